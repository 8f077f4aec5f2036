//! A requested solid density is found, and is the one of the file.

use super::{Bench, bits, refusal, shape};
use std::f64::consts::PI;

#[test]
fn the_density_asked_for_is_found() {
    for (name, volume_mm3, wanted, particle) in [
        ("02", 2400.0, 1650.0, 2050.0),
        ("02", 2400.0, 1300.0, 2050.0),
        ("22", 9849.8009, 2.0, 2.5),
    ] {
        let [solid, material] = [wanted, particle].map(|d| {
            if d < 10.0 {
                format!("{d} g/cm3")
            } else {
                format!("{d}")
            }
        });
        let (wanted, particle) = if wanted < 10.0 {
            (1e3 * wanted, 1e3 * particle)
        } else {
            (wanted, particle)
        };
        let made = Bench::new().pack(
            &shape(name),
            &[
                "-d",
                "1mm..1.5mm",
                "--particle-density",
                &material,
                "--solid-density",
                &solid,
            ],
        );
        let volume: f64 = made
            .body
            .radii
            .iter()
            .map(|r| 4.0 / 3.0 * PI * r.powi(3))
            .sum();
        let found = particle * volume / (volume_mm3 * 1e-9);
        assert!(
            (found / wanted - 1.0).abs() <= 0.001,
            "{name}: wanted {wanted}, found {found}"
        );
        assert!((made.number("/quality/solid_density_kg_m3") / found - 1.0).abs() < 1e-7);
        assert!((made.number("/density_search/found_kg_m3") / found - 1.0).abs() < 1e-7);
        // Reading JSON may cost the last digit.
        assert!(
            (made.number("/density_search/overlap") / made.body.about.overlap.unwrap() - 1.0).abs()
                < 1e-15
        );
        assert_eq!(made.body.about.particle_density_kg_m3, Some(particle));
    }
}

#[test]
fn the_density_is_printed() {
    let bench = Bench::new();
    let output = bench.run(
        &shape("02"),
        &[
            "-d",
            "1.5mm..2mm",
            "--particle-density",
            "2050",
            "--solid-density",
            "1650",
            "--verbose",
            "-o",
            "body.vtp",
        ],
    );
    let said = String::from_utf8(output.stdout).unwrap();
    let line = said
        .lines()
        .find(|line| line.starts_with("density search"))
        .unwrap();
    for part in [
        "target 1650 kg/m3, found 16",
        " %) at overlap 0.",
        "packings made: ",
        ", fronts: ",
    ] {
        assert!(line.contains(part), "{line}");
    }
    // The stages add up, whatever the number of packings.
    let numbers: Vec<f64> = said
        .lines()
        .find(|line| line.starts_with("time"))
        .unwrap()
        .split([' ', ',', ';'])
        .filter_map(|word| word.parse().ok())
        .collect();
    let stages: f64 = numbers[1..6].iter().sum();
    assert!(
        (stages - numbers[0]).abs() < 0.1 * numbers[0] + 0.06,
        "{said}"
    );
}

#[test]
fn densities_out_of_reach_are_refused() {
    for (solid, particle) in [("100", "2000"), ("20000", "2000"), ("1 kg/m3", "2.5 g/cm3")] {
        let bench = Bench::new();
        let output = bench.run(
            &shape("02"),
            &[
                "-d",
                "1.5mm..2mm",
                "--particle-density",
                particle,
                "--solid-density",
                solid,
                "-o",
                "body.vtp",
            ],
        );
        let said = refusal(&output, &solid);
        assert!(
            said.contains("--solid-density") && said.contains("cannot be reached"),
            "{said}"
        );
        assert!(bench.files().is_empty());
    }
}

#[test]
fn the_limits_are_those_of_packings_that_were_made() {
    let sizes = ["-d", "1.5mm..2mm", "--particle-density", "2000"];
    for (overlap, solid) in [("0", "10"), ("0.999", "100000")] {
        let made = Bench::new().pack(
            &shape("02"),
            &[&sizes[..], &["--overlap", overlap]].concat(),
        );
        let limit = made.number("/quality/solid_density_kg_m3");
        let asked = [&sizes[..], &["--solid-density", solid, "-o", "body.vtp"]].concat();
        let said = refusal(&Bench::new().run(&shape("02"), &asked), &solid);
        assert!(
            said.contains(&format!(" is {limit:.0} kg/m3")),
            "{limit}: {said}"
        );
    }
}

#[test]
fn few_packings_are_finished_and_the_overlap_found_gives_the_same_body() {
    let sizes = ["-d", "1.5mm..2mm", "--particle-density", "2050"];
    let found = Bench::new().pack(
        &shape("02"),
        &[&sizes[..], &["--solid-density", "1650"]].concat(),
    );
    let [begun, finished] =
        ["packings", "finished"].map(|key| found.count(&format!("/density_search/{key}")));
    // The number of fronts depends on chance; only a few of them are worth completing.
    assert!(
        finished <= begun.min(6) && begun <= 30,
        "{finished} of {begun}"
    );
    let overlap = found.body.about.overlap.unwrap().to_string();
    let again = Bench::new().pack(
        &shape("02"),
        &[&sizes[..], &["--overlap", &overlap]].concat(),
    );
    assert!(bits(&found.body) == bits(&again.body), "{overlap}");
}

#[test]
fn without_overlap_the_two_densities_are_one() {
    // One is sampled, the other is the volume of the spheres; these shapes leave much of their box
    // empty.
    for name in ["22", "09"] {
        let made = Bench::new().pack(
            &shape(name),
            &["-d", "1mm..1.5mm", "--overlap", "0", "--densify", "0"],
        );
        let [sampled, error, exact] = [
            "/quality/union_density/value",
            "/quality/union_density/error",
            "/quality/generating_density",
        ]
        .map(|key| made.number(key));
        assert!(
            (sampled - exact).abs() < 4.0 * error && error < 0.0015,
            "{name}: {sampled} +- {error}, exactly {exact}"
        );
    }
}
