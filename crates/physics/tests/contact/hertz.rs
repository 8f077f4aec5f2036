//! Elastic impacts and weights.

use super::world::{Body, RIGID, World, Z, frictionless, material};
use super::{assert_near, reference};
use dem_physics::contact::ImpactLaw;
use dem_physics::contact::kinematics::{WallPoint, wall_contact_kinematics};
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::rolling::{ElasticPlastic, NoRolling};
use dem_physics::contact::{ContactSprings, NormalLaw, linearised, response};
use dem_physics::number::Vec3;
use std::f64::consts::PI;

/// Results of a central impact.
pub(crate) struct Central {
    /// Time until the force was 0.
    pub(crate) duration: f64,
    pub(crate) overlap: f64,
    pub(crate) force: f64,
}

/// A central impact; values between steps by linear interpolation.
pub(crate) fn central_impact<L: NormalLaw<f64>>(
    world: &mut World<L, NoRolling>,
    speed: f64,
) -> Central {
    world.bodies[1].velocity = Vec3(0.0, 0.0, -speed);
    let (mut overlap, mut force) = (0.0_f64, 0.0_f64);
    world.step();
    for step in 1.. {
        let before = world.history.overlap_m;
        let now = world.touch().overlap_m;
        let found = world.step();
        overlap = overlap.max(now);
        force = force.max(found.force_on_b.2);
        if found.force_on_b.2 == 0.0 {
            let part = if now <= 0.0 {
                before / (before - now)
            } else {
                1.0
            };
            return Central {
                duration: world.dt * (f64::from(step - 1) + part),
                overlap,
                force,
            };
        }
    }
    unreachable!()
}

#[test]
fn elastic_impacts_are_those_of_hertz() {
    for row in reference().hertz_elastic {
        let steel = material(row.young, row.nu);
        let law = HertzMindlin::new(
            [if row.two_spheres { steel } else { RIGID }, steel],
            &frictionless(),
        );
        assert_near(law.young_modulus_pa, row.e_star, 1e-14);
        assert_near(law.shear_modulus_pa, row.g_star, 1e-14);
        let b = Body::sphere(row.radius, row.rho, Vec3(0.0, 0.0, row.radius));
        let a = if row.two_spheres {
            Body::sphere(row.radius, row.rho, Vec3(0.0, 0.0, -row.radius))
        } else {
            Body::floor()
        };
        let mut world = World::new(law, NoRolling, [a, b], row.t_contact / 2000.0);
        let touch = world.touch();
        let limit =
            law.overlap_at_impact_m(touch.effective_radius_m, touch.effective_mass_kg, row.v_rel);
        assert_near(limit, row.delta_max, 1e-13);
        let found = central_impact(&mut world, row.v_rel);
        assert_near(found.duration, row.t_contact, row.tolerance_rel);
        assert_near(found.overlap, row.delta_max, row.tolerance_rel);
        assert_near(found.force, row.f_max, row.tolerance_rel);
        let speed = (world.bodies[1].velocity - world.bodies[0].velocity).2;
        assert_near(speed, row.v_rel, 1e-5);
    }
}

#[test]
fn a_linear_impact_lasts_half_a_swing() {
    let b = Body::sphere(0.01, 2500.0, Vec3(0.0, 0.0, 0.01));
    let law = Linear::new(1e6, 0.8, &frictionless());
    let half_swing = PI / (1e6 * b.per_mass).sqrt();
    let mut world = World::new(law, NoRolling, [Body::floor(), b], half_swing / 2000.0);
    let Central {
        duration,
        overlap,
        force,
    } = central_impact(&mut world, 2.0);
    assert_near(duration, half_swing, 1e-5);
    assert_near(overlap, 2.0 / (1e6 * b.per_mass).sqrt(), 1e-5);
    assert_near(force, 1e6 * overlap, 1e-14);
}

#[test]
fn a_sphere_sinks_in_by_its_weight() {
    let row = reference().static_weight_overlap;
    let cake = material(row.young, row.nu);
    let foot = WallPoint {
        normal: Z,
        normal_before: Z,
        distance_m: row.radius - row.overlap,
        velocity_m_s: Vec3(0.0, 0.0, 0.0),
        spin_rad_s: Vec3(0.0, 0.0, 0.0),
    };
    let ball = Body::sphere(row.radius, row.rho, Z);
    let touch = wall_contact_kinematics(&foot, ball.ball(), 0.0);
    let law = HertzMindlin::new([RIGID, cake], &frictionless());
    let found = response(&law, &NoRolling, &touch, &ContactSprings::default(), 0.0);
    assert_near(found.force_on_b.2, 9.81 / ball.per_mass, 1e-11);
}

/// The stiffnesses used for the limit of the time step are derivatives of the forces.
#[test]
fn stiffnesses_are_derivatives() {
    let cake = material(26e6, 0.3);
    let law = HertzMindlin::new([cake, cake], &frictionless());
    let rolling = ElasticPlastic {
        friction: 0.2,
        damping_ratio: 0.3,
    };
    let [a, b] = [-0.49e-3, 0.49e-3].map(|z| Body::sphere(0.5e-3, 2050.0, Vec3(0.0, 0.0, z)));
    let world = World::new(law, rolling, [a, b], 1e-6);
    let touch = world.touch();
    let found = linearised(&law, &rolling, &touch);
    let force = |change: f64| {
        let touch = dem_physics::contact::kinematics::ContactKinematics {
            overlap_m: touch.overlap_m + change,
            ..touch
        };
        response(&law, &rolling, &touch, &ContactSprings::default(), 0.0)
            .force_on_b
            .2
    };
    let small = 1e-5 * touch.overlap_m;
    assert_near(
        found.normal_n_m,
        (force(small) - force(-small)) / (2.0 * small),
        1e-9,
    );
    let g = 26e6 / 2.6;
    let k_t = 8.0 * g / (2.0 * 1.7) * (touch.effective_radius_m * touch.overlap_m).sqrt();
    assert_near(found.tangential_n_m, k_t, 1e-14);
    let arm = 0.2 * touch.effective_radius_m;
    assert_near(
        found.rolling_n_m_rad,
        2.25 * found.normal_n_m * arm * arm,
        1e-14,
    );
    let inertia = 0.5 * 1.4 / a.per_mass * a.radius * a.radius;
    assert_near(
        found.rolling_damping_n_m_s,
        0.6 * (found.rolling_n_m_rad * inertia).sqrt(),
        1e-14,
    );
}
