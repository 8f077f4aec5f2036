//! The bytes of files of triangles in other formats than STL, for tests.

use super::solids::Facet;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use std::io::Write;

/// The corners of facets, each once, and three indices for each facet.
pub(crate) fn indexed(facets: &[Facet]) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut index = |corner: [f64; 3]| {
        let found = corners.iter().position(|known| *known == corner);
        found.unwrap_or_else(|| {
            corners.push(corner);
            corners.len() - 1
        })
    };
    let triangles = facets.iter().map(|facet| facet.map(&mut index)).collect();
    (corners, triangles)
}

/// An OBJ with all that does not matter.
pub(crate) fn obj(facets: &[Facet]) -> String {
    let (corners, triangles) = indexed(facets);
    let mut text = "# Größe in mm\nmtllib part.mtl\no part\nvn 0 0 1\nvt 0.5 0.5\n".to_owned();
    for [x, y, z] in &corners {
        text += &format!("v {x} {y} {z} 1.0\n");
    }
    text += "g all\nusemtl grey\ns off\n";
    let count = corners.len();
    for (at, triangle) in triangles.iter().enumerate() {
        let [a, b, c] = match at % 4 {
            0 => triangle.map(|k| format!("{}", k + 1)),
            1 => triangle.map(|k| format!("{}/1/1", k + 1)),
            2 => triangle.map(|k| format!("{}//1", k + 1)),
            _ => triangle.map(|k| format!("-{}", count - k)),
        };
        text += &format!("f {a} {b} \\\n  {c}  # a face\n");
    }
    text
}

/// How the values of a PLY are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Ply {
    Text,
    Little,
    Big,
}

/// A PLY in double precision, with properties and an element that do not matter.
pub(crate) fn ply(facets: &[Facet], form: Ply) -> Vec<u8> {
    let (corners, triangles) = indexed(facets);
    let name = match form {
        Ply::Text => "ascii",
        Ply::Little => "binary_little_endian",
        Ply::Big => "binary_big_endian",
    };
    let (count, faces) = (corners.len(), triangles.len());
    let mut bytes = format!(
        "ply\nformat {name} 1.0\ncomment made by a test\nelement vertex {count}\nproperty uchar red\nproperty double x\nproperty double y\nproperty double z\nelement edge 1\nproperty int vertex1\nelement face {faces}\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
    )
    .into_bytes();
    let put = |bytes: &mut Vec<u8>, little: &[u8], text: String| match form {
        Ply::Text => bytes.extend(text.bytes()),
        Ply::Little => bytes.extend(little),
        Ply::Big => bytes.extend(little.iter().rev()),
    };
    for corner in &corners {
        put(&mut bytes, &[200], "200".to_owned());
        for x in corner {
            put(&mut bytes, &x.to_le_bytes(), format!(" {x}"));
        }
        put(&mut bytes, &[], "\n".to_owned());
    }
    put(&mut bytes, &7_i32.to_le_bytes(), "7\n".to_owned());
    for triangle in &triangles {
        put(&mut bytes, &[3], "3".to_owned());
        for index in triangle {
            put(
                &mut bytes,
                &(*index as i32).to_le_bytes(),
                format!(" {index}"),
            );
        }
        put(&mut bytes, &[1], " 1".to_owned());
        put(&mut bytes, &0.5_f32.to_le_bytes(), " 0.5\n".to_owned());
    }
    bytes
}

/// The element `mesh` of a 3MF.
pub(crate) fn mesh(facets: &[Facet]) -> String {
    let (corners, triangles) = indexed(facets);
    let mut text = "<mesh><vertices>\n".to_owned();
    for [x, y, z] in corners {
        text += &format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\" />\n");
    }
    text += "</vertices><triangles>\n";
    for [a, b, c] in triangles {
        text += &format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\" pid=\"1\"/>\n");
    }
    text + "</triangles></mesh>"
}

