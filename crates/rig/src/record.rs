//! Record of a test: force, displacement, and every broken bond.

use dem_scene::{Bars, Scene, Test};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::arrange::support_of;
use super::disc_stress::DiscStress;
use crate::setup::{Setup, Side};
use dem_engine::stages::motion::supports::velocity_at_kick;
use dem_engine::state::State;
use dem_engine::state::loads::factor_at;
use dem_physics::bond::failure::Cause;

/// Number of intervals of a test's full stroke over which forces are averaged.
const INTERVALS: f64 = 1000.0;
/// Smallest number of steps in an interval.
const FEWEST_STEPS: u64 = 4;
/// A body is broken when the force has fallen below this fraction of its maximum.
const BROKEN: f64 = 0.5;

/// Means over an interval of time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Middle of the interval, s.
    pub time_s: f64,
    /// Travel of the load, m.
    pub travel_m: f64,
    /// Force of the moving walls and supports along the direction of the test, N.
    pub force_n: f64,
    /// Force of all other walls and supports against the direction of the test, minus the
    /// contribution of gravity, N.
    pub reaction_n: f64,
    /// Deflection or elongation of the body between the measured points, m.
    pub deflection_m: f64,
    /// Of a dynamic test: velocities along the direction of the moving walls and supports, and of
    /// the others, and that of the incident pulse, m/s. Otherwise 0.
    pub speeds_m_s: [f64; 3],
    /// Force of each wall on the sides of a triaxial test, N; 0 where there is none.
    pub sides_n: [f64; 4],
    /// Strain across the middle of such a body, the mean of its sides, positive where it widens.
    /// Not a number where there are no particles to measure it.
    pub widening: f64,
}

/// Energies of a dynamic test so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Works {
    /// Work of the moving walls and supports on the body, J.
    pub moving_j: f64,
    /// Work of the body on the others, J.
    pub resting_j: f64,
    /// Energy of the incident pulse, J.
    pub incident_j: f64,
    /// Energy of the reflected pulse, J.
    pub reflected_j: f64,
    /// Energy of the transmitted pulse, J.
    pub transmitted_j: f64,
}

impl Row {
    /// Load of the body, N: the mean of the applied force and the reaction. The two differ by the
    /// body's inertia, which the mean cancels as far as its centre of mass is halfway between them.
    pub fn load_n(&self) -> f64 {
        f64::midpoint(self.force_n, self.reaction_n)
    }
}

/// A bond that broke.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BrokenBond {
    /// Time, s.
    pub time_s: f64,
    /// Number in the state.
    pub bond: u32,
    /// Cause of failure.
    pub cause: Cause,
}

/// Record of a test so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Forces and displacements.
    pub rows: Vec<Row>,
    /// Broken bonds in the order of time.
    pub broken: Vec<BrokenBond>,
    /// Sums over the interval that has not ended, and its number of steps.
    open: (Row, u64),
    /// Largest load of a row, N.
    pub largest_n: f64,
    /// Whether bonds had broken when the load of a row was below half of that, before the end of
    /// the pulse of a test with bars.
    pub fell: bool,
    /// Energies of a dynamic test.
    pub works: Works,
    /// Stress along the loaded diameter of a disc at the largest load before a bond broke.
    pub disc: DiscStress,
}

/// Numbers of walls and supports in a state.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Holders {
    /// Which walls.
    pub walls: Vec<usize>,
    /// Which supports.
    pub supports: Vec<usize>,
}

/// Loading of a test: walls or gripped sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Loading {
    /// The moving side.
    pub moving: Holders,
    /// The resting side. Nothing: the reaction is assumed to equal the force.
    pub resting: Holders,
    /// Contribution of gravity to the reaction, N.
    weight_n: f64,
    /// Steps in an interval.
    pub every: u64,
    /// Mean initial coordinate of walls and gripped particles along the direction, m.
    start_m: f64,
    /// Initial distance of the measured particles along the direction, moving minus resting, m.
    apart_m: f64,
    /// What a dynamic test moves. None: the test is quasi-static.
    dynamic: Option<Dynamic>,
    /// The walls that keep a pressure on the sides of the body, and where they started, m.
    sides: Vec<(Side, f64)>,
    /// Force of the confining pressure on the section of the body, N, which is no part of the load.
    confining_n: f64,
    /// The test goes on after the body has broken.
    has_residual: bool,
}

