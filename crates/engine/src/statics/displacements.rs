//! Displacements and rotations of particles from their present poses.

use crate::state::particles::Pose;
use dem_physics::rigid::turn;

use super::degrees_of_freedom::{DegreesOfFreedom, HELD};

/// Displacements, m, and rotations, rad: rotation vectors in space, applied after the present
/// rotation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Displacements<'a> {
    /// Of the unknowns.
    pub by: &'a [f64],
    /// Displacements of particles that supports move, by their numbers, ascending. Length 6 each.
    pub displacements: &'a [(u32, [f64; 6])],
}

impl Displacements<'_> {
    /// The displacements of all particles, six for each.
    fn of_all<'a>(
        &'a self,
        degrees_of_freedom: &'a DegreesOfFreedom,
    ) -> impl Iterator<Item = [f64; 6]> + 'a {
        let mut displacements = self.displacements.iter().peekable();
        degrees_of_freedom
            .unknown
            .iter()
            .enumerate()
            .map(move |(i, unknown)| {
                let way = displacements.next_if(|(moved, _)| *moved as usize == i);
                let mut six = way.map_or([0.0; 6], |(_, way)| *way);
                for (one, &unknown) in six.iter_mut().zip(unknown) {
                    if unknown != HELD {
                        *one = self.by[unknown];
                    }
                }
                six
            })
    }
}

/// Sets `poses` to `from` plus the displacements.
pub(crate) fn displace(
    poses: &mut [Pose],
    from: &[Pose],
    degrees_of_freedom: &DegreesOfFreedom,
    moves: &Displacements<'_>,
) {
    let all = moves.of_all(degrees_of_freedom);
    for ((pose, from), [x, y, z, rx, ry, rz]) in poses.iter_mut().zip(from).zip(all) {
        let [px, py, pz, radius_m] = from.position_m;
        pose.position_m = [px + x, py + y, pz + z, radius_m];
        pose.turned = turn(from.turned, [rx, ry, rz]);
    }
}

/// The largest rotation of a particle, rad.
pub(crate) fn largest_turn(
    moves: &Displacements<'_>,
    degrees_of_freedom: &DegreesOfFreedom,
) -> f64 {
    let turns = moves
        .of_all(degrees_of_freedom)
        .map(|[.., x, y, z]| x.hypot(y).hypot(z));
    turns.fold(0.0, f64::max)
}
