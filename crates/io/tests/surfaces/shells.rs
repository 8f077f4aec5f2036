//! Several shells: parts, cavities, and their orientation.

use super::solids::{Facet, ascii, binary, block, mirrored, moved, turned};
use super::{METRES, assert_same_solid, assert_volume, read};

#[test]
fn two_solids_in_one_ascii_file_are_both_read() {
    let text = ascii(&[
        &block([0.0; 3], [1.0, 2.0, 3.0]),
        &block([5.0, 0.0, 0.0], [6.0, 1.0, 1.0]),
    ]);
    let surface = read(text.as_bytes(), METRES);
    assert_eq!(
        surface
            .shells
            .iter()
            .map(|shell| shell.volume_m3)
            .collect::<Vec<_>>(),
        [6.0, 1.0]
    );
}

#[test]
fn one_facet_wound_the_wrong_way_is_turned() {
    let good = block([0.0; 3], [20.0, 12.0, 10.0]);
    for i in 0..12 {
        let mut facets = good.clone();
        facets[i].swap(0, 1);
        let surface = read(&binary(&facets), METRES);
        assert_eq!(surface.repairs.flipped_facets, 1);
        assert_same_solid(&surface, &read(&binary(&good), METRES));
    }
}

#[test]
fn shells_within_shells_alternate_whichever_way_they_are_wound() {
    let cubes: Vec<Vec<Facet>> = (0..4)
        .map(|i| block([f64::from(i); 3], [10.0 - f64::from(i); 3]))
        .collect();
    let volume = 1000.0 - 512.0 + 216.0 - 64.0;
    for winding in 0..16 {
        let facets: Vec<Facet> = cubes
            .iter()
            .enumerate()
            .flat_map(|(i, cube)| {
                if winding >> i & 1 == 1 {
                    turned(cube)
                } else {
                    cube.clone()
                }
            })
            .collect();
        let surface = read(&binary(&facets), METRES);
        assert_volume(&surface, volume);
        let found: Vec<(bool, usize)> = surface
            .shells
            .iter()
            .map(|shell| (shell.is_cavity, shell.outer_shell))
            .collect();
        assert_eq!(found, [(false, 0), (true, 0), (false, 2), (true, 2)]);
        let wrong = (0..4)
            .filter(|i| (winding >> i & 1 == 1) != (i % 2 == 1))
            .count();
        assert_eq!(surface.repairs.flipped_facets, 12 * wrong);
        let warnings = surface
            .warnings
            .iter()
            .filter(|text| text.contains("wound"))
            .count();
        assert_eq!(warnings, usize::from(wrong > 0));
    }
}

#[test]
fn a_cavity_belongs_to_the_part_around_it() {
    let mut facets = block([0.0; 3], [4.0; 3]);
    facets.extend(block([10.0, 0.0, 0.0], [14.0, 4.0, 4.0]));
    facets.extend(block([11.0, 1.0, 1.0], [12.0, 2.0, 2.0]));
    facets.extend(block([12.5, 1.0, 1.0], [13.5, 2.0, 2.0]));
    let surface = read(&binary(&facets), METRES);
    assert_volume(&surface, 126.0);
    assert_eq!(
        surface
            .shells
            .iter()
            .map(|shell| shell.outer_shell)
            .collect::<Vec<_>>(),
        [0, 1, 1, 1]
    );
}

#[test]
fn parts_that_touch_in_an_edge_or_a_vertex_stay_apart() {
    let first = block([0.0; 3], [1.0; 3]);
    for corner in [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0]] {
        for second in [moved(&first, corner), turned(&moved(&first, corner))] {
            let surface = read(&binary(&[first.clone(), second].concat()), METRES);
            assert_volume(&surface, 2.0);
            assert_eq!(
                (surface.shells.len(), surface.repairs.self_intersections),
                (2, 0)
            );
        }
    }
}

#[test]
fn a_wall_between_parts_that_touch_in_a_face_is_dropped() {
    let first = block([0.0; 3], [1.0; 3]);
    for second in [moved(&first, [1.0, 0.0, 0.0]), mirrored(&first)] {
        let surface = read(&binary(&[first.clone(), second].concat()), METRES);
        assert_volume(&surface, 2.0);
        assert_eq!(surface.shells.len(), 1);
        assert_eq!(surface.triangles.len(), 20);
    }
}
