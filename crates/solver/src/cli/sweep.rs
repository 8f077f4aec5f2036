//! `dem-run sweep`: a scene with many settings: the response of measures, a value that is searched,
//! or error and run time.

mod packings;
mod results;

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::write_target::{need_folder_of, refuse_input};
use dem_io::{Diagnostic, Result};
use dem_scene::study::{
    Combine, MeasureOf, Reference, RunTime, Setting, Study, StudyMeasure, read_study,
    reference_values, rewritten, scene_with, settle_references, value_to_find,
};
use dem_scene::text_of;
use dem_terminal::progress::progress_bar;

use self::packings::{checked_packings, make_packings};
use self::results::{list, say, write_files};
use super::pool::refuse_threads;
use super::progress::{Log, Tell, is_logged};
use crate::interrupt::Interrupt;
use dem_laboratory::test_result::T10;
use dem_study::collect::outcome;
use dem_study::design::in_words;
use dem_study::expand::{MOST_UNASKED, Run, runs};
use dem_study::folder::{Earlier, SweepFolder};
use dem_study::jobs::{Job, further_jobs, jobs, refuse_unlistable, work};
use dem_study::outcome::Outcome;
use dem_study::packings::PACKINGS;
use dem_study::search::{SearchResult, Step, next_of};
use dem_study::sweep_table::SweepTable;
use dem_study::want::{Want, fastest};

#[derive(Debug, Args)]
pub(super) struct SweepArguments {
    /// The study (.toml): a scene, what varies or is searched, what is measured
    study: PathBuf,
    /// Folder for the runs and results; the study's name with -sweep unless given
    #[arg(long, short, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Number of simultaneous runs. More than one disturb each other's times
    #[arg(long, value_name = "N", default_value_t = 1)]
    jobs: usize,
    /// Number of threads of each run; that of the study unless given
    #[arg(long, value_name = "N")]
    threads: Option<u32>,
    /// Resume an interrupted sweep: finished runs are kept
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Overwrite the sweep in the folder
    #[arg(long)]
    force: bool,
    /// Allow more than 10000 runs
    #[arg(long)]
    yes: bool,
    /// Run nothing: print one sh command for each remaining run, and write them as a Slurm job
    /// array and a Snakemake file into the folder
    #[arg(long, conflicts_with_all = ["collect", "max_error", "json", "quiet"])]
    list: bool,
    /// Run nothing: collect the finished runs into tables and pages
    #[arg(long, conflicts_with_all = ["force", "resume"])]
    collect: bool,
    /// Find the fastest setting whose errors are at most this: all=1% for all measures, or NAME=1%
    #[arg(long, value_name = "NAME=ERROR")]
    max_error: Vec<String>,
    /// Write the scene with the fastest setting to this file
    #[arg(long, value_name = "FILE", requires = "max_error")]
    write: Option<PathBuf>,
    /// Print the table as JSON
    #[arg(long)]
    json: bool,
    /// Only print errors: no progress, no table; --json is still printed
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the study, lists its runs or collects them, and prints the result. Runs that failed or are
/// missing are an error, once the tables of the others are written. `tell` is called with how far
/// the runs have come.
pub(super) fn sweep(options: &SweepArguments, interrupt: &Interrupt, tell: Tell<'_>) -> Result<()> {
    let mut sweep = Sweep::prepared(options)?;
    if let Some(design) = &sweep.study.design
        && !options.quiet
        && !options.collect
    {
        let words = in_words(&sweep.study, design);
        // A closed output is not a reason to stop.
        let _ = writeln!(std::io::stderr(), "design {}", visible(&words));
    }
    let Some(mut table) = sweep.table(options, interrupt, tell)? else {
        return Ok(());
    };
    if options.list {
        return Ok(());
    }
    if options.jobs > 1 && (table.has_errors() || measures_wall_time(&sweep.study)) {
        table.notes.push(format!(
            "{} runs at a time: they disturb each other's times",
            options.jobs
        ));
    }
    sweep.conclude(options, &table)
}

/// A study, and what follows from it before anything is run.
struct Sweep {
    study: Study,
    /// Text of its scene.
    scene_text: String,
    runs: Vec<Run>,
    /// The reference of each measure, if it is a number.
    references: Vec<Option<f64>>,
    /// The value of `[find]`.
    looked_for: Option<f64>,
    wants: Vec<Want>,
    folder: SweepFolder,
}

impl Sweep {
    /// Reads and checks everything, and makes the folder.
    fn prepared(options: &SweepArguments) -> Result<Self> {
        if !(1..=1024).contains(&options.jobs) {
            let problem = format!("{} is not between 1 and 1024", options.jobs);
            return Err(Diagnostic::input(
                "--jobs",
                problem,
                "1 measures run times best",
            ));
        }
        if let Some(target) = &options.write {
            need_folder_of(target).map_err(|error| error.within("--write"))?;
        }
        let mut study = read_study(&options.study)?;
        if let Some(threads) = options.threads {
            refuse_threads(threads as usize, "leave it out for those of the study")?;
            study.threads = threads;
        }
        let scene_text = text_of(&study.scene, "a scene")
            .map_err(|error| error.within(&format!("{}: scene", study.source)))?;
        study.settle_design(&scene_text)?;
        // What is wrong with it is said when the scenes of all runs are checked.
        let first = scene_with(&study, &scene_text, study.first_settings()).ok();
        if let Some(first) = &first {
            settle_references(&mut study, first);
        }
        let wants = wants(options, &study)?;
        let runs = runs(&study, options.yes)?;
        let path = options.output.clone().unwrap_or_else(|| {
            let stem = options.study.file_stem().unwrap_or_default();
            PathBuf::from(format!("{}-sweep", stem.to_string_lossy()))
        });
        refuse_unlistable_names(options, &study, &path)?;
        study.packings = path.join(PACKINGS);
        let (references, mut inputs) = checked(&study, &scene_text, &runs)?;
        inputs.extend(checked_packings(&study, &runs)?);
        let looked_for = match &first {
            Some(first) => value_to_find(&study, first)?,
            None => None,
        };
        inputs.push(options.study.clone());
        SweepFolder::refuse_inputs(&path, &inputs)?;
        if let Some(target) = &options.write {
            refuse_input(&format!("--write {}", target.display()), target, &inputs)?;
        }
        let folder = SweepFolder::create(&path, earlier(options), &study, &scene_text)?;
        Ok(Self {
            study,
            scene_text,
            runs,
            references,
            looked_for,
            wants,
            folder,
        })
    }

