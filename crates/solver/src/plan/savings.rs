//! What leaving a stage out saves: the bytes that its arrays would take, and the time that it would take in each step.

use std::mem::size_of;

use super::stages::PlannedStage;
use crate::clock::Stage;
use crate::physics::bond::incremental::History;
use crate::state::State;
use crate::state::particles::Wrench;

/// What a stage that is left out would take if the scene asked for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saving {
    /// Bytes of its arrays.
    pub bytes: usize,
    /// ns per step on one thread, by what its items take on the machine of doc/leave-out.md.
    pub ns: f64,
}

/// ns per bond, or per particle, of a body of 25,547 particles: see doc/leave-out.md.
const HISTORY_NS: f64 = 37.6;
const FAILURE_NS: f64 = 2.1;
const SCATTER_NS: f64 = 1.2;
const BOND_DAMPING_NS: f64 = 19.3;
const PARTICLE_DAMPING_NS: f64 = 37.6;

/// What leaving out a stage of a state saves. None: it depends on what the bodies would do.
pub fn saving(stage: &PlannedStage, state: &State) -> Option<Saving> {
    let (particles, bonds) = (state.particles.free, state.bonds.len());
    let of = |count: usize, bytes: usize, ns: f64| Saving {
        bytes: count * bytes,
        ns: count as f64 * ns,
    };
    let wrench = size_of::<Wrench>();
    let saved = match stage.stage {
        Stage::Histories => of(bonds, size_of::<History>(), HISTORY_NS),
        Stage::Failure => of(bonds, 0, FAILURE_NS),
        Stage::Scatter => of(bonds, size_of::<f64>(), SCATTER_NS),
        Stage::BondDamping => {
            let of_bonds = of(bonds, size_of::<[f64; 4]>(), BOND_DAMPING_NS);
            Saving {
                bytes: of_bonds.bytes + particles * wrench,
                ..of_bonds
            }
        }
        Stage::ParticleDamping => of(particles, wrench, PARTICLE_DAMPING_NS),
        _ => return None,
    };
    (saved.ns > 0.0).then_some(saved)
}