/// What a dynamic test moves.
#[derive(Debug, Clone, PartialEq)]
enum Dynamic {
    Bars(Bars),
    /// With the stroke after which it is stopped, m.
    Weight(f64),
}

impl Loading {
    /// For a test of a scene, in a state before the first step.
    pub(crate) fn of_test(scene: &Scene, test: &Test, setup: &Setup, state: &State) -> Self {
        let walls = scene.walls.keys().map(|name| test.crosshead.contains(name));
        let grips: Vec<String> = test.crosshead.iter().map(|name| support_of(name)).collect();
        let supports = scene.supports.keys().map(|name| grips.contains(name));
        let ([walls, other_walls], [supports, other_supports]) = (split(walls), split(supports));
        let moving = Holders { walls, supports };
        let resting = match &test.bars {
            Some(bars) => Holders {
                walls: places(scene.walls.keys(), &bars.transmission),
                supports: places(scene.supports.keys(), &support_of(&bars.transmission)),
            },
            None => Holders {
                walls: other_walls,
                supports: other_supports,
            },
        };
        let bars = test.bars.clone().map(Dynamic::Bars);
        let weight = || test.weight.as_ref().map(|_| Dynamic::Weight(test.stroke_m));
        // The end of a drop-weight test is far off: its stroke gives the time of the impact.
        let impact_s = (test.weight.as_ref()).map(|weight| test.stroke_m / weight.velocity_m_s);
        let end_s = impact_s.unwrap_or(f64::INFINITY).min(scene.run.end_time_s);
        let sides = setup.sides.iter().map(|side| {
            let start_m = side.place_m(state);
            (side.clone(), start_m)
        });
        let section_n = |pressure_pa: f64| pressure_pa / setup.specimen.stress_pa(1.0);
        Self {
            dynamic: bars.or_else(weight),
            sides: sides.collect(),
            confining_n: (test.confinement.as_ref())
                .map_or(0.0, |confinement| section_n(confinement.pressure_pa)),
            has_residual: test.kind.has_residual(),
            ..Self::of(moving, resting, setup, state, end_s)
        }
    }

    /// For a test that takes `end_s`, in a state before the first step.
    pub fn of(moving: Holders, resting: Holders, setup: &Setup, state: &State, end_s: f64) -> Self {
        let every = end_s / INTERVALS / state.time_step_s;
        let mut loading = Self {
            moving,
            resting,
            weight_n: state.ledger.mass_kg() * along(state.model.gravity_m_s2, setup),
            every: (every as u64).max(FEWEST_STEPS),
            start_m: 0.0,
            apart_m: 0.0,
            dynamic: None,
            sides: Vec::new(),
            confining_n: 0.0,
            has_residual: false,
        };
        loading.start_m = loading.place_m(setup, state);
        loading.apart_m = apart_m(setup, state);
        loading
    }

    /// Force of the moving side and reaction of the resting one, N.
    fn forces_n(&self, setup: &Setup, state: &State) -> [f64; 2] {
        let force_n = self.moving.force_n(setup, state) - self.confining_n;
        if self.resting == Holders::default() {
            return [force_n; 2];
        }
        let resting_n = -self.resting.force_n(setup, state);
        [force_n, resting_n - self.weight_n - self.confining_n]
    }

    /// Deflection or elongation of the body between the measured points, m.
    pub(crate) fn deflection_m(&self, setup: &Setup, state: &State) -> f64 {
        apart_m(setup, state) - self.apart_m
    }

    /// Velocities of the moving and the resting side along the direction at the kick, and of the
    /// incident pulse, m/s; 0 if the test is quasi-static.
    fn speeds_m_s(&self, setup: &Setup, state: &State) -> [f64; 3] {
        let speeds = |of: &Holders| of.speed_m_s(setup, state);
        match &self.dynamic {
            None => [0.0; 3],
            Some(Dynamic::Weight(_)) => [speeds(&self.moving), speeds(&self.resting), 0.0],
            Some(Dynamic::Bars(bars)) => {
                let wave_m_s = bars.incident_m_s() * factor_at(&bars.pulse(), state.time_s);
                [speeds(&self.moving), speeds(&self.resting), wave_m_s]
            }
        }
    }

