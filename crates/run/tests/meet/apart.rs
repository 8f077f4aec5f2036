//! Overlapping bodies, including overlapping second neighbours, whose bonds vanish all at once or
//! one by one: they separate without gaining energy.

use std::sync::Arc;

use std::fmt::Write;

use dem_engine::stages::clusters::pieces::find_pieces_of;
use dem_engine::stages::ledger::bookkeeping::{balance, opened};
use dem_engine::state::State;
use dem_engine::step::{advance, interact, step};
use dem_physics::bond::failure::Criteria;
use dem_plan::measure::bond_utilisation;
use dem_plan::{Plan, plan};
use nalgebra::Vector3;

use super::clouds::scattered;
use crate::helpers::scene;
use dem_scene::read_bodies;

const RADIUS_M: f64 = 1e-3;

/// The plan of a scene with inline particles.
pub(crate) fn planned(text: &str) -> Plan {
    let scene = scene(text);
    plan(&scene, read_bodies(&scene).unwrap(), 2, false).unwrap()
}

/// A cube of 4 x 4 x 4 spheres on a lattice such that neighbours overlap by this fraction of r_gen,
/// bonded to their nearest neighbours.
fn cube(overlap: f64, extra: &str) -> String {
    let apart_m = 2.0 * RADIUS_M / (1.0 + overlap);
    let count = 4_usize;
    let (mut particles, mut bonds) = (String::new(), String::new());
    let number = |[x, y, z]: [usize; 3]| (z * count + y) * count + x;
    for z in 0..count {
        for y in 0..count {
            for x in 0..count {
                let [px, py, pz] = [x, y, z].map(|n| n as f64 * apart_m);
                let _ = write!(particles, "[{px}, {py}, {pz}, {RADIUS_M}],");
                for next in [[x + 1, y, z], [x, y + 1, z], [x, y, z + 1]] {
                    if next.iter().all(|n| *n < count) {
                        let _ = write!(bonds, "[{}, {}],", number([x, y, z]), number(next));
                    }
                }
            }
        }
    }
    format!(
        "version = 1\nrun.end_time = 1\n\
         materials.cake = {{ density = 2000, young_modulus = \"10 MPa\" }}\n\
         contacts.cake-cake = {{ restitution = 0.5, friction = 0.5 }}\n\
         bonds.cake = {{ young_modulus = \"10 MPa\", poisson_ratio = 0.3, failure = {{ tensile_strength = 1e9 }} }}\n\
         bodies.cube = {{ material = \"cake\", bonds = \"cake\", particles = [{particles}], bond_list = [{bonds}] }}\n{extra}"
    )
}

/// Breaks a bond outside a step: it stores no energy if the body is at rest.
fn vanish(state: &mut State, at: usize) {
    state.bonds.set_broken(at);
    find_pieces_of(state, &[at as u32]);
}

#[test]
fn a_body_at_rest_whose_bonds_vanish_stays_at_rest() {
    for overlap in [0.25, 0.5] {
        for per_step in [usize::MAX, 1] {
            let Plan { mut state, .. } = planned(&cube(overlap, "run.safety_factor = 0.05"));
            let start = state.particles.poses.clone();
            let bonds = state.bonds.len();
            let mut next = 0;
            for _ in 0..2 * bonds + 200 {
                for _ in 0..per_step.min(bonds - next) {
                    vanish(&mut state, next);
                    next += 1;
                }
                step(&mut state);
            }
            let clusters = state.clusters.as_ref().unwrap();
            assert_eq!(clusters.living().count(), 64);
            let contacts = state.contacts.as_ref().unwrap();
            let overlapping = contacts.histories.iter().filter(|m| m.origin_m() > 0.0);
            // 144 nearest neighbours; at 0.5 also the 216 across the squares.
            assert_eq!(overlapping.count(), if overlap < 0.4 { 144 } else { 360 });
            // Bonds at rest have forces from the rounding of their lengths.
            let rounding_m = 1e-12 * RADIUS_M;
            for (now, then) in state.particles.poses.iter().zip(&start) {
                let moved = (now.place() - then.place()).norm();
                assert!(
                    moved < rounding_m,
                    "overlap {overlap}: moved by {moved:e} m"
                );
            }
        }
    }
}

