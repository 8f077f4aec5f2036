//! The values of a study, applied to its scene.

use std::path::PathBuf;

use super::contents::{BODY, MeasureOf, PACK, Pieces, Reference, Setting, Study};
use super::values::in_si;
use crate::blame::guilty;
use crate::measure::Measure;
use crate::names::suggestion;
use crate::read::scene_from_text;
use crate::root::SCENE;
use crate::root::Scene;
use crate::schema::{Key, Kind};
use crate::table::Table;
use crate::tree::Document;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::units::quantity;

/// The scene of `study`, whose file contains `text`, with these values applied.
pub fn scene_with<'a>(
    study: &Study,
    text: &str,
    settings: impl Iterator<Item = &'a Setting>,
) -> Result<Scene> {
    let name = study.scene.display().to_string();
    let document = Document::parse(&name, text)?;
    let root = Table::root(&document, &SCENE)?;
    let (mut overrides, mut places, mut files) = (Vec::new(), Vec::new(), Vec::new());
    for setting in settings.filter(|setting| !setting.path.starts_with(PACK)) {
        match setting.path.strip_prefix(BODY) {
            Some(body) => files.push((body, setting)),
            None => {
                refuse_new_name(&root, setting)?;
                overrides.push(override_text(setting));
                places.push(&setting.place);
            }
        }
    }
    let read = |overrides: &[String]| scene_from_text(text, &name, overrides);
    let mut scene = read(&overrides).map_err(|error| {
        let said = |count: usize| read(&overrides[..count]).err();
        match guilty(&error, overrides.len(), &said) {
            Some(at) => error.within(places[at]),
            None => error.within(&study.source),
        }
    })?;
    for (body, setting) in files {
        let names = scene.declared_bodies();
        if !names.contains(body) {
            return Err(Diagnostic::input(
                &setting.place,
                format!("the scene {name} has no body '{body}'"),
                suggestion(body, names.into_iter()),
            ));
        }
        let path = PathBuf::from(&setting.value);
        let parts = dem_io::body::files::body_files(&path);
        let parts = parts.map_err(|error| error.within(&setting.place))?;
        // It is made before the run.
        let is_packed = study.packs.iter().any(|pack| pack.body == body);
        if !is_packed && let Some(missing) = parts.iter().find(|part| !part.exists()) {
            return Err(Diagnostic::input(
                &setting.place,
                format!("there is no file {}", missing.display()),
                "make it with dem-pack, or correct the name, which counts from the study's folder",
            ));
        }
        scene.set_body_file(body, &path);
    }
    Ok(scene)
}

/// `PATH=VALUE`, as for `--set`.
pub fn override_text(setting: &Setting) -> String {
    format!("{}={}", setting.path, setting.value)
}

/// Refuses a path into a table `[kind.NAME]` that the scene does not have: the scene would take it
/// for a new one.
fn refuse_new_name(root: &Table<'_>, setting: &Setting) -> Result<()> {
    let keys: Vec<&str> = setting.path.split('.').collect();
    let [kind, name, _, ..] = keys.as_slice() else {
        return Ok(());
    };
    let is_named = |key: &Key| matches!(key.kind, Kind::Named(..));
    if !SCENE.key(kind).is_some_and(is_named) {
        return Ok(());
    }
    let known: Vec<String> = match root.get(kind) {
        Some(field) => {
            let table = Table::any(&field)?;
            table.entries.iter().map(|(name, _)| name.clone()).collect()
        }
        None => Vec::new(),
    };
    if known.iter().any(|other| other == name) {
        return Ok(());
    }
    let scene = &root.document.name;
    Err(Diagnostic::input(
        &setting.place,
        format!("{}: the scene {scene} has no [{kind}.{name}]", setting.path),
        suggestion(name, known.iter().map(String::as_str)),
    ))
}

/// Gives the measures without a word on their reference that of the scene's measure if it has one,
/// and none otherwise. `scene` is that of the first run.
pub fn settle_references(study: &mut Study, scene: &Scene) {
    for measure in &mut study.measures {
        let MeasureOf::Measure(of) = &measure.of else {
            continue;
        };
        let has_one = (scene.measures.get(of)).is_some_and(|found| found.reference.is_some());
        measure.reference = match (measure.reference.clone(), has_one) {
            (Reference::IfAny, true) => Reference::ClosedForm,
            (Reference::IfAny, false) => Reference::None,
            (given, _) => given,
        };
    }
}

