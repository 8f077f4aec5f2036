//! Whether spheres form one round heap.
//!
//! A cone is the same on all sides of its axis, thins out evenly from its axis to its rim, and ends
//! in a point. What it is compared by, and the limits, come from some 20,000 lattices and random
//! packings of 50 to 3,000 spheres, cut to cones of 10 to 40 degrees and to other shapes, and from
//! heaps of 55 to 2,500 spheres that scenes left: lifted, poured, wet, and of broken tablets. Means
//! over n spheres scatter by a part of 1/sqrt(n), by which the limits are wider.

use super::moments::{Moments, Sphere};

/// Part of the mass that lies within a quarter of the cone's radius from its axis, at least: 0.156
/// of a cone, 0.104 of a flat disc, 0.03 to 0.07 of heaps in a triangle.
const IN_MIDDLE: f64 = 0.1;

/// Largest harmonic of the mass: two corners of it are a ridge, three a slope or three heaps, four
/// a square. Cones have up to 0.03 with more than 800 spheres and 0.15 with 50, heaps of scenes
/// 0.11 with 1,000 and 0.22 with 60. Ridges of which a quarter is straight have 0.28, three heaps
/// that touch 0.43, squares 0.4, half a cone 0.5.
const UNEVEN: f64 = 0.2;
/// Largest harmonic of the height: one side higher than the other, or a crest. Cones have up to
/// 0.04 with more than 800 spheres and 0.2 with 50, heaps of scenes 0.11 with 300. A quarter of a
/// cone has 0.5, half a cone and two unequal heaps that touch 0.25 to 0.6, slopes 0.3 to 0.7.
const LEANING: f64 = 0.15;
/// What is added to both limits for n spheres, times sqrt(n).
const SCATTER: f64 = 1.5;

/// Fraction of the slope that the covariance gives up to which a top counts as flat, with a slope
/// that tends to 0 and any outline. Flat beds have up to 0.1 with one layer and 0.03 with three.
const FLAT: f64 = 0.1;
/// The same up to which a level ground around the heap makes it one on a wide bed: of n layers, the
/// first less the second over n. It is 0.5 to 0.72 of these with four and five layers, and 0.4 to
/// 0.8 of low heaps of scenes, around which the ground is not level. Cones have 0.7 and more with
/// three layers, and 0.89 and more with five.
const HALF_FLAT: [f64; 2] = [0.9, 0.6];
/// Smallest skewness of the height between a flat bed and a cone: below it the top is cut off. It
/// is 0.86 for a cone, 0.7 to 0.8 of most heaps of scenes, 0.5 of a wet heap and of a paraboloid,
/// 0.25 to 0.46 of cones whose plateau has half their radius.
const BLUNT: f64 = 0.44;
/// Fewest layers of which the heights of spheres show whether a top is cut off.
const FEWEST_LAYERS: f64 = 3.0;
/// Skewness of the height of a cone.
const POINTED: f64 = 0.861;
/// Parts of the mass, counted from the axis, between which the ground density of two outer rings
/// is compared.
const RINGS: [f64; 3] = [0.7, 0.85, 0.97];
/// Ratio of the ground density of the outer ring to that of the inner one from which the ground
/// around a heap is level: 0.5 to 0.7 of cones of seven layers, up to 1.3 of those of three, 0.2 to
/// 0.6 of heaps of scenes, concave ones included, 0.83 to 1.3 of cones on a bed.
const LEVEL: f64 = 0.8;
/// Points across a sphere, in its radii, at which its mass counts for the rings.
const ACROSS: [f64; 7] = [-0.9, -0.6, -0.3, 0.0, 0.3, 0.6, 0.9];

/// True if the spheres form one round heap or a bed with a flat top, as far as this number of
/// spheres shows it. `falling`: ratio of the slope by the covariance to that by the variances.
pub(super) fn is_one_heap(heap: &[Sphere], moments: &Moments, falling: f64) -> bool {
    let shape = Shape::of(heap, moments);
    let more = SCATTER / (heap.len() as f64).sqrt();
    let is_flat = falling.abs() <= FLAT;
    let corners = if is_flat { 2..=3 } else { 2..=4 };
    let skewness = shape.skewness();
    let layers = shape.layers();
    let is_cut = !is_flat && layers >= FEWEST_LAYERS && skewness < BLUNT;
    // A cone of few layers is as skew as a heap on a bed of one layer.
    let is_pointed = skewness > POINTED + 1.0 / layers;
    let is_half_flat = !is_flat && falling < HALF_FLAT[0] - HALF_FLAT[1] / layers;
    let on_a_bed = || (is_pointed || is_half_flat) && shape.ground_ratio() > LEVEL;
    shape.has_middle()
        && corners
            .into_iter()
            .all(|m| shape.uneven(m) <= UNEVEN + more)
        && shape.leaning() <= LEANING + more
        && !is_cut
        && !on_a_bed()
}

