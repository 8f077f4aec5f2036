//! The five regions of a measured curve: before contact, seating, linear, up to the largest force,
//! and the tail behind it (Platzer 2022, 4.4.1.2).

use std::ops::Range;

use crate::curve::Curve;
use crate::elastic::{ELASTIC, elastic_line, elastic_rows};
use crate::fit::{Line, mean, median, noise};
use crate::largest::largest_force;

/// Rows by which the part before contact is known, at least.
const FEWEST_BEFORE: usize = 8;
/// Largest drift of the load cell up to the largest force, as a fraction of that: what rises faster
/// is a specimen that is loaded already.
const LARGEST_DRIFT: f64 = 0.05;
/// Drift of the load cell up to the largest force, as a fraction of that, which is reported, and
/// subtracted only if the unloaded cell behind the failure confirms it.
const NAMED_DRIFT: f64 = 0.02;
/// Largest difference of a confirmed drift from that before contact, as a fraction of it.
const CONFIRMED: f64 = 0.25;
/// Change of slope between 20 % and 60 % of the largest force which is reported.
const CURVED: f64 = 0.05;
/// Largest difference of the force behind the failure from the offset at which the load cell counts
/// as unloaded, as a fraction of the entire rise.
const UNLOADED: f64 = 0.02;
/// Largest relative change of slope over a part that counts as linear, unless noise hides it.
const LINEAR: f64 = 0.01;
/// Change of slope over the straightest part at which a curve has no linear part.
const NOT_LINEAR: f64 = 0.03;
/// Smallest part of the largest force over which a linear part extends.
const LEAST_RISE: f64 = 0.2;
/// Part of the linear region that is left out of the fit at each of its ends.
const TRIMMED: f64 = 0.1;
/// Falls of the force, as fractions of the largest, that tell two peaks from one.
pub const FALL: f64 = 0.2;
const SECOND_PEAK: f64 = 0.3;

/// Regions of a curve, as rows, and what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct Regions {
    /// First row in contact; 0: the curve begins in contact.
    pub contact: usize,
    /// Rows of the linear part.
    pub linear: Range<usize>,
    /// Row of the largest force.
    pub peak: usize,
    /// Force without the offset and the drift of the load cell, N. Length rows.
    pub corrected_n: Vec<f64>,
    /// Offset of the load cell at the first row, N.
    pub offset_n: f64,
    /// Drift of the load cell over the travel, N/m; 0: none that noise does not hide.
    pub drift_n_m: f64,
    /// Standard deviation of the noise of the force, N.
    pub noise_n: f64,
    /// Slope between 20 % and 60 % of the largest force, N/m.
    pub stiffness_n_m: f64,
    /// Travel at which the line fitted there has no force, m.
    pub start_m: f64,
    /// Travel at which the line fitted to the linear part has no force, m.
    pub linear_start_m: f64,
    /// Largest force, N, as [`largest_force`] has it.
    pub largest_n: f64,
    /// What speaks against the curve, a sentence each.
    pub doubts: Vec<String>,
    /// What speaks against its stiffness, a sentence each.
    pub doubts_of_stiffness: Vec<String>,
    /// What was assumed, a sentence each.
    pub notes: Vec<String>,
}

