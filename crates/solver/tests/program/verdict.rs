//! Scenes whose results are misleading without a warning: the texts of the verdict and of `check`
//! are in `messages.txt` next to them.

use std::path::Path;

use dem_testing::hold_messages;
use serde_json::Value;

use super::{Bench, corpus};

fn strings(value: &Value) -> Vec<String> {
    let values = value.as_array().unwrap().iter();
    values.map(|one| one.as_str().unwrap().to_owned()).collect()
}

/// The JSON output.
fn json(bench: &Bench, scene: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&bench.good(scene, arguments)).unwrap()
}

#[test]
fn every_doubtful_scene_is_called_so() {
    let bench = Bench::new();
    let scenes = corpus("doubtful");
    assert!(scenes.len() >= 20, "{}", scenes.len());
    let mut messages = Vec::new();
    for path in &scenes {
        let name = path.file_name().unwrap().to_str().unwrap();
        let summary = json(&bench, path, &["--json", "--quiet"]);
        let warnings = strings(&summary["verdict"]["warnings"]);
        assert!(!warnings.is_empty(), "{name} is not doubtful");
        assert_eq!(summary["verdict"]["sound"], false, "{name}");
        let mut check = super::dem_run();
        let output = check.arg("check").arg(path).arg("--json").output().unwrap();
        let checked: Value = serde_json::from_slice(&output.stdout).unwrap();
        let checked = strings(&checked["warnings"]);
        messages.extend(warnings.iter().map(|said| format!("{name}, run: {said}")));
        messages.extend(checked.iter().map(|said| format!("{name}, check: {said}")));
    }
    hold_messages(scenes[0].parent().unwrap(), &messages);
}

/// A heavy ball beside it does not hide the energy error of a small body: it has that of a run
/// without the ball.
#[test]
fn a_small_body_is_judged_by_its_own_energy() {
    let bench = Bench::new();
    let scenes = corpus("doubtful");
    let scene = (scenes.iter()).find(|path| path.ends_with("small-beside-heavy.toml"));
    let text = std::fs::read_to_string(scene.unwrap()).unwrap();
    let summary = json(&bench, scene.unwrap(), &["--json", "--quiet"]);
    let number = |value: &Value| value.as_f64().unwrap();
    assert!(number(&summary["energy_error"]) < 1e-6);
    let part = &summary["part_error"];
    assert_eq!(part["bodies"], serde_json::json!(["pebble"]));

    let lines = text.lines().filter(|line| !line.starts_with("bodies.ball"));
    let alone = bench.write("alone.toml", lines.collect::<Vec<_>>().join("\n"));
    let alone = json(&bench, &alone, &["--json", "--quiet"]);
    assert!(alone["part_error"].is_null(), "{}", alone["part_error"]);
    let [part, alone] = [part, &alone].map(|of| number(&of["energy_error"]));
    assert!(alone > 0.02, "{alone}");
    assert!((part / alone - 1.0).abs() < 1e-3, "{part} {alone}");
}

/// Pieces in free flight are no doubt in what has been simulated: a note gives the time at which
/// the pair that can still break reaches the plate, sqrt(2 h/g), and there is none without a plate.
#[test]
fn pieces_in_free_flight_are_a_note() {
    let bench = Bench::new();
    let scenes = corpus("doubtful");
    let scene = scenes
        .iter()
        .find(|path| path.ends_with("still-flying.toml"));
    let text = std::fs::read_to_string(scene.unwrap()).unwrap();
    let of_run = |text: &str, name: &str| {
        let scene = bench.write(name, text);
        json(&bench, &scene, &["--json", "--quiet"])
    };
    let later = text.replace("0.15 ms", "10 ms");
    let text = text.replace("[0, 0, 0.13]", "[0, 0, 0.15]");
    let summary = of_run(&text, "far.toml");
    let doubts = |summary: &Value| {
        let warnings = strings(&summary["verdict"]["warnings"]).into_iter();
        warnings.filter(|said| said.contains("moved apart")).count()
    };
    assert_eq!(doubts(&summary), 0, "{summary}");
    let notes = strings(&summary["notes"]);
    let meets_s = (2.0 * 0.02 / 9.81_f64).sqrt();
    let time = format!("'plate' at {meets_s:.4} s");
    assert!(notes.iter().any(|note| note.contains(&time)), "{notes:?}");
    let kept = text.lines().filter(|line| !line.starts_with("walls."));
    let summary = of_run(&kept.collect::<Vec<_>>().join("\n"), "alone.toml");
    assert_eq!(doubts(&summary), 0, "{summary}");
    assert_eq!(strings(&summary["notes"]), Vec::<String>::new());
    // Long after the last break they are none either, although the pair touches the plate.
    let summary = of_run(&later, "later.toml");
    assert_eq!(doubts(&summary), 0, "{summary}");
    let notes = strings(&summary["notes"]);
    let quiet = "; no bond has broken for 0.00987 s";
    assert!(notes.iter().any(|note| note.ends_with(quiet)), "{notes:?}");
}

