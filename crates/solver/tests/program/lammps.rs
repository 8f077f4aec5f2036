//! Scenes for LAMMPS, read back by a reader of their own; what is refused; dumps back to frames.

mod surfaces;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Output;

use dem_io::body::{read_frame, read_particles};
use dem_run::lammps::bonds::{CLASS_WIDTH, Coefficients, classes};
use proptest::prelude::*;

use super::{Bench, dem_run, refused, scene_of_data};

/// What a data file and a script of LAMMPS say, word by word.
struct Export {
    /// By id: molecule, type, diameter, density, x, y, z.
    atoms: BTreeMap<u64, Vec<f64>>,
    /// By id: velocity and spin.
    velocities: BTreeMap<u64, Vec<f64>>,
    /// Type and ends of each bond.
    bonds: Vec<[u64; 3]>,
    /// The numbers of each type.
    types: BTreeMap<u64, Vec<f64>>,
    /// The lines of the script, without comments, as words.
    script: Vec<Vec<String>>,
}

impl Export {
    fn read(folder: &Path) -> Self {
        let text = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_default();
        let mut export = Self {
            atoms: BTreeMap::new(),
            velocities: BTreeMap::new(),
            bonds: Vec::new(),
            types: BTreeMap::new(),
            script: Vec::new(),
        };
        let data = text("particles.data");
        let mut section = "";
        for line in data.lines().skip(1) {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.first() {
                Some(&name @ ("Atoms" | "Velocities" | "Bonds")) => section = name,
                Some(first) if !section.is_empty() => {
                    let numbers: Vec<f64> = words[1..].iter().map(|w| w.parse().unwrap()).collect();
                    let id = first.parse().unwrap();
                    match section {
                        "Atoms" => assert!(export.atoms.insert(id, numbers).is_none()),
                        "Velocities" => assert!(export.velocities.insert(id, numbers).is_none()),
                        _ => export.bonds.push([0, 1, 2].map(|k| numbers[k] as u64)),
                    }
                }
                _ => {}
            }
        }
        for line in text("bond-types.lammps").lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            if words[0] == "bond_coeff" {
                let numbers = words[2..].iter().map(|w| w.parse().unwrap()).collect();
                export.types.insert(words[1].parse().unwrap(), numbers);
            }
        }
        for line in text("in.lammps").lines() {
            let words = line.split('#').next().unwrap().split_whitespace();
            export.script.push(words.map(str::to_owned).collect());
        }
        export
    }

    /// The words after the only line of the script that begins like this.
    fn said(&self, begin: &str) -> String {
        let lines: Vec<String> = self.script.iter().map(|words| words.join(" ")).collect();
        let found: Vec<&str> = lines.iter().filter_map(|l| l.strip_prefix(begin)).collect();
        assert_eq!(found.len(), 1, "{begin}: {found:?}");
        found[0].trim().to_owned()
    }

    fn number(&self, begin: &str) -> f64 {
        self.said(begin).parse().unwrap()
    }
}

fn go(bench: &Bench, words: &[&str]) -> Output {
    let mut command = dem_run();
    command.current_dir(bench.path("")).args(words);
    command.output().unwrap()
}

fn exported(bench: &Bench, scene: &str) -> Export {
    let done = go(bench, &["export", "lammps", scene, "-o", "out", "-q"]);
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success() && done.stdout.is_empty(), "{said}");
    Export::read(&bench.path("out"))
}

fn near(found: f64, wanted: f64) {
    assert!((found / wanted - 1.0).abs() < 1e-12, "{found} {wanted}");
}

