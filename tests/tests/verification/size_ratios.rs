//! Friction between spheres of very different size.

mod mixture;
mod neck;
mod wedge;

use super::page::{assert_shown, filled, on_one_thread};

/// The ratios of the radii.
const RATIOS: [f64; 5] = [3.0, 10.0, 20.0, 50.0, 100.0];

/// The page of size ratios equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [by_lammps, version] = neck::by_lammps();
        filled(
            include_str!("size-ratios.md"),
            &[
                ("neck", neck::rolls_off()),
                ("lammps", by_lammps),
                ("version", version),
                ("wedge", wedge::held()),
                ("mixture", mixture::settles()),
            ],
        )
    });
    assert_shown(&[("size-ratios.md".to_owned(), page)]);
}
