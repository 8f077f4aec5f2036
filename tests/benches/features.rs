//! The table of doc/leave-out.md: the cost of each feature of a scene when it is used, and the
//! absence of a cost when it is not. `cargo bench -p dem-tests --bench features`. A minute.
#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark stops where it fails, and prints a table"
)]

use std::collections::BTreeMap;
use std::time::Instant;

mod page;

use dem_io::Body;
use dem_io::surface::{ReadSettings, surface_from_stl};
use dem_pack::{Basis, BodySettings, PackSettings, Sizes, make_body};
use dem_run::plan::plan;
use dem_run::stages::bonds::BONDS;
use dem_run::stages::breakage::{FAILURE, FRICTION, RATES, SCATTER};
use dem_run::stages::contacts::CONTACTS;
use dem_run::stages::damping::BOND_DAMPING;
use dem_run::stages::flat_joints::FLAT_JOINTS;
use dem_run::stages::incremental::HISTORIES;
use dem_run::stages::loads::LOADS;
use dem_run::stages::motion::{GRAVITY, PARTICLE_DAMPING};
use dem_run::stages::plasticity::PLASTICITY;
use dem_run::stages::stage::Stage;
use dem_run::stages::structural::STRUCTURAL_DAMPING;
use dem_run::stages::supports::SUPPORTS;
use dem_run::stages::walls::WALLS;
use dem_run::state::State;
use dem_run::step::{number_of, step};

const SHAPE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../data/shapes/bending-sample.stl"
);

/// Number of rounds, of which the median is taken, and steps of each.
const ROUNDS: usize = 15;
const STEPS: u32 = 60;

/// The reference of other cases: a free, rotating body without any feature.
const PLAIN: &str = "a free body";

/// A scene: its name, its reference, its additional feature, and its text in place of run, bonds
/// and tables.
struct Case {
    name: &'static str,
    beside: &'static str,
    stage: Stage,
    run: &'static str,
    bonds: &'static str,
    tables: &'static str,
}

const CASE: Case = Case {
    name: PLAIN,
    beside: PLAIN,
    stage: BONDS,
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
        stage: HISTORIES,
        bonds: "formulation = \"incremental\"",
        ..CASE
    },
    Case {
        name: "bond damping",
        stage: BOND_DAMPING,
        bonds: "damping = { damping_ratio = 0.1 }",
        ..CASE
    },
    Case {
        name: "structural damping",
        stage: STRUCTURAL_DAMPING,
        bonds: "damping = { structural_damping = 0.1 }",
        ..CASE
    },
    Case {
        name: "elasto-plastic bonds",
        stage: PLASTICITY,
        bonds: "plasticity = { normal_yield_strength = 1e12, bending_yield_strength = 1e12 }",
        ..CASE
    },
    Case {
        name: "flat joints, 2 x 6 elements",
        stage: FLAT_JOINTS,
        bonds: "model = \"flat-joint\"\nradial_elements = 2\ncircumferential_elements = 6\nfailure = { tensile_strength = 1e12 }",
        ..CASE
    },
    Case {
        name: "failure",
        stage: FAILURE,
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\" }",
        ..CASE
    },
    Case {
        name: "fracture energy",
        beside: "failure",
        stage: FAILURE,
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\", fracture_energy = 1e12 }",
        ..CASE
    },
    Case {
        name: "friction of bonds",
        beside: "failure",
        stage: FRICTION,
        bonds: "failure = { cohesion = 1e12, friction_angle = \"35 deg\" }",
        ..CASE
    },
    Case {
        name: "strength scatter",
        beside: "failure",
        stage: SCATTER,
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\", weibull_modulus = 5 }",
        ..CASE
    },
    Case {
        name: "rate strengthening",
        beside: "failure",
        stage: RATES,
        bonds: "failure = { von_mises_strength = 1e12, equivalent_stress = \"axial-in-tension\", rate_strengthening = true }",
        ..CASE
    },
    Case {
        name: "local damping",
        stage: PARTICLE_DAMPING,
        run: ", local_damping = 0.1",
        ..CASE
    },
    Case {
        name: "gravity",
        stage: GRAVITY,
        run: ", gravity = [0, 0, -9.81]",
        ..CASE
    },
    Case {
        name: "loads",
        stage: LOADS,
        tables: "[loads.push]\ngroup = \"cake\"\nforce = [0, 0, 1e-3]\n",
        ..CASE
    },
    Case {
        name: "supports",
        stage: SUPPORTS,
        tables: "[supports.hold]\ngroup = \"cake\"\nfixed = [\"x\"]\n",
        ..CASE
    },
    Case {
        name: "walls",
        stage: WALLS,
        tables: FLOOR,
        ..CASE
    },
    Case {
        name: "particle contacts",
        beside: "failure",
        stage: CONTACTS,
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
        let more_ns = median(
            pairs
                .clone()
                .map(|(with, without)| with - without)
                .collect(),
        );
        let ratio = median(pairs.map(|(with, without)| with / without).collect());
        let steps = states[at].steps as f64;
        let items = states[at].scratch.clock.done(number_of(&case.stage)) as f64 / steps;
        let absent = [
            states[base].scratch.clock.done(number_of(&case.stage)),
            (case.stage.bytes)(&states[base]) as u64,
        ];
        table.row(&format!(
            "| {} | {} | {}, {} | {items:.0} | {} | {} | {ratio:.2} |",
            case.name,
            case.beside,
            absent[0],
            absent[1],
            if items > 0.0 {
                format!("{:.0}", (case.stage.bytes)(&states[at]) as f64 / items)
            } else {
                "-".to_owned()
            },
            if items > 0.0 {
                format!("{:.1}", more_ns / items)
            } else {
                "-".to_owned()
            },
        ));
    }
    table.write("features");
}

/// The bending sample of spheres of these diameters.
fn packed(diameters: &str) -> Body {
    let bytes = std::fs::read(SHAPE).expect("the shape is in the repository");
    let reading = ReadSettings {
        unit_m: 1e-3,
        scale: 1.0,
        fill_holes: false,
    };
    let surface = surface_from_stl(&bytes, "", reading).expect("the shape is sound");
    let settings = BodySettings {
        packing: PackSettings {
            sizes: Sizes::parse(diameters, Basis::Number).expect("good diameters"),
            overlap: 0.25,
            seed: 1,
            densify: None,
            seed_point_m: None,
        },
        bond_range: 1.1,
        bonds_per_particle: None,
        bond_radius_factor: 1.0,
        particle_density_kg_m3: None,
        solid_density_kg_m3: None,
    };
    make_body(&surface, &settings, &|_, _| Ok(()))
        .expect("packs")
        .0
}
