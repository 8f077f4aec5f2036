//! Values that are not final: measures of the end that still move, servos short of their force.

use dem_io::units::significant;
use dem_scene::{Statistic, WallMotion};
use serde::{Deserialize, Serialize};

use super::changes::last_change_s;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::events::REMOVED;
use dem_engine::state::loads::factor_at;
use dem_engine::state::walls::Wall;
use dem_plan::measure::{Probe, Settles};

/// The last part of a run, in which a final value does not change any more.
const LATE: f64 = 0.1;
/// Range of a measure in that part, over that in the run, above which it still moves.
const MOVES: f64 = 0.01;
/// The same of fillings and heaps: an even feed changes them by a tenth.
const FILLS: f64 = 0.05;
/// Ratio of the range of a measure to that of others of its unit below which it is rounding; and
/// lengths over the smallest radius, angles in rad.
const ROUNDING: [f64; 2] = [1e-6, 1e-9];
/// Change of an angle of repose that one sphere makes, degrees.
const OF_ONE_SPHERE_DEG: f64 = 0.5;
/// Mean force of a servo over the demanded one below which it is short of it.
const SHORT: f64 = 0.9;

/// Values of a quantity at the rows of the time series in the last tenth of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Range {
    lowest: f64,
    highest: f64,
    sum: f64,
    count: f64,
}

/// The last tenth of a run: measures, and forces of servos, N, along their direction.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LastTenth {
    /// Time of the first row, s.
    from_s: f64,
    measures: Vec<Range>,
    servos: Vec<Range>,
}

impl Range {
    fn note(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        if self.count == 0.0 {
            (self.lowest, self.highest) = (value, value);
        }
        self.lowest = self.lowest.min(value);
        self.highest = self.highest.max(value);
        self.sum += value;
        self.count += 1.0;
    }
}

impl LastTenth {
    /// Records a row of the time series of a run that ends at `end_s`: the values of all measures.
    pub(super) fn note(&mut self, state: &State, end_s: f64, values: &[f64]) {
        let late_s = (1.0 - LATE) * end_s;
        if state.time_s < late_s {
            return;
        }
        // A run that was continued to a later end begins anew.
        if self.from_s < late_s || self.measures.len() != values.len() {
            *self = Self {
                from_s: state.time_s,
                measures: vec![Range::default(); values.len()],
                servos: vec![Range::default(); state.walls.len()],
            };
        }
        for (range, value) in self.measures.iter_mut().zip(values) {
            range.note(*value);
        }
        for (range, wall) in self.servos.iter_mut().zip(&state.walls) {
            if let Some(force_n) = servo_force_n(wall) {
                range.note(force_n);
            }
        }
    }

    /// Reasons to doubt measures at the end, a sentence each: those of held bodies and of contacts
    /// that still move although nothing is moved or loaded any more.
    pub(super) fn moving(
        &self,
        state: &State,
        bodies: &[PlacedBody],
        probes: &[Probe],
    ) -> Vec<String> {
        if last_change_s(state) > (1.0 - LATE) * state.time_s {
            return Vec::new();
        }
        let is_held = holds(state, bodies);
        let ranges = probes.iter().zip(&self.measures);
        let moving = ranges.filter(|(probe, range)| {
            probe.measure.statistic == Statistic::End
                && probe.measure.tolerance.is_none()
                && probe.measure.absolute_tolerance.is_none()
                && settles(probe, state, &is_held)
                && range.highest - range.lowest > least_change(probe, probes, state)
        });
        moving
            .filter_map(|(probe, range)| still_moves(probe, range))
            .collect()
    }

    /// Servos whose mean force falls short of the one that they are to exert, a sentence each.
    /// `touched`: whether anything has touched the wall of this number.
    pub(super) fn short_servos(
        &self,
        state: &State,
        touched: impl Fn(usize) -> bool,
    ) -> Vec<String> {
        let walls = state.walls.iter().zip(&self.servos).enumerate();
        let short = walls.filter_map(|(number, (wall, range))| {
            let WallMotion::Servo {
                force_n, factor, ..
            } = &wall.model.motion
            else {
                return None;
            };
            let wanted_n = force_n * factor_at(factor, state.time_s);
            let mean_n = range.sum / range.count.max(1.0);
            if wanted_n == 0.0 || mean_n / wanted_n >= SHORT {
                return None;
            }
            let why = if touched(number) {
                "set run.end_time later, or check its max_velocity and what gives way to it"
            } else {
                "nothing has touched it: set run.end_time later, place it nearer, or raise its max_velocity"
            };
            Some(format!(
                "the servo of the wall '{}' pushed with {} N over the last tenth of the run, {} % of its {} N; {why}",
                wall.model.name,
                significant(mean_n, 4),
                significant(100.0 * mean_n / wanted_n, 3),
                significant(wanted_n, 4),
            ))
        });
        short.collect()
    }
}

