//! `dem-run units`: the units that are known.

use dem_io::Result;
use dem_io::units::DIMENSIONS;
use dem_terminal::standard_output::write_standard_output;

/// Prints the units of each dimension, one dimension in a line.
pub(super) fn print_units() -> Result<()> {
    write_standard_output(|out| {
        for dimension in DIMENSIONS {
            let units: Vec<&str> = dimension.units.iter().map(|(unit, _)| *unit).collect();
            writeln!(out, "{}: {}", dimension.name, units.join(", "))?;
        }
        Ok(())
    })
}
