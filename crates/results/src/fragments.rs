//! Fragments of breaking bodies: their motion at chosen moments, as one CSV table that grows, and
//! their origin, as one that is written at the end.
//!
//! Columns: see [`FragmentRow::COLUMNS`] and [`TreeRow::COLUMNS`]. Values that a fragment does not
//! have are empty. A zero has no sign.

use super::columns::{Column, known, lines};
use super::growing::{Table, field};
use dem_io::diagnostic::Result;
use dem_io::text::exact;

/// Number of rows that are passed to the system together.
const AT_ONCE: usize = 1000;

/// A fragment at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FragmentRow<'a> {
    /// The moment, s.
    pub time_s: f64,
    /// Its number, which is never reused.
    pub fragment_id: u32,
    /// The fragment from which it broke off.
    pub parent_id: Option<u32>,
    /// Number of its particles.
    pub particles: u32,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass, m. Length 3.
    pub centre_m: [f64; 3],
    /// Velocity of the centre of mass, m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// Angular velocity, rad/s. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// Sum of the forces on its particles, N. Length 3. None: not known.
    pub force_n: Option<[f64; 3]>,
    /// Diameter of the sphere with the volume of its particles, m.
    pub equivalent_diameter_m: f64,
    /// Diagonal of the box around it, m.
    pub box_diagonal_m: f64,
    /// Name of its body.
    pub body: &'a str,
    /// Name of its material.
    pub material: &'a str,
}

impl FragmentRow<'_> {
    /// The columns of its table.
    pub const COLUMNS: [Column<Self>; 21] = [
        ("time_s", |row| exact(row.time_s)),
        ("fragment_id", |row| row.fragment_id.to_string()),
        ("parent_id", |row| known(row.parent_id)),
        ("particles", |row| row.particles.to_string()),
        ("mass_kg", |row| number(row.mass_kg)),
        ("x_m", |row| number(row.centre_m[0])),
        ("y_m", |row| number(row.centre_m[1])),
        ("z_m", |row| number(row.centre_m[2])),
        ("vx_m_s", |row| number(row.velocity_m_s[0])),
        ("vy_m_s", |row| number(row.velocity_m_s[1])),
        ("vz_m_s", |row| number(row.velocity_m_s[2])),
        ("wx_rad_s", |row| number(row.angular_velocity_rad_s[0])),
        ("wy_rad_s", |row| number(row.angular_velocity_rad_s[1])),
        ("wz_rad_s", |row| number(row.angular_velocity_rad_s[2])),
        ("fx_n", |row| force(row, 0)),
        ("fy_n", |row| force(row, 1)),
        ("fz_n", |row| force(row, 2)),
        ("equivalent_diameter_m", |row| {
            number(row.equivalent_diameter_m)
        }),
        ("box_diagonal_m", |row| number(row.box_diagonal_m)),
        ("body", |row| field(row.body)),
        ("material", |row| field(row.material)),
    ];
}

/// Appends the fragments of one moment to their table. They are in the file when this returns. If
/// the disk is full, earlier moments are kept, and possibly some complete rows of this one.
pub fn append_fragments(table: &mut Table, fragments: &[FragmentRow<'_>]) -> Result<()> {
    for some in fragments.chunks(AT_ONCE) {
        table.append(&lines(&FragmentRow::COLUMNS, some.iter().copied()))?;
    }
    Ok(())
}

fn force(row: &FragmentRow<'_>, axis: usize) -> String {
    known(row.force_n.map(|force_n| number(force_n[axis])))
}

fn number(value: f64) -> String {
    // Adding 0 removes the sign of a zero.
    exact(value + 0.0)
}

/// A present or former fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreeRow {
    /// Its number.
    pub fragment_id: u32,
    /// The fragment from which it broke off; none if it is an original body.
    pub parent_id: Option<u32>,
    /// Time at which it was found, s.
    pub created_s: f64,
    /// Time at which it was found broken, s; none if it is not broken.
    pub ended_s: Option<f64>,
    /// Number of its particles.
    pub particles: u32,
}

impl TreeRow {
    /// The columns of its table.
    pub const COLUMNS: [Column<Self>; 5] = [
        ("fragment_id", |row| row.fragment_id.to_string()),
        ("parent_id", |row| known(row.parent_id)),
        ("created_s", |row| exact(row.created_s)),
        ("ended_s", |row| known(row.ended_s.map(exact))),
        ("particles", |row| row.particles.to_string()),
    ];
}
