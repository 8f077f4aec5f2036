//! The places of keys: file and line, or the option.

use std::fs;

use dem_scene::Places;
use tempfile::tempdir;

const SCENE: &str = "version = 1
run.end_time = 1
[contacts]
grain-coarse-plate = { restitution = 0.5, friction = 0.4 }
[walls.plate]
material = \"plate\"
[walls.plate.plane]
point = [0, 0, 0]
";

#[test]
fn keys_are_found_in_the_file_or_among_the_options() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, SCENE).unwrap();
    let included = folder.path().join("more.toml");
    fs::write(&included, "\n[bonds.grain]\nmodel = \"beam\"\n").unwrap();
    let file = path.display().to_string();
    let options = [
        "run.gravity=[0, 0, -1]".to_owned(),
        format!("include+=[\"{}\"]", included.display()),
    ];
    let places = Places::read(&path, &options).unwrap();
    let line = |number: usize| Some(format!("{file}:{number}"));
    for (key, wanted) in [
        ("run.end_time", line(2)),
        ("walls.plate", line(5)),
        ("walls.plate.material", line(6)),
        ("walls.plate.plane.point", line(8)),
        // What is not written has the place of its table.
        ("walls.plate.surface_velocity", line(5)),
        ("contacts.grain-coarse-plate.friction", line(4)),
        // Pairs are one in either order.
        ("contacts.plate-grain-coarse.friction", line(4)),
        ("contacts.coarse-plate-grain", line(4)),
        ("contacts.plate-coarse-grain", None),
        ("walls.other", None),
        ("sleep", None),
        (
            "run.gravity",
            Some("--set run.gravity=[0, 0, -1]".to_owned()),
        ),
        (
            "bonds.grain.model",
            Some(format!("{}:3", included.display())),
        ),
    ] {
        assert_eq!(places.of(key), wanted, "{key}");
    }
    assert!(Places::read(&folder.path().join("none.toml"), &[]).is_err());
}
