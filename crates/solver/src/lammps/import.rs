//! The way back: dumps of an exported run as frames, with a page.

use std::collections::{BTreeMap, HashSet};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use dem_io::body::mass::volume_m3;
use dem_io::body::stored_frame::{
    BODY, BOND_LENGTH, BOND_RADIUS, BROKEN, DENSITY, FRAGMENT_ID, PARTICLE_ID, RADIUS, VELOCITY,
};
use dem_io::disjoint::DisjointSets;
use dem_io::safe_write::write_file;
use dem_io::{Diagnostic, Result, read_input};
use dem_report::report;
use dem_results::{
    Existing, Frame, FrameFiles, NamedArray, ResultsFolder, Values, WallFiles, WallFrame,
    WallTriangles, write_json,
};
use serde_json::json;

use super::dump::{Dump, Section};
use super::files::{BONDS, DATA, FRAMES, MANIFEST, Manifest};

/// The particles and bonds of an export, from its data file, and those fed by now. Particles in the
/// order of their ids.
#[derive(Debug, Default)]
struct Exported {
    /// Ids in LAMMPS, from 1, ascending.
    ids: Vec<u64>,
    molecules: Vec<u32>,
    radii_m: Vec<f64>,
    densities_kg_m3: Vec<f64>,
    places_m: Vec<[f64; 3]>,
    /// Numbers of the two particles.
    bonds: Vec<[u32; 2]>,
    /// Types, from 1.
    bond_types: Vec<usize>,
}

/// Reads what LAMMPS left in the folder of an export, and writes it as the results of a run.
/// Returns the number of frames.
///
/// # Errors
/// The folder is not that of an export or has no dump; a file is damaged (exit code 2); results
/// cannot be written (exit code 1).
pub(crate) fn import(folder: &Path, results: &Path, existing: Existing) -> Result<usize> {
    let mut manifest = read_manifest(folder)?;
    let mut exported = read_data(&folder.join(DATA))?;
    refuse_strangers(folder, &manifest, &exported)?;
    let frames_path = folder.join(FRAMES);
    let mut input = open(&frames_path, "run the exported script with LAMMPS first")?;
    let mut frames = Dump::new(&mut input)?;
    let bonds_path = folder.join(BONDS);
    let mut bonds_input = match exported.bonds.is_empty() {
        true => None,
        false => Some(open(
            &bonds_path,
            "keep the dump commands of the exported script",
        )?),
    };
    let mut bonds = bonds_input
        .as_mut()
        .map(|input| Dump::new(input))
        .transpose()?;
    let within = |path: &Path| {
        let place = path.display().to_string();
        move |error: Diagnostic| error.within(&place)
    };
    let Some(mut section) = frames.section().map_err(within(&frames_path))? else {
        return Err(Diagnostic::input(
            frames_path.display().to_string(),
            "there is no complete frame in it",
            "run the exported script with LAMMPS first",
        ));
    };
    let target = ResultsFolder::create(results, existing)?;
    let mut files = FrameFiles::create(&target, WallFiles::None);
    let mut unbroken = None;
    let mut last_s = 0.0;
    loop {
        if let Some(bonds) = &mut bonds {
            unbroken = unbroken_at(bonds, section.step).map_err(within(&bonds_path))?;
        }
        exported
            .take_fed(&mut manifest, &section)
            .map_err(within(&frames_path))?;
        last_s = append(
            &manifest,
            &exported,
            &section,
            unbroken.as_ref(),
            &mut files,
        )
        .map_err(within(&frames_path))?
        .max(last_s);
        match frames.section().map_err(within(&frames_path))? {
            Some(next) => section = next,
            None => break,
        }
    }
    write_summary(&target, &manifest, last_s)?;
    Ok(files.times_s().len())
}

/// Summary and page.
fn write_summary(target: &ResultsFolder, manifest: &Manifest, last_s: f64) -> Result<()> {
    let summary = json!({
        "program": manifest.program,
        "engine": "LAMMPS",
        "scene": manifest.scene,
        "simulated_s": last_s,
        "verdict": {
            "sound": false,
            "warnings": ["computed by LAMMPS: energies, momentum and overlaps were not checked"],
        },
    });
    write_json(&target.summary(), &summary)?;
    let page = report(target.path(), &summary.to_string())?;
    write_file(&target.report(), |out| out.write_all(page.as_bytes()))
}

