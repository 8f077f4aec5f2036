//! Momenta, kinetic energy and the balance as the zone moves.

use dem_engine::check::limit::limit;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, drift, exchange, interact};
use nalgebra::Vector3;

use super::{EVERYWHERE, NOWHERE, TOP, UPPER, disturb, flying, flying_text, rigid};
use crate::bars::reopen;
use crate::clumps::Whole;
use crate::helpers::planned;

fn whole(state: &State) -> Whole {
    Whole::of(&state.particles, 0..state.particles.free, &Vector3::zeros())
}

/// Goes on for some steps, and compares the momenta before and after each change of the parts.
/// Returns the number of changes, and the kinetic energy that they took, J.
fn changes(state: &mut State, steps: usize) -> (usize, f64) {
    let (mut count, mut lost_j) = (0, 0.0);
    for _ in 0..steps {
        interact(state);
        let (before, counted) = (whole(state), state.rigid_parts.clone());
        exchange(state);
        let parts = &state.rigid_parts;
        if [parts.released, parts.rejoined] != [counted.released, counted.rejoined] {
            count += 1;
            let after = whole(state);
            let size = before.momentum.norm();
            assert!((after.momentum - before.momentum).norm() < 1e-12 * size);
            let off = after.angular_momentum - before.angular_momentum;
            assert!(off.norm() < 1e-12 * size * 0.4, "{off:?}");
            let gained_j = after.kinetic_j - before.kinetic_j;
            if parts.rejoined == counted.rejoined {
                assert!(gained_j.abs() < 1e-12 * before.kinetic_j, "{gained_j}");
            }
            lost_j -= gained_j;
        }
        drift(state);
    }
    (count, lost_j)
}

#[test]
fn a_release_keeps_momenta_and_kinetic_energy() {
    let mut state = flying(TOP, "").state;
    let rigid_at_start = rigid(&state);
    assert!((20..40).contains(&rigid_at_start), "{rigid_at_start}");
    // Gravity turns the lump's way round: it falls out of the zone again.
    state.model.gravity_m_s2 = [0.0, 0.0, 30.0];
    let (count, lost_j) = changes(&mut state, 3000);
    assert!(count >= 2, "{count}");
    assert!(lost_j.abs() < 1e-12);
    let released = state.rigid_parts.released as usize;
    assert!(rigid(&state) < rigid_at_start && released > 0);
}

#[test]
fn spheres_join_again_and_what_they_lose_is_booked() {
    // The wall carries the zone off the lump.
    let rejoin =
        ", moves_with = \"blade\", rejoin = { strain_energy = 10, fluctuation_velocity = 0.5 }";
    let mut state = flying(UPPER, rejoin).state;
    disturb(&mut state, 0.05);
    reopen(&mut state);
    // The fastest motions have the error of leapfrog, (w dt)^2/4 of their energy.
    state.time_step_s *= 0.05;
    let start = rigid(&state);
    let (count, lost_j) = changes(&mut state, 80_000);
    assert!(count > 1 && state.rigid_parts.rejoined > 10, "{count}");
    assert!(rigid(&state) > start);
    interact(&mut state);
    let balance = balance(&mut state);
    let booked_j = balance.rejoining_loss_j;
    eprintln!(
        "{count} changes, {} rejoined, lost {lost_j:e} J, booked {booked_j:e} J, error {:e} J, momenta {:e} {:e}",
        state.rigid_parts.rejoined,
        balance.energy_error_j,
        balance.momentum_error,
        balance.angular_momentum_error
    );
    // The books are of the velocities at the time of the positions; `lost_j` is half a step later.
    assert!(lost_j > 0.0 && booked_j > 0.0);
    assert!(balance.energy_error_j.abs() < 0.01 * booked_j);
    // The centre of the part is rounded in each of 80,000 steps, by up to 3e-17 m of 0.3 m, mostly
    // to the same side; the momenta refer to a few mm. A clump has the same error.
    let rounding = 80_000.0 * 3e-17 / 5e-3;
    assert!(balance.momentum_error < 1e-12 && balance.angular_momentum_error < rounding);
}

#[test]
fn a_sphere_that_is_not_quiet_stays_bonded() {
    let rejoin = ", rejoin = { strain_energy = 1, fluctuation_velocity = 1e-6 }";
    let mut state = flying(TOP, rejoin).state;
    disturb(&mut state, 0.05);
    // Nothing is in the zone any more.
    let nowhere = flying(NOWHERE, rejoin).state;
    state.model.rules.clone_from(&nowhere.model.rules);
    let start = rigid(&state);
    changes(&mut state, 1000);
    assert_eq!((rigid(&state), state.rigid_parts.rejoined), (start, 0));
}

#[test]
fn the_energy_of_a_part_that_is_torn_at_its_border_balances() {
    // The bonds across the border break, as a load pulls the bonded layer off.
    let elastic = "young_modulus = 1e9, poisson_ratio = 0.25";
    let weak = format!("{elastic}, failure = {{ tensile_strength = 1e4 }}");
    let pulls = "[groups.top]\nbody = \"lump\"\nbox = { min = [-9, -9, 0.3031], max = [9, 9, 9] }\n\
                 [loads.top]\ngroup = \"top\"\nforce = [0, 0, 2]\n";
    let torn = |zone| {
        let text = flying_text(zone, "").replacen(elastic, &weak, 1);
        let mut state = planned(&format!("{text}{pulls}")).state;
        let mut worst = 0.0_f64;
        for _ in 0..4000 {
            interact(&mut state);
            worst = worst.max(balance(&mut state).energy_error.abs());
            advance(&mut state);
        }
        let balance = balance(&mut state);
        assert!(balance.momentum_error < 1e-11 && balance.angular_momentum_error < 1e-11);
        (worst, state.broken_count)
    };
    let ((part, broken), (bonded, _)) = (torn(TOP), torn(EVERYWHERE));
    eprintln!("{broken} broken, {part:e}; all bonded {bonded:e}");
    assert!(broken > 17);
    assert!(part < 2.0 * bonded, "{part:e} {bonded:e}");
}

#[test]
fn the_limit_is_that_of_the_bonded_body_and_stable() {
    let whole_s = limit(&mut flying(EVERYWHERE, "").state).step_s;
    let mut state = flying(TOP, "").state;
    assert_eq!(limit(&mut state).step_s, whole_s);
    disturb(&mut state, 1e-3);
    let mut worst = 0.0_f64;
    for _ in 0..20_000 {
        interact(&mut state);
        worst = worst.max(balance(&mut state).energy_error.abs());
        advance(&mut state);
    }
    eprintln!("{worst:e}");
    assert!(worst < 1e-3, "{worst}");
}
