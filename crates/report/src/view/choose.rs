//! Which frames and which spheres a view shows, so that a page of a large run can still be opened.

use std::path::{Path, PathBuf};

use dem_io::Result;
use dem_results::read_arrays;

/// Most frames of a view.
const MOST_FRAMES: usize = 121;
/// Fewest frames, if the run has as many: rather are spheres left out.
const FEWEST_FRAMES: usize = 11;
/// Most spheres of all frames together.
const MOST_SPHERES: usize = 2_500_000;
/// Most bonds of all frames together.
const MOST_BONDS: usize = 6_000_000;

/// What is shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chosen {
    /// The frames.
    pub(crate) frames: Vec<ChosenFrame>,
    /// Number of frames of the run.
    of_frames: usize,
    /// One sphere of so many is shown.
    pub(crate) every: usize,
    /// Whether bonds are shown.
    pub(crate) with_bonds: bool,
    /// Largest number of particles in a frame.
    particles: usize,
}

/// A frame that is shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ChosenFrame {
    pub(crate) path: PathBuf,
    pub(crate) time_s: f64,
}

impl Chosen {
    /// What was left out, in sentences.
    pub(crate) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let shown = self.frames.len();
        if shown < self.of_frames {
            notes.push(format!("{shown} of {} frames are shown.", self.of_frames));
        }
        if self.every > 1 {
            let (every, particles) = (self.every, self.particles);
            notes.push(format!(
                "One of {every} spheres is shown, as there are up to {particles}."
            ));
        }
        if !self.with_bonds {
            notes.push("Bonds are not shown: there are too many.".to_owned());
        }
        notes
    }
}

/// Chooses from all frames and their times, s. None: no frame has particles.
///
/// # Errors
/// A frame is missing or damaged (exit code 2).
pub(crate) fn choose(frames: &[(PathBuf, f64)]) -> Result<Option<Chosen>> {
    let mut particles = 0;
    let mut bonds = 0;
    for (path, _) in frames {
        let counts = counts(path)?;
        particles = particles.max(counts[0]);
        bonds = bonds.max(counts[1]);
    }
    if particles == 0 {
        return Ok(None);
    }
    let fitting = (MOST_SPHERES / particles).min(MOST_BONDS / bonds.max(1));
    let wanted = fitting.clamp(FEWEST_FRAMES, MOST_FRAMES).min(frames.len());
    let last = frames.len() - 1;
    let numbers = (0..wanted).map(|k| k * last / (wanted - 1).max(1));
    let every = (particles * wanted).div_ceil(MOST_SPHERES);
    Ok(Some(Chosen {
        frames: numbers
            .map(|number| {
                let (path, time_s) = frames[number].clone();
                ChosenFrame { path, time_s }
            })
            .collect(),
        of_frames: frames.len(),
        every,
        // Of the bonds remain those whose two spheres are shown.
        with_bonds: bonds / (every * every) * wanted <= 2 * MOST_BONDS,
        particles,
    }))
}

/// Numbers of particles and bonds of a frame.
fn counts(path: &Path) -> Result<[usize; 2]> {
    let arrays = read_arrays(path, &[])?;
    Ok([arrays.points, arrays.lines])
}
