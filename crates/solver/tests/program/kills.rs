//! Commands that are killed at any time leave all or nothing.
#![cfg(unix)]

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::Instant;

use dem_testing::names_in;

use super::interrupted::{start, wait_until};
use super::{Bench, dem_run, refused, root, scene_of_data};

/// Kills of each command.
const KILLS: u32 = 16;

/// Runs a command to its end once, in a folder of its own, and then kills it at times spread over
/// that. `check` sees what is left.
fn kill_often(whole: &Bench, command: &dyn Fn(&Bench) -> Command, check: &mut dyn FnMut(&Bench)) {
    let since = Instant::now();
    let output = command(whole).output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let takes = since.elapsed();
    for kill in 0..KILLS {
        let bench = Bench::new();
        if whole.path("inputs").exists() {
            fs::create_dir(bench.path("inputs")).unwrap();
            for name in names_in(&whole.path("inputs")) {
                let name = format!("inputs/{name}");
                fs::copy(whole.path(&name), bench.path(&name)).unwrap();
            }
        }
        let mut child = start(command(&bench));
        sleep(takes * kill / KILLS);
        child.kill().unwrap();
        child.wait().unwrap();
        check(&bench);
    }
}

/// Names of what stands in a folder but temporary ones.
fn lasting(folder: &Path) -> Vec<String> {
    let mut names = names_in(folder);
    names.retain(|name| !name.starts_with(".unfinished-"));
    names
}

fn within(bench: &Bench, words: &[&str]) -> Command {
    let mut command = dem_run();
    command.current_dir(bench.folder.path()).args(words);
    command
}

/// A folder to start from is whole or not there, and the next command of its kind removes what the
/// killed one has left beside it.
#[test]
fn a_killed_new_leaves_all_or_nothing() {
    let whole = Bench::new();
    let new = |bench: &Bench| within(bench, &["new", "silo", "made"]);
    kill_often(&whole, &new, &mut |bench| {
        let made = bench.path("made");
        if made.exists() {
            assert_eq!(names_in(&made), names_in(&whole.path("made")));
        } else {
            assert_eq!(lasting(&bench.path("")), Vec::<String>::new());
        }
    });
    let bench = Bench::new();
    let abandoned = bench.path(".unfinished-1-0");
    fs::create_dir(&abandoned).unwrap();
    fs::write(abandoned.join("scene.toml"), "half").unwrap();
    assert!(new(&bench).output().unwrap().status.success());
    assert_eq!(names_in(&bench.path("")), ["made"]);
    assert_eq!(names_in(&bench.path("made")).len(), 4);
}

/// Dumps of many frames become results with all of them, or none.
#[test]
fn a_killed_import_leaves_all_or_nothing() {
    const FRAMES: usize = 40;
    let whole = Bench::new();
    whole.write("scene.toml", super::lammps::SCENE);
    let export = ["export", "lammps", "scene.toml", "-o", "inputs", "-q"];
    assert!(within(&whole, &export).output().unwrap().status.success());
    let mut frames = "ITEM: UNITS\nsi\n".to_owned();
    let (mut bonds, mut broken) = (String::new(), String::new());
    for n in 0..FRAMES {
        let bounds = "ITEM: BOX BOUNDS mm mm mm\n-1 1\n-1 1\n-1 1\n";
        let head = format!("ITEM: TIME\n{}\nITEM: TIMESTEP\n{n}\n", 1e-6 * n as f64);
        write!(
            frames,
            "{head}ITEM: NUMBER OF ATOMS\n2\n{bounds}ITEM: ATOMS id mol radius x y z vx vy vz omegax omegay omegaz \n1 1 0.004 0 0 0.02 1 2 3 4 5 6 \n2 1 0.005 0.0091 0 0.02 1 2 3 4 5 6 \n"
        )
        .unwrap();
        write!(
            bonds,
            "{head}ITEM: NUMBER OF ENTRIES\n1\n{bounds}ITEM: ENTRIES index c_bonds[1] c_bonds[2] c_bonds[3] \n1 2 1 1 \n"
        )
        .unwrap();
        write!(
            broken,
            "{head}ITEM: NUMBER OF ENTRIES\n0\n{bounds}ITEM: ENTRIES f_broken[1] f_broken[2] f_broken[3] f_broken[4] f_broken[5] f_broken[6] \n"
        )
        .unwrap();
    }
    whole.write("inputs/frames.dump", frames);
    whole.write("inputs/bonds.dump", bonds);
    whole.write("inputs/broken.dump", broken);
    let import = |bench: &Bench| within(bench, &["import", "inputs", "-o", "back", "-q"]);
    kill_often(&whole, &import, &mut |bench| {
        if bench.path("back").exists() {
            assert_eq!(names_in(&bench.path("back/frames")).len(), FRAMES);
            assert!(bench.path("back/summary.json").exists());
        } else {
            assert_eq!(lasting(&bench.path("")), ["inputs"]);
        }
    });
    // Over earlier results, a half is not taken for whole: it has no summary.
    let again = |bench: &Bench| within(bench, &["import", "inputs", "-o", "back", "-q", "--force"]);
    let takes = Instant::now();
    assert!(again(&whole).output().unwrap().status.success());
    let takes = takes.elapsed();
    for kill in 0..KILLS {
        let mut child = start(again(&whole));
        sleep(takes * kill / KILLS);
        child.kill().unwrap();
        child.wait().unwrap();
        let frames = names_in(&whole.path("back/frames")).len();
        assert!(frames == FRAMES || !whole.path("back/summary.json").exists());
    }
    assert!(again(&whole).output().unwrap().status.success());
    assert_eq!(names_in(&whole.path("back/frames")).len(), FRAMES);
}

