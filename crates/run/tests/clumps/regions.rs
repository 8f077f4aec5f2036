//! Regions compared with their definitions.

use dem_physics::geometry::Bounds;
use dem_physics::geometry::region::Region;
use nalgebra::Vector3;

use super::{HEAD, planned};
use dem_testing::Random;

/// The regions of a scene, by name.
fn regions(text: &str) -> Vec<Region> {
    let ball = "[bodies.ball]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0, 1e-3]]\n";
    planned(&format!("{HEAD}{ball}{text}"))
        .state
        .model
        .rules
        .regions
}

/// Checks which points are inside, and that sampled points are inside and spread over the entire
/// region: their mean is the centre.
fn compare(region: &Region, is_inside: impl Fn(&Vector3<f64>) -> Option<bool>, half: f64) {
    let mut random = Random(5);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..20_000 {
        let point = Vector3::from(random.point(half));
        let Some(wanted) = is_inside(&point) else {
            continue;
        };
        assert_eq!(region.contains(point.into()), wanted, "{point}");
        if wanted {
            inside += 1;
        } else {
            outside += 1;
        }
    }
    assert!(inside > 100 && outside > 100, "{inside} {outside}");
    let Bounds { low, high } = region.bounds();
    let (mut sum, mut squares, mut count) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for _ in 0..20_000 {
        let fraction = [0; 3].map(|_| random.within(0.0, 1.0));
        if let Some(point) = region.point(fraction) {
            assert!(region.contains(point));
            assert!((0..3).all(|k| (low[k]..=high[k]).contains(&point[k])));
            assert_ne!(is_inside(&point.into()), Some(false));
            let point = Vector3::from(point);
            sum += point;
            squares += point.component_mul(&point);
            count += 1.0;
        }
    }
    assert!(count > 100.0);
    // The same mean as that of points that fill a larger box, within four times the effect of
    // chance.
    let (mut mean, mut n) = (Vector3::zeros(), 0.0);
    for _ in 0..20_000 {
        let point = Vector3::from(random.point(half));
        if is_inside(&point) == Some(true) {
            mean += point;
            n += 1.0;
        }
    }
    for k in 0..3 {
        let variance = squares[k] / count - (sum[k] / count).powi(2);
        let sigma = (variance * (1.0 / count + 1.0 / n)).sqrt();
        let apart = sum[k] / count - mean[k] / n;
        assert!(apart.abs() < 4.0 * sigma, "{k}: {apart} {sigma}");
    }
}

#[test]
fn shapes_contain_what_they_should() {
    let all = regions(
        "[regions.a]\nbox = { min = [-0.5, -0.2, 0.1], max = [0.3, 0.6, 0.9] }\n\
         [regions.b]\nsphere = { centre = [0.1, 0.2, -0.1], radius = 0.6 }\n\
         [regions.c]\ncylinder = { from = [-0.3, -0.2, -0.4], to = [0.4, 0.3, 0.2], radius = 0.35 }\n",
    );
    let on = |x: f64| x.abs() < 1e-12;
    compare(
        &all[0],
        |p| Some((0..3).all(|k| [-0.5, -0.2, 0.1][k] <= p[k] && p[k] <= [0.3, 0.6, 0.9][k])),
        1.0,
    );
    let ball = |p: &Vector3<f64>| {
        let depth = 0.36 - (p - Vector3::new(0.1, 0.2, -0.1)).norm_squared();
        (!on(depth)).then_some(depth > 0.0)
    };
    compare(&all[1], ball, 1.0);
    // The distance from the axis as twice the area of a triangle, and the ends as half-spaces.
    let (from, to) = (Vector3::new(-0.3, -0.2, -0.4), Vector3::new(0.4, 0.3, 0.2));
    let cylinder = |p: &Vector3<f64>| {
        let axis = to - from;
        let beside = 0.35 - (p - from).cross(&axis).norm() / axis.norm();
        let (above, below) = ((p - from).dot(&axis), (to - p).dot(&axis));
        (![beside, above, below].into_iter().any(on))
            .then_some(beside > 0.0 && above > 0.0 && below > 0.0)
    };
    compare(&all[2], cylinder, 1.0);
    // Ends and faces are included.
    assert!(all[0].contains([0.3, 0.6, 0.9]) && all[0].contains([-0.5, -0.2, 0.1]));
    assert!(all[2].contains(from.into()));
}

/// A box as an STL file: outward facets, or inward ones, or without its last face.
pub(crate) fn box_stl(low: [f64; 3], high: [f64; 3], inward: bool, open: bool) -> String {
    let mut text = "solid box\n".to_owned();
    let faces = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
    for (axis, side) in faces.take(if open { 5 } else { 6 }) {
        let corner = |u: usize, v: usize| {
            let mut p = [0.0; 3];
            for (k, s) in [(axis, side), ((axis + 1) % 3, u), ((axis + 2) % 3, v)] {
                p[k] = if s == 0 { low[k] } else { high[k] };
            }
            p
        };
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        for mut triangle in [[a, b, c], [a, c, d]] {
            if (side == 0) != inward {
                triangle.reverse();
            }
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle {
                text += &format!("vertex {x:e} {y:e} {z:e}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid box\n"
}

#[test]
fn the_inside_of_a_closed_surface_is_a_region_whichever_way_its_facets_look() {
    let folder = tempfile::tempdir().unwrap();
    let (low, high) = ([-500.0, -200.0, 100.0], [300.0, 600.0, 900.0]);
    for inward in [false, true] {
        let path = folder.path().join("box.stl");
        std::fs::write(&path, box_stl(low, high, inward, false)).unwrap();
        let all = regions(&format!(
            "[regions.a]\nbox = {{ min = [-0.5, -0.2, 0.1], max = [0.3, 0.6, 0.9] }}\n\
             [regions.s]\nstl = '{}'\nunit = \"mm\"\n",
            path.display()
        ));
        for k in 0..3 {
            assert!((all[1].bounds().low[k] - 1e-3 * low[k]).abs() < 1e-15);
            assert!((all[1].bounds().high[k] - 1e-3 * high[k]).abs() < 1e-15);
        }
        // The same points except those within rounding of a face.
        let near = |p: &Vector3<f64>| {
            (0..3).any(|k| {
                [low[k], high[k]]
                    .iter()
                    .any(|face| (p[k] - 1e-3 * face).abs() < 1e-9)
            })
        };
        compare(
            &all[1],
            |p| (!near(p)).then(|| all[0].contains((*p).into())),
            1.0,
        );
        // In line with corners and edges, which is difficult for rays.
        for (point, wanted) in [
            ([-0.1, 0.2, 0.5], true),
            ([-0.1, 0.2, 0.95], false),
            ([0.3, 0.6, 1.0], false),
            ([0.29, 0.59, 0.89], true),
            ([-0.5, -0.2, 0.0], false),
        ] {
            assert_eq!(all[1].contains(point), wanted, "{point:?}");
        }
    }
}
