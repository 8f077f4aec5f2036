//! Morris' method: trajectories, elementary effects, and the ranking of published functions.

use dem_study::morris::{EffectStatistics, ElementaryEffect, Trajectory};
use proptest::prelude::*;

/// The statistics of each parameter of a function of numbers from 0 to 1.
fn statistics(
    parameters: usize,
    [trajectories, levels]: [usize; 2],
    seed: u64,
    value: impl Fn(&[f64]) -> f64,
) -> Vec<EffectStatistics> {
    let mut effects = vec![Vec::new(); parameters];
    for number in 0..trajectories {
        let one = Trajectory::new(parameters, levels, seed, number);
        let place = |level: &usize| *level as f64 / (levels - 1) as f64;
        let values = one.points.iter().map(|point| {
            let point: Vec<f64> = point.iter().map(place).collect();
            [Some(value(&point))]
        });
        let values: Vec<[Option<f64>; 1]> = values.collect();
        for (parameter, effects) in effects.iter_mut().enumerate() {
            let ([before, after], step) = one.step(parameter, levels).unwrap();
            effects.extend(ElementaryEffect::of(&values[before], &values[after], step));
        }
    }
    let statistics = effects.iter().map(|all| EffectStatistics::of(all).unwrap());
    statistics.collect()
}

/// The parameters by falling mu*.
fn ranked(statistics: &[EffectStatistics]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..statistics.len()).collect();
    order.sort_by(|a, b| statistics[*b].mu_star.total_cmp(&statistics[*a].mu_star));
    order
}

proptest! {
    /// Each step moves one parameter by p/2 levels, that is Delta = p/(2 (p - 1)); each parameter
    /// moves once; all points lie on levels.
    #[test]
    fn a_trajectory_moves_each_parameter_once_by_delta(
        parameters in 1..30_usize, half in 1..8_usize, seed: u64, number in 0..50_usize,
    ) {
        let levels = 2 * half;
        let one = Trajectory::new(parameters, levels, seed, number);
        prop_assert_eq!(one.points.len(), parameters + 1);
        prop_assert!(one.points.iter().flatten().all(|level| *level < levels));
        for (pair, changed) in one.points.windows(2).zip(&one.changed) {
            for (parameter, (before, after)) in pair[0].iter().zip(&pair[1]).enumerate() {
                let moved = before.abs_diff(*after);
                prop_assert_eq!(moved, if parameter == *changed { half } else { 0 });
            }
        }
        let mut changed = one.changed.clone();
        changed.sort_unstable();
        prop_assert_eq!(changed, (0..parameters).collect::<Vec<usize>>());
        let delta = levels as f64 / (2.0 * (levels as f64 - 1.0));
        for parameter in 0..parameters {
            let ([before, after], step) = one.step(parameter, levels).unwrap();
            prop_assert_eq!(before + 1, after);
            prop_assert!((step.abs() - delta).abs() < 1e-15, "{} {}", step, delta);
        }
    }

    /// The effects of a linear function are its coefficients, and do not scatter.
    #[test]
    fn effects_of_a_linear_function_are_its_coefficients(
        coefficients in prop::collection::vec(-1e3..1e3_f64, 1..12), seed: u64,
    ) {
        let value = |x: &[f64]| x.iter().zip(&coefficients).map(|(x, c)| c * x).sum::<f64>() - 7.0;
        let found = statistics(coefficients.len(), [5, 6], seed, value);
        for (of, coefficient) in found.iter().zip(&coefficients) {
            prop_assert_eq!(of.effects, 5);
            prop_assert!((of.mu - coefficient).abs() < 1e-9);
            prop_assert!((of.mu_star - coefficient.abs()).abs() < 1e-9);
            prop_assert!(of.sigma.unwrap() < 1e-9, "{:?}", of);
            let off = of.interval.map(|end| (end - coefficient.abs()).abs());
            prop_assert!(off.into_iter().all(|off| off < 1e-9), "{:?}", of);
        }
    }

    /// More trajectories leave the others as they are; another seed gives others.
    #[test]
    fn trajectories_depend_on_seed_and_number_only(seed: u64) {
        let of = |seed, number| Trajectory::new(8, 4, seed, number);
        prop_assert_eq!(of(seed, 3), of(seed, 3));
        prop_assert!(of(seed, 3) != of(seed, 4) && of(seed, 3) != of(seed ^ 1, 3));
    }
}

/// All levels and both directions are equally likely, and so is each place in the order.
#[test]
fn trajectories_cover_the_ranges_evenly() {
    const COUNT: usize = 4000;
    let [mut starts, mut first] = [[0_usize; 4], [0_usize; 4]];
    for number in 0..COUNT {
        let one = Trajectory::new(4, 4, 1, number);
        starts[one.points[0][2]] += 1;
        first[one.changed[0]] += 1;
    }
    // Five standard deviations of the binomial distribution.
    let room = 5.0 * (COUNT as f64 * 0.25 * 0.75).sqrt();
    for count in starts.into_iter().chain(first) {
        assert!(
            (count as f64 - 0.25 * COUNT as f64).abs() < room,
            "{starts:?} {first:?}"
        );
    }
}

/// The function of Morris 1991 (section 4), with zeros for its coefficients that are random there.
fn of_morris(x: &[f64]) -> f64 {
    let w = |at: usize| match at {
        2 | 4 | 6 => 2.0 * (1.1 * x[at] / (x[at] + 0.1) - 0.5),
        _ => 2.0 * (x[at] - 0.5),
    };
    let w: Vec<f64> = (0..20).map(w).collect();
    let first: f64 = w[..10].iter().map(|w| 20.0 * w).sum();
    let (mut second, mut third) = (0.0, 0.0);
    for i in 0..6 {
        for j in i + 1..6 {
            second -= 15.0 * w[i] * w[j];
            third -= (j + 1..5).map(|l| 10.0 * w[i] * w[j] * w[l]).sum::<f64>();
        }
    }
    first + second + third + 5.0 * w[..4].iter().product::<f64>()
}

