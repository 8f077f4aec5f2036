//! Contacts between particles: which pairs may touch, what each remembers, and what the kinds of
//! contacts are.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::physics::contact::law::ContactKind;

/// What a contact remembers. Two cache lines, of which contacts without rolling friction use the
/// first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(64))]
pub struct ContactHistory {
    /// Tangential spring x, y, z and the overlap of the law, m.
    pub tangential: [f64; 4],
    /// Damping force on the second end x, y, z, N, and the overlap at which the law begins, m,
    /// which is 0 but for pairs that [parted overlapping](crate::physics::contact::relaxation).
    pub damping: [f64; 4],
    /// Rolling spring x, y, z, rad, and nothing.
    pub rolling: [f64; 4],
    /// Damping moment on the second end x, y, z, N m, and nothing.
    pub rolling_damping: [f64; 4],
}

impl ContactHistory {
    /// Of a pair whose law begins at this overlap, m.
    pub fn separated_at(overlap_m: f64) -> Self {
        Self {
            damping: [0.0, 0.0, 0.0, overlap_m.max(0.0)],
            ..Self::default()
        }
    }

    /// Of a pair whose law has been pressed by this overlap, m, and by nothing else.
    pub fn pressed_by(overlap_m: f64) -> Self {
        Self {
            tangential: [0.0, 0.0, 0.0, overlap_m.max(0.0)],
            ..Self::default()
        }
    }

    /// The same of a pair that is named the other way round.
    pub fn reversed(&self) -> Self {
        let back = |[x, y, z, last]: [f64; 4]| [-x, -y, -z, last];
        Self {
            tangential: back(self.tangential),
            damping: back(self.damping),
            rolling: back(self.rolling),
            rolling_damping: back(self.rolling_damping),
        }
    }

    /// Overlap of the law, m; above 0 where the two press on each other.
    #[inline(always)]
    pub fn overlap_m(&self) -> f64 {
        self.tangential[3]
    }

    /// Overlap at which the law begins, m.
    #[inline(always)]
    pub fn origin_m(&self) -> f64 {
        self.damping[3]
    }
}

/// How particles meet.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ContactModel {
    /// Kinds of contacts.
    pub kinds: Vec<ContactKind>,
    /// For each material and each other the number of the kind: row by row, length materials
    /// squared.
    pub kind_of: Vec<u8>,
    /// No particle can ever meet another, only walls: there is one piece, and it cannot break. No
    /// pairs are looked for.
    pub alone: bool,
    /// Whether the overlap of a pair that is listed for the first time is the origin of its law.
    pub relaxes: bool,
    /// A pair that parted overlapping is ordinary below this share of its reduced radius.
    pub least_overlap: f64,
}

/// Contacts of all particles. None where the scene has one body and no other can come.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Contacts {
    /// How particles meet: that of the model.
    #[serde(skip)]
    pub model: Arc<ContactModel>,
    /// Material of each particle.
    pub materials: Vec<u8>,
    /// Pairs that touch or are near, the smaller index first, sorted.
    pub pairs: Vec<[u32; 2]>,
    /// What each remembers. Length as `pairs`.
    pub histories: Vec<ContactHistory>,
    /// Surfaces closer than this were near when pairs were looked for, m.
    pub skin_m: f64,
    /// What every particle may move before pairs have to be looked for again, m.
    pub skin_left_m: f64,
    /// What the fastest particle moved in the last step, m.
    pub moved_m: f64,
    /// Energy that friction and that damping took so far, booked at the first particle of each
    /// pair, J.
    pub lost_j: Vec<[f64; 2]>,
    /// The same of particles that are no more, J.
    pub lost_by_removed_j: [f64; 2],
    /// What can be rebuilt.
    #[serde(skip)]
    pub scratch: ContactScratch,
}

/// What can be rebuilt of contacts, or holds for one step only.
#[derive(Debug, Clone, Default)]
pub struct ContactScratch {
    /// Who works on what.
    pub partitions: Vec<ContactPartition>,
    /// Number of partitions that was asked for: few contacts make fewer.
    pub wanted_partitions: usize,
    /// Of the near pairs those that were closer than this when all were looked at are computed, m.
    pub close_m: f64,
    /// What every particle may move before all are looked at again, m: that is due at 0.
    pub close_skin_left_m: f64,
    /// The first pair that is pressed into each other by more than the radius of the smaller one,
    /// of this step.
    pub excessive_overlap: Option<[u32; 2]>,
}