/// A model of a 3MF with these resources and items. `unit` is an attribute, or empty.
pub(crate) fn model(unit: &str, resources: &str, items: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model {unit} xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\">\n<metadata name=\"Title\">A &amp; B</metadata>\n<resources>{resources}</resources>\n<build>{items}</build>\n</model>\n"
    )
}

/// A 3MF of one object, deflated.
pub(crate) fn three_mf(facets: &[Facet]) -> Vec<u8> {
    let object = format!("<object id=\"1\" type=\"model\">{}</object>", mesh(facets));
    let text = model("unit=\"millimeter\"", &object, "<item objectid=\"1\"/>");
    package(&[("3D/part.model", &text)], Zip::Deflated)
}

/// How an archive is packed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Zip {
    Stored,
    Deflated,
    /// Deflated, all sizes in fields of 64 bits.
    Wide,
}

/// A 3MF of these models, of which the first is the main one.
pub(crate) fn package(models: &[(&str, &str)], how: Zip) -> Vec<u8> {
    let relations = format!(
        "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Id=\"rel0\" Target=\"/{}\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>",
        models[0].0
    );
    let types = "<?xml version=\"1.0\"?><Types/>";
    let mut files = vec![("[Content_Types].xml", types), ("_rels/.rels", &relations)];
    files.extend(models);
    archive(&files, how)
}

/// A zip archive.
pub(crate) fn archive(files: &[(&str, &str)], how: Zip) -> Vec<u8> {
    let (mut bytes, mut list) = (Vec::new(), Vec::new());
    let wide = how == Zip::Wide;
    let size = |bytes: &mut Vec<u8>, value: usize| {
        let shown = if wide { u32::MAX } else { value as u32 };
        bytes.extend(shown.to_le_bytes());
    };
    for (name, content) in files {
        let mut sum = flate2::Crc::new();
        sum.update(content.as_bytes());
        let packed = match how {
            Zip::Stored => content.as_bytes().to_vec(),
            Zip::Deflated | Zip::Wide => {
                let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
                encoder.write_all(content.as_bytes()).unwrap();
                encoder.finish().unwrap()
            }
        };
        let method: u16 = if how == Zip::Stored { 0 } else { 8 };
        let begins = bytes.len();
        let common = |out: &mut Vec<u8>, extra: u16| {
            out.extend([20, 0, 0, 0]);
            out.extend(method.to_le_bytes());
            out.extend([0; 4]);
            out.extend(sum.sum().to_le_bytes());
            size(out, packed.len());
            size(out, content.len());
            out.extend((name.len() as u16).to_le_bytes());
            out.extend(extra.to_le_bytes());
        };
        bytes.extend(b"PK\x03\x04");
        common(&mut bytes, 0);
        bytes.extend(name.bytes());
        bytes.extend(&packed);
        list.extend(b"PK\x01\x02\x14\0");
        common(&mut list, if wide { 28 } else { 0 });
        list.extend([0; 10]);
        size(&mut list, begins);
        list.extend(name.bytes());
        if wide {
            list.extend([1, 0, 24, 0]);
            for value in [content.len(), packed.len(), begins] {
                list.extend((value as u64).to_le_bytes());
            }
        }
    }
    let begins = bytes.len();
    bytes.extend(&list);
    let count = files.len();
    if wide {
        let end = bytes.len() as u64;
        bytes.extend(b"PK\x06\x06");
        bytes.extend(44_u64.to_le_bytes());
        bytes.extend([45, 0, 45, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        for value in [count, count, list.len(), begins] {
            bytes.extend((value as u64).to_le_bytes());
        }
        bytes.extend(b"PK\x06\x07\0\0\0\0");
        bytes.extend(end.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
    }
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    for _ in 0..2 {
        bytes.extend((count as u16).to_le_bytes());
    }
    size(&mut bytes, list.len());
    size(&mut bytes, begins);
    bytes.extend([0; 2]);
    bytes
}
