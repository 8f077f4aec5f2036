//! The mixing index of a probe.

use dem_io::units::significant;
use dem_scene::Statistic;

use super::measurement::Measurement;
use super::mixture::{FEWEST_MIXED_CELLS, MixedCell, Mixture};
use super::probe::Probe;
use super::spheres::spheres;
use dem_engine::state::State;

/// Largest error of a mixing index that is not doubtful: at 95 % confidence it is known within
/// twice as much.
const LARGEST_INDEX_ERROR: f64 = 0.05;

pub(super) const MEASUREMENTS: &[Measurement] = &[Measurement {
    needs_clusters: true,
    missing: |probe| {
        let within = probe.measure.within.as_deref().unwrap_or_default();
        Some(format!(
            "the region \"{within}\" has nothing of one of the two, cell_size is so small that no cell has two pieces, or so large that fewer than {FEWEST_MIXED_CELLS} cells hold something"
        ))
    },
    ..Measurement::new("mixing_index", |probe, view| {
        (probe.mixing(view.state)).map_or(f64::NAN, |mixture| mixture.lacey_index())
    })
}];

impl Probe {
    /// What the cells of a mixing index hold of its two sets. None for other quantities.
    pub(super) fn mixing(&self, state: &State) -> Option<Mixture> {
        let cell_m = self.measure.cell_size_m?;
        let region = self.region?;
        let own = spheres(&self.members, state);
        let others = self.with.as_ref().map(|with| spheres(with, state));
        let region = &state.model.rules.regions[region];
        Some(Mixture::of(
            [&own, &others.unwrap_or_default()],
            region,
            cell_m,
        ))
    }

    /// Whether it is a mixing index.
    pub fn mixes(&self) -> bool {
        self.measure.cell_size_m.is_some()
    }

    /// What the cells of a mixing index hold. Empty for other quantities.
    pub fn mixed_cells(&self, state: &State) -> Vec<MixedCell> {
        (self.mixing(state)).map_or(Vec::new(), |mixture| mixture.cells().collect())
    }

    /// Reason to doubt a mixing index, from how far it may be off. None for other quantities.
    pub fn coarse_cells(&self) -> Option<String> {
        let [last, largest] = self.history.index_errors;
        let error = match self.measure.statistic {
            Statistic::End => last,
            Statistic::Largest | Statistic::Smallest | Statistic::Mean => largest,
        };
        if error.sum() <= LARGEST_INDEX_ERROR || self.history.last?.1.is_nan() {
            return None;
        }
        let place = format!("measures.{}", self.name);
        let [standard, within] = [error.standard, error.within_cells].map(|x| significant(x, 2));
        let allowed = format!("where {LARGEST_INDEX_ERROR} is allowed");
        Some(if error.within_cells > error.standard {
            format!(
                "{place}: the two sets lie apart within its cells, or these hold fewer than 3 pieces, too few to tell, which makes its index too large by {within} or more, {allowed}; choose another cell_size, or take it for an upper bound"
            )
        } else {
            format!(
                "{place}: its cells hold so few pieces, or are so few, that its index has a standard error of {standard}, {allowed}; choose a larger cell_size or a larger region"
            )
        })
    }
}
