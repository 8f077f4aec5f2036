//! Folders that appear whole.

use dem_io::whole_folder::WholeFolder;
use std::fs;
use std::path::Path;

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn nothing_stands_under_the_name_before_all_of_it() {
    let parent = tempfile::tempdir().unwrap();
    let target = parent.path().join("a/b");
    let folder = WholeFolder::beside(&target, "--output").unwrap();
    fs::write(folder.path().join("one"), "1").unwrap();
    assert!(!target.exists());
    drop(folder);
    assert!(names(&parent.path().join("a")).is_empty());
    let folder = WholeFolder::beside(&target, "--output").unwrap();
    fs::write(folder.path().join("one"), "1").unwrap();
    folder.publish().unwrap();
    assert_eq!(names(&target), ["one"]);
    assert_eq!(names(&parent.path().join("a")), ["b"]);
}

#[test]
fn an_empty_folder_is_filled_and_a_full_one_refused() {
    let parent = tempfile::tempdir().unwrap();
    let target = parent.path().join("out");
    fs::create_dir(&target).unwrap();
    for problem in [None, Some("this folder is not empty")] {
        match (WholeFolder::beside(&target, "--walls"), problem) {
            (Ok(folder), None) => {
                fs::write(folder.path().join("one"), "1").unwrap();
                folder.publish().unwrap();
            }
            (Err(refused), Some(problem)) => {
                assert_eq!(refused.problem, problem);
                assert_eq!(refused.exit_code(), 2);
                assert!(refused.remedy.contains("--walls"));
            }
            (made, _) => panic!("{made:?}"),
        }
        assert_eq!(names(&target), ["one"]);
    }
    fs::write(parent.path().join("file"), "").unwrap();
    for path in ["file", "file/out"] {
        let refused = WholeFolder::beside(&parent.path().join(path), "--output").unwrap_err();
        assert_eq!(refused.exit_code(), 2, "{refused}");
    }
    assert_eq!(names(parent.path()), ["file", "out"]);
}

#[test]
fn a_folder_filled_meanwhile_keeps_its_files() {
    let parent = tempfile::tempdir().unwrap();
    let target = parent.path().join("out");
    let folder = WholeFolder::beside(&target, "--output").unwrap();
    fs::write(folder.path().join("one"), "1").unwrap();
    fs::create_dir(&target).unwrap();
    fs::write(target.join("theirs"), "2").unwrap();
    assert!(folder.publish().is_err());
    assert_eq!(names(&target), ["theirs"]);
    assert_eq!(names(parent.path()), ["out"]);
}

#[test]
fn what_a_killed_command_left_is_removed_by_the_next() {
    let parent = tempfile::tempdir().unwrap();
    let left = parent.path().join(".unfinished-4194303-0");
    fs::create_dir(&left).unwrap();
    fs::write(left.join("half"), "1").unwrap();
    let target = parent.path().join("out");
    let live = WholeFolder::beside(&target, "--output").unwrap();
    assert!(!left.exists());
    fs::write(live.path().join("one"), "1").unwrap();
    WholeFolder::beside(&parent.path().join("other"), "--output")
        .unwrap()
        .publish()
        .unwrap();
    live.publish().unwrap();
    assert_eq!(names(&target), ["one"]);
    assert_eq!(names(parent.path()), ["other", "out"]);
}
