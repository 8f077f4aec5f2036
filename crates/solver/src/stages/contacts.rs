//! Forces of contacts between particles.

use std::ops::Range;

use crate::physics::contact::hertz_mindlin::HertzMindlin;
use crate::physics::contact::linear::Linear;
use crate::physics::contact::manner::Manner;
use crate::physics::contact::relaxation::relaxed;
use crate::physics::contact::rolling::{
    ConstantMoment, ElasticPlastic, NoRolling, RollingFriction,
};
use crate::physics::contact::touch::{Ball, torques, touch};
use crate::physics::contact::{History, NormalLaw, Response, response};
use crate::physics::number::Triple;
use crate::stages::blocks::{Four, fetch_soon, ways};
use crate::stages::lanes::{FOUR, LaneWork, Lanes, with_lanes};
use crate::stages::motion::ordered_sum;
use crate::stages::neighbours::near_pairs;
use crate::state::contacts::{ContactShare, Contacts, Law, Memory, Rolling};
use crate::state::particles::{Motion, Particles, Pose, Wrench};

/// Contacts between those that are looked at and those whose second particles are fetched into the cache.
const AHEAD: usize = 32;
/// The same for contacts that touch.
const SOON: usize = 32;

/// Adds the elastic and frictional forces of contacts to the wrenches, sets their resistance to the damping forces, books what friction took, and
/// takes down what each contact remembers: after a step of `dt`, s, in which the particles moved as their motions say.
pub fn contact_wrenches(contacts: &mut Contacts, particles: &mut Particles, dt: f64) {
    let mut shares = std::mem::take(&mut contacts.shares);
    let mut memories = std::mem::take(&mut contacts.memories);
    let mut resistance = std::mem::take(&mut contacts.resistance);
    let mut lost_j = std::mem::take(&mut contacts.lost_j);
    for share in &mut shares {
        // Their owners take down what comes next while others still need what was.
        let remembered = share.border.iter().map(|&at| memories[at as usize]);
        share.border_memories.clear();
        share.border_memories.extend(remembered);
    }
    let (known, p) = (&*contacts, &mut *particles);
    let scene = Scene {
        contacts: known,
        poses: &p.poses,
        motions: &p.motions,
        dt,
    };
    let books = Books {
        memories: &mut memories,
        wrenches: &mut p.wrenches,
        resistance: &mut resistance,
        lost_j: &mut lost_j,
    };
    for_each(&mut shares, books, &scene);
    contacts.shares = shares;
    contacts.memories = memories;
    contacts.resistance = resistance;
    contacts.lost_j = lost_j;
}

/// Looks for near pairs again. `clusters`: one for each particle; those of one cluster do not touch each other.
pub fn list_contacts(contacts: &mut Contacts, clusters: &[u32], particles: &Particles) {
    let poses = &particles.poses;
    let pairs = near_pairs(poses, clusters, contacts.skin_m);
    let relaxes = contacts.relaxes;
    contacts.relist(
        pairs,
        |pair| {
            if relaxes { overlap_m(poses, pair) } else { 0.0 }
        },
    );
    contacts.divide(particles.len(), contacts.shares.len().max(1));
    contacts.room_m = 0.5 * contacts.skin_m;
}

/// Overlap of two particles, m; below 0 where they are apart.
pub fn overlap_m(poses: &[Pose], pair: [u32; 2]) -> f64 {
    let [a, b] = pair.map(|i| &poses[i as usize]);
    a.radius_m() + b.radius_m() - (b.place() - a.place()).norm()
}

/// Elastic energy of all contacts, J.
pub fn elastic_energy_j(contacts: &Contacts, particles: &Particles) -> f64 {
    ordered_sum(contacts.pairs.len(), |at| {
        contact_energy_j(contacts, particles, at)
    })
}

/// Elastic energy of contact `at`, J.
pub fn contact_energy_j(contacts: &Contacts, particles: &Particles, at: usize) -> f64 {
    if contacts.memories[at] == Memory::default() {
        return 0.0;
    }
    let kind = &contacts.kinds[contacts.kind(contacts.pairs[at])];
    match &kind.law {
        Law::HertzMindlin(law) => stored_j(contacts, particles, at, law, &kind.rolling),
        Law::Linear(law) => stored_j(contacts, particles, at, law, &kind.rolling),
    }
}

