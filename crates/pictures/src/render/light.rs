//! The parts visible from the lamp and the sky: depth maps, each along one direction.
//!
//! A ball casts its shadow on objects behind it as far as the next wall. There the shadow of the
//! wall begins, which is fainter and falls on walls only.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::depths::Depths;
use super::shapes::{Body, crossings, range};
use crate::camera::Camera;

/// Direction to the lamp in view space, where y points downwards: from the upper left, a little
/// from the front. Any length.
const LAMP: Vector3<f32> = Vector3::new(-0.42, -0.78, 0.46);
/// Direction to the middle of the sky. Any length.
const ZENITH: Vector3<f32> = Vector3::new(-0.08, -0.76, 0.64);

/// Number of directions of the sky.
const SKY: usize = 14;
/// Cosine and sine of the golden angle, the angle between successive directions.
const GOLDEN: [f32; 2] = [-0.737_368_9, 0.675_490_3];

/// Largest number of texels along a side of a map of the lamp and of the sky.
const LAMP_TEXELS: f32 = 1536.0;
const SKY_TEXELS: f32 = 400.0;

/// Fraction of light that a wall lets through to other walls.
const THROUGH_WALL: f32 = 0.62;

/// Number of texels along a side of a block, of which the nearest depth is kept.
const BLOCK: usize = 8;

/// The lights on all balls.
pub(super) struct Lights {
    lamp: Map,
    sky: Vec<Map>,
    /// Direction to the middle of the sky.
    pub(super) zenith: Vector3<f32>,
}

/// The object that receives light.
#[derive(Clone, Copy)]
enum Receiver {
    Ball,
    /// A wall, with the distance by which other walls must be in front of it to count, px.
    Wall(f32),
}

impl Lights {
    /// The lights on balls and on triangles, in view space. Shape n x 3 x 3, px.
    pub(super) fn new(bodies: &[Body], triangles: &[[[f64; 3]; 3]], camera: &Camera) -> Self {
        let [width, height] = camera.size_px().map(|side| side as f32);
        let reach = 1.5 * (width + height);
        let middle = [0.5 * width, 0.5 * height, 0.0];
        // Balls that flew away must not make the maps coarse.
        let near: Vec<&Body> = bodies
            .iter()
            .filter(|body| (0..3).all(|k| (body.centre[k] - middle[k]).abs() + body.radius < reach))
            .collect();
        let mean = near.iter().map(|body| body.radius).sum::<f32>() / near.len().max(1) as f32;
        let lamp = (0.12 * mean).max(0.7);
        let sky = (0.5 * mean).max(0.8);
        // Objects outside the picture are not lit.
        let [far, close] = camera.depth_px();
        let high = [f64::from(width), f64::from(height), close.max(far)];
        let low = [0.0, 0.0, far];
        let inside = |p: &[f64; 3]| [0, 1, 2].map(|k| p[k].clamp(low[k], high[k]) as f32).into();
        let points: Vec<Vector3<f32>> = triangles.iter().flatten().map(inside).collect();
        let zenith = ZENITH.normalize();
        let map =
            |towards, texel, most| Map::new(towards, &near, triangles, &points, [texel, most]);
        Self {
            lamp: map(LAMP.normalize(), lamp, LAMP_TEXELS),
            sky: directions(zenith)
                .into_par_iter()
                .map(|towards| map(towards, sky, SKY_TEXELS))
                .collect(),
            zenith,
        }
    }

    /// Direction to the lamp.
    pub(super) fn lamp(&self) -> Vector3<f32> {
        self.lamp.towards
    }

    /// Fraction of the lamp visible from a point of a ball, 0 to 1.
    pub(super) fn lamp_on_ball(&self, point: Vector3<f32>, bias: f32) -> f32 {
        self.lamp.soft(point, bias, Receiver::Ball)
    }

    /// Fraction of the lamp visible from a point of a flat wall that faces it, 0 to 1.
    pub(super) fn lamp_on_wall(&self, point: Vector3<f32>, facing: f32) -> f32 {
        let bias = 1.0 + 3.0 * self.lamp.texel * steepness(facing);
        self.lamp.soft(point, 1.0, Receiver::Wall(bias))
    }

