//! Spheres that roll, slide and come to rest on planes.

use super::world::{Body, RIGID, World, material};
use super::{assert_near, reference};
use dem_physics::contact::Response;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::pair_parameters::PairInput;
use dem_physics::contact::rolling::{ConstantMoment, ElasticPlastic, NoRolling, RollingFriction};
use dem_physics::number::Vec3;

const DT: f64 = 1e-5;
const DENSITY: f64 = 2500.0;

/// A sphere on a plane under `gravity` with the overlap due to its weight.
fn lying<R: RollingFriction<f64>>(
    rolling: R,
    radius: f64,
    mu: f64,
    gravity: (f64, f64),
) -> World<HertzMindlin, R> {
    let law = HertzMindlin::new([RIGID, material(1e8, 0.3)], &PairInput::new(0.3, mu));
    let mut ball = Body::sphere(radius, DENSITY, Vec3(0.0, 0.0, radius));
    let weight = gravity.1 / ball.per_mass;
    let overlap = (0.75 * weight / (law.young_modulus_pa * radius.sqrt())).powf(2.0 / 3.0);
    ball.place.2 -= overlap;
    let mut world = World::new(law, rolling, [Body::floor(), ball], DT);
    world.gravity = Vec3(gravity.0, 0.0, -gravity.1);
    world
}

fn run<R: RollingFriction<f64>>(world: &mut World<HertzMindlin, R>, seconds: f64) -> Response {
    for _ in 1..(seconds / DT).round() as u32 {
        world.step();
    }
    world.step()
}

/// The lever is the radius less half the overlap, l, so a sphere rolls at v0 m l^2 / (m l^2 + I):
/// 5/7 v0 for a hard one.
#[test]
fn a_sphere_that_slides_comes_to_roll() {
    let wanted = reference().slide_to_roll;
    let mut world = lying(NoRolling, wanted.radius, wanted.mu, (0.0, wanted.g));
    world.bodies[1].velocity = Vec3(wanted.v0, 0.0, 0.0);
    let start = world.kinetic();
    let lever = world.touch().levers_m[1];
    let off = 1.0 - lever / wanted.radius;
    run(&mut world, 0.15);
    let ball = world.bodies[1];
    let final_speed = wanted.v0 / (1.0 + 0.4 * (wanted.radius / lever).powi(2));
    assert_near(ball.velocity.0, final_speed, 1e-9);
    assert_near(ball.spin.1 * lever, final_speed, 1e-9);
    assert!(off < 2e-4);
    assert_near(ball.velocity.0, wanted.v_final, off);
    assert_near(ball.spin.1, wanted.omega_final, 2.0 * off);
    assert_near(
        1.0 - world.kinetic() / start,
        wanted.energy_lost_fraction,
        3.0 * off,
    );
    assert_near(world.lost[1] + world.lost[2], start - world.kinetic(), 1e-5);
    let place = wanted.x_roll + wanted.v_final * (0.15 - wanted.t_roll);
    assert_near(ball.place.0, place, 2.0 * off);
}

#[test]
fn spheres_and_blocks_on_inclines() {
    let wanted = reference().incline;
    for row in &wanted.rows {
        let (sine, cosine) = row.theta_deg.to_radians().sin_cos();
        let gravity = (wanted.g * sine, wanted.g * cosine);
        let mut world = lying(NoRolling, wanted.radius, row.mu, gravity);
        let off = 1.0 - world.touch().levers_m[1] / wanted.radius;
        let found = run(&mut world, 0.1);
        let before = world.bodies[1];
        run(&mut world, 0.1);
        let ball = world.bodies[1];
        let a = (ball.velocity.0 - before.velocity.0) / 0.1;
        let alpha = (ball.spin.1 - before.spin.1) / 0.1;
        let friction = -found.force_on_b.0 * ball.per_mass / wanted.g;
        if row.sphere_rolls {
            let lever = wanted.radius * (1.0 - off);
            let rolls = wanted.g * sine / (1.0 + 0.4 * (wanted.radius / lever).powi(2));
            assert_near(a, rolls, 1e-9);
        }
        assert_near(a, row.a_sphere, 2.0 * off);
        assert_near(alpha, row.alpha_sphere, 2.0 * off);
        assert_near(friction, row.friction_over_weight_sphere, 2.0 * off);
        let slip = ball.velocity.0 - ball.spin.1 * world.touch().levers_m[1];
        assert_eq!(slip.abs() < 1e-6, row.sphere_rolls, "{slip}");

        // A block cannot rotate.
        let mut world = lying(NoRolling, wanted.radius, row.mu, gravity);
        world.bodies[1].per_inertia = 0.0;
        run(&mut world, 0.1);
        let before = world.bodies[1];
        run(&mut world, 0.1);
        let a = (world.bodies[1].velocity.0 - before.velocity.0) / 0.1;
        assert!((a - row.a_block).abs() < 1e-9 * wanted.g);
        assert_eq!(world.bodies[1].velocity.0.abs() < 1e-9, row.block_sticks);
    }
}