/// Two bonded spheres above a plate, with everything that is carried over.
pub(super) const SCENE: &str = r#"version = 1
[run]
end_time = "10 ms"
time_step = "1 us"
gravity = [0, 0, -9.81]
local_damping = 0.1
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
[bonds.grain]
model = "timoshenko"
young_modulus = "100 MPa"
poisson_ratio = 0.25
radius_factor = 0.5
damping = { damping_ratio = 0.1, per_mode = true }
failure = { tensile_strength = "1 MPa" }
[bodies.pair]
material = "grain"
bonds = "grain"
particles = [[0, 0, 0.02, 0.004], [0.0091, 0, 0.02, 0.005]]
bond_list = [[0, 1]]
velocity = [0, "1 m/s", 0]
[groups.left]
particles = [0]
[groups.right]
particles = [1]
[loads.push]
group = "right"
force = [0, 0, "-2 N"]
ramp = "5 ms"
[supports.hold]
group = "left"
fixed = true
[walls.plate]
plane = { point = [0, 0, 0], normal = [0, 0, 2] }
material = "plate"
[walls.block]
box = { min = [0.1, -1, 0], max = [0.2, 1, 1] }
material = "plate"
velocity = ["-1 m/s", 0, 0]
ramp = "2 ms"
[walls.roll]
cylinder = { from = [-0.1, -1, 0.1], to = [-0.1, 1, 0.1], radius = "50 mm" }
material = "plate"
[output]
frames = "1 ms"
"#;

