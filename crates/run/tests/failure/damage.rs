//! Bonds with a fracture energy soften beyond their strength, and take that energy to break.

use std::f64::consts::PI;

use dem_engine::Balance;
use dem_engine::check::limit::limit;
use dem_engine::stages::ledger::bookkeeping::{balance, opened};
use dem_engine::state::State;
use dem_engine::state::bonds::{BondLaw, BondRule};
use dem_engine::state::particles::Particles;
use dem_engine::step::{advance, interact, step};
use dem_physics::bond::damage::{Damage, damage_at};
use dem_physics::bond::failure::Criteria;
use dem_physics::bond::stiffness::BondModel;
use dem_scene::{Factor, Hold};
use proptest::prelude::*;

use super::bodies::{NONE, RADIUS_M, area_m2, damp, hold, on_one_thread};
use crate::bars::{BondDamping, Bonding, ELASTIC, body};

const YOUNG_PA: f64 = 1e9;
const STRENGTH_PA: f64 = 1e6;
const TENSION: Criteria = Criteria {
    tensile_strength_pa: STRENGTH_PA,
    ..NONE
};

/// A row of spheres along x with this many bonds of this length and radius [`RADIUS_M`]. Its step
/// is half of the limit.
fn row(bonds: usize, length_m: f64, criteria: Criteria, fracture_energy_j_m2: f64) -> State {
    let mut particles = Particles::default();
    for i in 0..=bonds {
        particles.push_sphere([length_m * i as f64, 0.0, 0.0], 0.5 * length_m, 2500.0);
    }
    let pairs: Vec<[u32; 2]> = (0..bonds as u32).map(|i| [i, i + 1]).collect();
    let bonding = Bonding {
        radius_factor: RADIUS_M / (0.5 * length_m),
        model: BondModel::Timoshenko,
        young_modulus_pa: YOUNG_PA,
        rule: BondRule {
            criteria: Some(criteria),
            law: BondLaw::Softening {
                fracture_energy_j_m2,
            },
            ..ELASTIC
        },
    };
    let mut state = body(particles, &pairs, &bonding, 1e-9);
    state.bonds.histories.damages = (0..bonds)
        .map(|at| Damage::none(&state.bonds.stiffness(at), 1.0))
        .collect();
    state.time_step_s = 0.5 * limit(&mut state).step_s;
    state
}

/// Energy that bonds lost while they softened and when they broke, J.
fn spent_j(state: &mut State) -> f64 {
    let now = balance(state);
    now.bond_damage_j + now.bond_breakage_j
}

/// Fig. 7 c of Platzer 2022: up to the strength, down the line of softening, back to 0 on the
/// damaged line, pressed with the full stiffness, up again, and to the end.
#[test]
fn a_bond_follows_the_cycle_of_the_cohesive_zone() {
    on_one_thread(|| {
        let (length_m, energy_j_m2) = (2e-3, 40.0);
        let mut state = row(1, length_m, TENSION, energy_j_m2);
        let stiffness = state.bonds.stiffness(0).normal;
        let elastic_m = STRENGTH_PA * area_m2() / stiffness;
        let broken_m = 2.0 * energy_j_m2 / STRENGTH_PA;
        assert!((elastic_m - 2e-6).abs() < 1e-12 && broken_m > 30.0 * elastic_m);
        let strength_n = STRENGTH_PA * area_m2();
        let speed = elastic_m / (400.0 * state.time_step_s);
        hold(&mut state, std::iter::once(0), 0.0);
        hold(&mut state, std::iter::once(1), speed);
        // Forwards by 20, back by 23, forwards to the end, each turn within 50 steps.
        let (mut points, mut turn) = (vec![[0.0, 1.0]], 0.0);
        for (openings, sign) in [(20.0, 1.0), (23.0, -1.0)] {
            turn += 400.0 * openings;
            points.extend([[turn, sign], [turn + 50.0, -sign]]);
        }
        let dt = state.time_step_s;
        let points = points.into_iter().map(|[step, factor]| [step * dt, factor]);
        state.supports[1].factor = Factor::Table(points.collect());
        state.particles.motions[1].velocity_m_s[0] = speed;
        state.ledger = opened(&state);
        let (mut largest_m, mut checked) = (0.0_f64, [0; 4]);
        loop {
            interact(&mut state);
            let places = [0, 1].map(|end| state.particles.poses[end].place().x);
            let opening_m = places[1] - places[0] - length_m;
            if state.broken_count > 0 {
                assert!((opening_m - broken_m).abs() < 2.0 * speed * dt);
                break;
            }
            let is_new = opening_m > largest_m;
            largest_m = largest_m.max(opening_m);
            let damage = if largest_m < elastic_m {
                0.0
            } else {
                broken_m * (largest_m - elastic_m) / (largest_m * (broken_m - elastic_m))
            };
            let kept = if opening_m < 0.0 { 1.0 } else { 1.0 - damage };
            let expected_n = kept * stiffness * opening_m;
            let forces = state.bonds.forces(0, &state.particles.poses);
            let is_close = |force_n: f64| (force_n - expected_n).abs() < 1e-7 * strength_n;
            assert!(is_close(forces.load.normal_n), "{opening_m}");
            let on_end = -state.particles.wrenches[1].force_n[0];
            assert!(is_close(on_end), "{opening_m}: {on_end} N on the end");
            let phase = match (opening_m < 0.0, damage > 0.0, is_new) {
                (true, ..) => 0,
                (_, false, _) => 1,
                (_, true, false) => 2,
                (_, true, true) => 3,
            };
            checked[phase] += 1;
            advance(&mut state);
        }
        assert!(checked.into_iter().all(|count| count > 300), "{checked:?}");
        assert_eq!(state.broken_count, 1);
        let whole_j = energy_j_m2 * area_m2();
        let spent = spent_j(&mut state);
        assert!(
            (spent / whole_j - 1.0).abs() < 1e-3,
            "{spent} of {whole_j} J"
        );
        let error = balance(&mut state).energy_error;
        assert!(error.abs() < 1e-5, "{error}");
    });
}

