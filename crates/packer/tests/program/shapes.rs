//! Every difficult shape that can be packed: the right solid, filled, exact.

use super::{Bench, Made, bits, read_stl, refusal, root, shape};
use crate::helpers::exact::{assert_exact, length, sub};
use std::f64::consts::PI;

const OPTIONS: [&str; 6] = [
    "--diameter",
    "1mm..1.5mm",
    "--overlap",
    "0",
    "--bond-range",
    "1.3",
];

/// Packs a shape of the folder and checks volume (mm3, to 1e-5) and pieces; `unsure` (mm) as for
/// [`assert_exact`].
fn packed(name: &str, more: &[&str], volume: f64, pieces: u64, unsure: f64) -> Made {
    let file = shape(name);
    let made = Bench::new().pack(&file, &[&OPTIONS, more].concat());
    assert!(
        (made.number("/quality/shape_volume_m3") * 1e9 / volume - 1.0).abs() < 1e-5,
        "{name}: volume"
    );
    assert_eq!(
        made.count("/quality/pieces/count"),
        pieces,
        "{name}: pieces"
    );
    let (positions, radii) = made.millimetres();
    assert_exact(name, &read_stl(&file), &positions, &radii, 0.0, unsure);
    assert!(
        radii
            .iter()
            .all(|r| (0.5 - 1e-12..=0.75 + 1e-12).contains(r)),
        "{name}: radii"
    );
    // The density of a packing with walls in every direction is at least this.
    let fraction = radii
        .iter()
        .map(|r| 4.0 / 3.0 * PI * r.powi(3))
        .sum::<f64>()
        / volume;
    assert!(
        fraction > 0.5 && fraction < 0.66,
        "{name}: filled {fraction}"
    );
    assert!(
        (made.number("/quality/generating_density") - fraction).abs() < 1e-4,
        "{name}: reported share"
    );
    assert!(
        made.number("/quality/contacts/largest_overlap") <= 1e-9,
        "{name}: reported overlap"
    );
    assert!(
        made.number("/quality/contacts/largest_protrusion") <= 1e-9,
        "{name}: reported protrusion"
    );
    made
}

/// Fraction of the ball around `centre` (mm) that its spheres fill.
fn filled_share(made: &Made, centre: [f64; 3], radius: f64) -> f64 {
    let (positions, radii) = made.millimetres();
    let within = positions
        .iter()
        .zip(&radii)
        .filter(|(p, _)| length(sub(**p, centre)) < radius);
    within.map(|(_, r)| (r / radius).powi(3)).sum()
}

#[test]
fn one_box_in_four_files_is_one_packing() {
    let binary = packed("02", &[], 2400.0, 1, 0.0);
    let wanted = bits(&binary.body);
    for name in ["01", "19"] {
        let made = Bench::new().pack(&shape(name), &OPTIONS);
        assert!(
            bits(&made.body) == wanted,
            "{name}: another packing than of the binary box"
        );
        assert_eq!(made.body.bonds, binary.body.bonds, "{name}");
        assert!(!made.said.contains("note"), "{name}: {}", made.said);
    }
    let inverted = Bench::new().pack(&shape("04"), &OPTIONS);
    assert!(
        bits(&inverted.body) == wanted,
        "inverted: another packing than of the binary box"
    );
    assert_eq!(inverted.count("/repairs/flipped_facets"), 12);
}

/// The corners of each facet as an OBJ and as a PLY, each corner as often as facets have it.
fn obj_and_ply(facets: &[[[f64; 3]; 3]]) -> [String; 2] {
    let corners = facets.as_flattened();
    let lines = |before: &str| -> String {
        let line = |[x, y, z]: &[f64; 3]| format!("{before}{x} {y} {z}\n");
        corners.iter().map(line).collect()
    };
    let faces = |before: &str, first: usize| -> String {
        let face = |at: usize| {
            let [a, b, c] = [0, 1, 2].map(|k| 3 * at + k + first);
            format!("{before}{a} {b} {c}\n")
        };
        (0..facets.len()).map(face).collect()
    };
    let head = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        corners.len(),
        facets.len()
    );
    [
        lines("v ") + &faces("f ", 1),
        head + &lines("") + &faces("3 ", 0),
    ]
}

