//! The contacts of a partition, as many at once as the processor has lanes.

use super::close::look;
use super::input::StepInput;
use crate::stages::bonds::blocks::fetch_soon_of;
use crate::state::contacts::{ContactHistory, ContactPartition};
use crate::state::particles::Wrench;
use crate::threads;
use dem_physics::contact::NormalLaw;
use dem_physics::contact::law::{ContactWork, Rolling};
use dem_physics::contact::rolling::RollingFriction;
use dem_physics::lanes::{LaneWork, Lanes, MOST, with_most_lanes};

/// Output of a partition: the histories of its own contacts, and data of its own particles.
pub(super) struct PartitionOutput<'a> {
    pub(super) histories: &'a mut [ContactHistory],
    pub(super) wrenches: &'a mut [Wrench],
    pub(super) lost_j: &'a mut [[f64; 2]],
}

impl<'a> PartitionOutput<'a> {
    /// Takes away what belongs to the first of these contacts and particles.
    fn take(&mut self, contacts: usize, particles: usize) -> Self {
        Self {
            histories: first_of(&mut self.histories, contacts),
            wrenches: first_of(&mut self.wrenches, particles),
            lost_j: first_of(&mut self.lost_j, particles),
        }
    }
}

fn first_of<'a, T>(all: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    all.split_off_mut(..count).unwrap_or_default()
}

/// Works on all partitions, on as many threads as there are.
pub(super) fn for_each(
    partitions: &mut [ContactPartition],
    mut books: PartitionOutput<'_>,
    scene: &StepInput<'_>,
) {
    let parts = partitions.iter_mut().map(|partition| {
        let books = books.take(partition.own.len(), partition.particles.len());
        (partition, books)
    });
    threads::for_each(parts, |(partition, books)| {
        with_most_lanes(PartitionWork {
            partition,
            books,
            scene,
        });
    });
}

struct PartitionWork<'a> {
    partition: &'a mut ContactPartition,
    books: PartitionOutput<'a>,
    scene: &'a StepInput<'a>,
}

impl LaneWork for PartitionWork<'_> {
    #[inline(always)]
    fn with<T: Lanes>(mut self, proof: T::Proof) {
        if self.scene.checks_all {
            look::<T>(proof, self.partition, self.scene);
        }
        (self.partition.computed, self.partition.rolled) = (0, 0);
        for kind in 0..self.scene.contacts.model.kinds.len() {
            let before = self.partition.computed;
            let contact = self.scene.contacts.model.kinds[kind];
            let work = KindWork::<T> {
                work: &mut self,
                proof,
                kind,
            };
            contact.with(|number| T::all(proof, number), work);
            if self.scene.contacts.model.kinds[kind].rolling != Rolling::Free {
                self.partition.rolled += self.partition.computed - before;
            }
        }
    }
}

/// The work on the contacts of one type in a partition.
struct KindWork<'a, 'b, T: Lanes> {
    work: &'a mut PartitionWork<'b>,
    proof: T::Proof,
    kind: usize,
}

impl<T: Lanes> ContactWork<T> for KindWork<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with(self, law: &impl NormalLaw<T>, rolling: &impl RollingFriction<T>) {
        self.work
            .of_kind::<T, _>(self.proof, self.kind, law, rolling);
    }
}

