//! The particles and bonds of an export, as its data file has them, and those that inlets feed.

use std::collections::HashMap;
use std::path::Path;

use dem_io::{Diagnostic, Result, read_input};

use super::dump::Section;
use super::files::{DATA, MANIFEST, Manifest};

/// Relative difference of two radii that are the same.
const SAME: f64 = 1e-9;

/// The particles and bonds of an export, from its data file, and those fed by now. Particles in the
/// order of their ids.
#[derive(Debug, Default)]
pub(super) struct Exported {
    /// Ids in LAMMPS, from 1, ascending.
    pub ids: Vec<u64>,
    pub molecules: Vec<u32>,
    pub radii_m: Vec<f64>,
    pub densities_kg_m3: Vec<f64>,
    /// Of the particles of the start, m.
    pub places_m: Vec<[f64; 3]>,
    /// Numbers of the two particles: the bonds of each body in the order of its file.
    pub bonds: Vec<[u32; 2]>,
    /// Types, from 1.
    pub bond_types: Vec<usize>,
    /// The number of the bond between two atoms, by their ids, the smaller first.
    bond_of: HashMap<[u64; 2], usize>,
    /// For each molecule of the start its first id, and its first bond.
    first_of: HashMap<u32, (u64, usize)>,
}

/// A bond by the numbers of the file of its body.
pub(super) struct InFile {
    /// Its molecule, from 1.
    pub molecule: u32,
    /// Its number.
    pub bond: u64,
    /// Numbers of its particles, the smaller first.
    pub particles: [u64; 2],
}

/// Reads the data file of an export.
pub(super) fn read_data(path: &Path) -> Result<Exported> {
    let text = read_input(path, "the data file of an export")?;
    let text = String::from_utf8_lossy(&text);
    let mut exported = Exported::default();
    let mut section = "";
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or("").trim();
        if line.starts_with(|first: char| first.is_ascii_alphabetic()) {
            section = match line {
                "Atoms" => "Atoms",
                "Bonds" => "Bonds",
                _ => "",
            };
            continue;
        }
        if section.is_empty() || line.is_empty() {
            continue;
        }
        let words: Vec<f64> = line
            .split_ascii_whitespace()
            .filter_map(|w| w.parse().ok())
            .collect();
        let taken = match (section, words.as_slice()) {
            ("Atoms", &[id, molecule, _, diameter, density, x, y, z]) => {
                exported.ids.push(id as u64);
                exported.molecules.push(molecule as u32);
                exported.radii_m.push(0.5 * diameter);
                exported.densities_kg_m3.push(density);
                exported.places_m.push([x, y, z]);
                let last_two = &exported.ids[exported.ids.len().saturating_sub(2)..];
                last_two.is_sorted_by(|a, b| a < b) && diameter > 0.0 && density > 0.0
            }
            ("Bonds", &[_, of, a, b]) => {
                exported.bond_types.push(of as usize);
                let ends = [a, b].map(|end| exported.number_of(end as u64));
                let known = ends.into_iter().all(|end| end.is_some());
                exported.bonds.push(ends.map(Option::unwrap_or_default));
                known
            }
            _ => false,
        };
        if !taken {
            return Err(Diagnostic::input(
                format!("{}: line {number}", path.display()),
                format!("this is not a line of the section {section} of an export"),
                "export the scene again",
            ));
        }
    }
    let numbers = 0..exported.bonds.len();
    exported.bond_of = numbers
        .clone()
        .map(|at| (exported.atoms_of(at), at))
        .collect();
    for (id, molecule) in exported.ids.iter().zip(&exported.molecules) {
        exported
            .first_of
            .entry(*molecule)
            .or_insert((*id, usize::MAX));
    }
    for at in numbers {
        let molecule = exported.molecule_of(at);
        if let Some((_, first)) = exported.first_of.get_mut(&molecule) {
            *first = at.min(*first);
        }
    }
    Ok(exported)
}

impl Exported {
    /// The ids in LAMMPS of the ends of a bond, the smaller first.
    pub(super) fn atoms_of(&self, bond: usize) -> [u64; 2] {
        let [a, b] = self.bonds[bond].map(|end| self.ids[end as usize]);
        [a.min(b), a.max(b)]
    }

    fn molecule_of(&self, bond: usize) -> u32 {
        self.molecules[self.bonds[bond][0] as usize]
    }

    /// A bond by the numbers of the file of its body.
    pub(super) fn in_file(&self, bond: usize) -> InFile {
        let molecule = self.molecule_of(bond);
        let (first_id, first_bond) = self.first_of.get(&molecule).copied().unwrap_or_default();
        InFile {
            molecule,
            bond: bond.saturating_sub(first_bond) as u64,
            particles: self.atoms_of(bond).map(|id| id.saturating_sub(first_id)),
        }
    }

    /// The number of the bond between the atoms that two columns of a row have.
    pub(super) fn bond_between(&self, atoms: [f64; 2], section: &Section) -> Result<usize> {
        let [a, b] = [atoms[0].min(atoms[1]), atoms[0].max(atoms[1])];
        let known = self.bond_of.get(&[a as u64, b as u64]).copied();
        let is_whole = a.fract() == 0.0 && b.fract() == 0.0;
        known.filter(|_| is_whole).ok_or_else(|| {
            section.refused(
                format!("{DATA} has no bond of the atoms {a} and {b}"),
                "import the dump into the folder of its own export, or run LAMMPS again",
            )
        })
    }

