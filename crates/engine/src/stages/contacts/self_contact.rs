//! Contacts within a piece: spheres that no bond joins touch, though other bonds hold the piece
//! together. So cracks that close carry load, and bodies that fold do not pass through themselves.
//!
//! The pairs that overlap when they are first listed have their overlap as the origin of their law:
//! see [`dem_physics::contact::relaxation`]. Those of the packing do so at the start, and those
//! whose bond breaks do so from the next step on.
//!
//! A pair is listed only if it may touch. Between two looks at a piece, no two of its particles
//! come nearer to each other than both have moved apart from a rigid motion of the piece. A look
//! finds the rigid motion that fits best since the pairs were searched for, and what is left of the
//! least gap of those that are not listed; particles may use that up by any motion until the next
//! look. A search is due when the deformation has used up most of the least gap.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use super::forces::overlap_m;
use crate::stages::chunks::{CHUNK, chunk_of, chunks_of};
use crate::stages::search::neighbours::near_pairs;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::clusters::Clusters;
use crate::state::contacts::Contacts;
use crate::state::particles::{Particles, Pose};
use crate::state::self_contacts::{Look, SelfContacts};

/// Pieces of fewer particles have no two that are unbonded.
const LEAST_PARTICLES: usize = 3;
/// Unbonded pairs of a piece are searched for up to this gap, as a fraction of its largest radius.
const REACH: f64 = 0.5;
/// Pairs are listed whose gap is below this fraction of the largest radius.
const NEAR: f64 = 1e-3;
/// Pairs are listed whose gap two particles can close in this number of steps at their speed.
const STEPS: f64 = 8.0;
/// Pairs are listed whose gap is below this multiple of the deformation since the last search, so
/// that searches become rarer as a piece deforms, up to a gap of this fraction of the largest
/// radius.
const DEFORMATION: [f64; 2] = [8.0, 0.25];
/// A search is due when less than this fraction of half the least gap is left.
const LEFT: f64 = 0.25;
/// A look is due when particles may use up what is left in this number of steps.
const STEPS_LEFT: f64 = 2.0;
/// Chunks with less than this fraction of their distance left are looked at together with one that
/// is due.
const SOON: f64 = 0.5;

/// Contacts within pieces.
pub(crate) const SELF_CONTACT: Stage = Stage {
    bytes: |state| {
        state.contacts.as_ref().map_or(0, |contacts| {
            let own = &contacts.scratch.self_contacts;
            size_of_val(&own.pairs[..])
                + size_of_val(&own.places_m[..])
                + size_of_val(&own.chunks_left_m[..])
        })
    },
    ..Stage::new("contacts within pieces", |state, scene| {
        let why_not = if !scene.clusters.self_contact {
            "switched off: spheres of one piece never touch"
        } else if state.bonds.is_empty()
            && state.clumps.templates.iter().all(|t| t.bonds.is_empty())
        {
            "nothing is bonded"
        } else {
            "no bonded material has a contact with itself"
        };
        Need::of(
            has_self_contact(state),
            || "once spheres that no bond joins may have come near each other".to_owned(),
            why_not,
        )
    })
};

fn has_self_contact(state: &State) -> bool {
    let contacts = state.contacts.as_ref();
    contacts.is_some_and(|contacts| contacts.model.self_contact)
}

/// Lists the unbonded pairs of one piece that may touch soon, if particles have moved far enough
/// since the last look, bonds have broken or there are new pieces. Returns the number of particles
/// of known pieces looked at.
pub(crate) fn find_self_contacts(state: &mut State) -> usize {
    let Some(mut contacts) = state
        .contacts
        .take_if(|contacts| contacts.model.self_contact)
    else {
        return 0;
    };
    let mut own = std::mem::take(&mut contacts.scratch.self_contacts);
    let looked = match &state.clusters {
        Some(clusters) => {
            let pieces = Pieces {
                clusters,
                bonds: &state.bonds,
                particles: &state.particles,
                contacts: &contacts,
                step_s: state.time_step_s,
            };
            pieces.look(&mut own, &state.scratch.chunks_moved_m)
        }
        None => 0,
    };
    contacts.scratch.self_contacts = own;
    state.contacts = Some(contacts);
    looked
}

/// What is looked at.
struct Pieces<'a> {
    clusters: &'a Clusters,
    bonds: &'a Bonds,
    particles: &'a Particles,
    contacts: &'a Contacts,
    step_s: f64,
}

