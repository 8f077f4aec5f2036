//! Factors over time, shared by loads, supports and walls: `ramp`, `table` and `end`.

use super::field::Field;
use super::listing::{LISTED, Listing};
use super::numbers::{number, quantity};
use super::schema::{Key, Kind};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{NUMBER, TIME};
use serde::{Deserialize, Serialize};

/// Factor on a load or a motion, over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Factor {
    /// 1 from the start.
    One,
    /// `ramp`: rises linearly from 0 to 1 until this time, s, and stays at 1.
    Ramp {
        /// End of the rise, s.
        until_s: f64,
    },
    /// `table = [[time, factor], ...]`: linear between the points, constant outside them. Times
    /// increase.
    Table(Vec<[f64; 2]>),
    /// `frequency` and `phase` of a wall: sin(2 pi f t + phase) - sin(phase).
    Oscillation {
        /// f, Hz.
        frequency_hz: f64,
        /// rad.
        phase_rad: f64,
    },
}

impl Factor {
    /// Its largest magnitude at any time.
    pub fn largest(&self) -> f64 {
        match self {
            Self::One | Self::Ramp { .. } => 1.0,
            Self::Table(points) => points.iter().fold(0.0, |most, [_, f]| most.max(f.abs())),
            Self::Oscillation { phase_rad, .. } => 1.0 + phase_rad.sin().abs(),
        }
    }

    /// Its largest change over time, 1/s.
    pub fn steepest_1_s(&self) -> f64 {
        match self {
            Self::One => 0.0,
            Self::Ramp { until_s } => 1.0 / until_s,
            Self::Table(points) => points
                .windows(2)
                .map(|w| ((w[1][1] - w[0][1]) / (w[1][0] - w[0][0])).abs())
                .fold(0.0, f64::max),
            Self::Oscillation { frequency_hz, .. } => std::f64::consts::TAU * frequency_hz,
        }
    }
}

pub(super) const RAMP: Key = Key::quantity(
    "ramp",
    &TIME,
    "The factor rises linearly from 0 to 1 until this time, then stays 1.",
)
.positive();

pub(super) const TABLE: Key = Key::new(
    "table",
    Kind::List(&Kind::Row(&[
        Kind::Quantity(&TIME),
        Kind::Quantity(&NUMBER),
    ])),
    "Factor over time, instead of `ramp`: `[[time, factor], ...]` with increasing times, linear between the rows, constant before and after them.",
);

impl Key {
    /// The key `end`.
    pub(super) const fn until(doc: &'static str) -> Self {
        Self::quantity("end", &TIME, doc)
            .positive()
            .otherwise("never")
    }
}

/// The key for the change of a factor with time, if there is one.
pub(super) fn over_time<'a>(table: &Table<'a>) -> Option<Field<'a>> {
    table.get("ramp").or_else(|| table.get("table"))
}

/// `ramp` or `table`; 1 without either.
pub(super) fn factor(table: &Table<'_>) -> Result<Factor> {
    match (table.get("ramp"), table.get("table")) {
        (None, None) => Ok(Factor::One),
        (Some(_), None) => Ok(Factor::Ramp {
            until_s: table.read("ramp")?,
        }),
        (None, Some(field)) => points(&field),
        (Some(_), Some(field)) => {
            let problem = "cannot be combined with ramp";
            Err(field.fault(problem, "the factor follows one of them: remove the other"))
        }
    }
}

/// `end`, s: not before the last change of the factor.
pub(super) fn end(table: &Table<'_>, factor: &Factor) -> Result<Option<f64>> {
    let Some(field) = table.get("end") else {
        return Ok(None);
    };
    let end_s = table.read("end")?;
    let (last_s, which) = match factor {
        Factor::One => return Ok(Some(end_s)),
        Factor::Ramp { until_s } => (*until_s, "the ramp"),
        Factor::Table(points) => (points.last().map_or(0.0, |row| row[0]), "the table"),
        Factor::Oscillation { .. } => return Ok(Some(end_s)),
    };
    if end_s < last_s {
        let limit = format!("at least {last_s} s, the end of {which}");
        return Err(field.wrong(&limit, format!("write a later end, or shorten {which}")));
    }
    Ok(Some(end_s))
}

/// The factor of the motion given by `moved`. Only the changes of a factor move a displacement, so
/// it must begin at 0.
pub(super) fn factor_from_zero(table: &Table<'_>, moved: &Field<'_>) -> Result<Factor> {
    let factor = factor(table)?;
    let first = match &factor {
        Factor::Ramp { .. } => Some([0.0, 0.0]),
        Factor::Table(points) => points.first().copied(),
        Factor::One | Factor::Oscillation { .. } => None,
    };
    match (first, table.get("table")) {
        (None, _) => {
            let problem = "has no effect without ramp or table";
            Err(moved.fault(problem, "add ramp = \"0.1 s\", the time that it takes"))
        }
        (Some([time_s, first]), Some(field)) if first != 0.0 || time_s < 0.0 => {
            let problem = format!(
                "begins with a factor of {first} at {time_s} s, so {} would be followed in part only",
                moved.path
            );
            Err(field.fault(problem, "begin it with a factor of 0, at 0 s or later"))
        }
        _ => Ok(factor),
    }
}

fn points(field: &Field<'_>) -> Result<Factor> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for item in field.items()? {
        let [time, factor] = item.row("[time, factor]")?;
        let time_s = time.quantity(&TIME)?;
        if let Some([before_s, _]) = points.last()
            && time_s <= *before_s
        {
            let limit = format!("more than the time before it, {before_s} s");
            return Err(time.wrong(&limit, "put the rows in the order of time"));
        }
        points.push([time_s, factor.quantity(&NUMBER)?]);
    }
    Ok(Factor::Table(points))
}

pub(super) fn list(factor: &Factor, listing: &mut Listing) {
    match factor {
        Factor::One => listing.text("factor", "1"),
        Factor::Ramp { until_s } => listing.value("ramp", until_s),
        Factor::Table(points) => {
            let row = |[time_s, factor]: &[f64; 2]| {
                format!("{}: {}", quantity(*time_s, "s"), number(*factor))
            };
            let shown: Vec<String> = points.iter().take(LISTED).map(row).collect();
            listing.some("table", &shown, points.len());
        }
        Factor::Oscillation {
            frequency_hz,
            phase_rad,
        } => {
            listing.value("frequency", frequency_hz);
            listing.value("phase", phase_rad);
        }
    }
}
