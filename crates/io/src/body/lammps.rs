//! Bodies as LAMMPS data files for `atom_style bpm/sphere`, which OVITO also reads.
//!
//! An atom is a particle (`atom-ID molecule-ID atom-type diameter density x y z`), a bond is a bond
//! (`bond-ID bond-type atom1 atom2`); atoms are numbered from 1; one molecule, one type of each; SI
//! units (`units si`). Positions, diameters and the density read back as the same bits. Bond radii
//! and lengths are not stored: LAMMPS computes the lengths from the positions of the atoms, and so
//! does [`read`].
//!
//! [read_data](https://docs.lammps.org/read_data.html),
//! [Howto_bpm](https://docs.lammps.org/Howto_bpm.html)

use std::io::{self, BufRead, Write};

use super::parts::{Body, Parts};
use super::table::particle;
use crate::diagnostic::{Diagnostic, Result};
use crate::lines::{Lines, float, on_line};

/// Density that is written if none is known, kg/m3. LAMMPS requires one.
pub(crate) const DENSITY_IF_UNKNOWN_KG_M3: f64 = 1000.0;

/// Tolerance for different densities of atoms: rounding, as LAMMPS itself computes them from
/// masses.
const DENSITY_TOLERANCE: f64 = 1e-9;

/// Writes a body as LAMMPS data. The box is larger than the body by the largest diameter on each
/// side.
pub fn write(body: &Body, out: &mut dyn Write) -> io::Result<()> {
    let known = body.about.particle_density_kg_m3;
    let density = known.unwrap_or(DENSITY_IF_UNKNOWN_KG_M3);
    let density_note = if known.is_some() {
        ""
    } else {
        "; the density is not known: 1000 kg/m3 stands for it"
    };
    writeln!(
        out,
        "Bonded spheres, units si (m, kg/m3); LAMMPS takes the bond lengths from the positions{density_note}\n\n\
         {} atoms\n{} bonds\n1 atom types\n1 bond types\n",
        body.positions.len(),
        body.bonds.len()
    )?;
    let margin = 2.0 * body.radii.iter().copied().fold(0.0, f64::max);
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (position, radius) in body.positions.iter().zip(&body.radii) {
            low = low.min(position[k] - radius);
            high = high.max(position[k] + radius);
        }
        writeln!(
            out,
            "{:.16e} {:.16e} {axis}lo {axis}hi",
            low - margin,
            high + margin
        )?;
    }
    writeln!(out, "\nAtoms # bpm/sphere\n")?;
    for (number, ([x, y, z], radius)) in (1_u64..).zip(body.positions.iter().zip(&body.radii)) {
        writeln!(
            out,
            "{number} 1 1 {:.16e} {density:.16e} {x:.16e} {y:.16e} {z:.16e}",
            2.0 * radius
        )?;
    }
    if !body.bonds.is_empty() {
        writeln!(out, "\nBonds\n")?;
    }
    for (number, [a, b]) in (1_u64..).zip(&body.bonds) {
        writeln!(
            out,
            "{number} 1 {} {}",
            u64::from(*a) + 1,
            u64::from(*b) + 1
        )?;
    }
    Ok(())
}

/// Reads a body from LAMMPS data as written by `write_data` and [`write()`]. Atoms may be in any
/// order. A bond has the radius of the smaller of its particles and their distance as its length.
/// Velocities, coefficients, molecules and types are ignored.
///
/// # Errors
/// Another atom style, atoms not numbered 1, 2, 3, ..., of several densities or beyond a periodic
/// boundary, wrong counts, an invalid line, or not a body by [`Body::check`].
pub fn read(input: &mut dyn BufRead) -> Result<Body> {
    let mut data = Data::default();
    let mut section = Section::Head;
    let mut lines = Lines::new(input);
    lines.next_line()?;
    while let Some((number, line)) = lines.next_line()? {
        let (text, comment) = line.split_once('#').unwrap_or((line, ""));
        let text = text.trim();
        if text.is_empty() {
            continue;
        }
        let taken = if text.starts_with(|first: char| first.is_ascii_alphabetic()) {
            Section::named(text, comment.trim()).map(|named| section = named)
        } else {
            data.take(&section, text)
        };
        taken.map_err(|error| on_line(number, error))?;
    }
    data.into_body()
}

/// Part of a data file.
enum Section {
    Head,
    Atoms,
    Bonds,
    /// Data that a body does not have.
    Other,
}

