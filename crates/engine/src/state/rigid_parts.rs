//! Rigid parts of bonded bodies: spheres outside the bonded zone that move as one.
//!
//! Their spheres stay free particles with their bonds. Bonds between two spheres of one part cannot
//! change and are not computed.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::bonds::Bonds;
use super::clumps::{SubSphere, sphere_volume_m3, sub_spheres};
use super::particles::{Motion, Pose};
use super::renumbered::{NewNumbers, Renumbered};
use dem_physics::bond::failure::smallest_strength_pa;
use dem_physics::clump_stress::Hits;
use dem_physics::rotation::{kinetic_j, rotation, spin_rad_s};
use dem_physics::shape::inertia::{MassProperties, of_spheres};

/// The part of a sphere that belongs to none.
pub const FREE: u32 = u32::MAX;

/// A rigid part. Velocity and angular momentum are half a step before or after its position.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RigidPart {
    /// Its particles, ascending.
    pub members: Vec<u32>,
    /// The same as spheres along its principal axes. Length members.
    pub spheres: Vec<SubSphere>,
    /// kg.
    pub mass_kg: f64,
    /// Principal moments of inertia, ascending, kg m2. Length 3.
    pub moments_kg_m2: [f64; 3],
    /// Centre of mass, m. Length 3.
    pub place_m: [f64; 3],
    /// Rotation from its principal axes to space: unit quaternion x, y, z, w.
    pub turned: [f64; 4],
    /// Of the centre of mass, m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// About the centre of mass, along the axes of space, kg m2/s. Length 3.
    pub angular_momentum: [f64; 3],
    /// Force on it in this step, N, without gravity. Length 3.
    #[serde(skip)]
    pub force_n: [f64; 3],
    /// Torque about its centre of mass, N m. Length 3.
    #[serde(skip)]
    pub torque_n_m: [f64; 3],
    /// Hits that would have broken its bonds.
    pub hits: Hits,
}

/// All rigid parts.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RigidParts {
    /// In the order of their first particles.
    pub all: Vec<RigidPart>,
    /// For each free particle the number of its part, or [`FREE`]. Empty: there are no parts.
    #[serde(skip)]
    pub of_particle: Vec<u32>,
    /// Bonds within parts, which are not computed.
    #[serde(skip)]
    pub bonds: u64,
    /// Spheres that were released so far.
    pub released: u64,
    /// Spheres that joined a part again so far.
    pub rejoined: u64,
}

/// Mass properties of some particles with these motions, and the velocity, m/s, and angular
/// momentum about the centre of mass, kg m2/s, of a rigid body with their momenta.
pub(crate) fn as_rigid(
    members: &[u32],
    poses: &[Pose],
    motions: &[Motion],
) -> (MassProperties, [Vector3<f64>; 2]) {
    let motions = || members.iter().map(|&i| &motions[i as usize]);
    let place = |i: &u32| poses[*i as usize].place();
    let centres: Vec<[f64; 3]> = members.iter().map(|i| place(i).into()).collect();
    let masses: Vec<f64> = motions().map(|m| 1.0 / m.inverse_mass).collect();
    let inertias: Vec<f64> = motions().map(|m| 1.0 / m.inverse_inertia).collect();
    let properties = of_spheres(&centres, &masses, &inertias);
    let momentum: Vector3<f64> = (motions().zip(&masses))
        .map(|(motion, mass)| *mass * Vector3::from(motion.velocity_m_s))
        .sum();
    let velocity = momentum / properties.mass_kg;
    let centre = Vector3::from(properties.centre_m);
    let mut angular = Vector3::zeros();
    for (n, motion) in motions().enumerate() {
        let arm = Vector3::from(centres[n]) - centre;
        angular += masses[n] * arm.cross(&(Vector3::from(motion.velocity_m_s) - velocity))
            + inertias[n] * Vector3::from(motion.spin_rad_s);
    }
    (properties, [velocity, angular])
}

impl RigidPart {
    /// Mean stress times volume from which its bonds break, N m: infinite if they cannot. Those of
    /// its first sphere stand for all.
    pub fn breaks_from_n_m(&self, bonds: &Bonds) -> f64 {
        let Some(&first) = self.members.first() else {
            return f64::INFINITY;
        };
        let at = bonds.ends.partition_point(|[a, _]| *a < first);
        if at == bonds.len() {
            return f64::INFINITY;
        }
        let criteria = bonds.rules[bonds.rule_of(at)].criteria;
        let strength_pa = criteria.as_ref().map(smallest_strength_pa);
        strength_pa.unwrap_or(f64::INFINITY) * sphere_volume_m3(&self.spheres)
    }

