//! What is left of the tested body.

use dem_engine::state::State;
use dem_plan::measure::sizes::Fragments;
use dem_results::summary::SizeSummary;

/// Pieces of the tested body at the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pieces {
    /// Mass of the body, kg.
    pub mass_kg: f64,
    /// Mass of the largest piece, kg.
    pub largest_kg: f64,
    /// Their sizes.
    pub sizes: SizeSummary,
    /// Mass fraction of its spheres that are smaller than a tenth of it: the largest t10 possible.
    pub largest_t10: f64,
}

impl Pieces {
    /// The pieces of a body, by its name in the scene. None: it cannot break.
    pub(super) fn of(state: &State, body: &str) -> Option<Self> {
        let fragments = Fragments::of(state)?;
        let sizes = fragments.sizes(&state.model);
        let sizes = *sizes.bodies.get(body)?.get("both")?;
        let number = state.model.bodies.iter().position(|one| one.name == body)?;
        Some(Self {
            mass_kg: sizes.mass_kg,
            largest_kg: fragments.largest_kg(number as u32),
            sizes,
            largest_t10: state.model.bodies[number].fine_fraction,
        })
    }
}
