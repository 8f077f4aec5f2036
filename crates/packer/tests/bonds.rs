//! Bonds compared with lattices of known neighbours and with a comparison of all pairs.

use crate::helpers::lattice::cubic;
use dem_pack::Spheres;
use dem_pack::internals::{close_pairs, suggested_bond_range};
use dem_pack::{bond_lengths, bond_radii, bond_range_for, find_bonds};
use dem_testing::Random;
use proptest::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

fn open(_: u32, _: u32) -> bool {
    false
}

/// The same, by testing every pair.
fn all_pairs(spheres: &Spheres, ratio: f64) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for a in 0..spheres.radii.len() {
        for b in a + 1..spheres.radii.len() {
            let (p, q) = (spheres.positions[a], spheres.positions[b]);
            let squared: f64 = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum();
            if squared.sqrt() <= ratio * (spheres.radii[a] + spheres.radii[b]) {
                pairs.push([a as u32, b as u32]);
            }
        }
    }
    pairs
}

/// Random positions with radii over a wide range.
fn scattered(count: usize, ratio: f64, seed: u64) -> Spheres {
    let mut generator = Random(seed);
    let mut random = || generator.fraction();
    let positions: Vec<[f64; 3]> = (0..count).map(|_| [random(), random(), random()]).collect();
    let scale = 0.5 / (count as f64).cbrt();
    let radii = (0..count)
        .map(|_| scale * ratio.powf(random() - 0.5))
        .collect();
    Spheres { positions, radii }
}

#[test]
fn a_cubic_lattice_has_its_neighbours() {
    let spheres = cubic([12; 3], 0.5);
    // Distances 1, sqrt 2, sqrt 3, 2: 3, 6 and 4 bonds per sphere, less those at the faces.
    let (n, m) = (12 * 12 * 12, 12 * 12 * 11);
    let faces = 3 * m;
    let face_diagonals = 6 * 12 * 11 * 11;
    let space_diagonals = 4 * 11 * 11 * 11;
    assert_eq!(find_bonds(&spheres, 0.99, &open).unwrap().len(), 0);
    assert_eq!(find_bonds(&spheres, 1.0, &open).unwrap().len(), faces);
    assert_eq!(
        find_bonds(&spheres, 1.42, &open).unwrap().len(),
        faces + face_diagonals
    );
    assert_eq!(
        find_bonds(&spheres, 1.74, &open).unwrap().len(),
        faces + face_diagonals + space_diagonals
    );

    let radius = bond_range_for(&spheres, faces as f64 / f64::from(n), &open).unwrap();
    assert!(radius > 1.0 && radius < 2.0_f64.sqrt(), "{radius}");
    assert_eq!(find_bonds(&spheres, radius, &open).unwrap().len(), faces);
    assert_eq!(suggested_bond_range(&spheres, &open), Some(1.42));

    let bonds = find_bonds(&spheres, 1.42, &open).unwrap();
    assert!(bonds.is_sorted() && bonds.iter().all(|[a, b]| a < b));
    let lengths = bond_lengths(&spheres, &bonds);
    assert_eq!(lengths.iter().filter(|l| **l == 1.0).count(), faces);
    assert_eq!(
        lengths.iter().filter(|l| **l == 2.0_f64.sqrt()).count(),
        face_diagonals
    );
}

#[test]
fn bond_radius_is_a_share_of_the_smaller_sphere() {
    let spheres = Spheres {
        positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]],
        radii: vec![1.5, 0.5, 0.75],
    };
    let bonds = find_bonds(&spheres, 1.0, &open).unwrap();
    assert_eq!(bonds, [[0, 1], [0, 2], [1, 2]]);
    assert_eq!(
        bond_radii(&spheres, &bonds, 0.8),
        [0.8 * 0.5, 0.8 * 0.75, 0.8 * 0.5]
    );
}

