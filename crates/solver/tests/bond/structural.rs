//! Structural damping of bonds: what it takes, what it leaves alone, and the four viscous ratios.

use super::vector;
use crate::leave_out::planned;
use dem_run::check::limit::limit;
use dem_run::physics::bond::BondLoad;
use dem_run::physics::bond::damping::{DampingModel, EndMotion, ReducedInertia};
use dem_run::physics::bond::damping_models::{ChenByMode, ModeRatios, structural_forces};
use dem_run::physics::bond::stiffness::{BondModel, BondShape, stiffness};
use dem_run::stages::ledger::balance;
use dem_run::state::State;
use dem_run::step::{advance, interact, step};
use nalgebra::Vector3;
use proptest::prelude::*;

const ROUNDING: f64 = 1e-12;

fn load() -> impl Strategy<Value = BondLoad> {
    (-2.0..2.0, 0.0..2.0, 0.0..2.0, 0.0..2.0).prop_map(
        |(normal_n, shear_n, torsion_n_m, bending_n_m)| BondLoad {
            normal_n,
            shear_n,
            torsion_n_m,
            bending_n_m,
        },
    )
}

fn motion() -> impl Strategy<Value = EndMotion> {
    (vector(3.0), vector(3.0)).prop_map(|(velocity_m_s, spin_rad_s)| EndMotion {
        velocity_m_s,
        spin_rad_s,
    })
}

proptest! {
    /// The power is minus gamma times each load times the speed of its mode; there is no net force
    /// and no net moment; and naming the other end first changes nothing.
    #[test]
    fn each_mode_is_resisted_by_a_fraction_of_its_load(
        gamma in 0.0..1.0, load in load(), c in vector(1.0), levers in [0.1..1.0, 0.1..1.0], a in motion(), b in motion()
    ) {
        prop_assume!(c.norm() > 0.1);
        let c = c.normalize();
        let length = levers[0] + levers[1];
        let found = structural_forces(gamma, &load, &levers, &c, length, &[a, b]);
        let arms = levers.map(|lever| lever * c);
        let slip = b.velocity_m_s - a.velocity_m_s
            - a.spin_rad_s.cross(&arms[0]) - b.spin_rad_s.cross(&arms[1]);
        let spin = b.spin_rad_s - a.spin_rad_s;
        let speeds = |v: Vector3<f64>| [v.dot(&c).abs(), v.cross(&c).norm()];
        let ([along, across], [about, bent]) = (speeds(slip), speeds(spin));
        let lost = gamma * (load.normal_n.abs() * along + load.shear_n * across
            + load.torsion_n_m * about + load.bending_n_m * bent);
        let power = found.force_on_b.dot(&(b.velocity_m_s - a.velocity_m_s))
            + found.torques[0].dot(&a.spin_rad_s) + found.torques[1].dot(&b.spin_rad_s);
        prop_assert!((power + lost).abs() < 100.0 * ROUNDING, "{power} {lost}");
        let moment = (length * c).cross(&found.force_on_b) + found.torques[0] + found.torques[1];
        prop_assert!(moment.norm() < ROUNDING, "{moment}");
        let back = structural_forces(gamma, &load, &[levers[1], levers[0]], &-c, length, &[b, a]);
        prop_assert!((found.force_on_b + back.force_on_b).norm() < ROUNDING);
        prop_assert!((found.torques[0] - back.torques[1]).norm() < ROUNDING);
    }
}

#[test]
fn ends_at_rest_are_not_pushed() {
    let load = BondLoad {
        normal_n: -3.0,
        shear_n: 2.0,
        torsion_n_m: 1.0,
        bending_n_m: 4.0,
    };
    let rest = EndMotion {
        velocity_m_s: Vector3::new(0.5, 0.25, -2.0),
        spin_rad_s: Vector3::zeros(),
    };
    let found = structural_forces(0.5, &load, &[1.0; 2], &Vector3::x(), 2.0, &[rest; 2]);
    assert_eq!(found.force_on_b, Vector3::zeros());
    assert_eq!(found.torques, [Vector3::zeros(); 2]);
}

#[test]
fn four_equal_ratios_are_those_of_each_mode_and_each_acts_on_its_own() {
    let shape = BondShape {
        length_m: 2e-3,
        radius_m: 1e-3,
        end_radii_m: [1e-3; 2],
    };
    let stiffness = stiffness(BondModel::Timoshenko, &shape, 15e6, 0.3);
    let reduced = ReducedInertia {
        mass_kg: 3e-6,
        inertia_kg_m2: 2e-12,
    };
    let equal = ModeRatios {
        normal: 0.3,
        shear: 0.3,
        torsion: 0.3,
        bending: 0.3,
    };
    let by_mode = ChenByMode { damping_ratio: 0.3 }.coefficients(&stiffness, &reduced);
    let close = |found: f64, wanted: f64| (found - wanted).abs() <= 1e-15 * wanted.abs();
    let all = equal.coefficients(&stiffness, &reduced);
    assert!(close(all.normal, by_mode.normal) && close(all.shear, by_mode.shear));
    assert!(close(all.torsion, by_mode.torsion) && close(all.bending, by_mode.bending));
    let twist = ModeRatios {
        torsion: 0.6,
        normal: 0.0,
        shear: 0.0,
        bending: 0.0,
    };
    let twist = twist.coefficients(&stiffness, &reduced);
    assert!(close(twist.torsion, 2.0 * by_mode.torsion));
    assert_eq!((twist.normal, twist.shear, twist.bending), (0.0, 0.0, 0.0));
}

