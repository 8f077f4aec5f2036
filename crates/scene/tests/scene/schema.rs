//! The reference and the JSON Schema, which are generated from the schema by which scenes and
//! studies are read.

pub(super) mod json;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use dem_scene::reference;
use serde_json::Value;

use super::cases;
use super::corpus::files;
use json::{check, toml_as_json};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub(super) fn schema(name: &str) -> Value {
    let (_, text) = reference::files()
        .into_iter()
        .find(|(other, _)| *other == name)
        .unwrap();
    serde_json::from_str(&text).unwrap()
}

pub(super) fn scenes() -> Vec<PathBuf> {
    [
        files(&root().join("data/scenes")),
        files(&root().join("data/thesis")),
        files(&root().join("tests/scenes/good")),
        files(&root().join("crates/scene/tests/scene/good")),
    ]
    .concat()
}

/// The keys of a schema that a file has, as paths in the schema.
fn keys_of(path: &Path, schema: &Value) -> Result<BTreeSet<String>, String> {
    keys_in(&std::fs::read_to_string(path).unwrap(), schema)
}

fn keys_in(text: &str, schema: &Value) -> Result<BTreeSet<String>, String> {
    let value = toml_as_json(text);
    let mut keys = BTreeSet::new();
    check(&value, schema, schema, "", &mut keys)?;
    Ok(keys)
}

/// All keys of a schema, and of the tables within it.
fn all_keys(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    let Value::Object(members) = schema else {
        return;
    };
    if let Some(Value::Object(properties)) = members.get("properties") {
        for (name, property) in properties {
            let path = format!("{path}.{name}");
            all_keys(property, &path, found);
            found.insert(path);
        }
    }
    if let Some(others) = members.get("additionalProperties") {
        all_keys(others, &format!("{path}.*"), found);
    }
    for choice in members
        .get("anyOf")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
    {
        all_keys(choice, path, found);
    }
}

#[test]
fn the_files_in_doc_are_those_that_the_program_writes() {
    for (name, text) in reference::files() {
        let written = std::fs::read_to_string(root().join("doc").join(name)).unwrap();
        assert!(
            written == text,
            "doc/{name} is old: run `cargo run -p dem-scene --example scene_reference`"
        );
    }
}

/// Fails if one of the at least `fewest` keys of a schema is in none of the files, or if it refuses
/// one of them.
#[track_caller]
fn assert_all_stand_in(files: &[PathBuf], schema: &Value, fewest: usize) {
    let mut missing = BTreeSet::new();
    all_keys(schema, "", &mut missing);
    assert!(missing.len() >= fewest, "{} keys", missing.len());
    for path in files {
        match keys_of(path, schema) {
            Ok(keys) => missing.retain(|key| !keys.contains(key)),
            Err(problem) => panic!("{}: {problem}", path.display()),
        }
    }
    assert!(missing.is_empty(), "no file has {missing:?}");
}

/// A new key fails here until a scene has it.
#[test]
fn every_key_of_a_scene_stands_in_a_good_one() {
    let schema = schema("scene.schema.json");
    assert_all_stand_in(&scenes(), &schema, 200);
}

#[test]
fn every_key_of_a_study_stands_in_a_good_one() {
    let schema = schema("study.schema.json");
    let studies =
        ["data/studies", "crates/scene/tests/studies"].map(|folder| files(&root().join(folder)));
    let studies = studies.concat();
    assert_all_stand_in(&studies, &schema, 25);
}

/// Unknown keys and words, and units of other quantities, are already marked in the editor.
#[test]
fn the_json_schema_refuses_what_the_reader_does_not_know() {
    let schema = schema("scene.schema.json");
    let mut counts = [0; 3];
    for case in cases::paths().iter().flat_map(|path| cases::read(path).1) {
        let (_, message) = case.message.split_once(": ").unwrap();
        let kinds = [
            message.starts_with("unknown key") || message.starts_with("unknown table"),
            message.contains(", which is unknown; "),
            // The unit of a measure depends on its quantity.
            message.contains(": unknown unit '")
                && message.contains("' is not a")
                && !message.starts_with("measures."),
        ];
        let Some(kind) = kinds.iter().position(|is_it| *is_it) else {
            continue;
        };
        counts[kind] += 1;
        assert!(keys_in(&case.scene, &schema).is_err(), "{message}");
    }
    assert!(counts.iter().all(|count| *count >= 5), "{counts:?}");
}
