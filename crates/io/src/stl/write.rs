//! Writing of STL: binary, or as text where the single precision of binary would move corners.

use super::precision::single_precision_keeps;
use std::io::{self, Write};

/// Bytes of the header.
const HEADER: usize = 80;

/// Writes triangles as STL: corners of each, counterclockwise as seen from outside. The file is
/// binary with the first 80 bytes of the `header`, or text if the corners are so far from the
/// origin that single precision would move them.
pub fn write_stl(header: &str, facets: &[[[f64; 3]; 3]], out: &mut dyn Write) -> io::Result<()> {
    if !single_precision_keeps(facets.iter().flatten()) {
        return write_stl_text(header, facets, out);
    }
    let mut head = [b' '; HEADER];
    for (byte, letter) in head.iter_mut().zip(header.bytes()) {
        *byte = letter;
    }
    out.write_all(&head)?;
    let count = u32::try_from(facets.len()).map_err(io::Error::other)?;
    out.write_all(&count.to_le_bytes())?;
    for facet in facets {
        let facet = facet.map(|corner| corner.map(|x| x as f32));
        for number in normal(&facet).iter().chain(facet.as_flattened()) {
            out.write_all(&number.to_le_bytes())?;
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

/// As [`write_stl`], as text with all digits: a corner that two triangles share is the same in both.
pub fn write_stl_text(
    header: &str,
    facets: &[[[f64; 3]; 3]],
    out: &mut dyn Write,
) -> io::Result<()> {
    let name = header.replace(['\r', '\n'], " ");
    writeln!(out, "solid {name}")?;
    for facet in facets {
        writeln!(out, "facet normal 0 0 0\nouter loop")?;
        for [x, y, z] in facet {
            writeln!(out, "vertex {x} {y} {z}")?;
        }
        writeln!(out, "endloop\nendfacet")?;
    }
    writeln!(out, "endsolid {name}")
}

/// Unit normal; zero for a triangle without area, as readers expect.
fn normal([a, b, c]: &[[f32; 3]; 3]) -> [f32; 3] {
    let edge = |to: &[f32; 3]| [0, 1, 2].map(|k| f64::from(to[k]) - f64::from(a[k]));
    let (u, v) = (edge(b), edge(c));
    let cross = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 {
        cross.map(|x| (x / length) as f32)
    } else {
        [0.0; 3]
    }
}
