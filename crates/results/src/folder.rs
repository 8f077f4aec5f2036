//! The folder of a run: the names in it, and its permitted previous contents.

use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

mod names;

use super::plot_file::{is_plot_file, write_plot_file};
use dem_io::body::stored_walls::FIXED_WALLS_FILE;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::{
    PendingFile, UNFINISHED_PREFIX, explain, remove_if_abandoned, write_file,
};
use dem_io::write_target::is_same_file;

use names::{FRAMES, frame_number, picture_number, walls_number};
pub(super) use names::{fixed_walls_name, frame_name, walls_name};
pub use names::{frame_in, walls_in};

const PLOTS: &str = "plots";
const PICTURES: &str = "pictures";
const FILM_STRIP: &str = "film-strip.png";
const FILM: &str = "film.png";
const INDEX: &str = "frames.pvd";
const SERIES: &str = "series.csv";
const EVENTS: &str = "events.csv";
const FRAGMENTS: &str = "fragments.csv";
const FRAGMENT_TREE: &str = "fragment-tree.csv";
const DISCHARGE: &str = "discharge.csv";
const DISTRIBUTION: &str = "distribution.csv";
const SUMMARY: &str = "summary.json";
const REPORT: &str = "report.html";
const SCENE: &str = "scene.toml";
/// The beginning of a scene that a run has written, so that other files are not removed.
const SCENE_BEGIN: &str = "# Written by dem-run";
const TEST_CURVE: &str = "force-displacement.csv";
const CHECKPOINT: &str = "checkpoint.dem";
const ENDED: &str = ".ended.json";
const LOCK: &str = ".lock";
/// Files of which a run writes one each.
const SINGLE_FILES: [&str; 14] = [
    INDEX,
    SERIES,
    EVENTS,
    FRAGMENTS,
    FRAGMENT_TREE,
    DISCHARGE,
    DISTRIBUTION,
    SUMMARY,
    REPORT,
    TEST_CURVE,
    FILM_STRIP,
    FILM,
    CHECKPOINT,
    ENDED,
];

/// Treatment of a folder that is not empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Refuse it.
    Refuse,
    /// Remove the files written by an earlier run, and nothing else: `--force`.
    Replace,
    /// Leave everything except the remains of killed writes, to continue a run: `--resume`.
    Continue,
}

/// The folder to which a run writes. No other run can write to it as long as this or a clone of it
/// exists.
#[derive(Debug, Clone)]
pub struct ResultsFolder {
    path: PathBuf,
    _lock: Arc<File>,
}

