//! Invalid bodies in a scene: messages with scene, body, file, particle or bond.

use dem_io::Body;
use dem_io::body::write_body;

use super::{Bench, piped, refused, row, vtp_bytes};

const SCENE: &str = "version = 1
run.end_time = \"1 ms\"
materials.cake.density = 2050
[bonds.cake]
young_modulus = \"12 MPa\"
poisson_ratio = 0.3
[bodies.sample]
file = \"sample.vtp\"
material = \"cake\"
bonds = \"cake\"
";

fn assert_refused(bytes: &[u8], parts: &[&str]) {
    let bench = Bench::new();
    let scene = bench.write("scene.toml", SCENE);
    bench.write("sample.vtp", bytes);
    let said = bench.bad(&scene, &["--output", "out"], 2);
    for part in ["scene.toml: [bodies.sample]: ", "sample.vtp: "]
        .iter()
        .chain(parts)
    {
        assert!(said.contains(part), "'{part}' is not in: {said}");
    }
    // Through a pipe the message names standard input.
    let output = piped(&[scene.to_str().unwrap(), "--body", "-"], bytes);
    let (said, code) = refused(&output);
    assert_eq!(code, 2);
    assert!(said.contains("[bodies.sample]: standard input: "), "{said}");
    assert_eq!(bench.files(), ["sample.vtp", "scene.toml"]);
}

#[test]
fn damaged_cut_off_or_newer() {
    let whole = vtp_bytes(&row(5));
    assert_refused(&whole[..whole.len() / 2], &["write or copy it again"]);
    assert_refused(&whole[..whole.len() - 60], &[]);
    assert_refused(b"", &[]);
    assert_refused(b"solid cake\n", &["not a VTK XML file"]);
    let text = String::from_utf8_lossy(&whole);
    let newer = text
        .find("FormatVersion")
        .or_else(|| text.find("format_version"));
    if let Some(at) = newer {
        let mut changed = whole.clone();
        let digit = (at..at + 200).find(|&i| changed[i] == b'>').unwrap() + 1;
        let digit = (digit..digit + 40)
            .find(|&i| changed[i].is_ascii_digit())
            .unwrap();
        changed[digit] = b'9';
        assert_refused(&changed, &["9"]);
    }
}

fn changed(change: impl FnOnce(&mut Body)) -> Vec<u8> {
    let mut body = row(5);
    change(&mut body);
    vtp_bytes(&body)
}

#[test]
fn particles_and_bonds_that_cannot_be() {
    assert_refused(
        &changed(|b| b.positions[3][1] = f64::NAN),
        &["particle 3", "y is NaN"],
    );
    assert_refused(
        &changed(|b| b.radii[2] = 0.0),
        &["particle 2", "radius is 0 m"],
    );
    assert_refused(&changed(|b| b.radii[2] = -1.0), &["particle 2", "-1 m"]);
    assert_refused(&changed(|b| b.bonds[1] = [2, 2]), &["bond 1"]);
    assert_refused(
        &changed(|b| b.bonds[1] = [2, 7]),
        &["bond 1", "particle 7", "5 particles"],
    );
    assert_refused(
        &changed(|b| b.bonds[1] = b.bonds[0]),
        &["bond 1", "as bond 0 does already"],
    );
    assert_refused(
        &changed(|b| b.bond_lengths[1] = 0.0),
        &["bond 1", "initial length is 0 m"],
    );
    assert_refused(
        &changed(|b| b.bond_radii[1] = f64::INFINITY),
        &["bond 1", "radius is inf m"],
    );
}

#[test]
fn two_bonded_particles_at_one_place() {
    let bench = Bench::new();
    let scene = bench.write("scene.toml", SCENE);
    // Its length is in the file, so that the body itself is valid.
    bench.write("sample.vtp", changed(|b| b.positions[1] = b.positions[0]));
    let said = bench.bad(&scene, &[], 2);
    let file = bench.path("sample.vtp");
    assert_eq!(
        said,
        format!(
            "error: {}: [bodies.sample]: {}: bond 0: its two particles are at the same place; move one of them, or remove the bond",
            scene.display(),
            file.display()
        )
    );
    // For two tables the message names that of the bonds.
    let mut body = row(5);
    body.positions[1] = body.positions[0];
    write_body(&body, &bench.path("pair.csv")).unwrap();
    let said = bench.bad(&scene, &["--body", "pair.csv"], 2);
    assert!(
        said.contains("[bodies.sample]: pair.bonds.csv: bond 0: "),
        "{said}"
    );
}

