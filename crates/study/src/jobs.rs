//! The processes of a sweep: what to start, in which order, and what is left.

use std::collections::{BTreeMap, VecDeque};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::Duration;

use dem_io::own_command::own_command;
use dem_io::{Diagnostic, Result};
use dem_results::Summary;
use dem_results::folder::{is_locked, is_written_to};
use dem_scene::study::{BODY, Keep, Study, override_text};

use super::expand::Run;
use super::outcome::Outcome;

/// Runs done more than once are repeated up to this total measured time, s, or this number of
/// repeats: short ones scatter most.
const MEASURED_S: f64 = 0.5;
const MOST_REPEATS: u32 = 25;
/// Interval at which processes are checked. They measure their own times.
const LOOK: Duration = Duration::from_millis(5);

/// One process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Job {
    /// Number of the run, from 1.
    pub number: usize,
    /// Number of the repeat, from 1.
    pub repeat: u32,
}

impl Job {
    /// Folder of its results.
    pub fn folder(&self, runs: &Path) -> PathBuf {
        runs.join(format!("{:04}-{}", self.number, self.repeat))
    }

    /// File of its error messages.
    pub fn complaint(&self, runs: &Path) -> PathBuf {
        runs.join(format!("{:04}-{}.txt", self.number, self.repeat))
    }

    /// The job whose folder or error file has this name, such as `0007-2` or `0007-2.txt`.
    pub fn named(name: &str) -> Option<Self> {
        let (run, repeat) = name.strip_suffix(".txt").unwrap_or(name).split_once('-')?;
        let job = Self {
            number: run.parse::<usize>().ok().filter(|number| *number > 0)?,
            repeat: repeat.parse().ok()?,
        };
        let is_same = |path: PathBuf| path.as_os_str() == name;
        let own = [job.folder(Path::new("")), job.complaint(Path::new(""))];
        own.into_iter().any(is_same).then_some(job)
    }

    /// Index of its run in the list of all, which is in the order of the numbers.
    pub fn index(&self, all: &[Run]) -> Option<usize> {
        all.binary_search_by_key(&self.number, |run| run.number)
            .ok()
    }

    /// True if its process is running at this moment, although the sweep that started it may have
    /// ended.
    pub(crate) fn is_alive(&self, runs: &Path) -> bool {
        is_locked(&self.complaint(runs)) || is_written_to(&self.folder(runs))
    }

    /// True if it has finished.
    pub fn is_done(&self, runs: &Path) -> bool {
        let summary = Summary::read(&self.folder(runs).join("summary.json"));
        // A failed run also leaves a summary, which contains the reason.
        summary.is_some_and(|summary| summary.problem.is_none())
    }
}

/// All processes. Each run is done once before any is repeated, forwards and backwards in turn, so
/// that a machine that slows down favours none.
pub fn jobs(all: &[Run], repeats: u32) -> Vec<Job> {
    let mut jobs = Vec::new();
    for repeat in 1..=repeats {
        let one = all.iter().map(|run| Job {
            number: run.number,
            repeat,
        });
        if repeat % 2 == 1 {
            jobs.extend(one);
        } else {
            jobs.extend(one.rev());
        }
    }
    jobs
}

/// Further repeats of short runs, from the outcomes of all [`jobs`] of each run. None for a run
/// with an unfinished job.
pub fn further_jobs(all: &[Run], repeats: u32, outcomes: &[Vec<Outcome>]) -> Vec<Job> {
    if repeats == 1 {
        return Vec::new();
    }
    let wanted = |outcomes: &Vec<Outcome>| {
        let times_s = outcomes.iter().map(|outcome| match outcome {
            Outcome::Done(done) => Some(done.time_s),
            _ => None,
        });
        let all_s: Option<f64> = times_s.sum();
        let mean_s = all_s.unwrap_or(f64::INFINITY) / f64::from(repeats);
        (MEASURED_S / mean_s).ceil().min(f64::from(MOST_REPEATS)) as u32
    };
    let numbers = all.iter().map(|run| run.number);
    let wanted: BTreeMap<usize, u32> = numbers.zip(outcomes.iter().map(wanted)).collect();
    let mut jobs = jobs(all, MOST_REPEATS);
    jobs.retain(|job| {
        let wanted = wanted.get(&job.number).copied().unwrap_or_default();
        job.repeat > repeats && job.repeat <= wanted
    });
    jobs
}

