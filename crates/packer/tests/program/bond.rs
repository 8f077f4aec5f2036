//! `dem-pack bond`: bonds for spheres of any origin.

use super::{Bench, bits, dem_pack, refusal, shape};
use crate::helpers::facets::cuboid;
use dem_io::Body;
use dem_io::body::{read_body, write_body};
use std::process::Output;

/// Runs dem-pack bond in the folder.
fn bond(bench: &Bench, words: &[&str]) -> Output {
    let mut program = dem_pack();
    program.current_dir(bench.folder.path());
    program.arg("bond").args(words).output().unwrap()
}

/// A body of these spheres (x, y, z, radius, m) without bonds, in a file.
fn write_spheres(bench: &Bench, name: &str, spheres: &[[f64; 4]]) {
    let body = Body::from_spheres(spheres, &[]).unwrap();
    write_body(&body, &bench.path(name)).unwrap();
}

#[test]
fn the_spheres_of_a_packing_get_its_bonds_again() {
    let bench = Bench::new();
    let file = bench.stl("box.stl", &cuboid([12.0, 9.0, 8.0]));
    for options in [
        &[][..],
        &["--bond-range", "1.0", "--bond-radius", "0.5"],
        &["--bonds-per-particle", "6.5"],
    ] {
        let packing = ["-d", "0.9mm..1.4mm", "--particle-density", "2050"];
        let made = bench.pack(&file, &[&packing[..], options].concat()).body;
        let alone = Body {
            bonds: Vec::new(),
            bond_radii: Vec::new(),
            bond_lengths: Vec::new(),
            ..made.clone()
        };
        write_body(&alone, &bench.path("spheres.vtp")).unwrap();
        let output = bond(
            &bench,
            &[&["spheres.vtp", "-o", "again.vtp"], options].concat(),
        );
        assert!(output.status.success() && output.stderr.is_empty());
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(
            said.contains("spheres.vtp -> again.vtp") && said.contains("fabric"),
            "{said}"
        );
        let again = read_body(&bench.path("again.vtp")).unwrap();
        assert!(bits(&again) == bits(&made));
        assert_eq!(again.bonds, made.bonds, "{options:?}");
        let pairs = |of: fn(&Body) -> &Vec<f64>| of(&again).iter().zip(of(&made));
        for (a, b) in pairs(|body| &body.bond_radii).chain(pairs(|body| &body.bond_lengths)) {
            // The packing was bonded in the units of its shape.
            assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        }
        let (of, was) = (&again.about, &made.about);
        assert_eq!(of.particle_density_kg_m3, Some(2050.0));
        assert_eq!(
            [of.shape_volume_m3, of.overlap],
            [was.shape_volume_m3, was.overlap]
        );
        assert_eq!([&of.source, &of.program], [&was.source, &was.program]);
    }
}

#[test]
fn density_and_volume_can_be_given() {
    let bench = Bench::new();
    write_spheres(
        &bench,
        "two.csv",
        &[[0.0, 0.0, 0.0, 1e-3], [1.5e-3, 0.0, 0.0, 1e-3]],
    );
    let options = [
        "two.csv",
        "-o",
        "-",
        "--particle-density",
        "2 g/cm3",
        "--shape-volume",
        "8mm3",
    ];
    let output = bond(&bench, &options);
    assert!(output.status.success() && output.stderr.is_empty());
    std::fs::write(bench.path("piped.vtp"), output.stdout).unwrap();
    let body = read_body(&bench.path("piped.vtp")).unwrap();
    assert_eq!(
        (&body.bonds[..], &body.bond_lengths[..]),
        (&[[0, 1]][..], &[1.5e-3][..])
    );
    let about = body.about;
    assert_eq!(
        [about.particle_density_kg_m3, about.shape_volume_m3],
        [Some(2000.0), Some(8e-9)]
    );
    assert_eq!(about.source.as_deref(), Some("two.csv"));
    assert!(
        about.warnings[0].contains("bonds per particle"),
        "{:?}",
        about.warnings
    );
}

