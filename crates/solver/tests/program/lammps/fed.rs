//! Inlets become molecules that are fed.

use std::fs;

use dem_io::body::{read_frame, read_particles};

use super::{exported, go, near, refused_export};
use crate::program::{Bench, refused};

/// Three spheres as a clump and single spheres, fed by an inlet.
const FED: &str = r#"version = 1
[run]
end_time = "10 ms"
time_step = "1 us"
gravity = [0, 0, -9.81]
[materials.grain]
density = "2000 kg/m3"
young_modulus = "10 MPa"
poisson_ratio = 0.3
[materials.plate]
young_modulus = "210 GPa"
poisson_ratio = 0.3
[contacts]
grain-grain = { restitution = 0.5, friction = 0.4 }
grain-plate = { restitution = 0.6, friction = 0.3 }
[bodies.rod]
material = "grain"
start_as = "clump"
particles = [[0, 0, 0, 0.004], [0.008, 0, 0, 0.004], [0.016, 0, 0, 0.004]]
[bodies.pebble]
material = "grain"
particles = [[0, 0, 0, 0.005]]
[bodies.there]
material = "grain"
particles = [[0, 0, 0.0051, 0.005]]
[regions.above]
cylinder = { from = [0, 0, 0.1], to = [0, 0, 0.2], radius = "50 mm" }
[inlets.feed]
bodies = { pebble = 1, rod = 3 }
region = "above"
rate = "4000 /s"
count = 20
start = "2 ms"
end = "8 ms"
velocity = [0, "0.5 m/s", "-1 m/s"]
orientation = "random"
[walls.plate]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
material = "plate"
[output]
frames = "1 ms"
"#;

/// The rows of a section of a molecule file.
fn section(text: &str, name: &str) -> Vec<Vec<f64>> {
    let mut lines = text.lines().skip_while(|line| *line != name).skip(2);
    let rows = lines.by_ref().take_while(|line| !line.is_empty());
    rows.map(|row| row.split(' ').map(|word| word.parse().unwrap()).collect())
        .collect()
}

#[test]
fn inlets_feed_molecules() {
    let bench = Bench::new();
    bench.write("scene.toml", FED);
    let export = exported(&bench, "scene.toml");
    // A fourth of 4,000 in a second are pebbles, the rest rods.
    let text = |name: &str| fs::read_to_string(bench.path(name)).unwrap();
    let sphere = text("out/fed-1.molecule");
    let mass = |radius: f64| 2000.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    assert_eq!(section(&sphere, "Diameters"), [[1.0, 0.01]]);
    assert_eq!(section(&sphere, "Types"), [[1.0, 3.0]]);
    near(section(&sphere, "Masses")[0][1], mass(0.005));
    let clump = text("out/fed-2.molecule");
    let places = section(&clump, "Coords");
    near(places[2][1] - places[0][1], 0.016);
    assert_eq!(
        section(&clump, "Types"),
        [[1.0, 4.0], [2.0, 4.0], [3.0, 4.0]]
    );
    let masses: f64 = section(&clump, "Masses").iter().map(|row| row[1]).sum();
    near(masses, 3.0 * mass(0.004));
    let line = |end: &str| {
        let line = clump
            .lines()
            .find_map(|line| line.strip_suffix(end))
            .unwrap();
        let words = line.split_whitespace();
        words
            .map(|word| word.parse().unwrap())
            .collect::<Vec<f64>>()
    };
    near(line("mass")[0], masses);
    assert_eq!(line("com"), [0.0; 3]);
    let own = 3.0 * 0.4 * mass(0.004) * 0.004_f64.powi(2);
    let across = own + 2.0 * mass(0.004) * 0.008_f64.powi(2);
    for (found, wanted) in line("inertia").iter().zip([own, across, across]) {
        near(*found, wanted);
    }
    let feed = |number: usize| export.said(&format!("fix feed_{number}"));
    let near_m = "near 1e-2";
    let motion = "vx 0e0 0e0 vy 5e-1 5e-1 vz -1e0 -1e0 units box";
    let [one, other] = [feed(1), feed(2)];
    assert!(
        one.starts_with("fed_1 deposit 5 0 1000 ")
            && one.ends_with(&format!("region inlet_1 {near_m} mol sphere_1 {motion}")),
        "{one}"
    );
    assert!(
        other.starts_with("fed_2 deposit 15 0 333 ")
            && other.ends_with(&format!(
                "region inlet_2 {near_m} mol fed molfrac 1e0 rigid clumps {motion}"
            )),
        "{other}"
    );
    assert_eq!(
        export.said("region inlet_2"),
        "cylinder z 0e0 0e0 5e-2 1e-1 2e-1 units box"
    );
    assert_eq!(export.said("molecule fed"), "fed-2.molecule");
    assert_eq!(
        export.said("fix clumps clumps"),
        "rigid/small molecule gravity gravity mol fed"
    );
    let runs: Vec<String> = (export.script.iter())
        .filter(|words| words.first().is_some_and(|word| word == "run"))
        .map(|words| words[1].clone())
        .collect();
    assert_eq!(runs, ["2000", "8000"]);
    // Each type has the law of its material, at walls too.
    let laws: Vec<&Vec<String>> = (export.script.iter())
        .filter(|words| words.first().is_some_and(|word| word == "pair_coeff"))
        .collect();
    assert_eq!(laws.len(), 10);
    assert_eq!(export.said("pair_coeff 3 4"), export.said("pair_coeff 1 1"));
    assert_eq!(export.said("pair_coeff 2 3"), export.said("pair_coeff 1 2"));
    let at_wall = export.said("fix wall_1_1 material_1");
    assert_eq!(export.said("fix wall_1_fed_2 fed_2"), at_wall);
}

