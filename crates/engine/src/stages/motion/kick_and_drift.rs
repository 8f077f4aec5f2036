//! Kick and drift: forces change velocities, velocities change positions.
//!
//! Velocities are those halfway between two steps (leapfrog). This is kick-drift-kick with the
//! second kick of a step merged with the first of the next.

use crate::stages::chunks::{CHUNK, ordered_sum};
use crate::stages::clumps::motion::awake;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::particles::{Motion, Particles, Pose, Wrench};
use crate::state::sleep::mask::Asleep;
use crate::threads::{for_each, largest_of};
use dem_physics::lanes::{LaneWork, Lanes, with_lanes};
use dem_physics::rigid::{room_to_small, turn, turn_a_little};

/// Kick and drift of particles.
pub const MOTION: Stage = Stage {
    bytes: |state| {
        let p = &state.particles;
        size_of_val(&p.poses[..]) + size_of_val(&p.motions[..]) + size_of_val(&p.wrenches[..])
    },
    ..Stage::new("motion", |state, _| {
        Need::Needed(format!("{} particles at the start", state.particles.free))
    })
};

/// Gravity.
pub const GRAVITY: Stage = Stage {
    within: Some(MOTION.name),
    ..Stage::new("gravity", |state, _| {
        let [x, y, z] = state.model.gravity_m_s2;
        Need::of(
            state.model.gravity_m_s2 != [0.0; 3],
            || format!("[{x}, {y}, {z}] m/s2"),
            "no gravity",
        )
    })
};

/// Updates the velocities of particles. Returns the number of particles.
pub(crate) fn kick_particles(state: &mut State) -> usize {
    let kick_s = state.kick_s();
    let mut motions = std::mem::take(&mut state.particles.motions);
    let p = &state.particles;
    let forces = Forces::of(p, state.resistances(), state.model.gravity_m_s2, kick_s);
    let chunks = motions[..p.free].chunks_mut(CHUNK).enumerate();
    for_each(chunks, |(chunk, motions)| {
        for_each_awake(chunk * CHUNK, motions, &p.asleep, |i, motion| {
            forces.kick(i, motion);
        });
    });
    state.particles.motions = motions;
    state.particles.free
}

/// Number of particles and clumps on which gravity acts.
pub(crate) fn count_falling(state: &mut State) -> usize {
    if state.model.gravity_m_s2 == [0.0; 3] {
        return 0;
    }
    state.particles.free + awake(&state.clumps)
}

/// Moves particles.
pub(crate) fn drift_particles(state: &mut State) -> usize {
    let moved_m = &mut state.scratch.chunks_moved_m;
    state.fastest_m_s = drift(&mut state.particles, state.time_step_s, moved_m);
    0
}

/// What changes the velocities of particles over the time `kick_s`.
pub(crate) struct Forces<'a> {
    wrenches: &'a [Wrench],
    /// Each with one for each particle, or empty.
    resisting: [&'a [Wrench]; 2],
    gravity_m_s2: [f64; 3],
    kick_s: f64,
}

impl<'a> Forces<'a> {
    /// All forces on particles, with these resisting ones: see [`State::resistances`].
    pub(crate) fn of(
        particles: &'a Particles,
        resisting: [&'a [Wrench]; 2],
        gravity_m_s2: [f64; 3],
        kick_s: f64,
    ) -> Self {
        Self {
            wrenches: &particles.wrenches,
            resisting,
            gravity_m_s2,
            kick_s,
        }
    }
}

impl Forces<'_> {
    /// Changes the velocities of particle `i`, which have been these.
    #[inline(always)]
    pub(crate) fn kick(&self, i: usize, motion: &mut Motion) {
        let per_mass = self.kick_s * motion.inverse_mass;
        let per_inertia = self.kick_s * motion.inverse_inertia;
        let wrench = &self.wrenches[i];
        for k in 0..3 {
            let fall = self.kick_s * self.gravity_m_s2[k];
            motion.velocity_m_s[k] += per_mass * wrench.force_n[k] + fall;
            motion.spin_rad_s[k] += per_inertia * wrench.torque_n_m[k];
        }
        for wrench in self.resisting.iter().filter_map(|list| list.get(i)) {
            for k in 0..3 {
                motion.velocity_m_s[k] += per_mass * wrench.force_n[k];
                motion.spin_rad_s[k] += per_inertia * wrench.torque_n_m[k];
            }
        }
    }
}

/// Changes those of a chunk, from number `first` on, that are awake.
#[inline(always)]
pub(crate) fn for_each_awake<T>(
    first: usize,
    some: &mut [T],
    asleep: &Asleep,
    mut change: impl FnMut(usize, &mut T),
) {
    debug_assert!(
        first.is_multiple_of(CHUNK) && some.len() <= CHUNK,
        "one chunk"
    );
    if asleep.is_whole(first / CHUNK) {
        return;
    }
    // As a slice, so that its place is not read again for each particle.
    let asleep: &[bool] = asleep;
    for (i, one) in (first..).zip(some) {
        if !asleep.get(i).is_some_and(|asleep| *asleep) {
            change(i, one);
        }
    }
}

