//! Stiffnesses compared with Chen et al. 2022, table 5, with the digits of an independent
//! implementation.

use std::f64::consts::PI;

use dem_physics::bond::incremental::{self, History, Step, advance};
use dem_physics::bond::stiffness::{BondModel, BondShape, stiffness};
use dem_physics::bond::total::{End, bond_forces};
use nalgebra::{UnitQuaternion, Vector3};

const STEEL_PA: f64 = 200e9;
const NU: f64 = 0.3;
/// The bar of the paper's cases 1 and 3: 4 m long, radius 0.2 m, with this many bonds.
fn bar_of(bonds: u32) -> BondShape {
    BondShape {
        length_m: 4.0 / f64::from(bonds),
        radius_m: 0.2,
        end_radii_m: [0.2; 2],
    }
}

fn assert_near(found: f64, wanted: f64) {
    assert!(
        (found / wanted - 1.0).abs() < 1e-14,
        "{found} instead of {wanted}"
    );
}

#[test]
fn one_long_bond_is_as_the_independent_implementation_has_it() {
    let shape = bar_of(1);
    let shear = [
        (BondModel::Parallel { kappa: None }, 2416609733.53061),
        (BondModel::EulerBernoulli, 47123889.8038469),
        (BondModel::Timoshenko, 46124525.09348799),
        (BondModel::ElasticSolid, 2416609733.53061),
        (
            BondModel::ShearCoefficient { alpha: 0.9 },
            2174948760.1775494,
        ),
    ];
    for (model, shear) in shear {
        let k = stiffness(model, &shape, STEEL_PA, NU);
        assert_near(k.normal, 6283185307.179586);
        assert_near(k.shear, shear);
        assert_near(k.torsion, 48332194.67061221);
        assert_near(k.bending, 62831853.07179587);
    }
}

#[test]
fn the_contact_point_of_the_parallel_bond_lies_halfway_between_the_surfaces() {
    let shape = BondShape {
        length_m: 0.6,
        radius_m: 0.08,
        end_radii_m: [0.1, 0.4],
    };
    let k = stiffness(BondModel::Parallel { kappa: None }, &shape, STEEL_PA, NU);
    let [from_a, from_b] = k.levers_m;
    assert_near(from_a, 0.15);
    assert_near(from_b, 0.45);
    assert_near(from_a - 0.1, from_b - 0.4);
    let k = stiffness(BondModel::Timoshenko, &shape, STEEL_PA, NU);
    assert_eq!(k.levers_m, [0.3, 0.3]);
}

#[test]
fn a_given_kappa_is_the_ratio_of_normal_to_shear_stiffness() {
    let model = BondModel::Parallel { kappa: Some(2.0) };
    let k = stiffness(model, &bar_of(10), STEEL_PA, NU);
    assert_near(k.normal / k.shear, 2.0);
}

/// The pin has the springs of the parallel bond, at the same point, and no moments.
#[test]
fn a_pin_is_a_parallel_bond_without_moments() {
    let shape = BondShape {
        length_m: 0.6,
        radius_m: 0.08,
        end_radii_m: [0.1, 0.4],
    };
    for kappa in [None, Some(2.0)] {
        let of = |model| stiffness(model, &shape, STEEL_PA, NU);
        let (pin, parallel) = (
            of(BondModel::Pin { kappa }),
            of(BondModel::Parallel { kappa }),
        );
        assert_near(pin.normal, STEEL_PA * PI * 0.08 * 0.08 / 0.6);
        assert_near(pin.normal / pin.shear, kappa.unwrap_or(2.6));
        assert_eq!((pin.normal, pin.shear), (parallel.normal, parallel.shear));
        assert_eq!(pin.levers_m, parallel.levers_m);
        assert_eq!((pin.torsion, pin.bending), (0.0, 0.0));
    }
}

