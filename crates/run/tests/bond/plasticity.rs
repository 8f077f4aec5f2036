//! Elasto-plastic bonds: curve, permanent set, work and cycles in closed form; what rotation, step
//! and failure do to them.

use std::f64::consts::PI;

use super::vector;
use crate::bars::reopen;
use crate::leave_out::planned;
use dem_engine::check::limit::limit;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact, step};
use dem_physics::bond::BondLoad;
use dem_physics::bond::plasticity::{PlasticDeformation, Plasticity, StressFree};
use dem_physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use dem_physics::bond::total::{End, bond_forces};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

const RADIUS_M: f64 = 1e-3;
const LENGTH_M: f64 = 2e-3;
const YOUNG_PA: f64 = 1e9;
const YIELD_PA: f64 = 1e4;
/// Amplitude of a cycle over the deformation at yield.
const AMPLITUDE: f64 = 3.0;
/// Time from rest to the amplitude, s, and the number of its steps.
const QUARTER_S: f64 = 2e-3;
const STEPS: f64 = 2000.0;

/// A mode: its name, how supports drive it, its load, and how that follows from the stress.
struct Mode {
    name: &'static str,
    /// Keys of a displacement of the right end, m or rad; the left end takes minus the second one.
    moves: [&'static str; 2],
    load: fn(&BondLoad) -> f64,
    stiffness: fn(&Stiffness) -> f64,
    per_stress: f64,
}

const AREA_M2: f64 = PI * RADIUS_M * RADIUS_M;
const MODES: [Mode; 4] = [
    Mode {
        name: "normal",
        moves: ["x", ""],
        load: |load| load.normal_n.abs(),
        stiffness: |k| k.normal,
        per_stress: AREA_M2,
    },
    Mode {
        name: "shear",
        moves: ["y", ""],
        load: |load| load.shear_n,
        stiffness: |k| k.shear,
        per_stress: AREA_M2,
    },
    Mode {
        name: "torsion",
        moves: ["rx", ""],
        load: |load| load.torsion_n_m,
        stiffness: |k| k.torsion,
        per_stress: AREA_M2 * RADIUS_M / 2.0,
    },
    Mode {
        name: "bending",
        moves: ["rz", "rz"],
        load: |load| load.bending_n_m,
        stiffness: |k| k.bending,
        per_stress: AREA_M2 * RADIUS_M / 4.0,
    },
];

/// A pair of bonded spheres with keys of its bond, and further tables.
fn pair(step_s: f64, bond: &str, more: &str) -> State {
    let text = format!(
        "version = 1
run = {{ end_time = 1, time_step = {step_s:e} }}
materials.steel = {{ density = 2500 }}
bonds.steel = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3{bond} }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M}], [{LENGTH_M}, 0, 0, {RADIUS_M}]], bond_list = [[0, 1]], material = \"steel\", bonds = \"steel\" }}
groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
{more}"
    );
    planned(&text).1.state
}

/// A bond that yields in one mode and is driven from rest to +1, -1, +1 and 0.3 times a
/// displacement, m or rad.
fn driven(mode: &Mode, hardening: f64, size: f64, slower: f64) -> State {
    let all = ["x", "y", "z", "rx", "ry", "rz"];
    let table: Vec<String> = [(0.0, 0.0), (1.0, 1.0), (3.0, -1.0), (5.0, 1.0), (5.7, 0.3)]
        .iter()
        .map(|(time, factor)| format!("[{:e}, {factor}]", time * slower * QUARTER_S))
        .collect();
    let support = |side: &str, moved: &str, size: f64| {
        let fixed: Vec<String> = (all.iter().filter(|axis| **axis != moved))
            .map(|axis| format!("\"{axis}\""))
            .collect();
        let moved = match moved {
            "" => String::new(),
            _ => format!(
                ", displacement = {{ {moved} = {size:e} }}, table = [{}]",
                table.join(", ")
            ),
        };
        format!(
            "supports.{side} = {{ group = \"{side}\", fixed = [{}]{moved} }}\n",
            fixed.join(", ")
        )
    };
    let [right, left] = mode.moves;
    let part = if left.is_empty() { 1.0 } else { 0.5 };
    let bond = format!(
        ", plasticity = {{ {}_yield_strength = {YIELD_PA:e}, hardening_ratio = {hardening} }}",
        mode.name
    );
    let supports = support("left", left, -part * size) + &support("right", right, part * size);
    pair(QUARTER_S / STEPS, &bond, &supports)
}

