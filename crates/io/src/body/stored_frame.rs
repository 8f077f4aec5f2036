//! A frame of a run, as a file of particles and bonds: its fragments, and each of them as a body.

use std::collections::BTreeMap;

use super::parts::{About, Body, Parts};
use crate::diagnostic::{Diagnostic, Result};

/// Particle array: radius, m.
pub const RADIUS: &str = "radius_m";
/// Particle array: density of the material, kg/m3.
pub const DENSITY: &str = "density_kg_m3";
/// Particle array: number of the fragment.
pub const FRAGMENT_ID: &str = "fragment_id";
/// Bond array: radius, m.
pub const BOND_RADIUS: &str = "bond_radius_m";
/// Bond array: length at which the bond is free of force, m.
pub const BOND_LENGTH: &str = "initial_length_m";
/// Bond array: whether it is broken, 1 or 0.
pub const BROKEN: &str = "broken";
/// Field: simulated time, s.
pub const TIME: &str = "TimeValue";

/// Densities of one material differ by no more than this part, by rounding.
const SAME_DENSITY: f64 = 1e-12;

/// Fragments that a message names.
const NAMED: usize = 5;

/// What a frame says of its fragments. SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StoredFrame {
    /// Simulated time, s.
    pub time_s: f64,
    /// Centre of each particle, m.
    pub positions: Vec<[f64; 3]>,
    /// Radius of each particle, m.
    pub radii: Vec<f64>,
    /// Density of each particle, kg/m3.
    pub densities_kg_m3: Vec<f64>,
    /// Fragment of each particle.
    pub clusters: Vec<u32>,
    /// The two particles of each bond.
    pub bonds: Vec<[u32; 2]>,
    /// Radius of each bond, m.
    pub bond_radii: Vec<f64>,
    /// Length at which each bond is free of force, m.
    pub bond_lengths: Vec<f64>,
    /// Whether each bond is broken.
    pub broken: Vec<bool>,
}

/// A fragment of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoredFragment {
    /// Its number.
    pub id: u32,
    /// Number of its particles.
    pub particles: usize,
    /// kg.
    pub mass_kg: f64,
}

impl StoredFrame {
    /// All fragments, the heaviest first; of equal ones that with the smallest number.
    pub fn fragments(&self) -> Vec<StoredFragment> {
        let mut found: BTreeMap<u32, StoredFragment> = BTreeMap::new();
        for (i, &id) in self.clusters.iter().enumerate() {
            let fragment = found.entry(id).or_insert(StoredFragment {
                id,
                particles: 0,
                mass_kg: 0.0,
            });
            let volume = 4.0 / 3.0 * std::f64::consts::PI * self.radii[i].powi(3);
            fragment.particles += 1;
            fragment.mass_kg += self.densities_kg_m3[i] * volume;
        }
        let mut fragments: Vec<StoredFragment> = found.into_values().collect();
        // The sort keeps the order of equal ones.
        fragments.sort_by(|a, b| b.mass_kg.total_cmp(&a.mass_kg));
        fragments
    }

    /// A fragment as a body: its particles where they stand, in the order of the frame, and the
    /// bonds between them that hold.
    ///
    /// Bonds keep the lengths at which they are free of force, so that one that is stretched or
    /// pressed stays so. That they were bent, twisted or sheared is lost, and so are velocities.
    /// The density is that of the particles, unless they differ.
    ///
    /// # Errors
    /// There is no such fragment; the frame holds no sound body of it.
    pub fn body(&self, id: u32) -> Result<Body> {
        let members: Vec<usize> = (0..self.clusters.len())
            .filter(|&i| self.clusters[i] == id)
            .collect();
        let Some(&first) = members.first() else {
            return Err(self.unknown(id));
        };
        let mut number_of = vec![u32::MAX; self.clusters.len()];
        for (number, &i) in (0..).zip(&members) {
            number_of[i] = number;
        }
        let is_whole = |bond: &usize| {
            let ends = self.bonds[*bond].map(|end| self.clusters[end as usize]);
            !self.broken[*bond] && ends == [id; 2]
        };
        let bonds: Vec<usize> = (0..self.bonds.len()).filter(is_whole).collect();
        let density = self.densities_kg_m3[first];
        let is_same = |i: &usize| (self.densities_kg_m3[*i] / density - 1.0).abs() <= SAME_DENSITY;
        Body::from_parts(Parts {
            positions: members.iter().map(|&i| self.positions[i]).collect(),
            radii: members.iter().map(|&i| self.radii[i]).collect(),
            bonds: bonds
                .iter()
                .map(|&bond| self.bonds[bond].map(|end| number_of[end as usize]))
                .collect(),
            bond_radii: Some(bonds.iter().map(|&bond| self.bond_radii[bond]).collect()),
            bond_lengths: Some(bonds.iter().map(|&bond| self.bond_lengths[bond]).collect()),
            about: About {
                particle_density_kg_m3: members
                    .iter()
                    .all(is_same)
                    .then(|| without_rounding(density)),
                ..About::default()
            },
        })
    }

    fn unknown(&self, id: u32) -> Diagnostic {
        let fragments = self.fragments();
        let named: Vec<String> = fragments
            .iter()
            .take(NAMED)
            .map(|fragment| {
                let s = if fragment.particles == 1 { "" } else { "s" };
                format!("{} ({} particle{s})", fragment.id, fragment.particles)
            })
            .collect();
        Diagnostic::input(
            "",
            format!(
                "there is no fragment {id} at {:.6e} s among the {} that there are",
                self.time_s,
                fragments.len()
            ),
            format!("the heaviest are {}", named.join(", ")),
        )
    }
}

/// A density without what came in when it was reckoned from a mass: 12 digits of it.
fn without_rounding(density_kg_m3: f64) -> f64 {
    format!("{density_kg_m3:.11e}")
        .parse()
        .unwrap_or(density_kg_m3)
}
