//! A body: its data, and the parts of them that a file may omit.

use serde::{Deserialize, Serialize};

use super::coarse::few_across;
use super::histories::{BondColumn, hashed_others, hashed_sums};
use crate::diagnostic::Result;

/// Information on the origin of a body. Every field is optional: a body may come from anywhere.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// Program and version that made it.
    pub program: Option<String>,
    /// File of the shape.
    pub source: Option<String>,
    /// Hash of that file's bytes (FNV-1a, 64 bit).
    pub source_hash: Option<u64>,
    /// Volume of the shape, m3.
    pub shape_volume_m3: Option<f64>,
    /// Density of the particles' material, kg/m3.
    pub particle_density_kg_m3: Option<f64>,
    /// Overlap o of the packing: spheres touch at r/(1 + o).
    pub overlap: Option<f64>,
    /// Bonds join pairs closer than this times the sum of their radii.
    pub bond_range: Option<f64>,
    /// Seed of the random numbers.
    pub seed: Option<u64>,
    /// Thickness of its thinnest part, m.
    pub thinnest_part_m: Option<f64>,
    /// The same in mean diameters of its particles.
    pub particles_across: Option<f64>,
    /// Warnings of the program that made it, one sentence each.
    pub warnings: Vec<String>,
}

impl About {
    /// A sentence on a body with few particles across its thinnest part. None: there are enough, or
    /// their number is unknown.
    pub fn coarse(&self) -> Option<String> {
        few_across(
            self.particles_across?,
            "the thinnest part",
            self.thinnest_part_m?,
        )
    }
}

/// Spheres joined by bonds. SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Body {
    /// Centres, m. One per particle.
    pub positions: Vec<[f64; 3]>,
    /// Radii, m. One per particle.
    pub radii: Vec<f64>,
    /// Rotation vector of each particle since its bonds were without load, rad. One per particle,
    /// or empty: none has turned. There are `bond_directions` as well, or neither.
    pub turns_rad: Vec<[f64; 3]>,
    /// The two particles of each bond, the smaller index first. One per bond.
    pub bonds: Vec<[u32; 2]>,
    /// Bond radii, m. One per bond.
    pub bond_radii: Vec<f64>,
    /// Initial bond lengths, m. One per bond.
    pub bond_lengths: Vec<f64>,
    /// Unit vector of each bond without load from its first to its second particle, in the axes
    /// that these had before they turned. One per bond, or empty: all lie between the centres.
    pub bond_directions: Vec<[f64; 3]>,
    /// Damage of each bond, from 0 (intact) to below 1 (broken). One per bond, or empty: all are
    /// intact.
    pub bond_damages: Vec<f64>,
    /// What the bonds have been through beyond damage: a column with numbers of each bond for each
    /// part of it. Missing columns are 0.
    pub bond_histories: Vec<BondColumn>,
    /// Information on its origin.
    pub about: About,
}

/// A body as read from a file, possibly incomplete.
#[derive(Debug, Clone, Default)]
pub(crate) struct Parts {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) radii: Vec<f64>,
    pub(crate) turns_rad: Vec<[f64; 3]>,
    pub(crate) bonds: Vec<[u32; 2]>,
    pub(crate) bond_radii: Option<Vec<f64>>,
    pub(crate) bond_lengths: Option<Vec<f64>>,
    pub(crate) bond_directions: Vec<[f64; 3]>,
    pub(crate) bond_damages: Vec<f64>,
    pub(crate) bond_histories: Vec<BondColumn>,
    pub(crate) about: About,
}

impl Body {
    /// Mean diameter of its particles by number, m. 0 without particles.
    pub fn mean_diameter_m(&self) -> f64 {
        2.0 * self.radii.iter().sum::<f64>() / self.radii.len().max(1) as f64
    }

    /// A body of spheres (x, y, z, radius, m) and the bonds between them, which are at rest and
    /// have the radius of the smaller of their spheres. Refuses what is not a body by
    /// [`Body::check`].
    pub fn from_spheres(spheres: &[[f64; 4]], bonds: &[[u32; 2]]) -> Result<Self> {
        Self::from_parts(Parts {
            positions: spheres.iter().map(|&[x, y, z, _]| [x, y, z]).collect(),
            radii: spheres.iter().map(|sphere| sphere[3]).collect(),
            bonds: bonds.to_vec(),
            ..Parts::default()
        })
    }

    /// The numbers of a bond in the column of this name of its history. Empty: there is none.
    pub fn history_of(&self, name: &str, bond: usize) -> &[f64] {
        let column = self
            .bond_histories
            .iter()
            .find(|column| column.name == name);
        column.map_or(&[], |column| column.of(bond))
    }

    /// Hash of its numbers (FNV-1a, 64 bit): the same for the same particles and bonds, whatever
    /// file they come from.
    pub fn hash(&self) -> u64 {
        let places = self.positions.iter().flatten().chain(&self.radii);
        let of_bonds = self.bond_radii.iter().chain(&self.bond_lengths);
        let of_bonds = of_bonds.chain(&self.bond_damages);
        let mut bytes = Vec::new();
        for number in places.chain(of_bonds) {
            bytes.extend(number.to_bits().to_le_bytes());
        }
        for number in self.turns_rad.iter().chain(&self.bond_directions).flatten() {
            bytes.extend(number.to_bits().to_le_bytes());
        }
        bytes.extend(hashed_sums(&self.bond_histories, self.bonds.len()));
        for end in self.bonds.iter().flatten() {
            bytes.extend(end.to_le_bytes());
        }
        bytes.extend(hashed_others(&self.bond_histories, self.bonds.len()));
        crate::hash::fnv1a(&bytes)
    }

    /// A body from the data of a file. The smaller end of each bond is put first. Unless given, a
    /// bond has the radius of the smaller of its particles and their distance as its length.
    /// Refuses what is not a body by [`Body::check`].
    pub(crate) fn from_parts(parts: Parts) -> Result<Self> {
        let Parts {
            positions,
            radii,
            turns_rad,
            mut bonds,
            bond_radii,
            bond_lengths,
            bond_directions,
            bond_damages,
            bond_histories,
            about,
        } = parts;
        for bond in &mut bonds {
            bond.sort_unstable();
        }
        // A non-existing end gives NaN here, and is refused by the check below.
        let bond_radii = bond_radii.unwrap_or_else(|| {
            let radius = |end: u32| radii.get(end as usize).copied().unwrap_or(f64::NAN);
            bonds
                .iter()
                .map(|&[a, b]| radius(a).min(radius(b)))
                .collect()
        });
        let bond_lengths = bond_lengths.unwrap_or_else(|| {
            let position = |end: u32| {
                positions
                    .get(end as usize)
                    .copied()
                    .unwrap_or([f64::NAN; 3])
            };
            bonds
                .iter()
                .map(|&[a, b]| distance(position(a), position(b)))
                .collect()
        });
        let body = Self {
            positions,
            radii,
            turns_rad,
            bonds,
            bond_radii,
            bond_lengths,
            bond_directions,
            bond_damages,
            bond_histories,
            about,
        };
        body.check()?;
        Ok(body)
    }
}

/// Distance of two points, in their unit.
fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    let [x, y, z] = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    (x * x + y * y + z * z).sqrt()
}
