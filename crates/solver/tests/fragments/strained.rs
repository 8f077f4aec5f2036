//! A body taken from a run has the forces that its bonds had, whatever their model and history, and
//! wherever the next scene puts it.

use std::path::Path;
use std::process::{Command, Output};

use dem_engine::state::State;
use dem_engine::step::{exchange, interact, step};
use dem_io::Body;
use dem_io::body::{read_body, write_body};
use dem_plan::{Plan, plan};
use dem_results::{Existing, ResultsFolder};
use dem_scene::{Scene, read_bodies, scene_from_text};
use nalgebra::{UnitQuaternion, Vector3};

use super::burst::run_into;

const PLASTIC: &str = "plasticity = { normal_yield_strength = 2e5, shear_yield_strength = 1e5, torsion_yield_strength = 1e5, bending_yield_strength = 1e5, hardening_ratio = 0.2 }";
const JOINT: &str = "model = \"flat-joint\", radial_elements = 2, circumferential_elements = 7, joint_friction = 0.4, failure = { tensile_strength = STRENGTH, cohesion = STRENGTH, friction_angle = \"20 deg\" }";

/// Strengths that are tried, Pa, until bonds are damaged and the body is still one piece.
fn strengths() -> impl Iterator<Item = f64> {
    (0..40).map(|n| 5e4 * 1.08_f64.powi(n))
}

/// Names and keys of kinds of bonds.
const KINDS: [(&str, &str); 8] = [
    ("timoshenko", "model = \"timoshenko\""),
    ("parallel", "model = \"parallel\""),
    ("rojek", "model = \"rojek\""),
    ("pin", "model = \"pin\""),
    ("incremental", "formulation = \"incremental\""),
    ("plastic", PLASTIC),
    ("joint", JOINT),
    (
        "damaged",
        "failure = { tensile_strength = STRENGTH, shear_strength = STRENGTH, fracture_energy = 100 }",
    ),
];

/// Where the next scene puts the body.
const TURN: [f64; 3] = [0.3, -0.8, 1.1];

fn scene(kind: &str, body: &str) -> Scene {
    let text = format!(
        "version = 1
        run = {{ end_time = 1e-3 }}
        materials.rock = {{ density = 2500 }}
        bonds.rock = {{ young_modulus = 1e8, poisson_ratio = 0.25, {kind} }}
        bodies.chain = {{ particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1.2e-3], [2.5e-3, 2e-3, 0, 1e-3], [1e-3, 2e-3, 1.9e-3, 1e-3], [-1e-3, 2.5e-3, 2e-3, 0.9e-3]], bond_list = [[0, 1], [1, 2], [2, 3], [3, 4], [0, 2]], material = \"rock\", bonds = \"rock\"{body} }}
        "
    );
    scene_from_text(&text, "strained.toml", &[]).unwrap()
}

/// The body after its particles have been thrown about for a while.
fn strained(kind: &str) -> (Scene, Plan) {
    let scene = scene(kind, "");
    let mut plan = plan(&scene, read_bodies(&scene).unwrap(), 1, false).unwrap();
    let state = &mut plan.state;
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        let wave = |k: usize| (1.7 * (3 * i + k) as f64 + 0.4).sin();
        motion.velocity_m_s = [0, 1, 2].map(|k| 0.5 * wave(k));
        motion.spin_rad_s = [0, 1, 2].map(|k| 600.0 * wave(k + 40));
    }
    (0..600).for_each(|_| {
        step(state);
    });
    state.time_s = 0.0;
    state.steps = 0;
    // What yields or slides does so at these positions, and loads are summed no further.
    state.previous_time_step_s = 0.0;
    interact(state);
    state.ledger = Default::default();
    (scene, plan)
}