/// Two bonded spheres along x with this damping of their bond.
fn pair(damping: &str, formulation: &str, more: &str) -> State {
    let (_, plan) = planned(&format!(
        "version = 1
run = {{ end_time = 1, time_step = 2e-7 }}
materials.stone.density = 2500
bonds.glue = {{ formulation = \"{formulation}\", young_modulus = 1e9, poisson_ratio = 0.25, damping = {{ {damping} }} }}
bodies.pair = {{ particles = [[0, 0, 0, 1e-3], [3e-3, 0, 0, 1e-3]], bond_list = [[0, 1]], material = \"stone\", bonds = \"glue\"{more} }}
"
    ));
    plan.state
}

/// The stiffness counts 1 + gamma times in the largest stable step, and not in the undamped one.
#[test]
fn the_limit_counts_the_stiffness_that_damping_adds() {
    let free = limit(&mut pair("damping_ratio = 0", "total", ""));
    for gamma in [0.1, 0.5, 0.9_f64] {
        let found = limit(&mut pair(
            &format!("structural_damping = {gamma}"),
            "total",
            "",
        ));
        let ratio = found.step_s / free.step_s * (1.0 + gamma).sqrt();
        assert!((ratio - 1.0).abs() < 1e-4, "{gamma}: {ratio}");
        assert!((found.undamped_step_s / free.step_s - 1.0).abs() < 1e-9);
    }
}

/// Free flight with a spin: momenta and the centre are those of a body without damping, and energy
/// is in the books.
#[test]
fn a_flying_spinning_pair_keeps_its_momenta() {
    for formulation in ["total", "incremental"] {
        let moving = ", velocity = [3, -2, 1], angular_velocity = [50, 200, -100]";
        let mut state = pair("structural_damping = 0.4", formulation, moving);
        let mut lost_j = 0.0;
        for _ in 0..5000 {
            interact(&mut state);
            let now = balance(&mut state);
            assert!(now.momentum_error < 1e-12, "{}", now.momentum_error);
            assert!(
                now.angular_momentum_error < 1e-12,
                "{}",
                now.angular_momentum_error
            );
            assert!(now.energy_error.abs() < 1e-6, "{}", now.energy_error);
            lost_j = now.structural_damping_j;
            advance(&mut state);
        }
        assert!(lost_j > 0.0);
    }
}

/// A grid of bonded spheres that falls on a floor: the rebound over the fall.
fn rebound(gamma: f64) -> f64 {
    const SIDE: usize = 4;
    let number = |x: usize, y: usize, z: usize| x + SIDE * (y + SIDE * z);
    let (mut spheres, mut pairs) = (Vec::new(), Vec::new());
    for z in 0..SIDE {
        for y in 0..SIDE {
            for x in 0..SIDE {
                let at = [x, y, z].map(|n| 2e-3 * n as f64);
                // Slightly uneven, so that the impact reaches all modes.
                let bottom = 1.05e-3 + 2e-5 * ((3 * x + 7 * y) % 5) as f64;
                spheres.push(format!("[{}, {}, {}, 1e-3]", at[0], at[1], at[2] + bottom));
                let me = number(x, y, z);
                for (other, inside) in [
                    (me + 1, x + 1 < SIDE),
                    (me + SIDE, y + 1 < SIDE),
                    (me + SIDE * SIDE, z + 1 < SIDE),
                    (me + SIDE + 1, x + 1 < SIDE && y + 1 < SIDE),
                    (me + SIDE * SIDE + 1, x + 1 < SIDE && z + 1 < SIDE),
                    (me + SIDE * SIDE + SIDE, y + 1 < SIDE && z + 1 < SIDE),
                ] {
                    if inside {
                        pairs.push(format!("[{me}, {other}]"));
                    }
                }
            }
        }
    }
    let speed_m_s = 1.0;
    let (_, plan) = planned(&format!(
        "version = 1
run = {{ end_time = 1, time_step = \"{STEP_US} us\" }}
materials.stone = {{ density = 2000, young_modulus = 15e6, poisson_ratio = 0.3 }}
contacts.stone-stone = {{ restitution = 1, friction = 0.3 }}
walls.floor = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"stone\" }}
bonds.glue = {{ young_modulus = 0.2e6, poisson_ratio = 0.3, damping = {{ structural_damping = {gamma} }} }}
[bodies.block]
particles = [{}]
bond_list = [{}]
material = \"stone\"
bonds = \"glue\"
velocity = [0, 0, {}]
",
        spheres.join(", "),
        pairs.join(", "),
        -speed_m_s
    ));
    let mut state = plan.state;
    for _ in 0..STEPS {
        step(&mut state);
    }
    let p = &state.particles;
    let rise: f64 = p.motions.iter().map(|motion| motion.velocity_m_s[2]).sum();
    (rise / (p.len() as f64 * speed_m_s)).powi(2)
}

/// Below the limit of the undamped block, and of the block with any gamma here.
const STEP_US: f64 = 11.0;
const STEPS: usize = 4500;

/// The height of the rebound falls from about half of the fall to a tenth: what the contacts store
/// comes back undamped.
#[test]
fn a_rebound_falls_with_gamma() {
    let gammas = [0.0, 0.1, 0.3, 0.6, 0.9];
    let found = gammas.map(rebound);
    assert!((0.4..0.7).contains(&found[0]), "{found:?}");
    for (gamma, found) in gammas.into_iter().zip(found.windows(2)) {
        assert!(found[1] < found[0], "{gamma}: {found:?}");
    }
    assert!(found[4] < 0.13, "{found:?}");
}