/// Largest spurious energy, over the largest energy, while a vibrating cube falls apart: at once,
/// or bond by bond.
fn worst_gain(overlap: f64, at_once: bool, safety: f64) -> f64 {
    let text = cube(overlap, &format!("run.safety_factor = {safety}"));
    let Plan { mut state, .. } = planned(&text);
    let mut any = scattered();
    for motion in &mut state.particles.motions {
        motion.velocity_m_s = [0, 1, 2].map(|_| 0.3 * any());
        motion.spin_rad_s = [0, 1, 2].map(|_| 50.0 * any());
    }
    state.ledger = opened(&state);
    let strong = state.bonds.rules[0].criteria.unwrap();
    let end_s = 2e-3;
    let mut worst = 0.0_f64;
    while state.time_s < end_s {
        // Gradually weaker, or no bonds at all from a certain time.
        let gone = state.time_s / end_s;
        let tensile_strength_pa = match at_once {
            true if gone < 0.1 => strong.tensile_strength_pa,
            true => 1e-9,
            false => 1e6 * (-20.0 * gone).exp(),
        };
        let weaker = Criteria {
            tensile_strength_pa,
            ..strong
        };
        Arc::make_mut(&mut state.bonds.rules)[0].criteria = Some(weaker);
        interact(&mut state);
        let balance = balance(&mut state);
        worst = worst.max(balance.energy_error);
        assert!(balance.momentum_error < 1e-11, "{balance:?}");
        advance(&mut state);
    }
    let pieces = state.clusters.as_ref().unwrap().living().count();
    assert!(state.broken_count > 100 && pieces > 20, "{pieces} pieces");
    worst
}

#[test]
fn a_vibrating_body_that_falls_apart_gains_no_energy() {
    for overlap in [0.25, 0.5] {
        for at_once in [true, false] {
            let errors = [2e-3, 1e-3].map(|safety| worst_gain(overlap, at_once, safety));
            eprintln!("overlap {overlap}, at once {at_once}: {errors:?}");
            // The error of leapfrog itself in a vibration, (omega dt)^2/8 of its energy, decreases
            // with the square of the step; no other error is left.
            assert!(errors[0] > 3.0 * errors[1], "{errors:?}");
            assert!(errors[1] < 1e-6, "{errors:?}");
        }
    }
}

/// Velocities of the first sphere of a pair, m/s; the second has the opposite ones.
const INTO_EACH_OTHER: [f64; 3] = [0.5, 0.05, 0.0];
const BY_EACH_OTHER: [f64; 3] = [0.02, 0.5, 0.1];
const AWAY: [f64; 3] = [-0.5, 0.0, 0.0];

/// Positions of the second sphere of a pair relative to the first, step by step for 1.5 ms, from a
/// small overlap; bonded with these failure criteria.
fn flight(failure: Option<&str>, velocity_m_s: [f64; 3], time_step_s: f64) -> Vec<Vector3<f64>> {
    let bonded = failure.is_some();
    let list = if bonded { ", bond_list = [[0, 1]]" } else { "" };
    let failure = failure.unwrap_or("tensile_strength = 1");
    let text = format!(
        "version = 1\nrun.end_time = 1\nrun.time_step = {time_step_s}\nrun.initial_overlap = \"relax\"\n\
         materials.cake = {{ density = 2000, young_modulus = \"10 MPa\" }}\n\
         contacts.cake-cake = {{ restitution = 0.5, friction = 0.5 }}\n\
         bonds.cake = {{ young_modulus = \"10 MPa\", poisson_ratio = 0.3, failure = {{ {failure} }} }}\n\
         bodies.pair = {{ material = \"cake\", bonds = \"cake\", particles = [[0, 0, 0, 1e-3], [1.999e-3, 0, 0, 1e-3]]{list} }}\n"
    );
    let Plan { mut state, .. } = planned(&text);
    for (motion, sign) in state.particles.motions.iter_mut().zip([1.0, -1.0]) {
        motion.velocity_m_s = velocity_m_s.map(|v| sign * v);
    }
    let mut places = Vec::new();
    while state.time_s < 1.5e-3 {
        step(&mut state);
        assert!(!bonded || !bond_utilisation(&state, 0).is_nan());
        places.push(state.particles.poses[1].place() - state.particles.poses[0].place());
    }
    assert_eq!(state.broken_count, u64::from(bonded));
    places
}

