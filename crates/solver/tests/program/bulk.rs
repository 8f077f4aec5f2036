//! Bulk behaviour of scenes that a user runs, against laws that others have measured.

use super::{Bench, dem_pack, last_frame, root, scene_of_data, table};
use crate::helpers::mass_in_box_kg;
use dem_io::body::mass::of_named_density;
use dem_io::body::{read_body, read_particles};
use serde_json::Value;

/// Slope of a straight line through the values of a column of `series.csv` between two times.
fn slope(bench: &Bench, column: &str, [from, to]: [f64; 2]) -> f64 {
    let (columns, rows) = table(&bench.path("out/series.csv"));
    let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let (time, value) = (at("time_s"), at(column));
    let points: Vec<[f64; 2]> = (rows.iter())
        .map(|row| [time, value].map(|k| row[k].parse().unwrap()))
        .filter(|[t, _]: &[f64; 2]| (from..to).contains(t))
        .collect();
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let squares: f64 = points.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    let products = points.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1]));
    products.sum::<f64>() / squares
}

#[test]
fn beads_leave_a_silo_as_beverloo_says() {
    // W = 0.58 rho sqrt(g) (D - k d)^(5/2) with k = 1.4 for spheres (Beverloo et al. 1961), for two
    // holes; the constants of the law are known to a tenth.
    for hole_m in [0.018, 0.022] {
        let bench = Bench::new();
        let scale = format!("walls.floor.scale={}", hole_m * 100.0);
        let scene = scene_of_data("silo.toml");
        let settings = [
            scale.as_str(),
            "inlets.fill.count=1200",
            "walls.slide.table=[[\"0.3 s\", 0], [\"0.35 s\", 1]]",
            "run.end_time=\"0.75 s\"",
        ];
        let mut options = vec!["--quiet", "--output", "out"];
        options.extend(settings.iter().flat_map(|setting| ["--set", setting]));
        bench.good(&scene, &options);
        let found = -slope(&bench, "mass_inside_kg", [0.45, 0.75]);
        let density = 1550.0;
        let wanted = 0.58 * density * 9.81_f64.sqrt() * (hole_m - 1.4 * 0.004_f64).powf(2.5);
        assert!((found / wanted - 1.0).abs() < 0.12, "{found} {wanted}");
    }
}

/// `--set` for a box of this half width and a bed in it, mm, for the scenes of a box.
fn small_box(half_mm: f64, bed_mm: [f64; 3]) -> Vec<String> {
    let [half_bed, low, high] = bed_mm;
    let wall = |name: &str, place: [f64; 2]| {
        let [x, y] = place;
        format!("walls.{name}.plane.point=[\"{x} mm\",\"{y} mm\",0]")
    };
    vec![
        wall("left", [-half_mm, 0.0]),
        wall("right", [half_mm, 0.0]),
        wall("front", [0.0, -half_mm]),
        wall("back", [0.0, half_mm]),
        format!("regions.bed.box.min=[\"-{half_bed} mm\",\"-{half_bed} mm\",\"{low} mm\"]"),
        format!("regions.bed.box.max=[\"{half_bed} mm\",\"{half_bed} mm\",\"{high} mm\"]"),
        "output.pictures=10".to_owned(),
    ]
}

fn value(summary: &Value, measure: &str) -> f64 {
    summary["measures"][measure]["value"].as_f64().unwrap()
}

#[test]
fn a_poured_density_gives_particle_density_and_overlap_and_comes_back_by_shattering() {
    // The route of Platzer 2022 (3.1.1, 4.5.1.6) for a material that weighs 1200 kg/m3 when poured
    // and 1800 kg/m3 as a solid, with 900 spheres.
    let [bulk, solid] = [1200.0, 1800.0];
    let bench = Bench::new();
    let bed = small_box(20.0, [15.0, 6.0, 26.0]);
    let run = |scene: &str, more: &[String]| -> Value {
        let mut options = vec!["--quiet", "--json", "--force", "--output", "out"];
        let set = bed.iter().chain(more).flat_map(|set| ["--set", set]);
        options.extend(set);
        serde_json::from_str(&bench.good(&scene_of_data(scene), &options)).unwrap()
    };
    let poured = run("pour-box.toml", &["inlets.pour.count=900".to_owned()]);
    let particle = 2050.0 * bulk / value(&poured, "bulk_density");

    let stl = root().join("data/shapes/bar.stl");
    let file = bench.path("bar.vtp");
    let densities = [particle, solid].map(|density| density.to_string());
    let mut options = vec!["--scale", "0.84", "-d", "3.5mm..5mm", "--bond-range", "1.0"];
    options.extend([
        "--particle-density",
        &densities[0],
        "--solid-density",
        &densities[1],
    ]);
    dem_pack(&stl, &options, &file);
    let body = read_body(&file).unwrap();
    let mass = of_named_density(&body).unwrap();
    let found = mass.solid_density_kg_m3.unwrap();
    assert!((found / solid - 1.0).abs() < 2e-3, "{found}");

    let shattered = run(
        "shatter-box.toml",
        &[
            format!("materials.cake.density={particle}"),
            format!("bodies.bar.file=\"{}\"", file.display()),
        ],
    );
    let back = value(&shattered, "bulk_density");
    assert!((back / bulk - 1.0).abs() < 0.02, "{back}");

    // All of it is still there; the bulking factor follows from the mass in the region, counted
    // without the program.
    let last = last_frame(&bench.path("out"));
    let frame = read_particles(&last).unwrap();
    let spheres = frame.loose_spheres().unwrap();
    assert_eq!(spheres.radii.len(), body.radii.len());
    let kept = of_named_density(&spheres).unwrap().mass_kg;
    // The density of a frame is read with 12 digits.
    assert!(
        (kept / mass.mass_kg - 1.0).abs() < 5e-12,
        "{kept} {}",
        mass.mass_kg
    );
    let corners = [[-15e-3, -15e-3, 6e-3], [15e-3, 15e-3, 26e-3]];
    let counted = found * 0.03 * 0.03 * 0.02 / mass_in_box_kg(&spheres, particle, corners);
    let factor = value(&shattered, "bulking_factor");
    assert!((factor / counted - 1.0).abs() < 2e-3, "{factor} {counted}");
    assert!((factor * back / found - 1.0).abs() < 1e-12);
}

#[test]
fn bulking_needs_a_body_with_a_shape() {
    let bench = Bench::new();
    let scene = std::fs::read_to_string(scene_of_data("pour-box.toml")).unwrap();
    let measure = "[measures.factor]\nof = \"a\"\nquantity = \"bulking_factor\"\n";
    let scene = bench.write("scene.toml", format!("{scene}\n{measure}"));
    let said = bench.bad(&scene, &[], 2);
    assert!(
        said.contains("[measures.factor]: \"a\" is no body with a shape of known volume"),
        "{said}"
    );
}