#[test]
fn two_fingers_stay_two() {
    // Two columns next to each other, a wall between them at x = 1.15, spheres on both sides 0.3
    // apart.
    let mut spheres = Spheres::default();
    for i in 0..20 {
        for x in [0.0, 2.3] {
            spheres.positions.push([x, 0.0, 2.0 * f64::from(i)]);
            spheres.radii.push(1.0);
        }
    }
    let asked = AtomicUsize::new(0);
    let wall = |a: u32, b: u32| {
        asked.fetch_add(1, Ordering::Relaxed);
        let [p, q] = [a, b].map(|i| spheres.positions[i as usize]);
        (p[0] - 1.15) * (q[0] - 1.15) < 0.0
    };
    assert_eq!(find_bonds(&spheres, 1.2, &open).unwrap().len(), 2 * 19 + 20);
    let bonds = find_bonds(&spheres, 1.2, &wall).unwrap();
    assert_eq!(bonds.len(), 2 * 19);
    assert!(bonds.iter().all(|[a, b]| a % 2 == b % 2));
    assert_eq!(
        asked.load(Ordering::Relaxed),
        20,
        "touching pairs are bonded without a question"
    );
    // If every pair across is refused, the second neighbours along a finger (distance 4, ratio 2)
    // are the next.
    let radius = bond_range_for(&spheres, 38.0 / 40.0, &wall).unwrap();
    assert_eq!(find_bonds(&spheres, radius, &wall).unwrap(), bonds);
}

#[test]
fn the_wanted_number_of_bonds_is_met() {
    for (ratio, seed) in [(1.0, 1), (1.5, 2), (8.0, 3)] {
        let spheres = scattered(3000, ratio, seed);
        for wanted in [0.5, 2.0, 4.87] {
            let radius = bond_range_for(&spheres, wanted, &open).unwrap();
            let bonds = find_bonds(&spheres, radius, &open).unwrap();
            assert_eq!(
                bonds.len(),
                (wanted * 3000.0).round() as usize,
                "{ratio} {wanted}"
            );
        }
    }
}

#[test]
fn what_cannot_be_is_said() {
    let spheres = cubic([4; 3], 0.5);
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 2.01] {
        let error = find_bonds(&spheres, radius, &open).unwrap_err();
        assert!(
            error.place == "--bond-range" && error.problem.contains(&radius.to_string()),
            "{error}"
        );
    }
    for wanted in [0.0, -3.0, f64::NAN, f64::INFINITY] {
        assert!(bond_range_for(&spheres, wanted, &open).is_err());
    }
    let error = bond_range_for(&spheres, 40.0, &open).unwrap_err();
    assert!(
        error
            .problem
            .contains("40 bonds per particle cannot be reached"),
        "{error}"
    );
    assert_eq!(suggested_bond_range(&cubic([2; 3], 0.5), &open), None);
    assert!(
        find_bonds(&Spheres::default(), 1.1, &open)
            .unwrap()
            .is_empty()
    );
    assert!(
        find_bonds(&cubic([1; 3], 0.5), 1.1, &open)
            .unwrap()
            .is_empty()
    );
}

#[test]
fn the_same_bonds_for_any_number_of_threads() {
    let spheres = scattered(20_000, 2.0, 5);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let radius = bond_range_for(&spheres, 3.0, &open).unwrap();
            (
                radius.to_bits(),
                find_bonds(&spheres, radius, &open).unwrap(),
            )
        })
    };
    let one = with(1);
    assert_eq!(one.1.len(), 60_000);
    assert_eq!(one, with(3));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_tree_finds_every_pair(count in 0..300usize, ratio in 1.0..30.0f64, reach in 0.3..2.0f64, seed in any::<u64>()) {
        let spheres = scattered(count, ratio, seed);
        let pairs = all_pairs(&spheres, reach);
        prop_assert_eq!(&close_pairs(&spheres, reach).unwrap(), &pairs);
        prop_assert_eq!(&find_bonds(&spheres, reach, &open).unwrap(), &pairs);
    }
}
