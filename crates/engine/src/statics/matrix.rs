//! The tangent stiffness of a scene as a sparse matrix, by columns: derivatives of the bond forces
//! with respect to small displacements and rotations of the unknowns.

use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::particles::Pose;
use dem_physics::bond::tangent::{BondTangent, DEGREES_OF_FREEDOM};

use super::degrees_of_freedom::{DegreesOfFreedom, HELD};

/// A square matrix over the unknowns. Its pattern is fixed while its entries change.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// Only the lower triangle of the symmetric part, (K + K^T)/2, is stored.
    pub symmetric: bool,
    /// Start of each column, followed by the end of the last one.
    pub starts: Vec<usize>,
    /// Rows of the entries, ascending in each column.
    pub rows: Vec<usize>,
    /// The entries, N/m, N, N m.
    pub values: Vec<f64>,
}

impl Matrix {
    /// The pattern of a state: every particle with itself and with its bonded neighbours. All
    /// entries are 0.
    pub fn pattern(state: &State, degrees_of_freedom: &DegreesOfFreedom, symmetric: bool) -> Self {
        let mut neighbours: Vec<Vec<u32>> =
            (0..state.particles.len() as u32).map(|i| vec![i]).collect();
        for (at, &[a, b]) in state.bonds.ends.iter().enumerate() {
            if !state.bonds.is_broken(at) {
                neighbours[a as usize].push(b);
                neighbours[b as usize].push(a);
            }
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for (own, neighbours) in degrees_of_freedom.unknown.iter().zip(&mut neighbours) {
            neighbours.sort_unstable();
            neighbours.dedup();
            for column in own.iter().filter(|n| **n != HELD) {
                let of_neighbours = neighbours
                    .iter()
                    .flat_map(|j| degrees_of_freedom.unknown[*j as usize]);
                rows.extend(
                    of_neighbours.filter(|row| *row != HELD && (!symmetric || row >= column)),
                );
                starts.push(rows.len());
            }
        }
        Self {
            symmetric,
            values: vec![0.0; rows.len()],
            starts,
            rows,
        }
    }

    /// Sets the entries to the tangents of all bonds at these poses, in the order of the bonds.
    pub fn assemble(
        &mut self,
        bonds: &Bonds,
        degrees_of_freedom: &DegreesOfFreedom,
        poses: &[Pose],
    ) {
        self.values.fill(0.0);
        for at in (0..bonds.len()).filter(|at| !bonds.is_broken(*at)) {
            let unknowns = of_ends(bonds, degrees_of_freedom, at);
            self.add(&unknowns, &bonds.tangent(at, poses));
        }
    }

    /// Adds to the entry of two unknowns, for a symmetric matrix; only its lower triangle counts.
    pub fn add_symmetric(&mut self, row: usize, column: usize, value: f64) {
        if row == HELD || column == HELD || row < column {
            return;
        }
        let entries = self.starts[column]..self.starts[column + 1];
        let at = entries.start + self.rows[entries.clone()].partition_point(|r| *r < row);
        if entries.contains(&at) && self.rows[at] == row {
            self.values[at] += value;
        }
    }

    /// Sets `image` to this symmetric matrix times a vector.
    pub fn multiply(&self, vector: &[f64], image: &mut [f64]) {
        image.fill(0.0);
        for column in 0..vector.len() {
            let mut sum = 0.0;
            for at in self.starts[column]..self.starts[column + 1] {
                let (row, value) = (self.rows[at], self.values[at]);
                if row == column {
                    sum += value * vector[column];
                } else {
                    image[row] += value * vector[column];
                    sum += value * vector[row];
                }
            }
            image[column] += sum;
        }
    }

    fn add(&mut self, unknowns: &[usize; DEGREES_OF_FREEDOM], tangent: &BondTangent) {
        for (j, &column) in unknowns.iter().enumerate() {
            if column == HELD {
                continue;
            }
            let entries = self.starts[column]..self.starts[column + 1];
            for end in [0..6, 6..DEGREES_OF_FREEDOM] {
                // The rows of a particle are contiguous.
                let mut place = None;
                for i in end {
                    let row = unknowns[i];
                    if row == HELD || (self.symmetric && row < column) {
                        continue;
                    }
                    let at = place.unwrap_or_else(|| {
                        let rows = &self.rows[entries.clone()];
                        entries.start + rows.partition_point(|r| *r < row)
                    });
                    self.values[at] += if self.symmetric {
                        0.5 * (tangent[i][j] + tangent[j][i])
                    } else {
                        tangent[i][j]
                    };
                    place = Some(at + 1);
                }
            }
        }
    }
}

/// Forces on the unknowns when supports move by these displacements, m and rad, before the others
/// follow: minus the tangent times the displacements, N and N m.
pub(crate) fn pulled_by_supports(
    bonds: &Bonds,
    degrees_of_freedom: &DegreesOfFreedom,
    poses: &[Pose],
    displacements: &[(u32, [f64; 6])],
) -> Vec<f64> {
    let mut pulled = vec![0.0; degrees_of_freedom.count];
    let displacement_of = |particle: u32| {
        let found = displacements.binary_search_by_key(&particle, |(moved, _)| *moved);
        found.ok().map(|n| displacements[n].1)
    };
    for at in (0..bonds.len()).filter(|at| !bonds.is_broken(*at)) {
        let displacements = bonds.ends[at].map(displacement_of);
        if displacements == [None; 2] {
            continue;
        }
        let [a, b] = displacements.map(Option::unwrap_or_default);
        let tangent = bonds.tangent(at, poses);
        for (&unknown, row) in of_ends(bonds, degrees_of_freedom, at).iter().zip(&tangent) {
            if unknown != HELD {
                let displacements = a.iter().chain(&b);
                pulled[unknown] -= row
                    .iter()
                    .zip(displacements)
                    .map(|(k, way)| k * way)
                    .sum::<f64>();
            }
        }
    }
    pulled
}

/// The numbers of the degrees of freedom of both ends of bond `at`.
fn of_ends(
    bonds: &Bonds,
    degrees_of_freedom: &DegreesOfFreedom,
    at: usize,
) -> [usize; DEGREES_OF_FREEDOM] {
    let [a, b] = bonds.ends[at].map(|end| degrees_of_freedom.unknown[end as usize]);
    let mut both = [HELD; DEGREES_OF_FREEDOM];
    both[..6].copy_from_slice(&a);
    both[6..].copy_from_slice(&b);
    both
}
