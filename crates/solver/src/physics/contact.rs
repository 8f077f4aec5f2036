//! Contacts between two spheres, or a sphere and a wall: a normal law with friction, and rolling
//! friction.
//!
//! With n the unit normal from a to b, d the overlap, v the velocity of b's surface against a's and
//! v_t its part across n, the force on b is
//!
//!   N n - k_t xi - c_t v_t,   N = elastic(d) - c_n v . n >= 0,   |k_t xi + c_t v_t| <= mu N
//!
//! and the moment on b is -k_r theta - c_r w_t, with the relative spin w in place of v. The [normal
//! law](NormalLaw) says what elastic, k_t, c_n and c_t are, the [rolling friction](RollingFriction)
//! what becomes of the moment.
//!
//! The springs xi and theta are what a contact remembers. They are summed up from velocities that
//! leapfrog has halfway through a step, in the axes of the middle of the step (half the turn of the
//! normal, half the mean spin about it), so that the step is the same backwards.
//!
//! The books are exact to second order in the time step. The springs' own losses come as energies
//! of the step just made: the mean of the forces at its two ends times the motion between, less
//! what is stored. Damping comes as forces: half of their power with the velocity before the kick,
//! half with that after it ([`Damping::power_w`]).
//!
//! Leapfrog knows the velocity of half a step ago when forces are due, and c_n is taken for that.

pub mod assembly;
pub mod hertz_mindlin;
pub mod kinematics;
pub mod law;
pub mod linear;
pub mod pair_parameters;
pub mod relaxation;
pub mod restitution;
pub mod rolling;
pub mod slider;

use crate::physics::number::{Number, Vec3};
use kinematics::{ContactKinematics, FrameRotation};
use rolling::RollingFriction;
use slider::coulomb_return_map;

/// What a contact remembers. All 0 when it begins, and again once the ends are apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSprings<T = f64> {
    /// Tangential spring: how far b's surface is displaced against a's, across the normal, m.
    pub tangential_m: Vec3<T>,
    /// Rolling spring: how far b has rolled against a, across the normal, rad.
    pub rolling_rad: Vec3<T>,
    /// Overlap when forces were computed last, m.
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

/// What a contact does and stores.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response<T = f64> {
    /// To be remembered.
    pub springs: ContactSprings<T>,
    /// Force on b, N. The first end feels the opposite.
    pub force_on_b: Vec3<T>,
    /// Moment of rolling friction on b, N m. The first end feels the opposite. Torques of the force
    /// come [on top](kinematics::torques).
    pub moment_on_b: Vec3<T>,
    /// Elastic energy.
    pub energy: ContactEnergy<T>,
    /// Lost by the springs in the step just made.
    pub lost: Lost<T>,
    /// The part of force and moment that is damping.
    pub damping: Damping<T>,
}

/// Elastic energy of a contact by mode, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactEnergy<T = f64> {
    /// Of the overlap.
    pub normal: T,
    /// Of the tangential spring.
    pub tangential: T,
    /// Of the rolling spring.
    pub rolling: T,
}

/// Energy the springs lost in a step, J: sliding, and what a spring loses as the normal load
/// changes.
///
/// Not below -1/8 k x^2, with k the stiffness before the step and x the motion in it, and that only
/// in a step that turns a force round.
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
    /// Along the normal, N: the normal force less its elastic part.
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
    /// All of it together.
    #[inline(always)]
    pub fn total(&self) -> Damped<T> {
        Damped {
            force_n: self.normal_n + self.tangential_n,
            moment_n_m: self.rolling_n_m,
        }
    }

    /// Power lost at this [relative velocity](kinematics::relative_velocity), m/s, and spin of b
    /// against a, rad/s, where the forces act.
    ///
    /// Over a step: half of it with the forces at its beginning, half with those at its end, both
    /// with the velocity halfway.
    #[inline(always)]
    pub fn power_w(&self, velocity_m_s: Vec3<T>, spin_rad_s: Vec3<T>) -> DampingPower<T> {
        DampingPower {
            normal: -self.normal_n.dot(velocity_m_s),
            tangential: -self.tangential_n.dot(velocity_m_s),
            rolling: -self.rolling_n_m.dot(spin_rad_s),
        }
    }
}

/// All that damping does to b: what is remembered of it until the next step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damped<T = f64> {
    /// Force, N.
    pub force_n: Vec3<T>,
    /// Moment against rolling, N m.
    pub moment_n_m: Vec3<T>,
}