#[test]
fn a_run_that_was_stopped_leaves_its_summary_and_what_happened() {
    let bench = Bench::new();
    let scene = bench.write("scene.toml", super::unstable::uneven());
    let options = [
        "--set",
        "run.time_step=20 us",
        "--force-step",
        "--json",
        "--output",
        "out",
    ];
    let output = bench.run(&scene, &options);
    assert_eq!(output.status.code(), Some(3));
    let printed: Value = serde_json::from_slice(&output.stdout).unwrap();
    let written = std::fs::read(bench.path("out/summary.json")).unwrap();
    let written: Value = serde_json::from_slice(&written).unwrap();
    assert_eq!(printed, written);
    assert_eq!(written["ended_by"], "instability");
    let problem = written["problem"].as_str().unwrap();
    assert!(problem.contains("unstable at step "), "{problem}");
    assert_eq!(written["verdict"]["sound"], false);
    assert_eq!(written["verdict"]["warnings"][0], problem);
    let inputs = &written["inputs"];
    assert_eq!(inputs["set"], serde_json::json!(["run.time_step=20 us"]));
    assert_eq!(inputs["scene"]["run.time_step"], "2e-5 s");
    assert_eq!(inputs["seed"], 0);
    // It is not a result of a completed run.
    let said = bench.bad(&scene, &["--output", "out"], 2);
    assert!(said.contains("--force"), "{said}");
}

#[test]
fn bodies_are_told_apart_by_their_hashes() {
    let bench = Bench::new();
    bench.write("row.vtp", super::vtp_bytes(&super::row(5)));
    bench.write("longer.vtp", super::vtp_bytes(&super::row(6)));
    let scene = bench.write(
        "scene.toml",
        "version = 1\nrun.end_time = \"1 us\"\nmaterials.m.density = 1000\nbonds.b = { young_modulus = \"1 MPa\", poisson_ratio = 0.3 }\nbodies.row = { file = \"row.vtp\", material = \"m\", bonds = \"b\" }\n",
    );
    let hash = |options: &[&str]| {
        let all = [&["--json", "--quiet"], options].concat();
        let body = &json(&bench, &scene, &all)["inputs"]["bodies"]["row"];
        body["hash"].as_str().unwrap().to_owned()
    };
    let first = hash(&[]);
    assert_eq!(first.len(), 16);
    assert_eq!(hash(&["--body", "row.vtp"]), first);
    assert_ne!(hash(&["--body", "longer.vtp"]), first);
}

/// A bar that breaks at once, in its first step.
#[test]
fn the_end_of_a_run_knows_all_pieces() {
    let bench = Bench::new();
    let scene = bench.write(
        "burst.toml",
        "version = 1\nrun.end_time = \"1 ms\"\nmaterials.m.density = 2000\nbonds.b = { young_modulus = \"50 MPa\", poisson_ratio = 0.3, failure = { tensile_strength = 0 } }\n[bodies.wheel]\nparticles = [[-0.01, 0, 0, 0.01], [0.01, 0, 0, 0.01]]\nbond_list = [[0, 1]]\nmaterial = \"m\"\nbonds = \"b\"\nangular_velocity = [0, 0, 100]\n",
    );
    let summary = json(&bench, &scene, &["--json", "--quiet", "--output", "out"]);
    assert_eq!(summary["broken_bonds"], 1);
    assert_eq!(summary["fragments"]["count"], 2);
    let events = std::fs::read_to_string(bench.path("out/events.csv")).unwrap();
    assert_eq!(
        events.lines().filter(|line| line.contains("split")).count(),
        1,
        "{events}"
    );
    let (_, rows) = super::table(&bench.path("out/fragments.csv"));
    let last = rows.last().unwrap()[0].clone();
    assert_eq!(rows.iter().filter(|row| row[0] == last).count(), 2);
}

