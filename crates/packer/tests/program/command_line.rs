//! Help, man page, completions, reports.

use super::{Bench, dem_pack, shape};
use dem_io::body::read_body;
use serde_json::Value;
use std::process::Output;

const OPTIONS: [&str; 20] = [
    "--output",
    "--unit",
    "--scale",
    "--fill-holes",
    "--diameter",
    "--basis",
    "--overlap",
    "--particle-density",
    "--solid-density",
    "--seed",
    "--seed-point",
    "--densify",
    "--bond-range",
    "--bonds-per-particle",
    "--bond-radius",
    "--threads",
    "--json",
    "--quiet",
    "--help",
    "--version",
];

fn said(arguments: &[&str]) -> String {
    let Output {
        status,
        stdout,
        stderr,
    } = dem_pack().args(arguments).output().unwrap();
    assert!(status.success() && stderr.is_empty(), "{arguments:?}");
    String::from_utf8(stdout).unwrap()
}

#[test]
fn help_man_page_and_completions_name_every_option() {
    for arguments in [
        &["--help"][..],
        &["-h"],
        &["man"],
        &["completions", "bash"],
        &["completions", "zsh"],
        &["completions", "fish"],
    ] {
        // A man page has its hyphens escaped, fish's completions name options without them.
        let text = said(arguments).replace("\\-", "-").replace("-l ", "--");
        for option in OPTIONS {
            assert!(text.contains(option), "{option} is not in {arguments:?}");
        }
        for command in ["info", "convert", "completions", "man"] {
            assert!(text.contains(command), "{command} is not in {arguments:?}");
        }
    }
    let help = said(&["--help"]);
    assert!(help.contains("Exit codes: 0 done, 1 failed while running, 2 bad input"));
    for law in ["normal:", "lognormal:", "weibull:", "sieve:"] {
        assert!(help.contains(law));
    }
    assert!(said(&["man"]).starts_with(".ie"));
    assert_eq!(
        said(&["--version"]),
        format!("dem-pack {}\n", env!("CARGO_PKG_VERSION"))
    );
    assert!(said(&["info", "--help"]).contains("--json"));
    said(&["convert", "--help"]);
}

#[test]
fn without_arguments_the_usage_is_shown() {
    let output = dem_pack().output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("Usage: dem-pack")
    );
}

#[test]
fn quiet_says_nothing_but_json() {
    let bench = Bench::new();
    let output = bench.run(&shape("02"), &["-d", "2mm", "--quiet", "-o", "body.vtp"]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
    assert_eq!(bench.files(), ["body.vtp"]);
    let output = bench.run(
        &shape("02"),
        &["-d", "2mm", "--quiet", "--json", "-o", "body.vtp"],
    );
    assert!(output.status.success() && output.stderr.is_empty());
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["quality"]["particles"].as_u64().unwrap() > 100);
    let output = bench.run(&shape("02"), &["-d", "30mm", "--quiet", "-o", "other.vtp"]);
    assert!(
        !output.stderr.is_empty(),
        "what is wrong is said all the same"
    );
}

/// What only the report shows is left out, not what the body's file says.
#[test]
fn quiet_makes_the_same_body_with_the_same_warnings() {
    let bench = Bench::new();
    let arguments = ["-d", "2mm", "--bond-range", "1.01"];
    let body = |name: &str, more: &[&str]| {
        let output = bench.run(&shape("02"), &[&arguments, more, &["-o", name]].concat());
        assert!(output.status.success());
        std::fs::read(bench.folder.path().join(name)).unwrap()
    };
    let with_report = body("with.vtp", &["--json"]);
    assert_eq!(body("without.vtp", &["--quiet"]), with_report);
    let about = read_body(&bench.folder.path().join("without.vtp"))
        .unwrap()
        .about;
    let coarse = about.coarse().unwrap();
    assert!(coarse.starts_with("only about "), "{coarse}");
}