/// Load at a deformation, both over those at yield, after these turns of it: by Masing's rule, from
/// each turn twice the curve from rest.
fn curve(deformation: f64, turns: &[f64], hardening: f64) -> f64 {
    let rise = |far: f64, elastic: f64| {
        if far <= elastic {
            far
        } else {
            elastic + hardening * (far - elastic)
        }
    };
    let (mut load, mut at) = (0.0, 0.0);
    let mut elastic = 1.0;
    for to in turns.iter().copied().chain([deformation]) {
        load += f64::signum(to - at) * rise((to - at).abs(), elastic);
        at = to;
        elastic = 2.0;
    }
    load
}

#[test]
fn every_mode_follows_its_curve_and_dissipates_its_loop() {
    for (mode, hardening) in MODES.iter().flat_map(|mode| [(mode, 0.0), (mode, 0.1)]) {
        let what = format!("{}, hardening {hardening}", mode.name);
        let rest = driven(mode, hardening, 0.0, 1.0);
        let stiffness = (mode.stiffness)(&rest.bonds.stiffness(0));
        let limit_load = YIELD_PA * mode.per_stress;
        let at_yield = limit_load / stiffness;
        let mut state = driven(mode, hardening, AMPLITUDE * at_yield, 1.0);
        let unit_j = limit_load * at_yield;
        let (mut turns, mut last, mut works) = (vec![], 0.0, vec![]);
        let corners = [1.0, 3.0, 5.0, 5.7];
        for corner in corners {
            while state.time_s < (corner - 0.25 / STEPS) * QUARTER_S {
                interact(&mut state);
                let quarter = state.time_s / QUARTER_S;
                let factor = match quarter {
                    t if t <= 1.0 => t,
                    t if t <= 3.0 => 2.0 - t,
                    t if t <= 5.0 => t - 4.0,
                    t => 6.0 - t,
                };
                last = curve(AMPLITUDE * factor, &turns, hardening);
                let load = (mode.load)(&state.bonds.forces(0, &state.particles.poses).load);
                assert!(
                    (load / limit_load - last.abs()).abs() < 2e-7,
                    "{what}, {factor}: {load} {last}"
                );
                advance(&mut state);
            }
            interact(&mut state);
            works.push(balance(&mut state).bond_plastic_j / unit_j);
            if corner < 5.5 {
                turns.push(AMPLITUDE * if corner == 3.0 { -1.0 } else { 1.0 });
            }
            advance(&mut state);
        }
        // Plastic deformation at +1, and what hardening stores there.
        let set = (1.0 - hardening) * (AMPLITUDE - 1.0);
        let stored = 0.5 * hardening / (1.0 - hardening) * set * set;
        let area = 4.0 * (1.0 - hardening) * (AMPLITUDE - 1.0);
        for (work, expected) in [
            (works[0], set + stored),
            (works[1], set + stored + 0.5 * area),
            (works[2], set + stored + area),
        ] {
            assert!((work - expected).abs() < 2e-5, "{what}: {work} {expected}");
        }
        // The way back to 0.3 ends before it yields again, as 2.1 is little more than 2.
        let left = curve(0.3 * AMPLITUDE, &turns, hardening);
        assert!((last - left).abs() < 1e-2, "{what}: {last} {left}");
        let found = balance(&mut state);
        assert!(found.energy_error.abs() < 1e-5, "{what}: {found:?}");
        let plastic = state.bonds.histories.plastics[0];
        let parts = [
            plastic.elongation_m,
            Vector3::from(plastic.slip_m).norm(),
            plastic.twist_rad,
            Vector3::from(plastic.bend_rad).norm(),
        ];
        for (other, part) in MODES.iter().zip(parts) {
            let expected = if other.name == mode.name {
                let load = curve(0.3 * AMPLITUDE, &turns, hardening);
                (0.3 * AMPLITUDE - load) * at_yield
            } else {
                0.0
            };
            assert!(
                (part.abs() - expected.abs()).abs() < 1e-2 * at_yield,
                "{what}: {} of {} is {part}, not {expected}",
                other.name,
                mode.name
            );
        }
    }
}

