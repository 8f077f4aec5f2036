//! Mixing of two sets of spheres: Lacey's index and how well it is known.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::spheres::Sphere;
use dem_engine::state::watches::IndexError;
use dem_physics::geometry::region::Region;

/// Smallest number of cells with something in them for which a mixing index has a meaning.
pub(super) const FEWEST_MIXED_CELLS: usize = 10;
/// Fewest pieces of a cell from which one can tell whether its two sets lie apart.
const FEWEST_TOLD_APART: f64 = 3.0;

/// What the cubic cells of a region hold of two sets of spheres. Spheres count where their centres
/// are.
pub(super) struct Mixture {
    /// The cells that are not empty.
    cells: BTreeMap<[i64; 3], [Part; 2]>,
    /// Mean mass of the pieces of either set, by mass, kg; of a piece that several cells share, its
    /// parts in them.
    piece_kg: [f64; 2],
    /// Lowest corner of the cell 0, 0, 0, m.
    low_m: Vector3<f64>,
    /// Edge of the cells, m.
    cell_m: f64,
}

/// What a cell holds of one set. Places are from the middle of the cell, over its edge.
#[derive(Debug, Clone, Copy, Default)]
struct Part {
    mass_kg: f64,
    /// Sum of the squared masses of its pieces, kg2.
    squares_kg2: f64,
    /// Sum of mass times place of its pieces, kg.
    moment_kg: Vector3<f64>,
    /// Sum of mass times squared place of its pieces, along each axis, kg.
    second_kg: Vector3<f64>,
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

/// Variances of the mass fraction of the first set.
struct Variances {
    /// Among cells, weighted by mass.
    found: f64,
    /// Of sets apart.
    apart: f64,
    /// Of a random mixture.
    random: f64,
}

impl Mixture {
    /// The mixture of two sets in a region, in cells with this edge, m.
    pub(super) fn of(sets: [&[Sphere]; 2], region: &Region, cell_m: f64) -> Self {
        let low_m = Vector3::from(region.bounds().low);
        let mut cells: BTreeMap<[i64; 3], [Part; 2]> = BTreeMap::new();
        let piece_kg = [0, 1].map(|k| {
            // Mass of each piece in each cell, and mass times place.
            let mut pieces: BTreeMap<([i64; 3], u32), (f64, Vector3<f64>)> = BTreeMap::new();
            let inside = sets[k].iter();
            for sphere in inside.filter(|s| region.contains(s.place_m.into())) {
                let place = (sphere.place_m - low_m) / cell_m;
                let number = place.map(f64::floor);
                let key = (number.map(|x| x as i64).into(), sphere.piece);
                let (mass_kg, moment_kg) = pieces.entry(key).or_default();
                *mass_kg += sphere.mass_kg;
                *moment_kg += sphere.mass_kg * (place - number.add_scalar(0.5));
            }
            let mut squares_kg2 = 0.0;
            for ((cell, _), (mass_kg, moment_kg)) in &pieces {
                let part = &mut cells.entry(*cell).or_default()[k];
                part.mass_kg += mass_kg;
                part.squares_kg2 += mass_kg * mass_kg;
                part.moment_kg += moment_kg;
                part.second_kg += moment_kg.component_mul(moment_kg) / *mass_kg;
                squares_kg2 += mass_kg * mass_kg;
            }
            squares_kg2 / pieces.values().map(|(mass_kg, _)| mass_kg).sum::<f64>()
        });
        Self {
            cells,
            piece_kg,
            low_m,
            cell_m,
        }
    }

    /// The cells that are not empty.
    pub(super) fn cells(&self) -> impl Iterator<Item = MixedCell> {
        self.cells.iter().map(|(number, [first, second])| {
            let corner = Vector3::from(number.map(|n| n as f64 + 0.5));
            let mass_kg = first.mass_kg + second.mass_kg;
            MixedCell {
                centre_m: (self.low_m + self.cell_m * corner).into(),
                mass_kg,
                fraction: first.mass_kg / mass_kg,
            }
        })
    }

    /// Mass of both sets, kg.
    fn mass_kg(&self) -> f64 {
        self.cells().map(|cell| cell.mass_kg).sum()
    }

    /// Lacey's index (Lacey 1954), 0 for sets apart and 1 for a random mixture:
    /// (s0^2 - s^2) / (s0^2 - sr^2), with the variance s^2 of the mass fraction of the first set
    /// among cells, weighted by mass, that of sets apart, s0^2 = p (1 - p), and that of a random
    /// mixture of pieces of different mass (Stange 1954): sr^2 = p (1 - p) (p m_b + (1 - p) m_a)/M,
    /// with the mean mass m_a and m_b of the pieces of either set, by mass, and M of what a cell
    /// holds. It is s0^2 / n for n equal pieces in each cell. NaN if the region has nothing of one
    /// of them, no more than one piece in each cell, or fewer than [`FEWEST_MIXED_CELLS`] cells:
    /// one cell is as mixed as can be, whatever lies in it.
    pub(super) fn lacey_index(&self) -> f64 {
        self.variances()
            .map_or(f64::NAN, |v| (v.apart - v.found) / (v.apart - v.random))
    }

