//! PLY (Stanford) -> facets: the coordinates of `vertex` and the lists of `face`, as text or binary
//! of either order of bytes. All else is skipped. Our own code: `ply-rs-bw` builds a map of names
//! for each corner, and its grammar is one more compiler.

mod header;
mod values;

use self::header::{Element, Header, Property};
use self::values::Values;
use super::polygon::{self, REMEDY_SPLIT};
use crate::diagnostic::{Diagnostic, Result};
use crate::stl::{Facets, REMEDY_AGAIN, REMEDY_REPAIR, precision_note};

/// True if the bytes begin as a PLY does.
pub(super) fn is_ply(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply") && bytes.get(3).is_some_and(u8::is_ascii_whitespace)
}

/// Reads the faces of a file.
pub(super) fn read(bytes: &[u8]) -> Result<Facets> {
    let header = Header::read(bytes)?;
    let mut values = Values::of(&header, bytes);
    let mut corners = Vec::new();
    let mut polygons = Polygons::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => corners = read_corners(element, &mut values)?,
            "face" => polygons = read_polygons(element, &mut values)?,
            _ => skip(element, &mut values)?,
        }
    }
    if polygons.begins.is_empty() {
        return Err(without_faces(&header));
    }
    let mut facets = polygons.split(&corners)?;
    if values.is_binary() && header.has_single_precision() {
        facets
            .warnings
            .extend(precision_note(&facets.corners, "PLY"));
    }
    let rest = values.rest();
    if rest > 0 {
        let note = format!("{rest} bytes after the last element were ignored.");
        facets.warnings.push(note);
    }
    Ok(facets)
}

fn without_faces(header: &Header) -> Diagnostic {
    let has_strips = header.elements.iter().any(|e| e.name == "tristrips");
    let (problem, remedy) = if has_strips {
        (
            "the PLY has strips of triangles, which are not read, and no faces",
            "export it with faces",
        )
    } else {
        (
            "the PLY contains no triangles: it has points only",
            "make a surface of the points, for example in MeshLab, and export that",
        )
    };
    Diagnostic::input("", problem, remedy)
}

/// The coordinates of an element `vertex`.
fn read_corners(element: &Element, values: &mut Values<'_>) -> Result<Vec<[f64; 3]>> {
    let mut at = [0; 3];
    for (k, axis) in ["x", "y", "z"].iter().enumerate() {
        let is_axis = |p: &Property| p.name == *axis && p.count.is_none();
        let Some(found) = element.properties.iter().position(is_axis) else {
            let problem = format!("the corners of the PLY have no {axis}");
            return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
        };
        at[k] = found;
    }
    // A header may promise more than the file has: room is made as corners come.
    let mut corners = Vec::new();
    for index in 0..element.count {
        let mut corner = [0.0; 3];
        for (which, property) in element.properties.iter().enumerate() {
            let value = values
                .property(property, |_| {})
                .map_err(|e| place(e, "corner", index, element))?;
            if let Some(k) = at.iter().position(|at| *at == which) {
                corner[k] = value;
            }
        }
        if let Some(k) = corner.iter().position(|x| !x.is_finite()) {
            let problem = format!(
                "{} is {}, not a finite number",
                ["x", "y", "z"][k],
                corner[k]
            );
            let wrong = Diagnostic::input("", problem, REMEDY_REPAIR);
            return Err(place(wrong, "corner", index, element));
        }
        corners.push(corner);
    }
    Ok(corners)
}

/// The faces of a file.
#[derive(Default)]
struct Polygons {
    /// Where the corners of each begin in `named`.
    begins: Vec<usize>,
    /// Indices of corners, from 0, as they stand in the file.
    named: Vec<f64>,
}

fn read_polygons(element: &Element, values: &mut Values<'_>) -> Result<Polygons> {
    let is_list = |p: &Property| {
        matches!(p.name.as_str(), "vertex_indices" | "vertex_index") && p.count.is_some()
    };
    let Some(list) = element.properties.iter().position(is_list) else {
        let problem = "the faces of the PLY have no list vertex_indices";
        return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
    };
    let mut polygons = Polygons::default();
    for index in 0..element.count {
        polygons.begins.push(polygons.named.len());
        for (which, property) in element.properties.iter().enumerate() {
            let push = |value| {
                if which == list {
                    polygons.named.push(value);
                }
            };
            values
                .property(property, push)
                .map_err(|e| place(e, "face", index, element))?;
        }
    }
    Ok(polygons)
}

impl Polygons {
    fn split(self, corners: &[[f64; 3]]) -> Result<Facets> {
        let mut facets = Facets::default();
        let mut polygon = Vec::new();
        for (at, begin) in self.begins.iter().enumerate() {
            let place = || format!("face {} of {}", at + 1, self.begins.len());
            let end = self.begins.get(at + 1).copied().unwrap_or(self.named.len());
            polygon.clear();
            for index in &self.named[*begin..end] {
                let is_whole = *index >= 0.0 && index.fract() == 0.0;
                let corner = corners.get(*index as usize).filter(|_| is_whole);
                let Some(corner) = corner else {
                    let problem = format!(
                        "corner {index} is named, and there are {}, from 0",
                        corners.len()
                    );
                    return Err(Diagnostic::input(place(), problem, REMEDY_REPAIR));
                };
                polygon.push(*corner);
            }
            if polygon.len() < 3 {
                let problem = "it has fewer than three corners";
                return Err(Diagnostic::input(place(), problem, REMEDY_REPAIR));
            }
            polygon::split(&polygon, &mut facets.corners)
                .map_err(|problem| Diagnostic::input(place(), problem, REMEDY_SPLIT))?;
        }
        Ok(facets)
    }
}

fn skip(element: &Element, values: &mut Values<'_>) -> Result<()> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for index in 0..element.count {
        for property in &element.properties {
            values
                .property(property, |_| {})
                .map_err(|e| place(e, &element.name, index, element))?;
        }
    }
    Ok(())
}

/// The error of an element with its place: that in the file, and `what` it is of how many.
fn place(error: Diagnostic, what: &str, index: u64, element: &Element) -> Diagnostic {
    error.within(&format!("{what} {} of {}", index + 1, element.count))
}
