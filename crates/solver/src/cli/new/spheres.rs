//! The body of a scene: its shape packed with spheres.

use dem_io::body::ENOUGH_ACROSS;
use dem_io::units::{show_length, significant};
use dem_io::{Body, Diagnostic, Result, Surface};
use dem_pack::{Basis, BodyReport, BodySettings, PackSettings, Sizes, make_body};

use super::templates::Fineness;

/// With it spheres weigh about as much as their shape.
const OVERLAP: f64 = 0.2;
/// Spheres of this overlap in the cube of their diameter, deep in a body.
const SPHERES_IN_CUBE: f64 = 1.85;
/// Packings that are tried: a first one shows how thin the shape is.
const ATTEMPTS: usize = 4;
/// Difference of diameters that matters.
const NEAR: f64 = 0.03;

/// The body, and a remark where it is coarser than it should be.
pub(super) fn packed(
    surface: &Surface,
    fineness: Fineness,
    diameter: Option<&Sizes>,
) -> Result<(Body, Option<String>)> {
    if let Some(sizes) = diameter {
        let packed = pack(surface, sizes.clone()).map_err(advised);
        let (body, report) = packed.map_err(|error| error.within("--diameter"))?;
        return Ok((body, remark(&report, fineness, None)));
    }
    let extent_m = surface.extent().map(|extent| extent * surface.unit_m);
    let shortest_m = extent_m.into_iter().fold(f64::INFINITY, f64::min);
    let most = fineness.most_spheres as f64;
    let fewest_m = (SPHERES_IN_CUBE * surface.volume_m3() / most).cbrt();
    let mut diameter_m = (shortest_m / fineness.across).max(fewest_m);
    let mut attempt = 1;
    loop {
        let (body, report) = pack(surface, around(diameter_m)?).map_err(advised)?;
        let count = body.radii.len() as f64;
        let finest_m = diameter_m * (count / most).cbrt();
        let thickness_m = (report.quality.thinnest.as_ref()).map(|thinnest| thinnest.thickness_m);
        let wanted_m = thickness_m.map_or(diameter_m, |thick| thick / fineness.across);
        let next_m = wanted_m.max(finest_m);
        if (next_m / diameter_m - 1.0).abs() < NEAR || attempt == ATTEMPTS {
            return Ok((body, remark(&report, fineness, Some(wanted_m))));
        }
        diameter_m = next_m;
        attempt += 1;
    }
}

fn pack(surface: &Surface, sizes: Sizes) -> Result<(Body, BodyReport)> {
    let mut settings = PackSettings::new(sizes);
    settings.overlap = OVERLAP;
    make_body(surface, &BodySettings::new(settings), &|_, _| Ok(()))
}

/// A tenth smaller to a tenth larger.
fn around(diameter_m: f64) -> Result<Sizes> {
    Sizes::parse(&range(diameter_m), Basis::Number)
}

fn range(diameter_m: f64) -> String {
    let mm = |factor: f64| significant(factor * diameter_m * 1e3, 3);
    format!("{}mm..{}mm", mm(0.9), mm(1.1))
}

fn advised(error: Diagnostic) -> Diagnostic {
    Diagnostic {
        remedy: "give smaller spheres with --diameter, such as 1mm..2mm".to_owned(),
        ..error
    }
}

/// `wanted_m`: the diameter with which there were enough across.
fn remark(report: &BodyReport, fineness: Fineness, wanted_m: Option<f64>) -> Option<String> {
    let thinnest = report.quality.thinnest.as_ref()?;
    if fineness.is_rigid || thinnest.particles_across.round() >= ENOUGH_ACROSS {
        return None;
    }
    let across = significant(thinnest.particles_across, 2);
    let wanted_m = wanted_m.unwrap_or(thinnest.thickness_m / fineness.across);
    Some(format!(
        "with {} spheres, about {across} lie across the thinnest part ({}): the result will be coarse; \
         --diameter {} gives {ENOUGH_ACROSS}",
        report.quality.particles,
        show_length(thinnest.thickness_m),
        range(wanted_m)
    ))
}
