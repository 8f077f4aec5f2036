//! Frames, measures and time series at known strain rates: a row of three spheres of which each
//! bond is pulled at its own rate, in closed form; and the numbers of what is in a scene.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{Bench, good, names_in, numbers, table};

/// Young's modulus over tensile strength of the bonds.
const PER_STRENGTH: f64 = 1e3;

/// Three spheres in a row, 2 mm apart. The first bond is pulled at 10/s, the second at 1/s; a
/// fourth and a fifth sphere have a bond without strengthening, pulled at 10/s.
const ROW: &str = r#"version = 1
[run]
end_time = "10 us"
time_step = "0.1 us"
[materials.cake]
density = 2500
[bonds.cake]
young_modulus = 1e9
poisson_ratio = 0.25
failure = { tensile_strength = 1e6, rate_strengthening = "0.05 /s" }
[bonds.static]
young_modulus = 1e9
poisson_ratio = 0.25
failure = { tensile_strength = 1e6 }
[bodies.row]
material = "cake"
bonds = "cake"
particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3], [4e-3, 0, 0, 1e-3]]
bond_list = [[0, 1], [1, 2]]
[bodies.static]
material = "cake"
bonds = "static"
particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3]]
bond_list = [[0, 1]]
position = [0, 0.1, 0]
[groups.first]
body = "row"
particles = [0]
[groups.second]
body = "row"
particles = [1]
[groups.third]
body = "row"
particles = [2]
[groups.held]
body = "static"
particles = [0]
[groups.pulled]
body = "static"
particles = [1]
[supports]
first = { group = "first", fixed = true }
held = { group = "held", fixed = true }
second = { group = "second", fixed = ["y", "z", "rx", "ry", "rz"], velocity = { x = 0.02 } }
third = { group = "third", fixed = ["y", "z", "rx", "ry", "rz"], velocity = { x = 0.022 } }
pulled = { group = "pulled", fixed = ["y", "z", "rx", "ry", "rz"], velocity = { x = 0.02 } }
[measures]
rate = { of = "row", quantity = "largest_strain_rate" }
rate_of_third = { of = "third", quantity = "largest_strain_rate" }
factor = { of = "row", quantity = "largest_dynamic_increase_factor" }
factor_of_static = { of = "static", quantity = "largest_dynamic_increase_factor" }
used = { of = "row", quantity = "largest_dynamic_utilisation" }
used_static = { of = "static", quantity = "largest_dynamic_utilisation" }
calm = { of = "row", quantity = "fraction_below_dynamic_utilisation", limit = 0.01 }
all_calm = { of = "row", quantity = "fraction_below_dynamic_utilisation", limit = 0.5 }
[output]
series = "1 us"
"#;

/// An array of numbers of a frame.
fn array(frame: &Path, name: &str) -> Option<Vec<f64>> {
    let bytes = fs::read(frame).unwrap();
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap();
    let header = std::str::from_utf8(&bytes[..at]).unwrap();
    let (_, tag) = header.split_once(&format!("Name=\"{name}\""))?;
    let tag = tag.split_once('>').unwrap().0;
    let (_, offset) = tag.split_once("offset=\"").unwrap();
    let offset: usize = offset.split_once('"').unwrap().0.parse().unwrap();
    let data = &bytes[at + mark.len() + offset..];
    let length = u64::from_le_bytes(data[..8].try_into().unwrap()) as usize;
    let numbers = data[8..8 + length].chunks_exact(8);
    Some(
        numbers
            .map(|number| f64::from_le_bytes(number.try_into().unwrap()))
            .collect(),
    )
}

fn last_frame(bench: &Bench) -> std::path::PathBuf {
    let names = names_in(&bench.path("out/frames"));
    bench.path("out/frames").join(&names[names.len() - 1])
}

fn assert_near(found: &[f64], wanted: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), wanted.len(), "{what}");
    for (found, wanted) in found.iter().zip(wanted) {
        let scale = wanted.abs().max(1e-3);
        assert!(
            (found - wanted).abs() <= tolerance * scale,
            "{what}: {found} instead of {wanted}"
        );
    }
}

/// Runs the row with these settings. Returns the last frame, and the time of it, s.
fn pulled(bench: &Bench, settings: &[&str]) -> (std::path::PathBuf, f64) {
    let scene = bench.write("row.toml", ROW);
    let settings = settings.iter().flat_map(|setting| ["--set", setting]);
    let options: Vec<&str> = settings.chain(["--output", "out", "--force"]).collect();
    let output = bench.run(&scene, &options);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let times = numbers(&bench.path("out/series.csv"), "time_s");
    (last_frame(bench), times[times.len() - 1])
}

