//! `--set`: values from the command line.

use dem_scene::scene_from_text;
use dem_scene::{BodySource, Scene, WallMotion, WallShape};

const SCENE: &str = r#"version = 1
[run]
end_time = 1
[materials.clay]
density = 2000
[bodies.bar]
particles = [[0, 0, 0, 1]]
material = "clay"
"#;

fn with(options: &[&str]) -> Result<Scene, String> {
    let options: Vec<String> = options.iter().map(|text| (*text).to_owned()).collect();
    scene_from_text(SCENE, "scenes/bar.toml", &options).map_err(|error| error.to_string())
}

#[test]
fn options_replace_values() {
    for text in [
        "run.end_time=0.5",
        "run.end_time = 0.5",
        "run.end_time=\"0.5 s\"",
        "run.end_time='0.5 s'",
        "run.end_time=0.5 s",
        "run.end_time=500ms",
        "run = { end_time = 0.5 }",
    ] {
        assert_eq!(with(&[text]).unwrap().run.end_time_s, 0.5, "{text}");
    }
    let moved = with(&["bodies.bar.position=[0, 0, \"1 mm\"]"]).unwrap();
    assert_eq!(moved.bodies["bar"].position_m, [0.0, 0.0, 0.001]);
    let twice = with(&["run.end_time=2", "run.end_time=3"]).unwrap();
    assert_eq!(twice.run.end_time_s, 3.0);
}

#[test]
fn options_add_keys_and_tables() {
    let scene = with(&[
        "bonds.weak.young_modulus=1 MPa",
        "bonds.weak.poisson_ratio=0.2",
        "bonds.weak.failure.tensile_strength=1 kPa",
        "output.folder=elsewhere",
        "bodies.other.file=a=b.vtp",
        "bodies.other.material=clay",
    ])
    .unwrap();
    assert_eq!(scene.bonds["weak"].young_modulus_pa, 1e6);
    assert_eq!(scene.bonds["weak"].failure.tensile_strength_pa, Some(1e3));
    // Names typed in a shell are relative to its folder.
    let folder = scene.output.unwrap().folder;
    assert_eq!(folder, Some("elsewhere".into()));
    let file = &scene.bodies["other"].source;
    assert_eq!(*file, BodySource::File("a=b.vtp".into()));
}

/// Pairs of materials and walls are set like all other keys.
#[test]
fn options_add_contacts_and_walls() {
    let scene = with(&[
        "materials.clay.young_modulus=1 MPa",
        "contacts.clay-clay.restitution=50 %",
        "walls.plate.stl=plate.stl",
        "walls.plate.unit=mm",
        "walls.plate.material=clay",
        "walls.plate.servo.force=-2 N",
        "walls.plate.servo.direction=[0, 0, 1]",
        "walls.plate.servo.max_velocity=1 mm/s",
        "search.skin=0.2",
    ])
    .unwrap();
    assert_eq!(scene.contacts[0].restitution, 0.5);
    let WallShape::Stl { path, .. } = &scene.walls["plate"].shape else {
        panic!("no STL");
    };
    assert_eq!(path.to_str(), Some("plate.stl"));
    let WallMotion::Servo { force_n, .. } = scene.walls["plate"].motion else {
        panic!("no servo");
    };
    assert_eq!(force_n, -2.0);
    assert_eq!(scene.search.skin, Some(0.2));
}

/// A 3MF has a unit of its own; other files need one in the scene.
#[test]
fn only_a_3mf_needs_no_unit() {
    let wall = |file: &str| {
        let file = format!("walls.plate.stl={file}");
        with(&[
            &file,
            "walls.plate.material=clay",
            "materials.clay.young_modulus=1 MPa",
        ])
    };
    for name in ["plate.3mf", "PLATE.3MF"] {
        let scene = wall(name).unwrap();
        let WallShape::Stl { unit_m, .. } = &scene.walls["plate"].shape else {
            panic!("no surface");
        };
        assert_eq!(*unit_m, None);
        assert!(scene.describe().contains("that of the file"));
    }
    for name in ["plate.stl", "plate.obj", "plate.ply"] {
        let said = wall(name).unwrap_err().clone();
        assert!(said.contains("walls.plate.unit is missing"), "{said}");
    }
}

