//! Fourth step: the voids of a settled packing are filled, as far as the sizes allow.

use super::job::Job;
use super::settings::Progress;
use super::solid::sphere_volumes;
use crate::front::{Assembly, first_draw};
use crate::geometry::inside::is_inside;
use crate::spheres::{ReducedSphere, Vector3};
use dem_io::Result;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// Number of spheres around which voids are searched at a time.
const VOID_SEARCH_GROUP: usize = 2000;

/// Number of random points for each sphere and in all that are looked at inside the solid, and the
/// largest number in its box.
const POINTS_PER_SPHERE: usize = 10;
const MOST_POINTS: usize = 10_000;
const MOST_POINTS_IN_BOX: usize = 200_000;
/// Part of a large void that small spheres fill.
const RANDOM_DENSITY: f64 = 0.6;

/// History of this step.
#[derive(Debug, Default)]
pub(super) struct FillHistory {
    /// Number of spheres put into voids.
    pub(super) fillers: usize,
    /// Approximate number of voids that would still take the smallest sphere.
    pub(super) voids_left: usize,
    /// Part of the solid in which the centre of the smallest sphere could still lie.
    pub(super) room_left: f64,
}

/// Puts spheres into the voids that take at least the smallest one, unless the front has filled
/// them already (`is_filled`). Each size is drawn among those that fit there. Filling stops before
/// it distorts the size distribution by more than a tenth of its statistical noise.
pub(super) fn fill(
    job: &Job,
    is_filled: bool,
    spheres: &mut Vec<ReducedSphere>,
    progress: Progress,
) -> Result<FillHistory> {
    if is_filled {
        return Ok(FillHistory::default());
    }
    progress("filling voids", 0.0)?;
    let assembly = || job.assembly(1.0, 1.0, spheres.len());
    let count = spheres.len();
    let radii = job.radius_range();
    let most = if radii[0] == radii[1] {
        usize::MAX
    } else {
        (0.1 * 1.36 * (count as f64).sqrt()).ceil() as usize
    };
    let mut filling = Filling {
        assembly: with_spheres(assembly(), spheres),
        seed: job.settings.seed ^ 0x5eed,
        most,
        fillers: 0,
    };
    // Neighbours in memory are neighbours in space: the search proceeds in strides, so that the
    // places found first are spread evenly.
    let groups = count.div_ceil(VOID_SEARCH_GROUP);
    for group in 0..groups {
        let around: Vec<u32> = (group..count).step_by(groups).map(|i| i as u32).collect();
        filling.fill_around(around);
        if filling.fillers == most {
            break;
        }
    }
    // Where there is much room, spheres are too far apart to show it.
    let sample = Sample::new(job, count);
    filling.fill_at(&sample.places_for_smallest(job, &filling.assembly));
    let room = sample.room(job, &filling.assembly);
    let voids_left = if filling.fillers == most {
        with_spheres(assembly(), &filling.assembly.spheres).count_all_voids()
    } else {
        0
    };
    let smallest = sphere_volumes(std::iter::once(filling.assembly.reduced(radii[0])));
    let voids_left = voids_left.max((RANDOM_DENSITY * room / smallest) as usize);
    let fillers = filling.fillers;
    *spheres = filling.assembly.spheres;
    Ok(FillHistory {
        fillers,
        voids_left,
        room_left: room * job.solid.surface.unit_m.powi(3) / job.solid.surface.volume_m3(),
    })
}

fn with_spheres<'a>(mut assembly: Assembly<'a>, spheres: &[ReducedSphere]) -> Assembly<'a> {
    spheres.iter().for_each(|sphere| assembly.add(*sphere));
    assembly
}

/// Voids being filled.
struct Filling<'a> {
    assembly: Assembly<'a>,
    /// Seed of the random numbers: each sphere has a stream of its own.
    seed: u64,
    /// Largest number of spheres put into voids.
    most: usize,
    /// Number of spheres put into voids.
    fillers: usize,
}

impl Filling<'_> {
    /// Fills the voids at these places, as far as they still take the smallest sphere.
    fn fill_at(&mut self, places: &[Vector3]) {
        for place in places {
            self.fill_void(place);
        }
    }

    /// Fills a void, unless it is filled already or there are fillers enough.
    fn fill_void(&mut self, void: &Vector3) {
        let smallest = self.assembly.settings.radius_range[0];
        if self.fillers < self.most && self.assembly.fits(void, smallest) {
            let drawn = first_draw(self.seed, self.fillers as u64);
            let (centre, radius) = self.assembly.roomy_place(void, drawn);
            self.assembly.add(self.assembly.sphere(&centre, radius));
            self.fillers += 1;
        }
    }

    /// Searches around the spheres `around` (indices) and then around the added ones.
    fn fill_around(&mut self, mut around: Vec<u32>) {
        while !around.is_empty() {
            let first = self.assembly.spheres.len() as u32;
            for void in self.assembly.voids(&around) {
                self.fill_void(&void);
            }
            around = (first..self.assembly.spheres.len() as u32).collect();
        }
    }
}

/// Random points in the box of the solid.
struct Sample {
    points: Vec<Vector3>,
    /// Volume of the box, local units.
    box_volume: f64,
}

impl Sample {
    /// Enough points for this number of spheres.
    fn new(job: &Job, spheres: usize) -> Self {
        let surface = job.solid.surface;
        let extent = job.extent();
        let box_volume = extent.product();
        let inside = (POINTS_PER_SPHERE * spheres).min(MOST_POINTS) as f64;
        let part_inside = surface.volume_m3() / surface.unit_m.powi(3) / box_volume;
        let count = (inside / part_inside).ceil().min(MOST_POINTS_IN_BOX as f64);
        let mut random = ChaCha8Rng::seed_from_u64(job.settings.seed ^ 0x5eed);
        random.set_stream(u64::MAX);
        let point = |_| extent.map(|most| most * random.random::<f64>());
        Self {
            points: (0..count as usize).map(point).collect(),
            box_volume,
        }
    }

    /// The points where the smallest sphere fits.
    fn places_for_smallest(&self, job: &Job, assembly: &Assembly) -> Vec<Vector3> {
        let smallest = assembly.settings.radius_range[0];
        let takes_smallest = |point: &&Vector3| {
            assembly.fits(point, smallest) && is_inside(&job.solid.boundary, point)
        };
        let points = self.points.par_iter().with_min_len(256);
        points.filter(takes_smallest).copied().collect()
    }

    /// Volume in which the centre of the smallest sphere can lie, local units.
    fn room(&self, job: &Job, assembly: &Assembly) -> f64 {
        let places = self.places_for_smallest(job, assembly).len();
        places as f64 / self.points.len().max(1) as f64 * self.box_volume
    }
}