    /// Mean coordinate of the moving side along the direction, m.
    fn place_m(&self, setup: &Setup, state: &State) -> f64 {
        let walls = self.moving.walls.iter();
        let walls = walls.map(|&at| state.walls[at].frame.position_m.into());
        let supports = self.moving.supports.iter();
        let held = supports.flat_map(|&at| &state.supports[at].held);
        let gripped = held.map(|held| state.particles.poses[held.particle as usize].place());
        let (sum, count) = walls
            .chain(gripped)
            .fold((0.0, 0.0), |(sum, count), place| {
                (sum + along(place, setup), count + 1.0)
            });
        sum / f64::max(count, 1.0)
    }
}

impl Holders {
    /// Their force on the body along the direction of a test, N.
    fn force_n(&self, setup: &Setup, state: &State) -> f64 {
        let walls = self.walls.iter();
        let of_walls = walls.map(|&at| along(state.walls[at].push.force_n, setup));
        let supports = self.supports.iter();
        let held = supports.flat_map(|&at| &state.supports[at].held);
        let of_supports = held.map(|held| {
            let [x, y, z, ..] = held.reactions[0];
            along([x, y, z], setup)
        });
        of_walls.chain(of_supports).sum()
    }
}

impl Holders {
    /// Their mean velocity along the direction of a test at the kick just made, m/s.
    fn speed_m_s(&self, setup: &Setup, state: &State) -> f64 {
        let steps_s = state.steps_s();
        let between = |before: Vector3<f64>, after: Vector3<f64>| {
            velocity_at_kick(along(before, setup), along(after, setup), steps_s)
        };
        let walls = self.walls.iter().map(|&at| {
            let [before, after] = state.walls[at].velocities_m_s;
            between(before.into(), after.into())
        });
        let supports = self.supports.iter();
        let held = supports.flat_map(|&at| &state.supports[at].held);
        let held = held.map(|held| {
            let [x, y, z, ..] = held.before;
            let after = state.particles.motions[held.particle as usize].velocity_m_s;
            between(Vector3::new(x, y, z), after.into())
        });
        let (sum, count) = walls
            .chain(held)
            .fold((0.0, 0.0), |(sum, count), speed| (sum + speed, count + 1.0));
        sum / f64::max(count, 1.0)
    }
}

fn apart_m(setup: &Setup, state: &State) -> f64 {
    let mean = |of: &[u32]| {
        let places = of
            .iter()
            .map(|&i| state.particles.poses[i as usize].place());
        places.map(|place| along(place, setup)).sum::<f64>() / of.len().max(1) as f64
    };
    mean(&setup.moving) - mean(&setup.resting)
}

/// Component of a vector along the direction of a test.
fn along(vector: impl Into<Vector3<f64>>, setup: &Setup) -> f64 {
    vector.into().dot(&Vector3::from(setup.direction))
}

impl Record {
    /// Records a step between a kick and the drift after it. Returns whether the test is over: of a
    /// quasi-static one, the body is broken, as bonds have broken and the force has fallen below
    /// half of its maximum; a weight has travelled its stroke, or has come back.
    pub fn note(&mut self, setup: &Setup, loading: &Loading, state: &State) -> bool {
        for broken in &state.scratch.events.broken {
            self.broken.push(BrokenBond {
                time_s: state.time_s,
                bond: broken.bond,
                cause: broken.cause,
            });
        }
        let mut widening = 0.0;
        let (sum, steps) = &mut self.open;
        sum.time_s += state.time_s;
        sum.travel_m += loading.place_m(setup, state) - loading.start_m;
        let [force_n, reaction_n] = loading.forces_n(setup, state);
        sum.force_n += force_n;
        sum.reaction_n += reaction_n;
        sum.deflection_m += loading.deflection_m(setup, state);
        for (sum, (side, start_m)) in sum.sides_n.iter_mut().zip(&loading.sides) {
            *sum += side.force_n(state);
            // Two opposite walls move apart for each strain.
            let pairs = 0.5 * loading.sides.len() as f64;
            widening += (start_m - side.place_m(state)) / (side.gauge_m * pairs);
        }
        sum.widening += widening;
        if let Some(dynamic) = &loading.dynamic {
            let speeds_m_s = loading.speeds_m_s(setup, state);
            let resting_n = -loading.resting.force_n(setup, state);
            for (sum, speed_m_s) in sum.speeds_m_s.iter_mut().zip(speeds_m_s) {
                *sum += speed_m_s;
            }
            let [before_s, after_s] = state.steps_s();
            let during_s = 0.5 * (before_s + after_s);
            (self.works).add(dynamic, [force_n, resting_n], speeds_m_s, during_s);
        }
        *steps += 1;
        if *steps < loading.every {
            return false;
        }
        let fraction = 1.0 / *steps as f64;
        let row = Row {
            time_s: fraction * sum.time_s,
            travel_m: fraction * sum.travel_m,
            force_n: fraction * sum.force_n,
            reaction_n: fraction * sum.reaction_n,
            deflection_m: fraction * sum.deflection_m,
            speeds_m_s: sum.speeds_m_s.map(|sum| fraction * sum),
            sides_n: sum.sides_n.map(|sum| fraction * sum),
            widening: fraction * sum.widening,
        };
        self.open = Default::default();
        self.rows.push(row);
        self.largest_n = self.largest_n.max(row.load_n());
        if self.broken.is_empty() && loading.dynamic.is_none() && !setup.strip.is_empty() {
            let [force_n, reaction_n] = loading.forces_n(setup, state);
            (self.disc).follow(f64::midpoint(force_n, reaction_n), setup, state);
        }
        let falls = !self.broken.is_empty() && row.load_n() < BROKEN * self.largest_n;
        match &loading.dynamic {
            None => {
                self.fell |= falls;
                self.fell && !loading.has_residual
            }
            Some(Dynamic::Bars(bars)) => {
                self.fell |= falls && row.time_s < bars.pulse_s();
                false
            }
            Some(Dynamic::Weight(stroke_m)) => {
                self.fell |= falls;
                row.travel_m >= *stroke_m || row.travel_m < 0.0
            }
        }
    }