impl Regions {
    /// The regions of a curve.
    pub fn of(curve: &Curve) -> Self {
        let travel = &curve.travel_m;
        let noise_n = noise(&curve.force_n);
        let rough_peak = largest(&curve.force_n);
        let baseline = Baseline::found(travel, &curve.force_n[..=rough_peak], noise_n)
            .through_tail(travel, &curve.force_n, rough_peak, noise_n);
        let (baseline, drift) =
            baseline.with_sure_drift(travel, &curve.force_n, rough_peak, noise_n);
        let corrected_n: Vec<f64> = travel
            .iter()
            .zip(&curve.force_n)
            .map(|(x, force)| force - baseline.line.at(*x))
            .collect();
        let peak = largest(&corrected_n);
        let contact = baseline.contact.min(peak);
        let largest_n = largest_force(travel, &corrected_n).map_or(f64::NAN, |found| found.force_n);
        let mut doubts_of_stiffness = Vec::new();
        if contact == 0 {
            doubts_of_stiffness.push(
                "it begins in contact: the offset of the load cell is taken to be 0".to_owned(),
            );
        }
        let (linear, change) = linear_part(travel, &corrected_n, contact, peak, largest_n);
        if change > NOT_LINEAR {
            doubts_of_stiffness.push(format!(
                "it has no linear part: the slope changes by {:.0} % in the straightest",
                100.0 * change
            ));
        }
        let doubts = two_peaks(curve, &corrected_n, largest_n)
            .into_iter()
            .collect();
        let rising = contact..peak + 1;
        let (ways_m, loads_n) = (&travel[rising.clone()], &corrected_n[rising]);
        let mut notes: Vec<String> = drift.into_iter().collect();
        notes.extend(curved(ways_m, loads_n, largest_n));
        let fit = trimmed(&corrected_n, &linear);
        let of_linear = Line::fitted(&travel[fit.clone()], &corrected_n[fit]);
        let line = elastic_line(ways_m, loads_n, largest_n).unwrap_or(of_linear);
        Self {
            contact,
            linear,
            peak,
            offset_n: baseline.line.at(travel[0]),
            drift_n_m: baseline.line.slope,
            noise_n,
            stiffness_n_m: line.slope,
            start_m: line.zero(),
            linear_start_m: of_linear.zero(),
            largest_n,
            corrected_n,
            doubts,
            doubts_of_stiffness,
            notes,
        }
    }

    /// Travel from the first contact to where the line of the linear part has no force: what the
    /// seating of the specimen adds to the travel, m.
    pub fn seating_m(&self, curve: &Curve) -> f64 {
        self.linear_start_m - curve.travel_m[self.contact]
    }

    /// Travel at the largest force, from where the fitted line has no force, m.
    pub fn travel_at_failure_m(&self, curve: &Curve) -> f64 {
        curve.travel_m[self.peak] - self.start_m
    }
}

/// What the load cell shows without a load.
struct Baseline {
    line: Line,
    /// First row in contact.
    contact: usize,
}

impl Baseline {
    /// Of the rows up to the largest force.
    fn found(travel_m: &[f64], force_n: &[f64], noise_n: f64) -> Self {
        let none = Self {
            line: Line {
                slope: 0.0,
                slope_error: 0.0,
                at_x0: 0.0,
                x0: 0.0,
                residual: 0.0,
            },
            contact: 0,
        };
        let first = median(&force_n[..(force_n.len() / 20).max(5).min(force_n.len())]);
        let rise = force_n[force_n.len() - 1] - first;
        let low = first + 0.05 * rise;
        let Some(low_row) = force_n.iter().rposition(|force| *force < low) else {
            return none;
        };
        let mut rows = low_row;
        let mut found = None;
        while rows >= FEWEST_BEFORE {
            let line = level(&travel_m[..rows], &force_n[..rows]);
            let drift = line.slope * (travel_m[travel_m.len() - 1] - travel_m[0]);
            let is_unloaded =
                drift.abs() <= LARGEST_DRIFT * rise && line.residual <= 1.2 * noise_n + 1e-4 * rise;
            if is_unloaded {
                let loaded_n = 3.0 * line.residual.max(noise_n);
                let within = |row: &usize| force_n[*row] - line.at(travel_m[*row]) <= loaded_n;
                let contact = (0..=low_row).rev().find(within).map_or(0, |row| row + 1);
                // The first rows in contact hide in the noise.
                let before = contact * 4 / 5;
                if before >= FEWEST_BEFORE {
                    let line = level(&travel_m[..before], &force_n[..before]);
                    found = Some(Self { line, contact });
                }
                break;
            }
            rows = rows * 9 / 10;
        }
        found
            .filter(|found| found.contact >= FEWEST_BEFORE)
            .unwrap_or(none)
    }
}