/// Morris 1991 (section 4, figure 1): of 20 inputs the first ten matter; the first seven are curved
/// or interact, inputs 8 to 10 are linear; the others do nothing.
#[test]
fn the_inputs_of_morris_are_told_apart() {
    for seed in 1..=5 {
        let found = statistics(20, [10, 4], seed, of_morris);
        for (input, of) in found.iter().enumerate() {
            let sigma = of.sigma.unwrap();
            match input {
                0..=6 => assert!(of.mu_star > 5.0 && sigma > 5.0, "{seed} {input} {of:?}"),
                // 20 w, with w = 2 (x - 1/2).
                7..=9 => assert!(
                    (of.mu - 40.0).abs() < 1e-9 && sigma < 1e-9,
                    "{input} {of:?}"
                ),
                _ => assert!(of.mu_star < 1e-9 && sigma < 1e-9, "{input} {of:?}"),
            }
        }
    }
}

/// Sobol's g function (product of (|4 x - 2| + a)/(1 + a)): the smaller a, the larger the effect,
/// as the indices of Saltelli et al. 2008 (section 3.6) have it. Signs cancel: mu is no measure.
#[test]
fn the_parameters_of_the_g_function_are_ranked() {
    const A: [f64; 6] = [0.0, 1.0, 4.5, 9.0, 30.0, 99.0];
    let value = |x: &[f64]| -> f64 {
        let factors = x
            .iter()
            .zip(A)
            .map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a));
        factors.product()
    };
    let found = statistics(6, [200, 8], 1, value);
    assert_eq!(ranked(&found), [0, 1, 2, 3, 4, 5]);
    for of in &found {
        assert!(of.mu.abs() < 0.5 * of.mu_star, "{of:?}");
        assert!(of.sigma.unwrap() > 0.9 * of.mu_star, "{of:?}");
        let [low, high] = of.interval;
        assert!(low < of.mu_star && of.mu_star < high, "{of:?}");
    }
}

/// The interval covers the mu* of infinitely many trajectories in about 95 % of designs: the mean
/// over all pairs of levels, and all levels of the other parameter.
#[test]
fn the_interval_covers_the_true_value() {
    let value = |x: [f64; 2]| (3.0 * x[0]).sin() + x[0] * x[1] + (x[1] - 0.3).powi(2);
    let place = |level: usize| level as f64 / 3.0;
    let truth = [0, 1].map(|parameter| {
        let effects = (0..8).map(|at| {
            let ends = [at / 4, at / 4 + 2].map(|level| {
                let mut x = [place(at % 4); 2];
                x[parameter] = place(level);
                value(x)
            });
            ((ends[1] - ends[0]) / (2.0 / 3.0)).abs()
        });
        effects.sum::<f64>() / 8.0
    });
    let (mut covered, mut all) = (0_u32, 0_u32);
    for seed in 0..200 {
        let found = statistics(2, [30, 4], seed, |x| value([x[0], x[1]]));
        for (of, truth) in found.iter().zip(truth) {
            let [low, high] = of.interval;
            covered += u32::from(low <= truth && truth <= high);
            all += 1;
        }
    }
    // Binomial of 400 with 0.95: a standard deviation of 1.1 %; a bootstrap of 30 is a little
    // narrow.
    let share = f64::from(covered) / f64::from(all);
    assert!((0.90..=0.99).contains(&share), "{share}");
}

/// Values that only scatter: mu* exceeds its chance level in about 5 % of designs.
#[test]
fn chance_is_told_from_effects() {
    let noise = |words: &[u64]| {
        // Near enough to normal: the sum of twelve uniform numbers.
        let draws = (0..12).map(|draw| dem_io::random::uniform(draw, words));
        draws.sum::<f64>() - 6.0
    };
    let (mut above, mut all) = (0, 0);
    for design in 0..300 {
        let effects: Vec<ElementaryEffect> = (0..8)
            .map(|trajectory| {
                let values = |point: u64| {
                    [0, 1, 2].map(|seed| Some(noise(&[design, trajectory, point, seed])))
                };
                ElementaryEffect::of(&values(0), &values(1), 2.0 / 3.0).unwrap()
            })
            .collect();
        let found = EffectStatistics::of(&effects).unwrap();
        above += u32::from(found.is_above_chance().unwrap());
        all += 1;
    }
    // 5 % of 300 with four standard deviations.
    let share = f64::from(above) / f64::from(all);
    assert!((0.0..=0.1).contains(&share) && above > 0, "{share}");
}

/// Seeds without a value at one end of a step are left out; never zero.
#[test]
fn missing_values_are_left_out() {
    let of = |before: [Option<f64>; 3], after: [Option<f64>; 3]| {
        ElementaryEffect::of(&before, &after, -0.5)
    };
    let whole = of(
        [Some(1.0), Some(2.0), Some(3.0)],
        [Some(2.0), Some(4.0), Some(6.0)],
    )
    .unwrap();
    assert_eq!(whole.value, -4.0);
    // -2, -4, -6: variance 4 over 3.
    assert!((whole.variance.unwrap() - 4.0 / 3.0).abs() < 1e-12);
    let partly = of([Some(1.0), None, Some(3.0)], [Some(2.0), Some(4.0), None]).unwrap();
    assert_eq!((partly.value, partly.variance), (-2.0, None));
    assert_eq!(of([None; 3], [Some(1.0); 3]), None);
    assert_eq!(EffectStatistics::of(&[]), None);
}
