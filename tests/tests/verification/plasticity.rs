//! Elasto-plastic bonds: loads and work of cycles in every mode, permanent set of a bar.

use std::f64::consts::PI;

use dem_run::physics::bond::BondLoad;
use dem_run::stages::ledger::bookkeeping::balance;
use dem_run::step::{advance, interact};
use dem_run::{State, step};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::{place, started};
use super::table::{Case, compared};

const RADIUS_M: f64 = 1e-3;
const LENGTH_M: f64 = 2e-3;
const YOUNG_PA: f64 = 1e9;
const YIELD_PA: f64 = 1e4;
/// Amplitude of a cycle over the deformation at yield.
const AMPLITUDE: f64 = 3.0;
/// Steps from rest to the amplitude, and their length, s.
const STEPS: f64 = 2000.0;
const STEP_S: f64 = 1e-6;
/// Squares of the strains and of a step.
const BOUND: f64 = 1e-6;

/// A mode: its name, the displacements of the right and of the left end, its load, and its load
/// over its stress.
type Mode = (&'static str, [&'static str; 2], fn(&BondLoad) -> f64, f64);

const AREA_M2: f64 = PI * RADIUS_M * RADIUS_M;
const MODES: [Mode; 4] = [
    ("normal", ["x", ""], |load| load.normal_n, AREA_M2),
    ("shear", ["y", ""], |load| load.shear_n, AREA_M2),
    (
        "torsion",
        ["rx", ""],
        |load| load.torsion_n_m,
        AREA_M2 * RADIUS_M / 2.0,
    ),
    (
        "bending",
        ["rz", "rz"],
        |load| load.bending_n_m,
        AREA_M2 * RADIUS_M / 4.0,
    ),
];

/// Loads of a bond at rest, after a deformation of 1 m or rad.
fn stiffness(state: &State, mode: &str) -> f64 {
    let k = state.bonds.stiffness(0);
    match mode {
        "normal" => k.normal,
        "shear" => k.shear,
        "torsion" => k.torsion,
        _ => k.bending,
    }
}

/// A bond whose ends move as the supports say.
fn pair((name, ..): &Mode, hardening: f64, supports: &str) -> State {
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = 1, time_step = {STEP_S:e} }}
        materials.steel = {{ density = 2500 }}
        bonds.steel = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3, plasticity = {{ {name}_yield_strength = {YIELD_PA:e}, hardening_ratio = {hardening} }} }}
        bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M}], [{LENGTH_M}, 0, 0, {RADIUS_M}]], bond_list = [[0, 1]], material = "steel", bonds = "steel" }}
        groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
        {supports}
        "#
    ))
}

/// A support that moves an end to this displacement, m or rad, and between it and its negative.
fn support(side: &str, axis: &str, size: f64) -> String {
    let axes = ["x", "y", "z", "rx", "ry", "rz"].into_iter();
    let fixed: Vec<String> = axes
        .filter(|other| *other != axis)
        .map(|other| format!("\"{other}\""))
        .collect();
    let turns = [[0.0, 0.0], [1.0, 1.0], [3.0, -1.0], [5.0, 1.0]];
    let table = turns.map(|[time, factor]| format!("[{:e}, {factor}]", time * STEPS * STEP_S));
    let moved = match axis {
        "" => String::new(),
        _ => format!(
            ", displacement = {{ {axis} = {size:e} }}, table = [{}]",
            table.join(", ")
        ),
    };
    format!(
        "supports.{side} = {{ group = \"{side}\", fixed = [{}]{moved} }}\n",
        fixed.join(", ")
    )
}

