//! Viscous forces of damped bonds on the particles, from the velocities half a step ago.

use nalgebra::Vector3;

use crate::physics::bond::damping::{
    DampingCoefficients, DampingForces, EndMotion, damping_forces,
};
use crate::state::bonds::Bonds;
use crate::state::particles::{Motion, Pose, Wrench};
use crate::state::shares::{Batch, Share, Which};

/// Sets `resisting` (one for each particle) to the damping forces of the bonds.
pub fn damping_wrenches(
    bonds: &Bonds,
    poses: &[Pose],
    motions: &[Motion],
    shares: &[Share],
    resisting: &mut [Wrench],
) {
    match shares {
        [] => {}
        [share] => of_share(bonds, poses, motions, share, resisting),
        _ => {
            let (left, right) = shares.split_at(shares.len() / 2);
            let count = right[0].particles.start - left[0].particles.start;
            let (of_left, of_right) = resisting.split_at_mut(count);
            rayon::join(
                || damping_wrenches(bonds, poses, motions, left, of_left),
                || damping_wrenches(bonds, poses, motions, right, of_right),
            );
        }
    }
}

fn of_share(
    bonds: &Bonds,
    poses: &[Pose],
    motions: &[Motion],
    share: &Share,
    resisting: &mut [Wrench],
) {
    resisting.fill(Wrench::default());
    let own = &share.particles;
    let mut add = |at: usize| {
        let [a, b] = bonds.ends[at].map(|end| end as usize);
        let forces = of_bond(bonds, at, poses, motions);
        if own.contains(&a) {
            resisting[a - own.start].add(&-forces.force_on_b, &forces.torques[0]);
        }
        if own.contains(&b) {
            resisting[b - own.start].add(&forces.force_on_b, &forces.torques[1]);
        }
    };
    for Batch { rule, which } in &share.batches {
        if !bonds.rules[*rule].damped {
            continue;
        }
        match which {
            Which::Border(list) => list.iter().for_each(|&at| add(at as usize)),
            Which::Run(range) => range.clone().for_each(&mut add),
        }
    }
}

fn of_bond(bonds: &Bonds, at: usize, poses: &[Pose], motions: &[Motion]) -> DampingForces {
    let [a, b] = bonds.ends[at].map(|end| end as usize);
    let apart = poses[b].place() - poses[a].place();
    let length = apart.norm();
    let [normal, shear, torsion, bending] = bonds.damping[at];
    let coefficients = DampingCoefficients {
        normal,
        shear,
        torsion,
        bending,
    };
    let levers = [bonds.levers_m[0][at], bonds.levers_m[1][at]];
    let ends = [a, b].map(|end| EndMotion {
        velocity_m_s: Vector3::from(motions[end].velocity_m_s),
        spin_rad_s: Vector3::from(motions[end].spin_rad_s),
    });
    damping_forces(&coefficients, &levers, &(apart / length), length, &ends)
}
