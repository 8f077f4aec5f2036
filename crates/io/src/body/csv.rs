//! Bodies as a pair of CSV files for spreadsheets and scripts: `cake.particles.csv` and
//! `cake.bonds.csv`.
//!
//! The first line names the columns and their units: `x_m,y_m,z_m,radius_m` and
//! `particle_a,particle_b,bond_radius_m,initial_length_m`. The ends `particle_a` and `particle_b`
//! of a bond are particle indices, counted from 0 in the order of their file. Every number reads
//! back as the same bits. [`About`](super::About) is not stored.

use std::io::{self, BufRead, Write};

use super::check::{check_different, check_particle, check_positive};
use super::parts::{Body, Parts};
use super::table::{in_table, particle, pick};
use crate::diagnostic::{Diagnostic, Result};
use crate::lines::{Lines, float, on_line};

const PARTICLE_COLUMNS: [&str; 4] = ["x_m", "y_m", "z_m", "radius_m"];
const BOND_COLUMNS: [&str; 4] = [
    "particle_a",
    "particle_b",
    "bond_radius_m",
    "initial_length_m",
];

/// Writes the file of the particles.
pub fn write_particles(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}", PARTICLE_COLUMNS.join(","))?;
    for ([x, y, z], radius) in body.positions.iter().zip(&body.radii) {
        writeln!(out, "{x:e},{y:e},{z:e},{radius:e}")?;
    }
    Ok(())
}

/// Writes the file of the bonds.
pub fn write_bonds(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}", BOND_COLUMNS.join(","))?;
    for (([a, b], radius), length) in body
        .bonds
        .iter()
        .zip(&body.bond_radii)
        .zip(&body.bond_lengths)
    {
        writeln!(out, "{a},{b},{radius:e},{length:e}")?;
    }
    Ok(())
}

/// Reads a body from its two files. Columns may be in any order; others are ignored. Without the
/// column `bond_radius_m` a bond has the radius of the smaller of its particles, without
/// `initial_length_m` their distance as its length.
///
/// # Errors
/// A missing column, an invalid or cut-off line, or not a body by [`Body::check`].
pub fn read(particles: &mut dyn BufRead, bonds: &mut dyn BufRead) -> Result<Body> {
    let mut parts = Parts::default();
    read_particles(particles, &mut parts).map_err(|error| error.within("particles"))?;
    read_bonds(bonds, &mut parts).map_err(|error| error.within("bonds"))?;
    Body::from_parts(parts).map_err(in_table)
}

fn read_particles(input: &mut dyn BufRead, parts: &mut Parts) -> Result<()> {
    let mut lines = Lines::new(input);
    let columns = read_columns(&mut lines, PARTICLE_COLUMNS, 4)?;
    while let Some((number, line)) = lines.next_line()? {
        if line.is_empty() {
            continue;
        }
        let words = pick(line, columns);
        let mut values = [0.0; 4];
        for k in 0..4 {
            values[k] =
                float(words[k], PARTICLE_COLUMNS[k]).map_err(|error| on_line(number, error))?;
        }
        let [x, y, z, radius] = values;
        check_particle(&[x, y, z], radius).map_err(|error| on_line(number, error))?;
        parts.positions.push([x, y, z]);
        parts.radii.push(radius);
    }
    Ok(())
}

fn read_bonds(input: &mut dyn BufRead, parts: &mut Parts) -> Result<()> {
    let mut lines = Lines::new(input);
    let columns = read_columns(&mut lines, BOND_COLUMNS, 2)?;
    let [_, _, radius_column, length_column] = columns;
    let particles = parts.positions.len();
    let (mut radii, mut lengths) = (Vec::new(), Vec::new());
    while let Some((number, line)) = lines.next_line()? {
        if line.is_empty() {
            continue;
        }
        let [a, b, radius, length] = pick(line, columns);
        let mut read_line = || {
            let [a, b] = [
                particle(a, "particle_a", 0, particles)?,
                particle(b, "particle_b", 0, particles)?,
            ];
            check_different(a, b)?;
            parts.bonds.push([a, b]);
            if radius_column.is_some() {
                let radius = float(radius, "bond_radius_m")?;
                check_positive(radius, "radius")?;
                radii.push(radius);
            }
            if length_column.is_some() {
                let length = float(length, "initial_length_m")?;
                check_positive(length, "initial length")?;
                lengths.push(length);
            }
            Ok(())
        };
        read_line().map_err(|error| on_line(number, error))?;
    }
    parts.bond_radii = radius_column.map(|_| radii);
    parts.bond_lengths = length_column.map(|_| lengths);
    Ok(())
}

/// The positions of the columns, from the first line. The first `required` of them must be present.
fn read_columns<const N: usize>(
    lines: &mut Lines<'_>,
    names: [&str; N],
    required: usize,
) -> Result<[Option<usize>; N]> {
    let (_, line) = lines.next_line()?.unwrap_or((1, ""));
    let columns = names.map(|name| line.split(',').position(|column| column.trim() == name));
    match (0..required).find(|&k| columns[k].is_none()) {
        None => Ok(columns),
        Some(k) => Err(Diagnostic::input(
            "line 1",
            format!("there is no column '{}'", names[k]),
            format!("the first line names the columns: {}", names.join(",")),
        )),
    }
}
