//! Bodies as VTK XML PolyData (.vtp), which ParaView and PyVista open directly.
//!
//! Layout: points = particles (Float64, m), lines = bonds (two points each), point data `radius_m`
//! and, of a strained body, `rotation_rad`, cell data `bond_radius_m`, `initial_length_m` and, if
//! bonds are damaged, `damage`, `initial_direction` if they are sheared or bent, and the columns of
//! [`super::histories`] of what they have been through; field data: `body_format_version`,
//! `length_unit` and one array for each known field of [`About`]. For the encoding see
//! [`crate::vtk`].

mod names;
mod read;
mod shapes;
mod stored;

pub use names::FORMAT_VERSION;
pub use read::read;
pub(crate) use stored::{read_frame, read_particles, read_walls};

use std::io::{self, Write};

use names::{
    BOND_RANGE, LENGTH_UNIT, METRE, OVERLAP, PARTICLE_DENSITY, PARTICLES_ACROSS, PROGRAM, SEED,
    SHAPE_VOLUME, SOURCE, SOURCE_HASH, THINNEST_PART, VERSION, WARNINGS,
};

use super::histories::{BondColumn, DIRECTION};
use super::parts::{About, Body};
use super::stored_frame::{BOND_LENGTH, BOND_RADIUS, DAMAGE, RADIUS, TURN};
use crate::vtk::{
    Cells, NamedArray, PolyData, Values, exact, write_number, write_text, write_texts,
};

/// Writes a body as .vtp. It must follow the rules of [`Body::check`].
pub fn write(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    let array = |name, value| NamedArray {
        name,
        values: Values::Scalars(value),
    };
    let radius = |i: usize| body.radii[i];
    let bond_radius = |bond: usize| body.bond_radii[bond];
    let bond_length = |bond: usize| body.bond_lengths[bond];
    let damage = |bond: usize| body.bond_damages[bond];
    let mut of_bonds = vec![
        array(BOND_RADIUS, &bond_radius),
        array(BOND_LENGTH, &bond_length),
    ];
    // None: all bonds are intact.
    if !body.bond_damages.is_empty() {
        of_bonds.push(array(DAMAGE, &damage));
    }
    let turn = |i: usize| body.turns_rad[i];
    let mut of_particles = vec![array(RADIUS, &radius)];
    if !body.turns_rad.is_empty() {
        of_particles.push(NamedArray {
            name: TURN,
            values: Values::Vectors(&turn),
        });
    }
    let direction = |bond: usize| body.bond_directions[bond];
    if !body.bond_directions.is_empty() {
        of_bonds.push(NamedArray {
            name: DIRECTION,
            values: Values::Vectors(&direction),
        });
    }
    of_bonds.extend(body.bond_histories.iter().map(BondColumn::array));
    PolyData {
        points: body.positions.len(),
        place: Values::Vectors(&|i| body.positions[i]),
        cells: Cells::Lines(body.bonds.len(), &|bond| body.bonds[bond]),
        point_data: &of_particles,
        cell_data: &of_bonds,
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
    let thinnest_m = about.thinnest_part_m.map(exact);
    write_number(out, "Float64", THINNEST_PART, thinnest_m)?;
    let across = about.particles_across.map(exact);
    write_number(out, "Float64", PARTICLES_ACROSS, across)?;
    write_texts(out, WARNINGS, &about.warnings)
}
