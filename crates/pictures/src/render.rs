//! Draws shaded balls and light-grey walls.
//!
//! Balls are exact spheres: each of four samples per pixel has its own depth. Walls are translucent
//! for balls behind them. Two lights: a lamp from the upper left, which casts shadows of the balls,
//! and a sky, of which balls deep in a heap see less.
//!
//! All computations are in view space: px from the left, from the top, and from the middle of the
//! scene towards the viewer.

mod band;
mod light;
mod shade;

use nalgebra::Vector3;
use rayon::prelude::*;

use super::camera::Camera;
use super::image::Image;
use super::surface::{Surface, Triangle};
use band::{Band, ROWS};
use light::Lights;

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

/// A ball in view space, px.
#[derive(Debug, Clone, Copy)]
struct Body {
    centre: Vector3<f32>,
    radius: f32,
    colour: [f32; 3],
    /// Visible fraction of the sky: the mean, and its gradient along each axis.
    sky: [f32; 4],
}

/// A triangle in view space, px.
#[derive(Debug, Clone, Copy)]
struct Face {
    corners: [[f64; 3]; 3],
    /// Change of depth to the right and downwards.
    slope: [f64; 2],
    /// Unit vector towards the viewer.
    normal: Vector3<f32>,
    colour: [f32; 3],
    opacity: f32,
}

/// A line in view space, px.
type Line = [[f64; 3]; 2];

/// All objects to draw.
struct Scene {
    bodies: Vec<Body>,
    faces: Vec<Face>,
    lines: Vec<Line>,
    lights: Lights,
    /// Depths of the farthest and the nearest point, px.
    depth: [f32; 2],
}

/// The picture taken by a camera. Objects that are not finite or absurdly far away are ignored.
///
/// A camera without width or height gives a picture without pixels.
pub fn render(camera: &Camera, balls: &[Ball], walls: &[Surface]) -> Image {
    let [width, height] = camera.size_px();
    let mut image = Image::new(width, height, [255; 3]);
    if width == 0 || height == 0 {
        return image;
    }
    let scene = Scene::new(camera, balls, walls);
    let bands = (height as usize).div_ceil(ROWS);
    let of_bodies = by_band(&scene.bodies, bands, |body| {
        [-1.0, 1.0].map(|side| f64::from(body.centre[1] + side * body.radius))
    });
    let of_faces = by_band(&scene.faces, bands, |face| {
        range(face.corners.map(|c| c[1]))
    });
    let of_lines = by_band(&scene.lines, bands, |line| range(line.map(|c| c[1])));
    let rows = (image.rgb_mut()).par_chunks_mut(3 * ROWS * width as usize);
    rows.enumerate().for_each_init(
        || Band::new(width as usize),
        |band, (index, pixels)| {
            band.clear(index);
            band.add_bodies(&scene, &of_bodies[index]);
            band.add_faces(&scene, &of_faces[index]);
            band.resolve(&scene);
            band.add_lines(&scene, &of_lines[index]);
            band.write(pixels);
        },
    );
    image
}

impl Scene {
    fn new(camera: &Camera, balls: &[Ball], walls: &[Surface]) -> Self {
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
        colour: shade::linear(ball.colour),
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
        colour: shade::linear(wall.colour),
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

fn range<const N: usize>(values: [f64; N]) -> [f64; 2] {
    let low = values.into_iter().fold(f64::INFINITY, f64::min);
    let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
    [low, high]
}

/// For each band of rows, the items that reach into it, in their order.
fn by_band<T>(all: &[T], bands: usize, rows: impl Fn(&T) -> [f64; 2]) -> Vec<Vec<u32>> {
    let mut of_bands = vec![Vec::new(); bands];
    for (number, one) in (0..).zip(all) {
        let [low, high] = rows(one);
        // Lines have a finite width.
        let first = ((low - 2.0) / ROWS as f64).floor().max(0.0) as usize;
        let last = ((high + 2.0) / ROWS as f64).floor();
        if last >= 0.0 {
            let end = (last as usize + 1).min(bands);
            for band in of_bands.get_mut(first..end).unwrap_or_default() {
                band.push(number);
            }
        }
    }
    of_bands
}
