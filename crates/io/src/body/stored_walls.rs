//! The walls of a scene as the frames of a run hold them: triangles, names and forces.

use crate::diagnostic::{Diagnostic, Result};

/// Cell array: number of the wall in [`WALL_NAMES`].
pub const WALL: &str = "wall";
/// Cell array: force of the particles on the wall, N; the same for all triangles of a wall.
pub const FORCE: &str = "force_n";
/// Cell array: velocity of the surface at the centre of the triangle, m/s.
pub const VELOCITY: &str = "velocity_m_s";
/// Field: names of the walls.
pub const WALL_NAMES: &str = "wall_names";
/// Field: force of the particles on each wall, N, in full precision.
pub const WALL_FORCES: &str = "wall_force_n";
/// Field: name of the file next to this one with the triangles of large walls that never move.
pub const FIXED_WALLS: &str = "fixed_walls";
/// The name in [`FIXED_WALLS`].
pub const FIXED_WALLS_FILE: &str = "walls_fixed.vtp";

/// The walls of a scene at one time. SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StoredWalls {
    /// Simulated time, s.
    pub time_s: f64,
    /// Name of each wall.
    pub names: Vec<String>,
    /// Force of the particles on each wall, N. Shape walls x 3.
    pub forces_n: Vec<[f64; 3]>,
    /// Points, m. Shape n x 3.
    pub points_m: Vec<[f64; 3]>,
    /// The three points of each triangle, counterclockwise as seen from outside the wall.
    pub triangles: Vec<[u32; 3]>,
    /// The wall of each triangle. Length: triangles.
    pub wall_of_triangle: Vec<u32>,
    /// Whether more triangles are in [`FIXED_WALLS_FILE`].
    pub(crate) has_fixed: bool,
}

impl StoredWalls {
    /// Checks that the points and walls of all triangles exist.
    pub(crate) fn check(&self) -> Result<()> {
        let points = self.points_m.len();
        let corners = self.triangles.as_flattened().iter();
        let wrong = corners.copied().find(|point| *point as usize >= points);
        let missing = |what: &str, number: u32, count: usize| {
            let problem = format!("a triangle has {what} {number}, but there are {count}");
            Err(Diagnostic::input("", problem, "write or copy it again"))
        };
        if let Some(point) = wrong {
            return missing("point", point, points);
        }
        let walls = self.names.len();
        let mut numbers = self.wall_of_triangle.iter().copied();
        match numbers.find(|wall| *wall as usize >= walls) {
            Some(wall) => missing("wall", wall, walls),
            None => Ok(()),
        }
    }

    /// Adds the triangles of others, whose names are the same.
    pub(crate) fn add(&mut self, others: &Self) {
        let first = self.points_m.len() as u32;
        self.points_m.extend(&others.points_m);
        let triangles = others.triangles.iter();
        self.triangles
            .extend(triangles.map(|t| t.map(|point| first + point)));
        self.wall_of_triangle.extend(&others.wall_of_triangle);
    }
}