/// The reference of each measure of a study in one of its scenes, in SI, if it is known without a
/// run.
///
/// # Errors
/// The scene has no such measure or no test; a reference is missing or of another quantity.
pub fn reference_values(study: &Study, scene: &Scene) -> Result<Vec<Option<f64>>> {
    let mut values = Vec::new();
    for measure in &study.measures {
        let refuse = |problem: String, remedy: String| {
            Err(Diagnostic::input(&measure.place, problem, remedy))
        };
        let name = &measure.name;
        let of_scene = match &measure.of {
            MeasureOf::Measure(of) => match scene.measures.get(of) {
                Some(found) => Some(found),
                None => {
                    let known = scene.measures.keys().map(String::as_str);
                    let problem = format!("the scene {} has no measure '{of}'", scene.source);
                    return refuse(problem, suggestion(of, known));
                }
            },
            MeasureOf::Masses(Pieces::Left) if scene.outlets.is_empty() => {
                let problem = format!(
                    "measures.{name}.fragment_masses is \"discharged\", but the scene {} has no [outlets]",
                    scene.source
                );
                return refuse(problem, "write fragment_masses = \"remaining\"".to_owned());
            }
            MeasureOf::Discharge(_, outlet) => {
                let known = scene.outlets.keys().map(String::as_str);
                let scene = &scene.source;
                match outlet {
                    Some(of) if !known.clone().any(|name| name == of) => {
                        let problem = format!(
                            "measures.{name}.outlet: the scene {scene} has no outlet '{of}'"
                        );
                        return refuse(problem, suggestion(of, known));
                    }
                    None if known.count() == 0 => {
                        let problem = format!(
                            "measures.{name} is of what left, but the scene {scene} has no [outlets]"
                        );
                        return refuse(problem, "write a run_result".to_owned());
                    }
                    _ => None,
                }
            }
            MeasureOf::Curve if scene.test.is_none() => {
                let problem = format!(
                    "measures.{name}.curve is that of a test, but the scene {} has no [test]",
                    scene.source
                );
                return refuse(problem, "name a measure of the scene".to_owned());
            }
            MeasureOf::Figure(of) if scene.test.is_none() => {
                let problem = format!(
                    "measures.{name}.test_result is '{of}', but the scene {} has no [test]",
                    scene.source
                );
                return refuse(problem, "name a measure of the scene".to_owned());
            }
            _ => None,
        };
        values.push(match (&measure.reference, of_scene) {
            (Reference::Value(text), _) => {
                let value = in_unit_of(text, of_scene).map_err(|error| {
                    error.within(&format!("{}: measures.{name}.reference", measure.place))
                });
                Some(value?)
            }
            (Reference::IfAny, Some(of)) => of.reference,
            (Reference::ClosedForm, Some(of)) => {
                if of.reference.is_none() {
                    let problem = format!("measures.{name} has no reference: that of the scene says none");
                    let remedy = "add reference = { value = ... }, \"finest\" or \"richardson\", or one in the scene";
                    return refuse(problem, remedy.to_owned());
                }
                of.reference
            }
            _ => None,
        });
    }
    Ok(values)
}

/// The value of `[find]`, or the limit of `[probability]`, in the unit of its measure, if the study
/// has such a table.
pub fn value_to_find(study: &Study, scene: &Scene) -> Result<Option<f64>> {
    let (measure, written, place) = match (&study.find, &study.probability) {
        (Some(find), _) => (
            find.measure,
            &find.value,
            format!("{}: find.value", find.place),
        ),
        (None, Some(of)) => {
            let key = if of.is_below { "below" } else { "above" };
            let place = format!("{}: probability.{key}", of.place);
            (of.measure, &of.limit, place)
        }
        (None, None) => return Ok(None),
    };
    let of_scene = match &study.measures[measure].of {
        MeasureOf::Measure(of) => scene.measures.get(of),
        _ => None,
    };
    let value = in_unit_of(written, of_scene);
    value.map(Some).map_err(|error| error.within(&place))
}

/// A value as written, in the unit of the scene's measure, or in SI for other results.
fn in_unit_of(text: &str, measure: Option<&Measure>) -> Result<f64> {
    match measure {
        Some(measure) => quantity(text, measure.quantity.dimension),
        None => in_si(text).ok_or_else(|| {
            let problem = format!("'{text}' is no number with a unit");
            Diagnostic::input("", problem, "write it in SI, without one")
        }),
    }
}
