//! From values to positions along an axis, and its ticks.

use crate::plot::Axis;
use crate::text::{shortened, width};

/// Values beyond this are gaps: their sums are not finite.
const LARGEST: f64 = 1e300;

/// Space for the numbers below a plot, px.
const LABELS: f64 = 400.0;

/// Space for the names below a plot, px.
const NAMES: f64 = 500.0;

/// Largest number of labels at a logarithmic axis.
const MOST_LOG_NUMBERS: usize = 7;

/// Positions of values along an axis.
#[derive(Debug, Clone)]
pub(crate) struct Scale {
    /// Ends of the axis: values, or their decimal logarithms.
    low: f64,
    high: f64,
    log: bool,
    /// Label of the axis.
    pub(crate) label: String,
    /// Lines of the grid with their numbers.
    pub(crate) ticks: Vec<Tick>,
    /// Positions of finer grid lines, as fractions of the axis.
    pub(crate) fine: Vec<f64>,
}

/// A number at an axis.
#[derive(Debug, Clone)]
pub(crate) struct Tick {
    /// Position as a fraction of the axis, 0 to 1.
    pub(crate) fraction: f64,
    pub(crate) label: String,
}

/// True if a value can be drawn on an axis.
pub(crate) fn is_drawn(value: f64, log: bool) -> bool {
    value.abs() <= LARGEST && (!log || value > 0.0)
}