/// A millimetre is lost at this distance: for two tables the message names that of the particles.
#[test]
fn a_body_that_is_put_too_far_away() {
    let bench = Bench::new();
    let scene = bench.write("scene.toml", SCENE);
    write_body(&row(5), &bench.path("row.csv")).unwrap();
    let away = "bodies.sample.position=[1e15, 0, 0]";
    let said = bench.bad(&scene, &["--body", "row.csv", "--set", away], 2);
    assert!(
        said.contains("[bodies.sample]: row.particles.csv: particle 0: 1.000e15 m from the origin its coordinates are rounded by 2.2e-1 m"),
        "{said}"
    );
}

#[test]
fn what_a_scene_lacks_for_a_body() {
    let bench = Bench::new();
    bench.write("sample.vtp", vtp_bytes(&row(5)));
    let scene = bench.write("scene.toml", SCENE.replace("bonds = \"cake\"\n", ""));
    let said = bench.bad(&scene, &[], 2);
    assert!(
        said.contains("[bodies.sample]: the body has 3 bonds, and no kind of bonds is named; add bonds = \"NAME\""),
        "{said}"
    );
    let mut body = row(5);
    body.about.particle_density_kg_m3 = None;
    bench.write("sample.vtp", vtp_bytes(&body));
    let scene = bench.write(
        "scene.toml",
        SCENE.replace(".density = 2050", ".young_modulus = 1e7"),
    );
    let said = bench.bad(&scene, &[], 2);
    assert!(
        said.contains("[materials.cake]: no density") && said.contains("add density = "),
        "{said}"
    );
    // A density in the body's file is sufficient.
    bench.write("sample.vtp", vtp_bytes(&row(5)));
    bench.good(&scene, &["--quiet"]);
    let said = bench.bad(&scene, &["--set", "groups.one.particles=[5]"], 2);
    assert!(
        said.contains("[groups.one]: particle 5 does not exist: the body has 5 particles; use numbers from 0 to 4"),
        "{said}"
    );
}

/// The message for tables with these particles and bonds.
fn said_of_tables(ending: &str, particles: &str, bonds: &str) -> String {
    let bench = Bench::new();
    bench.write(&format!("x.particles.{ending}"), particles);
    bench.write(&format!("x.bonds.{ending}"), bonds);
    let output = bench.run(format!("x.{ending}").as_ref(), &[]);
    let (said, code) = refused(&output);
    assert_eq!(code, 2, "{said}");
    said
}

#[test]
fn of_two_tables_the_right_one_is_named() {
    let particles = "x_m,y_m,z_m,radius_m\n0,0,0,1\n2,0,0,1\n";
    for (bond, place) in [
        ("1,1,1,1", "line 4: it joins particle 1 to itself"),
        ("1,0,1,1", "bond 1: it joins particles 0 and 1, as bond 0"),
        ("1,0,0,1", "line 4: its radius is 0 m"),
        ("1,0,1,-2", "line 4: its initial length is -2 m"),
    ] {
        let bonds =
            format!("particle_a,particle_b,bond_radius_m,initial_length_m\n0,1,1,2\n\n{bond}\n");
        let said = said_of_tables("csv", particles, &bonds);
        assert!(said.contains(&format!("x.bonds.csv: {place}")), "{said}");
    }
    let said = said_of_tables(
        "csv",
        &particles.replace("2,0,0,1", "2,0,0,0"),
        "particle_a,particle_b\n0,1\n",
    );
    assert!(
        said.contains("x.particles.csv: line 3: its radius is 0 m"),
        "{said}"
    );
    let said = said_of_tables(
        "csv",
        &particles.replace("2,", "0,"),
        "particle_a,particle_b\n0,1\n",
    );
    assert!(
        said.contains("x.bonds.csv: bond 0: its initial length is 0 m"),
        "{said}"
    );
    let said = said_of_tables("txt", "0 0 0 1\n2 0 0 1\n", "1 2\n2 1\n");
    assert!(said.contains("x.bonds.txt: bond 1: it joins"), "{said}");
    let said = said_of_tables("txt", "0 0 0 1\n2 0 0 -1\n", "1 2\n");
    assert!(
        said.contains("x.particles.txt: line 2: its radius is -1 m"),
        "{said}"
    );
}
