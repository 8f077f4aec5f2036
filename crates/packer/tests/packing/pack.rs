//! Complete packings, exact on shapes of many kinds, sizes and orientations.

use crate::helpers::exact::assert_exact;
use crate::helpers::facets::cuboid;
use crate::helpers::packing::{pack_with, settings};
use crate::helpers::solids::{between, random_numbers, random_solid, surface_of, turned};
use dem_pack::{PackSettings, pack};
use rand::RngExt;

/// Packs solids of one kind with random sizes, orientations, diameters, overlaps and seeds.
fn exact_on(kind: usize) {
    for case in 0..6 {
        let mut random = random_numbers(1000 * kind as u64 + case);
        let (name, solid) = random_solid(&mut random, kind);
        let solid = if case % 2 == 0 {
            turned(&mut random, solid)
        } else {
            solid
        };
        let mean = between(&mut random, 0.7, 1.1);
        let diameter = match case % 3 {
            0 => format!("{}mm..{}mm", 0.8 * mean, 1.2 * mean),
            1 => format!(
                "lognormal:{mean}mm,{}mm,{}mm..{}mm",
                0.2 * mean,
                0.6 * mean,
                1.6 * mean
            ),
            _ => format!("{mean}mm"),
        };
        let overlap = if case == 3 {
            0.0
        } else {
            between(&mut random, 0.0, 0.6)
        };
        for settled in [false, true] {
            let mut settings = settings(&diameter, overlap, (!settled).then_some(0.0));
            settings.seed = random.random();
            let what = format!(
                "{name} {case}, {diameter}, overlap {overlap}, settled {settled}, seed {}",
                settings.seed
            );
            let (facets, packing) = pack_with(&solid, &settings);
            let spheres = &packing.spheres;
            assert_exact(
                &what,
                &facets,
                &spheres.positions,
                &spheres.radii,
                overlap,
                0.0,
            );
            let (surface, _) = surface_of(&solid);
            for r in &spheres.radii {
                let d = 2.0 * r * surface.unit_m;
                assert!(
                    d >= settings.sizes.min_m() * (1.0 - 1e-12)
                        && d <= settings.sizes.max_m() * (1.0 + 1e-12),
                    "{what}: {d}"
                );
            }
            // However bad the shape, a packing of spheres is only as thin as this if a part was
            // forgotten.
            let filled = spheres
                .radii
                .iter()
                .map(|r| (r / (1.0 + overlap)).powi(3))
                .sum::<f64>()
                * 4.0
                / 3.0
                * std::f64::consts::PI;
            let fraction = filled * surface.unit_m.powi(3) / surface.volume_m3();
            assert!(
                fraction > 0.25 && fraction < 0.66,
                "{what}: filled {fraction}"
            );
        }
    }
}

#[test]
fn exact_in_boxes() {
    exact_on(0);
}

#[test]
fn exact_in_tetrahedra() {
    exact_on(1);
}

#[test]
fn exact_in_stars() {
    exact_on(2);
}

#[test]
fn exact_in_l_shapes() {
    exact_on(3);
}

#[test]
fn exact_in_wedges() {
    exact_on(4);
}

#[test]
fn exact_in_tori() {
    exact_on(5);
}

#[test]
fn a_sphere_that_just_fits_is_placed() {
    let (facets, packing) = pack_with(
        &cuboid([8.0, 8.0, 8.0]),
        &settings("7.99mm", 0.0, Some(0.0)),
    );
    assert_eq!(packing.spheres.radii.len(), 1);
    assert_exact(
        "one sphere",
        &facets,
        &packing.spheres.positions,
        &packing.spheres.radii,
        0.0,
        0.0,
    );
    // A row of four in a channel as wide as they are.
    let (facets, packing) = pack_with(
        &cuboid([32.0, 8.0, 8.0]),
        &settings("7.999mm", 0.0, Some(0.0)),
    );
    assert!(
        packing.spheres.radii.len() >= 3,
        "{}",
        packing.spheres.radii.len()
    );
    assert_exact(
        "row",
        &facets,
        &packing.spheres.positions,
        &packing.spheres.radii,
        0.0,
        0.0,
    );
}

/// A plate one sphere thick: each sphere touches both walls, and none may protrude by the rounding
/// of the last step.
#[test]
fn exact_in_a_plate_one_sphere_thick() {
    for seed in 1..=10 {
        let settings = PackSettings {
            seed,
            ..settings("3mm", 0.0, None)
        };
        let (facets, packing) = pack_with(&cuboid([30.0, 30.0, 3.0]), &settings);
        let spheres = &packing.spheres;
        assert!(spheres.radii.len() > 60, "{}", spheres.radii.len());
        assert_exact(
            "plate",
            &facets,
            &spheres.positions,
            &spheres.radii,
            0.0,
            0.0,
        );
    }
}

/// The first three spheres are around the seed, and the seed may be nearer to the wall than any
/// sphere can be.
#[test]
fn exact_from_a_seed_almost_on_the_wall() {
    for settle in [Some(0.0), None] {
        for seed_point_m in [
            [0.05e-3, 9.3e-3, 9e-3],
            [19.99e-3, 5e-3, 0.01e-3],
            [1e-6; 3],
        ] {
            let settings = PackSettings {
                seed_point_m: Some(seed_point_m),
                ..settings("2mm..3mm", 0.0, settle)
            };
            let (facets, packing) = pack_with(&cuboid([20.0, 10.0, 10.0]), &settings);
            let spheres = &packing.spheres;
            assert!(spheres.radii.len() > 80, "{}", spheres.radii.len());
            assert_exact("bar", &facets, &spheres.positions, &spheres.radii, 0.0, 0.0);
        }
    }
}

#[test]
fn the_front_begins_at_the_point_given() {
    let (surface, _) = surface_of(&cuboid([20.0, 10.0, 10.0]));
    let given = [3e-3, 4e-3, 5e-3];
    let settings = PackSettings {
        seed_point_m: Some(given),
        ..settings("1mm..1.5mm", 0.2, Some(0.0))
    };
    let packing = pack(&surface, &settings, &|_, _| Ok(())).unwrap();
    for (found, wanted) in packing.history.seed_point_m.iter().zip(given) {
        assert!((found - wanted).abs() < 1e-15);
    }
    let elsewhere = pack(
        &surface,
        &PackSettings {
            seed_point_m: None,
            ..settings.clone()
        },
        &|_, _| Ok(()),
    )
    .unwrap();
    assert_ne!(packing.spheres, elsewhere.spheres);
    let outside = PackSettings {
        seed_point_m: Some([-1e-3, 4e-3, 5e-3]),
        ..settings
    };
    let error = pack(&surface, &outside, &|_, _| Ok(())).unwrap_err();
    assert_eq!(error.place, "--seed-point");
}

#[test]
fn a_stop_asked_for_by_progress_stops_it() {
    let (surface, _) = surface_of(&cuboid([20.0, 10.0, 10.0]));
    for stage in ["front", "densifying", "filling voids"] {
        let stop = |now: &str, _: f64| {
            if now == stage {
                Err(dem_io::Diagnostic::failed("", "stopped", ""))
            } else {
                Ok(())
            }
        };
        let stopped = pack(&surface, &settings("1mm..1.5mm", 0.2, Some(0.034)), &stop);
        assert_eq!(stopped.unwrap_err().problem, "stopped", "{stage}");
    }
}