impl Pieces<'_> {
    fn look(&self, own: &mut SelfContacts, chunks_moved_m: &[f64]) -> usize {
        self.begin(own);
        let mut due = std::mem::take(&mut own.due);
        due.clear();
        self.find_new(own, &mut due);
        self.add_parted(own);
        self.find_due(own, chunks_moved_m, &mut due);
        if due.is_empty() {
            own.due = due;
            return 0;
        }
        let mut looks = std::mem::take(&mut own.looks);
        let look = |&(piece, is_new): &(u32, bool)| match is_new {
            true => self.search(piece, 0.0),
            false => self.look_at(own, piece),
        };
        due.par_iter().map(look).collect_into_vec(&mut looks);
        self.relist(own, &looks);
        let known = due.iter().filter(|(_, is_new)| !is_new);
        let looked = known
            .map(|&(piece, _)| self.clusters.members(piece).len())
            .sum();
        (own.due, own.looks) = (due, looks);
        looked
    }

    /// Forgets everything if the particles are not those of the last look.
    fn begin(&self, own: &mut SelfContacts) {
        let free = self.particles.free;
        if own.places_m.len() != free {
            *own = SelfContacts {
                places_m: vec![[0.0; 3]; free],
                is_changed: true,
                ..SelfContacts::default()
            };
        }
        let chunks = chunks_of(free).len();
        if own.chunks_left_m.len() != chunks {
            own.chunks_left_m = vec![[0.0; 2]; chunks];
        }
    }

    /// Whether this cluster is a piece in which spheres can touch.
    fn is_piece(&self, cluster: u32) -> bool {
        let members = self.clusters.members(cluster);
        members.len() >= LEAST_PARTICLES
            && (members[0] as usize) < self.particles.free
            && self.contacts.touches_itself(members[0])
    }

    /// Updates the pieces if there are other clusters than at the last look, and lists those that
    /// are to be searched. What broke off from a piece keeps its places and its least gap.
    fn find_new(&self, own: &mut SelfContacts, due: &mut Vec<(u32, bool)>) {
        let ever = self.clusters.history.len();
        let known = own.clusters_ever.unwrap_or(0);
        if own.clusters_ever == Some(ever) {
            return;
        }
        for piece in (known as u32..ever as u32).filter(|&piece| self.is_piece(piece)) {
            if own.least_gaps_m.contains_key(&piece) {
                continue;
            }
            let parent = self.clusters.history[piece as usize].parent;
            match parent.and_then(|parent| own.least_gaps_m.get(&parent)) {
                Some(&gap_m) => {
                    own.least_gaps_m.insert(piece, gap_m);
                }
                None => due.push((piece, true)),
            }
        }
        own.least_gaps_m.retain(|&piece, _| self.is_piece(piece));
        own.pairs.retain(|&pair| self.clusters.is_within(pair));
        own.clusters_ever = Some(ever);
    }

    /// Lists the pairs whose bond has broken, if they are still of one piece.
    fn add_parted(&self, own: &mut SelfContacts) {
        let parted = std::mem::take(&mut own.parted);
        let parted = parted.iter().map(|&[a, b]| [a.min(b), a.max(b)]);
        let known = own.pairs.len();
        own.pairs.extend(parted.filter(|&pair| {
            self.clusters.is_within(pair) && self.contacts.touches_itself(pair[0])
        }));
        if own.pairs.len() > known {
            own.pairs.sort_unstable();
            own.pairs.dedup();
            own.is_changed = true;
        }
    }

    /// Lists the known pieces of which a particle may have used up its distance, and those of which
    /// one may have soon.
    fn find_due(&self, own: &mut SelfContacts, chunks_moved_m: &[f64], due: &mut Vec<(u32, bool)>) {
        let moved_m = |chunk: usize| chunks_moved_m.get(chunk).copied().unwrap_or(0.0);
        let left = own.chunks_left_m.iter().enumerate();
        let mut urgent =
            left.filter(|(chunk, [left_m, _])| *left_m <= STEPS_LEFT * moved_m(*chunk));
        if urgent.next().is_none() {
            return;
        }
        for chunk in chunks_of(self.particles.free) {
            let [left_m, allowance_m] = &mut own.chunks_left_m[chunk];
            if *left_m <= (STEPS_LEFT * moved_m(chunk)).max(SOON * *allowance_m) {
                *left_m = f64::INFINITY;
                let some = &self.clusters.of_particle[chunk_of(chunk, self.particles.free)];
                due.extend(some.chunk_by(|a, b| a == b).map(|same| (same[0], false)));
            }
        }
        due.sort_unstable();
        due.dedup();
        // What is no piece has no gap.
        due.retain(|(piece, is_new)| *is_new || own.least_gaps_m.contains_key(piece));
    }

    /// Looks how far the particles of a known piece have moved beside each other.
    fn look_at(&self, own: &SelfContacts, piece: u32) -> Look {
        let members = self.clusters.members(piece);
        let least_gap_m = own.least_gaps_m.get(&piece).copied().unwrap_or(0.0);
        let deformation_m = deformation_m(members, &own.places_m, &self.particles.poses);
        let left_m = 0.5 * least_gap_m - deformation_m;
        let fastest_m = self.fastest_m(members);
        if left_m < (LEFT * 0.5 * least_gap_m).max((STEPS_LEFT + 1.0) * fastest_m) {
            return self.search(piece, deformation_m);
        }
        Look {
            piece,
            left_m,
            searched: None,
        }
    }

    /// Distance that the fastest of these particles moves in a step, m.
    fn fastest_m(&self, members: &[u32]) -> f64 {
        let speeds = members
            .iter()
            .map(|&i| self.particles.motions[i as usize].speed_m_s());
        self.step_s * speeds.fold(0.0, f64::max)
    }

    /// Searches for the unbonded pairs of a piece that may touch. `deformation_m`: that since the
    /// search before.
    fn search(&self, piece: u32, deformation_m: f64) -> Look {
        let members = self.clusters.members(piece);
        let poses: Vec<Pose> =
            (members.iter().map(|&i| self.particles.poses[i as usize])).collect();
        let largest_m = poses.iter().map(Pose::radius_m).fold(0.0, f64::max);
        let fastest_m = self.fastest_m(members);
        let [times, most] = DEFORMATION;
        let near_m = (times * deformation_m).clamp(NEAR * largest_m, most * largest_m);
        let near_m = near_m.max(2.0 * STEPS * fastest_m);
        let reach_m = (REACH * largest_m).max(2.0 * near_m);
        let each: Vec<u32> = (0..members.len() as u32).collect();
        let (mut pairs, mut least_gap_m) = (Vec::new(), reach_m);
        for near in near_pairs(&poses, &each, reach_m) {
            let [a, b] = near.map(|n| members[n as usize]);
            let gap_m = -overlap_m(&poses, near);
            if (gap_m >= near_m && gap_m >= least_gap_m)
                || self.clusters.are_bonded([a, b], self.bonds)
            {
                continue;
            }
            if gap_m < near_m {
                pairs.push([a.min(b), a.max(b)]);
            } else {
                least_gap_m = gap_m;
            }
        }
        Look {
            piece,
            left_m: 0.5 * least_gap_m,
            searched: Some((pairs, least_gap_m)),
        }
    }

    /// Notes what looks have found.
    fn relist(&self, own: &mut SelfContacts, looks: &[Look]) {
        let is_searched = |look: &&Look| look.searched.is_some();
        let mut searched: Vec<u32> = looks
            .iter()
            .filter(is_searched)
            .map(|look| look.piece)
            .collect();
        searched.sort_unstable();
        if !searched.is_empty() {
            let before = std::mem::take(&mut own.pairs);
            let piece_of = |[a, _]: &[u32; 2]| self.clusters.of_particle[*a as usize];
            let stays = |pair: &&[u32; 2]| searched.binary_search(&piece_of(pair)).is_err();
            own.pairs = before.iter().filter(stays).copied().collect();
            let found = looks.iter().flat_map(|look| &look.searched);
            own.pairs.extend(found.flat_map(|(pairs, _)| pairs));
            own.pairs.sort_unstable();
            own.is_changed |= own.pairs != before;
        }
        for look in looks {
            let members = self.clusters.members(look.piece);
            if let Some((_, gap_m)) = look.searched {
                own.least_gaps_m.insert(look.piece, gap_m);
                for &i in members {
                    own.places_m[i as usize] = self.particles.poses[i as usize].place().into();
                }
            }
            for some in members.chunk_by(|&a, &b| a as usize / CHUNK == b as usize / CHUNK) {
                let [left_m, allowance_m] = &mut own.chunks_left_m[some[0] as usize / CHUNK];
                if look.left_m < *left_m {
                    (*left_m, *allowance_m) = (look.left_m, look.left_m);
                }
            }
        }
    }
}

/// Largest distance of one of these particles from where a rigid motion of all of them from
/// `places_m` brings it, m: for the motion that fits best (Kabsch 1976).
fn deformation_m(members: &[u32], places_m: &[[f64; 3]], poses: &[Pose]) -> f64 {
    let before = |&i: &u32| Vector3::from(places_m[i as usize]);
    let now = |&i: &u32| poses[i as usize].place();
    let per_count = 1.0 / members.len() as f64;
    let centre_before = members.iter().map(before).sum::<Vector3<f64>>() * per_count;
    let centre_now = members.iter().map(now).sum::<Vector3<f64>>() * per_count;
    let products = members
        .iter()
        .map(|i| (now(i) - centre_now) * (before(i) - centre_before).transpose());
    let svd = products.sum::<Matrix3<f64>>().svd(true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else {
        return f64::INFINITY;
    };
    let handedness = (u * v_t).determinant().signum();
    let turn = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, handedness)) * v_t;
    let apart = members
        .iter()
        .map(|i| now(i) - centre_now - turn * (before(i) - centre_before));
    let farthest_m = apart.map(|apart| apart.norm()).fold(0.0, f64::max);
    if turn[(0, 0)].is_finite() {
        farthest_m
    } else {
        f64::INFINITY
    }
}
