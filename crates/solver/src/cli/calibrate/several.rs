//! `dem-run calibrate` with several scenes: one material by several tests at once.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use dem_calibration::{
    Aim, End, Free, JOINT_VERSION, Joint, JointTest, Trial, calibrate_joint, check_joint_rate,
    joint_origin, joint_page, joint_report, read_joint, write_joint,
};
use dem_io::diagnostic::Kind;
use dem_io::hash::{file_hash, fnv1a_of_parts};
use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::units::{show_length, significant};
use dem_io::{Body, Diagnostic, Result};
use dem_pack::cli::Recipe;
use dem_scene::{material_text_of_all, scene_from_text, text_of};
use dem_terminal::program::today;
use dem_terminal::standard_output::{write_standard_json, write_standard_output};

use super::arguments::{CalibrateArguments, PACKINGS};
use super::output_files::{OutputFiles, not_met};
use crate::calibration::{
    JointBeginning, JointBench, Prospect, TestBodies, TestScene, aims, free_numbers, pace_of,
    prospect, shared_bonds,
};
use crate::cli::packings::{Packings, spheres_across};
use crate::cli::pool::in_pool;
use crate::cli::progress::LogOfTests;
use crate::interrupt::Interrupt;

/// Largest relative difference of the mean diameters of tests for which the bonds have one.
const ONE_SIZE: f64 = 0.05;

/// Calibrates by all scenes, writes material, page and record, and prints a summary. Targets that
/// are not met are an error, once page and record are written.
pub(super) fn calibrate_several(options: &CalibrateArguments, interrupt: &Interrupt) -> Result<()> {
    refuse_options(options)?;
    let overrides = options.scene.all_overrides();
    let tests = scenes(options, &overrides)?;
    let bonds = shared_bonds(&tests, &overrides)?;
    let packings = packings_of_all(options, &tests)?;
    let files = OutputFiles::of(&options.output, 1)?;
    let mut inputs: Vec<PathBuf> = Vec::new();
    for (test, packings) in tests.iter().zip(&packings) {
        inputs.extend(test.scene.input_files());
        inputs.extend(packings.files());
    }
    let existing = [options.resume, options.force];
    files.refuse(&inputs, existing)?;
    let _lock = files.lock()?;
    // Another one may have ended since.
    files.refuse(&inputs, existing)?;
    let unknowns = free_numbers(&tests, &overrides, bonds, &options.free)?;
    in_pool(options.scene.threads, |threads| {
        let looked = look(&tests, &packings, threads)?;
        let aims = looked.aims(options, &tests, &overrides, &unknowns)?;
        let identity = identity(options, &tests, &inputs);
        let mut joint = match options.resume {
            true => resumed(&files, identity)?,
            false => {
                files.remove()?;
                Joint {
                    version: JOINT_VERSION,
                    program: format!("dem-run {}", env!("CARGO_PKG_VERSION")),
                    date: today(),
                    identity,
                    tests: joint_tests(options, &tests, &packings, &looked.prospects),
                    unknowns,
                    aims,
                    start: None,
                    rounds: Vec::new(),
                    end: None,
                    at_twice_the_rate: None,
                    rate_problem: None,
                }
            }
        };
        write_joint(&files.record, &joint)?;
        let mut job = Job {
            options,
            overrides: &overrides,
            tests: &tests,
            packings: &packings,
            bodies: looked.bodies,
            stiffnesses: &looked.stiffnesses,
            threads,
            files: &files,
        };
        let worked = interrupt.run_interruptible(|stop| job.do_all(&mut joint, stop));
        worked.map_err(|mut error| {
            if error.kind == Kind::Interrupted {
                error.remedy = "go on with --resume".to_owned();
            }
            error
        })?;
        finish(options, &joint, &files, &tests, &overrides)
    })
}

/// The first packing of each test, and what is known before the tests.
struct Looked {
    bodies: Vec<TestBodies>,
    prospects: Vec<Prospect>,
    /// Stiffness of the measured curve of each test, N/m.
    stiffnesses: Vec<Option<f64>>,
}

