//! The folder of a sweep: `study.json` (its identity), `runs/0001-1` (each process), and the
//! results of all.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use dem_io::safe_write::UNFINISHED_PREFIX;
use dem_io::write_target::is_same_file;
use dem_io::{Diagnostic, Result};
use dem_results::folder::lock_file;
use dem_results::{Existing, ResultsFolder, is_plot_file, write_json};
use dem_scene::study::{Average, DesignKind, Setting, Study};
use serde_json::{Value, json};

use super::jobs::Job;
use super::packings::PACKINGS;

const IDENTITY: &str = "study.json";
const RUNS: &str = "runs";
const LOCK: &str = ".lock";
/// Keys of [`IDENTITY`].
const SCENE_TEXT: &str = "text of the scene";
const VARY: &str = "[vary]";

/// The commands of the remaining runs, one a line.
pub(crate) const COMMANDS: &str = "commands.txt";
/// A Slurm job array of them.
pub(crate) const SLURM: &str = "array.slurm";
/// A Snakemake file of them.
pub(crate) const SNAKEFILE: &str = "Snakefile";
/// Marks of the runs that Snakemake has done.
const DONE: &str = "done";

/// Files of which a sweep makes one each, besides [`IDENTITY`].
const TABLES: [&str; 11] = [
    COMMANDS,
    SLURM,
    SNAKEFILE,
    "sweep.csv",
    "responses.csv",
    "find.csv",
    "probability.csv",
    "probability-fit.csv",
    "effects.csv",
    "sweep.json",
    "sweep.html",
];

/// The folder of a sweep. No other sweep can use it as long as this exists.
#[derive(Debug)]
pub struct SweepFolder {
    path: PathBuf,
    _lock: File,
}

/// Treatment of an existing sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Earlier {
    /// Refuse it.
    Refuse,
    /// Remove its runs.
    Replace,
    /// Keep finished runs; they must be of the same study.
    Continue,
    /// The same, and it must exist.
    Collect,
}

impl SweepFolder {
    /// Makes the folder `path`, or uses the existing one. `scene_text` is the text of the scene's
    /// file. Refuses one that contains an earlier sweep, by `earlier`, or other files, or into
    /// which another sweep is writing.
    pub fn create(path: &Path, earlier: Earlier, study: &Study, scene_text: &str) -> Result<Self> {
        let place = path.display().to_string();
        let is_sweep = is_identity(&path.join(IDENTITY));
        if !is_sweep && earlier == Earlier::Collect {
            let remedy = "run the sweep or its --list first, or name its folder with --output";
            return Err(Diagnostic::input(
                place,
                "no sweep is in this folder",
                remedy,
            ));
        }
        if !is_sweep && !is_just_begun(path) {
            let problem = "this folder holds something else than a sweep";
            let remedy = "name another one with --output";
            return Err(Diagnostic::input(place, problem, remedy));
        }
        if is_sweep && earlier == Earlier::Refuse {
            let remedy = "go on with it by --resume, replace it by --force, or name another folder with --output";
            return Err(Diagnostic::input(
                place,
                "a sweep is in this folder",
                remedy,
            ));
        }
        fs::create_dir_all(path.join(RUNS)).map_err(|error| cannot(path, &error))?;
        if !study.packs.is_empty() {
            fs::create_dir_all(path.join(PACKINGS)).map_err(|error| cannot(path, &error))?;
        }
        let folder = Self {
            path: path.to_owned(),
            _lock: lock(path)?,
        };
        if earlier != Earlier::Collect {
            folder.refuse_living()?;
        }
        let identity = identity(study, scene_text);
        if is_sweep && earlier != Earlier::Replace {
            folder.refuse_another(&identity, study)?;
            return Ok(folder);
        }
        if is_sweep {
            folder.remove_sweep()?;
        }
        write_json(&path.join(IDENTITY), &identity)?;
        Ok(folder)
    }

