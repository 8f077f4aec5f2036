//! Many wet spheres: momenta, energy, threads and checkpoints.

use std::fmt::Write;

use dem_engine::stages::ledger::totals::momenta;
use dem_engine::state::State;
use dem_engine::state::bridges::Bridges;
use nalgebra::Vector3;
use proptest::prelude::*;

use super::{RADIUS_M, WATER, ball, bridges, head, started, step_and_balance};
use dem_testing::Random;

/// Number of spheres along an edge of the cloud.
const EDGE: i32 = 4;

/// Spheres on a jittered grid that fly into each other.
fn cloud(seed: u64, restitution: f64, more: &str) -> State {
    let mut random = Random(seed);
    let mut text = head(1.0, restitution, more);
    for (n, k) in (0..EDGE.pow(3)).enumerate() {
        let at = [k % EDGE, k / EDGE % EDGE, k / EDGE / EDGE];
        let centre = at.map(|i| f64::from(i) - 0.5 * f64::from(EDGE - 1));
        let jitter = random.point(0.02 * RADIUS_M);
        let place = [0, 1, 2].map(|k| 2.1 * RADIUS_M * centre[k] + jitter[k]);
        let own = random.point(0.02);
        let velocity = [0, 1, 2].map(|k| own[k] - 0.1 * centre[k]);
        write!(text, "{}", ball(&format!("b{n}"), place, velocity)).unwrap();
    }
    started(&text)
}

fn bits(state: &State) -> Vec<u64> {
    let p = &state.particles;
    let poses = p.poses.iter().flat_map(|pose| pose.position_m);
    let motions = p.motions.iter().flat_map(|motion| motion.velocity_m_s);
    let gaps = bridges(state).pairs.iter().map(|bridge| bridge.gap_m);
    let all = poses
        .chain(motions)
        .chain(gaps)
        .chain([bridges(state).lost_j]);
    all.map(f64::to_bits).collect()
}

#[test]
fn the_bits_do_not_depend_on_the_partitions() {
    let mut one = cloud(1, 0.5, "");
    let mut other = one.clone();
    let contacts = other.contacts.as_mut().unwrap();
    contacts.divide(other.particles.len(), 7);
    for _ in 0..3000 {
        step_and_balance(&mut one);
        step_and_balance(&mut other);
    }
    let [formed, ruptured] = bridges(&one).formed_and_ruptured;
    assert!(formed > 50 && ruptured > 0, "{formed} {ruptured}");
    assert_eq!(bits(&one), bits(&other));
}

#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let after = |threads: usize| {
        crate::bars::with_threads(threads, || {
            let mut state = cloud(2, 0.5, "");
            for _ in 0..2000 {
                step_and_balance(&mut state);
            }
            bits(&state)
        })
    };
    assert_eq!(after(1), after(3));
}

#[test]
fn a_checkpoint_keeps_the_bridges() {
    let mut state = cloud(3, 0.5, "");
    while bridges(&state).pairs.len() < 30 {
        step_and_balance(&mut state);
    }
    let saved = postcard::to_stdvec(&state).unwrap();
    let resumed: State = postcard::from_bytes(&saved).unwrap();
    let mut resumed = resumed
        .rebuilt(state.model.clone(), &state.scratch)
        .unwrap();
    assert_eq!(resumed.bridges, state.bridges);
    for _ in 0..1000 {
        step_and_balance(&mut state);
        step_and_balance(&mut resumed);
    }
    assert_eq!(bits(&state), bits(&resumed));
}

/// Momentum, angular momentum and energy, for any cloud.
fn kept(seed: u64, restitution: f64) {
    let mut state = cloud(seed, restitution, "safety_factor = 0.3");
    let zero = [0.0; 3];
    let now = |state: &State| momenta(&state.particles, &state.clumps, zero);
    let ([momentum, angular], scales) = now(&state);
    let (mut error, mut step_m) = (0.0_f64, 0.0_f64);
    for _ in 0..3000 {
        let balance = step_and_balance(&mut state);
        error = error.max(balance.energy_error.abs());
        assert!(balance.momentum_error < 1e-12 && balance.angular_momentum_error < 1e-12);
        step_m = step_m.max(2.0 * state.fastest_m_s * state.time_step_s);
    }
    // Each rupture takes the work of a bridge; where one begins and ends is off by up to a step.
    let Bridges {
        formed_and_ruptured: [formed, ruptured],
        lost_j,
        ..
    } = *bridges(&state);
    assert!(formed > 20, "{formed}");
    let ends_j = (formed + ruptured) as f64 * WATER.largest_n(0.5 * RADIUS_M) * step_m;
    let work_j = ruptured as f64 * WATER.work_j(0.5 * RADIUS_M);
    assert!(
        (lost_j - work_j).abs() < ends_j,
        "{lost_j:e} {work_j:e} {ends_j:e}"
    );
    let ([after, turned], _) = now(&state);
    let off = |a: [f64; 3], b: [f64; 3]| (Vector3::from(a) - Vector3::from(b)).norm();
    assert!(off(after, momentum) < 1e-12 * scales[0]);
    assert!(off(turned, angular) < 1e-12 * scales[1]);
    assert!(error < 1e-2, "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]

    #[test]
    fn momenta_are_kept_and_the_books_close(seed in 0_u64..1 << 32, restitution in 0.3_f64..1.0) {
        kept(seed, restitution);
    }
}
