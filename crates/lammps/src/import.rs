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
use dem_io::{Diagnostic, Result, read_input};
use dem_report::report;
use dem_results::folder::names;
use dem_results::summary::Verdict;
use dem_results::{
    Existing, Frame, FrameFiles, NamedArray, ResultsFolder, Values, WallFiles, WallFrame,
    WallTriangles, write_json,
};
use serde_json::json;

use super::dump::{Dump, Section};
use super::files::{BONDS, DATA, FRAMES, MANIFEST, Manifest};

/// Columns of place, velocity and spin.
const MOTION: [&str; 9] = [
    "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz",
];
/// Relative difference of two radii that are the same.
const SAME: f64 = 1e-9;
/// What to do if a dump lacks something.
const KEEP_DUMPS: &str = "keep the dump commands of the exported script";

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

/// What a run of LAMMPS came to.
#[derive(Debug, Clone, Copy, Default)]
pub struct Came {
    /// Frames written.
    pub frames: usize,
    /// Time of the last frame, and of the end of the run, s.
    pub last_s: f64,
    pub(crate) end_s: f64,
    /// Whether the last frame is that of the end.
    pub(crate) is_whole: bool,
}

/// A frame of a dump, whose numbers have been checked.
struct Moment<'a> {
    manifest: &'a Manifest,
    exported: &'a Exported,
    section: &'a Section,
    time_s: f64,
    /// Columns of place, velocity and spin.
    columns: [usize; 9],
    /// For each row the number of its particle.
    numbers: &'a [u32],
    /// The unbroken bonds, by the ids of their ends in LAMMPS, the smaller first.
    unbroken: &'a HashSet<[u64; 2]>,
}

/// Reads what LAMMPS left in the folder of an export, and writes it as the results of a run. The
/// dumps are read twice: what is damaged leaves nothing behind.
pub fn import(folder: &Path, results: &Path, existing: Existing) -> Result<Came> {
    each_moment(folder, &mut |_| Ok(()))?;
    let target = ResultsFolder::create(results, existing)?;
    let mut files = FrameFiles::create(&target, WallFiles::default());
    let came = each_moment(folder, &mut |moment| append(moment, &mut files))?;
    write_summary(&target, &read_manifest(folder)?, &came)?;
    Ok(came)
}

