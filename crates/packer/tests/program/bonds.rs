//! The bonds in the file are those requested by the options, verified pair by pair.

use super::{Bench, Made};
use crate::helpers::exact::{length, sub};
use crate::helpers::facets::{cuboid, prism};
use dem_io::Body;

/// Every pair whose centres are at most `bond_range` times the sum of the radii apart.
fn pairs_within(body: &Body, bond_range: f64) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for a in 0..body.radii.len() {
        for b in a + 1..body.radii.len() {
            if length(sub(body.positions[a], body.positions[b]))
                <= bond_range * (body.radii[a] + body.radii[b])
            {
                pairs.push([a as u32, b as u32]);
            }
        }
    }
    pairs
}

fn assert_bond_numbers(made: &Made, factor: f64) {
    let body = &made.body;
    for (k, [a, b]) in body.bonds.iter().enumerate() {
        let (a, b) = (*a as usize, *b as usize);
        let distance = length(sub(body.positions[a], body.positions[b]));
        assert!(
            (body.bond_lengths[k] / distance - 1.0).abs() < 1e-11,
            "bond {k}"
        );
        assert!(
            (body.bond_radii[k] / (factor * body.radii[a].min(body.radii[b])) - 1.0).abs() < 1e-12,
            "bond {k}"
        );
    }
}

#[test]
fn exactly_the_pairs_within_the_bond_range() {
    let bench = Bench::new();
    let file = bench.stl("box.stl", &cuboid([12.0, 9.0, 8.0]));
    for (bond_range, overlap, factor) in [
        (1.0, 0.25, 1.0),
        (1.1, 0.25, 0.8),
        (1.3, 0.0, 0.5),
        (0.9, 0.5, 1.0),
    ] {
        let made = bench.pack(
            &file,
            &[
                "-d",
                "0.9mm..1.4mm",
                "--overlap",
                &overlap.to_string(),
                "--bond-range",
                &bond_range.to_string(),
                "--bond-radius",
                &factor.to_string(),
            ],
        );
        assert_eq!(
            made.body.bonds,
            pairs_within(&made.body, bond_range),
            "bond range {bond_range}"
        );
        assert_bond_numbers(&made, factor);
        assert_eq!(made.count("/quality/bonds"), made.body.bonds.len() as u64);
        assert_eq!(made.body.about.bond_range, Some(bond_range));
    }
}

#[test]
fn the_bonds_per_particle_asked_for() {
    let bench = Bench::new();
    let file = bench.stl("box.stl", &cuboid([12.0, 9.0, 8.0]));
    for wanted in [3.0, 4.87, 6.0] {
        let made = bench.pack(
            &file,
            &[
                "-d",
                "0.9mm..1.4mm",
                "--bonds-per-particle",
                &wanted.to_string(),
            ],
        );
        let (bonds, count) = (made.body.bonds.len() as f64, made.body.radii.len() as f64);
        assert!(
            (bonds / count - wanted).abs() <= 0.5 / count,
            "{bonds} bonds of {count} particles, wanted {wanted}"
        );
        assert!((made.number("/quality/bonds_per_particle") - bonds / count).abs() < 1e-12);
        assert_eq!(
            made.body.bonds,
            pairs_within(&made.body, made.number("/bond_range"))
        );
    }
}

#[test]
fn two_fingers_stay_two() {
    // A U of two fingers with a gap of a tenth of a diameter between them, joined at the bottom.
    let (width, gap, height, bottom) = (8.0, 0.12, 16.0, 5.0);
    let right = 2.0 * width + gap;
    let u_shape = prism(
        &[
            [0.0, 0.0],
            [right, 0.0],
            [right, height],
            [width + gap, height],
            [width + gap, bottom],
            [width, bottom],
            [width, height],
            [0.0, height],
        ],
        8.0,
    );
    let bench = Bench::new();
    let made = bench.pack(
        &bench.stl("u.stl", &u_shape),
        &[
            "-d",
            "1mm..1.5mm",
            "--overlap",
            "0.25",
            "--bond-range",
            "1.3",
        ],
    );
    let body = &made.body;
    let crossing = |pairs: &[[u32; 2]]| {
        let across = |[a, b]: &&[u32; 2]| {
            let [p, q] = [a, b].map(|i| body.positions[*i as usize].map(|x| 1e3 * x));
            // Where the line of centres passes the middle of the gap.
            let t = (width + 0.5 * gap - p[0]) / (q[0] - p[0]);
            (0.0..=1.0).contains(&t) && p[1] + t * (q[1] - p[1]) > bottom
        };
        pairs.iter().filter(across).count()
    };
    let near = pairs_within(body, 1.3);
    assert!(crossing(&near) > 20, "the gap is too wide to show anything");
    assert_eq!(crossing(&body.bonds), 0);
    // Only lines that cut the two corners at the bottom of the gap are left out.
    assert!(
        near.len() - body.bonds.len() < crossing(&near) + 40,
        "{} of {}",
        body.bonds.len(),
        near.len()
    );
    assert_eq!(made.count("/quality/pieces/count"), 1);
}
