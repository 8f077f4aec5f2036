//! The way back: dumps of an exported run as results: frames, broken bonds, fragments, with a page.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use dem_io::{Diagnostic, Result, read_input};
use dem_results::Existing;

pub use super::came::Came;

use super::breaks::{Break, breaks_until, check_unbroken};
use super::dump::{Dump, Section};
use super::exported::{Exported, read_data, refuse_strangers};
use super::files::{BONDS, BROKEN, DATA, FRAMES, MANIFEST, Manifest};
use super::pieces::Pieces;
use super::results::{Moment, Results};

/// Columns of place, velocity and spin.
const MOTION: [&str; 9] = [
    "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz",
];
/// What to do if a dump lacks something.
const KEEP_DUMPS: &str = "keep the dump commands of the exported script";

/// Reads what LAMMPS left in the folder of an export, and writes it as the results of a run. The
/// dumps are read twice: what is damaged leaves nothing behind.
pub fn import(folder: &Path, results: &Path, existing: Existing) -> Result<Came> {
    Run::read(folder)?.go(folder, None)?;
    let mut results = Results::create(results, existing)?;
    let mut run = Run::read(folder)?;
    let came = run.go(folder, Some(&mut results))?;
    results.finish(&run.moment(came.last_s), &came)?;
    Ok(came)
}

/// An exported run while its dumps are read.
struct Run {
    manifest: Manifest,
    exported: Exported,
    pieces: Pieces,
}

impl Run {
    /// As it was exported.
    fn read(folder: &Path) -> Result<Self> {
        let manifest = read_manifest(folder)?;
        let exported = read_data(&folder.join(DATA))?;
        refuse_strangers(folder, &manifest, &exported)?;
        let pieces = Pieces::new(&manifest, &exported);
        Ok(Self {
            manifest,
            exported,
            pieces,
        })
    }

    fn moment(&self, time_s: f64) -> Moment<'_> {
        Moment {
            manifest: &self.manifest,
            exported: &self.exported,
            pieces: &self.pieces,
            time_s,
        }
    }

    /// Reads the dumps, and writes each frame that all of them have, with what broke before it.
    fn go(&mut self, folder: &Path, mut results: Option<&mut Results>) -> Result<Came> {
        let paths = [FRAMES, BONDS, BROKEN].map(|name| folder.join(name));
        let [frames_path, bonds_path, broken_path] = &paths;
        let has_bonds = !self.exported.bonds.is_empty();
        let can_break = has_bonds && self.manifest.breaks;
        let mut inputs = [
            Some(open(
                frames_path,
                "run the exported script with LAMMPS first",
            )?),
            has_bonds
                .then(|| open(bonds_path, KEEP_DUMPS))
                .transpose()?,
            can_break
                .then(|| open(broken_path, KEEP_DUMPS))
                .transpose()?,
        ];
        let [frames, bonds, broken] = &mut inputs;
        let mut frames = begun(frames, frames_path)?;
        let mut bonds = begun(bonds, bonds_path)?;
        let mut broken = begun(broken, broken_path)?;
        let mut came = Came {
            end_s: self.manifest.end_s,
            ..Came::default()
        };
        let (mut before, mut ends_early) = (None, frames_path);
        while let Some(section) = next(&mut frames).map_err(within(frames_path))? {
            let step = section.step;
            let taken = self.take_frame(before, &section);
            let (numbers, columns, time_s) = taken.map_err(within(frames_path))?;
            let mut breaks = Vec::new();
            let mut is_broken = self.pieces.is_broken.clone();
            if let Some(dump) = &mut broken {
                let found = breaks_until(dump, step, before, &self.exported, &is_broken);
                let Some(found) = found.map_err(within(broken_path))? else {
                    ends_early = broken_path;
                    break;
                };
                breaks = found;
                breaks.iter().for_each(|one| is_broken[one.bond] = true);
            }
            if let Some(dump) = &mut bonds {
                let found = check_unbroken(dump, step, &self.exported, &is_broken);
                if found.map_err(within(bonds_path))?.is_none() {
                    ends_early = bonds_path;
                    break;
                }
            }
            self.take_breaks(&breaks, results.as_deref_mut())?;
            self.pieces.add_fed(&self.manifest, &self.exported, time_s);
            self.pieces.move_to(&section, &columns, &numbers);
            if let Some(results) = &mut results {
                results.add_frame(&self.moment(time_s))?;
            }
            before = Some(step);
            (came.frames, came.last_s) = (came.frames + 1, time_s);
            came.is_whole = step >= self.manifest.steps;
        }
        if came.frames == 0 {
            return Err(Diagnostic::input(
                ends_early.display().to_string(),
                "there is no complete frame in it",
                "run the exported script with LAMMPS first",
            ));
        }
        came.broken = self.pieces.state.broken_count;
        let clusters = self.pieces.state.clusters.as_ref();
        came.fragments = clusters.map_or(0, |clusters| clusters.living().count());
        Ok(came)
    }

    /// Checks a frame. Returns the particle of each row, the columns of the motion, and the time, s.
    fn take_frame(
        &mut self,
        before: Option<u64>,
        section: &Section,
    ) -> Result<(Vec<u32>, [usize; 9], f64)> {
        follows(before, section)?;
        self.exported.take_fed(&mut self.manifest, section)?;
        let numbers = self.exported.numbers_of(section)?;
        Ok((numbers, section.find(MOTION)?, time_s(section)?))
    }

    /// Breaks bonds, step by step.
    fn take_breaks(&mut self, breaks: &[Break], mut results: Option<&mut Results>) -> Result<()> {
        let step_s = self.pieces.state.time_step_s;
        for some in breaks.chunk_by(|one, other| one.step == other.step) {
            let splits = self.pieces.break_bonds(some, step_s);
            if let Some(results) = &mut results {
                results.add_breaks(&self.moment(0.0), some, &splits)?;
            }
        }
        Ok(())
    }
}

fn within(path: &Path) -> impl Fn(Diagnostic) -> Diagnostic {
    let place = path.display().to_string();
    move |error| error.within(&place)
}

/// A dump, if there is a file of it.
fn begun<'a>(input: &'a mut Option<BufReader<File>>, path: &Path) -> Result<Option<Dump<'a>>> {
    let dump = input.as_mut().map(|input| Dump::new(input));
    dump.transpose().map_err(within(path))
}

fn next(dump: &mut Option<Dump<'_>>) -> Result<Option<Section>> {
    dump.as_mut().map_or(Ok(None), Dump::section)
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
