//! The part of JSON Schema that our schemas use; anything else in a schema fails.

use std::collections::BTreeSet;

use regex::Regex;
use serde_json::{Map, Value, json};
use toml::de::{DeTable, DeValue};

pub(in super::super) fn toml_as_json(text: &str) -> Value {
    let table = DeTable::parse(text).unwrap().into_inner();
    as_json(&DeValue::Table(table))
}

fn as_json(value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => json!(text),
        DeValue::Integer(whole) => {
            let number = i128::from_str_radix(whole.as_str(), whole.radix()).unwrap();
            match u64::try_from(number) {
                Ok(number) => json!(number),
                Err(_) => json!(i64::try_from(number).unwrap()),
            }
        }
        DeValue::Float(float) => json!(float.as_str().parse::<f64>().unwrap()),
        DeValue::Boolean(boolean) => json!(boolean),
        DeValue::Datetime(date) => json!(date.to_string()),
        DeValue::Array(items) => items.iter().map(|item| as_json(item.get_ref())).collect(),
        DeValue::Table(entries) => entries
            .iter()
            .map(|(key, value)| (key.get_ref().to_string(), as_json(value.get_ref())))
            .collect::<Map<_, _>>()
            .into(),
    }
}

/// Checks `value` at `path` against `schema`, part of `root`, and collects its keys.
pub(super) fn check(
    value: &Value,
    schema: &Value,
    root: &Value,
    path: &str,
    keys: &mut BTreeSet<String>,
) -> Result<(), String> {
    let schema = match schema {
        Value::Bool(true) => return Ok(()),
        Value::Bool(false) => return Err(format!("{path} is unknown")),
        Value::Object(schema) => schema,
        other => panic!("{other} is no schema"),
    };
    for (word, rule) in schema {
        let holds = match word.as_str() {
            "$schema" | "title" | "description" | "default" | "definitions" => true,
            "type" => is_of_type(value, rule),
            "enum" => rule.as_array().unwrap().contains(value),
            "$ref" => {
                let pointer = rule.as_str().unwrap().strip_prefix('#').unwrap();
                let definition = root.pointer(pointer).unwrap();
                check(value, definition, root, path, keys).is_ok()
            }
            "anyOf" => {
                let mut choices = rule.as_array().unwrap().iter();
                choices.any(|choice| check(value, choice, root, path, keys).is_ok())
            }
            "pattern" => value
                .as_str()
                .is_none_or(|text| Regex::new(rule.as_str().unwrap()).unwrap().is_match(text)),
            "minimum" => number(value).is_none_or(|value| value >= number(rule).unwrap()),
            "maximum" => number(value).is_none_or(|value| value <= number(rule).unwrap()),
            "exclusiveMinimum" => number(value).is_none_or(|value| value > number(rule).unwrap()),
            "exclusiveMaximum" => number(value).is_none_or(|value| value < number(rule).unwrap()),
            "minItems" => length(value).is_none_or(|count| count >= rule.as_u64().unwrap()),
            "maxItems" => length(value).is_none_or(|count| count <= rule.as_u64().unwrap()),
            "required" => value.as_object().is_none_or(|members| {
                let names = rule.as_array().unwrap().iter();
                names
                    .map(|name| name.as_str().unwrap())
                    .all(|name| members.contains_key(name))
            }),
            "items" => {
                check_items(value, rule, root, path, keys)?;
                true
            }
            "properties" | "additionalProperties" => true,
            other => panic!("{other} is a word that this checker does not know"),
        };
        if !holds {
            return Err(format!("{path} is {value}, against {word} {rule}"));
        }
    }
    check_members(value, schema, root, path, keys)
}

fn check_items(
    value: &Value,
    rule: &Value,
    root: &Value,
    path: &str,
    keys: &mut BTreeSet<String>,
) -> Result<(), String> {
    for (at, item) in value.as_array().into_iter().flatten().enumerate() {
        let rule = rule.get(at).unwrap_or(rule);
        check(item, rule, root, path, keys)?;
    }
    Ok(())
}

fn check_members(
    value: &Value,
    schema: &Map<String, Value>,
    root: &Value,
    path: &str,
    keys: &mut BTreeSet<String>,
) -> Result<(), String> {
    let (Some(members), Some(others)) = (value.as_object(), schema.get("additionalProperties"))
    else {
        return Ok(());
    };
    for (name, member) in members {
        let known = schema.get("properties").and_then(|known| known.get(name));
        let path = match known {
            Some(_) => format!("{path}.{name}"),
            None if others.is_object() => format!("{path}.*"),
            None => return Err(format!("{path}.{name} is unknown")),
        };
        check(member, known.unwrap_or(others), root, &path, keys)?;
        keys.insert(path);
    }
    Ok(())
}

fn is_of_type(value: &Value, rule: &Value) -> bool {
    match rule {
        Value::Array(types) => types.iter().any(|rule| is_of_type(value, rule)),
        _ => match rule.as_str().unwrap() {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "number" => value.is_number(),
            "integer" => value.is_u64() || value.is_i64(),
            other => panic!("{other} is a type that this checker does not know"),
        },
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64()
}

fn length(value: &Value) -> Option<u64> {
    value.as_array().map(|items| items.len() as u64)
}
