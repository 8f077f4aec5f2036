//! Where particles were when their neighbours were last searched for.

pub use super::groups::Ball;

use super::groups::KnownClusters;

/// The last search for the neighbours of each particle. Its pairs cover all that can touch while no
/// particle leaves its ball.
#[derive(Debug, Clone, Default)]
pub struct References {
    /// For each particle the ball around its place at that time: larger than the particle by the
    /// distance that it may move. Empty: all particles are to be searched for.
    pub balls: Vec<Ball>,
    /// For each chunk of free particles the distance that is left to each of them, m, at least.
    pub chunks_left_m: Vec<f64>,
    /// The clumps.
    pub clumps: Vec<ClumpReference>,
    /// Particles to be searched for again, wherever they are: those of new bodies and fragments.
    pub due: Vec<u32>,
    /// The clusters.
    pub clusters: KnownClusters,
}

/// A clump at the last search for its neighbours.
#[derive(Debug, Clone, Copy, Default)]
pub struct ClumpReference {
    /// Centre of mass, m. Length 3.
    pub place_m: [f64; 3],
    /// Rotation: unit quaternion x, y, z, w.
    pub turned: [f64; 4],
    /// Distance that each of its spheres may move, m.
    pub allowance_m: f64,
    /// What is left of it, m, at least.
    pub left_m: f64,
}