#[test]
fn a_bond_without_strength_is_none() {
    for failure in [
        "tensile_strength = 1e-3, shear_strength = 1e-3",
        "tensile_strength = 0, shear_strength = \"0 Pa\"",
        "von_mises_strength = 0, equivalent_stress = \"axial-in-tension\", tensile_strength = 0",
        "tensile_strength = 0, shear_strength = 0, rate_strengthening = true, weibull_modulus = 3",
    ] {
        for velocity_m_s in [INTO_EACH_OTHER, BY_EACH_OTHER, AWAY] {
            // It acts until the second check, and its cluster is searched one step later: that much
            // of the approach is lost.
            let off = [4e-7, 2e-7, 1e-7].map(|dt| {
                let bonded = flight(Some(failure), velocity_m_s, dt);
                let free = flight(None, velocity_m_s, dt);
                let apart = bonded.iter().zip(&free).map(|(a, b)| (a - b).norm());
                let flown_m = (free[free.len() - 1] - free[0]).norm();
                assert!(flown_m > 0.3e-3);
                apart.fold(0.0, f64::max) / flown_m
            });
            let what = format!("{failure}, {velocity_m_s:?}");
            eprintln!("{what}: bonded and free pair differ by {off:?} of their way");
            assert!(
                off[0] > 1.8 * off[1] && off[1] > 1.8 * off[2],
                "{what}: {off:?}"
            );
            assert!(off[2] < 2e-3, "{what}: {off:?}");
        }
    }
}

/// It carries no force: no utilisation of zero strength.
#[test]
fn a_bond_without_strength_holds_a_body_at_rest_together() {
    let text = cube(0.25, "").replace(
        "tensile_strength = 1e9",
        "tensile_strength = 0, von_mises_strength = 0, equivalent_stress = \"axial-in-tension\"",
    );
    let Plan { mut state, .. } = planned(&text);
    interact(&mut state);
    for at in 0..state.bonds.len() {
        assert!(!bond_utilisation(&state, at).is_nan());
    }
    let balance = balance(&mut state);
    assert!(balance.energy_error.is_finite(), "{balance:?}");
}

/// The cluster of each particle, as the smallest particle connected by unbroken bonds, by
/// breadth-first search.
fn breadth_first(state: &State) -> Vec<u32> {
    let count = state.particles.len();
    let mut beside = vec![Vec::new(); count];
    for (at, &[a, b]) in state.bonds.ends.iter().enumerate() {
        if !state.bonds.is_broken(at) {
            beside[a as usize].push(b);
            beside[b as usize].push(a);
        }
    }
    let mut found = vec![u32::MAX; count];
    for first in 0..count as u32 {
        if found[first as usize] != u32::MAX {
            continue;
        }
        let mut queue = std::collections::VecDeque::from([first]);
        found[first as usize] = first;
        while let Some(at) = queue.pop_front() {
            for &next in &beside[at as usize] {
                if found[next as usize] == u32::MAX {
                    found[next as usize] = first;
                    queue.push_back(next);
                }
            }
        }
    }
    found
}

#[test]
fn clusters_of_a_body_that_breaks_on_a_floor_are_those_of_a_breadth_first_search() {
    let extra = "run.gravity = [0, 0, -9.81]\n\
         walls.floor = { plane = { point = [0, 0, -4e-3], normal = [0.2, 0.1, 1] }, material = \"cake\" }";
    let text = cube(0.25, extra)
        .replace(
            "tensile_strength = 1e9",
            "tensile_strength = 5e4, weibull_modulus = 2",
        )
        .replace("bodies.cube = {", "bodies.cube = { velocity = [0, 0, -2],");
    let Plan { mut state, .. } = planned(&text);
    let mut looks = 0;
    while state.time_s < 8e-3 {
        step(&mut state);
        if !state.scratch.events.broken.is_empty() {
            looks += 1;
            let wanted = breadth_first(&state);
            let clusters = &state.clusters.as_ref().unwrap().of_particle;
            // One to one.
            let mut pairs: Vec<(u32, u32)> = clusters.iter().copied().zip(wanted).collect();
            pairs.sort_unstable();
            pairs.dedup();
            let mut ids: Vec<u32> = pairs.iter().map(|p| p.0).collect();
            let mut roots: Vec<u32> = pairs.iter().map(|p| p.1).collect();
            ids.dedup();
            roots.sort_unstable();
            roots.dedup();
            assert_eq!([ids.len(), roots.len()], [pairs.len(); 2]);
        }
    }
    let pieces = state.clusters.as_ref().unwrap().living().count();
    eprintln!(
        "{looks} looks, {} broken, {pieces} pieces",
        state.broken_count
    );
    assert!(looks > 10 && pieces > 5);
}
