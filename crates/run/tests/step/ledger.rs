//! The ledger: all energy and momentum exchanged is recorded.

use crate::bars::{
    BAR_LIMIT_S, BondDamping, ELASTIC, Errors, bar, damp, damp_particles, law, orders, reopen, run,
    with_threads,
};
use dem_engine::state::State;
use dem_engine::state::bonds::BondRule;
use dem_engine::state::loads::GroupLoad;
use dem_engine::state::supports::GroupSupport;
use dem_engine::state::supports::HeldParticle;
use dem_physics::bond::stiffness::BondModel;
use dem_scene::{Factor, Hold};

/// Duration of a run, s: a multiple of all its step sizes. Changes happen at fractions of it.
const LENGTH: f64 = 300.0 * BAR_LIMIT_S;

fn load(particle: u32, factor: Factor) -> GroupLoad {
    GroupLoad {
        end_s: f64::INFINITY,
        particles: vec![particle, 7],
        force_n: [3e5, -2e6, 1e6],
        torque_n_m: [1e5, 5e4, -2e5],
        factor,
    }
}

fn support(particle: u32, holds: [Option<Hold>; 6], factor: Factor) -> GroupSupport {
    GroupSupport {
        end_s: f64::INFINITY,
        holds,
        factor,
        held: vec![HeldParticle {
            particle,
            ..HeldParticle::default()
        }],
    }
}

const CLAMP: [Option<Hold>; 6] = [Some(Hold::Fixed); 6];
const UNTIL: Factor = Factor::Ramp {
    until_s: LENGTH / 3.0,
};

fn table() -> Factor {
    let at = |fraction: f64, factor: f64| [fraction * LENGTH, factor];
    Factor::Table(vec![
        at(0.1, 0.2),
        at(0.4, 1.0),
        at(0.6, -0.7),
        at(0.9, 0.3),
    ])
}

/// A slow motion of the free bar: it drifts, tumbles and bends.
fn swing(state: &mut State) {
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        let x = (i as f64 - 5.0) / 5.0;
        motion.velocity_m_s = [5.0 + x, 20.0 * x + 4.0 * x * x, -10.0 * x + 2.0];
        motion.spin_rad_s = [10.0 + 3.0 * x, 5.0, 10.0 + 4.0 * x];
    }
    reopen(state);
}

type Change = fn(&mut State);

/// All possible changes of a bar, one after another.
fn smooth() -> Vec<(&'static str, Change)> {
    vec![
        ("alone", swing),
        ("constant load", |s| s.loads = vec![load(10, Factor::One)]),
        ("ramp", |s| s.loads = vec![load(10, UNTIL)]),
        ("table", |s| s.loads = vec![load(10, table())]),
        ("gravity", |s| {
            s.model.gravity_m_s2 = [30.0, -2000.0, 500.0];
            swing(s);
        }),
        ("clamp, load and gravity", |s| {
            s.supports = vec![support(0, CLAMP, Factor::One)];
            s.loads = vec![load(10, Factor::One)];
            s.model.gravity_m_s2 = [0.0, -2000.0, 0.0];
        }),
        ("clamp of a bar that moves", |s| {
            swing(s);
            s.supports = vec![support(0, CLAMP, Factor::One)];
        }),
        ("velocity", |s| {
            let mut holds = CLAMP;
            holds[1] = Some(Hold::Velocity(3.0));
            holds[3] = Some(Hold::Velocity(5.0));
            holds[2] = None;
            s.supports = vec![
                support(0, holds, Factor::One),
                support(
                    10,
                    [Some(Hold::Fixed), None, None, None, None, None],
                    Factor::One,
                ),
            ];
        }),
        ("velocity, ramp", |s| {
            let mut holds = [None; 6];
            holds[1] = Some(Hold::Velocity(3.0));
            holds[5] = Some(Hold::Velocity(-5.0));
            s.supports = vec![support(0, holds, UNTIL)];
            s.model.gravity_m_s2 = [0.0, -100.0, 300.0];
        }),
        ("displacement, ramp", |s| {
            let mut holds = CLAMP;
            holds[1] = Some(Hold::Displacement(0.02));
            holds[3] = Some(Hold::Displacement(0.02));
            s.supports = vec![support(0, holds, UNTIL), support(10, CLAMP, Factor::One)];
        }),
        ("displacement, table", |s| {
            let mut holds = [None; 6];
            holds[0] = Some(Hold::Displacement(0.002));
            holds[4] = Some(Hold::Displacement(0.01));
            s.supports = vec![support(0, holds, table()), support(10, CLAMP, Factor::One)];
        }),
        ("Chen", |s| {
            swing(s);
            damp(s, BondDamping::Chen(0.1));
        }),
        ("Chen by mode", |s| {
            swing(s);
            damp(s, BondDamping::ChenByMode(0.1));
        }),
        ("Platzer", |s| {
            swing(s);
            damp(s, BondDamping::Platzer(0.1, 0.3));
        }),
        ("local damping", |s| {
            swing(s);
            damp_particles(s, 0.3);
        }),
        ("all", |s| {
            s.model.gravity_m_s2 = [30.0, -200.0, 50.0];
            swing(s);
            let mut holds = [None; 6];
            holds[1] = Some(Hold::Displacement(0.02));
            holds[3] = Some(Hold::Velocity(3.0));
            s.supports = vec![
                support(0, holds, UNTIL),
                support(
                    3,
                    [None, None, Some(Hold::Fixed), None, None, None],
                    Factor::One,
                ),
            ];
            s.loads = vec![load(10, Factor::One), load(5, table())];
            damp(s, BondDamping::ChenByMode(0.1));
        }),
    ]
}

fn errors(change: Change, incremental: bool, finer: u32) -> Errors {
    let rule = BondRule {
        law: law(incremental),
        ..ELASTIC
    };
    let mut state = bar(BondModel::Timoshenko, rule, BAR_LIMIT_S / f64::from(finer));
    change(&mut state);
    run(&mut state, 300 * u64::from(finer), 1)
}

/// Steps of a 10th, a 20th, a 40th and an 80th of the limit. Loads and supports change at times
/// that are steps of all of them.
#[test]
fn energy_error_falls_with_the_square_of_the_step_whatever_acts() {
    let mut failed = Vec::new();
    with_threads(1, || {
        for incremental in [false, true] {
            for (name, change) in smooth() {
                let runs = [10, 20, 40, 80].map(|finer| errors(change, incremental, finer));
                let orders = orders(&runs.map(|r| r.energy_j));
                let [momentum, angular] = [
                    runs.iter().map(|r| r.momentum).fold(0.0, f64::max),
                    runs.iter().map(|r| r.angular_momentum).fold(0.0, f64::max),
                ];
                eprintln!(
                    "{name}, {incremental}: {orders:.3?}, finest {:.1e}; {momentum:.1e} {angular:.1e}",
                    runs[3].energy
                );
                if orders[1..].iter().any(|o| (o - 2.0).abs() > 0.1)
                    || momentum > 1e-12
                    || angular > 1e-12
                {
                    failed.push(name);
                }
            }
        }
    });
    assert!(failed.is_empty(), "{failed:?}");
}
