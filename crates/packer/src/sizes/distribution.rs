//! A distribution of diameters, by number and by mass.

use super::curve::Curve;
use super::laws::{Basis, Tables};
use super::parse::{self, Law};
use dem_io::units::{show_length, significant};
use dem_io::{Diagnostic, Result};

/// Largest ratio of the largest to the smallest size.
pub(crate) const LARGEST_SIZE_RATIO: f64 = 1000.0;
/// Fraction of a distribution between MIN and MAX below which they are taken for a mistake.
const SMALLEST_FRACTION_KEPT: f64 = 0.01;

/// A distribution of particle diameters between two limits, in metres.
#[derive(Debug, Clone)]
pub struct Sizes {
    by: Basis,
    description: String,
    note: Option<String>,
    min_m: f64,
    max_m: f64,
    mean_volume_m3: f64,
    number: Curve,
    mass: Curve,
}

impl Sizes {
    /// The file of a sieve curve named in `text`, if any.
    pub fn file(text: &str) -> Option<&str> {
        parse::file(text)
    }

    /// The sizes described by `text`, in one of the forms above; reads the file of a sieve curve.
    ///
    /// # Errors
    /// A text of another form; a size that is zero, negative or not finite; MIN above MAX; a
    /// standard deviation or shape that is not positive; less than 1 % of the distribution between
    /// MIN and MAX; MAX more than 1000 times MIN; a sieve file that is not a cumulative curve.
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

    /// Standard deviation over mean of the diameters, by number, and their skewness (0 for one
    /// size); accurate to about 1e-3. Length 2.
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

    /// Mean diameter by mass, m.
    pub(crate) fn mean_by_mass_m(&self) -> f64 {
        const PARTS: u32 = 1000;
        let quantiles = || (0..PARTS).map(|k| (f64::from(k) + 0.5) / f64::from(PARTS));
        let moment = |n: i32| -> f64 {
            quantiles()
                .map(|u| self.quantile_by_number(u).powi(n))
                .sum()
        };
        moment(4) / moment(3)
    }

    /// Mean volume of a particle, by number, m3.
    pub fn mean_volume_m3(&self) -> f64 {
        self.mean_volume_m3
    }

    /// The quantity that the distribution counts.
    pub fn by(&self) -> Basis {
        self.by
    }

    /// The diameter in metres below which the fraction `u` of the particles lies: with `u` uniform
    /// in [0, 1), a diameter drawn at random.
    pub fn quantile_by_number(&self, u: f64) -> f64 {
        self.number.quantile(u)
    }

    /// Fraction of the particles at or below a diameter in metres. Accurate to 1e-8.
    pub fn cdf_by_number(&self, diameter_m: f64) -> f64 {
        self.number.cdf(diameter_m)
    }

    /// Fraction of the particles' mass at or below a diameter in metres. Accurate to 1e-8.
    pub fn cdf_by_mass(&self, diameter_m: f64) -> f64 {
        self.mass.cdf(diameter_m)
    }

    /// True if all particles have one size.
    pub fn is_one_size(&self) -> bool {
        self.min_m == self.max_m
    }

    /// What was left out of a sieve curve that does not go from 0 to 100 %, as a sentence.
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// One human-readable line: the distribution, its limits and means, and the changes made to it.
    pub fn describe(&self) -> &str {
        &self.description
    }

    fn from_law(law: &Law, by: Basis) -> Result<Self> {
        let Tables {
            name,
            knots,
            curves,
        } = Tables::new(law, by)?;
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
        let is_whole = matches!(law, Law::One(_) | Law::Uniform { .. } | Law::Sieve(_));
        let (number, mass) = match curves {
            Some(curves) if is_whole || kept >= SMALLEST_FRACTION_KEPT => curves,
            _ => return Err(unreachable_sizes(&name, kept, min_m, max_m)),
        };
        let mean_volume_m3 = std::f64::consts::PI / 6.0
            * if min_m == max_m {
                min_m.powi(3)
            } else {
                min_m.powi(3) * mass.total / number.total
            };
        let mut sizes = Self {
            by,
            description: String::new(),
            note: cut_note(law, by, [min_m, max_m]),
            min_m,
            max_m,
            mean_volume_m3,
            number,
            mass,
        };
        sizes.description = sizes.described(law, &name, (!is_whole).then_some(kept));
        Ok(sizes)
    }

    /// The distribution as text; `kept` is the fraction of it between the limits, where it was cut.
    fn described(&self, law: &Law, name: &str, kept: Option<f64>) -> String {
        let note = match law {
            Law::One(d) => return format!("all {}", show_length(*d)),
            Law::Sieve(curve) => &curve.note,
            _ => "",
        };
        let kept = kept.map_or_else(String::new, |kept| {
            format!(
                ", {} % of it between the limits",
                significant(100.0 * kept, 4)
            )
        });
        format!(
            "{name} by {}, {} to {}, mean {} by number and {} by mass{note}{kept}",
            if self.by == Basis::Number {
                "number"
            } else {
                "mass"
            },
            show_length(self.min_m),
            show_length(self.max_m),
            show_length(self.number.mean),
            show_length(self.mass.mean),
        )
    }
}

/// What was left out of a sieve curve, between whose openings no sizes are known.
fn cut_note(law: &Law, by: Basis, [min_m, max_m]: [f64; 2]) -> Option<String> {
    let Law::Sieve(curve) = law else {
        return None;
    };
    let [below, above] = curve.left_out;
    let of = match by {
        Basis::Number => "number",
        Basis::Mass => "mass",
    };
    let part = |fraction: f64, which: &str, size_m: f64| {
        (fraction > 0.0).then(|| {
            let percent = significant(100.0 * fraction, 3);
            format!("the {percent} % {which} {}", show_length(size_m))
        })
    };
    let parts: Vec<String> = [part(below, "below", min_m), part(above, "above", max_m)]
        .into_iter()
        .flatten()
        .collect();
    (!parts.is_empty()).then(|| {
        format!(
            "The sieve curve leaves {} by {of} without sizes: these are left out, and the rest counts as 100 %. Add the size that nothing passes, or that everything passes, to keep them.",
            parts.join(" and ")
        )
    })
}

fn unreachable_sizes(name: &str, kept: f64, min: f64, max: f64) -> Diagnostic {
    Diagnostic::input(
        "",
        format!(
            "only {} % of the {name} distribution lies between {} and {}, at least {} % must",
            significant(100.0 * kept, 2),
            show_length(min),
            show_length(max),
            100.0 * SMALLEST_FRACTION_KEPT
        ),
        "move MIN..MAX to where the distribution is",
    )
}
