//! OBJ, PLY and 3MF beside STL.

use super::body;
use super::solids::{Facet, ascii, binary, block, moved, turned};
use super::written::{Ply, Zip, archive, mesh, model, obj, package, ply, three_mf};
use super::{METRES, assert_same_solid, assert_volume, damaged, read, shape_bytes};
use dem_io::surface::{ReadSettings, read_open_surface, read_surface};
use proptest::prelude::*;

/// As the file says, or mm.
pub(crate) const USUAL: ReadSettings = ReadSettings {
    unit_m: None,
    scale: 1.0,
    fill_holes: false,
};

fn facets_of(binary: &[u8]) -> Vec<Facet> {
    let number = |at: usize| f64::from(f32::from_le_bytes(binary[at..at + 4].try_into().unwrap()));
    let corner = |at: usize| [0, 4, 8].map(|axis| number(at + axis));
    let facets = (84..binary.len()).step_by(50);
    facets
        .map(|at| [12, 24, 36].map(|part| corner(at + part)))
        .collect()
}

fn said(bytes: &[u8], name: &str) -> String {
    let error = read_surface(bytes, name, USUAL).expect_err("a refusal");
    assert_eq!(error.exit_code(), 2);
    assert!(!error.remedy.is_empty(), "{error}");
    let text = error.to_string();
    text.strip_prefix(&format!("{name}: "))
        .expect(&text)
        .to_owned()
}

#[track_caller]
pub(crate) fn assert_says(bytes: &[u8], name: &str, beginning: &str) {
    let text = said(bytes, name);
    assert!(text.starts_with(beginning), "{text}");
}

#[test]
fn a_box_and_a_torus_are_the_same_in_every_format() {
    for name in ["02_binary_box_mm", "22_torus_R20_r5"] {
        let stl = shape_bytes(name);
        let facets = facets_of(&stl);
        let reference = read_surface(&stl, "part.stl", USUAL).unwrap();
        for (name, bytes) in [
            ("part.stl", ascii(&[&facets]).into_bytes()),
            ("part.obj", obj(&facets).into_bytes()),
            ("part.obj", obj(&facets).replace('\n', "\r\n").into_bytes()),
            ("PART.PLY", ply(&facets, Ply::Text)),
            ("part.ply", ply(&facets, Ply::Little)),
            ("part.ply", ply(&facets, Ply::Big)),
            ("part.3mf", three_mf(&facets)),
            ("standard input", three_mf(&facets)),
            ("standard input", ply(&facets, Ply::Big)),
            ("standard input", obj(&facets).into_bytes()),
        ] {
            let surface = read_surface(&bytes, name, USUAL).unwrap();
            assert_same_solid(&surface, &reference);
            assert_eq!(surface.origin_m, reference.origin_m, "{name}");
            assert_eq!(surface.warnings, Vec::<String>::new(), "{name}");
        }
    }
}

#[test]
fn walls_are_the_same_in_every_format() {
    let plate = &block([0.0; 3], [20.0, 12.0, 10.0])[..2];
    let wall = |bytes: &[u8], name: &str, unit_m| {
        let surface = read_open_surface(bytes, name, unit_m, 0.5).unwrap();
        (surface.vertices_m, surface.triangles, surface.warnings)
    };
    let reference = wall(&binary(plate), "wall.stl", Some(1e-3));
    let in_obj = obj(plate).into_bytes();
    assert_eq!(wall(&in_obj, "wall.obj", Some(1e-3)), reference);
    let in_ply = ply(plate, Ply::Little);
    assert_eq!(wall(&in_ply, "wall.ply", Some(1e-3)), reference);
    let in_3mf = three_mf(plate);
    assert_eq!(wall(&in_3mf, "wall.3mf", Some(1e-3)), reference);
    assert_eq!(wall(&in_3mf, "wall.3mf", None), reference);
    let error = read_open_surface(&in_ply, "wall.ply", None, 1.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "wall.ply: the file has no unit of its own; add unit = \"mm\" beside its name"
    );
}

