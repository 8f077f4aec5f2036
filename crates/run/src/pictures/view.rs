//! View of a run: one camera and one scale of colours from its first picture to its last.

use dem_pictures::label::{label, scale_bar, time_text};
use dem_pictures::{Camera, Image, Surface, render};

use super::region_names::write_names;
use super::scale::Scale;
use super::subject::{around, balls, outlines_of_regions, points_of, regions_near, surfaces};
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::particles::Pose;
use dem_physics::geometry::Bounds;
use dem_physics::geometry::region::Region;

/// Width and height of a picture, px.
pub(crate) const SIZE_PX: [u32; 2] = [960, 540];

/// Upward direction in a picture.
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// The camera of a run, the extent of planes, and the colours of particles.
#[derive(Debug, Clone, Copy)]
pub struct View {
    camera: Camera,
    around: Bounds,
    /// None: each fragment has its own colour.
    scale: Option<Scale>,
}

impl View {
    /// Shows all particles, inlets and walls of a state at its start, and of planes a patch around
    /// the rest. `from`: direction of the viewer, of any length; None: from the front, the right
    /// and above. `scale`: colours of particles; None: by fragment.
    pub fn of(state: &State, from: Option<[f64; 3]>, scale: Option<Scale>) -> Self {
        Self::around(state, from, scale, points_of(state))
    }

    /// As [`Self::of`], with all regions near the scene.
    pub fn with_regions(state: &State, from: Option<[f64; 3]>) -> Self {
        let mut points_m = points_of(state);
        points_m.extend(regions_near(state, &points_m));
        Self::around(state, from, None, points_m)
    }

    fn around(
        state: &State,
        from: Option<[f64; 3]>,
        scale: Option<Scale>,
        mut points_m: Vec<[f64; 3]>,
    ) -> Self {
        let around = around(state, &points_m);
        let surfaces = surfaces(&state.walls, &around);
        points_m.extend(surfaces.iter().flat_map(Surface::points_m));
        let camera = match from {
            Some(from) => Camera::around(from.map(|c| -c), UP, &points_m, SIZE_PX),
            None => Camera::three_quarter(&points_m, SIZE_PX),
        };
        Self {
            camera,
            around,
            scale,
        }
    }

    /// The picture of a state, with its time. `every_s`: time between pictures, s.
    pub fn picture(&self, state: &State, bodies: &[PlacedBody], every_s: f64) -> Image {
        let surfaces = surfaces(&state.walls, &self.around);
        self.drawn(state, bodies, &surfaces, every_s)
    }

    /// As [`Self::picture`], with the edges of the boxes around all regions, and their names, in
    /// their order.
    pub fn picture_with_regions<'a>(
        &self,
        state: &State,
        bodies: &[PlacedBody],
        every_s: f64,
        names: impl Iterator<Item = &'a String>,
    ) -> Image {
        let mut surfaces = surfaces(&state.walls, &self.around);
        surfaces.extend(outlines_of_regions(state));
        let mut image = self.drawn(state, bodies, &surfaces, every_s);
        let bounds = state.model.rules.regions.iter().map(Region::bounds);
        write_names(&mut image, &self.camera, bounds.zip(names));
        image
    }

    /// Number of particles whose centres are outside the picture.
    pub fn outside(&self, state: &State) -> usize {
        let [wide, high] = SIZE_PX.map(f64::from);
        let poses = state.particles.poses.iter();
        let is_outside = |pose: &&Pose| {
            let [x, y, _] = self.camera.project(pose.place().into());
            !(0.0..=wide).contains(&x) || !(0.0..=high).contains(&y)
        };
        poses.filter(is_outside).count()
    }

    fn drawn(
        &self,
        state: &State,
        bodies: &[PlacedBody],
        surfaces: &[Surface],
        every_s: f64,
    ) -> Image {
        let balls = balls(state, bodies, self.scale.as_ref());
        let mut image = render(&self.camera, &balls, surfaces);
        if let Some(scale) = &self.scale {
            scale.draw(&mut image);
        }
        label(&mut image, &time_text(state.time_s, every_s));
        scale_bar(&mut image, self.camera.px_per_m());
        image
    }
}
