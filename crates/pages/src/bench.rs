//! The two programs, what they are run with, and what they leave.

use std::error::Error;
use std::ffi::OsStr;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::Command;

use dem_laboratory::test_result::TestResult;
use dem_results::Summary;
use dem_results::summary::FragmentSummary;
use serde_json::Value;

pub(crate) type Failed = Box<dyn Error>;

pub(crate) const ONE_THREAD: &str = "--threads=1";

/// The programs, compiled for release, and the folder of their results.
pub(crate) struct Bench {
    dem_pack: PathBuf,
    dem_run: PathBuf,
    pub(crate) folder: PathBuf,
    /// Whether complete results in it are kept.
    resumes: bool,
}

/// A run that came to its end.
pub(crate) struct Run {
    pub(crate) folder: PathBuf,
    /// The words for its value on each axis of its study.
    pub(crate) settings: Vec<String>,
    /// Its `summary.json`.
    pub(crate) summary: Summary,
}

/// The folder of the clone.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `--set` options for these values.
pub(crate) fn sets<T: Display>(all: &[T]) -> Vec<String> {
    all.iter().map(|set| format!("--set={set}")).collect()
}

/// The option that gives a body of a scene its file.
pub(crate) fn body(name: &str, file: &Path) -> String {
    format!("--body={name}={}", file.display())
}

/// A JSON file, if it is there.
pub(crate) fn read(file: &Path) -> Option<Value> {
    serde_json::from_slice(&std::fs::read(file).ok()?).ok()
}

/// Writes a JSON file.
pub(crate) fn keep(file: &Path, value: &Value) -> Result<(), Failed> {
    Ok(std::fs::write(file, serde_json::to_vec(value)?)?)
}

/// The folder of results of a subject, made if it is missing: this program stands two folders below
/// the target folder.
pub(crate) fn results(subject: &str) -> Result<PathBuf, Failed> {
    let own = std::env::current_exe()?;
    let target = own.ancestors().nth(2).ok_or("no target folder")?;
    let folder = target.join("pages").join(subject);
    std::fs::create_dir_all(&folder)?;
    Ok(folder)
}

/// Prints a command and runs it in the folder of the clone. Returns its standard output.
fn output(command: &mut Command) -> Result<Vec<u8>, Failed> {
    output_of(command, &[0])
}

/// As [`output`], of a command that may end with these exit codes.
#[allow(clippy::print_stderr, reason = "it says what it runs")]
fn output_of(command: &mut Command, codes: &[i32]) -> Result<Vec<u8>, Failed> {
    let words: Vec<_> = command.get_args().map(OsStr::to_string_lossy).collect();
    let program = Path::new(command.get_program()).file_name();
    let program = program.unwrap_or_default().to_string_lossy();
    eprintln!("{program} {}", words.join(" "));
    let done = command.current_dir(root()).output()?;
    if !done.status.code().is_some_and(|code| codes.contains(&code)) {
        return Err(String::from_utf8_lossy(&done.stderr).into());
    }
    Ok(done.stdout)
}

impl Bench {
    /// Builds the programs, if they are needed.
    pub(crate) fn new(subject: &str, resumes: bool, builds: bool) -> Result<Self, Failed> {
        let folder = results(subject)?;
        let target = folder.ancestors().nth(2).ok_or("no target folder")?;
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = Command::new(cargo);
        build.args(["build", "--release", "--quiet", "--bins"]);
        build.args(["-p", "dem-pack", "-p", "dem-run", "--target-dir"]);
        if builds && !build.arg(target).current_dir(root()).status()?.success() {
            return Err("the programs cannot be built".into());
        }
        let program = |name: &str| {
            let file = target.join("release").join(name);
            file.with_extension(std::env::consts::EXE_EXTENSION)
        };
        Ok(Self {
            dem_pack: program("dem-pack"),
            dem_run: program("dem-run"),
            folder,
            resumes,
        })
    }

    /// Runs a command of `dem-run`. Returns what it prints.
    pub(crate) fn command<T: AsRef<OsStr>>(&self, arguments: &[T]) -> Result<Vec<u8>, Failed> {
        output(Command::new(&self.dem_run).args(arguments))
    }

    /// As [`Bench::command`], of a command that may miss what it is to reach (exit code 1).
    pub(crate) fn command_or_miss<T: AsRef<OsStr>>(&self, words: &[T]) -> Result<(), Failed> {
        output_of(Command::new(&self.dem_run).args(words), &[0, 1]).map(drop)
    }

    /// Whether a file is kept.
    pub(crate) fn has(&self, file: &Path) -> bool {
        self.resumes && file.exists()
    }

    /// The body that `dem-pack` makes of a shape in `data/shapes` with these options. Its report
    /// stands next to it, as JSON.
    pub(crate) fn pack<T: AsRef<OsStr>>(
        &self,
        name: &str,
        shape: &str,
        options: &[T],
    ) -> Result<PathBuf, Failed> {
        let shape = format!("data/shapes/{shape}.stl");
        let options = options.iter().map(AsRef::as_ref);
        let words: Vec<&OsStr> = std::iter::once(OsStr::new(&shape)).chain(options).collect();
        self.packed(name, &words)
    }

