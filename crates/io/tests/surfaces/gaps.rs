//! Surfaces that are not closed: welded, split, filled or refused.

use super::solids::{self, Facet, ascii, binary, block};
use super::{FILL, METRES, assert_same_solid, assert_volume, read, refusal};

/// A box whose upper face has one more vertex, in the middle of an edge that the side face does not
/// split.
pub(crate) fn block_with_t_junction() -> Vec<Facet> {
    let mut facets = block([0.0; 3], [20.0, 12.0, 10.0]);
    let on_top = |p: &[f64; 3]| p[2] == 10.0;
    let upper = facets
        .iter()
        .position(|f| f.iter().all(on_top) && f.iter().filter(|p| p[1] == 0.0).count() == 2)
        .unwrap();
    let [a, b, c] = facets.remove(upper);
    let (a, b, c) = if a[1] != 0.0 {
        (b, c, a)
    } else if b[1] != 0.0 {
        (c, a, b)
    } else {
        (a, b, c)
    };
    let middle = [7.0, 0.0, 10.0];
    facets.extend([[a, middle, c], [middle, b, c]]);
    facets
}

#[test]
fn t_junctions_are_closed_and_reported() {
    let surface = read(&binary(&block_with_t_junction()), METRES);
    assert_volume(&surface, 2400.0);
    assert_eq!(
        (surface.repairs.t_junctions, surface.triangles.len()),
        (1, 14)
    );
    assert_eq!(surface.warnings.len(), 1);
    assert!(
        surface.warnings[0].starts_with("1 edge was split on one side only"),
        "{:?}",
        surface.warnings
    );
}

#[test]
fn faces_split_differently_on_both_sides_of_every_edge_close() {
    // Each face of the box is a grid of its own resolution, so that hardly any vertex on an edge
    // has a partner.
    let facets = solids::block_of_grids([20.0, 12.0, 10.0], [2, 3, 5, 7, 4, 1]);
    let surface = read(&binary(&facets), METRES);
    assert!((surface.volume_m3() / 2400.0 - 1.0).abs() < 1e-5);
    assert!(surface.repairs.t_junctions > 0);
    assert_eq!(surface.shells.len(), 1);
}

#[test]
fn a_facet_without_area_that_closes_a_t_junction_may_go() {
    let mut facets = block_with_t_junction();
    facets.push([[0.0, 0.0, 10.0], [7.0, 0.0, 10.0], [20.0, 0.0, 10.0]]);
    let surface = read(&binary(&facets), METRES);
    assert_volume(&surface, 2400.0);
    assert_eq!(
        (
            surface.repairs.degenerate_facets,
            surface.repairs.t_junctions
        ),
        (1, 1)
    );
}

#[test]
fn fine_features_do_not_collapse() {
    // Steps of 1e-6 of the size: a tolerance for all vertices would flatten them.
    let facets = [
        block([0.0; 3], [1000.0, 1000.0, 1000.0]),
        block([2000.0, 0.0, 0.0], [2000.001, 0.001, 0.001]),
    ]
    .concat();
    let surface = read(ascii(&[&facets]).as_bytes(), METRES);
    assert_eq!(
        (
            surface.shells.len(),
            surface.vertices.len(),
            surface.repairs.welded_vertices
        ),
        (2, 16, 0)
    );
}

#[test]
fn one_missing_facet_is_closed_and_a_missing_face_is_not() {
    let mut facets = block([0.0; 3], [20.0, 12.0, 10.0]);
    facets.pop();
    assert!(
        refusal(&binary(&facets), METRES)
            .problem
            .contains("3 open edges, 1 hole")
    );
    let surface = read(&binary(&facets), FILL);
    assert_same_solid(
        &surface,
        &read(&binary(&block([0.0; 3], [20.0, 12.0, 10.0])), METRES),
    );
    let open: Vec<Facet> = block([0.0; 3], [20.0, 12.0, 10.0])
        .into_iter()
        .filter(|f| f.iter().any(|p| p[2] < 10.0))
        .collect();
    let error = refusal(&binary(&open), FILL);
    assert!(
        error
            .problem
            .contains("4 open edges, 1 hole, the largest with a boundary of 64 around (10, 6, 10)"),
        "{error}"
    );
    assert!(error.remedy.contains("boundary of up to 12.69"), "{error}");
}

#[test]
fn surfaces_without_an_inside_are_refused() {
    let strip = solids::moebius_strip(24);
    for settings in [METRES, FILL] {
        assert!(
            refusal(&binary(&strip), settings)
                .problem
                .contains("Moebius")
        );
    }
    let facet = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for settings in [METRES, FILL] {
        refusal(&binary(&[facet]), settings);
        refusal(&binary(&[facet, [facet[0], facet[2], facet[1]]]), settings);
        refusal(&binary(&[[facet[0]; 3]]), settings);
    }
    let mut with_fin = block([0.0; 3], [1.0; 3]);
    with_fin.push([[0.0; 3], [1.0, 0.0, 0.0], [0.5, -1.0, 0.0]]);
    let error = refusal(&binary(&with_fin), FILL);
    assert!(error.problem.contains("1 edge belongs to an odd number of facets, the first with 3 from (0, 0, 0) to (1, 0, 0)"), "{error}");
}

#[test]
fn holes_with_few_and_with_many_edges_are_closed() {
    for sides in [5, 200, 201, 400] {
        let tube = solids::open_tube(sides, 50.0);
        let surface = read(ascii(&[&tube]).as_bytes(), FILL);
        let angle = std::f64::consts::TAU / sides as f64;
        assert_volume(&surface, 0.5 * sides as f64 * angle.sin() * 50.0);
        assert_eq!(
            (surface.repairs.filled_holes, surface.repairs.flipped_facets),
            (1, 0)
        );
    }
}
