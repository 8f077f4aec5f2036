//! The bare front: every sphere rests on three others or on two and the wall, for any seeds.

use crate::helpers::exact::assert_exact;
use crate::helpers::facets::{Facets, cuboid, prism};
use crate::helpers::packing::{pack_with, settings};
use crate::helpers::solids::{distance_to_surface, icosphere, surface_of};
use dem_pack::{PackSettings, Packing};

fn bare_front(facets: &Facets, diameter: &str, overlap: f64) -> (Facets, Packing) {
    let settings = PackSettings {
        seed: 3,
        ..settings(diameter, overlap, Some(0.0))
    };
    pack_with(facets, &settings)
}

/// Spheres that touch fewer than three others and walls.
fn unsupported(facets: &Facets, packing: &Packing, overlap: f64) -> usize {
    let spheres = &packing.spheres;
    let reduced: Vec<f64> = spheres.radii.iter().map(|r| r / (1.0 + overlap)).collect();
    let touches = |i: usize| {
        let others = (0..reduced.len()).filter(|j| {
            let d: f64 = (0..3)
                .map(|k| (spheres.positions[i][k] - spheres.positions[*j][k]).powi(2))
                .sum::<f64>()
                .sqrt();
            *j != i && (d / (reduced[i] + reduced[*j]) - 1.0).abs() < 1e-9
        });
        let wall = (distance_to_surface(facets, &spheres.positions[i]) / spheres.radii[i] - 1.0)
            .abs()
            < 1e-9;
        others.count() + usize::from(wall)
    };
    (0..reduced.len()).filter(|i| touches(*i) < 3).count()
}

#[test]
fn spheres_touch_three_others_or_two_and_the_wall() {
    let l_shape = prism(
        &[
            [0.0, 0.0],
            [14.0, 0.0],
            [14.0, 5.0],
            [5.0, 5.0],
            [5.0, 12.0],
            [0.0, 12.0],
        ],
        7.0,
    );
    let cases = [
        (
            "box, uniform",
            cuboid([12.0, 9.0, 8.0]),
            "0.8mm..1.2mm",
            0.0,
        ),
        ("box, one size", cuboid([12.0, 9.0, 8.0]), "1mm", 0.25),
        ("ball", icosphere(2, &|_| 5.5), "0.8mm..1.2mm", 0.3),
        ("L", l_shape, "lognormal:0.9mm,0.2mm,0.6mm..1.5mm", 0.1),
    ];
    for (name, facets, diameter, overlap) in cases {
        let (facets, packing) = bare_front(&facets, diameter, overlap);
        let spheres = &packing.spheres;
        assert_exact(
            name,
            &facets,
            &spheres.positions,
            &spheres.radii,
            overlap,
            0.0,
        );
        // The first three of a front rest only on each other, and some fillers of voids are at the
        // roomiest place.
        let free = 3 * packing.history.fronts + packing.history.loose_fillers;
        let found = unsupported(&facets, &packing, overlap);
        assert!(
            found <= free,
            "{name}: {found} of {} spheres are unsupported, {free} may be",
            spheres.radii.len()
        );
        assert_eq!(packing.history.densify_steps, 0);
    }
}

#[test]
fn a_part_that_the_front_cannot_reach_gets_its_own() {
    let mut facets = cuboid([6.0, 6.0, 6.0]);
    for shift in [10.0, 20.0] {
        facets.extend(
            cuboid([6.0, 6.0, 6.0])
                .into_iter()
                .map(|c| c.map(|p| [p[0] + shift, p[1], p[2]])),
        );
    }
    let (_, packing) = bare_front(&facets, "0.8mm..1.2mm", 0.0);
    assert!(packing.history.fronts >= 3);
    let (surface, _) = surface_of(&facets);
    let mm = surface.unit_m * 1e3;
    let counts = [0.0, 10.0, 20.0].map(|low| {
        packing
            .spheres
            .positions
            .iter()
            .filter(|p| p[0] * mm > low && p[0] * mm < low + 6.0)
            .count()
    });
    assert_eq!(counts.iter().sum::<usize>(), packing.spheres.radii.len());
    let mean = packing.spheres.radii.len() / 3;
    assert!(
        counts.iter().all(|n| n.abs_diff(mean) < mean / 5),
        "{counts:?}"
    );
}

#[test]
fn no_void_is_left_that_takes_one_more_sphere_of_one_size() {
    let overlap = 0.2;
    let (facets, packing) = bare_front(&cuboid([10.0, 8.0, 7.0]), "1mm", overlap);
    assert_eq!(packing.history.voids_left, 0);
    // Points on a fine lattice where a sphere would fit with a tenth to spare: a void for another
    // sphere would contain one.
    let spheres = &packing.spheres;
    let radius = spheres.radii[0];
    let spacing = 0.1 * radius;
    let high = facets
        .iter()
        .flatten()
        .fold([0.0_f64; 3], |m, p| [0, 1, 2].map(|k| m[k].max(p[k])));
    let steps = high.map(|h| ((h - 2.0 * radius) / spacing) as usize);
    let room = 2.0 * radius / (1.0 + overlap);
    let mut taken = vec![false; (steps[0] + 1) * (steps[1] + 1) * (steps[2] + 1)];
    let at = |c: [usize; 3]| (c[2] * (steps[1] + 1) + c[1]) * (steps[0] + 1) + c[0];
    for p in &spheres.positions {
        let range = |k: usize| {
            let low = ((p[k] - room - radius) / spacing).max(0.0) as usize;
            low..=(((p[k] + room - radius) / spacing) as usize + 1).min(steps[k])
        };
        for (i, j, l) in
            range(0).flat_map(|i| range(1).flat_map(move |j| range(2).map(move |l| (i, j, l))))
        {
            let q = [i, j, l].map(|c| radius + c as f64 * spacing);
            let d: f64 = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
            if d < room {
                taken[at([i, j, l])] = true;
            }
        }
    }
    assert_eq!(taken.iter().filter(|t| !**t).count(), 0);
}