#[test]
fn what_cannot_be_bonded_is_refused() {
    let bench = Bench::new();
    write_spheres(&bench, "one.vtp", &[[0.0, 0.0, 0.0, 1e-3]]);
    write_spheres(
        &bench,
        "near.vtp",
        &[[0.0, 0.0, 0.0, 1e-3], [2.5e-3, 0.0, 0.0, 1e-3]],
    );
    write_spheres(
        &bench,
        "far.vtp",
        &[[0.0, 0.0, 0.0, 1e-3], [1.0, 0.0, 0.0, 1e-3]],
    );
    let _ = bench.pack_only(&shape("02"), &["-d", "2mm..3mm"]);
    std::fs::write(bench.path("empty.particles.txt"), "").unwrap();
    std::fs::write(bench.path("empty.bonds.txt"), "").unwrap();
    std::fs::write(bench.path("bare.particles.csv"), "x_m,y_m,z_m\n0,0,0\n").unwrap();
    std::fs::write(bench.path("bare.bonds.csv"), "particle_a,particle_b\n").unwrap();
    for (words, wanted) in [
        (&["one.vtp"][..], "one.vtp: there is only one sphere"),
        (
            &["near.vtp"],
            "near.vtp: none of 2 spheres is within the bond range of 1.1 of another",
        ),
        (&["near.vtp"], "--bond-range 1.25"),
        (&["far.vtp"], "the spheres must touch, or nearly so"),
        (
            &["far.vtp", "--bonds-per-particle", "1"],
            "cannot be reached",
        ),
        (
            &["near.vtp", "--bond-range", "3"],
            "--bond-range: 3 is not above 0",
        ),
        (&["near.vtp", "--shape-volume", "8mm"], "--shape-volume: "),
        (&["near.vtp", "--shape-volume", "0"], "0 m3 is not positive"),
        (
            &["near.vtp", "--particle-density", "-1"],
            "-1 kg/m3 is not positive",
        ),
        (&["body.vtp"], "the spheres are bonded already, by "),
        (&["body.vtp"], "--replace bonds them anew"),
        (&["empty.txt"], "the body has no particles"),
        (&["bare.csv"], "radius_m"),
        (&["none.vtp"], "there is no such file"),
        (&["x.stl"], "'.stl' is not the ending of a body"),
        (&["near.vtp", "-o", "none/x.vtp"], "none"),
    ] {
        let output = bond(
            &bench,
            &[
                words,
                &["-o", "out.vtp"][..2 * usize::from(!words.contains(&"-o"))],
            ]
            .concat(),
        );
        let said = refusal(&output, &words.join(" "));
        assert!(said.contains(wanted), "{words:?}: {said}");
        assert!(!bench.path("out.vtp").exists());
    }
    let itself = refusal(
        &bond(
            &bench,
            &["near.vtp", "--bond-range", "1.3", "-o", "near.vtp"],
        ),
        &"itself",
    );
    assert!(itself.contains("near.vtp"), "{itself}");
    assert!(
        bond(&bench, &["body.vtp", "--replace", "-q", "-o", "out.vtp"])
            .status
            .success()
    );
}

#[test]
fn a_list_of_spheres_needs_no_file_of_bonds() {
    let bench = Bench::new();
    let list = "# three in a line\n0 0 0 0.005\n0.005 0 0 0.005\n0.01 0 0 0.005\n";
    std::fs::write(bench.path("stone.txt"), list).unwrap();
    std::fs::write(bench.path("line.particles.txt"), list).unwrap();
    let table = "radius_m,x_m,y_m,z_m\n0.005,0,0,0\n0.005,0.005,0,0\n0.005,0.01,0,0\n";
    std::fs::write(bench.path("table.csv"), table).unwrap();
    for name in ["stone.txt", "line.txt", "table.csv"] {
        let output = bond(&bench, &[name, "-o", "s.vtp"]);
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{name}");
        // Three bonds tell nothing of directions: the ends touch as well.
        assert!(
            said.contains("too few bonds to tell whether isotropic"),
            "{said}"
        );
        let body = read_body(&bench.path("s.vtp")).unwrap();
        assert_eq!((body.radii.len(), body.bonds.len()), (3, 3), "{name}");
    }
    let output = bond(&bench, &["stone.txt", "-o", "stone.txt"]);
    // It writes the pair of that name.
    assert!(output.status.success() && bench.path("stone.particles.txt").is_file());
    assert_eq!(
        std::fs::read_to_string(bench.path("stone.txt")).unwrap(),
        list
    );
}