impl ResultsFolder {
    /// Makes the folder `path` or uses the existing one, and checks that it can be written to.
    ///
    /// # Errors
    /// It is not empty, by `existing`; there is none to continue; another run is writing into it
    /// (all exit code 2). Its parent is missing, a file has its name, no permission to write in it
    /// (all exit code 1).
    pub fn create(path: &Path, existing: Existing) -> Result<Self> {
        if existing != Existing::Continue {
            make_folder(path)?;
        } else if !path.is_dir() {
            return Err(Diagnostic::input(
                path.display().to_string(),
                "there is no such folder, so no run to continue",
                "check its name, or start the run without --resume",
            ));
        }
        // A folder that is not that of a run does not get a lock file either.
        if existing == Existing::Refuse && !path.join(LOCK).exists() {
            refuse_unless_empty(path)?;
        }
        let folder = Self {
            path: path.to_owned(),
            _lock: Arc::new(lock(path)?),
        };
        match existing {
            Existing::Refuse => refuse_unless_empty(path)?,
            Existing::Replace => {
                folder.refuse_foreign_scene()?;
                folder.remove_results()?;
            }
            Existing::Continue => {
                // The remains of a killed write.
                for part in ["", FRAMES, PICTURES, PLOTS] {
                    folder.remove_files(part, |_| false)?;
                }
            }
        }
        // This file is not kept: it only shows that files can be written here.
        PendingFile::write(&folder.summary(), |_| Ok(()))?;
        Ok(folder)
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Frame `number`, counted from 0: `frames/frame_000123.vtp`.
    pub fn frame(&self, number: usize) -> PathBuf {
        frame_in(&self.path, number)
    }

    /// The walls of frame `number`: `frames/walls_000123.vtp`.
    pub fn walls(&self, number: usize) -> PathBuf {
        walls_in(&self.path, number)
    }

    /// The large walls that never move: `frames/walls_fixed.vtp`.
    pub fn fixed_walls(&self) -> PathBuf {
        self.path.join(fixed_walls_name())
    }

    /// The list of all frames with their times, which ParaView opens: `frames.pvd`.
    pub fn frames_index(&self) -> PathBuf {
        self.path.join(INDEX)
    }

    /// Picture `number`, counted from 0: `pictures/picture-00123.png`.
    pub fn picture(&self, number: usize) -> PathBuf {
        self.path
            .join(PICTURES)
            .join(format!("picture-{number:05}.png"))
    }

    /// Some pictures side by side: `film-strip.png`.
    pub fn film_strip(&self) -> PathBuf {
        self.path.join(FILM_STRIP)
    }

    /// The pictures one after the other: `film.png`.
    pub fn film(&self) -> PathBuf {
        self.path.join(FILM)
    }

    /// Time series: `series.csv`.
    pub fn series(&self) -> PathBuf {
        self.path.join(SERIES)
    }

    /// Events: `events.csv`.
    pub fn events(&self) -> PathBuf {
        self.path.join(EVENTS)
    }

    /// Fragments at chosen moments: `fragments.csv`.
    pub fn fragments(&self) -> PathBuf {
        self.path.join(FRAGMENTS)
    }

    /// The origin of each fragment: `fragment-tree.csv`.
    pub fn fragment_tree(&self) -> PathBuf {
        self.path.join(FRAGMENT_TREE)
    }

    /// What leaves through outlets: `discharge.csv`.
    pub fn discharge(&self) -> PathBuf {
        self.path.join(DISCHARGE)
    }

    /// The size distribution of all fragments: `distribution.csv`.
    pub fn distribution(&self) -> PathBuf {
        self.path.join(DISTRIBUTION)
    }

    /// Summary: `summary.json`.
    pub fn summary(&self) -> PathBuf {
        self.path.join(SUMMARY)
    }

    /// The scene as it was run: `scene.toml`.
    pub fn scene(&self) -> PathBuf {
        self.path.join(SCENE)
    }

    /// Writes the scene as it is run to `scene.toml`, after a line that says so. Replaces that of an
    /// earlier run.
    ///
    /// # Errors
    /// A scene that no run has written is there (exit code 2); no permission, full disk (exit code
    /// 1).
    pub fn write_scene(&self, program: &str, text: &str) -> Result<()> {
        self.refuse_foreign_scene()?;
        write_file(&self.scene(), |out| {
            writeln!(
                out,
                "{SCENE_BEGIN} ({program}): the scene of this run, with all files and settings that it was given."
            )?;
            out.write_all(text.as_bytes())
        })
    }

    /// Refuses a folder with a `scene.toml` that no run has written: it would be lost.
    fn refuse_foreign_scene(&self) -> Result<()> {
        let path = self.scene();
        if !path.exists() || is_scene_as_run(&path) {
            return Ok(());
        }
        Err(Diagnostic::input(
            path.display().to_string(),
            "the scene of the run would take the place of this file",
            "rename it, or name another folder with --output",
        ))
    }

    /// The data written at the end of a run, kept until all files are complete: `.ended.json`.
    pub fn ended(&self) -> PathBuf {
        self.path.join(ENDED)
    }

    /// The latest state of the run: `checkpoint.dem`.
    pub fn checkpoint(&self) -> PathBuf {
        self.path.join(CHECKPOINT)
    }

    /// A plot: `plots/NAME.svg`. Characters that a file name may not contain become `_`.
    pub fn plot(&self, name: &str) -> PathBuf {
        let name: String = name
            .chars()
            .map(|letter| match letter {
                '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '_',
                control if control.is_control() => '_',
                other => other,
            })
            .collect();
        self.path.join(PLOTS).join(format!("{name}.svg"))
    }

    /// Writes the curve of a laboratory test to `force-displacement.csv`, replacing an earlier one.
    ///
    /// # Errors
    /// Those of [`ResultsFolder::write_plot`].
    pub fn write_test_curve(&self, csv: &str) -> Result<()> {
        write_file(&self.test_curve(), |out| out.write_all(csv.as_bytes()))
    }

    /// The page of the run: `report.html`.
    pub fn report(&self) -> PathBuf {
        self.path.join(REPORT)
    }

    /// The curve of a laboratory test: `force-displacement.csv`.
    pub fn test_curve(&self) -> PathBuf {
        self.path.join(TEST_CURVE)
    }

    /// Makes the folder of the frames, unless it is there.
    ///
    /// # Errors
    /// No permission, a file has its name (exit code 1).
    pub(super) fn make_frames_folder(&self) -> Result<()> {
        make_folder(&self.path.join(FRAMES))
    }

    /// Makes the folder of the pictures, unless it is there.
    ///
    /// # Errors
    /// No permission, a file has its name (exit code 1).
    pub(super) fn make_pictures_folder(&self) -> Result<()> {
        make_folder(&self.path.join(PICTURES))
    }

    /// Removes picture `number` and all after it.
    ///
    /// # Errors
    /// No permission (exit code 1).
    pub(super) fn remove_pictures_from(&self, number: usize) -> Result<()> {
        self.remove_files(PICTURES, |name| {
            picture_number(name).is_some_and(|found| found >= number)
        })
    }

    /// Writes a plot to `plots/NAME.svg`, replacing an earlier one. `svg`: the text of an SVG file.
    ///
    /// # Errors
    /// No permission, full disk, a file or folder in the way (all exit code 1).
    pub fn write_plot(&self, name: &str, svg: &str) -> Result<()> {
        make_folder(&self.path.join(PLOTS))?;
        write_plot_file(&self.plot(name), svg)
    }

    /// Removes frame `number` and all after it, with their walls; if it is the first, also the walls
    /// that never move.
    ///
    /// # Errors
    /// No permission (exit code 1).
    pub(super) fn remove_frames_from(&self, number: usize) -> Result<()> {
        self.remove_files(FRAMES, |name| {
            let is_later = |found: Option<usize>| found.is_some_and(|found| found >= number);
            is_later(frame_number(name))
                || is_later(walls_number(name))
                || (number == 0 && name == FIXED_WALLS_FILE)
        })
    }

    /// Removes the list of all frames, if there is one.
    ///
    /// # Errors
    /// No permission (exit code 1).
    pub(super) fn remove_frames_index(&self) -> Result<()> {
        self.remove_files("", |name| name == INDEX)
    }

    /// Removes the files written by a run, and the folder unless it contains something else.
    ///
    /// # Errors
    /// No permission (exit code 1).
    pub fn remove(self) -> Result<()> {
        self.remove_results()?;
        for part in [FRAMES, PICTURES, PLOTS] {
            // A folder with other contents stays, and so does the main folder then.
            let _ = fs::remove_dir(self.path.join(part));
        }
        let is_empty = refuse_unless_empty(&self.path).is_ok();
        let lock = self.path.join(LOCK);
        fs::remove_file(&lock).map_err(|error| explain(&lock, &error))?;
        if is_empty {
            fs::remove_dir(&self.path).map_err(|error| explain(&self.path, &error))?;
        }
        Ok(())
    }

    /// Removes what is neither a table nor the summary, the page or the scene of a run that has ended:
    /// frames, pictures, plots and checkpoint.
    ///
    /// # Errors
    /// A file cannot be removed (exit code 1).
    pub fn keep_tables(&self) -> Result<()> {
        // First, so that a partly removed folder is not taken for a run to continue.
        self.remove_files("", |name| name == CHECKPOINT)?;
        self.remove_files("", |name| [ENDED, INDEX, FILM, FILM_STRIP].contains(&name))?;
        self.remove_numbered_and_plots()?;
        for part in [FRAMES, PICTURES, PLOTS] {
            // One that holds other files stays.
            let _ = fs::remove_dir(self.path.join(part));
        }
        Ok(())
    }

    fn remove_results(&self) -> Result<()> {
        // First, so that a partly removed folder is not taken for a run to continue.
        self.remove_files("", |name| name == CHECKPOINT)?;
        self.remove_files("", |name| SINGLE_FILES.contains(&name))?;
        let is_ours = is_scene_as_run(&self.scene());
        self.remove_files("", |name| name == SCENE && is_ours)?;
        self.remove_numbered_and_plots()
    }

    fn remove_numbered_and_plots(&self) -> Result<()> {
        self.remove_frames_from(0)?;
        self.remove_pictures_from(0)?;
        let plots = self.path.join(PLOTS);
        self.remove_files(PLOTS, |name| {
            name.ends_with(".svg") && is_plot_file(&plots.join(name))
        })
    }

    /// Removes the files of the folder `part` that are `ours` by their name. A file left by a
    /// killed write is also ours.
    fn remove_files(&self, part: &str, ours: impl Fn(&str) -> bool) -> Result<()> {
        let folder = self.path.join(part);
        if !folder.is_dir() {
            return Ok(());
        }
        for entry in entries(&folder)? {
            let path = entry.map_err(|error| explain(&folder, &error))?;
            let name = path.file_name().and_then(|name| name.to_str());
            let name = name.unwrap_or_default();
            let removed = if name.starts_with(UNFINISHED_PREFIX) {
                remove_if_abandoned(&path)
            } else if ours(name)
                && fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_file())
            {
                fs::remove_file(&path)
            } else {
                Ok(())
            };
            removed.map_err(|error| explain(&path, &error))?;
        }
        Ok(())
    }
}

