//! The particles and bonds of a frame, for other programs, and its loose spheres as a body.

use std::collections::BTreeMap;

use super::parts::{About, Body, Parts};
use super::stored_frame::common_density;
use crate::diagnostic::{Diagnostic, Result};

/// The particles and bonds of a frame of any run. SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StoredParticles {
    /// Simulated time, s.
    pub time_s: f64,
    /// Names of the bodies of the scene.
    pub body_names: Vec<String>,
    /// Body of each particle: number in `body_names`.
    pub bodies: Vec<u32>,
    /// The number of each particle that follows it through the run.
    pub ids: Vec<u32>,
    /// Centre of each particle, m.
    pub positions: Vec<[f64; 3]>,
    /// Radius of each particle, m.
    pub radii: Vec<f64>,
    /// Velocity of each particle, m/s.
    pub velocities_m_s: Vec<[f64; 3]>,
    /// Fragment of each particle. None: nothing can break in this run.
    pub fragments: Option<Vec<u32>>,
    /// Density of each particle, kg/m3. None: the frame does not say.
    pub densities_kg_m3: Option<Vec<f64>>,
    /// The two particles of each bond.
    pub bonds: Vec<[u32; 2]>,
    /// Radius of each bond, m.
    pub bond_radii: Vec<f64>,
    /// For each bond, true if it is broken.
    pub broken: Vec<bool>,
}

impl StoredParticles {
    /// All loose spheres as one body without bonds, at their positions, in the order of the frame:
    /// those that are a fragment of their own or, in a run in which nothing can break, those
    /// without a bond. Velocities are lost. The density is that of the spheres, unless they differ.
    /// Refuses a frame without loose spheres.
    pub fn loose_spheres(&self) -> Result<Body> {
        let loose = self.loose();
        if loose.is_empty() {
            let problem = format!("none of the {} spheres is loose", self.radii.len());
            let remedy = "dem-run fragment takes a fragment with its bonds: --id or --largest";
            return Err(Diagnostic::input("", problem, remedy));
        }
        let density = |densities: &Vec<f64>| common_density(loose.iter().map(|&i| densities[i]));
        Body::from_parts(Parts {
            positions: loose.iter().map(|&i| self.positions[i]).collect(),
            radii: loose.iter().map(|&i| self.radii[i]).collect(),
            about: About {
                particle_density_kg_m3: self.densities_kg_m3.as_ref().and_then(density),
                ..About::default()
            },
            ..Parts::default()
        })
    }

    /// The loose spheres, ascending.
    fn loose(&self) -> Vec<usize> {
        let count = self.radii.len();
        if let Some(fragments) = &self.fragments {
            let mut sizes: BTreeMap<u32, usize> = BTreeMap::new();
            for fragment in fragments {
                *sizes.entry(*fragment).or_default() += 1;
            }
            return (0..count).filter(|&i| sizes[&fragments[i]] == 1).collect();
        }
        let mut bonded = vec![false; count];
        for (ends, _) in self
            .bonds
            .iter()
            .zip(&self.broken)
            .filter(|(_, broken)| !**broken)
        {
            for end in ends {
                bonded[*end as usize] = true;
            }
        }
        (0..count).filter(|&i| !bonded[i]).collect()
    }
}
