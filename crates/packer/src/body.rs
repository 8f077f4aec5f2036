//! A bonded body from a surface: spheres, bonds, and a report of how good they are.

use crate::bonds::{BondSettings, bond_lengths, bond_radii, centre_distance, find_bonds};
use crate::density::{DensitySearch, pack_to_density};
use crate::geometry::boundary::Boundary;
use crate::geometry::depth_map::DepthMap;
use crate::pack::{
    PackHistory, PackSettings, Packing, Progress, Solid, can_fill_voids, pack_solid,
};
use crate::quality::{
    BondedPacking, DEFAULT_GAP_LIMIT, Report, Thinnest, assess, depth_needed, find_warnings,
};
use crate::sizes::Sizes;
use crate::spheres::{Spheres, Vector3};
use dem_io::body::About;
use dem_io::body::mass::{BodyMass, of_body, of_named_density, volume_m3};
use dem_io::units::significant;
use dem_io::{Body, Result, Surface};
use rayon::prelude::*;
use serde::Serialize;
use std::time::Instant;

/// Number of spheres whose distance to the wall one task measures.
const SPHERES_PER_TASK: usize = 256;

/// Settings of a body.
#[derive(Debug, Clone)]
pub struct BodySettings {
    /// Settings of the sphere packing.
    pub packing: PackSettings,
    /// Which spheres are bonded, and how.
    pub bonds: BondSettings,
    /// Density of the particles' material, kg/m3.
    pub particle_density_kg_m3: Option<f64>,
    /// Target mass of the particles / volume of the shape, kg/m3, for which the overlap is chosen.
    pub solid_density_kg_m3: Option<f64>,
}

impl BodySettings {
    /// With the program's default bonds.
    pub fn new(packing: PackSettings) -> Self {
        Self {
            packing,
            bonds: BondSettings::default(),
            particle_density_kg_m3: None,
            solid_density_kg_m3: None,
        }
    }
}

/// Fraction of spheres taken out above which a warning is given.
const MANY_TAKEN_OUT: f64 = 0.005;

/// Times of the stages, s.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct StageSeconds {
    /// Time for the front, settling and filling, for every packing of a density search.
    pub packing: f64,
    /// Time to find the bonds.
    pub bonds: f64,
    /// Time for distances to the wall, checks and the report.
    pub report: f64,
}

/// Results of making a body.
#[derive(Debug, Clone, Serialize)]
pub struct BodyReport {
    /// Its quality.
    pub quality: Report,
    /// Its mass, and the mass of its shape filled with the density of the particles. None without
    /// that density.
    pub mass: Option<BodyMass>,
    /// Mass of the particles / mass of the shape filled with their density; independent of that
    /// density.
    pub mass_over_shape: f64,
    /// Centre of mass, m. Length 3.
    pub centre_m: [f64; 3],
    /// History of its packing. The times are the sums over all packings of a density search.
    pub history: PackHistory,
    /// The bond range that was used.
    pub bond_range: f64,
    /// The search for the overlap, if there was one.
    pub density_search: Option<DensitySearch>,
    /// What the sizes leave out, one sentence each.
    pub notes: Vec<String>,
    /// Repairs of the surface.
    pub repairs: dem_io::surface::Repairs,
    /// Times of the stages.
    pub seconds: StageSeconds,
}

/// Packs a shape with spheres, bonds them and assesses the body. Refuses a density that no overlap
/// gives.
pub fn make_body(
    surface: &Surface,
    settings: &BodySettings,
    progress: Progress,
) -> Result<(Body, BodyReport)> {
    let (made, mut quality) = make(surface, settings, progress, assess)?;
    quality.warnings.extend(made.packed.warnings());
    let body = made.body(settings, quality.thinnest, quality.warnings.clone());
    let report = BodyReport {
        mass: of_named_density(&body),
        mass_over_shape: spheres_volume_m3(&body) / surface.volume_m3(),
        centre_m: of_body(&body, 1.0).centre_m,
        quality,
        history: made.packed.packing.history,
        bond_range: made.bond_range,
        density_search: made.packed.density_search,
        notes: (settings.packing.sizes.note().iter())
            .map(|note| (*note).to_owned())
            .collect(),
        repairs: surface.repairs.clone(),
        seconds: made.seconds,
    };
    Ok((body, report))
}

