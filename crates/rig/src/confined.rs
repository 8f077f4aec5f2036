//! Results of tests under pressure: triaxial compression and direct shear.

use dem_laboratory::Line;
use dem_laboratory::theory::PEAK_AXIAL_STRESS;
use dem_scene::Test;

use super::curve::{elastic_range, largest_n, peak};
use super::record::Row;
use crate::setup::Setup;
use dem_laboratory::figure::Figure;
use dem_laboratory::test_result::PRESSURE_OFF;

/// Ratio of the lateral strain to the axial one, with the sign reversed.
pub const POISSON_RATIO: &str = "Poisson's ratio";
/// Stress that is left at the end of the stroke, Pa.
pub const RESIDUAL: &str = "residual strength";
/// Ratio of the residual strength to the normal stress.
pub const RESIDUAL_FRICTION: &str = "residual friction coefficient";

/// Whether the stress ends below its peak.
pub(super) fn has_passed_its_peak(rows: &[Row]) -> bool {
    let residual = residual_n(rows).zip(peak(rows));
    residual.is_some_and(|(residual_n, peak)| {
        dem_laboratory::has_passed_its_peak(residual_n, peak.load_n())
    })
}

/// Mean load over the last tenth of the travel, N.
fn residual_n(rows: &[Row]) -> Option<f64> {
    let (travel_m, loads_n): (Vec<f64>, Vec<f64>) =
        rows.iter().map(|row| (row.travel_m, row.load_n())).unzip();
    dem_laboratory::residual_n(&travel_m, &loads_n)
}

/// What a test under pressure has besides stiffness, modulus and strength. None of it for other
/// tests.
pub(super) fn figures(test: &Test, setup: &Setup, rows: &[Row]) -> Vec<Figure> {
    let mut found = Vec::new();
    let mut add = |name: &str, value: Option<f64>, unit: &str| {
        found.extend(value.map(|value| Figure::new(name, value, unit, None)));
    };
    let stress = |force_n: f64| setup.specimen.stress_pa(force_n);
    let residual_pa = residual_n(rows)
        .filter(|_| has_passed_its_peak(rows))
        .map(stress);
    if let Some(confinement) = &test.confinement {
        let strength_pa = largest_n(rows).map(stress);
        add(POISSON_RATIO, poisson_ratio(setup, rows), "");
        let axial_pa = strength_pa.map(|strength| strength + confinement.pressure_pa);
        add(
            PEAK_AXIAL_STRESS,
            axial_pa.filter(|_| has_passed_its_peak(rows)),
            "Pa",
        );
        add(RESIDUAL, residual_pa, "Pa");
        add(
            PRESSURE_OFF,
            pressure_off(setup, confinement.pressure_pa, rows),
            "",
        );
    }
    if let Some(normal) = &test.normal_stress {
        add(RESIDUAL, residual_pa, "Pa");
        let ratio = residual_pa.map(|residual| residual / normal.stress_pa);
        add(
            RESIDUAL_FRICTION,
            ratio.filter(|ratio| ratio.is_finite()),
            "",
        );
    }
    found
}

/// Slope of the widening of the body over its shortening between the measured points, in the range
/// of loads in which the modulus is found.
fn poisson_ratio(setup: &Setup, rows: &[Row]) -> Option<f64> {
    if setup.gauge_m == 0.0 {
        return None;
    }
    let rows = elastic_range(rows)?;
    let strains: Vec<f64> = rows
        .iter()
        .map(|row| -row.deflection_m / setup.gauge_m)
        .collect();
    let widenings: Vec<f64> = rows.iter().map(|row| row.widening).collect();
    let ratio = Line::fitted(&strains, &widenings).slope;
    ratio.is_finite().then_some(ratio)
}

/// Largest deviation of a lateral pressure from `pressure_pa`, over it, from the beginning of the
/// elastic range to the largest load.
fn pressure_off(setup: &Setup, pressure_pa: f64, rows: &[Row]) -> Option<f64> {
    let from_s = elastic_range(rows)?.first()?.time_s;
    let to_s = peak(rows)?.time_s;
    let during = rows
        .iter()
        .filter(|row| row.time_s >= from_s && row.time_s <= to_s);
    let off = |row: &Row| {
        let sides = setup.sides.iter().zip(row.sides_n);
        let off = sides.map(|(side, force_n)| (force_n / side.area_m2 / pressure_pa - 1.0).abs());
        off.fold(0.0, f64::max)
    };
    Some(during.map(off).fold(0.0, f64::max))
}
