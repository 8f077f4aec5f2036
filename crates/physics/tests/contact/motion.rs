//! Pairs that move as one body, and walls.

use super::keeping::{DT, SPRING, hertz, linear, triple, vectors};
use super::world::{Body, Z, ZERO};
use dem_physics::contact::kinematics::{
    ContactSphere, WallPoint, contact_kinematics, wall_contact_kinematics,
};
use dem_physics::contact::{ContactSprings, NormalLaw, response};
use dem_physics::number::Vec3;
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::TAU;

/// A pair that is rotated as one body in this many steps per revolution: the deviation of its force
/// from the pair, over the force.
fn whole_turn(law: &impl NormalLaw<f64>, axis: Vector3<f64>, steps: u32) -> f64 {
    let (radius, overlap) = (0.01, 1e-4);
    let axis = axis.normalize();
    let dt = 1.0 / f64::from(steps);
    let spin = triple(axis * TAU);
    let body = Body::sphere(radius, 2500.0, ZERO).ball();
    let apart = Vector3::new(0.0, 0.0, 2.0 * radius - overlap);
    let spring = Vector3::new(1e-5, 0.5e-5, 0.0);
    let mut history = ContactSprings {
        tangential_m: triple(spring),
        rolling_rad: Vec3(2e-4, -1e-4, 0.0),
        overlap_m: overlap,
    };
    let (mut before, mut first, mut worst) = (apart, None, 0.0_f64);
    for step in 0..=steps {
        let by = Rotation3::new(axis * (TAU * f64::from(step) * dt));
        let now = by * apart;
        let moved = if step == 0 {
            Vector3::zeros()
        } else {
            now - before
        };
        let dt = if step == 0 { 0.0 } else { dt };
        let velocity = if step == 0 { ZERO } else { triple(moved / dt) };
        let balls = [ZERO, velocity].map(|velocity_m_s| ContactSphere {
            velocity_m_s,
            spin_rad_s: if step == 0 { ZERO } else { spin },
            ..body
        });
        let met = contact_kinematics(triple(now), balls, dt);
        let found = response(law, &SPRING, &met, &history, dt);
        history = found.springs;
        let [force, moment] = [found.force_on_b, found.moment_on_b]
            .map(|v| by.inverse() * Vector3::new(v.0, v.1, v.2));
        let (first_force, first_moment) = *first.get_or_insert((force, moment));
        worst = worst
            .max((force - first_force).norm() / first_force.norm())
            .max((moment - first_moment).norm() / first_moment.norm());
        before = now;
    }
    worst
}

/// Rotation of the whole pair changes no force. The remaining error is that of leapfrog, for which
/// a rotation by an angle moves the ends by the chord: at most angle^2 / 24 of their distance for
/// each radian, for a spring elongation of 1.1e-5 m.
#[test]
fn turning_of_the_whole_changes_no_force() {
    for axis in [Vector3::z(), Vector3::x(), Vector3::new(1.0, -2.0, 1.5)] {
        for steps in [1000, 10000] {
            let angle = TAU / f64::from(steps);
            let bound = TAU * 0.02 * angle * angle / 24.0 / 1.1e-5;
            for found in [
                whole_turn(&hertz(), axis, steps),
                whole_turn(&linear(), axis, steps),
            ] {
                assert!(found < bound, "{axis:?} {steps}: {found:e} above {bound:e}");
            }
        }
    }
}

/// A wall is the limit of a large fixed sphere, and a ball that moves along with a wall has the
/// same contact as on a wall at rest.
#[test]
fn a_wall_is_an_end_of_endless_mass_and_radius() {
    let ball = ContactSphere {
        velocity_m_s: Vec3(0.3, -0.1, -0.2),
        spin_rad_s: Vec3(4.0, 5.0, 6.0),
        ..Body::sphere(0.01, 2500.0, ZERO).ball()
    };
    let foot = WallPoint {
        normal: Z,
        normal_before: Z,
        distance_m: 0.00999,
        velocity_m_s: ZERO,
        spin_rad_s: ZERO,
    };
    let history = ContactSprings {
        tangential_m: Vec3(1e-6, 2e-6, 0.0),
        rolling_rad: Vec3(1e-5, -1e-5, 0.0),
        overlap_m: 0.9e-5,
    };
    let at_wall = response(
        &hertz(),
        &SPRING,
        &wall_contact_kinematics(&foot, ball, DT),
        &history,
        DT,
    );
    // Compared with a fixed sphere of this radius, whose surface is a plane to rounding.
    let radius = 1e6;
    let huge = ContactSphere {
        velocity_m_s: ZERO,
        spin_rad_s: ZERO,
        radius_m: radius,
        inverse_mass_per_kg: 0.0,
        inverse_inertia_per_kg_m2: 0.0,
    };
    let met = contact_kinematics(Vec3(0.0, 0.0, radius + 0.00999), [huge, ball], DT);
    let at_sphere = response(&hertz(), &SPRING, &met, &history, DT);
    for (wall, sphere) in vectors(&at_wall).into_iter().zip(vectors(&at_sphere)) {
        let off = (wall - sphere).square().sqrt();
        // The huge sphere's distance has an ulp of 1e-10 m, of an overlap of 1e-5 m.
        assert!(off <= 3e-5 * wall.square().sqrt(), "{wall:?} {sphere:?}");
    }
    // Carried along by a moving wall, the same to rounding.
    let drift = Vec3(1.0, 2.0, 3.0);
    let moving = wall_contact_kinematics(
        &WallPoint {
            velocity_m_s: drift,
            ..foot
        },
        ContactSphere {
            velocity_m_s: ball.velocity_m_s + drift,
            ..ball
        },
        DT,
    );
    let carried = response(&hertz(), &SPRING, &moving, &history, DT);
    for (rest, carried) in vectors(&at_wall).into_iter().zip(vectors(&carried)) {
        assert!((rest - carried).square().sqrt() <= 1e-12 * rest.square().sqrt());
    }
}
