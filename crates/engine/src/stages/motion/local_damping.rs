//! Local damping: a fraction of each force on a particle, against its motion (Chen et al. 2022).
//!
//! What nothing holds is damped relative to its own motion as a rigid body, so that it falls and
//! flies as if undamped and keeps its momentum and angular momentum: the forces that act against
//! the relative motion are freed of their resultant, which takes nothing from their power, as the
//! relative motion has no momentum. A piece is held by a support, by a wall that it touches, and by
//! another piece that is held and touches it. What is held is damped in space: a specimen comes to
//! rest between its plates.

use dem_io::disjoint::{find, join};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use crate::stages::chunks::CHUNK;
use crate::stages::stage::{Need, Saving, Stage};
use crate::state::State;
use crate::state::clusters::Clusters;
use crate::state::particles::{Particles, Wrench};
use crate::threads::for_each;

/// ns per particle of a body of 25,547 particles: see doc/inside/leave-out.md.
const PARTICLE_DAMPING_NS: f64 = 37.6;

/// Damping of particles.
pub const PARTICLE_DAMPING: Stage = Stage {
    bytes: |state| size_of_val(&state.scratch.particle_resistance[..]),
    saving: |state| {
        Saving::of(
            state.particles.free,
            size_of::<Wrench>(),
            PARTICLE_DAMPING_NS,
        )
    },
    ..Stage::new("local damping", |state, _| {
        let gamma = state.model.particle_damping;
        Need::of(gamma > 0.0, || format!("gamma {gamma}"), "not asked for")
    })
};

/// Sets the damping forces on particles. Returns the number of particles on which they act.
pub(crate) fn compute_particle_damping(state: &mut State) -> usize {
    if state.scratch.particle_resistance.is_empty() {
        return 0;
    }
    state.scratch.particle_resistance.fill(Wrench::default());
    add_particle_damping(
        &state.particles,
        state.model.gravity_m_s2,
        state.model.particle_damping,
        &mut state.scratch.particle_resistance,
    );
    spare_rigid_motion(state);
    state.particles.free
}

/// Replaces the damping forces on pieces that nothing holds by those relative to their motion as
/// rigid bodies.
fn spare_rigid_motion(state: &mut State) {
    let of_bonds = state.scratch.pieces.take();
    let bonds = || Clusters::new(state.particles.len(), &state.bonds);
    // Without clusters no bond breaks, and nothing touches anything.
    let of_bonds = match &state.clusters {
        Some(_) => None,
        None => Some(of_bonds.unwrap_or_else(bonds)),
    };
    let Some(clusters) = state.clusters.as_ref().or(of_bonds.as_ref()) else {
        return;
    };
    let free = free_pieces(state, clusters);
    let damp = |id: &u32| {
        let members = clusters.members(*id);
        let damped = relative_damping(state, members);
        (*id, damped)
    };
    let damped: Vec<(u32, Vec<Wrench>)> = free.par_iter().map(damp).collect();
    for (id, wrenches) in damped {
        for (&i, wrench) in clusters.members(id).iter().zip(wrenches) {
            state.scratch.particle_resistance[i as usize] = wrench;
        }
    }
    state.scratch.pieces = of_bonds;
}

/// The clusters that nothing holds, without sleeping ones.
fn free_pieces(state: &State, clusters: &Clusters) -> Vec<u32> {
    let id = |i: u32| clusters.of_particle[i as usize];
    let supports = state.supports.iter();
    let supports = supports.filter(|support| state.time_s < support.end_s);
    let supported = supports.flat_map(|support| support.held.iter().map(|held| held.particle));
    let touches = state.walls.iter().flat_map(|wall| &wall.touching);
    let touches = touches.filter(|touch| touch.history.overlap_m() > 0.0);
    let at_walls = touches.map(|touch| touch.particle);
    let mut holds: Vec<u32> = supported.chain(at_walls).map(id).collect();
    holds.sort_unstable();
    holds.dedup();
    // Pieces that touch each other hold each other.
    let mut names: Vec<u32> = (0..clusters.history.len() as u32).collect();
    for [a, b] in touching_pairs(state) {
        join(&mut names, id(a), id(b));
    }
    let mut held = vec![false; names.len()];
    for piece in holds {
        held[find(&mut names, piece) as usize] = true;
    }
    let moves = |id: &u32| {
        let first = clusters.members(*id).first();
        first.is_some_and(|i| !state.particles.sleeps(*i as usize))
    };
    let living = clusters.living().filter(moves);
    living
        .filter(|id| !held[find(&mut names, *id) as usize])
        .collect()
}

/// Pairs of particles that press on each other.
fn touching_pairs(state: &State) -> Vec<[u32; 2]> {
    let Some(contacts) = &state.contacts else {
        return Vec::new();
    };
    let partitions = state.contact_partitions().iter();
    let partitions = partitions.filter(|partition| partition.computed > 0);
    let close = partitions.flat_map(|partition| partition.close.iter().flat_map(|[_, own]| own));
    let touching = close.filter(|at| contacts.histories[**at as usize].overlap_m() > 0.0);
    touching.map(|at| contacts.pairs[*at as usize]).collect()
}

/// Motion of particles as one rigid body, or its change in time: that of the centre of mass, and
/// about it.
struct Rigid {
    centre_m: Vector3<f64>,
    along: Vector3<f64>,
    about: Vector3<f64>,
}