fn read_manifest(folder: &Path) -> Result<Manifest> {
    let path = folder.join(MANIFEST);
    let place = path.display().to_string();
    if !path.exists() {
        return Err(Diagnostic::input(
            place,
            "this file is missing, which every export has",
            "name a folder that dem-run export lammps has written",
        ));
    }
    let text = read_input(&path, "the description of an export")?;
    serde_json::from_slice(&text).map_err(|error| {
        Diagnostic::input(
            place,
            format!("this is not the description of an export: {error}"),
            "export the scene again",
        )
    })
}

fn open(path: &Path, remedy: &str) -> Result<BufReader<File>> {
    let file = File::open(path).map_err(|error| {
        let problem = format!("cannot be read: {error}");
        Diagnostic::input(path.display().to_string(), problem, remedy)
    })?;
    Ok(BufReader::new(file))
}

/// Reads the data file of an export.
fn read_data(path: &Path) -> Result<Exported> {
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
                exported.ids.is_sorted_by(|a, b| a < b)
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
    Ok(exported)
}

impl Exported {
    /// The number of the particle with this id in LAMMPS.
    fn number_of(&self, id: u64) -> Option<u32> {
        self.ids.binary_search(&id).ok().map(|at| at as u32)
    }

    /// Takes atoms that inlets have fed since the last section: their molecules and radii from the
    /// dump, the rest from the description of their type.
    fn take_fed(&mut self, manifest: &mut Manifest, section: &Section) -> Result<()> {
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
            if !(1..=most).contains(&number) {
                return Err(Diagnostic::input(
                    format!("step {}", section.step),
                    format!("atom {} is of molecule {}", row[id], row[molecule]),
                    "keep the fix deposit of the exported script",
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

    fn length_m(&self, bond: usize) -> f64 {
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
fn refuse_strangers(folder: &Path, manifest: &Manifest, exported: &Exported) -> Result<()> {
    let molecules = manifest.body_of_molecule.len();
    let is_known = |molecule: &u32| (1..=molecules).contains(&(*molecule as usize));
    let bodies = manifest.body_names.len();
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

/// The unbroken bonds at a step, by the ids of their ends in LAMMPS, the smaller first. None: the
/// dump ends before.
fn unbroken_at(bonds: &mut Dump<'_>, step: u64) -> Result<Option<HashSet<[u64; 2]>>> {
    while let Some(section) = bonds.section()? {
        if section.step < step {
            continue;
        }
        // The columns have the names of the compute: by place, after the index.
        let ends = |row: &Vec<f64>| {
            let [a, b] = [row.get(1), row.get(2)].map(|x| x.copied().unwrap_or(0.0) as u64);
            [a.min(b), a.max(b)]
        };
        return Ok(Some(section.rows.iter().map(ends).collect()));
    }
    Ok(None)
}

/// Appends a frame. Returns its time, s.
fn append(
    manifest: &Manifest,
    exported: &Exported,
    section: &Section,
    unbroken: Option<&HashSet<[u64; 2]>>,
    files: &mut FrameFiles,
) -> Result<f64> {
    let step = || format!("step {}", section.step);
    let time_s = section.time_s.ok_or_else(|| {
        Diagnostic::input(
            step(),
            "no time",
            "keep dump_modify ... time yes of the exported script",
        )
    })?;
    let [id, x, y, z] = section.find(["id", "x", "y", "z"])?;
    let [vx, vy, vz, wx, wy, wz] =
        section.find(["vx", "vy", "vz", "omegax", "omegay", "omegaz"])?;
    let mut numbers = Vec::with_capacity(section.rows.len());
    let mut place_of: BTreeMap<u32, u32> = BTreeMap::new();
    for (at, row) in (0..).zip(&section.rows) {
        let number = exported.number_of(row[id] as u64).ok_or_else(|| {
            Diagnostic::input(
                step(),
                format!("atom {} is not in {DATA}", row[id]),
                "import the dump into the folder of its own export",
            )
        })?;
        numbers.push(number as usize);
        place_of.insert(number, at);
    }
    let row = |i: usize| &section.rows[i];
    let bonds: Vec<usize> = (0..exported.bonds.len())
        .filter(|bond| {
            exported.bonds[*bond]
                .iter()
                .all(|end| place_of.contains_key(end))
        })
        .collect();
    let is_broken = |bond: usize| {
        let [a, b] = exported.bonds[bond].map(|end| exported.ids[end as usize]);
        unbroken.is_some_and(|unbroken| !unbroken.contains(&[a.min(b), a.max(b)]))
    };
    let ends = |i: usize| exported.bonds[bonds[i]].map(|end| place_of[&end]);
    let broken: Vec<bool> = bonds.iter().map(|bond| is_broken(*bond)).collect();
    let fragments = fragments(manifest, exported, &numbers, &ends, &broken);
    let mass =
        |i: usize| exported.densities_kg_m3[numbers[i]] * volume_m3(exported.radii_m[numbers[i]]);
    let mut masses_kg: BTreeMap<u32, f64> = BTreeMap::new();
    for (i, fragment) in fragments.iter().enumerate() {
        *masses_kg.entry(*fragment).or_default() += mass(i);
    }
    let body_names: Vec<&str> = manifest.body_names.iter().map(String::as_str).collect();
    let radius = |i: usize| exported.radii_m[numbers[i]];
    let density = |i: usize| exported.densities_kg_m3[numbers[i]];
    let body = |i: usize| manifest.body_of_molecule[exported.molecules[numbers[i]] as usize - 1];
    let particle_id = |i: usize| (exported.ids[numbers[i]] - 1) as u32;
    let velocity = |i: usize| [vx, vy, vz].map(|k| row(i)[k]);
    let spin = |i: usize| [wx, wy, wz].map(|k| row(i)[k]);
    let fragment = |i: usize| fragments[i];
    let fragment_mass = |i: usize| masses_kg[&fragments[i]];
    let bond_radius = |i: usize| manifest.bond_radii_m[exported.bond_types[bonds[i]] - 1];
    let length = |i: usize| exported.length_m(bonds[i]);
    let is_broken = |i: usize| u32::from(broken[i]);
    let array = |name, values| NamedArray { name, values };
    let frame = Frame {
        time_s,
        body_names: &body_names,
        particles: numbers.len(),
        position_m: &|i| [x, y, z].map(|k| row(i)[k]),
        particle_arrays: &[
            array(RADIUS, Values::Scalars(&radius)),
            array(BODY, Values::Counts(&body)),
            array(PARTICLE_ID, Values::Counts(&particle_id)),
            array(VELOCITY, Values::Vectors(&velocity)),
            array("angular_velocity_rad_s", Values::Vectors(&spin)),
            array(FRAGMENT_ID, Values::Counts(&fragment)),
            array(DENSITY, Values::Scalars(&density)),
            array("fragment_mass_kg", Values::Scalars(&fragment_mass)),
        ],
        bonds: bonds.len(),
        ends: &ends,
        bond_arrays: &[
            array(BOND_RADIUS, Values::Scalars(&bond_radius)),
            array(BROKEN, Values::Counts(&is_broken)),
            array(BOND_LENGTH, Values::Scalars(&length)),
        ],
    };
    files.append(&frame, &WallFrame::default(), &WallTriangles::default())?;
    Ok(time_s)
}

/// The fragment of each particle of a frame: the smallest id, from 0, of the particles joined to it
/// by unbroken bonds, or that are of its molecule if that has no bonds and several particles, a
/// clump.
fn fragments(
    manifest: &Manifest,
    exported: &Exported,
    numbers: &[usize],
    ends: &dyn Fn(usize) -> [u32; 2],
    broken: &[bool],
) -> Vec<u32> {
    let mut sets = DisjointSets::new(numbers.len());
    for (bond, _) in broken.iter().enumerate().filter(|(_, broken)| !**broken) {
        let [a, b] = ends(bond);
        sets.join(a, b);
    }
    let mut first_of: BTreeMap<u32, u32> = BTreeMap::new();
    for (i, number) in (0..).zip(numbers) {
        let molecule = exported.molecules[*number];
        if manifest.is_clump[molecule as usize - 1] {
            let first = *first_of.entry(molecule).or_insert(i);
            sets.join(first, i);
        }
    }
    let mut least: BTreeMap<u32, u32> = BTreeMap::new();
    let roots: Vec<u32> = (0..numbers.len() as u32).map(|i| sets.root(i)).collect();
    for (root, number) in roots.iter().zip(numbers) {
        let id = (exported.ids[*number] - 1) as u32;
        let slot = least.entry(*root).or_insert(id);
        *slot = id.min(*slot);
    }
    roots.iter().map(|root| least[root]).collect()
}
