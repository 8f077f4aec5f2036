//! The triangles of the wall, eight at a time in their order, to find those near a place.

use super::eight_triangles::{AT_ONCE, EightSurroundings, bits};
use super::plane::Surroundings;
use super::tree::{BoxTree, Corners};
use crate::spheres::Vector3;
use dem_io::Bounds;
use pulp::{Arch, NullaryFnOnce};

/// Distance of a triangle from the first of its eight, in sums of their radii, up to which it is
/// close to it.
const CLOSE: f64 = 4.0;

/// The triangles of the wall by eights that follow each other and are close together.
pub(super) struct WallEights {
    eights: Vec<EightBoxes>,
    tree: BoxTree,
}

/// Up to eight triangles with their boxes.
struct EightBoxes {
    /// The number of the first; the others follow it.
    first: u32,
    around: EightSurroundings,
    /// The least and the most of x, of y and of z. NaN, near to nothing, where there is no
    /// triangle.
    least: [[f64; AT_ONCE]; 3],
    most: [[f64; AT_ONCE]; 3],
}

impl WallEights {
    /// Of triangles given by their corners, with the surroundings of each.
    pub(super) fn new(
        triangles: impl Iterator<Item = Corners>,
        surroundings: &[Surroundings],
    ) -> Self {
        let boxes: Vec<Bounds> = triangles.map(Bounds::of).collect();
        let mut eights = Vec::new();
        let mut around_eights = Vec::new();
        let mut first = 0;
        while first < boxes.len() {
            let end = first + close_together(&surroundings[first..]);
            let (boxes, surroundings) = (&boxes[first..end], &surroundings[first..end]);
            eights.push(EightBoxes::new(first as u32, boxes, surroundings));
            around_eights.push(boxes.iter().fold(Bounds::EMPTY, |all, one| all.with(one)));
            first = end;
        }
        Self {
            eights,
            tree: BoxTree::new(&around_eights),
        }
    }

    /// The triangles whose boxes come within `reach` (local units) of a place and that could do so
    /// themselves, each with a lower bound of its distance.
    pub(super) fn near(&self, place: &Vector3, reach: f64) -> Vec<(f64, u32)> {
        Arch::new().dispatch(Near {
            wall: self,
            place,
            reach,
        })
    }
}

impl EightBoxes {
    fn new(first: u32, boxes: &[Bounds], surroundings: &[Surroundings]) -> Self {
        let mut eight = Self {
            first,
            around: EightSurroundings::default(),
            least: [[f64::NAN; AT_ONCE]; 3],
            most: [[f64::NAN; AT_ONCE]; 3],
        };
        for (k, (around_triangle, surroundings)) in boxes.iter().zip(surroundings).enumerate() {
            eight.around.set(k, surroundings);
            for axis in 0..3 {
                eight.least[axis][k] = around_triangle.low[axis];
                eight.most[axis][k] = around_triangle.high[axis];
            }
        }
        eight
    }
}

/// The number of triangles, eight at most, that are close to the first.
fn close_together(surroundings: &[Surroundings]) -> usize {
    let first = &surroundings[0];
    let is_close = |other: &&Surroundings| {
        let radii = f64::from(first.radius) + f64::from(other.radius);
        (other.middle() - first.middle()).norm() <= CLOSE * radii
    };
    let others = surroundings[1..].iter().take(AT_ONCE - 1);
    1 + others.take_while(is_close).count()
}

/// A search for the triangles near a place.
struct Near<'a> {
    wall: &'a WallEights,
    place: &'a Vector3,
    reach: f64,
}

impl NullaryFnOnce for Near<'_> {
    type Output = Vec<(f64, u32)>;

    #[expect(
        clippy::needless_range_loop,
        reason = "several arrays side by side, lane by lane"
    )]
    #[inline(always)]
    fn call(self) -> Vec<(f64, u32)> {
        let Self { wall, place, reach } = self;
        let query = Bounds::of([*place]).grown(reach);
        let mut found = Vec::new();
        for number in wall.tree.meeting(&query) {
            let eight = &wall.eights[number as usize];
            let mut near = [true; AT_ONCE];
            for axis in 0..3 {
                for k in 0..AT_ONCE {
                    near[k] &= (eight.least[axis][k] <= query.high[axis])
                        & (eight.most[axis][k] >= query.low[axis]);
                }
            }
            if bits(&near) == 0 {
                continue;
            }
            let mut distances = [0.0; AT_ONCE];
            // One loop: both bounds need the distance from the middle.
            for k in 0..AT_ONCE {
                let around = eight.around.of(k);
                distances[k] = around.least_distance(place);
                near[k] &= !around.is_beyond(place, reach) & (distances[k] < reach);
            }
            let mut near = bits(&near);
            while near != 0 {
                let k = near.trailing_zeros();
                near &= near - 1;
                found.push((distances[k as usize], eight.first + k));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corner() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3(-1.0..1.0)
    }

    /// A triangle of this size at a place.
    fn triangle() -> impl Strategy<Value = Corners> {
        (corner(), prop::array::uniform3(corner()), -6.0_f64..0.0).prop_map(
            |(place, corners, octaves)| {
                corners.map(|corner| [0, 1, 2].map(|k| place[k] + octaves.exp2() * corner[k]))
            },
        )
    }

    proptest! {
        #[test]
        fn the_same_triangles_as_one_by_one(
            triangles in prop::collection::vec(triangle(), 1..100),
            place in corner(), reach in prop_oneof![0.01_f64..0.6, Just(f64::INFINITY)],
            // Beside a box, nearer than single precision could tell.
            beside in prop::option::of((prop::sample::select(vec![-1e-9, 0.0, 1e-9]), 0..3_usize)),
        ) {
            let surroundings: Vec<Surroundings> =
                triangles.iter().copied().map(Surroundings::new).collect();
            let wall = WallEights::new(triangles.iter().copied(), &surroundings);
            let mut place = Vector3::from(place);
            if let Some((by, axis)) = beside && f64::is_finite(reach) {
                place = Vector3::from(triangles[0][0]);
                place[axis] = Bounds::of(triangles[0]).high[axis] + reach + by;
            }
            let bound = |(number, corners): (usize, &Corners)| {
                let query = Bounds::of([place]).grown(reach);
                let meets = Bounds::of(*corners).overlaps(&query);
                let around = &surroundings[number];
                let distance = around.least_distance(&place);
                (meets && !around.is_beyond(&place, reach) && distance < reach)
                    .then_some((distance.to_bits(), number as u32))
            };
            let wanted: Vec<_> = triangles.iter().enumerate().filter_map(bound).collect();
            let near = Near { wall: &wall, place: &place, reach };
            // Compiled for this processor, and for all of its kind.
            for mut found in [wall.near(&place, reach), near.call()] {
                found.sort_unstable_by_key(|(_, number)| *number);
                let found = found.iter().map(|(least, number)| (least.to_bits(), *number));
                prop_assert_eq!(found.collect::<Vec<_>>(), wanted.clone());
            }
        }
    }
}