fn dynamic_arrays(frame: &Path) -> [Vec<f64>; 3] {
    [
        "strain_rate_1_s",
        "dynamic_increase_factor",
        "dynamic_utilisation",
    ]
    .map(|name| array(frame, name).unwrap())
}

/// Factors computed by hand from Platzer 2022, eq. 20, with its parentheses.
#[test]
fn bonds_of_a_frame_have_rate_factor_and_dynamic_utilisation() {
    let bench = Bench::new();
    for (rate_1_s, factor) in [
        (0.099_999, 1.097_499),
        (1.1, 1.652_375),
        (10.0, 3.5675),
        (50.0, 5.812_589),
        (80.0, 5.812_589),
        (0.04, 1.0),
        (-10.0, 1.0),
    ] {
        // Strains of a ten-thousandth at most, in a hundred steps.
        let end_s = 1e-4 / f64::abs(rate_1_s).max(1.0);
        let velocity_m_s = 2e-3 * rate_1_s;
        let (frame, time_s) = pulled(
            &bench,
            &[
                &format!("run.end_time={end_s:e}"),
                &format!("run.time_step={:e}", 0.01 * end_s),
                &format!("output.series={end_s:e}"),
                &format!("supports.second.velocity.x={velocity_m_s:e}"),
                &format!("supports.third.velocity.x={:e}", velocity_m_s + 2e-3),
                &format!("supports.pulled.velocity.x={velocity_m_s:e}"),
            ],
        );
        let strains = [rate_1_s, 1.0, rate_1_s].map(|rate| rate * time_s);
        let used = strains.map(|strain| PER_STRENGTH * strain.max(0.0));
        let utilisation = array(&frame, "utilisation").unwrap();
        assert_near(&utilisation, &used, 1e-6, "utilisation");
        let factors = [factor, 1.6, 1.0];
        let [rate, increase, dynamic] = dynamic_arrays(&frame);
        assert_near(&rate, &[rate_1_s, 1.0, rate_1_s], 1e-9, "rate");
        assert_near(
            &increase,
            &factors,
            1e-6,
            &format!("factor at {rate_1_s}/s"),
        );
        let wanted = [0, 1, 2].map(|k| used[k] / factors[k]);
        assert_near(&dynamic, &wanted, 2e-6, "dynamic utilisation");
    }
}

/// Pulled across, a bond has no rate of elongation but one by eq. 21 as printed.
#[test]
fn the_rate_is_that_of_the_measure_of_the_bond() {
    let across = [
        "supports.third.fixed=[\"x\", \"z\", \"rx\", \"ry\", \"rz\"]",
        "supports.third.velocity={ y = 0.02 }",
        "supports.second.velocity.x=0",
    ];
    let bench = Bench::new();
    let (frame, time_s) = pulled(&bench, &across);
    // 10 rad/s times the angle of the bond.
    let turning_1_s = 100.0 * time_s;
    let [rate, increase, _] = dynamic_arrays(&frame);
    assert_near(&rate[1..2], &[turning_1_s], 1e-6, "elongation");
    assert_eq!(increase[1], 1.0);
    let by = "bonds.cake.failure.strain_rate_measure=\"relative-velocity\"";
    let (frame, _) = pulled(&bench, &[&across[..], &[by]].concat());
    let [rate, increase, _] = dynamic_arrays(&frame);
    assert_near(&rate[1..2], &[10.0], 1e-9, "relative velocity");
    assert_near(&increase[1..2], &[3.5675], 1e-9, "its factor");
}

#[test]
fn without_rate_strengthening_frames_have_none_of_it() {
    let bench = Bench::new();
    let off = "bonds.cake.failure.rate_strengthening=false";
    let (frame, _) = pulled(&bench, &[off]);
    for name in [
        "strain_rate_1_s",
        "dynamic_increase_factor",
        "dynamic_utilisation",
    ] {
        assert_eq!(array(&frame, name), None, "{name}");
    }
    assert!(array(&frame, "utilisation").is_some());
}