/// Two rods in series, each in proportion to its sphere.
#[test]
fn the_bond_of_rojek_consists_of_two_segments() {
    let of = |shape: &BondShape, kappa| stiffness(BondModel::Rojek { kappa }, shape, STEEL_PA, NU);
    let touching = BondShape {
        length_m: 0.5,
        radius_m: 0.08,
        end_radii_m: [0.1, 0.4],
    };
    let factor = 0.08 / 0.1;
    let wanted = STEEL_PA * PI * factor * factor * 0.1 * 0.4 / (0.1 + 0.4);
    for (kappa, ratio) in [(None, 2.6), (Some(3.0), 3.0)] {
        let k = of(&touching, kappa);
        assert_near(k.normal, wanted);
        assert_near(k.normal / k.shear, ratio);
        assert_near(k.bending, 0.25 * 0.08 * 0.08 * k.normal);
        assert_near(k.torsion, 0.5 * 0.08 * 0.08 * k.shear);
        // Where the segments meet, on whichever side the larger sphere is.
        assert_near(k.levers_m[0], 0.1);
        assert_eq!(k.levers_m[0] + k.levers_m[1], 0.5);
    }
    // Twice as far apart the segments are twice as long.
    let apart = BondShape {
        length_m: 1.0,
        ..touching
    };
    assert_near(of(&apart, None).normal, 0.5 * wanted);
    let turned = BondShape {
        end_radii_m: [0.4, 0.1],
        ..touching
    };
    assert_near(of(&turned, None).levers_m[1], 0.1);
    // Equal spheres: the parallel bond.
    let (rojek, parallel) = (
        of(&bar_of(10), None),
        stiffness(
            BondModel::Parallel { kappa: None },
            &bar_of(10),
            STEEL_PA,
            NU,
        ),
    );
    assert_near(rojek.normal, parallel.normal);
    assert_near(rojek.shear, parallel.shear);
    assert_near(rojek.torsion, parallel.torsion);
    assert_near(rojek.bending, parallel.bending);
    assert_eq!(rojek.levers_m, parallel.levers_m);
}

/// Ends that turn against each other feel nothing; ends that move apart, or that both turn the same
/// way, feel the springs at the point between them, in both formulations.
#[test]
fn a_pin_resists_no_rotation_of_its_ends_against_each_other() {
    let shape = BondShape {
        length_m: 2.0,
        radius_m: 0.5,
        end_radii_m: [1.0; 2],
    };
    let k = stiffness(BondModel::Pin { kappa: Some(4.0) }, &shape, 1e3, 0.3);
    let at_rest = [0.0, 2.0].map(|x| End {
        position_m: Vector3::new(x, 0.0, 0.0),
        turned: UnitQuaternion::identity(),
    });
    let turned = |turns: [Vector3<f64>; 2]| {
        let mut ends = at_rest;
        for (end, turn) in ends.iter_mut().zip(turns) {
            end.turned = UnitQuaternion::from_scaled_axis(turn);
        }
        let total = bond_forces(&k, &Vector3::x(), &ends);
        let step = Step {
            apart_before: 2.0 * Vector3::x(),
            apart_after: 2.0 * Vector3::x(),
            turns,
        };
        let history = advance(&k, &History::default(), &step);
        let summed = incremental::bond_forces(&k, &history, &(2.0 * Vector3::x()));
        [total, summed]
    };
    for axis in [Vector3::x(), Vector3::z()] {
        for found in turned([-0.1 * axis, 0.1 * axis]) {
            assert!(
                found.force_on_b.norm() < 1e-12,
                "{axis}: {}",
                found.force_on_b
            );
            assert!(found.torques[0].norm() + found.torques[1].norm() < 1e-12);
            assert_eq!((found.load.torsion_n_m, found.load.bending_n_m), (0.0, 0.0));
            assert!(found.energy.total() < 1e-12, "{:?}", found.energy);
        }
    }
    // Both by a small angle: the point slides by the length times that.
    let angle = 1e-6;
    for found in turned([angle * Vector3::z(); 2]) {
        let force = k.shear * 2.0 * angle;
        assert!(
            (found.force_on_b.y / force - 1.0).abs() < 1e-9,
            "{}",
            found.force_on_b
        );
        for torque in found.torques {
            assert!((torque.z / -force - 1.0).abs() < 1e-9, "{torque}");
        }
    }
}

/// A cantilever of bonds end to end under a force F at its tip: each bond shears by F / k_s and
/// bends by the moment at its middle.
fn tip_of_cantilever(model: BondModel, bonds: u32) -> f64 {
    let shape = bar_of(bonds);
    let k = stiffness(model, &shape, STEEL_PA, NU);
    let force = 100e3;
    let mut slope = 0.0;
    let mut deflection = 0.0;
    for bond in 0..bonds {
        let to_tip = 4.0 - f64::from(bond) * shape.length_m;
        let turn = force * (to_tip - k.levers_m[0]) / k.bending;
        deflection +=
            slope * shape.length_m + force / k.shear + turn * (shape.length_m - k.levers_m[0]);
        slope += turn;
    }
    deflection
}

#[test]
fn cantilevers_of_ten_bonds_bend_as_the_reference_values_say() {
    let tips = [
        (BondModel::Parallel { kappa: None }, 0.008508423257692722),
        (BondModel::EulerBernoulli, 0.008488263631567749),
        (BondModel::Timoshenko, 0.00853424172623874),
        (BondModel::ElasticSolid, 0.008508423257692722),
        (
            BondModel::ShearCoefficient { alpha: 0.9 },
            0.008513021067159822,
        ),
    ];
    for (model, tip) in tips {
        let found = tip_of_cantilever(model, 10);
        assert!(
            (found / tip - 1.0).abs() < 1e-12,
            "{model:?}: {found} instead of {tip}"
        );
    }
}