fn look(tests: &[TestScene], packings: &[Packings], threads: usize) -> Result<Looked> {
    let mut looked = Looked {
        bodies: Vec::new(),
        prospects: Vec::new(),
        stiffnesses: Vec::new(),
    };
    for (test, packings) in tests.iter().zip(packings) {
        let others = packings.other_bodies(&test.scene)?;
        let first = packings.make(0, 0, &AtomicBool::new(false))?;
        let found = prospect(&test.scene, &packings.body, &first, &others, threads)?;
        looked.stiffnesses.push(found.stiffness_n_m);
        looked.prospects.push(found);
        looked.bodies.push(TestBodies {
            body: packings.body.clone(),
            packings: vec![first],
            others,
        });
    }
    Ok(looked)
}

impl Looked {
    /// What the tests are to give; refuses strokes that are too short for it.
    fn aims(
        &self,
        options: &CalibrateArguments,
        tests: &[TestScene],
        overrides: &[String],
        unknowns: &[Free],
    ) -> Result<Vec<Aim>> {
        let by = options.modulus;
        let aims = aims(
            tests,
            overrides,
            by,
            &self.stiffnesses,
            unknowns,
            &options.target,
        )?;
        for (at, (test, prospect)) in tests.iter().zip(&self.prospects).enumerate() {
            let own = aims.iter().filter(|aim| aim.test == at);
            let own = own.map(|aim| (aim.result.as_str(), aim.target));
            prospect.check_targets(&test.scene, &own.collect::<Vec<_>>())?;
        }
        Ok(aims)
    }
}

/// Refuses what only a calibration by one scene has.
fn refuse_options(options: &CalibrateArguments) -> Result<()> {
    let refused = [
        (
            "--body",
            !options.scene.body.is_empty(),
            "name the body's file in its scene, or its shape by --shape",
        ),
        (
            "--size",
            !options.size.is_empty(),
            "compare sizes with one scene, or write --diameter after --",
        ),
    ];
    match refused.iter().find(|(_, is_there, _)| *is_there) {
        Some((option, _, remedy)) => {
            let problem = "it does not apply to several scenes";
            Err(Diagnostic::input(*option, problem, *remedy))
        }
        None => Ok(()),
    }
}

/// Reads the scenes; refuses one that is named twice, and one without a test.
fn scenes(options: &CalibrateArguments, overrides: &[String]) -> Result<Vec<TestScene>> {
    let files: Vec<&PathBuf> = options.scene.file.iter().chain(&options.more).collect();
    let mut tests: Vec<TestScene> = Vec::new();
    for (at, file) in files.iter().enumerate() {
        let source = file.display().to_string();
        let own = file.canonicalize().ok();
        let is_same = |other: &&&PathBuf| own.is_some() && other.canonicalize().ok() == own;
        if files[..at].iter().any(|other| is_same(&other)) {
            let problem = "this scene is named twice";
            let remedy = "name each test once: twice the same would count twice";
            return Err(Diagnostic::input(source, problem, remedy));
        }
        let text = text_of(file, "a scene")?;
        let scene = scene_from_text(&text, &source, overrides)?;
        for note in &scene.notes {
            let _ = writeln!(std::io::stderr(), "note: {source}: {}", visible(note));
        }
        let test = TestScene { scene, text };
        test.test()?;
        tests.push(test);
    }
    Ok(tests)
}

