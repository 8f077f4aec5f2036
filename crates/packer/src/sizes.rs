//! Particle sizes: what a user asks for, as a distribution function by number and by mass.
//!
//! | text | distribution of the diameter |
//! |---|---|
//! | `2.5mm` | one size |
//! | `2mm..3mm`, `uniform:2mm..3mm` | every size between the two equally often |
//! | `normal:MEAN,STD,MIN..MAX` | normal, cut at MIN and MAX |
//! | `lognormal:MEAN,STD,MIN..MAX` | lognormal, cut; mean and standard deviation of the diameter itself, not of its logarithm |
//! | `weibull:SCALE,SHAPE,MIN..MAX`, `rosin-rammler:...` | F(d) = 1 - exp(-(d/SCALE)^SHAPE), cut |
//! | `sieve:FILE.csv`, `FILE.csv` | opening and cumulative passing, linear between the openings |
//!
//! MEAN, STD, SCALE and SHAPE are those of the whole distribution, before it is cut. Without MIN..MAX it is cut at the
//! diameters that 0.1 % and 99.9 % of it lie below. The distribution counts particles or their mass, as [`Basis`] says;
//! the two are converted into each other with the third power of the diameter.

mod curve;
mod fit;
mod parse;
mod sieve;

use curve::Curve;
use dem_io::units::{show_length, significant};
use dem_io::{Diagnostic, Result};
pub use fit::{Fit, ks_distance_by_mass, ks_distance_by_number};
use parse::{Cut, Law};
use serde::Serialize;

/// The largest size may be so many times the smallest.
pub(crate) const LARGEST_SIZE_RATIO: f64 = 1000.0;
/// Less than this share of a distribution between MIN and MAX is taken for a mistake.
const SMALLEST_SHARE_KEPT: f64 = 0.01;
/// The standard normal deviate that 99.9 % lie below.
const NORMAL_DEVIATE_999: f64 = 3.090_232_306_167_813;

/// What a distribution of sizes counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// Particles.
    Number,
    /// Mass (or volume): each particle with the third power of its diameter.
    Mass,
}

/// A distribution of particle diameters between two limits, in metres.
#[derive(Debug, Clone)]
pub struct Sizes {
    by: Basis,
    description: String,
    min_m: f64,
    max_m: f64,
    mean_volume_m3: f64,
    number: Curve,
    mass: Curve,
}

impl Sizes {
    /// The file of a sieve curve that `text` names, if it names one.
    pub fn file(text: &str) -> Option<&str> {
        parse::file(text)
    }

    /// The sizes that `text` asks for, in one of the forms above; reads the file of a sieve curve.
    ///
    /// # Errors
    /// A text of another form; a size that is zero, negative or not finite; MIN above MAX; a standard deviation or
    /// shape that is not positive; less than 1 % of the distribution between MIN and MAX; MAX more than
    /// [`LARGEST_SIZE_RATIO`] times MIN; a sieve file that cannot be read or is not a cumulative curve.
    pub fn parse(text: &str, by: Basis) -> Result<Self> {
        let place = format!("--diameter '{text}'");
        parse::law(text)
            .and_then(|law| Self::from_law(&law, by))
            .map_err(|e| e.within(&place))
    }

    /// The smallest diameter, m.
    pub fn min_m(&self) -> f64 {
        self.min_m
    }

    /// The largest diameter, m.
    pub fn max_m(&self) -> f64 {
        self.max_m
    }

    /// Mean diameter by number, m.
    pub fn mean_m(&self) -> f64 {
        self.number.mean
    }

    /// Standard deviation over mean of the diameters, by number, and their skewness (0 for one size); to about 1e-3.
    pub fn spread_and_skewness(&self) -> [f64; 2] {
        const PARTS: u32 = 1000;
        let off = |k: u32| {
            let u = (f64::from(k) + 0.5) / f64::from(PARTS);
            self.quantile_by_number(u) / self.mean_m() - 1.0
        };
        let offs: Vec<f64> = (0..PARTS).map(off).collect();
        let moment = |n: i32| offs.iter().map(|off| off.powi(n)).sum::<f64>() / f64::from(PARTS);
        let spread = moment(2).sqrt();
        if spread < 1e-6 {
            return [0.0; 2];
        }
        [spread, moment(3) / spread.powi(3)]
    }

