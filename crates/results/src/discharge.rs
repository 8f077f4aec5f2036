//! What leaves through outlets, as one CSV table that grows; and the size distribution of all
//! fragments, as one that is written at the end.
//!
//! Columns: see [`COLUMNS`] and [`DISTRIBUTION_COLUMNS`]. Every number reads back as the same bits.

use std::path::Path;

use super::growing::field;
use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;
use dem_io::text::exact;

/// The first line of the table of what leaves. Length, width and thickness are those of the box
/// along the principal axes, the longest first.
pub const COLUMNS: &str = "time_s,fragment_id,body,material,outlet,mass_kg,equivalent_diameter_m,length_m,width_m,thickness_m,sieve_m";

/// The first line of the size distribution.
pub const DISTRIBUTION_COLUMNS: &str = "body,location,sieve_m,passing_kg,passing_fraction,resolved";

/// A fragment or a body that has left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DischargeRow<'a> {
    /// s.
    pub time_s: f64,
    /// Its number, as in the table of fragments.
    pub fragment_id: u32,
    /// Name of its body.
    pub body: &'a str,
    /// Name of its material.
    pub material: &'a str,
    /// Name of the outlet.
    pub outlet: &'a str,
    /// kg.
    pub mass_kg: f64,
    /// Diameter of the sphere with the volume of its particles, m.
    pub equivalent_diameter_m: f64,
    /// Lengths of its box, the longest first, m. Length 3.
    pub box_lengths_m: [f64; 3],
    /// Side of the smallest square opening that it passes, m.
    pub sieve_m: f64,
}

/// Lines of the table of what leaves.
pub fn discharge_lines<'a>(rows: impl Iterator<Item = DischargeRow<'a>>) -> String {
    rows.map(|row| line(&row)).collect()
}

fn line(row: &DischargeRow<'_>) -> String {
    let [length, width, thickness] = row.box_lengths_m.map(exact);
    format!(
        "{},{},{},{},{},{},{},{length},{width},{thickness},{}\n",
        exact(row.time_s),
        row.fragment_id,
        field(row.body),
        field(row.material),
        field(row.outlet),
        exact(row.mass_kg),
        exact(row.equivalent_diameter_m),
        exact(row.sieve_m),
    )
}

/// A point of a size distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistributionRow<'a> {
    /// Name of the body, or `all`.
    pub body: &'a str,
    /// `inside`, `discharged` or `both`.
    pub location: &'a str,
    /// Opening of the sieve, m.
    pub sieve_m: f64,
    /// Mass of the fragments that pass it, kg.
    pub passing_kg: f64,
    /// The same as a fraction of the mass of all fragments of this body in this place.
    pub passing_fraction: f64,
    /// Whether the sieve is so large that the spheres of the bodies do not decide on what passes:
    /// `1`, else `0`.
    pub resolved: bool,
}

/// Writes the size distribution to the file `path`, completely or not at all.
pub fn write_distribution(path: &Path, rows: &[DistributionRow<'_>]) -> Result<()> {
    write_file(path, |out| {
        writeln!(out, "{DISTRIBUTION_COLUMNS}")?;
        for row in rows {
            writeln!(
                out,
                "{},{},{},{},{},{}",
                field(row.body),
                field(row.location),
                exact(row.sieve_m),
                exact(row.passing_kg),
                exact(row.passing_fraction),
                u8::from(row.resolved)
            )?;
        }
        Ok(())
    })
}
