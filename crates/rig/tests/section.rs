//! The section of a tested body and the pressed part of its ends, measured on its particles.

use std::collections::BTreeMap;
use std::path::Path;

fn scene(text: &str) -> Scene {
    scene_from_text(text, "test.toml", &[]).unwrap_or_else(|error| panic!("{error}: {text}"))
}

use dem_rig::plan_with_test;
use dem_scene::{Scene, read_bodies, read_scene, scene_from_text};

/// Half the distance of neighbours in the block, m.
const R: f64 = 3e-3;

/// A block of 6 x 6 x 10 spheres of 6 mm between plates, turned by an angle about y. `upper`: shape
/// of the upper plate; `more`: lines of [test].
fn block(upper: &str, degrees: f64, kind: &str, more: &str) -> String {
    let mut particles = Vec::new();
    for k in 0..10 {
        for j in 0..6 {
            for i in 0..6 {
                let place = [i, j, k].map(|n| f64::from(n) * 2.0 * R);
                particles.push(format!("[{}, {}, {}, {R}]", place[0], place[1], place[2]));
            }
        }
    }
    format!(
        r#"version = 1
[run]
end_time = "1 ms"
time_step = "1 us"
[materials.rock]
density = 2500
young_modulus = "1 GPa"
poisson_ratio = 0.3
[materials.steel]
rigid = true
[contacts]
rock-rock = {{ restitution = 0.5, friction = 0.5 }}
rock-steel = {{ restitution = 0.5, friction = 0.1 }}
[bodies.block]
particles = [{}]
material = "rock"
rotation = {{ axis = [0, 1, 0], angle = "{degrees} deg" }}
[walls.lo]
plane = {{ point = [0, 0, -0.05], normal = [0, 0, 1] }}
material = "steel"
[walls.hi]
{upper}
material = "steel"
[test]
type = "{kind}"
crosshead = ["hi"]
direction = [0, 0, -1]
{more}
"#,
        particles.join(", ")
    )
}

const PLANE: &str = "plane = { point = [0, 0, 0.2], normal = [0, 0, -1] }";
const STROKE: &str = "stroke = \"1 mm\"\n";
const BARS: &str = r#"transmission_bar = "lo"
bars = { density = "7850 kg/m3", young_modulus = "210 GPa", diameter = "60 mm" }
striker = { length = "200 mm", velocity = "5 m/s" }
"#;

/// Section, pressed part and warnings on the test.
fn looked(text: &str) -> (f64, Option<f64>, Vec<String>) {
    let scene = scene(text);
    let bodies = read_bodies(&scene).unwrap_or_else(|_| BTreeMap::new());
    let (planned, setup) =
        plan_with_test(&scene, bodies, 1, true).unwrap_or_else(|error| panic!("{error}"));
    let setup = setup.unwrap();
    for warning in &setup.warnings {
        assert!(planned.warnings.contains(warning), "{warning}");
    }
    (setup.section_m2.unwrap(), setup.pressed, setup.warnings)
}

/// 36 mm x 36 mm, whatever the test says.
#[test]
fn the_section_of_a_block_is_measured_beside_the_one_given() {
    for (kind, more) in [("compression", STROKE), ("hopkinson-pressure", BARS)] {
        for (given, is_right) in [
            ("", true),
            ("1296 mm2", true),
            ("1250 mm2", true),
            ("1200 mm2", false),
            ("12.96 mm2", false),
        ] {
            let area = match given {
                "" => String::new(),
                given => format!("area = \"{given}\"\n"),
            };
            let (section_m2, pressed, warnings) =
                looked(&block(PLANE, 0.0, kind, &(more.to_owned() + &area)));
            assert!((section_m2 / 1296e-6 - 1.0).abs() < 1e-3, "{section_m2}");
            assert!((pressed.unwrap() - 1.0).abs() < 1e-3, "{pressed:?}");
            assert_eq!(
                warnings.is_empty(),
                is_right,
                "{kind} {given}: {warnings:?}"
            );
            if !is_right {
                assert!(warnings[0].starts_with("test.area is"), "{warnings:?}");
            }
        }
        let (.., warnings) = looked(&block(
            PLANE,
            0.0,
            kind,
            &format!("{more}length = \"40 mm\"\n"),
        ));
        assert!(
            warnings.len() == 1 && warnings[0].contains("test.length"),
            "{warnings:?}"
        );
    }
}

/// A plate that covers a part of the end, and a block that stands askew.
#[test]
fn small_plates_and_oblique_blocks_are_doubtful() {
    // From x = 15 mm on: half of the 36 mm that begin at -3 mm.
    let half = "box = { min = [0.015, -0.1, 0.1], max = [0.1, 0.1, 0.12] }";
    let (_, pressed, warnings) = looked(&block(half, 0.0, "compression", STROKE));
    assert!((pressed.unwrap() - 0.5).abs() < 0.01, "{pressed:?}");
    assert!(
        warnings[0].starts_with("the loaded end of the body 'block' is pressed over 50 %"),
        "{warnings:?}"
    );
    // A round plate of 30 mm.
    let round =
        "cylinder = { from = [0.015, 0.015, 0.1], to = [0.015, 0.015, 0.12], radius = 0.015 }";
    let (_, pressed, _) = looked(&block(round, 0.0, "compression", STROKE));
    let wanted = std::f64::consts::PI * 15.0 * 15.0 / 1288.3;
    assert!(
        (pressed.unwrap() - wanted).abs() < 0.01,
        "{pressed:?} {wanted}"
    );
    let whole = "box = { min = [-0.1, -0.1, 0.1], max = [0.1, 0.1, 0.12] }";
    let (.., warnings) = looked(&block(whole, 0.0, "compression", STROKE));
    assert_eq!(warnings, Vec::<String>::new());
    let (.., warnings) = looked(&block(PLANE, 6.0, "compression", STROKE));
    assert!(
        warnings
            .iter()
            .any(|one| one.contains("stands askew between the plates, by")),
        "{warnings:?}"
    );
}

