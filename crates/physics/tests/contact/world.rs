//! Two touching bodies, integrated by leapfrog, with their energy balance.

use dem_physics::contact::kinematics::{
    ContactKinematics, ContactSphere, WallPoint, contact_kinematics, torques,
    wall_contact_kinematics,
};
use dem_physics::contact::pair_parameters::{Elastic, PairInput};
use dem_physics::contact::rolling::RollingFriction;
use dem_physics::contact::{ContactSprings, Damping, NormalLaw, Response, response};
use dem_physics::number::Vec3;
use std::f64::consts::PI;

pub(crate) type Vector = Vec3<f64>;
pub(crate) const ZERO: Vector = Vec3(0.0, 0.0, 0.0);
pub(crate) const Z: Vector = Vec3(0.0, 0.0, 1.0);

/// Velocity of b's surface relative to a's at the present contact point, m/s, for ends with these
/// velocities and spins (a first).
///
/// For a wall: the velocity of its surface there.
pub(crate) fn relative_velocity(
    touch: &ContactKinematics,
    [velocity_a, velocity_b]: [Vector; 2],
    [spin_a, spin_b]: [Vector; 2],
) -> Vector {
    let [lever_a, lever_b] = touch.levers_m;
    velocity_b - velocity_a - (spin_a * lever_a + spin_b * lever_b).cross(touch.normal)
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Body {
    pub(crate) place: Vector,
    pub(crate) velocity: Vector,
    pub(crate) spin: Vector,
    pub(crate) radius: f64,
    pub(crate) per_mass: f64,
    pub(crate) per_inertia: f64,
}

impl Body {
    pub(crate) fn sphere(radius: f64, density: f64, place: Vector) -> Self {
        let mass = density * 4.0 / 3.0 * PI * radius.powi(3);
        Self {
            place,
            velocity: ZERO,
            spin: ZERO,
            radius,
            per_mass: 1.0 / mass,
            per_inertia: 2.5 / (mass * radius * radius),
        }
    }

    /// The plane z = 0, or its moved position.
    pub(crate) fn floor() -> Self {
        Self {
            radius: 0.0,
            per_mass: 0.0,
            per_inertia: 0.0,
            ..Self::sphere(1.0, 1.0, ZERO)
        }
    }

    pub(crate) fn ball(&self) -> ContactSphere {
        ContactSphere {
            velocity_m_s: self.velocity,
            spin_rad_s: self.spin,
            radius_m: self.radius,
            inverse_mass_per_kg: self.per_mass,
            inverse_inertia_per_kg_m2: self.per_inertia,
        }
    }

    pub(crate) fn kinetic(&self) -> f64 {
        let half = |square: f64, inverse: f64| {
            if inverse > 0.0 {
                0.5 * square / inverse
            } else {
                0.0
            }
        };
        half(self.velocity.square(), self.per_mass) + half(self.spin.square(), self.per_inertia)
    }
}

pub(crate) struct World<L, R> {
    pub(crate) law: L,
    pub(crate) rolling: R,
    /// A radius of 0 for the first: a floor.
    pub(crate) bodies: [Body; 2],
    pub(crate) history: ContactSprings,
    pub(crate) gravity: Vector,
    pub(crate) dt: f64,
    /// Previous step: 0 at the start.
    pub(crate) before: f64,
    /// True to use the full radius as lever, for comparison.
    pub(crate) whole_lever: bool,
    /// Energy lost so far: normal damping, tangential damping, sliding, rolling.
    pub(crate) lost: [f64; 4],
    pending: [f64; 4],
}

impl<L: NormalLaw<f64>, R: RollingFriction<f64>> World<L, R> {
    pub(crate) fn new(law: L, rolling: R, bodies: [Body; 2], dt: f64) -> Self {
        Self {
            law,
            rolling,
            bodies,
            history: ContactSprings::default(),
            gravity: ZERO,
            dt,
            before: 0.0,
            whole_lever: false,
            lost: [0.0; 4],
            pending: [0.0; 4],
        }
    }

    pub(crate) fn touch(&self) -> ContactKinematics {
        let [a, b] = &self.bodies;
        if a.radius > 0.0 {
            return contact_kinematics(b.place - a.place, [a.ball(), b.ball()], self.before);
        }
        let foot = WallPoint {
            normal: Z,
            normal_before: Z,
            distance_m: b.place.2 - a.place.2,
            velocity_m_s: a.velocity,
            spin_rad_s: a.spin,
        };
        let touch = wall_contact_kinematics(&foot, b.ball(), self.before);
        if !self.whole_lever {
            return touch;
        }
        ContactKinematics {
            levers_m: [0.0, b.radius],
            velocity_m_s: b.velocity - a.velocity - (b.spin * b.radius).cross(Z),
            ..touch
        }
    }

    /// A step: forces, kick, drift. The balance and the result refer to the time of the forces.
    pub(crate) fn step(&mut self) -> Response {
        let touch = self.touch();
        let response = response(&self.law, &self.rolling, &touch, &self.history, self.before);
        for (lost, pending) in self.lost.iter_mut().zip(self.pending) {
            *lost += pending;
        }
        let power = self.powers(&touch, &response.damping);
        for (lost, power) in self.lost.iter_mut().zip(power) {
            *lost += 0.5 * self.before * power;
        }
        self.lost[2] += response.lost.sliding;
        self.lost[3] += response.lost.rolling;

        let kick = 0.5 * (self.before + self.dt);
        let forces = [-response.force_on_b, response.force_on_b];
        let turning = torques(&touch, response.force_on_b, response.moment_on_b);
        for ((body, force), torque) in self.bodies.iter_mut().zip(forces).zip(turning) {
            body.velocity = body.velocity + force * (kick * body.per_mass);
            if body.per_mass > 0.0 {
                body.velocity = body.velocity + self.gravity * kick;
            }
            body.spin = body.spin + torque * (kick * body.per_inertia);
        }
        let power = self.powers(&touch, &response.damping);
        self.pending = power.map(|power| 0.5 * self.dt * power);
        self.history = response.springs;

        for body in &mut self.bodies {
            body.place = body.place + body.velocity * self.dt;
        }
        self.before = self.dt;
        response
    }

    fn powers(&self, touch: &ContactKinematics, damping: &Damping) -> [f64; 4] {
        let [a, b] = &self.bodies;
        let velocity = relative_velocity(touch, [a.velocity, b.velocity], [a.spin, b.spin]);
        let power = damping.power_w(velocity, b.spin - a.spin);
        [power.normal, power.tangential, 0.0, power.rolling]
    }

    pub(crate) fn kinetic(&self) -> f64 {
        self.bodies.iter().map(Body::kinetic).sum()
    }

    pub(crate) fn all_lost(&self) -> f64 {
        self.lost.iter().sum()
    }

    pub(crate) fn momentum(&self) -> Vector {
        self.bodies.iter().fold(ZERO, |sum, body| {
            sum + body.velocity * (1.0 / body.per_mass)
        })
    }

    pub(crate) fn angular_momentum(&self) -> Vector {
        self.bodies.iter().fold(ZERO, |sum, body| {
            sum + body.place.cross(body.velocity) * (1.0 / body.per_mass)
                + body.spin * (1.0 / body.per_inertia)
        })
    }
}

pub(crate) const RIGID: Elastic = Elastic {
    young_modulus_pa: f64::INFINITY,
    poisson_ratio: 0.3,
};

pub(crate) fn material(young_modulus_pa: f64, poisson_ratio: f64) -> Elastic {
    Elastic {
        young_modulus_pa,
        poisson_ratio,
    }
}

/// A pair without damping and friction.
pub(crate) fn frictionless() -> PairInput {
    PairInput::new(1.0, 0.0)
}
