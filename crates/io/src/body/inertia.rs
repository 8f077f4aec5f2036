//! Mass, centre and inertia of rigidly joined spheres.

use nalgebra::{Matrix3, Quaternion, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};

/// Products of inertia below this fraction of the trace are rounding errors.
const ROUNDING: f64 = 4e-16;

/// Mass, centre of mass and principal axes of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass, m.
    pub centre_m: [f64; 3],
    /// Principal moments of inertia about the centre of mass, ascending, kg m^2.
    pub moments_kg_m2: [f64; 3],
    /// Rotation from the principal axes, in the order of the moments, to the axes of the input:
    /// unit quaternion x, y, z, w.
    ///
    /// The axes are right-handed. The largest components of the first two are positive, and w is
    /// not negative. If moments are equal, the axes are one of many valid choices, the same in each
    /// run.
    pub axes: [f64; 4],
}

/// The mass properties of rigidly joined spheres, each with its own mass and moment of inertia:
/// their sum, in which overlaps are counted repeatedly.
///
/// A cluster of bonded spheres has the same mass, centre of mass and inertia, so one can replace
/// the other without a change of momentum or kinetic energy.
///
/// `centres_m`, m, `masses_kg` and `own_inertias_kg_m2` (about the centre of the sphere; for a full
/// one 2/5 m r^2) have one entry per sphere; surplus entries are ignored. All sums are taken about
/// the mean. A body without mass has zero moments; numbers that are not finite give moments of NaN.
pub fn of_spheres(
    centres_m: &[[f64; 3]],
    masses_kg: &[f64],
    own_inertias_kg_m2: &[f64],
) -> MassProperties {
    let spheres = || centres_m.iter().zip(masses_kg).zip(own_inertias_kg_m2);
    let Some(&origin) = centres_m.first() else {
        return properties(Vector3::zeros(), 0.0, Matrix3::zeros());
    };
    let origin = Vector3::from(origin);
    let mut mass = Sum::<1>::default();
    let mut first = Sum::<3>::default();
    for ((centre, &m), _) in spheres() {
        mass.add([m]);
        first.add(((Vector3::from(*centre) - origin) * m).into());
    }
    let mass = mass.total()[0];
    if mass.is_nan() || mass <= 0.0 {
        return properties(origin, 0.0, Matrix3::zeros());
    }
    let mean = Vector3::from(first.total()) / mass;
    // The rounding error of the first moment about the mean.
    let mut rest = Sum::<3>::default();
    let mut second = Sum::<6>::default();
    for ((centre, &m), &own) in spheres() {
        let v = Vector3::from(*centre) - origin - mean;
        rest.add((v * m).into());
        // Half of the own inertia along each axis gives the full value about each.
        let own = 0.5 * own;
        second.add([
            m * v.x * v.x + own,
            m * v.y * v.y + own,
            m * v.z * v.z + own,
            m * v.x * v.y,
            m * v.x * v.z,
            m * v.y * v.z,
        ]);
    }
    let [xx, yy, zz, xy, xz, yz] = second.total();
    let second = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let centre = origin + (mean + Vector3::from(rest.total()) / mass);
    properties(centre, mass, second)
}

impl MassProperties {
    /// The inertia about the centre of mass along the axes of the input, kg m^2: a symmetric
    /// matrix.
    pub fn inertia_kg_m2(&self) -> [[f64; 3]; 3] {
        let [x, y, z, w] = self.axes;
        let turn = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
        let turn = turn.to_rotation_matrix();
        let turned = turn.matrix() * Matrix3::from_diagonal(&self.moments_kg_m2.into());
        let inertia = turned * turn.matrix().transpose();
        // Both halves are bitwise equal.
        [0, 1, 2].map(|row| [0, 1, 2].map(|k: usize| inertia[(row.max(k), row.min(k))]))
    }
}

/// From the second moments of the mass about the centre of mass, kg m^2: rows of a symmetric
/// matrix.
pub fn of_moments(centre_m: [f64; 3], mass_kg: f64, second_kg_m2: [[f64; 3]; 3]) -> MassProperties {
    // A symmetric matrix is the same by rows and by columns.
    properties(centre_m.into(), mass_kg, Matrix3::from(second_kg_m2))
}

fn properties(centre: Vector3<f64>, mass_kg: f64, second: Matrix3<f64>) -> MassProperties {
    let mut inertia = Matrix3::from_diagonal_element(second.trace()) - second;
    let least = ROUNDING * inertia.trace().abs();
    for (row, column) in [(0, 1), (0, 2), (1, 2)] {
        let mean = 0.5 * (inertia[(row, column)] + inertia[(column, row)]);
        let product = if mean.abs() > least { mean } else { 0.0 };
        inertia[(row, column)] = product;
        inertia[(column, row)] = product;
    }
    let (moments, axes) = principal(inertia);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let sign = 1.0_f64.copysign(turn.w);
    MassProperties {
        mass_kg,
        centre_m: centre.into(),
        moments_kg_m2: moments,
        axes: [turn.i, turn.j, turn.k, turn.w].map(|q| q * sign),
    }
}

/// The moments, ascending, and the axes as columns.
fn principal(inertia: Matrix3<f64>) -> ([f64; 3], Matrix3<f64>) {
    if !inertia.iter().all(|value| value.is_finite()) {
        return ([f64::NAN; 3], Matrix3::identity());
    }
    let eigen = SymmetricEigen::new(inertia);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let axis = |k: usize| {
        let v = eigen.eigenvectors.column(order[k]).normalize();
        v * 1.0_f64.copysign(v[v.iamax()])
    };
    let first = axis(0);
    let second = axis(1);
    let second = (second - first * first.dot(&second)).normalize();
    (
        order.map(|k| eigen.eigenvalues[k]),
        Matrix3::from_columns(&[first, second, first.cross(&second)]),
    )
}

/// Sums with compensation of rounding errors (Neumaier 1974).
struct Sum<const N: usize> {
    sum: [f64; N],
    lost: [f64; N],
}

impl<const N: usize> Default for Sum<N> {
    fn default() -> Self {
        Self {
            sum: [0.0; N],
            lost: [0.0; N],
        }
    }
}

impl<const N: usize> Sum<N> {
    fn add(&mut self, terms: [f64; N]) {
        for (k, term) in terms.into_iter().enumerate() {
            let old = self.sum[k];
            let new = old + term;
            self.lost[k] += if old.abs() >= term.abs() {
                (old - new) + term
            } else {
                (term - new) + old
            };
            self.sum[k] = new;
        }
    }

    fn total(&self) -> [f64; N] {
        std::array::from_fn(|k| self.sum[k] + self.lost[k])
    }
}