/// Force and torque of the bonds on each particle of the file, and their energy, J.
fn loads(state: &State, numbers: &[u32]) -> (Vec<[Vector3<f64>; 2]>, f64) {
    let mut found = vec![[Vector3::zeros(); 2]; numbers.len()];
    let number_of = |end: u32| numbers.iter().position(|i| *i == end).unwrap();
    let mut energy_j = 0.0;
    for at in (0..state.bonds.len()).filter(|at| !state.bonds.is_broken(*at)) {
        let forces = state.bonds.forces(at, &state.particles.poses);
        let [a, b] = state.bonds.ends[at].map(number_of);
        found[a][0] -= forces.force_on_b;
        found[b][0] += forces.force_on_b;
        found[a][1] += forces.torques[0];
        found[b][1] += forces.torques[1];
        energy_j += forces.energy.total();
    }
    (found, energy_j)
}

fn fragment(folder: &Path, output: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_dem-run"))
        .current_dir(folder)
        .args(["fragment", "out", "--largest", "--frame", "0", "-o", output])
        .output()
        .unwrap()
}

/// The body that dem-run fragment makes of this state.
fn taken(folder: &Path, scene: &Scene, plan: &Plan) -> Body {
    let results = ResultsFolder::create(&folder.join("out"), Existing::Replace).unwrap();
    let mut scene = scene.clone();
    scene.run.end_time_s = 1e-9;
    run_into(&results, plan.clone(), &scene, None, 2.0).unwrap();
    let done = fragment(folder, "left.vtp");
    assert!(done.status.success(), "{done:?}");
    read_body(&folder.join("left.vtp")).unwrap()
}

/// Compares loads with those before, in a body that has been turned.
fn same(name: &str, before: &(Vec<[Vector3<f64>; 2]>, f64), after: &(Vec<[Vector3<f64>; 2]>, f64)) {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(TURN));
    assert!(
        (after.1 / before.1 - 1.0).abs() < 1e-9,
        "{name}: {} J of {} J",
        after.1,
        before.1
    );
    for which in 0..2 {
        let largest = before.0.iter().map(|one| one[which].norm());
        let largest = largest.fold(0.0, f64::max);
        for (before, after) in before.0.iter().zip(&after.0) {
            let off = (turn * before[which] - after[which]).norm();
            assert!(off <= 1e-9 * largest, "{name}: {off} of {largest}");
        }
    }
}

