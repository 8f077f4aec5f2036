//! The bodies that a study packs itself: `[pack.NAME]`.

use std::path::{Path, PathBuf};

use dem_io::hash::{file_hash, fnv1a_of_parts};
use dem_scene::study::{BODY, Setting, Study};

/// Folder of the packings in that of the study.
pub const PACKINGS: &str = "packings";

/// A body with the options of one run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Packing {
    /// Name of the body in the scene.
    pub body: String,
    /// Arguments of `dem-pack`, the shape first.
    pub arguments: Vec<String>,
    /// Its file. Runs with the same shape and options share it.
    pub file: PathBuf,
    /// Its place in the study.
    pub place: String,
}

impl Packing {
    /// The setting that gives the body its file.
    pub(crate) fn setting(self) -> Setting {
        Setting {
            path: format!("{BODY}{}", self.body),
            value: self.file.display().to_string(),
            place: self.place,
        }
    }
}

/// The packings of a run with these settings.
pub(crate) fn packings(study: &Study, settings: &[&Setting]) -> Vec<Packing> {
    let of = |pack: &dem_scene::study::Pack| {
        let arguments = pack.arguments(settings);
        let name = format!("{}-{:016x}.vtp", pack.body, hash(&arguments));
        Packing {
            body: pack.body.clone(),
            arguments,
            file: study.packings.join(name),
            place: pack.place.clone(),
        }
    };
    study.packs.iter().map(of).collect()
}

/// Hash of some arguments, and of the files among them.
fn hash(arguments: &[String]) -> u64 {
    let file = |word: &String| {
        let name = word.rsplit(['=', ':']).next().unwrap_or_default();
        file_hash(Path::new(name)).unwrap_or_default().to_le_bytes()
    };
    let files: Vec<[u8; 8]> = arguments.iter().map(file).collect();
    let words = arguments.iter().map(|word| word.as_bytes());
    // No argument has a zero byte.
    let parts: Vec<&[u8]> = words
        .flat_map(|word| [word, &[0]])
        .chain(files.iter().map(|file| &file[..]))
        .collect();
    fnv1a_of_parts(&parts)
}