/// Bonds that are pulled past yield and let go keep their plastic deformation and no load.
#[test]
fn a_bond_that_is_let_go_keeps_its_permanent_set() {
    let strain = YIELD_PA / YOUNG_PA;
    let hardening = 0.1;
    let stretch_m = 4.0 * strain * LENGTH_M;
    let mut state = pair(
        1e-6,
        &format!(
            ", damping = {{ damping_ratio = 1 }}, plasticity = {{ normal_yield_strength = {YIELD_PA:e}, hardening_ratio = {hardening} }}"
        ),
        &format!(
            "supports.left = {{ group = \"left\", fixed = true }}
supports.right = {{ group = \"right\", fixed = true, end = \"2 ms\" }}
[supports.pull]\ngroup = \"right\"\ndisplacement = {{ x = {stretch_m:e} }}\nramp = \"1 ms\"\nend = \"2 ms\"\n"
        )
        .replace("fixed = true, end", "fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], end"),
    );
    while state.time_s < 4e-3 {
        step(&mut state);
    }
    interact(&mut state);
    let places = [0, 1].map(|end| state.particles.poses[end].place().x);
    let set = (places[1] - places[0] - LENGTH_M) / LENGTH_M;
    // The stress at the largest strain over E is 1 + 3 h times that at yield: the rest is plastic.
    let expected = strain * (4.0 - (1.0 + 3.0 * hardening));
    assert!((set / expected - 1.0).abs() < 1e-5, "{set} {expected}");
    let load = state.bonds.forces(0, &state.particles.poses).load;
    assert!(load.normal_n.abs() < 1e-6 * YIELD_PA * AREA_M2, "{load:?}");
}

/// The way counts, not the speed: a tenth of the speed ends at the same plastic deformation.
#[test]
fn time_does_not_enter() {
    for mode in &MODES {
        let at_yield = YIELD_PA * mode.per_stress
            / (mode.stiffness)(&driven(mode, 0.1, 0.0, 1.0).bonds.stiffness(0));
        let ends = [1.0, 10.0].map(|slower| {
            let mut state = driven(mode, 0.1, AMPLITUDE * at_yield, slower);
            while state.time_s < 5.5 * slower * QUARTER_S {
                step(&mut state);
            }
            let plastic = state.bonds.histories.plastics[0];
            let [x, y, z] = plastic.slip_m;
            let [rx, ry, rz] = plastic.bend_rad;
            [plastic.elongation_m, x, y, z, plastic.twist_rad, rx, ry, rz]
        });
        for (fast, slow) in ends[0].into_iter().zip(ends[1]) {
            // A shear turns the line of centres, in steps, by up to 1e-4.
            let off = (fast - slow).abs() / at_yield;
            assert!(off < 1e-6, "{}: {off}", mode.name);
        }
    }
}

/// A row of spheres whose bonds yield in all modes, free, moving as the modes of its vibration.
fn thrown(part: f64, hardening: f64) -> State {
    let spheres: Vec<String> = (0..7)
        .map(|i| format!("[{}, 0, 0, {RADIUS_M}]", LENGTH_M * f64::from(i)))
        .collect();
    let text = format!(
        "version = 1
run = {{ end_time = 1, safety_factor = {part} }}
materials.steel = {{ density = 2500 }}
bonds.steel = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3, plasticity = {{ normal_yield_strength = {YIELD_PA:e}, shear_yield_strength = {YIELD_PA:e}, torsion_yield_strength = {YIELD_PA:e}, bending_yield_strength = {YIELD_PA:e}, hardening_ratio = {hardening} }} }}
bodies.row = {{ particles = [{}], bond_list = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6]], material = \"steel\", bonds = \"steel\" }}
",
        spheres.join(", ")
    );
    let mut state = planned(&text).1.state;
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        let phase = PI * i as f64 / 6.0;
        motion.velocity_m_s = [-0.02 * phase.cos(), 0.01 * (2.0 * phase).sin(), 0.0];
        motion.spin_rad_s = [4.0 * phase.cos(), 0.0, 6.0 * (2.0 * phase).cos()];
    }
    reopen(&mut state);
    state
}