#[test]
fn one_shape_in_four_formats_is_one_packing() {
    for (name, diameter) in [("02", "1.5mm..2mm"), ("22", "3mm..4mm")] {
        let file = shape(name);
        let bench = Bench::new();
        let wanted = bench.pack_only(&file, &["--diameter", diameter]);
        let [obj, ply] = obj_and_ply(&read_stl(&file));
        for (name, text) in [("part.obj", obj), ("part.ply", ply)] {
            let file = bench.path(name);
            std::fs::write(&file, text).unwrap();
            let made = bench.pack_only(&file, &["--diameter", diameter]);
            assert!(bits(&made) == bits(&wanted), "{name}");
            assert_eq!(made.bonds, wanted.bonds);
        }
    }
    let file = root().join("crates/packer/tests/shapes/box.3mf");
    let options = ["--diameter", "1.5mm..2mm"];
    let wanted = Bench::new().pack_only(&shape("02"), &options);
    for unit in [&[][..], &["--unit", "mm"]] {
        let made = Bench::new().pack_only(&file, &[&options[..], unit].concat());
        assert!(bits(&made) == bits(&wanted), "{unit:?}");
    }
    let other = Bench::new().run(
        &file,
        &[&options[..], &["--unit", "cm", "-o", "a.vtp"]].concat(),
    );
    let said = refusal(&other, &file);
    let wanted = "a unit of the file is 0.001 m, as it says itself, not 0.01 m; leave the unit out; a scale makes the shape larger or smaller";
    assert!(said.ends_with(wanted), "{said}");
}