/// The arguments of the program for one process.
pub fn arguments(study: &Study, run: &Run, job: Job, runs: &Path) -> Vec<String> {
    let mut arguments = scene_arguments(study, run);
    let threads = study.threads.to_string();
    let out = job.folder(runs).display().to_string();
    for argument in [
        "--threads",
        &threads,
        "--output",
        &out,
        "--force",
        "--quiet",
    ] {
        arguments.push(argument.to_owned());
    }
    if study.keep == Keep::Tables {
        arguments.extend(["--keep", "tables"].map(str::to_owned));
    }
    arguments
}

/// The scene and its values.
pub fn scene_arguments(study: &Study, run: &Run) -> Vec<String> {
    let scene = study.scene.display().to_string();
    // Prevents its interpretation as an option.
    let here = if scene.starts_with('-') { "./" } else { "" };
    let mut arguments = vec![format!("{here}{scene}")];
    for setting in run.settings(study) {
        match setting.path.strip_prefix(BODY) {
            Some(body) => {
                arguments.push("--body".to_owned());
                arguments.push(format!("{body}={}", setting.value));
            }
            None => {
                arguments.push("--set".to_owned());
                arguments.push(override_text(&setting));
            }
        }
    }
    if study.force_step {
        arguments.push("--force-step".to_owned());
    }
    arguments
}

/// A command line for sh.
pub fn shell_line(program: &str, arguments: &[String], complaint: Option<&Path>) -> String {
    let mut line = shell_word(program);
    for argument in arguments {
        line.push(' ');
        line += &shell_word(argument);
    }
    if let Some(path) = complaint {
        line += &format!(" 2> {}", shell_word(&path.display().to_string()));
    }
    line
}

/// Refuses names that a command of `--list` cannot contain: it is one line of text.
///
/// # Errors
/// The name `text`, given at `place`, has control characters or is not UTF-8.
pub fn refuse_unlistable(place: &str, text: &Path) -> Result<()> {
    let problem = match text.to_str() {
        None => "is not UTF-8",
        Some(text) if text.chars().any(char::is_control) => "holds a control character",
        Some(_) => return Ok(()),
    };
    Err(Diagnostic::input(
        place,
        format!("'{}' {problem}", text.display()),
        "rename it: the command of each run is one line of text",
    ))
}

