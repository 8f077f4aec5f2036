//! Frames of a run for ParaView: one .vtp file each, and one index of all with their times, `frames.pvd`.
//!
//! Points = particles (Float64, m), lines = bonds, any point and cell data, the time as field data `TimeValue` (s).
//! How it is encoded, [`crate::vtk`] says.

use std::io::{self, Write};

use super::folder::{ResultsFolder, frame_name};
use crate::safe_write::write_file;
pub use crate::vtk::{NamedArray, Values};
use crate::vtk::{PolyData, exact, write_number};
use crate::{Diagnostic, Result};

/// What is to be seen at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame<'a> {
    /// Simulated time, s.
    pub time_s: f64,
    /// Centres of the particles, m.
    pub positions: &'a [[f64; 3]],
    /// What is known of the particles: one value each.
    pub particle_arrays: &'a [NamedArray<'a>],
    /// The two particles of each bond.
    pub bonds: &'a [[u32; 2]],
    /// What is known of the bonds: one value each.
    pub bond_arrays: &'a [NamedArray<'a>],
}

impl Frame<'_> {
    /// Whether every array has one value for each particle or bond, and every bond its two particles: ParaView crashes without.
    ///
    /// # Errors
    /// Says which array or bond (exit code 1: it is a fault of the program).
    pub fn check(&self) -> Result<()> {
        let fault =
            |problem| Diagnostic::failed("frame", problem, "this is a fault of the program");
        let (particles, bonds) = (self.positions.len(), self.bonds.len());
        for (arrays, count, what) in [
            (self.particle_arrays, particles, "particles"),
            (self.bond_arrays, bonds, "bonds"),
        ] {
            for array in arrays {
                let (name, values) = (array.name, array.values.len());
                if values != count {
                    return Err(fault(format!(
                        "array '{name}' has {values} values for {count} {what}"
                    )));
                }
            }
        }
        let missing = |end: &u32| *end as usize >= particles;
        match self.bonds.iter().position(|bond| bond.iter().any(missing)) {
            Some(bond) => Err(fault(format!(
                "bond {bond} joins {:?} of {particles} particles",
                self.bonds[bond]
            ))),
            None => Ok(()),
        }
    }
}

/// Writes a frame, which must pass [`Frame::check`], as .vtp.
///
/// # Errors
/// Those of `out`.
pub fn write_frame(frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
    let data = PolyData {
        points: frame.positions,
        lines: frame.bonds,
        point_data: frame.particle_arrays,
        cell_data: frame.bond_arrays,
    };
    data.write(out, |out| {
        write_number(out, "Float64", "TimeValue", Some(exact(frame.time_s)))
    })
}

/// The frames of a run so far.
#[derive(Debug)]
pub struct FrameFiles {
    folder: ResultsFolder,
    times_s: Vec<f64>,
}

impl FrameFiles {
    /// No frame yet. Nothing is written before the first.
    pub fn create(folder: &ResultsFolder) -> Self {
        Self {
            folder: folder.clone(),
            times_s: Vec::new(),
        }
    }

    /// The frames of an interrupted run up to its checkpoint, which had these times, s. Later ones are removed.
    ///
    /// # Errors
    /// A frame is missing (exit code 2); the index cannot be written or a later frame not removed (exit code 1).
    pub fn continue_at(folder: &ResultsFolder, times_s: Vec<f64>) -> Result<Self> {
        for number in 0..times_s.len() {
            let path = folder.frame(number);
            if !path.is_file() {
                return Err(Diagnostic::input(
                    path.display().to_string(),
                    "this frame is missing, which was there when the checkpoint was written",
                    "put it back, or start the run again without --resume",
                ));
            }
        }
        let frames = Self {
            folder: folder.clone(),
            times_s,
        };
        if frames.times_s.is_empty() {
            // A run without frames has no index.
            folder.remove_frames_index()?;
        } else {
            frames.write_index()?;
        }
        folder.remove_frames_from(frames.times_s.len())?;
        Ok(frames)
    }

    /// Writes the next frame, then the index with it.
    ///
    /// # Errors
    /// No permission, full disk (exit code 1): frames and index before are kept. The frame is wrong by [`Frame::check`].
    pub fn append(&mut self, frame: &Frame<'_>) -> Result<()> {
        frame.check()?;
        self.folder.make_frames_folder()?;
        let path = self.folder.frame(self.times_s.len());
        write_file(&path, |out| write_frame(frame, out))?;
        self.times_s.push(frame.time_s);
        self.write_index()
    }

    /// Times of the frames, s: what a checkpoint keeps for [`FrameFiles::continue_at`].
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    fn write_index(&self) -> Result<()> {
        write_file(&self.folder.frames_index(), |out| {
            writeln!(
                out,
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>"
            )?;
            for (number, time_s) in self.times_s.iter().enumerate() {
                let (time, file) = (exact(*time_s), frame_name(number));
                writeln!(out, "    <DataSet timestep=\"{time}\" file=\"{file}\"/>")?;
            }
            writeln!(out, "  </Collection>\n</VTKFile>")
        })
    }
}
