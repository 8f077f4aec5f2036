//! The table of doc/inside/leave-out.md: the cost of each feature of a scene when it is used, and
//! the absence of a cost when it is not. `cargo bench -p dem-tests --bench features`. A minute.
#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark stops where it fails, and prints a table"
)]

use std::collections::BTreeMap;
use std::time::Instant;

#[allow(dead_code, reason = "other benchmarks use the rest")]
mod page;

use dem_io::Body;
use dem_io::surface::{ReadSettings, read_surface};
use dem_pack::{Basis, BodySettings, BondSettings, PackSettings, Sizes, make_body};
use dem_run::plan::plan;
use dem_run::stages::stage::Stage;
use dem_run::state::State;
use dem_run::step::{number_of, stages, step};

use self::page::Table;

const SHAPE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../data/shapes/bending-sample.stl"
);

/// Number of rounds, of which the median is taken, and steps of each.
const ROUNDS: usize = 15;
const STEPS: u32 = 60;

/// The reference of other cases: a free, rotating body without any feature.
const PLAIN: &str = "a free body";

/// A scene: its name, its reference, the stage of its additional feature, and its text in place of
/// run, bonds and tables.
struct Case {
    name: &'static str,
    beside: &'static str,
    stage: &'static str,
    run: &'static str,
    bonds: &'static str,
    tables: &'static str,
}

const CASE: Case = Case {
    name: PLAIN,
    beside: PLAIN,
    stage: "bond forces",
    run: "",
    bonds: "",
    tables: "",
};
const MEETS: &str = "[contacts]\nstuff-stuff = { restitution = 0.5, friction = 0.3 }\n";
const FLOOR: &str = "[contacts]\nstuff-stuff = { restitution = 0.5, friction = 0.3 }\n[walls.floor]\nplane = { point = [0, 0, -1e-4], normal = [0, 0, 1] }\nmaterial = \"stuff\"\n";

const CASES: [Case; 17] = [
    CASE,
    Case {
        name: "bond history",
        stage: "bond history",
        bonds: "formulation = \"incremental\"",
        ..CASE
    },
    Case {
        name: "bond damping",
        stage: "bond damping",
        bonds: "damping = { damping_ratio = 0.1 }",
        ..CASE
    },
    Case {
        name: "structural damping",
        stage: "structural damping",
        bonds: "damping = { structural_damping = 0.1 }",
        ..CASE
    },
    Case {
        name: "elasto-plastic bonds",
        stage: "elasto-plastic bonds",
        bonds: "plasticity = { normal_yield_strength = 1e12, bending_yield_strength = 1e12 }",
        ..CASE
    },
    Case {
        name: "flat joints, 2 x 6 elements",
        stage: "flat joints",
        bonds: "model = \"flat-joint\"\nradial_elements = 2\ncircumferential_elements = 6\nfailure = { tensile_strength = 1e12 }",
        ..CASE
    },
    Case {
        name: "failure",
        stage: "failure",
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\" }",
        ..CASE
    },
    Case {
        name: "fracture energy",
        beside: "failure",
        stage: "damage of bonds",
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\", fracture_energy = 1e20 }",
        ..CASE
    },
    Case {
        name: "friction of bonds",
        beside: "failure",
        stage: "friction of bonds",
        bonds: "failure = { cohesion = 1e12, friction_angle = \"35 deg\" }",
        ..CASE
    },
    Case {
        name: "strength scatter",
        beside: "failure",
        stage: "strength scatter",
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\", weibull_modulus = 5 }",
        ..CASE
    },
    Case {
        name: "rate strengthening",
        beside: "failure",
        stage: "rate strengthening",
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\", rate_strengthening = true }",
        ..CASE
    },
    Case {
        name: "local damping",
        stage: "local damping",
        run: ", local_damping = 0.1",
        ..CASE
    },
    Case {
        name: "gravity",
        stage: "gravity",
        run: ", gravity = [0, 0, -9.81]",
        ..CASE
    },
    Case {
        name: "loads",
        stage: "loads",
        tables: "[loads.push]\ngroup = \"cake\"\nforce = [0, 0, 1e-3]\n",
        ..CASE
    },
    Case {
        name: "supports",
        stage: "supports",
        tables: "[supports.hold]\ngroup = \"cake\"\nfixed = [\"x\"]\n",
        ..CASE
    },
    Case {
        name: "walls",
        stage: "walls",
        tables: FLOOR,
        ..CASE
    },
    Case {
        name: "particle contacts",
        beside: "failure",
        stage: "particle contacts",
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\" }",
        tables: MEETS,
        ..CASE
    },
];

