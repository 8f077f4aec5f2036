//! The complete report: the same for any number of threads, its text and JSON, and the smallest
//! packings.

use super::{Case, close};
use crate::helpers::lattice::cubic;
use dem_pack::Report;
use dem_pack::Spheres;
use dem_pack::internals::depth_needed;
use dem_testing::Random;
use std::f64::consts::PI;

#[test]
fn unknown_wall_distances_are_measured() {
    let case = Case::new(cubic([14; 3], 0.5), [14.0; 3]);
    let exact = case.report();
    let distance = |p: [f64; 3]| {
        (0..3)
            .map(|k| p[k].min(14.0 - p[k]))
            .fold(f64::INFINITY, f64::min)
    };
    let near: Vec<f64> = case
        .spheres
        .positions
        .iter()
        .map(|p| distance(*p))
        .map(|d| if d < 0.8 { d } else { f64::INFINITY })
        .collect();
    assert_eq!(case.report_with(&near, &distance), exact);
}

#[test]
fn distances_beyond_need_may_be_infinite() {
    let case = Case::new(cubic([26, 24, 25], 0.5), [26.0, 24.0, 25.0]);
    let extent = case.extent;
    let distance = |p: [f64; 3]| {
        (0..3)
            .map(|k| p[k].min(extent[k] - p[k]))
            .fold(f64::INFINITY, f64::min)
    };
    let needed = depth_needed(&case.spheres);
    assert_eq!(needed, 10.0);
    let cut = |p: [f64; 3]| {
        if distance(p) > needed {
            f64::INFINITY
        } else {
            distance(p)
        }
    };
    assert_eq!(case.report_in(&cut), case.report_in(&distance));
}

#[test]
fn the_same_report_for_any_number_of_threads() {
    let mut random = Random(8);
    let mut spheres = cubic([24, 20, 22], 0.5);
    for (i, (p, r)) in spheres
        .positions
        .iter_mut()
        .zip(&mut spheres.radii)
        .enumerate()
    {
        *r = 0.35 + 0.1 * (i as f64 * 0.618_033_988_749_894_9).fract();
        p.iter_mut()
            .for_each(|x| *x += 0.08 * (random.fraction() - 0.5));
    }
    let mut case = Case::new(spheres, [24.0, 20.0, 22.0]);
    case.sizes = "0.7m..0.9m".to_owned();
    case.bond_range = 1.3;
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| case.report())
    };
    let one = with(1);
    let three = with(3);
    assert_eq!(one, three);
    assert_eq!(one.text(), three.text());
    assert!(
        one.sizes_by_number.passes() && one.sizes_by_mass.passes(),
        "{}",
        one.text()
    );
    let json = serde_json::to_string(&one).unwrap();
    let read: Report = serde_json::from_str(&json).unwrap();
    assert_eq!(read.text(), one.text());
}

#[test]
fn the_text_says_it_in_aligned_lines() {
    let mut case = Case::new(cubic([16; 3], 0.5), [16.0; 3]);
    case.particle_density = Some(2050.0);
    case.sizes = "1.5m".to_owned();
    let report = case.report();
    let text = report.text();
    for wanted in [
        "particles        4096, mean diameter 1 m, overlap 0",
        "solid density    1073 kg/m3",
        "in r_gen, deeper than 2 m",
    ] {
        assert!(text.contains(wanted), "{text}");
    }
    let warnings = report.warnings.join("; ");
    for wanted in [
        "2.81 bonds per particle",
        "--bond-range 1.42 gives 5",
        "sizes are off by 1 by number",
    ] {
        assert!(warnings.contains(wanted), "{warnings}");
    }
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
}

#[test]
fn one_sphere_and_none() {
    let one = Case::new(
        Spheres {
            positions: vec![[0.5; 3]],
            radii: vec![0.5],
        },
        [1.0; 3],
    )
    .report();
    close(one.union_density, PI / 6.0);
    assert_eq!((one.particles, one.bonds, one.pieces.count), (1, 0, 1));
    assert!(one.fabric.is_none());
    assert!(!one.text().contains("NaN"));
    let none = Case::new(Spheres::default(), [1.0; 3]).report();
    assert_eq!((none.particles, none.pieces.count), (0, 0));
    assert!(none.thinnest.is_none());
    assert!(!none.text().contains("NaN"), "{}", none.text());
}