/// Elastic energy of a contact as it was taken down, J.
fn stored_j(
    contacts: &Contacts,
    particles: &Particles,
    at: usize,
    law: &impl NormalLaw<f64>,
    rolling: &Rolling,
) -> f64 {
    let ends = contacts.pairs[at].map(|end| end as usize);
    let memory = &contacts.memories[at];
    let still = |i: usize| Ball {
        velocity_m_s: Triple(0.0, 0.0, 0.0),
        spin_rad_s: Triple(0.0, 0.0, 0.0),
        radius_m: particles.poses[i].radius_m(),
        inverse_mass_per_kg: particles.motions[i].inverse_mass,
        inverse_inertia_per_kg_m2: particles.motions[i].inverse_inertia,
    };
    let [a, b] = ends.map(|i| particles.poses[i].place());
    let apart = b - a;
    let mut touch = touch(Triple(apart.x, apart.y, apart.z), ends.map(still), 0.0);
    touch.overlap_m = memory.slid[3];
    let grip = law.grip(&touch, touch.overlap_m);
    let stiffness = match rolling {
        Rolling::Free => 0.0,
        Rolling::Constant(rolling) => rolling.linearised(&grip, &touch)[0],
        Rolling::Spring(rolling) => rolling.linearised(&grip, &touch)[0],
    };
    let square = |[x, y, z, _]: [f64; 4]| x * x + y * y + z * z;
    grip.energy_j
        + 0.5 * grip.tangential_n_m[1] * square(memory.slid)
        + 0.5 * stiffness * square(memory.rolled)
}

/// Energy that friction took so far, J.
pub fn friction_j(contacts: &Contacts) -> f64 {
    ordered_sum(contacts.lost_j.len(), |i| {
        contacts.lost_j[i][0] + contacts.lost_j[i][1]
    })
}

/// What all shares look at.
struct Scene<'a> {
    contacts: &'a Contacts,
    poses: &'a [Pose],
    motions: &'a [Motion],
    dt: f64,
}

/// What a share writes: memories of its own contacts, the rest of its own particles.
struct Books<'a> {
    memories: &'a mut [Memory],
    wrenches: &'a mut [Wrench],
    resistance: &'a mut [Wrench],
    lost_j: &'a mut [[f64; 2]],
}

impl<'a> Books<'a> {
    fn split(self, contacts: usize, particles: usize) -> [Self; 2] {
        let (memories, other_memories) = self.memories.split_at_mut(contacts);
        let (wrenches, other_wrenches) = self.wrenches.split_at_mut(particles);
        let (resistance, other_resistance) = self.resistance.split_at_mut(particles);
        let (lost_j, other_lost_j) = self.lost_j.split_at_mut(particles);
        [
            Self {
                memories,
                wrenches,
                resistance,
                lost_j,
            },
            Self {
                memories: other_memories,
                wrenches: other_wrenches,
                resistance: other_resistance,
                lost_j: other_lost_j,
            },
        ]
    }
}

/// Works on all shares, on as many threads as there are.
fn for_each(shares: &mut [ContactShare], books: Books<'_>, scene: &Scene<'_>) {
    match shares {
        [] => {}
        [share] => with_lanes(ShareWork {
            share,
            books,
            scene,
        }),
        _ => {
            let (left, right) = shares.split_at_mut(shares.len() / 2);
            let [of_left, of_right] = books.split(
                right[0].own.start - left[0].own.start,
                right[0].particles.start - left[0].particles.start,
            );
            rayon::join(
                || for_each(left, of_left, scene),
                || for_each(right, of_right, scene),
            );
        }
    }
}

/// The work on one share.
struct ShareWork<'a> {
    share: &'a mut ContactShare,
    books: Books<'a>,
    scene: &'a Scene<'a>,
}

impl LaneWork for ShareWork<'_> {
    #[inline(always)]
    fn with<T: Lanes>(mut self, proof: T::Proof) {
        self.books.resistance.fill(Wrench::default());
        find_touching(self.share, &mut self.books, self.scene);
        for kind in 0..self.scene.contacts.kinds.len() {
            let contact = &self.scene.contacts.kinds[kind];
            match &contact.law {
                Law::HertzMindlin(law) => {
                    let law = HertzMindlin {
                        young_modulus_pa: T::all(proof, law.young_modulus_pa),
                        shear_modulus_pa: T::all(proof, law.shear_modulus_pa),
                        manner: manner(proof, &law.manner),
                    };
                    self.with_law::<T>(proof, kind, &law, &contact.rolling);
                }
                Law::Linear(law) => {
                    let law = Linear {
                        normal_n_m: T::all(proof, law.normal_n_m),
                        tangential_n_m: T::all(proof, law.tangential_n_m),
                        manner: manner(proof, &law.manner),
                    };
                    self.with_law::<T>(proof, kind, &law, &contact.rolling);
                }
            }
        }
    }
}

