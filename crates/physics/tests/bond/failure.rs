//! Breaking of bonds: failure loads of a round bar of known strength.

use dem_physics::bond::BondLoad;
use dem_physics::bond::failure::{
    Cause, CauseCounts, Criteria, EquivalentStress, Factors, Screen, Stresses, cause, stresses,
    utilisation,
};
use proptest::prelude::*;
use std::f64::consts::PI;

const NONE: Criteria = Criteria {
    tensile_strength_pa: f64::INFINITY,
    compressive_strength_pa: f64::INFINITY,
    shear_strength_pa: f64::INFINITY,
    cohesion_pa: f64::INFINITY,
    friction_tangent: 0.0,
    von_mises_strength_pa: f64::INFINITY,
    equivalent_stress: EquivalentStress::AxialInTension,
};
const ONE: Factors = Factors {
    scatter: 1.0,
    rate: 1.0,
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

/// A bond with zero strength breaks under any load, but not without load; no NaN occurs on the way.
#[test]
fn of_no_strength_any_load_is_too_much() {
    for zero in [
        Criteria {
            tensile_strength_pa: 0.0,
            ..NONE
        },
        Criteria {
            compressive_strength_pa: 0.0,
            ..NONE
        },
        Criteria {
            shear_strength_pa: 0.0,
            ..NONE
        },
        Criteria {
            cohesion_pa: 0.0,
            friction_tangent: 0.5,
            ..NONE
        },
        Criteria {
            von_mises_strength_pa: 0.0,
            ..NONE
        },
        Criteria {
            tensile_strength_pa: 0.0,
            compressive_strength_pa: 0.0,
            shear_strength_pa: 0.0,
            von_mises_strength_pa: 0.0,
            ..NONE
        },
    ] {
        let screen = Screen::new(&zero);
        for factor in [1.0, 0.3, 5.0] {
            let factors = Factors::scattered(factor);
            assert_eq!(utilisation(&zero, &Stresses::default(), factors), 0.0);
        }
        let [used, factor] =
            screen.utilisation_and_factor::<f64, true>(&BondLoad::default(), RADIUS_M);
        assert!(used == 0.0 && factor > 0.0);
        let tiny = BondLoad {
            normal_n: 1e-30,
            shear_n: 1e-30,
            torsion_n_m: 1e-30,
            bending_n_m: 1e-30,
        };
        assert_eq!(
            utilisation(&zero, &stresses(&tiny, RADIUS_M), Factors::scattered(2.0)),
            f64::INFINITY
        );
        let [used, factor] = screen.utilisation_and_factor::<f64, true>(&tiny, RADIUS_M);
        assert!(used > factor);
    }
}

/// Each criterion responds to its own modes.
#[test]
fn each_mode_uses_its_share_of_each_strength() {
    let cases = [
        (
            Criteria {
                tensile_strength_pa: 2e6,
                ..NONE
            },
            [0.5, 0.5, 0.0, 0.0],
            Cause::Tension,
        ),
        (
            Criteria {
                compressive_strength_pa: 4e6,
                ..NONE
            },
            [0.0, 0.25, 0.0, 0.0],
            Cause::Compression,
        ),
        (
            Criteria {
                shear_strength_pa: 4e6,
                ..NONE
            },
            [0.0, 0.0, 0.25, 0.25],
            Cause::Shear,
        ),
        (
            Criteria {
                cohesion_pa: 4e6,
                friction_tangent: 0.5,
                ..NONE
            },
            [0.125, 0.0, 0.25, 0.25],
            Cause::MohrCoulomb,
        ),
        (
            Criteria {
                von_mises_strength_pa: 2e6,
                ..NONE
            },
            [0.5, 0.5, 0.5 * 3.0_f64.sqrt(), 0.5 * 3.0_f64.sqrt()],
            Cause::VonMises,
        ),
    ];
    for (criteria, fractions, by) in cases {
        for (stresses, fraction) in MODES.iter().zip(fractions) {
            let found = utilisation(&criteria, stresses, ONE);
            assert!(
                (found - fraction).abs() < 1e-15,
                "{criteria:?}, {stresses:?}: {found}"
            );
            if fraction > 0.0 {
                assert_eq!(cause(&criteria, stresses, ONE), by);
            }
        }
    }
}

#[test]
fn criteria_act_together_and_the_worst_one_is_the_cause() {
    let criteria = Criteria {
        tensile_strength_pa: 1.0,
        compressive_strength_pa: 2.0,
        shear_strength_pa: 1.0,
        von_mises_strength_pa: 4.0,
        ..NONE
    };
    let at = |axial_pa, shear_pa| {
        let stresses = Stresses {
            axial_pa,
            shear_pa,
            ..Stresses::default()
        };
        (
            utilisation(&criteria, &stresses, ONE),
            cause(&criteria, &stresses, ONE),
        )
    };
    assert_eq!(at(0.9, 0.8), (0.9, Cause::Tension));
    assert_eq!(at(-1.8, 0.8), (0.9, Cause::Compression));
    assert_eq!(at(-1.5, 0.8), (0.8, Cause::Shear));
    assert_eq!(at(0.7, 0.8), (0.8, Cause::Shear));
    let criteria = Criteria {
        von_mises_strength_pa: 1.0,
        ..criteria
    };
    let stresses = Stresses {
        axial_pa: 0.7,
        shear_pa: 0.8,
        ..Stresses::default()
    };
    assert_near(
        utilisation(&criteria, &stresses, ONE),
        (0.49_f64 + 3.0 * 0.64).sqrt(),
    );
    assert_eq!(cause(&criteria, &stresses, ONE), Cause::VonMises);
}

/// Tension counts at the tensile edge, also in an overall compressed bond; compression at the
/// opposite edge, also in a bond under tension. A bond without a strength is not broken by any
/// stress.
#[test]
fn each_edge_has_a_strength_of_its_own() {
    let tension = Criteria {
        tensile_strength_pa: 2.0,
        ..NONE
    };
    let compression = Criteria {
        compressive_strength_pa: 5.0,
        ..NONE
    };
    let both = Criteria {
        tensile_strength_pa: 2.0,
        compressive_strength_pa: 5.0,
        ..NONE
    };
    let by_tension = Some(Cause::Tension);
    let by_compression = Some(Cause::Compression);
    // Axial and bending stress; then utilisation and cause by tension, by compression, by both.
    for (axial_pa, bending_pa, wanted) in [
        (
            2.0,
            0.0,
            [(1.0, by_tension), (0.0, None), (1.0, by_tension)],
        ),
        (
            -5.0,
            0.0,
            [(0.0, None), (1.0, by_compression), (1.0, by_compression)],
        ),
        (
            0.0,
            2.0,
            [(1.0, by_tension), (0.4, by_compression), (1.0, by_tension)],
        ),
        // A small compression: the tensile edge still breaks.
        (
            -0.25,
            2.25,
            [(1.0, by_tension), (0.5, by_compression), (1.0, by_tension)],
        ),
        (
            -2.5,
            2.5,
            [(0.0, None), (1.0, by_compression), (1.0, by_compression)],
        ),
        (
            -4.0,
            1.0,
            [(0.0, None), (1.0, by_compression), (1.0, by_compression)],
        ),
        (
            3.0,
            1.0,
            [(2.0, by_tension), (0.0, None), (2.0, by_tension)],
        ),
        (
            1.0,
            3.5,
            [
                (2.25, by_tension),
                (0.5, by_compression),
                (2.25, by_tension),
            ],
        ),
    ] {
        let stresses = Stresses {
            axial_pa,
            bending_pa,
            ..Stresses::default()
        };
        for (criteria, (fraction, by)) in [tension, compression, both].iter().zip(wanted) {
            let what = format!("{axial_pa} and {bending_pa}, {criteria:?}");
            assert_eq!(utilisation(criteria, &stresses, ONE), fraction, "{what}");
            if let Some(by) = by {
                assert_eq!(cause(criteria, &stresses, ONE), by, "{what}");
            }
        }
    }
}

/// The envelope of Mohr and Coulomb: shear strength rises with pressure without end and falls with
/// tension to 0 at c/tan(phi); the tensile strength cuts it off before. Bending does not count, and
/// pressure alone breaks nothing.
#[test]
fn pressure_raises_the_shear_strength_of_mohr_and_coulomb() {
    let criteria = Criteria {
        cohesion_pa: 3.0,
        friction_tangent: 0.75,
        ..NONE
    };
    let cut_off = Criteria {
        tensile_strength_pa: 2.5,
        ..criteria
    };
    let at = |criteria: &Criteria, axial_pa: f64, shear_pa: f64| {
        let stresses = Stresses {
            axial_pa,
            shear_pa: 0.5 * shear_pa,
            torsion_pa: 0.5 * shear_pa,
            bending_pa: 0.0,
        };
        let factors = Factors::scattered(1.0);
        let used = utilisation(criteria, &stresses, factors);
        (
            used,
            (used > 0.0).then(|| cause(criteria, &stresses, factors)),
        )
    };
    let slides = Some(Cause::MohrCoulomb);
    for (axial_pa, shear_pa) in [(-8.0, 9.0), (-2.0, 4.5), (0.0, 3.0), (2.0, 1.5), (4.0, 0.0)] {
        assert_eq!(
            at(&criteria, axial_pa, shear_pa),
            (1.0, slides),
            "{axial_pa}"
        );
        // The load at failure grows in proportion to the cohesion.
        let stronger = Criteria {
            cohesion_pa: 6.0,
            ..criteria
        };
        assert_eq!(at(&stronger, axial_pa, shear_pa), (0.5, slides));
    }
    assert_eq!(at(&cut_off, -8.0, 9.0), (1.0, slides));
    assert_eq!(at(&cut_off, 2.0, 1.5), (1.0, slides));
    assert_eq!(at(&cut_off, 2.5, 0.0), (1.0, Some(Cause::Tension)));
    assert_eq!(at(&criteria, -1e9, 1e6), (0.0, None));
    let bent = Stresses {
        bending_pa: 1e9,
        ..Stresses::default()
    };
    assert_eq!(utilisation(&criteria, &bent, ONE), 0.0);
    assert_eq!(utilisation(&cut_off, &bent, ONE), 1e9 / 2.5);
}

const READINGS: [EquivalentStress; 4] = [
    EquivalentStress::ForcesOnly,
    EquivalentStress::AxialInTension,
    EquivalentStress::TensileEdge,
    EquivalentStress::BondInTension,
];

/// Which stresses count in a bond that is pulled, pressed a little and pressed a lot, each with
/// bending, shear and torsion.
#[test]
fn the_equivalent_stress_has_four_readings() {
    let of = |equivalent_stress, axial_pa| {
        let platzer = Criteria {
            von_mises_strength_pa: 2.0,
            equivalent_stress,
            ..NONE
        };
        let stresses = Stresses {
            axial_pa,
            bending_pa: 1.0,
            shear_pa: 0.25,
            torsion_pa: 0.5,
        };
        utilisation(&platzer, &stresses, ONE)
    };
    // Normal stress that counts at 3 Pa, -0.25 Pa and -3 Pa, and shear stress.
    let expected = [
        ([3.0, 0.0, 0.0], 0.25),
        ([4.0, 1.0, 1.0], 0.75),
        ([4.0, 0.75, 0.0], 0.75),
        ([4.0, 0.0, 0.0], 0.75),
    ];
    for (reading, (normal_pa, shear_pa)) in READINGS.into_iter().zip(expected) {
        for (axial_pa, normal_pa) in [3.0, -0.25, -3.0].into_iter().zip(normal_pa) {
            let equivalent_pa = f64::hypot(normal_pa, 3.0_f64.sqrt() * shear_pa);
            assert_near(of(reading, axial_pa), equivalent_pa / 2.0);
        }
    }
}

#[test]
fn nothing_breaks_without_a_criterion_or_a_load() {
    assert_eq!(utilisation(&NONE, &MODES[0], ONE), 0.0);
    let strong = Criteria {
        tensile_strength_pa: 1.0,
        compressive_strength_pa: 1.0,
        shear_strength_pa: 1.0,
        von_mises_strength_pa: 1.0,
        ..NONE
    };
    assert_eq!(utilisation(&strong, &Stresses::default(), ONE), 0.0);
    // Factors increase all strengths.
    assert_near(
        utilisation(&strong, &MODES[3], Factors::scattered(4.0)),
        0.25e6 * 3.0_f64.sqrt(),
    );
}

/// The strain rate increases all strengths except the compressive one; scatter affects all.
#[test]
fn compression_is_not_strengthened_by_the_rate() {
    let criteria = Criteria {
        tensile_strength_pa: 1.0,
        compressive_strength_pa: 2.0,
        ..NONE
    };
    let bent = Stresses {
        bending_pa: 3.0,
        ..Stresses::default()
    };
    for (scatter, rate, fraction, by) in [
        (1.0, 1.0, 3.0, Cause::Tension),
        (1.0, 1.5, 2.0, Cause::Tension),
        (1.0, 2.5, 1.5, Cause::Compression),
        (3.0, 1.0, 1.0, Cause::Tension),
        (3.0, 6.0, 0.5, Cause::Compression),
    ] {
        let factors = Factors { scatter, rate };
        assert_near(utilisation(&criteria, &bent, factors), fraction);
        assert_eq!(cause(&criteria, &bent, factors), by, "{factors:?}");
    }
}

#[test]
fn causes_are_counted_and_said() {
    let mut counts = CauseCounts::default();
    assert_eq!(counts.to_string(), "");
    for cause in [Cause::Shear, Cause::Tension, Cause::Tension] {
        counts.count(cause);
    }
    assert_eq!(counts.to_string(), "2 in tension, 1 in shear");
    counts.count(Cause::Compression);
    counts.count(Cause::VonMises);
    counts.count(Cause::MohrCoulomb);
    assert_eq!(
        counts.to_string(),
        "2 in tension, 1 in compression, 1 in shear, 1 by equivalent stress, 1 by Mohr-Coulomb"
    );
}

/// Loads, and radii of bonds.
fn loads() -> impl Strategy<Value = (BondLoad, f64)> {
    let any = (-1e3..1e3, 0.0..1e3, 0.0..3.0, 0.0..3.0, 1e-4..1e-2);
    // Including axial force and bending that nearly cancel at an edge, and axial force and shear
    // that nearly cancel at a friction of 0.7.
    let cancel = prop::option::of((0..3_u8, -15..0));
    (any, cancel).prop_map(
        |((normal_n, shear_n, torsion_n_m, bending_n_m, radius_m), cancel)| {
            let normal_n = match cancel {
                Some((against, digits)) => {
                    let bending_n: f64 = 4.0 * bending_n_m / radius_m;
                    let sliding_n: f64 = (shear_n + 2.0 * torsion_n_m / radius_m) / 0.7;
                    let largest_n = [bending_n, -bending_n, -sliding_n][usize::from(against)];
                    largest_n * (1.0 - 10.0_f64.powi(digits))
                }
                None => normal_n,
            };
            let load = BondLoad {
                normal_n,
                shear_n,
                torsion_n_m,
                bending_n_m,
            };
            (load, radius_m)
        },
    )
}

fn some_criteria() -> impl Strategy<Value = Criteria> {
    let readings = prop::sample::select(&READINGS[..]);
    let strengths = prop::array::uniform5(prop::option::of(1e-3..1e9));
    let tangents = prop::sample::select(&[0.0, 0.7, 30.0, 1e9][..]);
    (strengths, tangents, readings).prop_map(|(strengths, friction_tangent, equivalent_stress)| {
        let [
            tensile_strength_pa,
            compressive_strength_pa,
            shear_strength_pa,
            cohesion_pa,
            von_mises_strength_pa,
        ] = strengths.map(|s| s.unwrap_or(f64::INFINITY));
        Criteria {
            tensile_strength_pa,
            compressive_strength_pa,
            shear_strength_pa,
            cohesion_pa,
            friction_tangent,
            von_mises_strength_pa,
            equivalent_stress,
        }
    })
}

proptest! {
    /// The screen used by the step is the square of the utilisation, except for rounding where
    /// axial force and bending cancel.
    #[test]
    fn the_screen_finds_what_is_utilised(
        (load, radius_m) in loads(),
        criteria in some_criteria(),
    ) {
        let of_load = stresses(&load, radius_m);
        let exact = utilisation(&criteria, &of_load, ONE);
        let [used, factor] = Screen::new(&criteria).utilisation_and_factor::<f64, true>(&load, radius_m);
        let screened = (used / factor).sqrt();
        let least = criteria.tensile_strength_pa.min(criteria.compressive_strength_pa);
        let axial_pa = of_load.axial_pa.abs();
        let sheared_pa = of_load.shear_pa + of_load.torsion_pa;
        let slid_pa = axial_pa * criteria.friction_tangent + sheared_pa;
        let cancelled = (axial_pa + of_load.bending_pa) / least + slid_pa / criteria.cohesion_pa;
        let error = (screened - exact).abs();
        prop_assert!(error <= 1e-12 * exact + 2e-14 * cancelled, "{screened} {exact}");
    }

    /// It misses no bond that breaks: it reports the load at which the strength is just reached,
    /// and loads beyond it.
    #[test]
    fn the_screen_misses_no_bond_that_breaks(
        (load, radius_m) in loads(),
        criteria in some_criteria(),
        beyond in prop::option::of(0.0..1.0),
    ) {
        let exact = |criteria: &Criteria| utilisation(criteria, &stresses(&load, radius_m), ONE);
        let reached = exact(&criteria);
        prop_assume!(reached > 0.0);
        // Strengths that this load just reaches, to one rounding more or less.
        let scale = reached * (1.0 - beyond.unwrap_or(0.0));
        let scaled = Criteria {
            tensile_strength_pa: criteria.tensile_strength_pa * scale,
            compressive_strength_pa: criteria.compressive_strength_pa * scale,
            shear_strength_pa: criteria.shear_strength_pa * scale,
            cohesion_pa: criteria.cohesion_pa * scale,
            von_mises_strength_pa: criteria.von_mises_strength_pa * scale,
            ..criteria
        };
        if exact(&scaled) >= 1.0 {
            let [used, factor] = Screen::new(&scaled).utilisation_and_factor::<f64, true>(&load, radius_m);
            prop_assert!(used >= (1.0 - 1e-9) * factor, "{} {}", used / factor, exact(&scaled));
        }
    }
}
