//! From a solid and sizes to spheres, in four steps: [`shrink`], [`grow`], [`settle`] and [`fill`].

mod attempt;
mod fill;
mod grow;
mod job;
mod order;
mod retry;
mod scatter;
mod settings;
pub(crate) mod settle;
pub(crate) mod shrink;
mod solid;

pub(crate) use self::attempt::can_fill_voids;
use self::fill::fill;
use self::grow::grow;
use self::job::Job;
use self::order::sort_along_curve;
use self::retry::Retry;
use self::scatter::scatter;
pub use self::settings::{PackHistory, PackSettings, Packing, Progress};
use self::settle::{Settled, WhenJammed, settle, settle_all};
use self::shrink::{choose_shrink, thin_out};
pub(crate) use self::solid::Solid;
use self::solid::sphere_volumes;
use crate::spheres::{ReducedSphere, Spheres};
use dem_io::units::show_length;
use dem_io::{Diagnostic, Result, Surface};
use std::time::Instant;

/// Fills the solid inside a surface with spheres; refuses sizes that do not fit it, and a seed
/// point outside.
pub fn pack(surface: &Surface, settings: &PackSettings, progress: Progress) -> Result<Packing> {
    let started = Instant::now();
    let solid = Solid::new(surface)?;
    let seconds = started.elapsed().as_secs_f64();
    let mut packing = pack_solid(&solid, settings, progress)?;
    packing.history.front_seconds += seconds;
    Ok(packing)
}

/// Fills a solid with spheres.
pub(crate) fn pack_solid(
    solid: &Solid,
    settings: &PackSettings,
    progress: Progress,
) -> Result<Packing> {
    let packing = pack_if(solid, settings, &|_| true, progress)?;
    packing.ok_or_else(|| Diagnostic::failed(solid.surface.source.clone(), "given up", ""))
}

/// Fills a solid with spheres, but stops after the front if the packing is not wanted: `is_wanted`
/// is called with the sum of the spheres' volumes / volume of the solid before settling and
/// filling, which take most of the time and change it little. None if the packing was not wanted.
pub(crate) fn pack_if(
    solid: &Solid,
    settings: &PackSettings,
    is_wanted: &dyn Fn(f64) -> bool,
    progress: Progress,
) -> Result<Option<Packing>> {
    let started = Instant::now();
    let job = Job::new(solid, settings)?;
    let mut attempt = Retry::first(choose_shrink(settings), &settings.sizes);
    let mut retry = Retry::new(&job);
    let front = loop {
        let front = grow(&job, &attempt, progress)?;
        match retry.after_front(&attempt, &front) {
            Some(better) => attempt = better,
            None => break front,
        }
    };
    let too_many = retry.too_many(&front);
    let scattered = match retry.volume_to_scatter(&settings.sizes, &front) {
        Some(volume) => scatter(&job, volume, progress)?,
        None => Vec::new(),
    };
    let reduced_radii = || scattered.iter().map(|sphere| sphere[3] * job.enlarge());
    let filled = ((1.0 - too_many) * front.filled_fraction(&job))
        .max(solid.filled_fraction(reduced_radii()));
    if !is_wanted(filled) {
        return Ok(None);
    }
    let least = front.volume();
    let (mut spheres, grown) = front.finish();
    sort_along_curve(&mut spheres, job.radius_range()[1]);
    let thinned = thin_out(&mut spheres, too_many);
    let front_seconds = started.elapsed().as_secs_f64();
    let settling = Instant::now();
    let when_jammed = retry.when_jammed();
    let mut denser = settle_scattered(&job, scattered, least, when_jammed, progress)?;
    let scattered = denser.as_ref().map_or(0, |(spheres, _)| spheres.len());
    let settled = match denser.take() {
        Some((settled_spheres, settled)) => {
            spheres = settled_spheres;
            settled
        }
        None => settle(&job, attempt.shrink, when_jammed, &mut spheres, progress)?,
    };
    let densify_seconds = settling.elapsed().as_secs_f64();
    let filling = Instant::now();
    let filled = fill(&job, attempt.fills_voids, &mut spheres, progress)?;

    let history = PackHistory {
        seed_point_m: solid.to_metres(&job.seed),
        largest_inscribed_diameter_m: solid.largest_inscribed_diameter_m(),
        densify: attempt.shrink,
        fronts: grown.fronts,
        scattered,
        densify_steps: settled.steps,
        thinned: thinned + settled.thinned,
        removed: settled.taken_out,
        attempts: retry.fronts,
        void_fillers: grown.fillers + filled.fillers,
        loose_fillers: grown.loose_fillers + filled.fillers,
        voids_left: grown.voids_left + filled.voids_left,
        room_left: filled.room_left,
        unplaced: grown.unplaced,
        front_seconds,
        densify_seconds,
        fill_seconds: filling.elapsed().as_secs_f64(),
    };
    let spheres = full_size(&job, &spheres)?;
    Ok(Some(Packing { spheres, history }))
}

/// Scattered spheres, settled, if they then fill more than `least` (reduced radii, local units).
fn settle_scattered(
    job: &Job,
    mut spheres: Vec<ReducedSphere>,
    least: f64,
    when_jammed: WhenJammed,
    progress: Progress,
) -> Result<Option<(Vec<ReducedSphere>, Settled)>> {
    if spheres.is_empty() {
        return Ok(None);
    }
    sort_along_curve(&mut spheres, job.radius_range()[1]);
    let settled = settle_all(job, when_jammed, &mut spheres, progress)?;
    let volume = sphere_volumes(spheres.iter().map(|sphere| sphere[3]));
    Ok((volume > least).then_some((spheres, settled)))
}

/// The spheres at their true radii; refuses a packing without any.
fn full_size(job: &Job, spheres: &[ReducedSphere]) -> Result<Spheres> {
    if spheres.is_empty() {
        let inscribed_m = job.solid.largest_inscribed_diameter_m();
        return Err(Diagnostic::input(
            job.solid.surface.source.clone(),
            format!(
                "no sphere found room: the largest inscribed sphere has diameter {}",
                show_length(inscribed_m)
            ),
            "ask for smaller diameters",
        ));
    }
    let [smallest, largest] = job.exact_radius_range();
    Ok(Spheres {
        positions: spheres.iter().map(|b| [b[0], b[1], b[2]]).collect(),
        radii: spheres
            .iter()
            .map(|b| (b[3] * job.enlarge()).clamp(smallest, largest))
            .collect(),
    })
}