#[test]
fn without_a_folder_the_last_line_says_so() {
    let bench = Bench::new();
    let scene = super::scene_of_data("cantilever.toml");
    let said = bench.good(&scene, &["--set", "run.end_time=1 ms"]);
    let last = "no files written: add --output FOLDER to keep the results";
    assert_eq!(said.lines().last(), Some(last));
    let short = ["--set", "run.end_time=1 ms", "--output", "out"];
    assert!(!bench.good(&scene, &short).contains("no files written"));
}

/// Pebbles and bonded pairs, fed into a box.
const FED: &str = r#"version = 1
run = { end_time = "60 ms", gravity = [0, 0, -9.81] }
[materials.stone]
density = 2000
young_modulus = "50 MPa"
[materials.steel]
young_modulus = "210 GPa"
[contacts]
stone-stone = { restitution = 0.5 }
steel-stone = { restitution = 0.5 }
[bonds.glue]
young_modulus = "50 MPa"
poisson_ratio = 0.3
[bodies.pair]
particles = [[0, 0, 0, 0.01], [0.02, 0, 0, 0.01]]
bond_list = [[0, 1]]
material = "stone"
bonds = "glue"
[bodies.pebble]
particles = [[0, 0, 0, 0.01]]
material = "stone"
[regions.gate]
box = { min = [-0.2, -0.2, 0.1], max = [0.2, 0.2, 0.2] }
[inlets.pairs]
bodies = ["pair"]
region = "gate"
rate = "40 /s"
velocity = [0, 0, -2]
[inlets.pebbles]
bodies = ["pebble"]
region = "gate"
rate = "40 /s"
velocity = [0, 0, -2]
[walls.floor]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
material = "steel"
"#;

#[test]
fn what_an_inlet_feeds_bonded_is_no_replacement_and_a_sphere_no_clump() {
    let bench = Bench::new();
    let scene = bench.write("fed.toml", FED);
    let summary = json(&bench, &scene, &["--json", "--quiet", "--output", "out"]);
    let population = &summary["population"];
    assert_eq!(population["fed"], 6);
    assert_eq!(population["replaced"], 0);
    assert_eq!(population["clumps"], 0);
    assert_eq!(population["single_sphere_bodies"], 3);
    let (_, rows) = super::table(&bench.path("out/events.csv"));
    let kinds = |kind: &str| {
        rows.iter()
            .filter(|row| row.iter().any(|cell| cell == kind))
            .count()
    };
    assert_eq!((kinds("bonded"), kinds("replaced")), (3, 0));
}

/// pi R sqrt(rho/G) / (0.1631 nu + 0.8766) with the material of the particles, which are not fed
/// yet.
#[test]
fn check_speaks_of_what_inlets_will_feed() {
    let bench = Bench::new();
    let scene = bench.write("fed.toml", FED);
    let output = super::dem_run()
        .arg("check")
        .arg(&scene)
        .arg("--json")
        .output()
        .unwrap();
    let check: Value = serde_json::from_slice(&output.stdout).unwrap();
    let shear_pa: f64 = 50e6 / (2.0 * 1.3);
    let rayleigh_s =
        std::f64::consts::PI * 0.01 * (2000.0 / shear_pa).sqrt() / (0.1631 * 0.3 + 0.8766);
    let said = check["rayleigh_s"].as_f64().unwrap();
    assert!(
        (said / rayleigh_s - 1.0).abs() < 1e-9,
        "{said} {rayleigh_s}"
    );
    let pairs = &check["to_be_fed"][0];
    assert_eq!(pairs["inlet"], "pairs");
    assert_eq!(
        (&pairs["bodies"], &pairs["bonds"]),
        (&3.0.into(), &3.0.into())
    );
    assert!(pairs["bytes"].as_f64().unwrap() > 0.0);
    let output = super::dem_run()
        .args(["check", "--verbose"])
        .arg(&scene)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    for said in [
        "0 particles, 0 bonds at the start\n",
        "3 bodies by the inlet 'pairs' until the end: 6 spheres and 3 bonds once they are bonded\n",
        "if all that is fed is bonded and none is discharged\n",
    ] {
        assert!(text.contains(said), "{text}");
    }
}