    /// Means of the rows over `over_s`, around each: rows are shorter after the time step has been
    /// reduced.
    pub fn smoothed(&self, over_s: f64) -> Vec<Row> {
        let rows = &self.rows;
        let around = |row: &Row| {
            let from = rows.partition_point(|other| other.time_s < row.time_s - 0.5 * over_s);
            let to = rows.partition_point(|other| other.time_s <= row.time_s + 0.5 * over_s);
            mean(&rows[from..to])
        };
        rows.iter().map(around).collect()
    }
}

fn mean(rows: &[Row]) -> Row {
    let fraction = 1.0 / rows.len() as f64;
    let of = |value: fn(&Row) -> f64| fraction * rows.iter().map(value).sum::<f64>();
    Row {
        time_s: of(|row| row.time_s),
        travel_m: of(|row| row.travel_m),
        force_n: of(|row| row.force_n),
        reaction_n: of(|row| row.reaction_n),
        deflection_m: of(|row| row.deflection_m),
        speeds_m_s: [0, 1, 2].map(|k| {
            let speeds = rows.iter().map(|row| row.speeds_m_s[k]);
            fraction * speeds.sum::<f64>()
        }),
        sides_n: [0, 1, 2, 3].map(|k| {
            let forces = rows.iter().map(|row| row.sides_n[k]);
            fraction * forces.sum::<f64>()
        }),
        widening: of(|row| row.widening),
    }
}

impl Works {
    /// Adds the works during a time, s, of the forces on the body along the direction and of the
    /// body against it, N, with the velocities of both sides and of the incident pulse, m/s.
    ///
    /// The reflected wave is F/Z less the incident one, and the transmitted one F/Z.
    fn add(
        &mut self,
        dynamic: &Dynamic,
        [force_n, reaction_n]: [f64; 2],
        [moving_m_s, resting_m_s, wave_m_s]: [f64; 3],
        during_s: f64,
    ) {
        self.moving_j += during_s * force_n * moving_m_s;
        self.resting_j += during_s * reaction_n * resting_m_s;
        if let Dynamic::Bars(bars) = dynamic {
            let z = bars.impedance_n_s_m();
            self.incident_j += during_s * z * wave_m_s.powi(2);
            self.reflected_j += during_s * z * (force_n / z - wave_m_s).powi(2);
            self.transmitted_j += during_s * reaction_n.powi(2) / z;
        }
    }
}

/// Position of a name among others.
fn places<'a>(mut names: impl Iterator<Item = &'a String>, wanted: &str) -> Vec<usize> {
    names.position(|name| name == wanted).into_iter().collect()
}

/// The indices of those that load, and those of the others.
fn split(load: impl Iterator<Item = bool>) -> [Vec<usize>; 2] {
    let mut found = [Vec::new(), Vec::new()];
    for (at, loads) in load.enumerate() {
        found[usize::from(!loads)].push(at);
    }
    found
}