/// Force of a servo on the particles along its direction, N. None: the wall is no servo.
fn servo_force_n(wall: &Wall) -> Option<f64> {
    let WallMotion::Servo { direction, .. } = &wall.model.motion else {
        return None;
    };
    let [force_n, _] = wall.total_load();
    Some((0..3).map(|k| force_n[k] * direction[k]).sum())
}

/// For each particle whether supports hold its body.
fn holds(state: &State, bodies: &[PlacedBody]) -> Vec<bool> {
    let mut is_held = vec![false; state.particles.len()];
    for held in state.supports.iter().flat_map(|support| &support.held) {
        is_held[held.particle as usize] = true;
    }
    for body in bodies {
        let living = || body.particles.iter().filter(|i| **i != REMOVED);
        if living().any(|i| is_held[*i as usize]) {
            living().for_each(|i| is_held[*i as usize] = true);
        }
    }
    is_held
}

/// Whether a measure is expected to settle: forces, and what moves of a held body or a servo.
fn settles(probe: &Probe, state: &State, is_held: &[bool]) -> bool {
    let of_servo = probe.walls()[0].is_some_and(|wall| {
        let motion = state.walls.get(wall).map(|wall| &wall.model.motion);
        matches!(motion, Some(WallMotion::Servo { .. }))
    });
    let of_held = || {
        let mut own = probe.particles().iter();
        own.any(|i| is_held.get(*i as usize).copied().unwrap_or(false))
    };
    match probe.measurement().settles {
        Settles::Never => false,
        Settles::IfHeld => of_servo || of_held(),
        Settles::Always | Settles::Roughly => true,
    }
}

/// Range of a measure in the last tenth of a run, over that in the run, which is allowed.
fn allowed(probe: &Probe) -> f64 {
    match probe.measurement().settles {
        Settles::Roughly => FILLS,
        _ => MOVES,
    }
}

/// Range in the run, in its unit. 0 without values.
fn range_of_run(probe: &Probe) -> f64 {
    let both = probe.history.largest.zip(probe.history.smallest);
    both.map_or(0.0, |(largest, smallest)| largest - smallest)
}

/// Largest change of a measure, in its unit, that does not count: a fraction of its range in the
/// run, and rounding.
fn least_change(probe: &Probe, probes: &[Probe], state: &State) -> f64 {
    let alike = probes.iter().filter(|other| other.unit() == probe.unit());
    let of_unit = alike.map(range_of_run).fold(0.0, f64::max);
    let small_m = ROUNDING[1] * state.smallest_radius_m();
    let floor = match probe.unit() {
        "m" => small_m,
        "rad" => ROUNDING[1],
        "deg" => OF_ONE_SPHERE_DEG,
        "m/s" => small_m / state.time_step_s,
        "rad/s" => ROUNDING[1] / state.time_step_s,
        "J" => state.ledger.rounding_floor_j,
        "N" | "N m" => {
            // That at a strain of 1e-9, from the energy at one of 1e-6.
            let per_particle_j =
                state.ledger.rounding_floor_j / state.particles.len().max(1) as f64;
            let stiff_j = 2e12 * per_particle_j;
            let lever_m = if probe.unit() == "N" {
                state.smallest_radius_m()
            } else {
                1.0
            };
            ROUNDING[1] * stiff_j / lever_m
        }
        _ => 0.0,
    };
    floor
        .max(ROUNDING[0] * of_unit)
        .max(allowed(probe) * range_of_run(probe))
}

fn still_moves(probe: &Probe, range: &Range) -> Option<String> {
    let (_, last) = probe.history.last?;
    let [value, low, high] = [last, range.lowest, range.highest].map(|x| significant(x, 4));
    let unit = probe.unit();
    let share = 100.0 * (range.highest - range.lowest) / range_of_run(probe);
    Some(format!(
        "measures.{} is read at the end, {value} {unit}, while it still moves: over the last tenth of the run it was between {low} and {high} {unit}, {} % of its range in the run, where {} % is allowed; set run.end_time later, add damping, or ask for statistic = \"mean\", \"largest\" or \"smallest\"",
        probe.name,
        significant(share, 2),
        100.0 * allowed(probe),
    )
    .replace("  ", " "))
}
