//! View of a run: one camera and one scale of colours from its first picture to its last.

use dem_pictures::label::{label, scale_bar, time_text};
use dem_pictures::{Camera, Image, Surface, render};

use super::scale::Scale;
use super::subject::{balls, finite, surfaces};
use crate::geometry::Bounds;
use crate::state::State;
use crate::state::bodies::PlacedBody;

/// Width and height of a picture, px.
pub(crate) const SIZE_PX: [u32; 2] = [960, 540];

/// Distance to which planes are drawn beyond the particles, as a fraction of the width of these.
const ROOM: f64 = 0.55;

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
        let poses = &state.particles.poses;
        let mut points_m: Vec<[f64; 3]> = (poses.iter())
            .flat_map(|pose| outermost(pose.place().into(), pose.radius_m()))
            .collect();
        for inlet in &state.model.rules.inlets {
            points_m.extend(state.model.rules.regions[inlet.region].bounds().corners());
        }
        let room = with_room(Bounds::of(points_m.iter().copied()));
        let finite = state.walls.iter().filter_map(finite);
        let around = finite.fold(room, |around, surface| {
            around.with(&Bounds::of(surface.points_m()))
        });
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
        let balls = balls(state, bodies, self.scale.as_ref());
        let mut image = render(&self.camera, &balls, &surfaces);
        if let Some(scale) = &self.scale {
            scale.draw(&mut image);
        }
        label(&mut image, &time_text(state.time_s, every_s));
        scale_bar(&mut image, self.camera.px_per_m());
        image
    }
}

/// A box with room at its sides, for parts that will fall over or break.
fn with_room(bounds: Bounds) -> Bounds {
    let [x, y] = [0, 1].map(|k| bounds.high[k] - bounds.low[k]);
    // No room if there is nothing.
    let room = if x > 0.0 && y > 0.0 {
        ROOM * (x * y).sqrt()
    } else {
        0.0
    };
    let [a, b, low] = bounds.low;
    let [c, d, high] = bounds.high;
    Bounds {
        low: [a - room, b - room, low],
        high: [c + room, d + room, high],
    }
}

/// The extreme points of a ball along the axes, m. Shape 6 x 3.
fn outermost(centre_m: [f64; 3], radius_m: f64) -> [[f64; 3]; 6] {
    [0, 1, 2, 3, 4, 5].map(|end| {
        let mut point_m = centre_m;
        point_m[end / 2] += if end % 2 == 0 { -radius_m } else { radius_m };
        point_m
    })
}
