//! Damage of bonds goes from run to run.

use dem_io::body::{read_body, write_body};
use serde_json::Value;

use super::{Bench, good, numbers, scene_of_data};

/// The results of a fall of `data/scenes/repeated-drops.toml`.
fn fall(bench: &Bench, body: &[&str], folder: &str) -> Value {
    let options = [
        "--set",
        "output.pictures=\"40 ms\"",
        "--json",
        "--quiet",
        "--output",
        folder,
    ];
    let scene = scene_of_data("repeated-drops.toml");
    serde_json::from_str(&bench.good(&scene, &[&options[..], body].concat())).unwrap()
}

/// Number of falls.
const LAST: usize = 5;

/// The mass fraction of the largest fragment, and the number of damaged bonds, after each fall of
/// the largest fragment of the fall before; `mended`: its damage is taken away in between.
fn falls(bench: &Bench, mended: bool) -> Vec<(f64, u64)> {
    let mut after = Vec::new();
    let mut last = String::new();
    for number in 1..=LAST {
        let folder = format!("drop-{mended}-{number}");
        let body = ["--body", &last];
        let results = fall(bench, if number == 1 { &[] } else { &body }, &folder);
        let largest = results["measures"]["largest"]["value"].as_f64().unwrap();
        let damaged = results["damaged_bonds"].as_u64().unwrap();
        assert!(damaged > 0);
        after.push((largest, damaged));
        last = format!("dropped-{mended}-{number}.vtp");
        let done = super::dem_run()
            .current_dir(bench.path(""))
            .args(["fragment", &folder, "--largest", "-o", &last, "--quiet"])
            .status();
        assert!(done.unwrap().success());
        let mut body = read_body(&bench.path(&last)).unwrap();
        assert!(body.bond_damages.iter().any(|damage| *damage > 0.0));
        if mended {
            body.bond_damages.clear();
            write_body(&body, &bench.path(&last)).unwrap();
        }
    }
    after
}

#[test]
fn damage_adds_up_from_fall_to_fall() {
    let bench = Bench::new();
    let damaged = falls(&bench, false);
    let grows = damaged.windows(2).all(|two| two[0].1 < two[1].1);
    assert!(
        grows && damaged[LAST - 1].1 > 10 * damaged[0].1,
        "{damaged:?}"
    );
    // Pieces have broken off.
    assert!(damaged.iter().any(|after| after.0 < 1.0), "{damaged:?}");
    // Damage adds up: with the bonds mended before each fall, far fewer are damaged by the fifth.
    let mended = falls(&bench, true);
    let [damaged, mended] = [&damaged, &mended].map(|after| after[LAST - 1].1 as f64);
    assert!(damaged > 1.4 * mended, "{damaged} {mended}");
}

