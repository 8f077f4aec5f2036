//! Every difficult shape that cannot be packed: one message that names file, place and cause, and
//! no files left.

use super::{Bench, refusal, shape};

/// The message for a shape of the folder.
fn refused(name: &str, diameter: &str) -> String {
    let bench = Bench::new();
    let file = shape(name);
    let output = bench.run(
        &file,
        &["--diameter", diameter, "--overlap", "0", "-o", "body.vtp"],
    );
    let said = refusal(&output, &file);
    assert!(
        said.starts_with(&format!("error: {}: ", file.display())),
        "the file is not named: {said}"
    );
    assert_eq!(said.lines().count(), 1, "{said}");
    assert_eq!(
        bench.files(),
        Vec::<String>::new(),
        "{name}: something was left behind"
    );
    said
}

fn assert_says(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "'{part}' is not in: {said}");
    }
}

#[test]
fn files_that_are_no_solid() {
    let diameter = "1mm..1.5mm";
    assert_says(
        &refused("06", diameter),
        &["not closed", "10 open edges", "2 holes", "--fill-holes"],
    );
    assert_says(&refused("15", diameter), &["contains no triangles"]);
    assert_says(
        &refused("17", diameter),
        &["truncated: header promises 5120 triangles (256084 bytes), file has 50107"],
    );
    assert_says(&refused("24", diameter), &["triangle 18", "NaN"]);
    assert_says(&refused("31", diameter), &["not an STL"]);
    assert_says(&refused("33", diameter), &["line 58", "truncated"]);
}

#[test]
fn a_plate_thinner_than_the_spheres() {
    for diameter in ["1mm..1.5mm", "1.1mm..1.5mm", "2mm"] {
        assert_says(
            &refused("13", diameter),
            &["inscribed sphere has diameter 1 mm", "smaller diameters"],
        );
    }
    assert_says(
        &refused("13", "1.1mm..1.5mm"),
        &["no sphere fits", "1.1 mm"],
    );
}
