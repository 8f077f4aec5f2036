//! What is noted while a test runs: force and way, and every bond that breaks.

use serde::{Deserialize, Serialize};

use super::setup::Setup;
use crate::physics::bond::failure::Cause;
use crate::state::State;

/// Intervals of a test's whole stroke over which forces are averaged.
const INTERVALS: f64 = 1000.0;
/// Fewest steps in an interval.
const FEWEST_STEPS: u64 = 4;
/// A body is broken when the force has fallen below this share of its largest.
const BROKEN: f64 = 0.5;

/// Means over an interval of time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Middle of the interval, s.
    pub time_s: f64,
    /// How far the load has moved, m.
    pub travel_m: f64,
    /// Force of all that loads, along the direction of the test, N.
    pub force_n: f64,
    /// Deflection or elongation of the body between the places where it is measured, m.
    pub deflection_m: f64,
}

/// A bond that broke.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BrokenBond {
    /// When, s.
    pub time_s: f64,
    /// Which of the state.
    pub bond: u32,
    /// By what.
    pub cause: Cause,
}

/// A test so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Forces and ways.
    pub rows: Vec<Row>,
    /// Broken bonds in the order of time.
    pub broken: Vec<BrokenBond>,
    /// Sums over the interval that has not ended, and the steps in it.
    open: (Row, u64),
    /// Largest force of a row, N.
    largest_n: f64,
}

/// What loads: walls or gripped sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Loading {
    /// Walls of the state.
    pub walls: Vec<usize>,
    /// Supports of the state.
    pub supports: Vec<usize>,
    /// Steps in an interval.
    pub every: u64,
    /// Where walls and gripped particles stood at the start, along the direction, on average, m.
    start_m: f64,
    /// Where the measured particles stood along the direction, moving less resting, m.
    apart_m: f64,
}

impl Loading {
    /// Of a test that takes `end_s`, in a state before the first step.
    pub fn of(
        walls: Vec<usize>,
        supports: Vec<usize>,
        setup: &Setup,
        state: &State,
        end_s: f64,
    ) -> Self {
        let every = end_s / INTERVALS / state.time_step_s;
        let mut loading = Self {
            walls,
            supports,
            every: (every as u64).max(FEWEST_STEPS),
            start_m: 0.0,
            apart_m: 0.0,
        };
        loading.start_m = loading.place_m(setup, state);
        loading.apart_m = apart_m(setup, state);
        loading
    }

    /// Where what loads stands along the direction, on average, m.
    fn place_m(&self, setup: &Setup, state: &State) -> f64 {
        let walls = self
            .walls
            .iter()
            .map(|&at| state.walls[at].frame.position_m);
        let held = self
            .supports
            .iter()
            .flat_map(|&at| &state.supports[at].held);
        let gripped = held.map(|held| {
            let [x, y, z, _] = state.particles.poses[held.particle as usize].position_m;
            [x, y, z]
        });
        let (sum, count) = walls
            .chain(gripped)
            .fold((0.0, 0.0), |(sum, count), place| {
                (sum + dot(place, setup.direction), count + 1.0)
            });
        sum / f64::max(count, 1.0)
    }

    /// Force of what loads on the body along the direction, N.
    fn force_n(&self, setup: &Setup, state: &State) -> f64 {
        let of_walls = self
            .walls
            .iter()
            .map(|&at| dot(state.walls[at].push.force_n, setup.direction));
        let held = self
            .supports
            .iter()
            .flat_map(|&at| &state.supports[at].held);
        let of_supports = held.map(|held| {
            let [x, y, z, ..] = held.reactions[0];
            dot([x, y, z], setup.direction)
        });
        of_walls.chain(of_supports).sum()
    }
}

fn apart_m(setup: &Setup, state: &State) -> f64 {
    let mean = |of: &[u32]| {
        let along = of.iter().map(|&i| {
            let [x, y, z, _] = state.particles.poses[i as usize].position_m;
            dot([x, y, z], setup.direction)
        });
        along.sum::<f64>() / of.len().max(1) as f64
    };
    mean(&setup.moving) - mean(&setup.resting)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Record {
    /// Notes a step between a kick and the drift after it. Whether the body is broken: bonds have, and the force has fallen below half of its largest.
    pub fn note(&mut self, setup: &Setup, loading: &Loading, state: &State) -> bool {
        for broken in &state.broken {
            self.broken.push(BrokenBond {
                time_s: state.time_s,
                bond: broken.bond,
                cause: broken.cause,
            });
        }
        let (sum, steps) = &mut self.open;
        sum.time_s += state.time_s;
        sum.travel_m += loading.place_m(setup, state) - loading.start_m;
        sum.force_n += loading.force_n(setup, state);
        sum.deflection_m += apart_m(setup, state) - loading.apart_m;
        *steps += 1;
        if *steps < loading.every {
            return false;
        }
        let share = 1.0 / *steps as f64;
        let row = Row {
            time_s: share * sum.time_s,
            travel_m: share * sum.travel_m,
            force_n: share * sum.force_n,
            deflection_m: share * sum.deflection_m,
        };
        self.open = Default::default();
        self.rows.push(row);
        self.largest_n = self.largest_n.max(row.force_n);
        !self.broken.is_empty() && row.force_n < BROKEN * self.largest_n
    }
}
