//! Breakage of one bond, by every criterion, at every rate, and of many with scattered strengths.

mod block;
mod bond;
mod energy;
mod rate;
mod residual;
mod scatter;
mod strength;

use self::block::{by_bending, by_block};
use self::energy::{by_cycle, by_energy, by_mode};
use self::rate::by_rate;
use self::residual::residual;
use self::scatter::scatter;
use self::strength::{by_displacement, by_load};
use super::page::{assert_shown, filled, on_one_thread};

/// The page of failure equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [rates, from] = by_rate();
        filled(
            include_str!("failure.md"),
            &[
                ("by displacement", by_displacement()),
                ("by load", by_load()),
                ("by energy", by_energy()),
                ("by mode", by_mode()),
                ("by cycle", by_cycle()),
                ("by block", by_block()),
                ("by bending", by_bending()),
                ("residual", residual()),
                ("rates", rates),
                ("rates from 1.1", from),
                ("scatter", scatter()),
            ],
        )
    });
    assert_shown(&[("failure.md".to_owned(), page)]);
}
