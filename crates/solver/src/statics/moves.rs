//! Moves and turns of particles from where they stand.

use crate::physics::rigid::turn;
use crate::state::particles::Pose;

use super::freedoms::{Freedoms, HELD};

/// Moves, m, and turns, rad: rotation vectors in space, applied after the present rotation.
#[derive(Debug, Clone, Copy)]
pub struct Moves<'a> {
    /// Of the unknowns.
    pub by: &'a [f64],
    /// Of particles that supports move, by their numbers, rising. Length 6 each.
    pub ways: &'a [(u32, [f64; 6])],
}

/// Puts `poses` where `from` comes to by `part` of the moves. A turn that is prescribed together with others about other axes is one rotation vector.
pub fn displace(
    poses: &mut [Pose],
    from: &[Pose],
    freedoms: &Freedoms,
    moves: &Moves<'_>,
    part: f64,
) {
    let mut ways = moves.ways.iter().peekable();
    for (i, (pose, from)) in poses.iter_mut().zip(from).enumerate() {
        let mut all = match ways.next_if(|(moved, _)| *moved as usize == i) {
            Some((_, way)) => *way,
            None => [0.0; 6],
        };
        for (all, &unknown) in all.iter_mut().zip(&freedoms.unknown[i]) {
            if unknown != HELD {
                *all = moves.by[unknown];
            }
        }
        let [x, y, z, rx, ry, rz] = all.map(|move_or_turn| part * move_or_turn);
        let [px, py, pz, radius_m] = from.position_m;
        pose.position_m = [px + x, py + y, pz + z, radius_m];
        pose.turned = turn(from.turned, [rx, ry, rz]);
    }
}