/// Updates positions and orientations of the free particles over `time_step_s`. Returns the largest
/// speed of a particle, m/s, and sets for each chunk how far its fastest particle moved, m.
pub fn drift(particles: &mut Particles, time_step_s: f64, chunks_moved_m: &mut Vec<f64>) -> f64 {
    chunks_moved_m.resize(particles.free.div_ceil(CHUNK), 0.0);
    let Particles {
        poses,
        motions,
        asleep,
        ..
    } = particles;
    let chunks = poses[..particles.free].chunks_mut(CHUNK);
    let chunks = chunks.zip(chunks_moved_m).enumerate();
    largest_of(chunks, |(chunk, (poses, moved_m))| {
        let own = chunk * CHUNK..chunk * CHUNK + poses.len();
        if asleep.is_whole(chunk) {
            *moved_m = 0.0;
            return 0.0;
        }
        let mut fastest = 0.0;
        with_lanes(DriftWork {
            poses,
            motions: &motions[own.clone()],
            asleep: asleep.get(own).unwrap_or_default(),
            time_step_s,
            fastest: &mut fastest,
        });
        let fastest = fastest.sqrt();
        *moved_m = fastest * time_step_s;
        fastest
    })
}

/// The drift of some particles.
struct DriftWork<'a> {
    poses: &'a mut [Pose],
    motions: &'a [Motion],
    /// Empty: no particle sleeps.
    asleep: &'a [bool],
    time_step_s: f64,
    /// Square of their largest speed, m2/s2.
    fastest: &'a mut f64,
}

impl LaneWork for DriftWork<'_> {
    #[inline(always)]
    fn with<T: Lanes>(self, proof: T::Proof) {
        let mut fastest = T::all(proof, 0.0);
        let count = T::COUNT;
        for (n, (poses, motions)) in (self.poses.chunks_mut(count))
            .zip(self.motions.chunks(count))
            .enumerate()
        {
            let first = n * count;
            let asleep = self.asleep.get(first..first + poses.len());
            let awake = asleep.is_none_or(|asleep| !asleep.contains(&true));
            if poses.len() == count
                && awake
                && let Some(square) = move_on::<T>(proof, poses, motions, self.time_step_s)
            {
                fastest = square.maximum(fastest);
                continue;
            }
            for (i, (pose, motion)) in (first..).zip(poses.iter_mut().zip(motions)) {
                if !self.asleep.get(i).is_some_and(|asleep| *asleep) {
                    *self.fastest = self.fastest.max(move_one(pose, motion, self.time_step_s));
                }
            }
        }
        for square in fastest.values() {
            *self.fastest = self.fastest.max(square);
        }
    }
}

/// Moves a particle, and returns the square of its speed, m2/s2.
fn move_one(pose: &mut Pose, motion: &Motion, time_step_s: f64) -> f64 {
    let mut square = 0.0;
    for k in 0..3 {
        pose.position_m[k] += time_step_s * motion.velocity_m_s[k];
        square += motion.velocity_m_s[k] * motion.velocity_m_s[k];
    }
    let about = motion.spin_rad_s.map(|spin| spin * time_step_s);
    pose.turned = turn(pose.turned, about);
    square
}

/// Moves as many particles as there are lanes. None: one of them turns by more than a small angle,
/// and nothing is moved.
#[inline(always)]
fn move_on<T: Lanes>(
    proof: T::Proof,
    poses: &mut [Pose],
    motions: &[Motion],
    time_step_s: f64,
) -> Option<T> {
    let [vx, vy, vz, _] = T::columns(proof, |lane| motions[lane].velocity_row());
    let [wx, wy, wz, _] = T::columns(proof, |lane| motions[lane].spin_row());
    let about = [
        wx.scale(time_step_s),
        wy.scale(time_step_s),
        wz.scale(time_step_s),
    ];
    let room = room_to_small(about);
    if room.above(room.zero()).count_ones() < T::COUNT as u32 {
        return None;
    }
    let [x, y, z, radius_m] = T::columns(proof, |lane| poses[lane].position_m);
    let turned = turn_a_little(T::columns(proof, |lane| poses[lane].turned), about);
    let places = T::rows([
        x + vx.scale(time_step_s),
        y + vy.scale(time_step_s),
        z + vz.scale(time_step_s),
        radius_m,
    ]);
    let turned = T::rows(turned);
    for (lane, pose) in poses.iter_mut().enumerate() {
        pose.position_m = places[lane];
        pose.turned = turned[lane];
    }
    Some(vx * vx + vy * vy + vz * vz)
}

/// Power of wrenches on moving particles, W. The order of summation is the same for any number of
/// threads.
pub fn power_w(wrenches: &[Wrench], particles: &Particles) -> f64 {
    ordered_sum(wrenches.len(), |i| {
        if particles.sleeps(i) {
            return 0.0;
        }
        particles.motions[i].power_w(&wrenches[i])
    })
}
