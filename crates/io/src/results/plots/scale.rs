//! From values to places along an axis, and the ticks of it.

use super::contents::Axis;
use super::text::width;

/// Values beyond this are gaps: sums of them are not finite.
const LARGEST: f64 = 1e300;

/// Room for the numbers below a plot, px.
const LABELS: f64 = 400.0;

/// Where values stand along an axis.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    /// Ends of the axis: values, or their decimal logarithms.
    low: f64,
    high: f64,
    log: bool,
    /// What stands at the axis.
    pub(super) label: String,
    /// Lines of the grid with their numbers.
    pub(super) ticks: Vec<Tick>,
    /// Shares of the axis at which finer lines of the grid stand.
    pub(super) fine: Vec<f64>,
}

/// A number at an axis.
#[derive(Debug, Clone)]
pub(super) struct Tick {
    /// Share of the axis, 0 to 1.
    pub(super) share: f64,
    pub(super) label: String,
}

/// Whether a value has a place on an axis.
pub(super) fn is_drawn(value: f64, log: bool) -> bool {
    value.abs() <= LARGEST && (!log || value > 0.0)
}

impl Scale {
    /// An axis on which all of these values have a place; `rounded`: it begins and ends at ticks.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>, rounded: bool) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values {
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
            // A constant, as far as can be told.
            let room = if largest < 1e-290 { 1.0 } else { 0.1 * largest };
            (low, high) = (low - room, high + room);
        }
        Self::linear(axis, low, high, rounded)
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

    /// Numbers at round values, at most `intervals` and one more, or two if the axis is `rounded`.
    fn with_ticks(axis: &Axis, low: f64, high: f64, intervals: f64, rounded: bool) -> Self {
        let step = nice_step((high - low) / intervals);
        let step = if axis.whole { step.max(1.0) } else { step };
        // A little more than a whole step is one, not two.
        let (from, to, first, last);
        if rounded {
            (first, last) = ((low / step + 1e-6).floor(), (high / step - 1e-6).ceil());
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
                    share: scale.share(value),
                    label: decimal(value / 10_f64.powi(power), decimals),
                }
            })
            .collect();
        scale
    }

    /// Whole decades.
    fn logarithmic(axis: &Axis, low: f64, high: f64) -> Self {
        let (from, mut to) = if low > high {
            (0.0, 1.0)
        } else {
            ((low.log10() + 1e-9).floor(), (high.log10() - 1e-9).ceil())
        };
        if to <= from {
            to = from + 1.0;
        }
        let decades = to - from;
        let step = if decades <= 8.0 {
            1.0
        } else {
            nice_step(decades / 8.0).max(2.0)
        };
        let mut scale = Self {
            low: from,
            high: to,
            log: true,
            label: axis.label.clone(),
            ticks: Vec::new(),
            fine: Vec::new(),
        };
        let share = |exponent: f64| (exponent - from) / decades;
        let first = (from / step).ceil();
        let count = ((to / step).floor() - first) as u32;
        scale.ticks = (0..=count)
            .map(|number| {
                let exponent = (first + f64::from(number)) * step;
                Tick {
                    share: share(exponent),
                    label: power_of_ten(exponent as i32),
                }
            })
            .collect();
        if decades <= 2.0 {
            // Few decades: the numbers of their ends alone would say little.
            for decade in 0..count {
                for digit in [2, 5] {
                    let exponent = from + f64::from(decade);
                    scale.ticks.push(Tick {
                        share: share(exponent + f64::from(digit).log10()),
                        label: format!("{digit}×{}", power_of_ten(exponent as i32)),
                    });
                }
            }
        }
        if decades <= 4.0 {
            scale.fine = (0..count)
                .flat_map(|decade| {
                    (2..10).map(move |digit| {
                        share(from + f64::from(decade) + f64::from(digit).log10())
                    })
                })
                .collect();
        }
        scale
    }

    /// The share of the axis at which a value stands: 0 to 1 for those that the axis was made for.
    pub(super) fn share(&self, value: f64) -> f64 {
        let value = if self.log { value.log10() } else { value };
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

/// The label of an axis whose values go up to `largest`, and the power of ten by which they are divided.
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

/// `time (s)` in two, if the unit is one that takes a prefix.
fn unit_of(label: &str) -> Option<(&str, &str)> {
    const UNITS: [&str; 10] = ["s", "m", "N", "J", "Pa", "W", "Hz", "rad", "V", "A"];
    let open = label.rfind('(')?;
    let unit = label[open + 1..].strip_suffix(')')?;
    let first = unit.split([' ', '/', '·', '*']).next()?;
    UNITS.contains(&first).then_some((&label[..open], unit))
}

/// A number with this many decimals and a minus of the width of a plus.
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
    let raised = exponent
        .to_string()
        .chars()
        .map(|letter| match letter {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            _ => '⁹',
        })
        .collect::<String>();
    format!("10{raised}")
}
