//! The text of a scene as a tree of values, each with its place. The only module besides
//! `study::rewrite` that uses the TOML parser.

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use dem_io::diagnostic::{Diagnostic, Result};

/// Origin of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Origin {
    /// A line of the file, from 1.
    Line(usize),
    /// A `--set`, by its index in [`Document::options`].
    Option(usize),
    /// An included file, by its index in [`Document::included`], and a line of it, from 1.
    Included(usize, usize),
}

/// A value and its origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    pub(super) origin: Origin,
    pub(super) value: Value,
}

/// A TOML value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Text(String),
    /// As written, and its value; a whole number is written in decimal digits.
    Number(String, f64),
    Boolean(bool),
    Date(String),
    List(Vec<Node>),
    /// In the order of the file.
    Table(Vec<(String, Node)>),
}

/// The parsed text of a scene.
#[derive(Debug)]
pub(super) struct Document {
    /// Name of the file.
    pub(super) name: String,
    /// The texts of `--set`.
    pub(super) options: Vec<String>,
    /// Names of the included files.
    pub(super) included: Vec<String>,
    /// What was changed that the text has otherwise, a sentence each.
    pub(super) notes: Vec<String>,
    /// The root table.
    pub(super) root: Node,
}

/// Longest option that a message repeats in full, in characters.
const SHOWN_OPTION: usize = 60;

impl Document {
    pub(super) fn parse(name: &str, text: &str) -> Result<Self> {
        Ok(Self {
            name: name.to_owned(),
            options: Vec::new(),
            included: Vec::new(),
            notes: Vec::new(),
            root: Node {
                origin: Origin::Line(1),
                value: Value::Table(parse_tables(name, text, &Origin::Line)?),
            },
        })
    }

    /// A place, as named in messages.
    pub(super) fn place(&self, origin: Origin) -> String {
        match origin {
            Origin::Line(line) => format!("{}:{line}", self.name),
            Origin::Included(file, line) => {
                let name = self.included.get(file).map_or("", String::as_str);
                format!("{name}:{line}")
            }
            Origin::Option(number) => {
                let text = self.options.get(number).map_or("", String::as_str);
                option_place(text)
            }
        }
    }
}

/// The place of a `--set` text in messages.
pub(super) fn option_place(text: &str) -> String {
    format!("--set {}", shortened(text, SHOWN_OPTION))
}

/// The tables of the text of a file `name`; `origin` is that of a line.
pub(super) fn parse_tables(
    name: &str,
    text: &str,
    origin: &dyn Fn(usize) -> Origin,
) -> Result<Vec<(String, Node)>> {
    let lines = line_starts(text);
    let table = DeTable::parse(text).map_err(|error| not_toml(name, text, &lines, &error))?;
    let of_byte = |byte| origin(line_of(&lines, byte));
    Ok(entries(table.into_inner(), &of_byte))
}

/// The value of a `--set`, if it is TOML.
pub(super) fn parse_value(text: &str, option: usize) -> std::result::Result<Node, String> {
    let value = DeValue::parse(text).map_err(|error| error.message().to_owned())?;
    let origin = Origin::Option(option);
    Ok(Node {
        origin,
        value: plain(value.into_inner(), &|_| origin),
    })
}

/// The beginning of `text` on one line.
pub(super) fn shortened(text: &str, characters: usize) -> String {
    let mut shown: String = text.chars().take(characters).collect();
    if shown.len() < text.len() {
        shown.push_str("...");
    }
    shown.escape_debug().to_string().replace("\\\"", "\"")
}

fn entries(table: DeTable<'_>, origin: &dyn Fn(usize) -> Origin) -> Vec<(String, Node)> {
    let mut found: Vec<(usize, String, Node)> = table
        .into_iter()
        .map(|(key, value)| {
            let at = key.span().start;
            let node = Node {
                origin: origin(at),
                value: plain(value.into_inner(), origin),
            };
            (at, key.into_inner().into_owned(), node)
        })
        .collect();
    found.sort_by_key(|(at, ..)| *at);
    found
        .into_iter()
        .map(|(_, key, node)| (key, node))
        .collect()
}

fn plain(value: DeValue<'_>, origin: &dyn Fn(usize) -> Origin) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(whole) => match i128::from_str_radix(whole.as_str(), whole.radix()) {
            Ok(number) => Value::Number(number.to_string(), number as f64),
            Err(_) => Value::Number(whole.to_string(), f64::INFINITY),
        },
        DeValue::Float(float) => {
            let number = float.as_str().parse().unwrap_or(f64::NAN);
            Value::Number(float.as_str().to_owned(), number)
        }
        DeValue::Boolean(boolean) => Value::Boolean(boolean),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Array(list) => Value::List(
            list.into_iter()
                .map(|item: Spanned<DeValue<'_>>| Node {
                    origin: origin(item.span().start),
                    value: plain(item.into_inner(), origin),
                })
                .collect(),
        ),
        DeValue::Table(table) => Value::Table(entries(table, origin)),
    }
}

/// The start of each line, in bytes.
fn line_starts(text: &str) -> Vec<usize> {
    let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
    std::iter::once(0)
        .chain(breaks.map(|(at, _)| at + 1))
        .collect()
}

/// The line of a byte, from 1.
fn line_of(lines: &[usize], byte: usize) -> usize {
    lines.partition_point(|start| *start <= byte)
}

fn not_toml(name: &str, text: &str, lines: &[usize], error: &Error) -> Diagnostic {
    // An error at the very end belongs to the last line with text.
    let end = text.trim_end().len();
    let byte = error.span().map_or(0, |span| span.start).min(end);
    let line = line_of(lines, byte);
    let place = format!("{name}:{line}");
    let written = text.lines().nth(line - 1).unwrap_or_default();
    let span = error.span().unwrap_or_default();
    let part = shortened(text.get(span).unwrap_or_default().trim(), SHOWN_OPTION);
    let message = error.message();
    let message = message
        .strip_suffix(", expected nothing")
        .unwrap_or(message);
    if message == "duplicate key" {
        return twice(place, text, line, without_comment(written), &part);
    }
    if message.starts_with("string values must be quoted") {
        let problem = if part.is_empty() {
            "not TOML: a value is missing".to_owned()
        } else {
            format!("not TOML: {part} is no value")
        };
        let remedy = "a value is a number, true, false, a list in [ ], a table in { } or text in quotes, such as \"2 mm\"";
        return Diagnostic::input(place, problem, remedy);
    }
    if message.ends_with("string, expected `\"`") || message.ends_with("string, expected `'`") {
        let remedy = "end it with the quote that it begins with";
        return Diagnostic::input(place, "not TOML: a text has no closing quote", remedy);
    }
    let remedy = if message.contains("escape") || message.contains("unicode") {
        r"write \\ for a backslash, or 'single quotes' around the text"
    } else {
        "correct this line, or the end of the one before"
    };
    Diagnostic::input(place, format!("not TOML: {message}"), remedy)
}

/// The error for a table or a key that appears twice, which TOML does not allow.
fn twice(place: String, text: &str, line: usize, written: &str, key: &str) -> Diagnostic {
    if !written.starts_with('[') {
        let problem = format!("the key {key} is given twice in its table");
        return Diagnostic::input(place, problem, "remove one");
    }
    let first = text
        .lines()
        .take(line - 1)
        .position(|other| without_comment(other) == written)
        .map_or_else(String::new, |at| format!(", first on line {}", at + 1));
    Diagnostic::input(
        place,
        format!(
            "the table {} is given twice{first}",
            shortened(written, SHOWN_OPTION)
        ),
        "names are unique within their table: rename or remove one",
    )
}

fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}
