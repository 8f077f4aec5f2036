//! Bodies that are bonded in a region only: momenta and energy as spheres are released and join
//! again, closed forms, the step, and the same bits.

mod books;
mod closed_forms;
mod same_bits;

use dem_engine::state::State;
use dem_engine::state::rigid_parts::RigidPart;
use dem_plan::Plan;

use crate::clumps::{HEAD, MEETS, block};
use crate::helpers::planned;

/// A block of 6 x 3 x 3 spheres that differ in size, with these lines.
fn lump(more: &str) -> String {
    let radius = |[x, y, z]: [i32; 3]| {
        Some(1e-3 * (1.0 - 0.02 * f64::from(x) - 0.03 * f64::from(y) - 0.01 * f64::from(z)))
    };
    block("lump", [6, 3, 3], 2e-3, radius, more)
}

const FLIES: &str =
    "position = [0.1, 0.2, 0.3]\nvelocity = [1, -2, 3]\nangular_velocity = [20, -30, 10]\n";

/// A lump that flies and spins, bonded in this box, which a wall may carry.
fn flying(corners: [[f64; 3]; 2], more: &str) -> Plan {
    planned(&flying_text(corners, more))
}

fn flying_text([min, max]: [[f64; 3]; 2], more: &str) -> String {
    let zone = format!("{FLIES}bonded_within = {{ region = \"zone\"{more} }}\n");
    format!(
        "{HEAD}{MEETS}{}[regions.zone]\nbox = {{ min = {min:?}, max = {max:?} }}\n\
         [walls.blade]\nbox = {{ min = [9, 9, 9], max = [9.1, 9.1, 9.1] }}\nmaterial = \"stuff\"\n\
         velocity = [1, -2, 8]\nangular_velocity = [0, 0, 3]\n",
        lump(&zone)
    )
}

/// Everywhere, nowhere, and the upper layer of the lump at the start.
const EVERYWHERE: [[f64; 3]; 2] = [[-9.0; 3], [9.0; 3]];
const NOWHERE: [[f64; 3]; 2] = [[-9.0; 3], [-8.0; 3]];
const TOP: [[f64; 3]; 2] = [[-9.0, -9.0, 0.3031], [9.0; 3]];
/// The upper two layers.
const UPPER: [[f64; 3]; 2] = [[-9.0, -9.0, 0.3011], [9.0; 3]];

/// Gives the bonded spheres velocities of this size to and fro, m/s.
fn disturb(state: &mut State, by_m_s: f64) {
    for i in 0..state.particles.free {
        let sign = if i % 2 == 0 { by_m_s } else { -by_m_s };
        let is_rigid = |part: &RigidPart| part.members.contains(&(i as u32));
        if !state.rigid_parts.all.iter().any(is_rigid) {
            let motion = &mut state.particles.motions[i];
            motion.velocity_m_s = motion.velocity_m_s.map(|v| v + sign);
        }
    }
}

/// Number of spheres in rigid parts.
fn rigid(state: &State) -> usize {
    let parts = state.rigid_parts.all.iter();
    parts.map(|part| part.members.len()).sum()
}
