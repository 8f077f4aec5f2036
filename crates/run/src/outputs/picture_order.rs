//! View and interval of pictures.

use crate::pictures::View;
use crate::pictures::scale::Scale;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_scene::Scene;

/// View and interval of the pictures of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Order {
    pub(super) view: View,
    pub(super) every_s: f64,
}

impl Order {
    /// From the initial state and bodies. None: no pictures.
    pub(crate) fn of(scene: &Scene, start: &State, bodies: &[PlacedBody]) -> Option<Self> {
        let output = scene.output.as_ref()?;
        let every_s = output.pictures_s?;
        let scale = Scale::of(output.colour_by, start, bodies);
        Some(Self {
            every_s,
            view: View::of(start, output.view_from, scale),
        })
    }
}
