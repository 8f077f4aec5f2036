//! A scene from its text: the order in which the tables are read, and the relations between them.

use std::collections::BTreeMap;
use std::path::Path;

use super::blame::guilty;
use super::conflicts::STATIC;
use super::include::{INCLUDE, document_of, folder_of};
use super::paths::text_of;
use super::presence::Presence;
use super::root::{SCENE, SCENE_VERSION, Scene};
use super::table::Table;
use super::targets::Targets;
use super::test::Test;
use super::tree::{Document, option_place};
use super::{
    body, bond, clusters, contact, contact_beside_bond, fall_check, feed_sizes, group, initial,
    inlet, load, material, measure, outlet, output, region, relaxation, replacement, run, search,
    sleep, support, test, wall, zone_check,
};
use crate::field::Field;
use dem_io::diagnostic::Result;

/// Reads a scene from a TOML file. `overrides` are `KEY=VALUE` texts that override its values, as
/// in `run.end_time="0.5 s"`; a value that is not TOML is text. File names in the scene are
/// resolved against its folder, those in `overrides` against the current one; "-" stays.
///
/// # Errors
/// The file cannot be read, is not TOML, or cannot be simulated. The place is file and line, or the
/// option; both if the scene is refused at a line of the file because of an option.
pub fn read_scene(path: &Path, overrides: &[String]) -> Result<Scene> {
    let text = text_of(path, "a scene")?;
    let name = path.display().to_string();
    let read = |overrides: &[String]| scene_from_text(&text, &name, overrides);
    read(overrides).map_err(|error| {
        let said = |count: usize| read(&overrides[..count]).err();
        let names_an_option = error.place.starts_with("--");
        match guilty(&error, overrides.len(), &said).filter(|_| !names_an_option) {
            // Files of materials are not given as --set.
            Some(at) if !overrides[at].starts_with(INCLUDE) => {
                error.within(&option_place(&overrides[at]))
            }
            _ => error,
        }
    })
}

/// Reads a scene from the text of a file named `source`, as [`read_scene`] does.
pub fn scene_from_text(text: &str, source: &str, overrides: &[String]) -> Result<Scene> {
    let (document, included) = document_of(text, source, overrides)?;
    let root = root(&document)?;
    let folder = folder_of(source);

    let run = run::read(&root)?;
    let materials = each(&root, "materials", material::read)?;
    let bonds = each(&root, "bonds", bond::read)?;
    let regions = each(&root, "regions", |field| region::read(field, folder))?;
    let mut bodies = body::read_all(&root, &materials, &bonds, &regions, folder)?;
    let contacts = contact::read_all(&root, &materials)?;
    let mut replacement = replacement::read_all(&root, &bodies, &materials, &regions)?;
    let mut inlets = inlet::read_all(&root, folder, &bodies, &regions, &replacement)?;
    feed_sizes::expand(&root, &mut inlets, &mut bodies, &mut replacement)?;
    let outlets = each(&root, "outlets", |field| {
        outlet::read(field, &regions, &inlets)
    })?;
    let presence = Presence {
        bodies: &bodies,
        inlets: &inlets,
        replacement: &replacement,
    };
    let groups = group::read_all(&root, &presence)?;
    let walls = wall::read_all(&root, &materials, &bodies, &groups, folder)?;
    let of_zones = zone_check::Known {
        bodies: &bodies,
        bonds: &bonds,
        inlets: &inlets,
        walls: &walls,
    };
    zone_check::check(&root, &of_zones)?;
    fall_check::refuse_falls(&root, &run, &bodies, &walls, &inlets)?;
    let targets = Targets {
        groups: &groups,
        presence: &presence,
        walls: &walls,
    };
    let supports = each(&root, "supports", |field| support::read(field, &targets))?;
    let known = test::Known {
        folder,
        run: &run,
        presence: &presence,
        groups: &groups,
        walls: &walls,
        supports: &supports,
    };
    let test = root.read_by("test", |field| test::read(&field, &known))?;
    contact_beside_bond::refuse_others(&root)?;
    STATIC.refuse(&root, &root)?;
    Ok(Scene {
        source: source.to_owned(),
        included,
        notes: notes(&root, test.as_ref())?,
        run,
        materials,
        bonds,
        supports,
        initial: each(&root, "initial", |field| initial::read(field, &targets))?,
        loads: each(&root, "loads", |field| load::read(field, &targets))?,
        measures: each(&root, "measures", |field| {
            measure::read(field, &targets, &regions)
        })?,
        clusters: clusters::read(&root)?,
        relaxation: relaxation::read(&root)?,
        search: search::read(&root)?,
        sleep: root.read_by("sleep", |field| sleep::read(&field))?,
        output: root.read_by("output", |field| output::read(&field, folder))?,
        test,
        contacts,
        bodies,
        walls,
        groups,
        regions,
        replacement,
        inlets,
        outlets,
    })
}

/// The tables of a scene, all of them known, in a version that this program knows.
fn root(document: &Document) -> Result<Table<'_>> {
    let root = Table::root(document, &SCENE)?;
    check_version(&root)?;
    root.refuse_unknown()?;
    Ok(root)
}

/// Notes on the text of the scene, and on what goes ill with its test.
fn notes(root: &Table<'_>, test: Option<&Test>) -> Result<Vec<String>> {
    let mut notes = root.document.notes.clone();
    if let Some(field) = root.get("test") {
        notes.extend(test::conflicts(&field, test)?);
    }
    Ok(notes)
}

fn check_version(root: &Table<'_>) -> Result<()> {
    let field = root.need_such("version", &SCENE_VERSION.to_string())?;
    let remedy = format!("write version = {SCENE_VERSION}");
    let version = field.whole(0, Some(u64::MAX), &remedy)?;
    if version > SCENE_VERSION {
        let problem = format!("version is {version}, but this program knows up to {SCENE_VERSION}");
        return Err(field.refuse(problem, "use a newer program"));
    }
    if version == 0 {
        return Err(field.wrong("at least 1", remedy));
    }
    Ok(())
}

/// Every `[key.NAME]`, by name.
fn each<'a, T>(
    root: &Table<'a>,
    key: &str,
    read: impl Fn(&Field<'a>) -> Result<T>,
) -> Result<BTreeMap<String, T>> {
    let tables = root.named(key)?.into_iter();
    tables
        .map(|(name, field)| Ok((name, read(&field)?)))
        .collect()
}