/// The packings of each test: of the shape of `--shape` or that after `--`, or the body of the
/// scene.
fn packings_of_all(options: &CalibrateArguments, tests: &[TestScene]) -> Result<Vec<Packings>> {
    let mut shapes: Vec<Option<PathBuf>> = vec![None; tests.len()];
    for text in &options.shape {
        let place = format!("--shape {text}");
        let (name, file) = text.split_once('=').unwrap_or((text, ""));
        let Some(at) = tests.iter().position(|test| test.is_named(name)) else {
            let known: Vec<&str> = tests
                .iter()
                .map(|test| test.scene.source.as_str())
                .collect();
            let remedy = format!("write SCENE=FILE.stl with one of {}", known.join(", "));
            return Err(Diagnostic::input(
                place,
                format!("no scene is called '{name}'"),
                remedy,
            ));
        };
        if file.is_empty() || shapes[at].is_some() {
            let problem = match file.is_empty() {
                true => "no file is named",
                false => "this scene has a shape already",
            };
            let remedy = "write one --shape SCENE=FILE.stl for each scene";
            return Err(Diagnostic::input(place, problem, remedy));
        }
        shapes[at] = Some(PathBuf::from(file));
    }
    let of = |(test, shape): (&TestScene, Option<PathBuf>)| {
        let mut recipes = Vec::new();
        if !options.pack.is_empty() {
            if shape.is_none() && !Recipe::names_shape(&options.pack)? {
                let problem = "the shape of its body is missing";
                let name = &test.scene.source;
                let remedy = format!("add --shape {name}=FILE.stl, or one for all scenes after --");
                return Err(Diagnostic::input(name, problem, remedy));
            }
            recipes.push(Recipe::of_shape(shape.as_deref(), &options.pack)?);
        }
        let mut packings = Packings::of(recipes, &[], &test.scene)?;
        packings.count = options.packings.unwrap_or(PACKINGS);
        Ok(packings)
    };
    if let Some(wanted @ (0 | 1001..)) = options.packings {
        let problem = format!("{wanted} is not between 1 and 1000");
        return Err(Diagnostic::input("--packings", problem, "4 is usual"));
    }
    tests.iter().zip(shapes).map(of).collect()
}

/// Hash of everything that the result depends on.
fn identity(options: &CalibrateArguments, tests: &[TestScene], files: &[PathBuf]) -> u64 {
    let mut parts: Vec<String> = vec![
        env!("CARGO_PKG_VERSION").to_owned(),
        format!("{:?}", options.modulus),
        format!("{:?}", options.packings),
    ];
    parts.extend(tests.iter().map(|test| test.text.clone()));
    for list in [
        &options.scene.all_overrides(),
        &options.free,
        &options.target,
        &options.shape,
        &options.pack,
    ] {
        parts.push(list.join("\n"));
    }
    parts.extend(files.iter().map(|file| format!("{:?}", file_hash(file))));
    let parts: Vec<&[u8]> = parts.iter().map(String::as_bytes).collect();
    fnv1a_of_parts(&parts)
}

fn resumed(files: &OutputFiles, identity: u64) -> Result<Joint> {
    let joint = read_joint(&files.record)?;
    if joint.identity == identity {
        return Ok(joint);
    }
    Err(Diagnostic::input(
        files.record.display().to_string(),
        "it is the calibration of other scenes, or with other options",
        "repeat the same command with --resume, or start again with --force",
    ))
}

fn joint_tests(
    options: &CalibrateArguments,
    tests: &[TestScene],
    packings: &[Packings],
    prospects: &[Prospect],
) -> Vec<JointTest> {
    let of = |((test, packings), prospect): ((&TestScene, &Packings), &Prospect)| {
        let own = test.scene.test.as_ref()?;
        let confining = own.confinement.as_ref().map(|one| one.pressure_pa);
        let normal = own.normal_stress.as_ref().map(|one| one.stress_pa);
        let shape = options.shape.iter().find_map(|text| {
            let (name, file) = text.split_once('=')?;
            test.is_named(name).then(|| format!("{file} "))
        });
        let packed = format!("{}{}", shape.unwrap_or_default(), options.pack.join(" "));
        Some(JointTest {
            scene: test.scene.source.clone(),
            kind: own.kind,
            pressure_pa: confining.or(normal),
            packings: packings.names(),
            packed_with: packed.trim_end().to_owned(),
            particles: 0,
            bonds: 0,
            spheres_across: 0.0,
            mean_diameter_m: 0.0,
            travel_m: None,
            wanted_curve: prospect.wanted_curve.clone(),
        })
    };
    let all = tests.iter().zip(packings).zip(prospects);
    all.filter_map(of).collect()
}

/// The work of a calibration by several tests.
struct Job<'a> {
    options: &'a CalibrateArguments,
    overrides: &'a [String],
    tests: &'a [TestScene],
    packings: &'a [Packings],
    /// Of each test, with its first packing.
    bodies: Vec<TestBodies>,
    stiffnesses: &'a [Option<f64>],
    threads: usize,
    files: &'a OutputFiles,
}