/// What a killed list of a study has left is gone on with, or is begun again, and gives the list.
#[test]
fn a_killed_list_of_a_study_can_be_said_again() {
    let whole = Bench::new();
    fs::create_dir(whole.path("inputs")).unwrap();
    let scene = fs::read_to_string(scene_of_data("tension.toml")).unwrap();
    let body = root().join("data/bodies/bar.vtp").display().to_string();
    whole.write("inputs/scene.toml", scene.replace("bar.vtp", &body));
    whole.write(
        "inputs/study.toml",
        "version = 1\nscene = \"scene.toml\"\nrepeats = 50\n[vary]\n\"run.safety_factor\" = [0.1, 0.2, 0.3, 0.4]\n[measures.stiffness]\ntest_result = \"stiffness\"\n",
    );
    let list = |bench: &Bench| {
        within(
            bench,
            &["sweep", "inputs/study.toml", "--list", "-o", "out"],
        )
    };
    let lines = |bench: &Bench, more: &[&str]| {
        let output = list(bench).args(more).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let place = bench.path("").display().to_string();
        (text.replace(&place, ""), output)
    };
    let (wanted, output) = lines(&whole, &[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(wanted.lines().count() >= 200, "{said}");
    let files = names_in(&whole.path("out"));
    fs::remove_dir_all(whole.path("out")).unwrap();
    kill_often(&whole, &list, &mut |bench| {
        let (first, output) = lines(bench, &[]);
        let found = if output.status.success() {
            first
        } else {
            let (said, code) = refused(&output);
            assert!(
                code == 2 && said.contains("go on with it by --resume"),
                "{said}"
            );
            lines(bench, &["--resume"]).0
        };
        assert_eq!(found, wanted);
        assert_eq!(names_in(&bench.path("out")), files);
    });
}

/// Two calibrations with one output: one of them writes all files, the other refuses. What a killed
/// one has left keeps no other from it.
#[test]
fn one_calibration_at_a_time_writes_a_file() {
    let bench = Bench::new();
    let shape = root().join("data/shapes/bar.stl").display().to_string();
    let calibrate = |more: &[&str]| {
        let mut command = dem_run();
        command
            .arg("calibrate")
            .arg(scene_of_data("tension.toml"))
            .arg("--output")
            .arg(bench.path("cake.toml"))
            .args(["--packings", "1000"])
            .args(more)
            .args(["--", &shape, "--diameter", "3mm"]);
        command
    };
    let mut first = start(calibrate(&[]));
    let record = bench.path("cake.json");
    wait_until(&mut first, || record.exists());
    let before = fs::read(&record).unwrap();
    for more in [&[][..], &["--force"], &["--resume"]] {
        let (said, code) = refused(&calibrate(more).output().unwrap());
        assert_eq!(code, 2, "{said}");
        let is_other = said.contains("another calibration is writing it");
        assert!(
            is_other || more.is_empty() && said.contains("--resume"),
            "{said}"
        );
    }
    assert!(first.try_wait().unwrap().is_none());
    assert!(fs::read(&record).unwrap().starts_with(&before[..20]));
    first.kill().unwrap();
    first.wait().unwrap();
    // The system has released its lock.
    let mut next = start(calibrate(&["--resume"]));
    sleep(std::time::Duration::from_millis(500));
    assert!(next.try_wait().unwrap().is_none());
    next.kill().unwrap();
    next.wait().unwrap();
}
