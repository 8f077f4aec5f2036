//! data/bodies/README.md: what the bonds of scenes make of the spheres that are bonded there, in
//! tension.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use dem_io::Body;
use dem_io::body::{body_summary, read_body};
use dem_io::units::significant;

use crate::bench::{Bench, Failed, ONE_THREAD, root};
use crate::table::{Table, write};

/// A bar with the spheres of a scene.
struct Bar {
    scenes: &'static str,
    /// The file with its bonds, below `data`.
    bonds: &'static str,
    body: &'static str,
    /// The axis along which it is pulled.
    axis: usize,
}

/// Layer of particles that a grip holds at each end, in mean diameters.
const GRIP: f64 = 1.05;

const BARS: [Bar; 9] = [
    bar(
        "chute, chute-bonded, chute-region",
        "scenes/chute.toml",
        "lump",
        2,
    ),
    bar("one-cake", "scenes/one-cake.toml", "lump", 2),
    bar("jaw-crusher", "scenes/jaw-crusher.toml", "lump", 2),
    bar(
        "transfer-chute, process",
        "scenes/transfer-chute.toml",
        "lump",
        2,
    ),
    bar("drop-height", "scenes/drop-height.toml", "lump", 2),
    bar("repeated-drops", "scenes/repeated-drops.toml", "lump", 2),
    bar(
        "drop-flat, drop-inclined",
        "scenes/drop-inclined.toml",
        "sample",
        0,
    ),
    bar("stalk-cut", "scenes/stalk-cut.toml", "stalk", 2),
    bar("clamped", "scenes/clamped.toml", PACKED, 0),
];
/// A body of `clamped.toml`, which is packed: its shape and diameters.
const PACKED: &str = "bending-sample";
const PACKED_DIAMETERS: &str = "--diameter=4mm..6mm";

const fn bar(scenes: &'static str, bonds: &'static str, body: &'static str, axis: usize) -> Bar {
    Bar {
        scenes,
        bonds,
        body,
        axis,
    }
}

pub(crate) fn table() -> Table {
    let head = "bonds of | bar | mean diameter, mm | across | modulus, MPa | strength, MPa";
    let first: Vec<_> = BARS.iter().map(|bar| bar.scenes.to_owned()).collect();
    Table::new("data/bodies/README.md", "bodies", head, first)
}

/// Pulls each bar and writes the table.
pub(crate) fn bodies(bench: &Bench) -> Result<(), Failed> {
    let mut table = table();
    for (number, bar) in BARS.iter().enumerate() {
        let scene = bench.folder.join(format!("bar-{number}.toml"));
        let file = file_of(bench, bar)?;
        let body: Body = read_body(&file)?;
        std::fs::write(&scene, scene_of(bar, &file, &body)?)?;
        let name = format!("bar-{number}");
        let run = bench.run(&name, &scene.to_string_lossy(), &[ONE_THREAD.to_owned()])?;
        let test = run.test()?;
        let mpa = |name: &str| {
            let value = test.figure(name);
            value.map_or("-".to_owned(), |value| significant(1e-6 * value, 3))
        };
        table.row([
            match bar.body {
                PACKED => format!("{PACKED}.stl, 4mm..6mm"),
                body => format!("{body}.vtp"),
            },
            significant(1e3 * body.mean_diameter_m(), 3),
            significant(body.about.particles_across.unwrap_or(f64::NAN), 2),
            mpa("specimen modulus"),
            mpa("strength"),
        ]);
    }
    write(&[table])
}

fn file_of(bench: &Bench, bar: &Bar) -> Result<PathBuf, Failed> {
    match bar.body {
        PACKED => bench.pack(PACKED, PACKED, &[PACKED_DIAMETERS]),
        body => Ok(root().join(format!("data/bodies/{body}.vtp"))),
    }
}

/// The tension test of a bar, slow, with small steps.
fn scene_of(bar: &Bar, file: &Path, body: &Body) -> Result<String, Failed> {
    let its = body_summary(body);
    let [low_m, high_m] = [its.box_min_m, its.box_max_m].map(|corner| corner[bar.axis]);
    let grip_m = GRIP * body.mean_diameter_m();
    let text = std::fs::read_to_string(root().join("data").join(bar.bonds))?;
    let material = if bar.body == "stalk" { "stalk" } else { "cake" };
    let axis = ["x", "y", "z"][bar.axis];
    let materials = tables(&text, "[materials.");
    let mut scene = format!(
        "version = 1\n[run]\nlocal_damping = 0.02\nsafety_factor = 0.3\n{materials}{}\
         [bodies.bar]\nfile = {:?}\nmaterial = \"{material}\"\nbonds = \"{material}\"\n",
        tables(&text, "[bonds."),
        file
    );
    if !materials.contains("density") {
        scene.push_str("body_density = \"2050 kg/m3\"\n");
    }
    let far = [-1.0, 1.0];
    let grips = [
        ("lower", [-1.0, low_m + grip_m]),
        ("upper", [high_m - grip_m, 1.0]),
    ];
    for (name, own) in grips {
        let sides: Vec<[f64; 2]> = (0..3)
            .map(|i| if i == bar.axis { own } else { far })
            .collect();
        let [min, max] = [0, 1].map(|end| sides.iter().map(|side| side[end]).collect::<Vec<_>>());
        writeln!(
            scene,
            "[groups.{name}]\nbody = \"bar\"\nbox = {{ min = {min:?}, max = {max:?} }}"
        )?;
    }
    let mut direction = [0.0; 3];
    direction[bar.axis] = 1.0;
    write!(
        scene,
        "[supports.lower]\ngroup = \"lower\"\nfixed = [\"{axis}\"]\n\
         [test]\ntype = \"tension\"\nbody = \"bar\"\ncrosshead = [\"upper\"]\n\
         direction = {direction:?}\nstroke = {:?}\nperiods = 200\n[output]\n",
        0.1 * (high_m - low_m)
    )?;
    Ok(scene)
}

/// The tables of a scene whose heads begin so.
fn tables(scene: &str, head: &str) -> String {
    let mut is_own = false;
    let own = scene.lines().filter(|line| {
        if line.starts_with('[') {
            is_own = line.starts_with(head);
        }
        is_own
    });
    own.map(|line| format!("{line}\n")).collect()
}
