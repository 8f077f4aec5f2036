//! The arrays that bodies, frames and walls are made of, by their sections and names.

use super::names::{
    BOND_RANGE, LENGTH_UNIT, OVERLAP, PARTICLE_DENSITY, PARTICLES_ACROSS, PROGRAM, SEED,
    SHAPE_VOLUME, SOURCE, SOURCE_HASH, THINNEST_PART, VERSION, WARNINGS,
};
use crate::body::histories::{self, DIRECTION};
use crate::body::stored_frame as frame;
use crate::body::stored_walls::{FIXED_WALLS, WALL, WALL_FORCES, WALL_NAMES};
use crate::vtp::{Of, Shape};

/// A number or a text; fields of other programs may be larger.
const FIELD: Shape = Shape::Field(1 << 14);
/// Scenes may have many walls and bodies.
const LONG_FIELD: Shape = Shape::Field(1 << 20);

/// The positions.
pub(super) const POSITIONS: &str = "Points/positions_m";
/// The particles of bonds.
pub(super) const BOND_ENDS: &str = "Lines/connectivity";
/// Where each bond ends among them.
pub(super) const BOND_OFFSETS: &str = "Lines/offsets";
/// The points of triangles.
pub(super) const CORNERS: &str = "Polys/connectivity";

const fn values(of: Of, each: u64) -> Option<Shape> {
    Some(Shape::Each(of, each, "values"))
}

pub(super) fn of_body(section: &str, name: &str) -> Option<Shape> {
    match (section, name) {
        (
            "FieldData",
            VERSION | LENGTH_UNIT | PROGRAM | SOURCE | SOURCE_HASH | SHAPE_VOLUME
            | PARTICLE_DENSITY | OVERLAP | BOND_RANGE | SEED | THINNEST_PART | PARTICLES_ACROSS
            | WARNINGS,
        ) => Some(FIELD),
        _ => of_particles_and_bonds(section, name),
    }
}

pub(super) fn of_frame(section: &str, name: &str) -> Option<Shape> {
    match (section, name) {
        ("FieldData", frame::TIME) => Some(FIELD),
        ("FieldData", frame::BODY_NAMES) => Some(LONG_FIELD),
        (
            "PointData",
            frame::RIGID | frame::FRAGMENT_ID | frame::DENSITY | frame::PARTICLE_ID | frame::BODY,
        ) => values(Of::Points, 1),
        ("PointData", frame::VELOCITY) => values(Of::Points, 3),
        _ => of_particles_and_bonds(section, name),
    }
}

fn of_particles_and_bonds(section: &str, name: &str) -> Option<Shape> {
    match (section, name) {
        ("Points", _) => values(Of::Points, 3),
        ("Lines", "connectivity") => Some(Shape::Each(Of::Lines, 2, "line ends")),
        ("Lines", "offsets") => Some(Shape::Each(Of::Lines, 1, "lines")),
        ("PointData", frame::RADIUS) => values(Of::Points, 1),
        ("PointData", frame::TURN) => values(Of::Points, 3),
        ("CellData", frame::BOND_RADIUS | frame::BOND_LENGTH | frame::DAMAGE | frame::BROKEN) => {
            values(Of::Cells, 1)
        }
        ("CellData", DIRECTION) => values(Of::Cells, 3),
        ("CellData", name) => histories::shape(name),
        _ => None,
    }
}

pub(super) fn of_walls(section: &str, name: &str) -> Option<Shape> {
    match (section, name) {
        ("Points", _) => values(Of::Points, 3),
        ("Polys", "connectivity") => Some(Shape::Each(Of::Triangles, 3, "corners")),
        ("Polys", "offsets") => Some(Shape::Each(Of::Triangles, 1, "offsets")),
        ("CellData", WALL) => values(Of::Triangles, 1),
        ("FieldData", frame::TIME | FIXED_WALLS) => Some(FIELD),
        ("FieldData", WALL_NAMES | WALL_FORCES) => Some(LONG_FIELD),
        _ => None,
    }
}

/// The key of an array of particles.
pub(super) fn of_points(name: &str) -> String {
    format!("PointData/{name}")
}

/// The key of an array of bonds or triangles.
pub(super) fn of_cells(name: &str) -> String {
    format!("CellData/{name}")
}
