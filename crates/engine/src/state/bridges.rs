//! Liquid bridges between particles, and between particles and walls.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::renumbered::{NewNumbers, Renumbered};
use super::walls::WallLoad;
use dem_physics::geometry::Touch;

/// All liquid bridges of a state.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Bridges {
    /// Between particles, by pair.
    pub pairs: Vec<PairBridge>,
    /// Between particles and walls, by wall, particle and feature.
    pub walls: Vec<WallBridge>,
    /// Energy lost as bridges formed and ruptured, J.
    pub lost_j: f64,
    /// Number of bridges that have formed and that have ruptured.
    pub formed_and_ruptured: [u64; 2],
}

impl Bridges {
    /// The particles at bridges, in any order, with duplicates.
    pub(crate) fn particles(&self) -> impl Iterator<Item = u32> {
        let of_pairs = self.pairs.iter().flat_map(|bridge| bridge.pair);
        of_pairs.chain(self.walls.iter().map(|bridge| bridge.particle))
    }
}

impl Renumbered for Bridges {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        self.pairs.retain_mut(|bridge| {
            let [Some(a), Some(b)] = bridge.pair.map(|end| by.of(end)) else {
                return false;
            };
            bridge.gap_m += bridge.pair.map(|end| by.less_m(end)).iter().sum::<f64>();
            bridge.pair = [a.min(b), a.max(b)];
            true
        });
        self.pairs.sort_unstable_by_key(|bridge| bridge.pair);
        self.walls.retain_mut(|bridge| {
            let Some(now) = by.of(bridge.particle) else {
                return false;
            };
            bridge.gap_m += by.less_m(bridge.particle);
            bridge.particle = now;
            true
        });
        self.walls.sort_unstable_by_key(WallBridge::key);
    }
}

/// A bridge after a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Stepped<B> {
    pub(crate) bridge: B,
    /// Whether it has ruptured.
    pub(crate) is_ruptured: bool,
    /// Force on its second end, or on its particle, N.
    pub(crate) force_n: Vector3<f64>,
    /// Energy lost in the step, J.
    pub(crate) lost_j: f64,
}

/// The bridges in a step: kept from step to step for their memory only.
#[derive(Debug, Clone, Default)]
pub(crate) struct BridgeScratch {
    pub(crate) pairs: Vec<Stepped<PairBridge>>,
    pub(crate) walls: Vec<Stepped<WallBridge>>,
    /// For each chunk of bridges at walls where a particle touches a wall.
    pub(crate) touches: Vec<Vec<Touch>>,
    /// Keys of the bridges at walls.
    pub(crate) keys: Vec<[u32; 3]>,
}

/// A bridge between two particles.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PairBridge {
    /// The smaller number first.
    pub pair: [u32; 2],
    /// Gap of the surfaces at the last computation of forces, m; below 0: an overlap.
    pub gap_m: f64,
}

/// A bridge between a particle and a wall.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct WallBridge {
    /// Number of the wall.
    pub wall: u32,
    /// Number of the particle.
    pub particle: u32,
    /// Feature of the wall: see [`dem_physics::geometry::Touch`].
    pub feature: u32,
    /// Unit vector from the wall to the centre. Length 3.
    pub normal: [f64; 3],
    /// Gap of the surfaces at the last computation of forces, m; below 0: an overlap.
    pub gap_m: f64,
    /// Load of the wall on the particle.
    pub load: WallLoad,
}

impl WallBridge {
    /// Order of the list.
    pub(crate) fn key(&self) -> [u32; 3] {
        [self.wall, self.particle, self.feature]
    }
}
