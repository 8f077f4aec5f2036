//! Bonds of bodies with more or fewer spheres across than those they were calibrated in.

use serde_json::Value;

use super::{Bench, dem_pack, root, row, scene_of_data, vtp_bytes};

const ASKED: &str = "bonds.cake.size_correction=true";

/// Specimen modulus, Pa, of the bar of tension.toml with spheres of this mean diameter, mm, and its
/// spheres across; the grips hold 10 mm at each end, whatever the spheres. `more`: `--set` values.
fn modulus_pa(bench: &Bench, diameter_mm: f64, packing: &[&str], more: &[&str]) -> (f64, f64) {
    let file = bench.path("bar.vtp");
    let diameters = format!(
        "{}mm..{}mm",
        diameter_mm * 5.0 / 6.0,
        diameter_mm * 7.0 / 6.0
    );
    let options = [&["--diameter", diameters.as_str()], packing].concat();
    dem_pack(&root().join("data/shapes/bar.stl"), &options, &file);
    let sets = [
        "run.integrator=static",
        "groups.lower-grip.box.max=[\"1 m\",\"1 m\",\"10 mm\"]",
        "groups.upper-grip.box.min=[\"-1 m\",\"-1 m\",\"50 mm\"]",
    ];
    let sets = sets.iter().chain(more).flat_map(|set| ["--set", set]);
    let named = ["--json", "--quiet", "--force", "--body", "bar=bar.vtp"].into_iter();
    let options: Vec<&str> = named.chain(sets).collect();
    let said = bench.good(&scene_of_data("tension.toml"), &options);
    let summary: Value = serde_json::from_str(&said).unwrap();
    let results = summary["test"]["results"].as_array().unwrap();
    let found = results.iter().find(|one| one["name"] == "specimen modulus");
    let packed = dem_io::body::read_body(&file).unwrap();
    let across = packed.about.particles_across.unwrap();
    (found.unwrap()["value"].as_f64().unwrap(), across)
}

/// Bars of five and seven spheres across are up to 15 % softer than one of ten with the same bonds,
/// in both ways to pack that the pages use, and as stiff within 2 % with the correction.
#[test]
fn bars_of_any_size_are_as_stiff_as_the_calibrated_one() {
    let bench = Bench::new();
    let ways = [["0.296", "1.0"], ["0.25", "1.1"]];
    for [overlap, range] in ways {
        let packing = ["--overlap", overlap, "--bond-range", range];
        let (wanted_pa, calibrated) = modulus_pa(&bench, 3.0, &packing, &[]);
        let across = format!("bonds.cake.calibrated_across={calibrated}");
        for (diameter_mm, softer) in [(6.0, 0.11), (4.286, 0.05)] {
            let off =
                |more: &[&str]| modulus_pa(&bench, diameter_mm, &packing, more).0 / wanted_pa - 1.0;
            let plain = off(&[&across]);
            assert!(plain < -softer, "{overlap}, {diameter_mm} mm: {plain}");
            let corrected = off(&[&across, ASKED]);
            assert!(
                corrected.abs() < 0.02,
                "{overlap}, {diameter_mm} mm: {corrected}"
            );
        }
    }
}

/// A body that does not say how many spheres it has across, or has too few, has no correction.
#[test]
fn it_needs_spheres_across() {
    let bench = Bench::new();
    let scene = bench.write(
        "scene.toml",
        "version = 1
run.end_time = \"1 ms\"
materials.cake.density = 2050
[bonds.cake]
young_modulus = \"12 MPa\"
poisson_ratio = 0.3
calibrated_across = 8
size_correction = true
[bodies.row]
file = \"row.vtp\"
material = \"cake\"
bonds = \"cake\"
",
    );
    let mut body = row(5);
    body.about.program = Some("dem-pack 0.1.0".to_owned());
    let mut refused = |across: Option<f64>, wanted: &str| {
        body.about.particles_across = across;
        body.about.thinnest_part_m = across.map(|_| 9.8e-3);
        bench.write("row.vtp", vtp_bytes(&body));
        let said = bench.bad(&scene, &[], 2);
        assert!(said.contains(wanted), "{said}");
    };
    refused(
        None,
        "[bodies.row]: its bonds have size_correction, and its file does not say how many spheres it has across; make it with dem-pack",
    );
    refused(
        Some(2.9),
        "which holds from 3 spheres across on, and it has 2.9; take smaller spheres",
    );
}
