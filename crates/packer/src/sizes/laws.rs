//! The laws of size distributions, as tables of their distributions by number and by mass.

use super::curve::Curve;
use super::parse::{Cut, Law};
use dem_io::units::{show_length, significant};
use dem_io::{Diagnostic, Result};
use serde::Serialize;
use std::f64::consts::PI;

/// The standard normal quantile of 99.9 %.
const NORMAL_DEVIATE_999: f64 = 3.090_232_306_167_813;

/// The quantity that a distribution of sizes counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// Number of particles.
    Number,
    /// Mass (or volume): each particle counts with the third power of its diameter.
    Mass,
}

/// The tables of a law.
pub(super) struct Tables {
    /// The name of the law.
    pub(super) name: String,
    /// The smallest diameter, the boundaries between the pieces of the density, and the largest, m.
    pub(super) knots: Vec<f64>,
    /// The distributions by number and by mass; none if there is nothing between the limits.
    pub(super) curves: Option<(Curve, Curve)>,
}

impl Tables {
    /// The tables of a law that counts particles or their mass. Refuses one without limits that
    /// reaches down to diameters of zero.
    pub(super) fn new(law: &Law, by: Basis) -> Result<Self> {
        match law {
            Law::One(d) => Ok(Self {
                name: String::new(),
                knots: vec![*d, *d],
                curves: Some((Curve::single(*d), Curve::single(*d))),
            }),
            Law::Uniform { min, max } => {
                let name = "uniform".to_owned();
                Ok(Self::from_density(name, vec![*min, *max], by, |_, _| 1.0))
            }
            Law::Normal { mean, std, cut } => Self::normal(*mean, *std, *cut, by),
            Law::Lognormal { mean, std, cut } => Self::lognormal(*mean, *std, *cut, by),
            Law::Weibull { scale, shape, cut } => Self::weibull(*scale, *shape, *cut, by),
            Law::Sieve(curve) => {
                let (d, passing) = (&curve.openings_m, &curve.passing);
                let name = format!("sieve curve ({} openings)", d.len());
                let density = |i: usize, _: f64| (passing[i + 1] - passing[i]) / (d[i + 1] - d[i]);
                Ok(Self::from_density(name, d.clone(), by, density))
            }
        }
    }

    fn from_density(
        name: String,
        knots: Vec<f64>,
        by: Basis,
        density: impl Fn(usize, f64) -> f64,
    ) -> Self {
        let curves = curves(&knots, by, density);
        Self {
            name,
            knots,
            curves,
        }
    }

    fn normal(mean: f64, std: f64, cut: Option<Cut>, by: Basis) -> Result<Self> {
        let default = [
            mean - NORMAL_DEVIATE_999 * std,
            mean + NORMAL_DEVIATE_999 * std,
        ];
        let (min, max) = limits(cut, default)?;
        let knots = seeded(min, max, (-12..=12).map(|k| mean + f64::from(k) * std));
        let scale = 1.0 / (std * (2.0 * PI).sqrt());
        let density = |_: usize, d: f64| scale * (-0.5 * ((d - mean) / std).powi(2)).exp();
        Ok(Self::from_density(
            named("normal", mean, std),
            knots,
            by,
            density,
        ))
    }

    fn lognormal(mean: f64, std: f64, cut: Option<Cut>, by: Basis) -> Result<Self> {
        let variance = (std / mean).powi(2).ln_1p();
        let (mu, sigma) = (mean.ln() - 0.5 * variance, variance.sqrt());
        let end = NORMAL_DEVIATE_999 * sigma;
        let (min, max) = limits(cut, [(mu - end).exp(), (mu + end).exp()])?;
        let centres = [mu - 3.0 * variance, mu, mu + 3.0 * variance];
        let seeds = centres
            .into_iter()
            .flat_map(|c| (-12..=12).map(move |k| (c + f64::from(k) * sigma).exp()));
        let knots = seeded(min, max, seeds);
        let scale = 1.0 / (sigma * (2.0 * PI).sqrt());
        let density = |_: usize, d: f64| scale / d * (-0.5 * ((d.ln() - mu) / sigma).powi(2)).exp();
        Ok(Self::from_density(
            named("lognormal", mean, std),
            knots,
            by,
            density,
        ))
    }

    fn weibull(scale: f64, shape: f64, cut: Option<Cut>, by: Basis) -> Result<Self> {
        let quantile = |below: f64| scale * (-(1.0 - below).ln()).powf(1.0 / shape);
        let (min, max) = limits(cut, [quantile(0.001), quantile(0.999)])?;
        let seeds = (-30..=6).map(|k| scale * (f64::from(k) / shape).exp());
        let knots = seeded(min, max, seeds);
        let density = |_: usize, d: f64| {
            let x = d / scale;
            shape / scale * x.powf(shape - 1.0) * (-x.powf(shape)).exp()
        };
        let name = format!(
            "Weibull (scale {}, shape {})",
            show_length(scale),
            significant(shape, 4)
        );
        Ok(Self::from_density(name, knots, by, density))
    }
}

fn named(law: &str, mean: f64, std: f64) -> String {
    format!(
        "{law} (mean {}, standard deviation {})",
        show_length(mean),
        show_length(std)
    )
}

/// The distributions by number and by mass from a density that counts by `by`; pieces as in
/// [`Curve::from_density`]. Masses are relative to that of the smallest particle.
fn curves(knots: &[f64], by: Basis, density: impl Fn(usize, f64) -> f64) -> Option<(Curve, Curve)> {
    let smallest = knots[0];
    let volume = |d: f64| (d / smallest).powi(3);
    let (number, mass) = match by {
        Basis::Number => (
            Curve::from_density(knots, &density),
            Curve::from_density(knots, |i, d| density(i, d) * volume(d)),
        ),
        Basis::Mass => (
            Curve::from_density(knots, |i, d| density(i, d) / volume(d)),
            Curve::from_density(knots, &density),
        ),
    };
    number.zip(mass)
}

/// MIN and MAX as given, or else the diameters `default`.
fn limits(cut: Option<Cut>, default: [f64; 2]) -> Result<(f64, f64)> {
    match cut {
        Some(cut) => Ok((cut.min, cut.max)),
        None if default[0] > 0.0 && default[1].is_finite() => Ok((default[0], default[1])),
        None => Err(Diagnostic::input(
            "",
            format!(
                "0.1 % of this distribution lies below {}, and a diameter must be positive",
                show_length(default[0])
            ),
            "give the limits: MIN..MAX after another comma",
        )),
    }
}

/// `min`, `max` and those of `seeds` between them, ascending: no peak of the density hides inside a
/// piece.
fn seeded(min: f64, max: f64, seeds: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut knots: Vec<f64> = seeds
        .filter(|d| *d > min && *d < max)
        .chain([min, max])
        .collect();
    knots.sort_by(f64::total_cmp);
    knots
}
