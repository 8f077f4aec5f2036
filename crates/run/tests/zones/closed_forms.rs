//! A beam clamped to a rigid block, and the fully bonded one.

use dem_engine::state::State;
use dem_engine::step::step;

use crate::clumps::{HEAD, block};
use crate::helpers::planned;

const SPHERES: i32 = 12;
const APART_M: f64 = 2e-3;

/// A bar along x, held at its first sphere, bonded up to this length, under its weight along -y.
fn bar(bonded_m: f64) -> State {
    let zone = format!(
        "bonded_within = {{ region = \"zone\" }}\n[regions.zone]\nbox = {{ min = [-1, -1, -1], max = [{bonded_m}, 1, 1] }}\n\
         [groups.foot]\nbody = \"bar\"\nparticles = [0]\n[supports.foot]\ngroup = \"foot\"\nfixed = true\n"
    );
    let text = block("bar", [SPHERES, 1, 1], APART_M, |_| Some(1e-3), "");
    planned(&format!("{HEAD}{text}{zone}").replace(
        "run.end_time = 1",
        "run = { end_time = 1, gravity = [0, -9.81, 0] }",
    ))
    .state
}

/// Brings everything to rest at each largest kinetic energy. A step after rest is a full one, not a
/// half: it must be well below the limit.
fn settle(state: &mut State) {
    state.time_step_s *= 0.3;
    let kinetic = |state: &State| {
        let free = 0..state.particles.free;
        free.map(|i| state.particles.kinetic_j(i, &state.particles.motions[i]))
            .sum::<f64>()
    };
    let mut before_j = 0.0;
    for _ in 0..400_000 {
        step(state);
        let now_j = kinetic(state);
        if now_j < before_j {
            for motion in &mut state.particles.motions {
                motion.velocity_m_s = [0.0; 3];
                motion.spin_rad_s = [0.0; 3];
            }
            for part in &mut state.rigid_parts.all {
                part.velocity_m_s = [0.0; 3];
                part.angular_momentum = [0.0; 3];
            }
            before_j = 0.0;
        } else {
            before_j = now_j;
        }
    }
}

/// Deflections, m: each bond is sheared by the weight beyond it and bent by the moment of that
/// weight about its middle. Bonds from `rigid_from` on do not deform.
fn deflections_m(state: &State, rigid_from: usize) -> Vec<f64> {
    let weight_n = 9.81 / state.particles.motions[1].inverse_mass;
    let (mut deflection_m, mut rotation) = (0.0, 0.0);
    let mut all = vec![0.0];
    for at in 0..SPHERES as usize - 1 {
        let k = state.bonds.stiffness(at);
        let half_m = 0.5 * APART_M;
        let beyond: Vec<f64> = (at + 1..SPHERES as usize)
            .map(|i| (i - at) as f64 * APART_M - half_m)
            .collect();
        let (shear_n, moment_n_m) = (
            weight_n * beyond.len() as f64,
            weight_n * beyond.iter().sum::<f64>(),
        );
        deflection_m += half_m * rotation;
        if at < rigid_from {
            deflection_m += shear_n / k.shear;
            rotation += moment_n_m / k.bending;
        }
        deflection_m += half_m * rotation;
        all.push(deflection_m);
    }
    all
}

#[test]
fn a_beam_clamped_to_a_rigid_block_bends_by_its_closed_form() {
    for (bonded_m, rigid_from) in [(0.0081, 5), (1.0, usize::MAX)] {
        let mut state = bar(bonded_m);
        let start: Vec<f64> = state.particles.poses.iter().map(|p| p.place().y).collect();
        let wanted = deflections_m(&state, rigid_from);
        settle(&mut state);
        for (i, wanted_m) in wanted.iter().enumerate().skip(1) {
            let found_m = start[i] - state.particles.poses[i].place().y;
            if i == 11 {
                eprintln!("rigid from bond {rigid_from}: tip {found_m:e} m, wanted {wanted_m:e} m");
            }
            assert!(
                (found_m / wanted_m - 1.0).abs() < 1e-4,
                "{i}: {found_m:e} {wanted_m:e}"
            );
        }
    }
}
