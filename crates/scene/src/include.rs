//! `include`: materials, contacts and bonds from other files, such as those that `dem-run
//! calibrate` writes.

use std::path::{Path, PathBuf};

use super::field::Field;
use super::merge::{Conflict, join, take};
use super::paths::{named_path, text_of};
use super::root::SCENE;
use super::table::Table;
use super::toml_text::{key, quoted, split, toml};
use super::tree::{Document, Node, Origin, Value, parse_tables};
use dem_io::diagnostic::{Diagnostic, Result};

/// Tables that another file may add.
const TABLES: [&str; 3] = ["materials", "contacts", "bonds"];
pub(super) const INCLUDE: &str = "include";
/// The key of `--set` by which files are added to those of the scene.
const INCLUDE_TOO: &str = "include+";

/// A scene's text with its included files and its `--set` values, and the paths of these files.
pub(super) fn document_of(
    text: &str,
    source: &str,
    overrides: &[String],
) -> Result<(Document, Vec<PathBuf>)> {
    let mut document = Document::parse(source, text)?;
    let path = |text: &str| text.split_once('=').map(|(path, _)| path.trim().to_owned());
    let sets_include =
        |text: &&String| path(text).is_some_and(|path| path == INCLUDE || path == INCLUDE_TOO);
    let (first, others): (Vec<&String>, Vec<&String>) = overrides.iter().partition(sets_include);
    for text in first {
        let before = entry(&document.root, INCLUDE).cloned();
        let adds = path(text).is_some_and(|path| path == INCLUDE_TOO);
        document.set(&text.replacen(INCLUDE_TOO, INCLUDE, 1))?;
        if adds && let Some(Value::List(before)) = before {
            put_first(&mut document, before);
        }
    }
    let included = include(&mut document, folder_of(source))?;
    for text in others {
        document.set(text)?;
    }
    Ok((document, included))
}

/// Puts these files before those that `include` names.
fn put_first(document: &mut Document, mut before: Vec<Node>) {
    if let Value::Table(root) = &mut document.root.value {
        let own = root.iter_mut().find(|(name, _)| name == INCLUDE);
        if let Some(Value::List(items)) = own.map(|(_, node)| &mut node.value) {
            before.append(items);
            *items = before;
        }
    }
}

/// The folder of a scene's file.
pub(super) fn folder_of(source: &str) -> &Path {
    Path::new(source).parent().unwrap_or(Path::new(""))
}

/// Adds the tables of the included files. Of a file that `--set` names, the keys stand above those
/// of a table that is there already, which a note reports; otherwise they are added to it, and a
/// key with another value is refused.
fn include(document: &mut Document, folder: &Path) -> Result<Vec<PathBuf>> {
    let Some(field) = Table::root(document, &SCENE)?.get(INCLUDE) else {
        return Ok(Vec::new());
    };
    let path = |item: Field<'_>| {
        let replaces = matches!(item.node.origin, Origin::Option(_));
        Ok((named_path(&item, folder)?, replaces))
    };
    let paths: Vec<(PathBuf, bool)> = field
        .items()?
        .into_iter()
        .map(path)
        .collect::<Result<_>>()?;
    for (path, replaces) in &paths {
        let name = path.display().to_string();
        let text = text_of(path, "a file of materials")?;
        let file = document.included.len();
        document.included.push(name.clone());
        let tables = parse_tables(&name, &text, &|line| Origin::Included(file, line))?;
        for (table, node) in tables {
            merge(document, &table, node, *replaces)?;
        }
    }
    Ok(paths.into_iter().map(|(path, _)| path).collect())
}

/// Adds the entries of a table of an included file to the table of the same name.
fn merge(document: &mut Document, table: &str, node: Node, replaces: bool) -> Result<()> {
    let place = document.place(node.origin);
    if !TABLES.contains(&table) {
        let problem = format!(
            "[{table}] is in an included file, which may only have {}",
            TABLES.map(|name| format!("[{name}]")).join(", ")
        );
        return Err(Diagnostic::input(
            place,
            problem,
            "move it into the scene itself",
        ));
    }
    let origin = node.origin;
    let Value::Table(added) = node.value else {
        let problem = format!("{table} is not a table");
        return Err(Diagnostic::input(place, problem, "write [materials.NAME]"));
    };
    let mut conflict: Option<Box<Conflict>> = None;
    let file = match origin {
        Origin::Included(file, _) => document.included.get(file).cloned(),
        _ => None,
    };
    let file = format!("--material {}", file.unwrap_or_default());
    let mut notes: Vec<String> = Vec::new();
    let Value::Table(root) = &mut document.root.value else {
        return Ok(());
    };
    let at = root.iter().position(|(name, _)| name == table);
    let own = match at {
        Some(at) => &mut root[at].1,
        None => {
            let value = Value::Table(Vec::new());
            root.push((table.to_owned(), Node { origin, value }));
            let last = root.len() - 1;
            &mut root[last].1
        }
    };
    if let Value::Table(own) = &mut own.value {
        for (name, node) in added {
            let is_same = |other: &str| other == name || is_turned(table, other, &name);
            match own.iter_mut().find(|(other, _)| is_same(other)) {
                Some((_, old)) if replaces => {
                    let path = format!("{table}.{}", key(&name));
                    notes.extend(take(old, node, &path, &file));
                }
                Some((_, old)) => {
                    let path = format!("{table}.{}", key(&name));
                    conflict = conflict.or(join(old, node, &path).err());
                }
                None => own.push((name, node)),
            }
        }
    }
    document.notes.append(&mut notes);
    match conflict {
        Some(found) => {
            let there = document.place(found.added);
            let problem = format!("{} ({there})", found.problem);
            let remedy = "remove one of them; dem-run --material puts the keys of a file above those of a scene";
            Err(Diagnostic::input(
                document.place(found.own),
                problem,
                remedy,
            ))
        }
        None => Ok(()),
    }
}

