//! Motions of machines: places, orientations and velocities of orbits and gyrations.

use std::f64::consts::TAU;

use dem_physics::machine::{Gyration, Orbit};
use nalgebra::{UnitQuaternion, Vector3};

use crate::shape::unit;

/// Along (2, 3, 6)/7, and normal to it.
const AXIS: [f64; 3] = [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0];
const TOWARDS: [f64; 3] = [6.0 / 7.0, 2.0 / 7.0, -3.0 / 7.0];

const ORBIT: Orbit = Orbit {
    axis: AXIS,
    towards: TOWARDS,
    radius_m: 4e-3,
    frequency_hz: 15.0,
};

fn gyration(spin_rad_s: f64) -> Gyration {
    Gyration {
        axis: AXIS,
        towards: TOWARDS,
        angle_rad: 0.3,
        frequency_hz: 5.0,
        spin_rad_s,
    }
}

fn vector(of: [f64; 3]) -> Vector3<f64> {
    Vector3::from(of)
}

/// Errors of the central differences of a motion over 2 h and 4 h: the second is four times as
/// large, for an error of second order.
#[track_caller]
fn assert_second_order(error: impl Fn(f64) -> f64, scale: f64) {
    let [one, two] = [1e-4, 2e-4].map(error);
    let ratio = two / one;
    assert!((ratio - 4.0).abs() < 0.01, "{one:e} {two:e}: {ratio}");
    assert!(one < 1e-4 * scale, "{one:e} of {scale:e}");
}

#[test]
fn an_orbit_is_a_circle_about_its_axis() {
    assert!((vector(ORBIT.place_m(0.0)) - 4e-3 * vector(TOWARDS)).norm() < 1e-17);
    let quarter = vector(AXIS).cross(&vector(TOWARDS));
    assert!((vector(ORBIT.place_m(1.0 / 60.0)) - 4e-3 * quarter).norm() < 1e-17);
    for time_s in [0.0, 0.0123, 0.5, 7.7] {
        let (place, velocity) = (
            vector(ORBIT.place_m(time_s)),
            vector(ORBIT.velocity_m_s(time_s)),
        );
        assert!((place.norm() - 4e-3).abs() < 1e-17);
        assert!(place.dot(&vector(AXIS)).abs() < 1e-17);
        assert!((velocity.norm() - TAU * 15.0 * 4e-3).abs() < 1e-14);
        assert_second_order(
            |h| {
                let [from, to] = [time_s - h, time_s + h].map(|at| vector(ORBIT.place_m(at)));
                ((to - from) / (2.0 * h) - velocity).norm()
            },
            velocity.norm(),
        );
    }
}

#[test]
fn the_spin_of_a_gyration_is_the_derivative_of_its_orientation() {
    for spin_rad_s in [0.0, 3.0, -TAU * 5.0] {
        let mantle = gyration(spin_rad_s);
        let speed = vector(mantle.angular_velocity_rad_s(0.0)).norm();
        for time_s in [0.0, 0.0123, 0.5, 7.7] {
            let spin = vector(mantle.angular_velocity_rad_s(time_s));
            assert!((spin.norm() - speed).abs() < 1e-12 * speed);
            assert_second_order(
                |h| {
                    let turn = mantle.turn_between_rad([time_s - h, time_s + h]);
                    (vector(turn) / (2.0 * h) - spin).norm()
                },
                spin.norm(),
            );
            // A rotation of the orientation by this vector leads from one moment to the other.
            let turn = UnitQuaternion::from_scaled_axis(vector(
                mantle.turn_between_rad([time_s, time_s + 1e-3]),
            ));
            let [from, to] = [time_s, time_s + 1e-3].map(|at| unit(mantle.turned(at)));
            assert!((turn * from).angle_to(&to) < 1e-12);
        }
    }
}

#[test]
fn the_axis_of_a_gyration_goes_round_a_cone() {
    let mantle = gyration(0.0);
    let axis = vector(AXIS);
    for (part, wanted) in [
        (0.0, vector(TOWARDS)),
        (0.25, axis.cross(&vector(TOWARDS))),
        (0.5, -vector(TOWARDS)),
    ] {
        let leaning = unit(mantle.turned(part / 5.0)) * axis;
        let wanted = 0.3_f64.cos() * axis + 0.3_f64.sin() * wanted;
        assert!((leaning - wanted).norm() < 1e-15, "{part}");
    }
    // Without a spin it comes back, and has not turned.
    assert!(unit(mantle.turned(0.2)).angle_to(&unit(mantle.turned(0.0))) < 1e-14);
    // With that of its gyration it turns as a whole.
    let whole = gyration(TAU * 5.0);
    for time_s in [0.013, 0.1, 0.77] {
        let about = UnitQuaternion::from_scaled_axis(TAU * 5.0 * time_s * axis);
        let wanted = about * unit(whole.turned(0.0));
        assert!(
            unit(whole.turned(time_s)).angle_to(&wanted) < 1e-13,
            "{time_s}"
        );
    }
}
