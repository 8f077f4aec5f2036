//! Walls from STL files.

use dem_io::surface::read_open_surface;
use dem_physics::geometry::{Mesh, Shape};

use super::{Surface, add_tiles, box_surface, touches};
use crate::closed_box::closed_box;

/// An ASCII STL.
fn stl((vertices, triangles): &Surface) -> String {
    let mut text = "solid wall\n".to_owned();
    for triangle in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for v in triangle {
            let [x, y, z] = vertices[*v as usize];
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid wall\n"
}

fn plate() -> Surface {
    let mut surface = (Vec::new(), Vec::new());
    add_tiles(&mut surface, 4, |i, j| {
        [f64::from(i) * 10.0, f64::from(j) * 10.0, 5.0]
    });
    surface
}

#[test]
fn an_open_plate_in_millimetres_is_a_wall() {
    let surface =
        read_open_surface(stl(&plate()).as_bytes(), "plate.stl", Some(1e-3), 1.0).unwrap();
    let mesh = Mesh::from_surface(&surface).unwrap();
    assert_eq!((mesh.content.triangles, mesh.content.open_edges), (32, 16));
    assert_eq!(
        (
            mesh.content.flat_parts,
            mesh.content.straight_edges,
            mesh.content.corners
        ),
        (1, 4, 4)
    );
    assert!((mesh.diagonal_m() - 0.04 * 2.0_f64.sqrt()).abs() < 1e-15);
    let found = touches(&Shape::Mesh(mesh), [0.02, 0.01, 0.006], 2e-3);
    assert_eq!(found.len(), 1);
    assert!((found[0].distance_m - 1e-3).abs() < 1e-15);
}

#[test]
fn a_closed_box_is_read_the_same_way() {
    let surface = box_surface([0.0; 3], [1.0; 3], 2);
    let read = read_open_surface(stl(&surface).as_bytes(), "box.stl", Some(1.0), 1.0).unwrap();
    assert_eq!((read.vertices_m.len(), read.triangles.len()), (26, 48));
    let mesh = Mesh::from_surface(&read).unwrap();
    assert_eq!(
        (mesh.content.open_edges, mesh.content.crowded_edges),
        (0, 0)
    );
}

#[test]
fn gaps_splits_doubles_and_slivers_are_seen_to() {
    // The second half of the plate is displaced by a ten-thousandth of a tile, and has one tile
    // twice, with reversed winding, and one degenerate facet.
    let (vertices, mut triangles) = plate();
    let near = triangles.split_off(16);
    let mut text = stl(&(vertices.clone(), triangles));
    let moved: Vec<[f64; 3]> = vertices
        .iter()
        .map(|[x, y, z]| [x + 1e-4, *y, *z])
        .collect();
    let [a, b, c] = near[3];
    let extra = vec![[b, a, c], [a, a, b]];
    text += &stl(&(moved, [near, extra].concat()));
    let read = read_open_surface(text.as_bytes(), "plate.stl", Some(1.0), 1.0).unwrap();
    assert_eq!((read.facets_read, read.triangles.len()), (34, 32));
    assert_eq!((read.duplicate_facets, read.degenerate_facets), (1, 1));
    assert_eq!((read.welded_vertices, read.vertices_m.len()), (5, 25));

    // A T-junction: one triangle meets two.
    let tee: Surface = (
        vec![
            [0.0; 3],
            [2.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 0.0, 0.0],
        ],
        vec![[0, 1, 2], [0, 3, 4], [4, 3, 1]],
    );
    let read = read_open_surface(stl(&tee).as_bytes(), "tee.stl", Some(1.0), 1.0).unwrap();
    assert_eq!((read.t_junctions, read.triangles.len()), (1, 4));
}

/// Facets wound against their neighbours are counted, except duplicates with both windings.
#[test]
fn turned_facets_are_counted() {
    let read = |surface: &Surface| {
        let read = read_open_surface(stl(surface).as_bytes(), "wall.stl", Some(1.0), 1.0).unwrap();
        (read.turned_facets, read.duplicate_facets)
    };
    let turn = |triangles: &mut [[u32; 3]], which: &[usize]| {
        which.iter().for_each(|t| triangles[*t].swap(0, 1));
    };
    let both_ways = |triangles: &[[u32; 3]]| {
        let turned = triangles.iter().map(|[a, b, c]| [*b, *a, *c]);
        triangles.iter().copied().chain(turned).collect()
    };
    let plate = plate();
    assert_eq!(read(&plate), (0, 0));
    let mut some = plate.clone();
    turn(&mut some.1, &[3, 4, 17]);
    assert_eq!(read(&some), (3, 0));
    let mut most = plate.clone();
    turn(&mut most.1, &(3..32).collect::<Vec<_>>());
    assert_eq!(read(&most), (3, 0));
    let doubled: Surface = (plate.0.clone(), both_ways(&plate.1));
    assert_eq!(read(&doubled), (0, 32));
    let mut one_doubled = some.clone();
    one_doubled.1.push(plate.1[9]);
    let [a, b, c] = plate.1[10];
    one_doubled.1.extend([[b, a, c]; 2]);
    // Two of three have the reversed winding, which is therefore the reference.
    assert_eq!(read(&one_doubled), (4, 3));

    // The tiles of this box are wound arbitrarily: half of its sides face inwards.
    let tiles = box_surface([0.0; 3], [1.0; 3], 2);
    let (turned, _) = read(&tiles);
    assert_eq!(turned, 24);

    // A cavity within a box is wound the other way, but is not connected to it.
    let (mut vertices, mut triangles) = closed_box([0.0; 3], [1.0; 3]);
    let (inner, hollow) = closed_box([0.25; 3], [0.75; 3]);
    let first = vertices.len() as u32;
    vertices.extend(inner);
    triangles.extend(
        hollow
            .iter()
            .map(|[a, b, c]| [b + first, a + first, c + first]),
    );
    assert_eq!(read(&(vertices, triangles)), (0, 0));
}

#[test]
fn what_is_no_surface_is_refused_with_the_name_of_the_file() {
    let line: Surface = (vec![[0.0; 3], [1.0; 3], [2.0; 3]], vec![[0, 1, 2]]);
    for (text, unit) in [
        (stl(&line), 1.0),
        ("solid\nendsolid\n".to_owned(), 1.0),
        (String::new(), 1.0),
        (stl(&plate()), 0.0),
        (stl(&plate()), f64::NAN),
    ] {
        let error = read_open_surface(text.as_bytes(), "plate.stl", Some(unit), 1.0).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(
            error.place.starts_with("plate.stl") && !error.remedy.is_empty(),
            "{error}"
        );
    }
}
