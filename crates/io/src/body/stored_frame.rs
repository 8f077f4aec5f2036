//! A frame of a run, as a file of particles and bonds: its fragments, and each of them as a body.

use std::collections::BTreeMap;

use super::histories::{BondColumn, DIRECTION, of_some};
use super::parts::{About, Body, Parts};
use crate::diagnostic::{Diagnostic, Result};
use crate::units::significant;

/// Particle array: radius, m.
pub const RADIUS: &str = "radius_m";
/// Particle array: density of the material, kg/m3.
pub const DENSITY: &str = "density_kg_m3";
/// Particle array: id of the fragment.
pub const FRAGMENT_ID: &str = "fragment_id";
/// Particle array: number of the body in [`BODY_NAMES`].
pub const BODY: &str = "body";
/// Particle array: a number that follows a particle through a run.
pub const PARTICLE_ID: &str = "particle_id";
/// Particle array: velocity, m/s.
pub const VELOCITY: &str = "velocity_m_s";
/// Particle array: rotation vector since the bonds were without load, rad.
pub const TURN: &str = "rotation_rad";
/// Particle array: 1 for a sphere of a rigid clump, else 0.
pub const RIGID: &str = "rigid";
/// Bond array: radius, m.
pub const BOND_RADIUS: &str = "bond_radius_m";
/// Bond array: stress-free (rest) length, m.
pub const BOND_LENGTH: &str = "initial_length_m";
/// Bond array: 1 for a broken bond, else 0.
pub const BROKEN: &str = "broken";
/// Bond array: damage, from 0 (intact) to 1 (broken).
pub const DAMAGE: &str = "damage";
/// Bond array: failed part of the area of a flat joint.
pub const FAILED: &str = "failed_fraction";
/// Field: names of the bodies of the scene.
pub const BODY_NAMES: &str = "body_names";
/// Field: simulated time, s.
pub const TIME: &str = "TimeValue";

/// How the problem begins with a file of particles that is no frame.
pub const NO_FRAME: &str = "this is no frame of a run";
/// Largest relative difference between densities of one material, due to rounding.
const SAME_DENSITY: f64 = 1e-12;

/// Largest difference between the components of two equal directions, due to rounding.
const STRAIGHT: f64 = 1e-12;

/// Largest number of fragments that a message names.
const NAMED: usize = 5;

/// The fragments of a frame. SI units.
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
    /// Rotation vector of each particle since its bonds were without load, rad. None: the frame
    /// does not say.
    pub turns_rad: Option<Vec<[f64; 3]>>,
    /// Fragment of each particle.
    pub clusters: Vec<u32>,
    /// For each particle, true if it belongs to a rigid clump, of which the frame has the outer
    /// spheres and no bonds. Empty: none does.
    pub rigid: Vec<bool>,
    /// The two particles of each bond.
    pub bonds: Vec<[u32; 2]>,
    /// Radius of each bond, m.
    pub bond_radii: Vec<f64>,
    /// Stress-free (rest) length of each bond, m.
    pub bond_lengths: Vec<f64>,
    /// Unit vector of each bond without load from the particle with the smaller number to the other
    /// one, in the axes that both had before they turned. Empty: the frame does not say.
    pub bond_directions: Vec<[f64; 3]>,
    /// For each bond, true if it is broken.
    pub broken: Vec<bool>,
    /// Damage of each bond, or none: no bond can be damaged.
    pub damages: Vec<f64>,
    /// What bonds have been through beyond damage, in columns. Empty: no bond has a law with a
    /// history.
    pub histories: Vec<BondColumn>,
}

/// A fragment of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoredFragment {
    /// Its number.
    pub id: u32,
    /// Number of its particles.
    pub particles: usize,
    /// Mass, kg.
    pub mass_kg: f64,
}

/// What belongs to a fragment of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Members {
    /// Its particles, ascending.
    pub particles: Vec<usize>,
    /// Its unbroken bonds, ascending.
    pub bonds: Vec<usize>,
}

impl StoredFrame {
    /// All fragments, the heaviest first; among equal ones the one with the smallest number.
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

    /// The particles and unbroken bonds of each fragment.
    pub fn members(&self) -> BTreeMap<u32, Members> {
        let mut members: BTreeMap<u32, Members> = BTreeMap::new();
        for (i, &id) in self.clusters.iter().enumerate() {
            members.entry(id).or_default().particles.push(i);
        }
        for (bond, &[a, b]) in self.bonds.iter().enumerate() {
            let [a, b] = [a, b].map(|end| self.clusters[end as usize]);
            if !self.broken[bond] && a == b {
                members.entry(a).or_default().bonds.push(bond);
            }
        }
        members
    }

    /// A fragment as a body: its particles at their positions, in the order of the frame, and the
    /// unbroken bonds between them.
    ///
    /// Bonds keep their form without load, so that stretched, sheared, bent and twisted bonds stay
    /// so, their damage, their plastic deformation, and the elements of flat joints that have
    /// failed. Velocities are lost. The density is that of the particles, unless they differ.
    ///
    /// # Errors
    /// No such fragment; the frame lacks its bonds or their form without load; no valid body.
    pub fn body(&self, id: u32) -> Result<Body> {
        match self.members().get(&id) {
            Some(members) => self.body_of(id, members),
            None => Err(self.unknown(id)),
        }
    }

