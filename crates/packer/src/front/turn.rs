//! What one block does in its turn.

use super::places::Workspace;
use super::{Front, FrontBall, distance};
use crate::Vector3;
use crate::grid::Ball;
use crate::ledger::class_of;
use crate::seed::climb;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::ops::Range;

/// For a void the next smaller quantile is this part of the last: half of it on average, but never the same part. Halves of halves would fill
/// all voids with a few sizes only, and so many more of those than can be kept back: in a ball, where the front comes to the whole wall last.
const SMALLER: Range<f64> = 1.0 / 3.0..2.0 / 3.0;
/// Quantiles tried at most: the last is some five hundredth of the first.
const FILLERS_TRIED: usize = 9;

/// What a block begins its turn with.
pub(super) struct Task {
    pub(super) block: usize,
    /// Its front spheres.
    pub(super) queue: Vec<FrontBall>,
    /// A draw that waits for a place.
    pub(super) waiting: Option<f64>,
    /// Of random numbers.
    pub(super) stream: u64,
}

/// What all blocks of one colour share.
pub(super) struct Rules<'a> {
    /// How far from their seeds front spheres are worked off, local units; None: voids are filled only.
    pub(super) within: Option<f64>,
    /// For each class of the ledger the probability with which a draw is left out.
    pub(super) left_out: &'a [f64],
    /// Whether voids may be filled.
    pub(super) fills: bool,
}

/// What one block did in its turn.
#[derive(Default)]
pub(super) struct Turn {
    /// Spheres placed.
    pub(super) placed: Vec<Placed>,
    /// A draw that waits for a place.
    pub(super) waiting: Option<f64>,
    /// Their quantiles.
    pub(super) quantiles: Vec<f64>,
    /// How many of them were chosen to fill voids.
    pub(super) fillers: usize,
    /// Front spheres that left the queue with room around them for the smallest sphere.
    pub(super) with_room: Vec<FrontBall>,
    /// Spheres that fill voids and touch no three others or walls.
    pub(super) loose: usize,
}

/// A sphere placed.
pub(super) struct Placed {
    pub(super) ball: FrontBall,
    /// Not even the smallest sphere fits around it any more: it need not enter the queue.
    pub(super) is_done: bool,
}

/// A place in a void.
pub(super) struct Filler {
    pub(super) centre: Vector3,
    pub(super) quantile: f64,
    pub(super) is_loose: bool,
}

impl Front<'_> {
    /// Works off the front spheres of one block as far as the rules say.
    pub(super) fn advance_block(
        &self,
        workspace: &mut Workspace,
        task: Task,
        rules: &Rules,
    ) -> Turn {
        let mut random = ChaCha8Rng::seed_from_u64(self.settings.seed);
        random.set_stream(task.stream);
        let mut turn = Turn::default();
        let draw = |random: &mut ChaCha8Rng| loop {
            let u = random.random::<f64>();
            let share = rules.left_out[class_of(u, rules.left_out.len())];
            if share == 0.0 || random.random::<f64>() >= share {
                return u;
            }
        };
        let largest = self.settings.radius_range[1];
        let mut waiting = task.waiting;
        let mut placed: Vec<Ball> = Vec::new();
        let mut queue = task.queue;
        let mut next = 0;
        while next < queue.len() {
            let (initial, number) = queue[next];
            let seed = &self.seeds[number as usize];
            next += 1;
            self.look_around(workspace, &initial, &placed, largest);
            // Spheres of this quantile and above do not fit around this one any more.
            let mut too_large = f64::INFINITY;
            // A place for the smallest sphere.
            let mut void: Option<Vector3> = None;
            loop {
                if self.settings.fills_voids && void.is_none() {
                    void = self.place_for_smallest(workspace, &initial);
                    if void.is_none() {
                        break;
                    }
                }
                let mut drawn = None;
                if rules.within.is_some() {
                    let u = *waiting.get_or_insert_with(|| draw(&mut random));
                    if u < too_large {
                        drawn = self
                            .best_place(workspace, &initial, self.radius(u), seed)
                            .map(|centre| (centre, u));
                        match drawn {
                            Some(_) => waiting = None,
                            None => too_large = u,
                        }
                    }
                }
                let (centre, u) = if let Some(drawn) = drawn {
                    drawn
                } else if let Some(void) = void.filter(|_| rules.fills) {
                    let filler = self
                        .filler(workspace, &initial, &mut too_large, seed, &mut random)
                        .unwrap_or_else(|| self.roomiest(&void, &placed));
                    turn.fillers += 1;
                    turn.loose += usize::from(filler.is_loose);
                    (filler.centre, filler.quantile)
                } else {
                    if void.is_some() {
                        turn.with_room.push((initial, number));
                    }
                    break;
                };
                let ball = [centre.x, centre.y, centre.z, self.reduced(self.radius(u))];
                workspace
                    .neighbours
                    .gather(&initial, &[ball], self.reduced(largest));
                workspace.neighbours.sort();
                placed.push(ball);
                let reach = ball[3] + self.reduced(self.settings.radius_range[0]);
                void = void.filter(|place| distance(&ball, place) >= reach);
                if self.settings.fills_voids {
                    turn.quantiles.push(u);
                }
                let is_next = self.block_of(&ball).1 == task.block
                    && rules
                        .within
                        .is_some_and(|within| distance(&ball, seed) < within);
                turn.placed.push(Placed {
                    ball: (ball, number),
                    is_done: is_next && self.settings.fills_voids,
                });
                if is_next {
                    queue.push((ball, number));
                }
            }
        }
        turn.waiting = waiting;
        turn
    }

    /// A sphere for a void around `front`: the first that fits as quantiles become smaller, if one of some does.
    /// `too_large` is a quantile that does not fit, and becomes the smallest one known.
    fn filler(
        &self,
        workspace: &mut Workspace,
        front: &Ball,
        too_large: &mut f64,
        seed: &Vector3,
        random: &mut ChaCha8Rng,
    ) -> Option<Filler> {
        for _ in 0..FILLERS_TRIED {
            let quantile = random.random_range(SMALLER) * too_large.min(1.0);
            match self.best_place(workspace, front, self.radius(quantile), seed) {
                Some(centre) => {
                    return Some(Filler {
                        centre,
                        quantile,
                        is_loose: false,
                    });
                }
                None => *too_large = quantile,
            }
        }
        None
    }

    /// The largest sphere for the void around a place that takes the smallest one.
    fn roomiest(&self, void: &Vector3, placed: &[Ball]) -> Filler {
        let [smallest, largest] = self.settings.radius_range;
        let enlarge = 1.0 + self.settings.overlap;
        // No farther from the void than blocks of one colour can bear.
        let room = |p: &Vector3| {
            if (p - void).norm() > 0.5 * self.reduced(largest) {
                return f64::NEG_INFINITY;
            }
            let gap = placed
                .iter()
                .map(|ball| (distance(ball, p) - ball[3]) * enlarge)
                .fold(self.room(p), f64::min);
            gap * (1.0 - 1e-12)
        };
        let roomiest = climb(void, 0.1 * smallest, 1e-3 * smallest, &room);
        let quantile = self.largest_quantile_below(roomiest.radius);
        Filler {
            centre: if quantile > 0.0 {
                roomiest.centre
            } else {
                *void
            },
            quantile,
            is_loose: true,
        }
    }
}