    /// Mean volume of a particle, by number, m3.
    pub fn mean_volume_m3(&self) -> f64 {
        self.mean_volume_m3
    }

    /// What the distribution was asked to count.
    pub fn by(&self) -> Basis {
        self.by
    }

    /// The diameter in metres that the share `u` of the particles lies below: with `u` uniform in [0, 1), a diameter
    /// drawn at random.
    pub fn quantile_by_number(&self, u: f64) -> f64 {
        self.number.quantile(u)
    }

    /// Share of the particles at or below a diameter in metres. Exact to 1e-8.
    pub fn cdf_by_number(&self, diameter_m: f64) -> f64 {
        self.number.cdf(diameter_m)
    }

    /// Share of the particles' mass at or below a diameter in metres. Exact to 1e-8.
    pub fn cdf_by_mass(&self, diameter_m: f64) -> f64 {
        self.mass.cdf(diameter_m)
    }

    /// All particles of one size.
    pub fn is_one_size(&self) -> bool {
        self.min_m == self.max_m
    }

    /// One line for a person: the distribution, its limits and means, and what was done to it.
    pub fn describe(&self) -> &str {
        &self.description
    }

    fn from_law(law: &Law, by: Basis) -> Result<Self> {
        let mut note = String::new();
        let (name, knots, curves) = match law {
            Law::One(d) => (
                String::new(),
                vec![*d, *d],
                Some((Curve::single(*d), Curve::single(*d))),
            ),
            Law::Uniform { min, max } => {
                let knots = vec![*min, *max];
                (
                    "uniform".to_owned(),
                    knots.clone(),
                    curves(&knots, by, |_, _| 1.0),
                )
            }
            Law::Normal { mean, std, cut } => {
                let (min, max) = limits(
                    *cut,
                    [
                        mean - NORMAL_DEVIATE_999 * std,
                        mean + NORMAL_DEVIATE_999 * std,
                    ],
                )?;
                let knots = seeded(min, max, (-12..=12).map(|k| mean + f64::from(k) * std));
                let scale = 1.0 / (std * (2.0 * std::f64::consts::PI).sqrt());
                let density = |_: usize, d: f64| scale * (-0.5 * ((d - mean) / std).powi(2)).exp();
                let name = format!(
                    "normal (mean {}, standard deviation {})",
                    show_length(*mean),
                    show_length(*std)
                );
                (name, knots.clone(), curves(&knots, by, density))
            }
            Law::Lognormal { mean, std, cut } => {
                let variance = (std / mean).powi(2).ln_1p();
                let (mu, sigma) = (mean.ln() - 0.5 * variance, variance.sqrt());
                let end = NORMAL_DEVIATE_999 * sigma;
                let (min, max) = limits(*cut, [(mu - end).exp(), (mu + end).exp()])?;
                let centres = [mu - 3.0 * variance, mu, mu + 3.0 * variance];
                let seeds = centres
                    .into_iter()
                    .flat_map(|c| (-12..=12).map(move |k| (c + f64::from(k) * sigma).exp()));
                let knots = seeded(min, max, seeds);
                let scale = 1.0 / (sigma * (2.0 * std::f64::consts::PI).sqrt());
                let density =
                    |_: usize, d: f64| scale / d * (-0.5 * ((d.ln() - mu) / sigma).powi(2)).exp();
                let name = format!(
                    "lognormal (mean {}, standard deviation {})",
                    show_length(*mean),
                    show_length(*std)
                );
                (name, knots.clone(), curves(&knots, by, density))
            }
            Law::Weibull { scale, shape, cut } => {
                let quantile = |below: f64| scale * (-(1.0 - below).ln()).powf(1.0 / shape);
                let (min, max) = limits(*cut, [quantile(0.001), quantile(0.999)])?;
                let knots = seeded(
                    min,
                    max,
                    (-30..=6).map(|k| scale * (f64::from(k) / shape).exp()),
                );
                let density = |_: usize, d: f64| {
                    let x = d / scale;
                    shape / scale * x.powf(shape - 1.0) * (-x.powf(*shape)).exp()
                };
                let name = format!(
                    "Weibull (scale {}, shape {})",
                    show_length(*scale),
                    significant(*shape, 4)
                );
                (name, knots.clone(), curves(&knots, by, density))
            }
            Law::Sieve(curve) => {
                note.clone_from(&curve.note);
                let (d, passing) = (&curve.openings_m, &curve.passing);
                let curves = curves(d, by, |i, _| {
                    (passing[i + 1] - passing[i]) / (d[i + 1] - d[i])
                });
                (
                    format!("sieve curve ({} openings)", d.len()),
                    d.clone(),
                    curves,
                )
            }
        };
        let (min_m, max_m) = (knots[0], knots[knots.len() - 1]);
        if max_m > LARGEST_SIZE_RATIO * min_m {
            return Err(Diagnostic::input(
                "",
                format!(
                    "the sizes reach from {} to {}, a factor of {}, the limit is {LARGEST_SIZE_RATIO}",
                    show_length(min_m),
                    show_length(max_m),
                    significant(max_m / min_m, 3)
                ),
                "give MIN..MAX closer together",
            ));
        }
        let kept = curves.as_ref().map_or(0.0, |(number, mass)| match by {
            Basis::Number => number.total,
            Basis::Mass => mass.total,
        });
        let whole = matches!(law, Law::One(_) | Law::Uniform { .. } | Law::Sieve(_));
        let (number, mass) = match curves {
            Some(curves) if whole || kept >= SMALLEST_SHARE_KEPT => curves,
            _ => return Err(unreachable_sizes(&name, kept, min_m, max_m)),
        };
        let mean_volume_m3 = std::f64::consts::PI / 6.0
            * if min_m == max_m {
                min_m.powi(3)
            } else {
                min_m.powi(3) * mass.total / number.total
            };
        let description = match law {
            Law::One(d) => format!("all {}", show_length(*d)),
            _ => format!(
                "{name} by {}, {} to {}, mean {} by number and {} by mass{}{note}",
                if by == Basis::Number {
                    "number"
                } else {
                    "mass"
                },
                show_length(min_m),
                show_length(max_m),
                show_length(number.mean),
                show_length(mass.mean),
                if whole {
                    String::new()
                } else {
                    format!(
                        ", {} % of it between the limits",
                        significant(100.0 * kept, 4)
                    )
                },
            ),
        };
        Ok(Self {
            by,
            description,
            min_m,
            max_m,
            mean_volume_m3,
            number,
            mass,
        })
    }
}

/// The distributions by number and by mass from a density that counts by `by`; pieces as in [`Curve::from_density`].
/// The mass of a particle is counted in that of the smallest.
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

/// `min`, `max` and those of `seeds` between them, ascending: no peak of the density hides inside a piece.
fn seeded(min: f64, max: f64, seeds: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut knots: Vec<f64> = seeds
        .filter(|d| *d > min && *d < max)
        .chain([min, max])
        .collect();
    knots.sort_by(f64::total_cmp);
    knots
}

fn unreachable_sizes(name: &str, kept: f64, min: f64, max: f64) -> Diagnostic {
    Diagnostic::input(
        "",
        format!(
            "only {} % of the {name} distribution lies between {} and {}, at least {} % must",
            significant(100.0 * kept, 2),
            show_length(min),
            show_length(max),
            100.0 * SMALLEST_SHARE_KEPT
        ),
        "move MIN..MAX to where the distribution is",
    )
}
