//! Pictures taken during a run, `pictures/picture-00000.png` and so on.

use dem_io::Result;
use dem_pictures::png_file::{Compression, to_png};
use dem_results::PictureFiles;
use dem_scene::Scene;
use serde::{Deserialize, Serialize};

use super::picture_order::Order;
use super::{Moment, Opening, Output, Saved, position};
use crate::progress::Progress;
use crate::schedule::{due, first_after, next};
use dem_engine::state::State;

/// Their name in the list of outputs.
pub(super) const NAME: &str = "pictures";

/// Data of the pictures in a checkpoint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Taken {
    every_s: f64,
    next: u64,
    count: usize,
}

/// Fraction of the particles outside the pictures of which a note tells.
const MUCH: f64 = 0.05;

/// The pictures of a run.
struct Pictures {
    files: PictureFiles,
    order: Order,
    taken: Taken,
}

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let (folder, state) = (opening.folder, opening.state);
    let Some(order) = opening.start.pictures else {
        return Ok(None);
    };
    let every_s = order.every_s;
    let (files, next) = match opening.position::<Taken>()? {
        None => (PictureFiles::create(folder), 0),
        Some(before) => {
            let files = PictureFiles::continue_at(folder, before.count)?;
            let stood_s = state.time_s - 0.5 * state.previous_time_step_s;
            let next = if before.every_s == every_s {
                before.next
            } else {
                first_after(stood_s, every_s)
            };
            (files, next)
        }
    };
    let taken = Taken {
        every_s,
        next,
        count: files.count(),
    };
    Ok(Some(Box::new(Pictures {
        files,
        order,
        taken,
    })))
}

/// Number of the pictures at a checkpoint. None: the scene asks for none.
pub(crate) fn taken_until(scene: &Scene, progress: &Progress) -> Result<Option<usize>> {
    let every_s = scene.output.as_ref().and_then(|output| output.pictures_s);
    let count = every_s.map(|_| position(progress, NAME).map(|taken: Taken| taken.count));
    count.transpose()
}

impl Output for Pictures {
    fn is_due(&self, state: &State) -> bool {
        due(state, self.order.every_s, self.taken.next)
    }

    fn write(&mut self, now: &Moment<'_>) -> Result<()> {
        let state = now.state;
        if !(now.is_last || self.is_due(state)) {
            return Ok(());
        }
        self.taken.next = next(state, self.order.every_s);
        let (view, every_s) = (&self.order.view, self.order.every_s);
        let image = view.picture(state, now.bodies, every_s);
        self.files.append(&to_png(&image, Compression::Fast)?)?;
        self.taken.count = self.files.count();
        Ok(())
    }

    fn save(&self) -> Result<Saved> {
        Saved::new(&self.taken, Vec::new())
    }

    fn note(&self, state: &State) -> Option<String> {
        let (outside, all) = (self.order.view.outside(state), state.particles.len());
        let is_much = outside as f64 > MUCH * all as f64;
        is_much.then(|| {
            format!(
                "{outside} of {all} particles are outside the pictures at the end: dem-run picture FOLDER --output film.gif makes a film that shows more"
            )
        })
    }
}