    /// Fraction of the sky visible from a point of a flat wall, 0 to 1.
    pub(super) fn sky_at(&self, point: Vector3<f32>, normal: Vector3<f32>) -> f32 {
        let mut seen = 0.0;
        let mut all = 1e-6;
        for map in &self.sky {
            let facing = normal.dot(&map.towards);
            if facing > 0.05 {
                let bias = 1.0 + 2.0 * map.texel * steepness(facing);
                all += facing;
                seen += facing * map.smooth(point, 0.5 * map.texel, Receiver::Wall(bias));
            }
        }
        if all > 1e-3 { seen / all } else { 1.0 }
    }

    /// Fraction of the sky visible from a ball: the mean, and its gradient along each axis.
    pub(super) fn sky_of(&self, body: &Body) -> [f32; 4] {
        let fraction = 1.0 / SKY as f32;
        let seen: Vec<f32> = self.sky.iter().map(|map| map.seen(body)).collect();
        let mean = seen.iter().sum::<f32>() * fraction;
        let mut fit = [mean, 0.0, 0.0, 0.0];
        for (map, seen) in self.sky.iter().zip(seen) {
            for k in 0..3 {
                fit[k + 1] += 1.5 * fraction * (seen - mean) * map.towards[k];
            }
        }
        fit
    }
}

/// Directions around the zenith, denser near it.
fn directions(zenith: Vector3<f32>) -> [Vector3<f32>; SKY] {
    let [right, up] = across(zenith);
    let mut turn = [1.0, 0.0];
    std::array::from_fn(|k| {
        // Squared sine of the angle from the zenith.
        let square = 0.96 * (k as f32 + 0.5) / SKY as f32;
        let (out, along) = (square.sqrt(), (1.0 - square).sqrt());
        turn = [
            GOLDEN[0] * turn[0] - GOLDEN[1] * turn[1],
            GOLDEN[1] * turn[0] + GOLDEN[0] * turn[1],
        ];
        along * zenith + out * (turn[0] * right + turn[1] * up)
    })
}

/// Depths of the nearest ball and the nearest wall towards a light, for each texel of a grid
/// perpendicular to its direction.
struct Map {
    towards: Vector3<f32>,
    across: [Vector3<f32>; 2],
    /// The corner of the first texel.
    low: [f32; 2],
    /// Side of a texel, px.
    texel: f32,
    wide: usize,
    high: usize,
    balls: Depths,
    walls: Depths,
    /// The nearest depths, of balls and of walls, in each block of texels and the blocks around it.
    blocks: Vec<[f32; 2]>,
}