#[test]
fn a_comment_ends_with_its_line() {
    let facets = block([0.0; 3], [20.0, 12.0, 10.0]);
    let text = format!("# from C:\\parts\\\n{}", obj(&facets));
    let surface = read_surface(text.as_bytes(), "part.obj", USUAL).unwrap();
    assert_same_solid(
        &surface,
        &read_surface(&binary(&facets), "part.stl", USUAL).unwrap(),
    );
}

#[test]
fn polygons_are_split() {
    // A prism on an L, whose ends are not convex, with a corner in the middle of an edge.
    let outline = [[0, 0], [2, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]];
    let mut text = String::new();
    for z in [0, 2] {
        for [x, y] in outline {
            text += &format!("v {x} {y} {z}\n");
        }
    }
    let side = |k: usize| {
        format!(
            "f {} {} {} {}\n",
            k + 1,
            (k + 1) % 7 + 1,
            (k + 1) % 7 + 8,
            k + 8
        )
    };
    for first in 0..7 {
        let corners = (0..7).map(|k| (k + first) % 7);
        let top: String = corners.clone().map(|k| format!(" {}", k + 8)).collect();
        let bottom: String = corners.rev().map(|k| format!(" {}", k + 1)).collect();
        let sides: String = (0..7).map(side).collect();
        let solid = format!("{text}f{top}\nf{bottom}\n{sides}");
        let surface = read_surface(solid.as_bytes(), "l.obj", METRES).unwrap();
        assert_volume(&surface, 12.0);
        assert_eq!(surface.triangles.len(), 24);
        assert_eq!(surface.warnings, Vec::<String>::new());
    }
}

#[test]
fn quads_of_a_box_give_its_triangles() {
    let quads = |corners: &[[f64; 3]]| {
        let mut text = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\nproperty list uchar uint vertex_index\nend_header\n".to_owned();
        for [x, y, z] in corners {
            text += &format!("{x} {y} {z}\n");
        }
        text + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n"
    };
    let corner = |i: usize| [0, 1, 2].map(|k| [20.0, 12.0, 10.0][k] * (i >> k & 1) as f64);
    let corners: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let surface = read_surface(quads(&corners).as_bytes(), "box.ply", METRES).unwrap();
    assert_volume(&surface, 2400.0);
    assert_eq!(surface.triangles.len(), 12);
    let mut bent = corners.clone();
    bent[7][2] += 0.1;
    read_surface(quads(&bent).as_bytes(), "box.ply", METRES).unwrap();
    bent[7][2] += 4.0;
    assert_eq!(
        said(quads(&bent).as_bytes(), "box.ply"),
        "face 2 of 6: it has 4 corners that lie in no plane: one is 4.2 % of its size off; split it into triangles in the program that made the shape, or export it as STL"
    );
    let mut bow_tie = corners;
    bow_tie.swap(6, 7);
    assert_says(
        quads(&bow_tie).as_bytes(),
        "box.ply",
        "face 2 of 6: it has 4 corners and crosses itself",
    );
}

