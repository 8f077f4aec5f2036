//! Pictures of a run: one PNG file each, `pictures/picture-00000.png` and so on. Their content is
//! determined by the program that draws them.

use std::path::Path;

use super::folder::ResultsFolder;
use super::folder::names;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::write_file;

/// The pictures of a run so far.
#[derive(Debug)]
pub struct PictureFiles {
    folder: ResultsFolder,
    count: usize,
}

impl PictureFiles {
    /// No pictures yet. Nothing is written before the first.
    pub fn create(folder: &ResultsFolder) -> Self {
        Self {
            folder: folder.clone(),
            count: 0,
        }
    }

    /// The first `count` pictures of an interrupted run, up to its checkpoint. Later ones are
    /// removed; a missing one is refused (exit code 2).
    pub fn continue_at(folder: &ResultsFolder, count: usize) -> Result<Self> {
        let mut paths = (0..count).map(|number| folder.picture(number));
        if let Some(path) = paths.find(|path| !path.is_file()) {
            return Err(Diagnostic::input(
                path.display().to_string(),
                "this picture is missing, which was there when the checkpoint was written",
                "put it back, or start the run again without --resume",
            ));
        }
        folder.remove_pictures_from(count)?;
        Ok(Self {
            folder: folder.clone(),
            count,
        })
    }

    /// Writes the next picture, given as the bytes of a PNG file; an error keeps earlier ones.
    pub fn append(&mut self, png: &[u8]) -> Result<()> {
        self.folder.make_pictures_folder()?;
        write_bytes(&self.folder.picture(self.count), png)?;
        self.count += 1;
        Ok(())
    }

    /// Number of pictures, stored in a checkpoint for [`PictureFiles::continue_at`].
    pub fn count(&self) -> usize {
        self.count
    }

    /// Writes some pictures side by side to `film-strip.png`, and one after the other to
    /// `film.png`: both as the bytes of a PNG file. Replaces earlier ones.
    pub fn write_film(&self, strip: &[u8], film: &[u8]) -> Result<()> {
        write_bytes(&self.folder.file(names::FILM_STRIP), strip)?;
        write_bytes(&self.folder.file(names::FILM), film)
    }
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    write_file(path, |out| out.write_all(bytes))
}
