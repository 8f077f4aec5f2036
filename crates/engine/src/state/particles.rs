//! Particles: one entry per sphere in every array.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::sleep::mask::Asleep;
use dem_physics::bond::total::End;
use dem_physics::contact::kinematics::ContactSphere;
use dem_physics::number::Vec3;
use dem_physics::rotation::rotation;

/// Position and rotation of a particle. One cache line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[repr(align(64))]
pub struct Pose {
    /// Centre x, y, z and, next to it for the neighbour search, the radius of the sphere, m.
    pub position_m: [f64; 4],
    /// Rotation since the start as a unit quaternion x, y, z, w. Length 4.
    pub turned: [f64; 4],
}

impl Pose {
    /// Centre, m.
    #[inline(always)]
    pub fn place(&self) -> Vector3<f64> {
        let [x, y, z, _] = self.position_m;
        Vector3::new(x, y, z)
    }

    /// Radius of the sphere, m.
    #[inline(always)]
    pub fn radius_m(&self) -> f64 {
        self.position_m[3]
    }

    /// Moves the centre to this position, m.
    #[inline(always)]
    pub fn put_at(&mut self, [x, y, z]: [f64; 3]) {
        self.position_m = [x, y, z, self.radius_m()];
    }

    /// The particle as the end of a bond.
    pub fn end(&self) -> End {
        End {
            position_m: self.place(),
            turned: self.rotation(),
        }
    }

    /// Rotation since the start.
    #[inline(always)]
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        rotation(self.turned)
    }
}

/// Motion of a particle, half a step after its pose (leapfrog), and its inertia. One cache line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(64))]
pub struct Motion {
    /// m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// 1/mass, 1/kg: of a sphere of a clump, that which its contacts see.
    pub inverse_mass: f64,
    /// rad/s. Length 3.
    pub spin_rad_s: [f64; 3],
    /// 1/moment of inertia, 1/(kg m2): as the inverse mass.
    pub inverse_inertia: f64,
}

impl Motion {
    pub(crate) fn speed_m_s(&self) -> f64 {
        Vector3::from(self.velocity_m_s).norm()
    }

    /// Power of a wrench at this motion, W.
    pub(crate) fn power_w(&self, wrench: &Wrench) -> f64 {
        (0..3)
            .map(|k| {
                wrench.force_n[k] * self.velocity_m_s[k] + wrench.torque_n_m[k] * self.spin_rad_s[k]
            })
            .sum()
    }

    /// Velocity x, y, z, m/s, and inverse mass, 1/kg: as in memory.
    #[inline(always)]
    pub(crate) fn velocity_row(&self) -> [f64; 4] {
        let [x, y, z] = self.velocity_m_s;
        [x, y, z, self.inverse_mass]
    }

    /// Spin x, y, z, rad/s, and inverse moment of inertia, 1/(kg m2): as in memory.
    #[inline(always)]
    pub(crate) fn spin_row(&self) -> [f64; 4] {
        let [x, y, z] = self.spin_rad_s;
        [x, y, z, self.inverse_inertia]
    }
}

/// Force and torque on a particle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[repr(align(64))]
pub struct Wrench {
    /// Force, N: x, y, z and an unused fourth number.
    pub force_n: [f64; 4],
    /// Torque about the centre, N m: x, y, z and an unused fourth number.
    pub torque_n_m: [f64; 4],
}

impl Wrench {
    /// Adds a force, N, and a torque, N m.
    #[inline(always)]
    pub fn add(&mut self, force_n: &Vector3<f64>, torque_n_m: &Vector3<f64>) {
        for k in 0..3 {
            self.force_n[k] += force_n[k];
            self.torque_n_m[k] += torque_n_m[k];
        }
    }
}

