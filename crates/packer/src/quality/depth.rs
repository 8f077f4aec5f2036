//! Distance to the wall at many points, with as few exact (slow) distances as needed.

use super::bonded_packing::BondedPacking;
use rayon::prelude::*;

/// Number of points that share the last exact distance: fixed, so that results do not depend on the
/// number of threads.
const CHUNK: usize = 4096;
/// Mean number of spheres in a cell of the order in which depths are measured.
const SPHERES_PER_CELL: f64 = 4.0;

/// Gives depths at points one after the other, best in an order in which neighbours follow each
/// other: the distance changes by no more than the distance from the last measured point, which is
/// often enough to decide.
pub(super) struct DepthProbe<'a> {
    packing: &'a BondedPacking<'a>,
    question: DepthQuery,
    last: Option<([f64; 3], f64)>,
}

/// The accuracy needed of a depth.
#[derive(Debug, Clone, Copy)]
pub(super) struct DepthQuery {
    /// Depths below this need not be distinguished.
    pub(super) floor: f64,
    /// Depths above this need not be distinguished.
    pub(super) cap: f64,
    /// Thickness of the layers to be distinguished; 0 for exact depths.
    pub(super) layer: f64,
    /// Depths above this are to be distinguished from those below.
    pub(super) limit: f64,
}

impl DepthQuery {
    /// True if two depths need not be distinguished.
    fn same(&self, a: f64, b: f64) -> bool {
        (a <= self.floor && b <= self.floor)
            || (a >= self.cap && b >= self.cap)
            || (self.layer > 0.0
                && a > self.floor
                && b < self.cap
                && (a / self.layer).floor() == (b / self.layer).floor()
                && (a > self.limit) == (b > self.limit))
    }
}

impl<'a> DepthProbe<'a> {
    pub(super) fn new(packing: &'a BondedPacking<'a>, question: DepthQuery) -> Self {
        Self {
            packing,
            question,
            last: None,
        }
    }

    /// Depth of a point below the surface, or a larger one that is equivalent for the question; the
    /// cap if deeper, zero if not above the floor.
    pub(super) fn depth(&mut self, point: [f64; 3]) -> f64 {
        let DepthQuery { floor, cap, .. } = self.question;
        if let Some((measured, distance)) = self.last {
            let way = (0..3)
                .map(|k| (point[k] - measured[k]).powi(2))
                .sum::<f64>()
                .sqrt();
            if distance - way >= cap {
                return cap;
            }
            if distance + way <= floor {
                return 0.0;
            }
        }
        let [least, most] = (self.packing.distance_bounds)(point);
        let depth = if self.question.same(least, most) {
            most
        } else {
            let distance = (self.packing.distance_inside)(point);
            self.last = Some((point, distance));
            distance
        };
        if depth <= floor { 0.0 } else { depth.min(cap) }
    }
}

/// Depth of each centre, at most `cap`: from the packing if known there, or else measured. One per
/// sphere.
pub(super) fn of_centres(packing: &BondedPacking, cap: f64) -> Vec<f64> {
    let mut depths: Vec<f64> = packing
        .wall_distance
        .iter()
        .map(|d| {
            if d.is_finite() {
                d.clamp(0.0, cap)
            } else {
                f64::NAN
            }
        })
        .collect();
    depths.resize(packing.spheres.radii.len(), f64::NAN);
    let unknown: Vec<u32> = (0..)
        .zip(&depths)
        .filter(|(_, depth)| depth.is_nan())
        .map(|(i, _)| i)
        .collect();
    let unknown = in_rows(packing, unknown);
    let measured: Vec<Vec<f64>> = unknown
        .par_chunks(CHUNK)
        .map(|spheres| {
            let exactly = DepthQuery {
                floor: 0.0,
                cap,
                layer: 0.0,
                limit: 0.0,
            };
            let mut probe = DepthProbe::new(packing, exactly);
            spheres
                .iter()
                .map(|i| probe.depth(packing.spheres.positions[*i as usize]))
                .collect()
        })
        .collect();
    for (i, depth) in unknown.into_iter().zip(measured.into_iter().flatten()) {
        depths[i as usize] = depth;
    }
    depths
}

/// The spheres row by row through the box, so that neighbours follow each other (counting sort by
/// cell).
fn in_rows(packing: &BondedPacking, spheres: Vec<u32>) -> Vec<u32> {
    let volume: f64 = packing.extent.iter().product();
    let edge = (SPHERES_PER_CELL * volume / spheres.len().max(1) as f64).cbrt();
    let count = packing.extent.map(|e| (e / edge) as usize + 1);
    let cell = |sphere: u32| {
        let p = packing.spheres.positions[sphere as usize];
        let [x, y, z] = [0, 1, 2].map(|k| ((p[k] / edge).max(0.0) as usize).min(count[k] - 1));
        x + count[0] * (y + count[1] * z)
    };
    let mut next = vec![0_u32; count.iter().product::<usize>() + 1];
    for sphere in &spheres {
        next[cell(*sphere) + 1] += 1;
    }
    for i in 1..next.len() {
        next[i] += next[i - 1];
    }
    let mut sorted = vec![0_u32; spheres.len()];
    for sphere in spheres {
        let slot = &mut next[cell(sphere)];
        sorted[*slot as usize] = sphere;
        *slot += 1;
    }
    sorted
}