impl Baseline {
    /// The same, tilted so that it goes through the end of the curve as well, where nothing loads
    /// the cell any more: the force there is level, shows no more than the noise, and differs
    /// little from the offset.
    fn through_tail(self, travel_m: &[f64], force_n: &[f64], peak: usize, noise_n: f64) -> Self {
        let from = peak + (force_n.len() - peak) / 2;
        if self.contact == 0 || force_n.len() - from < FEWEST_BEFORE {
            return self;
        }
        let rise = force_n[peak] - self.line.at_x0;
        let rows = ..self.contact * 4 / 5;
        let before = Line::fitted(&travel_m[rows], &force_n[rows]);
        let tail = Line::fitted(&travel_m[from..], &force_n[from..]);
        let slope = (tail.at_x0 - before.at_x0) / (tail.x0 - before.x0);
        let error = tail.slope_error.hypot(before.slope_error);
        let is_unloaded = (tail.at_x0 - before.at_x0).abs() <= UNLOADED * rise
            && tail.residual <= 1.5 * noise_n.max(before.residual)
            && (tail.slope - slope).abs() <= 4.0 * error;
        if !is_unloaded {
            return self;
        }
        Self {
            line: Line { slope, ..before },
            ..self
        }
    }
}

impl Baseline {
    /// The same with a drift that is small, or that the unloaded cell behind the failure confirms,
    /// and a sentence on a larger one.
    fn with_sure_drift(
        self,
        travel_m: &[f64],
        force_n: &[f64],
        peak: usize,
        noise_n: f64,
    ) -> (Self, Option<String>) {
        let line = self.line;
        let rise = force_n[peak] - line.at_x0;
        let drift = line.slope * (travel_m[peak] - travel_m[0]) / rise;
        if self.contact == 0 || drift.abs() <= NAMED_DRIFT {
            return (self, None);
        }
        let percent = 100.0 * drift;
        let from = peak + (force_n.len() - peak) / 2;
        let rows = force_n.len() - from;
        let tail = Line::fitted(&travel_m[from..], &force_n[from..]);
        let (found, foreseen) = (tail.at_x0 - line.at_x0, line.at(tail.x0) - line.at_x0);
        let error = line.slope_error * (tail.x0 - line.x0);
        let is_confirmed = rows >= FEWEST_BEFORE
            && (found - foreseen).abs() <= CONFIRMED * foreseen.abs() + 4.0 * error.abs()
            && tail.residual <= 1.5 * noise_n.max(line.residual);
        if is_confirmed {
            let slope = found / (tail.x0 - line.x0);
            let note = format!(
                "the load cell drifts by {percent:.1} % of the largest force up to it, before contact as behind the failure: this is subtracted"
            );
            let line = Line { slope, ..line };
            return (Self { line, ..self }, Some(note));
        }
        let note = format!(
            "before contact the force rises as if the load cell drifted by {percent:.1} % of the largest force up to it, which no unloaded part behind the failure confirms: not subtracted"
        );
        let line = Line { slope: 0.0, ..line };
        (Self { line, ..self }, Some(note))
    }
}

/// Says where the slope changes within the part that gives the stiffness.
fn curved(way_m: &[f64], force_n: &[f64], largest_n: f64) -> Option<String> {
    let rows = elastic_rows(force_n, largest_n)?;
    let change = if rows.len() < 12 {
        0.0
    } else {
        slope_change(&way_m[rows.clone()], &force_n[rows])
    };
    (change > CURVED).then(|| {
        let [low, high] = ELASTIC.map(|fraction| 100.0 * fraction);
        format!(
            "the slope changes by {:.0} % between {low:.0} % and {high:.0} % of the largest force, where the stiffness is taken",
            100.0 * change
        )
    })
}

/// The line of an unloaded load cell: level, unless its drift stands out of the noise.
fn level(x: &[f64], y: &[f64]) -> Line {
    let line = Line::fitted(x, y);
    if line.slope.abs() > 4.0 * line.slope_error {
        return line;
    }
    Line {
        slope: 0.0,
        at_x0: mean(y),
        ..line
    }
}

