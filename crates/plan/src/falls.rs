//! `drop` of a body: just above a wall, with the speed of its fall.

use dem_io::{Body, Diagnostic, Result};
use dem_scene::{BodyEntry, Fall, PlaneShape, Scene, StartAs, Wall, WallShape};
use nalgebra::{UnitQuaternion, Vector3};

use super::walls::{beginning, standing};
use dem_physics::geometry::{Frame, Shape};

/// Gap between a body that falls and its wall at the start, over the smallest radius of the body.
const GAP: f64 = 0.01;
/// Accuracy of the gap to a wall that is no plane, as a fraction of it.
const FINE: f64 = 1e-4;
/// Distance at which a wall is looked for, in radii of a sphere.
const REACH: f64 = 4.0;

/// The spheres of a body at the start, without the part of the fall: centre and radius, m.
type Spheres = Vec<(Vector3<f64>, f64)>;

/// Puts a body just above its wall, with the speed with which it touches it after its fall less
/// what it gains on the way left. Refuses a wall that is not below the body.
pub(super) fn drop_onto(
    scene: &Scene,
    name: &str,
    entry: &mut BodyEntry,
    body: &Body,
    fall: &Fall,
) -> Result<()> {
    let Some(wall) = scene.walls.get(&fall.onto) else {
        return Ok(());
    };
    let gravity = Vector3::from(scene.run.gravity_m_s2);
    let down = gravity.normalize();
    let spheres = spheres(entry, body);
    let smallest_m = body.radii.iter().copied().fold(f64::INFINITY, f64::min);
    let refuse = |problem: String, remedy: &str| {
        let place = format!("{}: bodies.{name}.drop", scene.source);
        Diagnostic::input(place, problem, remedy)
    };
    // The way down along the vertical to the wall, and the cosine between the vertical and its
    // normal.
    let (way_m, facing) = match plane(wall) {
        Some((point, normal)) => {
            let facing = -down.dot(&normal);
            if facing <= 0.0 {
                let problem = format!(
                    "gravity does not point towards the free side of '{}'",
                    fall.onto
                );
                let remedy = "name a plane below the body, or turn its normal round";
                return Err(refuse(problem, remedy));
            }
            let distance =
                |(centre, radius_m): &(Vector3<f64>, f64)| (centre - point).dot(&normal) - radius_m;
            let nearest_m = spheres.iter().map(distance).fold(f64::INFINITY, f64::min);
            (nearest_m / facing, facing)
        }
        None => {
            let (shape, frame) = standing(wall, &fall.onto)?;
            let fine_m = FINE * GAP * smallest_m;
            way_to(&shape, &frame, &spheres, down, fine_m).ok_or_else(|| {
                let problem = format!("the body falls past '{}'", fall.onto);
                refuse(problem, "move it across gravity with position, or the wall")
            })?
        }
    };
    let gap_m = (GAP * smallest_m / facing).min(fall.height_m);
    // Along the vertical, so that the body stays where it is across it.
    entry.position_m = (Vector3::from(entry.position_m) + (way_m - gap_m) * down).into();
    let speed_m_s = (2.0 * gravity.norm() * (fall.height_m - gap_m)).sqrt();
    entry.velocity_m_s = (speed_m_s * down).into();
    Ok(())
}

fn spheres(entry: &BodyEntry, body: &Body) -> Spheres {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad));
    let shift = Vector3::from(entry.position_m);
    let scale = match entry.start_as {
        StartAs::Clump(clump) => clump.scale,
        StartAs::Bonded => 1.0,
    };
    let places = body.positions.iter().zip(&body.radii);
    places
        .map(|(place, radius_m)| (turn * Vector3::from(*place) + shift, scale * radius_m))
        .collect()
}

/// The way from the start, m, negative upwards, on which the first sphere touches the shape when
/// all come from above it, and the cosine between the vertical and the wall's normal there. None:
/// all fall past.
fn way_to(
    shape: &Shape,
    frame: &Frame,
    spheres: &Spheres,
    down: Vector3<f64>,
    fine_m: f64,
) -> Option<(f64, f64)> {
    let corners = shape.bounds().corners();
    let depths = corners.map(|corner| Vector3::from(frame.to_space(corner)).dot(&down));
    let top = depths.into_iter().fold(f64::INFINITY, f64::min);
    let bottom = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let lowest = |(centre, radius_m): &(Vector3<f64>, f64)| centre.dot(&down) + radius_m;
    let front = spheres.iter().map(lowest).fold(f64::NEG_INFINITY, f64::max);
    let begin_m = top - front;
    let mut first: Option<(f64, f64)> = None;
    for (centre, radius_m) in spheres {
        let past_m = bottom + radius_m - centre.dot(&down);
        let longest_m = first.map_or(past_m, |(way_m, _)| past_m.min(way_m));
        let found = touch_way(
            shape,
            frame,
            (*centre, *radius_m),
            down,
            [begin_m, longest_m],
            fine_m,
        );
        first = found.or(first);
    }
    first
}

/// The same for one sphere, between two ways, m: it moves on by its distance from the wall, so that
/// it never passes it.
fn touch_way(
    shape: &Shape,
    frame: &Frame,
    (centre, radius_m): (Vector3<f64>, f64),
    down: Vector3<f64>,
    [begin_m, longest_m]: [f64; 2],
    fine_m: f64,
) -> Option<(f64, f64)> {
    let reach_m = REACH * radius_m;
    let mut found = Vec::new();
    let mut way_m = begin_m;
    while way_m < longest_m {
        found.clear();
        let at = frame.to_wall((centre + way_m * down).into());
        shape.touches(at, reach_m, &mut found);
        let nearest = (found.iter()).min_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        let gap_m = nearest.map_or(reach_m, |touch| touch.distance_m) - radius_m;
        if let Some(touch) = nearest
            && gap_m <= fine_m
        {
            let normal = Vector3::from(frame.direction_to_space(touch.normal));
            return Some((way_m, normal.dot(&down).max(GAP)));
        }
        way_m += gap_m;
    }
    None
}

/// Point and normal of a plane at the start. None: the wall is no plane.
fn plane(wall: &Wall) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let WallShape::Plane(PlaneShape { point_m, normal }) = wall.shape else {
        return None;
    };
    let (begins_m, leans) = beginning(&wall.motion);
    let turn = leans * UnitQuaternion::from_scaled_axis(Vector3::from(wall.rotation_rad));
    let pivot = Vector3::from(wall.pivot_m);
    let point = pivot + turn * (Vector3::from(point_m) - pivot) + begins_m;
    Some((point, turn * Vector3::from(normal)))
}
