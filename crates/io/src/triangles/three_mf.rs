//! 3MF -> facets: the objects that its items build, each at its place, in the unit of the file.
//! Our own code, on quick-xml and flate2, which the programs need anyway: the crate `threemf` does
//! not follow references to other files in the archive, which slicers write.

mod model;
mod zip;

use self::model::{IN_PLACE, Model, Object, Reference, Transform, attribute};
use self::zip::Archive;
pub(super) use self::zip::is_zip;
use crate::diagnostic::{Diagnostic, Result};
use crate::stl::{Facets, REMEDY_AGAIN, REMEDY_REPAIR};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::{BTreeMap, BTreeSet};

/// The file that names the main model.
const RELATIONS: &str = "_rels/.rels";
/// The main model if no file names it.
const USUAL_MODEL: &str = "3D/3dmodel.model";
/// Largest number of triangles and of objects that are built: objects that repeat others could
/// fill any memory.
const MOST_TRIANGLES: usize = 20_000_000;
const MOST_OBJECTS: usize = 100_000;
/// Largest number of objects within each other.
const DEEPEST: usize = 100;

/// Reads the triangles of all items.
pub(super) fn read(bytes: &[u8]) -> Result<Facets> {
    if !is_zip(bytes) {
        let problem = "not a 3MF: it is not a zip archive";
        return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
    }
    let archive = Archive::read(bytes)?;
    let main = main_model(&archive)?;
    let models = all_models(&archive, &main)?;
    let root = &models[&main];
    let mut built = Built::default();
    built.beside.extend(&root.not_printed);
    for item in &root.items {
        built.add(&models, &main, item, &IN_PLACE, 0)?;
    }
    let mut warnings = Vec::new();
    if !built.beside.is_empty() {
        let ids: Vec<String> = built.beside.iter().map(u32::to_string).collect();
        warnings.push(format!(
            "Objects that are supports, or not to be printed, were left out: {}.",
            ids.join(", ")
        ));
    }
    Ok(Facets {
        corners: built.corners,
        warnings,
        unit_m: Some(root.unit_m),
    })
}

/// The name of the main model.
fn main_model(archive: &Archive<'_>) -> Result<String> {
    if let Some(relations) = archive.file(RELATIONS) {
        let relations = relations?;
        let mut reader = Reader::from_reader(&relations[..]);
        // Where it is damaged, it names nothing.
        while let Ok(event) = reader.read_event() {
            match event {
                Event::Eof => break,
                Event::Start(element) | Event::Empty(element) => {
                    let value = |name| attribute(&element, name).ok().flatten();
                    let is_model = value("Type").is_some_and(|kind| kind.ends_with("/3dmodel"));
                    if let Some(target) = value("Target").filter(|_| is_model) {
                        return Ok(in_archive(&target));
                    }
                }
                _ => {}
            }
        }
    }
    let mut names = archive.names();
    let usual = names.find(|name| name.eq_ignore_ascii_case(USUAL_MODEL));
    let usual = usual.map(str::to_owned);
    usual.ok_or_else(|| {
        let problem = "a zip archive, but not a 3MF: it has no model";
        Diagnostic::input("", problem, "export the shape as 3MF, OBJ, PLY or STL")
    })
}

/// A name of a reference as the archive has it.
fn in_archive(name: &str) -> String {
    name.trim_start_matches('/').to_owned()
}

type Models = BTreeMap<String, Model>;

/// The model of this name, and all to which it refers.
fn all_models(archive: &Archive<'_>, main: &str) -> Result<Models> {
    let mut models = Models::new();
    let mut wanted = vec![main.to_owned()];
    while let Some(name) = wanted.pop() {
        if models.contains_key(&name) {
            continue;
        }
        let Some(bytes) = archive.file(&name) else {
            let problem = format!("the model '{}' is missing in it", name.escape_debug());
            return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
        };
        let model = model::read(&bytes?).map_err(|error| error.within(&name))?;
        let components = model.objects.values().flat_map(|object| &object.components);
        let others = components
            .chain(&model.items)
            .filter_map(|one| one.path.as_deref());
        wanted.extend(others.map(in_archive));
        models.insert(name, model);
    }
    let unit_m = models[main].unit_m;
    if let Some((other, _)) = models.iter().find(|(_, model)| model.unit_m != unit_m) {
        let problem = format!("'{}' has another unit than '{main}'", other.escape_debug());
        return Err(Diagnostic::input("", problem, "export the shape again"));
    }
    Ok(models)
}

