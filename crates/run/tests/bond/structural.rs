//! Structural damping of bonds: what it takes, what it leaves alone, and the four viscous ratios.

use super::vector;
use crate::leave_out::planned;
use dem_engine::check::limit::limit;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact, step};
use dem_physics::bond::BondLoad;
use dem_physics::bond::damping::{DampingCoefficients, DampingModel, EndMotion, ReducedInertia};
use dem_physics::bond::damping_models::{ChenByMode, ModeRatios, SMOOTHING, StructuralDamping};
use dem_physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
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
    /// The power is minus gamma times each load times the speed v of its mode, times
    /// v/sqrt(v^2 + v_0^2); naming the other end first changes nothing; and the coefficients never
    /// exceed those that the number of stages is chosen for.
    #[test]
    fn each_mode_is_resisted_by_a_fraction_of_its_load(
        gamma in 0.0..1.0, load in load(), c in vector(1.0), levers in [0.1..1.0, 0.1..1.0], a in motion(), b in motion()
    ) {
        prop_assume!(c.norm() > 0.1);
        let c = c.normalize();
        let apart = (levers[0] + levers[1]) * c;
        let damping = damping(gamma, levers);
        let found = damping.coefficients(&load, &apart, &[a, b]);
        let arms = levers.map(|lever| lever * c);
        let slip = b.velocity_m_s - a.velocity_m_s
            - a.spin_rad_s.cross(&arms[0]) - b.spin_rad_s.cross(&arms[1]);
        let spin = b.spin_rad_s - a.spin_rad_s;
        let speeds = |v: Vector3<f64>| [v.dot(&c).abs(), v.cross(&c).norm()];
        let ([along, across], [about, bent]) = (speeds(slip), speeds(spin));
        let k = damping.stiffness;
        let largest = damping.largest_coefficients();
        for (coefficient, k, load, speed, most) in [
            (found.normal, k.normal, load.normal_n.abs(), along, largest.normal),
            (found.shear, k.shear, load.shear_n, across, largest.shear),
            (found.torsion, k.torsion, load.torsion_n_m.abs(), about, largest.torsion),
            (found.bending, k.bending, load.bending_n_m, bent, largest.bending),
        ] {
            let slow = SMOOTHING * damping.frequency_rad_s * load / k;
            let lost = gamma * load * speed * speed / (speed * speed + slow * slow).sqrt();
            prop_assert!((coefficient * speed * speed - lost).abs() <= 1e-9 * lost + 1e-300);
            prop_assert!(coefficient <= most * (1.0 + ROUNDING));
        }
        let turned = StructuralDamping {
            stiffness: Stiffness { levers_m: [levers[1], levers[0]], ..k },
            ..damping
        };
        let back = turned.coefficients(&load, &-apart, &[b, a]);
        let pairs = [
            (found.normal, back.normal), (found.shear, back.shear),
            (found.torsion, back.torsion), (found.bending, back.bending),
        ];
        prop_assert!(pairs.iter().all(|(one, other)| (one - other).abs() <= 1e-9 * one));
    }
}

/// A bond of stiffnesses 2, 3, 5, 7 between ends that vibrate with 11 rad/s on it.
fn damping(gamma: f64, levers_m: [f64; 2]) -> StructuralDamping {
    StructuralDamping {
        gamma,
        stiffness: Stiffness {
            normal: 2.0,
            shear: 3.0,
            torsion: 5.0,
            bending: 7.0,
            levers_m,
        },
        frequency_rad_s: 11.0,
    }
}

