//! Files that a run writes once it has ended, and their recovery if the run was killed while
//! writing them.

use std::path::PathBuf;

use dem_io::safe_write::{explain, write_file};
use dem_io::{Diagnostic, Result, read_input};
use dem_report::report;
use dem_results::{
    MixingRow, ResultsFolder, Summary, from_json, write_distribution, write_flows, write_mixing,
};
use dem_scene::Scene;
use serde::{Deserialize, Serialize};

use super::pictures::{Order, Pictures};
use super::schedule::OutputSchedule;
use super::settings::RunSettings;
use super::snapshot::fingerprint;
use crate::output::flows::flow_rows;
use crate::output::fragments::{FRAGMENT_PLOTS, write_fragment_plots, write_tree};
use crate::output::plots::{plots_of_every_run, write_plots};
use dem_engine::state::State;
use dem_plan::Plan;
use dem_plan::measure::sizes::Fragments;
use dem_plan::measure::{Probe, probes};
use dem_rig::watch::Watch;

/// Data that a finished run leaves next to its last checkpoint, before it writes plots, film, page
/// and summary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct End {
    /// `summary.json`.
    summary: String,
    /// Tables and plots of the fragments, which the state of the checkpoint, half a step later,
    /// would change: path in the folder and text of each file.
    tables: Vec<(String, String)>,
}

impl End {
    pub(super) fn of(summary: &Summary) -> Result<Self> {
        let json = serde_json::to_string_pretty(summary)
            .map_err(|error| Diagnostic::failed("summary.json", error.to_string(), ""))?;
        Ok(Self {
            summary: format!("{json}\n"),
            tables: Vec::new(),
        })
    }

    /// Writes the tables and plots of the fragments of a run that ends in this state after
    /// `end_s`, s, and keeps them.
    ///
    /// # Errors
    /// Those of the files.
    pub(super) fn write_tables(
        &mut self,
        folder: &ResultsFolder,
        scene: &Scene,
        (state, end_s): (&State, f64),
        probes: &[Probe],
    ) -> Result<()> {
        let Some(clusters) = &state.clusters else {
            return Ok(());
        };
        let output = scene.output.as_ref();
        let fragments = Fragments::of(state).unwrap_or_default();
        write_tree(folder, clusters)?;
        write_fragment_plots(folder, state, &fragments, end_s, probes)?;
        let sieves_m = output.map_or(&[][..], |output| &output.sieves_m);
        write_distribution(
            &folder.distribution(),
            &fragments.rows(&state.model, sieves_m),
        )?;
        if state.model.rules.have_flows() {
            let interval_s = output.and_then(|output| output.flow_s);
            let rows = flow_rows(state, interval_s.unwrap_or(end_s / 20.0), end_s);
            write_flows(&folder.flow(), &rows)?;
        }
        if probes.iter().any(Probe::mixes) {
            write_cells(folder, state, probes)?;
        }
        let plots = FRAGMENT_PLOTS.iter().map(|name| folder.plot(name));
        let paths = plots.chain(tables(folder, state, probes));
        for path in paths.filter(|path| path.is_file()) {
            let text = read_input(&path, "a file of results")?;
            let name = path.strip_prefix(folder.path()).unwrap_or(&path);
            let text = String::from_utf8_lossy(&text).into_owned();
            self.tables.push((name.display().to_string(), text));
        }
        Ok(())
    }

    /// Writes the tables that [`Self::write_tables`] has kept.
    ///
    /// # Errors
    /// Those of the files.
    fn write_kept(&self, folder: &ResultsFolder) -> Result<()> {
        for (name, text) in &self.tables {
            let path = folder.path().join(name);
            if let Some(parent) = path.parent() {
                std::fs::create_dir_all(parent).map_err(|error| explain(parent, &error))?;
            }
            write_file(&path, |out| out.write_all(text.as_bytes()))?;
        }
        Ok(())
    }

    /// Writes plots, film and page of a run whose tables are written, and its summary last: if the
    /// summary exists, all files do.
    ///
    /// # Errors
    /// Those of the files.
    pub(super) fn write(
        &self,
        folder: &ResultsFolder,
        probes: &[Probe],
        pictures: Option<&mut Pictures>,
    ) -> Result<()> {
        let summary: Option<Summary> = (serde_json::from_str(&self.summary))
            .and_then(from_json)
            .ok();
        let measures = summary.map_or_else(Vec::new, |summary| summary.measures);
        write_plots(folder, probes, &measures)?;
        if let Some(pictures) = pictures {
            pictures.finish()?;
        }
        self.write_page(folder)?;
        self.write_summary(folder)
    }

    /// Writes `report.html` from the other files of the run.
    ///
    /// # Errors
    /// Those of the files.
    pub(super) fn write_page(&self, folder: &ResultsFolder) -> Result<()> {
        let page = report(folder.path(), &self.summary)?;
        write_file(&folder.report(), |out| out.write_all(page.as_bytes()))
    }

