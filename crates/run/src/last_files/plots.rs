//! Plots of the time series: energies together, errors together, every measure separately.

use dem_io::Result;
use dem_plots::{Line, Plot};
use dem_results::folder::names;
use dem_results::summary::{ENERGIES, Energy, EnergyKind, Measured};
use dem_results::{ResultsFolder, Series, read_series};
use dem_scene::Statistic;

use super::fragments::{COUNT, DISCHARGE, SIZES};
use super::strengthening::STRENGTHENING;
use dem_plan::measure::Probe;

/// Names of plots that any run may have, which no measure may overwrite.
const OVERALL: [&str; 7] = [
    ENERGY,
    ERRORS,
    BROKEN,
    COUNT,
    SIZES,
    DISCHARGE,
    STRENGTHENING,
];
const ENERGY: &str = "energy";
const ERRORS: &str = "errors";
const BROKEN: &str = "broken_bonds";

/// Draws the time series of a finished run into its folder. `results`: those of its measures.
pub(crate) fn write_plots(
    folder: &ResultsFolder,
    probes: &[Probe],
    results: &[Measured],
) -> Result<()> {
    let series = read_series(&folder.file(names::SERIES))?;
    let changes = |energy: &Energy| column(&series, energy.name).iter().any(|v| *v != 0.0);
    let changing: Vec<Energy> = ENERGIES.into_iter().filter(changes).collect();
    let names: Vec<&str> = changing.iter().map(|energy| energy.name).collect();
    let mut energy = plot(&series, "Energy", "energy (J)", &names, "_j");
    for (line, of) in energy.lines.iter_mut().zip(&changing) {
        // Energy supplied is dashed, as the total often hides it.
        line.dashed = of.kind == EnergyKind::Work;
    }
    folder.write_plot(ENERGY, &energy.svg().file())?;
    let mut errors = plot(
        &series,
        "Errors of energy and momentum",
        "relative error",
        &["energy_error", "momentum_error", "angular_momentum_error"],
        "_error",
    );
    for point in errors.lines.iter_mut().flat_map(|line| &mut line.points) {
        point[1] = point[1].abs().max(1e-17);
    }
    errors.y.log = true;
    folder.write_plot(ERRORS, &errors.svg().file())?;
    write_broken_plot(folder, &series)?;
    let first = series.columns.len() - probes.len();
    for (probe, name) in probes.iter().zip(&series.columns[first..]) {
        let quantity = probe.measure.quantity_name().replace('_', " ");
        let label = match probe.unit() {
            "" => quantity,
            unit => format!("{quantity} ({unit})"),
        };
        let title = probe.name.replace('_', " ");
        let mut one = plot(&series, &title, &label, &[name], "");
        for line in &mut one.lines {
            line.name.clone_from(&title);
        }
        one.reference = level(probe, results);
        folder.write_plot(&plot_name(probe), &one.svg().file())?;
    }
    Ok(())
}

/// Plots the number of broken bonds over time, if any broke.
pub fn write_broken_plot(folder: &ResultsFolder, series: &Series) -> Result<()> {
    if column(series, "broken_bonds").iter().all(|v| *v == 0.0) {
        return Ok(());
    }
    let mut broken = plot(series, "Broken bonds", "bonds", &["broken_bonds"], "");
    broken.y.whole = true;
    folder.write_plot(BROKEN, &broken.svg().file())
}

/// The horizontal line in the plot of a measure: its reference, or else its result, if that is of
/// every step and not only of the rows of the series.
fn level(probe: &Probe, results: &[Measured]) -> Option<(f64, String)> {
    let reference = probe.measure.reference;
    let of_probe = results.iter().find(|result| result.name == probe.name);
    let result = match probe.measure.statistic {
        Statistic::End => None,
        Statistic::Largest => Some("largest of all steps"),
        Statistic::Smallest => Some("smallest of all steps"),
        Statistic::Mean => Some("mean"),
    };
    let result = result
        .zip(of_probe.filter(|result| !result.value.is_nan()))
        .map(|(name, result)| (result.value, name.to_owned()));
    let reference = reference.map(|value| (value, "reference".to_owned()));
    reference.or(result)
}

/// The plot of a measure.
fn plot_name(probe: &Probe) -> String {
    let is_taken = OVERALL.contains(&probe.name.to_lowercase().as_str());
    let prefix = if is_taken { "measured_" } else { "" };
    format!("{prefix}{}", probe.name)
}

/// Names of the plots of a run with these measures, whatever its results.
pub(crate) fn plots_of_every_run(probes: &[Probe]) -> Vec<String> {
    let overall = [ENERGY, ERRORS].map(str::to_owned);
    overall
        .into_iter()
        .chain(probes.iter().map(plot_name))
        .collect()
}

fn column<'a>(series: &'a Series, name: &str) -> &'a [f64] {
    let at = series.columns.iter().position(|column| column == name);
    at.map_or(&[], |at| &series.values[at])
}

fn plot(series: &Series, title: &str, y: &str, columns: &[&str], suffix: &str) -> Plot {
    let line = |name: &&str| {
        Line::new(
            name.trim_end_matches(suffix).replace('_', " "),
            series
                .times_s
                .iter()
                .zip(column(series, name))
                .map(|(&t, &v)| [t, v])
                // Missing values have no points.
                .filter(|[_, v]| !v.is_nan())
                .collect(),
        )
    };
    Plot::of(title, "time (s)", y, columns.iter().map(line).collect())
}
