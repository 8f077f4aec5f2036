//! The particles whose displacement is measured.

use dem_engine::state::State;
use dem_laboratory::Specimen;
use nalgebra::Vector3;

use super::arrangement::{GAUGE, InSlab, Setup};

/// Half the size of the part of a body whose displacement is measured, as a fraction of its height.
const SPOT: f64 = 0.125;
/// Largest number of slabs along the loaded diameter.
const MOST_SLABS: usize = 20;
/// Chooses the particles within a twentieth of the diameter of a disc, or a mean diameter of the
/// particles, on both sides of the loaded diameter, and divides it into slabs of at least that mean
/// diameter.
pub(super) fn choose_strip(setup: &mut Setup, state: &State, particles: &[u32]) {
    let Specimen::Disc {
        diameter_m,
        thickness_m,
    } = setup.specimen
    else {
        return;
    };
    let fits = (diameter_m / (2.0 * setup.mean_radius_m)) as usize;
    setup.slabs = fits.clamp(1, MOST_SLABS);
    let half_m = (0.05 * diameter_m).max(2.0 * setup.mean_radius_m);
    let cubed = |i: u32| state.particles.poses[i as usize].radius_m().powi(3);
    let volume_m3 = 0.25 * std::f64::consts::PI * diameter_m * diameter_m * thickness_m;
    let share = volume_m3 / particles.iter().map(|&i| cubed(i)).sum::<f64>();
    let [along, direction] = [setup.along, setup.direction].map(Vector3::from);
    for &i in particles {
        let offset = state.particles.poses[i as usize].place() - Vector3::from(setup.middle_m);
        let at = (offset.dot(&direction) / diameter_m + 0.5) * setup.slabs as f64;
        if offset.dot(&along).abs() < half_m && at >= 0.0 {
            setup.strip.push(InSlab {
                particle: i,
                slab: (at as usize).min(setup.slabs - 1),
                volume_m3: share * cubed(i),
            });
        }
    }
}

/// Chooses the particles whose displacement is measured: for a beam those at half its height at the
/// loading points and the supports, for a bar two slices at the ends of its middle half, for a disc
/// two spots at the ends of the middle half of its loaded diameter.
pub(super) fn choose_measured(setup: &mut Setup, state: &State, particles: &[u32]) {
    let middle = Vector3::from(setup.middle_m);
    let [along, direction] = [setup.along, setup.direction].map(Vector3::from);
    let offset = |i: u32| state.particles.poses[i as usize].place() - middle;
    let pick = |is_in: &dyn Fn(f64, f64) -> bool| -> Vec<u32> {
        let all = particles.iter().copied();
        all.filter(|&i| is_in(offset(i).dot(&along), offset(i).dot(&direction)))
            .collect()
    };
    match setup.specimen {
        Specimen::Beam(beam) => {
            let spot = (SPOT * beam.height_m).max(2.0 * setup.mean_radius_m);
            let at = |place: f64| pick(&|x, z| (x.abs() - place).abs() < spot && z.abs() < spot);
            setup.moving = at(0.5 * beam.loading_span_m);
            setup.resting = at(0.5 * beam.span_m);
        }
        Specimen::Bar { length_m, .. } => {
            let half = 0.5 * GAUGE * length_m;
            let spot = (0.05 * length_m).max(2.0 * setup.mean_radius_m);
            setup.moving = pick(&|x, _| (x - half).abs() < spot);
            setup.resting = pick(&|x, _| (x + half).abs() < spot);
            let mean = |of: &[u32]| {
                of.iter().map(|&i| offset(i).dot(&along)).sum::<f64>() / of.len() as f64
            };
            setup.gauge_m = mean(&setup.moving) - mean(&setup.resting);
        }
        Specimen::Disc { diameter_m, .. } => {
            let half = 0.5 * GAUGE * diameter_m;
            let spot = (0.05 * diameter_m).max(2.0 * setup.mean_radius_m);
            let at = |place: f64| pick(&|x, z| x.abs() < spot && (z - place).abs() < spot);
            // The load moves forwards: what lies behind the centre moves further.
            setup.moving = at(-half);
            setup.resting = at(half);
            let mean = |of: &[u32]| {
                of.iter().map(|&i| offset(i).dot(&direction)).sum::<f64>() / of.len() as f64
            };
            setup.gauge_m = mean(&setup.resting) - mean(&setup.moving);
        }
    }
    if setup.moving.is_empty() || setup.resting.is_empty() {
        setup.moving.clear();
        setup.resting.clear();
        setup.gauge_m = 0.0;
    }
}
