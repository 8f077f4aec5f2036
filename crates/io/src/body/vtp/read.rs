//! The arrays of a .vtp file as a body.

use std::io::BufRead;

use super::names::{
    BOND_RANGE, FORMAT_VERSION, LENGTH_UNIT, METRE, OVERLAP, PARTICLE_DENSITY, PARTICLES_ACROSS,
    PROGRAM, SEED, SHAPE_VOLUME, SOURCE, SOURCE_HASH, THINNEST_PART, VERSION, WARNINGS,
};
use super::shapes::{BOND_ENDS, BOND_OFFSETS, POSITIONS, of_body, of_cells, of_points};
use crate::body::histories::{self, DIRECTION};
use crate::body::parts::{About, Body, Parts};
use crate::body::stored_frame::{BOND_LENGTH, BOND_RADIUS, BROKEN, DAMAGE, RADIUS, TURN};
use crate::diagnostic::{Diagnostic, Result};
use crate::vtp::{Arrays, DAMAGED, Reader, check_count};

/// Reads a body from a .vtp file, which ends with the input.
///
/// Files of other programs are read too, in any uncompressed encoding, if each line has two points
/// and there is point data `radius`. Without cell data `bond_radius` a bond has the radius of the
/// smaller of its particles; without `bond_initial_length` their distance as its length. Other
/// arrays are ignored.
///
/// # Errors
/// Damaged or cut off, a later version, compressed, wrong counts, or not a body by [`Body::check`].
pub fn read(input: &mut dyn BufRead) -> Result<Body> {
    let file = Reader::open(input, &of_body)?;
    // A later version may have other arrays; of other programs, fields may follow the header.
    check_version(file.arrays())?;
    let mut arrays = file.read()?;
    check_version(&arrays)?;
    check_unit(&arrays)?;
    let about = about(&arrays)?;
    let parts = particles_and_bonds(&mut arrays)?;
    if arrays.take(&of_cells(BROKEN)).is_some() {
        return Err(Diagnostic::input(
            "",
            "this is a frame of a run, whose bonds may be broken",
            "write one of its fragments as a body: dem-run fragment RESULTS --largest -o piece.vtp",
        ));
    }
    let Some(radii) = arrays.take(&of_points(RADIUS)) else {
        let known = match arrays.point_data() {
            [] => "there are no point data".to_owned(),
            names => format!("the point data are '{}'", names.join("', '")),
        };
        return Err(Diagnostic::input(
            "",
            format!("the radii of the particles are missing: {known}"),
            format!("name the point data that hold them '{RADIUS}'"),
        ));
    };
    Body::from_parts(Parts {
        radii,
        about,
        ..parts
    })
}

fn about(arrays: &Arrays) -> Result<About> {
    Ok(About {
        program: arrays.text(PROGRAM)?,
        source: arrays.text(SOURCE)?,
        source_hash: arrays.whole(SOURCE_HASH)?,
        shape_volume_m3: arrays.float(SHAPE_VOLUME),
        particle_density_kg_m3: arrays.float(PARTICLE_DENSITY),
        overlap: arrays.float(OVERLAP),
        bond_range: arrays.float(BOND_RANGE),
        seed: arrays.whole(SEED)?,
        thinnest_part_m: arrays.float(THINNEST_PART),
        particles_across: arrays.float(PARTICLES_ACROSS),
        warnings: arrays.texts(WARNINGS)?,
    })
}

/// What bodies and frames have in common, but for the radii.
pub(super) fn particles_and_bonds(arrays: &mut Arrays) -> Result<Parts> {
    let counts = arrays.counts();
    let ends = arrays.take_indices(BOND_ENDS)?.unwrap_or_default();
    let (bonds, positions) = (ends.as_chunks().0.to_vec(), arrays.take_vectors(POSITIONS));
    check_count(positions.len() as u64, counts.points.into(), "points")?;
    check_count(bonds.len() as u64, counts.lines.into(), "lines")?;
    check_line_ends(arrays, counts.lines)?;
    Ok(Parts {
        positions,
        turns_rad: arrays.take_vectors(&of_points(TURN)),
        bond_radii: arrays.take(&of_cells(BOND_RADIUS)),
        bond_lengths: arrays.take(&of_cells(BOND_LENGTH)),
        bond_directions: arrays.take_vectors(&of_cells(DIRECTION)),
        bond_damages: arrays.take(&of_cells(DAMAGE)).unwrap_or_default(),
        bond_histories: histories::take(arrays, bonds.len()),
        bonds,
        ..Parts::default()
    })
}

/// Checks that each line has two points.
fn check_line_ends(arrays: &Arrays, lines: u64) -> Result<()> {
    let Some(offsets) = arrays.named().get(BOND_OFFSETS) else {
        return check_count(0, lines.into(), "offsets of lines");
    };
    let mut ends = offsets.values.iter().zip(1_u32..);
    let wrong = ends.position(|(end, line)| !offsets.is_whole || *end != 2.0 * f64::from(line));
    match wrong {
        None => Ok(()),
        Some(line) => {
            let problem = format!("line {line} does not have two points");
            let remedy = "a bond joins two: save each bond as a line of its own";
            Err(Diagnostic::input("array 'offsets'", problem, remedy))
        }
    }
}

fn check_version(arrays: &Arrays) -> Result<()> {
    if !arrays.has_field(VERSION) {
        return Ok(());
    }
    let [problem, remedy] = match arrays.whole(VERSION) {
        Ok(Some(FORMAT_VERSION)) => return Ok(()),
        Ok(Some(version)) if version > FORMAT_VERSION => [
            &format!("the body has format version {version}; this program knows {FORMAT_VERSION}"),
            "use a newer program, or write the body with an older one",
        ],
        _ => ["the format version makes no sense", DAMAGED],
    };
    Err(Diagnostic::input(
        format!("array '{VERSION}'"),
        problem,
        remedy,
    ))
}

fn check_unit(arrays: &Arrays) -> Result<()> {
    match arrays.text(LENGTH_UNIT)? {
        Some(unit) if unit != METRE => Err(Diagnostic::input(
            format!("array '{LENGTH_UNIT}'"),
            format!("the length unit is '{unit}', not '{METRE}'"),
            "convert the lengths to metres",
        )),
        _ => Ok(()),
    }
}
