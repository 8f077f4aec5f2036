//! Output on the fragments of bodies: tables, plots, and a line of the summary.

use std::collections::BTreeSet;

use dem_io::Result;
use dem_io::units::significant;
use dem_plots::{Axis, Line, MOST_LINES, Marks, Plot, Point};
use dem_results::columns::write_table;
use dem_results::folder::names;
use dem_results::summary::FragmentSummary;
use dem_results::{ResultsFolder, TreeRow};

use dem_engine::state::State;
use dem_engine::state::clusters::fragments::mass_fraction_of_largest;
use dem_engine::state::clusters::sizes::Discharged;
use dem_engine::state::clusters::{Cluster, Clusters, Fragment};
use dem_engine::state::model::Model;
use dem_engine::state::population::Population;
use dem_plan::measure::Probe;
use dem_plan::measure::sizes::Fragments;

/// Names of the plots of fragments.
pub(super) const COUNT: &str = "fragments";
pub(super) const SIZES: &str = "fragment_sizes";
pub(super) const DISCHARGE: &str = "discharged_mass";
/// The plots of [`write_fragment_plots`].
pub(crate) const FRAGMENT_PLOTS: [&str; 3] = [COUNT, SIZES, DISCHARGE];

/// Fragmentation of the bodies: `fragments` of the clusters, and what outlets have removed; fines
/// are part of the mass.
pub fn fragment_summary(
    clusters: &Clusters,
    fragments: &[Fragment],
    population: &Population,
) -> FragmentSummary {
    let discharged = &population.discharged;
    let fines_kg: f64 = population.fines_kg.iter().fold(0.0, |sum, kg| sum + kg);
    let ended = clusters.history.iter().filter(|c| c.ended_s.is_some());
    let gone = discharged.iter().map(|gone| gone.size.mass_kg);
    let masses_kg = fragments
        .iter()
        .map(|fragment| fragment.mass_kg)
        .chain(gone);
    let pieces_kg: f64 = masses_kg.clone().sum();
    FragmentSummary {
        count: fragments.len() + discharged.len(),
        inside: fragments.len(),
        mass_fraction_of_largest: match fines_kg {
            0.0 => mass_fraction_of_largest(masses_kg),
            _ => mass_fraction_of_largest(masses_kg) * pieces_kg / (pieces_kg + fines_kg),
        },
        // What has left has ended, but not in pieces.
        splits: ended.count().saturating_sub(discharged.len()),
    }
}

/// Writes the parent of each fragment.
pub fn write_tree(folder: &ResultsFolder, clusters: &Clusters) -> Result<()> {
    let row = |(id, cluster): (u32, &Cluster)| TreeRow {
        fragment_id: id,
        parent_id: cluster.parent,
        created_s: cluster.created_s,
        ended_s: cluster.ended_s,
        particles: cluster.particles,
    };
    let rows = (0..).zip(&clusters.history).map(row);
    write_table(&folder.file(names::FRAGMENT_TREE), &TreeRow::COLUMNS, rows)
}

/// Plots the discharged mass over time, if there is any; the number of fragments over time, if it
/// changes and no measure has it; and the sizes of those at the end and those discharged, if there
/// is more than one.
pub fn write_fragment_plots(
    folder: &ResultsFolder,
    state: &State,
    fragments: &Fragments,
    end_s: f64,
    probes: &[Probe],
) -> Result<()> {
    if !state.population.discharged.is_empty() {
        let plot = discharge_plot(state, end_s);
        folder.write_plot(DISCHARGE, &plot.svg().file())?;
    }
    let Some(clusters) = &state.clusters else {
        return Ok(());
    };
    let counts = counts_over_time(&clusters.history, end_s);
    let counts_fragments = |probe: &Probe| probe.measure.quantity_name() == "count";
    let is_measured = probes.iter().any(counts_fragments);
    if !is_measured && counts.iter().any(|[_, count]| *count != counts[0][1]) {
        let mut plot = plot("Fragments", "time (s)", "fragments", counts);
        plot.y.whole = true;
        folder.write_plot(COUNT, &plot.svg().file())?;
    }
    if fragments.count() > 1 {
        folder.write_plot(SIZES, &size_plot(fragments, &state.model).svg().file())?;
    }
    Ok(())
}

