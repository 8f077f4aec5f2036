//! Bulk behaviour of scenes that a user runs, against laws that others have measured.

use super::{Bench, dem_pack, last_frame, root, scene_of_data, table};
use crate::helpers::mass_in_box_kg;
use dem_io::body::mass::of_named_density;
use dem_io::body::{read_body, read_particles};
use rayon::prelude::*;
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
    slope_of_line(&points)
}

/// Slope of the straight line through points, by least squares.
fn slope_of_line(points: &[[f64; 2]]) -> f64 {
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let squares: f64 = points.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    let products = points.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1]));
    products.sum::<f64>() / squares
}

/// Mass flow out of the silo of `silo.toml` through a hole of this width, kg/s, with 1,200 beads.
fn silo_flow_kg_s(hole_m: f64, seed: usize) -> f64 {
    let bench = Bench::new();
    let scene = scene_of_data("silo.toml");
    let settings = [
        format!("walls.floor.scale={}", hole_m * 100.0),
        format!("run.seed={seed}"),
        "inlets.fill.count=1200".to_owned(),
        "walls.slide.table=[[\"0.3 s\", 0], [\"0.35 s\", 1]]".to_owned(),
        "run.end_time=\"0.75 s\"".to_owned(),
    ];
    let mut options = vec!["--quiet", "--threads", "1", "--output", "out"];
    options.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    bench.good(&scene, &options);
    -slope(&bench, "mass_inside_kg", [0.45, 0.75])
}

#[test]
fn beads_leave_a_silo_as_beverloo_says() {
    // W = 0.58 rho sqrt(g) (D - k d)^(5/2) with k = 1.4 for spheres (Beverloo et al. 1961), for two
    // holes; the constants of the law are known to a tenth. It holds for the mean of several beds:
    // those of five seeds have 0.87 to 1.19 of it through 18 mm, and 0.85 to 0.96 through 22 mm.
    const SEEDS: usize = 3;
    for hole_m in [0.018, 0.022] {
        let flows = (0..SEEDS)
            .into_par_iter()
            .map(|seed| silo_flow_kg_s(hole_m, seed));
        let mean = flows.sum::<f64>() / SEEDS as f64;
        let density = 1550.0;
        let wanted = 0.58 * density * 9.81_f64.sqrt() * (hole_m - 1.4 * 0.004_f64).powf(2.5);
        assert!((mean / wanted - 1.0).abs() < 0.12, "{mean} {wanted}");
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

/// Diameter of the beads of a heap, m.
const BEAD_M: f64 = 4e-3;

/// A heap: the tangent of the measured angle of repose, the slope that [`flank`] finds, and the
/// length of that flank, m.
struct Heap {
    measured: f64,
    counted: f64,
    flank_m: f64,
}

/// The heap that a scene of data leaves.
fn heap(scene: &str, settings: &[&str]) -> Heap {
    let bench = Bench::new();
    let mut options = vec!["--quiet", "--json", "--threads", "1", "--output", "out"];
    options.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    let said = bench.good(&scene_of_data(scene), &options);
    let summary: Value = serde_json::from_str(&said).unwrap();
    let frame = read_particles(&last_frame(&bench.path("out"))).unwrap();
    assert_eq!(frame.radii, [BEAD_M / 2.0; 300]);
    let (counted, flank_m) = flank(&frame.positions);
    Heap {
        measured: value(&summary, "angle_of_repose").to_radians().tan(),
        counted,
        flank_m,
    }
}

/// The heap of 300 beads that run out of a lifted tube.
fn lifted(rolling_friction: f64) -> Heap {
    let [bead, plate] = ["bead", "plate"]
        .map(|on| format!("contacts.bead-{on}.rolling_friction={rolling_friction}"));
    let settings = [
        bead.as_str(),
        plate.as_str(),
        "inlets.fill.count=300",
        "inlets.fill.rate=\"2000 /s\"",
        "regions.gate.cylinder.radius=\"11 mm\"",
        "walls.tube.scale=3",
        "walls.tube.displacement=[0,0,\"25 mm\"]",
        "walls.tube.table=[[\"0.25 s\",0],[\"1 s\",1]]",
        "run.end_time=\"1.1 s\"",
        "output.pictures=10",
    ];
    heap("lifted-cylinder.toml", &settings)
}

/// The heap of 300 beads of the same material, dry, that are poured.
fn poured(rolling_friction: f64) -> Heap {
    let rolling = format!("contacts.glass-glass.rolling_friction={rolling_friction}");
    let settings = [
        rolling.as_str(),
        "contacts.glass-glass.friction=0.5",
        "contacts.glass-glass.restitution=0.4",
        "contacts.glass-glass.liquid_bridge.surface_tension=1e-9",
        "materials.glass.young_modulus=\"2 MPa\"",
        "bodies.bead.particles=[[0,0,0,\"2 mm\"]]",
        "inlets.pour.count=300",
        "inlets.pour.rate=\"400 /s\"",
        "inlets.pour.end=\"1 s\"",
        "run.end_time=\"1.2 s\"",
        "output.pictures=10",
    ];
    heap("wet-heap.toml", &settings)
}

/// Slope of a straight line through the surface of a heap of beads over the distance from its
/// middle, and the length of the flank, m. The surface is what a plumb line finds on a grid of a
/// quarter of a bead, averaged over rings as wide as a bead. The flank begins a bead from the
/// middle, where the tip is blunt, and ends where the beads cover less than a layer half as high as
/// they are.
fn flank(places: &[[f64; 3]]) -> (f64, f64) {
    const RINGS: usize = 40;
    let radius = BEAD_M / 2.0;
    let middle =
        [0, 1].map(|k| places.iter().map(|place| place[k]).sum::<f64>() / places.len() as f64);
    let mut rings = [[0.0; 2]; RINGS];
    let reach = 4 * RINGS as i32;
    for (i, j) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j))) {
        let across = [i, j].map(|k| f64::from(k) * BEAD_M / 4.0);
        let ring = (across[0].hypot(across[1]) / BEAD_M) as usize;
        if ring >= RINGS {
            continue;
        }
        let tops = places.iter().filter_map(|place| {
            let [x, y] = [0, 1].map(|k| place[k] - middle[k] - across[k]);
            let cap = radius * radius - x * x - y * y;
            (cap > 0.0).then(|| place[2] + cap.sqrt())
        });
        rings[ring][0] += tops.fold(0.0, f64::max);
        rings[ring][1] += 1.0;
    }
    let surface = rings.iter().enumerate().map(|(ring, [sum, count])| {
        let distance = (ring as f64 + 0.5) * BEAD_M;
        [distance, sum / count]
    });
    let flank: Vec<[f64; 2]> = surface
        .skip(1)
        .take_while(|[_, height]| *height >= radius)
        .collect();
    (-slope_of_line(&flank), (flank.len() - 1) as f64 * BEAD_M)
}