/// A word for sh.
pub fn shell_word(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

/// A running process, and its job. It is killed when dropped.
struct Started(Child, Job);

impl Drop for Started {
    fn drop(&mut self) {
        if matches!(self.0.try_wait(), Ok(None)) {
            let _ = self.0.kill();
            let _ = self.0.wait();
        }
    }
}

/// Runs the jobs, several at a time. A failed one leaves its error message; the others continue.
/// `tell` is called with the number of finished jobs.
pub fn work(
    study: &Study,
    all: &[Run],
    todo: &[Job],
    runs: &Path,
    at_a_time: usize,
    interrupted: &AtomicBool,
    tell: &dyn Fn(usize),
) -> Result<()> {
    let (program, first) = own_command().map_err(|error| not_started(&error))?;
    let mut waiting: VecDeque<Job> = todo.iter().copied().collect();
    let mut started: Vec<Started> = Vec::new();
    let mut done = 0;
    loop {
        if interrupted.load(Ordering::Relaxed) {
            return Err(Diagnostic::interrupted(
                format!("interrupted after {done} of {} runs", todo.len()),
                "go on with --resume",
            ));
        }
        while started.len() < at_a_time
            && let Some(job) = waiting.pop_front()
        {
            let Some(run) = job.index(all) else {
                continue;
            };
            let complaint = job.complaint(runs);
            let say = File::create(&complaint).map_err(|error| {
                let problem = format!("cannot be written: {error}");
                Diagnostic::failed(complaint.display().to_string(), problem, "")
            })?;
            // The process inherits the lock with its standard error, and holds it as long as it
            // lives. If the disk does not support locks, the lock of its folder remains. On Windows
            // locks are not inherited, and would keep the process from writing.
            #[cfg(unix)]
            let _ = say.try_lock();
            let child = Command::new(&program)
                .args(&first)
                .args(arguments(study, &all[run], job, runs))
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(say)
                .spawn()
                .map_err(|error| not_started(&error))?;
            started.push(Started(child, job));
        }
        if started.is_empty() {
            return Ok(());
        }
        let before = started.len();
        started.retain_mut(|Started(child, job)| match child.try_wait() {
            Ok(None) => true,
            Ok(Some(status)) => {
                let complaint = job.complaint(runs);
                let is_silent = fs::metadata(&complaint).is_ok_and(|file| file.len() == 0);
                if !status.success() && is_silent {
                    let _ = fs::write(&complaint, format!("error: ended by {status}\n"));
                }
                false
            }
            Err(_) => false,
        });
        done += before - started.len();
        tell(done);
        if before == started.len() {
            sleep(LOOK);
        }
    }
}

fn not_started(error: &std::io::Error) -> Diagnostic {
    let problem = format!("dem-run cannot be started: {error}");
    Diagnostic::failed("", problem, "run the commands of --list yourself")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_go_there_and_back() {
        let all = [1, 2, 5].map(|number| Run {
            number,
            choice: Vec::new(),
        });
        let jobs = jobs(&all, 3);
        let order: Vec<(usize, u32)> = jobs.iter().map(|job| (job.number, job.repeat)).collect();
        assert_eq!(jobs[2].index(&all), Some(2));
        let wanted = [
            (1, 1),
            (2, 1),
            (5, 1),
            (5, 2),
            (2, 2),
            (1, 2),
            (1, 3),
            (2, 3),
            (5, 3),
        ];
        assert_eq!(order, wanted);
    }

    #[test]
    fn jobs_are_known_by_the_names_of_their_files() {
        let job = Job {
            number: 7,
            repeat: 2,
        };
        assert_eq!(Job::named("0007-2"), Some(job));
        assert_eq!(Job::named("0007-2.txt"), Some(job));
        let long = Job {
            number: 12345,
            repeat: 11,
        };
        assert_eq!(Job::named("12345-11"), Some(long));
        for other in [
            "",
            "7-2",
            "0007",
            "0000-1",
            "0007-02",
            "0007-2.csv",
            "00007-2",
            "a-b",
        ] {
            assert_eq!(Job::named(other), None, "{other}");
        }
    }

    #[test]
    fn what_would_split_a_line_is_refused() {
        for good in ["a b.toml", "it's $(x) `y` \\ \"z\" *é", ""] {
            assert_eq!(refuse_unlistable("here", Path::new(good)), Ok(()));
        }
        for bad in ["a\nreboot", "a\rb", "\u{1b}[2J", "a\tb", "\u{85}"] {
            let said = refuse_unlistable("here", Path::new(bad)).map_err(|error| error.to_string());
            let said = said.err().unwrap_or_default();
            assert!(
                said.starts_with("here: 'a") || said.starts_with("here: '\\u{"),
                "{said}"
            );
            assert!(
                said.contains("' holds a control character; rename it"),
                "{said}"
            );
            assert!(!said.chars().any(char::is_control), "{said}");
        }
    }

    proptest::proptest! {
        /// Each line, when read by sh, is exactly the intended command.
        #[cfg(unix)]
        #[test]
        fn sh_splits_no_line_of_any_names(
            lines in proptest::collection::vec(
                proptest::collection::vec("[ -~é\u{202e}\u{2028}$`'\"\\\\;&|<>*?!#~(){}\\[\\]-]{0,12}", 0..6),
                1..20,
            )
        ) {
            let mut script = String::new();
            let mut wanted = Vec::new();
            for arguments in &lines {
                let mut all = vec!["%s\\0".to_owned()];
                all.extend(arguments.iter().cloned());
                // Without arguments, printf writes its format once.
                all.push("end".to_owned());
                script += &shell_line("printf", &all, None);
                script.push('\n');
                for argument in &all[1..] {
                    wanted.extend(argument.bytes());
                    wanted.push(0);
                }
            }
            let output = Command::new("sh").arg("-c").arg(&script).output();
            let output = output.map_err(|error| proptest::test_runner::TestCaseError::fail(error.to_string()))?;
            proptest::prop_assert_eq!(output.stdout, wanted);
            proptest::prop_assert!(output.stderr.is_empty());
        }
    }

    #[test]
    fn sh_reads_what_is_meant() {
        let arguments = ["--set", "a.b=\"2 mm\"", "it's", ""].map(str::to_owned);
        assert_eq!(
            shell_line("dem-run", &arguments, Some(Path::new("a b.txt"))),
            r#"dem-run --set 'a.b="2 mm"' 'it'\''s' '' 2> 'a b.txt'"#
        );
    }
}
