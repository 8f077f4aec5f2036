//! What a second of a process costs, on one thread and on two, and how much bonds only while bodies
//! can break save: the table of doc/real-time.md. `cargo bench -p dem-tests --bench process`, then
//! the names of cases, or `--page FILE` to write it. A quarter of an hour; with the word `fine`, and
//! for a page, cakes of 2,400 spheres as well, half an hour more.
#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark stops where it fails, and prints a table"
)]

mod filled;
mod page;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use dem_run::plan::plan;
use dem_run::step::step;
use dem_run::threads::keep_awake;

use self::filled::{packed, shape};
use self::page::{Table, words};

/// A scene of `data/scenes` whose steps are timed from one time to another.
struct Case {
    name: &'static str,
    /// What the table calls it.
    title: &'static str,
    scene: &'static str,
    set: &'static [&'static str],
    /// s
    between_s: [f64; 2],
    /// The case that it is compared with.
    beside: Option<&'static str>,
    /// Its cakes are of spheres of this diameter instead of those of the scene.
    diameters: Option<&'static str>,
}

const USUAL: Case = Case {
    name: "chute",
    title: "`chute.toml`: four cakes a second, bonded while they can break",
    scene: "chute",
    set: &[],
    between_s: [0.0, 2.0],
    beside: Some("chute-bonded"),
    diameters: None,
};

const FINE: &str = "4.6mm..5.8mm";

const CASES: [Case; 8] = [
    Case {
        name: "chute-bonded",
        title: "`chute-bonded.toml`: bonded from the start",
        scene: "chute-bonded",
        beside: None,
        ..USUAL
    },
    Case {
        name: "chute-region",
        title: "`chute-region.toml`: bonded in a region",
        scene: "chute-region",
        ..USUAL
    },
    USUAL,
    Case {
        name: "five-a-second",
        title: "`chute.toml` with five cakes a second",
        set: &["inlets.feed.rate=\"5 /s\""],
        between_s: [1.0, 5.0],
        beside: None,
        ..USUAL
    },
    Case {
        name: "process",
        title: "`process.toml` with the soft cake of doc/process.md",
        scene: "process",
        set: &[
            "run.impact_accuracy=0.02",
            "materials.cake.shear_modulus=\"10 MPa\"",
            "materials.rock.shear_modulus=\"10 MPa\"",
            "bonds.cake.failure={von_mises_strength=\"0.185 MPa\",equivalent_stress=\"forces-only\",rate_strengthening=\"1.1 /s\",strain_rate_measure=\"relative-velocity\"}",
        ],
        between_s: [0.0, 3.0],
        beside: None,
        ..USUAL
    },
    Case {
        name: "hundred-lanes",
        title: "`chute.toml` with a hundred cakes a second on a belt 10 m wide",
        set: &[
            "inlets.feed.rate=\"100 /s\"",
            "walls.belt.box={min=[\"-2.1 m\",\"-5 m\",\"-20 mm\"],max=[\"0 m\",\"5 m\",\"0 m\"]}",
            "walls.plate.box={min=[\"0.44 m\",\"-5 m\",\"-0.4 m\"],max=[\"0.46 m\",\"5 m\",\"0.3 m\"]}",
            "regions.gate.box={min=[\"-2 m\",\"-4.8 m\",\"20 mm\"],max=[\"-1.9 m\",\"4.8 m\",\"30 mm\"]}",
            "regions.scene.box={min=[\"-2.2 m\",\"-6 m\",\"-0.5 m\"],max=[\"0.8 m\",\"6 m\",\"0.6 m\"]}",
        ],
        between_s: [0.9, 1.1],
        beside: None,
        ..USUAL
    },
    Case {
        name: "fine-bonded",
        title: "`chute-bonded.toml`, cakes of some 2,400 spheres",
        scene: "chute-bonded",
        between_s: [0.0, 0.9],
        beside: None,
        diameters: Some(FINE),
        ..USUAL
    },
    Case {
        name: "fine",
        title: "`chute.toml`, cakes of some 2,400 spheres",
        between_s: [0.0, 0.9],
        beside: Some("fine-bonded"),
        diameters: Some(FINE),
        ..USUAL
    },
];

/// What a run of a case costs.
#[derive(Clone, Copy)]
struct Cost {
    /// Run time over simulated time.
    per_s: f64,
    steps: u64,
    broken: u64,
}

impl Case {
    fn cost(&self, threads: usize) -> Cost {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let file = root
            .join("data/scenes")
            .join(self.scene)
            .with_extension("toml");
        let set: Vec<String> = self.set.iter().map(|&set| set.to_owned()).collect();
        let scene = dem_scene::read_scene(&file, &set).expect("a scene");
        let bodies = match self.diameters {
            Some(diameters) => {
                let cake = packed(&shape("filter-cake"), diameters, 0.25, None);
                BTreeMap::from([("cake".to_owned(), cake)])
            }
            None => dem_scene::read_bodies(&scene).expect("bodies"),
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads start").install(|| {
            let mut state = plan(&scene, bodies, threads, false).expect("plans").state;
            let [from_s, to_s] = self.between_s;
            keep_awake(|| {
                while state.time_s < from_s {
                    step(&mut state);
                }
                let (clock, before) = (Instant::now(), state.steps);
                while state.time_s < to_s {
                    step(&mut state);
                }
                Cost {
                    per_s: clock.elapsed().as_secs_f64() / (to_s - from_s),
                    steps: state.steps - before,
                    broken: state.broken_count,
                }
            })
        })
    }
}

fn main() {
    let asked = words();
    let is_for_page = std::env::args().any(|word| word == "--page");
    let mut table = Table::new();
    let is_asked = |case: &&Case| match case.diameters {
        Some(_) => is_for_page || asked.iter().any(|word| word == "fine"),
        None => asked.is_empty() || asked.iter().any(|word| word == case.name),
    };
    let cases: Vec<&Case> = CASES.iter().filter(is_asked).collect();
    table.row(
        "| scene | time | steps | bonds broken | run time over simulated time, one thread | times as fast as bonded from the start | two threads: times as fast |",
    );
    table.row("|---|---|---|---|---|---|---|");
    let mut costs: BTreeMap<&str, f64> = BTreeMap::new();
    for case in cases {
        let [one, two] = [1, 2].map(|threads| case.cost(threads));
        costs.insert(case.name, one.per_s);
        let beside = case.beside.and_then(|name| costs.get(name));
        let faster = beside.map_or_else(String::new, |beside| format!("{:.1}", beside / one.per_s));
        let [from_s, to_s] = case.between_s;
        table.row(&format!(
            "| {} | {from_s} s to {to_s} s | {} | {} | {:.2} | {faster} | {:.2} |",
            case.title,
            one.steps,
            one.broken,
            one.per_s,
            one.per_s / two.per_s
        ));
    }
    table.write("process");
}
