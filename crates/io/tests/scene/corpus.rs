//! Files that must be read, and files that must be refused with one message, which stands beside
//! the bad line after `#!`.

use std::path::{Path, PathBuf};

use dem_io::{read_scene, scene_from_text};

/// Fewest files that the corpus must have: an empty folder would pass.
const FEWEST_BAD: usize = 200;
const FEWEST_GOOD: usize = 11;

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/scene")
        .join(folder);
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    files.sort();
    files
}

#[test]
fn every_good_file_is_read() {
    let files = files("good");
    assert!(files.len() >= FEWEST_GOOD, "{} files", files.len());
    for path in files {
        if let Err(error) = read_scene(&path, &[]) {
            panic!("{error}");
        }
    }
}

#[test]
fn every_bad_file_is_refused_with_the_message_beside_its_line() {
    let files = files("bad");
    assert!(files.len() >= FEWEST_BAD, "{} files", files.len());
    let mut wrong = String::new();
    for path in files {
        let name = path.file_name().unwrap().to_str().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let expected: Vec<String> = text
            .lines()
            .enumerate()
            .filter_map(|(at, line)| {
                let (_, message) = line.split_once("#! ")?;
                Some(format!("{name}:{}: {message}", at + 1))
            })
            .collect();
        assert_eq!(expected.len(), 1, "{name}: messages expected");
        let got = match scene_from_text(&text, name, &[]) {
            Ok(_) => format!("{name} is read"),
            Err(error) => {
                assert_eq!(error.exit_code(), 2, "{name}");
                error.to_string()
            }
        };
        if got != expected[0] {
            wrong.push_str(&format!("expected {}\ngot      {got}\n", expected[0]));
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}