impl Job<'_> {
    fn do_all(&mut self, joint: &mut Joint, stop: &AtomicBool) -> Result<()> {
        for (at, bodies) in self.bodies.iter_mut().enumerate() {
            for packing in 1..joint.tests[at].packings.len() {
                bodies
                    .packings
                    .push(self.packings[at].make(0, packing, stop)?);
            }
            describe(&mut joint.tests[at], &bodies.packings[0]);
        }
        let workers = joint.jobs().min(self.threads);
        let (unknowns, aims) = (joint.unknowns.clone(), joint.aims.clone());
        let mut bench = JointBench {
            tests: self.tests,
            overrides: self.overrides,
            unknowns: &unknowns,
            aims: &aims,
            bodies: &self.bodies,
            paces: vec![Vec::new(); self.tests.len()],
            stiffnesses: self.stiffnesses,
            by: self.options.modulus,
            force_step: self.options.scene.force_step,
            threads: self.threads / workers,
            interrupted: stop,
        };
        if joint.start.is_none() && joint.end.is_none() {
            match bench.start()? {
                JointBeginning::Start(start, slopes, travels) => {
                    take_start(joint, &slopes, &travels);
                    joint.start = Some(start);
                }
                JointBeginning::OutOfReach(problem, remedy) => {
                    joint.end = Some((0, End::NotMet(problem, remedy)));
                }
            }
            write_joint(&self.files.record, joint)?;
        }
        for (at, test) in joint.tests.iter().enumerate() {
            if let Some(travel_m) = test.travel_m {
                bench.paces[at] = pace_of(self.tests[at].test()?, travel_m, test.mean_diameter_m);
            }
        }
        self.do_tests(joint, &bench, workers)
    }

    /// The rounds, and the tests at twice the rate, `workers` at a time.
    fn do_tests(&self, joint: &mut Joint, bench: &JointBench<'_>, workers: usize) -> Result<()> {
        let bar = self.options.progress_bar("");
        let parts = Mutex::new(vec![0.0; joint.jobs()]);
        let tell = |at: usize, fraction: f64| {
            if let Ok(mut parts) = parts.lock() {
                parts[at] = fraction;
                let mean: f64 = parts.iter().sum::<f64>() / parts.len() as f64;
                bar.set_position((1000.0 * mean) as u64);
            }
        };
        let log = Mutex::new(LogOfTests::new(self.options.quiet, ""));
        let save = |joint: &Joint| {
            let tests = joint.cost().1;
            bar.set_message(format!("{tests} tests done"));
            if let Ok(mut log) = log.lock() {
                log.tell(tests);
            }
            write_joint(&self.files.record, joint)
        };
        let names = joint.clone();
        let test = |factors: &[f64], at: usize, faster: f64| -> Result<Trial> {
            let (one, packing) = names.job(at);
            let tested = bench.test(factors, (one, packing), faster, &|part| tell(at, part));
            tested.map_err(|error| {
                let own = &names.tests[one];
                error.within(&format!("{}: {}", own.scene, own.packings[packing]))
            })
        };
        let usual = |factors: &[f64], at: usize| test(factors, at, 1.0);
        let mut done = calibrate_joint(joint, workers, &usual, &save);
        if let Err(error) = &done
            && error.kind == Kind::Unstable
        {
            let problem = format!("{}: {}", error.place, error.problem);
            joint.end = Some((0, End::NotMet(problem, error.remedy.clone())));
            done = Ok(());
        }
        let asks = |test: &TestScene| test.scene.test.as_ref().is_some_and(|one| one.rate_check);
        let asked: Vec<bool> = self.tests.iter().map(asks).collect();
        if done.is_ok() && joint.is_met() && asked.contains(&true) && joint.rate_problem.is_none() {
            let twice = |factors: &[f64], at: usize| test(factors, at, 2.0);
            match check_joint_rate(joint, &asked, workers, &twice, &save) {
                Err(error) if error.kind == Kind::Interrupted => done = Err(error),
                Err(error) => joint.rate_problem = Some(error.problem),
                Ok(()) => {}
            }
        }
        bar.finish_and_clear();
        done.and_then(|()| save(joint))
    }
}

