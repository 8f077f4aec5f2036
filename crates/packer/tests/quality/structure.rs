//! Structure: fabric, pieces, contacts and the thinnest part.

use std::f64::consts::PI;

use super::Case;
use crate::helpers::lattice::cubic;
use dem_pack::Spheres;
use dem_pack::internals::{BondedPacking, DEFAULT_GAP_LIMIT, assess};
use dem_pack::{Basis, Sizes};
use dem_testing::Random;

/// A direction, all equally likely.
fn direction(random: &mut Random) -> [f64; 3] {
    let (z, phi) = (2.0 * random.fraction() - 1.0, 2.0 * PI * random.fraction());
    let rho = (1.0 - z * z).sqrt();
    [rho * phi.cos(), rho * phi.sin(), z]
}

#[test]
fn a_line_has_one_direction() {
    let mut case = Case::new(cubic([30, 1, 1], 0.5), [30.0, 1.0, 1.0]);
    case.sizes = "1m".to_owned();
    let report = case.report();
    let fabric = report.fabric.unwrap();
    assert_eq!(fabric.bonds, 29);
    for (got, wanted) in fabric.eigenvalues.into_iter().zip([1.0, 0.0, 0.0]) {
        assert!((got - wanted).abs() < 1e-14);
    }
    assert!((fabric.direction[0].abs() - 1.0).abs() < 1e-14);
    assert!(!fabric.isotropic_within_2_sigma && fabric.chance < 1e-9);
    assert_eq!(report.pieces.with_one_bond, 2);
    assert!((report.bonds_per_particle - 29.0 / 30.0).abs() < 1e-15);
    assert!(
        report
            .warnings
            .iter()
            .any(|w| w.contains("0.967 bonds per particle")),
        "{:?}",
        report.warnings
    );
    let thinnest = report.thinnest.unwrap();
    assert!(
        (thinnest.particles_across - 1.0).abs() < 1e-9,
        "{thinnest:?}"
    );
    let coarse = report.coarse.unwrap();
    assert!(coarse.contains("only about 1 particles across"), "{coarse}");
}

#[test]
fn chance_of_a_fabric_is_a_chance() {
    // Pairs in random directions: 5 % of the samples have a chance below 5 %.
    let mut random = Random(11);
    let (mut rare, mut within) = (0, 0);
    let samples = 400;
    for _ in 0..samples {
        let mut spheres = Spheres::default();
        for i in 0..300 {
            let n = direction(&mut random);
            let centre = [
                3.0 + 4.0 * f64::from(i % 7),
                3.0 + 4.0 * f64::from(i / 7 % 7),
                3.0 + 4.0 * f64::from(i / 49),
            ];
            for side in [-0.5, 0.5] {
                spheres
                    .positions
                    .push([0, 1, 2].map(|k| centre[k] + side * n[k]));
                spheres.radii.push(0.5);
            }
        }
        let bonds: Vec<[u32; 2]> = (0..300).map(|i| [2 * i, 2 * i + 1]).collect();
        let no_wall = |_: [f64; 3]| -1.0;
        let open = |_: u32, _: u32| false;
        let report = assess(&BondedPacking {
            spheres: &spheres,
            overlap: 0.0,
            bonds: &bonds,
            bond_range: 0.0,
            sizes: &Sizes::parse("1m", Basis::Number).unwrap(),
            unit_m: 1.0,
            shape_volume: 1e9,
            extent: [1.0; 3],
            particle_density_kg_m3: None,
            wall_distance: &vec![1.0; 600],
            distance_inside: &no_wall,
            distance_bounds: &|_| [f64::NEG_INFINITY, f64::INFINITY],
            crosses_surface: &open,
            gap_limit: DEFAULT_GAP_LIMIT,
            parts: 1,
        })
        .unwrap();
        let fabric = report.fabric.unwrap();
        rare += u32::from(fabric.chance < 0.05);
        within += u32::from(fabric.isotropic_within_2_sigma);
    }
    // Binomial of 400 at 0.05: 20 with a standard deviation of 4.4.
    assert!((7..=34).contains(&rare), "{rare}");
    // The largest deviation of three eigenvalues exceeds two sigma in almost half of all isotropic
    // samples.
    assert!((180..=250).contains(&within), "{within}");
}

#[test]
fn pieces_and_rattlers() {
    let mut spheres = cubic([10, 10, 10], 0.5);
    for x in [12.0, 13.0, 14.0] {
        spheres.positions.push([x, 5.0, 5.0]);
        spheres.radii.push(0.5);
    }
    spheres.positions.push([12.0, 2.0, 2.0]);
    spheres.radii.push(0.5);
    let report = Case::new(spheres, [16.0, 10.0, 10.0]).report();
    assert_eq!(report.pieces.count, 3);
    assert_eq!(report.pieces.outside_largest, 4);
    assert!((report.pieces.largest_fraction - 1000.0 / 1004.0).abs() < 1e-15);
    assert_eq!(
        (report.pieces.without_bond, report.pieces.with_one_bond),
        (1, 2)
    );
    // The three in a row and the one alone; a corner at x = 10 has three neighbours and two sides.
    assert!(
        (report.contacts.rattlers - 4.0 / 1004.0).abs() < 1e-15,
        "{}",
        report.contacts.rattlers * 1004.0
    );
    assert!(
        report
            .warnings
            .iter()
            .any(|w| w.contains("in 3 pieces: 4 of 1004 particles")),
        "{:?}",
        report.warnings
    );
}

