//! Files that must be read.

use std::path::{Path, PathBuf};

use dem_scene::read_scene;

/// Fewest files: an empty folder would pass.
const FEWEST: usize = 11;

/// The scenes of a folder, sorted.
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    files.sort();
    files
}

#[test]
fn every_good_file_is_read() {
    let files = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/good"));
    assert!(files.len() >= FEWEST, "{} files", files.len());
    for path in files {
        if let Err(error) = read_scene(&path, &[]) {
            panic!("{error}");
        }
    }
}
