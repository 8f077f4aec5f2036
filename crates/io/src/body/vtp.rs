//! Bodies as VTK XML PolyData (.vtp), which ParaView and PyVista open directly.
//!
//! Layout: points = particles (Float64, m), lines = bonds (two points each), point data `radius_m`,
//! cell data `bond_radius_m`, `initial_length_m` and, if bonds are damaged, `damage`, field data:
//! `body_format_version`, `length_unit` and one array for each known field of [`About`]. For the
//! encoding see [`crate::vtk`].

mod contents;
mod decode;
mod guard;
mod header;
mod names;
mod numbers;
mod read;
mod walls;

pub use names::FORMAT_VERSION;
pub use read::read;
pub(crate) use read::{read_frame, read_particles, read_walls};

use std::io::{self, Write};

use names::{
    BOND_LENGTH, BOND_RADIUS, BOND_RANGE, LENGTH_UNIT, METRE, OVERLAP, PARTICLE_DENSITY, PROGRAM,
    RADIUS, SEED, SHAPE_VOLUME, SOURCE, SOURCE_HASH, VERSION, WARNINGS,
};

use super::parts::{About, Body};
use super::stored_frame::DAMAGE;
use crate::vtk::{
    Cells, NamedArray, PolyData, Values, exact, write_number, write_text, write_texts,
};

/// Writes a body as .vtp. It must follow the rules of [`Body::check`].
///
/// # Errors
/// Those of `out`.
pub fn write(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    let array = |name, value| NamedArray {
        name,
        values: Values::Scalars(value),
    };
    // No damages: all bonds are intact.
    let of_bonds = if body.bond_damages.is_empty() { 2 } else { 3 };
    PolyData {
        points: body.positions.len(),
        place: Values::Vectors(&|i| body.positions[i]),
        cells: Cells::Lines(body.bonds.len(), &|bond| body.bonds[bond]),
        point_data: &[array(RADIUS, &|i| body.radii[i])],
        cell_data: &[
            array(BOND_RADIUS, &|bond| body.bond_radii[bond]),
            array(BOND_LENGTH, &|bond| body.bond_lengths[bond]),
            array(DAMAGE, &|bond| body.bond_damages[bond]),
        ][..of_bonds],
    }
    .write(out, |out| write_fields(&body.about, out))
}

fn write_fields(about: &About, out: &mut dyn Write) -> io::Result<()> {
    write_number(out, "UInt64", VERSION, Some(FORMAT_VERSION))?;
    write_text(out, LENGTH_UNIT, Some(METRE))?;
    write_text(out, PROGRAM, about.program.as_deref())?;
    write_text(out, SOURCE, about.source.as_deref())?;
    write_number(out, "UInt64", SOURCE_HASH, about.source_hash)?;
    write_number(
        out,
        "Float64",
        SHAPE_VOLUME,
        about.shape_volume_m3.map(exact),
    )?;
    write_number(
        out,
        "Float64",
        PARTICLE_DENSITY,
        about.particle_density_kg_m3.map(exact),
    )?;
    write_number(out, "Float64", OVERLAP, about.overlap.map(exact))?;
    write_number(out, "Float64", BOND_RANGE, about.bond_range.map(exact))?;
    write_number(out, "UInt64", SEED, about.seed)?;
    write_texts(out, WARNINGS, &about.warnings)
}