impl Case {
    fn state(&self, body: &Body) -> State {
        let Self {
            run, bonds, tables, ..
        } = self;
        let text = format!(
            "version = 1
[run]
end_time = 1
RUN
[materials.stuff]
density = 2050
young_modulus = 1e7
[bonds.stuff]
young_modulus = 1.2e7
poisson_ratio = 0.3
{bonds}
[bodies.cake]
file = \"cake.vtp\"
material = \"stuff\"
bonds = \"stuff\"
angular_velocity = [1, 0, 0]
{tables}"
        );
        let text = text.replace("RUN", run.trim_start_matches(", "));
        let scene = dem_scene::scene_from_text(&text, "bench.toml", &[]).expect("a good scene");
        let bodies = BTreeMap::from([("cake".to_owned(), body.clone())]);
        plan(&scene, bodies, 1, false).expect("plans").state
    }
}

/// Time per step over some steps, ns.
fn time_ns(state: &mut State) -> f64 {
    let clock = Instant::now();
    for _ in 0..STEPS {
        step(state);
    }
    1e9 * clock.elapsed().as_secs_f64() / f64::from(STEPS)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The median of some differences, if three quarters of them are above 0.
fn above_noise(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    (values[values.len() / 4] > 0.0).then(|| values[values.len() / 2])
}

fn main() {
    let body = packed("2mm..3mm");
    let mut states: Vec<State> = CASES.iter().map(|case| case.state(&body)).collect();
    let mut times = vec![Vec::new(); CASES.len()];
    for state in &mut states {
        time_ns(state);
    }
    // In turns, so that a slowdown of the machine affects all equally.
    for _ in 0..ROUNDS {
        for (state, times) in states.iter_mut().zip(&mut times) {
            times.push(time_ns(state));
        }
    }
    let mut table = Table::new();
    table.row(&format!(
        "A free, rotating body of {} particles and {} bonds on one thread: {:.3} ms per step, {:.1} ns per bond.\n",
        states[0].particles.len(),
        states[0].bonds.len(),
        1e-6 * median(times[0].clone()),
        median(times[0].clone()) / states[0].bonds.len() as f64,
    ));
    table.row(
        "| feature | compared with | when absent: items, bytes | when present: items per step | bytes per item | ns per item | step |"
    );
    table.row("|---|---|---|---|---|---|---|");
    for (at, case) in CASES.iter().enumerate().skip(1) {
        let beside = CASES.iter().position(|other| other.name == case.beside);
        let base = beside.expect("one of the cases");
        // Round by round, so that a disturbance of a round affects both.
        let pairs = times[at].iter().zip(&times[base]);
        let more_ns = pairs.clone().map(|(with, without)| with - without);
        let more_ns = above_noise(more_ns.collect());
        let ratio = median(pairs.map(|(with, without)| with / without).collect());
        let steps = states[at].steps as f64;
        let named = |stage: &&&Stage| stage.name == case.stage;
        let stage = stages().iter().find(named).expect("a stage");
        let items = states[at].scratch.clock.done(number_of(stage)) as f64 / steps;
        let absent = [
            states[base].scratch.clock.done(number_of(stage)),
            (stage.bytes)(&states[base]) as u64,
        ];
        table.row(&format!(
            "| {} | {} | {}, {} | {items:.0} | {} | {} | {ratio:.2} |",
            case.name,
            case.beside,
            absent[0],
            absent[1],
            if items > 0.0 {
                format!("{:.0}", (stage.bytes)(&states[at]) as f64 / items)
            } else {
                "-".to_owned()
            },
            match more_ns {
                Some(more_ns) if items > 0.0 => format!("{:.1}", more_ns / items),
                _ => "-".to_owned(),
            },
        ));
    }
    table.write("features");
}

/// The bending sample of spheres of these diameters.
fn packed(diameters: &str) -> Body {
    let bytes = std::fs::read(SHAPE).expect("the shape is in the repository");
    let reading = ReadSettings {
        unit_m: Some(1e-3),
        scale: 1.0,
        fill_holes: false,
    };
    let surface = read_surface(&bytes, "", reading).expect("the shape is sound");
    let settings = BodySettings {
        packing: PackSettings {
            sizes: Sizes::parse(diameters, Basis::Number).expect("good diameters"),
            overlap: 0.25,
            seed: 1,
            densify: None,
            seed_point_m: None,
        },
        bonds: BondSettings::default(),
        particle_density_kg_m3: None,
        solid_density_kg_m3: None,
    };
    make_body(&surface, &settings, &|_, _| Ok(()))
        .expect("packs")
        .0
}
