//! Bodies as VTK XML PolyData (.vtp), which ParaView and PyVista open as they stand.
//!
//! Layout: points = particles (Float64, m), lines = bonds (two points each), point data `radius`, cell data `bond_radius`
//! and `bond_initial_length` (m), field data: `body_format_version`, `length_unit` and one array for each known field of
//! [`About`]. How it is encoded, [`crate::vtk`] says.

mod contents;
mod decode;
mod guard;
mod header;
mod read;

pub use read::read;
pub(crate) use read::read_frame;

use std::io::{self, Write};

use super::{About, Body};
use crate::vtk::{NamedArray, PolyData, Values, exact, write_number, write_text, write_texts};

/// Version of this layout. Files of a later one are refused.
pub const FORMAT_VERSION: u64 = 1;

const RADIUS: &str = "radius";
const BOND_RADIUS: &str = "bond_radius";
const BOND_LENGTH: &str = "bond_initial_length";
const VERSION: &str = "body_format_version";
const LENGTH_UNIT: &str = "length_unit";
const METRE: &str = "m";

/// Names of the field data, in the order of [`About`].
const PROGRAM: &str = "program";
const SOURCE: &str = "source";
const SOURCE_HASH: &str = "source_hash";
const SHAPE_VOLUME: &str = "shape_volume_m3";
const PARTICLE_DENSITY: &str = "particle_density_kg_m3";
const OVERLAP: &str = "overlap";
const BONDING_RADIUS: &str = "bonding_radius";
const SEED: &str = "seed";
const WARNINGS: &str = "warnings";

/// Writes a body as .vtp. It must keep the rules of [`Body::check`].
///
/// # Errors
/// Those of `out`.
pub fn write(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    let array = |name, value| NamedArray {
        name,
        values: Values::Scalars(value),
    };
    PolyData {
        points: body.positions.len(),
        place: &|i| body.positions[i],
        lines: body.bonds.len(),
        ends: &|bond| body.bonds[bond],
        point_data: &[array(RADIUS, &|i| body.radii[i])],
        cell_data: &[
            array(BOND_RADIUS, &|bond| body.bond_radii[bond]),
            array(BOND_LENGTH, &|bond| body.bond_lengths[bond]),
        ],
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
    write_number(
        out,
        "Float64",
        BONDING_RADIUS,
        about.bonding_radius.map(exact),
    )?;
    write_number(out, "UInt64", SEED, about.seed)?;
    write_texts(out, WARNINGS, &about.warnings)
}
