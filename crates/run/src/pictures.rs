//! Pictures taken during a run, and the film made of them at the end.

use std::collections::BTreeMap;
use std::rc::Rc;

use dem_io::Result;
use dem_pictures::Image;
use dem_pictures::animation::animation;
use dem_pictures::film::{
    COLUMNS, SMALLER, chosen_for_film, chosen_for_strip, delay_ms, film_strip,
};
use dem_pictures::png_file::{Compression, read_png, to_png};
use dem_results::{PictureFiles, ResultsFolder};
use dem_scene::Scene;
use serde::{Deserialize, Serialize};

use super::schedule::{due, first_after, next};
use crate::output::pictures::View;
use crate::output::pictures::scale::Scale;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;

/// Largest memory for pictures of which the film will be made: about 80 of the usual size.
const MOST_KEPT_BYTES: usize = 128 << 20;

/// Data of the pictures in a checkpoint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Taken {
    every_s: f64,
    next: u64,
    count: usize,
}

/// Fraction of the particles outside the pictures of which a note tells.
const MUCH: f64 = 0.05;

/// View and interval of the pictures of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Order {
    view: View,
    every_s: f64,
}

impl Order {
    /// From the initial state and bodies. None: no pictures.
    pub(super) fn of(scene: &Scene, start: &State, bodies: &[PlacedBody]) -> Option<Self> {
        let output = scene.output.as_ref()?;
        let every_s = output.pictures_s?;
        let scale = Scale::of(output.colour_by, start, bodies);
        Some(Self {
            every_s,
            view: View::of(start, output.view_from, scale),
        })
    }
}

/// The pictures of a run.
#[derive(Debug)]
pub(super) struct Pictures {
    files: PictureFiles,
    album: Album,
    order: Order,
    taken: Taken,
}

impl Pictures {
    /// No pictures yet, or those of a run that is resumed in this state.
    ///
    /// # Errors
    /// Those of the files.
    pub(super) fn open(
        folder: &ResultsFolder,
        order: Order,
        continued: Option<(&State, Taken)>,
    ) -> Result<Self> {
        let every_s = order.every_s;
        let (files, next) = match continued {
            None => (PictureFiles::create(folder), 0),
            Some((state, before)) => {
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
        Ok(Self {
            files,
            album: Album::new(folder),
            order,
            taken,
        })
    }

    /// Their data for a checkpoint.
    pub(super) fn taken(&self) -> Taken {
        self.taken
    }

    /// Whether the next one is due.
    pub(super) fn are_due(&self, state: &State) -> bool {
        due(state, self.order.every_s, self.taken.next)
    }

    /// Takes one.
    ///
    /// # Errors
    /// Those of the files.
    pub(super) fn take(&mut self, state: &State, bodies: &[PlacedBody]) -> Result<()> {
        self.taken.next = next(state, self.order.every_s);
        let image = self.order.view.picture(state, bodies, self.order.every_s);
        self.files.append(&to_png(&image, Compression::Fast)?)?;
        self.album.keep(self.taken.count, &Rc::new(image));
        self.taken.count = self.files.count();
        Ok(())
    }

    /// A note if much of this state, the last of the run, is outside of them.
    pub(super) fn note(&self, state: &State) -> Option<String> {
        let (outside, all) = (self.order.view.outside(state), state.particles.len());
        let is_much = outside as f64 > MUCH * all as f64;
        is_much.then(|| {
            format!(
                "{outside} of {all} particles are outside the pictures at the end: dem-run picture FOLDER --output film.gif makes a film that shows more"
            )
        })
    }

    /// Writes a sheet of some of them side by side, and a film of all or many.
    ///
    /// # Errors
    /// Those of the files.
    pub(super) fn finish(&mut self) -> Result<()> {
        let album = &mut self.album;
        let chosen = chosen_for_strip(self.taken.count);
        let small = |number: usize| album.picture(number).map(|image| image.reduced(SMALLER));
        let frames = chosen
            .into_iter()
            .map(small)
            .collect::<Result<Vec<Image>>>()?;
        let strip = to_png(&film_strip(&frames, COLUMNS), Compression::High)?;
        let chosen = chosen_for_film(self.taken.count);
        let film = animation(chosen.len() as u32, delay_ms(chosen.len()), |k| {
            album.picture(chosen[k as usize])
        })?;
        self.files.write_film(&strip, &film)
    }
}

/// The pictures of a results folder, kept in memory as far as that is allowed.
#[derive(Debug)]
struct Album {
    folder: ResultsFolder,
    kept: BTreeMap<usize, Rc<Image>>,
    kept_bytes: usize,
}

impl Album {
    /// Of this folder, with no picture in memory.
    fn new(folder: &ResultsFolder) -> Self {
        Self {
            folder: folder.clone(),
            kept: BTreeMap::new(),
            kept_bytes: 0,
        }
    }

    fn keep(&mut self, number: usize, image: &Rc<Image>) {
        let bytes = image.rgb().len();
        if self.kept_bytes + bytes <= MOST_KEPT_BYTES {
            self.kept_bytes += bytes;
            self.kept.insert(number, image.clone());
        }
    }

    /// The picture of this number, read from its file if it is not in memory.
    ///
    /// # Errors
    /// Its file cannot be read.
    fn picture(&mut self, number: usize) -> Result<Rc<Image>> {
        if let Some(image) = self.kept.get(&number) {
            return Ok(image.clone());
        }
        let image = Rc::new(read_png(&self.folder.picture(number))?);
        self.keep(number, &image);
        Ok(image)
    }
}
