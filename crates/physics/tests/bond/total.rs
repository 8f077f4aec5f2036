//! The total formulation: its forces are the gradient of its energy, and only deformation gives a
//! force.

use super::{MODELS, vector};
use dem_physics::bond::stiffness::{BondShape, Stiffness, stiffness};
use dem_physics::bond::total::{BondForces, End, bond_forces};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

fn direction() -> impl Strategy<Value = Vector3<f64>> {
    vector(1.0)
        .prop_filter("has a direction", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}

/// A bond of length 1 with its ends displaced and rotated by up to a few tenths.
pub(crate) fn bond() -> impl Strategy<Value = (Stiffness, Vector3<f64>, [End; 2])> {
    let ends = (vector(0.2), vector(0.5), vector(0.2), vector(0.5));
    (0..MODELS.len(), direction(), 0.2..0.6, ends).prop_map(
        |(model, direction, radius_a, (move_a, turn_a, move_b, turn_b))| {
            let shape = BondShape {
                length_m: 1.0,
                radius_m: 0.2,
                end_radii_m: [radius_a, 0.4],
            };
            let ends = [
                (Vector3::zeros(), move_a, turn_a),
                (direction, move_b, turn_b),
            ]
            .map(|(at, moved, turn)| End {
                position_m: at + moved,
                turned: UnitQuaternion::from_scaled_axis(turn),
            });
            (stiffness(MODELS[model], &shape, 1e3, 0.3), direction, ends)
        },
    )
}

pub(crate) fn largest(forces: &BondForces) -> f64 {
    let torques = forces.torques.map(|t| t.norm());
    forces.force_on_b.norm().max(torques[0]).max(torques[1])
}

proptest! {
    #[test]
    fn forces_are_the_gradient_of_the_energy(
        (k, direction, ends) in bond(), step in direction(), end in 0..2_usize, turning in any::<bool>()
    ) {
        let h = 1e-5;
        let energy = |h: f64| {
            let mut ends = ends;
            if turning {
                ends[end].turned = UnitQuaternion::from_scaled_axis(h * step) * ends[end].turned;
            } else {
                ends[end].position_m += h * step;
            }
            bond_forces(&k, &direction, &ends).energy.total()
        };
        // Fourth order.
        let slope = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
        let forces = bond_forces(&k, &direction, &ends);
        let push = if turning {
            forces.torques[end].dot(&step)
        } else {
            forces.force_on_b.dot(&step) * if end == 1 { 1.0 } else { -1.0 }
        };
        prop_assert!((slope + push).abs() < 1e-8 * largest(&forces).max(1.0), "{slope} and {push}");
    }

    #[test]
    fn the_bond_turns_nothing_as_a_whole((k, direction, ends) in bond()) {
        let forces = bond_forces(&k, &direction, &ends);
        let apart = ends[1].position_m - ends[0].position_m;
        let moment = apart.cross(&forces.force_on_b) + forces.torques[0] + forces.torques[1];
        prop_assert!(moment.norm() < 1e-13 * largest(&forces), "{moment}");
    }

    #[test]
    fn half_of_load_times_deformation_is_the_energy_of_each_mode((k, direction, ends) in bond()) {
        let BondForces { energy, load, .. } = bond_forces(&k, &direction, &ends);
        let modes = [
            (energy.normal, load.normal_n, k.normal),
            (energy.shear, load.shear_n, k.shear),
            (energy.torsion, load.torsion_n_m, k.torsion),
            (energy.bending, load.bending_n_m, k.bending),
        ];
        for (energy, load, k) in modes {
            if k == 0.0 {
                prop_assert_eq!((energy, load), (0.0, 0.0));
            } else {
                prop_assert!((0.5 * load * load / k - energy).abs() <= 1e-14 * energy);
            }
        }
        prop_assert!(load.shear_n >= 0.0 && load.torsion_n_m >= 0.0 && load.bending_n_m >= 0.0);
        let length = (ends[1].position_m - ends[0].position_m).norm();
        prop_assert_eq!(load.normal_n > 0.0, length > 1.0);
    }

    #[test]
    fn it_does_not_matter_which_end_is_named_first((k, direction, ends) in bond()) {
        let forward = bond_forces(&k, &direction, &ends);
        let [a, b] = k.levers_m;
        let k = Stiffness { levers_m: [b, a], ..k };
        let back = bond_forces(&k, &-direction, &[ends[1], ends[0]]);
        let scale = 1e-13 * largest(&forward);
        prop_assert!((forward.force_on_b + back.force_on_b).norm() < scale);
        prop_assert!((forward.torques[0] - back.torques[1]).norm() < scale);
        prop_assert!((forward.torques[1] - back.torques[0]).norm() < scale);
    }

    #[test]
    fn moving_and_turning_the_whole_bond_changes_nothing(
        (k, direction, ends) in bond(), shift in vector(3.0), turn in vector(3.0)
    ) {
        let here = bond_forces(&k, &direction, &ends);
        let turn = UnitQuaternion::from_scaled_axis(turn);
        let elsewhere = ends.map(|end| End {
            position_m: turn * end.position_m + shift,
            turned: turn * end.turned,
        });
        let there = bond_forces(&k, &direction, &elsewhere);
        let scale = 1e-12 * largest(&here);
        prop_assert!((turn * here.force_on_b - there.force_on_b).norm() < scale);
        for side in 0..2 {
            prop_assert!((turn * here.torques[side] - there.torques[side]).norm() < scale);
        }
    }

    #[test]
    fn a_bond_that_was_only_moved_and_turned_is_free_of_force(
        model in 0..MODELS.len(), direction in direction(), shift in vector(3.0), turn in vector(3.0)
    ) {
        let shape = BondShape { length_m: 1.0, radius_m: 0.2, end_radii_m: [0.3, 0.5] };
        let k = stiffness(MODELS[model], &shape, 1e3, 0.3);
        let turned = UnitQuaternion::from_scaled_axis(turn);
        let ends = [shift, shift + turned * direction].map(|position_m| End { position_m, turned });
        let forces = bond_forces(&k, &direction, &ends);
        prop_assert!(largest(&forces) < 1e-11, "{}", largest(&forces));
    }
}

/// Small displacements of one end give the four stiffnesses.
#[test]
fn each_mode_has_its_stiffness() {
    let shape = BondShape {
        length_m: 0.4,
        radius_m: 0.2,
        end_radii_m: [0.2; 2],
    };
    let small = 1e-6;
    for model in MODELS {
        let k = stiffness(model, &shape, 200e9, 0.3);
        let along = Vector3::x();
        let forces_when = |moved: Vector3<f64>, turns: [Vector3<f64>; 2]| {
            let positions = [Vector3::zeros(), 0.4 * along + moved];
            let ends = [0, 1].map(|i| End {
                position_m: positions[i],
                turned: UnitQuaternion::from_scaled_axis(turns[i]),
            });
            bond_forces(&k, &along, &ends)
        };
        // Where there is no stiffness, nothing beyond second order in the displacement.
        let least = 2.0 * small * k.shear * shape.length_m.powi(2);
        let near = |found: f64, wanted: f64| {
            assert!(
                (found - wanted).abs() < if wanted == 0.0 { least } else { 1e-5 * wanted },
                "{model:?}: {found} instead of {wanted}"
            );
        };
        let none = Vector3::zeros();
        let stretched = forces_when(small * along, [none; 2]);
        near(-stretched.force_on_b.x / small, k.normal);
        let sheared = forces_when(small * Vector3::y(), [none; 2]);
        near(-sheared.force_on_b.y / small, k.shear);
        let twisted = forces_when(none, [none, small * along]);
        near(-twisted.torques[1].x / small, k.torsion);
        near(twisted.torques[0].x / small, k.torsion);
        // Both ends rotated against each other about the contact point in the middle: bending
        // without shear.
        let turn = 0.5 * small * Vector3::z();
        let bent = forces_when(none, [-turn, turn]);
        near(-bent.torques[1].z / small, k.bending);
        near(bent.torques[0].z / small, k.bending);
    }
}
