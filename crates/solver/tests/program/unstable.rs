//! A step that is too large: refused, or stopped with the unstable bond.

use std::fs;
use std::path::PathBuf;

use super::{Bench, good};

#[test]
fn a_step_above_the_limit_is_refused_unless_forced() {
    let bench = Bench::new();
    let step = ["--set", "run.time_step=21 us", "--output", "out"];
    let said = bench.bad(
        &good("bodies.toml"),
        &[&step[..], &["--set", "run.end_time=20 ms"]].concat(),
        2,
    );
    assert!(
        said.contains("run.time_step: 2.1000e-5 s is above the largest stable step of 2.0")
            && said.contains("--force-step"),
        "{said}"
    );
    assert!(bench.files().is_empty());
}

#[test]
fn an_unstable_run_names_body_bond_step_and_remedy() {
    let bench = Bench::new();
    let scene = bench.write("scene.toml", uneven().replace("output", "#"));
    let options = ["--set", "run.time_step=20 us", "--force-step"];
    // Without a folder there is no checkpoint to mention.
    let said = bench.bad(&scene, &options, 3);
    assert!(
        said.contains("unstable at step ") && said.contains("of energy were created"),
        "{said}"
    );
    assert!(
        said.contains("of body '") && said.contains("take a smaller run.time_step"),
        "{said}"
    );
    assert!(
        !said.contains("checkpoint") && !said.contains("--resume"),
        "{said}"
    );
    let own: f64 = said
        .split_once("could take a step of ")
        .unwrap()
        .1
        .split_once(" s")
        .unwrap()
        .0
        .parse()
        .unwrap();
    assert!((1e-6..2e-5).contains(&own), "{said}");
}