#[test]
fn an_overlap_is_measured() {
    let mut spheres = cubic([6, 6, 6], 0.5);
    spheres.positions[0][0] += 0.01;
    let report = Case::new(spheres, [6.0; 3]).report();
    assert!((report.contacts.largest_overlap - 0.02).abs() < 1e-12);
    assert!(
        report
            .warnings
            .iter()
            .any(|w| w.contains("overlap in r_gen by up to 0.02")),
        "{:?}",
        report.warnings
    );
}

#[test]
fn thin_parts_are_found() {
    // A plate five across.
    let plate = Case::new(cubic([40, 40, 5], 0.5), [40.0, 40.0, 5.0]).report();
    let across = plate.thinnest.unwrap();
    assert!((across.particles_across - 5.0).abs() < 0.1, "{across:?}");
    // A block twelve across.
    let block = Case::new(cubic([12; 3], 0.5), [12.0; 3])
        .report()
        .thinnest
        .unwrap();
    assert!(
        block.particles_across > 10.9 && block.particles_across <= 12.0 && !block.at_least,
        "{block:?}"
    );
    // A block thicker than the measured range.
    let block = Case::new(cubic([24; 3], 0.5), [24.0; 3])
        .report()
        .thinnest
        .unwrap();
    assert!(
        block.at_least && block.particles_across == 20.0,
        "{block:?}"
    );
    // Two blocks of 9 joined by a bar three across: 12 long between them.
    let solid = |p: [f64; 3]| {
        let in_box = |low: [f64; 3], high: [f64; 3]| {
            (0..3)
                .map(|k| (p[k] - low[k]).min(high[k] - p[k]))
                .fold(f64::INFINITY, f64::min)
        };
        let ends = in_box([0.0; 3], [9.0; 3]).max(in_box([21.0, 0.0, 0.0], [30.0, 9.0, 9.0]));
        ends.max(in_box([6.0, 3.0, 3.0], [24.0, 6.0, 6.0]))
    };
    let mut spheres = cubic([30, 9, 9], 0.5);
    let inside: Vec<bool> = spheres.positions.iter().map(|p| solid(*p) > 0.0).collect();
    let mut keep = inside.iter();
    spheres.positions.retain(|_| *keep.next().unwrap());
    spheres.radii.truncate(spheres.positions.len());
    let report = Case::new(spheres, [30.0, 9.0, 9.0]).report_in(&solid);
    assert_eq!(report.pieces.count, 1);
    let neck = report.thinnest.unwrap();
    assert!((neck.particles_across - 3.0).abs() < 0.1, "{neck:?}");
}

#[test]
fn thickness_is_true_where_no_particle_lies_in_the_middle() {
    let lattice = |extent: [f64; 3], distance: &(dyn Fn([f64; 3]) -> f64 + Sync)| {
        let mut spheres = cubic(extent.map(|e| e as usize), 0.4);
        let mut random = Random(5);
        for p in &mut spheres.positions {
            *p = p.map(|x| x + 0.2 * (random.fraction() - 0.5));
        }
        spheres.positions.retain(|p| distance(*p) >= 0.4);
        spheres.radii.truncate(spheres.positions.len());
        let mut case = Case::new(spheres, extent);
        case.bond_range = 1.6;
        case.report_in(distance).thinnest.unwrap()
    };
    // Mean diameters are 0.8; a diagonal of the lattice is 0.43 of that.
    let most_off = 3.0_f64.sqrt() / 4.0;
    let around = |p: [f64; 3]| [p[0] - 10.0, p[1] - 10.0, p[2] - 3.0];
    let torus = |p: [f64; 3]| {
        let [x, y, z] = around(p);
        3.0 - (x.hypot(y) - 7.0).hypot(z)
    };
    let ball = |p: [f64; 3]| 3.5 - p.map(|x| (x - 3.6).powi(2)).iter().sum::<f64>().sqrt();
    let bar = |p: [f64; 3]| {
        (p[0].min(30.0 - p[0]))
            .min(p[1].min(6.0 - p[1]))
            .min(p[2].min(6.0 - p[2]))
    };
    for (name, thickness, found) in [
        ("torus", 6.0, lattice([20.0, 20.0, 6.0], &torus)),
        ("ball", 7.0, lattice([7.0; 3], &ball)),
        ("bar", 6.0, lattice([30.0, 6.0, 6.0], &bar)),
    ] {
        let across = thickness / 0.8;
        assert!(
            found.particles_across <= across * (1.0 + 1e-9)
                && found.particles_across >= across - most_off - 0.06,
            "{name}: {found:?}, not {across}"
        );
    }
}
