//! What LAMMPS has no word for is refused by name.

use std::fs;

use super::{SCENE, go, refused_export};
use crate::program::{Bench, refused, root, scene_of_data};

#[test]
fn everything_else_is_refused_by_name() {
    let cases = [
        (
            "friction = 0.3 }",
            "friction = 0.3, rolling_friction = 0.1 }",
            "rolling_friction: LAMMPS has no word for it: the spring of its rolling friction",
        ),
        (
            "friction = 0.3 }",
            "friction = 0.3, liquid_bridge = { surface_tension = 0.073, volume = \"1 mm3\" } }",
            "liquid_bridge: LAMMPS has no word for it: liquid between its ends",
        ),
        (
            "restitution = 0.5",
            "restitution = 0.1",
            "contacts.grain-grain.restitution: LAMMPS has no word for it: it needs a damping ratio of",
        ),
        (
            "tensile_strength = \"1 MPa\"",
            "von_mises_strength = \"1 MPa\"",
            "bonds.grain.failure.von_mises_strength: LAMMPS has no word for it",
        ),
        (
            "tensile_strength = \"1 MPa\"",
            "compressive_strength = \"1 MPa\"",
            "bonds.grain.failure.compressive_strength: LAMMPS has no word for it",
        ),
        (
            "tensile_strength = \"1 MPa\"",
            "tensile_strength = \"1 MPa\", shear_strength = \"1 MPa\"",
            "bonds.grain.failure.shear_strength: LAMMPS has no word for it: bpm/rotational adds tension and shear",
        ),
        (
            "tensile_strength = \"1 MPa\"",
            "tensile_strength = \"1 MPa\", rate_strengthening = \"1 1/s\"",
            "bonds.grain.failure.rate_strengthening: LAMMPS has no word for it",
        ),
        (
            "tensile_strength = \"1 MPa\"",
            "tensile_strength = 0",
            "bonds.grain.failure.tensile_strength: LAMMPS has no word for it: a limit",
        ),
        (
            "model = \"timoshenko\"",
            "model = \"timoshenko\"\nformulation = \"incremental\"",
            "bonds.grain.formulation: LAMMPS has no word for it",
        ),
        (
            "model = \"timoshenko\"",
            "model = \"parallel\"",
            "bonds.grain.model: LAMMPS has no word for it: in this model shear does not act in the middle",
        ),
        (
            "model = \"timoshenko\"",
            "model = \"rojek\"",
            "bonds.grain.model: LAMMPS has no word for it: in this model shear does not act in the middle",
        ),
        (
            "model = \"timoshenko\"",
            "model = \"flat-joint\"",
            "bonds.grain.model: LAMMPS has no word for it: bonds of bpm/rotational break as a whole",
        ),
        (
            "failure = { tensile",
            "plasticity = { normal_yield_strength = \"0.1 MPa\" }\nfailure = { tensile",
            "bonds.grain.plasticity: LAMMPS has no word for it: bonds of bpm/rotational are elastic",
        ),
        (
            "tensile_strength = \"1 MPa\"",
            "tensile_strength = \"1 MPa\", fracture_energy = \"1 kJ/m2\"",
            "bonds.grain.failure.fracture_energy: LAMMPS has no word for it: bonds of bpm/rotational break",
        ),
        (
            "[0.0091, 0, 0.02",
            "[0.0089, 0, 0.02",
            "[bodies.pair]: LAMMPS has no word for it: 1 pair of its particles overlap",
        ),
        (
            "force = [0, 0, \"-2 N\"]",
            "force = [0, 0, \"-2 N\"]\ntorque = [\"1 N m\", 0, 0]",
            "[loads.push]: LAMMPS has no word for it: fix addtorque",
        ),
        (
            "fixed = true",
            "fixed = [\"x\"]",
            "[supports.hold]: LAMMPS has no word for it: fix freeze holds all six",
        ),
        (
            "fixed = true",
            "fixed = true\nend = \"5 ms\"",
            "[supports.hold]: LAMMPS has no word for it: a fix that holds",
        ),
        (
            "velocity = [\"-1 m/s\", 0, 0]",
            "angular_velocity = [\"1 rad/s\", 0, 0]",
            "[walls.block]: LAMMPS has no word for it: the exported regions move, but do not turn",
        ),
        (
            "normal = [0, 0, 2] }",
            "normal = [0, 0, 2] }\nsurface_velocity = [\"1 m/s\", 0, 0]",
            "walls.plate.surface_velocity: LAMMPS has no word for it: its walls have no belt",
        ),
        (
            "to = [-0.1, 1, 0.1]",
            "to = [-0.2, 1, 0.1]",
            "[walls.roll]: LAMMPS has no word for it: the region cylinder is along an axis",
        ),
        (
            "normal = [0, 0, 2] }",
            "normal = [0, 0, 2] }\nservo = { force = \"1 N\", direction = [0, 0, 1], max_velocity = \"1 m/s\" }",
            "[walls.plate]: LAMMPS has no word for it: a wall that moves",
        ),
        (
            "max = [0.2, 1, 1] }",
            "max = [0.2, 1, 1] }\nrotation = { axis = [0, 1, 0], angle = \"10 deg\" }",
            "[walls.block]: LAMMPS has no word for it: the region block is along the axes",
        ),
        (
            "ramp = \"2 ms\"",
            "table = [[0, 0], [\"1 ms\", 1]]",
            "[walls.block]: LAMMPS has no word for it: the path of a wall",
        ),
        (
            "gravity = [0, 0, -9.81]",
            "gravity = [0, 0, -9.81]\ninitial_overlap = \"relax\"",
            "run.initial_overlap = \"relax\": LAMMPS has no word for it",
        ),
        (
            "[output]",
            "[sleep]\nspeed = \"1 mm/s\"\n[output]",
            "[sleep]: LAMMPS has no word for it: bodies that sleep",
        ),
        (
            "[output]",
            "[regions.out]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\n[outlets.gate]\ninside = \"out\"\n[output]",
            "[outlets.gate]: LAMMPS has no word for it",
        ),
    ];
    let bench = Bench::new();
    for (old, new, expected) in cases {
        assert!(SCENE.contains(old), "{old}");
        bench.write("scene.toml", SCENE.replacen(old, new, 1));
        let said = refused_export(&bench, &["scene.toml"]);
        assert!(says(&said, expected), "{new}: {said}");
        assert!(said.starts_with("error: scene.toml:"), "{said}");
        assert!(!bench.path("out").exists(), "{new}");
    }
    let left: Vec<_> = fs::read_dir(bench.path("")).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

/// Whether a message has a part and its reason, with what to do about it between them.
fn says(said: &str, expected: &str) -> bool {
    const NO_WORD: &str = ": LAMMPS has no word for it";
    let (part, why) = expected.split_once(NO_WORD).unwrap_or((expected, ""));
    let Some((_, after)) = said.split_once(&format!("{part}: ")) else {
        return false;
    };
    let Some((todo, reason)) = after.split_once(", as LAMMPS has no word for it") else {
        return false;
    };
    !todo.is_empty() && reason.starts_with(why)
}

#[test]
fn all_refusals_are_in_one_message_with_what_to_do_first_and_their_lines() {
    let bench = Bench::new();
    let mut scene = SCENE.to_owned();
    for (old, new) in [
        ("[0.0091, 0, 0.02", "[0.0089, 0, 0.02"),
        (
            "friction = 0.3 }",
            "friction = 0.3, rolling_friction = 0.1 }",
        ),
        (
            "tensile_strength = \"1 MPa\"",
            "von_mises_strength = \"1 MPa\"",
        ),
        ("fixed = true", "fixed = [\"x\"]"),
        ("[output]", "[sleep]\nspeed = \"1 mm/s\"\n[output]"),
        ("ramp = \"2 ms\"", "table = [[0, 0], [\"1 ms\", 1]]"),
    ] {
        assert!(scene.contains(old), "{old}");
        scene = scene.replacen(old, new, 1);
    }
    // The plate of the pair may stand first: its line is found all the same.
    scene = scene.replace("grain-plate =", "plate-grain =");
    bench.write("scene.toml", &scene);
    let said = refused_export(&bench, &["scene.toml"]);
    let head = "error: scene.toml: 6 things to change before LAMMPS can run it: 1. scene.toml:";
    assert!(said.starts_with(head), "{said}");
    let line = |text: &str| 1 + scene.lines().position(|line| line.contains(text)).unwrap();
    for (number, text, part, todo, limit) in [
        (
            1,
            "[bodies.pair]",
            "[bodies.pair]",
            "pack it without overlap (dem-pack --overlap 0)",
            "1 pair of its particles overlap",
        ),
        (2, "[sleep]", "[sleep]", "leave it out", "bodies that sleep"),
        (
            3,
            "von_mises",
            "bonds.grain.failure.von_mises_strength",
            "use tensile_strength or shear_strength",
            "no equivalent stress",
        ),
        (
            4,
            "rolling_friction",
            "contacts.grain-plate.rolling_friction",
            "leave rolling_friction out",
            "does not follow the load",
        ),
        (
            5,
            "[walls.block]",
            "[walls.block]",
            "give a table of displacements instead",
            "the path of a wall is a formula",
        ),
        (
            6,
            "[supports.hold]",
            "[supports.hold]",
            "use fixed = true",
            "holds all six degrees of freedom",
        ),
    ] {
        let item = format!("{number}. scene.toml:{}: {part}: {todo}", line(text));
        assert!(
            said.contains(&item) && said.contains(limit),
            "{item}: {said}"
        );
    }
    assert!(!said.contains("7. "), "{said}");
    assert!(!bench.path("out").exists());
    // A key of --set is named as that.
    bench.write("scene.toml", SCENE);
    let set = "--set=supports.hold.end=5 ms";
    let said = refused_export(&bench, &["scene.toml", set]);
    let begin = "error: scene.toml:";
    assert!(
        said.starts_with(begin) && said.contains("[supports.hold]: leave end out"),
        "{said}"
    );
    let set = "--set=run.initial_overlap=relax";
    let said = refused_export(&bench, &["scene.toml", set]);
    let begin = "error: --set run.initial_overlap=relax: run.initial_overlap = \"relax\": move";
    assert!(said.starts_with(begin), "{said}");
}

#[test]
fn studies_of_laboratory_tests_bodies_and_full_folders_are_refused() {
    let bench = Bench::new();
    let scene = |name: &str| scene_of_data(name).display().to_string();
    let body = |name: &str, file: &str| {
        let path = root().join("data/bodies").join(file);
        format!("--body={name}={}", path.display())
    };
    let cake = body("cake", "cake.vtp");
    for (scene, option, expected) in [
        (
            scene("three-point-bending.toml"),
            body("sample", "sample-coarse.vtp"),
            "[test]: LAMMPS has no word for it",
        ),
        (
            scene("cantilever.toml"),
            "--set=run.integrator=static".to_owned(),
            "run.integrator = \"static\": LAMMPS has no word for it",
        ),
        (
            scene("chute.toml"),
            cake.clone(),
            "[replacement.cake]: LAMMPS has no word for it",
        ),
        (
            scene("chute-bonded.toml"),
            cake,
            "[outlets.below]: LAMMPS has no word for it",
        ),
        (
            "body.vtp".to_owned(),
            "--quiet".to_owned(),
            "this is not a scene",
        ),
    ] {
        let said = refused_export(&bench, &[&scene, &option]);
        let is_said = said.contains(expected) || says(&said, expected);
        assert!(is_said, "{expected}: {said}");
    }
    let (said, code) = refused(&go(&bench, &["export"]));
    assert!(
        code == 2 && said.contains("required arguments were not provided"),
        "{said}"
    );
    bench.write("scene.toml", SCENE);
    fs::create_dir(bench.path("full")).unwrap();
    bench.write("full/mine.txt", "mine");
    let (said, code) = refused(&go(
        &bench,
        &["export", "lammps", "scene.toml", "-o", "full"],
    ));
    assert!(
        code == 2 && said.contains("full: this folder is not empty"),
        "{said}"
    );
    assert_eq!(fs::read_dir(bench.path("full")).unwrap().count(), 1);
}