/// Whether two names of contacts have the same materials in the other order.
fn is_turned(table: &str, one: &str, other: &str) -> bool {
    let mut cuts = one.match_indices('-');
    table == "contacts" && cuts.any(|(at, _)| format!("{}-{}", &one[at + 1..], &one[..at]) == other)
}

/// Materials, contacts and bonds of a scene, with included files and `--set` values, as the text of
/// a file that other scenes can include.
pub fn material_text(text: &str, source: &str, overrides: &[String]) -> Result<String> {
    material_text_of_all(&[(text, source, overrides)])
}

/// The same of several scenes, each a text, its source and its `--set` values: of entries of the
/// same name the first.
pub fn material_text_of_all(scenes: &[(&str, &str, &[String])]) -> Result<String> {
    let documents = scenes.iter().map(|(text, source, overrides)| {
        document_of(text, source, overrides).map(|(document, _)| document)
    });
    let documents: Vec<Document> = documents.collect::<Result<_>>()?;
    let mut found = String::new();
    for table in TABLES {
        let entries = all_entries(&documents, table);
        if table == "contacts"
            && documents
                .iter()
                .any(|one| entry(&one.root, table).is_some())
        {
            found.push_str("\n[contacts]\n");
        }
        for (name, node) in entries {
            if table == "contacts" {
                found.push_str(&format!("{} = {}\n", key(name), toml(node)));
                continue;
            }
            found.push_str(&format!("\n[{table}.{}]\n", key(name)));
            if let Value::Table(values) = &node.value {
                for (name, node) in values {
                    found.push_str(&format!("{} = {}\n", key(name), toml(node)));
                }
            }
        }
    }
    Ok(found)
}

/// The entries of a table of several scenes, each name once.
fn all_entries<'a>(documents: &'a [Document], table: &str) -> Vec<(&'a str, &'a Node)> {
    let mut found: Vec<(&str, &Node)> = Vec::new();
    for document in documents {
        let Some(Value::Table(entries)) = entry(&document.root, table) else {
            continue;
        };
        for (name, node) in entries {
            let is_same = |other: &str| other == name || is_turned(table, other, name);
            if !found.iter().any(|(other, _)| is_same(other)) {
                found.push((name, node));
            }
        }
    }
    found
}

/// A number of a scene with included files and `--set` values: as written, and its unit, empty for
/// a plain number. `path` as for `--set`. None: the scene does not have it.
pub fn written_value(
    text: &str,
    source: &str,
    overrides: &[String],
    path: &str,
) -> Result<Option<(f64, String)>> {
    let (document, _) = document_of(text, source, overrides)?;
    let mut node = &document.root;
    for name in path.split('.') {
        match &node.value {
            Value::Table(entries) => match entries.iter().find(|(other, _)| other == name) {
                Some((_, inner)) => node = inner,
                None => return Ok(None),
            },
            _ => return Ok(None),
        }
    }
    let place = || document.place(node.origin);
    let no_number = || Diagnostic::input(place(), format!("{path} is not a number"), "");
    split(node).map(Some).ok_or_else(no_number)
}

/// A value with its unit, as `--set` takes it.
pub fn set_text(path: &str, value: f64, unit: &str) -> String {
    if unit.is_empty() {
        format!("{path}={value}")
    } else {
        format!("{path}={}", quoted(&format!("{value} {unit}")))
    }
}

/// The `--set` value that includes these files as well, their keys above those of the scene.
pub fn include_text(files: &[String]) -> String {
    let names: Vec<String> = files.iter().map(|name| quoted(name)).collect();
    format!("{INCLUDE_TOO}=[{}]", names.join(", "))
}

fn entry<'a>(node: &'a Node, name: &str) -> Option<&'a Value> {
    match &node.value {
        Value::Table(entries) => {
            let found = entries.iter().find(|(other, _)| other == name);
            found.map(|(_, node)| &node.value)
        }
        _ => None,
    }
}
