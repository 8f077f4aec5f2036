//! The visible objects of a state: its particles, coloured by their fragment or on a scale, and its
//! walls.

use dem_pictures::colours::{Piece, SINGLE, of_piece, of_pieces};
use dem_pictures::surface::HalfSpace;
use dem_pictures::{Ball, Surface};

use super::reach::{Reach, nearest};
use super::scale::Scale;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::Cluster;
use dem_engine::state::walls::Wall;
use dem_physics::geometry::region::Region;
use dem_physics::geometry::{Bounds, Mesh, Shape};

/// Distance to which planes are drawn beyond the particles, as a fraction of the width of these.
const ROOM: f64 = 0.55;

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

/// The outermost points of all particles, and those that fed bodies will reach, m. Shape n x 3.
pub(crate) fn points_of(state: &State) -> Vec<[f64; 3]> {
    let poses = &state.particles.poses;
    let mut points_m: Vec<[f64; 3]> = (poses.iter())
        .flat_map(|pose| outermost(pose.place().into(), pose.radius_m()))
        .collect();
    points_m.extend(Reach::of(state).points_m);
    let scene = with_walls(Bounds::of(points_m.iter().copied()), state);
    points_m.extend(Reach::outlets(state, &scene));
    points_m
}

/// The box around the walls that are no planes.
pub(crate) fn around_walls(state: &State) -> Bounds {
    with_walls(Bounds::EMPTY, state)
}

/// A box, and the walls that are no planes.
fn with_walls(bounds: Bounds, state: &State) -> Bounds {
    state.walls.iter().fold(bounds, |bounds, wall| {
        let corners = corners_m(&wall.model.shape).unwrap_or_default();
        let in_space = corners.into_iter().flatten();
        let in_space = in_space.map(|corner| wall.frame.to_space(corner));
        bounds.with(&Bounds::of(in_space))
    })
}

/// The corners of all regions, of large ones only near a scene with these points, m. Shape n x 3.
pub(crate) fn regions_near(state: &State, points_m: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let scene = with_walls(Bounds::of(points_m.iter().copied()), state);
    let near = scene.grown(0.5 * scene.longest_side_m());
    let regions = state.model.rules.regions.iter().map(Region::bounds);
    let nearest = regions.map(|region| nearest(&region, &near));
    nearest.flat_map(|region| region.corners()).collect()
}

/// The edges of the boxes around all regions.
pub(crate) fn outlines_of_regions(state: &State) -> Vec<Surface> {
    let regions = state.model.rules.regions.iter();
    regions
        .map(|region| Surface {
            triangles: Vec::new(),
            ..Surface::solid_box(&region.bounds())
        })
        .collect()
}

/// The box of a scene around which planes are drawn: these points, m, with room at their sides, and
/// the walls that are no planes.
pub(crate) fn around(state: &State, points_m: &[[f64; 3]]) -> Bounds {
    let points = Bounds::of(points_m.iter().copied());
    let room = with_room(points, Reach::of(state).fall_m);
    let room = points.with(&room.common(&Reach::within(state)));
    with_walls(room, state)
}

/// A box with room at its sides, for parts that will fall over or break, and for bodies that fall
/// from an inlet by `fall_m`.
fn with_room(bounds: Bounds, fall_m: f64) -> Bounds {
    let [x, y] = [0, 1].map(|k| bounds.high[k] - bounds.low[k]);
    // No room if there is nothing.
    let room = if x > 0.0 && y > 0.0 {
        ROOM * (x * y).sqrt().max(fall_m)
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

/// All walls in their present position. Planes are infinite: only the part around a scene is drawn,
/// up to other walls.
pub(crate) fn surfaces(walls: &[Wall], around: &Bounds) -> Vec<Surface> {
    let planes = half_spaces(walls);
    let surface = |wall: &Wall| match half_space(wall) {
        Some(plane) => Some(Surface::plane(&plane, around, &planes)),
        None => finite(wall),
    };
    walls.iter().filter_map(surface).collect()
}

/// The part of a plane around a scene, up to the other planes among the walls: the corners of its
/// triangles, m. None: the wall is no plane.
pub(crate) fn plane_patch(
    wall: &Wall,
    walls: &[Wall],
    around: &Bounds,
) -> Option<Vec<[[f64; 3]; 3]>> {
    let surface = Surface::plane(&half_space(wall)?, around, &half_spaces(walls));
    Some(surface.triangles.iter().map(|t| t.corners_m).collect())
}

fn half_spaces(walls: &[Wall]) -> Vec<HalfSpace> {
    walls.iter().filter_map(half_space).collect()
}

fn half_space(wall: &Wall) -> Option<HalfSpace> {
    let plane = wall.model.shape.plane()?;
    Some(HalfSpace {
        point_m: wall.frame.to_space(plane.point_m()),
        normal: wall.frame.direction_to_space(plane.normal()),
    })
}

/// The corners of the triangles of a shape in its own frame, m. None: a plane is infinite.
pub(crate) fn corners_m(shape: &Shape) -> Option<Vec<[[f64; 3]; 3]>> {
    if let Some(mesh) = shape.mesh() {
        return Some(mesh.corners_m().collect());
    }
    let surface = solid(shape)?;
    Some(surface.triangles.iter().map(|t| t.corners_m).collect())
}

/// A wall in its present position. None: a plane is infinite.
fn finite(wall: &Wall) -> Option<Surface> {
    let shape = &wall.model.shape;
    let in_its_frame = shape.mesh().map(two_sided).or_else(|| solid(shape))?;
    Some(in_its_frame.moved(&|point_m| wall.frame.to_space(point_m)))
}

fn two_sided(mesh: &Mesh) -> Surface {
    let vertices_m: Vec<[f64; 3]> = mesh.corners_m().flatten().collect();
    let triangles: Vec<[u32; 3]> = (0..vertices_m.len() as u32 / 3)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect();
    Surface::mesh(&vertices_m, &triangles)
}

/// A solid of finite size in its own frame.
fn solid(shape: &Shape) -> Option<Surface> {
    match shape {
        Shape::Box(solid) => Some(Surface::solid_box(&solid.bounds())),
        Shape::Cylinder(pin) => Some(Surface::cylinder(pin.ends_m(), pin.radius_m())),
        Shape::Plane(_) | Shape::Mesh(_) => None,
    }
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