#[inline(always)]
fn manner<T: Lanes>(proof: T::Proof, manner: &Manner) -> Manner<T> {
    Manner {
        damping_ratio: T::all(proof, manner.damping_ratio),
        tangential_damping_ratio: T::all(proof, manner.tangential_damping_ratio),
        friction: T::all(proof, manner.friction),
        least_n: T::all(proof, manner.least_n),
        kept: [T::all(proof, manner.kept[0]), T::all(proof, manner.kept[1])],
    }
}

/// Lists the contacts that touch; those that do not forget.
#[inline(always)]
fn find_touching(share: &mut ContactShare, books: &mut Books<'_>, scene: &Scene<'_>) {
    let (contacts, poses) = (scene.contacts, scene.poses);
    for lists in &mut share.touching {
        lists[0].clear();
        lists[1].clear();
    }
    let overlaps = |[a, b]: [u32; 2]| {
        let (a, b) = (&poses[a as usize], &poses[b as usize]);
        let reach = a.radius_m() + b.radius_m();
        (b.place() - a.place()).norm_squared() < reach * reach
    };
    for (n, &at) in (0..).zip(&share.border) {
        let pair = contacts.pairs[at as usize];
        if overlaps(pair) {
            share.touching[contacts.kind(pair)][0].push(n);
        }
    }
    for at in share.own.clone() {
        if let Some(&[_, soon]) = contacts.pairs.get(at + AHEAD) {
            fetch_soon(&poses[soon as usize]);
        }
        let pair = contacts.pairs[at];
        let memory = &mut books.memories[at - share.own.start];
        if overlaps(pair) {
            share.touching[contacts.kind(pair)][1].push(at as u32);
        } else if *memory != Memory::default() {
            *memory = Memory::default();
        }
    }
}

impl ShareWork<'_> {
    #[inline(always)]
    fn with_law<T: Lanes>(
        &mut self,
        proof: T::Proof,
        kind: usize,
        law: &impl NormalLaw<T>,
        rolling: &Rolling,
    ) {
        match rolling {
            Rolling::Free => self.of_kind::<T>(proof, kind, law, &NoRolling),
            Rolling::Constant(rolling) => {
                let friction = T::all(proof, rolling.friction);
                self.of_kind::<T>(proof, kind, law, &ConstantMoment { friction });
            }
            Rolling::Spring(rolling) => {
                let rolling = ElasticPlastic {
                    friction: T::all(proof, rolling.friction),
                    damping_ratio: T::all(proof, rolling.damping_ratio),
                };
                self.of_kind::<T>(proof, kind, law, &rolling);
            }
        }
    }

    /// The contacts of one kind: those of the border first, so that each particle meets its contacts in their order.
    #[inline(always)]
    fn of_kind<T: Lanes>(
        &mut self,
        proof: T::Proof,
        kind: usize,
        law: &impl NormalLaw<T>,
        rolling: &impl RollingFriction<T>,
    ) {
        let Self {
            share,
            books,
            scene,
        } = self;
        let pairs = &scene.contacts.pairs;
        let particles = &share.particles;
        let [of_border, own] = &share.touching[kind];
        for some in of_border.chunks(FOUR) {
            let of_four = |i: usize| some[i.min(some.len() - 1)] as usize;
            let numbers = [0, 1, 2, 3].map(|i| share.border[of_four(i)] as usize);
            let memories = [0, 1, 2, 3].map(|i| share.border_memories[of_four(i)]);
            let four = Four::new(numbers, pairs, 0..some.len());
            for first in (0..FOUR).step_by(T::COUNT) {
                let _ = scene.meet::<T>(
                    proof, law, rolling, &four, first, &memories, books, particles,
                );
            }
        }
        for (n, some) in own.chunks(FOUR).enumerate() {
            let soon = n * FOUR + SOON;
            for &at in own.get(soon..soon + FOUR).unwrap_or_default() {
                let b = pairs[at as usize][1] as usize;
                fetch_soon(&scene.motions[b]);
                fetch_soon(&books.memories[at as usize - share.own.start]);
                if particles.contains(&b) {
                    fetch_soon(&books.wrenches[b - particles.start]);
                    fetch_soon(&books.resistance[b - particles.start]);
                }
            }
            let of_four = |i: usize| some[i.min(some.len() - 1)] as usize;
            let numbers = [0, 1, 2, 3].map(of_four);
            let memories = numbers.map(|at| books.memories[at - share.own.start]);
            let four = Four::new(numbers, pairs, 0..some.len());
            for first in (0..FOUR).step_by(T::COUNT) {
                let taken = scene.meet::<T>(
                    proof, law, rolling, &four, first, &memories, books, particles,
                );
                for lane in 0..T::COUNT.min(some.len().saturating_sub(first)) {
                    let at = numbers[first + lane];
                    books.memories[at - share.own.start] = taken.memories[lane];
                    let a = pairs[at][0] as usize - particles.start;
                    books.lost_j[a][0] += taken.sliding_j[lane];
                    books.lost_j[a][1] += taken.rolling_j[lane];
                }
            }
        }
    }
}

