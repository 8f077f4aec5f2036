//! A band of rows of the picture, with four samples per pixel.

use super::linear::{linear, mixed, stored};
use super::scene::Scene;
use super::shade;
use super::shapes::{Line, crossings, range};

/// Number of rows of pixels in a band.
pub(super) const ROWS: usize = 16;

/// Spacing of the pixels, in both directions, at which the fraction of the sky visible from a wall
/// is computed; it is interpolated between them.
const STEP: usize = 4;
/// Number of rows of such pixels in a band.
const STEPS: usize = ROWS / STEP + 1;

/// Number of wall layers kept at a sample, the nearest ones.
const LAYERS: usize = 4;

/// Fraction of the walls behind it and of the background that a wall hides.
const SOLID: f32 = 0.88;
/// Transmission below which nothing behind is evaluated.
const DARK: f32 = 0.02;

/// Layers closer together than this count as one, px.
const SAME: f32 = 0.02;

/// Lines: colour, width in px, and their darkness when visible and when behind a wall.
const INK: [u8; 3] = [92, 99, 108];
const WIDTH: f64 = 1.15;
const IN_SIGHT: f32 = 0.85;
const BEHIND: f32 = 0.22;

/// No ball.
const NONE: u32 = u32::MAX;

#[derive(Debug, Clone, Copy, Default)]
struct Layer {
    depth: f32,
    face: u32,
}

/// Buffers, used for one band after the other.
pub(super) struct Band {
    /// Number of pixels in a row.
    width: usize,
    /// The first row, px.
    top: f64,
    /// The nearest ball of each sample. Rows of samples, two per pixel in both directions.
    depth: Vec<f32>,
    body: Vec<u32>,
    /// Walls nearer than the ball, the nearest first.
    count: Vec<u8>,
    layers: Vec<[Layer; LAYERS]>,
    light: Vec<[f32; 3]>,
    /// For the faces in the band, in ascending order.
    skies: Vec<Sky>,
}

/// Fraction of the sky visible from one face in a band.
struct Sky {
    face: u32,
    /// The first column of grid points.
    first: usize,
    /// Columns of [`STEPS`] grid points; NaN if not computed yet.
    places: Vec<f32>,
}

impl Sky {
    /// For a face in a picture of this width, px.
    fn new(face: u32, corners: &[[f64; 3]; 3], width: usize) -> Self {
        let [first, last] = range(corners.map(|corner| corner[0]))
            .map(|x| x.clamp(0.0, width as f64) as usize / STEP);
        Self {
            face,
            first,
            places: vec![f32::NAN; STEPS * (last - first + 2)],
        }
    }

    /// Value in the middle of a pixel of the band, whose first row is `top`, px.
    fn at(&mut self, scene: &Scene, top: f64, column: usize, row: usize) -> f32 {
        let face = &scene.faces[self.face as usize];
        let mut place = |i: usize, j: usize| {
            let [x, y] = [(i * STEP) as f32, top as f32 + (j * STEP) as f32];
            let new = || scene.lights.sky_at(face.point(x, y), face.normal);
            let at = i.checked_sub(self.first).map(|i| STEPS * i + j);
            match at.and_then(|at| self.places.get_mut(at)) {
                Some(known) => {
                    if known.is_nan() {
                        *known = new();
                    }
                    *known
                }
                None => new(),
            }
        };
        let (i, j) = (column / STEP, row / STEP);
        let [x, y] = [column, row].map(|at| ((at % STEP) as f32 + 0.5) / STEP as f32);
        let above = place(i, j) * (1.0 - x) + place(i + 1, j) * x;
        let below = place(i, j + 1) * (1.0 - x) + place(i + 1, j + 1) * x;
        above * (1.0 - y) + below * y
    }
}

impl Band {
    pub(super) fn new(width: usize) -> Self {
        let samples = 4 * width * ROWS;
        Self {
            width,
            top: 0.0,
            depth: vec![0.0; samples],
            body: vec![NONE; samples],
            count: vec![0; samples],
            layers: vec![[Layer::default(); LAYERS]; samples],
            light: vec![[0.0; 3]; width * ROWS],
            skies: Vec::new(),
        }
    }

    /// Makes this the empty band of this index.
    pub(super) fn clear(&mut self, index: usize) {
        self.top = (index * ROWS) as f64;
        self.depth.fill(f32::NEG_INFINITY);
        self.body.fill(NONE);
        self.count.fill(0);
        self.skies.clear();
    }

    /// Samples with their middle between two positions, px, among `end` of them.
    fn samples(low: f64, high: f64, end: usize) -> std::ops::Range<usize> {
        let first = |at: f64| (2.0 * at - 0.5).ceil().clamp(0.0, end as f64) as usize;
        first(low)..first(high)
    }