/// The body of [`make_body`], with the same warnings, but without a report: what only a report
/// shows is not computed.
pub fn make_body_only(
    surface: &Surface,
    settings: &BodySettings,
    progress: Progress,
) -> Result<Body> {
    let (made, (thinnest, mut warnings)) = make(surface, settings, progress, find_warnings)?;
    warnings.extend(made.packed.warnings());
    Ok(made.body(settings, thinnest, warnings))
}

/// A bonded packing.
struct Made<'a> {
    solid: Solid<'a>,
    packed: Packed,
    bonds: Vec<[u32; 2]>,
    bond_range: f64,
    seconds: StageSeconds,
}

/// Packs a shape with spheres, bonds them and judges the result.
fn make<'a, Q>(
    surface: &'a Surface,
    settings: &BodySettings,
    progress: Progress,
    judge: fn(&BondedPacking) -> Result<Q>,
) -> Result<(Made<'a>, Q)> {
    let started = Instant::now();
    let solid = Solid::new(surface)?;
    let prepared = started.elapsed().as_secs_f64();
    let mut packed = packed(&solid, settings, progress)?;
    packed.packing.history.front_seconds += prepared;
    let mut seconds = StageSeconds {
        packing: started.elapsed().as_secs_f64(),
        ..StageSeconds::default()
    };

    let started = Instant::now();
    progress("report", 0.0)?;
    let spheres = &packed.packing.spheres;
    let map = depth_map(&solid, spheres);
    let wall_distance: Vec<f64> = spheres
        .positions
        .par_iter()
        .with_min_len(SPHERES_PER_TASK)
        .map(|p| map.depth(*p))
        .collect();
    seconds.report = started.elapsed().as_secs_f64();

    let started = Instant::now();
    progress("bonds", 0.0)?;
    let crosses = |a: u32, b: u32| {
        let (p, q) = (spheres.positions[a as usize], spheres.positions[b as usize]);
        // Spheres that clear the surface and cover the line between their centres.
        let clear = wall_distance[a as usize] + wall_distance[b as usize];
        clear <= centre_distance(spheres, a, b) && crosses_surface(&solid.boundary, p, q)
    };
    let bond_range = settings.bonds.range_for(spheres, &crosses)?;
    let bonds = find_bonds(spheres, bond_range, &crosses)?;
    seconds.bonds = started.elapsed().as_secs_f64();

    let started = Instant::now();
    progress("report", 0.0)?;
    let judged = judge(&BondedPacking {
        spheres,
        overlap: packed.settings.overlap,
        bonds: &bonds,
        bond_range,
        sizes: &settings.packing.sizes,
        unit_m: surface.unit_m,
        shape_volume: surface.volume_m3() / surface.unit_m.powi(3),
        extent: surface.extent(),
        particle_density_kg_m3: settings.particle_density_kg_m3,
        wall_distance: &wall_distance,
        distance_inside: &|p| map.depth(p),
        distance_bounds: &|p| map.bounds(p),
        crosses_surface: &crosses,
        gap_limit: DEFAULT_GAP_LIMIT,
        parts: parts(surface),
    })?;
    seconds.report += started.elapsed().as_secs_f64();
    drop(map);
    let made = Made {
        solid,
        packed,
        bonds,
        bond_range,
        seconds,
    };
    Ok((made, judged))
}

/// Map of distances to the wall as far as the report needs them, with cells two mean diameters
/// wide.
fn depth_map<'a>(solid: &'a Solid, spheres: &Spheres) -> DepthMap<'a> {
    let mean_radius = spheres.radii.iter().sum::<f64>() / spheres.radii.len() as f64;
    let reach = depth_needed(spheres);
    DepthMap::new(solid.surface, &solid.boundary, reach, 4.0 * mean_radius)
}

/// Spheres and the history of their packing.
struct Packed {
    packing: Packing,
    /// Settings, with the overlap found by a density search.
    settings: PackSettings,
    density_search: Option<DensitySearch>,
}

