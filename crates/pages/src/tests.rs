//! The pages have the tables of this program, and scenes take what it sets.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use dem_io::Body;
use dem_results::folder::{Existing, ResultsFolder};
use dem_run::{RunSettings, plan, run};
use dem_scene::{read_scene, scene_from_text};

use crate::bench::{Failed, Run, finished, root};
use crate::cells::{scattered, thousands};
use crate::table::{Table, parts, place, rows};
use crate::{
    COMMANDS, alumina, board, bodies, bulk, calibration, calibration_cases, concrete, dynamic,
    fracture, laboratory, packing, parameters, pressing, process, replacement, resolution, rocks,
    round_robin, self_contact, thesis,
};

fn tables() -> Vec<Table> {
    let mut all = Vec::new();
    all.extend(alumina::tables());
    all.extend(board::tables().unwrap());
    all.push(bodies::table());
    all.extend(bulk::tables());
    all.extend(calibration::tables());
    all.extend(calibration_cases::tables());
    all.extend(concrete::tables());
    all.extend(dynamic::tables());
    all.extend(fracture::tables());
    all.extend(laboratory::tables());
    all.extend(packing::tables());
    all.extend(parameters::tables().unwrap());
    all.extend(pressing::tables());
    all.extend(process::tables());
    all.extend(replacement::tables());
    all.extend(resolution::tables());
    all.extend(rocks::tables());
    all.extend(round_robin::tables());
    all.extend(self_contact::tables());
    all.extend(thesis::page::tables(Path::new("no such folder")));
    all
}

/// The pages, from the root of the repository.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec![PathBuf::from("README.md")];
    for folder in [
        "doc",
        "doc/inside",
        "tests/verification",
        "tests/calibrations",
        "data/bodies",
    ] {
        let files = std::fs::read_dir(root().join(folder)).unwrap();
        let names = files.map(|file| Path::new(folder).join(file.unwrap().file_name()));
        pages.extend(names.filter(|name| name.extension().is_some_and(|end| end == "md")));
    }
    pages
}

/// What is read from a run, in this process, of a scene of the repository with these `--set` values
/// and this body.
pub(crate) fn in_place<T>(
    scene: &str,
    keys: &[String],
    (name, body): (&str, &Body),
    read: impl FnOnce(&Run) -> Result<T, Failed>,
) -> Result<T, Failed> {
    let text = std::fs::read_to_string(root().join(scene))?;
    let scene = scene_from_text(&text, scene, keys)?;
    let plan = plan(&scene, [(name.to_owned(), body.clone())].into(), 1, false)?;
    let parent = tempfile::tempdir()?;
    let folder = ResultsFolder::create(&parent.path().join("out"), Existing::Refuse)?;
    let settings = RunSettings {
        folder: Some(&folder),
        resume: None,
        test: None,
        setup: None,
        threads: 1,
        interrupted: &AtomicBool::new(false),
    };
    run(plan, &scene, settings, &|_| ())?;
    read(&finished(&parent.path().join("out")).unwrap())
}

/// The words of the tables of a page that this program writes, in their order.
fn words(page: &str) -> Vec<String> {
    let lines = page.lines();
    let markers = lines.filter_map(|line| line.strip_prefix("<!-- table: ")?.strip_suffix(" -->"));
    let others = ["cargo bench ", "tests/"];
    markers
        .filter(|words| !others.iter().any(|other| words.starts_with(other)))
        .map(str::to_owned)
        .collect()
}

/// Every marker names a table that this program writes, and the other way round. Heads and first
/// cells are as it writes them, and every row has all of its cells.
#[test]
fn the_pages_have_the_tables_of_this_program() {
    let mut on_pages: Vec<(String, String)> = Vec::new();
    for page in pages() {
        let text = std::fs::read_to_string(root().join(&page)).unwrap();
        let page = page.to_str().unwrap().replace('\\', "/");
        on_pages.extend(words(&text).into_iter().map(|words| (page.clone(), words)));
    }
    let tables = tables();
    let owned = |table: &Table| (table.page.to_owned(), table.words.to_owned());
    let mut written: Vec<(String, String)> = tables.iter().map(owned).collect();
    on_pages.sort();
    written.sort();
    assert_eq!(on_pages, written);

    for (at, table) in tables.iter().enumerate() {
        let what = format!("{}: {}", table.page, table.words);
        assert!(
            COMMANDS.iter().any(|(words, _)| *words == table.words),
            "{what}"
        );
        let page = std::fs::read_to_string(root().join(table.page)).unwrap();
        let [_, text, _] = parts(&page, table.words, place(&tables, at)).unwrap();
        let found = rows(text);
        assert_eq!(found[0], table.head, "{what}");
        for row in &found {
            assert_eq!(row.len(), table.head.len(), "{what}: {row:?}");
        }
        let first = |rows: &[Vec<String>]| -> Vec<String> {
            rows.iter().map(|row| row[0].clone()).collect()
        };
        let (shown, mut known) = (first(&found[1..]), first(&table.rows));
        if known.is_empty() {
            assert!(shown.len() > 1, "{what}");
            continue;
        }
        if table.words.starts_with("thesis") {
            // It leaves out rows without results.
            let mut left = shown.iter().peekable();
            known.retain(|cell| left.next_if_eq(&cell).is_some());
        }
        assert_eq!(shown, known, "{what}");
    }
}

/// The board has the numbers that stand on the other pages now.
#[test]
fn the_board_has_the_numbers_of_the_pages() {
    let tables = board::tables().unwrap();
    let page = std::fs::read_to_string(root().join(tables[0].page)).unwrap();
    for (at, table) in tables.iter().enumerate() {
        let [_, text, _] = parts(&page, table.words, place(&tables, at)).unwrap();
        assert_eq!(text, table.markdown().unwrap(), "run dem-pages board page");
    }
}

/// The keys that are set exist in the scenes.
#[test]
fn scenes_take_what_tables_set() {
    let mut asked: Vec<(&str, &[&str])> = vec![("tension", &calibration::SETS)];
    for seed in laboratory::SEEDS {
        asked.push(("four-point-bending", laboratory::bending_sets(seed)));
    }
    for (scene, _) in laboratory::DISC_AND_BAR {
        asked.push((scene, &[]));
    }
    for (scene, sets) in asked {
        let path = root().join(format!("data/scenes/{scene}.toml"));
        let plain = read_scene(&path, &[]).unwrap();
        let owned: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let changed = read_scene(&path, &owned).unwrap_or_else(|e| panic!("{sets:?}: {e}"));
        assert!(sets.is_empty() || plain != changed, "{scene}: {sets:?}");
    }
}

#[test]
fn cells_hold_mean_and_scatter() {
    assert_eq!(scattered(&[1.0, 3.0], 1, "N"), "2.0 N +- 1.4 N");
    assert_eq!(scattered(&[1.0, 3.0, f64::NAN], 0, ""), "2 +- 1 (2 of 3)");
    assert_eq!(scattered(&[f64::NAN], 0, "N"), "");
    assert_eq!(thousands(1_234_567.0), "1,234,567");
    assert_eq!(thousands(999.0), "999");
}
