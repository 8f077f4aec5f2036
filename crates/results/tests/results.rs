//! The results of a run: the folder and its files, complete, readable by other programs, and the
//! same after an interruption.

mod checkpoints;
mod discharge;
mod folder;
mod fragments;
mod frames;
mod pictures;
mod stored_frame;
mod tables;
mod walls;

use std::path::{Path, PathBuf};

use dem_results::{Existing, ResultsFolder};

fn results_in(parent: &tempfile::TempDir) -> ResultsFolder {
    ResultsFolder::create(&parent.path().join("out"), Existing::Refuse).unwrap()
}

/// All files of a folder and its subfolders except its lock, with their bytes.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(contents(&path));
        } else if !path.ends_with(".lock") {
            let bytes = std::fs::read(&path).unwrap();
            found.push((path, bytes));
        }
    }
    found.sort();
    found
}
