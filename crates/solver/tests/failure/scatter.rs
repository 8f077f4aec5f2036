//! Strength that varies from bond to bond.

use dem_run::physics::bond::scatter::strength_factor;
use dem_run::stages::loads::factor_at;
use dem_run::state::particles::Particles;
use dem_run::step::{act, move_on};

use crate::bodies::{
    LENGTH_M, LOAD_STEP, NORMAL, RADIUS_M, SOFT_STEPS, STRENGTH_PA, YOUNG_PA, area_m2, bonded,
    hold, on_one_thread, push, rod,
};

const MODULUS: f64 = 6.0;

/// Ten bonds in a row carry the same load: the weakest breaks, alone, at its strength.
#[test]
fn the_weakest_bond_of_a_chain_breaks_first() {
    on_one_thread(|| {
        for seed in 0..6 {
            for incremental in [false, true] {
                let mut state = rod(10, NORMAL, incremental);
                hold(&mut state, std::iter::once(0), 0.0);
                let factors: Vec<f64> = (0..10)
                    .map(|i| strength_factor(seed, 0, [i, i + 1], MODULUS))
                    .collect();
                let weakest = (0..10).min_by(|&a, &b| factors[a].total_cmp(&factors[b]));
                let weakest = weakest.unwrap();
                let strength = factors[weakest];
                state.bonds.strength_factors = factors;
                let force = strength * STRENGTH_PA * area_m2();
                push(&mut state, 10, [force, 0.0, 0.0], [0.0; 3]);
                while state.broken_count == 0 {
                    act(&mut state);
                    if state.broken_count == 0 {
                        move_on(&mut state);
                    }
                    assert!(
                        state.steps < 2 * u64::from(SOFT_STEPS) + 10,
                        "does not break"
                    );
                }
                assert_eq!(state.broken.len(), 1);
                assert_eq!(state.broken[0].bond as usize, weakest);
                let load = factor_at(&state.loads[0].factor, state.time_s);
                let late = (load - 1.0) / LOAD_STEP;
                assert!((-0.1..1.1).contains(&late), "{late} steps late");
            }
        }
    });
}

/// Two thousand bonds, pulled alike, break at strengths of Weibull's distribution: Kolmogorov and Smirnov's test at one per cent.
#[test]
fn strengths_are_those_of_weibull() {
    const COUNT: usize = 2000;
    const STEPS: f64 = 1000.0;
    let mut particles = Particles::default();
    let mut pairs = Vec::new();
    for i in 0..COUNT {
        let y = 4.0 * RADIUS_M * i as f64;
        particles.push_sphere([0.0, y, 0.0], RADIUS_M, 2500.0);
        particles.push_sphere([LENGTH_M, y, 0.0], RADIUS_M, 2500.0);
        pairs.push([2 * i as u32, 2 * i as u32 + 1]);
    }
    let mut state = bonded(particles, &pairs, NORMAL, false);
    state.bonds.strength_factors = pairs
        .iter()
        .map(|pair| strength_factor(11, 0, pair.map(u64::from), MODULUS))
        .collect();
    let speed = 1e-3;
    let even = (0..COUNT as u32).map(|i| 2 * i);
    hold(&mut state, even, 0.0);
    let odd = (0..COUNT as u32).map(|i| 2 * i + 1);
    hold(&mut state, odd, speed);
    state.time_step_s = STRENGTH_PA / YOUNG_PA * LENGTH_M / speed / STEPS;
    let mut strengths = Vec::new();
    while strengths.len() < COUNT {
        act(&mut state);
        for broken in &state.broken {
            let strength = state.steps as f64 / STEPS;
            let given = state.bonds.strength_factor(broken.bond as usize);
            let late = (strength - given) * STEPS;
            assert!((-0.05..1.05).contains(&late), "{given} broke at {strength}");
            strengths.push(given);
        }
        assert!(state.broken.windows(2).all(|two| two[0].bond < two[1].bond));
        move_on(&mut state);
        assert!((state.steps as f64) < 3.0 * STEPS, "not all break");
    }
    assert_eq!(state.broken_count as usize, COUNT);
    let largest = strengths
        .iter()
        .enumerate()
        .fold(0.0, |largest: f64, (i, strength)| {
            let share = 1.0 - (-strength.powf(MODULUS)).exp();
            let (before, after) = (i as f64 / COUNT as f64, (i + 1) as f64 / COUNT as f64);
            largest
                .max((share - before).abs())
                .max((share - after).abs())
        });
    assert!(largest < 1.63 / (COUNT as f64).sqrt(), "off by {largest}");
}