/// True if a run has written the scene in this file.
fn is_scene_as_run(path: &Path) -> bool {
    let mut begin = [0; SCENE_BEGIN.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut begin));
    read.is_ok() && begin == SCENE_BEGIN.as_bytes()
}

/// True if a run is writing into the folder `path` at this moment. A folder to which no run has
/// written is not created.
pub fn is_written_to(path: &Path) -> bool {
    is_locked(&path.join(LOCK))
}

/// True if a file exists and another program holds its lock.
pub fn is_locked(path: &Path) -> bool {
    File::open(path).is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

/// The first of `files` that is in the folder `path` under a name of results, also through a link:
/// a run that writes there would remove or overwrite it. None if there is none of them, or no such
/// folder.
pub fn result_among<'a>(path: &Path, files: &'a [PathBuf]) -> Option<&'a PathBuf> {
    let is_ours = |part: &str, name: &str| match part {
        FRAMES => {
            frame_number(name).is_some() || walls_number(name).is_some() || name == FIXED_WALLS_FILE
        }
        PICTURES => picture_number(name).is_some(),
        PLOTS => name.ends_with(".svg"),
        _ => SINGLE_FILES.contains(&name) || name == SCENE,
    };
    for part in ["", FRAMES, PICTURES, PLOTS] {
        let Ok(entries) = fs::read_dir(path.join(part)) else {
            continue;
        };
        for entry in entries.flatten() {
            let name = entry.file_name();
            let is_result = (name.to_str())
                .is_some_and(|name| is_ours(part, name) || name.starts_with(UNFINISHED_PREFIX));
            if !is_result {
                continue;
            }
            let found = files.iter().find(|file| is_same_file(file, &entry.path()));
            if found.is_some() {
                return found;
            }
        }
    }
    None
}

