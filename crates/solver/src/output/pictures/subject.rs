//! The visible objects of a state: its particles, coloured by their fragment or on a scale, and its
//! walls.

use dem_pictures::colours::{Piece, SINGLE, of_piece, of_pieces};
use dem_pictures::surface::HalfSpace;
use dem_pictures::{Ball, Surface};

use super::scale::Scale;
use crate::geometry::{Bounds, Shape};
use crate::state::State;
use crate::state::bodies::PlacedBody;
use crate::state::clusters::Cluster;
use crate::state::walls::Wall;

/// All particles: on a scale, if there is one; otherwise by cluster, or by body if there are no
/// clusters.
pub(crate) fn balls(state: &State, bodies: &[PlacedBody], scale: Option<&Scale>) -> Vec<Ball> {
    let colours = match scale {
        Some(scale) => scale.colours(state, bodies),
        None => by_fragment(state, bodies),
    };
    (state.particles.poses.iter().zip(colours))
        .map(|(pose, colour)| Ball {
            centre_m: pose.place().into(),
            radius_m: pose.radius_m(),
            colour,
        })
        .collect()
}

/// The colour of the fragment of each particle. Length: particles.
fn by_fragment(state: &State, bodies: &[PlacedBody]) -> Vec<[u8; 3]> {
    let count = state.particles.len();
    let (of_particle, colours) = match &state.clusters {
        Some(clusters) => (clusters.of_particle.clone(), of_clusters(&clusters.history)),
        None => by_body(count, bodies),
    };
    let colour_of = |i: usize| colours.get(*of_particle.get(i)? as usize).copied();
    (0..count).map(|i| colour_of(i).unwrap_or(SINGLE)).collect()
}

/// All walls in their present position. Planes are infinite: only the part around a scene is drawn,
/// up to other walls.
pub(crate) fn surfaces(walls: &[Wall], around: &Bounds) -> Vec<Surface> {
    let planes: Vec<HalfSpace> = walls.iter().filter_map(half_space).collect();
    let surface = |wall: &Wall| match half_space(wall) {
        Some(plane) => Some(Surface::plane(&plane, around, &planes)),
        None => finite(wall),
    };
    walls.iter().filter_map(surface).collect()
}

fn half_space(wall: &Wall) -> Option<HalfSpace> {
    match &wall.model.shape {
        Shape::Plane(plane) => Some(HalfSpace {
            point_m: wall.frame.to_space(plane.point_m()),
            normal: wall.frame.direction_to_space(plane.normal()),
        }),
        _ => None,
    }
}

/// A wall in its present position. None: a plane is infinite.
pub(super) fn finite(wall: &Wall) -> Option<Surface> {
    let in_its_frame = match &wall.model.shape {
        Shape::Plane(_) => return None,
        Shape::Box(solid) => Surface::solid_box(&solid.bounds()),
        Shape::Cylinder(cylinder) => Surface::cylinder(cylinder.ends_m(), cylinder.radius_m()),
        Shape::Mesh(mesh) => {
            let vertices_m: Vec<[f64; 3]> = mesh.corners_m().flatten().collect();
            let triangles: Vec<[u32; 3]> = (0..vertices_m.len() as u32 / 3)
                .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
                .collect();
            Surface::mesh(&vertices_m, &triangles)
        }
    };
    Some(in_its_frame.moved(&|point_m| wall.frame.to_space(point_m)))
}

/// The colour of each cluster.
pub fn of_clusters(history: &[Cluster]) -> Vec<[u8; 3]> {
    let piece = |cluster: &Cluster| Piece {
        parent: cluster.parent,
        particles: cluster.particles,
    };
    of_pieces(&history.iter().map(piece).collect::<Vec<_>>())
}

/// The body of each particle, and the colour of each body.
pub fn by_body(particles: usize, bodies: &[PlacedBody]) -> (Vec<u32>, Vec<[u8; 3]>) {
    let mut of_particle = vec![u32::MAX; particles];
    for (number, body) in (0..).zip(bodies) {
        for &i in &body.particles {
            if let Some(of_this) = of_particle.get_mut(i as usize) {
                *of_this = number;
            }
        }
    }
    let count = |body: &PlacedBody| body.particles.len() as u32;
    let colours = (0..)
        .zip(bodies)
        .map(|(number, body)| of_piece(number, count(body), count(body)));
    (of_particle, colours.collect())
}
