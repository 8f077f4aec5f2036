//! Walls that come back: how often, how far they go, and the walls in their way.

use std::f64::consts::TAU;

use dem_io::units::{show_length, show_quantity, significant};
use dem_io::{Diagnostic, Result};
use dem_scene::{Factor, Scene, WallMotion};
use nalgebra::Vector3;

use dem_engine::state::loads::factor_at;
use dem_engine::state::walls::Wall;
use dem_physics::geometry::{Bounds, Frame};
use dem_physics::rigid::turn;
use dem_physics::rotation::{numbers, rotation};

/// Fewest steps in a period. A sine that is followed by so many straight pieces is off by 1.2 % of
/// its amplitude.
const STEPS_IN_PERIOD: f64 = 20.0;

/// Acceleration of a wall, as a multiple of gravity, above which its frequency is asked for.
const MOST_GRAVITY: f64 = 200.0;
const GRAVITY_M_S2: f64 = 9.81;

/// Moments of a period at which a wall is looked at. Those at both ends of a swing are among them.
const MOMENTS: usize = 32;

/// Overlap of two walls that counts as a touch, as a part of the size of the smaller one.
const TOUCH: f64 = 1e-4;

/// Rate at which a wall comes back, Hz. None: it does not.
fn frequency_hz(motion: &WallMotion) -> Option<f64> {
    match motion {
        WallMotion::Displacement {
            factor: Factor::Oscillation { frequency_hz, .. },
            ..
        } => Some(*frequency_hz),
        WallMotion::Orbit(orbit) => Some(orbit.frequency_hz),
        WallMotion::Gyration(gyration) => Some(gyration.frequency_hz),
        _ => None,
    }
}

/// Turns of a wall that spins in one place, Hz. None: it does not.
fn turns_hz(motion: &WallMotion) -> Option<f64> {
    match motion {
        WallMotion::Velocity {
            velocity_m_s: [0.0, 0.0, 0.0],
            spin_rad_s,
            ..
        } => Some(Vector3::from(*spin_rad_s).norm() / TAU).filter(|hz| *hz > 0.0),
        _ => None,
    }
}

/// Rate at which a wall takes the same places again, Hz. None: it does not.
fn cycle_hz(motion: &WallMotion) -> Option<f64> {
    frequency_hz(motion).or_else(|| turns_hz(motion))
}

/// Largest step that follows a motion, s; infinite if it does not come back.
fn step_for_s(motion: &WallMotion) -> f64 {
    let turns_hz = match motion {
        WallMotion::Gyration(gyration) => gyration.spin_rad_s.abs() / TAU,
        _ => 0.0,
    };
    let fastest_hz = frequency_hz(motion).map_or(0.0, |hz| hz.max(turns_hz));
    1.0 / (STEPS_IN_PERIOD * fastest_hz)
}

/// Largest step that follows the walls of a scene, s.
pub(crate) fn largest_step_s(scene: &Scene) -> f64 {
    let walls = scene.walls.values();
    let steps = walls.map(|wall| step_for_s(&wall.motion));
    steps.fold(f64::INFINITY, f64::min)
}

/// Refuses a given step, s, that is too long for the motion of a wall.
pub(crate) fn refuse_long_step(scene: &Scene, step_s: f64) -> Result<()> {
    let too_fast = |wall: &dem_scene::Wall| step_s > step_for_s(&wall.motion);
    let Some((name, wall)) = scene.walls.iter().find(|(_, wall)| too_fast(wall)) else {
        return Ok(());
    };
    let limit_s = step_for_s(&wall.motion);
    Err(Diagnostic::input(
        format!("{}: [walls.{name}]", scene.source),
        format!(
            "its motion takes {} for a period, which is {} steps of run.time_step, {}; at least {STEPS_IN_PERIOD} are needed",
            show_quantity(STEPS_IN_PERIOD * limit_s, "s"),
            significant(STEPS_IN_PERIOD * limit_s / step_s, 3),
            show_quantity(step_s, "s"),
        ),
        format!(
            "write time_step = \"auto\" or at most {}, or a frequency of at most {}",
            show_quantity(limit_s, "s"),
            show_quantity(1.0 / (STEPS_IN_PERIOD * step_s), "Hz")
        ),
    ))
}

/// Times at which a wall is at the ends of its way and in between, s; some may be before the start.
/// Empty: its way is not known in advance.
fn moments_s(motion: &WallMotion) -> Vec<f64> {
    if let WallMotion::Displacement { factor, .. } = motion {
        match factor {
            Factor::Ramp { until_s } => return vec![0.0, *until_s],
            Factor::Table(points) => return points.iter().map(|point| point[0]).collect(),
            Factor::One | Factor::Oscillation { .. } => {}
        }
    }
    let phase = match motion {
        WallMotion::Displacement {
            factor: Factor::Oscillation { phase_rad, .. },
            ..
        } => phase_rad / TAU,
        _ => 0.0,
    };
    let Some(frequency_hz) = cycle_hz(motion) else {
        return Vec::new();
    };
    let part = |k: usize| k as f64 / MOMENTS as f64;
    (0..MOMENTS)
        .map(|k| (part(k) - phase) / frequency_hz)
        .collect()
}

