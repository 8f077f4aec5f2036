//! Utilisation of the dynamic strength of all bonds during a drop (Platzer 2022, figs. 55 and 56).

use dem_run::State;
use dem_run::measure::load;
use dem_run::physics::bond::failure::{Factors, stresses, utilisation};
use nalgebra::Vector3;
use serde_json::{Value, json};

/// Interval between two looks, in steps.
const EVERY_STEPS: u64 = 25;
/// Side of a cell of the map, m.
const CELL_M: f64 = 2.5e-3;

/// What has been seen so far.
pub(crate) struct Watch {
    /// Middles of the bonds before the drop, in the frame of the scene, m.
    middles_m: Vec<Vector3<f64>>,
    /// Largest utilisation of each bond so far.
    largest: Vec<f64>,
    /// Utilisation and dynamic increase factor of each bond at the moment at which the mean
    /// utilisation was largest; that mean, and the time.
    moment: Vec<[f64; 2]>,
    mean: f64,
    time_s: f64,
}

impl Watch {
    pub(crate) fn new(state: &State) -> Self {
        let middle = |ends: &[u32; 2]| {
            let [a, b] = ends.map(|end| state.particles.poses[end as usize].place());
            0.5 * (a + b)
        };
        Self {
            middles_m: state.bonds.ends.iter().map(middle).collect(),
            largest: vec![0.0; state.bonds.len()],
            moment: vec![[0.0, 1.0]; state.bonds.len()],
            mean: 0.0,
            time_s: 0.0,
        }
    }

    /// Looks at a state whose positions and velocities are those of one moment.
    pub(crate) fn look(&mut self, state: &State) {
        if !state.steps.is_multiple_of(EVERY_STEPS) {
            return;
        }
        let now: Vec<[f64; 2]> = (0..state.bonds.len())
            .map(|at| of_bond(state, at))
            .collect();
        for (largest, [used, _]) in self.largest.iter_mut().zip(&now) {
            *largest = largest.max(*used);
        }
        let mean = now.iter().map(|[used, _]| used).sum::<f64>() / now.len() as f64;
        if mean > self.mean {
            (self.mean, self.time_s, self.moment) = (mean, state.time_s, now);
        }
    }

    /// Largest utilisation of the bonds over the drop, and a map of the moment of the largest mean.
    pub(crate) fn report(&self) -> Value {
        let mut largest = self.largest.clone();
        largest.sort_by(f64::total_cmp);
        let quantile = |share: f64| largest[(share * (largest.len() - 1) as f64) as usize];
        let above_half = largest.iter().filter(|used| **used > 0.5).count();
        json!({
            "exceeded_by_1_in_1000": quantile(0.999),
            "exceeded_by_1_in_100": quantile(0.99),
            "median": quantile(0.5),
            "fraction_above_half": above_half as f64 / largest.len() as f64,
            "time_of_largest_mean_s": self.time_s,
            "cell_m": CELL_M,
            "cells": self.cells(),
        })
    }

    /// Cells of the side view: x, z, largest utilisation, largest factor.
    fn cells(&self) -> Vec<[f64; 4]> {
        let mut cells = std::collections::BTreeMap::new();
        for (middle, [used, factor]) in self.middles_m.iter().zip(&self.moment) {
            let place = [middle.x, middle.z].map(|x| (x / CELL_M).floor() as i32);
            let cell = cells.entry(place).or_insert([0.0_f64, 1.0]);
            *cell = [cell[0].max(*used), cell[1].max(*factor)];
        }
        let cell = |([x, z], [used, factor]): ([i32; 2], [f64; 2])| {
            let middle = |number: i32| CELL_M * (f64::from(number) + 0.5);
            let rounded = |number: f64| (1e3 * number).round() / 1e3;
            [middle(x), middle(z), rounded(used), rounded(factor)]
        };
        cells.into_iter().map(cell).collect()
    }
}

/// Relative velocity of the ends over the initial length (Platzer 2022, eq. 21), 1/s.
pub(crate) fn rate_1_s(state: &State, at: usize) -> f64 {
    let [a, b] = state.bonds.ends[at]
        .map(|end| Vector3::from(state.particles.motions[end as usize].velocity_m_s));
    (b - a).norm() / state.bonds.initial_length_m(at)
}

/// Utilisation of a bond, all of which follow one rule, against its strength at its strain rate
/// and the factor by which that rate raises the strength.
fn of_bond(state: &State, at: usize) -> [f64; 2] {
    let bonds = &state.bonds;
    let rule = &bonds.rules[0];
    let (Some(criteria), false) = (&rule.criteria, bonds.is_broken(at)) else {
        return [0.0, 1.0];
    };
    let factor = bonds.dynamic_increase_factor(at, rate_1_s(state, at));
    let factors = Factors {
        scatter: 1.0,
        rate: factor,
    };
    let stresses = stresses(&load(state, at), bonds.radius_m(at));
    [utilisation(criteria, &stresses, factors), factor]
}
