//! The plot of the factor by which the strain rate raises strengths, over the rate, with the bonds
//! of a run on it: where each broke, and where the others are at the end.

use std::collections::BTreeSet;
use std::path::PathBuf;

use dem_io::Result;
use dem_io::units::significant;
use dem_plots::{Axis, Line, MOST_LINES, Marks, Plot, Point};
use dem_results::folder::names;
use dem_results::read_strengthened;
use dem_scene::Scene;

use super::last_state::LastState;
use dem_engine::state::State;
use dem_physics::bond::rate_strengthening::{IncreaseCurve, RateStrengthening};
use dem_physics::bond::strain_rate::HIGHEST_1_S;
use dem_plan::bond_kinds::strengthening;
use dem_plan::measure::dynamic_utilisations;

/// Name of the plot.
pub(super) const STRENGTHENING: &str = "rate_strengthening";
/// The lowest rate of the plot, 1/s; slower bonds lie there. The highest is that of eq. 20, or of
/// the fastest bond.
const LOWEST_1_S: f64 = 1e-6;
/// Points of a curve for each decade of the rate.
const PER_DECADE: f64 = 25.0;
/// Largest number of marks of the bonds that broke, and of the others.
const MOST_MARKS: usize = 20;

/// Draws the plot, if bodies of the scene have bonds whose strength depends on the rate.
pub(super) fn strengthening_plot(last: &LastState<'_>) -> Result<Vec<PathBuf>> {
    let curves = curves(last.scene);
    if curves.is_empty() {
        return Ok(Vec::new());
    }
    let broken = read_strengthened(&last.folder.file(names::EVENTS))?;
    let plot = plot(&curves, broken, intact(last.state));
    last.folder.write_plot(STRENGTHENING, &plot.svg().file())?;
    Ok(vec![last.folder.plot(STRENGTHENING)])
}

/// The kinds of bonds of bodies whose strength depends on the rate, by name.
fn curves(scene: &Scene) -> Vec<(&str, RateStrengthening)> {
    let used = scene.bodies.values().filter_map(|b| b.bond_kind.as_deref());
    let used: BTreeSet<&str> = used.collect();
    let curve = |name: &&str| strengthening(&scene.bonds.get(*name)?.failure);
    used.iter()
        .filter_map(|name| Some((*name, curve(name)?)))
        .collect()
}

/// Rate, 1/s, and factor of each intact bond whose strength depends on the rate.
fn intact(state: &State) -> Vec<[f64; 2]> {
    let bonds = &state.bonds;
    let depends = |at: usize| bonds.rules[bonds.rule_of(at)].strengthening.is_some();
    let each = dynamic_utilisations(state).into_iter().enumerate();
    each.filter(|(at, _)| depends(*at))
        .filter_map(|(at, bond)| {
            let bond = bond?;
            let rate_1_s = bonds.deciding_rate_1_s(at, bond.strain_rate_1_s);
            Some([rate_1_s, bond.increase_factor])
        })
        .collect()
}

/// The curves, with the bonds that have broken and those that are intact: rates, 1/s, and factors.
pub fn plot(
    curves: &[(&str, RateStrengthening)],
    broken: Vec<[f64; 2]>,
    intact: Vec<[f64; 2]>,
) -> Plot {
    let all = broken.iter().chain(&intact);
    let highest_1_s = all.fold(HIGHEST_1_S, |most, [rate, _]| most.max(*rate));
    let lines = curves.iter().take(MOST_LINES).map(|(name, strengthening)| {
        let rates = rates(&strengthening.curve, highest_1_s).into_iter();
        let points = rates.map(|rate| [rate, strengthening.factor(rate)]);
        let kept = if strengthening.keeps_largest {
            ", largest so far"
        } else {
            ""
        };
        Line::new(format!("{name}{kept}"), points.collect())
    });
    let lines: Vec<Line> = lines.collect();
    // Kinds of marks take colours in the order of lines: those of bonds come after them.
    let mut of_bonds = vec![Marks::default(); lines.len()];
    of_bonds.extend(marks("intact at the end", false, intact));
    of_bonds.extend(marks("broken", true, broken));
    Plot {
        title: "Dynamic increase factor of the bonds".to_owned(),
        x: Axis::log("strain rate (1/s)"),
        y: Axis::of("dynamic over static strength"),
        lines,
        marks: of_bonds,
        ..Plot::default()
    }
}

/// Rates at which a curve is drawn, 1/s: evenly spaced, and where it bends or jumps.
fn rates(curve: &IncreaseCurve, highest_1_s: f64) -> Vec<f64> {
    let decades = (highest_1_s / LOWEST_1_S).log10();
    let count = (PER_DECADE * decades).ceil() as u32;
    let even = |i| LOWEST_1_S * (highest_1_s / LOWEST_1_S).powf(f64::from(i) / f64::from(count));
    let mut rates: Vec<f64> = (0..=count).map(even).collect();
    let corners: Vec<f64> = match curve {
        IncreaseCurve::Platzer { from_1_s } => vec![*from_1_s],
        IncreaseCurve::Table(rows) => rows.iter().map(|[rate, _]| *rate).collect(),
    };
    rates.extend(corners.iter().flat_map(|rate| [rate.next_down(), *rate]));
    rates.retain(|rate| (LOWEST_1_S..=highest_1_s).contains(rate));
    rates.sort_by(f64::total_cmp);
    rates
}

/// At most [`MOST_MARKS`] marks of bonds at their rates and factors: every n-th in the order of
/// rates. None: there are no bonds.
fn marks(what: &str, filled: bool, mut bonds: Vec<[f64; 2]>) -> Option<Marks> {
    bonds.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let every = bonds.len().div_ceil(MOST_MARKS);
    if every == 0 {
        return None;
    }
    let shown = match every {
        1 => String::new(),
        _ => format!(", one mark for {every}"),
    };
    let point = |[rate_1_s, factor]: &[f64; 2]| Point {
        at: [rate_1_s.max(LOWEST_1_S), *factor],
        filled,
        title: format!(
            "{} 1/s: {}",
            significant(*rate_1_s, 3),
            significant(*factor, 3)
        ),
        ..Point::default()
    };
    Some(Marks {
        name: format!("{} {what}{shown}", bonds.len()),
        points: bonds
            .iter()
            .skip(every / 2)
            .step_by(every)
            .map(point)
            .collect(),
        ..Marks::default()
    })
}