/// All particles of a scene. Those of a body are contiguous, with near ones near each other; those
/// carried by clumps come last.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Particles {
    /// Positions and rotations.
    pub poses: Vec<Pose>,
    /// Motions and inertia.
    pub motions: Vec<Motion>,
    /// Forces and torques in this step.
    #[serde(skip)]
    pub wrenches: Vec<Wrench>,
    /// A number that stands for the same particle throughout a run, and is never reused: see
    /// [`Particles::id`].
    pub ids: Vec<u32>,
    /// Number of free particles, which are not carried by clumps.
    pub free: usize,
    /// For each particle whether its body sleeps. Empty: none does.
    pub asleep: Asleep,
}

impl Particles {
    /// None, with room for so many.
    pub(crate) fn with_room(count: usize) -> Self {
        Self {
            poses: Vec::with_capacity(count),
            motions: Vec::with_capacity(count),
            wrenches: Vec::with_capacity(count),
            ids: Vec::with_capacity(count),
            ..Self::default()
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// Whether there are no particles.
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// The number that stands for particle `i` throughout a run, while bodies are added, removed
    /// and replaced: bodies are numbered one after the other as they come, each in the order of its
    /// file.
    pub fn id(&self, i: usize) -> u32 {
        self.ids.get(i).copied().unwrap_or(i as u32)
    }

    /// Whether the body of particle `i` sleeps.
    #[inline(always)]
    pub fn sleeps(&self, i: usize) -> bool {
        self.asleep.get(i).is_some_and(|asleep| *asleep)
    }

    /// Kinetic energy of particle `i` with this motion, J.
    pub fn kinetic_j(&self, i: usize, motion: &Motion) -> f64 {
        let square = |v: &[f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        0.5 * (square(&motion.velocity_m_s) / self.motions[i].inverse_mass
            + square(&motion.spin_rad_s) / self.motions[i].inverse_inertia)
    }

    /// Radius of the smallest sphere, m; infinite if there is none.
    pub(crate) fn smallest_radius_m(&self) -> f64 {
        let radii = self.poses.iter().map(Pose::radius_m);
        radii.fold(f64::INFINITY, f64::min)
    }

    /// Radius of the largest sphere, m; 0 if there is none.
    pub fn largest_radius_m(&self) -> f64 {
        self.poses.iter().map(Pose::radius_m).fold(0.0, f64::max)
    }

    /// Density of particle `i`, kg/m3.
    pub fn density_kg_m3(&self, i: usize) -> f64 {
        let volume = 4.0 / 3.0 * std::f64::consts::PI * self.poses[i].radius_m().powi(3);
        1.0 / (self.motions[i].inverse_mass * volume)
    }

    /// Particle `i` as a contact sphere at rest.
    pub(crate) fn contact_sphere_at_rest(&self, i: usize) -> ContactSphere {
        ContactSphere {
            velocity_m_s: Vec3(0.0, 0.0, 0.0),
            spin_rad_s: Vec3(0.0, 0.0, 0.0),
            radius_m: self.poses[i].radius_m(),
            inverse_mass_per_kg: self.motions[i].inverse_mass,
            inverse_inertia_per_kg_m2: self.motions[i].inverse_inertia,
        }
    }

    /// Reserves room for exactly this many more particles.
    pub fn reserve_exact(&mut self, count: usize) {
        self.poses.reserve_exact(count);
        self.motions.reserve_exact(count);
        self.wrenches.reserve_exact(count);
        self.ids.reserve_exact(count);
    }

    /// Adds a sphere at rest.
    pub fn push_sphere(&mut self, position_m: [f64; 3], radius_m: f64, density_kg_m3: f64) {
        let mass = density_kg_m3 * 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3);
        self.poses.push(Pose {
            position_m: [position_m[0], position_m[1], position_m[2], radius_m],
            turned: [0.0, 0.0, 0.0, 1.0],
        });
        self.motions.push(Motion {
            inverse_mass: 1.0 / mass,
            inverse_inertia: 1.0 / (0.4 * mass * radius_m * radius_m),
            ..Motion::default()
        });
        self.wrenches.push(Wrench::default());
        self.ids.push(self.ids.len() as u32);
        self.free += 1;
    }
}