#[test]
fn bonds_pulled_or_sheared_apart_take_their_fracture_energy() {
    on_one_thread(|| {
        let shear = Criteria {
            shear_strength_pa: STRENGTH_PA,
            ..NONE
        };
        let cohesion = Criteria {
            cohesion_pa: STRENGTH_PA,
            ..NONE
        };
        let von_mises = Criteria {
            von_mises_strength_pa: STRENGTH_PA,
            ..NONE
        };
        for (name, criteria, axis) in [
            ("tension", TENSION, 0),
            ("von Mises", von_mises, 0),
            ("shear", shear, 1),
            ("cohesion", cohesion, 1),
        ] {
            let energy_j_m2 = 20.0;
            let mut state = row(1, 2e-3, criteria, energy_j_m2);
            hold(&mut state, 0..2, 0.0);
            let speed = 2e-6 / (400.0 * state.time_step_s);
            hold(&mut state, std::iter::once(1), 0.0);
            state.supports[0].held.truncate(1);
            state.supports[1].holds[0] = Some(Hold::Fixed);
            state.supports[1].holds[axis] = Some(Hold::Velocity(speed));
            state.particles.motions[1].velocity_m_s[axis] = speed;
            state.ledger = opened(&state);
            for _ in 0..40_000 {
                interact(&mut state);
                if state.broken_count > 0 {
                    break;
                }
                advance(&mut state);
            }
            let whole_j = energy_j_m2 * area_m2();
            let spent = spent_j(&mut state);
            assert!(
                state.broken_count == 1 && (spent / whole_j - 1.0).abs() < 3e-3,
                "{name}: {spent} of {whole_j} J"
            );
        }
    });
}

/// A bar of the same length and section with 2, 4 and 8 bonds, one of them a little weaker.
#[test]
fn a_bar_takes_the_same_energy_at_any_resolution() {
    on_one_thread(|| {
        let energy_j_m2 = 40.0;
        for bonds in [2, 4, 8] {
            let mut state = row(bonds, 16e-3 / bonds as f64, TENSION, energy_j_m2);
            state.bonds.histories.damages[bonds / 2].strength_factor = 0.95;
            state.bonds.strength_factors = vec![1.0; bonds];
            state.bonds.strength_factors[bonds / 2] = 0.95;
            let speed = 0.004;
            hold(&mut state, std::iter::once(0), 0.0);
            hold(&mut state, std::iter::once(bonds as u32), speed);
            for (i, motion) in state.particles.motions.iter_mut().enumerate() {
                motion.velocity_m_s[0] = speed * i as f64 / bonds as f64;
            }
            damp(&mut state, 0.2);
            state.ledger = opened(&state);
            let mut largest_n = 0.0_f64;
            while state.broken_count == 0 {
                assert!(state.time_s < 50e-3, "{bonds} bonds: it does not break");
                interact(&mut state);
                let load = state.bonds.forces(0, &state.particles.poses).load;
                largest_n = largest_n.max(load.normal_n);
                advance(&mut state);
            }
            interact(&mut state);
            let spent = spent_j(&mut state) / (energy_j_m2 * area_m2());
            let strength = largest_n / (0.95 * STRENGTH_PA * area_m2());
            assert!(
                (spent - 1.0).abs() < 0.02,
                "{bonds} bonds: {spent} of the energy"
            );
            assert!((strength - 1.0).abs() < 0.02, "{bonds} bonds: {strength}");
            assert_eq!(state.broken_count, 1);
        }
    });
}