/// Row of the largest value.
fn largest(values: &[f64]) -> usize {
    (1..values.len()).fold(0, |best, row| {
        if values[row] > values[best] {
            row
        } else {
            best
        }
    })
}

/// First row from `from` on at which the force has reached a level.
fn reached(force_n: &[f64], from: usize, level_n: f64) -> usize {
    let found = force_n[from..].iter().position(|force| *force >= level_n);
    found.map_or(force_n.len() - 1, |at| from + at)
}

/// The longest part that is straight as far as noise lets one say, and the relative change of slope
/// in it; 0: it is straight.
fn linear_part(
    travel_m: &[f64],
    force_n: &[f64],
    contact: usize,
    peak: usize,
    largest_n: f64,
) -> (Range<usize>, f64) {
    let up_to_peak = &force_n[..=peak];
    let at = |level: usize| reached(up_to_peak, contact, level as f64 / 100.0 * largest_n);
    let mut straightest = (contact..peak + 1, f64::INFINITY);
    let least = (100.0 * LEAST_RISE) as usize;
    for rise in (least..=90).rev().step_by(5) {
        for low in (5..=95 - rise).step_by(5) {
            let rows = at(low)..at(low + rise) + 1;
            if rows.len() < 12 || travel_m[rows.start] == travel_m[rows.end - 1] {
                continue;
            }
            let change = slope_change(&travel_m[rows.clone()], &force_n[rows.clone()]);
            if change < straightest.1 {
                straightest = (rows, change);
            }
        }
        if straightest.1 == 0.0 {
            break;
        }
    }
    straightest
}

/// Largest relative difference of the slope of a third of some rows from that of all; 0 where it is
/// small or no more than noise.
fn slope_change(x: &[f64], y: &[f64]) -> f64 {
    let whole = Line::fitted(x, y);
    let third = x.len() / 3;
    let part = |part: usize| {
        let rows = part * third..(part + 1) * third;
        let line = Line::fitted(&x[rows.clone()], &y[rows]);
        let change = (line.slope - whole.slope).abs();
        let is_small = change <= (LINEAR * whole.slope.abs()).max(3.0 * line.slope_error);
        if is_small {
            0.0
        } else {
            change / whole.slope.abs()
        }
    };
    (0..3).map(part).fold(0.0, f64::max)
}

/// The rows of a part without its ends, by force.
fn trimmed(force_n: &[f64], rows: &Range<usize>) -> Range<usize> {
    let [low, high] = [rows.start, rows.end - 1].map(|row| force_n[row]);
    let cut = TRIMMED * (high - low);
    let part = &force_n[..rows.end];
    let inner = reached(part, rows.start, low + cut)..reached(part, rows.start, high - cut) + 1;
    if inner.len() < 5 { rows.clone() } else { inner }
}

/// Says where a force falls and rises again.
fn two_peaks(curve: &Curve, force_n: &[f64], largest_n: f64) -> Option<String> {
    let mut high = 0;
    let mut fall: Option<(usize, usize)> = None;
    for row in 1..force_n.len() {
        if let Some((_, low)) = &mut fall {
            if force_n[row] < force_n[*low] {
                *low = row;
            }
            let risen = force_n[row] - force_n[*low];
            if risen > SECOND_PEAK * largest_n && force_n[row] > 2.0 * SECOND_PEAK * largest_n {
                let (high, low) = fall?;
                return Some(format!(
                    "it has two peaks: the force falls from {:.4} N (line {}) to {:.4} N and rises to {:.4} N again",
                    force_n[high],
                    curve.lines[high],
                    force_n[low],
                    force_n[row..].iter().fold(0.0_f64, |most, f| most.max(*f))
                ));
            }
        } else if force_n[row] > force_n[high] {
            high = row;
        } else if force_n[row] < force_n[high] - FALL * largest_n {
            fall = Some((high, row));
        }
    }
    None
}
