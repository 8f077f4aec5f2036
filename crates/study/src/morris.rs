//! Morris' method: trajectories through the ranges of all parameters, the elementary effects along
//! them, and their statistics (Morris 1991; Campolongo et al. 2007).
//!
//! Each range is the interval from 0 to 1, on which a point has one of p levels, the multiples of
//! 1/(p - 1). An elementary effect is the change of a value over the step of one parameter that
//! causes it, so that it counts over the whole range.

use dem_io::random::{hash, uniform};
use serde::Serialize;

/// Number of samples of the bootstrap.
const SAMPLES: usize = 2000;
/// Their fractions below and above the interval of 95 %.
const TAILS: [f64; 2] = [0.025, 0.975];
/// Keeps the random numbers of the bootstrap apart from those of trajectories.
const BOOTSTRAP: u64 = 0x6d6f_7272_6973;

/// A trajectory: a point more than there are parameters, each of which changes once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trajectory {
    /// The level of each parameter at each point, from 0.
    pub points: Vec<Vec<usize>>,
    /// The parameter that changes after each point but the last.
    pub changed: Vec<usize>,
}

impl Trajectory {
    /// Trajectory number `number` of a design. `levels`: their number, even.
    ///
    /// Each parameter starts at any level with the same probability and moves by half the number of
    /// levels, p/2, to where there is room: that is Delta = p/(2 (p - 1)) in the range from 0 to 1.
    /// The order of the parameters is random (the random orientation B* of Morris 1991).
    pub fn new(parameters: usize, levels: usize, seed: u64, number: usize) -> Self {
        let random = |draw: usize| uniform(seed, &[number as u64, draw as u64]);
        let below = |count: usize, draw: usize| {
            // Numbers are below 1, so that this is below `count`.
            (random(draw) * count as f64) as usize
        };
        let mut point: Vec<usize> = (0..parameters).map(|at| below(levels, at)).collect();
        let mut changed: Vec<usize> = (0..parameters).collect();
        for last in (1..parameters).rev() {
            changed.swap(last, below(last + 1, parameters + last));
        }
        let mut points = vec![point.clone()];
        let step = levels / 2;
        for parameter in &changed {
            let level = &mut point[*parameter];
            *level = if *level < step {
                *level + step
            } else {
                *level - step
            };
            points.push(point.clone());
        }
        Self { points, changed }
    }

    /// The step of a parameter: the points before and after it, and its size with its sign, as a
    /// fraction of the range.
    pub fn step(&self, parameter: usize, levels: usize) -> Option<([usize; 2], f64)> {
        let before = self.changed.iter().position(|other| *other == parameter)?;
        let level = |at: usize| self.points[at][parameter] as f64;
        let step = (level(before + 1) - level(before)) / (levels - 1) as f64;
        Some(([before, before + 1], step))
    }
}

/// An elementary effect of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementaryEffect {
    /// Change of the value over that of the parameter, whose range is 1: the mean over the seeds.
    pub value: f64,
    /// Variance of that mean by chance, from its scatter over the seeds. None for a single seed.
    pub variance: Option<f64>,
    /// Degrees of freedom of that variance: the number of seeds with both values, less 1.
    pub degrees: usize,
}

impl ElementaryEffect {
    /// From the values before and after a step of this size, seed by seed. None: no seed has both.
    pub fn of(before: &[Option<f64>], after: &[Option<f64>], step: f64) -> Option<Self> {
        let both = before.iter().zip(after);
        let effects = both.filter_map(|(before, after)| Some(((*after)? - (*before)?) / step));
        let effects: Vec<f64> = effects.collect();
        let count = effects.len() as f64;
        let value = effects.iter().sum::<f64>() / count;
        let squares: f64 = effects.iter().map(|one| (one - value).powi(2)).sum();
        (!effects.is_empty()).then(|| Self {
            value,
            variance: (effects.len() > 1).then(|| squares / (count - 1.0) / count),
            degrees: effects.len() - 1,
        })
    }
}

