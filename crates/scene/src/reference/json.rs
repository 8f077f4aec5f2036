//! The JSON Schema (draft 7) with which editors complete and check TOML files.

use std::ops::Bound::{Excluded, Included, Unbounded};

use serde_json::{Map, Value, json};

use crate::schema::{Key, Kind, Schema, Unless};
use dem_io::units::{DIMENSIONS, Dimension, NUMBER};

pub(super) fn text(title: &str, root: &Schema) -> String {
    let mut schema = table(root, &json!(false));
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!(title);
    let definitions: Map<String, Value> = DIMENSIONS
        .iter()
        .map(|dimension| (id(dimension), with_unit(dimension)))
        .collect();
    schema["definitions"] = Value::Object(definitions);
    format!("{schema:#}\n")
}

/// A table; `others` is the schema of keys that are not listed.
fn table(schema: &Schema, others: &Value) -> Value {
    let keys = schema.keys.iter();
    let properties: Map<String, Value> = keys
        .clone()
        .map(|key| (key.name.to_owned(), property(key)))
        .collect();
    let required: Vec<&str> = keys
        .filter(|key| matches!(key.unless_given, Unless::Required(_)))
        .map(|key| key.name)
        .collect();
    json!({
        "type": "object",
        "description": schema.doc,
        "properties": properties,
        "required": required,
        "additionalProperties": others,
    })
}

fn property(key: &Key) -> Value {
    let mut property = value(&key.kind, key);
    let mut description = key.doc.to_owned();
    let limits = key.limits_in_words();
    if !limits.is_empty() {
        description += &format!("\n\nLimits: {limits}.");
    } else if !key.unit().is_empty() {
        description += &format!("\n\nUnit: {}.", key.unit());
    }
    if !matches!(
        key.unless_given,
        Unless::Required(_) | Unless::SometimesRequired(_)
    ) {
        description += &format!("\n\nDefault: {}.", key.usual());
    }
    property["description"] = json!(description);
    let usual = match key.unless_given {
        Unless::Boolean(usual) => json!(usual),
        Unless::Word(usual) => json!(usual),
        Unless::Number(usual) => match key.kind {
            Kind::Vector(_) => json!([usual, usual, usual]),
            Kind::Whole { .. } => json!(usual as u64),
            Kind::Quantity(_) => json!(usual),
            _ => return property,
        },
        _ => return property,
    };
    property["default"] = usual;
    property
}

fn value(kind: &Kind, key: &Key) -> Value {
    let list = |items: Value, least: usize, most: Option<usize>| {
        let mut list = json!({ "type": "array", "items": items, "minItems": least });
        if let Some(most) = most {
            list["maxItems"] = json!(most);
        }
        list
    };
    let vector = |dimension| list(quantity(dimension, None), 3, Some(3));
    match kind {
        Kind::Quantity(dimension) => quantity(dimension, Some(key)),
        Kind::Auto(dimension) => {
            json!({ "anyOf": [{ "enum": ["auto"] }, quantity(dimension, Some(key))] })
        }
        Kind::Measured => json!({ "type": ["number", "string"] }),
        Kind::Vector(dimension) => vector(*dimension),
        Kind::Direction(_) => vector(&NUMBER),
        Kind::Whole { least, most, .. } => {
            let mut whole = json!({ "type": "integer", "minimum": least });
            let limit = match key.limits.1 {
                Included(limit) => Some(limit as u64),
                _ => *most,
            };
            if let Some(most) = limit {
                whole["maximum"] = json!(most);
            }
            whole
        }
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::True => json!({ "enum": [true] }),
        Kind::Word(words) => json!({ "enum": words() }),
        Kind::Text(_) => json!({ "type": "string" }),
        Kind::List(item) => list(value(item, key), 1, None),
        Kind::Row(items) => {
            let values: Vec<Value> = items.iter().map(|item| value(item, key)).collect();
            list(json!(values), items.len(), Some(items.len()))
        }
        Kind::Table(schema) => table(schema, &json!(false)),
        Kind::Open(schema, others) => table(schema, &value(others, key)),
        Kind::Named(_, of) => json!({ "type": "object", "additionalProperties": value(of, key) }),
        Kind::Either(kinds) => {
            let kinds: Vec<Value> = kinds.iter().map(|kind| value(kind, key)).collect();
            json!({ "anyOf": kinds })
        }
        Kind::Anything(_) => json!({}),
    }
}

/// A number within the limits of `key`, or text with a unit.
fn quantity(dimension: &Dimension, key: Option<&Key>) -> Value {
    let mut number = json!({ "type": "number" });
    if let Some(key) = key {
        match key.limits.0 {
            Excluded(low) => number["exclusiveMinimum"] = json!(low),
            Included(low) => number["minimum"] = json!(low),
            Unbounded => {}
        }
        match key.limits.1 {
            Excluded(high) => number["exclusiveMaximum"] = json!(high),
            Included(high) => number["maximum"] = json!(high),
            Unbounded => {}
        }
    }
    let text = json!({ "$ref": format!("#/definitions/{}", id(dimension)) });
    json!({ "anyOf": [number, text] })
}

fn id(dimension: &Dimension) -> String {
    dimension.name.replace(' ', "-")
}

/// Text of a number with or without one of the units, in all accepted spellings.
fn with_unit(dimension: &Dimension) -> Value {
    let units: Vec<&str> = dimension.units.iter().map(|(unit, _)| *unit).collect();
    let spelled: Vec<String> = units.iter().map(|unit| spellings(unit)).collect();
    let number = r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?";
    json!({
        "type": "string",
        "description": format!("{} with its unit: {}", dimension.named(), units.join(", ")),
        "pattern": format!(r"^\s*{number}\s*({})?\s*$", spelled.join("|")),
    })
}

/// A pattern for a unit: "N s/m", "N·s/m" and "N*s/m" are the same.
fn spellings(unit: &str) -> String {
    let letters = unit.chars().filter(|letter| !letter.is_whitespace());
    let letters: Vec<String> = letters
        .map(|letter| match letter {
            'u' => "[uµμ]".to_owned(),
            '2' => "[2²]".to_owned(),
            '3' => "[3³]".to_owned(),
            '(' | ')' => format!(r"\{letter}"),
            other => other.to_string(),
        })
        .collect();
    letters.join(r"[\s*·^]*")
}