/// Where a wall is at the second of these times, s, if it has its frame of the first.
fn frame_at(wall: &Wall, [now_s, time_s]: [f64; 2]) -> Frame {
    let Frame { position_m, turned } = wall.frame;
    match &wall.model.motion {
        WallMotion::Displacement {
            displacement_m,
            angular_displacement_rad,
            factor,
        } => {
            let gain = factor_at(factor, time_s) - factor_at(factor, now_s);
            Frame {
                position_m: [0, 1, 2].map(|k| position_m[k] + gain * displacement_m[k]),
                turned: turn(turned, angular_displacement_rad.map(|angle| gain * angle)),
            }
        }
        WallMotion::Velocity { spin_rad_s, .. } if turns_hz(&wall.model.motion).is_some() => {
            let turned = turn(turned, spin_rad_s.map(|rate| rate * (time_s - now_s)));
            Frame { position_m, turned }
        }
        WallMotion::Orbit(orbit) => {
            let Frame { position_m, turned } = middle(wall, now_s);
            let place_m = orbit.place_m(time_s);
            let position_m = [0, 1, 2].map(|k| position_m[k] + place_m[k]);
            Frame { position_m, turned }
        }
        WallMotion::Gyration(gyration) => {
            let upright = rotation(middle(wall, now_s).turned);
            let turned = numbers(&(rotation(gyration.turned(time_s)) * upright));
            Frame { position_m, turned }
        }
        _ => wall.frame,
    }
}

/// Where a wall is in the middle of its circle, or upright, if it has its frame of this time, s.
fn middle(wall: &Wall, now_s: f64) -> Frame {
    let Frame { position_m, turned } = wall.frame;
    match &wall.model.motion {
        WallMotion::Orbit(orbit) => {
            let place_m = orbit.place_m(now_s);
            let position_m = [0, 1, 2].map(|k| position_m[k] - place_m[k]);
            Frame { position_m, turned }
        }
        WallMotion::Gyration(gyration) => {
            let upright = rotation(gyration.turned(now_s)).inverse() * rotation(turned);
            let turned = numbers(&upright);
            Frame { position_m, turned }
        }
        _ => wall.frame,
    }
}

/// Largest distance between two places of one point of the surface of a wall, m, over its whole
/// motion; of a plane, of its point. None: its way is not known in advance, or has no end. The wall
/// is where it is at this time, s.
pub fn stroke_m(wall: &Wall, now_s: f64) -> Option<f64> {
    let motion = &wall.model.motion;
    let spins = matches!(motion, WallMotion::Gyration(gyration) if gyration.spin_rad_s != 0.0);
    if spins || turns_hz(motion).is_some() {
        return None;
    }
    let moments = moments_s(motion).into_iter();
    let frames: Vec<Frame> = moments.map(|at_s| frame_at(wall, [now_s, at_s])).collect();
    let mut stroke_m = frames.first().map(|_| 0.0)?;
    for point in wall.model.shape.surface_points_m() {
        let places: Vec<[f64; 3]> = frames.iter().map(|f| f.to_space(point)).collect();
        for (k, place) in places.iter().enumerate() {
            let ways = places[..k].iter().map(|other| Bounds::of([*place, *other]));
            stroke_m = ways.fold(stroke_m, |most: f64, way| most.max(way.diagonal_m()));
        }
    }
    Some(stroke_m)
}

/// Pairs of walls that do not overlap at the start, in the middle of their circles or upright, but
/// which their motion drives into each other, a sentence each. The walls are where they start.
pub(crate) fn crossings(walls: &[Wall]) -> Vec<String> {
    let comes_back = |wall: &Wall| cycle_hz(&wall.model.motion).is_some();
    if !walls.iter().any(comes_back) {
        return Vec::new();
    }
    let seen: Vec<Seen<'_>> = walls.iter().map(Seen::new).collect();
    let mut found = Vec::new();
    for (k, one) in seen.iter().enumerate() {
        for other in &seen[..k] {
            let (first, second) = match comes_back(one.wall) {
                true => (one, other),
                false => (other, one),
            };
            let stands = second.wall.model.motion == WallMotion::Fixed;
            if comes_back(first.wall) && (comes_back(second.wall) || stands) {
                found.extend(crossing(first, second));
            }
        }
    }
    found
}

