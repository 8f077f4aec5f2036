//! A run that is interrupted and continued writes the same fragments.

use std::fs;
use std::io::Write;

use dem_results::checkpoint::read_checkpoint;
use dem_results::folder::names;
use dem_results::{Existing, ResultsFolder};
use dem_runner::snapshot::Snapshot;

use super::burst::{burst, bursting, planned, run_into};

#[test]
fn after_an_interruption_the_tables_are_the_same_bytes() {
    let (_whole_parent, whole, _) = burst();
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("out");
    let scene = bursting();
    let folder = ResultsFolder::create(&path, Existing::Refuse).unwrap();
    // Before the first bond breaks.
    run_into(&folder, planned(&scene), &scene, None, 0.02).unwrap_err();
    let kept = fs::read(folder.file(names::FRAGMENTS)).unwrap();
    assert_eq!(kept.iter().filter(|byte| **byte == b'\n').count(), 3);
    drop(folder);
    // Rows after the checkpoint, of which the last one is incomplete.
    let file = fs::OpenOptions::new()
        .append(true)
        .open(path.join("fragments.csv"));
    file.unwrap().write_all(&kept[..kept.len() - 7]).unwrap();
    let folder = ResultsFolder::create(&path, Existing::Continue).unwrap();
    let snapshot =
        Snapshot::from_bytes(&read_checkpoint(&folder.file(names::CHECKPOINT)).unwrap()).unwrap();
    run_into(&folder, planned(&scene), &scene, Some(snapshot), 2.0).unwrap();
    for name in [
        "fragments.csv",
        "fragment-tree.csv",
        "events.csv",
        "series.csv",
        "plots/fragments.svg",
        "plots/fragment_sizes.svg",
        "frames/frame_000005.vtp",
    ] {
        let [one, other] = [&whole, &folder].map(|f| fs::read(f.path().join(name)).unwrap());
        assert!(one == other, "{name}");
    }
}

#[test]
fn a_table_of_fragments_that_is_gone_is_told() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("out");
    let scene = bursting();
    let folder = ResultsFolder::create(&path, Existing::Refuse).unwrap();
    run_into(&folder, planned(&scene), &scene, None, 0.02).unwrap_err();
    fs::remove_file(folder.file(names::FRAGMENTS)).unwrap();
    let snapshot =
        Snapshot::from_bytes(&read_checkpoint(&folder.file(names::CHECKPOINT)).unwrap()).unwrap();
    let error = run_into(&folder, planned(&scene), &scene, Some(snapshot), 2.0).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.place.ends_with("fragments.csv"), "{error}");
    assert!(
        error.problem.starts_with("there is no such file"),
        "{error}"
    );
}
