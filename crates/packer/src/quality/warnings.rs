//! Warnings about a packing before it is used, with advice.

use super::checks::{Checks, ENOUGH_BONDS};
use super::pieces::Pieces;
use crate::bonds::WELL_BONDED;
use dem_io::units::significant;

/// Overlaps (in r_gen) and protrusions above this fraction of a radius are not rounding errors.
const EXACT: f64 = 1e-9;
/// Sizes are reported as wrong beyond this multiple of the statistical limit: chance alone exceeds
/// it once in 2,000 packings, the limit itself once in 20.
const CLEARLY_OFF: f64 = 1.5;
/// Probability below which a fabric is reported as anisotropic.
pub(super) const RARE: f64 = 0.01;

pub(super) fn warnings(checks: &Checks, parts: usize) -> Vec<String> {
    let mut warnings = Vec::new();
    let contacts = &checks.contacts;
    if contacts.largest_overlap > EXACT {
        warnings.push(format!(
            "spheres overlap in r_gen by up to {} of a radius: the packing is not finished: please report the command",
            significant(contacts.largest_overlap, 2)
        ));
    }
    if contacts.largest_protrusion > EXACT {
        warnings.push(format!(
            "spheres stand out of the surface by up to {} of a radius: please report the command",
            significant(contacts.largest_protrusion, 2)
        ));
    }
    warnings.extend(pieces_warning(&checks.pieces, parts, checks.particles));
    if checks.particles > 1 && checks.bonds_per_particle < ENOUGH_BONDS {
        warnings.push(few_bonds_warning(
            checks.bonds_per_particle,
            checks.advised_bond_range,
        ));
    }
    warnings.extend(statistical_warnings(checks));
    warnings
}

/// A warning about more pieces than the shape has parts.
pub(super) fn pieces_warning(pieces: &Pieces, parts: usize, particles: usize) -> Option<String> {
    (pieces.count > parts.max(1)).then(|| {
        format!(
            "the body is in {} pieces: {} of {particles} particles are not bonded to the largest; a larger --bond-range or smaller \
             particles join them",
            pieces.count, pieces.outside_largest
        )
    })
}

/// The warning about a body with fewer bonds than make it rigid, and the bond range to advise.
pub(super) fn few_bonds_warning(bonds_per_particle: f64, advised_range: Option<f64>) -> String {
    let advice = match advised_range {
        Some(range) => format!("--bond-range {range} gives {WELL_BONDED}"),
        None => "use smaller particles".to_owned(),
    };
    format!(
        "{} bonds per particle, fewer than {ENOUGH_BONDS} are hardly rigid; {advice}",
        significant(bonds_per_particle, 3)
    )
}

/// Warnings about deviations that chance does not explain: sizes, and directions of bonds.
fn statistical_warnings(checks: &Checks) -> Vec<String> {
    let mut warnings = Vec::new();
    for (fit, by) in [
        (checks.sizes_by_number, "number"),
        (checks.sizes_by_mass, "mass"),
    ] {
        if fit.distance > CLEARLY_OFF * fit.limit_95 {
            warnings.push(format!(
                "sizes are off by {} by {by} (Kolmogorov-Smirnov), chance seldom exceeds {}; use a shape that is larger relative to the \
                 particles, or a narrower distribution",
                significant(fit.distance, 2),
                significant(fit.limit_95, 2)
            ));
        }
    }
    if let Some(fabric) = checks.interior_fabric.as_ref().filter(|f| f.chance < RARE) {
        warnings.push(format!(
            "bonds prefer a direction in the interior (eigenvalue {} off by {} sigma, chance {}): cracks will too; another \
             --seed or a larger --densify helps",
            significant(fabric.eigenvalues[0], 3),
            significant(fabric.largest_deviation_in_sigma, 2),
            significant(fabric.chance, 1)
        ));
    }
    warnings
}
