//! The bodies that a study packs itself: `[pack.NAME]`.

use std::path::PathBuf;

use dem_io::hash::fnv1a_of_parts;
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
        let name = format!("{}-{:016x}.vtp", pack.body, hash(&arguments, pack.content));
        Packing {
            body: pack.body.clone(),
            arguments,
            file: study.packings.join(name),
            place: pack.place.clone(),
        }
    };
    study.packs.iter().map(of).collect()
}

/// Hash of some arguments, and of the files that they name.
fn hash(arguments: &[String], content: u64) -> u64 {
    let content = content.to_le_bytes();
    // No argument has a zero byte.
    let words = arguments.iter().flat_map(|word| [word.as_bytes(), &[0]]);
    let parts: Vec<&[u8]> = words.chain([&content[..]]).collect();
    fnv1a_of_parts(&parts)
}
