//! The report compared with closed forms: lattices, lenses, lines, plates and necks.

mod chi_squared;
mod densities;
mod structure;
mod whole;

use dem_pack::Spheres;
use dem_pack::find_bonds;
use dem_pack::internals::{BondedPacking, DEFAULT_GAP_LIMIT, assess};
use dem_pack::{Basis, Sizes};
use dem_pack::{Fraction, Report};

/// Spheres in a box with six walls, or a solid given by its own distance.
struct Case {
    spheres: Spheres,
    extent: [f64; 3],
    overlap: f64,
    bond_range: f64,
    sizes: String,
    particle_density: Option<f64>,
}

impl Case {
    fn new(spheres: Spheres, extent: [f64; 3]) -> Self {
        let sizes = format!("{}m", 2.0 * spheres.radii.first().copied().unwrap_or(1.0));
        Self {
            spheres,
            extent,
            overlap: 0.0,
            bond_range: 1.0 + 1e-9,
            sizes,
            particle_density: None,
        }
    }

    fn report(&self) -> Report {
        let extent = self.extent;
        self.report_in(&move |p| {
            (0..3)
                .map(|k| p[k].min(extent[k] - p[k]))
                .fold(f64::INFINITY, f64::min)
        })
    }

    fn report_in(&self, distance_inside: &(dyn Fn([f64; 3]) -> f64 + Sync)) -> Report {
        let wall_distance: Vec<f64> = self
            .spheres
            .positions
            .iter()
            .map(|p| distance_inside(*p))
            .collect();
        self.report_with(&wall_distance, distance_inside)
    }

    fn report_with(
        &self,
        wall_distance: &[f64],
        distance_inside: &(dyn Fn([f64; 3]) -> f64 + Sync),
    ) -> Report {
        let open = |_: u32, _: u32| false;
        let bonds = find_bonds(&self.spheres, self.bond_range, &open).unwrap();
        assess(&BondedPacking {
            spheres: &self.spheres,
            overlap: self.overlap,
            bonds: &bonds,
            bond_range: self.bond_range,
            sizes: &Sizes::parse(&self.sizes, Basis::Number).unwrap(),
            unit_m: 1.0,
            shape_volume: self.extent.iter().product(),
            extent: self.extent,
            particle_density_kg_m3: self.particle_density,
            wall_distance,
            distance_inside,
            distance_bounds: &|_| [f64::NEG_INFINITY, f64::INFINITY],
            crosses_surface: &open,
            gap_limit: DEFAULT_GAP_LIMIT,
            parts: 1,
        })
        .unwrap()
    }
}

/// Within four of the stated errors, which is small.
#[track_caller]
fn close(fraction: Fraction, wanted: f64) {
    assert!(
        fraction.error > 0.0 && fraction.error < 0.003,
        "{fraction:?}"
    );
    assert!(
        (fraction.value - wanted).abs() < 4.0 * fraction.error,
        "{fraction:?} {wanted}"
    );
}