    /// The body that `dem-pack` makes with these words, with its report.
    pub(crate) fn packed<T: AsRef<OsStr>>(
        &self,
        name: &str,
        words: &[T],
    ) -> Result<PathBuf, Failed> {
        let file = self.folder.join(format!("{name}.vtp"));
        let report = file.with_extension("json");
        if !self.has(&report) {
            let mut command = Command::new(&self.dem_pack);
            command.args(words).args(["--json", "-o"]).arg(&file);
            std::fs::write(report, output(&mut command)?)?;
        }
        Ok(file)
    }

    /// A packing as in the comments of the scenes: overlap 0.296, touching spheres bonded.
    pub(crate) fn usual(
        &self,
        shape: &str,
        diameters: &str,
        seed: impl Display,
    ) -> Result<PathBuf, Failed> {
        let name = format!("{shape}-{diameters}-{seed}");
        let seed = format!("--seed={seed}");
        let options = ["--overlap=0.296", "--bond-range=1.0", &seed];
        let diameters = format!("--diameter={diameters}");
        self.pack(&name, shape, &[&options[..], &[&diameters]].concat())
    }

    /// Runs a scene with these options and hardly any pictures into a folder of the results.
    pub(crate) fn run(&self, name: &str, scene: &str, options: &[String]) -> Result<Run, Failed> {
        let folder = self.folder.join(name);
        if let Some(run) = finished(&folder).filter(|_| self.resumes) {
            return Ok(run);
        }
        let mut command = Command::new(&self.dem_run);
        command.args([scene, "--set=output.pictures=\"10 s\"", "--quiet"]);
        command.args(options).args(["--force", "--output"]);
        output(command.arg(&folder))?;
        finished(&folder).ok_or_else(|| "the run did not come to its end".into())
    }

    /// Runs a study of `data/studies`, or keeps its complete runs. Returns all in its order.
    pub(crate) fn study(&self, study: &str) -> Result<Vec<Run>, Failed> {
        let folder = self.folder.join(study);
        let mut command = Command::new(&self.dem_run);
        command.args(["sweep", &format!("data/studies/{study}.toml")]);
        command.args(["--json", "--quiet", "--output"]).arg(&folder);
        command.arg(if self.has(&folder) {
            "--resume"
        } else {
            "--force"
        });
        let table: Value = serde_json::from_slice(&output(&mut command)?)?;
        let rows = table["runs"].as_array().ok_or("the study has no runs")?;
        rows.iter().map(|row| of_study(row, &folder)).collect()
    }
}

fn of_study(row: &Value, folder: &Path) -> Result<Run, Failed> {
    if let Some(why) = row["failed"].as_str() {
        return Err(why.into());
    }
    let folder = folder.join(format!("runs/{:04}-1", number(&row["number"])));
    let words = row["settings"].as_array().into_iter().flatten();
    let words = words.map(|word| word.as_str().unwrap_or_default().to_owned());
    let run = finished(&folder).ok_or("a run did not come to its end")?;
    Ok(Run {
        settings: words.collect(),
        ..run
    })
}

/// The run with its results in this folder, if it came to its end.
pub(crate) fn finished(folder: &Path) -> Option<Run> {
    let summary = Summary::read(&folder.join("summary.json"))?;
    summary.problem.is_none().then(|| Run {
        folder: folder.to_owned(),
        settings: Vec::new(),
        summary,
    })
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

impl Run {
    pub(crate) fn processor_s(&self) -> f64 {
        self.summary.processor_s.unwrap_or(f64::NAN)
    }

    /// Its fragments; none if nothing could break.
    pub(crate) fn fragments(&self) -> FragmentSummary {
        self.summary.fragments.unwrap_or_default()
    }

    /// The value of a measure.
    pub(crate) fn measured(&self, measure: &str) -> Result<f64, Failed> {
        let mut measures = self.summary.measures.iter();
        let found = measures.find(|one| one.name == measure && !one.value.is_nan());
        let value = found.map(|one| one.value);
        Ok(value.ok_or_else(|| format!("the run has not measured {measure}"))?)
    }

    pub(crate) fn test(&self) -> Result<TestResult, Failed> {
        Ok(self.summary.test.clone().ok_or("the run has no test")?)
    }

    /// Columns of one of its tables of numbers, row by row.
    pub(crate) fn columns<const N: usize>(
        &self,
        file: &str,
        names: [&str; N],
    ) -> Result<Vec<[f64; N]>, Failed> {
        let rows = self.words(file, names)?;
        let numbers = rows.into_iter().map(|row| {
            let mut numbers = [0.0; N];
            for (number, cell) in numbers.iter_mut().zip(row) {
                *number = cell.parse()?;
            }
            Ok(numbers)
        });
        numbers.collect()
    }

    /// Columns of one of its tables, row by row, as they are written.
    pub(crate) fn words<const N: usize>(
        &self,
        file: &str,
        names: [&str; N],
    ) -> Result<Vec<[String; N]>, Failed> {
        let text = std::fs::read_to_string(self.folder.join(file))?;
        let mut lines = text.lines();
        let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            let at = head.iter().position(|other| *other == name);
            *place = at.ok_or_else(|| format!("{file} has no {name}"))?;
        }
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            places.map(|place| cells.get(place).copied().unwrap_or_default().to_owned())
        };
        Ok(lines.map(row).collect())
    }
}
