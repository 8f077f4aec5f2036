//! The objects to draw, in view space.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::light::Lights;
use super::linear::linear;
use super::shapes::{Body, Face, Line};
use crate::camera::Camera;
use crate::surface::{Surface, Triangle};

/// Objects with coordinates beyond this are ignored, px.
const FARTHEST_PX: f64 = 1e7;

/// A ball to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre, m. Length 3.
    pub centre_m: [f64; 3],
    /// Radius, m. Balls without a positive radius are ignored.
    pub radius_m: f64,
    /// Its colour: red, green, blue.
    pub colour: [u8; 3],
}

/// All objects to draw.
pub(super) struct Scene {
    pub(super) bodies: Vec<Body>,
    pub(super) faces: Vec<Face>,
    pub(super) lines: Vec<Line>,
    pub(super) lights: Lights,
    /// Depths of the farthest and the nearest point, px.
    pub(super) depth: [f32; 2],
}

impl Scene {
    pub(super) fn new(camera: &Camera, balls: &[Ball], walls: &[Surface]) -> Self {
        let mut bodies: Vec<Body> = balls.iter().filter_map(|b| body(camera, b)).collect();
        let triangles: Vec<[[f64; 3]; 3]> = walls
            .iter()
            .flat_map(|wall| &wall.triangles)
            .filter_map(|triangle| corners(camera, triangle))
            .collect();
        let lights = Lights::new(&bodies, &triangles, camera);
        bodies
            .par_iter_mut()
            .for_each(|body| body.sky = lights.sky_of(body));
        let lines = walls.iter().flat_map(|wall| lines(camera, wall));
        Self {
            faces: walls.iter().flat_map(|wall| faces(camera, wall)).collect(),
            lines: lines.collect(),
            bodies,
            lights,
            depth: camera.depth_px().map(|depth| depth as f32),
        }
    }
}

fn body(camera: &Camera, ball: &Ball) -> Option<Body> {
    let centre = projected(camera, ball.centre_m)?;
    let radius = ball.radius_m * camera.px_per_m();
    let is_sane = radius > 0.0 && radius < FARTHEST_PX;
    is_sane.then(|| Body {
        centre: centre.map(|x| x as f32).into(),
        radius: radius as f32,
        colour: linear(ball.colour),
        sky: [1.0, 0.0, 0.0, 0.0],
    })
}

fn faces(camera: &Camera, wall: &Surface) -> impl Iterator<Item = Face> {
    wall.triangles
        .iter()
        .filter_map(|triangle| face(wall, corners(camera, triangle)?))
}

fn corners(camera: &Camera, triangle: &Triangle) -> Option<[[f64; 3]; 3]> {
    let [a, b, c] = triangle.corners_m.map(|corner| projected(camera, corner));
    Some([a?, b?, c?])
}

fn face(wall: &Surface, corners: [[f64; 3]; 3]) -> Option<Face> {
    let [a, b, c] = corners;
    let [u, v] = [b, c].map(|p| Vector3::from(p) - Vector3::from(a));
    // Positive if seen from outside: y points downwards.
    let area = u[1] * v[0] - u[0] * v[1];
    if area.abs() < 1e-9 || (wall.solid && area < 0.0) {
        return None;
    }
    let slope = [
        (u[1] * v[2] - u[2] * v[1]) / area,
        (u[2] * v[0] - u[0] * v[2]) / area,
    ];
    let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
    // Also not if a slope is not finite.
    length.is_finite().then(|| Face {
        corners,
        slope,
        normal: Vector3::new(-slope[0], -slope[1], 1.0).map(|x| (x / length) as f32),
        colour: linear(wall.colour),
        opacity: wall.opacity.clamp(0.0, 1.0),
    })
}

fn lines(camera: &Camera, wall: &Surface) -> impl Iterator<Item = Line> {
    wall.edges.iter().filter_map(|edge| {
        let [a, b] = edge.ends_m.map(|end| projected(camera, end));
        let (a, b) = (a?, b?);
        if let Some(beside) = edge.beside_m {
            let [c, d] = beside.map(|corner| projected(camera, corner));
            let side = |p: [f64; 3]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            if side(c?) * side(d?) < 0.0 {
                return None;
            }
        }
        Some([a, b])
    })
}

fn projected(camera: &Camera, point_m: [f64; 3]) -> Option<[f64; 3]> {
    let point = camera.project(point_m);
    // Also not if it is NaN.
    let is_near = point.iter().all(|x| x.abs() < FARTHEST_PX);
    is_near.then_some(point)
}
