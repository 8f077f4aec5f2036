//! Every key of the schema refuses what is no value of it: another type, a unit of another quantity
//! and numbers beyond its limits.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use dem_scene::scene_from_text;
use serde_json::{Map, Value, json};

use super::corpus::files;
use super::schema::json::toml_as_json;
use super::schema::{scenes, schema};

/// A value of a scene that the schema has, and where it stands.
struct Found {
    scene: PathBuf,
    value: Value,
    /// From the root of the scene.
    keys: Vec<String>,
    of_key: Value,
}

/// Adds the values of a table to those found, each path of the schema once.
fn collect(
    (path, scene): (&Path, &Value),
    (table, schema): (&Map<String, Value>, &Value),
    (keys, names): (&[String], &str),
    found: &mut BTreeMap<String, Found>,
) {
    for (key, value) in table {
        let known = schema["properties"].get(key);
        let name = match known {
            Some(_) => format!("{names}.{key}"),
            None => format!("{names}.*"),
        };
        let of_key = known.unwrap_or(&schema["additionalProperties"]);
        let keys = [keys, std::slice::from_ref(key)].concat();
        if let Some(inner) = value.as_object() {
            let choices = of_key["anyOf"].as_array().into_iter().flatten();
            for choice in choices
                .chain([of_key])
                .filter(|choice| choice["type"] == "object")
            {
                collect((path, scene), (inner, choice), (&keys, &name), found);
            }
        }
        if known.is_some() {
            let entry = Found {
                scene: path.to_owned(),
                value: scene.clone(),
                keys,
                of_key: of_key.clone(),
            };
            found.entry(name).or_insert(entry);
        }
    }
}

/// Values that the key must refuse.
fn refused_by(of_key: &Value) -> Vec<Value> {
    let mut wrong = vec![json!([[[]]]), json!({ "nonsense": [] })];
    let choices = of_key["anyOf"].as_array().into_iter().flatten();
    let choices: Vec<&Value> = choices.chain([of_key]).collect();
    for choice in &choices {
        let is_whole = choice["type"] == "integer";
        if choice["type"] != "number" && !is_whole {
            continue;
        }
        wrong.push(json!("1 furlong"));
        let step = |limit: f64| {
            if is_whole {
                1.0
            } else {
                1e-3 * limit.abs().max(1.0)
            }
        };
        let number = |value: f64| match is_whole {
            true => json!(value as i64),
            false => json!(value),
        };
        let limit = |word: &str| choice[word].as_f64();
        wrong.extend(limit("minimum").map(|least| number(least - step(least))));
        wrong.extend(limit("exclusiveMinimum").map(number));
        // Nothing is larger than the largest whole number.
        let most = limit("maximum").filter(|most| *most < 1e15);
        wrong.extend(most.map(|most| number(most + step(most))));
        wrong.extend(limit("exclusiveMaximum").map(number));
    }
    wrong
}

/// The scene with this value in place of its own.
fn with(found: &Found, value: Value) -> String {
    let mut scene = found.value.clone();
    let mut at = &mut scene;
    for key in &found.keys {
        at = &mut at[key];
    }
    *at = value;
    as_toml(&scene)
}

/// A scene as TOML, a line for each of its tables.
fn as_toml(scene: &Value) -> String {
    fn inline(value: &Value) -> String {
        match value {
            Value::Array(items) => {
                let items: Vec<String> = items.iter().map(inline).collect();
                format!("[{}]", items.join(", "))
            }
            Value::Object(members) => {
                let members = members.iter();
                let members = members.map(|(key, value)| format!("{key:?} = {}", inline(value)));
                format!("{{ {} }}", members.collect::<Vec<_>>().join(", "))
            }
            other => other.to_string(),
        }
    }
    let members = scene.as_object().unwrap().iter();
    let lines = members.map(|(key, value)| format!("{key:?} = {}\n", inline(value)));
    lines.collect()
}

#[test]
fn every_key_refuses_another_type_another_unit_and_what_is_beyond_its_limits() {
    let schema = schema("scene.schema.json");
    let mut found = BTreeMap::new();
    for path in scenes() {
        let scene = toml_as_json(&std::fs::read_to_string(&path).unwrap());
        let table = scene.as_object().unwrap();
        collect((&path, &scene), (table, &schema), (&[], ""), &mut found);
    }
    assert!(found.len() >= 200, "{} keys", found.len());
    let (mut tried, mut limits, mut accepted) = (0, 0, Vec::new());
    for (name, one) in &found {
        let place = one.scene.display().to_string();
        let key = one.keys.last().unwrap();
        for value in refused_by(&one.of_key) {
            tried += 1;
            limits += usize::from(value.is_number());
            match scene_from_text(&with(one, value.clone()), &place, &[]) {
                Ok(_) => accepted.push(format!("{name} = {value} in {place}")),
                Err(error) => {
                    assert_eq!(error.exit_code(), 2);
                    let said = error.to_string();
                    if !said.contains(key) {
                        accepted.push(format!("{name} = {value}: {said}"));
                    }
                }
            }
        }
    }
    assert!(
        tried > 700 && limits > 100,
        "{tried} values, {limits} beyond limits"
    );
    assert!(accepted.is_empty(), "{tried}: {}", accepted.join("\n"));
}

/// A good scene stays good when it is written anew.
#[test]
fn scenes_written_anew_are_read() {
    for path in files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/good")) {
        let scene = toml_as_json(&std::fs::read_to_string(&path).unwrap());
        let text = as_toml(&scene);
        scene_from_text(&text, &path.display().to_string(), &[]).unwrap();
    }
}
