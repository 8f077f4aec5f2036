//! Bulk quantities: mass and bulk density of a region, bulk density of a heap, and mixing.
//!
//! A sphere counts with the part of it that is in a region: of [`POINTS`] points spread evenly
//! through it, those within.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::Vector3;
use rayon::prelude::*;

use super::spheres::{Sphere, across};
use crate::plan::measures::FEWEST_MIXED_CELLS;
use crate::state::regions::Region;

/// Points of a sphere that a border cuts: its part on one side is known to some thousandths.
const POINTS: usize = 500;
/// Columns of a heap are this wide, in mean diameters.
const COLUMN: f64 = 0.5;
/// A column that a sphere enters by less than about half of this part of its radius is beside it:
/// rounding must not decide for spheres that lie side by side.
const TOUCHED: f64 = 1e-6;

/// Mass of the part of some spheres that is in a region, kg.
pub(super) fn mass_within_kg(spheres: &[Sphere], region: &Region) -> f64 {
    let points = points_of_ball();
    let mass = |s: &Sphere| s.mass_kg * part_within(s, region, &points);
    let masses: Vec<f64> = spheres.par_iter().map(mass).collect();
    0.0 + masses.iter().sum::<f64>()
}

/// The part of a sphere that is in a region.
fn part_within(sphere: &Sphere, region: &Region, points: &[Vector3<f64>]) -> f64 {
    let (place, radius_m) = (sphere.place_m.into(), sphere.radius_m);
    if !region.bounds().is_near(&place, radius_m) {
        return 0.0;
    }
    if !region.cuts(place, radius_m) {
        return f64::from(u8::from(region.contains(place)));
    }
    let is_in =
        |point: &&Vector3<f64>| region.contains((sphere.place_m + radius_m * **point).into());
    points.iter().filter(is_in).count() as f64 / points.len() as f64
}

/// Points spread evenly through a ball of radius 1: shells of equal volume along a spiral, turned
/// by the golden ratio from point to point, at depths in the order of the van der Corput sequence.
fn points_of_ball() -> Vec<Vector3<f64>> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let point = |n: usize| {
        let height = 1.0 - 2.0 * (n as f64 + 0.5) / POINTS as f64;
        let angle = TAU * golden * n as f64;
        let across = (1.0 - height * height).sqrt();
        let depth = f64::from((n as u32 + 1).reverse_bits()) / 2.0_f64.powi(32);
        depth.cbrt() * Vector3::new(across * angle.cos(), across * angle.sin(), height)
    };
    (0..POINTS).map(point).collect()
}

/// Mass of some spheres over the volume under their surface, kg/m3: that of columns along `up`,
/// from the lowest point of all to the highest point in each column. Columns are half a mean
/// diameter wide. NaN if there are none.
pub(super) fn heap_density_kg_m3(spheres: &[Sphere], up: Vector3<f64>) -> f64 {
    let [aside, across] = across(&up);
    let mean_m = spheres.iter().map(|s| s.radius_m).sum::<f64>() / spheres.len() as f64;
    let width_m = 2.0 * COLUMN * mean_m;
    let mut tops: BTreeMap<[i64; 2], f64> = BTreeMap::new();
    let mut lowest_m = f64::INFINITY;
    for sphere in spheres {
        let radius_m = sphere.radius_m;
        let [x, y, z] = [aside, across, up].map(|axis| sphere.place_m.dot(&axis));
        lowest_m = lowest_m.min(z - radius_m);
        let [from, to] = [-1.0, 1.0]
            .map(|side| [x, y].map(|middle| ((middle + side * radius_m) / width_m).floor() as i64));
        for i in from[0]..=to[0] {
            for j in from[1]..=to[1] {
                // The point of the column nearest to the axis of the sphere is the highest.
                let [aside_m, across_m] = [(i, x), (j, y)].map(|(n, middle)| {
                    let [low, high] = [n as f64, (n + 1) as f64].map(|end| end * width_m);
                    (low - middle).max(middle - high).max(0.0)
                });
                let left_m2 = radius_m * radius_m - aside_m.powi(2) - across_m.powi(2);
                if left_m2 > TOUCHED * radius_m * radius_m {
                    let top = tops.entry([i, j]).or_insert(f64::NEG_INFINITY);
                    *top = top.max(z + left_m2.sqrt());
                }
            }
        }
    }
    let heights = tops.values().map(|top| top - lowest_m);
    let volume_m3 = width_m * width_m * heights.sum::<f64>();
    spheres.iter().map(|s| s.mass_kg).sum::<f64>() / volume_m3
}