impl Map {
    /// The map of all these balls and points, with a smallest size of texels, px, and a largest
    /// number of them along a side.
    fn new(
        towards: Vector3<f32>,
        bodies: &[&Body],
        triangles: &[[[f64; 3]; 3]],
        points: &[Vector3<f32>],
        [texel, most]: [f32; 2],
    ) -> Self {
        let across = across(towards);
        let mut low = [f32::INFINITY; 2];
        let mut high = [f32::NEG_INFINITY; 2];
        for point in points {
            for k in 0..2 {
                let place = point.dot(&across[k]);
                low[k] = low[k].min(place);
                high[k] = high[k].max(place);
            }
        }
        for body in bodies {
            for k in 0..2 {
                let place = body.centre.dot(&across[k]);
                low[k] = low[k].min(place - body.radius);
                high[k] = high[k].max(place + body.radius);
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 2], [0.0; 2]);
        }
        let extent = [0, 1].map(|k| high[k] - low[k]);
        let texel = texel.max(extent[0].max(extent[1]) / most);
        // A free texel on every side.
        let low = low.map(|low| low - 1.5 * texel);
        let [wide, high] = extent.map(|extent| (extent / texel).ceil() as usize + 4);
        let mut map = Self {
            towards,
            across,
            low,
            texel,
            wide,
            high,
            balls: Depths::new(wide * high),
            walls: Depths::new(wide * high),
            blocks: Vec::new(),
        };
        for body in bodies {
            map.add(body);
        }
        for triangle in triangles {
            map.add_triangle(triangle);
        }
        map.fill_blocks();
        map
    }

    /// Position in texels, and depth.
    fn place(&self, point: Vector3<f32>) -> [f32; 3] {
        [
            (point.dot(&self.across[0]) - self.low[0]) / self.texel,
            (point.dot(&self.across[1]) - self.low[1]) / self.texel,
            point.dot(&self.towards),
        ]
    }

    fn add(&mut self, body: &Body) {
        let [x, y, z] = self.place(body.centre);
        let radius = body.radius / self.texel;
        let range = |middle: f32, end: usize| {
            let first = (middle - radius).floor().max(0.0) as usize;
            let last = (middle + radius).floor().max(0.0) as usize;
            first..(last + 1).min(end)
        };
        for row in range(y, self.high) {
            for column in range(x, self.wide) {
                let [dx, dy] = [column as f32 + 0.5 - x, row as f32 + 0.5 - y];
                let left = radius * radius - dx * dx - dy * dy;
                if left > 0.0 {
                    let depth = z + self.texel * left.sqrt();
                    let there = &mut self.balls[row * self.wide + column];
                    *there = there.max(depth);
                }
            }
        }
    }

    fn add_triangle(&mut self, corners: &[[f64; 3]; 3]) {
        let placed =
            corners.map(|corner| self.place(corner.map(|x| x as f32).into()).map(f64::from));
        let [a, b, c] = placed;
        let [u, v] = [b, c].map(|p| Vector3::from(p) - Vector3::from(a));
        let area = u[1] * v[0] - u[0] * v[1];
        if area.abs() < 1e-9 {
            return;
        }
        let right = (u[1] * v[2] - u[2] * v[1]) / area;
        let down = (u[2] * v[0] - u[0] * v[2]) / area;
        let texels = |low: f64, high: f64, end: usize| {
            let first = |at: f64| (at - 0.5).ceil().clamp(0.0, end as f64) as usize;
            first(low)..first(high)
        };
        let [low, high] = range(placed.map(|corner| corner[1]));
        for row in texels(low, high, self.high) {
            let y = row as f64 + 0.5;
            let [left, end] = crossings(&placed, y);
            let at_left = a[2] + right * (0.5 - a[0]) + down * (y - a[1]);
            for column in texels(left, end, self.wide) {
                let depth = (at_left + right * column as f64) as f32;
                let there = &mut self.walls[row * self.wide + column];
                *there = there.max(depth);
            }
        }
    }

    fn fill_blocks(&mut self) {
        let [across, down] = [self.wide, self.high].map(|side| side.div_ceil(BLOCK));
        let [balls, walls] = [&self.balls, &self.walls].map(|depths| {
            let rows = depths.chunks(BLOCK * self.wide);
            rows.flat_map(|rows| nearest_of_blocks(rows, self.wide))
        });
        let inner: Vec<[f32; 2]> = balls.zip(walls).map(|(ball, wall)| [ball, wall]).collect();
        let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
        for row in 0..down {
            for column in 0..across {
                let all = around(row, down)
                    .flat_map(|y| &inner[y * across..][around(column, across)])
                    .fold([f32::NEG_INFINITY; 2], |a, b| {
                        [a[0].max(b[0]), a[1].max(b[1])]
                    });
                self.blocks.push(all);
            }
        }
    }

    /// Fraction of light that a texel lets through to a depth.
    fn light(&self, x: usize, y: usize, z: f32, bias: f32, receiver: Receiver) -> f32 {
        if x >= self.wide || y >= self.high {
            return 1.0;
        }
        let at = y * self.wide + x;
        let (ball, wall) = (self.balls[at], self.walls[at]);
        let before = match receiver {
            Receiver::Ball => bias,
            Receiver::Wall(before) => before,
        };
        let is_behind_wall = wall > z + before;
        if ball > z + bias && !(is_behind_wall && ball > wall) {
            return 0.0;
        }
        match receiver {
            Receiver::Wall(_) if is_behind_wall => THROUGH_WALL,
            _ => 1.0,
        }
    }

    /// True if nothing is in front of any texel around this position.
    fn is_free(&self, [x, y, z]: [f32; 3], bias: f32, receiver: Receiver) -> bool {
        // Also not if it is NaN.
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.wide as f32 && y < self.high as f32;
        !is_inside || {
            let [column, row] = [x, y].map(|at| at as usize / BLOCK);
            let [ball, wall] = self.blocks[row * self.wide.div_ceil(BLOCK) + column];
            ball <= z + bias
                && match receiver {
                    Receiver::Ball => true,
                    Receiver::Wall(before) => wall <= z + before,
                }
        }
    }

    /// Lit fraction of a point: four texels.
    fn smooth(&self, point: Vector3<f32>, bias: f32, receiver: Receiver) -> f32 {
        let [x, y, z] = self.place(point);
        if self.is_free([x, y, z], bias, receiver) {
            return 1.0;
        }
        let [x, y] = [x, y].map(|at| (at - 0.5).max(0.0));
        let (column, row) = (x as usize, y as usize);
        let (fx, fy) = (x - column as f32, y - row as f32);
        let lit = |x, y| self.light(x, y, z, bias, receiver);
        let above = lit(column, row) * (1.0 - fx) + lit(column + 1, row) * fx;
        let below = lit(column, row + 1) * (1.0 - fx) + lit(column + 1, row + 1) * fx;
        above * (1.0 - fy) + below * fy
    }

    /// Lit fraction of a point, with a soft border: 16 texels.
    fn soft(&self, point: Vector3<f32>, bias: f32, receiver: Receiver) -> f32 {
        let [x, y, z] = self.place(point);
        if self.is_free([x, y, z], bias, receiver) {
            return 1.0;
        }
        let [x, y] = [x, y].map(|at| (at - 2.0).max(0.0));
        let (column, row) = (x as usize, y as usize);
        let (fx, fy) = (x - column as f32, y - row as f32);
        let across = [1.0 - fx, 1.0, 1.0, fx];
        let mut sum = 0.0;
        for (j, down) in [1.0 - fy, 1.0, 1.0, fy].into_iter().enumerate() {
            for (i, across) in across.into_iter().enumerate() {
                sum += across * down * self.light(column + i, row + j, z, bias, receiver);
            }
        }
        sum / 9.0
    }

    /// Lit fraction of the near side of a ball, at five positions.
    fn seen(&self, body: &Body) -> f32 {
        let [x, y, z] = self.place(body.centre);
        let bias = 0.3 * body.radius + self.texel;
        let off = 0.6 * body.radius / self.texel;
        let places = [
            [0.0, 0.0, 1.0],
            [off, 0.0, 0.8],
            [-off, 0.0, 0.8],
            [0.0, off, 0.8],
            [0.0, -off, 0.8],
        ];
        let lit = places.into_iter().filter(|[dx, dy, up]| {
            let [column, row] = [x + dx, y + dy].map(|at| at.max(0.0) as usize);
            self.light(column, row, z + up * body.radius, bias, Receiver::Ball) > 0.0
        });
        lit.count() as f32 / 5.0
    }
}

/// The nearest depth in each block of these rows of texels, from left to right.
fn nearest_of_blocks(rows: &[f32], wide: usize) -> Vec<f32> {
    let nearer = |a: f32, b: f32| if b > a { b } else { a };
    let mut columns = vec![f32::NEG_INFINITY; wide];
    for row in rows.chunks_exact(wide) {
        for (column, depth) in columns.iter_mut().zip(row) {
            *column = nearer(*column, *depth);
        }
    }
    let nearest = |block: &[f32]| block.iter().copied().fold(f32::NEG_INFINITY, nearer);
    columns.chunks(BLOCK).map(nearest).collect()
}

/// Rate of change of depth along a surface that faces the light to this degree.
fn steepness(facing: f32) -> f32 {
    ((1.0 - facing * facing).max(0.0).sqrt() / facing.max(0.05)).min(10.0)
}

/// Two unit vectors perpendicular to a unit vector and to each other.
fn across(a: Vector3<f32>) -> [Vector3<f32>; 2] {
    let other = if a.x.abs() < 0.6 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let right = other.cross(&a).normalize();
    [right, a.cross(&right)]
}