/// Refuses to write results into the folder `path` if they would replace a file that the run reads.
///
/// # Errors
/// One of `inputs` is in it under a name of results (exit code 2).
pub fn refuse_inputs_among_results(path: &Path, inputs: &[PathBuf]) -> Result<()> {
    match result_among(path, inputs) {
        None => Ok(()),
        Some(input) => Err(Diagnostic::input(
            input.display().to_string(),
            format!(
                "this is an input of the run, and results in '{}' would take its place",
                path.display()
            ),
            "name another folder with --output, or copy the file elsewhere and name the copy",
        )),
    }
}

/// The numbers of the frames in the results folder `path`, ascending. Nothing is locked: a run may
/// be writing there.
///
/// # Errors
/// There is no such folder, or it cannot be read.
pub fn frames_in(path: &Path) -> Result<Vec<usize>> {
    if !path.is_dir() {
        return Err(Diagnostic::input(
            path.display().to_string(),
            "there is no such folder",
            "name the folder of results of a run",
        ));
    }
    let frames = path.join(FRAMES);
    if !frames.is_dir() {
        return Ok(Vec::new());
    }
    let mut numbers = Vec::new();
    for entry in entries(&frames)? {
        let entry = entry.map_err(|error| explain(&frames, &error))?;
        let name = entry.file_name().and_then(|name| name.to_str());
        numbers.extend(name.and_then(frame_number));
    }
    numbers.sort_unstable();
    Ok(numbers)
}

/// Makes a folder unless it exists. Its parent must exist.
fn make_folder(path: &Path) -> Result<()> {
    match fs::create_dir(path) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            if path.is_dir() {
                return Ok(());
            }
            Err(Diagnostic::failed(
                path.display().to_string(),
                "this is a file, where a folder is needed",
                "remove it, or write elsewhere",
            ))
        }
        Err(error) => Err(explain(path, &error)),
    }
}

/// Locks a folder. The system releases the lock when the program ends for whatever reason. The file
/// stays: another run may be about to lock it.
fn lock(folder: &Path) -> Result<File> {
    let path = folder.join(LOCK);
    let file = File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .open(&path)
        .map_err(|error| explain(&path, &error))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(Diagnostic::input(
            folder.display().to_string(),
            "another run is writing into it",
            "wait until that run has ended, or name another folder with --output",
        )),
        // Some network disks do not support locks: that is not a reason to refuse the run.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}

fn refuse_unless_empty(folder: &Path) -> Result<()> {
    for path in entries(folder)? {
        let path = path.map_err(|error| explain(folder, &error))?;
        if path.file_name().is_none_or(|name| name != LOCK) {
            return Err(Diagnostic::input(
                folder.display().to_string(),
                "this folder is not empty",
                "write to another one, replace its results with --force, or continue its run with --resume",
            ));
        }
    }
    Ok(())
}

/// The paths of the entries of a folder.
fn entries(folder: &Path) -> Result<impl Iterator<Item = std::io::Result<PathBuf>>> {
    let entries = fs::read_dir(folder).map_err(|error| {
        Diagnostic::failed(
            folder.display().to_string(),
            format!("this folder cannot be read: {error}"),
            "write elsewhere",
        )
    })?;
    Ok(entries.map(|entry| entry.map(|entry| entry.path())))
}
