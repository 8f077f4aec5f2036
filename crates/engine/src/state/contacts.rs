//! Contacts between particles: pairs that may touch, their histories, and the types of contacts.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::islands::Islands;
use super::search::buffers::SearchBuffers;
use super::search::references::References;
use super::self_contacts::SelfContacts;
use crate::threads::for_each;
pub use dem_physics::contact::history::ContactHistory;
use dem_physics::contact::law::ContactKind;

/// In [`ContactModel::kind_of`]: the scene does not define the pair of materials.
pub const NO_KIND: u8 = u8::MAX;

/// Number of pairs that one task relists.
const RELISTED_AT_ONCE: usize = 1024;

/// Contact model of the particles.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ContactModel {
    /// Types of contacts.
    pub kinds: Vec<ContactKind>,
    /// For each pair of materials the number of the contact type, or 255 for none: row by row,
    /// length
    /// materials squared.
    pub kind_of: Vec<u8>,
    /// Particles can never touch each other, only walls: there is one piece, and it cannot break.
    /// No search for pairs.
    pub alone: bool,
    /// Whether spheres of one piece that no bond joins can touch, if their material has a contact
    /// with itself.
    pub self_contact: bool,
    /// Whether the overlap of a pair at its first listing is the origin of its law. That of a pair
    /// of one piece always is.
    pub relaxes: bool,
    /// A pair that separated while overlapping becomes ordinary below this fraction of its
    /// effective radius.
    pub least_overlap: f64,
    /// Smallest and largest distance that a particle may move between two searches for its
    /// neighbours, as fractions of its radius; between the two it depends on its speed. None: half
    /// of [`Contacts::skin_m`] for all.
    pub allowances: Option<[f64; 2]>,
}

/// Contacts of all particles. None if the scene has one body and no other can be added.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Contacts {
    /// Contact model of the particles, that of the model.
    #[serde(skip)]
    pub model: Arc<ContactModel>,
    /// Material of each particle.
    pub materials: Vec<u8>,
    /// Pairs that touch or are near, the smaller index first, sorted.
    pub pairs: Vec<[u32; 2]>,
    /// History of each pair. Length as `pairs`.
    pub histories: Vec<ContactHistory>,
    /// Skin of the Verlet list: pairs with surfaces closer than this were listed at the last
    /// search, m.
    pub skin_m: f64,
    /// Distance that every particle may move before it must be known which have moved too far since
    /// their last search, m; below 0: now.
    pub skin_left_m: f64,
    /// Distance that the fastest particle moved in the last step, m.
    pub moved_m: f64,
    /// Energy lost to friction and to damping so far, assigned to the first particle of each pair,
    /// J.
    pub lost_j: Vec<[f64; 2]>,
    /// The same for removed particles, J.
    pub lost_by_removed_j: [f64; 2],
    /// Pieces that have come near each other, and their energies. Not saved: what was near depends
    /// on when the lists were renewed, and so on interruptions.
    #[serde(skip)]
    pub islands: Islands,
    /// Data that can be rebuilt.
    #[serde(skip)]
    pub scratch: ContactScratch,
}

/// Contact data that can be rebuilt, or are valid for one step only.
#[derive(Debug, Clone, Default)]
pub struct ContactScratch {
    /// The last search for the neighbours of each particle.
    pub references: References,
    /// Pairs before the last search, kept for their memory only.
    pub(crate) former_pairs: Vec<[u32; 2]>,
    /// Histories before the last search, kept for their memory only.
    pub former_histories: Vec<ContactHistory>,
    /// For each pair whether there is anything in its history: kept for its memory only.
    remembers: Vec<bool>,
    /// Vectors of a search, kept for their memory only.
    pub(crate) buffers: SearchBuffers,
    /// Division of the work.
    pub partitions: Vec<ContactPartition>,
    /// Requested number of partitions: few contacts need fewer.
    pub wanted_partitions: usize,
    /// Sum of the radii of the particles, m.
    pub radii_m: f64,
    /// Mean radius of the particles, m; 0 until it is known.
    pub mean_radius_m: f64,
    /// Only the listed pairs that were closer than this at the last check of all pairs are
    /// computed, m.
    pub close_m: f64,
    /// Distance that every particle may move before the next check of all pairs, m; the check is
    /// due at 0.
    pub close_skin_left_m: f64,
    /// The first pair in this step that overlaps by more than the radius of the smaller particle.
    pub excessive_overlap: Option<[u32; 2]>,
    /// Pairs with a contact beside their bond.
    pub(crate) beside: Vec<Beside>,
    /// Unbonded pairs of one piece.
    pub(crate) self_contacts: SelfContacts,
}