impl PartitionWork<'_> {
    /// The contacts of one type, border contacts first, so that each particle gets its contacts in
    /// their order.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "lanes are gone through")]
    fn of_kind<T: Lanes, L: NormalLaw<T>>(
        &mut self,
        proof: T::Proof,
        kind: usize,
        law: &L,
        rolling: &impl RollingFriction<T>,
    ) {
        self.of_border::<T, L>(proof, kind, law, rolling);
        let Self {
            partition,
            books,
            scene,
        } = self;
        let pairs = &scene.contacts.pairs;
        let (own, particles) = (&partition.own, &partition.particles);
        let close = &partition.close[kind][1];
        let histories = &mut books.histories[..];
        let wrenches = &mut books.wrenches[..];
        let lost_j = &mut books.lost_j[..];
        let mut excessive_overlap = partition.excessive_overlap;
        let mut computed = 0;
        for (n, some) in close.chunks(T::COUNT).enumerate() {
            let soon = n * T::COUNT + SOON;
            for &at in close.get(soon..soon + T::COUNT).unwrap_or_default() {
                let b = pairs[at as usize][1] as usize;
                fetch_soon_of(scene.poses, b);
                fetch_soon_of(scene.motions, b);
                fetch_soon_of(histories, at as usize - own.start);
                fetch_soon_of(wrenches, b.wrapping_sub(particles.start));
            }
            let (mut numbers, mut ends) = ([0; MOST], [[0; 2]; MOST]);
            for lane in 0..T::COUNT {
                numbers[lane] = some[lane.min(some.len() - 1)] as usize;
                ends[lane] = pairs[numbers[lane]];
            }
            let met = scene.meet::<T, _, _>(
                proof,
                law,
                rolling,
                |lane| ends[lane],
                |lane| &histories[numbers[lane] - own.start],
            );
            if met.excessive_overlap != 0 {
                // Spare lanes repeat the last contact.
                let pair = ends[met.excessive_overlap.trailing_zeros() as usize];
                excessive_overlap = Some(excessive_overlap.map_or(pair, |other| other.min(pair)));
            }
            let touched = met.touched & (0xff >> (MOST - some.len()));
            computed += touched.count_ones() as usize;
            for lane in 0..T::COUNT {
                if touched >> lane & 1 == 1 {
                    let a = ends[lane][0] as usize - particles.start;
                    lost_j[a][0] += met.friction_j[lane];
                    lost_j[a][1] += met.damping_j[lane];
                    let history = &mut histories[numbers[lane] - own.start];
                    history.tangential = met.tangential[lane];
                    history.damping = met.damped[lane];
                    if let Some([rolled, rolling_damped]) = &met.rolled {
                        history.rolling = rolled[lane];
                        history.rolling_damping = rolling_damped[lane];
                    }
                    if L::ATTRACTS && history.ends_with_a_jump() {
                        let own = numbers[lane] - own.start;
                        partition.was_close[own / 8] |= 1 << (own % 8);
                    }
                }
            }
            for lane in 0..T::COUNT {
                if touched >> lane & 1 == 1 {
                    let [a, b] = ends[lane].map(|end| (end as usize).wrapping_sub(particles.start));
                    met.forces.add_to_a(lane, &mut wrenches[a]);
                    if b < wrenches.len() {
                        met.forces.add_to_b(lane, &mut wrenches[b]);
                    }
                }
            }
        }
        partition.computed += computed;
        partition.excessive_overlap = excessive_overlap;
    }

    /// The border contacts of one type: their forces on particles of this partition.
    #[inline(always)]
    fn of_border<T: Lanes, L: NormalLaw<T>>(
        &mut self,
        proof: T::Proof,
        kind: usize,
        law: &L,
        rolling: &impl RollingFriction<T>,
    ) {
        let Self {
            partition,
            books,
            scene,
        } = self;
        let pairs = &scene.contacts.pairs;
        let first = partition.particles.start;
        for some in partition.close[kind][0].chunks(T::COUNT) {
            let number = |lane: usize| some[lane.min(some.len() - 1)] as usize;
            let pair = |lane: usize| pairs[partition.border[number(lane)] as usize];
            let history = |lane: usize| &partition.border_histories[number(lane)];
            let met = scene.meet::<T, _, _>(proof, law, rolling, pair, history);
            for lane in 0..some.len() {
                let b = pair(lane)[1] as usize - first;
                met.forces.add_to_b(lane, &mut books.wrenches[b]);
            }
        }
    }
}

/// Prefetch distance of second particles, in contacts.
const SOON: usize = 16;