/// A bar of two spheres, so far from the middle, m, whose bond breaks at once. It turns, so that they
/// part, and its overlap acts once it is below a fraction of what it was.
fn bursting(bench: &Bench, end_ms: u32, least: f64, modulus: &str, from_middle_m: f64) -> PathBuf {
    let text = format!(
        "version = 1
run.end_time = \"{end_ms} ms\"
relaxation.min_overlap = {least}
materials.m = {{ density = 2000, young_modulus = \"{modulus}\" }}
contacts.m-m = {{ restitution = 1 }}
bonds.b = {{ young_modulus = \"1 MPa\", poisson_ratio = 0.3, failure = {{ tensile_strength = 0 }} }}
[bodies.wheel]
particles = [[-{from_middle_m}, 0, 0, 0.01], [{from_middle_m}, 0, 0, 0.01]]
bond_list = [[0, 1]]
material = \"m\"
bonds = \"b\"
angular_velocity = [0, 0, 100]
"
    );
    bench.write("burst.toml", text)
}

/// Bars of spheres that overlap by half a radius burst at once. Those overlaps are relaxed, but
/// act as soon as they fall below a fraction as large as theirs.
#[test]
fn a_large_min_overlap_is_blamed_and_not_the_step() {
    let bench = Bench::new();
    let scene = bursting(&bench, 20, 0.9, "1 GPa", 0.0075);
    let said = bench.bad(&scene, &[], 3);
    assert!(said.contains("a smaller relaxation.min_overlap"), "{said}");
    bench.good(&scene, &["--set", "relaxation.min_overlap=1e-5"]);
}

/// A run that ends with an energy error from such overlaps has the same remedy in its verdict.
#[test]
fn the_verdict_blames_a_large_min_overlap_and_not_the_step() {
    let bench = Bench::new();
    let scene = bursting(&bench, 40, 0.15, "1 MPa", 0.0095);
    let said = bench.good(&scene, &["--json", "--quiet"]);
    let summary: serde_json::Value = serde_json::from_str(&said).unwrap();
    let error = summary["energy_error"].as_f64().unwrap();
    let warnings = summary["verdict"]["warnings"].to_string();
    assert!(error > 0.01, "{error}");
    assert!(
        warnings.contains("is allowed: set a smaller relaxation.min_overlap")
            && !warnings.contains("run.safety_factor"),
        "{warnings}"
    );
}

/// Two bars of equal bonds; in the second, listed from its end, one pair is much lighter than all
/// others.
pub(super) fn uneven() -> String {
    "version = 1
run = { end_time = \"20 ms\", gravity = [0, 0, -1] }
materials.cake.density = 2050
output = { checkpoint = \"0.1 ms\", frames = \"1 ms\" }
[bonds.cake]
young_modulus = \"12 MPa\"
poisson_ratio = 0.3
[bodies.even]
particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3], [4e-3, 0, 0, 1e-3]]
bond_list = [[0, 1], [1, 2]]
material = \"cake\"
bonds = \"cake\"
[bodies.uneven]
particles = [[8e-3, 0, 0, 1e-3], [6e-3, 0, 0, 1e-3], [4e-3, 0, 0, 1e-3], [2.4e-3, 0, 0, 0.3e-3], [1.8e-3, 0, 0, 0.3e-3], [0, 0, 0, 1e-3]]
bond_list = [[0, 1], [1, 2], [2, 3], [4, 5], [3, 4]]
material = \"cake\"
bonds = \"cake\"
position = [0, 0.01, 0]
velocity = [0.5, 0, 0]
angular_velocity = [0, 0, 50]
"
    .to_owned()
}

#[test]
fn the_bond_has_the_number_of_the_bodys_file() {
    let bench = Bench::new();
    let scene = bench.write("uneven.toml", uneven());
    let limit = limit_of(&bench, &scene);
    let step = format!("run.time_step={}", 1.15 * limit);
    let said = bench.bad(&scene, &["--set", &step, "--force-step"], 3);
    assert!(
        said.contains("most of it in bond 4 of body 'uneven' at ("),
        "{said}"
    );
}

fn limit_of(bench: &Bench, scene: &std::path::Path) -> f64 {
    let output = super::dem_run()
        .current_dir(bench.path(""))
        .args(["check", "--json"])
        .arg(scene)
        .output()
        .unwrap();
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    value["limit_s"].as_f64().unwrap()
}

#[test]
fn its_last_good_checkpoint_can_be_taken_up_with_a_smaller_step() {
    let bench = Bench::new();
    let scene = bench.write("uneven.toml", uneven());
    let limit = limit_of(&bench, &scene);
    let step = format!("run.time_step={}", 1.05 * limit);
    let said = bench.bad(
        &scene,
        &["--set", &step, "--force-step", "--output", "out"],
        3,
    );
    assert!(
        said.ends_with("--resume takes it up from 'out/checkpoint.dem' with that step"),
        "{said}"
    );
    assert!(bench.path("out/checkpoint.dem").exists());
    let step = format!("run.time_step={}", 0.2 * limit);
    let said = bench.good(&scene, &["--set", &step, "--output", "out", "--resume"]);
    assert!(said.contains("resumed      time step "), "{said}");
    // Or with one that is found automatically.
    fs::remove_dir_all(bench.path("out")).unwrap();
    let step = format!("run.time_step={}", 1.05 * limit);
    bench.bad(
        &scene,
        &["--set", &step, "--force-step", "--output", "out"],
        3,
    );
    let said = bench.good(&scene, &["--output", "out", "--resume"]);
    assert!(said.contains("resumed      time step "), "{said}");
}

/// Two loose spheres that just touch, and a ball that falls and bounces without loss: at rest, and
/// at the top of its path, there is almost no energy.
const TOUCHING: &str = r#"version = 1
[run]
end_time = "0.1 s"
gravity = [0,0,-9.81]
[materials.m]
density = "2000 kg/m3"
young_modulus = "10 MPa"
poisson_ratio = 0.3
[contacts]
m-m = { restitution = 0.9, friction = 0.3 }
[bodies.a]
material = "m"
particles = [[0.01,0,0.5,0.01],[0.03,0,0.5,0.01]]
[walls.p]
plane = { point = [0,0,0], normal = [0,0,1] }
material = "m"
"#;
const BOUNCING: &str = r#"version = 1
[run]
end_time = "5 s"
gravity = [0,0,-9.81]
[materials.m]
density = "2000 kg/m3"
young_modulus = "10 MPa"
poisson_ratio = 0.3
[contacts]
m-m = { restitution = 1.0, friction = 0.3 }

[bodies.a]
material = "m"
particles = [[0, 0, 0.5, 0.01]]
[walls.p]
plane = { point = [0,0,0], normal = [0,0,1] }
material = "m"
[measures.z]
of = "a"
quantity = "position_z"
statistic = "mean"
[measures.e]
of = "a"
quantity = "kinetic_energy"
"#;

#[test]
fn where_there_is_next_to_no_energy_nobody_is_stopped() {
    let bench = super::Bench::new();
    for at in ["0.03", "0.0299999999", "0.02999999999999"] {
        let scene = bench.write("touch.toml", TOUCHING.replace("0.03,", &format!("{at},")));
        let overlaps = ["--verbose", "--set", "run.initial_overlap=relax"];
        assert!(bench.good(&scene, &overlaps).contains("ended by end time"));
    }
    let scene = bench.write("bounce.toml", BOUNCING);
    for height in ["0.05", "0.5", "1.5"] {
        let set = format!("bodies.a.particles=[[0, 0, {height}, 0.01]]");
        let said = bench.good(&scene, &["--set", &set, "--set", "run.end_time=3"]);
        assert!(said.contains("verdict      sound"), "{said}");
    }
}