#[test]
fn each_fault_of_an_obj_has_its_line() {
    let good = obj(&block([0.0; 3], [20.0, 12.0, 10.0]));
    for (from, to, beginning) in [
        (
            "v 20 0 0",
            "v 20 nan 0",
            "line 9: coordinate 'nan' is not a finite number",
        ),
        (
            "v 20 0 0 1.0",
            "v 20 0,5 0",
            "line 9: coordinate '0,5' is not a number",
        ),
        (
            "v 20 0 0 1.0",
            "v 20 0",
            "line 9: a corner has fewer than three coordinates",
        ),
        (
            "f 1 2 \\\n",
            "f 1 9 \\\n",
            "line 17, face 1: corner 9 of 8 is named",
        ),
        (
            "f 1 2 \\\n",
            "f 0 2 \\\n",
            "line 17: '0' is not the number of a corner",
        ),
        (
            "f 1 2 \\\n",
            "f -9 2 \\\n",
            "line 17: '-9' is not the number of a corner",
        ),
        (
            "f 1 2 \\\n  3",
            "f 1 2",
            "line 17: face 1 has fewer than three corners",
        ),
        (
            "g all",
            "gall all",
            "line 14: found 'gall' where an OBJ has 'v' or 'f'",
        ),
        (
            "g all",
            "cstype bspline",
            "line 14: 'cstype' belongs to a smooth surface",
        ),
        ("\nf ", "\nl ", "the OBJ contains no triangles"),
    ] {
        assert!(good.contains(from), "{from}");
        assert_says(good.replace(from, to).as_bytes(), "box.obj", beginning);
    }
    assert_says(b"# nothing\n", "box.obj", "the OBJ contains no triangles");
    assert_says(b"hello\n", "box.obj", "line 1: found 'hello'");
    assert_says(b"", "box.obj", "not an OBJ: the file is empty");
    let cut = read_surface(good.trim_end().as_bytes(), "box.obj", USUAL).unwrap();
    assert_eq!(
        cut.warnings,
        ["The last line has no end: the file may be cut short."]
    );
}

#[test]
fn each_fault_of_a_ply_has_its_place() {
    let facets = block([0.0; 3], [20.0, 12.0, 10.0]);
    let good = String::from_utf8(ply(&facets, Ply::Text)).unwrap();
    for (from, to, beginning) in [
        (
            "200 20 0 0",
            "200 20 nan 0",
            "corner 4 of 8: y is NaN, not a finite number",
        ),
        (
            "200 20 0 0",
            "200 20 0,5 0",
            "corner 4 of 8: line 18: '0,5' is not a number",
        ),
        (
            "3 0 1 2",
            "3 0 1 8",
            "face 1 of 12: corner 8 is named, and there are 8, from 0",
        ),
        ("3 0 1 2", "3 0 1 -3", "face 1 of 12: corner -3 is named"),
        (
            "3 0 1 2",
            "2 0 1",
            "face 1 of 12: it has fewer than three corners",
        ),
        ("3 0 1 2", "-1 0 1", "face 1 of 12: a list of -1 values"),
        (
            "property double z",
            "property double zz",
            "the corners of the PLY have no z",
        ),
        (
            "vertex_indices",
            "indices",
            "the faces of the PLY have no list vertex_indices",
        ),
        (
            "element face",
            "element tristrips",
            "the PLY has strips of triangles",
        ),
        (
            "element face",
            "element thing",
            "the PLY contains no triangles: it has points only",
        ),
        (
            "property double x",
            "property half x",
            "line 6: found 'property half x'",
        ),
        (
            "format ascii",
            "format zip",
            "line 2: found 'format zip 1.0' in the header",
        ),
        (
            "format ascii 1.0\n",
            "",
            "the header of the PLY has no line 'format'",
        ),
        ("end_header", "", "line 15: found '200 0 0 0' in the header"),
    ] {
        assert!(good.contains(from), "{from}");
        assert_says(good.replacen(from, to, 1).as_bytes(), "box.ply", beginning);
    }
    for (form, kept) in [(Ply::Text, 400), (Ply::Little, 700), (Ply::Big, 700)] {
        let bytes = ply(&facets, form);
        assert_says(&bytes[..kept], "box.ply", "face ");
        assert!(said(&bytes[..kept], "box.ply").contains("truncated: the file ends in it"));
        assert_says(
            &bytes[..100],
            "box.ply",
            "truncated: the file ends within its header",
        );
        let more = [&bytes[..], b"\n 1 2"].concat();
        let surface = read_surface(&more, "box.ply", USUAL).unwrap();
        assert_eq!(
            surface.warnings,
            ["3 bytes after the last element were ignored."]
        );
    }
    assert_says(b"plywood", "box.ply", "truncated");
}

