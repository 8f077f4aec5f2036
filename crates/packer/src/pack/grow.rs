//! Second step: fronts that start at seeds spread over the solid, and again wherever there is room
//! that no front has reached.

use super::attempt::Attempt;
use super::job::Job;
use super::settings::Progress;
use super::solid::sphere_volumes;
use crate::front::{FillingSettings, Front, SizeQuota};
use crate::geometry::inside::is_inside;
use crate::seed::{climb, first_spheres, spread_points};
use crate::spheres::{ReducedSphere, Vector3};
use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use rayon::prelude::*;
use std::ops::Range;

/// Edge of the cubes in which a front starts before settling, in largest diameters: small enough
/// that directions of growth average out, large enough that few fronts meet, since the density is
/// lower where they meet.
const SEED_SPACING: f64 = 8.0;
/// Largest number of spheres: about 30 GB.
const MOST_SPHERES: f64 = 1e8;

/// History of this step.
#[derive(Debug)]
pub(super) struct GrowHistory {
    /// Number of fronts started.
    pub(super) fronts: usize,
    /// Number of drawn radii that found no place.
    pub(super) unplaced: usize,
    /// Number of spheres chosen to fill voids.
    pub(super) fillers: usize,
    /// Number of fillers that touch fewer than three other spheres or walls.
    pub(super) loose_fillers: usize,
    /// Approximate number of voids that would still take the smallest sphere.
    pub(super) voids_left: usize,
}

/// A front that has filled the solid.
pub(super) struct Grown<'a> {
    front: Front<'a>,
    /// Ratio of its radii to the requested ones.
    scale: f64,
    /// Number of fronts started.
    fronts: usize,
}

/// Fills the solid with the spheres of one attempt; refuses too many of them.
pub(super) fn grow<'a>(job: &'a Job, attempt: &Attempt, progress: Progress) -> Result<Grown<'a>> {
    let scale = 1.0 - attempt.shrink;
    let expected = expected_spheres(job, scale)?;
    let placed_before = attempt.expected.unwrap_or(expected);
    let wall_factor = (1.0 - 1e-12) / scale;
    let assembly = job.assembly(scale, wall_factor, placed_before as usize);
    let filling = attempt.fills_voids.then(|| FillingSettings {
        expected: placed_before,
        most_too_many: attempt.most_too_many,
        quota: attempt.quota.clone(),
    });
    let mut front = Front::new(assembly, job.settings.seed, filling);
    let progress = |placed: usize| progress("front", placed as f64 / expected);
    let fronts = begin_at_seeds(job, &mut front, attempt.shrink, &progress)?
        + begin_where_room_is_left(job, &mut front, &progress)?;
    Ok(Grown {
        front,
        scale,
        fronts,
    })
}

/// Approximate number of spheres expected.
fn expected_spheres(job: &Job, scale: f64) -> Result<f64> {
    let surface = job.solid.surface;
    let reduced_volume = job.settings.sizes.mean_volume_m3() * (scale / job.enlarge()).powi(3);
    let expected = 0.58 * surface.volume_m3() / reduced_volume.max(f64::MIN_POSITIVE);
    if expected <= MOST_SPHERES {
        return Ok(expected);
    }
    Err(Diagnostic::input(
        surface.source.clone(),
        format!(
            "about {} spheres would fill it, at most {MOST_SPHERES:e} can be handled",
            significant(expected, 2)
        ),
        "ask for larger diameters, or check the units of --diameter and --unit",
    ))
}

/// Grows fronts from the seed and, before settling, from others spread over the solid. Returns the
/// number started.
fn begin_at_seeds(
    job: &Job,
    front: &mut Front,
    shrink: f64,
    progress: &dyn Fn(usize) -> Result<()>,
) -> Result<usize> {
    let boundary = &job.solid.boundary;
    let mut seeds = vec![job.seed];
    if shrink > 0.0 {
        let diameter = 2.0 * job.radius_range()[1] * (1.0 - shrink) / job.enlarge();
        let extent = job.solid.surface.extent();
        let others = spread_points(&extent, SEED_SPACING * diameter, job.settings.seed);
        let is_apart = |p: &Vector3| (p - job.seed).norm() > 2.0 * diameter;
        seeds.par_extend(
            others
                .into_par_iter()
                .filter(|p| is_apart(p) && is_inside(boundary, p)),
        );
    }
    let mut queue = Vec::new();
    let mut fronts = 0;
    for seed in &seeds {
        let first = place_first_spheres(job, front, seed);
        fronts += usize::from(!first.is_empty());
        queue.extend(first);
    }
    front.advance(&queue, progress)?;
    Ok(fronts)
}

