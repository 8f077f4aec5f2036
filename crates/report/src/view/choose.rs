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

impl From<&(PathBuf, f64)> for ChosenFrame {
    /// A frame of this file and time, s.
    fn from((path, time_s): &(PathBuf, f64)) -> Self {
        Self {
            path: path.clone(),
            time_s: *time_s,
        }
    }
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
    let amount = Amount::of(particles, bonds, frames.len());
    let last = frames.len() - 1;
    let numbers = (0..amount.frames).map(|k| k * last / (amount.frames - 1).max(1));
    Ok(Some(Chosen {
        frames: numbers
            .map(|number| ChosenFrame::from(&frames[number]))
            .collect(),
        of_frames: frames.len(),
        every: amount.every,
        with_bonds: amount.with_bonds,
        particles,
    }))
}

/// How much of a run is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Amount {
    frames: usize,
    /// One sphere of so many.
    every: usize,
    with_bonds: bool,
}

impl Amount {
    /// For the largest numbers of particles, at least one, and bonds in a frame.
    fn of(particles: usize, bonds: usize, frames: usize) -> Self {
        let fitting = (MOST_SPHERES / particles).min(MOST_BONDS / bonds.max(1));
        let frames = fitting.clamp(FEWEST_FRAMES, MOST_FRAMES).min(frames);
        let every = (particles * frames).div_ceil(MOST_SPHERES);
        Self {
            frames,
            every,
            // Of the bonds remain those whose two spheres are shown.
            with_bonds: bonds / (every * every) * frames <= 2 * MOST_BONDS,
        }
    }
}

/// Numbers of particles and bonds of a frame.
fn counts(path: &Path) -> Result<[usize; 2]> {
    let arrays = read_arrays(path, &[])?;
    Ok([arrays.points, arrays.lines])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_spheres_are_thinned() {
        let amount = Amount::of(1_000_000, 5_000_000, 500);
        assert_eq!((amount.frames, amount.every), (FEWEST_FRAMES, 5));
        assert!(amount.with_bonds);
        assert!(1_000_000 / amount.every * amount.frames <= MOST_SPHERES);
        let chosen = Chosen {
            frames: vec![
                ChosenFrame {
                    path: PathBuf::new(),
                    time_s: 0.0,
                };
                amount.frames
            ],
            of_frames: 500,
            every: amount.every,
            with_bonds: false,
            particles: 1_000_000,
        };
        assert_eq!(
            chosen.notes(),
            [
                "11 of 500 frames are shown.",
                "One of 5 spheres is shown, as there are up to 1000000.",
                "Bonds are not shown: there are too many."
            ]
        );
    }

    #[test]
    fn what_fits_is_shown_whole() {
        let whole = |frames| Amount {
            frames,
            every: 1,
            with_bonds: true,
        };
        assert_eq!(Amount::of(1000, 5000, 40), whole(40));
        assert_eq!(Amount::of(1000, 5000, 4000), whole(MOST_FRAMES));
        assert_eq!(Amount::of(1_000_000, 0, 2), whole(2));
    }
}
