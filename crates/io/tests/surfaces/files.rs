//! The files of tests/shapes: the names of the tests give the expected result for each.

use super::{FILL, METRES, assert_same_solid, assert_volume, read, refusal, shape, shape_bytes};
use dem_io::surface::ReadSettings;

/// Volume of a polyhedron of 5120 facets in a sphere of radius 10.
const SPHERE: f64 = 4_179.738_952;

#[test]
fn clean_files_need_no_repair_and_no_word() {
    for (name, volume) in [
        ("01_ascii_box_mm", 2400.0),
        ("02_binary_box_mm", 2400.0),
        ("13_thin_plate_50x50x1", 2500.0),
        ("19_solid_header_binary_box", 2400.0),
        ("22_torus_R20_r5", 9_849.800_933),
        ("29_dumbbell_neck_d1", 8_313.289_231),
    ] {
        let surface = shape(name);
        assert_volume(&surface, volume);
        assert_eq!(surface.shells.len(), 1, "{name}");
        assert_eq!(surface.warnings, Vec::<String>::new(), "{name}");
        let clean = dem_io::surface::Repairs {
            facets_read: surface.triangles.len(),
            ..Default::default()
        };
        assert_eq!(surface.repairs, clean, "{name}");
    }
}

#[test]
fn single_precision_far_from_the_origin_is_noted() {
    let surface = shape("20_offset_1e6_box_float32");
    assert_volume(&surface, 2400.0);
    let [note] = &surface.warnings[..] else {
        panic!("{:?}", surface.warnings);
    };
    assert!(note.contains("0.16 % of its size"), "{note}");
}

#[test]
fn the_same_box_is_the_same_whatever_its_file() {
    let reference = shape("02_binary_box_mm");
    assert_eq!(reference.origin_m, [0.0; 3]);
    for name in [
        "01_ascii_box_mm",
        "04_inverted_normals_box",
        "19_solid_header_binary_box",
    ] {
        let surface = shape(name);
        assert_same_solid(&surface, &reference);
        assert_eq!(surface.origin_m, reference.origin_m);
    }
    let shifted = shape("20_offset_1e6_box_float32");
    assert_same_solid(&shifted, &reference);
    assert_eq!(shifted.origin_m, [1e6; 3]);
    assert_ne!(shifted.source_hash, reference.source_hash);
}

#[test]
fn a_box_wound_inwards_is_turned_with_one_warning() {
    let surface = shape("04_inverted_normals_box");
    assert_eq!(surface.repairs.flipped_facets, 12);
    assert_eq!(surface.warnings.len(), 1);
    assert!(
        surface.warnings[0].starts_with("All 12 facets were wound the wrong way round"),
        "{:?}",
        surface.warnings
    );
}

#[test]
fn holes_are_refused_with_their_place_and_closed_on_request() {
    let bytes = shape_bytes("06_open_small_hole_sphere_r10");
    let error = refusal(&bytes, METRES);
    assert!(
        error
            .problem
            .contains("10 open edges, 2 holes, the largest with a boundary of 5.166 around (-3.95"),
        "{error}"
    );
    assert!(error.remedy.contains("--fill-holes"), "{error}");
    let filled = read(&bytes, FILL);
    assert_volume(&filled, SPHERE);
    assert_eq!(
        (filled.repairs.filled_holes, filled.repairs.hole_triangles),
        (2, 6)
    );
    assert_eq!(
        filled.warnings,
        ["2 holes were closed with 6 new triangles."]
    );
}

#[test]
fn disjoint_parts_and_cavities() {
    let two = shape("08_two_disjoint_spheres_r10");
    assert_volume(&two, 2.0 * SPHERE);
    assert_eq!(
        two.shells.iter().filter(|shell| !shell.is_cavity).count(),
        2
    );
    assert_eq!(
        two.warnings,
        ["The shape has 2 separate parts: each is filled."]
    );
    let hollow = shape("09_nested_cavity_r10_r5_inner_inverted");
    assert_volume(&hollow, 0.875 * SPHERE);
    assert_eq!(
        hollow
            .shells
            .iter()
            .map(|shell| (shell.is_cavity, shell.outer_shell))
            .collect::<Vec<_>>(),
        [(false, 0), (true, 0)]
    );
    assert_eq!(hollow.repairs.flipped_facets, 0);
}

#[test]
fn superfluous_facets_are_dropped_and_counted() {
    let surface = shape("11_degenerate_and_duplicated_facets_sphere_r10");
    assert_volume(&surface, SPHERE);
    assert_eq!(
        (
            surface.repairs.degenerate_facets,
            surface.repairs.duplicate_facets,
            surface.repairs.flipped_facets
        ),
        (3, 21, 0)
    );
    assert_eq!((surface.triangles.len(), surface.warnings.len()), (5120, 2));
}

#[test]
fn jittered_corners_are_welded_and_that_is_said() {
    let surface = shape("26_unwelded_vertices_1e-5_sphere_r10");
    assert_volume(&surface, SPHERE);
    assert_eq!(
        (surface.vertices.len(), surface.repairs.welded_vertices),
        (2562, 12798)
    );
    // Two corners moved by up to 1e-5 along each axis are at most 2e-5 * sqrt(3) apart.
    assert!(
        (2e-5..3.47e-5).contains(&surface.repairs.weld_tolerance_m),
        "{}",
        surface.repairs.weld_tolerance_m
    );
    assert!(
        surface.warnings[0].contains("12798 vertices were moved onto a near one"),
        "{:?}",
        surface.warnings
    );
}

#[test]
fn files_that_are_no_solid_are_refused() {
    for (name, part) in [
        (
            "15_zero_triangles",
            "part.stl: the STL contains no triangles",
        ),
        (
            "17_truncated_binary_sphere",
            "part.stl: truncated: header promises 5120 triangles (256084 bytes), file has 50107",
        ),
        (
            "24_nan_vertex_sphere",
            "part.stl: triangle 18 of 5120: coordinate x of corner 2 is NaN, not a finite number",
        ),
        ("31_empty_file", "part.stl: not an STL: the file is empty"),
        (
            "33_ascii_truncated_mid_facet",
            "part.stl: line 58: truncated: ",
        ),
    ] {
        let text = refusal(&shape_bytes(name), FILL).to_string();
        assert!(text.starts_with(part), "{name}: {text}");
    }
}

#[test]
fn units_and_scale_multiply() {
    let bytes = shape_bytes("02_binary_box_mm");
    let metres = read(&bytes, METRES);
    let scaled = read(
        &bytes,
        ReadSettings {
            unit_m: Some(1e-3),
            scale: 2.0,
            fill_holes: false,
        },
    );
    assert_eq!(
        (&scaled.vertices, &scaled.triangles),
        (&metres.vertices, &metres.triangles)
    );
    assert!((scaled.volume_m3() - 2400.0 * 8e-9).abs() < 1e-18);
    for (unit_m, scale) in [
        (0.0, 1.0),
        (-1.0, 1.0),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
        (1e-200, 1.0),
    ] {
        refusal(
            &bytes,
            ReadSettings {
                unit_m: Some(unit_m),
                scale,
                fill_holes: false,
            },
        );
    }
}