    /// How far the index may be off. None: it has no value.
    pub(super) fn error(&self) -> Option<IndexError> {
        let variances = self.variances()?;
        Some(IndexError {
            standard: self.standard_error(&variances),
            within_cells: self.apart_within_cells() / (variances.apart - variances.random),
        })
    }

    /// The variances that its index compares. None: it has none.
    fn variances(&self) -> Option<Variances> {
        if self.cells.len() < FEWEST_MIXED_CELLS {
            return None;
        }
        let all_kg = self.mass_kg();
        let first_kg: f64 = self.cells.values().map(|[first, _]| first.mass_kg).sum();
        let fraction = first_kg / all_kg;
        let apart = fraction * (1.0 - fraction);
        let squares = (self.cells()).map(|cell| cell.mass_kg * (cell.fraction - fraction).powi(2));
        let cell_kg = all_kg / self.cells.len() as f64;
        let piece_kg = fraction * self.piece_kg[1] + (1.0 - fraction) * self.piece_kg[0];
        // Both are 0 if one is missing; rounding must not make an index of that.
        (apart > 0.0 && piece_kg < (1.0 - 1e-9) * cell_kg).then(|| Variances {
            found: squares.sum::<f64>() / all_kg,
            apart,
            random: apart * piece_kg / cell_kg,
        })
    }

    /// Standard error of the index: pieces at random within N cells give each fraction the variance
    /// v = (s0^2 - s^2)/(n - 1), and their mean square, s^2, that of
    /// (2 v^2 + 4 v (s^2 - v))/N. It is 0 apart and sqrt(2/N)/(n - 1) at random.
    fn standard_error(&self, variances: &Variances) -> f64 {
        let Variances {
            found,
            apart,
            random,
        } = *variances;
        let all_kg = self.mass_kg();
        let squares_kg2: f64 = self.cells().map(|cell| cell.mass_kg.powi(2)).sum();
        let cells = all_kg * all_kg / squares_kg2;
        let inside = (apart - found).max(0.0) / (apart / random - 1.0);
        let between = (found - inside).max(0.0);
        let variance = (2.0 * inside * inside + 4.0 * inside * between) / cells;
        variance.sqrt() / (apart - random)
    }

    /// Variance that the cells hide, as their two sets lie apart within them: the part of the
    /// variance inside of cells that goes with the place along an axis, over that of pieces at
    /// random (adjusted R^2), where it is more than twice its scatter. A straight border through a
    /// cell shows from a third of it, near a face, to three quarters, in the middle. All of the
    /// variance inside if cells hold too few pieces to tell.
    fn apart_within_cells(&self) -> f64 {
        let all_kg = self.mass_kg();
        let (mut inside, mut told, mut scatter2) = (0.0, 0.0, 0.0);
        let mut hidden = Vector3::zeros();
        for [first, second] in self.cells.values() {
            let mass_kg = first.mass_kg + second.mass_kg;
            if first.mass_kg == 0.0 || second.mass_kg == 0.0 {
                continue;
            }
            let fraction = first.mass_kg / mass_kg;
            let spread = fraction * (1.0 - fraction);
            let share = spread * mass_kg / all_kg;
            inside += share;
            let parts = [first, second].map(|part| part.squares_kg2 / part.mass_kg.powi(2));
            // That of equal pieces whose middles are as far apart at random.
            let pieces = 1.0 / (spread * (parts[0] + parts[1]));
            if pieces < FEWEST_TOLD_APART * (1.0 - 1e-9) {
                continue;
            }
            told += share;
            let [a, b] = [first, second].map(|part| part.moment_kg / part.mass_kg);
            let middle = fraction * a + (1.0 - fraction) * b;
            let second = (first.second_kg + second.second_kg) / mass_kg;
            for k in 0..3 {
                let variance = second[k] - middle[k].powi(2);
                if variance > 1e-9 {
                    let with_place = spread * (a[k] - b[k]).powi(2) / variance;
                    hidden[k] += share * (with_place * (pieces - 1.0) - 1.0) / (pieces - 2.0);
                }
            }
            scatter2 += 2.0 * (share / (pieces - 2.0)).powi(2);
        }
        if told == 0.0 {
            return inside;
        }
        let clear = |found: f64, axes: f64| {
            let is_clear = found > 2.0 * (axes * scatter2).sqrt();
            if is_clear { found } else { 0.0 }
        };
        let along_axes: f64 = hidden.iter().map(|found| clear(*found, 1.0)).sum();
        along_axes.max(clear(hidden.sum(), 3.0)) * inside / told
    }
}
