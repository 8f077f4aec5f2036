//! A model of a 3MF: XML -> objects and the items to build. Units, transforms and the references of
//! one object to another stay as they are in the file.

use crate::diagnostic::{Diagnostic, Result};
use crate::stl::{REMEDY_AGAIN, REMEDY_REPAIR};
use quick_xml::Reader;
use quick_xml::XmlVersion::Implicit1_0;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// A transform: x y z of a point are multiplied by the first nine numbers, three for each of its
/// coordinates, and moved by the last three.
pub(super) type Transform = [f64; 12];

pub(super) const IN_PLACE: Transform = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];

/// A model.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// Metres in its unit.
    pub(super) unit_m: f64,
    /// By their number.
    pub(super) objects: BTreeMap<u32, Object>,
    /// What is to be built.
    pub(super) items: Vec<Reference>,
    /// Numbers of the objects of items that are not to be printed.
    pub(super) not_printed: Vec<u32>,
}

/// An object: triangles, or other objects.
#[derive(Debug, Default)]
pub(super) struct Object {
    /// A support of a print, or something that is not to be printed.
    pub(super) is_beside: bool,
    pub(super) corners: Vec<[f64; 3]>,
    /// Three indices of corners each.
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) components: Vec<Reference>,
}

/// An object at a place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reference {
    pub(super) object: u32,
    pub(super) transform: Transform,
    /// The file of the object, if it is another.
    pub(super) path: Option<String>,
}

/// Reads a model.
pub(super) fn read(bytes: &[u8]) -> Result<Model> {
    let mut reader = Reader::from_reader(bytes);
    let mut model = Model::default();
    let mut has_model = false;
    let mut object: Option<u32> = None;
    let mut own: Option<String> = None;
    loop {
        let before = reader.buffer_position();
        let damaged = || {
            let line = 1 + bytes[..(before as usize).min(bytes.len())]
                .iter()
                .filter(|b| **b == b'\n')
                .count();
            format!("line {line}")
        };
        let event = reader.read_event().map_err(|error| {
            Diagnostic::input(damaged(), format!("no valid XML: {error}"), REMEDY_AGAIN)
        })?;
        match event {
            Event::Start(element) | Event::Empty(element) => {
                let name = element.local_name();
                let prefix = element.name().prefix();
                let prefix = prefix.map_or("", |prefix| prefix.into_inner()).to_owned();
                if name.as_ref() == "model" {
                    has_model = true;
                    own = Some(prefix);
                } else if own.as_ref().is_some_and(|own| *own != prefix) {
                    continue;
                }
                open(&element, name.as_ref(), &mut model, &mut object)
                    .map_err(|problem| Diagnostic::input(damaged(), problem, REMEDY_REPAIR))?;
            }
            Event::End(element) if element.local_name().as_ref() == "model" => return Ok(model),
            Event::End(element) if element.local_name().as_ref() == "object" => object = None,
            Event::Eof => break,
            _ => {}
        }
    }
    let problem = if has_model {
        "truncated: the model has no end"
    } else {
        "it has no element 'model'"
    };
    Err(Diagnostic::input("", problem, REMEDY_AGAIN))
}

/// Takes in the beginning of an element.
fn open(
    element: &BytesStart<'_>,
    name: &str,
    model: &mut Model,
    current: &mut Option<u32>,
) -> std::result::Result<(), String> {
    match name {
        "model" => model.unit_m = unit_m(element)?,
        "object" => {
            let id = whole(element, "id")?;
            let kind = attribute(element, "type")?;
            let is_beside = matches!(kind.as_deref(), Some("support" | "solidsupport" | "other"));
            let object = Object {
                is_beside,
                ..Object::default()
            };
            if model.objects.insert(id, object).is_some() {
                return Err(format!("two objects have the number {id}"));
            }
            *current = Some(id);
        }
        "item" if attribute(element, "printable")?.as_deref() == Some("0") => {
            model.not_printed.push(whole(element, "objectid")?);
        }
        "item" => model.items.push(reference(element)?),
        "vertex" | "triangle" | "component" => {
            let object = current.and_then(|id| model.objects.get_mut(&id));
            let object = object.ok_or_else(|| format!("'{name}' stands outside of an object"))?;
            match name {
                "vertex" => object.corners.push(corner(element)?),
                "triangle" => object.triangles.push(triangle(element)?),
                _ => object.components.push(reference(element)?),
            }
        }
        _ => {}
    }
    Ok(())
}

fn unit_m(element: &BytesStart<'_>) -> std::result::Result<f64, String> {
    let name = attribute(element, "unit")?;
    Ok(match name.as_deref().unwrap_or("millimeter") {
        "micron" => 1e-6,
        "millimeter" => 1e-3,
        "centimeter" => 1e-2,
        "inch" => 0.0254,
        "foot" => 0.3048,
        "meter" => 1.0,
        other => return Err(format!("'{}' is no unit of a 3MF", other.escape_debug())),
    })
}

fn corner(element: &BytesStart<'_>) -> std::result::Result<[f64; 3], String> {
    let mut corner = [0.0; 3];
    for (coordinate, name) in corner.iter_mut().zip(["x", "y", "z"]) {
        let text = needed(element, name)?;
        *coordinate = number(&text)
            .ok_or_else(|| format!("{name} is '{}', not a finite number", text.escape_debug()))?;
    }
    Ok(corner)
}

fn triangle(element: &BytesStart<'_>) -> std::result::Result<[usize; 3], String> {
    let mut triangle = [0; 3];
    for (index, name) in triangle.iter_mut().zip(["v1", "v2", "v3"]) {
        *index = whole(element, name)? as usize;
    }
    Ok(triangle)
}

fn reference(element: &BytesStart<'_>) -> std::result::Result<Reference, String> {
    let transform = match attribute(element, "transform")? {
        None => IN_PLACE,
        Some(text) => {
            let numbers: Option<Vec<f64>> = text.split_ascii_whitespace().map(number).collect();
            let numbers = numbers.and_then(|numbers| Transform::try_from(numbers).ok());
            numbers.ok_or_else(|| {
                format!(
                    "the transform '{}' is not twelve numbers",
                    text.escape_debug()
                )
            })?
        }
    };
    Ok(Reference {
        object: whole(element, "objectid")?,
        transform,
        path: attribute(element, "path")?,
    })
}

fn number(text: &str) -> Option<f64> {
    text.trim()
        .parse()
        .ok()
        .filter(|value: &f64| value.is_finite())
}

fn whole(element: &BytesStart<'_>, name: &str) -> std::result::Result<u32, String> {
    let text = needed(element, name)?;
    let wrong = |_| format!("{name} is '{}', not a whole number", text.escape_debug());
    text.trim().parse().map_err(wrong)
}

fn needed(element: &BytesStart<'_>, name: &str) -> std::result::Result<String, String> {
    let missing = || {
        format!(
            "'{}' has no {name}",
            element.local_name().as_ref().escape_debug()
        )
    };
    attribute(element, name)?.ok_or_else(missing)
}

/// The value of an attribute, in any namespace.
pub(super) fn attribute(
    element: &BytesStart<'_>,
    name: &str,
) -> std::result::Result<Option<String>, String> {
    for attribute in element.attributes() {
        let attribute = attribute.map_err(|error| format!("no valid XML: {error}"))?;
        if attribute.key.local_name().as_ref() == name {
            let value = attribute.normalized_value(Implicit1_0);
            let value = value.map_err(|error| format!("no valid XML: {error}"))?;
            return Ok(Some(value.into_owned()));
        }
    }
    Ok(None)
}
