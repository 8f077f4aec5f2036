//! Static cases of Chen et al. 2022, run to rest by time stepping, and the page about them.

mod bar;
mod cases;
mod models;
mod others;
mod statics;
mod tables;

use self::others::of_others;
use self::tables::{
    of_case1, of_case2, of_case3, of_case4, of_case5, of_stiffnesses, of_whole_load,
};
use super::page::{assert_shown, filled, on_one_thread};

/// Runs all five cases, and compares each with its exact solution, and the page with the results.
#[test]
fn the_page_shows_what_the_solver_gives() {
    assert_shown(&on_one_thread(files));
}

/// All files of the page.
fn files() -> Vec<(String, String)> {
    let (table1, [shape, error]) = of_case1();
    let (table2, plot2) = of_case2();
    let (table3, plot3) = of_case3();
    let (table4, plot4) = of_case4();
    let (table5, plot5) = of_case5();
    let tables = [
        ("table 4", table1),
        ("table 5", of_stiffnesses()),
        ("whole load", of_whole_load()),
        ("case 2", table2),
        ("case 3", table3),
        ("case 4", table4),
        ("case 5", table5),
        ("others", of_others()),
    ];
    let page = filled(include_str!("cantilevers.md"), &tables);
    let plots = [
        ("case1.svg", shape),
        ("case1-error.svg", error),
        ("case2.svg", plot2),
        ("case3.svg", plot3),
        ("case4.svg", plot4),
        ("case5.svg", plot5),
    ];
    let mut files = vec![("cantilevers.md".to_owned(), page.clone())];
    for (name, plot) in plots {
        assert!(page.contains(name), "the page does not show {name}");
        files.push((name.to_owned(), plot.svg().file()));
    }
    files
}
