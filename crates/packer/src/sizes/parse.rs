//! The sizes as typed -> a law with checked numbers, in metres.

use dem_io::sieve_curve::{self, SieveCurve};
use dem_io::units::{length_m, show_length};
use dem_io::{Diagnostic, Result};
use std::ops::RangeInclusive;

const FORMS: &str = "write one of 2.5mm, 2mm..3mm, normal:MEAN,STD,MIN..MAX, lognormal:MEAN,STD,MIN..MAX, \
                     weibull:SCALE,SHAPE,MIN..MAX, sieve:FILE.csv";
/// Diameters that make sense for particles, m.
const SENSIBLE_M: RangeInclusive<f64> = 1e-12..=1e6;
/// Ratio of standard deviation to mean below which the distribution is one size.
const SMALLEST_SPREAD: f64 = 1e-6;
const SHAPES: RangeInclusive<f64> = 0.05..=1000.0;

/// Limits of a distribution, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    pub(super) min: f64,
    pub(super) max: f64,
}

/// A distribution as typed. Lengths in metres.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Law {
    One(f64),
    Uniform {
        min: f64,
        max: f64,
    },
    Normal {
        mean: f64,
        std: f64,
        cut: Option<Cut>,
    },
    Lognormal {
        mean: f64,
        std: f64,
        cut: Option<Cut>,
    },
    Weibull {
        scale: f64,
        shape: f64,
        cut: Option<Cut>,
    },
    Sieve(SieveCurve),
}

/// The file of a sieve curve named in `text`.
pub(super) fn file(text: &str) -> Option<&str> {
    let text = text.trim();
    match text.split_once(':') {
        Some((name, file)) if name.trim().eq_ignore_ascii_case("sieve") => Some(file.trim()),
        _ => Some(text).filter(|text| text.to_ascii_lowercase().ends_with(".csv")),
    }
}

pub(super) fn law(text: &str) -> Result<Law> {
    let text = text.trim();
    let (name, rest) = text.split_once(':').unwrap_or(("", text));
    match name.trim().to_ascii_lowercase().as_str() {
        "uniform" => {
            let (min, max) = range(rest)?;
            Ok(if min == max {
                Law::One(min)
            } else {
                Law::Uniform { min, max }
            })
        }
        "normal" => {
            let ([mean, std], cut) = mean_and_std("normal", rest)?;
            Ok(Law::Normal { mean, std, cut })
        }
        "lognormal" => {
            let ([mean, std], cut) = mean_and_std("lognormal", rest)?;
            Ok(Law::Lognormal { mean, std, cut })
        }
        "weibull" | "rosin-rammler" => weibull(rest),
        "sieve" => sieve_curve::read(rest.trim()).map(Law::Sieve),
        _ if text.to_ascii_lowercase().ends_with(".csv") => sieve_curve::read(text).map(Law::Sieve),
        "" if text.contains("..") => law(&format!("uniform:{text}")),
        "" => diameter(text).map(Law::One),
        unknown => Err(Diagnostic::input(
            "",
            format!("'{unknown}' is not a distribution of sizes"),
            FORMS,
        )),
    }
}

/// The comma-separated parts: two parameters and, if given, MIN..MAX.
fn parts<'a>(name: &str, form: &str, rest: &'a str) -> Result<(&'a str, &'a str, Option<&'a str>)> {
    let parts: Vec<&str> = rest.split(',').map(str::trim).collect();
    match parts[..] {
        [first, second] => Ok((first, second, None)),
        [first, second, limits] => Ok((first, second, Some(limits))),
        _ => Err(Diagnostic::input(
            "",
            format!(
                "'{name}' takes two or three values separated by commas, here are {}",
                parts.len()
            ),
            format!("write {name}:{form} (a decimal point, not a comma)"),
        )),
    }
}

