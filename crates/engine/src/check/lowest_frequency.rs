//! The lowest frequency of a free body, by the Rayleigh-Ritz method with its actual forces.

use nalgebra::{DMatrix, DVector, SymmetricEigen, Vector3};
use rayon::prelude::*;

use super::limit::{Field, add_stiffness_times};
use crate::state::State;

/// Highest degree of the polynomials in x, y and z.
const DEGREE: usize = 4;
/// Monomials of x, y and z up to that degree.
const MONOMIALS: usize = 35;
/// Fields: each monomial as a displacement along x, y and z.
const FIELDS: usize = 3 * MONOMIALS;
/// Fields whose independent part is below this fraction of the largest mass are dropped: a flat or
/// thin body has such fields.
const DEPENDENT: f64 = 1e-10;
/// Number of rigid motions.
const RIGID: usize = 6;
/// An eigenvalue below this fraction of the largest is rounding: that of a body without bonds.
const NOTHING: f64 = 1e-12;
/// Particles handled by one task.
const CHUNK: usize = 1024;

/// Lowest frequency of the bodies of a state as one free body, Hz: no supports, walls or contacts.
/// None: nothing vibrates.
///
/// Displacements are polynomials of up to the fourth degree in x, y and z about the centre, and
/// each particle rotates by half the curl. The smallest of their frequencies is never below the
/// true one. It is 0.3 % above that of the first bending mode of a slender beam (22.45 instead of
/// 22.37 in the formula omega = 22.37 sqrt(EI/(rho A L^4))), and more above that of a packing,
/// whose particles do not follow polynomials. Pieces that are not bonded count as if the
/// polynomials held them together.
///
/// The wrenches of the state are overwritten.
pub fn lowest_frequency_hz(state: &mut State) -> Option<f64> {
    let basis = Basis::of(state)?;
    let count = state.particles.len();
    let ones: Field = vec![[1.0; 6]; count];
    let mut displaced = state.particles.poses.clone();
    let mut stiffness = DMatrix::zeros(FIELDS, FIELDS);
    let mut mass = DMatrix::zeros(FIELDS, FIELDS);
    for j in 0..FIELDS {
        let field = basis.field(state, j);
        let mut forces: Field = vec![[0.0; 6]; count];
        add_stiffness_times(state, 1.0, &ones, &field, None, &mut displaced, &mut forces);
        stiffness.set_column(j, &basis.work(state, &forces));
        let p = &state.particles;
        for (i, (force, moved)) in forces.iter_mut().zip(&field).enumerate() {
            for k in 0..3 {
                force[k] = moved[k] / p.motions[i].inverse_mass;
                force[3 + k] = moved[3 + k] / p.motions[i].inverse_inertia;
            }
        }
        mass.set_column(j, &basis.work(state, &forces));
    }
    let squared = lowest_elastic(&stiffness, &mass, &basis.rigid())?;
    Some(squared.sqrt() / std::f64::consts::TAU)
}

/// Smallest eigenvalue of `stiffness` over `mass` on the space orthogonal to the columns of
/// `rigid`.
fn lowest_elastic(
    stiffness: &DMatrix<f64>,
    mass: &DMatrix<f64>,
    rigid: &DMatrix<f64>,
) -> Option<f64> {
    let symmetric = |matrix: &DMatrix<f64>| 0.5 * (matrix + matrix.transpose());
    let of_mass = SymmetricEigen::new(symmetric(mass));
    let least = DEPENDENT * of_mass.eigenvalues.max();
    let kept: Vec<usize> = (0..mass.nrows())
        .filter(|&i| of_mass.eigenvalues[i] > least)
        .collect();
    let (mut to_unit, mut from_unit) = (
        DMatrix::zeros(kept.len(), mass.nrows()),
        DMatrix::zeros(mass.nrows(), kept.len()),
    );
    for (row, &i) in kept.iter().enumerate() {
        let (root, vector) = (
            of_mass.eigenvalues[i].sqrt(),
            of_mass.eigenvectors.column(i),
        );
        to_unit.set_row(row, &(root * vector.transpose()));
        from_unit.set_column(row, &(vector / root));
    }
    let rigid = (to_unit * rigid).qr().q();
    let without_rigid = DMatrix::identity(kept.len(), kept.len()) - &rigid * rigid.transpose();
    let elastic =
        &without_rigid * from_unit.transpose() * symmetric(stiffness) * from_unit * &without_rigid;
    let mut found: Vec<f64> = SymmetricEigen::new(symmetric(&elastic))
        .eigenvalues
        .iter()
        .copied()
        .collect();
    found.sort_by(f64::total_cmp);
    let largest = found.last().copied()?;
    let lowest = found.get(RIGID).copied()?;
    (lowest > NOTHING * largest).then_some(lowest)
}

