//! The files that grow during a run, and its checkpoints.

use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_results::checkpoint::write_checkpoint;
use dem_results::{DischargeFile, EventFile, FragmentFile, FrameFiles, ResultsFolder, SeriesFile};
use dem_scene::Scene;

use super::pictures::Pictures;
use super::progress::Progress;
use crate::output::frames::FrameOrder;
use crate::output::walls::WallOutput;
use crate::snapshot::Snapshot;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_plan::measure::Probe;

/// Files that grow during a run.
pub(super) struct Files<'a> {
    pub(super) folder: &'a ResultsFolder,
    /// Hash of the data fixed by the plan: see [`super::snapshot::fingerprint`].
    fingerprint: u64,
    pub(super) series: SeriesFile,
    pub(super) events: EventFile,
    pub(super) frames: FrameFiles,
    /// None: no pictures.
    pub(super) pictures: Option<Pictures>,
    /// None: nothing can break into fragments.
    pub(super) fragments: Option<FragmentFile>,
    /// The table of what leaves, and the number of its rows. None: there are no outlets.
    pub(super) discharge: Option<(DischargeFile, usize)>,
    pub(super) order: FrameOrder,
    pub(super) walls: WallOutput,
}

impl<'a> Files<'a> {
    /// New files, or those of a resumed run at the point where it is `continued`.
    pub(super) fn open(
        folder: &'a ResultsFolder,
        fingerprint: u64,
        (order, walls): (FrameOrder, WallOutput),
        columns: &[String],
        has_fragments: bool,
        continued: Option<&Progress>,
    ) -> Result<Self> {
        if let Some(at) = continued {
            at.sums.check(folder.path())?;
        }
        let fragments = has_fragments.then(|| match continued {
            Some(at) => FragmentFile::continue_at(&folder.fragments(), at.fragments_bytes),
            None => FragmentFile::create(&folder.fragments()),
        });
        let (series, events, frames) = match continued {
            Some(at) => (
                SeriesFile::continue_at(&folder.series(), columns, at.series_bytes)?,
                EventFile::continue_at(&folder.events(), at.events_bytes)?,
                FrameFiles::continue_at(folder, walls.files(), at.frame_times_s.clone())?,
            ),
            None => (
                SeriesFile::create(&folder.series(), columns)?,
                EventFile::create(&folder.events())?,
                FrameFiles::create(folder, walls.files()),
            ),
        };
        Ok(Self {
            folder,
            fingerprint,
            series,
            events,
            frames,
            pictures: None,
            fragments: fragments.transpose()?,
            discharge: None,
            order,
            walls,
        })
    }
}

/// The table of what leaves through outlets, new or at the point where the run is `continued` in
/// this state. None: there are no outlets.
pub(super) fn open_discharge(
    folder: &ResultsFolder,
    state: &State,
    continued: Option<&Progress>,
) -> Result<Option<(DischargeFile, usize)>> {
    if state.model.rules.outlets.is_empty() {
        return Ok(None);
    }
    let path = folder.discharge();
    let file = match continued {
        Some(at) => DischargeFile::continue_at(&path, at.discharge_bytes)?,
        None => DischargeFile::create(&path)?,
    };
    Ok(Some((file, state.population.discharged.len())))
}

/// Writes a checkpoint, and flushes all files that it depends on to the disk.
pub(super) fn save(
    state: &State,
    bodies: &[PlacedBody],
    scene: &Scene,
    probes: &[Probe],
    progress: &mut Progress,
    files: &mut Files<'_>,
) -> Result<()> {
    files.series.sync()?;
    files.events.sync()?;
    progress.series_bytes = files.series.length_bytes();
    progress.events_bytes = files.events.length_bytes();
    if let Some(fragments) = &files.fragments {
        fragments.sync()?;
        progress.fragments_bytes = fragments.length_bytes();
    }
    progress.frame_times_s = files.frames.times_s().to_vec();
    if let Some((discharge, _)) = &files.discharge {
        discharge.sync()?;
        progress.discharge_bytes = discharge.length_bytes();
    }
    if let Some(pictures) = &files.pictures {
        progress.pictures = pictures.taken();
    }
    sum_files(progress, files)?;
    let measures = probes.iter().map(|probe| probe.history).collect();
    let snapshot = Snapshot::taken(
        state,
        bodies,
        scene.describe(),
        files.fingerprint,
        measures,
        progress.clone(),
    );
    write_checkpoint(&files.folder.checkpoint(), &snapshot.to_bytes()?)
}

/// Updates the check sums of the tables, and adds those of new frames.
fn sum_files(progress: &mut Progress, files: &Files<'_>) -> Result<()> {
    let folder = files.folder;
    let fragments = files.fragments.as_ref();
    let discharge = files.discharge.as_ref();
    let tables = [
        Some((folder.series(), progress.series_bytes)),
        Some((folder.events(), progress.events_bytes)),
        fragments.map(|_| (folder.fragments(), progress.fragments_bytes)),
        discharge.map(|_| (folder.discharge(), progress.discharge_bytes)),
    ];
    for (path, bytes) in tables.into_iter().flatten() {
        if let Some(name) = path.file_name().and_then(|name| name.to_str()) {
            progress.sums.update(folder.path(), name, Some(bytes))?;
        }
    }
    for number in 0..progress.frame_times_s.len() {
        for name in files.frames.files_of(number) {
            if !progress.sums.has(&name) {
                progress.sums.update(folder.path(), &name, None)?;
            }
        }
    }
    Ok(())
}

/// Adds to a message that the run can be resumed from its checkpoint, if there is one.
pub(super) fn with_checkpoint(mut problem: Diagnostic, files: Option<&Files<'_>>) -> Diagnostic {
    let checkpoint = files.map(|files| files.folder.checkpoint());
    if let Some(path) = checkpoint.filter(|path| path.is_file()) {
        problem.remedy += &format!(
            "; --resume takes it up from '{}' with that step",
            path.display()
        );
    }
    problem
}

pub(super) fn interruption(state: &State, files: Option<&Files<'_>>) -> Diagnostic {
    let remedy = match files {
        Some(files) => format!(
            "go on with the same command and --resume: '{}' holds its state",
            files.folder.checkpoint().display()
        ),
        None => "with --output FOLDER its state would have been kept".to_owned(),
    };
    Diagnostic::interrupted(
        format!(
            "interrupted at {} s, step {}",
            significant(state.time_s, 6),
            state.steps
        ),
        remedy,
    )
}
