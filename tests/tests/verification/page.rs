//! The page `tests/verification/README.md` and its plots are what the solver gives.

use std::fs;
use std::path::{Path, PathBuf};

use super::cases::on_one_thread;
use super::tables::{
    of_case1, of_case2, of_case3, of_case4, of_case5, of_stiffnesses, of_whole_load,
};

const TEXT: &str = include_str!("page.md");

/// Runs all five cases, holds each against its exact solution, and the page against what came out.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("verification");
    let renew = std::env::var_os("RENEW_VERIFICATION").is_some();
    let mut old = Vec::new();
    for (name, content) in on_one_thread(files) {
        let path: PathBuf = folder.join(&name);
        if fs::read_to_string(&path).is_ok_and(|is| is == content) {
            continue;
        }
        if renew {
            fs::create_dir_all(&folder).unwrap();
            fs::write(&path, content).unwrap();
        } else {
            old.push(name);
        }
    }
    assert!(
        old.is_empty(),
        "tests/verification: {} no longer shows what the solver gives. If the change is meant, renew the page, look at it and commit it:\n\
         RENEW_VERIFICATION=1 cargo test --release -p dem-tests --test verification",
        old.join(", ")
    );
}

/// All files of the page.
fn files() -> Vec<(String, String)> {
    let (table1, [shape, error]) = of_case1();
    let (table2, plot2) = of_case2();
    let (table3, plot3) = of_case3();
    let (table4, plot4) = of_case4();
    let (table5, plot5) = of_case5();
    let tables = [
        ("{table 4}", table1),
        ("{table 5}", of_stiffnesses()),
        ("{whole load}", of_whole_load()),
        ("{case 2}", table2),
        ("{case 3}", table3),
        ("{case 4}", table4),
        ("{case 5}", table5),
    ];
    let mut page = TEXT.to_owned();
    for (place, table) in tables {
        assert!(page.contains(place), "{place} has no place in the page");
        page = page.replace(place, table.trim_end());
    }
    let plots = [
        ("case1.svg", shape),
        ("case1-error.svg", error),
        ("case2.svg", plot2),
        ("case3.svg", plot3),
        ("case4.svg", plot4),
        ("case5.svg", plot5),
    ];
    let mut files = vec![("README.md".to_owned(), page.clone())];
    for (name, plot) in plots {
        assert!(page.contains(name), "the page does not show {name}");
        files.push((name.to_owned(), plot.svg().file()));
    }
    files
}
