//! The folder: refusals, removed files, and names.

use std::fs;

use dem_results::folder::names;
use dem_results::{Existing, ResultsFolder, write_json};
use tempfile::tempdir;

use super::{contents, results_in};

#[test]
fn names_in_the_folder() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let at = |name: &str| parent.path().join("out").join(name);
    assert_eq!(folder.frame(123), at("frames/frame_000123.vtp"));
    assert_eq!(folder.frame(1_234_567), at("frames/frame_1234567.vtp"));
    assert_eq!(folder.file(names::INDEX), at("frames.pvd"));
    assert_eq!(folder.picture(123), at("pictures/picture-00123.png"));
    assert_eq!(folder.picture(123_456), at("pictures/picture-123456.png"));
    assert_eq!(folder.file(names::FILM_STRIP), at("film-strip.png"));
    assert_eq!(folder.file(names::FILM), at("film.png"));
    assert_eq!(folder.file(names::SERIES), at("series.csv"));
    assert_eq!(folder.file(names::EVENTS), at("events.csv"));
    assert_eq!(folder.file(names::FRAGMENTS), at("fragments.csv"));
    assert_eq!(folder.file(names::FRAGMENT_TREE), at("fragment-tree.csv"));
    assert_eq!(folder.file(names::SUMMARY), at("summary.json"));
    assert_eq!(folder.file(names::CHECKPOINT), at("checkpoint.dem"));
    assert_eq!(folder.plot("a/b: c"), at("plots/a_b_ c.svg"));
    assert!(contents(folder.path()).is_empty());
}

#[test]
fn a_folder_with_something_in_it_is_refused() {
    let parent = tempdir().unwrap();
    let path = parent.path().join("out");
    fs::create_dir(&path).unwrap();
    ResultsFolder::create(&path, Existing::Refuse).expect("an empty folder will do");
    fs::write(path.join("notes.txt"), "mine").unwrap();
    let error = ResultsFolder::create(&path, Existing::Refuse).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert_eq!(error.problem, "this folder is not empty");
    assert!(error.remedy.contains("--force") && error.remedy.contains("--resume"));
}

#[test]
fn force_removes_what_a_run_wrote_and_nothing_else() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let path = folder.path();
    folder.write_plot("energy", "<svg/>").unwrap();
    fs::create_dir(path.join("frames")).unwrap();
    fs::create_dir(path.join("pictures")).unwrap();
    fs::create_dir(path.join("frames/frame_000009.vtp")).unwrap();
    let ours = [
        "frames/frame_000000.vtp",
        "frames/frame_1000000.vtp",
        "frames/walls_000000.vtp",
        "frames/walls_fixed.vtp",
        "frames/.unfinished-x1",
        "frames.pvd",
        "pictures/picture-00000.png",
        "pictures/picture-123456.png",
        "pictures/.unfinished-x2",
        "film-strip.png",
        "film.png",
        "series.csv",
        "events.csv",
        "fragments.csv",
        "fragment-tree.csv",
        "discharge.csv",
        "distribution.csv",
        "flow.csv",
        "mixing.csv",
        "wall_loads.csv",
        "wall_loads.vtp",
        "summary.json",
        "checkpoint.dem",
    ];
    let foreign = [
        "frames/frame_1.vtp",
        "frames/walls_1.vtp",
        "frames/frame_000001.vtp.bak",
        "frames/view.pvsm",
        "pictures/picture-1.png",
        "pictures/poster.png",
        "plots/mine.svg",
        "plots/notes.md",
        "drop.toml",
        "series.csv.old",
    ];
    for name in ours.iter().chain(&foreign) {
        fs::write(path.join(name), "<svg/>").unwrap();
    }
    let path = &path.to_owned();
    drop(folder);
    ResultsFolder::create(path, Existing::Continue).unwrap();
    // Only the remains of two killed writes are gone, and there is a plot.
    assert_eq!(contents(path).len(), ours.len() - 2 + foreign.len() + 1);
    ResultsFolder::create(path, Existing::Replace).unwrap();
    let mut left: Vec<_> = foreign.iter().map(|name| path.join(name)).collect();
    left.sort();
    assert_eq!(
        contents(path)
            .into_iter()
            .map(|(path, _)| path)
            .collect::<Vec<_>>(),
        left
    );
}