/// A pair with a contact beside its bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Beside {
    /// Number of the pair.
    pub(crate) pair: u32,
    /// Number of the bond.
    pub(crate) bond: u32,
    /// Overlap at which the ends were bonded, m; 0 if they did not touch then.
    pub(crate) origin_m: f64,
}

/// Contacts that one thread works on at a time: those of its particles with others of a larger
/// index, and copies of those with smaller ones.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactPartition {
    /// Its particles.
    pub particles: Range<usize>,
    /// Its contacts: their first particles are its own.
    pub own: Range<usize>,
    /// Contacts whose second particle only is its own.
    pub border: Vec<u32>,
    /// Histories of those before this step.
    pub border_histories: Vec<ContactHistory>,
    /// For each type the contacts that were close at the last check of all, or at the check before
    /// it: numbers in `border`, and in all.
    pub close: Vec<[Vec<u32>; 2]>,
    /// Its contacts that were close at the last check of all: a bit for each, eight to a byte.
    pub was_close: Vec<u8>,
    /// Number of its contacts that touch in this step, or did in the previous one.
    pub computed: usize,
    /// Number of those with rolling friction.
    pub rolled: usize,
    /// See [`ContactScratch::excessive_overlap`].
    pub excessive_overlap: Option<[u32; 2]>,
}

impl Contacts {
    /// The type of a contact between two particles.
    #[inline(always)]
    pub fn kind(&self, [a, b]: [u32; 2]) -> usize {
        if self.model.kinds.len() == 1 {
            return 0;
        }
        let count = self.model.kind_of.len().isqrt();
        let [a, b] = [a, b].map(|i| usize::from(self.materials[i as usize]));
        usize::from(self.model.kind_of[a * count + b])
    }

    /// Whether the material of this particle has a contact with itself.
    pub(crate) fn touches_itself(&self, i: u32) -> bool {
        let count = self.model.kind_of.len().isqrt();
        let material = usize::from(self.materials[i as usize]);
        self.model.kind_of[material * count + material] != NO_KIND
    }

    /// Replaces the list of pairs of this number of particles, and divides them into as many
    /// partitions as were requested last; pairs that were listed before keep their history. The
    /// overlap of a newly listed pair is the origin of its law: the two had no contact before,
    /// whether they were bonded or not.
    pub fn relist(
        &mut self,
        pairs: Vec<[u32; 2]>,
        particles: usize,
        overlap_m: impl Fn([u32; 2]) -> f64 + Sync,
    ) {
        let (known, of_known) = (&self.pairs, &self.histories);
        let relist_chunk =
            |new: &mut [ContactHistory], remember: &mut [bool], pairs: &[[u32; 2]]| {
                let first = known.partition_point(|old| *old < pairs[0]);
                let mut before = known[first..].iter().zip(&of_known[first..]).peekable();
                for ((history, remembers), pair) in new.iter_mut().zip(remember).zip(pairs) {
                    while before.next_if(|(old, _)| *old < pair).is_some() {}
                    *history = match before.peek() {
                        Some((old, history)) if *old == pair => **history,
                        _ => ContactHistory::separated_at(overlap_m(*pair)),
                    };
                    *remembers = history.remembers();
                }
            };
        let mut histories = std::mem::take(&mut self.scratch.former_histories);
        if histories.capacity() < pairs.len() {
            histories = Vec::with_capacity(pairs.len() + pairs.len() / 8);
        }
        histories.resize(pairs.len(), ContactHistory::default());
        let mut remembers = std::mem::take(&mut self.scratch.remembers);
        remembers.resize(pairs.len(), false);
        let chunks = histories.chunks_mut(RELISTED_AT_ONCE);
        let chunks = chunks.zip(remembers.chunks_mut(RELISTED_AT_ONCE));
        let chunks = chunks.zip(pairs.chunks(RELISTED_AT_ONCE));
        for_each(chunks, |((new, remember), pairs)| {
            relist_chunk(new, remember, pairs);
        });
        self.scratch.former_histories = std::mem::replace(&mut self.histories, histories);
        self.scratch.former_pairs = std::mem::replace(&mut self.pairs, pairs);
        self.set_partitions(particles, self.scratch.wanted_partitions.max(1), &remembers);
        self.scratch.remembers = remembers;
    }

