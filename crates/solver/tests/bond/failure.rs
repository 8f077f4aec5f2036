//! Breaking of bonds: loads at which a round bar of known strength must fail.

use dem_run::physics::bond::BondLoad;
use dem_run::physics::bond::failure::{
    Cause, Criteria, Screen, Stresses, cause, stresses, utilisation,
};
use proptest::prelude::*;
use std::f64::consts::PI;

const NONE: Criteria = Criteria {
    tension_pa: f64::INFINITY,
    shear_pa: f64::INFINITY,
    von_mises_pa: f64::INFINITY,
    compressive: true,
};
const RADIUS_M: f64 = 0.003;
const MODES: [Stresses; 4] = [
    Stresses {
        axial_pa: 1e6,
        bending_pa: 0.0,
        shear_pa: 0.0,
        torsion_pa: 0.0,
    },
    Stresses {
        axial_pa: 0.0,
        bending_pa: 1e6,
        shear_pa: 0.0,
        torsion_pa: 0.0,
    },
    Stresses {
        axial_pa: 0.0,
        bending_pa: 0.0,
        shear_pa: 1e6,
        torsion_pa: 0.0,
    },
    Stresses {
        axial_pa: 0.0,
        bending_pa: 0.0,
        shear_pa: 0.0,
        torsion_pa: 1e6,
    },
];

fn assert_near(found: f64, wanted: f64) {
    assert!(
        (found / wanted - 1.0).abs() < 1e-14,
        "{found} instead of {wanted}"
    );
}

#[test]
fn stresses_are_those_of_a_round_bar() {
    let load = BondLoad {
        normal_n: -2.0,
        shear_n: 3.0,
        torsion_n_m: 5.0,
        bending_n_m: 7.0,
    };
    let (area, second_moment) = (PI * RADIUS_M.powi(2), 0.25 * PI * RADIUS_M.powi(4));
    let found = stresses(&load, RADIUS_M);
    assert_near(found.axial_pa, -2.0 / area);
    assert_near(found.shear_pa, 3.0 / area);
    assert_near(found.torsion_pa, 5.0 * RADIUS_M / (2.0 * second_moment));
    assert_near(found.bending_pa, 7.0 * RADIUS_M / second_moment);
}

/// A bond without strength breaks under any load, and by none; no number is lost on the way.
#[test]
fn of_no_strength_any_load_is_too_much() {
    for zero in [
        Criteria {
            tension_pa: 0.0,
            ..NONE
        },
        Criteria {
            shear_pa: 0.0,
            ..NONE
        },
        Criteria {
            von_mises_pa: 0.0,
            ..NONE
        },
        Criteria {
            tension_pa: 0.0,
            shear_pa: 0.0,
            von_mises_pa: 0.0,
            compressive: false,
        },
    ] {
        let screen = Screen::new(&zero);
        for factor in [1.0, 0.3, 5.0] {
            assert_eq!(utilisation(&zero, &Stresses::default(), factor), 0.0);
        }
        let [used, factor] = screen.used_and_factor(&BondLoad::default(), RADIUS_M);
        assert!(used == 0.0 && factor > 0.0);
        let tiny = BondLoad {
            normal_n: 1e-30,
            shear_n: 1e-30,
            torsion_n_m: 1e-30,
            bending_n_m: 1e-30,
        };
        assert_eq!(
            utilisation(&zero, &stresses(&tiny, RADIUS_M), 2.0),
            f64::INFINITY
        );
        let [used, factor] = screen.used_and_factor(&tiny, RADIUS_M);
        assert!(used > factor);
    }
}

/// Each criterion sees the modes that are its own.
#[test]
fn each_mode_uses_its_share_of_each_strength() {
    let cases = [
        (
            Criteria {
                tension_pa: 2e6,
                ..NONE
            },
            [0.5, 0.5, 0.0, 0.0],
            Cause::Tension,
        ),
        (
            Criteria {
                shear_pa: 4e6,
                ..NONE
            },
            [0.0, 0.0, 0.25, 0.25],
            Cause::Shear,
        ),
        (
            Criteria {
                von_mises_pa: 2e6,
                ..NONE
            },
            [0.5, 0.5, 0.5 * 3.0_f64.sqrt(), 0.5 * 3.0_f64.sqrt()],
            Cause::VonMises,
        ),
    ];
    for (criteria, shares, by) in cases {
        for (stresses, share) in MODES.iter().zip(shares) {
            let found = utilisation(&criteria, stresses, 1.0);
            assert!(
                (found - share).abs() < 1e-15,
                "{criteria:?}, {stresses:?}: {found}"
            );
            if share > 0.0 {
                assert_eq!(cause(&criteria, stresses), by);
            }
        }
    }
}