#[test]
fn a_damaged_body_needs_bonds_that_can_be_damaged() {
    let bench = Bench::new();
    let mut body = super::row(3);
    body.bond_damages = vec![0.0; body.bonds.len()];
    body.bond_damages[0] = 0.25;
    write_body(&body, &bench.path("row.vtp")).unwrap();
    let scene = |failure: &str| {
        format!(
            "version = 1
run = {{ end_time = 1e-4 }}
materials.rock = {{ density = 2500 }}
bonds.rock = {{ young_modulus = 1e9, poisson_ratio = 0.25, failure = {{ tensile_strength = 1e6{failure} }} }}
bodies.row = {{ file = \"row.vtp\", material = \"rock\", bonds = \"rock\" }}
"
        )
    };
    let said = bench.bad(&bench.write("none.toml", scene("")), &[], 2);
    assert!(
        said.ends_with("bond 0: it is damaged (0.25), and its kind of bonds has no fracture_energy; add fracture_energy to its failure table, or remove the array 'damage' from the file"),
        "{said}"
    );
    let said = bench.bad(
        &bench.write("less.toml", scene(", fracture_energy = 1")),
        &[],
        2,
    );
    assert!(
        said.contains("it stores 1 J/m2 when it reaches its strength, not less than its fracture_energy of 1 J/m2; give more fracture energy"),
        "{said}"
    );
    bench.good(
        &bench.write("good.toml", scene(", fracture_energy = 2")),
        &["--quiet"],
    );
}

/// Frames, series and summary tell of it.
#[test]
fn damage_is_in_the_results() {
    let bench = Bench::new();
    let options = ["--json", "--quiet", "--output", "out"];
    let results: Value =
        serde_json::from_str(&bench.good(&good("softening.toml"), &options)).unwrap();
    let series = numbers(&bench.path("out/series.csv"), "bond_damage_j");
    assert!(
        series.is_sorted() && series.last().unwrap() > &1e-5,
        "{series:?}"
    );
    assert_eq!(
        results["balance"]["bond_damage_j"].as_f64(),
        series.last().copied()
    );
    let frame = dem_results::read_all_arrays(&bench.path("out/frames/frame_000004.vtp")).unwrap();
    let damages = frame.get("CellData/damage").unwrap();
    assert!(
        damages.iter().any(|damage| (0.01..0.99).contains(damage)),
        "{damages:?}"
    );
    let error = results["energy_error"].as_f64().unwrap();
    assert!(error.abs() < 1e-3, "{error}");
}

/// The largest strain of a bond is that at which it broke, and not less because it is gone.
#[test]
fn the_largest_strain_is_that_of_the_break() {
    let bench = Bench::new();
    let scene = |failure: &str| {
        format!(
            "version = 1
run = {{ end_time = 1e-2, time_step = 1e-6 }}
materials.rock = {{ density = 2500 }}
bonds.rock = {{ young_modulus = 1e7, poisson_ratio = 0.25, failure = {{ tensile_strength = 2e5{failure} }} }}
bodies.row = {{ particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3]], bond_list = [[0, 1]], material = \"rock\", bonds = \"rock\" }}
groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
supports.left = {{ group = \"left\", fixed = true }}
supports.right = {{ group = \"right\", fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], velocity = {{ x = 0.05 }} }}
"
        )
    };
    for (failure, least) in [("", 0.02), (", fracture_energy = 20", 0.019)] {
        let file = bench.write("pulled.toml", scene(failure));
        let results: Value =
            serde_json::from_str(&bench.good(&file, &["--json", "--quiet"])).unwrap();
        assert_eq!(results["broken_bonds"], 1);
        let strain = results["largest_bond_strain"].as_f64().unwrap();
        // A step moves the end by 5e-8 m of 2e-3 m. What a damaged bond is opened by is no strain.
        assert!((least..0.0201).contains(&strain), "{failure}: {strain}");
    }
}

/// A pair with this damage on its bond, whose right end is loaded along x until it rests. Returns
/// the displacement of that end, m, and the utilisation.
fn loaded(bench: &Bench, damage: f64, force_n: f64, integrator: &str) -> [f64; 2] {
    let spheres = [[0.0, 0.0, 0.0, 1e-3], [2e-3, 0.0, 0.0, 1e-3]];
    let mut body = dem_io::Body::from_spheres(&spheres, &[[0, 1]]).unwrap();
    body.bond_damages = vec![damage];
    write_body(&body, &bench.path("pair.vtp")).unwrap();
    let file = bench.write(
        "loaded.toml",
        format!(
            "version = 1
run = {{ {integrator} }}
materials.rock = {{ density = 2500 }}
bonds.rock = {{ young_modulus = 1e8, poisson_ratio = 0.25, damping = {{ damping_ratio = 0.3 }}, failure = {{ tensile_strength = 1e5, compressive_strength = 4e5, fracture_energy = 2 }} }}
bodies.pair = {{ file = \"pair.vtp\", material = \"rock\", bonds = \"rock\" }}
groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
supports.left = {{ group = \"left\", fixed = true }}
supports.right = {{ group = \"right\", fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"] }}
loads.right = {{ group = \"right\", force = [{force_n:e}, 0, 0] }}
measures.moved = {{ of = \"right\", quantity = \"displacement_x\" }}
measures.used = {{ quantity = \"largest_utilisation\" }}
"
        ),
    );
    let results: Value = serde_json::from_str(&bench.good(&file, &["--json", "--quiet"])).unwrap();
    let measure = |name: &str| results["measures"][name]["value"].as_f64().unwrap();
    [measure("moved"), measure("used")]
}

/// Pulled, a damaged bond gives way by the stiffness that is left, pressed by that which it had;
/// its utilisation is that of its remaining strength, and of its full compressive one.
#[test]
fn a_damaged_bond_is_soft_in_tension_only() {
    let bench = Bench::new();
    let area_m2 = std::f64::consts::PI * 1e-6;
    let stiffness = 1e8 * area_m2 / 2e-3;
    let damage = 0.75;
    // w_c/w_e = 2 G_f E/(s^2 L).
    let ratio = 2.0 * 2.0 * 1e8 / (1e5 * 1e5 * 2e-3);
    let opened = ratio / (ratio - damage * (ratio - 1.0));
    let strength_n = 1e5 * area_m2;
    for integrator in [
        "end_time = 1, integrator = \"static\"",
        "end_time = \"2 ms\"",
    ] {
        let pull_n = 0.1 * strength_n;
        let [moved, used] = loaded(&bench, damage, pull_n, integrator);
        let wanted = pull_n / (0.25 * stiffness);
        assert!(
            (moved / wanted - 1.0).abs() < 1e-3,
            "{integrator}: {moved} {wanted}"
        );
        let wanted = 0.1 / 0.25 / opened;
        assert!(
            (used / wanted - 1.0).abs() < 2e-3,
            "{integrator}: {used} {wanted}"
        );
        let push_n = 2.0 * strength_n;
        let [moved, used] = loaded(&bench, damage, -push_n, integrator);
        let wanted = -push_n / stiffness;
        assert!(
            (moved / wanted - 1.0).abs() < 5e-3,
            "{integrator}: {moved} {wanted}"
        );
        assert!((used / 0.5 - 1.0).abs() < 5e-3, "{integrator}: {used}");
    }
}