/// What the first packing of a test is.
fn describe(test: &mut JointTest, body: &Body) {
    test.particles = body.positions.len();
    test.bonds = body.bonds.len();
    test.mean_diameter_m = body.mean_diameter_m();
    test.spheres_across = spheres_across(body);
}

/// Takes the slopes of the modulus, by test, and the travel at failure of each test, m.
fn take_start(joint: &mut Joint, slopes: &[(usize, f64)], travels: &[Option<f64>]) {
    for (test, travel_m) in joint.tests.iter_mut().zip(travels) {
        test.travel_m = *travel_m;
    }
    for (test, slope) in slopes {
        for aim in joint.aims.iter_mut().filter(|aim| aim.test == *test) {
            for own in aim.slopes.iter_mut().filter(|own| **own == Some(1.0)) {
                if aim.result != dem_rig::evaluate::STRENGTH {
                    *own = Some(*slope);
                }
            }
        }
    }
}

/// Writes the page and the material file; prints the result.
fn finish(
    options: &CalibrateArguments,
    joint: &Joint,
    files: &OutputFiles,
    tests: &[TestScene],
    overrides: &[String],
) -> Result<()> {
    write_file(&files.page, |out| {
        out.write_all(joint_page(joint).as_bytes())
    })?;
    let mut written = Vec::new();
    if joint.result().is_some() {
        let path = match joint.is_met() {
            true => files.materials[0].clone(),
            false => not_met(&files.materials[0]),
        };
        let text = material_of(joint, tests, overrides)?;
        write_file(&path, |out| out.write_all(text.as_bytes()))?;
        written.push(path);
    }
    if options.scene.json {
        write_standard_json(&joint.without_curves())?;
    } else if !options.quiet {
        let all = written.iter().chain([&files.page, &files.record]);
        let all: Vec<String> = all.map(|path| path.display().to_string()).collect();
        write_standard_output(|out| {
            write!(out, "{}", joint_report(joint))?;
            writeln!(out, "{:12} {}", "written", visible(&all.join(", ")))
        })?;
    }
    match joint.problem() {
        None => Ok(()),
        Some((problem, remedy)) => Err(Diagnostic::failed("", problem, remedy)),
    }
}

/// The material file: where its numbers come from, as comments, and the tables of all scenes, with
/// the diameter for which the bonds are calibrated if all tests have the same.
fn material_of(joint: &Joint, tests: &[TestScene], overrides: &[String]) -> Result<String> {
    let factors = joint.result().map_or(&[][..], |round| &round.factors);
    let mut of_bonds = Vec::new();
    let first_m = joint.tests[0].mean_diameter_m;
    let is_one_size = |test: &JointTest| (test.mean_diameter_m / first_m - 1.0).abs() < ONE_SIZE;
    if joint.is_met() && joint.tests.iter().all(is_one_size) {
        let bonds = shared_bonds(tests, overrides)?;
        let across = joint.tests.iter().map(|test| test.spheres_across);
        let across = significant(across.fold(f64::INFINITY, f64::min), 3);
        let diameter = show_length(first_m);
        of_bonds.push(format!("bonds.{bonds}.calibrated_diameter=\"{diameter}\""));
        of_bonds.push(format!("bonds.{bonds}.calibrated_across={across}"));
    }
    let mut all = Vec::new();
    for test in tests {
        let mut own = test.overrides(overrides, &joint.unknowns, factors)?;
        own.extend(of_bonds.iter().cloned());
        all.push(own);
    }
    let scenes = tests.iter().zip(&all);
    let scenes: Vec<(&str, &str, &[String])> = scenes
        .map(|(test, own)| {
            (
                test.text.as_str(),
                test.scene.source.as_str(),
                own.as_slice(),
            )
        })
        .collect();
    let tables = material_text_of_all(&scenes)?;
    Ok(format!("{}{tables}", joint_origin(joint)))
}