impl<T: Number> Damped<T> {
    /// Energy that damping took in a step of `dt`, s, that began with `before` and ends so, J: the
    /// mean of the two forces times the motion between, as springs' losses are booked.
    #[inline(always)]
    pub fn lost_j(&self, before: &Self, touch: &ContactKinematics<T>, dt: f64) -> T {
        let force = before.force_n + self.force_n;
        let moment = before.moment_n_m + self.moment_n_m;
        let power = force.dot(touch.velocity_m_s) + moment.dot(touch.spin_rad_s);
        power.scale(-0.5 * dt)
    }
}

/// What a normal law says of a contact at an overlap, and of the same contact a step before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalResponse<T = f64> {
    /// Elastic force, N.
    pub elastic_n: T,
    /// Elastic energy, J.
    pub energy_j: T,
    /// Tangent stiffness along the normal, before the step and now, N/m.
    pub normal_n_m: [T; 2],
    /// Stiffness of the tangential spring, before the step and now, N/m.
    pub tangential_n_m: [T; 2],
    /// Stiffness before the step over that now; 0 where there is no contact now.
    pub stiffness_ratio: T,
    /// Damping force per speed along the normal, N s/m.
    pub normal_damping_n_s_m: T,
    /// The same across it.
    pub tangential_damping_n_s_m: T,
}

/// A law for the normal force, and what friction needs to know of it.
pub trait NormalLaw<T: Number> {
    /// The contact now and, at the overlap of its history, a step of `dt`, s, before.
    fn evaluate(
        &self,
        touch: &ContactKinematics<T>,
        overlap_before_m: T,
        dt: f64,
    ) -> NormalResponse<T>;

    /// How the pair damps and rubs.
    fn parameters(&self) -> &pair_parameters::PairParameters<T>;
}

/// What the choice of the time step asks of a law besides forces.
pub trait ImpactLaw: NormalLaw<f64> {
    /// Fraction of its own limit with which an impact is followed, at most, at the usual safety
    /// factor: what keeps the energy error of a single impact small.
    fn impact_fraction(&self) -> f64;

    /// Tangent stiffness along the normal, N/m, at an overlap, m, above 0, with an effective
    /// radius, m.
    fn normal_n_m(&self, overlap_m: f64, effective_radius_m: f64) -> f64;

    /// Largest overlap at which the tangent stiffness is at most this, N/m, with an effective
    /// radius, m; infinite where no contact is stiffer.
    fn overlap_of_stiffness_m(&self, stiffness_n_m: f64, effective_radius_m: f64) -> f64;

    /// Largest overlap of an impact at a speed, m/s, without damping, m: with damping it is less.
    fn overlap_at_impact_m(&self, effective_radius_m: f64, mass_kg: f64, speed_m_s: f64) -> f64;
}

/// The damping c, N s/m, of a force -c v that is computed with the velocity of half a step of `dt`,
/// s, ago and yet takes from an impact what it should: c/(1 + g/2) with g = c dt/(2 m) and the
/// reduced mass m, kg. With constant stiffness that is of second order in the step, with Hertz's a
/// tenth of the first order is left.
///
/// With c itself, a step takes -ln(1 - 2 g)/2, which is g (1 + g), from the logarithm of the speed,
/// and the ends swing faster by a share of g/2, so that they touch for that much less time:
/// together an impact loses a share of g/2 too much.
#[inline(always)]
fn of_lagging_velocity<T: Number>(damping_n_s_m: T, mass_kg: T, dt: f64) -> T {
    let mass = mass_kg.scale(4.0);
    mass.if_positive(damping_n_s_m * mass / (mass + damping_n_s_m.scale(dt)))
}

/// What a contact does after a step of `dt` (s) which the touch and the history before it describe.
///
/// Meant for the inside of a loop over contacts: there is no branch in it, and what the caller does
/// not read is not computed.
#[inline(always)]
pub fn response<T: Number>(
    law: &impl NormalLaw<T>,
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
    let held = damped.maximum(parameters.least_n);
    let normal = touch.overlap_m.if_positive(held);
    let pressed = normal.if_positive(normal);

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
        force_on_b: touch.normal * normal - friction_step.force - friction_step.damping,
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
    }
}

/// A contact as the limit of the time step sees it: linearised, at rest at its overlap.
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

/// The linearised contact. All its numbers grow with the overlap, so at the largest overlap there
/// will be they are the largest.
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
