//! The overlap that gives a wanted solid density (Platzer 2022, section 4.5.1.5): a root search over packings.

use crate::boundary::Boundary;
use crate::pack::{PackSettings, Packing, Progress, pack};
use dem_io::{Diagnostic, Result, Surface};
use serde::Serialize;

/// The search ends when the density is as near as this, relative.
const NEAR_ENOUGH: f64 = 1e-3;
/// Packings tried at most. Two packings of nearly the same overlap differ by chance, so more do not help.
const MOST_PACKINGS: usize = 6;
/// Overlaps are below this: a sphere must not swallow its neighbour's centre.
pub const LARGEST_OVERLAP: f64 = 1.0;

/// What was looked for and how close it came.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DensitySearch {
    /// Wanted mass of the particles / volume of the shape, kg/m3.
    pub wanted_kg_m3: f64,
    /// Found, kg/m3.
    pub found_kg_m3: f64,
    /// The overlap that gives it.
    pub overlap: f64,
    /// How many packings were made.
    pub packings: usize,
}

/// Packs with the overlap that gives `wanted_kg_m3` for particles of `particle_kg_m3`.
///
/// # Errors
/// As [`pack`]; a density that no overlap from 0 to below 1 gives.
pub fn pack_to_density(
    surface: &Surface,
    boundary: &Boundary,
    settings: &mut PackSettings,
    wanted_kg_m3: f64,
    particle_kg_m3: f64,
    progress: Progress,
) -> Result<(Packing, DensitySearch)> {
    let target = wanted_kg_m3 / particle_kg_m3;
    // Filled share of the shape by particle volume = (share filled by reduced spheres) (1 + overlap)^3; the first factor hardly changes.
    settings.overlap = overlap_for(target, 0.59).clamp(0.0, 0.9);
    let mut best: Option<(f64, f64, Packing)> = None;
    let mut packings = 0;
    while packings < MOST_PACKINGS {
        let packing = pack(surface, boundary, settings, progress)?;
        packings += 1;
        let filled = filled_share(surface, &packing);
        let off = (filled / target - 1.0).abs();
        let reduced = filled / (1.0 + settings.overlap).powi(3);
        let tried = settings.overlap;
        if best.as_ref().is_none_or(|(least, ..)| off < *least) {
            best = Some((off, tried, packing));
        }
        let next = overlap_for(target, reduced);
        if next >= LARGEST_OVERLAP || (next < 0.0 && tried == 0.0 && off > NEAR_ENOUGH) {
            return Err(unreachable(wanted_kg_m3, particle_kg_m3, reduced));
        }
        if off < NEAR_ENOUGH || next.max(0.0) == tried {
            break;
        }
        settings.overlap = next.max(0.0);
    }
    let Some((_, overlap, packing)) = best else {
        return Err(unreachable(wanted_kg_m3, particle_kg_m3, 0.6));
    };
    settings.overlap = overlap;
    let found_kg_m3 = filled_share(surface, &packing) * particle_kg_m3;
    Ok((
        packing,
        DensitySearch {
            wanted_kg_m3,
            found_kg_m3,
            overlap,
            packings,
        },
    ))
}

/// Sum of the particles' volumes / volume of the shape.
pub fn filled_share(surface: &Surface, packing: &Packing) -> f64 {
    let spheres: f64 = packing
        .spheres
        .radii
        .iter()
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum();
    spheres * surface.unit_m.powi(3) / surface.volume_m3()
}

fn overlap_for(target: f64, reduced: f64) -> f64 {
    (target / reduced).cbrt() - 1.0
}

fn unreachable(wanted: f64, particle: f64, reduced: f64) -> Diagnostic {
    let (least, most) = (particle * reduced, particle * reduced * 8.0);
    Diagnostic::input(
        "--solid-density",
        format!(
            "{wanted} kg/m3 cannot be reached with particles of {particle} kg/m3: without overlap the body has {least:.0} kg/m3, at overlap 1 {most:.0}"
        ),
        "change --solid-density or --particle-density",
    )
}