#[test]
fn folders_that_cannot_be() {
    let parent = tempdir().unwrap();
    for existing in [Existing::Refuse, Existing::Replace] {
        // The folders that it is in are made.
        drop(ResultsFolder::create(&parent.path().join("a/b/out"), existing).unwrap());
        let file = parent.path().join("file");
        fs::write(&file, "").unwrap();
        let error = ResultsFolder::create(&file, existing).unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(error.problem.starts_with("this is a file"), "{error}");
    }
    let error = ResultsFolder::create(&parent.path().join("b"), Existing::Continue).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.problem.contains("no such folder"), "{error}");
    let folder = results_in(&parent);
    fs::write(folder.path().join("plots"), "").unwrap();
    let error = folder.write_plot("energy", "<svg/>").unwrap_err();
    assert!(error.problem.starts_with("this is a file"), "{error}");
}

#[cfg(unix)]
#[test]
fn a_folder_that_is_read_only_is_noticed_at_once() {
    use std::os::unix::fs::PermissionsExt;
    let parent = tempdir().unwrap();
    let path = parent.path().join("out");
    fs::create_dir(&path).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o555)).unwrap();
    // A user who may write everywhere cannot test this.
    if fs::write(path.join("probe"), "").is_ok() {
        return;
    }
    let error = ResultsFolder::create(&path, Existing::Refuse).unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(error.problem.starts_with("no permission"), "{error}");
}

#[test]
fn plots_and_summaries_are_replaced_whole() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    folder.write_plot("energy", "<svg>long</svg>").unwrap();
    folder.write_plot("energy", "<svg/>").unwrap();
    let plot = fs::read_to_string(folder.plot("energy")).unwrap();
    assert_eq!(plot, "<!-- dem-run plot -->\n<svg/>");
    #[derive(serde::Serialize)]
    struct Summary {
        steps: u64,
        error: f64,
    }
    let summary = Summary {
        steps: 7,
        error: f64::NAN,
    };
    write_json(&folder.file(names::SUMMARY), &summary).unwrap();
    let text = fs::read_to_string(folder.file(names::SUMMARY)).unwrap();
    assert_eq!(text, "{\n  \"steps\": 7,\n  \"error\": null\n}\n");
    assert_eq!(contents(folder.path()).len(), 2);
}

#[test]
fn one_run_at_a_time() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let path = folder.path().to_owned();
    fs::write(folder.file(names::SUMMARY), "mine").unwrap();
    let clone = folder.clone();
    drop(folder);
    for existing in [Existing::Refuse, Existing::Replace, Existing::Continue] {
        let error = ResultsFolder::create(&path, existing).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert_eq!(error.problem, "another run is writing into it");
    }
    assert_eq!(fs::read(clone.file(names::SUMMARY)).unwrap(), b"mine");
    drop(clone);
    ResultsFolder::create(&path, Existing::Continue).unwrap();
    let error = ResultsFolder::create(&path, Existing::Refuse).unwrap_err();
    assert_eq!(error.problem, "this folder is not empty");
    ResultsFolder::create(&path, Existing::Replace).unwrap();
    // It now contains only the lock.
    ResultsFolder::create(&path, Existing::Refuse).unwrap();
}

#[test]
fn a_scene_that_is_not_that_of_a_run_is_kept() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let path = folder.path().to_owned();
    folder.write_scene("dem-run 1", "version = 1\n").unwrap();
    let written = fs::read_to_string(folder.file(names::SCENE)).unwrap();
    assert!(
        written.starts_with("# Written by dem-run (dem-run 1)"),
        "{written}"
    );
    assert!(written.ends_with("\nversion = 1\n"), "{written}");
    folder.write_scene("dem-run 2", "version = 1\n").unwrap();
    drop(folder);
    let folder = ResultsFolder::create(&path, Existing::Replace).unwrap();
    assert!(!folder.file(names::SCENE).exists());
    fs::write(folder.file(names::SCENE), "version = 1\n").unwrap();
    fs::write(folder.file(names::SUMMARY), "{}").unwrap();
    let refused = [folder.write_scene("dem-run 1", "").unwrap_err(), {
        drop(folder);
        ResultsFolder::create(&path, Existing::Replace).unwrap_err()
    }];
    for error in refused {
        assert_eq!(error.exit_code(), 2);
        assert!(error.place.ends_with("scene.toml"), "{error}");
    }
    // Nothing has been removed.
    assert!(path.join("summary.json").exists());
}
