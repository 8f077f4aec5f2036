//! Walls in frames: their triangles, forces and velocities.

use std::collections::HashMap;

use dem_results::{WallFiles, WallFrame, WallTriangles};
use dem_scene::WallMotion;
use nalgebra::Vector3;

use crate::pictures::subject::{around, corners_m, plane_patch, points_of};
use crate::wall_patches::{Position, wall_patches};
use dem_engine::state::State;
use dem_engine::state::walls::Wall;
use dem_physics::geometry::Bounds;

/// Number of triangles above which a wall that never moves is written once instead of with each
/// frame.
const LARGE: usize = 10_000;

/// The walls of a run as its frames show them.
#[derive(Debug, Clone)]
pub(crate) struct WallOutput {
    /// The part of planes that is shown.
    around: Bounds,
    /// For each wall. None: a plane, or a large wall that never moves.
    moving: Vec<Option<Patch>>,
    /// Large walls that never move, where they stand.
    fixed: WallTriangles,
    /// Whether loads are booked on any wall.
    has_loads: bool,
}

/// The triangles of a wall in its own frame.
#[derive(Debug, Clone, Default)]
struct Patch {
    points_m: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl WallOutput {
    /// From a state at its start.
    pub(crate) fn of(start: &State) -> Self {
        let mut output = Self {
            around: around(start, &points_of(start)),
            moving: Vec::new(),
            fixed: WallTriangles::default(),
            has_loads: start.walls.iter().any(|wall| wall.model.book.is_some()),
        };
        for (number, wall) in (0..).zip(&start.walls) {
            let patch = corners_m(&wall.model.shape).map(|corners| Patch::of(&corners));
            let is_fixed = wall.model.motion == WallMotion::Fixed;
            output.moving.push(match patch {
                Some(patch) if is_fixed && patch.triangles.len() > LARGE => {
                    let points_m = patch.points_m.iter().map(|p| wall.frame.to_space(*p));
                    output.fixed.add(number, points_m, &patch.triangles);
                    None
                }
                other => other,
            });
        }
        output
    }

    /// The files that hold them.
    pub(crate) fn files(&self) -> WallFiles {
        WallFiles {
            each_frame: !self.moving.is_empty(),
            fixed: !self.fixed.triangles.is_empty(),
            loads: self.has_loads,
        }
    }

    /// The large walls that never move.
    pub(crate) fn fixed(&self) -> &WallTriangles {
        &self.fixed
    }

    /// The walls of a state between a kick and the drift after it.
    pub(crate) fn frame(&self, state: &State) -> WallFrame {
        let mut shown = WallFrame::default();
        for ((number, wall), patch) in (0..).zip(&state.walls).zip(&self.moving) {
            shown.names.push(wall.model.name.clone());
            // Adding 0 removes the sign of a zero.
            let force_n = wall.total_load()[0].map(|force| 0.0 - force);
            shown.forces_n.push(force_n);
            let of_plane = plane_patch(wall, &state.walls, &self.around);
            let of_plane = of_plane.map(|corners| Patch::of(&corners));
            let first = shown.triangles.triangles.len();
            let (patch, points_m): (_, Vec<[f64; 3]>) = match (patch, &of_plane) {
                (Some(patch), _) => {
                    let to_space = |point| wall.frame.to_space(point);
                    (
                        patch,
                        patch.points_m.iter().copied().map(to_space).collect(),
                    )
                }
                (None, Some(patch)) => (patch, patch.points_m.clone()),
                (None, None) => continue,
            };
            let triangles = &patch.triangles;
            shown.triangles.add(number, points_m.into_iter(), triangles);
            let velocity = velocity_of(wall);
            let new = &shown.triangles.triangles[first..];
            let centres = new.iter().map(|t| centre(&shown.triangles.points_m, t));
            shown.velocities_m_s.extend(centres.map(velocity));
        }
        shown.loads = wall_patches(&state.walls, Position::Now);
        shown
    }
}

impl Patch {
    /// Triangles with common points: those at the same place are one.
    fn of(corners_m: &[[[f64; 3]; 3]]) -> Self {
        let mut patch = Self::default();
        let mut number_of = HashMap::new();
        for corners in corners_m {
            patch.triangles.push(corners.map(|point| {
                // Minus zero is zero.
                let bits = point.map(|x| (x + 0.0).to_bits());
                *number_of.entry(bits).or_insert_with(|| {
                    patch.points_m.push(point);
                    patch.points_m.len() as u32 - 1
                })
            }));
        }
        patch
    }
}

/// Velocity of the surface of a wall at a point, m/s: the mean of the step before and after, and
/// the motion of a belt.
fn velocity_of(wall: &Wall) -> impl Fn(Vector3<f64>) -> [f64; 3] {
    let mean = |[before, next]: [[f64; 3]; 2]| 0.5 * (Vector3::from(before) + Vector3::from(next));
    let (velocity, spin) = (mean(wall.velocities_m_s), mean(wall.spins_rad_s));
    let velocity = velocity + Vector3::from(wall.model.surface_velocity_m_s);
    let pivot = Vector3::from(wall.frame.position_m);
    move |point| (velocity + spin.cross(&(point - pivot))).into()
}

fn centre(points_m: &[[f64; 3]], triangle: &[u32; 3]) -> Vector3<f64> {
    let corners = triangle.map(|point| Vector3::from(points_m[point as usize]));
    (corners[0] + corners[1] + corners[2]) / 3.0
}