/// Without a load there is nothing to resist with, and without a frequency no smoothing.
#[test]
fn what_carries_nothing_is_not_damped() {
    let moving = EndMotion {
        velocity_m_s: Vector3::new(0.5, 0.25, -2.0),
        spin_rad_s: Vector3::new(3.0, 0.0, 1.0),
    };
    let resting = EndMotion {
        velocity_m_s: Vector3::zeros(),
        spin_rad_s: Vector3::zeros(),
    };
    let ends = [moving, resting];
    let damping = damping(0.5, [1.0; 2]);
    let found = damping.coefficients(&BondLoad::default(), &Vector3::x(), &ends);
    assert_eq!(found, DampingCoefficients::default());
    let held = StructuralDamping {
        frequency_rad_s: 0.0,
        ..damping
    };
    let load = BondLoad {
        normal_n: 1.0,
        ..BondLoad::default()
    };
    let found = held.coefficients(&load, &Vector3::x(), &[resting; 2]);
    assert_eq!(found, DampingCoefficients::default());
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

/// However strong it is, structural damping leaves the largest stable step alone.
#[test]
fn the_limit_is_that_without_damping() {
    let free = limit(&mut pair("damping_ratio = 0", "total", ""));
    for gamma in [0.1, 0.5, 0.99] {
        let damping = format!("structural_damping = {gamma}");
        let found = limit(&mut pair(&damping, "total", ""));
        assert_eq!(found.step_s, free.step_s);
    }
}

/// Stretches of a pair that starts with opposite speeds along the bond, after 3, 4, ... 10 radians.
fn stretches_m(damping: &str, step_rad: f64) -> Vec<f64> {
    let mut state = pair(damping, "total", "");
    for (motion, speed) in state.particles.motions.iter_mut().zip([1e-3, -1e-3]) {
        motion.velocity_m_s[0] = speed;
    }
    let omega = limit(&mut pair(damping, "total", "")).omega_rad_s;
    state.time_step_s = step_rad / omega;
    let mut found = Vec::new();
    for at in 1..=(10.0 / step_rad).round() as usize {
        step(&mut state);
        if at >= (3.0 / step_rad) as usize && at.is_multiple_of((1.0 / step_rad).round() as usize) {
            let [a, b] = [0, 1].map(|i| state.particles.poses[i].position_m[0]);
            found.push(b - a - 3e-3);
        }
    }
    found
}

/// The displacement is of second order in the step, past three reversals, alone and beside viscous
/// damping.
#[test]
fn displacements_are_of_second_order() {
    for damping in [
        "structural_damping = 0.3",
        "structural_damping = 0.8",
        "structural_damping = 0.3, damping_ratio = 0.1",
    ] {
        let [coarse, middle, fine] =
            [2e-3, 1e-3, 5e-4].map(|step_rad| stretches_m(damping, step_rad));
        let change = |one: &[f64], other: &[f64]| {
            let squares = one
                .iter()
                .zip(other)
                .map(|(one, other)| (one - other).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let order = (change(&coarse, &middle) / change(&middle, &fine)).log2();
        assert!((order - 2.0).abs() < 0.1, "{damping}: {order}");
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
const GRAVITY_M_S2: f64 = 9.81;

/// A grid of bonded spheres with this structural damping, in a scene with these further lines.
fn block(gamma: f64, run: &str, more: &str) -> State {
    block_with(
        &format!("damping = {{ structural_damping = {gamma} }}"),
        "",
        run,
        more,
    )
}

/// The same with these keys of its bonds and of itself.
fn block_with(bonds: &str, body: &str, run: &str, more: &str) -> State {
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
    let (_, plan) = planned(&format!(
        "version = 1
run = {{ end_time = 1, {run} }}
bonds.glue = {{ young_modulus = 0.2e6, poisson_ratio = 0.3, {bonds} }}
bodies.block = {{ particles = [{}], bond_list = [{}], material = \"stone\", bonds = \"glue\"{body} }}
{more}
",
        spheres.join(", "),
        pairs.join(", "),
    ));
    plan.state
}

const FLOOR: &str =
    "materials.stone = { density = 2000, young_modulus = 15e6, poisson_ratio = 0.3 }
contacts.stone-stone = { restitution = 1, friction = 0.3 }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"stone\" }
initial.block = { group = \"block\", velocity = [0, 0, -1] }
";

/// The block falls on a floor that hardly stores energy, with this step: the rebound over the fall.
fn rebound(gamma: f64, step_us: f64) -> f64 {
    let run = format!("time_step = \"{step_us} us\"");
    let mut state = block(gamma, &run, FLOOR);
    while state.time_s < 0.05 {
        step(&mut state);
    }
    let p = &state.particles;
    let rise: f64 = p.motions.iter().map(|motion| motion.velocity_m_s[2]).sum();
    (rise / p.len() as f64).powi(2)
}

/// Just below the limit of the block, on the floor as well.
const STEP_US: f64 = 11.0;

/// The height of the rebound falls from about half of the fall to a tenth: what the contacts store
/// comes back undamped. It does so at the step that the undamped block has, as at small steps.
#[test]
fn a_rebound_falls_with_gamma_at_the_undamped_step() {
    let gammas = [0.0, 0.1, 0.3, 0.6, 0.9];
    let found = gammas.map(|gamma| rebound(gamma, STEP_US));
    assert!((0.4..0.7).contains(&found[0]), "{found:?}");
    for (gamma, found) in gammas.into_iter().zip(found.windows(2)) {
        assert!(found[1] < found[0], "{gamma}: {found:?}");
    }
    assert!(found[4] < 0.13, "{found:?}");
    for (gamma, found) in gammas.into_iter().zip(found) {
        let converged = rebound(gamma, STEP_US / 8.0);
        assert!(
            (found - converged).abs() < 0.02,
            "{gamma}: {found} {converged}"
        );
    }
}

/// Under its weight the block hangs still, without trembling, and its uppermost layer carries all
/// of it: the damping carries nothing.
#[test]
fn a_hanging_block_comes_to_rest_and_its_bonds_carry_its_weight() {
    let run = format!("gravity = [0, 0, {}]", -GRAVITY_M_S2);
    let top = 2e-3 * (SIDE - 1) as f64;
    let mut state = block(
        0.5,
        &run,
        &format!(
            "materials.stone = {{ density = 2000 }}
groups.top.box = {{ min = [-1, -1, {}], max = [1, 1, 1] }}
supports.top = {{ group = \"top\", fixed = true }}",
            top + 0.5e-3
        ),
    );
    let fastest = |state: &State| {
        let speeds = state.particles.motions.iter().flat_map(|m| m.velocity_m_s);
        speeds.map(f64::abs).fold(0.0, f64::max)
    };
    let mut largest_m_s: f64 = 0.0;
    while state.time_s < 1.0 {
        step(&mut state);
        largest_m_s = largest_m_s.max(fastest(&state));
    }
    assert!(fastest(&state) < 1e-9 * largest_m_s, "{}", fastest(&state));
    interact(&mut state);
    let resisting = state.bond_resistance.iter().flat_map(|w| w.force_n);
    let resisting_n = resisting.map(f64::abs).fold(0.0, f64::max);
    let hanging = (SIDE * SIDE * (SIDE - 1)) as f64 / state.particles.motions[0].inverse_mass;
    assert!(resisting_n < 1e-9 * hanging * GRAVITY_M_S2, "{resisting_n}");
}

/// Beside bonds that soften, break, yield or sum their forces, in a body that is bonded in part,
/// and beside viscous damping, in an impact: what all of them take is booked, each in its column,
/// and a run goes on from a checkpoint with the same bits.
#[test]
fn what_it_takes_beside_other_models_is_booked_and_resumed() {
    let damping = "damping = { structural_damping = 0.4 }";
    let zone = "regions.zone.box = { min = [-1, -1, -1], max = [1, 1, 4.2e-3] }\n";
    let in_part = ", bonded_within = { region = \"zone\" }";
    for (name, bonds, body, more) in [
        ("alone", "", "", ""),
        ("viscous", ", damping_ratio = 0.2", "", ""),
        ("failure", "failure = { tensile_strength = 3e3 }", "", ""),
        (
            "softening",
            "failure = { tensile_strength = 3e3, fracture_energy = 0.1 }",
            "",
            "",
        ),
        (
            "yield",
            "plasticity = { normal_yield_strength = 3e3 }",
            "",
            "",
        ),
        ("history", "formulation = \"incremental\"", "", ""),
        ("in part", "", in_part, zone),
    ] {
        let bonds = match bonds.strip_prefix(", damping") {
            Some(viscous) => damping.replace(" }", &format!(", damping{viscous} }}")),
            None if bonds.is_empty() => damping.to_owned(),
            None => format!("{damping}, {bonds}"),
        };
        let more = format!("{FLOOR}{more}");
        let mut state = block_with(&bonds, body, "time_step = \"2 us\"", &more);
        let mut largest = [0.0_f64; 2];
        let mut resumed: Option<State> = None;
        while state.time_s < 6e-3 {
            if resumed.is_none() && state.time_s > 3e-3 {
                let saved = postcard::to_stdvec(&state).unwrap();
                let copy: State = postcard::from_bytes(&saved).unwrap();
                resumed = copy.rebuilt(state.model.clone(), &state.scratch);
                assert!(resumed.is_some(), "{name}");
            }
            interact(&mut state);
            let now = balance(&mut state);
            largest[0] = largest[0].max(now.energy_error.abs());
            largest[1] = largest[1].max(now.momentum_error);
            advance(&mut state);
            if let Some(resumed) = &mut resumed {
                interact(resumed);
                balance(resumed);
                advance(resumed);
            }
        }
        let resumed = resumed.unwrap();
        assert_eq!(state.particles.motions, resumed.particles.motions, "{name}");
        assert_eq!(state.ledger, resumed.ledger, "{name}");
        interact(&mut state);
        let now = balance(&mut state);
        assert!(now.structural_damping_j > 0.0, "{name}");
        assert_eq!(now.bond_damping_j > 0.0, name == "viscous", "{name}");
        assert_eq!(now.bond_damage_j > 0.0, name == "softening", "{name}");
        assert_eq!(now.bond_plastic_j > 0.0, name == "yield", "{name}");
        let breaks = name == "failure" || name == "softening";
        assert_eq!(state.broken_count > 0, breaks, "{name}");
        assert!(
            largest[0] < 5e-3 && largest[1] < 1e-10,
            "{name}: {largest:?}"
        );
    }
}

/// Of a pair with both dampings each takes what the same law takes by Runge and Kutta's method:
/// x'' = -x - 2 zeta x' - gamma |x| x'/sqrt(x'^2 + (epsilon x)^2).
#[test]
fn viscous_and_structural_damping_share_what_they_take() {
    let (zeta, gamma) = (0.15, 0.3);
    let rate = |[x, v, ..]: [f64; 4]| {
        let reversing = v.hypot(SMOOTHING * x);
        let structural = if reversing > 0.0 {
            gamma * x.abs() * v / reversing
        } else {
            0.0
        };
        let viscous = 2.0 * zeta * v;
        [v, -x - viscous - structural, viscous * v, structural * v]
    };
    let mut known = [0.0, 1.0, 0.0, 0.0];
    let part = 1e-4;
    for _ in 0..100_000 {
        let along = |rate: [f64; 4], part: f64| std::array::from_fn(|k| known[k] + part * rate[k]);
        let first = rate(known);
        let second = rate(along(first, 0.5 * part));
        let third = rate(along(second, 0.5 * part));
        let last = rate(along(third, part));
        known = std::array::from_fn(|k| {
            known[k] + part / 6.0 * (first[k] + 2.0 * second[k] + 2.0 * third[k] + last[k])
        });
    }
    let wanted = [known[2], known[3]].map(|taken| taken / 0.5);
    // 2 eta sqrt(k_n m_red): the damping ratio of stretching.
    let damping = format!("damping_ratio = {zeta}, structural_damping = {gamma}");
    let errors = [2e-3, 1e-3].map(|step_rad| {
        let mut state = pair(&damping, "total", "");
        for (motion, speed) in state.particles.motions.iter_mut().zip([1e-3, -1e-3]) {
            motion.velocity_m_s[0] = speed;
        }
        let omega = (state.bonds.normal(0) * 2.0 * state.particles.motions[0].inverse_mass).sqrt();
        state.time_step_s = step_rad / omega;
        let start_j = 1e-6 / state.particles.motions[0].inverse_mass;
        for _ in 0..(10.0 / step_rad).round() as usize {
            step(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        let found = [now.bond_damping_j, now.structural_damping_j];
        [0, 1].map(|k| (found[k] / start_j / wanted[k] - 1.0).abs())
    });
    assert!(
        errors[1].iter().all(|error| *error < 1e-4),
        "{errors:?} {wanted:?}"
    );
}
