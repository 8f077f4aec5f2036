//! Damping of bonds is of second order in the step, in a network and in a body that spins.

use crate::bars::{
    BondDamping, ELASTIC, bar, body, damp, law, random_spheres, shake, soft, spheres, steel, tumble,
};
use crate::clumps::{HEAD, block};
use crate::helpers::planned;
use dem_engine::check::limit::limit as step_limit;
use dem_engine::stages::bonds::damping::{ONE_STAGE, WEAK};
use dem_engine::stages::ledger::totals::kinetic_energy;
use dem_engine::state::State;
use dem_engine::state::bonds::BondRule;
use dem_engine::step::step;
use dem_physics::bond::stiffness::BondModel;
use dem_physics::chebyshev::{Chebyshev, limit};
use dem_physics::remembered::MOST;

/// Positions of all particles after `end_s`, in `steps` steps. Each has the stages for eigenvalues
/// up to `most`: the bound of damping that asks for them is higher than that of the bonds.
fn places(start: &State, end_s: f64, steps: u32, most: f64) -> Vec<f64> {
    let mut state = start.clone();
    state.time_step_s = end_s / f64::from(steps);
    let bound_1_s = 0.999 * most / state.time_step_s;
    assert!(
        bound_1_s > start.damping_rate_1_s,
        "too few stages: {bound_1_s} 1/s, {} 1/s",
        start.damping_rate_1_s
    );
    state.damping_rate_1_s = bound_1_s;
    for _ in 0..steps {
        step(&mut state);
    }
    let poses = state.particles.poses.iter();
    poses
        .flat_map(|pose| pose.position_m[..3].to_vec())
        .collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let square = |(a, b): (&f64, &f64)| (a - b) * (a - b);
    a.iter().zip(b).map(square).sum::<f64>().sqrt()
}

/// Half the step, a quarter of the difference to half the step: with one stage, without a mean and
/// with one, in steps short enough for it, with the fewest others and with more.
fn assert_second_order(name: &str, start: &State, end_s: f64, steps: u32) {
    let largest = end_s / f64::from(steps) * start.damping_rate_1_s;
    let fewest = Chebyshev::covering(largest.max(MOST)).others.len() + 1;
    let enough = |most: f64| (1.01 * end_s * start.damping_rate_1_s / most).ceil() as u32;
    // A mean of some three steps needs twice as many for the same next term of the error.
    for (stages, most, finer) in [
        ("one stage".to_owned(), WEAK, 1),
        ("one stage with a mean".to_owned(), ONE_STAGE, 2),
        ("one stage with a memory".to_owned(), MOST, 2),
        (format!("{fewest} stages"), limit(fewest), 1),
        (format!("{} stages", fewest + 1), limit(fewest + 1), 1),
        (format!("{} stages", fewest + 3), limit(fewest + 3), 1),
    ] {
        let steps = finer * steps.max(enough(most));
        let found = [1, 2, 4, 8].map(|finer| places(start, end_s, steps * finer, most));
        let errors: Vec<f64> = found
            .windows(2)
            .map(|two| apart(&two[0], &two[1]))
            .collect();
        let [first, last] = [0, 1].map(|n| (errors[n] / errors[n + 1]).log2());
        eprintln!("{name}, {stages}: {errors:?}: order {first:.3}, {last:.3}");
        let [first, last] = [first, last].map(|order| (order - 2.0).abs());
        assert!(first < 0.1 && last < 0.1, "{name}, {stages}: {errors:?}");
    }
}

/// 500 spheres with 2500 bonds, shaken, a bar that tumbles and vibrates, total and incremental.
#[test]
fn a_damped_network_is_of_second_order() {
    for (damping, end_s, steps) in [
        (BondDamping::Chen(0.1), 2e-5, 64),
        (BondDamping::Chen(0.5), 2e-5, 128),
        (BondDamping::Chen(10.0), 2.5e-6, 512),
        (BondDamping::ChenByMode(0.3), 2e-5, 64),
    ] {
        let (particles, pairs) = random_spheres();
        let bonding = soft(BondModel::Timoshenko, ELASTIC);
        let mut state = body(particles, &pairs, &bonding, 1e-9);
        damp(&mut state, damping);
        shake(&mut state, 0.1);
        assert_second_order(&format!("network, {damping:?}"), &state, end_s, steps);
    }
    for incremental in [false, true] {
        let rule = BondRule {
            law: law(incremental),
            ..ELASTIC
        };
        let mut state = bar(BondModel::Timoshenko, rule, 1e-9);
        damp(&mut state, BondDamping::Chen(0.2));
        tumble(&mut state);
        assert_second_order("tumbling bar", &state, 2e-3, 128);
    }
}