fn mean_and_std(name: &str, rest: &str) -> Result<([f64; 2], Option<Cut>)> {
    let (mean_text, std_text, limits) = parts(name, "MEAN,STD,MIN..MAX", rest)?;
    same_notation(&[mean_text, std_text])?;
    let mean = diameter(mean_text).map_err(|e| e.within("mean"))?;
    let std = length_m(std_text).map_err(|e| e.within("standard deviation"))?;
    if std <= SMALLEST_SPREAD * mean {
        return Err(Diagnostic::input(
            "standard deviation",
            format!(
                "'{std_text}' is {}, the least is {SMALLEST_SPREAD} of the mean",
                show_length(std)
            ),
            format!("give a larger one, or write one size: {mean_text}"),
        ));
    }
    Ok(([mean, std], cut(limits, mean_text)?))
}

fn weibull(rest: &str) -> Result<Law> {
    let (scale_text, shape_text, limits) = parts("weibull", "SCALE,SHAPE,MIN..MAX", rest)?;
    let scale = diameter(scale_text).map_err(|e| e.within("scale"))?;
    let shape: f64 = shape_text.parse().map_err(|_| {
        Diagnostic::input(
            "shape",
            format!("'{shape_text}' is not a plain number"),
            "write a number such as 3.5, without a unit",
        )
    })?;
    if !SHAPES.contains(&shape) {
        return Err(Diagnostic::input(
            "shape",
            format!("{shape} is outside {} to {}", SHAPES.start(), SHAPES.end()),
            "a larger shape is a narrower distribution; 1 to 10 is usual",
        ));
    }
    Ok(Law::Weibull {
        scale,
        shape,
        cut: cut(limits, scale_text)?,
    })
}

/// MIN..MAX, with or without units like the text `beside` it.
fn cut(limits: Option<&str>, beside: &str) -> Result<Option<Cut>> {
    let Some(limits) = limits else {
        return Ok(None);
    };
    let (min, max) = range(limits)?;
    same_notation(&[beside, limits])?;
    if min == max {
        return Err(Diagnostic::input(
            "MIN..MAX",
            format!("both limits are {}", show_length(min)),
            "give a largest size above the smallest, or one size alone",
        ));
    }
    Ok(Some(Cut { min, max }))
}

/// The two diameters of "2mm..3mm", in order.
fn range(text: &str) -> Result<(f64, f64)> {
    let Some((min_text, max_text)) = text.split_once("..") else {
        return Err(Diagnostic::input(
            "",
            format!("'{}' is not a range of sizes", text.trim()),
            "write the smallest and the largest with two dots between, such as 2mm..3mm",
        ));
    };
    same_notation(&[min_text, max_text])?;
    let (min, max) = (diameter(min_text)?, diameter(max_text)?);
    if min > max {
        return Err(Diagnostic::input(
            "",
            format!(
                "the smallest size {} is above the largest {}",
                show_length(min),
                show_length(max)
            ),
            "write the smallest first, such as 2mm..3mm",
        ));
    }
    Ok((min, max))
}

/// A positive length in metres.
fn diameter(text: &str) -> Result<f64> {
    let length = length_m(text).map_err(|mut e| {
        if !text
            .trim()
            .starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'))
        {
            FORMS.clone_into(&mut e.remedy);
        }
        e
    })?;
    if length <= 0.0 {
        return Err(Diagnostic::input(
            "",
            format!("the size '{}' is not positive", text.trim()),
            "a diameter must be above zero, such as 2.5mm",
        ));
    }
    if !SENSIBLE_M.contains(&length) {
        return Err(Diagnostic::input(
            "",
            format!(
                "the size '{}' is outside {} m to {} m",
                text.trim(),
                SENSIBLE_M.start(),
                SENSIBLE_M.end()
            ),
            "check the unit, such as 2.5mm",
        ));
    }
    Ok(length)
}

/// Requires all numbers with a unit, or none: a plain number is in metres, so "2..3mm" would be 2 m
/// to 3 mm.
fn same_notation(texts: &[&str]) -> Result<()> {
    let has_unit = |text: &&str| text.trim().ends_with(|c: char| c.is_alphabetic());
    if texts.iter().all(has_unit) || !texts.iter().any(has_unit) {
        return Ok(());
    }
    Err(Diagnostic::input(
        "",
        format!(
            "'{}' mix numbers with and without a unit, and a plain number is metres",
            texts.join("' and '")
        ),
        "write a unit at each of them, such as 2mm..3mm",
    ))
}