/// A bar of 4 mm x 4 mm x 16 mm of 1 x 1, 2 x 2 and 4 x 4 touching spheres in each layer, pulled
/// apart in its weakest layer: the bonds of a layer have the same section in all, and the crack
/// takes the fracture energy of that section.
#[test]
fn a_crack_takes_the_same_energy_for_any_size_of_spheres() {
    on_one_thread(|| {
        let energy_j_m2 = 20.0;
        for across in [1, 2, 4] {
            let (mut state, weakest) = weak_bar(across, energy_j_m2);
            let count = weakest.len() as u64;
            while state.broken_count < count {
                assert!(state.time_s < 50e-3, "{across}: it does not part");
                step(&mut state);
            }
            interact(&mut state);
            for at in 0..state.bonds.len() {
                let is_weak = weakest.contains(&at);
                assert_eq!(state.bonds.is_broken(at), is_weak, "{across}: {at}");
                assert!(is_weak || state.bonds.damage(at) == 0.0, "{across}: {at}");
            }
            let area_m2 = PI * (2e-3_f64).powi(2);
            let spent = spent_j(&mut state) / (energy_j_m2 * area_m2);
            assert!((spent - 1.0).abs() < 2e-3, "{across}: {spent}");
            let error = balance(&mut state).energy_error;
            assert!(error.abs() < 1e-5, "{across}: {error}");
        }
    });
}

/// That bar, held at its left and pulled at its right end, and the numbers of its weakest bonds.
fn weak_bar(across: usize, energy_j_m2: f64) -> (State, Vec<usize>) {
    let (length_m, long) = (4e-3 / across as f64, 4 * across);
    let sides = [long, across, across];
    let number = |[x, y, z]: [usize; 3]| (x + long * (y + across * z)) as u32;
    let (mut particles, mut pairs) = (Particles::default(), Vec::new());
    for i in 0..long * across * across {
        let place = [i % long, i / long % across, i / long / across];
        particles.push_sphere(place.map(|k| length_m * k as f64), 0.5 * length_m, 2500.0);
        for axis in (0..3).filter(|axis| place[*axis] + 1 < sides[*axis]) {
            let mut next = place;
            next[axis] += 1;
            pairs.push([i as u32, number(next)]);
        }
    }
    let layer = |x: usize| {
        let places = (0..across * across).map(move |k| [x, k % across, k / across]);
        places.map(number).collect::<Vec<u32>>()
    };
    let bonding = Bonding {
        radius_factor: 1.0,
        model: BondModel::Timoshenko,
        young_modulus_pa: YOUNG_PA,
        rule: BondRule {
            criteria: Some(TENSION),
            law: BondLaw::Softening {
                fracture_energy_j_m2: energy_j_m2,
            },
            ..ELASTIC
        },
    };
    let mut state = body(particles, &pairs, &bonding, 1e-9);
    let middle = layer(long / 2 - 1);
    let is_weak = |[a, b]: [u32; 2]| middle.contains(&a) && b == a + 1;
    let all = 0..pairs.len();
    let weakest: Vec<usize> = all.filter(|&at| is_weak(state.bonds.ends[at])).collect();
    state.bonds.strength_factors = vec![1.0; pairs.len()];
    for &at in &weakest {
        state.bonds.strength_factors[at] = 0.95;
    }
    state.bonds.histories.damages = (0..pairs.len())
        .map(|at| Damage::none(&state.bonds.stiffness(at), state.bonds.strength_factors[at]))
        .collect();
    state.time_step_s = 0.5 * limit(&mut state).step_s;
    let speed = 4e-3;
    hold(&mut state, layer(0).into_iter(), 0.0);
    hold(&mut state, layer(long - 1).into_iter(), speed);
    for i in 0..state.particles.len() {
        let part = (i % long) as f64 / (long - 1) as f64;
        state.particles.motions[i].velocity_m_s[0] = speed * part;
    }
    damp(&mut state, 0.2);
    state.ledger = opened(&state);
    (state, weakest)
}