/// With one stage the largest stable step is that without damping: a shaken network comes to rest
/// below it, and what shakes it grows above it.
#[test]
fn one_stage_is_stable_up_to_the_undamped_limit() {
    let (particles, pairs) = random_spheres();
    let mut start = body(
        particles,
        &pairs,
        &soft(BondModel::Timoshenko, ELASTIC),
        1e-9,
    );
    shake(&mut start, 0.1);
    let limit_s = step_limit(&mut start).step_s;
    let kinetic_j =
        |state: &State| kinetic_energy(&state.particles, |i| state.particles.motions[i]);
    for most in [WEAK, ONE_STAGE, MOST] {
        damp(&mut start, BondDamping::Chen(0.01));
        let eta = 0.01 * 0.98 * most / (limit_s * start.damping_rate_1_s);
        damp(&mut start, BondDamping::Chen(eta));
        for (ratio, range) in [(0.99, 0.0..0.5), (1.01, 10.0..f64::INFINITY)] {
            let mut state = start.clone();
            state.time_step_s = ratio * limit_s;
            let largest = state.time_step_s * state.damping_rate_1_s;
            assert!(0.9 * most < largest && largest < most);
            for _ in 0..3000 {
                step(&mut state);
            }
            let left = kinetic_j(&state) / kinetic_j(&start);
            eprintln!("{ratio} of the limit, damping {largest}: {left}");
            assert!(range.contains(&left), "{ratio}, {most}: {left}");
        }
    }
}

/// Two spheres on a circle: once their vibration has decayed, what the dashpot carries of the load
/// that holds them there falls with the square of the step.
#[test]
fn dashpots_carry_no_load_on_a_circle() {
    let carried = [1e-5, 5e-6, 2.5e-6].map(|dt| {
        let (particles, pairs) = spheres(2);
        let bonding = steel(BondModel::Timoshenko, ELASTIC);
        let mut state = body(particles, &pairs, &bonding, dt);
        damp(&mut state, BondDamping::Chen(0.3));
        for (motion, pose) in (state.particles.motions.iter_mut()).zip(&state.particles.poses) {
            motion.spin_rad_s = [0.0, 0.0, 500.0];
            motion.velocity_m_s = [0.0, 500.0 * (pose.position_m[0] - 0.2), 0.0];
        }
        while state.time_s < 0.2 {
            step(&mut state);
        }
        let size = |[x, y, z, _]: [f64; 4]| (x * x + y * y + z * z).sqrt();
        let held = size(state.particles.wrenches[0].force_n);
        assert!(held > 1e6, "{held}");
        size(state.bond_resistance[0].force_n) / held
    });
    eprintln!("{carried:?}");
    for two in carried.windows(2) {
        assert!(two[1] < 0.28 * two[0], "{carried:?}");
    }
}

/// Ends that a support holds or moves, and spheres of rigid parts, move as these prescribe.
#[test]
fn damping_of_held_ends_and_of_rigid_parts_is_of_second_order() {
    let row = block("row", [8, 1, 1], 2e-3, |_| Some(1e-3), "");
    let head = HEAD
        .replace(
            "poisson_ratio = 0.25 }\n",
            "poisson_ratio = 0.25, damping = { damping_ratio = 0.3 } }\n",
        )
        .replace(
            "1e8, poisson_ratio = 0.25, damping = { damping_ratio = 0.3 } }",
            "1e8, poisson_ratio = 0.25 }",
        );
    let ends = "groups.foot = { body = \"row\", particles = [0] }
groups.head = { body = \"row\", particles = [7] }
initial.head = { group = \"head\", velocity = [0.1, 0.2, 0], angular_velocity = [50, 0, 30] }
";
    let moved = "supports.foot = { group = \"foot\", displacement = { y = 1e-5, rx = 1e-3 }, ramp = 1e-4 }\n";
    let fixed = "supports.foot = { group = \"foot\", fixed = true }\n";
    let zone = "bonded_within = { region = \"zone\" }\nregions.zone.box = { min = [-1, -1, -1], max = [7e-3, 1, 1] }\n";
    for (name, more) in [
        ("moved", [moved, ""]),
        ("fixed", [fixed, ""]),
        ("zone", ["", zone]),
    ] {
        let [support, zone] = more;
        let zone = zone.split_once('\n').unwrap_or_default();
        let state = planned(&format!(
            "{head}{}\n{ends}{support}{row}{}\n",
            zone.1, zone.0
        ))
        .state;
        assert_eq!(state.rigid_parts.is_empty(), name != "zone");
        assert_second_order(name, &state, 5e-5, 400);
    }
}