#[test]
fn measures_have_the_largest_and_the_fraction_below() {
    let bench = Bench::new();
    let (_, time_s) = pulled(&bench, &[]);
    let summary = fs::read(bench.path("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    let value = |name: &str| summary["measures"][name]["value"].as_f64().unwrap();
    assert_eq!(summary["measures"]["rate"]["unit"], "1/s");
    let used = 10.0 * time_s * PER_STRENGTH;
    for (name, wanted) in [
        ("rate", 10.0),
        ("rate_of_third", 1.0),
        ("factor", 3.5675),
        ("factor_of_static", 1.0),
        ("used", used / 3.5675),
        ("used_static", used),
        // The second bond uses 0.1 * used / 1.6 = 0.006 of its strength.
        ("calm", 0.5),
        ("all_calm", 1.0),
    ] {
        assert_near(&[value(name)], &[wanted], 1e-6, name);
    }
    // The same in the time series.
    let rates = numbers(&bench.path("out/series.csv"), "rate_1_s");
    assert_eq!(rates.len(), 11);
    assert_near(&rates[1..], &[10.0; 10], 1e-9, "rate");
}

/// The first bond breaks at 3.5675 times its strength: 1 us, plus a part of a step, per 0.01 of it.
#[test]
fn after_a_break_masses_of_fragments_and_numbers_of_bonds_are_new() {
    let bench = Bench::new();
    let (frame, _) = pulled(
        &bench,
        &[
            "run.end_time=400 us",
            "run.time_step=1 us",
            "output.series=1 us",
        ],
    );
    let sphere_kg = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    let masses = |frame: &Path| array(frame, "fragment_mass_kg").unwrap();
    let in_spheres =
        |frame: &Path| -> Vec<f64> { masses(frame).iter().map(|kg| kg / sphere_kg).collect() };
    let first = bench.path("out/frames/frame_000000.vtp");
    assert_near(
        &in_spheres(&first),
        &[3.0, 3.0, 3.0, 2.0, 2.0],
        1e-12,
        "whole",
    );
    assert_near(
        &in_spheres(&frame),
        &[1.0, 2.0, 2.0, 1.0, 1.0],
        1e-12,
        "broken",
    );
    let [rate, increase, dynamic] = dynamic_arrays(&frame);
    assert_near(&rate, &[0.0, 1.0, 0.0], 1e-9, "rate");
    assert_near(&increase, &[1.0, 1.6, 1.0], 1e-9, "factor");
    assert_eq!((dynamic[0], dynamic[2]), (0.0, 0.0));

    let series = bench.path("out/series.csv");
    let [times, intact, broken, used] =
        ["time_s", "intact_bonds", "broken_bonds", "used"].map(|name| numbers(&series, name));
    // The bond without strengthening breaks at 100 us, the first one at 356.75 us.
    for (row, time_s) in times.iter().enumerate() {
        let wanted = if *time_s < 99.5e-6 {
            3.0
        } else if (101.5e-6..356.5e-6).contains(time_s) {
            2.0
        } else if *time_s > 358.5e-6 {
            1.0
        } else {
            continue;
        };
        assert_eq!(intact[row], wanted, "{time_s}");
        assert_eq!(broken[row], 3.0 - wanted);
    }
    assert!(
        numbers(&series, "particles")
            .iter()
            .all(|count| *count == 5.0)
    );
    assert!(numbers(&series, "clumps").iter().all(|count| *count == 0.0));
    // An intact bond is below its dynamic strength, and just before the break close to it.
    let largest = used.iter().copied().fold(0.0, f64::max);
    assert!((0.996..1.0).contains(&largest), "{largest}");
}

/// A measure of a body of which no bond is left says so.
#[test]
fn without_intact_bonds_there_is_no_rate_and_no_fraction() {
    let bench = Bench::new();
    pulled(
        &bench,
        &[
            "run.end_time=150 us",
            "run.time_step=1 us",
            "measures.calm.of=\"static\"",
        ],
    );
    let summary = fs::read(bench.path("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    assert_eq!(summary["measures"]["calm"]["value"], Value::Null);
    assert_eq!(
        summary["measures"]["calm"]["missing"],
        "calm has no value: \"static\" has no intact bond"
    );
}

/// A cube of 27 spheres that flies as a clump, of which the inner sphere is left out, becomes a
/// cluster with 54 bonds, and leaves.
#[test]
fn numbers_follow_replacement_and_outlet() {
    let bench = Bench::new();
    let (mut particles, mut bonds) = (String::new(), String::new());
    for n in 0..27_u32 {
        let [x, y, z] = [n % 3, n / 3 % 3, n / 9];
        particles += &format!("[{x}e-3, {y}e-3, {z}e-3, 0.5e-3],");
        for (next, step) in [(x, 1), (y, 3), (z, 9)] {
            if next < 2 {
                bonds += &format!("[{n}, {}],", n + step);
            }
        }
    }
    let scene = bench.write(
        "cube.toml",
        format!(
            "version = 1\nrun.end_time = 2e-3\nrun.time_step = 1e-7\n\
             materials.cake = {{ density = 2500, young_modulus = 1e7, poisson_ratio = 0.25 }}\n\
             contacts.cake-cake = {{ restitution = 0.5 }}\n\
             bonds.cake = {{ young_modulus = 1e9, poisson_ratio = 0.25 }}\n\
             [bodies.cube]\nmaterial = \"cake\"\nbonds = \"cake\"\nstart_as = \"clump\"\n\
             velocity = [1, 0, 0]\nparticles = [{particles}]\nbond_list = [{bonds}]\n\
             [regions.gone]\nbox = {{ min = [2e-3, -1, -1], max = [1, 1, 1] }}\n\
             [replacement.cube]\nwhen = {{ time = 5e-4 }}\n\
             [outlets.out]\ninside = \"gone\"\n\
             [output]\nseries = 1e-5\nframes = 1e-4\n"
        ),
    );
    let output = bench.run(&scene, &["--output", "out"]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let (columns, rows) = table(&bench.path("out/series.csv"));
    let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let places = ["time_s", "particles", "intact_bonds", "clumps"].map(at);
    let mut seen = [0; 3];
    for row in rows {
        let [time_s, particles, bonds, clumps] =
            places.map(|place| row[place].parse::<f64>().unwrap());
        // The centre starts at 1 mm; the outlet looks every 50 steps.
        let (stage, wanted) = if time_s < 4.99e-4 {
            (0, [26.0, 0.0, 1.0])
        } else if (5.02e-4..9.9e-4).contains(&time_s) {
            (1, [27.0, 54.0, 0.0])
        } else if time_s > 1.02e-3 {
            (2, [0.0, 0.0, 0.0])
        } else {
            continue;
        };
        assert_eq!([particles, bonds, clumps], wanted, "{time_s}");
        seen[stage] += 1;
    }
    assert!(seen.iter().all(|count| *count > 40), "{seen:?}");
    // All spheres of the clump have the mass of all 27, as has the cluster.
    let cube_kg = 27.0 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125e-9;
    for (name, count) in [("frame_000002.vtp", 26), ("frame_000007.vtp", 27)] {
        let masses = array(&bench.path("out/frames").join(name), "fragment_mass_kg").unwrap();
        assert_near(&masses, &vec![cube_kg; count], 1e-12, name);
    }
}

/// Rates and strengths are those of the failure check, so that only bonds that break reach 1: at a
/// step near the limit, where velocities change much within a step, and in the steps in which bonds
/// break, which give their ends a kick after the check.
#[test]
fn intact_bonds_are_below_their_dynamic_strength() {
    let bench = Bench::new();
    let settings = [
        "run.safety_factor=0.9",
        "output.series=1e-7",
        "measures.used={ quantity = \"largest_dynamic_utilisation\" }",
        "bonds.cake.damping.damping_ratio=0",
        "bonds.cake.failure.strain_rate_measure=\"relative-velocity\"",
    ];
    for count in [3, 5] {
        let settings = settings[..count].iter().flat_map(|set| ["--set", set]);
        let options: Vec<&str> = settings.chain(["--output", "out", "--force"]).collect();
        bench.good(&good("breaking.toml"), &options);
        let series = bench.path("out/series.csv");
        let broken = numbers(&series, "broken_bonds");
        assert!(broken[broken.len() - 1] >= 4.0);
        let used = numbers(&series, "used");
        let largest = used.iter().copied().fold(0.0, f64::max);
        assert!((0.95..1.0).contains(&largest), "{largest}");
    }
}

#[test]
#[cfg(unix)]
fn a_continued_run_has_the_same_frames_series_and_pictures() {
    use super::assert_same;
    use super::interrupted::interrupt;
    let settings = [
        "run.safety_factor=0.02",
        "output.pictures=0.5 ms",
        "output.colour_by=\"dynamic_utilisation\"",
        "measures.used={ quantity = \"largest_dynamic_utilisation\", statistic = \"largest\" }",
    ];
    let options: Vec<&str> = settings.iter().flat_map(|set| ["--set", set]).collect();
    let bench = Bench::new();
    let scene = good("breaking.toml");
    bench.good(&scene, &[&options[..], &["--output", "whole"]].concat());
    let part = [&options[..], &["--output", "part"]].concat();
    let command = bench.command(&scene, &part);
    interrupt(command, "-INT", &bench.path("part"), 300).unwrap();
    bench.good(&scene, &[&part[..], &["--resume"]].concat());
    assert_same(&bench.path("whole"), &bench.path("part"));
}
