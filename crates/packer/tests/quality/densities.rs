//! Densities: lattices, lenses, layers, and the stated error.

use super::{Case, close};
use crate::helpers::lattice::cubic;
use dem_pack::Spheres;
use dem_testing::Random;
use std::f64::consts::PI;

/// Common volume of two balls of radius `r` at distance `d`.
fn lens(r: f64, d: f64) -> f64 {
    PI * (4.0 * r + d) * (2.0 * r - d).powi(2) / 12.0
}

#[test]
fn simple_cubic() {
    let n = 20.0;
    let mut case = Case::new(cubic([20; 3], 0.5), [n; 3]);
    case.particle_density = Some(2000.0);
    let report = case.report();
    assert!((report.generating_density - PI / 6.0).abs() < 1e-12);
    assert!((report.solid_density_kg_m3.unwrap() - 2000.0 * PI / 6.0).abs() < 1e-9);
    close(report.union_density, PI / 6.0);
    assert!(
        report.union_density.error < 0.0012,
        "{:?}",
        report.union_density
    );
    // The interior, [2, 18]^3, contains complete cells.
    close(report.interior_union_density.unwrap(), PI / 6.0);
    close(report.interior_generating_density.unwrap(), PI / 6.0);
    let contacts = 3.0 * n * n * (n - 1.0);
    assert_eq!(report.bonds as f64, contacts);
    assert!((report.contacts.per_particle - 2.0 * contacts / n.powi(3)).abs() < 1e-12);
    assert!((report.mean_coordination - report.contacts.per_particle).abs() < 1e-12);
    assert_eq!(report.contacts.at_wall, 8000 - 18 * 18 * 18);
    assert_eq!(report.contacts.rattlers, 0.0);
    assert_eq!(
        (
            report.contacts.largest_overlap,
            report.contacts.largest_protrusion
        ),
        (0.0, 0.0)
    );
    assert_eq!(
        (report.pieces.count, report.pieces.largest_fraction),
        (1, 1.0)
    );
    let fabric = report.interior_fabric.unwrap();
    // Three bonds for each of 16^3 particles: one that leaves the interior counts half.
    assert_eq!(fabric.bonds, 3 * 16 * 16 * 16);
    for fabric in [fabric, report.fabric.unwrap()] {
        assert!(
            fabric
                .eigenvalues
                .iter()
                .all(|e| (e - 1.0 / 3.0).abs() < 1e-12),
            "{fabric:?}"
        );
        assert!(fabric.isotropic_within_2_sigma && fabric.chance > 0.999);
        assert!((fabric.sigma - (4.0 / 45.0 / fabric.bonds as f64).sqrt()).abs() < 1e-15);
    }
    for slab in report.slab_profile.iter().filter_map(|s| s.density) {
        assert!((slab.value - PI / 6.0).abs() < 0.02, "{slab:?}");
    }
    assert_eq!(report.sizes_by_number.distance, 0.0);
}

#[test]
fn face_centred_cubic() {
    // Cell a = sqrt 2 for spheres of diameter 1; the interior, 2 from each wall, holds 6 x 6 x 6
    // cells.
    let a = 2.0_f64.sqrt();
    let extent = 4.0 + 6.0 * a;
    let mut spheres = Spheres::default();
    for i in -1..=10 {
        for j in -1..=10 {
            for k in -1..=10 {
                for base in [
                    [0.0, 0.0, 0.0],
                    [0.0, 0.5, 0.5],
                    [0.5, 0.0, 0.5],
                    [0.5, 0.5, 0.0],
                ] {
                    let p = [f64::from(i), f64::from(j), f64::from(k)];
                    spheres
                        .positions
                        .push([0, 1, 2].map(|m| (p[m] + base[m]) * a + 0.3));
                    spheres.radii.push(0.5);
                }
            }
        }
    }
    let report = Case::new(spheres, [extent; 3]).report();
    close(
        report.interior_generating_density.unwrap(),
        PI / 18.0_f64.sqrt(),
    );
    close(report.union_density, PI / 18.0_f64.sqrt());
    let fabric = report.interior_fabric.unwrap();
    assert!(
        fabric
            .eigenvalues
            .iter()
            .all(|e| (e - 1.0 / 3.0).abs() < 0.01),
        "{fabric:?}"
    );
    // 12 neighbours each, less those at the outside of 12 cells: between 11 and 12.
    assert!(report.contacts.per_particle > 11.0 && report.contacts.per_particle < 12.0);
}

#[test]
fn union_of_two_spheres() {
    let (r, d) = (1.0, 1.2);
    let spheres = Spheres {
        positions: vec![[1.0, 1.0, 1.0], [2.2, 1.0, 1.0]],
        radii: vec![r; 2],
    };
    let mut case = Case::new(spheres, [3.2, 2.0, 2.0]);
    case.overlap = 2.0 * r / d - 1.0;
    let report = case.report();
    let volume = 3.2 * 4.0;
    close(
        report.union_density,
        (2.0 * 4.0 / 3.0 * PI - lens(r, d)) / volume,
    );
    assert!(
        (report.generating_density - 2.0 * 4.0 / 3.0 * PI * 0.6_f64.powi(3) / volume).abs() < 1e-12
    );
    assert!(report.contacts.largest_overlap < 1e-15);
    assert_eq!(report.contacts.per_particle, 1.0);
    assert_eq!(
        report.contacts.rattlers, 1.0,
        "one sphere and the wall each"
    );
    assert!(report.interior_fabric.is_none() && report.interior_union_density.is_none());
}

