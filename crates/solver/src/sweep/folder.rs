//! The folder of a sweep: `study.json` (what it is of), `runs/0001-1` (each process), and what comes of all.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use dem_io::results::write_json;
use dem_io::scene::study::{Setting, Study};
use dem_io::{Diagnostic, Result};
use serde_json::{Value, json};

const IDENTITY: &str = "study.json";
const RUNS: &str = "runs";
const LOCK: &str = ".lock";

/// The folder of a sweep, and of no other as long as this lives.
#[derive(Debug)]
pub struct SweepFolder {
    path: PathBuf,
    _lock: Option<File>,
}

/// What to do with a sweep that is there already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Earlier {
    /// Refuse it.
    Refuse,
    /// Remove its runs.
    Replace,
    /// Keep what is done; it must be of the same runs.
    Continue,
    /// The same, and it must be there.
    Collect,
}

impl SweepFolder {
    /// Makes the folder `path`, or takes the one that is there. `scene_text` is that of the scene's file.
    ///
    /// # Errors
    /// An earlier sweep by `earlier`, or other files are in it; another sweep is writing into it; it cannot be written to.
    pub fn create(path: &Path, earlier: Earlier, study: &Study, scene_text: &str) -> Result<Self> {
        let place = path.display().to_string();
        let is_sweep = path.join(IDENTITY).exists();
        if !is_sweep && earlier == Earlier::Collect {
            let remedy = "run the sweep or its --list first, or name its folder with --out";
            return Err(Diagnostic::input(
                place,
                "no sweep is in this folder",
                remedy,
            ));
        }
        let is_empty = fs::read_dir(path).map_or(true, |mut entries| entries.next().is_none());
        if !is_sweep && !is_empty {
            let problem = "this folder holds something else than a sweep";
            let remedy = "name another one with --out";
            return Err(Diagnostic::input(place, problem, remedy));
        }
        if is_sweep && earlier == Earlier::Refuse {
            let remedy = "go on with it by --resume, replace it by --force, or name another folder with --out";
            return Err(Diagnostic::input(
                place,
                "a sweep is in this folder",
                remedy,
            ));
        }
        fs::create_dir_all(path.join(RUNS)).map_err(|error| cannot(path, &error))?;
        let folder = Self {
            path: path.to_owned(),
            _lock: lock(path)?,
        };
        let identity = identity(study, scene_text);
        if is_sweep && earlier != Earlier::Replace {
            folder.refuse_another(&identity, study)?;
            return Ok(folder);
        }
        let runs = path.join(RUNS);
        fs::remove_dir_all(&runs)
            .and_then(|()| fs::create_dir(&runs))
            .map_err(|error| cannot(&runs, &error))?;
        write_json(&path.join(IDENTITY), &identity)?;
        Ok(folder)
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where the processes have their folders.
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
            "replace them with --force, or name another folder with --out",
        ))
    }
}

/// What decides what runs give: not how often they are done, nor what is made of them.
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
    json!({
        "scene": study.scene.display().to_string(),
        "text of the scene": scene_text,
        "number of threads": study.threads,
        "combine": format!("{:?}", study.combine),
        "[set]": settings(&study.fixed),
        "[vary]": axes,
    })
}

/// Takes the lock of a folder, which the system releases when the program ends. Some network disks know none: that is no reason not to run.
fn lock(folder: &Path) -> Result<Option<File>> {
    let path = folder.join(LOCK);
    let file = File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .open(&path)
        .map_err(|error| cannot(&path, &error))?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(fs::TryLockError::Error(_)) => Ok(None),
        Err(fs::TryLockError::WouldBlock) => Err(Diagnostic::input(
            folder.display().to_string(),
            "another sweep is writing into it",
            "wait until it has ended, or name another folder with --out",
        )),
    }
}

fn cannot(path: &Path, error: &std::io::Error) -> Diagnostic {
    let problem = format!("cannot be written: {error}");
    Diagnostic::failed(
        path.display().to_string(),
        problem,
        "write elsewhere with --out",
    )
}
