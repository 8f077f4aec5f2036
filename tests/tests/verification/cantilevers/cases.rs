//! The five cases of the paper.

use dem_run::physics::bond::stiffness::BondModel;

use super::bar::{Bar, LOAD, Rest};

/// Numbers of bonds of the bars of cases 2 and 4.
pub(crate) const COUNTS: [usize; 7] = [1, 2, 3, 4, 6, 8, 10];

/// Ratio of tip deflection to length of bars that are compared with small-deflection theory. The
/// error of the deflection is then about the square of this: 2.5e-9.
const SMALL: f64 = 5e-5;

/// Tolerance for the rest state: geometry and rest together.
pub(crate) const TOLERANCE: f64 = 1e-8;

/// Case 1: the reference bar.
pub(crate) fn case1(model: BondModel) -> Bar {
    Bar::even(4.0, 10, 0.2, 0.2, model)
}

/// Case 2: the bar shortened to this number of bonds.
pub(crate) fn case2(bonds: usize, model: BondModel) -> Bar {
    Bar::even(0.4 * bonds as f64, bonds, 0.2, 0.2, model)
}

/// Case 3: the bar of case 1 with this number of bonds, with gaps between the spheres.
pub(crate) fn case3(bonds: usize, model: BondModel) -> Bar {
    Bar::even(4.0, bonds, 0.2, 0.2, model)
}

/// Case 4: a bar of half the thickness with this number of bonds, the spheres in contact.
pub(crate) fn case4(bonds: usize, model: BondModel) -> Bar {
    Bar::even(4.0, bonds, 2.0 / bonds as f64, 0.1, model)
}

/// Case 5: two bonds, the sphere in the middle larger.
pub(crate) fn case5(middle_radius_m: f64, model: BondModel) -> Bar {
    let mut bar = Bar::even(4.0, 2, 0.2, 0.2, model);
    bar.radii_m[1] = middle_radius_m;
    bar
}

/// Ratio of normal to shear stiffness of an Euler-Bernoulli bond of case 5, which the paper uses
/// for the parallel bond there: L^2 / (3 r^2).
pub(crate) const KAPPA_OF_CASE_5: f64 = 2.0 * 2.0 / (3.0 * 0.2 * 0.2);

/// A bar at rest under a load so small that small-deflection theory holds, scaled to the paper's
/// load.
#[derive(Debug, Clone)]
pub(crate) struct Small {
    /// Displacements of the spheres along the load, m.
    pub(crate) deflections_m: Vec<f64>,
    /// Their rotations, rad.
    pub(crate) rotations: Vec<f64>,
}

impl Small {
    /// Deflection of the tip under the paper's load, m.
    pub(crate) fn tip_m(&self) -> f64 {
        self.deflections_m[self.deflections_m.len() - 1]
    }
}

/// Runs a bar in this way, and compares deflections, rotations and reactions with the exact
/// solution.
pub(crate) fn small(bar: &Bar, tolerance: f64) -> Small {
    let (deflections, rotations) = bar.exact(LOAD);
    let load = LOAD * SMALL * bar.length_m / deflections[bar.bonds()];
    let rest = bar.at_rest(load);
    let scaled = |values: &[f64]| values.iter().map(|v| v * LOAD / load).collect::<Vec<f64>>();
    let found = Small {
        deflections_m: scaled(&rest.deflections_m),
        rotations: scaled(&rest.rotations),
    };
    assert_profile(&found.deflections_m, &deflections, tolerance);
    assert_profile(&found.rotations, &rotations, tolerance);
    assert_reaction(&rest, load, bar.length_m, tolerance);
    found
}

/// Compares each value, relative to itself; the first is 0.
pub(crate) fn assert_profile(found: &[f64], exact: &[f64], tolerance: f64) {
    assert_eq!(found.len(), exact.len());
    assert_eq!([found[0], exact[0]], [0.0, 0.0]);
    for (i, (found, exact)) in found.iter().zip(exact).enumerate().skip(1) {
        assert_near(*found, *exact, tolerance, &format!("sphere {i}"));
    }
}

/// Checks that a number is close to another, relative to it.
pub(crate) fn assert_near(found: f64, exact: f64, tolerance: f64, what: &str) {
    let off = found / exact - 1.0;
    assert!(
        off.abs() <= tolerance,
        "{what}: {found} instead of {exact}, off by {off:e}"
    );
}

/// Checks that the support carries the load and its moment.
fn assert_reaction(rest: &Rest, load_n: f64, length_m: f64, tolerance: f64) {
    let [force, moment] = rest.reaction;
    assert_near(-force.y, load_n, tolerance, "reaction");
    assert_near(
        -moment.z,
        load_n * length_m,
        tolerance,
        "moment of the support",
    );
}
