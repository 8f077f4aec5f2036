//! Bodies as the two text files of Platzer 2022, algorithm 1: `cake.particles.txt` and
//! `cake.bonds.txt`.  Their layout is not printed there. This is the simplest: one line per
//! particle with x, y, z and radius in m, and one line per bond with the numbers of its two
//! particles, counted from 1 as in MATLAB, without a header line. Positions and radii read back as
//! the same bits. Bond radii, bond lengths and [`About`](super::About) are not stored.

use std::io::{self, BufRead, Write};

use super::check::check_particle;
use super::parts::{Body, Parts};
use super::table::{in_table, particle};
use crate::diagnostic::{Diagnostic, Result};
use crate::lines::{Lines, float, on_line};

/// Writes the file of the particles.
pub fn write_particles(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    for ([x, y, z], radius) in body.positions.iter().zip(&body.radii) {
        writeln!(out, "{x:e} {y:e} {z:e} {radius:e}")?;
    }
    Ok(())
}

/// Writes the file of the bonds.
pub fn write_bonds(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    for [a, b] in &body.bonds {
        writeln!(out, "{} {}", u64::from(*a) + 1, u64::from(*b) + 1)?;
    }
    Ok(())
}

/// Reads a body from its two files. There may be commas between the numbers; lines that begin with
/// % or # are ignored. A bond has the radius of the smaller of its particles and their distance as
/// its length.
///
/// # Errors
/// An invalid or cut-off line, or not a body by [`Body::check`].
pub fn read(particles: &mut dyn BufRead, bonds: &mut dyn BufRead) -> Result<Body> {
    let mut parts = Parts::default();
    each_line(particles, |words| {
        let [x, y, z, radius] = ["x", "y", "z", "the radius"].map(|what| float(words.next(), what));
        let (position, radius) = ([x?, y?, z?], radius?);
        check_particle(&position, radius)?;
        parts.positions.push(position);
        parts.radii.push(radius);
        Ok(())
    })
    .map_err(|error| error.within("particles"))?;
    let count = parts.positions.len();
    each_line(bonds, |words| {
        let [a, b] = ["the first particle", "the second particle"]
            .map(|what| particle(words.next(), what, 1, count));
        parts.bonds.push([a?, b?]);
        Ok(())
    })
    .map_err(|error| error.within("bonds"))?;
    Body::from_parts(parts).map_err(in_table)
}

/// Passes the words of each line to `take`, which must use all of them.
fn each_line(
    input: &mut dyn BufRead,
    mut take: impl FnMut(&mut dyn Iterator<Item = &str>) -> Result<()>,
) -> Result<()> {
    let mut lines = Lines::new(input);
    while let Some((number, line)) = lines.next_line()? {
        if line.is_empty() || line.starts_with(['%', '#']) {
            continue;
        }
        let mut words = line.split([' ', '\t', ',']).filter(|word| !word.is_empty());
        take(&mut words).map_err(|error| on_line(number, error))?;
        if let Some(word) = words.next() {
            let problem = format!("'{}' is one number too many", word.escape_debug());
            return Err(on_line(
                number,
                Diagnostic::input("", problem, "correct this line"),
            ));
        }
    }
    Ok(())
}
