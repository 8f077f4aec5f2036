//! Contact forces between particles.

mod beside;
mod close;
mod input;
mod kernel;
mod stored;

pub(crate) use self::beside::list_within;
pub(crate) use self::stored::pairs_adhesion_j;
pub use self::stored::{
    contact_energy_j, elastic_energy_j, lost_j, overlap_m, pair_force_n, touch_point_m,
};

pub(in crate::stages) use self::stored::{StoredEnergy, StoredForce};

use self::beside::hold_origins;
use self::close::close_m;
use self::input::StepInput;
use self::kernel::{PartitionOutput, for_each};
use crate::stages::bonds::blocks::{rows, vectors};
use crate::stages::bonds::forces::any_bond;
use crate::stages::search::neighbours::near_pairs;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::contacts::{ContactHistory, Contacts};
use crate::state::particles::{Motion, Particles, Pose, Wrench};
use dem_physics::contact::assembly::{StoredContact, assemble};
use dem_physics::contact::kinematics::{ContactSphere, contact_kinematics};
use dem_physics::contact::law::Rolling;
use dem_physics::contact::rolling::RollingFriction;
use dem_physics::contact::{ContactSprings, Damped, NormalLaw};
use dem_physics::lanes::{Lanes, MOST};
use dem_physics::number::Vec3;

/// Contacts between particles.
pub const CONTACTS: Stage = Stage {
    bytes: |state| {
        state.contacts.as_ref().map_or(0, |c| {
            let of_partitions = c.scratch.partitions.iter().map(|partition| {
                size_of_val(&partition.border[..])
                    + size_of_val(&partition.border_histories[..])
                    + partition.was_close.len()
            });
            size_of_val(&c.histories[..])
                + size_of_val(&c.scratch.former_histories[..])
                + of_partitions.sum::<usize>()
        })
    },
    ..Stage::new("particle contacts", |state, scene| {
        let pieces = state.clusters.as_ref().map_or(0, |c| c.living().count());
        let why_not = if state.contacts.is_some() {
            "there is one body, and no bond can break"
        } else if can_break(state) || pieces > 1 || scene.bodies.len() > 1 {
            "the scene has no [contacts]: bodies and pieces pass through each other"
        } else {
            "nothing can touch"
        };
        Need::of(
            can_meet(state),
            || {
                let s = if pieces == 1 { "" } else { "s" };
                format!("{pieces} piece{s} at the start")
            },
            why_not,
        )
    })
};

/// Overlaps of fragments as they separate.
pub const RELAXATION: Stage = Stage {
    within: Some(CONTACTS.name),
    ..Stage::new("relaxation", |state, scene| {
        let relaxes = state
            .contacts
            .as_ref()
            .is_some_and(|contacts| contacts.model.relaxes);
        let why_not = if scene.relaxation.enabled {
            "no pieces part"
        } else {
            "switched off: pieces that part overlapping fly apart"
        };
        Need::of(
            can_meet(state) && relaxes && can_break(state),
            || "overlaps of pieces that part are where their contact begins".to_owned(),
            why_not,
        )
    })
};

/// Rolling friction of contacts.
pub const ROLLING: Stage = Stage {
    within: Some(CONTACTS.name),
    ..Stage::new("rolling friction", |state, scene| {
        let mut contacts = scene.contacts.iter();
        let rolls = contacts.any(|c| c.rolling != Rolling::Free);
        Need::of(
            state.contacts.is_some() && rolls,
            || "materials have it".to_owned(),
            "no materials have it",
        )
    })
};

/// Whether particles of different pieces can touch each other.
fn can_meet(state: &State) -> bool {
    state
        .contacts
        .as_ref()
        .is_some_and(|contacts| !contacts.model.alone)
}

fn can_break(state: &State) -> bool {
    state.model.rules.make_daughters() || any_bond(state, |rule| rule.criteria.is_some())
}

/// Adds the contact forces between particles to the wrenches. Returns the number of pairs in
/// contact.
pub(crate) fn compute_contacts(state: &mut State) -> usize {
    match &mut state.contacts {
        Some(contacts) if !contacts.model.alone => {
            hold_origins(contacts, &state.bonds);
            contact_wrenches(contacts, &mut state.particles, state.previous_time_step_s);
            contacts
                .scratch
                .partitions
                .iter()
                .map(|partition| partition.computed)
                .sum()
        }
        _ => 0,
    }
}

/// Number of pairs listed in this step whose law begins at an overlap.
pub(crate) fn count_relaxing(state: &mut State) -> usize {
    state.scratch.events.work.relaxing
}

/// Number of touching contacts with rolling friction.
pub(crate) fn count_rolling(state: &mut State) -> usize {
    let partitions = state
        .contacts
        .iter()
        .flat_map(|contacts| &contacts.scratch.partitions);
    partitions.map(|partition| partition.rolled).sum()
}