#[test]
fn books_stay_closed_through_plastic_flow() {
    let until_s = 200.0 * thrown(0.25, 0.05).time_step_s;
    let errors = [0.25, 0.125, 0.0625].map(|part| {
        let mut state = thrown(part, 0.05);
        let mut error = 0.0_f64;
        while state.time_s < until_s {
            interact(&mut state);
            let now = balance(&mut state);
            error = error.max(now.energy_error.abs());
            assert!(now.momentum_error < 1e-12, "{now:?}");
            assert!(now.angular_momentum_error < 1e-12, "{now:?}");
            advance(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        assert!(now.bond_plastic_j > 0.3 * now.energy_scale_j, "{now:?}");
        let works = state
            .bonds
            .histories
            .plastics
            .iter()
            .map(|plastic| plastic.work_j);
        let of_bonds: f64 = works.clone().sum();
        assert!((of_bonds / now.bond_plastic_j - 1.0).abs() < 1e-12);
        assert!(works.filter(|work_j| *work_j > 0.0).count() >= 4);
        error
    });
    let falls = errors[0] / errors[2];
    assert!(
        (12.0..20.0).contains(&falls),
        "falls by {falls}: {errors:?}"
    );
}

/// Flow needs no smaller step: the row is stable just below the limit of its elastic bonds, which
/// stays what it was.
#[test]
fn flow_needs_no_smaller_step() {
    let mut state = thrown(1.0, 0.3);
    let elastic_s = limit(&mut state).step_s;
    state.time_step_s = 0.98 * elastic_s;
    let mut largest_j = 0.0_f64;
    for _ in 0..20_000 {
        interact(&mut state);
        let now = balance(&mut state);
        largest_j = largest_j.max(now.kinetic_j + now.elastic_j());
        advance(&mut state);
    }
    interact(&mut state);
    let now = balance(&mut state);
    assert!(now.bond_plastic_j > 0.3 * now.energy_scale_j, "{now:?}");
    assert!(now.kinetic_j + now.elastic_j() < 0.7 * largest_j, "{now:?}");
    let limit_s = limit(&mut state).step_s;
    assert!(
        (limit_s / elastic_s - 1.0).abs() < 2e-3,
        "{limit_s} {elastic_s}"
    );
}

/// With hardening a bond goes on to its strength, and breaks there.
#[test]
fn a_bond_that_hardens_breaks_at_its_strength() {
    let (hardening, strength) = (0.1, 1.5);
    let strain = YIELD_PA / YOUNG_PA;
    let speed_m_s = 1e-5;
    let mut state = pair(
        1e-6,
        &format!(
            ", failure = {{ tensile_strength = {:e} }}, plasticity = {{ normal_yield_strength = {YIELD_PA:e}, hardening_ratio = {hardening} }}",
            strength * YIELD_PA
        ),
        &format!(
            "supports.left = {{ group = \"left\", fixed = true }}\nsupports.right = {{ group = \"right\", fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], velocity = {{ x = {speed_m_s:e} }} }}\n"
        ),
    );
    while state.broken_count == 0 && state.time_s < 0.1 {
        step(&mut state);
    }
    let expected_m = strain * LENGTH_M * (1.0 + (strength - 1.0) / hardening);
    let found_m = state.time_s * speed_m_s;
    assert!(
        (found_m - expected_m).abs() < 3e-6 * speed_m_s,
        "{found_m} {expected_m}"
    );
    interact(&mut state);
    let now = balance(&mut state);
    let load_n = strength * YIELD_PA * AREA_M2;
    let elastic_j = 0.5 * load_n * load_n * LENGTH_M / (YOUNG_PA * AREA_M2);
    assert!(
        (now.bond_breakage_j / elastic_j - 1.0).abs() < 1e-3,
        "{now:?}"
    );
}

/// A bond of unequal spheres and its law, in which all modes yield.
fn bond() -> (StressFree, Stiffness, Plasticity) {
    let shape = BondShape {
        length_m: 1.8,
        radius_m: 0.5,
        end_radii_m: [1.0, 0.7],
    };
    let k = stiffness(BondModel::Parallel { kappa: None }, &shape, 1e3, 0.3);
    let free = StressFree {
        levers_m: k.levers_m,
        direction: Vector3::x(),
        plastic: PlasticDeformation::NONE,
    };
    let law = Plasticity {
        yield_strengths_pa: [0.2; 4],
        hardening_ratio: 0.1,
    };
    (free, k, law)
}

fn ends(apart: Vector3<f64>, turns: [Vector3<f64>; 2]) -> [End; 2] {
    [
        (Vector3::zeros(), turns[0]),
        (Vector3::x() * 1.8 + apart, turns[1]),
    ]
    .map(|(position_m, turn)| End {
        position_m,
        turned: UnitQuaternion::from_scaled_axis(turn),
    })
}

proptest! {
    /// After a flow no mode is beyond its yield, and the modes that did not flow carry what they
    /// did; rotated with both ends, a bond keeps its loads and does not flow; and forces are the
    /// gradient of the energy: no net force or moment acts.
    #[test]
    fn flow_returns_to_yield_at_any_rotation(
        apart in vector(0.002), turn_a in vector(0.002), turn_b in vector(0.002),
        more in vector(0.002), by in vector(3.0)
    ) {
        let (free, k, law) = bond();
        let limits = law.limits(0.5);
        let mut known = free;
        // A first flow, so that the second one begins with a plastic deformation.
        for scale in [1.0, 2.0] {
            let at = ends(scale * apart + (scale - 1.0) * more, [scale * turn_a, scale * turn_b]);
            let before = bond_forces(&known.with_levers(&k), &known.direction, &known.plastic.ends(&at)).load;
            let Some(after) = law.yielded(&known, &k, 0.5, &at) else { continue };
            let forces = |bond: &StressFree, at: &[End; 2]| {
                bond_forces(&bond.with_levers(&k), &bond.direction, &bond.plastic.ends(at))
            };
            let load = forces(&after, &at).load;
            let flowed = [
                after.plastic.elongation_m != known.plastic.elongation_m,
                after.plastic.slip_m != known.plastic.slip_m,
                after.plastic.twist_rad != known.plastic.twist_rad,
                after.plastic.bend_rad != known.plastic.bend_rad,
            ];
            let loads = |l: BondLoad| [l.normal_n.abs(), l.shear_n, l.torsion_n_m, l.bending_n_m];
            for (mode, is_flowing) in flowed.into_iter().enumerate() {
                let (was, is) = (loads(before)[mode], loads(load)[mode]);
                let moved = (is - was) / limits[mode];
                let is_right = moved < 2e-2 && (is_flowing || moved > -2e-2);
                prop_assert!(is_right, "{mode}: {was} {is} of {}", limits[mode]);
            }
            // What is left beyond yield is that of the turn of the axis, up to 0.01, and of second
            // order.
            let again = law.yielded(&after, &k, 0.5, &at);
            if let Some(again) = again {
                let step = |a: [f64; 3], b: [f64; 3]| (Vector3::from(a) - Vector3::from(b)).norm();
                let moved = [
                    k.normal * (again.plastic.elongation_m - after.plastic.elongation_m),
                    k.shear * step(again.plastic.slip_m, after.plastic.slip_m),
                    k.torsion * (again.plastic.twist_rad - after.plastic.twist_rad),
                    k.bending * step(again.plastic.bend_rad, after.plastic.bend_rad),
                ];
                for (mode, moved) in moved.into_iter().enumerate() {
                    prop_assert!(moved.abs() < 2e-2 * limits[mode], "{mode}: {moved} of {}", limits[mode]);
                }
            }
            let by = UnitQuaternion::from_scaled_axis(by);
            let rotated = at.map(|end| End { position_m: by * end.position_m, turned: by * end.turned });
            let (here, there) = (forces(&after, &at), forces(&after, &rotated));
            for (one, other) in loads(here.load).into_iter().zip(loads(there.load)) {
                prop_assert!((one - other).abs() < 1e-10, "{one} {other}");
            }
            prop_assert!((by * here.force_on_b - there.force_on_b).norm() < 1e-10);
            let arm = at[1].position_m - at[0].position_m;
            let moment = arm.cross(&here.force_on_b) + here.torques[0] + here.torques[1];
            prop_assert!(moment.norm() < 1e-10, "{moment}");
            known = after;
        }
    }
}
