//! Files that must be read, and files that must be refused with one message, which is in
//! `bad/messages.txt`.

use std::path::{Path, PathBuf};

use dem_scene::{read_scene, scene_from_text};
use dem_testing::hold_messages;

/// Smallest number of files in the corpus: an empty folder would pass.
const FEWEST_BAD: usize = 200;
const FEWEST_GOOD: usize = 11;

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

fn own(folder: &str) -> Vec<PathBuf> {
    files(
        &Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests/scene")
            .join(folder),
    )
}

#[test]
fn every_good_file_is_read() {
    let files = own("good");
    assert!(files.len() >= FEWEST_GOOD, "{} files", files.len());
    for path in files {
        if let Err(error) = read_scene(&path, &[]) {
            panic!("{error}");
        }
    }
}

#[test]
fn every_bad_file_is_refused_with_its_message() {
    let files = own("bad");
    assert!(files.len() >= FEWEST_BAD, "{} files", files.len());
    let refused = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        match scene_from_text(&text, name, &[]) {
            Ok(_) => format!("{name} is read"),
            Err(error) => {
                assert_eq!(error.exit_code(), 2, "{name}");
                error.to_string()
            }
        }
    };
    let messages: Vec<String> = files.iter().map(refused).collect();
    hold_messages(files[0].parent().unwrap(), &messages);
}
