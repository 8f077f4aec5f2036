//! What the dynamic increase factor has to be for no bond to break: drops of samples whose bonds do
//! not break, in which the utilisation of each bond is followed for several ways to apply it.

use std::path::Path;

use dem_run::measure::load;
use dem_run::physics::bond::failure::{
    Criteria, EquivalentStress, Factors, Stresses, stresses, utilisation,
};
use dem_run::physics::bond::strain_rate::{
    HIGHEST_1_S, PLATZER_LOWEST_RATE_1_S, dynamic_increase_factor, fast_branch,
};
use dem_run::step::{advance, interact};
use dem_run::{State, plan};
use dem_scene::read_bodies;
use serde_json::{Value, json};

use super::bending::READINGS;
use super::drops::{FALLS, Fall, Row, row};
use super::samples::{BARE, COARSE, Sample, scene};
use super::watch::rate_1_s;
use crate::bench::{Bench, Failed};

/// Time between two looks, s.
const EVERY_S: f64 = 25e-6;

/// The first readings of eq. 13, in the order of [`READINGS`].
const EQUIVALENT_STRESSES: [EquivalentStress; 2] = [
    EquivalentStress::ForcesOnly,
    EquivalentStress::AxialInTension,
];

/// Ways to apply the factor: how they are called in the results, and on the page.
pub(crate) const WAYS: [(&str, &str); 4] = [
    ("none", "none"),
    ("now", "that of the moment"),
    ("held", "the largest so far"),
    ("held_without_end", "the largest so far, also above 50/s"),
];

pub(crate) fn rows() -> [Row; 3] {
    [row(COARSE, "0.2"), row(COARSE, "0.6"), row(BARE, "0.2")]
}

pub(crate) fn name(row: &Row, fall: &str, seed: u32) -> String {
    let table = row.sample.table.number();
    format!("strengthening-{table}-{}-{fall}-{seed}", row.damping)
}

/// Settings of the scene.
pub(crate) fn sets(row: &Row, fall: &Fall) -> Vec<String> {
    let mut sets = row.sample.table.unbreakable_sets();
    sets.push(format!(
        "bonds.cake.damping={{damping_ratio={}}}",
        row.damping
    ));
    sets.extend(fall.sets());
    sets
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    for row in rows() {
        for fall in FALLS {
            for seed in 1..=row.packings {
                let name = name(&row, fall.0, seed);
                let sample = Sample { seed, ..row.sample };
                let strength_pa = sample.table.strength_pa();
                sample.keep(bench, &name, |body| {
                    drop(body, &sets(&row, &fall), strength_pa)
                })?;
            }
        }
    }
    Ok(())
}

/// Drops a sample whose bonds do not break, and says how much of this strength they used.
fn drop(body: &Path, sets: &[String], strength_pa: f64) -> Result<Value, Failed> {
    let scene = scene("drop", Some(body), sets)?;
    let mut state = plan(&scene, read_bodies(&scene)?, 1, false)?.state;
    let every_steps = (EVERY_S / state.time_step_s).round().max(1.0) as u64;
    let mut used = Used::new(state.bonds.len());
    while state.time_s < scene.run.end_time_s {
        interact(&mut state);
        if state.steps.is_multiple_of(every_steps) {
            used.look(&state, strength_pa);
        }
        advance(&mut state);
    }
    Ok(used.report())
}

/// Largest utilisation of each bond so far.
struct Used {
    /// For each reading and way, for each bond.
    largest: Vec<[[f32; WAYS.len()]; EQUIVALENT_STRESSES.len()]>,
    /// The largest factors of each bond so far, up to 50/s and without end.
    held: Vec<[f64; 2]>,
}

impl Used {
    fn new(bonds: usize) -> Self {
        Self {
            largest: vec![Default::default(); bonds],
            held: vec![[1.0; 2]; bonds],
        }
    }

    fn look(&mut self, state: &State, strength_pa: f64) {
        let each = self.largest.iter_mut().zip(&mut self.held).enumerate();
        for (at, (largest, held)) in each {
            let factors = factors(rate_1_s(state, at), held);
            let stresses = stresses(&load(state, at), state.bonds.radius_m(at));
            for (reading, largest) in EQUIVALENT_STRESSES.into_iter().zip(largest) {
                let used = used(reading, strength_pa, &stresses);
                for (largest, factor) in largest.iter_mut().zip(factors) {
                    *largest = largest.max((used / factor) as f32);
                }
            }
        }
    }

    fn report(&self) -> Value {
        let of = |reading: usize, way: usize| {
            let mut all: Vec<f32> = self.largest.iter().map(|one| one[reading][way]).collect();
            all.sort_by(f32::total_cmp);
            let above = |level: f32| all.iter().filter(|used| **used > level).count();
            json!({
                "largest": all.last(),
                "above_1": above(1.0),
                "fraction_above_half": above(0.5) as f64 / all.len() as f64,
            })
        };
        let mut report = json!({ "readings": {} });
        for reading in 0..EQUIVALENT_STRESSES.len() {
            for (way, (name, _)) in WAYS.iter().enumerate() {
                report["readings"][READINGS[reading]][*name] = of(reading, way);
            }
        }
        report
    }
}

/// The factors of all ways, in their order; `held` follows.
fn factors(rate_1_s: f64, held: &mut [f64; 2]) -> [f64; WAYS.len()] {
    let now = [
        dynamic_increase_factor(rate_1_s, PLATZER_LOWEST_RATE_1_S),
        without_end(rate_1_s),
    ];
    for (held, now) in held.iter_mut().zip(now) {
        *held = held.max(now);
    }
    [1.0, now[0], held[0], held[1]]
}

/// Eq. 20 as printed, beyond the 50/s up to which it holds.
fn without_end(rate_1_s: f64) -> f64 {
    if rate_1_s > HIGHEST_1_S {
        fast_branch(rate_1_s.log10())
    } else {
        dynamic_increase_factor(rate_1_s, PLATZER_LOWEST_RATE_1_S)
    }
}

/// Utilisation of this strength by the equivalent stress of this reading, without any factor.
fn used(reading: EquivalentStress, strength_pa: f64, stresses: &Stresses) -> f64 {
    let criteria = Criteria {
        tensile_strength_pa: f64::INFINITY,
        compressive_strength_pa: f64::INFINITY,
        shear_strength_pa: f64::INFINITY,
        cohesion_pa: f64::INFINITY,
        friction_tangent: 0.0,
        von_mises_strength_pa: strength_pa,
        equivalent_stress: reading,
    };
    utilisation(&criteria, stresses, Factors::scattered(1.0))
}