#[test]
fn every_bond_keeps_its_forces_and_what_it_has_been_through() {
    let folder = tempfile::tempdir().unwrap();
    for (name, kind) in KINDS {
        let of_strength = strengths().map(|pa| kind.replace("STRENGTH", &pa.to_string()));
        let tried = of_strength.map(|kind| {
            let (first, plan) = strained(&kind);
            (kind, first, plan)
        });
        let is_good = |plan: &Plan| {
            let bonds = &plan.state.bonds;
            let mut elements = bonds
                .histories
                .joints
                .iter()
                .flat_map(|joint| &joint.elements);
            // At most one of the bonds between the first three, which hold each other twice.
            let broken = (0..bonds.len()).filter(|at| bonds.is_broken(*at));
            let number = |end: u32| plan.bodies[0].number_of(end).unwrap();
            let broken: Vec<[u32; 2]> = broken.map(|at| bonds.ends[at].map(number)).collect();
            // A joint of which nothing holds breaks later in the step.
            let holds = bonds
                .histories
                .joints
                .iter()
                .all(|joint| !joint.has_failed());
            let inner = broken.as_flattened().iter().all(|end| *end < 3);
            let whole = holds && broken.len() < 2 && inner;
            whole
                && match name {
                    "joint" => elements.any(|element| element.slip_m != [0.0; 3]),
                    "damaged" => (0..bonds.len()).any(|at| bonds.damage(at) > 0.0),
                    _ => true,
                }
        };
        let mut good = tried.filter(|(_, _, plan)| is_good(plan));
        let (kind, first, plan_of_first) = good.next().unwrap();
        let kind = &kind[..];
        let numbers = &plan_of_first.bodies[0].particles;
        let before = loads(&plan_of_first.state, numbers);
        assert!(before.1 > 1e-7, "{name}: {} J", before.1);
        let bonds = &plan_of_first.state.bonds;
        if name == "plastic" {
            assert!(
                bonds
                    .histories
                    .plastics
                    .iter()
                    .any(|p| p.bend_rad != [0.0; 3])
            );
        }
        let body = taken(folder.path(), &first, &plan_of_first);
        // As a body that starts bonded, and as a clump that becomes bonded at once.
        let put = format!(
            ", position = [0.1, 0.2, -0.3], rotation = {{ axis = [{}, {}, {}], angle = {} }}",
            TURN[0],
            TURN[1],
            TURN[2],
            Vector3::from(TURN).norm()
        );
        let again = |rest: &str| {
            let next = scene(kind, &format!("{put}{rest}"));
            let bodies = [("chain".to_owned(), body.clone())].into();
            plan(&next, bodies, 1, false).unwrap()
        };
        let bonded = again("");
        let after = loads(&bonded.state, &bonded.bodies[0].particles);
        same(name, &before, &after);
        let clump = again(", start_as = \"clump\" }\nreplacement.chain = { when = { time = 0 }");
        let mut state = clump.state;
        let file_number = state.clumps.templates[0].file_number.clone();
        interact(&mut state);
        exchange(&mut state);
        let mut numbers = vec![0; file_number.len()];
        for (i, number) in (0..).zip(file_number.iter()) {
            numbers[*number as usize] = i;
        }
        same(name, &before, &loads(&state, &numbers));
        // What a file with its histories alone would give.
        let straight = Body {
            turns_rad: Vec::new(),
            bond_directions: Vec::new(),
            ..body.clone()
        };
        let bodies = [("chain".to_owned(), straight)].into();
        let straight = plan(&scene(kind, &put), bodies, 1, false).unwrap();
        let lost = loads(&straight.state, &straight.bodies[0].particles).1;
        let forgets = !matches!(name, "incremental" | "joint" | "damaged");
        assert!(!forgets || lost < 0.99 * before.1, "{name}: {lost}");
    }
}

#[test]
fn files_that_cannot_hold_the_strain_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, plan) = strained("model = \"timoshenko\"");
    let body = taken(folder.path(), &scene, &plan);
    for name in ["left.csv", "left.txt", "left.data"] {
        let done = fragment(folder.path(), name);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(2), "{said}");
        assert!(
            said.contains("bonds that are bent, twisted or sheared, which such a file does not hold; write a .vtp"),
            "{said}"
        );
    }
    // Stretched only.
    let stretched = Body {
        turns_rad: Vec::new(),
        bond_directions: Vec::new(),
        ..body
    };
    write_body(&stretched, &folder.path().join("left.csv")).unwrap();
    for name in ["left.txt", "left.data"] {
        let said = write_body(&stretched, &folder.path().join(name)).unwrap_err();
        assert!(said.problem.contains("stretched or pressed"), "{said}");
    }
}

#[test]
fn of_a_clump_only_the_hull_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let scene = scene(
        "model = \"timoshenko\"",
        ", start_as = \"clump\" }\nreplacement.chain = { when = { time = 1 }",
    );
    let plan = plan(&scene, read_bodies(&scene).unwrap(), 1, false).unwrap();
    let results = ResultsFolder::create(&here.join("out"), Existing::Refuse).unwrap();
    run_into(&results, plan, &scene, None, 2.0).unwrap();
    let done = fragment(here, "left.vtp");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("is a rigid clump at 0 s"), "{said}");
    let hulls = Command::new(env!("CARGO_BIN_EXE_dem-run"))
        .current_dir(here)
        .args(["fragment", "out", "--all", "--stl", "-o", "hulls"])
        .output()
        .unwrap();
    assert!(hulls.status.success(), "{hulls:?}");
}