/// Reads the dumps, and calls `visit` with each frame that both of them have.
fn each_moment(folder: &Path, visit: &mut dyn FnMut(&Moment<'_>) -> Result<()>) -> Result<Came> {
    let mut manifest = read_manifest(folder)?;
    let mut exported = read_data(&folder.join(DATA))?;
    refuse_strangers(folder, &manifest, &exported)?;
    let bonded = exported.pairs();
    let within = |path: &Path| {
        let place = path.display().to_string();
        move |error: Diagnostic| error.within(&place)
    };
    let (frames_path, bonds_path) = (folder.join(FRAMES), folder.join(BONDS));
    let mut frames_input = open(&frames_path, "run the exported script with LAMMPS first")?;
    let mut frames = Dump::new(&mut frames_input).map_err(within(&frames_path))?;
    let mut bonds_input = match bonded.is_empty() {
        true => None,
        false => Some(open(&bonds_path, KEEP_DUMPS)?),
    };
    let bonds = bonds_input.as_mut().map(|input| Dump::new(input));
    let mut bonds = bonds.transpose().map_err(within(&bonds_path))?;
    let mut came = Came {
        end_s: manifest.end_s,
        ..Came::default()
    };
    let (mut before, mut ends_early) = (None, &frames_path);
    while let Some(section) = frames.section().map_err(within(&frames_path))? {
        let mut check = || {
            follows(before, &section)?;
            exported.take_fed(&mut manifest, &section)?;
            let numbers = exported.numbers_of(&section)?;
            Ok((numbers, section.find(MOTION)?, time_s(&section)?))
        };
        let (numbers, columns, time_s) = check().map_err(within(&frames_path))?;
        let mut unbroken = HashSet::new();
        if let Some(bonds) = &mut bonds {
            match unbroken_at(bonds, section.step, &bonded).map_err(within(&bonds_path))? {
                Some(found) => unbroken = found,
                None => {
                    ends_early = &bonds_path;
                    break;
                }
            }
        }
        visit(&Moment {
            manifest: &manifest,
            exported: &exported,
            section: &section,
            time_s,
            columns,
            numbers: &numbers,
            unbroken: &unbroken,
        })?;
        before = Some(section.step);
        (came.frames, came.last_s) = (came.frames + 1, time_s);
        came.is_whole = section.step >= manifest.steps;
    }
    if came.frames == 0 {
        return Err(Diagnostic::input(
            ends_early.display().to_string(),
            "there is no complete frame in it",
            "run the exported script with LAMMPS first",
        ));
    }
    Ok(came)
}

/// Refuses a step that does not come after the one before.
fn follows(before: Option<u64>, section: &Section) -> Result<()> {
    match before {
        Some(before) if section.step <= before => Err(section.refused(
            format!("it comes after step {before}"),
            "run LAMMPS again, or copy the dump again: that of one run only",
        )),
        _ => Ok(()),
    }
}

fn time_s(section: &Section) -> Result<f64> {
    let remedy = "keep dump_modify ... time yes of the exported script";
    section
        .time_s
        .ok_or_else(|| section.refused("no time", remedy))
}

/// Summary and page.
fn write_summary(target: &ResultsFolder, manifest: &Manifest, came: &Came) -> Result<()> {
    let unchecked = "computed by LAMMPS: energies, momentum and overlaps were not checked";
    let warnings: Vec<String> = std::iter::once(unchecked.to_owned())
        .chain(came.warning())
        .collect();
    let summary = json!({
        "program": manifest.program,
        "engine": "LAMMPS",
        "scene": manifest.scene,
        "simulated_s": came.last_s,
        "verdict": Verdict::new(warnings, Vec::new()),
    });
    write_json(&target.file(names::SUMMARY), &summary)?;
    let page = report(target.path(), &summary.to_string())?;
    target.write(names::REPORT, &page)
}

impl Came {
    /// What is to be said of a run that has not come to its end.
    pub fn warning(&self) -> Option<String> {
        let Self { last_s, end_s, .. } = self;
        let warning = format!(
            "the frames end at {last_s} s, the run of the scene at {end_s} s: LAMMPS has stopped before, or goes on"
        );
        (!self.is_whole).then_some(warning)
    }
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
    let refuse = |problem| Diagnostic::input(path.display().to_string(), problem, remedy);
    if path.is_dir() {
        return Err(refuse("this is a folder, not a dump".to_owned()));
    }
    let file = File::open(path).map_err(|error| refuse(format!("cannot be read: {error}")))?;
    Ok(BufReader::new(file))
}

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
    /// The bonds, by the ids of their ends in LAMMPS, the smaller first.
    fn pairs(&self) -> HashSet<[u64; 2]> {
        let ids = |ends: &[u32; 2]| ends.map(|end| self.ids[end as usize]);
        let pairs = self.bonds.iter().map(ids);
        pairs.map(|[a, b]| [a.min(b), a.max(b)]).collect()
    }

    /// For each row of a section the number of its particle: each is there once, with the molecule
    /// and the radius that it had at the start.
    fn numbers_of(&self, section: &Section) -> Result<Vec<u32>> {
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
/// dump ends before. `bonded`: those of the start.
fn unbroken_at(
    bonds: &mut Dump<'_>,
    step: u64,
    bonded: &HashSet<[u64; 2]>,
) -> Result<Option<HashSet<[u64; 2]>>> {
    let Some(section) = bonds.section()? else {
        return Ok(None);
    };
    let remedy = "run LAMMPS again, or copy both dumps again";
    let refuse = |problem: String| Err(section.refused(problem, remedy));
    if section.step != step {
        return refuse(format!("{FRAMES} has step {step} there"));
    }
    // The columns have the names of the compute: by place, after the index.
    let mut unbroken = HashSet::with_capacity(section.rows.len());
    for row in &section.rows {
        let &[_, a, b, ..] = row.as_slice() else {
            return refuse("its rows have no ends of bonds".to_owned());
        };
        let [a, b] = [a.min(b), a.max(b)];
        let pair = [a as u64, b as u64];
        if !bonded.contains(&pair) {
            return refuse(format!("{DATA} has no bond of the atoms {a} and {b}"));
        }
        unbroken.insert(pair);
    }
    Ok(Some(unbroken))
}

fn append(moment: &Moment<'_>, files: &mut FrameFiles) -> Result<()> {
    let Moment {
        manifest,
        exported,
        section,
        numbers,
        ..
    } = moment;
    let [x, y, z, vx, vy, vz, wx, wy, wz] = moment.columns;
    let mut place_of = vec![0; numbers.len()];
    for (at, &number) in (0..).zip(*numbers) {
        place_of[number as usize] = at;
    }
    let row = |i: usize| &section.rows[i];
    let is_broken = |ends: &[u32; 2]| {
        let [a, b] = ends.map(|end| exported.ids[end as usize]);
        !moment.unbroken.contains(&[a.min(b), a.max(b)])
    };
    let ends = |i: usize| exported.bonds[i].map(|end| place_of[end as usize]);
    let broken: Vec<bool> = exported.bonds.iter().map(is_broken).collect();
    let number = |i: usize| numbers[i] as usize;
    let fragments = fragments(manifest, exported, numbers, &ends, &broken);
    let radius = |i: usize| exported.radii_m[number(i)];
    let density = |i: usize| exported.densities_kg_m3[number(i)];
    let mass = |i: usize| density(i) * volume_m3(radius(i));
    let mut masses_kg: BTreeMap<u32, f64> = BTreeMap::new();
    for (i, fragment) in fragments.iter().enumerate() {
        *masses_kg.entry(*fragment).or_default() += mass(i);
    }
    let body_names: Vec<&str> = manifest.body_names.iter().map(String::as_str).collect();
    let body = |i: usize| manifest.body_of_molecule[exported.molecules[number(i)] as usize - 1];
    let particle_id = |i: usize| (exported.ids[number(i)] - 1) as u32;
    let velocity = |i: usize| [vx, vy, vz].map(|k| row(i)[k]);
    let spin = |i: usize| [wx, wy, wz].map(|k| row(i)[k]);
    let fragment = |i: usize| fragments[i];
    let fragment_mass = |i: usize| masses_kg[&fragments[i]];
    let bond_radius = |i: usize| manifest.bond_radii_m[exported.bond_types[i] - 1];
    let length = |i: usize| exported.length_m(i);
    let is_broken = |i: usize| u32::from(broken[i]);
    let array = |name, values| NamedArray { name, values };
    let frame = Frame {
        time_s: moment.time_s,
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
        bonds: broken.len(),
        ends: &ends,
        bond_arrays: &[
            array(BOND_RADIUS, Values::Scalars(&bond_radius)),
            array(BROKEN, Values::Counts(&is_broken)),
            array(BOND_LENGTH, Values::Scalars(&length)),
        ],
    };
    files.append(&frame, &WallFrame::default(), &WallTriangles::default())
}

/// The fragment of each particle of a frame: the smallest id, from 0, of the particles joined to it
/// by unbroken bonds, or that are of its molecule if that has no bonds and several particles, a
/// clump.
fn fragments(
    manifest: &Manifest,
    exported: &Exported,
    numbers: &[u32],
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
        let molecule = exported.molecules[*number as usize];
        if manifest.is_clump[molecule as usize - 1] {
            let first = *first_of.entry(molecule).or_insert(i);
            sets.join(first, i);
        }
    }
    let mut least: BTreeMap<u32, u32> = BTreeMap::new();
    let roots: Vec<u32> = (0..numbers.len() as u32).map(|i| sets.root(i)).collect();
    for (root, number) in roots.iter().zip(numbers) {
        let id = (exported.ids[*number as usize] - 1) as u32;
        let slot = least.entry(*root).or_insert(id);
        *slot = id.min(*slot);
    }
    roots.iter().map(|root| least[root]).collect()
}
