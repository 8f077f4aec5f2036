//! Files that a run writes once it has ended, and their recovery if the run was killed while
//! writing them.

mod film;
pub mod flows;
pub mod fragments;
mod last_state;
pub mod plots;
pub mod strengthening;
mod tables;
pub(crate) mod wall_loads;

use std::path::{Path, PathBuf};

use dem_io::safe_write::{explain, write_file};
use dem_io::{Diagnostic, Result, read_input};
use dem_report::report;
use dem_results::folder::names;
use dem_results::{ResultsFolder, Summary, from_json};
use dem_scene::Scene;
use serde::{Deserialize, Serialize};

pub(super) use self::last_state::LastState;
use super::outputs::pictures::taken_until;
use super::schedule::OutputSchedule;
use super::settings::RunSettings;
use super::snapshot::fingerprint;
use crate::last_files::plots::{plots_of_every_run, write_plots};
use crate::last_files::strengthening::strengthening_plot;
use dem_plan::Plan;
use dem_plan::measure::{Probe, probes};
use dem_rig::watch::Watch;

/// Writes some tables and plots of the last state, and returns their paths.
type WriteTable = fn(&LastState<'_>) -> Result<Vec<PathBuf>>;

/// All tables and plots of the last state: that of the checkpoint, half a step later, would change
/// them.
const TABLES: [WriteTable; 5] = [
    tables::fragments,
    tables::flow,
    tables::mixing,
    wall_loads::wall_loads,
    strengthening_plot,
];

/// Data that a finished run leaves next to its last checkpoint, before it writes plots, film, page
/// and summary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct End {
    /// `summary.json`.
    summary: String,
    /// Tables and plots of the last state: path in the folder and text of each file.
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

    /// As [`Self::of`]; also writes and keeps the tables of this state.
    pub(super) fn with_tables(summary: &Summary, last: &LastState<'_>) -> Result<Self> {
        let mut end = Self::of(summary)?;
        for write in TABLES {
            for path in write(last)? {
                let text = read_input(&path, "a file of results")?;
                let text = String::from_utf8_lossy(&text).into_owned();
                end.tables.push((name_in(last.folder, &path), text));
            }
        }
        Ok(end)
    }

    /// Writes the tables that [`Self::with_tables`] has kept.
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

    /// Writes plots, page and the film of these pictures, if any, of a run whose tables are
    /// written, and its summary last: if the summary exists, all files do.
    pub(super) fn write(
        &self,
        folder: &ResultsFolder,
        probes: &[Probe],
        pictures: Option<usize>,
    ) -> Result<()> {
        let summary: Option<Summary> = (serde_json::from_str(&self.summary))
            .and_then(from_json)
            .ok();
        let measures = summary.map_or_else(Vec::new, |summary| summary.measures);
        write_plots(folder, probes, &measures)?;
        if let Some(count) = pictures {
            film::write(folder, count)?;
        }
        self.write_page(folder)?;
        self.write_summary(folder)
    }

    /// Writes `report.html` from the other files of the run.
    pub(super) fn write_page(&self, folder: &ResultsFolder) -> Result<()> {
        let page = report(folder.path(), &self.summary)?;
        folder.write(names::REPORT, &page)
    }

    pub(super) fn write_summary(&self, folder: &ResultsFolder) -> Result<()> {
        folder.write(names::SUMMARY, &self.summary)
    }

    /// Names of the missing files at the end of a run. A summary of another run does not count.
    fn missing(
        &self,
        folder: &ResultsFolder,
        probes: &[Probe],
        has_pictures: bool,
        has_test: bool,
    ) -> Vec<String> {
        let kept = self.tables.iter().map(|(name, _)| folder.path().join(name));
        let plots = plots_of_every_run(probes);
        let mut wanted = vec![folder.file(names::REPORT)];
        if has_pictures {
            wanted.extend([folder.file(names::FILM), folder.file(names::FILM_STRIP)]);
        }
        wanted.extend(kept);
        wanted.extend(has_test.then(|| folder.file(names::TEST_CURVE)));
        wanted.extend(plots.iter().map(|name| folder.plot(name)));
        wanted.retain(|path| !path.is_file());
        let summary = std::fs::read(folder.file(names::SUMMARY)).unwrap_or_default();
        if summary != self.summary.as_bytes() {
            wanted.push(folder.file(names::SUMMARY));
        }
        wanted.iter().map(|path| name_in(folder, path)).collect()
    }
}

/// Name of a file in the folder of results.
fn name_in(folder: &ResultsFolder, path: &Path) -> String {
    let name = path.strip_prefix(folder.path()).unwrap_or(path);
    name.display().to_string()
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
/// have been removed since. None: the run has not reached its end, or no file is missing. Refuses
/// another scene than that of the run.
pub fn finish(plan: &Plan, scene: &Scene, settings: &RunSettings<'_>) -> Result<Option<Finished>> {
    let (Some(folder), Some(snapshot)) = (settings.folder, &settings.resume) else {
        return Ok(None);
    };
    let progress = &snapshot.progress;
    let ended = std::fs::read(folder.file(names::ENDED)).ok();
    let ended = ended.and_then(|bytes| serde_json::from_slice::<End>(&bytes).ok());
    let Some(end) = &ended else {
        return Ok(None);
    };
    let (mut state, mut bodies) = (plan.state.clone(), plan.bodies.clone());
    let schedule = OutputSchedule::of(
        scene,
        plan.step.step_s,
        state.particles.len() + state.bonds.len(),
    );
    snapshot
        .check_scene(&scene.describe())
        .and_then(|()| fingerprint(&state))
        .and_then(|fingerprint| snapshot.restore(fingerprint, &mut state, &mut bodies))
        .map_err(|error| error.within(&folder.file(names::CHECKPOINT).display().to_string()))?;
    if progress.is_over(&state, schedule, scene).is_none() {
        return Ok(None);
    }
    let probes = probes(scene, plan);
    let pictures = taken_until(scene, progress)?;
    let missing = end.missing(folder, &probes, pictures.is_some(), scene.test.is_some());
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
    end.write_kept(folder)?;
    end.write(folder, &probes, pictures)?;
    let summary = end.summary.clone();
    Ok(Some(Finished { missing, summary }))
}
