//! How fast the dashpots of bonds can slow particles down.

use super::bonds::Bonds;
use super::particles::Particles;

/// Bonds may become longer by so much before the rate is found again.
const LONGER: f64 = 1.05;

/// An upper bound of the largest eigenvalue of the viscous damping of bonds over mass, 1/s; 0
/// without any. For two ends joined by a dashpot, (u_a - u_b)^2 <= 2 u_a^2 + 2 u_b^2: so the bound
/// for each end is twice the sum of its bonds, each in the mode that slows it down most.
pub(crate) fn damping_rate_1_s(bonds: &Bonds, particles: &Particles) -> f64 {
    if bonds.damping.is_empty() {
        return 0.0;
    }
    let mut rates_1_s = vec![0.0_f64; particles.free];
    for (at, (ends, damping)) in bonds.ends.iter().zip(&bonds.damping).enumerate() {
        let [normal, shear, torsion, bending] = *damping;
        let [a, b] = ends.map(|end| &particles.poses[end as usize]);
        let levers_m = bonds.levers_m(at);
        let length_m = (b.place() - a.place()).norm();
        let longer = LONGER * length_m / (levers_m[0] + levers_m[1]);
        for (end, lever_m) in ends.iter().zip(levers_m) {
            let motion = &particles.motions[*end as usize];
            let (per_mass, per_inertia) = (motion.inverse_mass, motion.inverse_inertia);
            let across = shear * (per_mass + per_inertia * (longer * lever_m).powi(2));
            let rate = (normal * per_mass)
                .max(across + bending * per_inertia)
                .max(torsion * per_inertia);
            rates_1_s[*end as usize] += 2.0 * rate;
        }
    }
    rates_1_s.into_iter().fold(0.0, f64::max)
}