/// What is taken down of contacts, lane by lane.
struct Taken {
    memories: [Memory; FOUR],
    sliding_j: [f64; FOUR],
    rolling_j: [f64; FOUR],
}

impl Scene<'_> {
    /// Adds what the contacts from `first` on, one for each lane, do to those of their particles that are in the share.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "the inside of two loops")]
    fn meet<T: Lanes>(
        &self,
        proof: T::Proof,
        law: &impl NormalLaw<T>,
        rolling: &impl RollingFriction<T>,
        four: &Four,
        first: usize,
        memories: &[Memory; FOUR],
        books: &mut Books<'_>,
        particles: &Range<usize>,
    ) -> Taken {
        let ends = &four.ends[first..first + T::COUNT];
        let balls = [
            self.ball::<T>(proof, |lane| ends[lane][0] as usize),
            self.ball::<T>(proof, |lane| ends[lane][1] as usize),
        ];
        let [sx, sy, sz, overlap_m] = T::columns(proof, |lane| memories[first + lane].slid);
        let [rx, ry, rz, origin_m] = T::columns(proof, |lane| memories[first + lane].rolled);
        let mut touch = touch(ways(proof, ends, self.poses), balls, self.dt);
        let least_m = touch.radius_m.times(self.contacts.least_overlap);
        let relaxed = relaxed(touch.overlap_m, origin_m, least_m);
        touch.overlap_m = relaxed.overlap_m;
        let history = History {
            tangential_m: Triple(sx, sy, sz),
            rolling_rad: Triple(rx, ry, rz),
            overlap_m,
        };
        let Response {
            history,
            force_on_b,
            moment_on_b,
            lost,
            damping,
            ..
        } = response(law, rolling, &touch, &history, self.dt);

        let damping_on_b = damping.normal_n + damping.tangential_n;
        let damped = torques(&touch, damping_on_b, damping.rolling_n_m);
        let held_on_b = force_on_b - damping_on_b;
        let held = torques(&touch, held_on_b, moment_on_b - damping.rolling_n_m);
        four.add(first, held_on_b, held, books.wrenches, particles);
        four.add(first, damping_on_b, damped, books.resistance, particles);

        let Triple(sx, sy, sz) = history.tangential_m;
        let Triple(rx, ry, rz) = history.rolling_rad;
        let slid = T::rows([sx, sy, sz, history.overlap_m]);
        let rolled = T::rows([rx, ry, rz, relaxed.origin_m]);
        Taken {
            memories: [0, 1, 2, 3].map(|lane| Memory {
                slid: slid[lane],
                rolled: rolled[lane],
            }),
            sliding_j: lost.sliding.values(),
            rolling_j: lost.rolling.values(),
        }
    }

    /// One particle for each lane.
    #[inline(always)]
    fn ball<T: Lanes>(&self, proof: T::Proof, particle: impl Fn(usize) -> usize) -> Ball<T> {
        let [vx, vy, vz, inverse_mass] = T::columns(proof, |lane| {
            let motion = &self.motions[particle(lane)];
            let [x, y, z] = motion.velocity_m_s;
            [x, y, z, motion.inverse_mass]
        });
        let [wx, wy, wz, inverse_inertia] = T::columns(proof, |lane| {
            let motion = &self.motions[particle(lane)];
            let [x, y, z] = motion.spin_rad_s;
            [x, y, z, motion.inverse_inertia]
        });
        Ball {
            velocity_m_s: Triple(vx, vy, vz),
            spin_rad_s: Triple(wx, wy, wz),
            radius_m: T::gathered(proof, |lane| self.poses[particle(lane)].radius_m()),
            inverse_mass_per_kg: inverse_mass,
            inverse_inertia_per_kg_m2: inverse_inertia,
        }
    }
}
