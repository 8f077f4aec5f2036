//! Records the forces and contacts that measures need, in every step, so that a peak between two
//! rows of the time series is not missed.

use nalgebra::Vector3;

use super::clusters::bytes::{ClusterUser, clusters_bytes};
use super::contacts::forces::{overlap_m, pair_force_n};
use super::stage::{Need, Stage};
use super::walls::{gap_m, touch_force_n};
use crate::state::State;
use crate::state::contacts::{ContactHistory, Contacts};
use crate::state::walls::{Wall, WallContact};
use crate::state::watches::{Recorded, Watch, WatchTarget, part};

/// Measures, files and pictures.
pub const OUTPUT: Stage = Stage {
    bytes: |state| {
        let watched = state.watches.iter().map(|watch| watch.of.bytes());
        clusters_bytes(state, ClusterUser::Measures) + watched.sum::<usize>()
    },
    ..Stage::new("output", |_, _| {
        Need::Needed("measures, files and pictures".to_owned())
    })
};

/// Sum of the contacts of a watched object.
struct Met {
    force_n: Vector3<f64>,
    /// Deepest overlap, m; for near but separate objects, minus their distance.
    overlap_m: f64,
}

/// Evaluates the watches, between the forces of a step and its end.
pub(crate) fn watch(state: &mut State) -> usize {
    let mut watches = std::mem::take(&mut state.watches);
    for watch in &mut watches {
        if let Some(contacts) = &state.contacts {
            let met = met(watch, state, contacts);
            note(watch, &met, state);
        }
    }
    state.watches = watches;
    0
}

fn note(watch: &mut Watch, met: &Met, state: &State) {
    let seen = &mut watch.seen;
    // The lists cover at least this distance, whether rebuilt in this step or in the previous one.
    let longest_s = state.time_step_s.max(state.previous_time_step_s);
    let sure_m = 2.0 * state.fastest_m_s * longest_s;
    let now_m = met.overlap_m.max(-sure_m);
    if let Some(before_m) = seen.overlap_m {
        seen.touched_s += state.previous_time_step_s * share_above_0(before_m, now_m);
    }
    seen.overlap_m = Some(now_m);
    let value = match watch.quantity {
        Recorded::Force => part(&met.force_n, watch.part),
        Recorded::Overlap => met.overlap_m.max(0.0),
        Recorded::Duration => seen.touched_s,
    };
    // Adding 0 removes the sign of a zero.
    seen.value = value + 0.0;
    seen.history.note(state.time_s, seen.value);
}

/// The fraction of a step in which a value that changes linearly is above 0.
fn share_above_0(before: f64, now: f64) -> f64 {
    match (before > 0.0, now > 0.0) {
        (true, true) => 1.0,
        (false, false) => 0.0,
        _ => before.max(now) / (before - now).abs(),
    }
}

fn met(watch: &Watch, state: &State, contacts: &Contacts) -> Met {
    let mut met = Met {
        force_n: Vector3::zeros(),
        overlap_m: f64::NEG_INFINITY,
    };
    match &watch.of {
        WatchTarget::Wall(wall) => {
            let wall = state.walls.get(*wall);
            met.force_n = wall.map_or(met.force_n, |wall| -Vector3::from(wall.total_load()[0]));
        }
        WatchTarget::Particles(of) => {
            let all = |[a, b]: [bool; 2]| (a != b).then_some(if b { 1.0 } else { -1.0 });
            met.pairs(state, contacts, |pair| all(pair.map(|i| of[i as usize])));
            for (number, wall) in state.walls.iter().enumerate() {
                met.wall(state, contacts, (number, wall), of);
            }
        }
        WatchTarget::WithWall(of, number) => {
            if let Some(wall) = state.walls.get(*number) {
                met.wall(state, contacts, (*number, wall), of);
                if watch.quantity == Recorded::Duration && met.overlap_m <= 0.0 {
                    let near = wall.near.iter().filter(|&&i| of[i as usize]);
                    let gaps = near.map(|&i| gap_m(wall, &state.particles.poses[i as usize]));
                    met.overlap_m = -gaps.fold(f64::INFINITY, f64::min).max(0.0);
                }
            }
        }
        WatchTarget::Between([of, with]) => met.pairs(state, contacts, |[a, b]| {
            let [a, b] = [a as usize, b as usize];
            match (of[b] && with[a], of[a] && with[b]) {
                (true, _) => Some(1.0),
                (_, true) => Some(-1.0),
                _ => None,
            }
        }),
    }
    met
}

impl Met {
    /// Adds contacts between particles. `sign`: 1 for the force on the second of a pair, -1 for
    /// that on the first, none if neither is watched.
    fn pairs(
        &mut self,
        state: &State,
        contacts: &Contacts,
        sign: impl Fn([u32; 2]) -> Option<f64>,
    ) {
        let p = &state.particles;
        for (&pair, history) in contacts.pairs.iter().zip(&contacts.histories) {
            let Some(sign) = sign(pair) else {
                continue;
            };
            if history.overlap_m() > 0.0 {
                self.force_n += sign * pair_force_n(contacts, p, pair, history);
                self.overlap_m = self.overlap_m.max(history.overlap_m());
            } else if self.overlap_m <= 0.0 {
                let apart_m = history.origin_m() - overlap_m(&p.poses, pair);
                self.overlap_m = self.overlap_m.max(-apart_m.max(0.0));
            }
        }
        for kept in state.sleep.iter().flat_map(|sleep| &sleep.pairs) {
            if let Some(sign) = sign(kept.pair) {
                let history = at_rest(&kept.history);
                self.force_n += sign * pair_force_n(contacts, p, kept.pair, &history);
                self.overlap_m = self.overlap_m.max(history.overlap_m());
            }
        }
    }

    /// Adds contacts of the particles selected by `of` with a wall and its number.
    fn wall(
        &mut self,
        state: &State,
        contacts: &Contacts,
        (number, wall): (usize, &Wall),
        of: &[bool],
    ) {
        let mut add = |touch: &WallContact| {
            if of[touch.particle as usize] && touch.history.overlap_m() > 0.0 {
                self.force_n += touch_force_n(wall, contacts, &state.particles, touch);
                self.overlap_m = self.overlap_m.max(touch.history.overlap_m());
            }
        };
        wall.touching.iter().for_each(&mut add);
        let kept = state.sleep.iter().flat_map(|sleep| &sleep.touches);
        for kept in kept.filter(|kept| kept.wall == number) {
            add(&WallContact {
                history: at_rest(&kept.touch.history),
                ..kept.touch
            });
        }
    }
}

/// Contact history of sleeping bodies, without damping: nothing moves.
fn at_rest(history: &ContactHistory) -> ContactHistory {
    let [.., origin_m] = history.damping;
    ContactHistory {
        damping: [0.0, 0.0, 0.0, origin_m],
        ..*history
    }
}