    /// Requests a search for the neighbours of all particles before the next step.
    pub fn search_all(&mut self) {
        self.forget_references();
        self.skin_left_m = -1.0;
    }

    /// Forgets the last search: all particles are searched for before the next step.
    pub(crate) fn forget_references(&mut self) {
        let references = &mut self.scratch.references;
        references.balls.clear();
        references.clusters = std::mem::take(&mut references.clusters).renumbered();
    }

    /// Number of pairs whose law begins at an overlap that they separated with.
    pub(crate) fn relaxing(&self) -> usize {
        let relaxes = |history: &&ContactHistory| history.origin_m() > 0.0;
        self.histories.iter().filter(relaxes).count()
    }

    /// Divides the contacts into `count` partitions of about equal size.
    pub fn divide(&mut self, particles: usize, count: usize) {
        let mut remembers = std::mem::take(&mut self.scratch.remembers);
        remembers.clear();
        remembers.extend(self.histories.iter().map(ContactHistory::remembers));
        self.set_partitions(particles, count, &remembers);
        self.scratch.remembers = remembers;
    }

    /// As `divide`, where it is known for each pair whether its history is empty.
    fn set_partitions(&mut self, particles: usize, count: usize, remembers: &[bool]) {
        self.scratch.wanted_partitions = count;
        self.scratch.close_skin_left_m = 0.0;
        let wanted = self.pairs.len().div_ceil(count).max(1);
        let end_of = |k: usize| {
            let next = self.pairs.get(k * wanted);
            next.map_or(particles, |&[a, _]| a as usize)
        };
        let mut partitions = std::mem::take(&mut self.scratch.partitions);
        let (mut divided, mut start) = (0, 0);
        for end in (1..=count).map(end_of) {
            if end == start {
                continue;
            }
            if divided == partitions.len() {
                partitions.push(ContactPartition::default());
            }
            partitions[divided].set(start..end, self, remembers);
            (divided, start) = (divided + 1, end);
        }
        partitions.truncate(divided);
        for s in 0..divided {
            for at in partitions[s].own.clone() {
                let b = self.pairs[at][1] as usize;
                if b >= partitions[s].particles.end {
                    let of_b = partitions.partition_point(|other| other.particles.end <= b);
                    partitions[of_b].border.push(at as u32);
                }
            }
        }
        self.scratch.partitions = partitions;
    }
}

impl ContactPartition {
    /// Gives it these particles and their contacts, without a border. `remembers`: for each pair
    /// whether there is anything in its history.
    fn set(&mut self, particles: Range<usize>, contacts: &Contacts, remembers: &[bool]) {
        let pairs = &contacts.pairs;
        let first_of = |p: usize| pairs.partition_point(|&[a, _]| (a as usize) < p);
        self.own = first_of(particles.start)..first_of(particles.end);
        self.particles = particles;
        self.border.clear();
        self.border_histories.clear();
        self.close
            .resize_with(contacts.model.kinds.len(), Default::default);
        self.close.iter_mut().flatten().for_each(Vec::clear);
        let of_eight = |eight: &[bool]| {
            let bits = (0..).zip(eight);
            bits.fold(0, |bits, (lane, remembers)| {
                bits | u8::from(*remembers) << lane
            })
        };
        self.was_close.clear();
        self.was_close
            .extend(remembers[self.own.clone()].chunks(8).map(of_eight));
        self.computed = 0;
        self.rolled = 0;
        self.excessive_overlap = None;
    }
}
