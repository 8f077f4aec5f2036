//! Distances of the depth map compared with all triangles one by one and with winding numbers.

use crate::helpers::exact::winding_number;
use crate::helpers::facets::cuboid;
use crate::helpers::solids::{
    distance_to_surface, icosphere, local_facets, point_between, random_numbers, surface_of, torus,
};
use dem_pack::internals::DepthMap;

#[test]
fn depths_are_exact_inside_and_never_too_far_outside() {
    let mut random = random_numbers(3);
    let touching = [
        cuboid([10.0, 8.0, 6.0]),
        cuboid([4.0, 4.0, 4.0])
            .into_iter()
            .map(|facet| facet.map(|[x, y, z]| [x + 10.0, y + 1.0, z + 1.0]))
            .collect(),
    ]
    .concat();
    for (facets, edge) in [
        (torus(20.0, 5.0, 60, 24), 1.0),
        (icosphere(4, &|d| 5.0 + 2.0 * (4.0 * d[0]).sin()), 0.3),
        (cuboid([10.0, 8.0, 6.0]), 0.5),
        (touching, 0.5),
    ] {
        let (surface, boundary) = surface_of(&facets);
        let facets = local_facets(&surface);
        let extent = surface.extent();
        let unit = 1e-3 / surface.unit_m;
        let cut_off = 2.5 * unit;
        let map = DepthMap::new(&surface, &boundary, cut_off, edge * unit);
        let (mut inside, mut bounded) = (0, 0);
        for _ in 0..3000 {
            let p = point_between(&mut random, [0.0; 3], extent);
            let distance = distance_to_surface(&facets, &p);
            let depth = map.depth(p);
            let rounding = 1e-9 * unit;
            let truth = if winding_number(&facets, &p) > 0 {
                inside += 1;
                let wanted = if distance > cut_off {
                    f64::INFINITY
                } else {
                    distance
                };
                assert!(
                    depth == wanted || (depth - wanted).abs() < rounding,
                    "{p:?}: {depth} {wanted}"
                );
                distance
            } else {
                assert!(
                    depth <= 0.0 && -depth <= distance + rounding,
                    "{p:?}: {depth}, {distance} outside"
                );
                -distance
            };
            let [least, most] = map.bounds(p);
            assert!(
                least <= truth + rounding && most >= truth - rounding,
                "{p:?}: {truth} is not in {least}..{most}"
            );
            bounded += usize::from(least.is_finite() && most.is_finite());
        }
        assert!(inside > 300, "{inside}");
        assert!(bounded > 300 || facets.len() < 100, "{bounded}");
    }
}
