//! The formulas of doc/inside/contacts.md, computed here from the page, compared with the program.

use dem_physics::contact::kinematics::{
    ContactKinematics, ContactSphere, WallPoint, contact_kinematics, torques,
    wall_contact_kinematics,
};
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::pair_parameters::{Elastic, PairInput};
use dem_physics::contact::rolling::{ConstantMoment, ElasticPlastic, NoRolling, RollingFriction};
use dem_physics::contact::{ContactSprings, NormalLaw, response};
use dem_physics::number::Vec3;
use nalgebra::Vector3;

use super::assert_near;
use super::world::relative_velocity;

const PAGE: &str = include_str!("../../../../doc/inside/contacts.md");
const OVERLAP_M: f64 = 2e-5;
const YOUNG_PA: [f64; 2] = [50e6, 80e6];
const POISSON: [f64; 2] = [0.25, 0.4];
const RESTITUTION: f64 = 0.6;

/// The page's e(zeta), solved for zeta.
fn zeta(restitution: f64) -> f64 {
    let of = |zeta: f64| {
        let (square, angle) = if zeta < 1.0 {
            (1.0 - zeta * zeta, zeta.acos())
        } else {
            (zeta * zeta - 1.0, zeta.acosh())
        };
        (-2.0 * zeta * angle / square.sqrt()).exp()
    };
    let (mut low, mut high) = (0.0, std::f64::consts::PI);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if of(middle) > restitution {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn ball(radius_m: f64, velocity: [f64; 3], spin: [f64; 3]) -> ContactSphere {
    let mass_kg = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3);
    let [x, y, z] = velocity;
    let [wx, wy, wz] = spin;
    ContactSphere {
        velocity_m_s: Vec3(x, y, z),
        spin_rad_s: Vec3(wx, wy, wz),
        radius_m,
        inverse_mass_per_kg: 1.0 / mass_kg,
        inverse_inertia_per_kg_m2: 2.5 / (mass_kg * radius_m * radius_m),
    }
}

fn balls() -> [ContactSphere; 2] {
    [
        ball(1e-3, [0.1, -0.05, 0.02], [3.0, -20.0, 7.0]),
        ball(2e-3, [-0.04, 0.03, 0.06], [-5.0, 11.0, 2.0]),
    ]
}

fn vector(of: Vec3<f64>) -> Vector3<f64> {
    of.into()
}

/// The two spheres, and the second of them on a wall; with R*, m* and the unit normal.
fn touches() -> [(ContactKinematics, f64, f64); 2] {
    let [a, b] = balls();
    let apart = Vector3::new(1.0, 2.0, -2.0) / 3.0 * (a.radius_m + b.radius_m - OVERLAP_M);
    let pair = contact_kinematics(apart.into(), [a, b], 0.0);
    let normal = Vec3(0.0, 0.6, 0.8);
    let foot = WallPoint {
        normal,
        normal_before: normal,
        distance_m: b.radius_m - OVERLAP_M,
        velocity_m_s: Vec3(0.0, 0.0, 0.0),
        spin_rad_s: Vec3(0.0, 0.0, 0.0),
    };
    let radius_m = a.radius_m * b.radius_m / (a.radius_m + b.radius_m);
    let mass_kg = 1.0 / (a.inverse_mass_per_kg + b.inverse_mass_per_kg);
    [
        (pair, radius_m, mass_kg),
        (
            wall_contact_kinematics(&foot, b, 0.0),
            b.radius_m,
            1.0 / b.inverse_mass_per_kg,
        ),
    ]
}

/// Velocity of b relative to a at the surfaces, along the normal and perpendicular to it, by the
/// page.
fn sliding(touch: &ContactKinematics) -> [Vector3<f64>; 2] {
    let [a, b] = balls();
    let n = vector(touch.normal);
    let is_wall = touch.levers_m[0] == 0.0;
    let of_a = if is_wall { 0.0 } else { 1.0 };
    let [lever_a, lever_b] = [a, b].map(|ball| ball.radius_m - 0.5 * OVERLAP_M);
    let turning = of_a * lever_a * vector(a.spin_rad_s) + lever_b * vector(b.spin_rad_s);
    let whole = vector(b.velocity_m_s) - of_a * vector(a.velocity_m_s) - turning.cross(&n);
    let along = n * whole.dot(&n);
    [along, whole - along]
}

/// Without a spring force yet, only the dashpot acts perpendicular to the normal.
fn check_dashpots(
    law: &impl NormalLaw<f64>,
    touch: &ContactKinematics,
    [c_n, c_t, elastic_n]: [f64; 3],
) {
    let found = response(law, &NoRolling, touch, &ContactSprings::default(), 0.0);
    let force = vector(found.force_on_b);
    let n = vector(touch.normal);
    let [along, across] = sliding(touch);
    let normal_n = elastic_n - c_n * along.dot(&n);
    assert_near(force.dot(&n), normal_n, 1e-9);
    let off = (force - n * force.dot(&n) + c_t * across).norm();
    assert!(off < 1e-9 * c_t * across.norm(), "{off:e}");
    // Friction rotates each end by its lever.
    let [on_a, on_b] = torques(touch, found.force_on_b, Vec3(0.0, 0.0, 0.0)).map(vector);
    let arm = (-c_t * across).cross(&n);
    let lever_b = balls()[1].radius_m - 0.5 * OVERLAP_M;
    assert!((on_b - lever_b * arm).norm() < 1e-9 * on_b.norm());
    if touch.levers_m[0] != 0.0 {
        let lever_a = balls()[0].radius_m - 0.5 * OVERLAP_M;
        assert!((on_a - lever_a * arm).norm() < 1e-9 * on_a.norm());
    }
}

#[test]
fn dashpots_and_levers_are_those_of_the_page() {
    // Friction so high that it never limits them.
    let pair_input = PairInput::new(RESTITUTION, 1e3);
    let materials = [0, 1].map(|k| Elastic {
        young_modulus_pa: YOUNG_PA[k],
        poisson_ratio: POISSON[k],
    });
    let zeta = zeta(RESTITUTION);
    let hertz = HertzMindlin::new(materials, &pair_input);
    let linear = Linear::new(2e4, 0.4, &pair_input);
    let [soft, shear] = [0, 1].map(|of_shear| {
        let one = |k: usize| {
            let (e, nu) = (YOUNG_PA[k], POISSON[k]);
            let g = e / (2.0 * (1.0 + nu));
            if of_shear == 1 {
                (2.0 - nu) / g
            } else {
                (1.0 - nu * nu) / e
            }
        };
        1.0 / (one(0) + one(1))
    });
    for (touch, radius_m, mass_kg) in touches() {
        let n_m = 2.0 * soft * (radius_m * OVERLAP_M).sqrt();
        let t_m = 8.0 * shear * (radius_m * OVERLAP_M).sqrt();
        let c = |k: f64| 2.0 * (5.0_f64 / 6.0).sqrt() * zeta * (k * mass_kg).sqrt();
        let elastic_n = 4.0 / 3.0 * soft * radius_m.sqrt() * OVERLAP_M.powf(1.5);
        check_dashpots(&hertz, &touch, [c(n_m), c(t_m), elastic_n]);
        let c = |k: f64| 2.0 * zeta * (k * mass_kg).sqrt();
        check_dashpots(&linear, &touch, [c(2e4), c(0.4 * 2e4), 2e4 * OVERLAP_M]);
        let [along, across] = sliding(&touch);
        let [a, b] = balls();
        let still = Vec3(0.0, 0.0, 0.0);
        let [va, wa] = if touch.levers_m[0] == 0.0 {
            [still; 2]
        } else {
            [a.velocity_m_s, a.spin_rad_s]
        };
        let found = relative_velocity(&touch, [va, b.velocity_m_s], [wa, b.spin_rad_s]);
        assert!((vector(found) - along - across).norm() < 1e-12);
    }
}

/// When sliding, spring and dashpot together are mu N; with restitution 1 there is no dashpot.
#[test]
fn friction_bounds_the_dashpot() {
    for (touch, ..) in touches() {
        let law = Linear::new(2e4, 0.4, &PairInput::new(0.1, 1e-4));
        let found = response(&law, &NoRolling, &touch, &ContactSprings::default(), 0.0);
        let n = vector(touch.normal);
        let force = vector(found.force_on_b);
        let across = force - n * force.dot(&n);
        assert_near(across.norm(), 1e-4 * force.dot(&n), 1e-9);
        let law = Linear::new(2e4, 0.4, &PairInput::new(1.0, 1e3));
        let found = response(&law, &NoRolling, &touch, &ContactSprings::default(), 0.0);
        let force = vector(found.force_on_b);
        assert!((force - n * force.dot(&n)).norm() < 1e-12 * force.norm());
    }
}

/// Moment on b of a contact that has rolled by this amount perpendicular to the normal, N m.
fn moment(
    rolling: &impl RollingFriction<f64>,
    touch: &ContactKinematics,
    rolled_rad: f64,
) -> Vector3<f64> {
    let law = Linear::new(2e4, 0.4, &PairInput::new(1.0, 0.5));
    let across = vector(touch.normal).cross(&Vector3::new(1.0, 0.0, 0.5));
    let history = ContactSprings {
        rolling_rad: (across.normalize() * rolled_rad).into(),
        overlap_m: OVERLAP_M,
        ..ContactSprings::default()
    };
    vector(response(&law, rolling, touch, &history, 0.0).moment_on_b)
}

/// Rolling friction is a moment of at most mu_r R* N, perpendicular to the normal, independent of
/// the lever.
#[test]
fn rolling_friction_is_bounded_by_the_reduced_radius() {
    for (touch, radius_m, _) in touches() {
        let constant = ConstantMoment { friction: 0.05 };
        let spring = ElasticPlastic {
            friction: 0.05,
            damping_ratio: 0.0,
        };
        // A spring rolled so far that it slips.
        for moment in [
            moment(&constant, &touch, 0.0),
            moment(&spring, &touch, 100.0),
        ] {
            assert!(moment.dot(&vector(touch.normal)).abs() < 1e-9 * moment.norm());
            assert_near(moment.norm(), 0.05 * radius_m * 2e4 * OVERLAP_M, 1e-9);
        }
    }
}

/// The table of damping ratios on the page.
#[test]
fn the_page_has_the_right_damping_ratios() {
    let row = |name: &str| -> Vec<f64> {
        let row = PAGE
            .lines()
            .find(|line| line.starts_with(&format!("| {name} |")));
        let cells = row.unwrap().split('|').skip(2);
        cells.filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    let (restitutions, ratios) = (row("e"), row("zeta"));
    assert_eq!((restitutions.len(), ratios.len()), (5, 5));
    for (restitution, ratio) in restitutions.into_iter().zip(ratios) {
        assert!(
            (zeta(restitution) - ratio).abs() < 6e-5,
            "{restitution}: {ratio}"
        );
    }
}