#[test]
fn heaps_of_rough_beads_are_steeper_lifted_or_poured() {
    let ways: [fn(f64) -> Heap; 2] = [lifted, poured];
    let runs: Vec<_> = [0.2, 0.05]
        .map(|rolling| ways.map(|way| (way, rolling)))
        .concat();
    let heaps: Vec<Heap> = runs
        .par_iter()
        .map(|(way, rolling)| way(*rolling))
        .collect();
    // A surface of beads is rough by half a bead: a slope along it is known to half a bead over its
    // length.
    let bound = |heap: &Heap| BEAD_M / 2.0 / heap.flank_m;
    for heap in &heaps {
        let Heap {
            measured,
            counted,
            flank_m,
        } = heap;
        assert!(*flank_m >= 4.0 * BEAD_M, "{flank_m}");
        assert!(
            (measured - counted).abs() < bound(heap),
            "{measured} {counted} {flank_m}"
        );
    }
    for ways in heaps.chunks(2) {
        let [lifted, poured] = [0, 1].map(|k| ways[k].measured);
        assert!(
            (lifted - poured).abs() < bound(&ways[0]),
            "{lifted} {poured}"
        );
    }
    let [rough, smooth] = [&heaps[..2], &heaps[2..]];
    for (rough, smooth) in rough.iter().zip(smooth) {
        let steeper = rough.measured - smooth.measured;
        assert!(
            steeper > 2.0 * bound(rough),
            "{} {}",
            rough.measured,
            smooth.measured
        );
    }
}
