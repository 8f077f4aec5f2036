//! The reference of keys: a table for each table.

use crate::schema::{Key, Kind, Schema};
use dem_io::units::{DIMENSIONS, Dimension};

/// The page of all tables of `what`, which is `root`.
pub(super) fn page(what: &str, root: &'static Schema) -> String {
    let mut text = format!(
        "# Every key of {what}\n\n\
         Written by `cargo run -p dem-scene --example scene_reference` from the schema by which {what} is read. Numbers \
         are in the unit named, or text with a unit of their own (`\"2 mm\"`).\n"
    );
    for schema in tables(root) {
        if !schema.title.is_empty() {
            text += &format!("\n## {}\n", heading(schema));
        }
        text += &format!("\n{}\n\n", escaped(schema.doc));
        text +=
            "| key | kind | unit | unless given | limits | meaning |\n|---|---|---|---|---|---|\n";
        for key in schema.keys {
            text += &row(key);
        }
    }
    text += "\n## Units\n\nWithout a unit a number is in SI.\n\n| | SI | units |\n|---|---|---|\n";
    for dimension in &DIMENSIONS {
        let units: Vec<String> = dimension
            .units
            .iter()
            .map(|(unit, _)| format!("`{unit}`"))
            .collect();
        text += &format!(
            "| {} | {} | {} |\n",
            dimension.name,
            dimension.si,
            units.join(", ")
        );
    }
    text
}

/// A table and all tables within it, each once, in the order of their keys.
pub(super) fn tables(root: &'static Schema) -> Vec<&'static Schema> {
    let mut found = vec![root];
    let mut next = 0;
    while next < found.len() {
        let mut within = Vec::new();
        for key in found[next].keys {
            collect(&key.kind, &mut within);
        }
        next += 1;
        within.retain(|table| !found.iter().any(|other| std::ptr::eq(*other, *table)));
        found.splice(next..next, within);
    }
    found
}

fn collect(kind: &Kind, found: &mut Vec<&'static Schema>) {
    match kind {
        Kind::Table(table) => found.push(table),
        Kind::Open(table, others) => {
            found.push(table);
            collect(others, found);
        }
        Kind::Named(_, kind) | Kind::List(kind) => collect(kind, found),
        Kind::Either(kinds) | Kind::Row(kinds) => {
            for kind in *kinds {
                collect(kind, found);
            }
        }
        _ => {}
    }
}

fn row(key: &Key) -> String {
    let cells = [
        format!("`{}`", key.name),
        kind(&key.kind),
        unit(&key.kind).to_owned(),
        escaped(&key.usual()),
        limits(key),
        escaped(key.doc),
    ];
    format!("| {} |\n", cells.join(" | ")).replace("  ", " ")
}

fn kind(of: &Kind) -> String {
    match of {
        Kind::Quantity(dimension) => dimension.name.to_owned(),
        Kind::Auto(dimension) => format!("`auto` or {}", dimension.named()),
        Kind::Measured => "what is measured".to_owned(),
        Kind::Vector(_) => "`[x, y, z]`".to_owned(),
        Kind::Direction(_) => "direction `[x, y, z]`".to_owned(),
        Kind::Whole { .. } => "whole number".to_owned(),
        Kind::Boolean => "true or false".to_owned(),
        Kind::True => "true".to_owned(),
        Kind::Word(words) => {
            let words: Vec<String> = words().iter().map(|word| format!("`{word}`")).collect();
            words.join(", ")
        }
        Kind::Text(what) | Kind::Anything(what) => escaped(what),
        Kind::List(item) => format!("list, each {}", each(item)),
        Kind::Row(items) => {
            let items: Vec<String> = items.iter().map(kind).collect();
            format!("\\[{}\\]", items.join(", "))
        }
        Kind::Table(table) | Kind::Open(table, _) => link(table),
        Kind::Named(name, of) => match of {
            Kind::Table(table) | Kind::Open(table, _) => link(table),
            _ => format!("table of `{name} = ...`, each {}", each(of)),
        },
        Kind::Either(kinds) => {
            let kinds: Vec<String> = kinds.iter().map(kind).collect();
            kinds.join(" or ")
        }
    }
}

/// The type of an item, with its article.
fn each(of: &Kind) -> String {
    match of {
        Kind::Quantity(dimension) => dimension.named(),
        Kind::Whole { .. } => "a whole number".to_owned(),
        Kind::Word(_) => format!("one of {}", kind(of)),
        Kind::List(_) => format!("a {}", kind(of)),
        _ => kind(of),
    }
}

fn unit(of: &Kind) -> &'static str {
    let shown = |dimension: &Dimension| dimension.si;
    match of {
        Kind::Quantity(dimension) | Kind::Auto(dimension) | Kind::Vector(dimension) => {
            shown(dimension)
        }
        Kind::Measured => "its own",
        Kind::List(kind) => unit(kind),
        Kind::Row(kinds) | Kind::Either(kinds) => kinds
            .iter()
            .map(unit)
            .find(|unit| !unit.is_empty())
            .unwrap_or_default(),
        _ => "",
    }
}

fn limits(key: &Key) -> String {
    match key.kind {
        Kind::Whole { least, .. } => {
            let most = key.limits_in_words();
            let and = if most.is_empty() { "" } else { " and " };
            format!("at least {least}{and}{most}")
        }
        _ => key.limits_in_words(),
    }
}

fn heading(schema: &Schema) -> String {
    match schema.title.starts_with('[') {
        true => format!("`{}`", schema.title),
        false => schema.title.to_owned(),
    }
}

fn link(schema: &Schema) -> String {
    let anchor = schema.title.to_lowercase().replace(' ', "-");
    let anchor: String = anchor
        .chars()
        .filter(|letter| letter.is_alphanumeric() || *letter == '-')
        .collect();
    format!("[{}](#{anchor})", heading(schema))
}

/// Brackets outside code would start a link.
fn escaped(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let parts: Vec<String> = parts
        .map(|(at, part)| match at % 2 {
            0 => part.replace('[', "\\[").replace(']', "\\]"),
            _ => part.to_owned(),
        })
        .collect();
    parts.join("`").replace('|', "\\|")
}