/// Adds the contact forces to the wrenches, records the energy lost to friction and damping, and
/// updates the contact histories, after a step of `dt`, s, in which the particles moved with their
/// present velocities.
pub fn contact_wrenches(contacts: &mut Contacts, particles: &mut Particles, dt: f64) {
    let checks_all = contacts.scratch.close_skin_left_m <= 0.0;
    if checks_all {
        contacts.scratch.close_m = close_m(contacts);
        contacts.scratch.close_skin_left_m = 0.45 * contacts.scratch.close_m;
    }
    let mut partitions = std::mem::take(&mut contacts.scratch.partitions);
    let mut histories = std::mem::take(&mut contacts.histories);
    let mut lost_j = std::mem::take(&mut contacts.lost_j);
    for partition in &mut partitions {
        partition.excessive_overlap = None;
        // Partitions update their own histories while others still need the previous ones.
        if checks_all {
            let remembered = partition.border.iter().map(|&at| histories[at as usize]);
            partition.border_histories.clear();
            partition.border_histories.extend(remembered);
        } else {
            for n in partition.close.iter().flat_map(|[of_border, _]| of_border) {
                let n = *n as usize;
                partition.border_histories[n] = histories[partition.border[n] as usize];
            }
        }
    }
    let (known, p) = (&*contacts, &mut *particles);
    let scene = StepInput {
        contacts: known,
        poses: &p.poses,
        motions: &p.motions,
        checks_all,
        dt,
    };
    let books = PartitionOutput {
        histories: &mut histories,
        wrenches: &mut p.wrenches,
        lost_j: &mut lost_j,
    };
    for_each(&mut partitions, books, &scene);
    contacts.scratch.excessive_overlap = partitions
        .iter()
        .filter_map(|partition| partition.excessive_overlap)
        .min();
    contacts.scratch.partitions = partitions;
    contacts.histories = histories;
    contacts.lost_j = lost_j;
}

/// Searches again for near pairs, with surfaces closer than `skin_m`. `clusters`: a number for each
/// particle; particles with the same number do not touch each other.
pub fn list_contacts(
    contacts: &mut Contacts,
    clusters: &[u32],
    particles: &Particles,
    skin_m: f64,
) {
    find_mean_radius(contacts, particles, 0);
    let pairs = near_pairs(&particles.poses, clusters, skin_m);
    let poses = &particles.poses;
    let relaxes = contacts.model.relaxes;
    contacts.relist(pairs, particles.len(), |pair| {
        if relaxes { overlap_m(poses, pair) } else { 0.0 }
    });
    contacts.skin_left_m = 0.5 * skin_m;
}

/// Finds the mean radius of the particles. The sum of the first `known` is the one that was found
/// last.
pub(crate) fn find_mean_radius(contacts: &mut Contacts, particles: &Particles, known: usize) {
    let radii_m = &mut contacts.scratch.radii_m;
    if known == 0 {
        *radii_m = 0.0;
    }
    let new = particles.poses[known..].iter().map(Pose::radius_m);
    *radii_m = new.fold(*radii_m, |sum, radius_m| sum + radius_m);
    contacts.scratch.mean_radius_m = *radii_m / particles.len().max(1) as f64;
}

/// Replaces the list of pairs, and divides the work anew.
pub(crate) fn relist(contacts: &mut Contacts, pairs: Vec<[u32; 2]>, state: &State) {
    let poses = &state.particles.poses;
    let relaxes = contacts.model.relaxes;
    let clusters = state.clusters.as_ref();
    if let Some(clusters) = clusters {
        contacts.islands.join_pairs(pairs.iter().copied(), clusters);
    }
    let has_origin = |pair| relaxes || clusters.is_some_and(|clusters| clusters.is_within(pair));
    contacts.relist(pairs, poses.len(), |pair| {
        let overlap_m = overlap_m(poses, pair);
        if overlap_m > 0.0 && has_origin(pair) {
            overlap_m
        } else {
            0.0
        }
    });
}

/// Result for contacts, row by row.
struct ContactOutput {
    tangential: [[f64; 4]; MOST],
    damped: [[f64; 4]; MOST],
    /// Spring and damping of rolling. None: no rolling friction.
    rolled: Option<[[[f64; 4]; MOST]; 2]>,
    friction_j: [f64; MOST],
    damping_j: [f64; MOST],
    forces: Forces,
    /// A bit for each contact, lowest first: whether the two overlap, or did in the previous step.
    touched: u8,
    /// The same: whether the two overlap by more than the radius of the smaller one.
    excessive_overlap: u8,
}

/// Forces on the second ends of contacts and torques on both ends, row by row: x, y, z and an
/// unused fourth number.
struct Forces {
    on_b: [[f64; 4]; MOST],
    torques: [[[f64; 4]; MOST]; 2],
}

impl Forces {
    #[inline(always)]
    fn new<T: Lanes>(force_on_b: Vec3<T>, torques: [Vec3<T>; 2]) -> Self {
        Self {
            on_b: rows(force_on_b),
            torques: [rows(torques[0]), rows(torques[1])],
        }
    }