    /// The fragment `id`, whose [members](Self::members) are known, as a [body](Self::body).
    ///
    /// # Errors
    /// The frame lacks its bonds or their form without load; no valid body.
    pub fn body_of(&self, id: u32, members: &Members) -> Result<Body> {
        let Members { particles, bonds } = members;
        self.refuse_rigid(id, particles)?;
        // Ascending, and bonds are of these particles alone.
        let number_of = |end: u32| particles.partition_point(|&i| i < end as usize) as u32;
        let [turns_rad, bond_directions] = self.form_without_load(id, particles, bonds)?;
        let is_damaged = |bond: &usize| self.damages.get(*bond).is_some_and(|damage| *damage > 0.0);
        Body::from_parts(Parts {
            positions: particles.iter().map(|&i| self.positions[i]).collect(),
            radii: particles.iter().map(|&i| self.radii[i]).collect(),
            turns_rad,
            bond_directions,
            bonds: bonds
                .iter()
                .map(|&bond| self.bonds[bond].map(number_of))
                .collect(),
            bond_radii: Some(bonds.iter().map(|&bond| self.bond_radii[bond]).collect()),
            bond_lengths: Some(bonds.iter().map(|&bond| self.bond_lengths[bond]).collect()),
            bond_damages: if bonds.iter().any(is_damaged) {
                bonds.iter().map(|&bond| self.damages[bond]).collect()
            } else {
                Vec::new()
            },
            bond_histories: of_some(&self.histories, bonds),
            about: About {
                particle_density_kg_m3: common_density(
                    particles.iter().map(|&i| self.densities_kg_m3[i]),
                ),
                ..About::default()
            },
        })
    }

    /// Refuses a clump: its bonds and its inner spheres are not in the frame.
    fn refuse_rigid(&self, id: u32, members: &[usize]) -> Result<()> {
        let is_rigid = |i: &usize| self.rigid.get(*i) == Some(&true);
        if members.len() < 2 || !members.iter().any(is_rigid) {
            return Ok(());
        }
        Err(Diagnostic::input(
            "",
            format!(
                "fragment {id} is a rigid clump at {} s: the frame has neither its bonds nor its inner spheres",
                significant(self.time_s, 7)
            ),
            "take the file of its body, or a frame in which it is bonded; --all --stl writes hulls of clumps too",
        ))
    }

    /// Rotations of these particles of fragment `id`, and directions of these bonds, by which the
    /// bonds have their present loads; both empty if no particle has turned and all bonds lie
    /// between the centres.
    fn form_without_load(
        &self,
        id: u32,
        members: &[usize],
        bonds: &[usize],
    ) -> Result<[Vec<[f64; 3]>; 2]> {
        if bonds.is_empty() {
            return Ok(Default::default());
        }
        let Some(turns_rad) = self
            .turns_rad
            .as_ref()
            .filter(|_| !self.bond_directions.is_empty())
        else {
            return Err(Diagnostic::input(
                "",
                format!(
                    "the frame does not say how the bonds of fragment {id} are bent, twisted and sheared: it has no arrays '{TURN}' and '{DIRECTION}'"
                ),
                "run the scene again with this version of dem-run, which writes them; --loose, and --all --stl, do without",
            ));
        };
        let lies_between_centres = |bond: &usize| {
            let [a, b] = self.bonds[*bond].map(|end| end as usize);
            let [a, b] = [a.min(b), a.max(b)].map(|end| self.positions[end]);
            let apart = [0, 1, 2].map(|k| b[k] - a[k]);
            let length = apart.iter().map(|x| x * x).sum::<f64>().sqrt();
            let along = self.bond_directions[*bond];
            (0..3).all(|k| (apart[k] / length - along[k]).abs() < STRAIGHT)
        };
        let is_turned = |i: &usize| turns_rad[*i] != [0.0; 3];
        if !members.iter().any(is_turned) && bonds.iter().all(lies_between_centres) {
            return Ok(Default::default());
        }
        let turns = members.iter().map(|&i| turns_rad[i]);
        let directions = bonds.iter().map(|&bond| self.bond_directions[bond]);
        Ok([turns.collect(), directions.collect()])
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
                "there is no fragment {id} at {} s among the {} that there are",
                significant(self.time_s, 7),
                fragments.len()
            ),
            format!("the heaviest are {}", named.join(", ")),
        )
    }
}

/// The density of some particles, kg/m3. None if they differ, or if there are none.
pub(super) fn common_density(mut densities_kg_m3: impl Iterator<Item = f64>) -> Option<f64> {
    let first = densities_kg_m3.next()?;
    let is_same = |density: f64| (density / first - 1.0).abs() <= SAME_DENSITY;
    densities_kg_m3
        .all(is_same)
        .then(|| without_rounding(first))
}

/// A density rounded to 12 digits, without the rounding errors of its computation from a mass.
fn without_rounding(density_kg_m3: f64) -> f64 {
    format!("{density_kg_m3:.11e}")
        .parse()
        .unwrap_or(density_kg_m3)
}
