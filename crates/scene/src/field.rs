//! One value of a scene: its expected form, and the message if it is wrong.

use std::fmt::Display;
use std::ops::Bound;

use super::names::{suggestion, well_formed};
use super::schema::Key;
use super::tree::{Document, Node, Value, shortened};
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::units::{self, Dimension};

/// Longest text of a value that a message repeats in full, in characters.
const SHOWN_TEXT: usize = 40;

/// A value of the scene, with its path for messages.
#[derive(Clone)]
pub(super) struct Field<'a> {
    pub(super) document: &'a Document,
    /// As in `bodies.bar.particles[3]`.
    pub(super) path: String,
    pub(super) node: &'a Node,
}

impl<'a> Field<'a> {
    /// A message at the place of this value.
    pub(super) fn refuse(
        &self,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::input(self.document.place(self.node.origin), problem, remedy)
    }

    /// A message at the place of this value, which begins with its path: "run.seed has no effect".
    pub(super) fn fault(&self, problem: impl Display, remedy: impl Into<String>) -> Diagnostic {
        self.refuse(format!("{} {problem}", self.path), remedy)
    }

    /// The error for a value that is not as required.
    pub(super) fn wrong(&self, limit: &str, remedy: impl Into<String>) -> Diagnostic {
        self.fault(format!("is {}, but must be {limit}", self.shown()), remedy)
    }

    /// The value as written, or its type if that is long.
    pub(super) fn shown(&self) -> String {
        match &self.node.value {
            Value::Text(text) => format!("\"{}\"", shortened(text, SHOWN_TEXT)),
            Value::Number(written, _) => written.clone(),
            Value::Boolean(boolean) => boolean.to_string(),
            Value::Date(date) => format!("the date {date}"),
            Value::List(items) if items.is_empty() => "an empty list".to_owned(),
            Value::List(items) => format!("a list of {}", items.len()),
            Value::Table(_) => "a table".to_owned(),
        }
    }

    /// A finite value in SI.
    pub(super) fn quantity(&self, dimension: &Dimension) -> Result<f64> {
        match &self.node.value {
            Value::Number(_, value) if value.is_finite() => Ok(*value),
            Value::Number(..) => Err(self.wrong("a finite number", example(dimension))),
            Value::Text(text) => units::quantity(text, dimension).map_err(|error| {
                let problem = format!("{}: {}", self.path, error.problem);
                self.refuse(problem, error.remedy)
            }),
            _ => Err(self.wrong("a number", example(dimension))),
        }
    }

    /// A value in SI, within the limits of `key`.
    pub(super) fn within_limits(&self, key: &Key) -> Result<f64> {
        let dimension = key.dimension();
        let value = self.quantity(dimension)?;
        if !key.allows(value) {
            return Err(self.wrong(&key.limits_in_words(), remedy(key)));
        }
        // -0 counts as 0 if nothing below 0 is allowed.
        let from_zero = key.limits.0 == Bound::Included(0.0);
        Ok(if from_zero { value.abs() } else { value })
    }

    /// A value above zero.
    pub(super) fn positive(&self, dimension: &Dimension) -> Result<f64> {
        let value = self.quantity(dimension)?;
        if value > 0.0 {
            return Ok(value);
        }
        let limit = format!("more than 0 {}", dimension.si);
        Err(self.wrong(limit.trim_end(), example(dimension)))
    }

    /// Three values in SI.
    pub(super) fn vector(&self, dimension: &Dimension) -> Result<[f64; 3]> {
        let [x, y, z] = self.row("the values along x, y and z, such as [0, 0, 1]")?;
        Ok([
            x.quantity(dimension)?,
            y.quantity(dimension)?,
            z.quantity(dimension)?,
        ])
    }

    /// The values of a list of `N`, written in the form `form`.
    pub(super) fn row<const N: usize>(&self, form: &str) -> Result<[Field<'a>; N]> {
        self.listed()
            .and_then(|items| items.try_into().ok())
            .ok_or_else(|| self.wrong(&format!("a list of {N}"), format!("write {form}")))
    }

