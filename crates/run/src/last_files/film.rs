//! A film of the pictures of a run, and some of them side by side.

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

/// Largest number of pictures in memory: the film needs each twice.
const MOST_KEPT: usize = 80;

pub(super) fn write(folder: &ResultsFolder, count: usize) -> Result<()> {
    let files = PictureFiles::continue_at(folder, count)?;
    let mut kept: BTreeMap<usize, Rc<Image>> = BTreeMap::new();
    let mut picture = |number: usize| {
        if let Some(image) = kept.get(&number) {
            return Ok(Rc::clone(image));
        }
        let image = Rc::new(read_png(&folder.picture(number))?);
        if kept.len() < MOST_KEPT {
            kept.insert(number, Rc::clone(&image));
        }
        Ok(image)
    };
    let chosen = chosen_for_strip(count).into_iter();
    let small = chosen.map(|number| picture(number).map(|image| image.reduced(SMALLER)));
    let small = small.collect::<Result<Vec<Image>>>()?;
    let strip = to_png(&film_strip(&small, COLUMNS), Compression::High)?;
    let chosen = chosen_for_film(count);
    let film = animation(chosen.len() as u32, delay_ms(chosen.len()), |k| {
        picture(chosen[k as usize])
    })?;
    files.write_film(&strip, &film)
}