#[test]
fn fed_bodies_come_back_as_bodies() {
    let bench = Bench::new();
    bench.write("scene.toml", FED);
    exported(&bench, "scene.toml");
    let there = "1 1 1 0.005 0 0 0.0051 0 0 0 0 0 0";
    let sphere = "2 2 3 0.005 0.01 0 0.15 0 0.5 -1 0 0 0";
    let clump: String = (0..3)
        .map(|n| {
            format!(
                "{} 3 4 0.004 {} 0 0.12 0 0.5 -1 0 0 0\n",
                3 + n,
                0.008 * f64::from(n)
            )
        })
        .collect();
    let frame = |time: f64, rows: &str| {
        format!(
            "ITEM: TIME\n{time}\nITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS mm mm mm\n-1 1\n-1 1\n-1 1\nITEM: ATOMS id mol type radius x y z vx vy vz omegax omegay omegaz\n{rows}",
            (time * 1e6) as u64,
            rows.lines().count()
        )
    };
    let dump =
        frame(0.0, &format!("{there}\n")) + &frame(0.003, &format!("{there}\n{sphere}\n{clump}"));
    bench.write("out/frames.dump", &dump);
    let done = go(&bench, &["import", "out", "-o", "back", "-q"]);
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let path = bench.path("back/frames/frame_000001.vtp");
    let frame = read_particles(&path).unwrap();
    let names: Vec<&str> = (frame.bodies.iter())
        .map(|of| frame.body_names[*of as usize].as_str())
        .collect();
    assert_eq!(names, ["there", "pebble", "rod", "rod", "rod"]);
    assert_eq!(frame.fragments.unwrap(), [0, 1, 2, 2, 2]);
    near(read_frame(&path).unwrap().densities_kg_m3[3], 2000.0);
    bench.write(
        "out/frames.dump",
        dump.replace("2 2 3 0.005", "2 4000 3 0.005"),
    );
    let (said, code) = refused(&go(&bench, &["import", "out", "-o", "other"]));
    assert!(
        code == 2 && said.contains("atom 2 is of molecule 4000"),
        "{said}"
    );
}

#[test]
fn inlets_that_deposit_has_no_word_for_are_refused() {
    let bench = Bench::new();
    for (from, to, expected) in [
        ("orientation = \"random\"\n", "", "inlets.feed.orientation"),
        (
            "orientation = \"random\"\n",
            "orientation = \"random\"\nangular_velocity = [0, 0, \"1 rad/s\"]\n",
            "inlets.feed.angular_velocity",
        ),
        (
            "to = [0, 0, 0.2]",
            "to = [0, 0.1, 0.2]",
            "inlets.feed.region",
        ),
    ] {
        assert!(FED.contains(from), "{from}");
        bench.write("scene.toml", FED.replace(from, to));
        let said = refused_export(&bench, &["scene.toml"]);
        let part = format!(": {expected}: ");
        assert!(
            said.contains(&part) && said.contains(", as LAMMPS has no word"),
            "{said}"
        );
    }
}
