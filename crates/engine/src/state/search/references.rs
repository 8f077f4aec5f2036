//! Where particles were when their neighbours were last searched for.

use super::clusters::KnownClusters;
use super::rigid_balls::ClumpReference;
use dem_physics::geometry::balls::Ball;

/// The last search for the neighbours of each particle. Its pairs cover all that can touch while no
/// particle leaves its ball.
#[derive(Debug, Clone, Default)]
pub struct References {
    /// For each particle the ball around its place at that time: larger than the particle by the
    /// distance that it may move. Those of the spheres of large clumps are not set: they follow
    /// from `clumps`. Empty: all particles are to be searched for.
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