/// Contacts that one thread works on at a time: those of its particles with others of a larger
/// index; and copies of those with smaller ones.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPartition {
    /// Its particles.
    pub particles: Range<usize>,
    /// Its contacts: their first particles are its own.
    pub own: Range<usize>,
    /// Contacts of which only the second particle is its own.
    pub border: Vec<u32>,
    /// What those remembered before this step.
    pub border_histories: Vec<ContactHistory>,
    /// For each kind the contacts that were close when all were looked at, or at the look before:
    /// numbers in `border`, and in all.
    pub close: Vec<[Vec<u32>; 2]>,
    /// Which of its contacts were close when all were looked at: a bit for each, eight to a byte.
    pub was_close: Vec<u8>,
    /// How many of its contacts touch in this step, or did in the one before.
    pub computed: usize,
    /// How many of those with rolling friction.
    pub rolled: usize,
    /// See [`ContactScratch::excessive_overlap`].
    pub excessive_overlap: Option<[u32; 2]>,
}

impl Contacts {
    /// The kind of a contact between two particles.
    #[inline(always)]
    pub fn kind(&self, [a, b]: [u32; 2]) -> usize {
        if self.model.kinds.len() == 1 {
            return 0;
        }
        let count = self.model.kind_of.len().isqrt();
        let [a, b] = [a, b].map(|i| usize::from(self.materials[i as usize]));
        usize::from(self.model.kind_of[a * count + b])
    }

    /// Takes a new list of pairs; pairs that were listed before keep what they remember. The
    /// overlap of one that is listed for the first time is the origin of its law: there was nothing
    /// between the two before, be it a bond or nothing at all.
    pub fn relist(&mut self, pairs: Vec<[u32; 2]>, overlap_m: impl Fn([u32; 2]) -> f64) {
        let mut before = self.pairs.iter().zip(&self.histories).peekable();
        let histories = pairs
            .iter()
            .map(|pair| {
                while before.next_if(|(old, _)| *old < pair).is_some() {}
                match before.peek() {
                    Some((old, history)) if *old == pair => **history,
                    _ => ContactHistory::separated_at(overlap_m(*pair)),
                }
            })
            .collect();
        self.histories = histories;
        self.pairs = pairs;
    }

    /// How many pairs begin their law at an overlap that they parted with.
    pub fn relaxing(&self) -> usize {
        let relaxes = |history: &&ContactHistory| history.origin_m() > 0.0;
        self.histories.iter().filter(relaxes).count()
    }

    /// Divides the contacts into `count` partitions of about the same number each.
    pub fn divide(&mut self, particles: usize, count: usize) {
        self.scratch.wanted_partitions = count;
        self.scratch.close_skin_left_m = 0.0;
        let wanted = self.pairs.len().div_ceil(count).max(1);
        let mut starts = vec![0];
        for k in 1..count {
            let first = (k * wanted).min(self.pairs.len());
            let particle = self
                .pairs
                .get(first)
                .map_or(particles, |&[a, _]| a as usize);
            starts.push(particle);
        }
        starts.push(particles);
        starts.dedup();
        self.scratch.partitions = starts
            .windows(2)
            .map(|w| {
                let first_of = |p: usize| self.pairs.partition_point(|&[a, _]| (a as usize) < p);
                let own = first_of(w[0])..first_of(w[1]);
                let remembers = |history: &ContactHistory| *history != ContactHistory::default();
                let was_close = self.histories[own.clone()].chunks(8).map(|eight| {
                    (0..).zip(eight).fold(0, |bits, (lane, history)| {
                        bits | u8::from(remembers(history)) << lane
                    })
                });
                ContactPartition {
                    particles: w[0]..w[1],
                    was_close: was_close.collect(),
                    own,
                    border: Vec::new(),
                    border_histories: Vec::new(),
                    excessive_overlap: None,
                    close: vec![Default::default(); self.model.kinds.len()],
                    computed: 0,
                    rolled: 0,
                }
            })
            .collect();
        for s in 0..self.scratch.partitions.len() {
            for at in self.scratch.partitions[s].own.clone() {
                let b = self.pairs[at][1] as usize;
                if b >= self.scratch.partitions[s].particles.end {
                    let of_b = self
                        .scratch
                        .partitions
                        .partition_point(|partition| partition.particles.end <= b);
                    self.scratch.partitions[of_b].border.push(at as u32);
                }
            }
        }
    }
}