#[test]
fn contents_count_more_than_names() {
    let facets = block([0.0; 3], [20.0, 12.0, 10.0]);
    let surface = read_surface(&binary(&facets), "box.obj", USUAL).unwrap();
    assert_eq!(
        surface.warnings,
        [
            "The name ends as that of a file of the format OBJ; the contents are STL, and were read so."
        ]
    );
    read_surface(&three_mf(&facets), "box.zip", USUAL).unwrap();
    for (bytes, name, beginning) in [
        (
            &b"ISO-10303-21;\nHEADER;"[..],
            "part.stl",
            "a file of the format STEP, which has no triangles; export it as STL or 3MF",
        ),
        (b"    1H,,1H;,", "part.IGS", "a file of the format IGES"),
        (
            b"#VRML V2.0 utf8",
            "part",
            "a file of the format VRML, which is not read; export it as STL, OBJ, PLY or 3MF, or convert it with MeshLab or meshio",
        ),
        (
            b"BLENDER-v300",
            "part.blend",
            "a file of the format Blender, which is not read; export it from Blender",
        ),
        (b"solid", "part.stp", "the STL contains no triangles"),
        (
            &archive(&[("Document.xml", "<a/>")], Zip::Stored),
            "part.FCStd",
            "a file of the format FreeCAD",
        ),
        (b"\x01\x02", "part.stl", "not an STL: 2 bytes"),
        (
            b"hello",
            "standard input",
            "not an STL: it is text that begins with 'hello', not with 'solid'",
        ),
    ] {
        assert_says(bytes, name, beginning);
    }
}

#[test]
fn several_objects_are_joined_as_solids_of_an_stl_are() {
    let cube = block([0.0; 3], [1.0; 3]);
    let both = [cube.clone(), turned(&moved(&cube, [3.0, 0.0, 0.0]))].concat();
    let text = obj(&both).replace("g all", "o second");
    let surface = read_surface(text.as_bytes(), "two.obj", METRES).unwrap();
    let reference = read(&binary(&both), METRES);
    assert_same_solid(&surface, &reference);
    assert_eq!(surface.warnings, reference.warnings);
    assert_eq!(surface.repairs.flipped_facets, 12);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files_give_a_solid_or_a_message(
        which in 0..7_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
        keep in prop::option::of(any::<prop::sample::Index>()),
        repeat in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let facets = block([0.0; 3], [20.0, 12.0, 10.0]);
        let object = format!("<object id=\"1\">{}</object>", mesh(&facets));
        let text = model("", &object, "<item objectid=\"1\"/>");
        let models = [("3D/3dmodel.model", &text[..])];
        let bytes = match which {
            0 => obj(&facets).into_bytes(),
            1 => ply(&facets, Ply::Text),
            2 => ply(&facets, Ply::Little),
            3 => ply(&facets, Ply::Big),
            4 => package(&models, Zip::Stored),
            5 => package(&models, Zip::Wide),
            _ => package(&models, Zip::Deflated),
        };
        body::read_stl(&damaged(bytes, damage, keep, repeat));
    }

    #[test]
    fn polygons_around_a_point_keep_their_area(radii in prop::collection::vec(0.2..3.0_f64, 4..40), from in any::<prop::sample::Index>()) {
        // A tent over a star-shaped polygon, which is its floor: a cone of that area.
        let count = radii.len();
        let first = from.index(count);
        let mut text = String::new();
        let mut area = 0.0;
        let at = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / count as f64;
            let radius = radii[k % count];
            [radius * angle.cos(), radius * angle.sin()]
        };
        for k in 0..count {
            let ([x, y], [u, v]) = (at(k), at((k + 1) % count));
            area += 0.5 * (x * v - y * u);
            text += &format!("v {x} {y} 0\n");
        }
        text += "v 0 0 3\n";
        let floor: String = (0..count).rev().map(|k| format!(" {}", (k + first) % count + 1)).collect();
        text += &format!("f{floor}\n");
        for k in 0..count {
            text += &format!("f {} {} {}\n", k + 1, (k + 1) % count + 1, count + 1);
        }
        let surface = read_surface(text.as_bytes(), "tent.obj", METRES).unwrap();
        prop_assert!((surface.volume_m3() / area - 1.0).abs() < 1e-9, "{} {area}", surface.volume_m3());
    }
}