/// A row that is shaken so that all its bonds are damaged.
fn shaken(energy_j_m2: f64, excess: f64) -> State {
    let mut state = row(6, 2e-3, TENSION, energy_j_m2);
    let m = 1.0 / state.particles.motions[0].inverse_mass;
    let speed = excess * STRENGTH_PA * area_m2() / (m * state.bonds.stiffness(0).normal).sqrt();
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        let phase = PI * i as f64 / 6.0;
        motion.velocity_m_s = [-phase.cos() * speed, 0.1 * speed * phase.sin(), 0.0];
        motion.spin_rad_s = [0.0, 0.0, 0.1 * speed / RADIUS_M * phase.cos()];
    }
    state.ledger = opened(&state);
    state
}

/// A row that is pulled apart, twisted and bent so fast that its bonds soften one after the other.
fn pulled() -> State {
    let mut state = row(6, 2e-3, TENSION, 40.0);
    let speed = 2e-6 / (20.0 * state.time_step_s);
    hold(&mut state, std::iter::once(0), 0.0);
    hold(&mut state, std::iter::once(6), speed);
    let spins = [0.2 * speed / RADIUS_M, 0.0, 0.3 * speed / RADIUS_M];
    for (axis, spin) in spins.into_iter().enumerate() {
        state.supports[1].holds[3 + axis] = Some(Hold::Velocity(spin));
    }
    state.particles.motions[6].velocity_m_s[0] = speed;
    state.particles.motions[6].spin_rad_s = spins;
    state.ledger = opened(&state);
    state
}

#[test]
fn books_stay_closed_through_damage() {
    on_one_thread(|| {
        let until_s = 1000.0 * pulled().time_step_s;
        let errors = [0.25, 0.125, 0.0625].map(|part| {
            let mut state = pulled();
            state.time_step_s *= part;
            let (mut error, mut last) = (0.0_f64, Balance::default());
            while state.time_s < until_s {
                interact(&mut state);
                last = balance(&mut state);
                error = error.max(last.energy_error.abs());
                assert!(last.momentum_error < 1e-12 && last.angular_momentum_error < 1e-12);
                advance(&mut state);
            }
            let damaged = (0..6).filter(|&at| state.bonds.damage(at) > 0.0).count();
            assert!(damaged >= 2, "{damaged}");
            assert!(last.bond_damage_j > 0.1 * last.energy_scale_j, "{last:?}");
            error
        });
        let falls = errors[0] / errors[2];
        assert!(
            (12.0..20.0).contains(&falls),
            "falls by {falls}: {errors:?}"
        );
    });
}

/// Softening needs no smaller step: a row with a hundredth of critical damping, whose damaged bonds
/// open and close, is stable just below the limit of its intact bonds.
#[test]
fn damage_needs_no_smaller_step() {
    on_one_thread(|| {
        let mut state = shaken(40.0, 3.0);
        crate::bars::damp(&mut state, BondDamping::ChenByMode(0.01));
        let intact_s = limit(&mut state).step_s;
        state.time_step_s = 0.98 * intact_s;
        for _ in 0..100_000 {
            interact(&mut state);
            advance(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        assert!(now.bond_damage_j > 0.1 * now.energy_scale_j, "{now:?}");
        assert!(now.energy_error.abs() < 0.03, "{now:?}");
        assert!(now.elastic_j() < 1e-6 * now.energy_scale_j, "{now:?}");
        let damaged = (0..6).filter(|&at| state.bonds.damage(at) > 0.0).count();
        assert!(damaged >= 3, "{damaged}");
        // The limit stays that of the intact bonds, whose stiffness returns under pressure.
        let limit_s = limit(&mut state).step_s;
        assert!(
            (limit_s / intact_s - 1.0).abs() < 1e-3,
            "{limit_s} {intact_s}"
        );
    });
}

proptest! {
    #[test]
    fn softening_is_a_straight_line(ratio in 1.001..1e6_f64, part in 0.0..1.0_f64) {
        let opening = 1.0 + part * (ratio - 1.0);
        let stress = (1.0 - damage_at(opening, ratio)) * opening;
        let line = (ratio - opening) / (ratio - 1.0);
        prop_assert!((stress - line).abs() < 1e-9, "{stress} {line}");
    }
}