/// Rolling against the constant moment decelerates by mu_r R N l / (m l^2 + I), stops and stays at
/// rest.
#[test]
fn a_constant_moment_stops_a_sphere_for_good() {
    let mut world = lying(ConstantMoment { friction: 0.05 }, 0.01, 0.5, (0.0, 9.81));
    let ball = &mut world.bodies[1];
    ball.velocity = Vec3(0.1, 0.0, 0.0);
    ball.spin = Vec3(0.0, 10.0, 0.0);
    let lever = world.touch().levers_m[1];
    let rate = 0.05 * 9.81 * 0.01 * lever / (lever * lever + 0.4e-4);
    run(&mut world, 0.1);
    let before = world.bodies[1].velocity.0;
    run(&mut world, 0.1);
    assert_near((before - world.bodies[1].velocity.0) / 0.1, rate, 1e-6);
    // It stops after 0.285 s. The energy of the tangential spring then causes an oscillation of at
    // most this initial size.
    let touch = world.touch();
    let k_t =
        8.0 * world.law.shear_modulus_pa * (touch.effective_radius_m * touch.overlap_m).sqrt();
    let recoil = rate * (touch.effective_mass_kg / k_t).sqrt() / lever;
    for step in 0..30_000 {
        world.step();
        let spin = world.bodies[1].spin.1;
        assert!(spin > -recoil, "{spin}");
        assert!(step < 15_000 || spin.abs() < 1e-9, "{spin}");
    }
    let ball = world.bodies[1];
    assert!(ball.velocity.0.abs() < 1e-11);
    let energy = 0.5 * 0.1 * 0.1 / ball.per_mass * 1.4;
    assert_near(world.all_lost(), energy, 1e-3);
}

/// The elastic-plastic spring holds a sphere on a slope up to mu_r, and yields above.
#[test]
fn an_elastic_plastic_spring_holds_a_sphere_on_a_slope() {
    let law = ElasticPlastic {
        friction: 0.1,
        damping_ratio: 0.3,
    };
    for (tangent, rolls) in [(0.0, false), (0.09, false), (0.11, true), (0.3, true)] {
        let (sine, cosine) = f64::atan(tangent).sin_cos();
        let mut world = lying(law, 0.01, 0.8, (9.81 * sine, 9.81 * cosine));
        let lever = world.touch().levers_m[1];
        let found = run(&mut world, 1.0);
        let before = world.bodies[1];
        run(&mut world, 0.1);
        let ball = world.bodies[1];
        let a = (ball.velocity.0 - before.velocity.0) / 0.1;
        let mass = 1.0 / ball.per_mass;
        if rolls {
            let pull = sine * lever - 0.1 * 0.01 * cosine;
            let wanted = 9.81 * pull * lever / (lever * lever + 0.4e-4);
            assert_near(a, wanted, 1e-6);
            assert_near(
                -found.moment_on_b.1,
                0.1 * 0.01 * 9.81 * cosine * mass,
                1e-6,
            );
        } else {
            assert!(ball.velocity.0.abs() < 1e-9);
            assert!(ball.spin.1.abs() < 1e-7);
            assert!(
                (-found.moment_on_b.1 - 9.81 * sine * lever * mass).abs()
                    < 1e-8 * 9.81 * mass * lever
            );
        }
    }
}