    /// The values of a list that is not empty.
    pub(super) fn items(&self) -> Result<Vec<Field<'a>>> {
        let Some(items) = self.listed() else {
            return Err(self.wrong("a list", "write it in [ ]"));
        };
        if items.is_empty() {
            let problem = "is an empty list";
            return Err(self.fault(problem, "give at least one, or leave the key out"));
        }
        Ok(items)
    }

    /// The items of a list, which is not empty, or the value itself if it is none.
    pub(super) fn one_or_more(&self) -> Result<Vec<Self>> {
        match self.node.value {
            Value::List(_) => self.items(),
            _ => Ok(vec![self.clone()]),
        }
    }

    /// The values of a list; None for anything else.
    fn listed(&self) -> Option<Vec<Field<'a>>> {
        let Value::List(items) = &self.node.value else {
            return None;
        };
        let item = |(at, node)| Field {
            document: self.document,
            path: format!("{}[{at}]", self.path),
            node,
        };
        Some(items.iter().enumerate().map(item).collect())
    }

    pub(super) fn text(&self) -> Result<&'a str> {
        match &self.node.value {
            Value::Text(text) => Ok(text),
            _ => Err(self.wrong("text", "write it in quotes")),
        }
    }

    /// True or false.
    pub(super) fn boolean(&self) -> Result<bool> {
        match self.node.value {
            Value::Boolean(boolean) => Ok(boolean),
            Value::Text(_) => Err(self.wrong("true or false", "write it without quotes")),
            _ => Err(self.wrong("true or false", "write one of them")),
        }
    }

    /// A whole number from `least` to `most`. With None no largest number is named in messages, but
    /// it must fit into 64 bits.
    pub(super) fn whole(&self, least: u64, most: Option<u64>, remedy: &str) -> Result<u64> {
        let number = match &self.node.value {
            Value::Number(written, _) => written.parse().ok(),
            _ => None,
        };
        let allowed = least..=most.unwrap_or(u64::MAX);
        number
            .filter(|number| allowed.contains(number))
            .ok_or_else(|| {
                let limit = format!("a whole number from {least}");
                let to = most.map_or_else(String::new, |most| format!(" to {most}"));
                self.wrong(&(limit + &to), remedy)
            })
    }

    /// Index of one of `count` particles, from 0.
    pub(super) fn particle(&self, count: u32) -> Result<u32> {
        let remedy = "particles are numbered from 0: correct or remove it";
        let number = self.whole(0, Some(u64::from(count.saturating_sub(1))), remedy)?;
        // Not above the limit, a u32.
        Ok(number as u32)
    }

    /// True if the value is this word.
    pub(super) fn is(&self, word: &str) -> bool {
        matches!(&self.node.value, Value::Text(text) if text == word)
    }

    /// True for text that does not begin like a number.
    pub(super) fn is_word(&self) -> bool {
        matches!(&self.node.value, Value::Text(text) if text.starts_with(char::is_alphabetic))
    }

    /// One of several words.
    pub(super) fn choice<T: Copy>(&self, known: &[(&str, T)]) -> Result<T> {
        let text = self.text()?;
        match known.iter().find(|(word, _)| *word == text) {
            Some((_, meant)) => Ok(*meant),
            None => {
                let problem = format!("is {}, which is unknown", self.shown());
                let remedy = suggestion(text, known.iter().map(|(word, _)| *word));
                Err(self.fault(problem, remedy))
            }
        }
    }

    /// A name of `known`: the names in `[table.NAME]`.
    pub(super) fn reference<'n>(
        &self,
        known: impl Iterator<Item = &'n String>,
        table: &str,
    ) -> Result<String> {
        let name = self.text()?;
        let problem = format!(
            "{} is {}, but nothing in [{table}] has this name",
            self.path,
            self.shown()
        );
        self.named(name, known, table, problem)?;
        Ok(name.to_owned())
    }

    /// Refuses the key `name` of this value if it is not among `known`: the names in
    /// `[table.NAME]`.
    pub(super) fn key_reference<'n>(
        &self,
        name: &str,
        known: impl Iterator<Item = &'n String>,
        table: &str,
    ) -> Result<()> {
        let problem = format!("{}: nothing in [{table}] has this name", self.path);
        self.named(name, known, table, problem)
    }

    /// Refuses `name` with `problem` if it is not among `known`.
    fn named<'n>(
        &self,
        name: &str,
        known: impl Iterator<Item = &'n String>,
        table: &str,
        problem: String,
    ) -> Result<()> {
        let known: Vec<&str> = known.map(String::as_str).collect();
        if known.contains(&name) {
            return Ok(());
        }
        let remedy = if known.is_empty() {
            let name = if well_formed(name) { name } else { "NAME" };
            format!("add [{table}.{name}]")
        } else {
            suggestion(name, known.into_iter())
        };
        Err(self.refuse(problem, remedy))
    }
}

fn example(dimension: &Dimension) -> String {
    let Dimension { si, example, .. } = dimension;
    let quotes = if si.is_empty() { "" } else { "\"" };
    format!(
        "write {} such as {quotes}{example}{quotes}",
        dimension.named()
    )
}

/// The remedy for a number outside the limits of `key`.
pub(super) fn remedy(key: &Key) -> String {
    if key.remedy.is_empty() {
        example(key.dimension())
    } else {
        key.remedy.to_owned()
    }
}
