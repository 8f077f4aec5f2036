//! The rotation that best maps one set of points onto another.

use nalgebra::{Matrix3, Matrix4, Quaternion, SymmetricEigen, UnitQuaternion, Vector3, Vector4};

/// Eigenvalues that differ by less than this fraction of the largest count as equal, and smaller
/// ones as zero.
const EQUAL: f64 = 1e-13;

/// Distances from a line below this fraction of the length are rounding.
const ON_A_LINE: f64 = 1e-14;

/// A pair of points, and its weight.
type Pair = (Vector3<f64>, Vector3<f64>, f64);

/// The rotation, unit quaternion x, y, z, w with w not negative, that maps the points `from` onto
/// the points `to` with the smallest weighted sum of squared distances.
///
/// Both sets hold one point per entry, in the same unit, and are centred by the caller: nothing is
/// shifted here. `weights`, none negative, are masses or ones. Entries without a counterpart are
/// ignored. Numbers that are not finite give no rotation: 0, 0, 0, 1.
///
/// Never a reflection. If several rotations are equally good (points on one line, or no points), it
/// is usually the one with the smallest angle.
///
/// Horn 1987 gives the start: the eigenvector of a symmetric 4 x 4 matrix. Newton steps on the
/// distances themselves then refine it to rounding, and a last rotation about the long axis does so
/// for points near a line.
pub fn best_rotation(from: &[[f64; 3]], to: &[[f64; 3]], weights: &[f64]) -> [f64; 4] {
    let pairs = || {
        let points = from.iter().zip(to).zip(weights);
        points.map(|((a, b), &weight)| (Vector3::from(*a), Vector3::from(*b), weight))
    };
    // The sum is not finite if any entry is not.
    let size: f64 = pairs()
        .map(|(a, b, weight)| (a.norm_squared() + b.norm_squared()) * weight)
        .sum();
    if !size.is_finite() {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let mut turn = horn(pairs());
    for _ in 0..2 {
        turn = newton(&turn, pairs()) * turn;
    }
    turn = twist(&turn, pairs()) * turn;
    let turn = turn.into_inner();
    let turn = turn / turn.norm();
    let sign = 1.0_f64.copysign(turn.w);
    [turn.i, turn.j, turn.k, turn.w].map(|q| q * sign)
}

/// The eigenvector of the largest eigenvalue; if several are equal, the part of their space nearest
/// to no rotation.
fn horn(pairs: impl Iterator<Item = Pair>) -> UnitQuaternion<f64> {
    let s: Matrix3<f64> = pairs.map(|(a, b, weight)| a * b.transpose() * weight).sum();
    let curl = Vector3::new(
        s[(1, 2)] - s[(2, 1)],
        s[(2, 0)] - s[(0, 2)],
        s[(0, 1)] - s[(1, 0)],
    );
    let mut k = Matrix4::zeros();
    let block = s + s.transpose() - Matrix3::from_diagonal_element(s.trace());
    k.fixed_view_mut::<3, 3>(0, 0).copy_from(&block);
    k.fixed_view_mut::<3, 1>(0, 3).copy_from(&curl);
    k.fixed_view_mut::<1, 3>(3, 0).copy_from(&curl.transpose());
    k[(3, 3)] = s.trace();
    let eigen = SymmetricEigen::new(k);
    let top = eigen.eigenvalues.imax();
    let least = eigen.eigenvalues[top] - EQUAL * eigen.eigenvalues.amax();
    let mut nearest = Vector4::zeros();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value >= least {
            nearest += vector * vector[3];
        }
    }
    let chosen = if nearest.norm() > 1e-6 {
        nearest
    } else {
        eigen.eigenvectors.column(top).into_owned()
    };
    UnitQuaternion::new_normalize(Quaternion::from(chosen))
}

/// The small rotation that minimises the distances of the rotated points from the others, where it
/// is determined.
fn newton(turn: &UnitQuaternion<f64>, pairs: impl Iterator<Item = Pair>) -> UnitQuaternion<f64> {
    let mut torque = Vector3::zeros();
    let mut stiffness = Matrix3::zeros();
    for (a, b, weight) in pairs {
        let a = turn * a;
        // The same as a x b, without the rounding errors of long arms.
        torque += a.cross(&(b - a)) * weight;
        let outer = a * b.transpose();
        stiffness += (Matrix3::from_diagonal_element(a.dot(&b))
            - (outer + outer.transpose()) * 0.5)
            * weight;
    }
    let eigen = SymmetricEigen::new(stiffness);
    let least = EQUAL * eigen.eigenvalues.amax();
    let mut step = Vector3::zeros();
    for (value, axis) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > least {
            step += axis * (axis.dot(&torque) / value);
        }
    }
    UnitQuaternion::from_scaled_axis(step)
}

/// The rotation about the long axis of the points that minimises the distances perpendicular to it.
fn twist(
    turn: &UnitQuaternion<f64>,
    pairs: impl Iterator<Item = Pair> + Clone,
) -> UnitQuaternion<f64> {
    let spread: Matrix3<f64> = pairs
        .clone()
        .map(|(_, b, weight)| b * b.transpose() * weight)
        .sum();
    let eigen = SymmetricEigen::new(spread);
    let axis = eigen
        .eigenvectors
        .column(eigen.eigenvalues.imax())
        .normalize();
    let (mut across, mut along, mut size) = (0.0, 0.0, 0.0);
    for (a, b, weight) in pairs {
        let a = turn * a;
        let (a, b) = (a - axis * axis.dot(&a), b - axis * axis.dot(&b));
        across += weight * axis.dot(&a.cross(&b));
        along += weight * a.dot(&b);
        size += weight * a.norm() * b.norm();
    }
    if size > ON_A_LINE * ON_A_LINE * spread.trace() {
        let angle: f64 = across.atan2(along);
        UnitQuaternion::from_scaled_axis(axis * angle)
    } else {
        UnitQuaternion::identity()
    }
}