/// Load at the amplitude, and work of the supports in the cycle after it, both in units of yield.
fn of_cycle(mode: &Mode, hardening: f64) -> [f64; 2] {
    let (name, [right, left], load, per_stress) = mode;
    let yield_load = YIELD_PA * per_stress;
    let at_yield = yield_load / stiffness(&pair(mode, hardening, ""), name);
    let size = AMPLITUDE * at_yield * if left.is_empty() { 1.0 } else { 0.5 };
    let supports = support("left", left, -size) + &support("right", right, size);
    let mut state = pair(mode, hardening, &supports);
    let turns = [1.0, 5.0].map(|turn| {
        while state.time_s < (turn * STEPS - 0.5) * STEP_S {
            step(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        let load = load(&state.bonds.forces(0, &state.particles.poses).load);
        advance(&mut state);
        [
            load / yield_load,
            now.support_work_j / (yield_load * at_yield),
        ]
    });
    [turns[0][0], turns[1][1] - turns[0][1]]
}

fn by_mode() -> String {
    let mut cases = Vec::new();
    for hardening in [0.0, 0.1] {
        for mode in &MODES {
            let [load, work] = of_cycle(mode, hardening);
            let beyond = AMPLITUDE - 1.0;
            let (what, expected) = (
                format!("{}, h = {hardening}", mode.0),
                1.0 + hardening * beyond,
            );
            cases.push(Case::new(format!("{what}: load"), load, expected, BOUND));
            let area = 4.0 * (1.0 - hardening) * beyond;
            let bound = 10.0 * BOUND;
            cases.push(Case::new(format!("{what}: work"), work, area, bound));
        }
    }
    compared("mode", "", &cases)
}

/// Permanent strain of a bar of so many bonds that is stretched to this multiple of its strain at
/// yield, relieved and let go, over that strain.
fn permanent_set(bonds: u32, stretch: f64, hardening: f64) -> f64 {
    let long_m = 16e-3;
    let length_m = long_m / f64::from(bonds);
    let radius_m = 0.5 * length_m;
    let spheres = (0..=bonds).map(|i| {
        let x_m = f64::from(i) * length_m;
        format!("[{x_m:e}, 0, 0, {radius_m:e}]")
    });
    let pairs = (0..bonds).map(|i| format!("[{i}, {}]", i + 1));
    let [spheres, pairs] = [spheres.collect::<Vec<_>>(), pairs.collect()].map(|l| l.join(", "));
    let strain = YIELD_PA / YOUNG_PA;
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = 1, safety_factor = 0.5 }}
        materials.steel = {{ density = 2500 }}
        bodies.bar = {{ particles = [{spheres}], bond_list = [{pairs}], material = "steel", bonds = "steel" }}
        bonds.steel = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3, radius_factor = {:e}, damping = {{ damping_ratio = 1 }}, plasticity = {{ normal_yield_strength = {YIELD_PA:e}, hardening_ratio = {hardening} }} }}
        groups = {{ left = {{ particles = [0] }}, right = {{ particles = [{bonds}] }} }}
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], displacement = {{ x = {:e} }}, table = [[0, 0], [40e-3, 1], [80e-3, 0.7]], end = 80e-3 }}
        "#,
        RADIUS_M / radius_m,
        stretch * strain * long_m,
    ));
    while state.time_s < 100e-3 {
        step(&mut state);
    }
    let ends = [0, bonds as usize].map(|i| place(&state, i).x);
    ((ends[1] - ends[0]) / long_m - 1.0) / strain
}

fn by_bar() -> String {
    let (stretch, hardening) = (4.0, 0.1);
    let cases = [1, 2, 4, 8].map(|bonds| {
        let expected = (1.0 - hardening) * (stretch - 1.0);
        let found = permanent_set(bonds, stretch, hardening);
        let what = format!("{bonds} bonds");
        Case::new(what, found, expected, 1e-3)
    });
    compared("bar", "", &cases)
}

#[test]
fn plasticity() {
    let page = on_one_thread(|| {
        filled(
            include_str!("plasticity.md"),
            &[("by mode", by_mode()), ("by bar", by_bar())],
        )
    });
    assert_shown(&[("plasticity.md".to_owned(), page)]);
}