    /// Removes the files of an earlier sweep, and nothing else.
    fn remove_sweep(&self) -> Result<()> {
        for path in entries(&self.path)? {
            let name = path.file_name().and_then(|name| name.to_str());
            let is_table = name.is_some_and(|name| TABLES.contains(&name));
            if is_plain_file(&path) && (is_table || (is_svg(&path) && is_plot_file(&path))) {
                fs::remove_file(&path).map_err(|error| cannot(&path, &error))?;
            }
        }
        for path in entries(&self.path.join(PACKINGS)).unwrap_or_default() {
            if is_plain_file(&path) && path.extension().is_some_and(|ending| ending == "vtp") {
                fs::remove_file(&path).map_err(|error| cannot(&path, &error))?;
            }
        }
        self.remove_marks()?;
        for path in entries(&self.runs())? {
            let name = path.file_name().and_then(|name| name.to_str());
            if name.and_then(Job::named).is_none() {
                continue;
            }
            if is_plain_file(&path) {
                fs::remove_file(&path).map_err(|error| cannot(&path, &error))?;
            } else if fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_dir()) {
                ResultsFolder::create(&path, Existing::Replace)?.remove()?;
            }
        }
        Ok(())
    }

    /// Removes the marks of the runs that Snakemake has done: these runs are listed again.
    pub fn remove_marks(&self) -> Result<()> {
        for path in entries(&self.path.join(DONE)).unwrap_or_default() {
            let name = path.file_name().and_then(|name| name.to_str());
            if name.and_then(Job::named).is_some() && is_plain_file(&path) {
                fs::remove_file(&path).map_err(|error| cannot(&path, &error))?;
            }
        }
        Ok(())
    }

    /// Refuses a sweep of which a process is still running, for example after the program that
    /// started it was killed.
    fn refuse_living(&self) -> Result<()> {
        let runs = self.runs();
        for path in entries(&runs)? {
            let name = path.file_name().and_then(|name| name.to_str());
            let Some(job) = name.and_then(Job::named) else {
                continue;
            };
            if job.is_alive(&runs) {
                return Err(Diagnostic::input(
                    job.folder(&runs).display().to_string(),
                    format!("run {} of this sweep is still going on", job.number),
                    "wait until it has ended, or end its process; then say the same again",
                ));
            }
        }
        Ok(())
    }

    /// Refuses a folder in which the sweep would remove or overwrite its inputs. `inputs`: the
    /// study, the scene and its files.
    pub fn refuse_inputs(path: &Path, inputs: &[PathBuf]) -> Result<()> {
        let is_made = |path: &PathBuf| {
            let name = path.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| TABLES.contains(&name) || name == IDENTITY) || is_svg(path)
        };
        let of_sweep = entries(path).unwrap_or_default();
        let made: Vec<PathBuf> = of_sweep.into_iter().filter(is_made).collect();
        let runs = path.join(RUNS);
        let within = |input: &PathBuf| {
            let whole = (input.canonicalize(), runs.canonicalize());
            made.iter().any(|file| is_same_file(file, input))
                || matches!(&whole, (Ok(input), Ok(runs)) if input.starts_with(runs))
        };
        match inputs.iter().find(|input| within(input)) {
            None => Ok(()),
            Some(input) => Err(Diagnostic::input(
                input.display().to_string(),
                format!(
                    "this is an input of the study, and the sweep in '{}' would replace it",
                    path.display()
                ),
                "name another folder with --output, or copy the file elsewhere and name the copy",
            )),
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder that contains those of the processes.
    pub fn runs(&self) -> PathBuf {
        self.path.join(RUNS)
    }

    fn refuse_another(&self, identity: &Value, study: &Study) -> Result<()> {
        let earlier = fs::read(self.path.join(IDENTITY)).unwrap_or_default();
        let earlier: Value = serde_json::from_slice(&earlier).unwrap_or_default();
        if earlier == *identity {
            return Ok(());
        }
        let changed = identity.as_object().into_iter().flatten();
        let mut changed = changed.filter(|(key, value)| earlier.get(key) != Some(value));
        let what = changed.next().map_or("study", |(key, _)| key);
        Err(Diagnostic::input(
            self.path.display().to_string(),
            format!("its runs are of another {what} than {} says", study.source),
            "replace them with --force, or name another folder with --output",
        ))
    }
}

