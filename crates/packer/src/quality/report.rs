//! The report on a packing.

use super::contacts::Contacts;
use super::densities::{Fraction, Layer};
use super::fabric::Fabric;
use super::pieces::Pieces;
use super::thickness::Thinnest;
use crate::sizes::Fit;
use serde::{Deserialize, Serialize};

/// The quality of a packing. Fractions are between 0 and 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Number of spheres.
    pub particles: usize,
    /// Number of bonds.
    pub bonds: usize,
    /// If the bonds are all pairs up to a multiple of the sum of their radii, except those with
    /// surface between them: that multiple. 0 if they were chosen otherwise.
    pub bond_range: f64,
    /// Mean diameter by number, m.
    pub mean_diameter_m: f64,
    /// Overlap of the packing.
    pub overlap: f64,
    /// Volume of the solid, m3.
    pub shape_volume_m3: f64,
    /// Sum of the particles' masses divided by the volume of the solid, kg/m3.
    pub solid_density_kg_m3: Option<f64>,
    /// Fraction of the solid filled by the union of the spheres.
    pub union_density: Fraction,
    /// Fraction of the solid filled by the spheres reduced to r_gen, which do not overlap: exact.
    pub generating_density: f64,
    /// Depth at which the interior begins, m: two largest diameters.
    pub interior_depth_m: f64,
    /// Fraction of the interior filled by the union of the spheres. None without interior.
    pub interior_union_density: Option<Fraction>,
    /// Fraction of the interior filled by the spheres reduced to r_gen. None without interior.
    pub interior_generating_density: Option<Fraction>,
    /// Density (r_gen) in layers from the wall inwards, a quarter of a mean diameter each.
    pub wall_profile: Vec<Layer>,
    /// Density (r_gen) of the interior in ten slabs along the longest side of the shape.
    pub slab_profile: Vec<Layer>,
    /// Sizes placed compared with those requested, by number.
    pub sizes_by_number: Fit,
    /// Sizes placed compared with those requested, by mass.
    pub sizes_by_mass: Fit,
    /// Bonds divided by particles, as Platzer 2022 counts (4.87).
    pub bonds_per_particle: f64,
    /// Mean number of bonds that a particle has: twice as many.
    pub mean_coordination: f64,
    /// Contacts between spheres, and with the wall.
    pub contacts: Contacts,
    /// Pieces that the bonds hold together.
    pub pieces: Pieces,
    /// Directions of all bonds. None without bonds.
    pub fabric: Option<Fabric>,
    /// Directions of the bonds of the interior: those with one end in it count half. None without
    /// such bonds.
    pub interior_fabric: Option<Fabric>,
    /// The thinnest part of the body. None without particles.
    pub thinnest: Option<Thinnest>,
    /// A sentence on few particles across, which make a body coarse.
    pub coarse: Option<String>,
    /// Warnings with advice, one sentence each.
    pub warnings: Vec<String>,
}