#[test]
fn info_describes_a_shape_of_any_format() {
    let bench = Bench::new();
    let [obj, ply] = obj_and_ply(&read_stl(&shape("02")));
    std::fs::write(bench.path("part.obj"), obj).unwrap();
    std::fs::write(bench.path("PART.PLY"), ply).unwrap();
    let box_3mf = root().join("crates/packer/tests/shapes/box.3mf");
    let said = |file: &std::path::Path| {
        let mut info = super::dem_pack();
        let output = info
            .arg("info")
            .arg(file)
            .args(["--json"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", file.display());
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        summary["volume_m3"].as_f64().unwrap()
    };
    for file in [
        shape("02"),
        bench.path("part.obj"),
        bench.path("PART.PLY"),
        box_3mf,
    ] {
        let volume_m3 = said(&file);
        assert!((volume_m3 / 2400e-9 - 1.0).abs() < 1e-12, "{volume_m3}");
    }
}

#[test]
fn inverted_normals_are_said_once() {
    let bench = Bench::new();
    let output = bench.run(&shape("04"), &[&OPTIONS[..], &["-o", "body.vtp"]].concat());
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(said.matches("wrong way round").count(), 1, "{said}");
}

#[test]
fn a_box_far_away_is_the_same_packing_moved() {
    let near = Bench::new().pack(&shape("02"), &OPTIONS);
    let far = packed("20", &[], 2400.0, 1, 1e-9);
    assert_eq!(near.body.radii, far.body.radii);
    assert_eq!(near.body.bonds, far.body.bonds);
    for (p, q) in near.body.positions.iter().zip(&far.body.positions) {
        // 1e6 mm are 1000 m, whose neighbour in double precision is 1.1e-13 m away.
        assert!(
            (0..3).all(|k| (q[k] - 1000.0 - p[k]).abs() < 1.2e-13),
            "{p:?} {q:?}"
        );
    }
}

#[test]
fn a_hole_is_refused_or_filled() {
    let made = packed("06", &["--fill-holes"], 4179.74, 1, 0.0);
    assert_eq!(made.count("/repairs/filled_holes"), 2);
}

#[test]
fn both_of_two_balls_are_filled_and_stay_two() {
    let made = packed("08", &[], 8359.48, 2, 0.0);
    for x in [0.0, 30.0] {
        let fraction = filled_share(&made, [x, 0.0, 0.0], 10.0);
        assert!(fraction > 0.5, "the ball at {x} is filled {fraction}");
    }
}

#[test]
fn a_cavity_stays_empty() {
    let made = packed("09", &[], 3657.27, 1, 0.0);
    let (positions, radii) = made.millimetres();
    // The facets of the inner wall lie between 4.98 and 5 from the middle.
    for (p, r) in positions.iter().zip(&radii) {
        assert!(
            length(*p) - r > 4.98,
            "a sphere reaches into the cavity: {p:?} {r}"
        );
    }
}

#[test]
fn degenerate_and_duplicated_facets_do_no_harm() {
    let made = packed("11", &[], 4179.74, 1, 0.0);
    assert_eq!(made.count("/repairs/degenerate_facets"), 3);
    assert_eq!(made.count("/repairs/duplicate_facets"), 21);
}

#[test]
fn corners_that_do_not_quite_meet_are_welded() {
    let made = packed("26", &[], 4179.74, 1, 3e-5);
    assert!(made.count("/repairs/welded_vertices") > 0);
}

#[test]
fn a_thin_plate_takes_what_fits() {
    let bench = Bench::new();
    let file = shape("13");
    let made = bench.pack(&file, &["--diameter", "0.5mm..0.8mm", "--overlap", "0"]);
    let (positions, radii) = made.millimetres();
    assert_exact("13", &read_stl(&file), &positions, &radii, 0.0, 0.0);
    assert!((made.number("/quality/shape_volume_m3") * 1e9 - 2500.0).abs() < 0.01);
    // At least one layer everywhere: about the same number in each square of 5 x 5 mm.
    let mut counts = [0_usize; 100];
    let low = [0, 1].map(|k| {
        read_stl(&file)
            .iter()
            .flatten()
            .map(|p| p[k])
            .fold(f64::INFINITY, f64::min)
    });
    for p in &positions {
        counts[((p[0] - low[0]) / 5.0) as usize * 10 + ((p[1] - low[1]) / 5.0) as usize] += 1;
    }
    let mean = positions.len() / 100;
    assert!(
        counts.iter().all(|n| *n > mean / 2 && *n < 2 * mean),
        "{counts:?}"
    );
}

#[test]
fn a_ring_is_packed_from_a_seed_inside_it() {
    let made = packed("22", &[], 9849.8, 1, 0.0);
    let [x, y, z] = [0, 1, 2].map(|k| 1e3 * made.number(&format!("/history/seed_point_m/{k}")));
    let in_tube = ((x.hypot(y) - 20.0).powi(2) + z * z).sqrt();
    assert!(
        in_tube < 0.2,
        "the seed is {in_tube} mm off the middle of the tube"
    );
    // On all sides.
    let (positions, _) = made.millimetres();
    let mut counts = [0_usize; 24];
    for p in &positions {
        counts[((p[1].atan2(p[0]) / PI + 1.0) * 11.999) as usize] += 1;
    }
    let mean = positions.len() / 24;
    assert!(
        counts.iter().all(|n| n.abs_diff(mean) < mean / 5),
        "{counts:?}"
    );
}

#[test]
fn both_balls_of_a_dumbbell_are_filled_and_stay_two() {
    let made = packed("29", &[], 8313.29, 2, 0.0);
    let facets = read_stl(&shape("29"));
    let ends = [f64::min, f64::max]
        .map(|pick| facets.iter().flatten().map(|p| p[0]).reduce(pick).unwrap());
    for x in [ends[0] + 10.0, ends[1] - 10.0] {
        let fraction = filled_share(&made, [x, 0.0, 0.0], 10.0);
        assert!(fraction > 0.5, "the ball at {x} is filled {fraction}");
    }
    let warnings = made.report["quality"]["warnings"].to_string();
    assert!(warnings.contains("2 pieces"), "{warnings}");
}
