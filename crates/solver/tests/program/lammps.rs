//! Scenes for LAMMPS, read back by a reader of their own; what is refused; dumps back to frames.

mod dumps;
mod fed;
mod refusals;
mod stored;
mod surfaces;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Output;

use super::{Bench, dem_run, refused};

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
            // Commands of an if are quoted, and it goes on.
            let line = line.split('#').next().unwrap();
            let quoted = line
                .strip_prefix("  \"")
                .map(|line| line.trim_end_matches(" &"));
            let command = quoted
                .and_then(|line| line.strip_suffix('"'))
                .unwrap_or(line);
            let words = command.split_whitespace();
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

/// The only line of an export that is refused.
fn refused_export(bench: &Bench, words: &[&str]) -> String {
    let words = [&["export", "lammps"], words, &["-o", "out"]].concat();
    let (said, code) = refused(&go(bench, &words));
    assert_eq!(code, 2, "{said}");
    said
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
    // What holds particles comes after the walls that push them.
    let at = |begin: &str| {
        let line = |words: &Vec<String>| words.join(" ").starts_with(begin);
        export.script.iter().position(line).unwrap()
    };
    assert!(at("fix wall_3_1") < at("fix support_1"));
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