/// Mass that has left through outlets, over time: a line for each outlet and body, the slope of
/// which is its mass flow.
fn discharge_plot(state: &State, end_s: f64) -> Plot {
    let discharged = &state.population.discharged;
    let outlets = &state.model.rules.outlets;
    let flow = |one: &Discharged| (one.outlet, one.size.body);
    let flows: BTreeSet<(u32, u32)> = discharged.iter().map(flow).collect();
    let name = |(outlet, body): (u32, u32)| {
        let body = state.model.body_name(body);
        match outlets.get(outlet as usize) {
            Some(outlet) if outlets.len() > 1 => format!("{}: {body}", outlet.name),
            _ => body.to_owned(),
        }
    };
    let line = |of: (u32, u32)| {
        let own = discharged.iter().filter(|one| flow(one) == of);
        let mut points = vec![[0.0, 0.0]];
        let mut mass_kg = 0.0;
        for one in own {
            points.push([one.time_s, mass_kg]);
            mass_kg += one.size.mass_kg;
            points.push([one.time_s, mass_kg]);
        }
        points.push([end_s, mass_kg]);
        Line::new(name(of), points)
    };
    Plot::of(
        "Discharged mass",
        "time (s)",
        "mass (kg)",
        flows.into_iter().take(MOST_LINES).map(line).collect(),
    )
}

/// Cumulative mass over sieve size: a line for each body, and for all if there are several; d50 is
/// marked.
fn size_plot(fragments: &Fragments, model: &Model) -> Plot {
    let mut curves = fragments.curves(model);
    if curves.len() == 2 {
        // The first is all together.
        curves.remove(0);
    }
    curves.truncate(MOST_LINES - 1);
    let millimetres = |[size_m, fraction]: [f64; 2]| [1e3 * size_m, fraction];
    // As many kinds of marks as lines, so that each has the colour of its line.
    let d50 = |(name, _, d50_m): &(&str, Vec<[f64; 2]>, f64)| Marks {
        points: vec![Point {
            at: [1e3 * d50_m, 0.5],
            filled: true,
            title: format!("{name}: d50 = {} mm", significant(1e3 * d50_m, 3)),
            ..Point::default()
        }],
        ..Marks::default()
    };
    let lines = curves.iter().map(|(name, points, _)| {
        Line::new(*name, points.iter().copied().map(millimetres).collect())
    });
    let mut lines: Vec<Line> = lines.collect();
    let resolved_mm = 1e3 * fragments.all_resolved_from_m(model);
    if resolved_mm > 0.0 {
        lines.push(Line::dashed(
            "unresolved below",
            vec![[resolved_mm, 0.0], [resolved_mm, 1.0]],
        ));
    }
    let mut x = Axis::of("sieve size, the width of a fragment (mm)");
    x.log = true;
    Plot {
        title: "Fragment sizes, with marks at d50".to_owned(),
        x,
        y: Axis::of("cumulative mass fraction"),
        lines,
        marks: curves.iter().map(d50).collect(),
        ..Plot::default()
    }
}

/// Time, s, and number of fragments, with a step at every change, of all present and former
/// clusters.
pub fn counts_over_time(history: &[Cluster], end_s: f64) -> Vec<[f64; 2]> {
    let created = history.iter().map(|c| (c.created_s, 1.0));
    let ended = history.iter().filter_map(|c| c.ended_s);
    let mut changes: Vec<(f64, f64)> = created.chain(ended.map(|time_s| (time_s, -1.0))).collect();
    changes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut count = 0.0;
    for same in changes.chunk_by(|a, b| a.0 == b.0) {
        let time_s = same[0].0;
        if !points.is_empty() {
            points.push([time_s, count]);
        }
        count += same.iter().map(|(_, change)| change).sum::<f64>();
        points.push([time_s, count]);
    }
    points.push([end_s, count]);
    points
}

fn plot(title: &str, x: &str, y: &str, points: Vec<[f64; 2]>) -> Plot {
    Plot::of(title, x, y, vec![Line::new(title.to_lowercase(), points)])
}