    pub(super) fn add_bodies(&mut self, scene: &Scene, numbers: &[u32]) {
        let wide = 2 * self.width;
        for &number in numbers {
            let body = scene.bodies[number as usize];
            let [x, y, z]: [f32; 3] = body.centre.into();
            let (middle, radius) = (f64::from(y) - self.top, f64::from(body.radius));
            for row in Self::samples(middle - radius, middle + radius, 2 * ROWS) {
                let dy = 0.5 * (row as f64 + 0.5) - middle;
                let chord = radius * radius - dy * dy;
                let half = chord.max(0.0).sqrt();
                let columns = Self::samples(f64::from(x) - half, f64::from(x) + half, wide);
                let chord = chord as f32;
                let first = columns.start;
                let here = row * wide + columns.start..row * wide + columns.end;
                let depths = &mut self.depth[here.clone()];
                for (k, (there, owner)) in depths.iter_mut().zip(&mut self.body[here]).enumerate() {
                    let dx = 0.5 * ((first + k) as f32 + 0.5) - x;
                    let depth = z + (chord - dx * dx).max(0.0).sqrt();
                    if depth > *there {
                        *there = depth;
                        *owner = number;
                    }
                }
            }
        }
    }

    /// Adds faces; called after the balls.
    pub(super) fn add_faces(&mut self, scene: &Scene, numbers: &[u32]) {
        let wide = 2 * self.width;
        for &number in numbers {
            let face = &scene.faces[number as usize];
            self.skies.push(Sky::new(number, &face.corners, self.width));
            let [low, high] = range(face.corners.map(|c| c[1] - self.top));
            for row in Self::samples(low, high, 2 * ROWS) {
                let y = self.top + 0.5 * (row as f64 + 0.5);
                let [left, right] = crossings(&face.corners, y);
                let at_left = face.depth(0.25, y);
                for column in Self::samples(left, right, wide) {
                    let depth = (at_left + 0.5 * column as f64 * face.slope[0]) as f32;
                    let at = row * wide + column;
                    if depth > self.depth[at] {
                        self.add_layer(
                            at,
                            Layer {
                                depth,
                                face: number,
                            },
                        );
                    }
                }
            }
        }
    }

    fn add_layer(&mut self, at: usize, layer: Layer) {
        let layers = &mut self.layers[at];
        let count = usize::from(self.count[at]);
        let place = layers[..count]
            .iter()
            .position(|other| layer.depth > other.depth - SAME)
            .unwrap_or(count);
        if place == LAYERS || (place < count && (layers[place].depth - layer.depth).abs() < SAME) {
            return;
        }
        let end = (count + 1).min(LAYERS);
        layers[place..end].rotate_right(1);
        layers[place] = layer;
        self.count[at] = end as u8;
    }

    /// The four samples of a pixel, and their positions, px from its corner.
    fn of_pixel(&self, column: usize, row: usize) -> [(usize, [f32; 2]); 4] {
        let first = 4 * row * self.width + 2 * column;
        let below = first + 2 * self.width;
        [
            (first, [0.25, 0.25]),
            (first + 1, [0.75, 0.25]),
            (below, [0.25, 0.75]),
            (below + 1, [0.75, 0.75]),
        ]
    }

    /// Computes the light of every pixel.
    pub(super) fn resolve(&mut self, scene: &Scene) {
        let mut shaded: Vec<(u32, [f32; 3])> = Vec::new();
        let mut skies = std::mem::take(&mut self.skies);
        for row in 0..ROWS {
            for column in 0..self.width {
                let samples = self.of_pixel(column, row);
                let is_empty =
                    |(at, _): &(usize, _)| self.body[*at] == NONE && self.count[*at] == 0;
                if samples.iter().all(is_empty) {
                    self.light[row * self.width + column] = [1.0; 3];
                    continue;
                }
                let place = [column as f32, self.top as f32 + row as f32];
                shaded.clear();
                let mut sum = [0.0; 3];
                let mut last = (NONE, None);
                for (at, _) in samples {
                    let number = self.body[at];
                    if number != last.0 {
                        last = (number, self.body_light(scene, samples, number, place));
                    }
                    let behind = last.1;
                    let mut shade = |number: u32| {
                        if let Some((_, light)) = shaded.iter().find(|known| known.0 == number) {
                            return *light;
                        }
                        let face = &scene.faces[number as usize];
                        let sky = skies
                            .binary_search_by_key(&number, |sky| sky.face)
                            .map_or(1.0, |k| skies[k].at(scene, self.top, column, row));
                        let light = shade::face(scene, face, place[0] + 0.5, place[1] + 0.5, sky);
                        shaded.push((number, light));
                        light
                    };
                    let light = self.over(scene, at, behind, &mut shade);
                    sum = [0, 1, 2].map(|k| sum[k] + 0.25 * light[k]);
                }
                self.light[row * self.width + column] = sum;
            }
        }
    }

