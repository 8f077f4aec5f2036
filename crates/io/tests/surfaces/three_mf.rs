//! 3MF: units, items, components, and what is none.

use super::body;
use super::formats::{USUAL, assert_says};
use super::solids::{binary, block};
use super::written::{Zip, archive, mesh, model, package, three_mf};
use super::{METRES, assert_volume, damaged, read};
use dem_io::surface::{ReadSettings, read_surface};
use proptest::prelude::*;

#[test]
fn a_3mf_knows_its_unit() {
    let object = format!(
        "<object id=\"1\">{}</object>",
        mesh(&block([0.0; 3], [1.0; 3]))
    );
    for (attribute, unit_m) in [
        ("", 1e-3),
        ("unit=\"micron\"", 1e-6),
        ("unit=\"centimeter\"", 1e-2),
        ("unit=\"inch\"", 0.0254),
        ("unit=\"foot\"", 0.3048),
        ("unit=\"meter\"", 1.0),
    ] {
        let text = model(attribute, &object, "<item objectid=\"1\"/>");
        let bytes = package(&[("3D/3dmodel.model", &text)], Zip::Stored);
        let with = |given: Option<f64>| {
            let settings = ReadSettings {
                unit_m: given,
                scale: 2.0,
                ..USUAL
            };
            read_surface(&bytes, "part.3mf", settings)
        };
        for given in [None, Some(unit_m)] {
            assert_volume(&with(given).unwrap(), 8.0 * unit_m.powi(3));
        }
        let error = with(Some(2.0)).unwrap_err().to_string();
        assert!(
            error.ends_with(", as it says itself, not 2 m; leave the unit out; a scale makes the shape larger or smaller"),
            "{error}"
        );
    }
    let text = model("unit=\"ell\"", &object, "<item objectid=\"1\"/>");
    let bytes = package(&[("3D/3dmodel.model", &text)], Zip::Stored);
    assert_says(
        &bytes,
        "part.3mf",
        "3D/3dmodel.model: line 2: 'ell' is no unit of a 3MF",
    );
}

#[test]
fn objects_of_a_3mf_stand_where_its_items_put_them() {
    let (cube, other) = (block([0.0; 3], [1.0; 3]), block([0.0; 3], [1.0, 1.0, 2.0]));
    let resources = format!(
        "<object id=\"1\">{}</object>\
         <object id=\"4\" type=\"support\">{}</object>\
         <object id=\"2\"><components>\
         <component objectid=\"1\" transform=\"2 0 0 0 1 0 0 0 1 10 0 0\"/>\
         <component p:path=\"/3D/Objects/other.model\" objectid=\"7\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 5\"/>\
         </components></object>",
        mesh(&cube),
        mesh(&cube)
    );
    // A quarter turn about z: x becomes y.
    let items = "<item objectid=\"1\"/><item objectid=\"4\"/>\
                 <item objectid=\"2\" transform=\"0 1 0 -1 0 0 0 0 1 0 0 100\"/>";
    let main = model("", &resources, items);
    let far = model(
        "",
        &format!("<object id=\"7\">{}</object>", mesh(&other)),
        "",
    );
    let models = [
        ("3D/main.model", &main[..]),
        ("3D/Objects/other.model", &far),
    ];
    let stretched = block([-1.0, 10.0, 100.0], [0.0, 12.0, 101.0]);
    let mirrored = block([-1.0, -1.0, 105.0], [0.0, 0.0, 107.0]);
    let whole = [cube, stretched, mirrored].concat();
    let reference = read(&binary(&whole), METRES);
    for how in [Zip::Stored, Zip::Deflated, Zip::Wide] {
        let bytes = package(&models, how);
        let surface = read_surface(&bytes, "part.3mf", USUAL).unwrap();
        assert_eq!(surface.vertices, reference.vertices);
        let volumes = |surface: &dem_io::Surface| {
            let volumes = surface.shells.iter().map(|shell| shell.volume_m3);
            volumes.collect::<Vec<f64>>()
        };
        for (found, wanted) in volumes(&surface).iter().zip(volumes(&reference)) {
            assert!(
                (1e9 * found / wanted - 1.0).abs() < 1e-12,
                "{found} {wanted}"
            );
        }
        assert_eq!(surface.repairs.flipped_facets, 0);
        assert_eq!(
            surface.warnings,
            [
                "Objects that are supports, or not to be printed, were left out: 4.",
                "The shape has 3 separate parts: each is filled."
            ]
        );
    }
    let main = main.replace("objectid=\"7\"", "objectid=\"8\"");
    let models = [
        ("3D/main.model", &main[..]),
        ("3D/Objects/other.model", &far),
    ];
    assert_says(
        &package(&models, Zip::Stored),
        "part.3mf",
        "3D/Objects/other.model: object 8: it is named, but missing",
    );
    assert_says(
        &package(&models[..1], Zip::Stored),
        "part.3mf",
        "the model '3D/Objects/other.model' is missing in it",
    );
}