/// By symmetry each of two equal balls that meet is pressed in as one is that meets a rigid wall at
/// half the speed: both scenes are doubtful from the same modulus on.
#[test]
fn each_of_two_spheres_takes_half_of_their_overlap() {
    let bench = Bench::new();
    let common = |modulus_kpa: f64| {
        format!(
            "version = 1\nrun.end_time = \"40 ms\"\nrun.safety_factor = 0.1\nmaterials.wall.rigid = true\n\
             materials.jelly = {{ density = 2000, young_modulus = \"{modulus_kpa} kPa\" }}\n\
             contacts.jelly-jelly = {{ restitution = 1.0 }}\n\
             contacts.jelly-wall = {{ restitution = 1.0 }}\n"
        )
    };
    let ball = |name: &str, z_mm: f64, speed_m_s: f64| {
        format!(
            "bodies.{name} = {{ particles = [[0, 0, \"{z_mm} mm\", \"10 mm\"]], \
             material = \"jelly\", velocity = [0, 0, {speed_m_s}] }}\n"
        )
    };
    let floor = "walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, \
                 material = \"wall\" }\n";
    for (modulus_kpa, is_sound) in [(300.0, true), (100.0, false)] {
        let alone = [&common(modulus_kpa), &ball("one", 10.1, -1.0), floor].concat();
        let two = [ball("one", 10.1, -1.0), ball("other", -10.1, 1.0)].concat();
        let pair = [common(modulus_kpa), two].concat();
        let deepest = [alone, pair].map(|text| {
            let scene = bench.write("scene.toml", text);
            let summary = json(&bench, &scene, &["--json", "--quiet"]);
            let verdict = &summary["verdict"];
            assert_eq!(verdict["sound"], is_sound, "{modulus_kpa}: {verdict}");
            summary["largest_overlap"].as_f64().unwrap()
        });
        // The pair's overlap counts from both of its spheres.
        assert!((deepest[1] / deepest[0] - 2.0).abs() < 1e-3, "{deepest:?}");
    }
}

/// A scene of the corpus, read.
fn doubtful_text(name: &str) -> String {
    let scenes = corpus("doubtful");
    let path = scenes.iter().find(|path| path.ends_with(name)).unwrap();
    std::fs::read_to_string(path).unwrap()
}

/// Once the ball has parted from the floor, and when it lies on it, the impact is over.
#[test]
fn an_impact_is_over_when_the_ball_has_parted_or_rests() {
    let bench = Bench::new();
    let text = doubtful_text("ends-in-an-impact.toml");
    let end = "run.end_time = \"10.05 ms\"";
    for other in [
        "run.end_time = \"11 ms\"",
        "run = { end_time = \"0.6 s\", gravity = [0, 0, -9.81] }",
    ] {
        let scene = bench.write("scene.toml", text.replace(end, other));
        let summary = json(&bench, &scene, &["--json", "--quiet"]);
        let warnings = strings(&summary["verdict"]["warnings"]);
        assert_eq!(warnings, Vec::<String>::new(), "{other}");
    }
}

/// A rigid rod that hits a pin becomes breakable by its stress of bending, and breaks as the rod
/// that was bonded from the start.
#[test]
fn bending_replaces_a_slender_clump_in_time() {
    let bench = Bench::new();
    let text = doubtful_text("rod-on-a-pin.toml");
    let bonded = text.replace("start_as = \"clump\"", "start_as = \"bonded\"");
    let rule = "replacement.rod = { when = { principal_stress = \"1 MPa\" } }\nversion = 1";
    let replaced = text.replacen("version = 1", rule, 1);
    let broken = [bonded, replaced].map(|text| {
        let scene = bench.write("scene.toml", text);
        let summary = json(&bench, &scene, &["--json", "--quiet"]);
        assert_eq!(summary["verdict"]["sound"], true, "{}", summary["verdict"]);
        summary["broken_bonds"].as_u64().unwrap()
    });
    assert!(broken[0] >= 2, "{broken:?}");
    assert_eq!(broken[0], broken[1]);
}