    #[inline(always)]
    fn add_to_a(&self, lane: usize, wrench: &mut Wrench) {
        for k in 0..4 {
            wrench.force_n[k] -= self.on_b[lane][k];
            wrench.torque_n_m[k] += self.torques[0][lane][k];
        }
    }

    #[inline(always)]
    fn add_to_b(&self, lane: usize, wrench: &mut Wrench) {
        for k in 0..4 {
            wrench.force_n[k] += self.on_b[lane][k];
            wrench.torque_n_m[k] += self.torques[1][lane][k];
        }
    }
}

impl StepInput<'_> {
    /// Contact forces on the particles, one contact for each lane.
    #[inline(always)]
    fn meet<'a, T: Lanes, L: NormalLaw<T>, R: RollingFriction<T>>(
        &self,
        proof: T::Proof,
        law: &L,
        rolling: &R,
        pair: impl Fn(usize) -> [u32; 2],
        history: impl Fn(usize) -> &'a ContactHistory,
    ) -> ContactOutput {
        let particles = (self.poses, self.motions);
        let (place_a, a) = contact_sphere::<T>(proof, particles, |lane| pair(lane)[0] as usize);
        let (place_b, b) = contact_sphere::<T>(proof, particles, |lane| pair(lane)[1] as usize);
        let before = stored_contact::<T, R>(proof, history);
        let touch = contact_kinematics(place_b - place_a, [a, b], self.dt);
        let (overlap_m, origin_m) = (before.springs.overlap_m, before.origin_m);
        let nothing = overlap_m.zero();
        let mut touched =
            touch.overlap_m.above(nothing) | overlap_m.above(nothing) | origin_m.above(nothing);
        if L::ATTRACTS {
            // A jump of the attraction is to be counted back.
            touched |= before.damped.force_n.square().above(nothing);
        }
        let least_overlap = self.contacts.model.least_overlap;
        let met = assemble(law, rolling, &touch, &before, least_overlap, self.dt);
        let StoredContact {
            springs,
            damped,
            origin_m,
        } = met.remembered;
        let Vec3(sx, sy, sz) = springs.tangential_m;
        let Vec3(dx, dy, dz) = damped.force_n;
        ContactOutput {
            touched,
            excessive_overlap: met.overlap_m.above(a.radius_m.minimum(b.radius_m)),
            tangential: T::rows([sx, sy, sz, springs.overlap_m]),
            damped: T::rows([dx, dy, dz, origin_m]),
            rolled: R::REMEMBERS.then(|| [rows(springs.rolling_rad), rows(damped.moment_n_m)]),
            friction_j: met.friction_j.values(),
            damping_j: met.damping_j.values(),
            forces: Forces::new(met.response.force_on_b, met.torques),
        }
    }
}

/// One history for each lane.
#[inline(always)]
pub(crate) fn stored_contact<'a, T: Lanes, R: RollingFriction<T>>(
    proof: T::Proof,
    history: impl Fn(usize) -> &'a ContactHistory,
) -> StoredContact<T> {
    let [sx, sy, sz, overlap_m] = T::columns(proof, |lane| history(lane).tangential);
    let [dx, dy, dz, origin_m] = T::columns(proof, |lane| history(lane).damping);
    let nothing = overlap_m.zero();
    let none = Vec3(nothing, nothing, nothing);
    let (rolling_rad, moment_n_m) = if R::REMEMBERS {
        (
            vectors(proof, |lane| history(lane).rolling),
            vectors(proof, |lane| history(lane).rolling_damping),
        )
    } else {
        (none, none)
    };
    StoredContact {
        springs: ContactSprings {
            tangential_m: Vec3(sx, sy, sz),
            rolling_rad,
            overlap_m,
        },
        damped: Damped {
            force_n: Vec3(dx, dy, dz),
            moment_n_m,
        },
        origin_m,
    }
}

/// One particle for each lane, and its centre, m.
#[inline(always)]
pub(crate) fn contact_sphere<T: Lanes>(
    proof: T::Proof,
    (poses, motions): (&[Pose], &[Motion]),
    particle: impl Fn(usize) -> usize,
) -> (Vec3<T>, ContactSphere<T>) {
    let [x, y, z, radius_m] = T::columns(proof, |lane| poses[particle(lane)].position_m);
    let [vx, vy, vz, inverse_mass] =
        T::columns(proof, |lane| motions[particle(lane)].velocity_row());
    let [wx, wy, wz, inverse_inertia] =
        T::columns(proof, |lane| motions[particle(lane)].spin_row());
    let ball = ContactSphere {
        velocity_m_s: Vec3(vx, vy, vz),
        spin_rad_s: Vec3(wx, wy, wz),
        radius_m,
        inverse_mass_per_kg: inverse_mass,
        inverse_inertia_per_kg_m2: inverse_inertia,
    };
    (Vec3(x, y, z), ball)
}