#[test]
fn a_3mf_that_is_none_or_never_ends_is_refused() {
    let object = |content: &str| format!("<object id=\"1\">{content}</object>");
    let cube = mesh(&block([0.0; 3], [1.0; 3]));
    let item = "<item objectid=\"1\"/>";
    let itself = "<components><component objectid=\"1\"/></components>";
    let mut doubling = object(&cube);
    for id in 2..60 {
        let part = format!("<component objectid=\"{}\"/>", id - 1);
        doubling += &format!("<object id=\"{id}\"><components>{part}{part}</components></object>");
    }
    for (text, beginning) in [
        (
            model("", &object(itself), item),
            "3D/a.model: object 1: it is a part of itself",
        ),
        (
            model("", &doubling, "<item objectid=\"59\"/>"),
            "3D/a.model: object 4: it is built too often",
        ),
        (
            model("", &object(&cube), ""),
            "the 3MF contains no triangles",
        ),
        (
            model("", &object(&cube.replace("v3=\"7\"", "v3=\"8\"")), item),
            "3D/a.model: object 1: triangle 4 names corner 8, and there are 8, from 0",
        ),
        (
            model("", &object(&cube.replace("x=\"1\"", "x=\"NaN\"")), item),
            "3D/a.model: line 7: x is 'NaN', not a finite number",
        ),
        (
            model("", &object(&cube.replacen("x=\"1\"", "", 1)), item),
            "3D/a.model: line 7: 'vertex' has no x",
        ),
        (
            model(
                "",
                &object(&cube),
                "<item objectid=\"1\" transform=\"1 0 0\"/>",
            ),
            "3D/a.model: line 27: the transform '1 0 0' is not twelve numbers",
        ),
        (
            model("", &object(&cube).repeat(2), item),
            "3D/a.model: line 26: two objects have the number 1",
        ),
        (
            "<model>".to_owned(),
            "3D/a.model: truncated: the model has no end",
        ),
        ("<a/>".to_owned(), "3D/a.model: it has no element 'model'"),
    ] {
        let bytes = package(&[("3D/a.model", &text)], Zip::Deflated);
        assert_says(&bytes, "part.3mf", beginning);
    }
    let none = archive(&[("readme.txt", "hello")], Zip::Stored);
    assert_says(&none, "part.3mf", "a zip archive, but not a 3MF");
    assert_says(b"hello", "part.3mf", "not a 3MF: it is not a zip archive");
    let whole = three_mf(&block([0.0; 3], [1.0; 3]));
    assert_says(
        &whole[..whole.len() - 1],
        "part.3mf",
        "truncated or damaged",
    );
    let place = whole.windows(4).rposition(|w| w == b"PK\x03\x04").unwrap() + 60;
    let mut damaged = whole;
    damaged[place] ^= 0xff;
    assert_says(&damaged, "part.3mf", "3D/part.model: damaged");
}

/// Items that are not printed are left out with a note, and elements of extensions, such as slices,
/// are none of the model.
#[test]
fn a_3mf_has_more_than_what_is_printed() {
    let cube = block([0.0; 3], [1.0; 3]);
    let resources = format!(
        "<object id=\"1\">{}</object><object id=\"2\">{}</object>\
         <s:slicestack id=\"3\"><s:slice><s:vertices><s:vertex x=\"1\" y=\"2\"/></s:vertices></s:slice></s:slicestack>",
        mesh(&cube),
        mesh(&cube)
    );
    let items = "<item objectid=\"1\"/><item objectid=\"2\" printable=\"0\"/>";
    let name = "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\"";
    let text = model(name, &resources, items);
    let bytes = package(&[("3D/part.model", &text)], Zip::Stored);
    let surface = read_surface(&bytes, "part.3mf", USUAL).unwrap();
    assert_volume(&surface, 1e-9);
    assert!(
        surface.warnings[0].contains("not to be printed, were left out: 2."),
        "{:?}",
        surface.warnings
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_models_give_a_solid_or_a_message(
        damage in prop::collection::vec((any::<prop::sample::Index>(), 32..127_u8), 0..4),
        keep in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let facets = block([0.0; 3], [20.0, 12.0, 10.0]);
        let object = format!("<object id=\"1\">{}</object>", mesh(&facets));
        let text = model("", &object, "<item objectid=\"1\"/>").into_bytes();
        let text = String::from_utf8(damaged(text, damage, keep, None)).unwrap();
        body::read_stl(&package(&[("3D/3dmodel.model", &text)], Zip::Stored));
    }
}
