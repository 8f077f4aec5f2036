//! A scene's text with other values in it; comments and order are kept. Besides
//! [`tree`](crate::tree) the only module that uses the TOML parser.

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use super::check::scene_with;
use super::contents::{BODY, Setting, Study};
use crate::body::BodySource;
use crate::read::scene_from_text;
use crate::root::Scene;
use crate::toml_text::{key, quoted, toml};
use crate::tree::{Value, parse_value};
use dem_io::diagnostic::{Diagnostic, Result};

/// The text of a scene file `target` that is the scene of `study`, whose file contains `text`, with
/// `settings`. Read back it is the same scene. Refuses a scene written in a way that does not allow
/// to insert them.
pub fn rewritten(
    study: &Study,
    text: &str,
    settings: &[&Setting],
    target: &Path,
) -> Result<String> {
    let wanted = scene_with(study, text, settings.iter().copied())?;
    let cannot = || {
        Diagnostic::input(
            target.display().to_string(),
            format!(
                "the scene {} is written in a way in which its values cannot be replaced",
                study.scene.display()
            ),
            "write it beside that scene, whose files it needs, or run that scene with the options of the sweep",
        )
    };
    let mut new = text.to_owned();
    let is_beside = target.parent() == study.scene.parent();
    for (name, body) in &wanted.bodies {
        let varies = settings
            .iter()
            .any(|s| s.path.strip_prefix(BODY) == Some(name));
        if let (BodySource::File(path), true) = (&body.source, varies || !is_beside) {
            for inline in ["particles", "bond_list"] {
                new = without(&new, &["bodies", name, inline]).ok_or_else(cannot)?;
            }
            let file = quoted(&absolute(path).display().to_string());
            new = with(&new, &["bodies", name, "file"], &file).ok_or_else(cannot)?;
        }
    }
    for setting in settings.iter().filter(|s| !s.path.starts_with(BODY)) {
        let keys: Vec<&str> = setting.path.split('.').collect();
        new = with(&new, &keys, &setting.value).ok_or_else(cannot)?;
    }
    let read = scene_from_text(&new, &target.display().to_string(), &[]).map_err(|_| cannot())?;
    if comparable(read) == comparable(wanted) {
        Ok(new)
    } else {
        Err(cannot())
    }
}

/// A scene without the parts that depend on the place of its file.
fn comparable(mut scene: Scene) -> Scene {
    scene.source.clear();
    scene.notes.clear();
    for body in scene.bodies.values_mut() {
        if let BodySource::File(path) = &mut body.source {
            *path = absolute(path);
        }
    }
    if let Some(output) = &mut scene.output {
        output.folder = None;
    }
    scene
}

/// The absolute path. The name may be that of a body in two files, whose names differ slightly.
fn absolute(path: &Path) -> PathBuf {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// The place of an item in a text, in bytes.
struct Found {
    key: Range<usize>,
    value: Range<usize>,
    is_table: bool,
}

/// The items at the ends of ever longer parts of a path, as far as it exists.
fn way(text: &str, keys: &[&str]) -> Option<Vec<Found>> {
    let root = DeTable::parse(text).ok()?;
    let mut table = root.get_ref();
    let mut found = Vec::new();
    for key in keys {
        let entry = table.iter().find(|(name, _)| name.get_ref() == key);
        let Some((name, value)) = entry else { break };
        let inner = match value.get_ref() {
            DeValue::Table(inner) => Some(inner),
            _ => None,
        };
        found.push(Found {
            key: name.span(),
            value: value.span(),
            is_table: inner.is_some(),
        });
        match inner {
            Some(inner) => table = inner,
            None => break,
        }
    }
    Some(found)
}

/// `text` with `value` at the end of the path `keys`. None if it cannot be put there.
fn with(text: &str, keys: &[&str], value: &str) -> Option<String> {
    let way = way(text, keys)?;
    let is_inline = |found: &Found| text[found.value.clone()].starts_with('{');
    if way.len() == keys.len() {
        let found = way.last()?;
        if found.is_table && !is_inline(found) {
            return with_section(text, keys, value);
        }
        return Some(spliced(text, found.value.clone(), value));
    }
    let rest: Vec<String> = keys[way.len()..].iter().map(|name| key(name)).collect();
    let entry = format!("{} = {value}", rest.join("."));
    match way.last() {
        Some(parent) if !parent.is_table => None,
        Some(parent) if is_inline(parent) => {
            let end = parent.value.end - 1;
            let inside = text[parent.value.start + 1..end].trim_end();
            let comma = match inside.trim() {
                "" => " ",
                some if some.ends_with(',') => " ",
                _ => ", ",
            };
            let start = parent.value.start + 1 + inside.len();
            Some(spliced(text, start..end, &format!("{comma}{entry} ")))
        }
        _ => {
            let parent = header(&keys[..way.len()]);
            let mut start = 0;
            for line in text.split_inclusive('\n') {
                start += line.len();
                if !way.is_empty() && header_of(line) == Some(parent.as_str()) {
                    let newline = if line.ends_with('\n') { "" } else { "\n" };
                    return Some(spliced(text, start..start, &format!("{newline}{entry}\n")));
                }
            }
            let (last, table) = keys.split_last()?;
            let table = header(table);
            let last = key(last);
            Some(format!(
                "{}\n\n[{table}]\n{last} = {value}\n",
                text.trim_end()
            ))
        }
    }
}

/// `text` in which the tables `[keys]` and those within are replaced by one with the entries of
/// `value`, which is a table as well.
fn with_section(text: &str, keys: &[&str], value: &str) -> Option<String> {
    let Value::Table(entries) = parse_value(value, 0).ok()?.value else {
        return None;
    };
    let name = header(keys);
    let within = format!("{name}.");
    let mut new = String::new();
    let mut is_left_out = false;
    for line in text.split_inclusive('\n') {
        if let Some(other) = header_of(line) {
            is_left_out = other == name || other.starts_with(&within);
        }
        if !is_left_out {
            new += line;
        }
    }
    new = format!("{}\n\n[{name}]\n", new.trim_end());
    for (name, node) in &entries {
        new += &format!("{} = {}\n", key(name), toml(node));
    }
    Some(new)
}

/// `text` without a key and its value, if it is there. None if it cannot be read.
fn without(text: &str, keys: &[&str]) -> Option<String> {
    let way = way(text, keys)?;
    let Some(found) = way.get(keys.len() - 1) else {
        return Some(text.to_owned());
    };
    let rest = &text[found.value.end..];
    let line = rest.find('\n').map_or(rest.len(), |at| at + 1);
    Some(spliced(text, found.key.start..found.value.end + line, ""))
}

fn spliced(text: &str, range: Range<usize>, new: &str) -> String {
    format!("{}{new}{}", &text[..range.start], &text[range.end..])
}

fn header(keys: &[&str]) -> String {
    let keys: Vec<String> = keys.iter().map(|name| key(name)).collect();
    keys.join(".")
}

/// `a.b` of a line `[a.b]`.
fn header_of(line: &str) -> Option<&str> {
    let line = line.split('#').next()?.trim();
    line.strip_prefix('[')?.strip_suffix(']')
}