    /// The part that these particles, ascending, form with their momenta.
    pub(crate) fn of(members: Vec<u32>, poses: &[Pose], motions: &[Motion]) -> Self {
        let (properties, [velocity, angular]) = as_rigid(&members, poses, motions);
        let own = members
            .iter()
            .map(|&i| (&poses[i as usize], &motions[i as usize]));
        Self {
            spheres: sub_spheres(own, &properties),
            members,
            mass_kg: properties.mass_kg,
            moments_kg_m2: properties.moments_kg_m2,
            place_m: properties.centre_m,
            turned: properties.axes,
            velocity_m_s: velocity.into(),
            angular_momentum: angular.into(),
            ..Self::default()
        }
    }

    /// Spin, rad/s.
    pub fn spin_rad_s(&self) -> Vector3<f64> {
        spin_rad_s(&self.turned, self.angular_momentum, self.moments_kg_m2).into()
    }

    /// Kinetic energy, J.
    pub fn kinetic_j(&self) -> f64 {
        0.5 * self.mass_kg * Vector3::from(self.velocity_m_s).norm_squared()
            + kinetic_j(&self.turned, self.angular_momentum, self.moments_kg_m2)
    }

    /// Change of the spin in time by a torque, rad/s2.
    pub(crate) fn spun_by(&self, torque_n_m: &Vector3<f64>) -> Vector3<f64> {
        let to_space = rotation(self.turned);
        let own = to_space.inverse() * torque_n_m;
        to_space * own.component_div(&Vector3::from(self.moments_kg_m2))
    }

    /// Velocity, m/s, of the part at a place, m.
    pub(crate) fn velocity_at(&self, place: &Vector3<f64>) -> Vector3<f64> {
        let arm = place - Vector3::from(self.place_m);
        Vector3::from(self.velocity_m_s) + self.spin_rad_s().cross(&arm)
    }

    /// Gives its particles the motion that they have in it.
    pub(crate) fn set_motions(&self, poses: &[Pose], motions: &mut [Motion]) {
        let motion = [self.velocity_m_s, self.angular_momentum].map(Vector3::from);
        self.set_motions_of(motion, poses, motions);
    }

    /// The same if this were its velocity, m/s, and its angular momentum, kg m2/s.
    pub(crate) fn set_motions_of(
        &self,
        [velocity, angular]: [Vector3<f64>; 2],
        poses: &[Pose],
        motions: &mut [Motion],
    ) {
        let spin = spin_rad_s(&self.turned, angular.into(), self.moments_kg_m2);
        let (spin, centre) = (Vector3::from(spin), Vector3::from(self.place_m));
        for &i in &self.members {
            let arm = poses[i as usize].place() - centre;
            let motion = &mut motions[i as usize];
            *motion = Motion {
                velocity_m_s: (velocity + spin.cross(&arm)).into(),
                spin_rad_s: spin.into(),
                ..*motion
            };
        }
    }
}

impl RigidParts {
    /// Number of the part of particle `i`, or [`FREE`].
    pub(crate) fn of(&self, i: u32) -> u32 {
        self.of_particle.get(i as usize).copied().unwrap_or(FREE)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Lists the part of each of `free` particles again, and counts the bonds within parts.
    pub(crate) fn number(&mut self, free: usize, bonds: &Bonds) {
        self.of_particle.clear();
        self.bonds = 0;
        if self.all.is_empty() {
            return;
        }
        self.of_particle.resize(free, FREE);
        for (n, part) in (0..).zip(&self.all) {
            for &i in &part.members {
                self.of_particle[i as usize] = n;
            }
        }
        let is_within = |at: &usize| {
            !bonds.is_broken(*at) && is_within_part(&self.of_particle, bonds.ends[*at])
        };
        self.bonds = (0..bonds.len()).filter(is_within).count() as u64;
    }

    /// Bytes of the arrays.
    pub(crate) fn bytes(&self) -> usize {
        let parts = self.all.iter();
        let parts =
            parts.map(|part| size_of_val(&part.members[..]) + size_of_val(&part.spheres[..]));
        size_of_val(&self.all[..]) + size_of_val(&self.of_particle[..]) + parts.sum::<usize>()
    }
}

/// A part leaves as a whole.
impl Renumbered for RigidParts {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        self.all.retain_mut(|part| {
            by.renumber(&mut part.members);
            !part.members.is_empty()
        });
    }
}

/// Whether both ends of a bond belong to one rigid part. `part_of`: see
/// [`RigidParts::of_particle`].
#[inline(always)]
pub(crate) fn is_within_part(part_of: &[u32], [a, b]: [u32; 2]) -> bool {
    let first = part_of.get(a as usize);
    first.is_some_and(|part| *part != FREE) && first == part_of.get(b as usize)
}