#[test]
fn bodies_bonds_and_motion_are_read_back() {
    let bench = Bench::new();
    bench.write("scene.toml", SCENE);
    let export = exported(&bench, "scene.toml");
    for (id, wanted) in [
        (1, [1.0, 1.0, 0.008, 2000.0, 0.0, 0.0, 0.02]),
        (2, [1.0, 1.0, 0.01, 2000.0, 0.0091, 0.0, 0.02]),
    ] {
        let (found, density) = (&export.atoms[&id], wanted[3]);
        near(found[3], density);
        assert_eq!(
            [&found[..3], &found[4..]].concat(),
            [&wanted[..3], &wanted[4..]].concat()
        );
    }
    assert_eq!(export.velocities[&2], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(export.bonds, [[1, 1, 2]]);
    // The formulas of PHYSICS, once more: Timoshenko's beam of radius 2 mm.
    let (e, nu, r, l) = (1e8_f64, 0.25, 0.002_f64, 0.0091_f64);
    let area = std::f64::consts::PI * r * r;
    let second = area * r * r / 4.0;
    let phi = 20.0 * r * r * (1.0 + nu) / (3.0 * l * l);
    let bending = e * second / l;
    let k = &export.types[&1];
    near(k[0], e * area / l);
    near(k[1], 12.0 * e * second / l.powi(3) / (1.0 + phi));
    near(k[2], bending / (1.0 + nu));
    near(k[3], bending);
    near(k[4], 1e6 * area);
    near(k[7], 1e6 * second / r);
    assert!(k[5] == 1e300 && k[6] == 1e300, "{k:?}");
    let mass = |radius: f64| 2000.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let (a, b) = (mass(0.004), mass(0.005));
    near(k[8], 0.2 * (k[0] * a * b / (a + b)).sqrt());
    near(k[9], 0.2 * (k[1] * a * b / (a + b)).sqrt());
    let inertia = |radius: f64| 0.4 * mass(radius) * radius * radius;
    let (a, b) = (inertia(0.004), inertia(0.005));
    let reduced = a * b / (a + b);
    near(k[10], 2.0 / l * 0.2 * (k[3] * reduced).sqrt());
    near(k[11], 2.0 * 0.2 * (k[2] * reduced).sqrt());
    let bond = export.said("bond_style bpm/rotational");
    assert!(bond.starts_with("smooth no break yes"), "{bond}");
    assert_eq!(
        export.said("special_bonds"),
        "lj 0.0 1.0 1.0 coul 1.0 1.0 1.0"
    );
    near(export.number("timestep"), 1e-6);
    assert_eq!(export.number("run"), 10_000.0);
    let dump = export.said("dump frames all custom");
    assert!(dump.starts_with("1000 frames.dump id "), "{dump}");
    assert_eq!(
        export.said("fix gravity all gravity"),
        "9.81e0 vector 0e0 0e0 -1e0"
    );
    assert_eq!(export.said("fix damping all damping/cundall"), "1e-1 1e-1");
    assert_eq!(export.said("fix support_1"), "support_1 freeze");
    assert_eq!(export.said("group support_1 id"), "1");
    assert_eq!(export.said("group load_1 id"), "2");
    let load = export.said("variable load_1_z equal");
    assert_eq!(load, "\"-2e0*((time<5e-3)*time/5e-3+(time>=5e-3))\"");
}

#[test]
fn contacts_and_walls_are_read_back() {
    let bench = Bench::new();
    bench.write("scene.toml", SCENE);
    let export = exported(&bench, "scene.toml");
    let law = export.said("pair_coeff 1 1");
    let words: Vec<&str> = law.split(' ').collect();
    let number = |at: usize| words[at].parse::<f64>().unwrap();
    assert_eq!(
        [words[0], words[3], words[4]],
        ["hertz", "tangential", "mindlin_rescale/force"]
    );
    let e = 1e7 / (2.0 * (1.0 - 0.09));
    let g = 1e7 / (2.0 * 2.0 * 1.3 * 1.7);
    near(number(1), 4.0 / 3.0 * e);
    near(number(5), 8.0 * g);
    near(number(6), (4.0 * g / e).sqrt());
    assert_eq!(number(7), 0.4);
    assert_eq!(
        words[8..],
        ["damping", "coeff_restitution", "limit_damping"]
    );
    // The damping ratio with which attraction cut off gives 0.5, in the words of the formula with
    // it.
    let wanted = number(2).ln() / number(2).ln().hypot(std::f64::consts::PI);
    let zeta = -wanted;
    let loss = 2.0 * zeta * zeta.acos() / (1.0 - zeta * zeta).sqrt();
    near((-loss).exp(), 0.5);

    let mut regions = BTreeMap::new();
    for words in export
        .script
        .iter()
        .filter(|w| w.first().is_some_and(|w| w == "region"))
    {
        regions.insert(words[1].clone(), words[2..].join(" "));
    }
    let move_1 = "move v_wall_1_x v_wall_1_y v_wall_1_z";
    // By name: block, plate, roll.
    assert_eq!(
        regions["wall_1"],
        format!("block 1e-1 2e-1 -1e0 1e0 0e0 1e0 side out units box {move_1}")
    );
    assert_eq!(
        regions["wall_2"],
        "plane 0e0 0e0 0e0 0e0 0e0 1e0 side in units box"
    );
    assert_eq!(
        regions["wall_3"],
        "cylinder y -1e-1 1e-1 5e-2 -1e0 1e0 side out units box"
    );
    let path = export.said("variable wall_1_x equal");
    assert_eq!(
        path,
        "\"-1e0*((time<2e-3)*time*time/4e-3+(time>=2e-3)*(time-1e-3))\""
    );
    let wall = export.said("fix wall_2_1 material_1 wall/gran/region granular hertz");
    assert!(wall.ends_with("limit_damping region wall_2"), "{wall}");
    let page = fs::read_to_string(bench.path("out/README.md")).unwrap();
    for part in [
        "contacts grain-grain",
        "wall plate",
        "load push",
        "support hold",
        "1 bond as",
        "Where walls meet as one surface",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn clumps_keep_mass_centre_and_inertia() {
    let bench = Bench::new();
    let scene = SCENE
        .replace(
            "bonds = \"grain\"\nparticles",
            "start_as = \"clump\"\nparticles",
        )
        .replace("bond_list = [[0, 1]]\n", "");
    let cut = |text: &str, from: &str, to: &str| {
        let (a, b) = (text.find(from).unwrap(), text.find(to).unwrap());
        format!("{}{}", &text[..a], &text[b..])
    };
    let scene = cut(&scene, "[groups.left]", "[walls.plate]").replace("local_damping = 0.1\n", "");
    bench.write("scene.toml", scene);
    let export = exported(&bench, "scene.toml");
    let text = fs::read_to_string(bench.path("out/clumps.txt")).unwrap();
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(lines[0], "1");
    let row: Vec<f64> = lines[1]
        .split(' ')
        .map(|word| word.parse().unwrap())
        .collect();
    let mass = |radius: f64| 2000.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let (a, b) = (mass(0.004), mass(0.005));
    assert_eq!(row[0], 1.0);
    near(row[1], a + b);
    near(row[2], 0.0091 * b / (a + b));
    near(row[4], 0.02);
    let own = 0.4 * (a * 0.004_f64.powi(2) + b * 0.005_f64.powi(2));
    near(row[5], own);
    near(row[6], own + a * b / (a + b) * 0.0091_f64.powi(2));
    assert_eq!(row[11..14], [0.0, 1.0, 0.0]);
    assert_eq!(row.len(), 20);
    assert_eq!(
        export.said("fix clumps clumps rigid/small"),
        "molecule gravity gravity infile clumps.txt"
    );
    // Their gravity is not that of loose particles too.
    assert!(export.said("fix gravity loose").starts_with("gravity 9.81"));
    assert_eq!(export.said("neigh_modify exclude"), "molecule/intra clumps");
    // The spheres of a clump have its mass together.
    let together: f64 = export
        .atoms
        .values()
        .map(|row| row[3] * (row[2] / 2.0).powi(3))
        .sum();
    near(together * 4.0 / 3.0 * std::f64::consts::PI, a + b);
}

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
        (
            "orientation = \"random\"\n",
            "",
            "inlets.feed.orientation: LAMMPS has no word for it",
        ),
        (
            "orientation = \"random\"\n",
            "orientation = \"random\"\nangular_velocity = [0, 0, \"1 rad/s\"]\n",
            "inlets.feed.angular_velocity: LAMMPS has no word for it",
        ),
        (
            "to = [0, 0, 0.2]",
            "to = [0, 0.1, 0.2]",
            "[inlets.feed].region: LAMMPS has no word for it",
        ),
    ] {
        assert!(FED.contains(from), "{from}");
        bench.write("scene.toml", FED.replace(from, to));
        let words = ["export", "lammps", "scene.toml", "-o", "out"];
        let (said, code) = refused(&go(&bench, &words));
        assert!(code == 2 && said.contains(expected), "{said}");
    }
}

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
            "[walls.plate]: LAMMPS has no word for it: a region has no belt",
        ),
        (
            "to = [-0.1, 1, 0.1]",
            "to = [-0.2, 1, 0.1]",
            "[walls.roll]: LAMMPS has no word for it: the region cylinder is along an axis",
        ),
        (
            "normal = [0, 0, 2] }",
            "normal = [0, 0, 2] }\nservo = { force = \"1 N\", direction = [0, 0, 1], max_velocity = \"1 m/s\" }",
            "[walls.plate]: LAMMPS has no word for it: a region that moves",
        ),
        (
            "max = [0.2, 1, 1] }",
            "max = [0.2, 1, 1] }\nrotation = { axis = [0, 1, 0], angle = \"10 deg\" }",
            "[walls.block]: LAMMPS has no word for it: the region block is along the axes",
        ),
        (
            "ramp = \"2 ms\"",
            "table = [[0, 0], [\"1 ms\", 1]]",
            "[walls.block]: LAMMPS has no word for it: the path of a region",
        ),
        (
            "plane = { point = [0, 0, 0], normal = [0, 0, 2] }",
            "stl = \"tetra.stl\"\nunit = \"m\"",
            "[walls.plate]: LAMMPS has no word for it: fix wall/gran has no triangles, only planes around a room, and there are particles outside",
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
    bench.write("tetra.stl", tetrahedron());
    for (old, new, expected) in cases {
        assert!(SCENE.contains(old), "{old}");
        bench.write("scene.toml", SCENE.replacen(old, new, 1));
        let (said, code) = refused(&go(
            &bench,
            &["export", "lammps", "scene.toml", "-o", "out"],
        ));
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(expected), "{new}: {said}");
        assert!(!bench.path("out").exists(), "{new}");
    }
    let left: Vec<_> = fs::read_dir(bench.path("")).unwrap().collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

