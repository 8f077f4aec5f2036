//! doc/inside/self-contact.md: scenes with and without contacts within pieces.

use std::fmt::Write;

use dem_io::units::significant;
use dem_scene::study::Pieces;
use dem_study::masses::{by_chance, distance, masses_kg};

use crate::bench::{Bench, Failed, ONE_THREAD, Run, sets};
use crate::cells::mean_and_range;
use crate::table::{Table, write};

const WAYS: [&str; 2] = ["false", "true"];
/// Seeds of the chute.
const SEEDS: usize = 4;
/// Spheres of the slit block along each side, and their radius, m.
const BLOCK: [usize; 3] = [5, 5, 10];
const RADIUS_M: f64 = 1e-3;

/// What is read from a run, and what it is called in the table.
type Reading = (&'static str, fn(&Run) -> f64);

const TIME: Reading = ("processor time, s", Run::processor_s);
const LARGEST: Reading = ("largest piece, of the mass", |run| {
    run.fragments().mass_fraction_of_largest
});
const BROKEN: Reading = ("bonds broken", broken);

/// Scenes with their bodies, and what is read from each.
const SCENES: [(&str, &[&str], &[Reading]); 3] = [
    (
        "compression",
        &["--body=bar=data/bodies/bar.vtp"],
        &[
            ("failure force, N", |run| figure(run, "failure force")),
            ("bonds broken at 8 mm", broken),
            LARGEST,
            TIME,
        ],
    ),
    (
        "four-point-bending",
        &["--body=sample=data/bodies/sample.vtp"],
        &[
            ("strength, kPa", |run| 1e-3 * figure(run, "strength")),
            BROKEN,
            TIME,
        ],
    ),
    (
        "drop-inclined",
        &[],
        &[
            BROKEN,
            LARGEST,
            ("pieces", |run| run.fragments().count as f64),
            TIME,
        ],
    ),
];

fn figure(run: &Run, name: &str) -> f64 {
    let test = run.test().ok();
    test.and_then(|test| test.figure(name)).unwrap_or(f64::NAN)
}

fn broken(run: &Run) -> f64 {
    run.summary.broken_bonds as f64
}

pub(crate) fn tables() -> [Table; 1] {
    let mut first_cells = BLOCKS.map(|(name, _)| format!("block, {name}")).to_vec();
    for (scene, _, readings) in SCENES {
        first_cells.extend(readings.iter().map(|_| format!("`{scene}.toml`")));
    }
    first_cells.extend([(); 4].map(|()| format!("`chute-region.toml`, {SEEDS} seeds")));
    let head = "scene |  | never | `self_contact`";
    let page = "doc/inside/self-contact.md";
    [Table::new(page, "self-contact", head, first_cells)]
}

pub(crate) fn self_contact(bench: &Bench) -> Result<(), Failed> {
    let [mut table] = tables();
    blocks(bench, &mut table)?;
    for (name, bodies, readings) in SCENES {
        let scene = format!("data/scenes/{name}.toml");
        let runs = each_way(bench, name, &scene, bodies)?;
        for (what, read) in readings {
            let cells = runs.iter().map(|run| number(read(run)));
            table.row([(*what).to_owned()].into_iter().chain(cells));
        }
    }
    chute(bench, &mut table)?;
    write(&[table])
}

/// A scene, run without and with contacts within pieces.
fn each_way(bench: &Bench, name: &str, scene: &str, more: &[&str]) -> Result<[Run; 2], Failed> {
    let [never, always] = WAYS.map(|way| {
        let mut options = sets(&[format!("clusters.self_contact={way}")]);
        options.push(ONE_THREAD.to_owned());
        options.extend(more.iter().map(|&option| option.to_owned()));
        bench.run(&format!("{name}-{way}"), scene, &options)
    });
    Ok([never?, always?])
}

/// A block that is pressed by 0.4 mm: whole, cut in two, and slit but for one row of bonds.
fn blocks(bench: &Bench, table: &mut Table) -> Result<(), Failed> {
    for (name, joins) in BLOCKS {
        let scene = bench.folder.join(format!("{name}.toml"));
        std::fs::write(&scene, block(joins))?;
        let [never, always] = each_way(bench, name, &scene.display().to_string(), &[])?;
        let force = |run: &Run| Ok::<_, Failed>(number(run.measured("force")?));
        let what = "force at 0.4 mm, N".to_owned();
        table.row([what, force(&never)?, force(&always)?]);
    }
    Ok(())
}

/// The chute, with several seeds, bonded from the start.
fn chute(bench: &Bench, table: &mut Table) -> Result<(), Failed> {
    let mut runs: [Vec<(Run, Vec<f64>)>; 2] = Default::default();
    for seed in 0..SEEDS {
        let set = format!("--set=run.seed={seed}");
        let name = format!("chute-{seed}");
        let both = each_way(bench, &name, "data/scenes/chute-region.toml", &[&set])?;
        for (run, runs) in both.into_iter().zip(&mut runs) {
            let masses = masses_kg(Pieces::Left, &run.folder)?;
            runs.push((run, masses));
        }
    }
    let row = |what: &str, read: &dyn Fn(&Run, &[f64]) -> f64| {
        let cells = runs.iter().map(|runs| {
            let values: Vec<f64> = runs.iter().map(|(run, masses)| read(run, masses)).collect();
            mean_and_range(&values, "", 0)
        });
        [what.to_owned()]
            .into_iter()
            .chain(cells)
            .collect::<Vec<_>>()
    };
    let [never, always] = runs
        .each_ref()
        .map(|runs| -> Vec<f64> { runs.iter().flat_map(|(_, masses)| masses.clone()).collect() });
    let apart = format!(
        "{:.3} (by chance, in one of twenty cases: {:.3})",
        distance(&never, &always, |_| 1.0),
        by_chance(never.len(), always.len())
    );
    table.row(row("bonds broken", &|run, _| broken(run)));
    table.row(row("fragments discharged", &|_, masses| {
        masses.len() as f64
    }));
    let what = "distance of their masses (KS)".to_owned();
    table.row([what, String::new(), apart]);
    table.row(row(TIME.0, &|run, _| TIME.1(run)));
    Ok(())
}

/// Three significant digits, or a whole number.
fn number(value: f64) -> String {
    if value >= 100.0 || value.fract() == 0.0 {
        format!("{value:.0}")
    } else {
        significant(value, 3)
    }
}

/// Whether two neighbouring spheres are bonded, by their places on the lattice.
type Joins = fn([usize; 3], [usize; 3]) -> bool;

const BLOCKS: [(&str, Joins); 3] = [
    ("whole", |_, _| true),
    ("cut in two", |a, b| !crosses(a, b)),
    ("slit, held by one row of bonds", |a, b| {
        !crosses(a, b) || (a[0] == 0 && b[0] == 0)
    }),
];

/// Whether a bond crosses the middle of the block.
fn crosses(a: [usize; 3], b: [usize; 3]) -> bool {
    let middle = BLOCK[2] / 2;
    a[2].min(b[2]) == middle - 1 && a[2].max(b[2]) == middle
}

/// The scene of a block of touching spheres between two plates, of which the upper comes down.
fn block(joins: Joins) -> String {
    let [nx, ny, nz] = BLOCK;
    let all: Vec<[usize; 3]> = (0..nz)
        .flat_map(|z| (0..nx).flat_map(move |x| (0..ny).map(move |y| [x, y, z])))
        .collect();
    let apart = |a: [usize; 3], b: [usize; 3]| {
        let square = (0..3).map(|k| a[k].abs_diff(b[k]).pow(2));
        square.sum::<usize>()
    };
    let (mut particles, mut bonds) = (String::new(), String::new());
    for (n, &[x, y, z]) in all.iter().enumerate() {
        let [x_m, y_m, z_m] = [x, y, z].map(|k| (2 * k + 1) as f64 * RADIUS_M);
        let _ = write!(particles, "[{x_m:e}, {y_m:e}, {z_m:e}, {RADIUS_M:e}], ");
        for (m, &other) in all.iter().enumerate().skip(n + 1) {
            if apart([x, y, z], other) <= 2 && joins([x, y, z], other) {
                let _ = write!(bonds, "[{n}, {m}], ");
            }
        }
    }
    let law = "{ law = \"linear\", normal_stiffness = \"200 kN/m\", tangential_stiffness_ratio = 0.8, restitution = 0.3, friction = 0.5 }";
    let above_m = 2.0 * RADIUS_M * nz as f64;
    format!(
        "version = 1\n\
         run = {{ end_time = \"4 ms\", local_damping = 0.2 }}\n\
         materials.cake = {{ density = 2000, young_modulus = \"100 MPa\", poisson_ratio = 0.2 }}\n\
         materials.plate = {{ rigid = true }}\n\
         contacts.cake-cake = {law}\n\
         contacts.cake-plate = {law}\n\
         bonds.cake = {{ young_modulus = \"100 MPa\", poisson_ratio = 0.2, damping = {{ damping_ratio = 0.1 }} }}\n\
         bodies.block = {{ material = \"cake\", bonds = \"cake\", particles = [{particles}], bond_list = [{bonds}] }}\n\
         walls.below = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"plate\" }}\n\
         walls.above = {{ plane = {{ point = [0, 0, {above_m:e}], normal = [0, 0, -1] }}, material = \"plate\", velocity = [0, 0, \"-0.1 m/s\"] }}\n\
         measures.force = {{ of = \"above\", quantity = \"force_z\", statistic = \"largest\" }}\n"
    )
}