    /// The light of a ball in a pixel: in the middle of all samples of the pixel that show it.
    fn body_light(
        &self,
        scene: &Scene,
        samples: [(usize, [f32; 2]); 4],
        number: u32,
        place: [f32; 2],
    ) -> Option<[f32; 3]> {
        let body = scene.bodies.get(number as usize)?;
        let mut sum = [0.0; 3];
        for (other, [x, y]) in samples {
            if self.body[other] == number {
                sum = [sum[0] + x, sum[1] + y, sum[2] + 1.0];
            }
        }
        let [x, y] = [0, 1].map(|k| place[k] + sum[k] / sum[2]);
        Some(shade::body(scene, body, x, y))
    }

    /// The light of a sample: its walls, each with its light, over the ball or the background.
    fn over(
        &self,
        scene: &Scene,
        at: usize,
        behind: Option<[f32; 3]>,
        shade: &mut dyn FnMut(u32) -> [f32; 3],
    ) -> [f32; 3] {
        let mut through = 1.0;
        let mut sum = [0.0; 3];
        for layer in &self.layers[at][..usize::from(self.count[at])] {
            let face = &scene.faces[layer.face as usize];
            let light = shade(layer.face);
            let opacity = if behind.is_some() {
                face.opacity
            } else {
                SOLID
            };
            sum = [0, 1, 2].map(|k| sum[k] + through * opacity * light[k]);
            through *= 1.0 - opacity;
            if through < DARK {
                break;
            }
        }
        let rest = behind.unwrap_or([1.0; 3]);
        [0, 1, 2].map(|k| sum[k] + through * rest[k])
    }

    /// Draws lines over the resolved pixels.
    pub(super) fn add_lines(&mut self, scene: &Scene, numbers: &[u32]) {
        for &number in numbers {
            self.add_line(scene, scene.lines[number as usize]);
        }
    }

    fn add_line(&mut self, scene: &Scene, [a, b]: Line) {
        let along = [0, 1, 2].map(|k| b[k] - a[k]);
        let square = along[0] * along[0] + along[1] * along[1];
        let length = square.sqrt();
        if length < 0.05 {
            return;
        }
        let reach = 0.5 * WIDTH + 0.5;
        for row in 0..ROWS {
            let y = self.top + row as f64 + 0.5;
            // The part of the line near this row, and the columns around it.
            let mut part = [0.0f64, 1.0];
            if along[1].abs() > 1e-9 {
                let ends = [y - 1.5, y + 1.5].map(|y| (y - a[1]) / along[1]);
                part = [
                    part[0].max(ends[0].min(ends[1])),
                    part[1].min(ends[0].max(ends[1])),
                ];
            } else if (y - a[1]).abs() > 1.5 {
                continue;
            }
            if part[0] > part[1] {
                continue;
            }
            let ends = part.map(|t| a[0] + t * along[0]);
            let first = (ends[0].min(ends[1]) - 2.0).clamp(0.0, self.width as f64) as usize;
            let last = (ends[0].max(ends[1]) + 3.0).clamp(0.0, self.width as f64) as usize;
            for column in first..last {
                let from = [column as f64 + 0.5 - a[0], y - a[1]];
                let t = ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0);
                let off = [from[0] - t * along[0], from[1] - t * along[1]];
                let distance = (off[0] * off[0] + off[1] * off[1]).sqrt();
                let cover = (reach - distance).clamp(0.0, 1.0) as f32;
                if cover > 0.0 {
                    let depth = a[2] + t * along[2];
                    let sight = self.sight(scene, column, row, depth);
                    let light = &mut self.light[row * self.width + column];
                    *light = mixed(*light, linear(INK), cover * sight);
                }
            }
        }
    }

    /// Darkness of a line at this depth in a pixel.
    fn sight(&self, scene: &Scene, column: usize, row: usize, depth: f64) -> f32 {
        let of_sample = |at: usize| {
            if f64::from(self.depth[at]) > depth + 1.0 {
                return 0.0;
            }
            let walls = &self.layers[at][..usize::from(self.count[at])];
            let is_hidden = walls.first().is_some_and(|layer| {
                let slope = scene.faces[layer.face as usize].slope;
                let steep = (slope[0].abs() + slope[1].abs()).min(20.0);
                f64::from(layer.depth) > depth + 1.0 + 1.5 * steep
            });
            if is_hidden { BEHIND } else { IN_SIGHT }
        };
        let sum: f32 = self
            .of_pixel(column, row)
            .map(|(at, _)| of_sample(at))
            .iter()
            .sum();
        0.25 * sum
    }

    /// Stores the band, up to the number of rows of the picture.
    pub(super) fn write(&self, pixels: &mut [u8]) {
        for (pixel, light) in pixels.chunks_exact_mut(3).zip(&self.light) {
            pixel.copy_from_slice(&stored(*light));
        }
    }
}
