//! Motions of machines in closed form: a body whose points go round circles (a vibrating screen),
//! and one whose axis goes round a cone (the mantle of a cone crusher).

use std::f64::consts::TAU;

use nalgebra::{Unit, UnitQuaternion, Vector3};
use serde::Serialize;

use super::rigid::rotation_vector;
use super::rotation::numbers;

/// A body that does not turn, and whose points all go round circles of the same radius.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Orbit {
    /// Axis of the circles, of length 1; the body goes round it right-handed. Length 3.
    pub axis: [f64; 3],
    /// From the centre of the circle to the body at time 0, normal to the axis and of length 1.
    /// Length 3.
    pub towards: [f64; 3],
    /// Radius of the circles, m.
    pub radius_m: f64,
    /// Turns per second, Hz.
    pub frequency_hz: f64,
}

/// A body that moves about a fixed point, and whose axis goes round a cone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Gyration {
    /// Axis of the cone, of length 1; the axis of the body goes round it right-handed. Length 3.
    pub axis: [f64; 3],
    /// Where the axis of the body leans at time 0, normal to the axis and of length 1. Length 3.
    pub towards: [f64; 3],
    /// Between the two axes, rad.
    pub angle_rad: f64,
    /// Turns of the axis of the body per second, Hz.
    pub frequency_hz: f64,
    /// Rate at which the body turns about its own axis, right-handed, rad/s.
    pub spin_rad_s: f64,
}

impl Orbit {
    /// From the centre of the circle to the body at this time, s; m.
    pub fn place_m(&self, time_s: f64) -> [f64; 3] {
        (self.radius_m * round(self.axis, self.towards, self.angle_rad(time_s))).into()
    }

    /// Velocity at this time, s; m/s.
    pub fn velocity_m_s(&self, time_s: f64) -> [f64; 3] {
        let out = round(self.axis, self.towards, self.angle_rad(time_s));
        (self.speed_m_s() * Vector3::from(self.axis).cross(&out)).into()
    }

    /// Speed, m/s.
    pub fn speed_m_s(&self) -> f64 {
        TAU * self.frequency_hz * self.radius_m
    }

    fn angle_rad(&self, time_s: f64) -> f64 {
        TAU * self.frequency_hz * time_s
    }
}

impl Gyration {
    /// Rotation of the upright body at this time, s: a unit quaternion x, y, z, w.
    pub fn turned(&self, time_s: f64) -> [f64; 4] {
        numbers(&self.rotation(time_s))
    }

    /// Rotation vector from one of these times to the other, s; rad. They are less than half a turn
    /// apart.
    pub fn turn_between_rad(&self, [from_s, to_s]: [f64; 2]) -> [f64; 3] {
        let turn = self.rotation(to_s) * self.rotation(from_s).inverse();
        rotation_vector(numbers(&turn))
    }

    /// Angular velocity at this time, s; rad/s. Its magnitude is always the same.
    ///
    /// The rotation by the constant angle a about the unit vector h(t) has the angular velocity
    /// sin(a) h' + (1 - cos(a)) h x h', as h' is normal to h.
    pub fn angular_velocity_rad_s(&self, time_s: f64) -> [f64; 3] {
        let axis = Vector3::from(self.axis);
        let rate_rad_s = TAU * self.frequency_hz;
        let (sine, cosine) = self.angle_rad.sin_cos();
        let leans = round(self.axis, self.towards, rate_rad_s * time_s);
        let own_axis = cosine * axis + sine * leans;
        let nods = (1.0 - cosine) * axis - sine * leans;
        (rate_rad_s * nods + self.spin_rad_s * own_axis).into()
    }

    fn rotation(&self, time_s: f64) -> UnitQuaternion<f64> {
        let axis = Vector3::from(self.axis);
        let leans = round(self.axis, self.towards, TAU * self.frequency_hz * time_s);
        let about = Unit::new_unchecked(axis.cross(&leans));
        let own =
            UnitQuaternion::from_axis_angle(&Unit::new_unchecked(axis), self.spin_rad_s * time_s);
        UnitQuaternion::from_axis_angle(&about, self.angle_rad) * own
    }
}

/// A unit vector normal to an axis after a rotation about it, rad.
fn round(axis: [f64; 3], towards: [f64; 3], angle_rad: f64) -> Vector3<f64> {
    let (axis, towards) = (Vector3::from(axis), Vector3::from(towards));
    let (sine, cosine) = angle_rad.sin_cos();
    cosine * towards + sine * axis.cross(&towards)
}