#[test]
fn the_summary_goes_where_the_body_does_not() {
    let bench = Bench::new();
    let to_file = bench.run(&shape("02"), &["-d", "2mm", "--verbose", "-o", "body.vtp"]);
    assert!(to_file.stderr.is_empty());
    let text = String::from_utf8(to_file.stdout).unwrap();
    let through_pipe = bench.run(&shape("02"), &["-d", "2mm", "--verbose"]);
    assert!(through_pipe.stdout.starts_with(b"<?xml"));
    let other = String::from_utf8(through_pipe.stderr).unwrap();
    for name in [
        "particles",
        "packing density",
        "interior",
        "sizes by number",
        "sizes by mass",
        "bonds",
        "contacts",
        "exactness",
        "pieces",
        "fabric",
        "packed by",
        "time",
        "verdict",
    ] {
        for text in [&text, &other] {
            assert!(
                text.lines().any(|line| line.starts_with(name)),
                "{name} is not in {text}"
            );
        }
    }
    for text in [&text, &other] {
        let mut names: Vec<&str> = text
            .lines()
            .skip(1)
            .filter_map(|line| line.split("  ").next())
            .filter(|name| *name != "warning" && *name != "note")
            .collect();
        let lines = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), lines, "two lines of one name: {text}");
        let warned = text.contains("\nwarning ") || text.contains("coarse: ");
        let verdict = text.lines().last().unwrap();
        assert_eq!(verdict.contains("sound"), !warned, "{text}");
    }
    assert!(text.contains(" up to bond range 1.1, "), "{text}");
    assert!(
        !other.contains('\u{1b}') && !other.contains('\r'),
        "a progress bar without a terminal"
    );
}

/// Room that is left between wide sizes is no detail: without `--verbose` it is reported, too.
#[test]
fn the_short_report_has_the_voids_that_are_left() {
    let bench = Bench::new();
    let short = |sizes: &str, name: &str| {
        let output = bench.run(&shape("02"), &["-d", sizes, "-o", name]);
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    };
    let text = short("0.5mm..3mm", "wide.vtp");
    assert!(text.contains("\npacking density  0."), "{text}");
    let line = text.lines().find(|line| line.starts_with("packed by"));
    let line = line.unwrap_or_else(|| panic!("{text}"));
    let (_, voids) = line.rsplit_once(" added in voids, about ").unwrap();
    let (voids, _) = voids.split_once(" voids still fit").unwrap();
    assert!(voids.parse::<u64>().unwrap() > 0, "{line}");
    let text = short("2mm", "one.vtp");
    assert!(!text.contains("packed by"), "{text}");
}

#[test]
fn the_report_as_json_has_its_keys() {
    let made = Bench::new().pack(
        &shape("02"),
        &["-d", "1.5mm..2mm", "--particle-density", "2050"],
    );
    let pointers = [
        "/quality/particles",
        "/quality/bonds",
        "/quality/mean_diameter_m",
        "/quality/overlap",
        "/quality/shape_volume_m3",
        "/quality/solid_density_kg_m3",
        "/quality/union_density/value",
        "/quality/union_density/error",
        "/quality/generating_density",
        "/quality/interior_union_density",
        "/quality/wall_profile/0/density",
        "/quality/slab_profile",
        "/quality/sizes_by_number/distance",
        "/quality/sizes_by_number/limit_95",
        "/quality/sizes_by_mass/distance",
        "/quality/bonds_per_particle",
        "/quality/contacts/per_particle",
        "/quality/contacts/largest_overlap",
        "/quality/contacts/largest_protrusion",
        "/quality/pieces/count",
        "/quality/fabric/eigenvalues/2",
        "/quality/interior_fabric",
        "/quality/thinnest",
        "/quality/warnings",
        "/history/seed_point_m/2",
        "/history/fronts",
        "/history/densify_steps",
        "/bond_range",
        "/density_search",
        "/repairs/facets_read",
        "/seconds/packing",
    ];
    for pointer in pointers {
        assert!(
            made.report.pointer(pointer).is_some(),
            "{pointer} is not in {}",
            made.report
        );
    }
    assert_eq!(made.report["density_search"], Value::Null);
    assert_eq!(
        made.count("/quality/particles"),
        made.body.radii.len() as u64
    );
    assert_eq!(made.count("/quality/bonds"), made.body.bonds.len() as u64);
}