/// What the items gave so far.
#[derive(Default)]
struct Built {
    corners: Vec<[[f64; 3]; 3]>,
    /// Numbers of objects that were left out.
    beside: BTreeSet<u32>,
    /// Objects so far, each as often as it is built.
    objects: usize,
}

impl Built {
    /// Adds an object that `reference` in the model `name` places, at the place `outer`. It is
    /// `depth` objects deep in an item.
    fn add(
        &mut self,
        models: &Models,
        name: &str,
        reference: &Reference,
        outer: &Transform,
        depth: usize,
    ) -> Result<()> {
        let id = reference.object;
        let name = reference
            .path
            .as_deref()
            .map_or(name.to_owned(), in_archive);
        let wrong = |problem: &str| {
            Diagnostic::input(format!("{name}: object {id}"), problem, REMEDY_REPAIR)
        };
        let object = models.get(&name).and_then(|model| model.objects.get(&id));
        let object = object.ok_or_else(|| wrong("it is named, but missing"))?;
        if object.is_beside {
            self.beside.insert(id);
            return Ok(());
        }
        if depth > DEEPEST {
            return Err(wrong("it is a part of itself"));
        }
        self.objects += 1;
        if self.objects > MOST_OBJECTS
            || self.corners.len() + object.triangles.len() > MOST_TRIANGLES
        {
            return Err(wrong("it is built too often: more than memory would hold"));
        }
        let place = joined(&reference.transform, outer);
        self.add_triangles(object, &place)
            .map_err(|problem| wrong(&problem))?;
        for component in &object.components {
            self.add(models, &name, component, &place, depth + 1)?;
        }
        Ok(())
    }

    fn add_triangles(
        &mut self,
        object: &Object,
        place: &Transform,
    ) -> std::result::Result<(), String> {
        let is_mirrored = determinant(place) < 0.0;
        for (at, triangle) in object.triangles.iter().enumerate() {
            let mut facet = [[0.0; 3]; 3];
            for (corner, index) in facet.iter_mut().zip(triangle) {
                let Some(found) = object.corners.get(*index) else {
                    return Err(format!(
                        "triangle {} names corner {index}, and there are {}, from 0",
                        at + 1,
                        object.corners.len()
                    ));
                };
                *corner = moved(found, place);
            }
            if facet.as_flattened().iter().any(|x| !x.is_finite()) {
                return Err(format!("triangle {} is at no finite place", at + 1));
            }
            if is_mirrored {
                facet.swap(1, 2);
            }
            self.corners.push(facet);
        }
        Ok(())
    }
}

/// Exact where the place is that of the file.
fn moved(point: &[f64; 3], place: &Transform) -> [f64; 3] {
    let [x, y, z] = *point;
    [0, 1, 2].map(|k| x * place[k] + y * place[3 + k] + z * place[6 + k] + place[9 + k])
}

/// The transform that does `first`, then `second`.
fn joined(first: &Transform, second: &Transform) -> Transform {
    let mut joined = [0.0; 12];
    for (row, numbers) in first.as_chunks::<3>().0.iter().enumerate() {
        let mut place = *second;
        if row < 3 {
            // Directions are turned, not moved.
            place[9..].fill(0.0);
        }
        joined[3 * row..3 * row + 3].copy_from_slice(&moved(numbers, &place));
    }
    joined
}

fn determinant(t: &Transform) -> f64 {
    t[0] * (t[4] * t[8] - t[5] * t[7]) - t[1] * (t[3] * t[8] - t[5] * t[6])
        + t[2] * (t[3] * t[7] - t[4] * t[6])
}
