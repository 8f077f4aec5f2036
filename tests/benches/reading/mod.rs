//! How fast the memory lets a step be: loops that read what a step of bonds or of contacts reads,
//! and do nothing else.

use std::hint::black_box;
use std::time::Instant;

use dem_run::state::State;
use dem_run::state::bonds::{BLOCK, BondBlock};
use dem_run::state::particles::Pose;
use rayon::prelude::*;

/// Number of rounds, of which the median is taken, and passes in each.
const ROUNDS: usize = 7;
const PASSES: usize = 10;
/// Number of bonds, pairs or particles that a thread reads at once.
const CHUNK: usize = 1024;

/// Sums of four numbers. What a loop reads side by side goes into different ones, so that additions
/// wait for the memory and not for each other.
type Sums = [[f64; 4]; 8];

#[inline(always)]
fn add<const N: usize>(sum: &mut [f64; 4], values: &[f64; N]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += value;
    }
}

/// Adds a pose to two sums.
#[inline(always)]
fn add_pose([position, turned]: &mut [[f64; 4]; 2], pose: &Pose) {
    add(position, &pose.position_m);
    add(turned, &pose.turned);
}

fn total(sums: Sums) -> f64 {
    sums.iter().flatten().sum()
}

/// Passes per second, the median of all rounds.
fn passes_per_s(pass: impl Fn() -> f64) -> f64 {
    let mut rates: Vec<f64> = (0..ROUNDS)
        .map(|_| {
            let clock = Instant::now();
            for _ in 0..PASSES {
                black_box(pass());
            }
            PASSES as f64 / clock.elapsed().as_secs_f64()
        })
        .collect();
    rates.sort_by(f64::total_cmp);
    rates[ROUNDS / 2]
}

/// Reads motions and wrenches of all particles once.
fn of_particles(state: &State) -> f64 {
    let motions = state.particles.motions.par_chunks(CHUNK);
    motions
        .zip(state.particles.wrenches.par_chunks(CHUNK))
        .map(|(motions, wrenches)| {
            let mut sums = Sums::default();
            for (motion, wrench) in motions.iter().zip(wrenches) {
                add(&mut sums[0], &motion.velocity_m_s);
                add(&mut sums[1], &motion.spin_rad_s);
                add(&mut sums[2], &wrench.force_n);
                add(&mut sums[3], &wrench.torque_n_m);
            }
            total(sums)
        })
        .sum()
}

/// Million bonds per second of a loop that only reads what a step of bonds reads: each bond's block
/// (72 bytes) and the poses of its ends (64 bytes each), then motions and wrenches of all
/// particles, once each. A step writes the last two and the poses as well.
pub(crate) fn million_bonds_per_s(state: &State) -> f64 {
    let (bonds, poses) = (&state.bonds, &state.particles.poses);
    let of_bonds = |(blocks, ends): (&[BondBlock], &[[u32; 2]])| {
        let mut sums = Sums::default();
        let (mut of_first, mut of_second) = ([[0.0; 4]; 2], [[0.0; 4]; 2]);
        for (block, ends) in blocks.iter().zip(ends.chunks(BLOCK)) {
            let ([x, y, z], [first, second]) = (&block.direction, &block.levers_m);
            let [normal, shear, radii] = [&block.normal, &block.shear, &block.radii_m];
            for (sum, column) in
                (sums.iter_mut()).zip([x, y, z, first, second, normal, shear, radii])
            {
                add(sum, column);
            }
            for [a, b] in ends {
                add_pose(&mut of_first, &poses[*a as usize]);
                add_pose(&mut of_second, &poses[*b as usize]);
            }
        }
        total(sums) + (of_first.iter().chain(&of_second).flatten()).sum::<f64>()
    };
    let pass = || {
        let of_bonds: f64 = (bonds.blocks.par_chunks(CHUNK / BLOCK))
            .zip(bonds.ends.par_chunks(CHUNK))
            .map(of_bonds)
            .sum();
        of_bonds + of_particles(state)
    };
    1e-6 * bonds.len() as f64 * passes_per_s(pass)
}

/// Million particles per second of a loop that only reads what a step of contacts reads: each
/// listed pair (8 bytes), the first cache line of its history (64 bytes) and the poses of its ends,
/// of pairs that touch the motions of both ends, then motions and wrenches of all particles. A step
/// writes the histories, the poses, the motions and the wrenches as well.
pub(crate) fn million_particles_per_s(state: &State) -> f64 {
    let Some(contacts) = &state.contacts else {
        return f64::NAN;
    };
    let (poses, motions) = (&state.particles.poses, &state.particles.motions);
    let pass = || {
        let of_pairs: f64 = (contacts.pairs.par_chunks(CHUNK))
            .zip(contacts.histories.par_chunks(CHUNK))
            .map(|(pairs, histories)| {
                let mut sums = Sums::default();
                let (mut of_first, mut of_second) = ([[0.0; 4]; 2], [[0.0; 4]; 2]);
                for ([a, b], history) in pairs.iter().zip(histories) {
                    let [a, b] = [*a as usize, *b as usize];
                    add_pose(&mut of_first, &poses[a]);
                    add_pose(&mut of_second, &poses[b]);
                    add(&mut sums[0], &history.tangential);
                    if history.overlap_m() > 0.0 {
                        add(&mut sums[1], &history.damping);
                        add(&mut sums[2], &motions[a].velocity_m_s);
                        add(&mut sums[3], &motions[a].spin_rad_s);
                        add(&mut sums[4], &motions[b].velocity_m_s);
                        add(&mut sums[5], &motions[b].spin_rad_s);
                    }
                }
                total(sums) + (of_first.iter().chain(&of_second).flatten()).sum::<f64>()
            })
            .sum();
        of_pairs + of_particles(state)
    };
    1e-6 * state.particles.len() as f64 * passes_per_s(pass)
}

/// Seconds of a loop that only reads what a search for neighbours has to read once: the ball of
/// each particle (32 bytes), each listed pair (8 bytes) and its history (128 bytes). A search
/// writes the last two anew.
pub(crate) fn search_s(state: &State) -> f64 {
    let Some(contacts) = &state.contacts else {
        return f64::NAN;
    };
    let balls = &contacts.scratch.references.balls;
    let pass = || {
        let of_balls: f64 = (balls.par_chunks(CHUNK))
            .map(|balls| {
                let mut sums = Sums::default();
                for (n, ball) in balls.iter().enumerate() {
                    add(&mut sums[n % 8], ball);
                }
                total(sums)
            })
            .sum();
        let of_pairs: f64 = (contacts.pairs.par_chunks(CHUNK))
            .zip(contacts.histories.par_chunks(CHUNK))
            .map(|(pairs, histories)| {
                let mut sums = Sums::default();
                for ([a, b], history) in pairs.iter().zip(histories) {
                    add(&mut sums[0], &[f64::from(*a), f64::from(*b)]);
                    add(&mut sums[1], &history.tangential);
                    add(&mut sums[2], &history.damping);
                    add(&mut sums[3], &history.rolling);
                    add(&mut sums[4], &history.rolling_damping);
                }
                total(sums)
            })
            .sum();
        of_balls + of_pairs
    };
    1.0 / passes_per_s(pass)
}
