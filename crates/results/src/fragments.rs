//! Fragments of breaking bodies: their motion at chosen moments, as one CSV table that grows, and
//! their origin, as one that is written at the end.
//!
//! Columns: see [`COLUMNS`] and [`TREE_COLUMNS`]. Values that a fragment does not have are empty.
//! Every number reads back as the same bits, except that a zero has no sign.

use std::fmt::{Display, Write};
use std::path::Path;

use super::growing::{Table, field};
use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;
use dem_io::text::exact;

/// The first line of the table of moments.
pub const COLUMNS: &str = "time_s,fragment_id,parent_id,particles,mass_kg,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,\
                           wx_rad_s,wy_rad_s,wz_rad_s,fx_n,fy_n,fz_n,equivalent_diameter_m,box_diagonal_m,body,material";

/// The first line of the fragment tree.
pub const TREE_COLUMNS: &str = "fragment_id,parent_id,created_s,ended_s,particles";

/// Number of rows that are passed to the system together.
const AT_ONCE: usize = 1000;

/// A fragment at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FragmentRow<'a> {
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
    /// Sum of the forces on its particles, N. Length 3.
    pub force_n: [f64; 3],
    /// Diameter of the sphere with the volume of its particles, m.
    pub equivalent_diameter_m: f64,
    /// Diagonal of the box around it, m.
    pub box_diagonal_m: f64,
    /// Name of its body.
    pub body: &'a str,
    /// Name of its material.
    pub material: &'a str,
}

/// Appends the fragments of one moment to their table. They are in the file when this returns. If
/// the disk is full, earlier moments are kept, and possibly some complete rows of this one.
pub fn append_fragments(
    table: &mut Table,
    time_s: f64,
    fragments: &[FragmentRow<'_>],
) -> Result<()> {
    for some in fragments.chunks(AT_ONCE) {
        let rows: String = some.iter().map(|fragment| row(time_s, fragment)).collect();
        table.append(&rows)?;
    }
    Ok(())
}

fn row(time_s: f64, fragment: &FragmentRow<'_>) -> String {
    let mut row = format!(
        "{},{},{},{}",
        exact(time_s),
        fragment.fragment_id,
        known(fragment.parent_id),
        fragment.particles
    );
    let [mass, size, extent] = [
        fragment.mass_kg,
        fragment.equivalent_diameter_m,
        fragment.box_diagonal_m,
    ];
    let vectors = [
        fragment.centre_m,
        fragment.velocity_m_s,
        fragment.angular_velocity_rad_s,
        fragment.force_n,
    ];
    let numbers = [mass].into_iter().chain(vectors.into_iter().flatten());
    for number in numbers.chain([size, extent]) {
        // Writing to a string cannot fail. Adding 0 removes the sign of a zero.
        let _ = write!(row, ",{}", exact(number + 0.0));
    }
    let _ = writeln!(
        row,
        ",{},{}",
        field(fragment.body),
        field(fragment.material)
    );
    row
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

/// Writes the fragment tree to the file `path`, completely or not at all.
pub fn write_fragment_tree(path: &Path, rows: impl Iterator<Item = TreeRow>) -> Result<()> {
    write_file(path, |out| {
        writeln!(out, "{TREE_COLUMNS}")?;
        for row in rows {
            let (parent, ended) = (known(row.parent_id), known(row.ended_s.map(exact)));
            let created = exact(row.created_s);
            writeln!(
                out,
                "{},{parent},{created},{ended},{}",
                row.fragment_id, row.particles
            )?;
        }
        Ok(())
    })
}

fn known(value: Option<impl Display>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}
