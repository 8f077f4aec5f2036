//! Mass flows over time and the cells of mixtures, as CSV tables that are written at the end of a
//! run. Every number reads back as the same bits.

use std::path::Path;

use super::growing::field;
use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;
use dem_io::text::exact;

/// The first line of the table of mass flows.
pub const FLOW_COLUMNS: &str = "time_s,body,outlet,pieces,mass_kg,flow_kg_s";

/// The first line of the table of mixtures.
pub const MIXING_COLUMNS: &str = "measure,x_m,y_m,z_m,mass_kg,fraction";

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

/// Writes mass flows to the file `path`, completely or not at all.
pub fn write_flows(path: &Path, rows: &[FlowRow<'_>]) -> Result<()> {
    write_file(path, |out| {
        writeln!(out, "{FLOW_COLUMNS}")?;
        for row in rows {
            writeln!(
                out,
                "{},{},{},{},{},{}",
                exact(row.time_s),
                field(row.body),
                field(row.outlet),
                row.pieces,
                exact(row.mass_kg),
                exact(row.flow_kg_s)
            )?;
        }
        Ok(())
    })
}

/// Writes the cells of mixtures to the file `path`, completely or not at all.
pub fn write_mixing(path: &Path, rows: &[MixingRow<'_>]) -> Result<()> {
    write_file(path, |out| {
        writeln!(out, "{MIXING_COLUMNS}")?;
        for row in rows {
            let [x, y, z] = row.centre_m.map(exact);
            writeln!(
                out,
                "{},{x},{y},{z},{},{}",
                field(row.measure),
                exact(row.mass_kg),
                exact(row.fraction)
            )?;
        }
        Ok(())
    })
}
