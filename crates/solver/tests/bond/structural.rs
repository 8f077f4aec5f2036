//! Structural damping of bonds: what it takes, what it leaves alone, and the four viscous ratios.

use super::vector;
use crate::leave_out::planned;
use dem_run::check::limit::limit;
use dem_run::physics::bond::BondLoad;
use dem_run::physics::bond::damping::{
    DampingCoefficients, DampingModel, EndMotion, ReducedInertia,
};
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

/// The same dashpot for each mode.
fn dashpots(coefficient: f64) -> DampingCoefficients {
    DampingCoefficients {
        normal: coefficient,
        shear: coefficient,
        torsion: coefficient,
        bending: coefficient,
    }
}

/// So strong that only friction counts.
const FRICTION: f64 = 1e100;

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
        let found = structural_forces(gamma, &load, &dashpots(FRICTION), &levers, &c, length, &[a, b]);
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
        let back = structural_forces(gamma, &load, &dashpots(FRICTION), &[levers[1], levers[0]], &-c, length, &[b, a]);
        prop_assert!((found.force_on_b + back.force_on_b).norm() < ROUNDING);
        prop_assert!((found.torques[0] - back.torques[1]).norm() < ROUNDING);
    }

    /// A slow mode is resisted by its dashpot, a fast one by its friction: by the lesser of both.
    #[test]
    fn slow_modes_are_resisted_by_their_dashpots(speed in -2.0..2.0_f64, load in 0.0..2.0_f64, coefficient in 0.1..2.0_f64) {
        let load = BondLoad { normal_n: load, shear_n: load, torsion_n_m: load, bending_n_m: load };
        let (axis, rest) = (Vector3::x(), EndMotion { velocity_m_s: Vector3::zeros(), spin_rad_s: Vector3::zeros() });
        let resisted = (0.5 * load.normal_n).min(coefficient * f64::abs(speed)).copysign(speed);
        for direction in [Vector3::x(), Vector3::y()] {
            let moving = EndMotion { velocity_m_s: speed * direction, ..rest };
            let turning = EndMotion { spin_rad_s: speed * direction, ..rest };
            let found = [moving, turning].map(|b| structural_forces(
                0.5, &load, &dashpots(coefficient), &[1.0, 0.0], &axis, 1.0, &[rest, b],
            ));
            prop_assert!((found[0].force_on_b + resisted * direction).norm() < ROUNDING);
            prop_assert!((found[1].torques[1] + resisted * direction).norm() < ROUNDING);
        }
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
    let found = structural_forces(
        0.5,
        &load,
        &dashpots(FRICTION),
        &[1.0; 2],
        &Vector3::x(),
        2.0,
        &[rest; 2],
    );
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

/// The largest stable step is that without damping, however large gamma is.
#[test]
fn structural_damping_shortens_no_step() {
    let free = limit(&mut pair("damping_ratio = 0", "total", ""));
    for gamma in [0.1, 0.5, 0.9] {
        let damping = format!("structural_damping = {gamma}");
        assert_eq!(limit(&mut pair(&damping, "total", "")), free);
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

const SIDE: usize = 4;

/// Spheres of a slightly uneven grid, the lowest 0.05 mm to 0.15 mm above the height 0, and the
/// pairs that are bonded.
fn grid() -> [String; 2] {
    let number = |x: usize, y: usize, z: usize| x + SIDE * (y + SIDE * z);
    let (mut spheres, mut pairs) = (Vec::new(), Vec::new());
    for z in 0..SIDE {
        for y in 0..SIDE {
            for x in 0..SIDE {
                let at = [x, y, z].map(|n| 2e-3 * n as f64);
                // Uneven, so that an impact reaches all modes.
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
    [spheres.join(", "), pairs.join(", ")]
}

/// The block hangs on its highest spheres, let go at rest, with this gamma and 0.9 of its limit.
fn hanging(gamma: f64) -> State {
    let [spheres, pairs] = grid();
    let (_, plan) = planned(&format!(
        "version = 1
run = {{ end_time = 1, time_step = 1e-6, gravity = [0, 0, -9.81] }}
materials.stone.density = 2000
bonds.glue = {{ young_modulus = 0.2e6, poisson_ratio = 0.3, damping = {{ structural_damping = {gamma} }} }}
bodies.block = {{ particles = [{spheres}], bond_list = [{pairs}], material = \"stone\", bonds = \"glue\" }}
groups.top = {{ body = \"block\", particles = [48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63] }}
supports.top = {{ group = \"top\", fixed = true }}
"
    ));
    let mut state = plan.state;
    state.time_step_s = 0.9 * limit(&mut state).step_s;
    state
}

/// A body that hangs comes to rest, and its bonds then store what they do with any other gamma,
/// about half of what its weight has done: damping carries nothing of it.
#[test]
fn damping_carries_nothing_of_a_hanging_block() {
    let stored_j = [0.1, 0.5, 0.9].map(|gamma| {
        let mut state = hanging(gamma);
        for _ in 0..20_000 {
            step(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        let elastic_j = now.elastic_normal_j
            + now.elastic_shear_j
            + now.elastic_torsion_j
            + now.elastic_bending_j;
        assert!(now.kinetic_j < 1e-20 * elastic_j, "{gamma}: {now:?}");
        let ratio = -2.0 * elastic_j / now.gravity_j;
        assert!((ratio - 1.0).abs() < 1e-4, "{gamma}: {ratio}");
        elastic_j
    });
    for one_j in stored_j {
        let ratio = one_j / stored_j[0];
        assert!((ratio - 1.0).abs() < 1e-10, "{stored_j:?}");
    }
}

/// A grid of bonded spheres that falls on a floor: the rebound over the fall.
fn rebound(gamma: f64) -> f64 {
    let [spheres, pairs] = grid();
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
        spheres, pairs, -speed_m_s
    ));
    let mut state = plan.state;
    while state.time_s < 50e-3 {
        step(&mut state);
    }
    let p = &state.particles;
    let rise: f64 = p.motions.iter().map(|motion| motion.velocity_m_s[2]).sum();
    (rise / (p.len() as f64 * speed_m_s)).powi(2)
}

/// A quarter of the limit of the undamped block.
const STEP_US: f64 = 2.75;

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
