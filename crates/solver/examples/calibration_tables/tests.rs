//! The page has the tables of this program, and its scenes take what the program sets.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use dem_scene::read_scene;

use super::programs::root;
use super::table::{Table, head};
use super::{breaks, scatter, stiffness};

/// The rows of the table of the page that has this word, as cells.
fn rows(table: &Table) -> Vec<Vec<String>> {
    let page = std::fs::read_to_string(root().join("doc/calibration.md")).unwrap();
    let (_, rest) = page.split_once(&table.markdown()).unwrap();
    let lines = rest
        .lines()
        .skip(1)
        .take_while(|line| line.starts_with('|'));
    let cells = |line: &str| {
        line.trim_matches('|')
            .split('|')
            .map(str::trim)
            .map(str::to_owned)
            .collect()
    };
    lines.map(cells).collect()
}

/// Command and head of each table stand on the page as they are printed, with the rows of the
/// program; the head of `sizes` depends on its record.
#[test]
fn the_page_has_the_tables_of_this_program() {
    let ratios = scatter::RATIOS.map(|(ratio, ..)| ratio.to_string());
    let diameters = stiffness::SIZES.map(|(diameters, _)| diameters.to_owned());
    let broken = breaks::SIZES.map(str::to_owned);
    let tables = [
        ("scatter", &scatter::HEAD[..], &ratios[..]),
        ("stiffness", &stiffness::HEAD, &diameters),
        ("breaks", &breaks::HEAD, &broken),
    ];
    for (word, names, first) in tables {
        let head = head(names);
        let rows = rows(&Table {
            word,
            head,
            rows: Vec::new(),
        });
        let of_page: Vec<&str> = rows.iter().map(|row| row[0].as_str()).collect();
        assert_eq!(of_page, first);
        for row in &rows {
            assert_eq!(row.len(), names.len(), "{row:?}");
        }
    }
}

#[test]
fn scenes_take_what_tests_set() {
    let asked: [(&str, &[&str]); 3] = [
        ("tension", &scatter::SETS),
        ("four-point-bending", &[breaks::NO_RATE_CHECK]),
        ("four-point-bending", &[breaks::STATIC]),
    ];
    for (scene, sets) in asked {
        let path = root().join(format!("data/scenes/{scene}.toml"));
        let read = |sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
            read_scene(Path::new(&path), &sets).unwrap()
        };
        assert_ne!(read(sets), read(&[]));
    }
}