#[test]
fn info_says_what_a_shape_is() {
    let path = shape("09");
    let text = said(&["info", path.to_str().unwrap()]);
    assert!(text.contains("parts       1, cavities 1"), "{text}");
    let json: Value =
        serde_json::from_str(&said(&["info", path.to_str().unwrap(), "--json"])).unwrap();
    assert!((json["volume_m3"].as_f64().unwrap() / 3657.27e-9 - 1.0).abs() < 1e-5);
    assert_eq!(json["shells"].as_array().unwrap().len(), 2);
    let json: Value = serde_json::from_str(&said(&[
        "info",
        path.to_str().unwrap(),
        "--json",
        "--unit",
        "um",
        "--scale",
        "2",
    ]))
    .unwrap();
    assert!((json["volume_m3"].as_f64().unwrap() / (8.0 * 3657.27e-18) - 1.0).abs() < 1e-5);
}

#[test]
fn info_says_what_a_body_is() {
    let bench = Bench::new();
    let made = bench.pack(
        &shape("02"),
        &["-d", "1.5mm..2mm", "--particle-density", "2050"],
    );
    let path = bench.path("body.vtp");
    let json: Value =
        serde_json::from_str(&said(&["info", path.to_str().unwrap(), "--json"])).unwrap();
    assert_eq!(json["particles"], made.body.radii.len());
    assert_eq!(json["bonds"], made.body.bonds.len());
    assert_eq!(json["pieces"], made.report["quality"]["pieces"]["count"]);
}

/// The mass of the spheres compared with that of the shape filled with their density.
#[test]
fn the_report_says_what_body_and_shape_weigh() {
    let bench = Bench::new();
    let made = bench.pack(&shape("02"), &["-d", "2mm", "--particle-density", "2050"]);
    let volume_m3 = made.body.about.shape_volume_m3.unwrap();
    let number = |pointer: &str| made.report.pointer(pointer).unwrap().as_f64().unwrap();
    let spheres = made.body.radii.iter().map(|r| r * r * r);
    let spheres_m3 = 4.0 / 3.0 * std::f64::consts::PI * spheres.sum::<f64>();
    for (pointer, wanted) in [
        ("/mass/mass_kg", 2050.0 * spheres_m3),
        ("/mass/shape_mass_kg", 2050.0 * volume_m3),
        (
            "/mass/difference_percent",
            100.0 * (spheres_m3 / volume_m3 - 1.0),
        ),
        ("/mass_over_shape", spheres_m3 / volume_m3),
    ] {
        let found = number(pointer);
        assert!(
            (found / wanted - 1.0).abs() < 1e-9,
            "{pointer}: {found} {wanted}"
        );
    }
    let line = |text: &str, name: &str| {
        let found = text.lines().find(|line| line.starts_with(name));
        found
            .unwrap_or_else(|| panic!("no {name} in {text}"))
            .to_owned()
    };
    let run = |options: &[&str]| {
        let output = bench.run(&shape("02"), &[options, &["--verbose"]].concat());
        String::from_utf8(output.stdout).unwrap()
    };
    let text = run(&["-d", "2mm", "--particle-density", "2050", "-o", "body.vtp"]);
    let mass = line(&text, "mass ");
    assert!(
        mass.contains(" kg; its shape filled with 2050 kg/m3 would weigh ")
            && mass.contains(" %); solid density ")
            && mass.ends_with(" kg/m3"),
        "{mass}"
    );
    assert!(
        line(&text, "centre ").contains("; principal moments "),
        "{text}"
    );
    let text = run(&["-d", "2mm", "-o", "body.vtp"]);
    let mass = line(&text, "mass ");
    assert!(
        mass.ends_with(" of its shape filled with the density of the particles"),
        "{mass}"
    );
    assert!(!line(&text, "centre ").contains("moments"), "{text}");
}