/// Grows fronts in the regions that no front has reached: other shells, and spaces behind a neck
/// narrower than a sphere. Returns their number.
fn begin_where_room_is_left(
    job: &Job,
    front: &mut Front,
    progress: &dyn Fn(usize) -> Result<()>,
) -> Result<usize> {
    let mut fronts = 0;
    for place in &job.solid.inner {
        let smallest = front.smallest_next();
        let assembly = &front.assembly;
        let reduced = assembly.reduced(smallest);
        let is_too_narrow = place.radius < 0.5 * smallest;
        if is_too_narrow || assembly.gap(&place.centre, reduced) < 0.9 * reduced {
            continue;
        }
        // The steps are never longer than the distance to the wall, so that the climb stays on the
        // same side of it.
        let reach = 4.0 * assembly.settings.radius_range[1];
        let clearance = |p: &Vector3| assembly.clearance(p, reach);
        let room = climb(&place.centre, 0.5 * smallest, 1e-6 * smallest, &clearance);
        if room.radius >= smallest {
            let first: Vec<u32> = place_first_spheres(job, front, &room.centre).collect();
            fronts += usize::from(!first.is_empty());
            front.advance(&first, progress)?;
        }
    }
    Ok(fronts)
}

/// Places as many of the first three spheres as fit around `seed`. Returns their indices.
fn place_first_spheres(job: &Job, front: &mut Front, seed: &Vector3) -> Range<u32> {
    let draws = front.next_draws();
    let assembly = &front.assembly;
    let radii = draws.map(|u| assembly.radius(u));
    let reduced = radii.map(|r| assembly.reduced(r));
    let placed = first_spheres(seed, radii, reduced, &|centre, radius| {
        assembly.fits(centre, radius) && is_inside(&job.solid.boundary, centre)
    });
    front.waiting.extend_from_slice(&draws[placed.len()..]);
    front.begin(seed, &placed)
}

impl Grown<'_> {
    /// Number of spheres placed.
    pub(super) fn spheres(&self) -> usize {
        self.front.assembly.spheres.len()
    }

    /// Volume of the spheres at their reduced radii once they have grown to full size, local units.
    pub(super) fn volume(&self) -> f64 {
        sphere_volumes(self.full_reduced_radii())
    }

    /// Sum of the volumes of the spheres at full size over the volume of the solid.
    pub(super) fn filled_fraction(&self, job: &Job) -> f64 {
        let radii = self.full_reduced_radii().map(|r| r * job.enlarge());
        job.solid.filled_fraction(radii)
    }

    fn full_reduced_radii(&self) -> impl Iterator<Item = f64> + '_ {
        let spheres = &self.front.assembly.spheres;
        spheres.iter().map(|sphere| sphere[3] / self.scale)
    }

    /// The sizes placed, if the front filled voids.
    pub(super) fn quota(&self) -> Option<&SizeQuota> {
        self.front.quota()
    }

    /// True if voids remain that take the smallest sphere.
    pub(super) fn has_left_voids(&self) -> bool {
        self.front.has_left_voids()
    }

    /// The spheres at full size, which overlap if the front used smaller radii, and the history of
    /// the front.
    pub(super) fn finish(self) -> (Vec<ReducedSphere>, GrowHistory) {
        let unplaced = self.front.waiting.len();
        let mut finished = self.front.finish();
        let full_size = |sphere: &mut ReducedSphere| sphere[3] /= self.scale;
        finished.spheres.iter_mut().for_each(full_size);
        let history = GrowHistory {
            fronts: self.fronts,
            unplaced,
            fillers: finished.fillers,
            loose_fillers: finished.loose_fillers,
            voids_left: finished.voids_left,
        };
        (finished.spheres, history)
    }
}
