//! Distance to the wall at many points, with as few exact (slow) distances as the question needs.

use super::Packing;
use rayon::prelude::*;

/// Points that share the last exact distance: fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 4096;
/// Mean number of spheres in a cell of the order in which depths are measured.
const SPHERES_PER_CELL: f64 = 4.0;

/// Answers depths at points one after the other, best in an order in which neighbours follow each other: the distance
/// changes by no more than the way from the last point that was measured, which often settles the matter.
pub(super) struct Probe<'a> {
    distance_inside: &'a (dyn Fn([f64; 3]) -> f64 + Sync),
    /// Shallower is all the same.
    floor: f64,
    /// Deeper is all the same.
    cap: f64,
    last: Option<([f64; 3], f64)>,
}

impl<'a> Probe<'a> {
    pub(super) fn new(packing: &Packing<'a>, floor: f64, cap: f64) -> Self {
        Self {
            distance_inside: packing.distance_inside,
            floor,
            cap,
            last: None,
        }
    }

    /// Depth of a point below the surface: exact between floor and cap, the cap if deeper, zero if not above the floor.
    pub(super) fn depth(&mut self, point: [f64; 3]) -> f64 {
        if let Some((measured, distance)) = self.last {
            let way = (0..3)
                .map(|k| (point[k] - measured[k]).powi(2))
                .sum::<f64>()
                .sqrt();
            if distance - way >= self.cap {
                return self.cap;
            }
            if distance + way <= self.floor {
                return 0.0;
            }
        }
        let distance = (self.distance_inside)(point);
        self.last = Some((point, distance));
        if distance <= self.floor {
            0.0
        } else {
            distance.min(self.cap)
        }
    }
}

/// Depth of each centre, at most `cap`: as the packing knows it, or else measured. One per sphere.
pub(super) fn of_centres(packing: &Packing, cap: f64) -> Vec<f64> {
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
            let mut probe = Probe::new(packing, 0.0, cap);
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

/// The spheres row by row through the box, so that neighbours follow each other (counting sort by cell).
fn in_rows(packing: &Packing, spheres: Vec<u32>) -> Vec<u32> {
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
