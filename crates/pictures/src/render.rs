//! Draws shaded balls and light-grey walls.
//!
//! Balls are exact spheres: each of four samples per pixel has its own depth. Walls are translucent
//! for balls behind them. Two lights: a lamp from the upper left, which casts shadows of the balls,
//! and a sky, of which balls deep in a heap see less.
//!
//! All computations are in view space: px from the left, from the top, and from the middle of the
//! scene towards the viewer.

mod band;
mod depths;
mod light;
mod linear;
mod scene;
mod shade;
mod shapes;

pub use scene::Ball;

use rayon::prelude::*;

use super::camera::Camera;
use super::image::Image;
use super::surface::Surface;
use band::{Band, ROWS};
use scene::Scene;
use shapes::range;

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
