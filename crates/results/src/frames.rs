//! Frames of a run for ParaView: one .vtp file each, another with the walls, and one index with
//! their times, `frames.pvd`.
//!
//! Points = particles (Float64, m), lines = bonds, any point and cell data; the time, `TimeValue`
//! (s), and the names of the bodies, `body_names`, as field data. For the encoding see
//! [`dem_io::vtk`].

use std::io::{self, Write};

use super::folder::names;
use super::folder::{ResultsFolder, fixed_walls_name, frame_name, loads_name, walls_name};
use super::wall_loads::write_frame_loads;
use super::walls::{WallFrame, WallTriangles, write_fixed_walls, write_walls};
use dem_io::body::stored_frame::{BODY_NAMES, TIME};
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::write_file;
use dem_io::vtk::{Cells, PolyData, exact, write_number, write_texts};
pub use dem_io::vtk::{NamedArray, Values};

/// The data of a frame. Particles and bonds are given by their indices, from 0.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// Simulated time, s.
    pub time_s: f64,
    /// Names of the bodies, by their number in the array `body`.
    pub body_names: &'a [&'a str],
    /// Number of particles.
    pub particles: usize,
    /// Centre of each particle, m.
    pub position_m: &'a dyn Fn(usize) -> [f64; 3],
    /// Arrays of the particles.
    pub particle_arrays: &'a [NamedArray<'a>],
    /// Number of bonds.
    pub bonds: usize,
    /// The two particles of each bond.
    pub ends: &'a dyn Fn(usize) -> [u32; 2],
    /// Arrays of the bonds.
    pub bond_arrays: &'a [NamedArray<'a>],
}

impl Frame<'_> {
    /// Checks that the two particles of every bond exist: otherwise ParaView crashes. A missing one
    /// is an error of the program (exit code 1).
    pub fn check(&self) -> Result<()> {
        let missing = |end: u32| end as usize >= self.particles;
        match (0..self.bonds).find(|&bond| (self.ends)(bond).into_iter().any(missing)) {
            Some(bond) => Err(Diagnostic::failed(
                "frame",
                format!(
                    "bond {bond} joins {:?} of {} particles",
                    (self.ends)(bond),
                    self.particles
                ),
                "this is a fault of the program",
            )),
            None => Ok(()),
        }
    }
}

/// Writes a frame, which must pass [`Frame::check`], as .vtp.
pub fn write_frame(frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
    let data = PolyData {
        points: frame.particles,
        place: Values::Vectors(frame.position_m),
        cells: Cells::Lines(frame.bonds, frame.ends),
        point_data: frame.particle_arrays,
        cell_data: frame.bond_arrays,
    };
    data.write(out, |out| {
        write_number(out, "Float64", TIME, Some(exact(frame.time_s)))?;
        write_texts(out, BODY_NAMES, frame.body_names)
    })
}

/// The files of walls next to each frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WallFiles {
    /// One with each frame.
    pub each_frame: bool,
    /// One for all with large walls that never move.
    pub fixed: bool,
    /// One with each frame of what contacts have done to patches of walls.
    pub loads: bool,
}

/// The frames of a run so far.
#[derive(Debug)]
pub struct FrameFiles {
    folder: ResultsFolder,
    walls: WallFiles,
    times_s: Vec<f64>,
}

impl FrameFiles {
    /// No frames yet. Nothing is written before the first.
    pub fn create(folder: &ResultsFolder, walls: WallFiles) -> Self {
        Self {
            folder: folder.clone(),
            walls,
            times_s: Vec::new(),
        }
    }

    /// The frames of an interrupted run up to its checkpoint, at these times, s. Later ones are
    /// removed; a missing one is refused (exit code 2).
    pub fn continue_at(
        folder: &ResultsFolder,
        walls: WallFiles,
        times_s: Vec<f64>,
    ) -> Result<Self> {
        let frames = Self {
            folder: folder.clone(),
            walls,
            times_s,
        };
        let mut files = frames.files().into_iter();
        if let Some(name) = files.find(|name| !folder.path().join(name).is_file()) {
            return Err(Diagnostic::input(
                folder.path().join(name).display().to_string(),
                "this frame is missing, which was there when the checkpoint was written",
                "put it back, or start the run again without --resume",
            ));
        }
        if frames.times_s.is_empty() {
            // A run without frames has no index.
            folder.remove_frames_index()?;
        } else {
            frames.write_indices()?;
        }
        folder.remove_frames_from(frames.times_s.len())?;
        Ok(frames)
    }

    /// Writes the next frame and its walls, then the updated index. `fixed`: the large walls that
    /// never move, written with the first frame. An error keeps earlier frames and the index.
    pub fn append(
        &mut self,
        frame: &Frame<'_>,
        walls: &WallFrame,
        fixed: &WallTriangles,
    ) -> Result<()> {
        frame.check()?;
        self.folder.make_frames_folder()?;
        let number = self.times_s.len();
        if self.walls.fixed && number == 0 {
            write_file(&self.folder.fixed_walls(), |out| {
                write_fixed_walls(fixed, out)
            })?;
        }
        if self.walls.each_frame {
            write_file(&self.folder.walls(number), |out| {
                write_walls(walls, frame.time_s, self.walls.fixed, out)
            })?;
        }
        if self.walls.loads {
            write_file(&self.folder.file(&loads_name(number)), |out| {
                write_frame_loads(out, &walls.names, &walls.loads, frame.time_s)
            })?;
        }
        write_file(&self.folder.frame(number), |out| write_frame(frame, out))?;
        self.times_s.push(frame.time_s);
        self.write_indices()
    }

    /// Times of the frames, s, stored in a checkpoint for [`FrameFiles::continue_at`].
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Names in the folder of the files of frame `number` but the loads of walls, in the order of
    /// their parts.
    fn files_of(&self, number: usize) -> Vec<String> {
        let mut files = vec![frame_name(number)];
        files.extend(self.walls.each_frame.then(|| walls_name(number)));
        files.extend(self.walls.fixed.then(fixed_walls_name));
        files
    }

    /// Names in the folder of all files of the frames, with the loads of walls.
    pub fn files(&self) -> Vec<String> {
        let numbers = 0..self.times_s.len();
        let mut files: Vec<String> = numbers.clone().flat_map(|at| self.files_of(at)).collect();
        if self.walls.loads {
            files.extend(numbers.map(loads_name));
        }
        files
    }

    fn write_indices(&self) -> Result<()> {
        self.write_index(names::INDEX, |number| self.files_of(number))?;
        match self.walls.loads {
            true => self.write_index(names::WALL_LOAD_INDEX, |number| vec![loads_name(number)]),
            false => Ok(()),
        }
    }

    /// Writes a list of these files of each frame.
    fn write_index(&self, name: &str, files_of: impl Fn(usize) -> Vec<String>) -> Result<()> {
        write_file(&self.folder.file(name), |out| {
            writeln!(
                out,
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>"
            )?;
            for (number, time_s) in self.times_s.iter().enumerate() {
                let time = exact(*time_s);
                for (part, file) in files_of(number).iter().enumerate() {
                    writeln!(
                        out,
                        "    <DataSet timestep=\"{time}\" part=\"{part}\" file=\"{file}\"/>"
                    )?;
                }
            }
            writeln!(out, "  </Collection>\n</VTKFile>")
        })
    }
}
