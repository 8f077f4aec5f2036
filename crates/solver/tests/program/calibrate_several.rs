//! `dem-run calibrate` with several scenes: tests with closed forms, as if measured with bonds that
//! the calibration does not know.

use std::f64::consts::PI;
use std::process::Output;

use serde_json::Value;

use super::{Bench, dem_run, refused};

/// Radius of every sphere and bond, m.
const RADIUS_M: f64 = 1e-3;
const DIAMETER_M: f64 = 2.0 * RADIUS_M;
/// The hidden bonds: modulus and cohesion, Pa, and friction angle, degrees.
const HIDDEN: [f64; 3] = [1e12, 0.5e6, 30.0];
/// Normal stresses of the shear tests, Pa.
const NORMAL_PA: [f64; 2] = [0.2e6, 1e6];

/// The wrong first guess, in a file that all scenes include.
const MATERIAL: &str = r#"
[contacts]
rock-rock = { restitution = 0.5, friction = 0.3 }
[materials.rock]
density = 2600
young_modulus = "1000 GPa"
poisson_ratio = 0.25
[bonds.rock]
model = "shear-coefficient"
young_modulus = "600 GPa"
poisson_ratio = 0.25
damping = { damping_ratio = 0.3 }
failure = { cohesion = "0.9 MPa", friction_angle = "20 deg" }
"#;

fn body(places: &[[f64; 3]], bonds: &[[usize; 2]]) -> String {
    let spheres: Vec<String> = (places.iter())
        .map(|[x, y, z]| format!("[{x:e}, {y:e}, {z:e}, {RADIUS_M}]"))
        .collect();
    format!(
        "version = 1\ninclude = [\"rock.toml\"]\n[run]\nsafety_factor = 0.5\n[bodies.specimen]\nparticles = [{}]\nbond_list = {bonds:?}\nmaterial = \"rock\"\nbonds = \"rock\"\n",
        spheres.join(", ")
    )
}

/// A row of spheres that is pulled: rods with the modulus of their bonds, which break where the
/// line of Mohr and Coulomb has no shear stress, under a tension of c/tan phi, if that is a target.
fn pulled(has_strength: bool) -> String {
    let places: Vec<[f64; 3]> = (0..11)
        .map(|i| [0.0, 0.0, DIAMETER_M * f64::from(i)])
        .collect();
    let bonds: Vec<[usize; 2]> = (0..10).map(|i| [i, i + 1]).collect();
    let strength_pa = HIDDEN[1] / HIDDEN[2].to_radians().tan();
    let strength = match has_strength {
        true => format!("strength = {strength_pa:e}"),
        false => String::new(),
    };
    format!(
        r#"{}
[groups]
foot = {{ particles = [0] }}
head = {{ particles = [10] }}
[supports]
foot = {{ group = "foot", fixed = true }}
[test]
type = "tension"
crosshead = ["head"]
direction = [0, 0, 1]
stroke = "0.15 um"
length = "20 mm"
area = {:e}
periods = 200
rate_check = false
young_modulus = {:e}
{strength}
"#,
        body(&places, &bonds),
        PI * RADIUS_M.powi(2),
        HIDDEN[0],
    )
}

