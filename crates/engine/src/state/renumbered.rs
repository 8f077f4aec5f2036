//! Data that names particles, and follows when their numbers change.

use super::particles::Pose;

/// Number of a particle or bond that has been removed.
pub const REMOVED: u32 = u32::MAX;

/// The numbers of particles after bodies have come, gone or changed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NewNumbers<'a> {
    /// For each old particle, its new number, or [`REMOVED`].
    pub(crate) now: &'a [u32],
    pub(crate) old_radii_m: &'a [f64],
    /// Poses of the new particles.
    pub(crate) poses: &'a [Pose],
    /// For each new particle, its material if it did not exist before.
    pub(crate) materials_of_new: &'a [Option<u8>],
    /// Number of partitions into which work is divided.
    pub(crate) partitions: usize,
}

impl NewNumbers<'_> {
    /// The new number of a particle. None: it is gone.
    pub(crate) fn of(&self, particle: u32) -> Option<u32> {
        Some(self.now[particle as usize]).filter(|now| *now != REMOVED)
    }

    /// By how much the radius of an old particle that is still there has become smaller, m. Contact
    /// spheres of clumps may be larger than those of clusters.
    pub(crate) fn less_m(&self, particle: u32) -> f64 {
        let now = &self.poses[self.now[particle as usize] as usize];
        self.old_radii_m[particle as usize] - now.radius_m()
    }

    /// Whether a new particle did not exist before.
    pub(crate) fn is_new(&self, particle: u32) -> bool {
        self.materials_of_new[particle as usize].is_some()
    }

    /// Renumbers a list, and leaves out what is gone.
    pub(crate) fn renumber(&self, particles: &mut Vec<u32>) {
        particles.retain_mut(|particle| {
            let now = self.of(*particle);
            *particle = now.unwrap_or(REMOVED);
            now.is_some()
        });
    }
}

/// Part of a state that names particles. All of them are listed in `state.rs`.
pub(crate) trait Renumbered {
    /// Takes the new numbers, and forgets particles that are gone.
    fn renumber(&mut self, by: &NewNumbers<'_>);
}

impl<T: Renumbered> Renumbered for Vec<T> {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        self.iter_mut().for_each(|part| part.renumber(by));
    }
}

impl<T: Renumbered> Renumbered for Option<T> {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        self.iter_mut().for_each(|part| part.renumber(by));
    }
}
