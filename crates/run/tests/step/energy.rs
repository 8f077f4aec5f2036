//! Energy and momentum of isolated bodies: order of the step, long runs, rest.

use crate::bars::{
    BAR_LIMIT_S, Bonding, ELASTIC, MODELS, bar, body, orders, random_spheres, run, soft, spheres,
    steel, tumble, turned, with_threads,
};
use dem_engine::state::State;
use dem_engine::state::bonds::{BondLaw, BondRule};
use dem_engine::state::particles::Particles;
use dem_engine::step::step;
use dem_physics::bond::stiffness::BondModel;
use nalgebra::{UnitQuaternion, Vector3};

const INCREMENTAL: BondRule = BondRule {
    law: BondLaw::Incremental,
    ..ELASTIC
};

/// The tumbling bar at a step of the limit over this number.
fn tumbling(rule: &BondRule, limit_over_step: u32) -> State {
    let mut state = bar(
        BondModel::Timoshenko,
        rule.clone(),
        BAR_LIMIT_S / f64::from(limit_over_step),
    );
    tumble(&mut state);
    state
}

#[test]
fn energy_error_falls_with_the_square_of_the_step() {
    with_threads(1, || {
        for rule in [ELASTIC, INCREMENTAL] {
            let errors: Vec<f64> = [5, 10, 20, 40]
                .map(|finer| run(&mut tumbling(&rule, finer), 1000 * u64::from(finer), 1).energy)
                .into();
            let orders = orders(&errors);
            eprintln!("{:?}: {errors:?} {orders:.4?}", rule.law);
            assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.05), "{orders:?}");
        }
    });
}

/// Position of the first particle after 300 steps of the limit.
fn end(mut state: State, finer: u32) -> Vector3<f64> {
    for _ in 0..300 * u64::from(finer) {
        step(&mut state);
    }
    state.particles.poses[0].place()
}

/// Distances between the ends of runs with halved steps.
fn distances(ends: &[Vector3<f64>]) -> Vec<f64> {
    ends.windows(2).map(|e| (e[0] - e[1]).norm()).collect()
}

#[test]
fn places_are_of_second_order() {
    with_threads(1, || {
        for rule in [ELASTIC, INCREMENTAL] {
            let ends = [10, 20, 40, 80].map(|finer| end(tumbling(&rule, finer), finer));
            let orders = orders(&distances(&ends));
            eprintln!("{:?}: {orders:.4?}", rule.law);
            assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.1), "{orders:?}");
        }
    });
}

/// The step increases by a third after a third of the run and is halved after two thirds, at the
/// same times for all steps.
#[test]
fn a_step_that_changes_in_mid_run_keeps_the_order() {
    with_threads(1, || {
        for rule in [ELASTIC, INCREMENTAL] {
            let runs = [12, 24, 48, 96].map(|finer| {
                let step_s = BAR_LIMIT_S / f64::from(finer);
                let mut state = tumbling(&rule, finer);
                let third = 100 * u64::from(finer);
                let mut energy = 0.0_f64;
                for (fraction, steps) in [(1.0, third), (4.0 / 3.0, third), (2.0 / 3.0, third)] {
                    state.time_step_s = fraction * step_s;
                    let errors = run(&mut state, steps, 1);
                    energy = energy.max(errors.energy);
                    assert!(errors.momentum < 1e-12 && errors.angular_momentum < 1e-12);
                }
                (energy, state.particles.poses[0].place())
            });
            let of_energy = orders(&runs.map(|(energy, _)| energy));
            let of_place = orders(&distances(&runs.map(|(_, place)| place)));
            eprintln!("{:?}: {of_energy:.4?} {of_place:.4?}", rule.law);
            assert!(
                of_energy
                    .iter()
                    .chain(&of_place)
                    .all(|o| (o - 2.0).abs() < 0.1)
            );
        }
    });
}

/// A million steps at a tenth of the limit: as accurate as the independent implementation, whose
/// error was 1.3e-7.
#[test]
fn a_million_steps_of_tumbling_lose_nothing() {
    with_threads(1, || {
        let mut state = tumbling(&ELASTIC, 10);
        let early = run(&mut state, 100_000, 50);
        let all = run(&mut state, 900_000, 50);
        eprintln!("{early:?}\n{all:?}");
        assert!(
            (27.0e6..27.5e6).contains(&(all.energy_j / all.energy)),
            "{all:?}"
        );
        assert!((60e3..100e3).contains(&all.elastic_j), "{all:?}");
        assert!(all.energy <= 2e-7, "{all:?}");
        // Bounded: the first tenth contains nearly the largest error.
        assert!(all.energy < 1.3 * early.energy, "{early:?} {all:?}");
        assert!(
            all.momentum <= 1e-12 && all.angular_momentum <= 1e-12,
            "{all:?}"
        );
    });
}

#[test]
fn the_incremental_formulation_keeps_its_energy_too() {
    with_threads(1, || {
        let all = run(&mut tumbling(&INCREMENTAL, 10), 200_000, 50);
        eprintln!("{all:?}");
        assert!(all.energy <= 2e-7, "{all:?}");
        assert!(
            all.momentum <= 1e-12 && all.angular_momentum <= 1e-12,
            "{all:?}"
        );
    });
}

/// Not along an axis, of spheres of many sizes: it contains no round numbers.
fn oblique_chain() -> (Particles, Vec<[u32; 2]>) {
    let mut particles = Particles::default();
    let mut next = crate::bars::scattered();
    let mut place = Vector3::new(0.1, 0.2, 0.3);
    for _ in 0..20 {
        let radius = 0.2 + 0.1 * next();
        particles.push_sphere(place.into(), radius, 7850.0);
        place += Vector3::new(0.3 + 0.1 * next(), 0.2 * next(), 0.2 * next());
    }
    (particles, (0..19).map(|i| [i, i + 1]).collect())
}

#[test]
fn what_rests_does_not_move_by_a_single_bit() {
    with_threads(1, || {
        for (model, _) in MODELS {
            for rule in [ELASTIC, INCREMENTAL] {
                let (spheres, chain) = oblique_chain();
                let still = |particles: &Particles, pairs: &[[u32; 2]], of: &Bonding, steps| {
                    let mut state = body(particles.clone(), pairs, of, 1e-6);
                    for _ in 0..steps {
                        step(&mut state);
                    }
                    assert_eq!(state.particles.poses, particles.poses, "{model:?}");
                    assert_eq!(state.particles.motions, particles.motions, "{model:?}");
                };
                still(&spheres, &chain, &steel(model, rule.clone()), 100_000);
                // Nothing has changed after a step, so nothing ever will.
                let (spheres, pairs) = random_spheres();
                still(&spheres, &pairs, &soft(model, rule), 100);
            }
        }
    });
}

/// The bar rotated in space before it starts.
#[test]
fn a_bar_at_rest_in_any_direction_is_at_rest() {
    let (straight, pairs) = spheres(11);
    let by = UnitQuaternion::from_euler_angles(0.3, 1.1, -2.0);
    let particles = turned(&straight, by);
    for (model, _) in MODELS {
        let mut state = body(particles.clone(), &pairs, &steel(model, ELASTIC), 1e-6);
        step(&mut state);
        assert_eq!(state.particles.motions, particles.motions, "{model:?}");
    }
}
