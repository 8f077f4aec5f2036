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

/// The fall that breaks the body in two.
const LAST: usize = 7;

/// The mass fraction of the largest fragment after each fall of the largest fragment of the fall
/// before; `mended`: its damage is taken away in between.
fn falls(bench: &Bench, mended: bool) -> Vec<f64> {
    let mut largest = Vec::new();
    let mut last = String::new();
    for number in 1..=LAST {
        let folder = format!("drop-{mended}-{number}");
        let body = ["--body", &last];
        let results = fall(bench, if number == 1 { &[] } else { &body }, &folder);
        largest.push(results["measures"]["largest"]["value"].as_f64().unwrap());
        assert!(results["damaged_bonds"].as_u64().unwrap() > 0);
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
    largest
}

#[test]
fn a_body_that_is_dropped_again_and_again_breaks_at_last() {
    let bench = Bench::new();
    let damaged = falls(&bench, false);
    let before = &damaged[..LAST - 1];
    assert!(before.iter().all(|largest| *largest > 0.98), "{damaged:?}");
    assert!(damaged[LAST - 1] < 0.7, "{damaged:?}");
    // As often, but with its bonds mended before each fall, it stays in one piece but for crumbs.
    let mended = falls(&bench, true);
    assert!(mended.iter().all(|largest| *largest > 0.98), "{mended:?}");
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
