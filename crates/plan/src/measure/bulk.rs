//! Bulk quantities: mass and bulk density of a region, bulk density of a heap.
//!
//! A sphere counts with the part of it that is in a region: of [`POINTS`] points spread evenly
//! through it, those within.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::Vector3;
use rayon::prelude::*;

use super::measurement::{IfZero, Measurement, Settles};
use super::probe::Probe;
use super::spheres::{Sphere, across, spheres};
use super::view::View;
use dem_physics::geometry::region::Region;

/// Points of a sphere that a border cuts: its part on one side is known to some thousandths.
const POINTS: usize = 500;
/// Columns of a heap are this wide, in mean diameters.
const COLUMN: f64 = 0.5;
/// A column that a sphere enters by less than about half of this part of its radius is beside it:
/// rounding must not decide for spheres that lie side by side.
const TOUCHED: f64 = 1e-6;

pub(super) const MEASUREMENTS: &[Measurement] = &[
    Measurement {
        if_zero: IfZero::Note(|measure| {
            let (of, within) = (&measure.of, measure.within.as_ref()?);
            Some(format!(
                "nothing of '{of}' ever was in the region '{within}'"
            ))
        }),
        ..Measurement::new("mass", mass_kg)
    },
    Measurement {
        settles: Settles::Roughly,
        if_zero: IfZero::Doubt(|measure| {
            let (of, within) = (&measure.of, measure.within.as_ref()?);
            Some(format!(
                "nothing of '{of}' ever was in the region '{within}'; check its place and size"
            ))
        }),
        ..Measurement::new("bulk_density", density_kg_m3)
    },
    Measurement {
        settles: Settles::Roughly,
        missing: |probe| {
            let within = probe.measure.within.as_deref().unwrap_or_default();
            let of = &probe.measure.of;
            Some(format!("the region \"{within}\" has nothing of \"{of}\""))
        },
        refusal: |measure, planned| {
            let mass = planned.masses.get(&measure.of);
            let has_shape = mass.is_some_and(|mass| mass.solid_density_kg_m3.is_some());
            (!has_shape).then(|| {
                (
                    format!("\"{}\" is no body with a shape of known volume", measure.of),
                    "name one body in \"of\", whose file says its shape_volume_m3 (a .vtp of dem-pack)",
                )
            })
        },
        ..Measurement::new("bulking_factor", |probe, view| {
            match density_kg_m3(probe, view) {
                0.0 => f64::NAN,
                density => probe.solid_density_kg_m3 / density,
            }
        })
    },
];

/// Mass in the region, or of all, kg.
fn mass_kg(probe: &Probe, view: &View<'_>) -> f64 {
    let own = spheres(&probe.members, view.state);
    match probe.region {
        Some(at) => mass_within_kg(&own, &view.state.model.rules.regions[at]),
        None => 0.0 + own.iter().map(|sphere| sphere.mass_kg).sum::<f64>(),
    }
}

/// Bulk density in the region, or under the surface of all, kg/m3.
fn density_kg_m3(probe: &Probe, view: &View<'_>) -> f64 {
    let own = spheres(&probe.members, view.state);
    match probe.region {
        Some(at) => {
            let region = &view.state.model.rules.regions[at];
            mass_within_kg(&own, region) / region.volume_m3()
        }
        None => heap_density_kg_m3(&own, view.up()),
    }
}

/// Mass of the part of some spheres that is in a region, kg.
fn mass_within_kg(spheres: &[Sphere], region: &Region) -> f64 {
    let points = points_of_ball();
    let mass = |s: &Sphere| s.mass_kg * part_within(s, region, &points);
    let masses: Vec<f64> = spheres.par_iter().map(mass).collect();
    0.0 + masses.iter().sum::<f64>()
}

fn part_within(sphere: &Sphere, region: &Region, points: &[Vector3<f64>]) -> f64 {
    let (place, radius_m) = (sphere.place_m.into(), sphere.radius_m);
    if !region.bounds().is_near(&place, radius_m) {
        return 0.0;
    }
    if !region.cuts(place, radius_m) {
        return f64::from(u8::from(region.contains(place)));
    }
    let is_in =
        |point: &&Vector3<f64>| region.contains((sphere.place_m + radius_m * **point).into());
    points.iter().filter(is_in).count() as f64 / points.len() as f64
}

/// Points spread evenly through a ball of radius 1: shells of equal volume along a spiral, turned
/// by the golden ratio from point to point, at depths in the order of the van der Corput sequence.
fn points_of_ball() -> Vec<Vector3<f64>> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let point = |n: usize| {
        let height = 1.0 - 2.0 * (n as f64 + 0.5) / POINTS as f64;
        let angle = TAU * golden * n as f64;
        let across = (1.0 - height * height).sqrt();
        let depth = f64::from((n as u32 + 1).reverse_bits()) / 2.0_f64.powi(32);
        depth.cbrt() * Vector3::new(across * angle.cos(), across * angle.sin(), height)
    };
    (0..POINTS).map(point).collect()
}

/// Mass of some spheres over the volume under their surface, kg/m3: that of columns along `up`,
/// from the lowest point of all to the highest point in each column. Columns are half a mean
/// diameter wide. NaN if there are none.
fn heap_density_kg_m3(spheres: &[Sphere], up: Vector3<f64>) -> f64 {
    let [aside, across] = across(&up);
    let mean_m = spheres.iter().map(|s| s.radius_m).sum::<f64>() / spheres.len() as f64;
    let width_m = 2.0 * COLUMN * mean_m;
    let mut tops: BTreeMap<[i64; 2], f64> = BTreeMap::new();
    let mut lowest_m = f64::INFINITY;
    for sphere in spheres {
        let radius_m = sphere.radius_m;
        let [x, y, z] = [aside, across, up].map(|axis| sphere.place_m.dot(&axis));
        lowest_m = lowest_m.min(z - radius_m);
        let [from, to] = [-1.0, 1.0]
            .map(|side| [x, y].map(|middle| ((middle + side * radius_m) / width_m).floor() as i64));
        for i in from[0]..=to[0] {
            for j in from[1]..=to[1] {
                // The point of the column nearest to the axis of the sphere is the highest.
                let [aside_m, across_m] = [(i, x), (j, y)].map(|(n, middle)| {
                    let [low, high] = [n as f64, (n + 1) as f64].map(|end| end * width_m);
                    (low - middle).max(middle - high).max(0.0)
                });
                let left_m2 = radius_m * radius_m - aside_m.powi(2) - across_m.powi(2);
                if left_m2 > TOUCHED * radius_m * radius_m {
                    let top = tops.entry([i, j]).or_insert(f64::NEG_INFINITY);
                    *top = top.max(z + left_m2.sqrt());
                }
            }
        }
    }
    let heights = tops.values().map(|top| top - lowest_m);
    let volume_m3 = width_m * width_m * heights.sum::<f64>();
    spheres.iter().map(|s| s.mass_kg).sum::<f64>() / volume_m3
}