/// Two layers of nine spheres, one slid along the other: c + sigma tan phi of their bonds.
fn sheared(normal_pa: f64) -> String {
    let layer = |z: f64| {
        let at = move |n: usize| [DIAMETER_M * (n / 3) as f64, DIAMETER_M * (n % 3) as f64, z];
        (0..9).map(at)
    };
    let places: Vec<[f64; 3]> = layer(0.0).chain(layer(DIAMETER_M)).collect();
    let touch = |i: usize, j: usize| {
        let square: f64 = (0..3).map(|k| (places[i][k] - places[j][k]).powi(2)).sum();
        square.sqrt() < 1.001 * DIAMETER_M
    };
    let pairs = (0..places.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
    let bonds: Vec<[usize; 2]> = pairs.filter(|[i, j]| touch(*i, *j)).collect();
    let numbers = |from: usize| (from..from + 9).collect::<Vec<usize>>();
    let peak_pa = HIDDEN[1] + normal_pa * HIDDEN[2].to_radians().tan();
    format!(
        r#"{}
[groups]
lower = {{ particles = {:?} }}
upper = {{ particles = {:?} }}
[supports]
lower = {{ group = "lower", fixed = true }}
[test]
type = "direct-shear"
crosshead = ["upper"]
direction = [1, 0, 0]
normal = [0, 0, -1]
normal_stress = {normal_pa:e}
area = {:e}
stroke = "0.03 um"
periods = 500
rate_check = false
strength = {peak_pa:e}
"#,
        body(&places, &bonds),
        numbers(0),
        numbers(9),
        9.0 * PI * RADIUS_M.powi(2),
    )
}

/// The scenes and the material of all.
pub(super) fn scenes(bench: &Bench) {
    bench.write("rock.toml", MATERIAL);
    bench.write("pulled.toml", pulled(false));
    bench.write("torn.toml", pulled(true));
    for (name, normal_pa) in ["low.toml", "high.toml"].into_iter().zip(NORMAL_PA) {
        bench.write(name, sheared(normal_pa));
    }
}

const ALL: [&str; 3] = ["pulled.toml", "low.toml", "high.toml"];
const FREE: [&str; 6] = [
    "--free",
    "modulus",
    "--free",
    "cohesion",
    "--free",
    "friction_angle",
];

fn calibrate(bench: &Bench, scenes: &[&str], options: &[&str]) -> Output {
    let mut command = dem_run();
    command.current_dir(bench.path("")).arg("calibrate");
    command.args(scenes).args(["--output", "found.toml"]);
    command.args(options).output().unwrap()
}

fn record(bench: &Bench) -> Value {
    let text = std::fs::read_to_string(bench.path("found.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Three numbers that are 1.5 to 1.8 times wrong are found by a test in tension and two in shear,
/// whose results determine them; with the tensile strength as a fourth target by least squares.
#[test]
fn three_tests_find_three_numbers_of_a_material() {
    for first in ["torn.toml", "pulled.toml"] {
        let bench = Bench::new();
        scenes(&bench);
        let printed = calibrate(&bench, &[first, "low.toml", "high.toml"], &FREE);
        assert!(printed.status.success(), "{first}: {printed:?}");
        let record = record(&bench);
        let at = record["end"][0].as_u64().unwrap() as usize;
        let guess = [600e9, 0.9e6, 20.0];
        for (n, (hidden, guess)) in HIDDEN.into_iter().zip(guess).enumerate() {
            let found = guess * record["rounds"][at]["factors"][n].as_f64().unwrap();
            // Strengths are met within 2 %; tan phi follows from their difference.
            let most = [0.012, 0.05, 0.1][n];
            let off = found / hidden - 1.0;
            assert!(off.abs() < most, "{first} {n}: {found} {hidden}");
        }
    }
}

/// What a calibration by several tests prints and writes, and that there is nothing left to do.
#[test]
fn a_calibration_by_several_tests_is_written_down() {
    let bench = Bench::new();
    scenes(&bench);
    let printed = calibrate(&bench, &ALL, &FREE);
    assert!(printed.status.success(), "{printed:?}");
    let said = String::from_utf8(printed.stdout).unwrap();
    for part in [
        "test         pulled.toml",
        "test         high.toml",
        "failure line direct-shear, 2 strengths: cohesion ",
        "bonds.rock.failure.friction_angle ",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // The material meets the targets of each scene, and names all tests.
    let material = std::fs::read_to_string(bench.path("found.toml")).unwrap();
    for part in [
        "# Test: low.toml, direct-shear.",
        "# Test: pulled.toml, tension.",
        "[bonds.rock]",
    ] {
        assert!(material.contains(part), "{part}: {material}");
    }
    let found = bench.path("found.toml").display().to_string();
    let options = ["--material", found.as_str(), "--json", "--quiet"];
    let after = bench.good(&bench.path("high.toml"), &options);
    let after: Value = serde_json::from_str(&after).unwrap();
    let results = after["test"]["results"].as_array().unwrap();
    let strength = results
        .iter()
        .find(|one| one["name"] == "strength")
        .unwrap();
    assert!(
        strength["error"].as_f64().unwrap().abs() <= 0.02,
        "{strength}"
    );
    // Nothing is left to do.
    let again = calibrate(
        &bench,
        &ALL,
        &[&FREE[..], &["--resume", "--quiet"]].concat(),
    );
    assert!(again.status.success(), "{again:?}");
    let other = calibrate(
        &bench,
        &ALL,
        &["--resume", "--free", "modulus", "--free", "strength"],
    );
    let (said, code) = refused(&other);
    assert!(
        said.contains("it is the calibration of other scenes"),
        "{said}"
    );
    assert_eq!(code, 2);
}

/// One factor on all strengths cannot give both strengths: each is as far off as the other.
#[test]
fn targets_that_contradict_are_written_down() {
    let bench = Bench::new();
    scenes(&bench);
    let text = std::fs::read_to_string(bench.path("high.toml")).unwrap();
    let own = text.lines().filter(|line| !line.starts_with("strength"));
    let own: Vec<&str> = own.collect();
    bench.write(
        "high.toml",
        format!("{}\nstrength = \"4 MPa\"\n", own.join("\n")),
    );
    let printed = calibrate(&bench, &ALL[1..], &["--free", "cohesion"]);
    assert_eq!(printed.status.code(), Some(1), "{printed:?}");
    let said = String::from_utf8(printed.stderr).unwrap();
    assert!(
        said.contains(
            "the targets contradict each other; the nearest numbers leave low.toml: strength +"
        ),
        "{said}"
    );
    assert!(said.contains("high.toml: strength -"), "{said}");
    assert!(!bench.path("found.toml").exists());
    let marked = std::fs::read_to_string(bench.path("found-not-met.toml")).unwrap();
    assert!(
        marked.starts_with("# NOT CALIBRATED: the targets contradict"),
        "{marked}"
    );
}

#[test]
fn several_scenes_that_do_not_fit_are_refused_with_one_message() {
    let bench = Bench::new();
    scenes(&bench);
    let other = pulled(false).replace("include = [\"rock.toml\"]", "include = [\"soft.toml\"]");
    bench.write("soft.toml", MATERIAL.replace("600 GPa", "500 GPa"));
    bench.write("soft-pulled.toml", other);
    let renamed = pulled(false)
        .replace("include = [\"rock.toml\"]", "include = [\"clay.toml\"]")
        .replace("bonds = \"rock\"", "bonds = \"clay\"");
    bench.write(
        "clay.toml",
        MATERIAL.replace("[bonds.rock]", "[bonds.clay]"),
    );
    bench.write("clay-pulled.toml", renamed);
    let text = pulled(false);
    let (without, _) = text.split_once("[test]").unwrap();
    let without = without.replace("[run]", "[run]\nend_time = \"1 s\"");
    bench.write("untested.toml", without);
    let shape = super::root()
        .join("data/shapes/bar.stl")
        .display()
        .to_string();
    let both = ["pulled.toml", "low.toml"];
    for (scenes, options, wanted) in [
        (
            ["pulled.toml", "./pulled.toml"],
            vec![],
            "error: ./pulled.toml: this scene is named twice; name each test once",
        ),
        (
            ["low.toml", "soft-pulled.toml"],
            vec![],
            "error: soft-pulled.toml: its bonds 'rock' are others than in low.toml: young_modulus = \"500 GPa\" in place of young_modulus = \"600 GPa\"; several tests",
        ),
        (
            ["low.toml", "clay-pulled.toml"],
            vec![],
            "error: clay-pulled.toml: its body has the bonds 'clay', and that of low.toml the bonds 'rock'",
        ),
        (
            ["low.toml", "untested.toml"],
            vec![],
            "error: untested.toml: the scene has no [test]; add one",
        ),
        (
            both,
            vec!["--free", "strength"],
            "error: pulled.toml: no free number moves its target, the modulus by travel; add --free modulus",
        ),
        (
            both,
            FREE.to_vec(),
            "error: --free: 3 numbers are free, and the scenes have 2 targets",
        ),
        (
            both,
            vec!["--free", "contacts.rock-sand.friction"],
            "error: --free contacts.rock-sand.friction: no scene has this number",
        ),
        (
            both,
            vec!["--free", "bonds.rock.young_modulus=strength:1"],
            "error: --free bonds.rock.young_modulus=strength:1: it is not known; write modulus,",
        ),
        (
            both,
            vec!["--free", "cohesion", "--free", "strength"],
            "error: --free: bonds.rock.failure.cohesion is named twice",
        ),
        (
            both,
            vec!["--target", "mud.toml=strength:1"],
            "error: --target mud.toml=strength:1: no scene is called 'mud.toml'",
        ),
        (
            both,
            vec!["--target", "low.toml=height:1"],
            "error: --target low.toml=height:1: the scene has no measure or test result 'height'",
        ),
        (
            both,
            vec!["--target", "low.toml=residual strength"],
            "error: --target low.toml=residual strength: its value is not a positive number",
        ),
        (
            both,
            vec!["--", "--diameter", "6mm"],
            "error: pulled.toml: the shape of its body is missing; add --shape pulled.toml=FILE.stl",
        ),
        (
            both,
            vec![
                "--shape",
                "mud.toml=a.stl",
                "--",
                &shape,
                "--diameter",
                "6mm",
            ],
            "error: --shape mud.toml=a.stl: no scene is called 'mud.toml'",
        ),
        (
            both,
            vec!["--body", "a.vtp"],
            "error: --body: it does not apply to several scenes",
        ),
    ] {
        let (said, code) = refused(&calibrate(&bench, &scenes, &options));
        assert!(said.starts_with(wanted), "{options:?}: {said}");
        assert_eq!(code, 2, "{options:?}: {said}");
        assert!(!bench.path("found.json").exists(), "{options:?}: {said}");
    }
}