    /// Does the runs, and further ones until the value that is looked for is found. None: they have
    /// been listed.
    fn table(
        &mut self,
        options: &SweepArguments,
        interrupt: &Interrupt,
        tell: Tell<'_>,
    ) -> Result<Option<SweepTable>> {
        loop {
            let Self {
                study,
                runs: all,
                folder,
                ..
            } = self;
            let Some(outcomes) = outcomes_of(options, study, all, folder, interrupt, tell)? else {
                return Ok(None);
            };
            let table = SweepTable::new(study, all, &outcomes, &self.references, self.looked_for);
            let next = next_points(study, &table);
            if next.is_empty() {
                return Ok(Some(table));
            }
            for (case, point) in next {
                study.add_point(case, point);
            }
            *all = runs(study, options.yes)?;
            checked(study, &self.scene_text, all)?;
            if options.collect && !is_done(study, all, folder) {
                return Ok(Some(table));
            }
        }
    }

    /// Writes the results, and the scene with the fastest setting, and says what they are.
    fn conclude(&self, options: &SweepArguments, table: &SweepTable) -> Result<()> {
        let study = &self.study;
        write_files(&self.folder, table)?;
        let failure = failure(study, table);
        if let Some(failure) = &failure
            && table.failed().count() == table.runs.len()
        {
            return Err(failure.clone());
        }
        let best = if self.wants.is_empty() {
            None
        } else {
            Some(fastest(table, &self.wants)?)
        };
        if let (Some(best), Some(target)) = (best, &options.write) {
            let run = self.runs.iter().find(|run| run.number == best.number);
            let settings = run.map_or(Vec::new(), |run| run.settings(study));
            let settings: Vec<&Setting> = settings.iter().collect();
            let text = rewritten(study, &self.scene_text, &settings, target)?;
            write_file(target, |out| out.write_all(text.as_bytes()))?;
        }
        if options.json || !options.quiet {
            let written = options.write.as_deref();
            say(
                study,
                &self.runs,
                table,
                best,
                written,
                &self.folder,
                options.json,
            )?;
        }
        failure
            .or_else(|| not_found(study, table))
            .map_or(Ok(()), Err)
    }
}

/// True if a measure is a wall time, which other runs disturb.
fn measures_wall_time(study: &Study) -> bool {
    let is_time = |measure: &StudyMeasure| measure.of == MeasureOf::RunTime(RunTime::Wall);
    study.measures.iter().any(is_time)
}

/// The errors that are asked for, of measures with a reference.
fn wants(options: &SweepArguments, study: &Study) -> Result<Vec<Want>> {
    let compared = study
        .measures
        .iter()
        .filter(|m| m.reference != Reference::None);
    let names: Vec<&str> = compared.map(|m| m.name.as_str()).collect();
    let texts = options.max_error.iter();
    texts.map(|text| Want::parse(text, &names)).collect()
}

fn earlier(options: &SweepArguments) -> Earlier {
    match options {
        SweepArguments { collect: true, .. } => Earlier::Collect,
        SweepArguments { force: true, .. } => Earlier::Replace,
        SweepArguments { resume: true, .. } => Earlier::Continue,
        _ => Earlier::Refuse,
    }
}

/// The outcomes of all runs, after those that are left have been done. With `--list` the commands
/// of those that are left are printed instead; if there are any, the result is None.
fn outcomes_of(
    options: &SweepArguments,
    study: &Study,
    all: &[Run],
    folder: &SweepFolder,
    interrupt: &Interrupt,
    tell: Tell<'_>,
) -> Result<Option<Vec<Vec<Outcome>>>> {
    let mut all_jobs = jobs(all, study.repeats());
    let is_run_here = !options.collect && !options.list;
    if is_run_here {
        do_what_is_left(options, study, all, &all_jobs, folder, interrupt, tell)?;
    }
    let mut outcomes: Vec<Vec<Outcome>> = vec![Vec::new(); all.len()];
    read(study, all, &all_jobs, folder, &mut outcomes);
    let further = further_jobs(all, study.repeats(), &outcomes);
    if options.list {
        all_jobs.extend(&further);
        all_jobs.retain(|job| !job.is_done(&folder.runs()));
        make_packings(study, runs_of(all, &all_jobs), true, interrupt)?;
        list(study, all, &all_jobs, folder)?;
        if !all_jobs.is_empty() {
            return Ok(None);
        }
    }
    if is_run_here {
        do_what_is_left(options, study, all, &further, folder, interrupt, tell)?;
    }
    read(study, all, &further, folder, &mut outcomes);
    Ok(Some(outcomes))
}

/// The points that `[find]` tries next, with the numbers of their cases. Empty if there is no
/// search, or if all cases have come to their end.
fn next_points(study: &Study, table: &SweepTable) -> Vec<(usize, f64)> {
    let (Some(find), Some(search)) = (&study.find, &table.find) else {
        return Vec::new();
    };
    let mut responses = table.responses.iter();
    let Some(response) = responses.find(|response| response.measure == find.measure) else {
        return Vec::new();
    };
    let next = |case: usize| match next_of(study, find, response, search.value, case) {
        Step::Try(point) => Some((case, point)),
        Step::Found(_) | Step::NotBracketed | Step::Wait => None,
    };
    (0..search.cases.len()).filter_map(next).collect()
}

/// True if all runs have come to their end.
fn is_done(study: &Study, all: &[Run], folder: &SweepFolder) -> bool {
    let jobs = jobs(all, study.repeats());
    jobs.iter().all(|job| job.is_done(&folder.runs()))
}

/// The problem of a search whose value does not lie between those at the ends. None for others.
fn not_found(study: &Study, table: &SweepTable) -> Option<Diagnostic> {
    let (find, search) = (study.find.as_ref()?, table.find.as_ref()?);
    let name = &table.measures[search.measure].name;
    let mut cases = search.cases.iter();
    let lost = cases.find(|case| case.result == SearchResult::NotBracketed)?;
    let is_t10 = match &study.measures[search.measure].of {
        MeasureOf::Figure(name) => name == T10,
        _ => false,
    };
    let remedy = if is_t10 {
        "look for a value between these, or widen from and to; t10 cannot exceed the share of the spheres that are smaller than a tenth of the body ('largest possible t10' of its runs): if that is the limit, take smaller spheres"
    } else {
        "widen from and to, or look for a value between these"
    };
    Some(Diagnostic::failed(
        &find.place,
        search.in_words(lost, name),
        remedy,
    ))
}

/// Refuses names that shell commands cannot represent.
fn refuse_unlistable_names(options: &SweepArguments, study: &Study, out: &Path) -> Result<()> {
    refuse_unlistable("the study", &options.study)?;
    refuse_unlistable(&format!("{}: scene", study.source), &study.scene)?;
    refuse_unlistable("the folder of the sweep", out)?;
    let of_axes = study.axes.iter().flat_map(|axis| &axis.values);
    let varied = of_axes.flat_map(|value| &value.settings);
    for setting in study.fixed.iter().chain(varied) {
        for text in [&setting.path, &setting.value] {
            refuse_unlistable(&setting.place, Path::new(text))?;
        }
    }
    Ok(())
}

/// The problem of a sweep with runs without values. None: all have values.
fn failure(study: &Study, table: &SweepTable) -> Option<Diagnostic> {
    let first = table.failed().next()?;
    let (failed, all) = (table.failed().count(), table.runs.len());
    let count = if failed == all {
        "no run came to its end".to_owned()
    } else {
        format!("{failed} of {all} runs did not come to their end")
    };
    Some(Diagnostic::failed(
        &study.source,
        format!(
            "{count}; the first: run {}, {}: {}",
            first.number,
            table.named(first),
            first.failed.as_deref().unwrap_or_default()
        ),
        "what they left is in the folder of the sweep; --resume tries them again",
    ))
}

/// Adds the results of jobs to the outcomes of their runs.
fn read(
    study: &Study,
    all: &[Run],
    jobs: &[Job],
    folder: &SweepFolder,
    outcomes: &mut [Vec<Outcome>],
) {
    let runs = folder.runs();
    for job in jobs {
        if let Some(of_run) = job.index(all).and_then(|index| outcomes.get_mut(index)) {
            of_run.push(outcome(study, *job, &runs));
        }
    }
}

fn do_what_is_left(
    options: &SweepArguments,
    study: &Study,
    all: &[Run],
    jobs: &[Job],
    folder: &SweepFolder,
    interrupt: &Interrupt,
    tell: Tell<'_>,
) -> Result<()> {
    let runs = folder.runs();
    let todo: Vec<Job> = (jobs.iter().copied())
        .filter(|job| !job.is_done(&runs))
        .collect();
    make_packings(study, runs_of(all, &todo), options.quiet, interrupt)?;
    let template = "sweep [{bar:40}] {pos}/{len} runs  {eta} left";
    let bar = progress_bar(options.quiet, todo.len(), template);
    let is_logged = is_logged(options.quiet);
    let log = RefCell::new(Log::new("sweep "));
    let show = |done: usize| {
        bar.set_position(done as u64);
        if todo.is_empty() {
            return;
        }
        let fraction = done as f64 / todo.len() as f64;
        let what = format!("{done} of {} runs done", todo.len());
        tell(fraction, &what);
        if is_logged {
            log.borrow_mut().tell(fraction, &what);
        }
    };
    show(0);
    let worked = interrupt.run_interruptible(|interrupted| {
        work(study, all, &todo, &runs, options.jobs, interrupted, &show)
    });
    bar.finish_and_clear();
    worked
}

/// The runs of some jobs.
fn runs_of<'a>(all: &'a [Run], jobs: &[Job]) -> impl Iterator<Item = &'a Run> {
    jobs.iter().filter_map(|job| Some(&all[job.index(all)?]))
}

/// Reads the scene of every run, so that errors appear before hours are spent. Returns the
/// reference of each measure, if known, and the files that the scenes read. If there are very many
/// runs, reads one for each value.
fn checked(
    study: &Study,
    scene_text: &str,
    all: &[Run],
) -> Result<(Vec<Option<f64>>, Vec<PathBuf>)> {
    let is_grid = study.combine == Combine::Grid && study.design.is_none();
    let are_many = is_grid && all.len() as u64 > MOST_UNASKED;
    let differs_once = |run: &&Run| run.choice.iter().filter(|at| **at > 0).count() <= 1;
    let mut values = Vec::new();
    let mut files = BTreeSet::new();
    for run in all.iter().filter(|run| !are_many || differs_once(run)) {
        let settings = run.settings(study);
        let scene = scene_with(study, scene_text, settings.iter())?;
        let of_run = reference_values(study, &scene)?;
        if values.is_empty() {
            values = of_run;
        }
        files.extend(scene.input_files());
    }
    Ok((values, files.into_iter().collect()))
}