impl Section {
    /// From its keyword and the comment after it.
    fn named(name: &str, comment: &str) -> Result<Self> {
        match name {
            "Atoms" if comment.is_empty() || comment == "bpm/sphere" => Ok(Self::Atoms),
            "Atoms" => {
                let problem = format!("the atom style is '{}'", comment.escape_debug());
                Err(Diagnostic::input(
                    "",
                    problem,
                    "write the atoms with atom_style bpm/sphere",
                ))
            }
            "Bonds" => Ok(Self::Bonds),
            _ => Ok(Self::Other),
        }
    }
}

/// The data read so far. Atoms are in the order of the file.
#[derive(Default)]
struct Data {
    atoms: usize,
    bonds: usize,
    /// Counted from 0.
    numbers: Vec<u32>,
    density: Option<f64>,
    parts: Parts,
}

impl Data {
    fn take(&mut self, section: &Section, line: &str) -> Result<()> {
        let mut words = line.split_ascii_whitespace();
        match section {
            Section::Head => self.take_count(line),
            Section::Atoms => self.take_atom(&mut words),
            Section::Bonds => {
                words.nth(1);
                let [a, b] = ["the first atom", "the second atom"]
                    .map(|what| particle(words.next(), what, 1, self.atoms));
                self.parts.bonds.push([a?, b?]);
                Ok(())
            }
            Section::Other => Ok(()),
        }
    }

    fn take_count(&mut self, line: &str) -> Result<()> {
        let Some((count, what)) = line.split_once(|c: char| c.is_ascii_whitespace()) else {
            return Ok(());
        };
        let counted = match what.trim() {
            "atoms" => &mut self.atoms,
            "bonds" => &mut self.bonds,
            _ => return Ok(()),
        };
        *counted = count.parse().map_err(|_| {
            Diagnostic::input(
                "",
                format!(
                    "'{}' is not a number of {}",
                    count.escape_debug(),
                    what.trim()
                ),
                "correct it",
            )
        })?;
        Ok(())
    }

    fn take_atom(&mut self, words: &mut dyn Iterator<Item = &str>) -> Result<()> {
        self.numbers.push(particle(
            words.next(),
            "the number of the atom",
            1,
            self.atoms,
        )?);
        let mut words = words.skip(2);
        let [diameter, density, x, y, z] =
            ["the diameter", "the density", "x", "y", "z"].map(|what| float(words.next(), what));
        self.parts.positions.push([x?, y?, z?]);
        self.parts.radii.push(0.5 * diameter?);
        if words.any(|image| image != "0") {
            let problem = "the atom has gone through a periodic boundary";
            return Err(Diagnostic::input(
                "",
                problem,
                "write the data with fixed or shrink-wrapped boundaries",
            ));
        }
        let density = density?;
        let first = *self.density.get_or_insert(density);
        if (density - first).abs() <= DENSITY_TOLERANCE * first.abs() {
            return Ok(());
        }
        let problem =
            format!("the density is {density:e}, but that of the first atom is {first:e}");
        Err(Diagnostic::input(
            "",
            problem,
            "a body has particles of one density: 'set group all density ...'",
        ))
    }

    fn into_body(mut self) -> Result<Body> {
        for (what, found, wanted) in [
            ("atoms", self.numbers.len(), self.atoms),
            ("bonds", self.parts.bonds.len(), self.bonds),
        ] {
            if found != wanted {
                let problem = format!("{found} {what}, but the head of the file says {wanted}");
                return Err(Diagnostic::input(
                    "",
                    problem,
                    "it may be cut off: write or copy it again",
                ));
            }
        }
        self.sort()?;
        self.parts.about.particle_density_kg_m3 = self.density;
        Body::from_parts(self.parts)
    }

    /// Sorts the atoms by their numbers.
    fn sort(&mut self) -> Result<()> {
        if self.numbers.is_sorted_by(|a, b| a < b) {
            return Ok(());
        }
        const NONE: usize = usize::MAX;
        let mut places = vec![NONE; self.numbers.len()];
        for (place, &number) in self.numbers.iter().enumerate() {
            let slot = &mut places[number as usize];
            if *slot != NONE {
                let problem = format!("two atoms have the number {}", u64::from(number) + 1);
                return Err(Diagnostic::input(
                    "",
                    problem,
                    "number the atoms 1, 2, 3, ...: 'reset_atoms id'",
                ));
            }
            *slot = place;
        }
        self.parts.positions = places
            .iter()
            .map(|&place| self.parts.positions[place])
            .collect();
        self.parts.radii = places
            .iter()
            .map(|&place| self.parts.radii[place])
            .collect();
        Ok(())
    }
}
