//! Spheres scattered at random, largest first: the start of settling where a front stops early.
//!
//! A front places sizes in the order drawn, and each waits until it fits. In a shape only a few of
//! the largest spheres across, a large one that fits nowhere any more ends the front with much
//! room left. Spheres that are scattered largest first find their places, and settling moves the
//! last ones apart.

use super::job::Job;
use super::settings::Progress;
use crate::front::{Assembly, first_draw};
use crate::geometry::inside::is_inside;
use crate::seed::climb;
use crate::spheres::{ReducedSphere, Vector3};
use dem_io::Result;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;

/// Number of random places inside the solid among which that with the most room is taken if a
/// sphere fits at none.
const PLACES: usize = 40;
/// Number of random points of the box tried for each of these, until one of the inner points of the
/// solid is taken.
const POINTS_PER_PLACE: usize = 50;
/// Length of the first step towards more room, and of the last, in radii.
const STEPS: [f64; 2] = [0.5, 0.01];

/// Draws sizes until their volume at the reduced radii reaches `volume` (local units), and scatters
/// the spheres inside the solid. They may overlap; settling moves them apart.
pub(super) fn scatter(job: &Job, volume: f64, progress: Progress) -> Result<Vec<ReducedSphere>> {
    let mut radii = draw(job, volume);
    radii.sort_by(|a, b| b.total_cmp(a));
    let mut assembly = job.assembly(1.0, 1.0, radii.len());
    let mut random = ChaCha8Rng::seed_from_u64(job.settings.seed);
    random.set_stream(u64::MAX - 1);
    for (placed, radius) in radii.iter().enumerate() {
        if placed.is_multiple_of(1000) {
            progress("scattering", placed as f64 / radii.len() as f64)?;
        }
        let place = roomy_place(job, &assembly, &mut random, *radius);
        assembly.add(assembly.sphere(&place, *radius));
    }
    Ok(assembly.spheres)
}

/// Radii (not reduced, local units) drawn one after the other up to a volume of the reduced
/// spheres: the last one only if it brings the sum nearer.
fn draw(job: &Job, volume: f64) -> Vec<f64> {
    let assembly = job.assembly(1.0, 1.0, 0);
    let mut radii = Vec::new();
    let mut filled = 0.0;
    for stream in 0_u64.. {
        let radius = assembly.radius(first_draw(job.settings.seed ^ 0x5ca7, stream));
        let more = 4.0 / 3.0 * PI * assembly.reduced(radius).powi(3);
        if filled + more > volume {
            if filled + 0.5 * more < volume {
                radii.push(radius);
            }
            break;
        }
        filled += more;
        radii.push(radius);
    }
    radii
}

/// A random place where a sphere of this (not reduced) radius fits, or one with much room.
fn roomy_place(job: &Job, assembly: &Assembly, random: &mut ChaCha8Rng, radius: f64) -> Vector3 {
    let boundary = &job.solid.boundary;
    let extent = job.extent();
    let room = |place: &Vector3| {
        let wall = boundary.nearest(place, radius);
        let wall = wall.map_or(radius, |near| near.distance);
        wall.min(assembly.reach_to_spheres(place, radius))
    };
    let mut best = (job.solid.deepest.centre, f64::NEG_INFINITY);
    for _ in 0..PLACES {
        let place = random_place(job, &extent, random);
        let found = room(&place);
        if found > best.1 {
            best = (place, found);
        }
        if found >= radius {
            return place;
        }
    }
    // The steps are never longer than the distance to the wall, so that the climb stays inside.
    let first_step = STEPS[0] * best.1.clamp(0.0, radius);
    climb(&best.0, first_step, STEPS[1] * radius, &room).centre
}

/// A random point inside the solid.
fn random_place(job: &Job, extent: &Vector3, random: &mut ChaCha8Rng) -> Vector3 {
    let solid = job.solid;
    let anywhere = (0..POINTS_PER_PLACE)
        .map(|_| extent.map(|most| most * random.random::<f64>()))
        .find(|point| is_inside(&solid.boundary, point));
    anywhere.unwrap_or_else(|| solid.inner[random.random_range(0..solid.inner.len())].centre)
}
