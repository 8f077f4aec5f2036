//! Unknown degrees of freedom of the particles, and the final displacements of the held ones.

use dem_scene::{Factor, Hold};

use crate::state::State;
use crate::state::loads::factor_at;
use crate::state::particles::Pose;

/// The particle and the degree of freedom (0 to 5) of an unknown, and the place of the particle, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Number of the particle.
    pub particle: usize,
    /// Translation along x, y, z, or rotation about x, y, z.
    pub freedom: usize,
    /// Initial centre, m. Length 3.
    pub place_m: [f64; 3],
    /// Radius, m.
    pub radius_m: f64,
}

/// Marks a held degree of freedom.
pub(crate) const HELD: usize = usize::MAX;

/// The degrees of freedom of all particles: translations along x, y, z, then rotations about x, y,
/// z.
#[derive(Debug, Clone, PartialEq)]
pub struct DegreesOfFreedom {
    /// For each particle the numbers of its degrees of freedom among the unknowns, ascending; or
    /// `usize::MAX` for one that is held. Length 6 each.
    pub unknown: Vec<[usize; 6]>,
    /// Number of unknowns.
    pub count: usize,
    /// Particles that supports move or rotate, and their displacement from the start to the end: m,
    /// and rotation vectors in rad. It is 0 for a degree of freedom that is free or fixed.
    pub moved: Vec<(u32, [f64; 6])>,
}

impl DegreesOfFreedom {
    /// For a state at its start, with the motions that its supports prescribe until `end_s`.
    pub fn new(state: &State, end_s: f64) -> Self {
        let mut held = vec![[false; 6]; state.particles.len()];
        let mut moves = vec![[0.0; 6]; state.particles.len()];
        for support in &state.supports {
            let way = support
                .holds
                .map(|hold| hold.map(|hold| way(hold, &support.factor, end_s)));
            for one in &support.held {
                let i = one.particle as usize;
                for (k, way) in way.iter().enumerate() {
                    if let Some(way) = way {
                        held[i][k] = true;
                        moves[i][k] = *way;
                    }
                }
            }
        }
        let mut count = 0;
        let unknown = held.iter().map(|held| {
            held.map(|held| {
                if held {
                    return HELD;
                }
                count += 1;
                count - 1
            })
        });
        let unknown = unknown.collect();
        let moved = (0_u32..).zip(moves);
        Self {
            unknown,
            count,
            moved: moved
                .filter(|(_, by)| by.iter().any(|x| *x != 0.0))
                .collect(),
        }
    }

    /// Number of held degrees of freedom.
    pub fn held(&self) -> usize {
        6 * self.unknown.len() - self.count
    }

    /// The unknowns of all particles, each with its particle and the index, 0 to 5, of its degree
    /// of freedom.
    pub fn unknowns(&self) -> impl Iterator<Item = (usize, usize)> {
        let six = |(i, of): (usize, &[usize; 6])| {
            let of = *of;
            (0..6).filter(move |k| of[*k] != HELD).map(move |k| (i, k))
        };
        self.unknown.iter().enumerate().flat_map(six)
    }

    /// The nodes of the unknowns, at the present places of the particles.
    pub fn nodes(&self, poses: &[Pose]) -> Vec<Node> {
        let node = |(particle, freedom): (usize, usize)| {
            let [x, y, z, radius_m] = poses[particle].position_m;
            Node {
                particle,
                freedom,
                place_m: [x, y, z],
                radius_m,
            }
        };
        self.unknowns().map(node).collect()
    }

    /// Whether a torque may act, at rest, on a particle with more than one free rotation: then the
    /// tangent is not symmetric, even in equilibrium. The torque is that of a load, or of a support
    /// that holds one of the three rotations.
    pub fn has_free_torques(&self, state: &State) -> bool {
        let free_turns = |i: usize| self.unknown[i][3..].iter().filter(|n| **n != HELD).count();
        let held_once = || (0..self.unknown.len()).any(|i| free_turns(i) == 2);
        let loaded = || {
            let with_torque = state.loads.iter().filter(|l| l.torque_n_m != [0.0; 3]);
            let mut on = with_torque.flat_map(|load| &load.particles);
            on.any(|i| free_turns(*i as usize) > 1)
        };
        held_once() || loaded()
    }
}

/// Displacement of a held degree of freedom until `end_s`, m or rad.
fn way(hold: Hold, factor: &Factor, end_s: f64) -> f64 {
    match hold {
        // No static scene has the end of a bar.
        Hold::Fixed | Hold::Bar { .. } => 0.0,
        Hold::Displacement(d) => d * (factor_at(factor, end_s) - factor_at(factor, 0.0)),
        Hold::Velocity(v) => v * integral_s(factor, end_s),
    }
}

/// Integral of a factor from 0 to `end_s`, s: unless it oscillates, it is linear between its
/// points.
fn integral_s(factor: &Factor, end_s: f64) -> f64 {
    let mut times = vec![0.0, end_s];
    match factor {
        Factor::One => {}
        Factor::Oscillation {
            frequency_hz,
            phase_rad,
        } => {
            let angular_1_s = std::f64::consts::TAU * frequency_hz;
            let turned_rad = angular_1_s * end_s + phase_rad;
            return (phase_rad.cos() - turned_rad.cos()) / angular_1_s - end_s * phase_rad.sin();
        }
        Factor::Ramp { until_s } => times.push(*until_s),
        Factor::Table(points) => times.extend(points.iter().map(|point| point[0])),
    }
    times.retain(|time_s| (0.0..=end_s).contains(time_s));
    times.sort_by(f64::total_cmp);
    let spans = times.windows(2);
    spans
        .map(|span| {
            0.5 * (span[1] - span[0]) * (factor_at(factor, span[0]) + factor_at(factor, span[1]))
        })
        .sum()
}
