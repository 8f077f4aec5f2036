//! The data of a break, and the absence of later effects.

use std::sync::Arc;

use dem_engine::stages::ledger::totals::synchronous_motions;
use dem_engine::state::State;
use dem_engine::state::particles::{Motion, Particles, Wrench};
use dem_engine::step::{advance, interact, step};
use dem_physics::bond::failure::Cause;

use super::bodies::{
    ALL, LENGTH_M, NORMAL, RADIUS_M, STRENGTH_PA, YOUNG_PA, area_m2, bonded, on_one_thread, rod,
};

/// Two spheres fly apart fast enough to break their bond, with a little rotation and shear.
fn flying_apart(incremental: bool) -> State {
    let mut state = rod(1, NORMAL, incremental);
    let m = 1.0 / state.particles.motions[0].inverse_mass;
    let k = state.bonds.normal(0);
    // Twice the speed that the bond can resist.
    let force = STRENGTH_PA * area_m2();
    let speed = 2.0 * force / (0.5 * m * k).sqrt();
    for (motion, sign) in state.particles.motions.iter_mut().zip([-0.5, 0.5]) {
        motion.velocity_m_s = [sign * speed + 0.1, 0.1 * sign * speed, 0.02];
        motion.spin_rad_s = [sign * 0.3, 0.1, -0.2 * sign];
    }
    state
}

#[test]
fn an_event_tells_step_place_ends_cause_and_energy() {
    on_one_thread(|| {
        for incremental in [false, true] {
            let mut state = flying_apart(incremental);
            let first = loop {
                let before = state.clone();
                interact(&mut state);
                if let Some(&first) = state.scratch.events.broken.first() {
                    assert_eq!(state.scratch.events.broken.len(), 1);
                    assert_eq!(state.broken_count, 1);
                    assert_eq!(state.broken_by_cause.of(Cause::Tension), 1);
                    // The bond before the break: with the increments of this step, for which the
                    // forces must be computed again without strength.
                    let mut whole = before;
                    Arc::make_mut(&mut whole.bonds.rules)[0].criteria = None;
                    interact(&mut whole);
                    let forces = whole.bonds.forces(0, &whole.particles.poses);
                    assert_eq!(first.released_j, forces.energy.total());
                    assert!(first.released_j > 0.0);
                    break first;
                }
                advance(&mut state);
                assert!(state.steps < 1000, "does not break");
            };
            assert_eq!(first.cause, Cause::Tension);
            assert_eq!(state.bonds.ends[first.bond as usize], [0, 1]);
            let [a, b] = [0, 1].map(|i| state.particles.poses[i].place());
            assert_eq!(first.place_m, <[f64; 3]>::from(0.5 * (a + b)));
            assert!(
                (state.time_s - state.steps as f64 * state.time_step_s).abs()
                    < 1e-12 * state.time_s
            );
            advance(&mut state);
            interact(&mut state);
            assert!(
                state.scratch.events.broken.is_empty(),
                "an event is told twice"
            );
            assert_eq!(state.broken_count, 1);
        }
    });
}

/// After the break the ends move straight on, also when they are driven into each other and out
/// again, and are turned over.
#[test]
fn a_broken_bond_never_acts_again() {
    on_one_thread(|| {
        for incremental in [false, true] {
            let mut state = flying_apart(incremental);
            while state.broken_count == 0 {
                step(&mut state);
                assert!(state.steps < 1000, "does not break");
            }
            for reverse in [false, true] {
                if reverse {
                    for motion in &mut state.particles.motions {
                        motion.velocity_m_s = motion.velocity_m_s.map(|v| -v);
                        motion.spin_rad_s = motion.spin_rad_s.map(|w| 1e4 * w);
                    }
                }
                let motions: Vec<Motion> = state.particles.motions.clone();
                for _ in 0..2000 {
                    interact(&mut state);
                    assert_eq!(state.particles.wrenches, [Wrench::default(); 2]);
                    assert_eq!(state.particles.motions, motions);
                    assert!(state.scratch.events.broken.is_empty());
                    advance(&mut state);
                }
            }
            assert_eq!(state.broken_count, 1);
        }
    });
}

/// The ends of a bond get half of the bond's kick in the step of its break: so momentum and the
/// velocities at the time of the break are those of the bonded pair.
#[test]
fn the_break_comes_in_the_middle_of_the_kick() {
    on_one_thread(|| {
        for incremental in [false, true] {
            let mut state = flying_apart(incremental);
            let mut whole = state.clone();
            Arc::make_mut(&mut whole.bonds.rules)[0].criteria = None;
            loop {
                interact(&mut state);
                interact(&mut whole);
                if state.broken_count > 0 {
                    break;
                }
                advance(&mut state);
                advance(&mut whole);
            }
            let at_break = [&state, &whole].map(synchronous_motions);
            for (a, b) in at_break[0].iter().zip(&at_break[1]) {
                for k in 0..3 {
                    assert!((a.velocity_m_s[k] - b.velocity_m_s[k]).abs() < 1e-14);
                    assert!((a.spin_rad_s[k] - b.spin_rad_s[k]).abs() < 1e-11);
                }
            }
        }
    });
}

/// A block of 4 x 4 x 4 spheres at rest, whose bonds break at a strain of 1e-8: removing half of
/// the bonds has no effect.
#[test]
fn taking_bonds_from_an_unloaded_body_breaks_nothing() {
    on_one_thread(|| {
        for incremental in [false, true] {
            let mut particles = Particles::default();
            let place = |i: u32| [i / 16, i / 4 % 4, i % 4].map(|k| 0.9 * LENGTH_M * f64::from(k));
            for i in 0..64 {
                particles.push_sphere(place(i), RADIUS_M, 2500.0);
            }
            let mut pairs = Vec::new();
            for a in 0..64_u32 {
                for b in a + 1..64 {
                    let apart: f64 = (0..3).map(|k| (place(a)[k] - place(b)[k]).powi(2)).sum();
                    if apart.sqrt() < 1.5 * LENGTH_M {
                        pairs.push([a, b]);
                    }
                }
            }
            let mut weak = ALL;
            let strength = 1e-8 * YOUNG_PA;
            (weak.tensile_strength_pa, weak.compressive_strength_pa) = (strength, strength);
            (weak.shear_strength_pa, weak.von_mises_strength_pa) = (strength, strength);
            let mut state = bonded(particles, &pairs, weak, incremental);
            let start = state.particles.poses.clone();
            for at in (0..pairs.len()).step_by(2) {
                state.bonds.set_broken(at);
            }
            for _ in 0..1000 {
                step(&mut state);
            }
            assert_eq!(state.broken_count, 0);
            for (pose, start) in state.particles.poses.iter().zip(&start) {
                assert!((pose.place() - start.place()).norm() < 1e-15);
            }
        }
    });
}
