//! Stiffnesses compared with Chen et al. 2022, table 5, with the digits of an independent
//! implementation.

use dem_run::physics::bond::stiffness::{BondModel, BondShape, stiffness};

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
