//! A scene from its text: the order in which the tables are read, and what holds between them.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::presence::Presence;
use super::table::Table;
use super::targets::Targets;
use super::tree::{Document, Origin};
use super::{
    Integrator, SCENE_VERSION, Scene, body, bond, clusters, contact, initial, inlet, load,
    material, measure, outlet, output, region, relaxation, replacement, run, search, set, sleep,
    statics, support, test, wall,
};
use crate::scene::field::Field;
use crate::{Diagnostic, Result};

/// The tables of a scene.
const KEYS: [&str; 22] = [
    "version",
    "run",
    "materials",
    "contacts",
    "bonds",
    "bodies",
    "walls",
    "sets",
    "initial",
    "supports",
    "loads",
    "regions",
    "replacement",
    "inlets",
    "outlets",
    "measures",
    "clusters",
    "relaxation",
    "search",
    "sleep",
    "output",
    "test",
];

/// Reads a scene from a TOML file. `overrides` are `KEY=VALUE` texts laid over it, as in
/// `run.end_time="0.5 s"`; a value that is no TOML is text. File names in the scene are resolved
/// against its folder, those in `overrides` against the current one; "-" stays.
///
/// # Errors
/// The file cannot be read, is no TOML, or cannot be simulated. The place is file and line, or the
/// option.
pub fn read_scene(path: &Path, overrides: &[String]) -> Result<Scene> {
    let text = text_of(path, "a scene")?;
    scene_from_text(&text, &path.display().to_string(), overrides)
}

/// Largest file of a scene or study, bytes: what is larger is something else, or has no end.
const MOST_BYTES: u64 = 1 << 28;

/// The text of a file that holds `what`.
///
/// # Errors
/// It cannot be read, or is not text.
pub fn text_of(path: &Path, what: &str) -> Result<String> {
    let name = path.display().to_string();
    let read = || -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(path)?
            .take(MOST_BYTES + 1)
            .read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = read().map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            Diagnostic::input(&name, "there is no such file", "check its name and folder")
        }
        ErrorKind::IsADirectory => {
            Diagnostic::input(&name, "this is a folder", format!("name {what} in it"))
        }
        _ => {
            let remedy = "check the name and its permissions";
            Diagnostic::input(&name, format!("cannot be read: {error}"), remedy)
        }
    })?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Diagnostic::input(
            &name,
            format!("this is larger than {} MB", MOST_BYTES >> 20),
            format!("name {what}; particles belong into a file of their own"),
        ));
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + good.iter().filter(|byte| **byte == b'\n').count();
        let remedy = "save the file as plain text in UTF-8";
        Diagnostic::input(format!("{name}:{line}"), "this is not text", remedy)
    })
}

/// Reads a scene from the text of a file named `source`, as [`read_scene`] does.
///
/// # Errors
/// Those of [`read_scene`], but for reading the file.
pub fn scene_from_text(text: &str, source: &str, overrides: &[String]) -> Result<Scene> {
    let mut document = Document::parse(source, text)?;
    for text in overrides {
        document.set(text)?;
    }
    let root = Table::root(&document)?;
    check_version(&root)?;
    root.refuse_unknown(&KEYS)?;
    let folder = Path::new(source).parent().unwrap_or(Path::new(""));

    let run = run::read(&root)?;
    let materials = each(&root, "materials", material::read)?;
    let bonds = each(&root, "bonds", bond::read)?;
    let bodies = body::read_all(&root, &materials, &bonds, folder)?;
    let contacts = contact::read_all(&root, &materials)?;
    let regions = each(&root, "regions", |field| region::read(field, folder))?;
    let replacement = replacement::read_all(&root, &bodies, &regions)?;
    let inlets = inlet::read_all(&root, &bodies, &regions)?;
    let outlets = each(&root, "outlets", |field| {
        outlet::read(field, &regions, &inlets)
    })?;
    let presence = Presence {
        bodies: &bodies,
        inlets: &inlets,
    };
    let sets = set::read_all(&root, &presence)?;
    let walls = wall::read_all(&root, &materials, &bodies, &sets, folder)?;
    let targets = Targets {
        sets: &sets,
        presence: &presence,
        walls: &walls,
    };
    let supports = each(&root, "supports", |field| support::read(field, &targets))?;
    let known = test::Known {
        presence: &presence,
        sets: &sets,
        walls: &walls,
        supports: &supports,
    };
    let test = root.read("test", |field| test::read(&field, &known))?;
    if run.integrator == Integrator::Static {
        statics::refuse_what_moves(&root)?;
    }
    Ok(Scene {
        source: source.to_owned(),
        run,
        materials,
        bonds,
        supports,
        initial: each(&root, "initial", |field| initial::read(field, &targets))?,
        loads: each(&root, "loads", |field| load::read(field, &targets))?,
        measures: each(&root, "measures", |field| measure::read(field, &targets))?,
        clusters: root
            .read("clusters", |field| clusters::read(&field))?
            .unwrap_or_default(),
        relaxation: root
            .read("relaxation", |field| relaxation::read(&field))?
            .unwrap_or_default(),
        search: root
            .read("search", |field| search::read(&field))?
            .unwrap_or_default(),
        sleep: root.read("sleep", |field| sleep::read(&field))?,
        output: root.read("output", |field| output::read(&field, folder))?,
        test,
        contacts,
        bodies,
        walls,
        sets,
        regions,
        replacement,
        inlets,
        outlets,
    })
}

fn check_version(root: &Table<'_>) -> Result<()> {
    let field = root.need("version", &SCENE_VERSION.to_string())?;
    let remedy = format!("write version = {SCENE_VERSION}");
    let version = field.whole(u64::MAX, &remedy)?;
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

/// The file or folder that `field` names. Names in the file are resolved against its folder; names
/// on the command line are meant from where the program runs. "-" stays.
///
/// # Errors
/// No text, or empty.
pub(super) fn named_path(field: &Field<'_>, folder: &Path) -> Result<PathBuf> {
    let name = field.text()?;
    if name.trim().is_empty() {
        return Err(field.wrong("a name", "write a name such as \"cake.vtp\""));
    }
    let as_it_stands = name == "-" || matches!(field.node.origin, Origin::Option(_));
    Ok(if as_it_stands {
        PathBuf::from(name)
    } else {
        folder.join(name)
    })
}
