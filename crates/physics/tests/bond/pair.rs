//! Frequencies of two bonded spheres compared with an independent implementation and with
//! analytical limits.

use dem_physics::bond::pair::{Frequencies, frequencies};
use dem_physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use std::f64::consts::PI;

struct Case {
    model: BondModel,
    /// Radii 1 : 4 with a gap and a thin bond, or two equal spheres that touch.
    uneven: bool,
    frequencies: Frequencies,
    critical_step_s: f64,
}

const CASES: [Case; 8] = [
    Case {
        model: BondModel::Parallel { kappa: None },
        uneven: false,
        frequencies: Frequencies {
            axial: 21856.5094735968,
            torsion: 15154.762617253402,
            bending: [17279.087909403424, 25358.768186937697],
        },
        critical_step_s: 7.886818418215598e-05,
    },
    Case {
        model: BondModel::Parallel { kappa: None },
        uneven: true,
        frequencies: Frequencies {
            axial: 14387.715921116584,
            torsion: 7923.105464146135,
            bending: [3446.818452582701, 24375.838417014438],
        },
        critical_step_s: 8.204845986359967e-05,
    },
    Case {
        model: BondModel::EulerBernoulli,
        uneven: false,
        frequencies: Frequencies {
            axial: 21856.5094735968,
            torsion: 15154.762617253404,
            bending: [17279.087909403424, 35411.59261766893],
        },
        critical_step_s: 5.647867978132342e-05,
    },
    Case {
        model: BondModel::EulerBernoulli,
        uneven: true,
        frequencies: Frequencies {
            axial: 14387.715921116584,
            torsion: 7923.105464146134,
            bending: [1710.5474381064835, 18290.63935962479],
        },
        critical_step_s: 0.00010934554887211046,
    },
    Case {
        model: BondModel::Timoshenko,
        uneven: false,
        frequencies: Frequencies {
            axial: 21856.5094735968,
            torsion: 15154.762617253404,
            bending: [17279.087909403424, 19899.597126731867],
        },
        critical_step_s: 9.150591966279196e-05,
    },
    Case {
        model: BondModel::Timoshenko,
        uneven: true,
        frequencies: Frequencies {
            axial: 14387.715921116584,
            torsion: 7923.105464146134,
            bending: [1680.0839354384045, 17334.694329943486],
        },
        critical_step_s: 0.00011537555620725617,
    },
    Case {
        model: BondModel::ElasticSolid,
        uneven: false,
        frequencies: Frequencies {
            axial: 21856.5094735968,
            torsion: 15154.762617253402,
            bending: [17279.087909403424, 25358.768186937697],
        },
        critical_step_s: 7.886818418215595e-05,
    },
    Case {
        model: BondModel::ElasticSolid,
        uneven: true,
        frequencies: Frequencies {
            axial: 14387.715921116584,
            torsion: 7923.105464146135,
            bending: [1915.9089841414507, 43853.38257108761],
        },
        critical_step_s: 4.560651613950055e-05,
    },
];

fn pair(model: BondModel, uneven: bool) -> (Stiffness, [f64; 2], [f64; 2]) {
    let shape = if uneven {
        BondShape {
            length_m: 0.6,
            radius_m: 0.08,
            end_radii_m: [0.1, 0.4],
        }
    } else {
        BondShape {
            length_m: 0.4,
            radius_m: 0.2,
            end_radii_m: [0.2; 2],
        }
    };
    let masses = shape
        .end_radii_m
        .map(|r| 7850.0 * 4.0 / 3.0 * PI * r.powi(3));
    let inverse_inertias = [0, 1].map(|i| 2.5 / (masses[i] * shape.end_radii_m[i].powi(2)));
    (
        stiffness(model, &shape, 200e9, 0.3),
        masses.map(f64::recip),
        inverse_inertias,
    )
}

fn all(found: &Frequencies) -> [f64; 4] {
    [
        found.axial,
        found.torsion,
        found.bending[0],
        found.bending[1],
    ]
}

fn assert_near(found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found / wanted - 1.0).abs() < tolerance,
        "{found} instead of {wanted}"
    );
}

#[test]
fn frequencies_are_those_of_the_independent_implementation() {
    for case in CASES {
        let (k, per_mass, per_inertia) = pair(case.model, case.uneven);
        let found = frequencies(&k, per_mass, per_inertia);
        for (found, wanted) in all(&found).into_iter().zip(all(&case.frequencies)) {
            assert_near(found, wanted, 1e-9);
        }
        assert_near(found.critical_step_s(), case.critical_step_s, 1e-9);
    }
}

#[test]
fn it_does_not_matter_which_end_is_named_first() {
    let (k, [m, n], [i, j]) = pair(BondModel::Timoshenko, true);
    let k = Stiffness {
        levers_m: [0.15, 0.45],
        ..k
    };
    let forward = frequencies(&k, [m, n], [i, j]);
    let back = frequencies(
        &Stiffness {
            levers_m: [0.45, 0.15],
            ..k
        },
        [n, m],
        [j, i],
    );
    for (forward, back) in all(&forward).into_iter().zip(all(&back)) {
        assert_near(forward, back, 1e-14);
    }
}

#[test]
fn an_end_that_is_held_is_one_of_endless_mass() {
    let (k, [m, _], [i, _]) = pair(BondModel::Timoshenko, false);
    let held = frequencies(&k, [m, 0.0], [i, 0.0]);
    let heavy = frequencies(&k, [m, 1e-20], [i, 1e-20]);
    for (held, heavy) in all(&held).into_iter().zip(all(&heavy)) {
        assert_near(held, heavy, 1e-12);
    }
    assert_near(held.axial, (k.normal * m).sqrt(), 1e-14);
    let nothing = frequencies(&k, [0.0; 2], [0.0; 2]);
    assert_eq!(all(&nothing), [0.0; 4]);
    assert_eq!(nothing.critical_step_s(), f64::INFINITY);
}

/// Point masses with rotation prevented: shear alone, k_s (1/m_a + 1/m_b).
#[test]
fn without_turning_only_shear_is_left() {
    let (k, per_mass, _) = pair(BondModel::Timoshenko, true);
    let found = frequencies(&k, per_mass, [0.0; 2]);
    assert_near(
        found.bending[1],
        (k.shear * (per_mass[0] + per_mass[1])).sqrt(),
        1e-14,
    );
    assert_eq!(found.bending[0], 0.0);
    assert_eq!(found.torsion, 0.0);
}
