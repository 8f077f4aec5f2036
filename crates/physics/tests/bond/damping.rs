//! Damping of bonds: its conservation laws, its dissipation, and the largest step compared with an
//! independent implementation.

use super::vector;
use dem_physics::bond::damping::{
    DampingCoefficients, DampingModel, EndMotion, ReducedInertia, reduced, resistance,
};
use dem_physics::bond::damping_models::{Chen, ChenByMode, Platzer};
use dem_physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use dem_physics::bond::total::{End, bond_forces};
use dem_physics::chebyshev::Chebyshev;
use dem_physics::number::Vec3;
use nalgebra::{DMatrix, UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn direction() -> impl Strategy<Value = Vector3<f64>> {
    vector(1.0)
        .prop_filter("has a direction", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}

fn motion() -> impl Strategy<Value = EndMotion> {
    (vector(3.0), vector(3.0)).prop_map(|(velocity_m_s, spin_rad_s)| EndMotion {
        velocity_m_s,
        spin_rad_s,
    })
}

fn coefficients() -> impl Strategy<Value = DampingCoefficients> {
    (0.0..9.0, 0.0..9.0, 0.0..9.0, 0.0..9.0).prop_map(|(normal, shear, torsion, bending)| {
        DampingCoefficients {
            normal,
            shear,
            torsion,
            bending,
        }
    })
}

/// Force on the second end, N, and torques on both, N m.
struct DampingForces {
    force_on_b: Vector3<f64>,
    torques: [Vector3<f64>; 2],
}

/// Damping of a bond that is now `length_m` long along the unit vector `c` from a to b.
fn damping_forces(
    coefficients: &DampingCoefficients,
    levers_m: &[f64; 2],
    c: &Vector3<f64>,
    length_m: f64,
    ends: &[EndMotion; 2],
) -> DampingForces {
    let motions = ends.map(|end| [Vec3::from(end.velocity_m_s), Vec3::from(end.spin_rad_s)]);
    let apart = Vec3::from(length_m * c);
    let (force_on_b, torques) = resistance(coefficients, *levers_m, apart, motions);
    DampingForces {
        force_on_b: force_on_b.into(),
        torques: torques.map(Vector3::from),
    }
}

/// Scale of rounding errors: coefficients, speeds and levers are of the order 1 to 10.
const ROUNDING: f64 = 1e-12;

proptest! {
    #[test]
    fn damping_turns_nothing_as_a_whole_and_never_adds_energy(
        d in coefficients(), c in direction(), levers in [0.1..1.0, 0.1..1.0], length in 0.5..2.0, a in motion(), b in motion()
    ) {
        let ends = [a, b];
        let DampingForces { force_on_b, torques } = damping_forces(&d, &levers, &c, length, &ends);
        let moment = (length * c).cross(&force_on_b) + torques[0] + torques[1];
        prop_assert!(moment.norm() < ROUNDING, "{moment}");
        let power = force_on_b.dot(&(b.velocity_m_s - a.velocity_m_s))
            + torques[0].dot(&a.spin_rad_s) + torques[1].dot(&b.spin_rad_s);
        prop_assert!(power <= ROUNDING, "{power}");
    }

    #[test]
    fn a_bond_that_moves_as_a_rigid_body_is_not_damped(
        d in coefficients(), c in direction(), levers in [0.1..1.0, 0.1..1.0], length in 0.5..2.0,
        a in vector(5.0), centre in vector(5.0), drift in vector(3.0), spin in vector(3.0)
    ) {
        let ends = [a, a + length * c].map(|at| EndMotion {
            velocity_m_s: drift + spin.cross(&(at - centre)),
            spin_rad_s: spin,
        });
        let forces = damping_forces(&d, &levers, &c, length, &ends);
        prop_assert!(forces.force_on_b.norm() < ROUNDING);
        prop_assert!(forces.torques[0].norm().max(forces.torques[1].norm()) < ROUNDING);
    }

    #[test]
    fn it_does_not_matter_which_end_is_named_first(
        d in coefficients(), c in direction(), levers in [0.1..1.0, 0.1..1.0], length in 0.5..2.0, a in motion(), b in motion()
    ) {
        let forward = damping_forces(&d, &levers, &c, length, &[a, b]);
        let back = damping_forces(&d, &[levers[1], levers[0]], &-c, length, &[b, a]);
        prop_assert!((forward.force_on_b + back.force_on_b).norm() < ROUNDING);
        prop_assert!((forward.torques[0] - back.torques[1]).norm() < ROUNDING);
        prop_assert!((forward.torques[1] - back.torques[0]).norm() < ROUNDING);
    }
}

#[test]
fn a_held_end_leaves_mass_and_inertia_of_the_other() {
    let one = reduced([0.0, 0.25], [0.0, 0.5]);
    assert_eq!((one.mass_kg, one.inertia_kg_m2), (4.0, 2.0));
    let two = reduced([1.0, 0.25], [0.5, 0.5]);
    assert_eq!((two.mass_kg, two.inertia_kg_m2), (0.8, 1.0));
    let none = reduced([0.0; 2], [0.0; 2]);
    assert_eq!((none.mass_kg, none.inertia_kg_m2), (0.0, 0.0));
}

const YOUNG_PA: f64 = 200e9;
const LENGTH_M: f64 = 0.4;
const RADIUS_M: f64 = 0.2;
/// A sphere of steel, 7850 kg/m^3.
const MASS_KG: f64 = 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M * RADIUS_M * RADIUS_M;
const INERTIA_KG_M2: f64 = 0.4 * MASS_KG * RADIUS_M * RADIUS_M;

fn steel(model: BondModel) -> Stiffness {
    let shape = BondShape {
        length_m: LENGTH_M,
        radius_m: RADIUS_M,
        end_radii_m: [RADIUS_M; 2],
    };
    stiffness(model, &shape, YOUNG_PA, 0.3)
}

fn pair_of_steel() -> ReducedInertia {
    reduced([1.0 / MASS_KG; 2], [1.0 / INERTIA_KG_M2; 2])
}

#[test]
fn platzer_damps_with_its_equations_7_and_9() {
    let (k, pair) = (
        steel(BondModel::ShearCoefficient { alpha: 0.9 }),
        pair_of_steel(),
    );
    let second_moment = 0.25 * std::f64::consts::PI * RADIUS_M.powi(4);
    let shear_modulus = YOUNG_PA / 2.6;
    let torsion = (2.0 * shear_modulus * second_moment * 0.5 * INERTIA_KG_M2 / LENGTH_M).sqrt();
    let bending = (YOUNG_PA * second_moment * 0.5 * INERTIA_KG_M2 / LENGTH_M).sqrt();
    let platzer = |coefficient_n_s_m, moment_factor| {
        let model = Platzer {
            coefficient_n_s_m,
            moment_factor,
        };
        model.coefficients(&k, &pair)
    };
    let d = platzer(7.0, 1.0) + platzer(1.0, 0.5);
    assert_eq!((d.normal, d.shear), (8.0, 8.0));
    assert!((d.torsion / (1.5 * torsion) - 1.0).abs() < 1e-14);
    assert!((d.bending / (1.5 * bending) - 1.0).abs() < 1e-14);
}

/// One relative coordinate of two equal spheres, released at a small deflection, after this many
/// damped periods: fourth-order Runge-Kutta.
fn after_periods(
    periods: u32,
    frequency_rad_s: f64,
    mut acceleration: impl FnMut(f64, f64) -> f64,
) -> f64 {
    let steps_per_period = 1000;
    let h = TAU / frequency_rad_s / f64::from(steps_per_period);
    let (mut q, mut v) = (DEFLECTION, 0.0);
    for _ in 0..periods * steps_per_period {
        let a1 = acceleration(q, v);
        let (q2, v2) = (q + 0.5 * h * v, v + 0.5 * h * a1);
        let a2 = acceleration(q2, v2);
        let (q3, v3) = (q + 0.5 * h * v2, v + 0.5 * h * a2);
        let a3 = acceleration(q3, v3);
        let (q4, v4) = (q + h * v3, v + h * a3);
        let a4 = acceleration(q4, v4);
        q += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
        v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    q
}

/// Small: nonlinear effects are of the order of its square.
const DEFLECTION: f64 = 1e-6;

#[test]
fn two_spheres_swing_with_the_logarithmic_decrement_of_eta() {
    let (k, pair) = (steel(BondModel::Timoshenko), pair_of_steel());
    let eta = 0.05;
    let d = ChenByMode { damping_ratio: eta }.coefficients(&k, &pair);
    let x = Vector3::x();
    let decrement = TAU * eta / (1.0_f64 - eta * eta).sqrt();
    for turning in [None, Some(x), Some(Vector3::z())] {
        let accelerate = |q: f64, v: f64| {
            let (moved, turned) =
                turning.map_or((x, Vector3::zeros()), |axis| (Vector3::zeros(), axis));
            let side = [-0.5, 0.5];
            let ends = side.map(|side| End {
                position_m: side * (LENGTH_M * x + q * moved),
                turned: UnitQuaternion::from_scaled_axis(side * q * turned),
            });
            let motions = side.map(|side| EndMotion {
                velocity_m_s: side * v * moved,
                spin_rad_s: side * v * turned,
            });
            let length = (ends[1].position_m - ends[0].position_m).norm();
            let spring = bond_forces(&k, &x, &ends);
            let damper = damping_forces(&d, &k.levers_m, &x, length, &motions);
            let force = spring.force_on_b + damper.force_on_b;
            let torque = spring.torques[1] + damper.torques[1];
            force.dot(&moved) / pair.mass_kg + torque.dot(&turned) / pair.inertia_kg_m2
        };
        let square = match turning {
            None => k.normal / pair.mass_kg,
            Some(axis) if axis == x => k.torsion / pair.inertia_kg_m2,
            Some(_) => k.bending / pair.inertia_kg_m2,
        };
        let damped = (square * (1.0 - eta * eta)).sqrt();
        let periods = 5;
        let left = after_periods(periods, damped, accelerate) / DEFLECTION;
        let found = -left.ln() / f64::from(periods);
        assert!(
            (found / decrement - 1.0).abs() < 1e-8,
            "{found} instead of {decrement}"
        );
    }
}

/// Spheres of a free chain of steel.
const CHAIN: usize = 4;

/// Matrix that maps velocities of the chain to forces against them, each row and column divided by
/// the square root of its mass. With stiffnesses in place of the coefficients it is the stiffness
/// matrix.
fn matrix_of_chain(coefficients: &DampingCoefficients, levers_m: &[f64; 2]) -> DMatrix<f64> {
    let root = |row: usize| if row % 6 < 3 { MASS_KG } else { INERTIA_KG_M2 }.sqrt();
    let mut matrix = DMatrix::zeros(6 * CHAIN, 6 * CHAIN);
    for first in (0..CHAIN - 1).map(|sphere| 6 * sphere) {
        for column in 0..12 {
            let unit: Vec<f64> = (0..12).map(|row| f64::from(row == column)).collect();
            let ends = [0, 6].map(|end| EndMotion {
                velocity_m_s: Vector3::from_column_slice(&unit[end..end + 3]),
                spin_rad_s: Vector3::from_column_slice(&unit[end + 3..end + 6]),
            });
            let bond_response =
                damping_forces(coefficients, levers_m, &Vector3::x(), LENGTH_M, &ends);
            let blocks = [
                -bond_response.force_on_b,
                bond_response.torques[0],
                bond_response.force_on_b,
                bond_response.torques[1],
            ];
            for (block, push) in blocks.iter().enumerate() {
                for (axis, push) in push.iter().enumerate() {
                    let (row, column) = (first + 3 * block + axis, first + column);
                    matrix[(row, column)] -= push / (root(row) * root(column));
                }
            }
        }
    }
    matrix
}

fn largest_eigenvalue(matrix: &DMatrix<f64>) -> f64 {
    matrix.clone().symmetric_eigenvalues().max()
}

/// Whether the steps with this dt^2 K and dt C grow: displacements x and dt times the velocities
/// half a step before q, in 2^16 steps. The motion of the chain as a rigid body grows linearly.
fn grows(k: &DMatrix<f64>, c: &DMatrix<f64>) -> bool {
    let n = k.nrows();
    let one = DMatrix::identity(n, n);
    let stages = Chebyshev::covering(largest_eigenvalue(c));
    let rate = |change: &DMatrix<f64>| -c * (&one + change);
    let first = rate(&DMatrix::zeros(n, n));
    let (mut before, mut now) = (DMatrix::zeros(n, n), &first * stages.first);
    for stage in &stages.others {
        let next = &now * stage.last
            + &before * stage.before
            + rate(&now) * stage.force
            + &first * stage.first_force;
        (before, now) = (now, next);
    }
    let decay = &one + now;
    let q_from_x = -(&decay * k + k) * 0.5;
    let mut map = DMatrix::zeros(2 * n, 2 * n);
    let mut set = |row: usize, column: usize, block: &DMatrix<f64>| {
        map.view_mut((row * n, column * n), (n, n)).copy_from(block);
    };
    set(0, 0, &(&one + &q_from_x));
    set(0, 1, &decay);
    set(1, 0, &q_from_x);
    set(1, 1, &decay);
    for _ in 0..16 {
        map = &map * &map;
        let is_small = map.amax() < 1e12;
        if !is_small {
            return true;
        }
    }
    false
}

/// The largest stable step of a network whose damping is not proportional to its stiffness is that
/// without damping, 2 over the root of the largest eigenvalue of M^-1 K, however strong the
/// damping.
#[test]
fn a_damped_chain_is_stable_up_to_the_undamped_limit() {
    let pair = pair_of_steel();
    for model in super::MODELS {
        let k = steel(model);
        let stiff = DampingCoefficients {
            normal: k.normal,
            shear: k.shear,
            torsion: k.torsion,
            bending: k.bending,
        };
        let stiff = matrix_of_chain(&stiff, &k.levers_m);
        let limit = 2.0 / largest_eigenvalue(&stiff).sqrt();
        for eta in [0.05, 0.3, 1.0, 10.0] {
            for damping in [
                Chen { damping_ratio: eta }.coefficients(&k, &pair),
                ChenByMode { damping_ratio: eta }.coefficients(&k, &pair),
            ] {
                let damped = matrix_of_chain(&damping, &k.levers_m);
                for (fraction, wanted) in [(0.5, false), (0.999, false), (1.001, true)] {
                    let dt = fraction * limit;
                    let found = grows(&(&stiff * (dt * dt)), &(&damped * dt));
                    assert_eq!(found, wanted, "{model:?}, {eta}: {fraction} of the limit");
                }
            }
        }
    }
}
