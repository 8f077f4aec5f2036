//! Pictures: numbered, continued after an interruption, complete.

use std::fs;

use dem_results::PictureFiles;
use dem_results::folder::names;
use tempfile::tempdir;

use super::{contents, results_in};

#[test]
fn pictures_are_numbered_and_go_on() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let mut pictures = PictureFiles::create(&folder);
    assert!(contents(folder.path()).is_empty());
    for k in 0..4_u8 {
        pictures.append(&[k]).unwrap();
    }
    assert_eq!(pictures.count(), 4);
    assert_eq!(fs::read(folder.picture(3)).unwrap(), [3]);
    let mut pictures = PictureFiles::continue_at(&folder, 2).unwrap();
    assert_eq!(contents(folder.path()).len(), 2);
    pictures.append(&[9]).unwrap();
    assert_eq!(pictures.count(), 3);
    assert_eq!(fs::read(folder.picture(2)).unwrap(), [9]);
    pictures.write_film(&[1, 2], &[3]).unwrap();
    pictures.write_film(&[4], &[5, 6]).unwrap();
    assert_eq!(fs::read(folder.file(names::FILM_STRIP)).unwrap(), [4]);
    assert_eq!(fs::read(folder.file(names::FILM)).unwrap(), [5, 6]);
    assert_eq!(contents(folder.path()).len(), 5);
}

#[test]
fn a_missing_picture_is_told_when_a_run_continues() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    PictureFiles::create(&folder).append(&[1]).unwrap();
    let error = PictureFiles::continue_at(&folder, 2).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.place.ends_with("picture-00001.png"), "{error}");
    // Nothing was removed.
    assert_eq!(contents(folder.path()).len(), 1);
}