/// A ring of spheres is a row of bonds, and no packing with too few of them.
#[test]
fn a_bent_row_is_no_thin_packing() {
    let bench = Bench::new();
    let count = 24;
    let place = |k: i32| {
        let angle = f64::from(k) * std::f64::consts::TAU / f64::from(count);
        let (sine, cosine) = angle.sin_cos();
        format!("[{}, 0, {}, 0.005]", 0.036 * cosine, 0.0412 + 0.036 * sine)
    };
    let text = doubtful_text("rod-on-a-pin.toml");
    let head = text.split("[bodies.rod]").next().unwrap();
    let places: Vec<String> = (0..count).map(place).collect();
    let mut bonds: Vec<String> = (1..count).map(|k| format!("[{}, {k}]", k - 1)).collect();
    bonds.push(format!("[0, {}]", count - 1));
    let ring = format!(
        "{head}[bodies.ring]\nparticles = [{}]\nbond_list = [{}]\nmaterial = \"stone\"\n\
         bonds = \"glue\"\nvelocity = [0, 0, -0.5]\n",
        places.join(", "),
        bonds.join(", ")
    );
    let scene = bench.write("ring.toml", ring);
    let summary = json(&bench, &scene, &["--json", "--quiet"]);
    let warnings = strings(&summary["verdict"]["warnings"]);
    assert_eq!(warnings, Vec::<String>::new());
}

/// A constant load on a ball at rest, and a lid that was moved onto it and then held, are no
/// impact, however large beside the weight; nor is an end that a measure asked for.
#[test]
fn what_presses_at_rest_is_no_impact() {
    let bench = Bench::new();
    let text = doubtful_text("ends-in-an-impact.toml");
    let ball = "particles = [[0, 0, 0.02, 0.01]]";
    let lying = text.replace(ball, "particles = [[0, 0, 0.01, 0.01]]");
    let lying = lying.replace("velocity = [0, 0, -1]", "velocity = [0, 0, 0]");
    let lying = lying.replace("10.05 ms", "60 ms");
    let loaded = format!(
        "{lying}loads.push = {{ group = \"ball\", force = [0, 0, -1], ramp = \"5 ms\" }}\n"
    );
    let lid = format!(
        "{lying}walls.lid = {{ plane = {{ point = [0, 0, 0.0201], normal = [0, 0, -1] }}, material = \"stone\", \
         displacement = [0, 0, \"-0.3 mm\"], ramp = \"20 ms\" }}\n"
    );
    let measured = format!(
        "{}measures.push = {{ of = \"floor\", quantity = \"force_z\", statistic = \"smallest\" }}\n\
         measures.overlap = {{ of = \"floor\", quantity = \"force\", end_run_above = \"5 N\" }}\n\
         output.series = \"10 us\"\n",
        text.replace("10.05 ms", "20 ms")
    );
    for scene in [loaded, lid, measured] {
        let scene = bench.write("scene.toml", scene);
        let summary = json(&bench, &scene, &["--json", "--quiet"]);
        let warnings = strings(&summary["verdict"]["warnings"]);
        let is_impact = |said: &String| said.contains("in the middle of an impact");
        assert!(!warnings.iter().any(is_impact), "{warnings:?}");
    }
}

/// Bonds may be up to twice as thick as their smaller sphere.
#[test]
fn bonds_more_than_twice_as_thick_as_spheres_are_doubted() {
    let bench = Bench::new();
    let text = doubtful_text("bonds-too-thick.toml");
    for (factor, is_said) in [("2.0", false), ("2.1", true)] {
        let scene = text.replace("radius_factor = 20,", &format!("radius_factor = {factor},"));
        let scene = bench.write("scene.toml", scene);
        let summary = json(&bench, &scene, &["--json", "--quiet"]);
        let warnings = strings(&summary["verdict"]["warnings"]);
        let said = warnings.iter().any(|said| said.contains("as thick as"));
        assert_eq!(said, is_said, "{factor}: {warnings:?}");
    }
}