/// What the cubic cells of a region hold of two sets of spheres. Spheres count where their centres
/// are.
pub(super) struct Mixture {
    /// Mass of either set in each cell that is not empty, kg.
    cells_kg: BTreeMap<[i64; 3], [f64; 2]>,
    /// Mean mass of the pieces of either set, by mass, kg; of a piece that several cells share, its
    /// parts in them.
    piece_kg: [f64; 2],
    /// Lowest corner of the cell 0, 0, 0, m.
    low_m: Vector3<f64>,
    /// Edge of the cells, m.
    cell_m: f64,
}

/// A cell of a mixture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixedCell {
    /// Its centre, m. Length 3.
    pub centre_m: [f64; 3],
    /// Mass of both sets in it, kg.
    pub mass_kg: f64,
    /// Mass fraction of the first set.
    pub fraction: f64,
}

impl Mixture {
    /// That of two sets in a region, in cells with this edge, m.
    pub(super) fn of(sets: [&[Sphere]; 2], region: &Region, cell_m: f64) -> Self {
        let low_m = Vector3::from(region.bounds().low);
        let mut cells_kg: BTreeMap<[i64; 3], [f64; 2]> = BTreeMap::new();
        let piece_kg = [0, 1].map(|k| {
            let mut parts_kg: BTreeMap<([i64; 3], u32), f64> = BTreeMap::new();
            let inside = sets[k].iter();
            for sphere in inside.filter(|s| region.contains(s.place_m.into())) {
                let cell = ((sphere.place_m - low_m) / cell_m).map(|x| x.floor() as i64);
                cells_kg.entry(cell.into()).or_default()[k] += sphere.mass_kg;
                *parts_kg.entry((cell.into(), sphere.piece)).or_default() += sphere.mass_kg;
            }
            let squares: f64 = parts_kg.values().map(|kg| kg * kg).sum();
            squares / parts_kg.values().sum::<f64>()
        });
        Self {
            cells_kg,
            piece_kg,
            low_m,
            cell_m,
        }
    }

    /// The cells that are not empty.
    pub(super) fn cells(&self) -> impl Iterator<Item = MixedCell> {
        self.cells_kg.iter().map(|(number, [first, second])| {
            let corner = Vector3::from(number.map(|n| n as f64 + 0.5));
            let mass_kg = first + second;
            MixedCell {
                centre_m: (self.low_m + self.cell_m * corner).into(),
                mass_kg,
                fraction: first / mass_kg,
            }
        })
    }

    /// Lacey's index (Lacey 1954), 0 for sets apart and 1 for a random mixture:
    /// (s0^2 - s^2) / (s0^2 - sr^2), with the variance s^2 of the mass fraction of the first set
    /// among cells, weighted by mass, that of sets apart, s0^2 = p (1 - p), and that of a random
    /// mixture of pieces of different mass (Stange 1954): sr^2 = p (1 - p) (p m_b + (1 - p) m_a)/M,
    /// with the mean mass m_a and m_b of the pieces of either set, by mass, and M of what a cell
    /// holds. It is s0^2 / n for n equal pieces in each cell. NaN if the region has nothing of one
    /// of them, no more than one piece in each cell, or fewer than [`FEWEST_MIXED_CELLS`] cells:
    /// one
    /// cell is as mixed as can be, whatever lies in it.
    pub(super) fn lacey_index(&self) -> f64 {
        if self.cells_kg.len() < FEWEST_MIXED_CELLS {
            return f64::NAN;
        }
        let all_kg: f64 = self.cells().map(|cell| cell.mass_kg).sum();
        let first_kg: f64 = self.cells_kg.values().map(|[first, _]| first).sum();
        let fraction = first_kg / all_kg;
        let apart = fraction * (1.0 - fraction);
        let squares = (self.cells()).map(|cell| cell.mass_kg * (cell.fraction - fraction).powi(2));
        let variance = squares.sum::<f64>() / all_kg;
        let cell_kg = all_kg / self.cells_kg.len() as f64;
        let piece_kg = fraction * self.piece_kg[1] + (1.0 - fraction) * self.piece_kg[0];
        let random = apart * piece_kg / cell_kg;
        // Both are 0 if one is missing; rounding must not make an index of that.
        if !(apart > 0.0 && piece_kg < (1.0 - 1e-9) * cell_kg) {
            return f64::NAN;
        }
        (apart - variance) / (apart - random)
    }
}