#[test]
fn overlapping_lattice() {
    // True radius 0.55, r_gen 0.5: each cell holds one ball less its three lenses.
    // The interior, 2.2 from the walls of a box of 16.4, is twelve cells wide.
    let mut case = Case::new(cubic([16; 3], 0.55), [16.4; 3]);
    case.overlap = 0.1;
    case.bond_range = 1.0;
    let report = case.report();
    assert!((report.generating_density - PI / 6.0 * (16.0 / 16.4_f64).powi(3)).abs() < 1e-12);
    close(report.interior_generating_density.unwrap(), PI / 6.0);
    close(
        report.interior_union_density.unwrap(),
        4.0 / 3.0 * PI * 0.55_f64.powi(3) - 3.0 * lens(0.55, 1.0),
    );
    assert_eq!(report.bonds, 3 * 16 * 16 * 15);
    assert!((report.contacts.largest_overlap).abs() < 1e-14);
    // The true spheres protrude from the box by 0.05.
    assert!((report.contacts.largest_protrusion - 0.05 / 0.55).abs() < 1e-12);
    assert!(
        report
            .warnings
            .iter()
            .any(|w| w.contains("stand out of the surface by up to 0.091")),
        "{:?}",
        report.warnings
    );
}

#[test]
fn profile_from_a_wall() {
    // Two planes, at z = 0 and 14; the layer [a, b] of the first row of cells is filled by pi (b -
    // a)/4 - ...
    let case = Case::new(cubic([12, 12, 14], 0.5), [12.0, 12.0, 14.0]);
    let report = case.report_in(&|p| p[2].min(14.0 - p[2]));
    let filled = |z: f64| PI * (0.25 * z - (z - 0.5).powi(3) / 3.0);
    assert_eq!(report.wall_profile.len(), 20);
    for (i, layer) in report.wall_profile.iter().enumerate() {
        let from = 0.25 * (i % 4) as f64;
        assert!(
            (layer.from_m - 0.25 * i as f64).abs() < 1e-12
                && (layer.to_m - layer.from_m - 0.25).abs() < 1e-12
        );
        let density = layer.density.unwrap();
        assert!(density.error < 0.01, "{density:?}");
        let wanted = (filled(from + 0.25) - filled(from)) / 0.25;
        assert!(
            (density.value - wanted).abs() < 4.0 * density.error,
            "{i}: {density:?} {wanted}"
        );
    }
}

#[test]
fn the_stated_error_is_the_error() {
    // Balls without overlap at random places in a box: the covered fraction is known, and the error
    // must be too small as often as too large.
    let mut random = Random(4);
    let mut squares = 0.0;
    let cases = 40;
    for _ in 0..cases {
        let mut spheres = Spheres::default();
        while spheres.radii.len() < 40 {
            let radius = 0.3 + 0.2 * random.fraction();
            let p = [0, 1, 2].map(|_| radius + (4.0 - 2.0 * radius) * random.fraction());
            let free = spheres.positions.iter().zip(&spheres.radii).all(|(q, s)| {
                (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>() > (radius + s).powi(2)
            });
            if free {
                spheres.positions.push(p);
                spheres.radii.push(radius);
            }
        }
        let report = Case::new(spheres, [4.0; 3]).report();
        squares += ((report.union_density.value - report.generating_density)
            / report.union_density.error)
            .powi(2);
    }
    // Chi-squared of 40 degrees: 40 +- 9; between its 0.05 % and 99.95 %.
    assert!((16.0..77.0).contains(&squares), "{squares}");
}

#[test]
fn outside_costs_nothing_of_the_solid() {
    // A ball of radius 8 in its box, filled without overlap. Outside, the distance may only be
    // known to be negative.
    let inside = |p: [f64; 3]| 8.0 - p.iter().map(|x| (x - 8.0).powi(2)).sum::<f64>().sqrt();
    let mut spheres = cubic([16; 3], 0.5);
    spheres.positions.retain(|p| inside(*p) >= 0.5);
    spheres.radii.truncate(spheres.positions.len());
    // Volumes of a sphere and of the ball: pi/6 and 4/3 pi 8^3.
    let wanted = spheres.radii.len() as f64 / 4096.0;
    for outside in [0.0, 1.0] {
        let report = Case::new(spheres.clone(), [16.0; 3]).report_in(&|p| {
            let depth = inside(p);
            if depth < 0.0 { outside * depth } else { depth }
        });
        assert!(
            (report.union_density.value - wanted).abs() < 4.0 * report.union_density.error,
            "{:?} {wanted}",
            report.union_density
        );
    }
}
