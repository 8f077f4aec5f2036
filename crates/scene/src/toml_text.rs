//! Values as text in TOML.

use super::names::well_formed;
use super::tree::{Node, Value};

/// A value as TOML.
pub(crate) fn toml(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => quoted(text),
        Value::Number(written, _) | Value::Date(written) => written.clone(),
        Value::Boolean(boolean) => boolean.to_string(),
        Value::List(items) => {
            let items: Vec<String> = items.iter().map(toml).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(entries) => {
            let entries: Vec<String> = entries
                .iter()
                .map(|(name, node)| format!("{} = {}", key(name), toml(node)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

/// A text as TOML.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            control if control.is_control() => {
                out.push_str(&format!("\\u{:04X}", u32::from(control)));
            }
            other => out.push(other),
        }
    }
    out.push('"');
    out
}

/// A key in TOML syntax.
pub(crate) fn key(name: &str) -> String {
    if well_formed(name) {
        name.to_owned()
    } else {
        format!("{name:?}")
    }
}

/// A number and its unit.
pub(crate) fn split(node: &Node) -> Option<(f64, String)> {
    match &node.value {
        Value::Number(_, value) => value.is_finite().then(|| (*value, String::new())),
        Value::Text(text) => {
            let ends = (1..=text.len())
                .rev()
                .filter(|end| text.is_char_boundary(*end));
            let number = |end: usize| text[..end].trim().parse::<f64>().ok().map(|v| (v, end));
            let (value, end) = ends.filter_map(number).find(|(v, _)| v.is_finite())?;
            Some((value, text[end..].trim().to_owned()))
        }
        _ => None,
    }
}
