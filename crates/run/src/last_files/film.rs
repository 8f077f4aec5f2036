//! A film of the pictures of a run, and some of them side by side.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;

use dem_io::Result;
use dem_pictures::Image;
use dem_pictures::animation::animation;
use dem_pictures::film::{
    COLUMNS, SMALLER, chosen_for_film, chosen_for_strip, delay_ms, film_strip,
};
use dem_pictures::png_file::{Compression, read_png, to_png};
use dem_results::{PictureFiles, ResultsFolder};

use super::Drawing;

/// Largest memory for pictures, which the film needs twice: about 80 of the usual size.
const MOST_KEPT_BYTES: usize = 128 << 20;

pub(super) fn paths(run: &Drawing<'_>) -> Vec<PathBuf> {
    let paths = [run.folder.film(), run.folder.film_strip()];
    run.pictures.map_or(Vec::new(), |_| paths.to_vec())
}

pub(super) fn write(run: &Drawing<'_>) -> Result<()> {
    let Some(count) = run.pictures else {
        return Ok(());
    };
    let files = PictureFiles::continue_at(run.folder, count)?;
    let mut album = Album {
        folder: run.folder,
        kept: BTreeMap::new(),
        kept_bytes: 0,
    };
    let small = |number: usize| album.picture(number).map(|image| image.reduced(SMALLER));
    let chosen = chosen_for_strip(count).into_iter();
    let frames = chosen.map(small).collect::<Result<Vec<Image>>>()?;
    let strip = to_png(&film_strip(&frames, COLUMNS), Compression::High)?;
    let chosen = chosen_for_film(count);
    let film = animation(chosen.len() as u32, delay_ms(chosen.len()), |k| {
        album.picture(chosen[k as usize])
    })?;
    files.write_film(&strip, &film)
}

/// The pictures of a results folder, kept in memory as far as that is allowed.
struct Album<'a> {
    folder: &'a ResultsFolder,
    kept: BTreeMap<usize, Rc<Image>>,
    kept_bytes: usize,
}

impl Album<'_> {
    fn picture(&mut self, number: usize) -> Result<Rc<Image>> {
        if let Some(image) = self.kept.get(&number) {
            return Ok(image.clone());
        }
        let image = Rc::new(read_png(&self.folder.picture(number))?);
        let bytes = image.rgb().len();
        if self.kept_bytes + bytes <= MOST_KEPT_BYTES {
            self.kept_bytes += bytes;
            self.kept.insert(number, image.clone());
        }
        Ok(image)
    }
}