/// The spheres and their moments.
struct Shape<'a> {
    heap: &'a [Sphere],
    moments: &'a Moments,
    mass_kg: f64,
}

impl<'a> Shape<'a> {
    fn of(heap: &'a [Sphere], moments: &'a Moments) -> Self {
        let mass_kg = heap.iter().map(|sphere| sphere.mass_kg).sum();
        Self {
            heap,
            moments,
            mass_kg,
        }
    }

    /// Mean by mass.
    fn mean(&self, of: impl Fn(&Sphere) -> f64) -> f64 {
        let sum: f64 = self.heap.iter().map(|s| s.mass_kg * of(s)).sum();
        sum / self.mass_kg
    }

    /// Distance of a sphere from the axis, m.
    fn distance_m(&self, sphere: &Sphere) -> f64 {
        let [x, y] = self.beside_axis_m(sphere);
        x.hypot(y)
    }

    /// Position of a sphere from the axis, m.
    fn beside_axis_m(&self, sphere: &Sphere) -> [f64; 2] {
        [0, 1].map(|k| sphere.across_m[k] - self.moments.middle_m[k])
    }

    /// Radius of the cone, m.
    fn radius_m(&self) -> f64 {
        (10.0 / 3.0 * self.moments.across_m2).sqrt()
    }

    /// Whether the middle is not empty.
    fn has_middle(&self) -> bool {
        let quarter_m = 0.25 * self.radius_m();
        let in_middle = self.mean(|s| f64::from(u8::from(self.distance_m(s) <= quarter_m)));
        let scatter = (in_middle / self.heap.len() as f64).sqrt();
        in_middle + 2.0 * scatter >= IN_MIDDLE
    }

    /// Length of the mean of (x + i y)^m times a factor.
    fn harmonic(&self, m: i32, factor: impl Fn(&Sphere) -> f64) -> f64 {
        let power = |s: &Sphere| {
            let [x, y] = self.beside_axis_m(s);
            (1..m).fold([x, y], |[a, b], _| [a * x - b * y, a * y + b * x])
        };
        let [x, y] = [0, 1].map(|k| self.mean(|s| power(s)[k] * factor(s)));
        x.hypot(y)
    }

    /// Harmonic of the mass with m corners, as a fraction of what all mass on one side would have.
    fn uneven(&self, m: i32) -> f64 {
        self.harmonic(m, |_| 1.0) / self.mean(|s| self.distance_m(s).powi(m))
    }

    /// The larger of two harmonics of the height: its correlation with the direction in which it
    /// rises most, and its covariance with x^2 - y^2 along a crest, as a fraction of that with r^2
    /// in a cone, 1/40 H R^2.
    fn leaning(&self) -> f64 {
        let m = self.moments;
        let height_m = self.mean(|s| s.height_m);
        let above = |s: &Sphere| s.height_m - height_m;
        let side = self.harmonic(1, above) / (0.5 * m.upright_m2 * m.across_m2).sqrt();
        let slope = (8.0 * m.upright_m2 / m.across_m2).sqrt();
        let crest = 40.0 * self.harmonic(2, above) / (slope * self.radius_m().powi(3));
        side.max(crest)
    }

    /// Skewness of the height; a sphere counts with its extent.
    fn skewness(&self) -> f64 {
        let height_m = self.mean(|s| s.height_m);
        let third_m3 = self.mean(|s| {
            let above_m = s.height_m - height_m;
            above_m.powi(3) + 0.6 * above_m * s.radius_m * s.radius_m
        });
        third_m3 / self.moments.upright_m2.powf(1.5)
    }

    /// Height from the lowest to the highest point in mean diameters of a sphere.
    fn layers(&self) -> f64 {
        let ends = self
            .heap
            .iter()
            .map(|s| [-1.0, 1.0].map(|k| s.height_m + k * s.radius_m));
        let [low, high] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], ends| {
            [low.min(ends[0]), high.max(ends[1])]
        });
        (high - low) / (2.0 * self.mean(|s| s.radius_m))
    }

    /// Ratio of the mass over an area of the ground in the outer to that in the inner of two rings.
    fn ground_ratio(&self) -> f64 {
        let parts = self.heap.iter().flat_map(|s| {
            let distance_m = self.distance_m(s);
            ACROSS.map(|u| {
                let square_m2 = (distance_m + u * s.radius_m).powi(2);
                (square_m2, s.mass_kg * (1.0 - u * u))
            })
        });
        let mut parts: Vec<(f64, f64)> = parts.collect();
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let all: f64 = parts.iter().map(|(_, mass)| mass).sum();
        let [inner, middle, outer] = RINGS.map(|part| {
            let mut within = 0.0;
            let found = parts.iter().find(|(_, mass)| {
                within += mass;
                within >= part * all
            });
            found.map_or(0.0, |(square_m2, _)| *square_m2)
        });
        let masses = [RINGS[1] - RINGS[0], RINGS[2] - RINGS[1]];
        (masses[1] / (outer - middle)) / (masses[0] / (middle - inner))
    }
}