/// A tetrahedron below the plate's place.
fn tetrahedron() -> String {
    let corners = [
        [-0.1, -0.1, -0.01],
        [0.1, -0.1, -0.01],
        [0.0, 0.1, -0.01],
        [0.0, 0.0, -0.1],
    ];
    stl(&corners, &[[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
}

/// A surface as text STL.
fn stl(corners: &[[f64; 3]], triangles: &[[usize; 3]]) -> String {
    let mut text = "solid t\n".to_owned();
    for triangle in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for &at in triangle {
            let [x, y, z] = corners[at];
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid t\n"
}

#[test]
fn studies_of_laboratory_tests_bodies_and_full_folders_are_refused() {
    let bench = Bench::new();
    let test = scene_of_data("three-point-bending.toml");
    let sample = super::root().join("data/bodies/sample-coarse.vtp");
    let sample = format!("sample={}", sample.display());
    let words = [
        "export",
        "lammps",
        test.to_str().unwrap(),
        "--body",
        &sample,
        "-o",
        "out",
    ];
    let (said, code) = refused(&go(&bench, &words));
    assert!(
        code == 2 && said.contains("[test]: LAMMPS has no word for it"),
        "{said}"
    );
    let still = scene_of_data("cantilever.toml");
    let still = still.to_str().unwrap();
    let setting = "run.integrator=static";
    let words = ["export", "lammps", still, "--set", setting, "-o", "out"];
    let (said, code) = refused(&go(&bench, &words));
    assert!(
        code == 2 && said.contains("run.integrator = \"static\": LAMMPS has no word for it"),
        "{said}"
    );
    let cake = super::root().join("data/bodies/cake.vtp");
    let cake = format!("cake={}", cake.display());
    for (name, expected) in [
        (
            "chute.toml",
            "[replacement.cake]: LAMMPS has no word for it",
        ),
        (
            "chute-bonded.toml",
            "[outlets.below]: LAMMPS has no word for it",
        ),
    ] {
        let scene = scene_of_data(name);
        let scene = scene.to_str().unwrap();
        let words = ["export", "lammps", scene, "--body", &cake, "-o", "out"];
        let (said, code) = refused(&go(&bench, &words));
        assert!(code == 2 && said.contains(expected), "{said}");
    }
    let (said, code) = refused(&go(&bench, &["export", "lammps", "body.vtp", "-o", "out"]));
    assert!(code == 2 && said.contains("this is not a scene"), "{said}");
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
    assert!(code == 2 && said.contains("not an empty folder"), "{said}");
    assert_eq!(fs::read_dir(bench.path("full")).unwrap().count(), 1);
}

proptest! {
    /// No class is wider than the width, equal bonds have one type and keep their numbers, and the
    /// mean of a class is within it.
    #[test]
    fn classes_of_bonds_are_narrow(scales in prop::collection::vec(0.5_f64..2.0, 1..60)) {
        let bond = |s: &f64| -> Coefficients {
            [1e9 * s, 1e7 / s, 3.0 * s * s, 2.0 * s, 1e300, 1e300, 1e300, s.powi(3), 0.0, s.sqrt(), 0.0, 1.0]
        };
        let mut all: Vec<Coefficients> = scales.iter().map(bond).collect();
        all.push(all[0]);
        let radii = vec![0.001; all.len()];
        let found = classes(&all, &radii);
        prop_assert_eq!(found.type_of[0], found.type_of[scales.len()]);
        let used: BTreeSet<u32> = found.type_of.iter().copied().collect();
        prop_assert_eq!(used.len(), found.types.len());
        for (number, one) in (0..).zip(&found.types) {
            let members: Vec<&Coefficients> =
                all.iter().zip(&found.type_of).filter(|(_, of)| **of == number).map(|(c, _)| c).collect();
            prop_assert_eq!(one.count, members.len());
            for k in 0..12 {
                let low = members.iter().map(|c| c[k]).fold(f64::INFINITY, f64::min);
                let high = members.iter().map(|c| c[k]).fold(0.0, f64::max);
                prop_assert!(high <= low * (1.0 + CLASS_WIDTH) * (1.0 + 1e-12));
                let rounding = 1e-12 * high;
                prop_assert!(low - rounding <= one.coefficients[k] && one.coefficients[k] <= high + rounding);
            }
        }
        prop_assert!(found.largest_error <= CLASS_WIDTH);
    }
}

/// A dump of two frames, in the second of which the bond is broken.
fn write_dumps(bench: &Bench) {
    let mut frames = "ITEM: UNITS\nsi\n".to_owned();
    let mut bonds = String::new();
    for (n, [time, step]) in [[0.0, 0.0], [0.0010000000000000002, 1000.0]]
        .into_iter()
        .enumerate()
    {
        let head = format!("ITEM: TIME\n{time}\nITEM: TIMESTEP\n{step}\n");
        let bounds = "ITEM: BOX BOUNDS mm mm mm\n-1 1\n-1 1\n-1 1\n";
        frames += &format!("{head}ITEM: NUMBER OF ATOMS\n2\n{bounds}");
        frames += "ITEM: ATOMS id mol radius x y z vx vy vz omegax omegay omegaz \n";
        for id in [1, 2] {
            let x = 0.0091 * f64::from(id - 1);
            let radius = 0.003 + 0.001 * f64::from(id);
            frames += &format!("{id} 1 {radius} {x} {} 0.02 1 2 3 4 5 6 \n", 0.1 * n as f64);
        }
        let whole = 1 - n;
        bonds += &format!("{head}ITEM: NUMBER OF ENTRIES\n{whole}\n{bounds}");
        bonds += "ITEM: ENTRIES index c_bonds[1] c_bonds[2] c_bonds[3] \n";
        if n == 0 {
            bonds += "1 2 1 1 \n";
        }
    }
    bench.write("out/frames.dump", frames);
    bench.write("out/bonds.dump", bonds);
}

#[test]
fn dumps_become_frames_with_a_page_fragments_and_pictures() {
    let bench = Bench::new();
    bench.write("scene.toml", SCENE);
    exported(&bench, "scene.toml");
    write_dumps(&bench);
    let done = go(&bench, &["import", "out", "-o", "back"]);
    let said = "2 frames, the last at 0.0010000000000000002 s -> back\n";
    assert_eq!(String::from_utf8_lossy(&done.stdout), said);
    let frame =
        |n: usize| read_particles(&bench.path(&format!("back/frames/frame_{n:06}.vtp"))).unwrap();
    let (first, last) = (frame(0), frame(1));
    assert_eq!([first.time_s, last.time_s], [0.0, 0.0010000000000000002]);
    assert_eq!(last.positions, [[0.0, 0.1, 0.02], [0.0091, 0.1, 0.02]]);
    assert_eq!(last.velocities_m_s[1], [1.0, 2.0, 3.0]);
    assert_eq!(last.radii, [0.004, 0.005]);
    assert_eq!(last.ids, [0, 1]);
    assert_eq!([first.broken, last.broken.clone()], [[false], [true]]);
    assert_eq!(first.fragments.unwrap(), [0, 0]);
    assert_eq!(last.fragments.unwrap(), [0, 1]);
    assert_eq!(last.body_names, ["pair"]);
    let fragments = read_frame(&bench.path("back/frames/frame_000001.vtp")).unwrap();
    near(fragments.densities_kg_m3[0], 2000.0);
    near(fragments.bond_lengths[0], 0.0091);
    near(fragments.bond_radii[0], 0.002);
    for words in [
        &["picture", "back", "-o", "last.png"][..],
        &["fragment", "back", "--largest", "-o", "piece.vtp"],
        &["report", "back"],
        &["export", "back", "--to", "lammps-dump", "-o", "again.dump"],
    ] {
        let done = go(&bench, words);
        assert!(done.status.success(), "{words:?}: {done:?}");
    }
    let page = fs::read_to_string(bench.path("back/report.html")).unwrap();
    assert!(page.contains("computed by LAMMPS") && page.contains("id=\"view-data\""));
}

#[test]
fn damaged_dumps_and_folders_without_are_refused() {
    let bench = Bench::new();
    bench.write("scene.toml", SCENE);
    exported(&bench, "scene.toml");
    let bad = |expected: &str| {
        let (said, code) = refused(&go(&bench, &["import", "out", "-o", "back"]));
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(expected), "{expected}: {said}");
        assert!(!bench.path("back").exists(), "{expected}");
    };
    bad("frames.dump: cannot be read");
    fs::create_dir(bench.path("out/frames.dump")).unwrap();
    bad("frames.dump: this is a folder, not a dump");
    fs::remove_dir(bench.path("out/frames.dump")).unwrap();
    write_dumps(&bench);
    let read = |name: &str| fs::read_to_string(bench.path(name)).unwrap();
    let (whole, bonds) = (read("out/frames.dump"), read("out/bonds.dump"));
    for (old, new, expected) in [
        ("ITEM: UNITS", "UNITS", "is not the head of a section"),
        ("0.0091", "here", "line 15: 'here' is not a finite number"),
        ("0.0091", "nan", "line 15: 'nan' is not a finite number"),
        (
            "0.0091",
            "-1e400",
            "line 15: '-1e400' is not a finite number",
        ),
        (" 4 5 6 \n", " 4 5 \n", "11 numbers for 12 columns"),
        (" x y z", " xs y z", "there is no column 'x'"),
        (
            "\n2 1 0.005",
            "\n7 1 0.005",
            "atom 7 is not in particles.data",
        ),
        (
            "\n2 1 0.005",
            "\n2.5 1 0.005",
            "atom 2.5 is not in particles.data",
        ),
        ("\n2 1 0.005", "\n1 1 0.004", "atom 1 is there twice"),
        (
            "\n2 1 0.005",
            "\n2 3 0.005",
            "atom 2 is of molecule 3, not 1",
        ),
        (
            "\n2 1 0.005",
            "\n2 1 -0.005",
            "atom 2 has a radius of -0.005 m, not 0.005 m",
        ),
        (
            "ATOMS\n2\n",
            "ATOMS\n-2\n",
            "'-2' is not a whole number from 0",
        ),
        (
            "ATOMS\n2\n",
            "ATOMS\n3\n",
            "a section begins after 2 rows of 3",
        ),
        ("ATOMS\n2\n", "ATOMS\n1\n", "atom 2 is missing"),
        ("ITEM: TIME\n0\n", "", "no time"),
        ("STEP\n1000\n", "STEP\n0\n", "step 0: it comes after step 0"),
    ] {
        assert!(whole.contains(old), "{old}");
        bench.write("out/frames.dump", whole.replacen(old, new, 1));
        bad(expected);
    }
    let second = whole.find("ITEM: TIME\n0.001").unwrap();
    bench.write(
        "out/frames.dump",
        format!("{}{}", &whole[second..], &whole[second..]),
    );
    bad("bonds.dump: step 0: frames.dump has step 1000 there");
    bench.write("out/frames.dump", &whole);
    for (text, expected) in [
        ("", "bonds.dump: there is no complete frame in it"),
        (
            bonds.replace("1 2 1 1 ", "1 2 9 1 ").as_str(),
            "particles.data has no bond of the atoms 2 and 9",
        ),
        (
            bonds.replace("STEP\n1000\n", "STEP\n500\n").as_str(),
            "step 500: frames.dump has step 1000",
        ),
        (
            &bonds[bonds.find("ITEM: TIME\n0.001").unwrap()..],
            "frames.dump has step 0 there",
        ),
    ] {
        bench.write("out/bonds.dump", text);
        bad(expected);
    }
    // A run that goes on, or was stopped: the frames before are there, and it is said.
    let (row, bond) = (
        whole.rfind("2 1 0.005").unwrap(),
        bonds.rfind("ITEM: NUMBER").unwrap(),
    );
    for (frames, bonds) in [
        (&whole[..row], &bonds[..]),
        (&whole[..row + 4], &bonds[..]),
        (&whole[..], &bonds[..bond + 8]),
    ] {
        bench.write("out/frames.dump", frames);
        bench.write("out/bonds.dump", bonds);
        let done = go(&bench, &["import", "out", "-o", "back", "--force"]);
        let said = String::from_utf8_lossy(&done.stdout).into_owned();
        assert_eq!(said, "1 frame, the last at 0 s -> back\n");
        let warned = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(
            warned.contains("the frames end at 0 s, the run of the scene at"),
            "{warned}"
        );
        let page = read("back/report.html");
        assert!(
            page.contains("LAMMPS has stopped before, or goes on") && !page.contains("seed null")
        );
    }
    fs::remove_dir_all(bench.path("back")).unwrap();
    fs::remove_file(bench.path("out/export.json")).unwrap();
    bad("export.json: this file is missing");
}
