//! Contacts between two spheres, or a sphere and a wall: a normal law with friction, and rolling
//! friction.
//!
//! With n the unit normal from a to b, d the overlap, v the velocity of b's surface against a's and
//! v_t its part across n, the force on b is
//!
//!   N n - k_t xi - c_t v_t,   N = elastic(d) - c_n v . n >= 0,   |k_t xi + c_t v_t| <= mu N
//!
//! and the moment on b is -k_r theta - c_r w_t, with the relative spin w in place of v. The
//! [normal law](NormalLaw) defines elastic, k_t, c_n and c_t, the
//! [rolling friction](RollingFriction) the moment.
//!
//! The displacements xi and theta are the history of a contact. They are summed from the velocities
//! of the leapfrog, halfway through a step, in the axes of the middle of the step (half the
//! rotation of the normal, half the mean spin about it), so that the step is time-reversible.
//!
//! The energy accounting is exact to second order in the time step. Losses of the springs are
//! energies of the step just made: the mean of the forces at its two ends times the motion in
//! between, minus the increase of the stored energy. Losses of damping are computed from forces:
//! half of their power with the velocity before the kick, half with that after it
//! ([`Damping::power_w`]).
//!
//! When forces are computed, the leapfrog only has the velocity of half a step ago; c_n is adjusted
//! to that.

pub mod assembly;
pub mod history;
mod jumps;
pub mod kinematics;
pub mod law;
pub mod liquid_bridge;
mod normal;
pub mod pair_parameters;
pub mod patch_book;
pub mod relaxation;
pub mod restitution;
pub mod rolling;
pub mod slider;

pub use normal::{ImpactLaw, NormalLaw, NormalResponse};

use crate::number::{Number, Vec3};
use jumps::of_a_step_more;
use kinematics::{ContactKinematics, FrameRotation};
use rolling::RollingFriction;
use slider::coulomb_return_map;

/// History of a contact. All values are 0 when it begins, and again once the ends are apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSprings<T = f64> {
    /// Tangential displacement of b's surface relative to a's, across the normal, m.
    pub tangential_m: Vec3<T>,
    /// Rolling displacement of b relative to a, across the normal, rad.
    pub rolling_rad: Vec3<T>,
    /// Overlap at the last computation of forces, m.
    pub overlap_m: T,
}

impl Default for ContactSprings {
    fn default() -> Self {
        Self {
            tangential_m: Vec3(0.0, 0.0, 0.0),
            rolling_rad: Vec3(0.0, 0.0, 0.0),
            overlap_m: 0.0,
        }
    }
}

/// Forces and energies of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response<T = f64> {
    /// New history.
    pub springs: ContactSprings<T>,
    /// Force on b, N. The first end feels the opposite.
    pub force_on_b: Vec3<T>,
    /// Moment of rolling friction on b, N m. The first end feels the opposite. Torques of the force
    /// are [added to it](kinematics::torques).
    pub moment_on_b: Vec3<T>,
    /// Elastic energy.
    pub energy: ContactEnergy<T>,
    /// Energy lost by the springs in the step just made.
    pub lost: Lost<T>,
    /// The damping part of force and moment.
    pub damping: Damping<T>,
    /// Part of the force for an attraction that began or ended within the step, N, which acts in
    /// that step only.
    pub jump_n: Vec3<T>,
}

/// Elastic energy of a contact by mode, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactEnergy<T = f64> {
    /// Energy of the overlap.
    pub normal: T,
    /// Energy of the tangential spring.
    pub tangential: T,
    /// Energy of the rolling spring.
    pub rolling: T,
}

/// Energy that the springs lost in a step, J: by sliding, and by changes of the normal load.
///
/// Not below -1/8 k x^2, with k the stiffness before the step and x the motion in it, and negative
/// only in a step that reverses a force.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lost<T = f64> {
    /// By sliding.
    pub sliding: T,
    /// By rolling.
    pub rolling: T,
}

/// Forces and moments of damping on b. The first end feels the opposite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping<T = f64> {
    /// Along the normal, N: the normal force minus its elastic part.
    pub normal_n: Vec3<T>,
    /// Across it, N.
    pub tangential_n: Vec3<T>,
    /// Rolling, N m.
    pub rolling_n_m: Vec3<T>,
}

