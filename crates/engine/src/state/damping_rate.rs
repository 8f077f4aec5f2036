//! How fast the dashpots of bonds can slow particles down: at most by a bound that follows from the
//! dashpots of each particle, and at most as fast as the plan found for the whole bodies
//! ([`crate::check::limit::damping_bound_1_s`]). Bonds that break only lower it.

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::bonds::{BondRule, Bonds};
use super::particles::{Motion, Particles};

/// Bonds may become longer by so much, and change their directions as much, before the rate is
/// found again.
pub(crate) const MORE: f64 = 1.05;

/// An upper bound of the largest eigenvalue of the damping of bonds over mass, 1/s; 0 without any.
/// Structural damping counts with the largest coefficients that it can have. For two ends joined by
/// a dashpot, (u_a - u_b)^2 <= 2 u_a^2 + 2 u_b^2: so it is that of the particle that twice its own
/// dashpots, to ends at rest, slow down most.
pub(crate) fn damping_rate_1_s(bonds: &Bonds, particles: &Particles) -> f64 {
    if !bonds.rules.iter().any(BondRule::is_damped) {
        return 0.0;
    }
    let mut resistances = vec![Matrix6::zeros(); particles.free];
    for (at, ends) in bonds.ends.iter().enumerate() {
        let damping = &largest_coefficients(bonds, at, particles);
        let levers_m = bonds.levers_m(at);
        let [a, b] = ends.map(|end| &particles.poses[end as usize]);
        let apart = b.place() - a.place();
        let longer = MORE * apart.norm() / (levers_m[0] + levers_m[1]);
        let arms_m = [longer * levers_m[0], -longer * levers_m[1]];
        let direction = apart.normalize();
        for (end, arm_m) in ends.iter().zip(arms_m) {
            let motion = &particles.motions[*end as usize];
            resistances[*end as usize] += 2.0 * resistance_1_s(damping, &direction, arm_m, motion);
        }
    }
    MORE * (resistances.iter().map(largest_eigenvalue)).fold(0.0, f64::max)
}

/// Largest coefficients of damping of bond `at`, mode by mode.
pub(crate) fn largest_coefficients(bonds: &Bonds, at: usize, particles: &Particles) -> [f64; 4] {
    let undamaged = bonds.undamaged_stiffness(at);
    let structural = bonds.structural_damping(at, undamaged, &particles.motions);
    let largest = structural.map(|structural| structural.largest_coefficients());
    bonds.damping_with(at, largest.unwrap_or_default())
}

/// Resistance of a dashpot in this direction, with coefficients mode by mode, to the motion of an
/// end that is at this distance before the contact point, or beyond it if negative: over mass and
/// inertia, of velocities times the root of the mass and spins times that of the inertia.
fn resistance_1_s(
    damping: &[f64; 4],
    direction: &Vector3<f64>,
    arm_m: f64,
    motion: &Motion,
) -> Matrix6<f64> {
    let [normal, shear, torsion, bending] = *damping;
    let [per_mass, per_inertia] = [motion.inverse_mass, motion.inverse_inertia];
    let along = direction * direction.transpose();
    let across = Matrix3::identity() - along;
    let moving = (along * normal + across * shear) * per_mass;
    let bending = bending + shear * arm_m * arm_m;
    let turning = (along * torsion + across * bending) * per_inertia;
    let both = direction.cross_matrix() * (shear * arm_m * (per_mass * per_inertia).sqrt());
    let mut all = Matrix6::zeros();
    all.fixed_view_mut::<3, 3>(0, 0).copy_from(&moving);
    all.fixed_view_mut::<3, 3>(0, 3).copy_from(&-both);
    all.fixed_view_mut::<3, 3>(3, 0).copy_from(&both);
    all.fixed_view_mut::<3, 3>(3, 3).copy_from(&turning);
    all
}

/// That of a positive semidefinite matrix A, or more by up to 6 %: (|A^16|)^(1/16).
fn largest_eigenvalue(matrix: &Matrix6<f64>) -> f64 {
    let trace = matrix.trace();
    if trace <= 0.0 {
        return 0.0;
    }
    let mut power = matrix / trace;
    for _ in 0..4 {
        power *= power;
    }
    trace * power.norm().powf(1.0 / 16.0)
}
