//! Checks that supports hold every piece: a piece that can move as a rigid body has no equilibrium.

use dem_io::{Diagnostic, Result};
use nalgebra::{Matrix6, SymmetricEigen, Vector3, Vector6};

use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bodies::called;
use dem_io::disjoint::{find, join};

/// A rigid motion counts as held from this fraction of the best held one: about 1e-6 in lengths.
const HELD: f64 = 1e-12;

/// Refuses a state with a piece that can move as a rigid body: a body without bonds, a particle
/// without any, a body with too few supports.
pub(crate) fn refuse_loose(state: &State, bodies: &[PlacedBody], scene: &str) -> Result<()> {
    let count = state.particles.len();
    let mut names: Vec<u32> = (0..count as u32).collect();
    let whole = (0..state.bonds.len()).filter(|at| !state.bonds.is_broken(*at));
    for at in whole {
        let [a, b] = state.bonds.ends[at];
        join(&mut names, a, b);
    }
    let mut pieces: Vec<Vec<u32>> = vec![Vec::new(); count];
    for i in 0..count as u32 {
        pieces[find(&mut names, i) as usize].push(i);
    }
    let mut holds = vec![[false; 6]; count];
    for support in &state.supports {
        for held in &support.held {
            for (holds, hold) in holds[held.particle as usize].iter_mut().zip(&support.holds) {
                *holds |= hold.is_some();
            }
        }
    }
    for body in bodies.iter().filter(|body| !body.particles.is_empty()) {
        let own = body.first_particle..body.first_particle + body.particles.len();
        let is_loose = own.clone().all(|i| pieces[i].len() == 1);
        if is_loose && own.clone().any(|i| holds[i] != [true; 6]) {
            return Err(Diagnostic::input(
                format!("{scene}: [bodies.{}]", body.name),
                "the body has no bonds, and run.integrator = \"static\" finds the equilibrium of bonds",
                "name a body with bonds, hold all its freedoms, or write run.integrator = \"leapfrog\"",
            ));
        }
    }
    for piece in pieces.iter().filter(|piece| !piece.is_empty()) {
        let free = free_motions(piece, state, &holds);
        if free == 0 {
            continue;
        }
        let one = called(bodies, &state.clumps, piece[0]);
        let (what, remedy) = if piece.len() == 1 {
            (
                format!("{one} has no bond"),
                "hold all its freedoms by [supports], or bond it",
            )
        } else {
            (
                format!(
                    "the piece of {} particles with {one} is not held",
                    piece.len()
                ),
                "hold more of it by [supports]; fixed = true on some particles is enough",
            )
        };
        return Err(Diagnostic::input(
            format!("{scene}: run.integrator"),
            format!(
                "{what}: {free} of its 6 rigid motions {} free, so that \"static\" has no equilibrium to find",
                if free == 1 { "is" } else { "are" }
            ),
            remedy,
        ));
    }
    Ok(())
}

/// Number of the six rigid motions of a piece that its held degrees of freedom leave free.
fn free_motions(piece: &[u32], state: &State, holds: &[[bool; 6]]) -> usize {
    let place = |i: &u32| state.particles.poses[*i as usize].place();
    let centre = piece.iter().map(place).sum::<Vector3<f64>>() / piece.len() as f64;
    let far_m = |i: &u32| (place(i) - centre).norm();
    let size_m = piece.iter().map(far_m).fold(0.0, f64::max);
    let size_m = if size_m > 0.0 { size_m } else { 1.0 };
    // Displacement of a held degree of freedom in translations along, and in rotations by 1/size
    // about, the three axes.
    let mut gram = Matrix6::<f64>::zeros();
    for i in piece {
        let arm = (place(i) - centre) / size_m;
        for (k, _) in holds[*i as usize].iter().enumerate().filter(|(_, h)| **h) {
            let mut axis = Vector3::zeros();
            axis[k % 3] = 1.0;
            let mut moves = Vector6::zeros();
            if k < 3 {
                moves.fixed_rows_mut::<3>(0).copy_from(&axis);
                moves.fixed_rows_mut::<3>(3).copy_from(&arm.cross(&axis));
            } else {
                moves.fixed_rows_mut::<3>(3).copy_from(&axis);
            }
            gram += moves * moves.transpose();
        }
    }
    let values = SymmetricEigen::new(gram).eigenvalues;
    let largest = values.max();
    values.iter().filter(|v| **v <= HELD * largest).count()
}