/// Walls that shake far harder than any machine does, a sentence each: the frequency may be one in
/// revolutions per minute.
pub(crate) fn shaking(walls: &[Wall]) -> Vec<String> {
    let sentence = |wall: &Wall| {
        let hz = frequency_hz(&wall.model.motion)?;
        let amplitude_m = 0.5 * stroke_m(wall, 0.0)?;
        let times_gravity = amplitude_m * (TAU * hz).powi(2) / GRAVITY_M_S2;
        (times_gravity > MOST_GRAVITY).then(|| {
            format!(
                "the wall '{}' shakes with {} times gravity, {} to either side at {}: is its frequency one in rpm? Vibrating screens take up to ten times gravity",
                wall.model.name,
                significant(times_gravity, 2),
                show_length(amplitude_m),
                show_quantity(hz, "Hz"),
            )
        })
    };
    walls.iter().filter_map(sentence).collect()
}

/// A wall and points on its surface, in its own frame, m.
struct Seen<'a> {
    wall: &'a Wall,
    points: Vec<[f64; 3]>,
    /// Where it is at any time. None: it is infinite.
    swept: Option<Bounds>,
}

impl<'a> Seen<'a> {
    fn new(wall: &'a Wall) -> Self {
        let points = wall.model.shape.surface_points_m();
        let swept = swept(wall);
        Self {
            wall,
            points,
            swept,
        }
    }

    /// Depth of its deepest point in another wall, m, in these frames.
    fn depth_m(&self, frame: &Frame, other: &Self, in_frame: &Frame) -> f64 {
        let shape = &other.wall.model.shape;
        let there = |point: &[f64; 3]| in_frame.to_wall(frame.to_space(*point));
        let inside = self
            .points
            .iter()
            .map(there)
            .filter(|point| shape.holds(*point));
        inside.fold(0.0, |most, point| most.max(shape.distance_m(point).abs()))
    }
}

/// The box in which a wall is at any time of its period. None: it is infinite.
fn swept(wall: &Wall) -> Option<Bounds> {
    let own = wall.model.shape.bounds();
    if !own.diagonal_m().is_finite() {
        return None;
    }
    let moments = moments_s(&wall.model.motion).into_iter();
    let frames = moments.map(|at_s| frame_at(wall, [0.0, at_s]));
    let places = std::iter::once(wall.frame)
        .chain(frames)
        .flat_map(|frame| own.corners().map(|corner| frame.to_space(corner)));
    Some(Bounds::of(places))
}

/// Depth of the deepest point of each of two walls in the other one, m, in these frames.
fn overlap_m(one: &Seen<'_>, other: &Seen<'_>, [first, second]: [&Frame; 2]) -> f64 {
    let depth_m = one.depth_m(first, other, second);
    depth_m.max(other.depth_m(second, one, first))
}

/// The sentence for a wall that comes back and another one that stands or comes back.
fn crossing(one: &Seen<'_>, other: &Seen<'_>) -> Option<String> {
    let (wall, beside) = (one.wall, other.wall);
    let is_apart = one.swept.zip(other.swept);
    let is_apart = is_apart.is_some_and(|(one, other)| !one.overlaps(&other));
    // Walls on one orbit move as one.
    let is_one = matches!(wall.model.motion, WallMotion::Orbit(_))
        && wall.model.motion == beside.model.motion;
    if is_apart || is_one {
        return None;
    }
    let sizes_m = [wall, beside].map(|wall| wall.model.shape.bounds().diagonal_m());
    let touch_m = TOUCH * sizes_m.into_iter().fold(f64::INFINITY, f64::min);
    let [middle, middle_beside] = [wall, beside].map(|wall| middle(wall, 0.0));
    let is_apart = overlap_m(one, other, [&middle, &middle_beside]) <= touch_m;
    if !(touch_m.is_finite() && is_apart) {
        return None;
    }
    let motions = [&wall.model.motion, &beside.model.motion];
    let [own_hz, other_hz] = motions.map(cycle_hz);
    let mut deepest_m: f64 = 0.0;
    for time_s in moments_s(motions[0]) {
        let frame = frame_at(wall, [0.0, time_s]);
        // Walls of different frequencies meet in all positions.
        let times_s = match other_hz {
            Some(_) if own_hz != other_hz => moments_s(motions[1]),
            _ => vec![time_s],
        };
        for frame_beside in times_s
            .into_iter()
            .map(|at_s| frame_at(beside, [0.0, at_s]))
        {
            deepest_m = deepest_m.max(overlap_m(one, other, [&frame, &frame_beside]));
        }
    }
    (deepest_m > touch_m).then(|| {
        format!(
            "the motion of the wall '{}' drives it up to {} into the wall '{}', and crushes what is between them: move them apart, or make the motion smaller",
            wall.model.name,
            show_length(deepest_m),
            beside.model.name
        )
    })
}
