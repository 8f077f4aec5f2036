//! `dem-run calibrate`: numbers of a scene with which the mean test of several packings gives the
//! wanted results.

mod arguments;
mod output_files;
mod several;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use dem_calibration::{
    Case, End, FORMAT_VERSION, Record, Unknown, calibrate as search, check_rate, page, read_record,
    report, write_record,
};
use dem_io::diagnostic::Kind;
use dem_io::hash::{file_hash, fnv1a_of_parts};
use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::units::{show_length, significant};
use dem_io::{Body, Diagnostic, Result};
use dem_scene::{Scene, Test, material_text, scene_from_text, text_of};
use dem_terminal::program::today;
use dem_terminal::progress::ProgressBar;
use dem_terminal::standard_output::{write_standard_json, write_standard_output};

pub(super) use self::arguments::CalibrateArguments;
use self::arguments::PACKINGS;
use self::output_files::{OutputFiles, not_met};
use super::packings::{Packings, spheres_across};
use super::pool::in_pool;
use super::progress::LogOfTests;
use crate::calibration::{Beginning, Bench, Prospect, SceneText, pace_of, prospect, unknowns};
use crate::interrupt::Interrupt;

/// Calibrates, writes material, page and record, and prints a summary. Targets that are not met are
/// an error, once page and record are written.
pub(super) fn calibrate(options: &CalibrateArguments, interrupt: &Interrupt) -> Result<()> {
    if !options.more.is_empty() {
        return several::calibrate_several(options, interrupt);
    }
    let most_error = options.max_error.as_deref().map(fraction).transpose()?;
    let source = options.scene.place();
    let text = text_of(scene_file(options)?, "a scene")?;
    let overrides = options.scene.all_overrides();
    let scene = scene_from_text(&text, &source, &overrides)?;
    for note in &scene.notes {
        let _ = writeln!(std::io::stderr(), "note: {}", visible(note));
    }
    let mut packings = Packings::of(options.recipes()?, &options.scene.body, &scene)?;
    packings.count = options.packings.unwrap_or(PACKINGS);
    let files = OutputFiles::of(&options.output, packings.case_names().len())?;
    let mut inputs = scene.input_files();
    inputs.extend(packings.files());
    let existing = [options.resume, options.force];
    files.refuse(&inputs, existing)?;
    let _lock = files.lock()?;
    // Another one may have ended since.
    files.refuse(&inputs, existing)?;
    let scene_text = SceneText {
        text: &text,
        source: &source,
        overrides: &overrides,
    };
    in_pool(options.scene.threads, |threads| {
        let others = packings.other_bodies(&scene)?;
        let first = packings.make(0, 0, &AtomicBool::new(false))?;
        let prospect = prospect(&scene, &packings.body, &first, &others, threads)?;
        let unknowns = unknowns(
            &scene,
            &scene_text,
            &options.free,
            options.modulus,
            prospect.stiffness_n_m,
        )?;
        prospect.check(&scene, &unknowns)?;
        let identity = identity(&text, options, &scene, &packings);
        let mut record = match options.resume {
            true => resumed(&files.record, identity)?,
            false => {
                files.remove()?;
                new_record(
                    &scene,
                    &packings,
                    unknowns,
                    &prospect,
                    &options.pack,
                    identity,
                )
            }
        };
        write_record(&files.record, &record)?;
        let job = Job {
            options,
            scene: &scene_text,
            others: &others,
            packings: &packings,
            first: &first,
            threads,
            test: scene.test.as_ref(),
            checks_rate: scene.test.as_ref().is_some_and(|test| test.rate_check),
            record_file: &files.record,
        };
        let worked = interrupt.run_interruptible(|stop| job.do_all(&mut record, stop));
        worked.map_err(|mut error| {
            if error.kind == Kind::Interrupted {
                error.remedy = "go on with --resume".to_owned();
            }
            error
        })?;
        finish(options, &record, most_error, &files, &scene_text)
    })
}

fn scene_file(options: &CalibrateArguments) -> Result<&Path> {
    let no_scene = || Diagnostic::input("", "no scene was given", "name a scene (.toml)");
    options.scene.file.as_deref().ok_or_else(no_scene)
}

/// A fraction, as in 5% or 0.05.
fn fraction(text: &str) -> Result<f64> {
    let (number, factor) = match text.trim().strip_suffix('%') {
        Some(percent) => (percent.trim(), 0.01),
        None => (text.trim(), 1.0),
    };
    let value: Option<f64> = number.parse().ok();
    let value = value.filter(|value| *value > 0.0 && value.is_finite());
    value.map(|value| factor * value).ok_or_else(|| {
        let problem = format!("'{}' is not a positive error", text.escape_debug());
        Diagnostic::input("--max-error", problem, "write 5% or 0.05")
    })
}

