//! A run that was interrupted and continued leaves the same bits as one that was not.
#![cfg(unix)]

use std::fs;
use std::path::Path;

use super::interrupted::{interrupt, kill_after_checkpoint};
use super::{Bench, assert_same, good, numbers, refused, table};

/// Scenes that cover all features, with the signals and threads for each.
const SCENES: [(&str, &str, &str); 11] = [
    ("breaking.toml", "-INT", "2"),
    ("incremental.toml", "-TERM", "1"),
    ("bodies.toml", "-INT", "3"),
    ("strained.toml", "-TERM", "2"),
    ("rest.toml", "-INT", "2"),
    ("meeting.toml", "-INT", "2"),
    ("following.toml", "-TERM", "2"),
    ("softening.toml", "-INT", "2"),
    ("crushing.toml", "-TERM", "2"),
    ("yielding.toml", "-TERM", "2"),
    ("joints.toml", "-INT", "2"),
];

/// Makes a scene take longer, so that a signal arrives half-way.
fn slow(name: &str) -> &'static str {
    match name {
        "breaking.toml" | "softening.toml" | "yielding.toml" | "joints.toml" => {
            "run.safety_factor=0.02"
        }
        "incremental.toml" => "run.safety_factor=0.03",
        "bodies.toml" => "run.safety_factor=0.02",
        "rest.toml" => "run.safety_factor=0.01",
        "meeting.toml" => "run.safety_factor=0.05",
        "following.toml" | "crushing.toml" => "run.safety_factor=0.1",
        _ => "run.seed=0",
    }
}

#[test]
fn after_a_signal_a_run_goes_on_as_if_nothing_had_been() {
    for (name, signal, threads) in SCENES {
        let bench = Bench::new();
        let options = ["--set", slow(name), "--threads", "1"];
        bench.good(
            &good(name),
            &[&options[..], &["--output", "whole"]].concat(),
        );
        let mut times = 0;
        // Repeatedly: each time it is interrupted a little later.
        let (mut rows, mut resume) = (10, false);
        loop {
            let first: &[&str] = if resume { &["--resume"] } else { &[] };
            let all = [
                "--set",
                slow(name),
                "--threads",
                threads,
                "--output",
                "part",
            ];
            let command = bench.command(&good(name), &[&all[..], first].concat());
            let Some(said) = interrupt(command, signal, &bench.path("part"), rows) else {
                break;
            };
            assert!(said.starts_with("error: interrupted at "), "{said}");
            assert!(
                said.ends_with("go on with the same command and --resume: 'part/checkpoint.dem' holds its state"),
                "{said}"
            );
            let left = fs::read(bench.path("part/summary.json")).unwrap();
            let left: serde_json::Value = serde_json::from_slice(&left).unwrap();
            assert_eq!(left["ended_by"], "interruption");
            times += 1;
            resume = true;
            rows = numbers(&bench.path("part/series.csv"), "time_s").len() + 100;
        }
        assert!(times > 0, "{name} was too fast to be interrupted");
        assert_same(&bench.path("whole"), &bench.path("part"));
    }
}

#[test]
fn after_a_kill_a_run_goes_on_from_its_last_checkpoint() {
    for name in ["breaking.toml", "bodies.toml", "strained.toml"] {
        let bench = Bench::new();
        let options = ["--set", slow(name), "--threads", "1"];
        bench.good(
            &good(name),
            &[&options[..], &["--output", "whole"]].concat(),
        );
        let all = [&options[..], &["--output", "part"]].concat();
        kill_after_checkpoint(bench.command(&good(name), &all), &bench.path("part"));
        bench.good(&good(name), &[&all[..], &["--resume"]].concat());
        assert_same(&bench.path("whole"), &bench.path("part"));
    }
}