#[test]
fn criteria_act_together_and_the_worst_one_is_the_cause() {
    let criteria = Criteria {
        tension_pa: 1.0,
        shear_pa: 1.0,
        von_mises_pa: 4.0,
        compressive: true,
    };
    let at = |axial_pa, shear_pa| {
        let stresses = Stresses {
            axial_pa,
            shear_pa,
            ..Stresses::default()
        };
        (
            utilisation(&criteria, &stresses, 1.0),
            cause(&criteria, &stresses),
        )
    };
    assert_eq!(at(0.9, 0.8), (0.9, Cause::Tension));
    assert_eq!(at(-0.9, 0.8), (0.9, Cause::Compression));
    assert_eq!(at(0.7, 0.8), (0.8, Cause::Shear));
    let criteria = Criteria {
        von_mises_pa: 1.0,
        ..criteria
    };
    let stresses = Stresses {
        axial_pa: 0.7,
        shear_pa: 0.8,
        ..Stresses::default()
    };
    assert_near(
        utilisation(&criteria, &stresses, 1.0),
        (0.49_f64 + 3.0 * 0.64).sqrt(),
    );
    assert_eq!(cause(&criteria, &stresses), Cause::VonMises);
}

#[test]
fn pressing_breaks_only_where_it_is_meant_to() {
    let pressed = Stresses {
        axial_pa: -3.0,
        bending_pa: 1.0,
        ..Stresses::default()
    };
    let strong = Criteria {
        tension_pa: 2.0,
        ..NONE
    };
    assert_eq!(utilisation(&strong, &pressed, 1.0), 2.0);
    assert_eq!(cause(&strong, &pressed), Cause::Compression);
    let only_pulled = Criteria {
        compressive: false,
        ..strong
    };
    assert_eq!(utilisation(&only_pulled, &pressed, 1.0), 0.0);
    let pulled = Stresses {
        axial_pa: 3.0,
        ..pressed
    };
    assert_eq!(utilisation(&only_pulled, &pulled, 1.0), 2.0);
    // The equivalent stress leaves out the axial part only.
    let thesis = Criteria {
        von_mises_pa: 2.0,
        ..NONE
    };
    assert_eq!(utilisation(&thesis, &pressed, 1.0), 0.5);
    assert_eq!(utilisation(&thesis, &pulled, 1.0), 2.0);
}

#[test]
fn nothing_breaks_without_a_criterion_or_a_load() {
    assert_eq!(utilisation(&NONE, &MODES[0], 1.0), 0.0);
    let strong = Criteria {
        tension_pa: 1.0,
        shear_pa: 1.0,
        von_mises_pa: 1.0,
        compressive: true,
    };
    assert_eq!(utilisation(&strong, &Stresses::default(), 1.0), 0.0);
    // Factors make all strengths larger.
    assert_near(
        utilisation(&strong, &MODES[3], 4.0),
        0.25e6 * 3.0_f64.sqrt(),
    );
}

proptest! {
    /// The screen that the step uses is the square of the utilisation.
    #[test]
    fn the_screen_finds_what_is_utilised(
        normal_n in -1e3..1e3,
        shear_n in 0.0..1e3,
        torsion_n_m in 0.0..3.0,
        bending_n_m in 0.0..3.0,
        radius_m in 1e-4..1e-2,
        strengths in prop::array::uniform3(prop::option::of(1e4..1e9)),
        compressive: bool,
    ) {
        let [tension_pa, shear_pa, von_mises_pa] = strengths.map(|s| s.unwrap_or(f64::INFINITY));
        let criteria = Criteria { tension_pa, shear_pa, von_mises_pa, compressive };
        let load = BondLoad { normal_n, shear_n, torsion_n_m, bending_n_m };
        let exact = utilisation(&criteria, &stresses(&load, radius_m), 1.0);
        let [used, factor] = Screen::new(&criteria).used_and_factor(&load, radius_m);
        let screened = (used / factor).sqrt();
        prop_assert!((screened - exact).abs() <= 1e-12 * exact, "{screened} {exact}");
    }
}