/// The statistics of the elementary effects of one parameter, in the unit of the value: changes
/// over the whole range of the parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectStatistics {
    /// Number of effects.
    pub effects: usize,
    /// mu*: mean of their magnitudes (Campolongo et al. 2007), the rank of a parameter.
    pub mu_star: f64,
    /// 95 % confidence interval of mu*, by bootstrap over the trajectories.
    pub interval: [f64; 2],
    /// mu: mean of the effects with their signs.
    pub mu: f64,
    /// sigma: their standard deviation, by curvature, interaction and chance. None for one effect.
    pub sigma: Option<f64>,
    /// mu* that chance alone exceeds in 5 % of designs like this. None: there is one seed only.
    pub chance: Option<f64>,
}

impl EffectStatistics {
    /// Of the effects of all trajectories. None: there are none.
    pub fn of(effects: &[ElementaryEffect]) -> Option<Self> {
        let count = effects.len() as f64;
        let mean = |of: fn(f64) -> f64| effects.iter().map(|e| of(e.value)).sum::<f64>() / count;
        let mu = mean(|value| value);
        let squares: f64 = effects.iter().map(|e| (e.value - mu).powi(2)).sum();
        (!effects.is_empty()).then(|| Self {
            effects: effects.len(),
            mu_star: mean(f64::abs),
            interval: interval(effects),
            mu,
            sigma: (effects.len() > 1).then(|| (squares / (count - 1.0)).sqrt()),
            chance: chance(effects),
        })
    }

    /// Whether mu* is more than chance alone would give. None: that is not known.
    pub fn is_above_chance(&self) -> Option<bool> {
        self.chance.map(|chance| self.mu_star > chance)
    }
}

/// The 95 % interval of the mean of the magnitudes: percentiles of its values in samples with as
/// many effects, drawn with replacement. The same numbers for the same effects.
fn interval(effects: &[ElementaryEffect]) -> [f64; 2] {
    let count = effects.len();
    let magnitude = |sample: usize, draw: usize| {
        let at = hash(BOOTSTRAP, [sample as u64, draw as u64]) % count as u64;
        effects[at as usize].value.abs()
    };
    let mean = |sample| (0..count).map(|draw| magnitude(sample, draw)).sum::<f64>() / count as f64;
    let mut means: Vec<f64> = (0..SAMPLES).map(mean).collect();
    means.sort_by(f64::total_cmp);
    TAILS.map(|tail| means[(tail * (SAMPLES - 1) as f64).round() as usize])
}

/// The mean of the magnitudes that effects of chance alone exceed in 5 % of cases.
fn chance(effects: &[ElementaryEffect]) -> Option<f64> {
    let variances = effects.iter().filter_map(|effect| effect.variance);
    let variances: Vec<f64> = variances.collect();
    let degrees = effects.iter().map(|effect| effect.degrees).sum();
    let deviation = (variances.iter().sum::<f64>() / variances.len() as f64).sqrt();
    (!variances.is_empty()).then(|| deviation * chance_factor(effects.len(), degrees))
}

/// The 95 % quantile of the mean magnitude of as many normal numbers over their standard deviation,
/// where that is estimated with `degrees` of freedom: of samples, the same for the same numbers.
fn chance_factor(count: usize, degrees: usize) -> f64 {
    let degrees = degrees as f64;
    let ratio = |sample: usize| {
        let normal = |draw: usize| {
            let [u, v] = [0, 1].map(|half| uniform(BOOTSTRAP, &[sample as u64, draw as u64, half]));
            // Box and Muller.
            (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
        };
        let mean = (1..=count).map(|draw| normal(draw).abs()).sum::<f64>() / count as f64;
        // Chi squared over its degrees of freedom, after Wilson and Hilferty.
        let room = 2.0 / (9.0 * degrees);
        let variance = (1.0 - room + normal(0) * room.sqrt()).max(0.0).powi(3);
        mean / variance.sqrt()
    };
    let mut ratios: Vec<f64> = (0..SAMPLES).map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    ratios[(0.95 * (SAMPLES - 1) as f64).round() as usize]
}