#[test]
fn the_limit_of_the_step_is_looked_at_again_on_the_way() {
    let bench = Bench::new();
    let squeezed = "version = 1
run = { end_time = \"300 ms\", safety_factor = 0.5 }
materials.soft = { density = 2000, young_modulus = 1e7, poisson_ratio = 0.3 }
contacts.soft-soft = { restitution = 0.5, friction = 0.3 }
bodies.ball = { particles = [[0, 0, 1e-3, 1e-3]], material = \"soft\" }
output.series = \"30 ms\"
[walls.floor]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
material = \"soft\"
[walls.plate]
plane = { point = [0, 0, 2e-3], normal = [0, 0, -1] }
material = \"soft\"
velocity = [0, 0, -2e-3]
";
    let scene = bench.write("squeezed.toml", squeezed);
    bench.good(Path::new(&scene), &["--output", "out"]);
    let (_, events) = table(&bench.path("out/events.csv"));
    assert!(!events.is_empty());
    assert!(
        events
            .iter()
            .all(|row| row[2] == "time_step" && row[9] == "limit")
    );
}

/// A scene that has been run to a fifth of its end time.
fn begun(name: &str, options: &[&str]) -> Bench {
    let bench = Bench::new();
    bench.good(&good(name), &[&["--output", "out"], options].concat());
    bench
}

#[test]
fn a_run_that_is_over_says_so_and_can_be_taken_further() {
    let bench = begun("bodies.toml", &["--set", "run.end_time=1 ms"]);
    let resume = ["--output", "out", "--resume", "--set"];
    let before = super::results(&bench.path("out"));
    let said = bench.bad(
        &good("bodies.toml"),
        &[&resume[..], &["run.end_time=1 ms"]].concat(),
        2,
    );
    assert!(
        said.contains("this run has reached 1.0") && said.contains("set a later end"),
        "{said}"
    );
    assert!(before == super::results(&bench.path("out")));
    bench.good(
        &good("bodies.toml"),
        &[&resume[..], &["run.end_time=2 ms"]].concat(),
    );
    let times = numbers(&bench.path("out/series.csv"), "time_s");
    assert!(times.is_sorted_by(|a, b| a < b));
    assert!((times[times.len() - 1] / 2e-3 - 1.0).abs() < 1e-3);
    // The second half also has rows, twice as far apart.
    let late = times.iter().filter(|t| **t > 1.01e-3).count();
    assert!((400..600).contains(&late), "{late}");

    let bench = begun("rest.toml", &[]);
    let said = bench.bad(&good("rest.toml"), &["--output", "out", "--resume"], 2);
    assert!(
        said.contains("come to rest at") && said.contains("set a smaller run.rest_energy_ratio"),
        "{said}"
    );
    let said = bench.good(
        &good("rest.toml"),
        &[
            "--output",
            "out",
            "--resume",
            "--set",
            "run.rest_energy_ratio=1e-12",
        ],
    );
    assert!(said.contains("ended by     rest"), "{said}");
}

/// A flipped bit in a table or a frame would stay in the results of the whole run.
#[test]
fn changed_tables_and_frames_are_not_continued() {
    let bench = begun("bodies.toml", &["--set", "run.end_time=1 ms"]);
    let resume = ["--output", "out", "--resume", "--set", "run.end_time=2 ms"];
    let frame = fs::read_dir(bench.path("out/frames")).unwrap();
    let frames = frame.map(|entry| entry.unwrap().path());
    let frame = frames.filter(|path| path.extension().is_some_and(|e| e == "vtp"));
    let files = [bench.path("out/series.csv"), bench.path("out/events.csv")];
    for file in files.into_iter().chain(frame.min()) {
        let whole = fs::read(&file).unwrap();
        let mut changed = whole.clone();
        let at = whole.len() - 20;
        changed[at] ^= 1;
        fs::write(&file, &changed).unwrap();
        let said = bench.bad(&good("bodies.toml"), &resume, 2);
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(
            said.contains(name) && said.contains("check sum differs"),
            "{said}"
        );
        fs::write(&file, &whole).unwrap();
    }
    bench.good(&good("bodies.toml"), &resume);
}

#[test]
fn a_step_that_is_given_is_taken_when_a_run_goes_on() {
    let bench = begun("bodies.toml", &["--set", "run.end_time=0.5 ms"]);
    let options = ["--output", "out", "--resume", "--set", "run.time_step=1 us"];
    let said = bench.good(&good("bodies.toml"), &options);
    assert!(
        said.contains("resumed      time step 1.9531e-6 s -> 1.0000e-6 s")
            || said.contains("-> 1.0000e-6 s"),
        "{said}"
    );
    let steps = numbers(&bench.path("out/series.csv"), "time_step_s");
    assert!(steps[0] > 1.5e-6);
    assert_eq!(steps[steps.len() - 1], 1e-6);
    let (_, events) = table(&bench.path("out/events.csv"));
    let noted: Vec<_> = events.iter().filter(|row| row[2] == "time_step").collect();
    assert_eq!(noted.len(), 1);
    assert_eq!(noted[0][9], "resumed");
    let summary = fs::read_to_string(bench.path("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["time_step_s"], 1e-6);
    assert!(summary["energy_error"].as_f64().unwrap() < 1e-3);
}

/// The message for a folder whose checkpoint contains these bytes.
fn said_of(bench: &Bench, checkpoint: &[u8]) -> String {
    fs::write(bench.path("out/checkpoint.dem"), checkpoint).unwrap();
    let said = bench.bad(
        &good("bodies.toml"),
        &["--output", "out", "--resume", "--set", "run.end_time=3 ms"],
        2,
    );
    assert!(said.contains("out/checkpoint.dem"), "{said}");
    assert!(
        said.contains("without --resume") || said.contains("name a file"),
        "{said}"
    );
    said
}

#[test]
fn checkpoints_that_cannot_be_used() {
    let bench = begun("bodies.toml", &[]);
    let whole = fs::read(bench.path("out/checkpoint.dem")).unwrap();
    let before = super::results(&bench.path("out"));
    assert!(said_of(&bench, b"").contains("this is not a checkpoint"));
    assert!(said_of(&bench, b"a picture of a cat").contains("this is not a checkpoint"));
    for length in [20, 60, whole.len() / 2, whole.len() - 1] {
        assert!(said_of(&bench, &whole[..length]).contains("cut off or damaged"));
    }
    for at in [30, whole.len() / 2, whole.len() - 3] {
        let mut damaged = whole.clone();
        damaged[at] ^= 4;
        assert!(said_of(&bench, &damaged).contains("damaged"));
    }
    let mut newer = whole.clone();
    newer[16] = 99;
    assert!(said_of(&bench, &newer).contains("in format 99"));

    for other in ["breaking.toml", "incremental.toml", "alone.toml"] {
        let of_other = begun(other, &[]);
        let foreign = fs::read(of_other.path("out/checkpoint.dem")).unwrap();
        let said = said_of(&bench, &foreign);
        assert!(
            said.contains("the scene is not that of the run: "),
            "{said}"
        );
    }
    // No other file was changed.
    fs::write(bench.path("out/checkpoint.dem"), &whole).unwrap();
    assert!(before == super::results(&bench.path("out")));

    fs::remove_file(bench.path("out/checkpoint.dem")).unwrap();
    let said = bench.bad(&good("bodies.toml"), &["--output", "out", "--resume"], 2);
    assert!(
        said.contains("checkpoint.dem: there is no such file"),
        "{said}"
    );
}

#[test]
fn a_scene_that_has_changed_is_not_gone_on_with() {
    let bench = begun("bodies.toml", &["--set", "run.end_time=0.5 ms"]);
    for change in [
        "bonds.brittle.young_modulus=13 MPa",
        "bonds.brittle.formulation=incremental",
        "bonds.summed.formulation=total",
        "bonds.brittle.failure.weibull_modulus=9",
        "materials.steel.density=7000",
        "bodies.a.position=[1e-9, 0, 0]",
        "run.seed=1",
        "run.gravity=[0, 0, -1.5]",
        "run.local_damping=0.25",
        "measures.energy.quantity=elastic_energy",
    ] {
        let (said, code) = refused(&bench.run(
            &good("bodies.toml"),
            &["--output", "out", "--resume", "--set", change],
        ));
        assert_eq!(code, 2, "{change}: {said}");
        let key = change.split_once('=').unwrap().0;
        assert!(
            said.contains(&format!("the scene is not that of the run: {key} was ")),
            "{change}: {said}"
        );
    }
    // A scene with the same text, but with a different body.
    let text = fs::read_to_string(good("bodies.toml")).unwrap();
    let other = text.replace("[\"6 mm\", 0, 0, \"1 mm\"]", "[\"6.1 mm\", 0, 0, \"1 mm\"]");
    assert!(other != text);
    let other = bench.write("other.toml", other);
    let said = bench.bad(Path::new(&other), &["--output", "out", "--resume"], 2);
    assert!(said.contains("other bodies, bonds or walls"), "{said}");
}

#[test]
fn there_has_to_be_a_folder_to_resume() {
    let bench = Bench::new();
    let said = bench.bad(&good("bodies.toml"), &["--resume", "--output", "none"], 2);
    assert!(said.contains("none: there is no such folder"), "{said}");
    let scene = fs::read_to_string(good("alone.toml")).unwrap();
    let silent = bench.write("silent.toml", scene.replace("[output]", ""));
    let said = bench.bad(Path::new(&silent), &["--resume"], 2);
    assert!(
        said.contains("--resume: no folder") && said.contains("add --output FOLDER"),
        "{said}"
    );
}

/// A run that was killed while it wrote its final output, and one of which something was removed
/// since.
#[test]
fn what_is_missing_at_the_end_is_written() {
    let tension = super::laboratory::bar();
    for (name, missing) in [
        (
            "meeting.toml",
            &[
                "film.png",
                "film-strip.png",
                "fragment-tree.csv",
                "plots/energy.svg",
                "summary.json",
            ][..],
        ),
        (
            "breaking.toml",
            &[
                "fragment-tree.csv",
                "plots/pull.svg",
                "plots/errors.svg",
                "summary.json",
            ],
        ),
        ("rest.toml", &["plots/energy.svg"]),
        (
            "tension.toml",
            &["report.html", "force-displacement.csv", "summary.json"],
        ),
    ] {
        let bench = Bench::new();
        let scene = match name {
            "tension.toml" => bench.write(name, &tension),
            _ => good(name),
        };
        let go = |options: &[&str]| bench.good(&scene, &[&["--output", "out"], options].concat());
        go(&[]);
        let whole = bytes_of(&bench);
        for file in missing {
            fs::remove_file(bench.path("out").join(file)).unwrap();
            let said = go(&["--resume", "--threads", "2"]);
            assert_eq!(
                said,
                format!(
                    "this run had come to its end; what was missing has been written: {file}\n"
                ),
                "{name}"
            );
            assert!(whole == bytes_of(&bench), "{name} without {file}");
        }
        // All at once, as if the run was killed after its last checkpoint, with another summary in
        // the way.
        for file in missing {
            fs::remove_file(bench.path("out").join(file)).unwrap();
        }
        bench.write("out/summary.json", "{}");
        assert_eq!(go(&["--resume", "--quiet"]), "");
        assert!(whole == bytes_of(&bench), "{name} as a whole");
        fs::remove_file(bench.path("out/summary.json")).unwrap();
        let said = go(&["--resume", "--json"]);
        assert!(said.as_bytes() == whole["summary.json"], "{said}");
        // Nothing is missing now.
        let said = bench.bad(&scene, &["--output", "out", "--resume"], 2);
        assert!(said.contains("nothing is left to be done"), "{said}");
        assert!(whole == bytes_of(&bench));
    }
}

/// All files of the results, unchanged.
fn bytes_of(bench: &Bench) -> std::collections::BTreeMap<String, Vec<u8>> {
    let mut found = super::results(&bench.path("out"));
    found.insert(
        "summary.json".to_owned(),
        fs::read(bench.path("out/summary.json")).unwrap(),
    );
    found
}

/// Particles are renumbered when a body has left: loads and supports keep their particles.
#[test]
fn loads_keep_to_their_particles_where_a_body_has_left_before() {
    let bench = Bench::new();
    let scene = bench.write(
        "leaving.toml",
        r#"
version = 1
run = { end_time = "20 ms", time_step = "10 us" }
materials.stone = { density = 2600, young_modulus = "10 MPa", poisson_ratio = 0.25 }
contacts.stone-stone = { restitution = 0.5 }
bodies.a = { particles = [[0, 0, 0, "1 mm"]], material = "stone", velocity = [0, 0, -1] }
bodies.b = { particles = [["5 mm", 0, 0, "1 mm"]], material = "stone" }
bodies.c = { particles = [["9 mm", 0, 0, "1 mm"]], material = "stone" }
loads.b = { group = "b", force = [0, "1e-5 N", 0] }
supports.c = { group = "c", velocity = { y = "1 mm/s" } }
regions.below = { box = { min = ["-2 mm", "-2 mm", "-1 m"], max = ["2 mm", "2 mm", "-5 mm"] } }
outlets.below = { inside = "below" }
output = { frames = "5 ms", series = "10 us" }
"#,
    );
    bench.good(&scene, &["--output", "whole"]);
    let half = ["--set", "run.end_time=10 ms", "--output", "part"];
    bench.good(&scene, &half);
    let events = fs::read_to_string(bench.path("part/events.csv")).unwrap();
    assert!(events.contains("discharged"), "{events}");
    bench.good(&scene, &["--output", "part", "--resume"]);
    let [whole, part] = ["whole", "part"].map(|folder| {
        let (_, rows) = table(&bench.path(folder).join("series.csv"));
        rows.last().unwrap().clone()
    });
    assert_eq!(whole, part);
    let frames = ["whole", "part"].map(|folder| {
        let last = bench.path(folder).join("frames/frame_000004.vtp");
        fs::read(last).unwrap()
    });
    assert!(frames[0] == frames[1]);
}