    /// Writes `summary.json`.
    ///
    /// # Errors
    /// Those of the file.
    pub(super) fn write_summary(&self, folder: &ResultsFolder) -> Result<()> {
        write_file(&folder.summary(), |out| {
            out.write_all(self.summary.as_bytes())
        })
    }
}

/// The tables of a run with fragments.
fn tables(folder: &ResultsFolder, state: &State, probes: &[Probe]) -> Vec<PathBuf> {
    let mut tables = vec![folder.fragment_tree(), folder.distribution()];
    tables.extend(state.model.rules.have_flows().then(|| folder.flow()));
    tables.extend(probes.iter().any(Probe::mixes).then(|| folder.mixing()));
    tables
}

/// Writes the cells of all mixing indices.
fn write_cells(folder: &ResultsFolder, state: &State, probes: &[Probe]) -> Result<()> {
    let rows: Vec<MixingRow<'_>> = probes
        .iter()
        .flat_map(|probe| {
            let cells = probe.mixed_cells(state).into_iter();
            cells.map(|cell| MixingRow {
                measure: &probe.name,
                centre_m: cell.centre_m,
                mass_kg: cell.mass_kg,
                fraction: cell.fraction,
            })
        })
        .collect();
    write_mixing(&folder.mixing(), &rows)
}

/// Result of [`finish`].
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// Names of the missing files in the folder of results.
    pub missing: Vec<String>,
    /// The summary of the run, as JSON.
    pub summary: String,
}

/// Writes the files that are missing because the run was killed after reaching its end, or that
/// have been removed since. None: the run has not reached its end, or no file is missing.
///
/// # Errors
/// The scene is not the one of the run; those of the files.
pub fn finish(plan: &Plan, scene: &Scene, settings: &RunSettings<'_>) -> Result<Option<Finished>> {
    let (Some(folder), Some(snapshot)) = (settings.folder, &settings.resume) else {
        return Ok(None);
    };
    let progress = &snapshot.progress;
    let ended = std::fs::read(folder.ended()).ok();
    let ended = ended.and_then(|bytes| serde_json::from_slice::<End>(&bytes).ok());
    let Some(end) = &ended else {
        return Ok(None);
    };
    let (mut state, mut bodies) = (plan.state.clone(), plan.bodies.clone());
    let rhythm = OutputSchedule::of(
        scene,
        plan.step.step_s,
        state.particles.len() + state.bonds.len(),
    );
    snapshot
        .check_scene(&scene.describe())
        .and_then(|()| fingerprint(&state))
        .and_then(|fingerprint| snapshot.restore(fingerprint, &mut state, &mut bodies))
        .map_err(|error| error.within(&folder.checkpoint().display().to_string()))?;
    if progress.is_over(&state, rhythm, scene).is_none() {
        return Ok(None);
    }
    let order = Order::of(scene, &plan.state, &plan.bodies);
    let probes = probes(scene, plan);
    let missing = missing(
        folder,
        end,
        &state,
        &probes,
        order.is_some(),
        scene.test.is_some(),
    );
    if missing.is_empty() {
        return Ok(None);
    }
    if let (Some(test), Some(setup), Some(of_test)) = (&scene.test, &settings.setup, &settings.test)
    {
        Watch::new(scene, test, setup.clone(), of_test.clone(), plan).finish(
            &progress.test,
            &state,
            Some(folder),
        )?;
    }
    let mut pictures = order
        .map(|order| Pictures::open(folder, order, Some((&state, progress.pictures))))
        .transpose()?;
    end.write_kept(folder)?;
    end.write(folder, &probes, pictures.as_mut())?;
    let summary = end.summary.clone();
    Ok(Some(Finished { missing, summary }))
}

/// Names of the missing files at the end of a run. A summary of another run does not count.
fn missing(
    folder: &ResultsFolder,
    end: &End,
    state: &State,
    probes: &[Probe],
    has_pictures: bool,
    has_test: bool,
) -> Vec<String> {
    let summary = std::fs::read(folder.summary()).unwrap_or_default();
    let mut wanted = vec![folder.report()];
    if has_pictures {
        wanted.extend([folder.film(), folder.film_strip()]);
    }
    if state.clusters.is_some() {
        wanted.extend(tables(folder, state, probes));
    }
    if has_test {
        wanted.push(folder.test_curve());
    }
    wanted.extend(
        plots_of_every_run(probes)
            .iter()
            .map(|name| folder.plot(name)),
    );
    wanted.retain(|path| !path.is_file());
    if summary != end.summary.as_bytes() {
        wanted.push(folder.summary());
    }
    let name = |path: &std::path::PathBuf| {
        let name = path.strip_prefix(folder.path()).unwrap_or(path);
        name.display().to_string()
    };
    wanted.iter().map(name).collect()
}
