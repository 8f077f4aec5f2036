//! Parts that cross or overlap form their union.

use super::solids::{Facet, ascii, binary, block, turned};
use super::{METRES, read};

#[test]
fn overlapping_parts_form_their_union() {
    let first = block([0.0; 3], [2.0; 3]);
    for (second, union, crossing) in [
        (
            block([1.0, 0.7, 0.9], [3.0, 2.7, 2.9]),
            16.0 - 1.0 * 1.3 * 1.1,
            true,
        ),
        // Faces in one plane: no edge goes through a face, but the parts overlap.
        (block([1.0, 0.0, 0.0], [3.0, 2.0, 2.0]), 12.0, false),
        // Passing through completely.
        (
            block([0.5, 0.5, -1.0], [1.0, 1.0, 3.0]),
            8.0 + 0.25 * 2.0,
            true,
        ),
    ] {
        for second in [turned(&second), second] {
            let surface = read(ascii(&[&first, &second]).as_bytes(), METRES);
            assert_eq!(
                surface
                    .shells
                    .iter()
                    .filter(|shell| shell.is_cavity)
                    .count(),
                0
            );
            assert_eq!(surface.repairs.self_intersections > 0, crossing);
            let error = (surface.volume_m3() - union).abs();
            assert!(
                error <= surface.overlap_volume_error_m3,
                "{error} {}",
                surface.overlap_volume_error_m3
            );
            assert!(surface.overlap_volume_error_m3 < 1e-5 * union);
            assert!(
                surface
                    .warnings
                    .iter()
                    .any(|text| text.contains("the union of what they enclose is filled"))
            );
        }
    }
}

/// Parts, wound either way, are read as a solid of this volume.
fn assert_union(facets: Vec<Facet>, union: f64, within: f64) {
    for facets in [turned(&facets), facets] {
        let surface = read(&binary(&facets), METRES);
        assert!(
            (surface.volume_m3() / union - 1.0).abs() < within,
            "{} not {union}: {:?} {:?}",
            surface.volume_m3(),
            surface.shells,
            surface.warnings
        );
    }
}

#[test]
fn parts_that_overlap_with_a_face_in_common_form_their_union() {
    let first = block([0.0; 3], [1.0; 3]);
    for (second, union) in [
        (block([0.0; 3], [2.0, 1.0, 1.0]), 2.0),
        (block([0.0; 3], [3.0, 1.0, 2.0]), 6.0),
    ] {
        assert_union([first.clone(), second].concat(), union, 1e-5);
    }
}

/// Boxes of whole numbers, and the volume of their union.
type Boxes = (&'static [[[u8; 3]; 2]], f64);

#[test]
fn three_parts_with_faces_in_common_form_their_union() {
    let cases: [Boxes; 5] = [
        // Within each other, with two faces each in one plane.
        (
            &[
                [[0, 1, 1], [2, 4, 4]],
                [[0, 1, 1], [2, 2, 3]],
                [[0, 1, 1], [2, 4, 3]],
            ],
            18.0,
        ),
        // One face three times.
        (
            &[
                [[0, 0, 0], [1, 1, 1]],
                [[0, 0, 0], [2, 1, 1]],
                [[0, 0, 0], [3, 1, 1]],
            ],
            3.0,
        ),
        // Three and two times.
        (
            &[
                [[0, 0, 0], [1, 1, 1]],
                [[0, 0, 0], [2, 1, 1]],
                [[0, 0, 0], [2, 2, 1]],
            ],
            4.0,
        ),
        // A face of two, the third on its other side.
        (
            &[
                [[0, 0, 0], [1, 1, 1]],
                [[0, 0, 0], [2, 1, 1]],
                [[1, 0, 0], [2, 1, 1]],
            ],
            2.0,
        ),
        (
            &[
                [[0, 0, 0], [1, 1, 1]],
                [[0, 0, 0], [2, 1, 1]],
                [[0, 0, 0], [1, 1, 2]],
            ],
            3.0,
        ),
    ];
    for (boxes, union) in cases {
        let facets: Vec<_> = boxes
            .iter()
            .flat_map(|corners| {
                let [min, max] = corners.map(|corner| corner.map(f64::from));
                block(min, max)
            })
            .collect();
        assert_union(facets, union, 1e-3);
    }
}

#[test]
fn a_cavity_within_overlapping_parts_is_still_one() {
    let mut facets = block([0.0; 3], [4.0; 3]);
    facets.extend(block([3.0, 0.5, 0.5], [7.0, 3.5, 3.5]));
    facets.extend(block([1.0; 3], [2.0; 3]));
    let surface = read(&binary(&facets), METRES);
    assert_eq!(
        surface
            .shells
            .iter()
            .filter(|shell| shell.is_cavity)
            .count(),
        1
    );
    let union = 64.0 + 36.0 - 9.0 - 1.0;
    assert!(
        (surface.volume_m3() / union - 1.0).abs() < 1e-3,
        "{}",
        surface.volume_m3()
    );
}