    /// For each row of a section the number of its particle: each is there once, with the molecule
    /// and the radius that it had at the start.
    pub(super) fn numbers_of(&self, section: &Section) -> Result<Vec<u32>> {
        let remedy = "import the dump into the folder of its own export, or run LAMMPS again";
        let refuse = |problem: String| Err(section.refused(problem, remedy));
        let [id, molecule, radius] = section.find(["id", "mol", "radius"])?;
        let mut is_there = vec![false; self.ids.len()];
        let mut numbers = Vec::with_capacity(section.rows.len());
        for row in &section.rows {
            let known = self
                .number_of(row[id] as u64)
                .filter(|_| row[id].fract() == 0.0);
            let Some(number) = known else {
                return refuse(format!("atom {} is not in {DATA}", row[id]));
            };
            let i = number as usize;
            if std::mem::replace(&mut is_there[i], true) {
                return refuse(format!("atom {} is there twice", row[id]));
            }
            let (of, radius_m) = (self.molecules[i], self.radii_m[i]);
            if row[molecule] != f64::from(of) {
                let problem = format!("is of molecule {}, not {of}", row[molecule]);
                return refuse(format!("atom {} {problem}", row[id]));
            }
            if (row[radius] - radius_m).abs() > SAME * radius_m {
                let problem = format!("has a radius of {} m, not {radius_m} m", row[radius]);
                return refuse(format!("atom {} {problem}", row[id]));
            }
            numbers.push(number);
        }
        match is_there.iter().position(|is_there| !is_there) {
            Some(missing) => refuse(format!("atom {} is missing", self.ids[missing])),
            None => Ok(numbers),
        }
    }

    /// The number of the particle with this id in LAMMPS.
    fn number_of(&self, id: u64) -> Option<u32> {
        self.ids.binary_search(&id).ok().map(|at| at as u32)
    }

    /// Takes atoms that inlets have fed since the last section: their molecules and radii from the
    /// dump, the rest from the description of their type.
    pub(super) fn take_fed(&mut self, manifest: &mut Manifest, section: &Section) -> Result<()> {
        if manifest.fed.is_empty() {
            return Ok(());
        }
        let [id, molecule, of, radius] = section.find(["id", "mol", "type", "radius"])?;
        let most = manifest.body_of_molecule.len() + section.rows.len();
        for row in &section.rows {
            let last = self.ids.last().copied().unwrap_or(0);
            let atom_type = row[of] as u64;
            let fed = manifest.fed.iter().find(|fed| fed.atom_type == atom_type);
            let (Some(fed), true) = (fed, row[id] as u64 > last) else {
                continue;
            };
            let number = row[molecule] as usize;
            let remedy = "keep the fix deposit of the exported script";
            let refuse = |problem: String| Err(section.refused(problem, remedy));
            if !(1..=most).contains(&number) {
                let problem = format!("atom {} is of molecule {}", row[id], row[molecule]);
                return refuse(problem);
            }
            if row[radius] <= 0.0 {
                return refuse(format!(
                    "atom {} has a radius of {} m",
                    row[id], row[radius]
                ));
            }
            if manifest.body_of_molecule.len() < number {
                manifest.body_of_molecule.resize(number, fed.body);
                manifest.is_clump.resize(number, fed.is_clump);
            }
            manifest.body_of_molecule[number - 1] = fed.body;
            manifest.is_clump[number - 1] = fed.is_clump;
            self.ids.push(row[id] as u64);
            self.molecules.push(number as u32);
            self.radii_m.push(row[radius]);
            self.densities_kg_m3.push(fed.density_kg_m3);
        }
        Ok(())
    }

    /// The length of a bond at the start, m.
    pub(super) fn length_m(&self, bond: usize) -> f64 {
        let [a, b] = self.bonds[bond].map(|end| self.places_m[end as usize]);
        [0, 1, 2]
            .map(|k| b[k] - a[k])
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    }
}

/// Refuses a data file and a description that do not belong together.
pub(super) fn refuse_strangers(
    folder: &Path,
    manifest: &Manifest,
    exported: &Exported,
) -> Result<()> {
    let molecules = manifest.body_of_molecule.len();
    let is_known = |molecule: &u32| (1..=molecules).contains(&(*molecule as usize));
    let bodies = manifest.bodies.len();
    let types = manifest.bond_radii_m.len();
    let belong = exported.molecules.iter().all(is_known)
        && (manifest.body_of_molecule.iter())
            .chain(manifest.fed.iter().map(|fed| &fed.body))
            .all(|body| (*body as usize) < bodies)
        && exported
            .bond_types
            .iter()
            .all(|of| (1..=types).contains(of));
    if belong {
        return Ok(());
    }
    Err(Diagnostic::input(
        folder.display().to_string(),
        format!("{DATA} and {MANIFEST} do not belong together"),
        "export the scene again",
    ))
}
