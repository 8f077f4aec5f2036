//! What is in the folder of a run, without taking its lock.

use std::fs;
use std::path::{Path, PathBuf};

use super::disk::entries;
use super::names::{
    FRAMES, PICTURES, PLOTS, SCENE, SINGLE_FILES, frame_number, number_in_frames, picture_number,
};
use dem_io::body::stored_walls::FIXED_WALLS_FILE;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::{UNFINISHED_PREFIX, explain};
use dem_io::write_target::is_same_file;

/// The first of `files` that is in the folder `path` under a name of results, also through a link:
/// a run that writes there would remove or overwrite it. None if there is none of them, or no such
/// folder.
pub fn result_among<'a>(path: &Path, files: &'a [PathBuf]) -> Option<&'a PathBuf> {
    let is_ours = |part: &str, name: &str| match part {
        FRAMES => number_in_frames(name).is_some() || name == FIXED_WALLS_FILE,
        PICTURES => picture_number(name).is_some(),
        PLOTS => name.ends_with(".svg"),
        _ => SINGLE_FILES.contains(&name) || name == SCENE,
    };
    for part in ["", FRAMES, PICTURES, PLOTS] {
        let Ok(entries) = fs::read_dir(path.join(part)) else {
            continue;
        };
        for entry in entries.flatten() {
            let name = entry.file_name();
            let is_result = (name.to_str())
                .is_some_and(|name| is_ours(part, name) || name.starts_with(UNFINISHED_PREFIX));
            if !is_result {
                continue;
            }
            let found = files.iter().find(|file| is_same_file(file, &entry.path()));
            if found.is_some() {
                return found;
            }
        }
    }
    None
}

/// Refuses to write results into the folder `path` if they would replace a file that the run reads.
pub fn refuse_inputs_among_results(path: &Path, inputs: &[PathBuf]) -> Result<()> {
    match result_among(path, inputs) {
        None => Ok(()),
        Some(input) => Err(Diagnostic::input(
            input.display().to_string(),
            format!(
                "this is an input of the run, and results in '{}' would take its place",
                path.display()
            ),
            "name another folder with --output, or copy the file elsewhere and name the copy",
        )),
    }
}

/// The numbers of the frames in the results folder `path`, ascending. Nothing is locked: a run may
/// be writing there.
pub fn frames_in(path: &Path) -> Result<Vec<usize>> {
    if !path.is_dir() {
        return Err(Diagnostic::input(
            path.display().to_string(),
            "there is no such folder",
            "name the folder of results of a run",
        ));
    }
    let frames = path.join(FRAMES);
    if !frames.is_dir() {
        return Ok(Vec::new());
    }
    let mut numbers = Vec::new();
    for entry in entries(&frames)? {
        let entry = entry.map_err(|error| explain(&frames, &error))?;
        let name = entry.file_name().and_then(|name| name.to_str());
        numbers.extend(name.and_then(frame_number));
    }
    numbers.sort_unstable();
    Ok(numbers)
}
