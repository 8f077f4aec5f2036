//! Tables of pages: numbers whose printed digits are the same on every machine, and rows that
//! compare computed values with a reference.

/// Relative difference of a result between machines: the last digits of sines, powers and
/// logarithms, which libraries round differently.
const DOUBT: f64 = 1e-12;

/// Relative errors below this are rounding errors, and are not printed.
const ROUNDING: f64 = 1e-9;

/// One case: the result of the solver, its expected value, and the bound of their difference.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    what: String,
    computed: f64,
    reference: f64,
    scale: f64,
    bound: f64,
    rounding: f64,
}

impl Case {
    /// A case whose error is relative to its reference.
    pub(crate) fn new(what: impl Into<String>, computed: f64, reference: f64, bound: f64) -> Self {
        Self::of_scale(what, [computed, reference], reference.abs(), bound)
    }

    /// A case whose error, computed less reference, is relative to `scale`.
    pub(crate) fn of_scale(
        what: impl Into<String>,
        [computed, reference]: [f64; 2],
        scale: f64,
        bound: f64,
    ) -> Self {
        Self {
            what: what.into(),
            computed,
            reference,
            scale,
            bound,
            rounding: ROUNDING,
        }
    }

    /// Its error, relative to its scale.
    pub(crate) fn error(&self) -> f64 {
        (self.computed - self.reference) / self.scale
    }

    /// The same with another bound; infinite: none.
    pub(crate) fn within(self, bound: f64) -> Self {
        Self { bound, ..self }
    }

    /// Sets the limit below which errors are not printed, since their digits depend on the order of
    /// sums.
    pub(crate) fn rounding(self, rounding: f64) -> Self {
        Self { rounding, ..self }
    }

    fn keeps_bound(&self) -> bool {
        self.error().abs() <= self.bound
    }

    fn row(&self) -> String {
        let error = self.error();
        let doubt = DOUBT * self.scale;
        let computed = if self.reference != 0.0 {
            significant(self.computed, doubt)
        } else if error.abs() < self.rounding {
            "0".to_owned()
        } else {
            steady(self.computed, doubt, |value| format!("{value:.1e}"))
        };
        row(&[
            self.what.clone(),
            computed,
            significant(self.reference, doubt),
            if error.abs() < self.rounding {
                format!("< {:.0e}", self.rounding)
            } else {
                steady(error, DOUBT, |error| format!("{error:.1e}"))
            },
            if self.bound.is_finite() {
                format!("{:.1e}", self.bound)
            } else {
                "none".to_owned()
            },
        ])
    }
}

/// The table of these cases, all of which must be within their bounds. `unit` is that of both
/// numbers.
pub(crate) fn compared(of: &str, unit: &str, cases: &[Case]) -> String {
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(", {unit}")
    };
    let computed = format!("computed{unit}");
    let reference = format!("reference{unit}");
    let mut table = head(&[of, &computed, &reference, "relative error", "bound"]);
    for case in cases {
        table += &case.row();
    }
    let off = cases.iter().filter(|case| !case.keeps_bound());
    let off: Vec<&str> = off.map(|case| case.what.as_str()).collect();
    assert!(off.is_empty(), "beyond the bound: {off:?}\n{table}");
    table
}

/// A number with six significant digits, which must not depend on its last `doubt`.
fn significant(value: f64, doubt: f64) -> String {
    if value.abs() <= doubt {
        return "0".to_owned();
    }
    let text = steady(value, doubt, |value| format!("{value:.5e}"));
    let size = text.split_once('e').and_then(|(_, size)| size.parse().ok());
    match size {
        Some(size @ -3..=5) => digits(value, (5 - size) as usize, doubt),
        _ => text,
    }
}

/// A number with this many decimals. It must not depend on `doubt`, the difference between
/// machines.
pub(crate) fn digits(value: f64, decimals: usize, doubt: f64) -> String {
    steady(value, doubt, |value| {
        let text = format!("{value:.decimals$}");
        match text.strip_prefix('-') {
            Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
            _ => text,
        }
    })
}

/// The text of a number, if it is the same for all numbers within `doubt` of it.
fn steady(value: f64, doubt: f64, text: impl Fn(f64) -> String) -> String {
    assert_eq!(text(value - doubt), text(value + doubt), "unsteady digits");
    text(value).replace('-', "−").replace("e−", "e-")
}

/// The row of a table.
pub(crate) fn row(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// The header of a table: words in the first column, numbers in the others.
pub(crate) fn head(cells: &[&str]) -> String {
    let names: Vec<String> = cells.iter().map(|&cell| cell.to_owned()).collect();
    format!("{}|---|{}\n", row(&names), "---:|".repeat(cells.len() - 1))
}
