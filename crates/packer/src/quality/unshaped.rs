//! The quality of bonded spheres of which no shape is known.

use super::checks::ENOUGH_BONDS;
use super::fabric::{self, Fabric};
use super::pieces;
use super::text;
use super::warnings::{few_bonds_warning, pieces_warning};
use crate::bonds::suggested_bond_range;
use crate::spheres::Spheres;
use serde::Serialize;

/// The quality of the bonds of some spheres.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BondQuality {
    /// Mean number of bonds of a particle: twice the bonds / particles.
    pub mean_coordination: f64,
    /// Fabric of all bonds. None without bonds.
    pub fabric: Option<Fabric>,
    /// Warnings before the body is used, one sentence each.
    pub warnings: Vec<String>,
}

impl BondQuality {
    /// Of the bonds of these spheres.
    pub fn of(spheres: &Spheres, bonds: &[[u32; 2]]) -> Self {
        let particles = spheres.radii.len();
        let per_particle = bonds.len() as f64 / particles.max(1) as f64;
        let mut warnings = Vec::new();
        warnings.extend(pieces_warning(
            &pieces::find(particles, bonds),
            1,
            particles,
        ));
        if per_particle < ENOUGH_BONDS {
            let advised = suggested_bond_range(spheres, &|_, _| false);
            warnings.push(few_bonds_warning(per_particle, advised));
        }
        Self {
            mean_coordination: 2.0 * per_particle,
            fabric: fabric::of(spheres, bonds, |_| true),
            warnings,
        }
    }

    /// Human-readable, one line.
    pub fn line(&self) -> String {
        let fabric = self.fabric.as_ref().map_or(String::new(), text::fabric);
        format!(
            "fabric     {fabric}; coordination number {:.2}\n",
            self.mean_coordination
        )
    }
}
