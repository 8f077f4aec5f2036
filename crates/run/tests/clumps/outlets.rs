//! Outlets remove what comes into their regions, however short its stay there.

use std::fmt::Write;

use dem_engine::state::events::PopulationEvent;

use super::{HEAD, MEETS, block, happens, lump, planned};

/// Single spheres, clumps and bonded bodies that fly along x at 20 m/s through a region of 5 um,
/// 20 um in each step.
fn flown(region: &str) -> (u32, f64, usize) {
    let mut text = format!("{HEAD}{MEETS}");
    for n in 0..5 {
        let y = 0.02 * f64::from(n);
        let start = format!(
            "position = [{}, {y}, 0]\nvelocity = [20, 0, 0]\n",
            -0.012 - 0.0013 * f64::from(n)
        );
        writeln!(
            text,
            "[bodies.s{n}]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0, 1e-3]]\n{start}"
        )
        .unwrap();
        text += &lump(
            &format!("c{n}"),
            &format!(
                "start_as = \"clump\"\n{}",
                start.replace(", 0]\nvel", ", 0.02]\nvel")
            ),
        );
        text += &block(
            &format!("b{n}"),
            [2, 1, 1],
            2e-3,
            |_| Some(1e-3),
            &start.replace(", 0]\nvel", ", 0.04]\nvel"),
        );
    }
    text += &format!("[regions.out]\n{region}\n[outlets.out]\ninside = \"out\"\n");
    let mut state = planned(&text).state;
    state.time_step_s = 1e-6;
    state.previous_time_step_s = 1e-6;
    let mut left = 0;
    while state.time_s < 1.6e-3 {
        let happened = happens(&mut state);
        let gone = happened
            .iter()
            .filter(|one| matches!(one, PopulationEvent::Left { .. }));
        left += gone.count();
    }
    let outlet = state.population.outlets[0];
    (outlet.bodies, outlet.mass_kg, left)
}

#[test]
fn what_passes_a_thin_outlet_within_a_step_is_removed() {
    for region in [
        "box = { min = [0, -1, -1], max = [5e-6, 1, 1] }",
        "sphere = { centre = [0.5005, 0.04, 0.02], radius = 0.5005 }",
        "cylinder = { from = [0, 0.04, 0.02], to = [5e-6, 0.04, 0.02], radius = 0.5 }",
        "cylinder = { from = [0.0005, -1, 0.02], to = [0.0005, 1, 0.02], radius = 0.04 }",
    ] {
        let (bodies, mass_kg, left) = flown(region);
        assert_eq!((bodies, left), (15, 15), "{region}");
        assert!(mass_kg > 0.0);
    }
    // Beside it nothing is removed.
    for region in [
        "box = { min = [0, -1, -1], max = [5e-6, -0.001, 1] }",
        "cylinder = { from = [0.0005, -1, -0.5], to = [0.0005, 1, -0.5], radius = 0.49 }",
    ] {
        assert_eq!(flown(region).0, 0, "{region}");
    }
}
