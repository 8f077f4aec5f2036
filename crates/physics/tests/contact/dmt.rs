//! Adhesion by Derjaguin, Muller and Toporov: closed forms of forces, energies and sticking.

use super::assert_near;
use super::world::{Body, RIGID, World, material};
use dem_physics::contact::ImpactLaw;
use dem_physics::contact::law::dmt::DerjaguinMullerToporov;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::pair_parameters::PairInput;
use dem_physics::contact::rolling::NoRolling;
use dem_physics::number::Vec3;
use std::f64::consts::PI;

const RADIUS_M: f64 = 1e-4;
const DENSITY_KG_M3: f64 = 2000.0;
/// w, J/m2.
const WORK: f64 = 0.05;

/// Pull-off force at a wall, N.
const PULL_OFF_N: f64 = 2.0 * PI * WORK * RADIUS_M;

fn law(restitution: f64, friction: f64) -> DerjaguinMullerToporov {
    DerjaguinMullerToporov {
        hertz_mindlin: HertzMindlin::new(
            [RIGID, material(1e9, 0.3)],
            &PairInput::new(restitution, friction),
        ),
        work_of_adhesion_j_m2: WORK,
    }
}

/// 4/3 E* sqrt(R), N/m^1.5.
fn hertz() -> f64 {
    4.0 / 3.0 * 1e9 / (1.0 - 0.09) * RADIUS_M.sqrt()
}

/// Overlap at which the attraction and Hertz's force are equal, m.
fn at_rest_m() -> f64 {
    (PULL_OFF_N / hertz()).powf(2.0 / 3.0)
}

/// A sphere whose surface overlaps the floor by this, m.
fn on_floor(
    law: DerjaguinMullerToporov,
    overlap_m: f64,
    dt: f64,
) -> World<DerjaguinMullerToporov, NoRolling> {
    let place = Vec3(0.0, 0.0, RADIUS_M - overlap_m);
    let sphere = Body::sphere(RADIUS_M, DENSITY_KG_M3, place);
    World::new(law, NoRolling, [Body::floor(), sphere], dt)
}

/// Time scale of the contact at rest, s.
fn period_s() -> f64 {
    let stiffness = 1.5 * hertz() * at_rest_m().sqrt();
    let mass = DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    2.0 * PI * (mass / stiffness).sqrt()
}

#[test]
fn the_pull_off_force_and_the_overlap_at_rest_are_those_of_the_closed_form() {
    let force = |overlap_m: f64| {
        on_floor(law(1.0, 0.0), overlap_m, 1e-12)
            .step()
            .force_on_b
            .2
    };
    assert_near(force(1e-9 * at_rest_m()), -PULL_OFF_N, 1e-12);
    assert!(force(at_rest_m()).abs() < 1e-9 * PULL_OFF_N);
    assert_near(force(4.0 * at_rest_m()), 7.0 * PULL_OFF_N, 1e-9);
    assert_eq!(force(-1e-9 * at_rest_m()), 0.0);
}

/// What is pulled together leaves with the speed of its arrival, if nothing damps: the error falls
/// with the square of the step.
#[test]
fn an_undamped_impact_loses_nothing() {
    let speed = 0.02;
    let off = |steps: f64| {
        let mut world = on_floor(law(1.0, 0.0), -1e-9, period_s() / steps);
        world.bodies[1].velocity = Vec3(0.0, 0.0, -speed);
        let mut deepest_m = 0.0_f64;
        world.step();
        loop {
            let now_m = world.touch().overlap_m;
            if now_m < 0.0 && world.bodies[1].velocity.2 > 0.0 {
                break;
            }
            deepest_m = deepest_m.max(now_m);
            world.step();
        }
        let law = law(1.0, 0.0);
        let mass = 1.0 / world.bodies[1].per_mass;
        let bound_m = law.overlap_at_impact_m(RADIUS_M, mass, speed);
        assert!(
            deepest_m > at_rest_m() && deepest_m <= bound_m,
            "{deepest_m} {bound_m}"
        );
        world.bodies[1].velocity.2 / speed - 1.0
    };
    assert!(off(4000.0).abs() < 2e-3, "{}", off(4000.0));
}

/// The attraction begins and ends within a step: wherever in it that is, the error of the energy
/// falls with the square of the step. It is that of a sphere that comes and leaves without a loss,
/// over the depth of the attraction.
#[test]
fn touching_and_parting_within_a_step_leave_no_error_of_first_order() {
    let speed = 0.02;
    let largest = |steps: f64| {
        let dt = period_s() / steps;
        let off = |phase: f64| {
            let gap_m = (1.0 + phase) * speed * dt;
            let mut world = on_floor(law(1.0, 0.0), -gap_m, dt);
            let mass = 1.0 / world.bodies[1].per_mass;
            world.bodies[1].velocity = Vec3(0.0, 0.0, -speed);
            let mut parted = 0;
            while parted < 3 {
                world.step();
                let is_away = world.touch().overlap_m < 0.0;
                parted += usize::from(is_away && world.bodies[1].velocity.2 > 0.0);
            }
            let gained_j = 0.5 * mass * (world.bodies[1].velocity.2.powi(2) - speed * speed);
            gained_j / (PULL_OFF_N * at_rest_m())
        };
        (0..20)
            .map(|n| off(f64::from(n) / 20.0).abs())
            .fold(0.0, f64::max)
    };
    let [coarse, fine] = [60.0, 240.0].map(largest);
    assert!(coarse < 5e-3, "{coarse}");
    assert!(fine < coarse / 12.0, "{coarse} {fine}");
}

/// A slow sphere with damping stays, at the overlap at rest; a fast one leaves.
#[test]
fn what_is_too_slow_sticks() {
    let end = |speed: f64| {
        let mut world = on_floor(law(0.5, 0.0), -1e-9, period_s() / 200.0);
        world.bodies[1].velocity = Vec3(0.0, 0.0, -speed);
        for _ in 0..20_000 {
            world.step();
        }
        world.touch().overlap_m
    };
    assert_near(end(0.005), at_rest_m(), 1e-6);
    assert!(end(1.0) < 0.0);
}

/// Friction is that of the force that presses: a sphere that adhesion alone holds resists being
/// pushed aside by mu times the pull-off force.
#[test]
fn friction_follows_the_force_that_presses() {
    let friction = 0.4;
    let mut world = on_floor(law(1.0, friction), at_rest_m(), period_s() / 200.0);
    world.step();
    world.bodies[1].velocity = Vec3(0.1, 0.0, 0.0);
    let mut largest_n = 0.0_f64;
    for _ in 0..50 {
        largest_n = largest_n.max(-world.step().force_on_b.0);
    }
    assert_near(largest_n, friction * PULL_OFF_N, 1e-3);
}
