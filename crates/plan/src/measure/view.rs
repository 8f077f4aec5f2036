//! A state as measures see it.

use std::cell::OnceCell;

use dem_engine::stages::clumps::motion::synchronous;
use dem_engine::stages::ledger::totals::synchronous_motions;
use dem_engine::state::State;
use dem_engine::state::clumps::Clump;
use dem_engine::state::clusters::fragments;
use dem_engine::state::particles::Motion;
use dem_results::Balance;
use nalgebra::Vector3;

use super::utilisation::{DynamicUtilisation, dynamic_utilisations};

/// Velocities at the time of the positions: one for each particle, and the motion of each clump.
pub(super) struct Motions {
    pub(super) particles: Vec<Motion>,
    pub(super) clumps: Vec<Clump>,
}

/// A state at one time, and what several measures need of it, computed for the first of them.
pub(super) struct View<'a> {
    pub(super) state: &'a State,
    pub(super) balance: &'a Balance,
    motions: OnceCell<Motions>,
    masses_kg: OnceCell<Vec<f64>>,
    bonds: OnceCell<Vec<Option<DynamicUtilisation>>>,
}

impl<'a> View<'a> {
    pub(super) fn new(state: &'a State, balance: &'a Balance) -> Self {
        Self {
            state,
            balance,
            motions: OnceCell::new(),
            masses_kg: OnceCell::new(),
            bonds: OnceCell::new(),
        }
    }

    pub(super) fn motions(&self) -> &Motions {
        self.motions.get_or_init(|| Motions {
            particles: synchronous_motions(self.state),
            clumps: synchronous(self.state),
        })
    }

    /// Mass of every cluster, kg.
    pub(super) fn masses_kg(&self) -> &[f64] {
        self.masses_kg
            .get_or_init(|| masses_of_pieces_kg(self.state))
    }

    /// All bonds; broken ones are none.
    pub(super) fn bonds(&self) -> &[Option<DynamicUtilisation>] {
        self.bonds.get_or_init(|| dynamic_utilisations(self.state))
    }

    /// Against gravity; without gravity along z.
    pub(super) fn up(&self) -> Vector3<f64> {
        let down = Vector3::from(self.state.model.gravity_m_s2);
        (-down).try_normalize(0.0).unwrap_or_else(Vector3::z)
    }
}

/// Mass of every cluster, of what is inside and of what has left through outlets, kg.
fn masses_of_pieces_kg(state: &State) -> Vec<f64> {
    let Some(clusters) = &state.clusters else {
        return Vec::new();
    };
    let all = fragments(clusters, &state.particles, &state.clumps, None);
    let gone = state.population.discharged.iter();
    let gone = gone.map(|gone| gone.size.mass_kg);
    all.iter().map(|one| one.mass_kg).chain(gone).collect()
}