/// Hash of everything that the result depends on.
fn identity(text: &str, options: &CalibrateArguments, scene: &Scene, packings: &Packings) -> u64 {
    let mut parts: Vec<String> = vec![
        env!("CARGO_PKG_VERSION").to_owned(),
        text.to_owned(),
        format!("{:?}", options.modulus),
        format!("{:?}", options.packings),
    ];
    for list in [
        &options.scene.all_overrides(),
        &options.free,
        &options.size,
        &options.pack,
    ] {
        parts.push(list.join("\n"));
    }
    let files = scene.input_files().into_iter().chain(packings.files());
    parts.extend(files.map(|file| format!("{:?}", file_hash(&file))));
    let parts: Vec<&[u8]> = parts.iter().map(String::as_bytes).collect();
    fnv1a_of_parts(&parts)
}

fn resumed(file: &Path, identity: u64) -> Result<Record> {
    let record = read_record(file)?;
    if record.identity == identity {
        return Ok(record);
    }
    Err(Diagnostic::input(
        file.display().to_string(),
        "it is the calibration of another scene, or with other options",
        "repeat the same command with --resume, or start again with --force",
    ))
}

fn new_record(
    scene: &Scene,
    packings: &Packings,
    unknowns: Vec<Unknown>,
    prospect: &Prospect,
    pack: &[String],
    identity: u64,
) -> Record {
    let case = |name: String| Case {
        name,
        particles: 0,
        bonds: 0,
        spheres_across: 0.0,
        mean_diameter_m: 0.0,
        start: None,
        rounds: Vec::new(),
        end: None,
        at_twice_the_rate: None,
        rate_problem: None,
    };
    Record {
        version: FORMAT_VERSION,
        program: format!("dem-run {}", env!("CARGO_PKG_VERSION")),
        date: today(),
        identity,
        scene: scene.source.clone(),
        unknowns,
        packings: packings.names(),
        packed_with: pack.join(" "),
        wanted_curve: prospect.wanted_curve.clone(),
        cases: packings.case_names().into_iter().map(case).collect(),
    }
}

/// The work of a calibration.
struct Job<'a> {
    options: &'a CalibrateArguments,
    scene: &'a SceneText<'a>,
    others: &'a BTreeMap<String, Body>,
    packings: &'a Packings,
    /// The first packing of the first size.
    first: &'a Body,
    threads: usize,
    /// The test of the scene.
    test: Option<&'a Test>,
    /// Whether the scene asks for tests at twice the rate.
    checks_rate: bool,
    record_file: &'a Path,
}

impl Job<'_> {
    /// Calibrates each size that has not ended.
    fn do_all(&self, record: &mut Record, stop: &AtomicBool) -> Result<()> {
        for at in 0..record.cases.len() {
            let case = &record.cases[at];
            let lacks_rate = self.checks_rate && case.is_met() && !case.has_rate_check();
            if case.end.is_none() || lacks_rate {
                self.do_case(record, at, stop)?;
            }
        }
        Ok(())
    }

    fn do_case(&self, record: &mut Record, at: usize, stop: &AtomicBool) -> Result<()> {
        let count = record.packings.len();
        let bodies: Vec<Body> = (0..count)
            .map(|packing| match (at, packing) {
                (0, 0) => Ok(self.first.clone()),
                _ => self.packings.make(at, packing, stop),
            })
            .collect::<Result<_>>()?;
        let unknowns = record.unknowns.clone();
        let workers = count.min(self.threads);
        let mut bench = Bench {
            scene: *self.scene,
            unknowns: &unknowns,
            body: &self.packings.body,
            packings: &bodies,
            others: self.others,
            force_step: self.options.scene.force_step,
            pace: Vec::new(),
            threads: self.threads / workers,
            interrupted: stop,
        };
        let mut case = record.cases[at].clone();
        case.particles = bodies[0].positions.len();
        case.bonds = bodies[0].bonds.len();
        case.mean_diameter_m = bodies[0].mean_diameter_m();
        case.spheres_across = spheres_across(&bodies[0]);
        let bar = self.options.progress_bar(&case.name);
        if case.start.is_none() && case.rounds.is_empty() {
            bar.set_message("first numbers, without time steps");
            match bench.start()? {
                Beginning::Unknown => {}
                Beginning::Start(start) => case.start = Some(start),
                Beginning::OutOfReach(problem, remedy) => {
                    case.end = Some((0, End::NotMet(problem, remedy)));
                }
            }
            record.cases[at].clone_from(&case);
            write_record(self.record_file, record)?;
        }
        let travel_m = case.start.as_ref().and_then(|start| start.travel_m);
        if let (Some(travel_m), Some(test)) = (travel_m, self.test) {
            bench.pace = pace_of(test, travel_m, case.mean_diameter_m);
        }
        self.do_tests(record, at, &bench, case, workers, &bar)
    }

    /// The rounds of a case, and its tests at twice the rate, `workers` at a time.
    fn do_tests(
        &self,
        record: &mut Record,
        at: usize,
        bench: &Bench<'_>,
        mut case: Case,
        workers: usize,
        bar: &ProgressBar,
    ) -> Result<()> {
        let count = bench.packings.len();
        let parts = Mutex::new(vec![0.0; count]);
        let tell = |packing: usize, fraction: f64| {
            if let Ok(mut parts) = parts.lock() {
                parts[packing] = fraction;
                let sum: f64 = parts.iter().sum();
                bar.set_position((1000.0 * sum / count as f64) as u64);
            }
        };
        let shared = Mutex::new((
            &mut *record,
            LogOfTests::new(self.options.quiet, &case.name),
        ));
        let save = |case: &Case| {
            let Ok(mut shared) = shared.lock() else {
                return Ok(());
            };
            let (record, log) = &mut *shared;
            let tests = case.cost().1;
            bar.set_message(format!("{tests} tests done"));
            log.tell(tests);
            record.cases[at].clone_from(case);
            write_record(self.record_file, record)
        };
        let names = self.packings.names();
        let test = |factors: &[f64], packing: usize, faster: f64| {
            let tested = bench.test(factors, packing, faster, &|fraction| {
                tell(packing, fraction);
            });
            tested.map_err(|error| error.within(&names[packing]))
        };
        let usual = |factors: &[f64], packing: usize| test(factors, packing, 1.0);
        let mut done = search(bench.unknowns, count, &mut case, workers, &usual, &save);
        if let Err(error) = &done
            && error.kind == Kind::Unstable
        {
            let problem = format!("{}: {}", error.place, error.problem);
            case.end = Some((0, End::NotMet(problem, error.remedy.clone())));
            done = Ok(());
        }
        if done.is_ok() && self.checks_rate && case.is_met() && !case.has_rate_check() {
            let twice = |factors: &[f64], packing: usize| test(factors, packing, 2.0);
            match check_rate(&mut case, workers, &twice, &save) {
                Err(error) if error.kind == Kind::Interrupted => done = Err(error),
                Err(error) => case.rate_problem = Some(error.problem),
                Ok(()) => {}
            }
        }
        bar.finish_and_clear();
        done.and_then(|()| save(&case))
    }
}