fn packed(solid: &Solid, settings: &BodySettings, progress: Progress) -> Result<Packed> {
    let densities = settings
        .solid_density_kg_m3
        .zip(settings.particle_density_kg_m3);
    let mut settings = settings.packing.clone();
    let (packing, density_search) = match densities {
        Some((wanted, particle)) => {
            let (packing, search) =
                pack_to_density(solid, &mut settings, wanted, particle, progress)?;
            (packing, Some(search))
        }
        None => (pack_solid(solid, &settings, progress)?, None),
    };
    Ok(Packed {
        packing,
        settings,
        density_search,
    })
}

impl Packed {
    /// Warnings about the packing.
    fn warnings(&self) -> impl Iterator<Item = String> {
        let history = &self.packing.history;
        let density = self
            .density_search
            .as_ref()
            .and_then(DensitySearch::warning);
        let jammed = jam_warning(history, self.packing.spheres.radii.len());
        let open = void_warning(history, &self.settings.sizes);
        density.into_iter().chain(jammed).chain(open)
    }
}

impl Made<'_> {
    /// The body in metres.
    fn body(
        &self,
        settings: &BodySettings,
        thinnest: Option<Thinnest>,
        warnings: Vec<String>,
    ) -> Body {
        let surface = self.solid.surface;
        let spheres = &self.packed.packing.spheres;
        let in_metres =
            |lengths: Vec<f64>| lengths.into_iter().map(|l| l * surface.unit_m).collect();
        let bonds = &self.bonds;
        Body {
            bond_radii: in_metres(bond_radii(spheres, bonds, settings.bonds.radius_factor)),
            bond_lengths: in_metres(bond_lengths(spheres, bonds)),
            bond_damages: Vec::new(),
            turns_rad: Vec::new(),
            bond_directions: Vec::new(),
            bond_histories: Vec::new(),
            positions: spheres
                .positions
                .iter()
                .map(|p| self.solid.to_metres(&Vector3::from(*p)))
                .collect(),
            radii: spheres.radii.iter().map(|r| r * surface.unit_m).collect(),
            bonds: bonds.clone(),
            about: About {
                program: Some(format!("dem-pack {}", env!("CARGO_PKG_VERSION"))),
                source: Some(surface.source.clone()),
                source_hash: Some(surface.source_hash),
                shape_volume_m3: Some(surface.volume_m3()),
                particle_density_kg_m3: settings.particle_density_kg_m3,
                overlap: Some(self.packed.settings.overlap),
                bond_range: Some(self.bond_range),
                seed: Some(self.packed.settings.seed),
                thinnest_part_m: thinnest.map(|thinnest| thinnest.thickness_m),
                particles_across: thinnest.map(|thinnest| thinnest.particles_across),
                warnings,
            },
        }
    }
}

fn spheres_volume_m3(body: &Body) -> f64 {
    body.radii.iter().map(|radius| volume_m3(*radius)).sum()
}

/// Number of separate parts of the solid. Parts that cross each other count as one.
fn parts(surface: &Surface) -> usize {
    if surface.repairs.self_intersections > 0 {
        1
    } else {
        surface.parts()
    }
}

/// A warning if many spheres jammed.
fn jam_warning(history: &PackHistory, particles: usize) -> Option<String> {
    let fraction = history.removed as f64 / particles.max(1) as f64;
    (fraction > MANY_TAKEN_OUT).then(|| {
        format!(
            "{} spheres ({} %) jammed during densification and were removed: --densify {} leaves them more room",
            history.removed,
            significant(100.0 * fraction, 2),
            significant(0.8 * history.densify, 2)
        )
    })
}

/// A warning if voids remain although the sizes would allow filling them.
fn void_warning(history: &PackHistory, sizes: &Sizes) -> Option<String> {
    (can_fill_voids(sizes) && history.voids_left > 0).then(|| {
        format!(
            "about {} voids would take the smallest sphere: to fill them all would change the sizes; take smaller particles, or less different ones",
            history.voids_left
        )
    })
}

/// True if the straight line between two points inside the solid (local units) meets the surface.
fn crosses_surface(boundary: &Boundary, a: [f64; 3], b: [f64; 3]) -> bool {
    let (a, b) = (Vector3::from(a), Vector3::from(b));
    let length = (b - a).norm();
    let middle = 0.5 * (a + b);
    if boundary.clears(&middle, 0.5 * length) {
        return false;
    }
    crate::geometry::inside::first_hit(boundary, &a, &((b - a) / length), 0.0)
        .is_some_and(|distance| distance < length)
}