/// The fields, in coordinates from -1 to 1 over the body.
struct Basis {
    centre_m: [f64; 3],
    half_m: [f64; 3],
    /// Powers of x, y and z.
    powers: Vec<[usize; 3]>,
}

impl Basis {
    /// None: no particles.
    fn of(state: &State) -> Option<Self> {
        let poses = &state.particles.poses;
        let reach = |side: f64| {
            [0, 1, 2].map(|k| {
                let ends = poses.iter().map(|p| side * p.position_m[k] + p.radius_m());
                side * ends.fold(f64::NEG_INFINITY, f64::max)
            })
        };
        let (low, high) = (reach(-1.0), reach(1.0));
        let mut powers = Vec::new();
        for total in 0..=DEGREE {
            for a in (0..=total).rev() {
                for b in (0..=total - a).rev() {
                    powers.push([a, b, total - a - b]);
                }
            }
        }
        (!state.particles.is_empty()).then(|| Self {
            centre_m: [0, 1, 2].map(|k| 0.5 * (low[k] + high[k])),
            half_m: [0, 1, 2].map(|k| 0.5 * (high[k] - low[k])),
            powers,
        })
    }

    /// Value and gradient, 1/m, of every monomial at particle `i`.
    fn monomials(&self, state: &State, i: usize) -> [(f64, Vector3<f64>); MONOMIALS] {
        let place = state.particles.poses[i].position_m;
        let mut powers = [[1.0; DEGREE + 1]; 3];
        for k in 0..3 {
            let x = (place[k] - self.centre_m[k]) / self.half_m[k];
            for n in 0..DEGREE {
                powers[k][n + 1] = powers[k][n] * x;
            }
        }
        let of = |at: usize| {
            let exponents = self.powers[at];
            let factor = |k: usize| powers[k][exponents[k]];
            let slope = |k: usize| match exponents[k] {
                0 => 0.0,
                n => n as f64 * powers[k][n - 1] / self.half_m[k],
            };
            let gradient = Vector3::new(
                slope(0) * factor(1) * factor(2),
                factor(0) * slope(1) * factor(2),
                factor(0) * factor(1) * slope(2),
            );
            (factor(0) * factor(1) * factor(2), gradient)
        };
        std::array::from_fn(of)
    }

    /// Displacement and rotation of every particle in field `j`.
    fn field(&self, state: &State, j: usize) -> Field {
        let (at, axis) = (j / 3, j % 3);
        (0..state.particles.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|i| {
                let (value, gradient) = self.monomials(state, i)[at];
                let mut direction = Vector3::zeros();
                direction[axis] = 1.0;
                let (moved, turned) = (value * direction, 0.5 * gradient.cross(&direction));
                [moved.x, moved.y, moved.z, turned.x, turned.y, turned.z]
            })
            .collect()
    }

    /// Work of forces and torques in every field. The same for any number of threads.
    fn work(&self, state: &State, forces: &Field) -> DVector<f64> {
        let of_chunk = |(number, chunk): (usize, &[[f64; 6]])| {
            let mut sum = [0.0; FIELDS];
            for (i, &[fx, fy, fz, tx, ty, tz]) in chunk.iter().enumerate() {
                let (force, torque) = (Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz));
                let monomials = self.monomials(state, number * CHUNK + i);
                for (at, (value, gradient)) in monomials.iter().enumerate() {
                    let work = *value * force + 0.5 * torque.cross(gradient);
                    for k in 0..3 {
                        sum[3 * at + k] += work[k];
                    }
                }
            }
            DVector::from_column_slice(&sum)
        };
        let sums: Vec<DVector<f64>> = forces.par_chunks(CHUNK).enumerate().map(of_chunk).collect();
        sums.iter().sum()
    }

    /// Coefficients of the three translations and the three rotations about the centre, one per
    /// column.
    fn rigid(&self) -> DMatrix<f64> {
        let mut rigid = DMatrix::zeros(FIELDS, RIGID);
        let linear = |k: usize| {
            let found = self
                .powers
                .iter()
                .position(|powers| powers.iter().sum::<usize>() == 1 && powers[k] == 1);
            3 * found.unwrap_or_default()
        };
        for axis in 0..3 {
            rigid[(axis, axis)] = 1.0;
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            rigid[(linear(b) + a, 3 + axis)] = -self.half_m[b];
            rigid[(linear(a) + b, 3 + axis)] = self.half_m[a];
        }
        rigid
    }
}
