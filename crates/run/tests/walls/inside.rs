//! The inside of closed surfaces.

use dem_physics::geometry::{Mesh, Shape, SolidBox};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

use super::{Surface, assert_same, mesh};
use crate::closed_box::closed_box;

fn turned_over((vertices, triangles): &Surface) -> Surface {
    let triangles = triangles.iter().map(|[a, b, c]| [*b, *a, *c]).collect();
    (vertices.clone(), triangles)
}

fn both(one: &Surface, other: &Surface) -> Surface {
    let first = one.0.len() as u32;
    let moved = other.1.iter().map(|t| t.map(|v| v + first));
    (
        one.0.iter().chain(&other.0).copied().collect(),
        one.1.iter().copied().chain(moved).collect(),
    )
}

proptest! {
    /// In any orientation, also above and below its edges and corners.
    #[test]
    fn a_box_holds_what_is_in_it(
        angles in prop_oneof![
            1 => Just([0.0; 3]),
            2 => prop::array::uniform3(-3.0..3.0_f64),
        ],
        point in prop::array::uniform3(prop_oneof![
            4 => -1.0..1.5_f64,
            1 => Just(0.25), 1 => Just(0.125), 1 => Just(-0.25), 1 => Just(0.0), 1 => Just(0.5),
        ]),
    ) {
        let (low, high) = ([0.0; 3], [0.5, 0.625, 0.75]);
        let by = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let turn = |v: &[f64; 3]| -> [f64; 3] { (by * Vector3::from(*v)).into() };
        let (vertices, triangles) = closed_box(low, high);
        let surface = (vertices.iter().map(turn).collect(), triangles);
        let of_box = mesh(&surface);
        prop_assert_eq!(of_box.content.unpaired_edges, 0);
        let inverted = mesh(&turned_over(&surface));
        prop_assert_eq!(inverted.content.unpaired_edges, 0);
        let solid = Shape::Box(SolidBox::new(low, high).unwrap());
        let mut found = Vec::new();
        solid.touches(point, 10.0, &mut found);
        let distance_m = found[0].distance_m;
        prop_assume!(distance_m.abs() > 1e-6);
        let at = turn(&point);
        prop_assert_eq!(of_box.holds(at), distance_m < 0.0, "{} m at {:?}", distance_m, point);
        prop_assert!(!inverted.holds(at));
        if distance_m < 0.0 {
            let touch = of_box.touch_from_inside(at);
            prop_assert!((touch.distance_m - distance_m).abs() < 1e-12);
            let along = Vector3::from(touch.normal) * touch.distance_m;
            prop_assert!((Vector3::from(at) + along - Vector3::from(touch.point)).norm() < 1e-12);
        }
    }
}

#[test]
fn a_hollow_is_no_inside_and_parts_that_overlap_are_one() {
    let outer = closed_box([0.0; 3], [4.0; 3]);
    let inner = closed_box([1.0; 3], [3.0; 3]);
    let hollow = mesh(&both(&outer, &turned_over(&inner)));
    assert!(hollow.holds([0.5, 2.0, 2.0]) && hollow.holds([3.5, 3.5, 3.5]));
    assert!(!hollow.holds([2.0; 3]) && !hollow.holds([5.0, 2.0, 2.0]));
    let union = mesh(&both(&outer, &closed_box([2.0; 3], [6.0; 3])));
    for place in [1.0, 3.0, 5.0] {
        assert!(union.holds([place; 3]));
    }
    assert!(!union.holds([5.0, 5.0, 1.0]));
    // Two that share an edge.
    let beside = closed_box([4.0, 4.0, 0.0], [5.0, 5.0, 4.0]);
    let beside = mesh(&both(&outer, &beside));
    assert!(beside.holds([4.5, 4.5, 1.0]) && !beside.holds([4.5, 3.5, 1.0]));
}

#[test]
fn what_is_open_or_not_wound_one_way_has_no_inside() {
    let whole = closed_box([0.0; 3], [1.0; 3]);
    let mut open = whole.clone();
    open.1.pop();
    let mut mixed = whole.clone();
    mixed.1[5].swap(0, 1);
    for (surface, unpaired) in [(&whole, 0), (&open, 3), (&mixed, 3)] {
        let surface = mesh(surface);
        assert_eq!(surface.content.unpaired_edges, unpaired);
        assert_eq!(surface.holds([0.5; 3]), unpaired == 0);
    }
}

/// From inside, a mesh of a box gives the same as the box, where one side is the nearest.
#[test]
fn the_nearest_way_out_is_that_of_the_solid() {
    let (low, high) = ([0.0; 3], [0.5, 0.625, 0.75]);
    let of_box: Mesh = mesh(&closed_box(low, high));
    let solid = SolidBox::new(low, high).unwrap();
    for point in [[0.1, 0.3, 0.4], [0.4, 0.2, 0.3], [0.25, 0.3, 0.74]] {
        let wanted = solid.touch(point);
        assert_same(&of_box.touch_from_inside(point), &wanted, 1e-12, "inside");
    }
}