/// Power lost by damping, W.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DampingPower<T = f64> {
    /// Along the normal.
    pub normal: T,
    /// Across it.
    pub tangential: T,
    /// Rolling.
    pub rolling: T,
}

impl<T: Number> Damping<T> {
    /// Total force and moment of damping.
    #[inline(always)]
    pub fn total(&self) -> Damped<T> {
        Damped {
            force_n: self.normal_n + self.tangential_n,
            moment_n_m: self.rolling_n_m,
        }
    }

    /// Power lost at this velocity of b's surface relative to a's at the contact point, m/s, and
    /// spin of b relative to a, rad/s, at the time of the forces.
    ///
    /// Over a step: half of it with the forces at its beginning, half with those at its end, both
    /// with the velocity in the middle.
    #[inline(always)]
    pub fn power_w(&self, velocity_m_s: Vec3<T>, spin_rad_s: Vec3<T>) -> DampingPower<T> {
        DampingPower {
            normal: -self.normal_n.dot(velocity_m_s),
            tangential: -self.tangential_n.dot(velocity_m_s),
            rolling: -self.rolling_n_m.dot(spin_rad_s),
        }
    }
}

/// Total damping on b, kept in the history until the next step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damped<T = f64> {
    /// Force, N.
    pub force_n: Vec3<T>,
    /// Moment against rolling, N m.
    pub moment_n_m: Vec3<T>,
}

impl<T: Number> Damped<T> {
    /// Energy lost to damping in a step of `dt`, s, that began with `before` and ends with `self`,
    /// J: the mean of the two forces times the motion in between, as for the losses of springs.
    #[inline(always)]
    pub fn lost_j(&self, before: &Self, touch: &ContactKinematics<T>, dt: f64) -> T {
        let force = before.force_n + self.force_n;
        let moment = before.moment_n_m + self.moment_n_m;
        let power = force.dot(touch.velocity_m_s) + moment.dot(touch.spin_rad_s);
        power.scale(-0.5 * dt)
    }
}

/// The damping c, N s/m, of a force -c v that uses the velocity of half a step of `dt`, s, ago,
/// corrected to give the right loss in an impact: c/(1 + g/2) with g = c dt/(2 m) and the effective
/// mass m, kg. With constant stiffness the error is of second order in the step; with Hertz's a
/// tenth of the first-order error remains.
///
/// With c itself, a step subtracts -ln(1 - 2 g)/2, which is g (1 + g), from the logarithm of the
/// speed, and the ends oscillate faster by a fraction of g/2, so that the contact is shorter by
/// that fraction: in total an impact loses too much by a fraction of g/2.
#[inline(always)]
fn of_lagging_velocity<T: Number>(damping_n_s_m: T, mass_kg: T, dt: f64) -> T {
    let mass = mass_kg.scale(4.0);
    mass.if_positive(damping_n_s_m * mass / (mass + damping_n_s_m.scale(dt)))
}

/// The normal force of a contact without what attracts it and, for friction, the force that presses
/// its surfaces on each other, N. `damped`: the elastic force less that of the dashpot, N.
#[inline(always)]
fn normal_forces_n<T: Number, L: NormalLaw<T>>(
    law: &L,
    touch: &ContactKinematics<T>,
    damped: T,
) -> [T; 2] {
    let least_n = law.parameters().least_n;
    if L::ATTRACTS {
        let attraction = law.attraction_n(touch);
        let held = (damped + attraction).maximum(least_n);
        let normal = touch.overlap_m.if_positive(held - attraction);
        return [normal, touch.overlap_m.if_positive(held.if_positive(held))];
    }
    let normal = touch.overlap_m.if_positive(damped.maximum(least_n));
    [normal, normal.if_positive(normal)]
}

