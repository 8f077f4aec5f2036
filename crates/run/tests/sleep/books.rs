//! The balances of energy and momentum stay closed during sleep.

use dem_engine::Balance;
use dem_engine::stages::ledger::bookkeeping::{balance, opened};
use dem_engine::state::State;
use dem_engine::step::{advance, interact};

use super::{CLUMP, GROUND, SLEEP, ball, head, slab, sleep, started};

/// Bodies that land, sleep, and are later hit by a falling ball.
fn scene() -> String {
    let clump = slab("clump", [0.0, 0.0, 1e-4], CLUMP);
    let cluster = slab("cluster", [1e-3, 0.0, 2.2e-3], "");
    let ball = ball("ball", [-2.44e-3, 1e-3, 6e-3], "velocity = [0.06, 0, 0.25]");
    format!("{}{clump}{cluster}{ball}{GROUND}", head(0.0))
}

fn look(state: &mut State) -> Balance {
    interact(state);
    let found = balance(state);
    advance(state);
    found
}

fn errors(balance: &Balance) -> [f64; 3] {
    [
        balance.energy_error,
        balance.momentum_error,
        balance.angular_momentum_error,
    ]
    .map(f64::abs)
}

/// The largest errors on the way, the numbers of bodies that fell asleep and woke, and the lost
/// kinetic energy.
fn follow(asks: &str, until_s: f64) -> ([f64; 3], [u32; 2], f64) {
    let mut state = started(&format!("{}{asks}", scene()));
    let mass_kg = state.ledger.mass_kg();
    let (mut worst, mut counts, mut all_lost_j) = ([0.0_f64; 3], [0; 2], 0.0);
    let mut before: Option<Balance> = None;
    while state.time_s < until_s {
        let now = look(&mut state);
        for (worst, error) in worst.iter_mut().zip(errors(&now)) {
            *worst = worst.max(error);
        }
        if let Some(before) = before.take() {
            // The first balance without the motion of the bodies that fell asleep.
            let lost_j = before.flow_energy_j - now.flow_energy_j;
            all_lost_j += lost_j;
            let jump_j = (now.energy_error_j - before.energy_error_j).abs();
            eprintln!(
                "at {:.4} s: lost {lost_j:.2e} J, off by {jump_j:.1e} J",
                state.time_s
            );
            assert!(lost_j > 0.0);
            assert!(jump_j < 1e-3 * lost_j + 1e-13 * now.energy_scale_j);
        }
        for news in &state.scratch.events.sleep {
            counts[usize::from(news.kind == "awake")] += 1;
            if news.kind == "asleep" {
                before = Some(now);
            }
        }
    }
    assert_eq!(state.ledger.mass_kg().to_bits(), mass_kg.to_bits());
    (worst, counts, all_lost_j)
}

#[test]
fn what_falls_asleep_is_booked() {
    let mut awake = started(&scene());
    let mut worst_awake = 0.0_f64;
    while awake.time_s < 0.12 {
        worst_awake = worst_awake.max(look(&mut awake).energy_error.abs());
    }
    let (worst, [slept, woke], lost_j) = follow(SLEEP, 0.12);
    eprintln!("{slept} slept, {woke} woke, lost {lost_j:.1e} J; {worst:?}, {worst_awake:e} awake");
    assert!(slept >= 1 && woke >= 1, "{slept} {woke}");
    assert!(worst[0] < 1.1 * worst_awake);
    assert!(worst[1] < 1e-10 && worst[2] < 1e-10, "{worst:?}");
    // So fast that much is lost, also in the air.
    let (worst, [slept, woke], lost_j) = follow("[sleep]\nspeed = 0.05\nafter = 1e-4\n", 0.12);
    eprintln!("{slept} slept, {woke} woke, lost {lost_j:.1e} J; {worst:?}");
    assert!(slept >= 1 && woke >= 1, "{slept} {woke}");
    assert!(lost_j > 1e-9, "{lost_j:e}");
    assert!(worst[0] < 1.1 * worst_awake);
    assert!(worst[1] < 1e-10 && worst[2] < 1e-10, "{worst:?}");
}

#[test]
fn damping_of_bonds_is_booked_until_the_motion_stops() {
    let text = head(0.0).replace("run.end_time = 1", "run.end_time = 1\nrun.time_step = 1e-8");
    let swinging = slab("swinging", [0.0, 0.0, 1e-3], "");
    let asks = "[sleep]\nspeed = 0.05\nafter = 5e-7\n";
    let mut state = started(&format!("{text}{swinging}{GROUND}{asks}"));
    for (i, along) in [(0, 0.02), (1, -0.02)] {
        state.particles.motions[i].velocity_m_s = [along, 0.0, 0.0];
    }
    state.ledger = opened(&state);
    let mut before = look(&mut state);
    while sleep(&state).bodies == 0 {
        before = look(&mut state);
    }
    assert_eq!(state.steps, 101);
    let after = look(&mut state);
    let lost_j = before.kinetic_j - after.kinetic_j;
    assert!(after.kinetic_j == 0.0 && after.bond_damping_j > before.bond_damping_j);
    // Its effect in half a step is about 1e-4 of the motion.
    let jump_j = (after.energy_error_j - before.energy_error_j).abs();
    eprintln!("lost {lost_j:.2e} J, off by {jump_j:.1e} J");
    assert!(jump_j < 1e-6 * lost_j, "{jump_j:e}");
}