impl Rigid {
    /// Of particles with these momenta and angular momenta about their centres, or with these
    /// forces and torques.
    fn of(
        particles: &Particles,
        members: &[u32],
        each: impl Fn(usize) -> [Vector3<f64>; 2],
    ) -> Self {
        let origin = particles.poses[members[0] as usize].place();
        let (mut mass_kg, mut moment, mut sum) = (0.0, Vector3::zeros(), Vector3::zeros());
        for (n, &i) in members.iter().enumerate() {
            let own_kg = 1.0 / particles.motions[i as usize].inverse_mass;
            mass_kg += own_kg;
            moment += own_kg * (particles.poses[i as usize].place() - origin);
            sum += each(n)[0];
        }
        let centre_m = origin + moment / mass_kg;
        let along = sum / mass_kg;
        let (mut inertia, mut turning) = (Matrix3::zeros(), Vector3::zeros());
        for (n, &i) in members.iter().enumerate() {
            let motion = &particles.motions[i as usize];
            let (own_kg, own_kg_m2) = (1.0 / motion.inverse_mass, 1.0 / motion.inverse_inertia);
            let arm = particles.poses[i as usize].place() - centre_m;
            let [linear, angular] = each(n);
            turning += arm.cross(&(linear - own_kg * along)) + angular;
            inertia += Matrix3::from_diagonal_element(own_kg_m2 + own_kg * arm.norm_squared())
                - own_kg * arm * arm.transpose();
        }
        let solved = inertia.cholesky().map(|c| c.solve(&turning));
        Self {
            centre_m,
            along,
            about: solved.unwrap_or_else(Vector3::zeros),
        }
    }

    fn at(&self, point_m: Vector3<f64>) -> Vector3<f64> {
        self.along + self.about.cross(&(point_m - self.centre_m))
    }
}

/// The damping of the particles of a piece relative to its rigid motion.
fn relative_damping(state: &State, members: &[u32]) -> Vec<Wrench> {
    if members.len() == 1 {
        return vec![Wrench::default()];
    }
    let (p, gamma) = (&state.particles, state.model.particle_damping);
    let three = |[x, y, z, _]: [f64; 4]| Vector3::new(x, y, z);
    let inert = |n: usize| {
        let motion = &p.motions[members[n] as usize];
        [1.0 / motion.inverse_mass, 1.0 / motion.inverse_inertia]
    };
    // Gravity accelerates all alike.
    let driving = |n: usize| {
        let wrench = &p.wrenches[members[n] as usize];
        [three(wrench.force_n), three(wrench.torque_n_m)]
    };
    let moving = |n: usize| {
        let motion = &p.motions[members[n] as usize];
        let [mass_kg, inertia_kg_m2] = inert(n);
        let [velocity, spin] = [motion.velocity_m_s, motion.spin_rad_s].map(Vector3::from);
        [mass_kg * velocity, inertia_kg_m2 * spin]
    };
    let [gains, moves] = [
        Rigid::of(p, members, driving),
        Rigid::of(p, members, moving),
    ];
    let raw: Vec<[Vector3<f64>; 2]> = (0..members.len())
        .map(|n| {
            let place = p.poses[members[n] as usize].place();
            let [mass_kg, inertia_kg_m2] = inert(n);
            let [force, torque] = driving(n);
            let [momentum, angular] = moving(n);
            let force = force - mass_kg * gains.at(place);
            let torque = torque - inertia_kg_m2 * gains.about;
            let velocity = momentum / mass_kg - moves.at(place);
            let spin = angular / inertia_kg_m2 - moves.about;
            [
                force.zip_map(&velocity, |f, v| -gamma * against(f, v)),
                torque.zip_map(&spin, |t, w| -gamma * against(t, w)),
            ]
        })
        .collect();
    let resultant = Rigid::of(p, members, |n| raw[n]);
    let freed = raw.iter().zip(members).enumerate();
    freed
        .map(|(n, ([force, torque], &i))| {
            let [mass_kg, inertia_kg_m2] = inert(n);
            let place = p.poses[i as usize].place();
            let mut wrench = Wrench::default();
            wrench.add(
                &(force - mass_kg * resultant.at(place)),
                &(torque - inertia_kg_m2 * resultant.about),
            );
            wrench
        })
        .collect()
}

/// Adds the resistance of Chen et al. 2022, eqs. 11 and 12, to `resisting`: a fraction `gamma` of
/// each component of force and torque, against the motion. `total` is the driving wrench of each
/// particle, including gravity.
pub fn add_particle_damping(
    particles: &Particles,
    gravity_m_s2: [f64; 3],
    gamma: f64,
    resisting: &mut [Wrench],
) {
    let chunks = resisting[..particles.free].chunks_mut(CHUNK);
    for_each(chunks.enumerate(), |(chunk, resisting)| {
        for (i, resisting) in (chunk * CHUNK..).zip(resisting) {
            let (wrench, motion) = (&particles.wrenches[i], &particles.motions[i]);
            let weight = gravity_m_s2.map(|g| g / motion.inverse_mass);
            for (k, weight) in weight.iter().enumerate() {
                let force = wrench.force_n[k] + weight;
                resisting.force_n[k] -= gamma * against(force, motion.velocity_m_s[k]);
                resisting.torque_n_m[k] -=
                    gamma * against(wrench.torque_n_m[k], motion.spin_rad_s[k]);
            }
        }
    });
}

/// The magnitude of a force with the sign of a velocity; 0 at rest.
fn against(force: f64, velocity: f64) -> f64 {
    if velocity == 0.0 {
        0.0
    } else {
        force.abs().copysign(velocity)
    }
}