/// Forces and energies of a contact after a step of `dt` (s), from its kinematics and its history.
///
/// Meant for the inside of a loop over contacts: it has no branches, and results that the caller
/// does not use are not computed.
#[inline(always)]
pub fn response<T: Number, L: NormalLaw<T>>(
    law: &L,
    rolling: &impl RollingFriction<T>,
    touch: &ContactKinematics<T>,
    springs: &ContactSprings<T>,
    dt: f64,
) -> Response<T> {
    let normal_response = law.evaluate(touch, springs.overlap_m, dt);
    let parameters = law.parameters();
    let carry = FrameRotation::new(touch, dt);

    let apart = touch.velocity_m_s.dot(touch.middle);
    let damping = of_lagging_velocity(
        normal_response.normal_damping_n_s_m,
        touch.effective_mass_kg,
        dt,
    );
    let damped = normal_response.elastic_n - damping * apart;
    let [normal, pressed] = normal_forces_n(law, touch, damped);
    let force = touch.normal * normal;
    let none = normal.zero();
    let [pushed, jump_n] = if L::ATTRACTS {
        let overlaps_m = [springs.overlap_m, touch.overlap_m];
        let more = of_a_step_more(overlaps_m, apart.scale(dt));
        let jump_n = touch.normal * -(law.attraction_at_touch_n(touch) * more);
        [force + jump_n, jump_n]
    } else {
        [force, Vec3(none, none, none)]
    };

    let across = touch.velocity_m_s - touch.middle * apart;
    let friction_step = coulomb_return_map(
        &carry,
        springs.tangential_m,
        across.scale(dt),
        normal_response.tangential_n_m,
        normal_response
            .stiffness_ratio
            .maximum(parameters.kept[0])
            .minimum(parameters.kept[1]),
        parameters.friction * pressed,
        across * normal_response.tangential_damping_n_s_m,
    );
    let rolled = rolling.roll(
        &normal_response,
        touch,
        &carry,
        springs.rolling_rad,
        pressed,
        dt,
    );

    Response {
        springs: ContactSprings {
            tangential_m: friction_step.spring,
            rolling_rad: rolled.spring,
            overlap_m: touch.overlap_m.if_positive(touch.overlap_m),
        },
        force_on_b: pushed - friction_step.force - friction_step.damping,
        moment_on_b: -rolled.force - rolled.damping,
        energy: ContactEnergy {
            normal: normal_response.energy_j,
            tangential: friction_step.stored_j,
            rolling: rolled.stored_j,
        },
        lost: Lost {
            sliding: friction_step.lost_j,
            rolling: rolled.lost_j,
        },
        damping: Damping {
            normal_n: touch.normal * (normal - normal_response.elastic_n),
            tangential_n: -friction_step.damping,
            rolling_n_m: -rolled.damping,
        },
        jump_n,
    }
}

/// A contact linearised for the time step limit, at rest at its overlap.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Linearised<T = f64> {
    /// Stiffness along the normal, N/m.
    pub normal_n_m: T,
    /// Across it, N/m.
    pub tangential_n_m: T,
    /// Of rolling, N m/rad.
    pub rolling_n_m_rad: T,
    /// Damping along the normal, N s/m.
    pub normal_damping_n_s_m: T,
    /// Across it, N s/m.
    pub tangential_damping_n_s_m: T,
    /// Of rolling, N m s/rad.
    pub rolling_damping_n_m_s: T,
}

/// The linearised contact. All its numbers grow with the overlap, so they are largest at the
/// largest overlap to be expected.
#[inline(always)]
pub fn linearised<T: Number>(
    law: &impl NormalLaw<T>,
    rolling: &impl RollingFriction<T>,
    touch: &ContactKinematics<T>,
) -> Linearised<T> {
    let normal_response = law.evaluate(touch, touch.overlap_m, 0.0);
    let [stiffness, damping] = rolling.linearised(&normal_response, touch);
    Linearised {
        normal_n_m: normal_response.normal_n_m[1],
        tangential_n_m: normal_response.tangential_n_m[1],
        rolling_n_m_rad: stiffness,
        normal_damping_n_s_m: normal_response.normal_damping_n_s_m,
        tangential_damping_n_s_m: normal_response.tangential_damping_n_s_m,
        rolling_damping_n_m_s: damping,
    }
}
