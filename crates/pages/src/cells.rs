//! Numbers as text of cells.

use dem_laboratory::Statistic;

/// Mean, and standard deviation if there are several: `12.05 N +- 0.16 N`; how many there are, if
/// some are not. Empty if there are none.
pub(crate) fn scattered(values: &[f64], digits: usize, unit: &str) -> String {
    let there: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let with_unit = |value: f64| format!("{value:.digits$} {unit}").trim_end().to_owned();
    let Statistic {
        mean,
        standard_deviation,
        ..
    } = Statistic::of(&there);
    let cell = match there[..] {
        [] => return String::new(),
        [only] => with_unit(only),
        _ => format!("{} +- {}", with_unit(mean), with_unit(standard_deviation)),
    };
    if there.len() < values.len() {
        return format!("{cell} ({} of {})", there.len(), values.len());
    }
    cell
}

/// Mean of some values with their unit, and the smallest and the largest if there are several.
pub(crate) fn mean_and_range(values: &[f64], unit: &str, digits: usize) -> String {
    let text = format!("{:.digits$} {unit}", mean(values));
    let text = text.trim_end();
    let [least, most] = ends(values);
    match values.len() {
        0 | 1 => text.to_owned(),
        _ => format!("{text} ({least:.digits$} to {most:.digits$})"),
    }
}

/// Smallest to largest: `0.50 to 0.68`. Empty if there are none.
pub(crate) fn range(values: &[f64], digits: usize) -> String {
    least_to_most(values, |value| format!("{value:.digits$}"))
}

/// As [`range`], with numbers written by `text`; one if both ends have the same.
pub(crate) fn least_to_most(values: &[f64], text: impl Fn(f64) -> String) -> String {
    let [least, most] = ends(values).map(text);
    match values {
        [] => String::new(),
        _ if least == most => least,
        _ => format!("{least} to {most}"),
    }
}

/// The smallest and the largest value.
pub(crate) fn ends(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least, most]
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Of the columns of some rows, a value each.
pub(crate) fn columns<const N: usize>(rows: &[[f64; N]], of: fn(&[f64]) -> f64) -> [f64; N] {
    std::array::from_fn(|at| of(&rows.iter().map(|row| row[at]).collect::<Vec<_>>()))
}

/// Each column of some rows with its scatter, to so many digits.
pub(crate) fn over<const N: usize>(rows: &[[f64; N]], digits: [usize; N]) -> [String; N] {
    std::array::from_fn(|at| {
        let column: Vec<f64> = rows.iter().map(|row| row[at]).collect();
        scattered(&column, digits[at], "")
    })
}

pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 {
        values[half]
    } else {
        0.5 * (values[half - 1] + values[half])
    }
}

/// A number with so many digits behind the point. Empty if there is none.
pub(crate) fn rounded(number: f64, digits: usize) -> String {
    if number.is_finite() {
        format!("{number:.digits$}")
    } else {
        String::new()
    }
}

/// A number to three digits.
pub(crate) fn three_digits(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}

/// A change in percent, with its sign.
pub(crate) fn change(fraction: f64, digits: usize) -> String {
    format!("{:+.digits$} %", 100.0 * fraction)
}

/// A whole number with commas between thousands.
pub(crate) fn thousands(number: f64) -> String {
    let digits = format!("{number:.0}");
    let mut text = String::new();
    for (place, digit) in digits.char_indices() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The cells of a row of text, between ` | `.
pub(crate) fn cells(row: &str) -> Vec<String> {
    row.split(" | ").map(str::to_owned).collect()
}
