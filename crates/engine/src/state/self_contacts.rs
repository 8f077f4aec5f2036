//! Spheres of one piece that no bond joins and that may touch.

use std::collections::BTreeMap;

use super::events::REMOVED;

/// What a look at a piece found.
#[derive(Debug, Clone, Default)]
pub(crate) struct Look {
    /// Number of its cluster.
    pub(crate) piece: u32,
    /// Distance that each of its particles may move until the next look, m.
    pub(crate) left_m: f64,
    /// If its pairs were searched for: those to be listed, and the least gap of the others, m.
    pub(crate) searched: Option<(Vec<[u32; 2]>, f64)>,
}

/// Pairs of unbonded particles of one piece that may touch, and how far the particles of each piece
/// may move until it must be known whether others have come near each other.
#[derive(Debug, Clone, Default)]
pub struct SelfContacts {
    /// The pairs, the smaller number first, sorted. Those of pieces that have parted since are
    /// still among them.
    pub(crate) pairs: Vec<[u32; 2]>,
    /// Ends of the bonds that have broken since the last look.
    pub(crate) parted: Vec<[u32; 2]>,
    /// Whether `pairs` have changed since the contacts were listed.
    pub(crate) is_changed: bool,
    /// For each free particle the place that it had when the pairs of its piece were searched for,
    /// m.
    pub(crate) places_m: Vec<[f64; 3]>,
    /// For each piece of three particles or more, by the number of its cluster, the least gap at
    /// those places between two unbonded particles that are not in `pairs`, m.
    pub(crate) least_gaps_m: BTreeMap<u32, f64>,
    /// Number of clusters that the scene had had at the last look. None: all are to be looked at.
    pub(crate) clusters_ever: Option<usize>,
    /// For each chunk of free particles the distance that they may still move, and that which they
    /// could move at the last look, m.
    pub(crate) chunks_left_m: Vec<[f64; 2]>,
    /// The pieces that are looked at in a step, and whether each is new: kept for their memory
    /// only.
    pub(crate) due: Vec<(u32, bool)>,
    /// What was found there: kept for its memory only.
    pub(crate) looks: Vec<Look>,
}

impl SelfContacts {
    /// Subtracts the displacements in a drift from the distances left.
    pub(crate) fn use_up(&mut self, chunks_moved_m: &[f64]) {
        for ([left_m, _], moved_m) in self.chunks_left_m.iter_mut().zip(chunks_moved_m) {
            *left_m -= moved_m;
        }
    }

    /// Gives the particles new numbers. `now`: for each old particle its new number or
    /// [`REMOVED`]; `free`: number of free particles from now on.
    pub(crate) fn renumber(&mut self, now: &[u32], free: usize) {
        if self.places_m.is_empty() {
            return;
        }
        let stays = |i: u32| {
            let to = now.get(i as usize).copied().unwrap_or(REMOVED);
            Some(to).filter(|&to| (to as usize) < free)
        };
        let mut places_m = vec![[0.0; 3]; free];
        for (i, place_m) in (0..).zip(&self.places_m) {
            if let Some(to) = stays(i) {
                places_m[to as usize] = *place_m;
            }
        }
        self.places_m = places_m;
        for pairs in [&mut self.pairs, &mut self.parted] {
            let both = pairs
                .iter()
                .filter_map(|&[a, b]| Some([stays(a)?, stays(b)?]));
            *pairs = both.map(|[a, b]| [a.min(b), a.max(b)]).collect();
            pairs.sort_unstable();
        }
        self.clusters_ever = None;
        self.chunks_left_m.clear();
    }
}
