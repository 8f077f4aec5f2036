//! A scene as it is run: its text with included files and `--set` values in it, and with the paths
//! of its files as seen from another folder.

use std::path::{Component, Path, PathBuf, absolute};

use super::body::BodySource;
use super::include::{INCLUDE, document_of};
use super::region::Region;
use super::root::Scene;
use super::toml_text::{key, toml};
use super::tree::{Node, Origin, Value};
use super::wall::WallShape;
use dem_io::diagnostic::Result;

type Entries = Vec<(String, Node)>;

/// The text of a scene in the folder `to` that is `scene`, which was read from `text` with
/// `overrides`; the bodies of `scene` may have other files by now. Read in that folder, it gives
/// the same scene without the folder of its output. Standard input stays "-".
pub fn scene_as_run(text: &str, scene: &Scene, overrides: &[String], to: &Path) -> Result<String> {
    let (mut document, _) = document_of(text, &scene.source, overrides)?;
    let Value::Table(root) = &mut document.root.value else {
        return Ok(String::new());
    };
    root.retain(|(name, _)| name != INCLUDE);
    set_paths(root, scene, to);
    if let Some(output) = table(root, "output") {
        output.retain(|(name, _)| name != "folder");
    }
    Ok(written(root))
}

fn set_paths(root: &mut Entries, scene: &Scene, to: &Path) {
    for (name, body) in &scene.bodies {
        let name = body.class_of.as_ref().unwrap_or(name);
        if let (BodySource::File(file), Some(entry)) = (&body.source, entry(root, "bodies", name)) {
            entry.retain(|(name, _)| !["particles", "bond_list"].contains(&name.as_str()));
            set_path(entry, "file", file, to);
        }
    }
    for (name, wall) in &scene.walls {
        if let (WallShape::Stl { path, .. }, Some(entry)) =
            (&wall.shape, entry(root, "walls", name))
        {
            set_path(entry, "stl", path, to);
        }
    }
    for (name, region) in &scene.regions {
        if let (Region::Stl { file, .. }, Some(entry)) = (region, entry(root, "regions", name)) {
            set_path(entry, "stl", file, to);
        }
    }
    for (name, inlet) in &scene.inlets {
        if let (Some(sizes), Some(entry)) = (&inlet.sizes, entry(root, "inlets", name)) {
            set_path(entry, "sizes", &sizes.file, to);
        }
    }
    let measured = scene.test.as_ref().and_then(|test| test.measured.as_ref());
    if let (Some(measured), Some(test)) = (measured, table(root, "test")) {
        let is_option = |node: &Node| matches!(node.origin, Origin::Option(_));
        if (test.iter()).any(|(name, node)| name == "measured" && is_option(node)) {
            // Its numbers stand above those of the scene.
            let has_modulus = measured.material.young_modulus_pa.is_some();
            test.retain(|(name, node)| match name.as_str() {
                "young_modulus" => is_option(node) || !has_modulus,
                "strength" => is_option(node),
                _ => true,
            });
        }
        set_path(test, "measured", &measured.file, to);
    }
}

fn table<'a>(entries: &'a mut Entries, name: &str) -> Option<&'a mut Entries> {
    let found = entries.iter_mut().find(|(other, _)| other == name);
    match &mut found?.1.value {
        Value::Table(entries) => Some(entries),
        _ => None,
    }
}

fn entry<'a>(root: &'a mut Entries, kind: &str, name: &str) -> Option<&'a mut Entries> {
    table(table(root, kind)?, name)
}

fn set_path(entries: &mut Entries, name: &str, file: &Path, to: &Path) {
    let value = Value::Text(path_from(to, file));
    match entries.iter_mut().find(|(other, _)| other == name) {
        Some((_, node)) => node.value = value,
        None => {
            let origin = Origin::Line(0);
            entries.push((name.to_owned(), Node { origin, value }));
        }
    }
}

/// The path of a file, relative to the working directory, as seen from a folder: relative to it,
/// with `/` on every system; absolute where the two have no common root. "-" stays.
fn path_from(folder: &Path, file: &Path) -> String {
    if file == Path::new("-") {
        return "-".to_owned();
    }
    // `..` after a link leads elsewhere than its text says.
    let folder = folder.canonicalize().or_else(|_| absolute(folder));
    let parent = file.parent().filter(|parent| *parent != Path::new(""));
    let parent = parent.unwrap_or(Path::new("."));
    let parent = parent.canonicalize().or_else(|_| absolute(parent));
    let (Ok(folder), Ok(parent)) = (folder, parent) else {
        return file.display().to_string();
    };
    let name = file.file_name().unwrap_or_default();
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (folder.components().collect(), parent.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return parent.join(name).display().to_string();
    }
    let mut path: Vec<String> = vec!["..".to_owned(); from.len() - common];
    let below: PathBuf = to[common..].iter().collect();
    let text = |part: Component<'_>| part.as_os_str().to_string_lossy().into_owned();
    path.extend(below.join(name).components().map(text));
    path.join("/")
}

/// The text of a scene: a line for each value, a table for each object with a name.
fn written(root: &Entries) -> String {
    let line = |(name, node): &(String, Node)| format!("{} = {}\n", key(name), toml(node));
    let mut text = String::new();
    let is_table = |node: &Node| matches!(node.value, Value::Table(_));
    text.extend(root.iter().filter(|(_, node)| !is_table(node)).map(line));
    for (name, node) in root {
        let Value::Table(entries) = &node.value else {
            continue;
        };
        let has_objects = name != "contacts" && entries.iter().all(|(_, node)| is_table(node));
        if !has_objects || entries.is_empty() {
            text.push_str(&format!("\n[{}]\n", key(name)));
            text.extend(entries.iter().map(line));
            continue;
        }
        for (object, node) in entries {
            text.push_str(&format!("\n[{}.{}]\n", key(name), key(object)));
            if let Value::Table(values) = &node.value {
                text.extend(values.iter().map(line));
            }
        }
    }
    text
}

/// The names of bodies that are read from standard input.
pub fn piped_bodies(scene: &Scene) -> Vec<&str> {
    let bodies = scene.bodies.iter();
    let piped = bodies.filter(
        |(_, body)| matches!(&body.source, BodySource::File(file) if file == Path::new("-")),
    );
    piped.map(|(name, _)| name.as_str()).collect()
}