/// True if a folder holds nothing, or only what a sweep that was killed before it wrote its
/// identity has made.
fn is_just_begun(path: &Path) -> bool {
    let is_begin = |entry: &PathBuf| {
        let name = entry.file_name().and_then(|name| name.to_str());
        match name {
            Some(RUNS) => entries(entry).is_ok_and(|runs| runs.is_empty()),
            Some(LOCK) => true,
            Some(name) => name.starts_with(UNFINISHED_PREFIX),
            None => false,
        }
    };
    entries(path).map_or(true, |entries| entries.iter().all(is_begin))
}

/// True if this file is the identity of a sweep.
fn is_identity(path: &Path) -> bool {
    let value: Option<Value> =
        (fs::read(path).ok()).and_then(|bytes| serde_json::from_slice(&bytes).ok());
    value.is_some_and(|value| {
        [SCENE_TEXT, VARY]
            .iter()
            .all(|key| value.get(key).is_some())
    })
}

fn is_svg(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "svg")
}

/// True for a file itself, false for a link to one.
fn is_plain_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file())
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = fs::read_dir(folder).map_err(|error| cannot(folder, &error))?;
    let paths: std::io::Result<Vec<PathBuf>> = read.map(|entry| Ok(entry?.path())).collect();
    paths.map_err(|error| cannot(folder, &error))
}

/// The data that determine the results of runs, without the number of repeats and the evaluation.
fn identity(study: &Study, scene_text: &str) -> Value {
    let settings = |settings: &[Setting]| -> Vec<[String; 2]> {
        let texts = settings.iter();
        texts.map(|s| [s.path.clone(), s.value.clone()]).collect()
    };
    let axes: Vec<Vec<_>> = study
        .axes
        .iter()
        .map(|axis| axis.values.iter().map(|v| settings(&v.settings)).collect())
        .collect();
    let mut identity = json!({
        "scene": study.scene.display().to_string(),
        SCENE_TEXT: scene_text,
        "number of threads": study.threads,
        "combine": format!("{:?}", study.combine),
        "[set]": settings(&study.fixed),
        VARY: axes,
    });
    // The points of a search follow from its ends and from what is looked for.
    if let Some(find) = &study.find {
        let measure = &study.measures[find.measure];
        let looked_for = format!("{:?} {} {:?}", measure.of, find.value, study.average_over);
        // Studies of the mean had no statistic once.
        identity["[find]"] = match find.statistic {
            Average::Mean => looked_for.into(),
            Average::Median => format!("{looked_for} median").into(),
        };
    }
    if !study.packs.is_empty() {
        let packs = study.packs.iter();
        let packs: Vec<_> = packs
            .map(|pack| (&pack.body, pack.arguments(&[]), pack.content))
            .collect();
        identity["[pack]"] = json!(packs);
    }
    // More trajectories continue a design.
    if let Some(design) = &study.design {
        identity["[design]"] = match design.kind {
            DesignKind::OneAtATime => json!("one at a time"),
            DesignKind::Morris { levels, seed, .. } => json!(["morris", levels, seed]),
        };
    }
    identity
}

/// Locks a folder. The system releases the lock when the program ends.
fn lock(folder: &Path) -> Result<File> {
    let path = folder.join(LOCK);
    lock_file(&path)
        .map_err(|error| cannot(&path, &error))?
        .ok_or_else(|| {
            Diagnostic::input(
                folder.display().to_string(),
                "another sweep is writing into it",
                "wait until it has ended, or name another folder with --output",
            )
        })
}

fn cannot(path: &Path, error: &std::io::Error) -> Diagnostic {
    let problem = format!("cannot be written: {error}");
    Diagnostic::failed(
        path.display().to_string(),
        problem,
        "write elsewhere with --output",
    )
}
