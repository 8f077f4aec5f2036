//! Mass flows over time and the cells of mixtures, as CSV tables that are written at the end of a
//! run. Every number reads back as the same bits.

use super::columns::Column;
use super::growing::field;
use dem_io::text::exact;

/// What has come or left in an interval of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowRow<'a> {
    /// End of the interval, s.
    pub time_s: f64,
    /// Name of the body.
    pub body: &'a str,
    /// Name of the outlet. Empty: what inlets have fed.
    pub outlet: &'a str,
    /// Bodies and fragments from the start to the end of the interval.
    pub pieces: usize,
    /// Their mass, kg.
    pub mass_kg: f64,
    /// Mass in the interval over its duration, kg/s.
    pub flow_kg_s: f64,
}

impl FlowRow<'_> {
    /// The columns of its table.
    pub const COLUMNS: [Column<Self>; 6] = [
        ("time_s", |row| exact(row.time_s)),
        ("body", |row| field(row.body)),
        ("outlet", |row| field(row.outlet)),
        ("pieces", |row| row.pieces.to_string()),
        ("mass_kg", |row| exact(row.mass_kg)),
        ("flow_kg_s", |row| exact(row.flow_kg_s)),
    ];
}

/// A cell of a mixture at the end of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixingRow<'a> {
    /// Name of the mixing index.
    pub measure: &'a str,
    /// Centre of the cell, m. Length 3.
    pub centre_m: [f64; 3],
    /// Mass of both sets in the cell, kg.
    pub mass_kg: f64,
    /// Mass fraction of the first set in it.
    pub fraction: f64,
}

impl MixingRow<'_> {
    /// The columns of its table.
    pub const COLUMNS: [Column<Self>; 6] = [
        ("measure", |row| field(row.measure)),
        ("x_m", |row| exact(row.centre_m[0])),
        ("y_m", |row| exact(row.centre_m[1])),
        ("z_m", |row| exact(row.centre_m[2])),
        ("mass_kg", |row| exact(row.mass_kg)),
        ("fraction", |row| exact(row.fraction)),
    ];
}