/// The formulas take the dimensions of the measured specimen, and differences are named.
#[test]
fn dimensions_of_the_measured_specimen_are_taken() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("measured.json");
    let statistic = r#"{ "mean": 1.0, "standard_deviation": 0.0, "count": 1 }"#;
    let taken = |length_m: f64, area_m2: f64, more: &str| {
        let json = format!(
            r#"{{ "version": 1, "type": "compression", "dimensions": {{ "length_m": {length_m}, "area_m2": {area_m2} }},
            "young_modulus_pa": {statistic}, "strength_pa": {statistic}, "stiffness_n_m": {statistic},
            "failure_force_n": {statistic}, "travel_at_failure_m": {statistic},
            "linear_part": [{statistic}, {statistic}], "specimens": [], "left_out": [],
            "curve": [{{ "displacement_m": 0, "load_n": 0, "standard_deviation_n": 0 }},
                      {{ "displacement_m": 1, "load_n": 1, "standard_deviation_n": 0 }}] }}"#
        );
        std::fs::write(&file, json).unwrap();
        let more = format!(
            "{STROKE}measured = {:?}\n{more}",
            file.display().to_string()
        );
        let scene = scene(&block(PLANE, 0.0, "compression", &more));
        let bodies = read_bodies(&scene).unwrap();
        let (planned, setup) = plan_with_test(&scene, bodies, 1, true).unwrap();
        let setup = setup.unwrap();
        let dem_laboratory::Specimen::Bar { length_m, area_m2 } = setup.specimen else {
            panic!("no bar");
        };
        let named = ["the length is", "the area is", "test.area is"]
            .map(|start| planned.notes.iter().any(|note| note.starts_with(start)));
        ([length_m, area_m2], named)
    };
    let near = |(sizes, named): ([f64; 2], [bool; 3]), wanted: [f64; 2], said: [bool; 3]| {
        assert_eq!(named, said, "{sizes:?}");
        for (size, wanted) in sizes.iter().zip(wanted) {
            assert!((size / wanted - 1.0).abs() < 1e-9, "{sizes:?}");
        }
    };
    // The body has 60 mm and 36 mm x 36 mm.
    near(
        taken(0.0605, 1.25e-3, ""),
        [0.0605, 1.25e-3],
        [false, true, false],
    );
    near(
        taken(0.055, 1.29e-3, ""),
        [0.055, 1.29e-3],
        [true, false, false],
    );
    // Another specimen, of which the curve is scaled.
    near(
        taken(0.03, 0.6e-3, ""),
        [0.06, 1.296e-3],
        [true, true, false],
    );
    near(
        taken(0.06, 1.25e-3, "area = \"1296 mm2\"\n"),
        [0.06, 1.296e-3],
        [false, false, true],
    );
}

/// Half the length in which the crack belongs, m, and the section, m2, of the dog bone between
/// bars.
fn of_bone(set: &[&str]) -> (f64, f64) {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/scenes/hopkinson-tension.toml"
    );
    let set: Vec<String> = set.iter().map(|set| (*set).to_owned()).collect();
    let scene = read_scene(Path::new(path), &set).unwrap_or_else(|error| panic!("{error}"));
    let bodies = read_bodies(&scene).unwrap_or_else(|error| panic!("{error}"));
    let (_, setup) =
        plan_with_test(&scene, bodies, 1, true).unwrap_or_else(|error| panic!("{error}"));
    let setup = setup.unwrap();
    (setup.crack_within_m, setup.section_m2.unwrap())
}

/// A neck of 24 mm x 176.7 mm2 in a body of 80 mm: the crack belongs anywhere in it. Without length
/// and area of the neck it belongs in the middle half of what is taken for a bar.
#[test]
fn length_and_area_of_a_neck_say_where_the_crack_belongs() {
    let run = ["run.end_time=1e-3", "run.time_step=1e-8"];
    let (within_m, section_m2) = of_bone(&run);
    assert!((within_m - 12e-3).abs() < 1e-9, "{within_m}");
    assert!((section_m2 / 176.7e-6 - 1.0).abs() < 0.1, "{section_m2}");
    let (bar_m, mean_m2) = of_bone(&[run[0], run[1], "test.area=\"400 mm2\""]);
    assert!((bar_m - 6e-3).abs() < 1e-9, "{bar_m}");
    assert!(mean_m2 > 1.1 * section_m2, "{mean_m2} {section_m2}");
}
