//! The fragments of a run and their colours, as in its pictures.

use std::path::Path;

use dem_io::{Diagnostic, Result};
use dem_pictures::colours::{Piece, of_pieces};

use super::spheres::Spheres;

/// Largest number of a body that the view can show.
const LAST_BODY: u32 = 65_535;
/// Largest number of a fragment in a run whose tree of fragments is not written yet: besides ten
/// for each particle.
const MOST_FRAGMENTS: usize = 1_000_000;

/// The fragments in `fragment-tree.csv`.
pub(crate) struct Pieces {
    all: Vec<Piece>,
}

impl Pieces {
    /// The pieces of a results folder; none if it has no such file.
    pub(crate) fn of(folder: &Path) -> Self {
        let text = std::fs::read_to_string(folder.join("fragment-tree.csv")).unwrap_or_default();
        Self {
            all: text.lines().skip(1).filter_map(piece).collect(),
        }
    }

    /// Refuses a frame with a number of a body or a fragment that there is not: one wrong number
    /// would make tables as long as itself.
    pub(crate) fn refuse_unknown(&self, spheres: &Spheres, frame: &Path) -> Result<()> {
        let bodies = match spheres.body_names.len() {
            0 => LAST_BODY as usize + 1,
            known => known,
        };
        let fragments = match self.all.len() {
            0 => MOST_FRAGMENTS + 10 * spheres.centres_m.len(),
            known => known,
        };
        for (what, numbers, known) in [
            ("body", &spheres.bodies, bodies),
            ("fragment", &spheres.fragments, fragments),
        ] {
            if let Some(i) = numbers.iter().position(|number| *number as usize >= known) {
                return Err(Diagnostic::input(
                    frame.display().to_string(),
                    format!(
                        "sphere {i} is of {what} {}, and {what} numbers end at {}",
                        numbers[i],
                        known - 1
                    ),
                    "the frame is damaged: run the scene again, or remove the frame from frames.pvd",
                ));
            }
        }
        Ok(())
    }

    /// The colour of each fragment up to the number `last`. A fragment that is not in the file has
    /// the colour of its number.
    pub(crate) fn colours(mut self, last: u32) -> Vec<[u8; 3]> {
        let unknown = |_| Piece {
            parent: None,
            particles: 2,
        };
        let known = self.all.len();
        self.all.extend((known..=last as usize).map(unknown));
        of_pieces(&self.all)
    }
}

/// A row `fragment_id,parent_id,created_s,ended_s,particles`. Rows stand in the order of the ids.
fn piece(row: &str) -> Option<Piece> {
    let cells: Vec<&str> = row.split(',').collect();
    Some(Piece {
        parent: cells.get(1)?.parse().ok(),
        particles: cells.get(4)?.parse().ok()?,
    })
}
