//! What leaves through outlets, as one CSV table that grows; and the size distribution of all
//! fragments, as one that is written at the end.
//!
//! Columns: see [`DischargeRow::COLUMNS`] and [`DistributionRow::COLUMNS`].

use super::columns::Column;
use super::growing::field;
use dem_io::text::exact;

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

impl DischargeRow<'_> {
    /// The columns of its table. Length, width and thickness are those of the box along the
    /// principal axes, the longest first.
    pub const COLUMNS: [Column<Self>; 11] = [
        ("time_s", |row| exact(row.time_s)),
        ("fragment_id", |row| row.fragment_id.to_string()),
        ("body", |row| field(row.body)),
        ("material", |row| field(row.material)),
        ("outlet", |row| field(row.outlet)),
        ("mass_kg", |row| exact(row.mass_kg)),
        ("equivalent_diameter_m", |row| {
            exact(row.equivalent_diameter_m)
        }),
        ("length_m", |row| exact(row.box_lengths_m[0])),
        ("width_m", |row| exact(row.box_lengths_m[1])),
        ("thickness_m", |row| exact(row.box_lengths_m[2])),
        ("sieve_m", |row| exact(row.sieve_m)),
    ];
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

impl DistributionRow<'_> {
    /// The columns of its table.
    pub const COLUMNS: [Column<Self>; 6] = [
        ("body", |row| field(row.body)),
        ("location", |row| field(row.location)),
        ("sieve_m", |row| exact(row.sieve_m)),
        ("passing_kg", |row| exact(row.passing_kg)),
        ("passing_fraction", |row| exact(row.passing_fraction)),
        ("resolved", |row| u8::from(row.resolved).to_string()),
    ];
}
