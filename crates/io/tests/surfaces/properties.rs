//! Conditions that hold for any facets and any bytes.

use super::body::{self, assert_solid};
use super::gaps::block_with_t_junction;
use super::solids::{self, Facet, ascii, binary, block, moved, turned};
use super::{METRES, assert_same_solid, damaged, read, shape_bytes};
use dem_io::surface::read_surface;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_order_of_facets_and_corners_does_not_matter(
        order in Just((0..12).collect::<Vec<usize>>()).prop_shuffle(),
        starts in prop::collection::vec(0..3_usize, 12),
        turns in prop::collection::vec(any::<bool>(), 12),
    ) {
        let good = block([0.0; 3], [20.0, 12.0, 10.0]);
        let facets: Vec<Facet> = order.iter().map(|i| {
            let mut facet = good[*i];
            facet.rotate_left(starts[*i]);
            if turns[*i] {
                facet.swap(1, 2);
            }
            facet
        }).collect();
        assert_same_solid(&read(&binary(&facets), METRES), &read(&binary(&good), METRES));
    }

    #[test]
    fn boxes_on_a_grid_that_touch_and_overlap_form_their_union(
        corners in prop::collection::vec((prop::array::uniform3(0..3_u8), prop::array::uniform3(1..4_u8)), 2..6),
        turn in any::<bool>(),
    ) {
        let boxes: Vec<([u8; 3], [u8; 3])> = corners.iter().map(|(c, size)| (*c, [0, 1, 2].map(|k| c[k] + size[k]))).collect();
        let nested = |a: usize, b: usize| (0..3).all(|k| boxes[a].0[k] > boxes[b].0[k] && boxes[a].1[k] < boxes[b].1[k]);
        prop_assume!((0..boxes.len()).all(|a| (0..boxes.len()).all(|b| !nested(a, b) && (a == b || boxes[a] != boxes[b]))));
        let mut facets = Vec::new();
        for (min, max) in &boxes {
            let solid = block(min.map(f64::from), max.map(f64::from));
            facets.extend(if turn { turned(&solid) } else { solid });
        }
        let mut union = 0;
        for cell in 0..512_u32 {
            let cell = [cell % 8, cell / 8 % 8, cell / 64].map(|x| x as u8);
            union += u32::from(boxes.iter().any(|(min, max)| (0..3).all(|k| min[k] <= cell[k] && cell[k] < max[k])));
        }
        // Faces that cannot be distinguished may be refused, but a solid must be the union.
        match read_surface(&binary(&facets), "boxes.stl", METRES) {
            Ok(surface) => {
                assert_solid(&surface);
                let error = (surface.volume_m3() - f64::from(union)).abs();
                prop_assert!(error < 1e-3 * f64::from(union), "{} not {union}: {:?} {:?}", surface.volume_m3(), surface.shells, surface.warnings);
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn a_solid_turned_in_space_keeps_its_volume(angles in prop::array::uniform3(0.0..6.3_f64), shift in prop::array::uniform3(-1e3..1e3_f64)) {
        let facets = solids::rotated(&block([0.0; 3], [20.0, 12.0, 10.0]), angles);
        let surface = read(ascii(&[&moved(&facets, shift)]).as_bytes(), METRES);
        prop_assert!((surface.volume_m3() / 2400.0 - 1.0).abs() < 1e-10);
        prop_assert_eq!(surface.shells.len(), 1);
    }

    #[test]
    fn any_bytes_give_a_message(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        body::read_stl(&bytes);
    }

    #[test]
    fn facets_between_few_points_give_a_solid_or_a_message(corners in prop::collection::vec(prop::array::uniform3(0..4_u8), 3..60)) {
        let facets: Vec<Facet> = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]].map(|p| p.map(f64::from))).collect();
        body::read_stl(&binary(&facets));
    }

    #[test]
    fn damaged_files_give_a_solid_or_a_message(
        which in 0..4_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
        keep in prop::option::of(any::<prop::sample::Index>()),
        repeat in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let bytes = match which {
            0 => shape_bytes("02_binary_box_mm"),
            1 => shape_bytes("01_ascii_box_mm"),
            2 => binary(&block_with_t_junction()),
            _ => binary(&[block([0.0; 3], [2.0; 3]), block([1.0; 3], [3.0; 3])].concat()),
        };
        body::read_stl(&damaged(bytes, damage, keep, repeat));
    }
}