impl Scale {
    /// An axis that contains all of these values that [can be drawn](is_drawn); `rounded`: a linear
    /// one begins and ends at ticks.
    pub(crate) fn new(axis: &Axis, values: impl Iterator<Item = f64>, rounded: bool) -> Self {
        if !axis.names.is_empty() {
            return Self::named(axis);
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|value| is_drawn(*value, axis.log)) {
            low = low.min(value);
            high = high.max(value);
        }
        if axis.log {
            return Self::logarithmic(axis, low, high);
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let largest = low.abs().max(high.abs());
        if high - low <= 1e-10 * largest || high - low < 1e-290 {
            // A constant, as far as can be distinguished.
            let room = if largest < 1e-290 { 1.0 } else { 0.1 * largest };
            (low, high) = (low - room, high + room);
        }
        Self::linear(axis, low, high, rounded)
    }

    /// Names at 0, 1, ..., each with equal room.
    fn named(axis: &Axis) -> Self {
        let count = axis.names.len() as f64;
        let tick = |(number, name): (usize, &String)| Tick {
            fraction: (number as f64 + 0.5) / count,
            label: shortened(name, 12.0, NAMES / count),
        };
        Self {
            low: -0.5,
            high: count - 0.5,
            log: false,
            label: axis.label.clone(),
            ticks: axis.names.iter().enumerate().map(tick).collect(),
            fine: Vec::new(),
        }
    }

    fn linear(axis: &Axis, low: f64, high: f64, rounded: bool) -> Self {
        if rounded {
            return Self::with_ticks(axis, low, high, 5.0, true);
        }
        let scale = Self::with_ticks(axis, low, high, 8.0, false);
        let widths = scale.ticks.iter().map(|tick| width(&tick.label, 12.0));
        if widths.sum::<f64>() < LABELS {
            scale
        } else {
            Self::with_ticks(axis, low, high, 5.0, false)
        }
    }

    /// Numbers at round values: at most `intervals` plus one, or plus two if the axis is `rounded`.
    fn with_ticks(axis: &Axis, low: f64, high: f64, intervals: f64, rounded: bool) -> Self {
        let step = nice_step((high - low) / intervals);
        let step = if axis.whole { step.max(1.0) } else { step };
        let (from, to, first, last);
        if rounded {
            // No further step for a twentieth of one.
            (first, last) = ((low / step + 0.05).floor(), (high / step - 0.05).ceil());
            (from, to) = ((first * step).min(low), (last * step).max(high));
        } else {
            (first, last) = ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
            (from, to) = (low, high);
        }
        let (label, power) = with_prefix(&axis.label, from.abs().max(to.abs()));
        let mut scale = Self {
            low: from,
            high: to,
            log: false,
            label,
            ticks: Vec::new(),
            fine: Vec::new(),
        };
        let decimals = f64::from(power) - step.log10() - 1e-6;
        let decimals = decimals.ceil().clamp(0.0, 15.0) as usize;
        let count = (last - first).clamp(0.0, 20.0) as u32;
        scale.ticks = (0..=count)
            .map(|number| {
                let value = (first + f64::from(number)) * step;
                Tick {
                    fraction: scale.fraction(value),
                    label: decimal(value / 10_f64.powi(power), decimals),
                }
            })
            .collect();
        scale
    }

    /// With a margin around the values, at least a factor of two.
    fn logarithmic(axis: &Axis, low: f64, high: f64) -> Self {
        let (low, high) = if low > high {
            (0.0, 1.0)
        } else {
            (low.log10(), high.log10())
        };
        let span = high - low;
        let room = (0.5 * (0.3 - span)).max(0.06 * span).max(0.04);
        let mut scale = Self {
            low: low - room,
            high: high + room,
            log: true,
            label: axis.label.clone(),
            ticks: Vec::new(),
            fine: Vec::new(),
        };
        if let Some(ticks) = scale.steps() {
            scale.ticks = ticks;
            return scale;
        }
        let ticks = scale.numbers();
        let plain = ticks.iter().all(|(_, decade)| (-3..4).contains(decade));
        scale.ticks = (ticks.into_iter())
            .map(|(digit, decade)| Tick {
                fraction: scale.share_of(digit, decade),
                label: match (plain, digit) {
                    (true, _) => decimal(
                        f64::from(digit) * 10_f64.powi(decade),
                        (-decade).max(0) as usize,
                    ),
                    (false, 1) => power_of_ten(decade),
                    (false, _) => format!("{digit}×{}", power_of_ten(decade)),
                },
            })
            .collect();
        if span <= 4.0 {
            let fine = scale.within(&[1, 2, 3, 4, 5, 6, 7, 8, 9], 1);
            let fraction = |(digit, decade)| scale.share_of(digit, decade);
            scale.fine = fine.into_iter().map(fraction).collect();
        }
        scale
    }

    /// Numbers at equal steps, if the ends of the axis differ by less than a factor of four.
    fn steps(&self) -> Option<Vec<Tick>> {
        let [from, to] = [self.low, self.high].map(|log| 10_f64.powf(log));
        if to > 4.0 * from || from < 1e-3 || to > 1e4 {
            return None;
        }
        let step = nice_step((to - from) / 7.0);
        let decimals = -(step.log10() + 1e-6).floor();
        let [first, last] = [(from / step).ceil(), (to / step).floor()];
        let tick = |number: u32| {
            let value = (first + f64::from(number)) * step;
            Tick {
                fraction: self.fraction(value),
                label: decimal(value, decimals.max(0.0) as usize),
            }
        };
        Some((0..=(last - first) as u32).map(tick).collect())
    }

    /// Digits and decades with a number: as many as fit.
    fn numbers(&self) -> Vec<(u32, i32)> {
        let few = [
            &[1, 2, 3, 4, 5, 6, 7, 8, 9][..],
            &[1, 2, 3, 5],
            &[1, 2, 5],
            &[1, 3],
        ];
        let few = few.into_iter().map(|digits| self.within(digits, 1));
        let many = [1, 2, 3, 5, 10, 20, 50].map(|every| self.within(&[1], every));
        let mut fitting = few.chain(many).filter(|all| all.len() <= MOST_LOG_NUMBERS);
        fitting.next().unwrap_or_else(|| self.within(&[1], 100))
    }

    /// These digits of every `every`th decade, as far as they lie on the axis.
    fn within(&self, digits: &[u32], every: i32) -> Vec<(u32, i32)> {
        let decades = self.low.floor() as i32..=self.high.floor() as i32;
        decades
            .filter(|decade| decade.rem_euclid(every) == 0)
            .flat_map(|decade| digits.iter().map(move |digit| (*digit, decade)))
            .filter(|(digit, decade)| {
                let log = f64::from(*decade) + f64::from(*digit).log10();
                (self.low..=self.high).contains(&log)
            })
            .collect()
    }

    fn share_of(&self, digit: u32, decade: i32) -> f64 {
        let log = f64::from(decade) + f64::from(digit).log10();
        (log - self.low) / (self.high - self.low)
    }

    /// The position of a value as a fraction of the axis: 0 to 1 for those for which the axis was
    /// made, 0 for values without a logarithm.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        let value = match self.log {
            true if value > 0.0 => value.log10(),
            true => self.low,
            false => value,
        };
        // Rounding must not carry a point over the edge.
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

/// The next of 1, 2, 5, 10, ... that is not smaller.
fn nice_step(raw: f64) -> f64 {
    let power = 10_f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= raw * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// The label of an axis whose values go up to `largest`, and the power of ten by which they are
/// divided.
fn with_prefix(label: &str, largest: f64) -> (String, i32) {
    const PREFIXES: [&str; 11] = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P"];
    let power = (largest.log10() / 3.0 + 1e-9).floor() as i32 * 3;
    if (0.1..1e4).contains(&largest) {
        return (label.to_owned(), 0);
    }
    let prefix = usize::try_from(power / 3 + 5)
        .ok()
        .and_then(|index| PREFIXES.get(index));
    if let (Some((quantity, unit)), Some(prefix)) = (unit_of(label), prefix) {
        return (format!("{quantity}({prefix}{unit})"), power);
    }
    if (1e-2..0.1).contains(&largest) {
        return (label.to_owned(), 0);
    }
    let factor = format!("×{}", power_of_ten(power));
    match label.strip_suffix(')') {
        Some(open) if open.contains('(') => (format!("{open}, {factor})"), power),
        _ if label.is_empty() => (factor, power),
        _ => (format!("{label} ({factor})"), power),
    }
}

/// `time (s)` in two parts, if the unit takes a prefix.
fn unit_of(label: &str) -> Option<(&str, &str)> {
    const UNITS: [&str; 10] = ["s", "m", "N", "J", "Pa", "W", "Hz", "rad", "V", "A"];
    let open = label.rfind('(')?;
    let unit = label[open + 1..].strip_suffix(')')?;
    let first = unit.split([' ', '/', '·', '*']).next()?;
    UNITS.contains(&first).then_some((&label[..open], unit))
}

/// A number with this many decimals and a minus sign as wide as a plus.
fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// `10⁻³`.
fn power_of_ten(exponent: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |sign: char| {
        sign.to_digit(10)
            .map_or('⁻', |digit| RAISED[digit as usize])
    };
    let exponent: String = exponent.to_string().chars().map(raised).collect();
    format!("10{exponent}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Width of a plot area, px.
    const AREA: f64 = 500.0;

    #[test]
    fn axes_with_logarithms_have_numbers_that_fit() {
        for (low, high) in [
            (0.01, 0.013),
            (0.01, 0.5),
            (1e-3, 20.0),
            (1e-12, 1e-1),
            (3.0, 3.0),
        ] {
            let scale = Scale::new(&Axis::log(""), [low, high].into_iter(), false);
            let names: Vec<&str> = scale.ticks.iter().map(|tick| tick.label.as_str()).collect();
            assert!((3..=9).contains(&names.len()), "{low} {high} {names:?}");
            let room = scale.ticks.windows(2).map(|two| {
                let words = 0.5 * (width(&two[0].label, 12.0) + width(&two[1].label, 12.0));
                AREA * (two[1].fraction - two[0].fraction) - words
            });
            assert!(room.fold(AREA, f64::min) > 4.0, "{low} {high} {names:?}");
            assert!(scale.fraction(low) > 0.0 && scale.fraction(high) < 1.0);
        }
    }
}