#[test]
fn bad_options_are_refused_by_name() {
    for (text, message) in [
        (
            "run.end_tim=0.5",
            "--set run.end_tim=0.5: unknown key run.end_tim; did you mean 'end_time'?",
        ),
        (
            "rum.end_time=0.5",
            "--set rum.end_time=0.5: unknown table [rum]; did you mean 'run'?",
        ),
        (
            "run.end_time=-1",
            "--set run.end_time=-1: run.end_time is -1, but must be more than 0 s; write a time such as \"5 ms\"",
        ),
        (
            "run.end_time=5 mm",
            "--set run.end_time=5 mm: run.end_time: '5 mm' is not a time: unknown unit 'mm'; use one of ns, us, ms, s, min, h",
        ),
        (
            "run.end_time=",
            "--set run.end_time=: run.end_time: '' is not a time; write a number with a unit, such as 5 ms",
        ),
        (
            "run.end_time",
            "--set run.end_time: there is no =; write KEY=VALUE, such as run.end_time=\"0.5 s\"",
        ),
        (
            "run..rest=1",
            "--set run..rest=1: a key is empty; write KEY=VALUE, such as run.end_time=\"0.5 s\"",
        ),
        (
            "run.end_time.now=1",
            "--set run.end_time.now=1: run.end_time is no table; set it as a whole",
        ),
        (
            "run.gravity=[0, 0",
            "--set run.gravity=[0, 0: the value is not TOML: unclosed array, expected `]`; correct the value, and keep the shell from changing it with '...' around",
        ),
        (
            "bodies.bar.material=mud",
            "--set bodies.bar.material=mud: bodies.bar.material is \"mud\", but nothing in [materials] has this name; known: clay",
        ),
        (
            "bonds.weak.poisson_ratio=0.2",
            "--set bonds.weak.poisson_ratio=0.2: bonds.weak.young_modulus is missing; add young_modulus = \"15 MPa\"",
        ),
    ] {
        assert_eq!(with(&[text]), Err(message.to_owned()), "{text}");
    }
}

/// A message repeats a long option only in part, and on one line.
#[test]
fn long_options_are_shortened() {
    let text = format!("run.rest_energy_ratio=\"{}\n\"", "x".repeat(1000));
    let message = with(&[&text]).unwrap_err();
    assert!(message.len() < 300 && !message.contains('\n'), "{message}");
}

/// A value that makes a line of the file wrong is named with that line.
#[test]
fn an_option_that_makes_a_line_wrong_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bar.toml");
    let rigid = format!("{SCENE}start_as = \"clump\"\n");
    std::fs::write(&file, &rigid).unwrap();
    let refused = |options: &[&str]| {
        let options: Vec<String> = options.iter().map(|text| (*text).to_owned()).collect();
        let said = dem_scene::read_scene(&file, &options)
            .unwrap_err()
            .to_string();
        said.replace(&file.display().to_string(), "bar.toml")
    };
    let said = refused(&["run.end_time=2", "run.integrator=static"]);
    assert!(
        said.starts_with("--set run.integrator=static: bar.toml:"),
        "{said}"
    );
    let said = refused(&["run.end_time=2", "run.end_time=-1"]);
    assert!(said.starts_with("--set run.end_time=-1: "), "{said}");
    let wrong = rigid.replace("density = 2000", "density = -1");
    std::fs::write(&file, wrong).unwrap();
    let said = refused(&["run.end_time=2"]);
    assert!(said.starts_with("bar.toml:5: "), "{said}");
}
