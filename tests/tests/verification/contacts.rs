//! Impacts, head-on and oblique, rolling and attraction, compared with closed forms.

mod attraction;
mod ball;
mod beside_bond;
pub(crate) mod impact;
mod plane;

use self::attraction::{adhesion, liquid_bridge};
use self::beside_bond::beside_bond;
use self::impact::{elastic, oblique, oblique_linear, restitution, restitution_as_planned};
use self::plane::{held, incline, rolling_friction, sliding_to_rolling};
use super::page::{assert_shown, filled, on_one_thread};

/// The page of contacts equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [durations, overlaps, speeds] = elastic();
        let [velocities, spins] = oblique();
        let [along, turn] = incline();
        filled(
            include_str!("contacts.md"),
            &[
                ("durations", durations),
                ("overlaps", overlaps),
                ("speeds", speeds),
                ("restitution", restitution()),
                ("restitution as planned", restitution_as_planned()),
                ("oblique velocities", velocities),
                ("oblique spins", spins),
                ("oblique linear", oblique_linear()),
                ("sliding to rolling", sliding_to_rolling()),
                ("incline", along),
                ("incline spins", turn),
                ("rolling friction", rolling_friction()),
                ("held", held()),
                ("adhesion", adhesion()),
                ("liquid bridge", liquid_bridge()),
                ("contact beside a bond", beside_bond()),
            ],
        )
    });
    assert_shown(&[("contacts.md".to_owned(), page)]);
}
