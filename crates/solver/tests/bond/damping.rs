//! Damping of bonds: its conservation laws, its dissipation, and the largest step compared with an
//! independent implementation.

use super::vector;
use dem_run::physics::bond::damping::{
    DampingCoefficients, DampingForces, DampingModel, EndMotion, ReducedInertia, damping_forces,
    reduced,
};
use dem_run::physics::bond::damping_models::{Chen, ChenByMode, Platzer};
use dem_run::physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use dem_run::physics::bond::total::{End, bond_forces};
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

/// Largest step of a free chain of eleven steel spheres as a fraction of the undamped one, damped
/// with these eta, for eqs. 9 and 10 and for each mode's own stiffness.
const ETAS: [f64; 5] = [0.05, 0.1, 0.2, 0.4, 0.6];
const LIMITS: [(BondModel, f64, [f64; 5], [f64; 5]); 4] = [
    (
        BondModel::Parallel { kappa: None },
        6.53698268945512e-05,
        [
            0.8442979121788551,
            0.7102008473742787,
            0.518089075833483,
            0.3170235225014872,
            0.22303275008511247,
        ],
        [
            0.9028252304936923,
            0.8088872539788656,
            0.6549154043639603,
            0.45216260520135654,
            0.3354788473966709,
        ],
    ),
    (
        BondModel::EulerBernoulli,
        4.740045402825849e-05,
        [
            0.8794186116229545,
            0.7749732113016656,
            0.6096074451936366,
            0.4053583516880592,
            0.2951951279893621,
        ],
        [
            0.8946735658089997,
            0.8015217793890331,
            0.6488874859362979,
            0.4479527334113478,
            0.3323386705326579,
        ],
    ),
    (
        BondModel::Timoshenko,
        6.536982689455117e-05,
        [
            0.9324554253091629,
            0.8232541562977674,
            0.5660298605893419,
            0.3285789916292624,
            0.22711135534317364,
        ],
        [
            0.9324554253093366,
            0.8697679576786461,
            0.7584868522884571,
            0.5698509338527495,
            0.4245998807076023,
        ],
    ),
    (
        BondModel::ShearCoefficient { alpha: 0.9 },
        6.53698268945512e-05,
        [
            0.8808888383028054,
            0.7347327295762411,
            0.5291573783391053,
            0.3198811186587312,
            0.22406670595216202,
        ],
        [
            0.9324554253093014,
            0.8516166263646934,
            0.6897933149958558,
            0.47628963750966635,
            0.35339289592138506,
        ],
    ),
];

/// Matrix that maps velocities of the chain to forces against them, each row and column divided by
/// the square root of its mass. With stiffnesses in place of the coefficients it is the stiffness
/// matrix.
fn matrix_of_chain(coefficients: &DampingCoefficients, levers_m: &[f64; 2]) -> DMatrix<f64> {
    let spheres = 11;
    let root = |row: usize| if row % 6 < 3 { MASS_KG } else { INERTIA_KG_M2 }.sqrt();
    let mut matrix = DMatrix::zeros(6 * spheres, 6 * spheres);
    for first in (0..spheres - 1).map(|sphere| 6 * sphere) {
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

/// Largest dt for which v += dt (-K x - C v), x += dt v does not grow: 4 - 2 dt C - dt^2 K must not
/// have a negative eigenvalue.
fn exact_limit(k: &DMatrix<f64>, c: &DMatrix<f64>, above: f64) -> f64 {
    let four = DMatrix::from_diagonal_element(k.nrows(), k.nrows(), 4.0);
    let (mut low, mut high) = (0.0, above);
    for _ in 0..40 {
        let dt = 0.5 * (low + high);
        let rest: DMatrix<f64> = &four - c * (2.0 * dt) - k * (dt * dt);
        if rest.cholesky().is_some() {
            low = dt;
        } else {
            high = dt;
        }
    }
    low
}

fn largest_eigenvalue(matrix: &DMatrix<f64>) -> f64 {
    matrix.clone().symmetric_eigenvalues().max()
}

#[test]
fn a_damped_chain_takes_the_steps_of_the_independent_implementation() {
    let pair = pair_of_steel();
    for (model, undamped, both, by_mode) in LIMITS {
        let k = steel(model);
        let stiff = DampingCoefficients {
            normal: k.normal,
            shear: k.shear,
            torsion: k.torsion,
            bending: k.bending,
        };
        let stiff = matrix_of_chain(&stiff, &k.levers_m);
        let lambda = largest_eigenvalue(&stiff);
        let limit = 2.0 / lambda.sqrt();
        assert!((limit / undamped - 1.0).abs() < 1e-12, "{model:?}: {limit}");
        for (case, eta) in ETAS.into_iter().enumerate() {
            for (damping, wanted) in [
                (
                    Chen { damping_ratio: eta }.coefficients(&k, &pair),
                    both[case],
                ),
                (
                    ChenByMode { damping_ratio: eta }.coefficients(&k, &pair),
                    by_mode[case],
                ),
            ] {
                let damped = matrix_of_chain(&damping, &k.levers_m);
                let found = exact_limit(&stiff, &damped, 1.01 * limit) / limit;
                // The reference determined its limits by bisection, to this accuracy.
                assert!(
                    (found / wanted - 1.0).abs() < 1e-6,
                    "{model:?}, {eta}: {found} instead of {wanted}"
                );
                let c = largest_eigenvalue(&damped);
                let safe = (-c + (c * c + 4.0 * lambda).sqrt()) / lambda / limit;
                assert!(safe <= found, "{model:?}, {eta}: {safe} above {found}");
            }
        }
    }
}
