//! A body by filling a mould and pressing (Platzer 2022, 3.2.1): the density is met, and the
//! spheres become a body that a scene loads and breaks.

use super::{Bench, dem_run, last_frame, scene_of_data};
use crate::helpers::{mass_in_box_kg, mass_within_kg};
use clap::Parser;
use dem_io::Body;
use dem_io::body::{body_summary, read_body, read_particles, write_body};
use dem_pack::cli::Arguments;
use dem_pack::{BondSettings, bond_spheres};
use serde_json::Value;

/// Half of the bar's width and its height, m.
const BODY_M: [f64; 2] = [15e-3, 60e-3];

/// The scene with spheres twice as large.
fn pressed() -> Bench {
    let bench = Bench::new();
    let radii_mm = [("a", 3.0), ("b", 3.25), ("c", 3.5), ("d", 3.75), ("e", 4.0)];
    let mut set: Vec<String> = radii_mm
        .map(|(name, r)| format!("bodies.{name}.particles=[[0,0,0,\"{r} mm\"]]"))
        .into();
    let more = [
        "inlets.fill.count=237",
        "inlets.fill.rate=800",
        "output.pictures=10",
    ];
    set.extend(more.map(str::to_owned));
    let mut options = vec!["--quiet", "--output", "out"];
    options.extend(set.iter().flat_map(|set| ["--set", set]));
    bench.good(&scene_of_data("press-mould.toml"), &options);
    bench
}

/// The loose spheres of the last frame of a run in `out`, and what the program says of them.
fn loose_spheres(bench: &Bench) -> (Body, String) {
    let output = dem_run()
        .current_dir(bench.path(""))
        .args(["fragment", "out", "--loose", "-o", "spheres.vtp"])
        .output()
        .unwrap();
    assert!(output.status.success() && output.stderr.is_empty());
    let said = String::from_utf8(output.stdout).unwrap();
    (read_body(&bench.path("spheres.vtp")).unwrap(), said)
}

#[test]
fn a_mould_is_pressed_to_a_density_and_its_body_breaks() {
    let bench = pressed();
    let summary = std::fs::read(bench.path("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    assert_eq!(summary["ended_by"], "measure");
    let found = summary["measures"]["solid_density"]["value"]
        .as_f64()
        .unwrap();
    // The plunger moves 0.1 mm between two rows.
    assert!((1650.0..1650.0 * 1.003).contains(&found), "{found}");

    let (spheres, said) = loose_spheres(&bench);
    assert!(said.contains("237 of 237 particles, 0.09027 kg"), "{said}");
    assert_eq!(spheres.about.particle_density_kg_m3, Some(2050.0));
    let last = last_frame(&bench.path("out"));
    let frame = read_particles(&last).unwrap();
    assert!(spheres.positions == frame.positions && spheres.radii == frame.radii);
    // The density, counted by fine steps over the volume of each sphere.
    let [half_m, height_m] = BODY_M;
    let body_box = [[-half_m, -half_m, 0.0], [half_m, half_m, height_m]];
    let mass_kg = mass_in_box_kg(&spheres, 2050.0, body_box);
    let counted = mass_kg / (4.0 * half_m * half_m * height_m);
    assert!((counted / found - 1.0).abs() < 2e-3, "{counted} {found}");

    // dem-pack takes the frame as well.
    let (frame, direct) = (last.display().to_string(), bench.path("direct.vtp"));
    let words = [
        "dem-pack",
        "bond",
        &frame,
        "--quiet",
        "-o",
        &direct.display().to_string(),
    ];
    dem_pack::cli::run(&Arguments::try_parse_from(words).unwrap()).unwrap();
    let direct = read_body(&direct).unwrap();

    let (body, quality) = bond_spheres(&spheres, &BondSettings::default()).unwrap();
    assert!(quality.fabric.is_some());
    assert!(direct.bonds == body.bonds && direct.bond_lengths == body.bond_lengths);
    assert_eq!(body_summary(&body).pieces, 1);
    write_body(&body, &bench.path("pressed.vtp")).unwrap();
    let broken = bench.write("drop.toml", DROP);
    let said = bench.good(&broken, &["--json", "--quiet"]);
    let summary: Value = serde_json::from_str(&said).unwrap();
    let value = |name: &str| summary["measures"][name]["value"].as_f64().unwrap();
    assert_eq!(value("at_start"), 0.0);
    assert!(value("broken") > 0.2 * body.bonds.len() as f64, "{summary}");
}

/// A mould that is an STL surface, open at the top: no sphere leaves through its wall, the density
/// in the cylinder is that of a count by fine steps, and the spheres become one bonded body.
#[test]
fn a_mould_of_an_stl_surface_is_filled_and_pressed() {
    const RADIUS_M: f64 = 15e-3;
    const HEIGHT_M: f64 = 30e-3;
    let bench = Bench::new();
    let options = ["--json", "--quiet", "--output", "out"];
    let said = bench.good(&scene_of_data("press-tube.toml"), &options);
    let summary: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(summary["ended_by"], "measure");
    let found = summary["measures"]["solid_density"]["value"]
        .as_f64()
        .unwrap();
    assert!((1650.0..1650.0 * 1.005).contains(&found), "{found}");
    let (spheres, _) = loose_spheres(&bench);
    assert_eq!(spheres.radii.len(), 360);
    let from_axis_m = |p: [f64; 3]| p[0].hypot(p[1]);
    for (p, radius_m) in spheres.positions.iter().zip(&spheres.radii) {
        let stands_out_m = from_axis_m(*p) + radius_m - RADIUS_M;
        assert!(stands_out_m < 0.4 * radius_m, "{p:?} {radius_m}");
        assert!(p[2] > 0.5 * radius_m, "{p:?} {radius_m}");
    }
    let mass_kg = mass_within_kg(&spheres, 2050.0, |p| {
        from_axis_m(p) < RADIUS_M && (0.0..HEIGHT_M).contains(&p[2])
    });
    let counted = mass_kg / (std::f64::consts::PI * RADIUS_M * RADIUS_M * HEIGHT_M);
    assert!((counted / found - 1.0).abs() < 2e-3, "{counted} {found}");
    let (body, _) = bond_spheres(&spheres, &BondSettings::default()).unwrap();
    assert_eq!(body_summary(&body).pieces, 1);
}

/// The body at rest on its bonds, which then strikes a plate.
const DROP: &str = r#"version = 1
[run]
end_time = "5 ms"
[materials.cake]
density = "2050 kg/m3"
shear_modulus = "2 MPa"
[contacts]
cake-cake = { restitution = 0.3, friction = 0.3 }
[bonds.cake]
young_modulus = "5 MPa"
poisson_ratio = 0.3
failure = { tensile_strength = "20 kPa", shear_strength = "20 kPa" }
[bodies.bar]
file = "pressed.vtp"
material = "cake"
bonds = "cake"
velocity = [0, 0, "-5 m/s"]
[walls.plate]
plane = { point = [0, 0, "-1.5 mm"], normal = [0, 0, 1] }
material = "cake"
[measures.at_start]
of = "bar"
quantity = "elastic_energy"
statistic = "smallest"
[measures.broken]
of = "bar"
quantity = "broken_bonds"
"#;
