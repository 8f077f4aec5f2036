//! The walls of a frame for ParaView: triangles as .vtp, `frames/walls_000123.vtp`.
//!
//! Points and vectors are in single precision, which suffices for drawing (points in double where
//! they are so far from the origin that single precision would move them); the forces are in the
//! field data as well, in full. Large walls that never move are not written again with each frame:
//! they are in `frames/walls_fixed.vtp`, which every time of `frames.pvd` lists. Such a wall of
//! 100,000 triangles takes 2.6 MB once; a moving one takes 5 MB in each frame.

use std::io::{self, Write};

use super::wall_loads::WallPatch;

use dem_io::body::stored_walls::{
    FIXED_WALLS, FIXED_WALLS_FILE, FORCE, VELOCITY, WALL, WALL_FORCES, WALL_NAMES,
};
use dem_io::stl::single_precision_keeps;
use dem_io::vtk::{
    Cells, NamedArray, PolyData, Values, exact, write_number, write_text, write_texts,
    write_vectors,
};

/// Triangles of walls.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WallTriangles {
    /// Points, m. Shape n x 3.
    pub points_m: Vec<[f64; 3]>,
    /// The three points of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The wall of each triangle. Length: triangles.
    pub wall_of_triangle: Vec<u32>,
}

impl WallTriangles {
    /// Adds the triangles of a wall of this number. Points, m, shape n x 3; triangles of three of
    /// them each.
    pub fn add(
        &mut self,
        wall: u32,
        points_m: impl Iterator<Item = [f64; 3]>,
        triangles: &[[u32; 3]],
    ) {
        let first = self.points_m.len() as u32;
        self.points_m.extend(points_m);
        let moved = triangles.iter().map(|t| t.map(|point| first + point));
        self.triangles.extend(moved);
        self.wall_of_triangle
            .extend(std::iter::repeat_n(wall, triangles.len()));
    }
}

/// The walls of a scene at the time of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WallFrame {
    /// Name of each wall.
    pub names: Vec<String>,
    /// Force of the particles on each wall, N. Shape walls x 3.
    pub forces_n: Vec<[f64; 3]>,
    /// The triangles, without those of large walls that never move.
    pub triangles: WallTriangles,
    /// Velocity of the surface at the centre of each triangle, m/s. Shape triangles x 3.
    pub velocities_m_s: Vec<[f64; 3]>,
    /// What contacts have done so far to the patches of walls with loads, where they stand now.
    pub loads: Vec<WallPatch>,
}

/// Writes the walls of a frame as .vtp. `has_fixed`: others are in `walls_fixed.vtp`.
pub(crate) fn write_walls(
    walls: &WallFrame,
    time_s: f64,
    has_fixed: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    let wall = |i: usize| walls.triangles.wall_of_triangle[i];
    let force = |i: usize| single(walls.forces_n[wall(i) as usize]);
    let velocity = |i: usize| single(walls.velocities_m_s[i]);
    let arrays = [
        named(WALL, Values::Counts(&wall)),
        named(FORCE, Values::SingleVectors(&force)),
        named(VELOCITY, Values::SingleVectors(&velocity)),
    ];
    write(&walls.triangles, &arrays, out, |out| {
        write_number(out, "Float64", "TimeValue", Some(exact(time_s)))?;
        write_texts(out, WALL_NAMES, &walls.names)?;
        write_vectors(out, WALL_FORCES, &walls.forces_n)?;
        write_text(out, FIXED_WALLS, has_fixed.then_some(FIXED_WALLS_FILE))
    })
}

/// Writes walls that never move.
pub(crate) fn write_fixed_walls(walls: &WallTriangles, out: &mut dyn Write) -> io::Result<()> {
    let wall = |i: usize| walls.wall_of_triangle[i];
    write(
        walls,
        &[named(WALL, Values::Counts(&wall))],
        out,
        |_| Ok(()),
    )
}

fn write(
    walls: &WallTriangles,
    cell_data: &[NamedArray<'_>],
    out: &mut dyn Write,
    write_fields: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let exact_place = |i: usize| walls.points_m[i];
    let place = |i: usize| single(walls.points_m[i]);
    PolyData {
        points: walls.points_m.len(),
        place: match single_precision_keeps(walls.points_m.iter()) {
            true => Values::SingleVectors(&place),
            false => Values::Vectors(&exact_place),
        },
        cells: Cells::Triangles(walls.triangles.len(), &|i| walls.triangles[i]),
        point_data: &[],
        cell_data,
    }
    .write(out, write_fields)
}

fn named<'a>(name: &'a str, values: Values<'a>) -> NamedArray<'a> {
    NamedArray { name, values }
}

fn single(vector: [f64; 3]) -> [f32; 3] {
    vector.map(|x| x as f32)
}