/// Writes the page and, for each size that met its targets, the material file; prints the result.
fn finish(
    options: &CalibrateArguments,
    record: &Record,
    most_error: Option<f64>,
    files: &OutputFiles,
    scene: &SceneText<'_>,
) -> Result<()> {
    write_file(&files.page, |out| {
        out.write_all(page(record, most_error).as_bytes())
    })?;
    let mut written = Vec::new();
    for (case, path) in record.cases.iter().zip(&files.materials) {
        let path = match case.is_met() {
            true => path.clone(),
            false => not_met(path),
        };
        if case.result().is_some() {
            let text = material_of(record, case, scene)?;
            write_file(&path, |out| out.write_all(text.as_bytes()))?;
            written.push(path);
        }
    }
    if options.scene.json {
        write_standard_json(&record.without_curves())?;
    } else if !options.quiet {
        let all = written.iter().chain([&files.page, &files.record]);
        let all: Vec<String> = all.map(|path| path.display().to_string()).collect();
        write_standard_output(|out| {
            write!(out, "{}", report(record, most_error))?;
            writeln!(out, "{:12} {}", "written", visible(&all.join(", ")))
        })?;
    }
    let problem = |case: &Case| {
        let (problem, remedy) = case.problem()?;
        Some(match case.name.as_str() {
            "" => (problem, remedy),
            size => (format!("spheres of {size}: {problem}"), remedy),
        })
    };
    match record.cases.iter().find_map(problem) {
        None => Ok(()),
        Some((problem, remedy)) => Err(Diagnostic::failed(&record.scene, problem, remedy)),
    }
}

/// The material file of a case: where its numbers come from, as comments, and the tables, with the
/// diameter for which the bonds are calibrated.
fn material_of(record: &Record, case: &Case, scene: &SceneText<'_>) -> Result<String> {
    let factors = case.result().map_or(&[][..], |round| &round.factors);
    let mut overrides = crate::calibration::overrides(scene, &record.unknowns, factors);
    let numbers = record.unknowns.iter().flat_map(|unknown| &unknown.numbers);
    let bonds: BTreeSet<&str> = numbers
        .filter_map(|number| number.path.strip_prefix("bonds.")?.split('.').next())
        .collect();
    let diameter = show_length(case.mean_diameter_m);
    let across = significant(case.spheres_across, 3);
    for bond in bonds.iter().filter(|_| case.is_met()) {
        overrides.push(format!("bonds.{bond}.calibrated_diameter=\"{diameter}\""));
        overrides.push(format!("bonds.{bond}.calibrated_across={across}"));
    }
    let tables = material_text(scene.text, scene.source, &overrides)?;
    Ok(format!("{}{tables}", dem_calibration::origin(record, case)))
}
