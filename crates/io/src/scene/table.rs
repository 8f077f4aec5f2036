//! One table of a scene: hands out its values by key.

use super::field::Field;
use super::names::{suggestion, well_formed};
use super::tree::{Document, Node, Origin, Value, shortened};
use crate::{Diagnostic, Result};

/// A table of the scene, with its path for messages.
pub(super) struct Table<'a> {
    pub(super) document: &'a Document,
    /// As in `bodies.bar`; empty for the whole file.
    pub(super) path: String,
    pub(super) origin: Origin,
    pub(super) entries: &'a [(String, Node)],
}

impl<'a> Table<'a> {
    /// The whole file.
    pub(super) fn root(document: &'a Document) -> Result<Self> {
        let root = Field {
            document,
            path: String::new(),
            node: &document.root,
        };
        root.any_table()
    }

    /// Refuses keys that are not among `known`.
    pub(super) fn refuse_unknown(&self, known: &[&str]) -> Result<()> {
        let unknown = |(key, _): &&(String, Node)| !known.contains(&key.as_str());
        let Some((key, node)) = self.entries.iter().find(unknown) else {
            return Ok(());
        };
        let field = self.field(key, node);
        let problem = match node.value {
            Value::Table(_) if self.path.is_empty() => {
                format!("unknown table [{}]", field.path)
            }
            _ => format!("unknown key {}", field.path),
        };
        Err(field.refuse(problem, suggestion(key, known.iter().copied())))
    }

    /// The value of a key, if it is there.
    pub(super) fn get(&self, key: &str) -> Option<Field<'a>> {
        let (name, node) = self.entries.iter().find(|(name, _)| name == key)?;
        Some(self.field(name, node))
    }

    /// The value at the end of `keys`, each in the table of the one before, if it is there.
    pub(super) fn find(&self, keys: &[&str]) -> Option<Field<'a>> {
        let (first, rest) = keys.split_first()?;
        let mut field = self.get(first)?;
        for key in rest {
            field = field.any_table().ok()?.get(key)?;
        }
        Some(field)
    }

    /// What `read` makes of a key, if it is there.
    pub(super) fn read<T>(
        &self,
        key: &str,
        read: impl FnOnce(Field<'a>) -> Result<T>,
    ) -> Result<Option<T>> {
        self.get(key).map(read).transpose()
    }

    /// Those of `keys` that are there, in the order of the file, with their values.
    pub(super) fn given(
        &self,
        keys: &[&'static str],
    ) -> impl Iterator<Item = (&'static str, Field<'a>)> {
        self.entries.iter().filter_map(|(name, node)| {
            let key = keys.iter().find(|key| *key == name)?;
            Some((*key, self.field(name, node)))
        })
    }

    /// The value of a key that must be there; `example` is how it may look.
    pub(super) fn need(&self, key: &str, example: &str) -> Result<Field<'a>> {
        self.get(key).ok_or_else(|| {
            let problem = format!("{} is missing", joined(&self.path, key));
            self.refuse(problem, format!("add {key} = {example}"))
        })
    }

    /// A message at the head of this table.
    pub(super) fn refuse(
        &self,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::input(self.document.place(self.origin), problem, remedy)
    }

    /// The named tables in the table `key`: `[key.NAME]`; none if it is not there.
    ///
    /// # Errors
    /// No table, or a name with other characters than letters, digits, - and _.
    pub(super) fn named(&self, key: &str) -> Result<Vec<(String, Field<'a>)>> {
        let Some(field) = self.get(key) else {
            return Ok(Vec::new());
        };
        let Ok(table) = field.any_table() else {
            return Err(field.wrong("a table of tables", format!("write [{key}.NAME]")));
        };
        let mut found = Vec::new();
        for (name, node) in table.entries {
            let field = table.field(name, node);
            if !well_formed(name) {
                let problem = format!("'{}' in [{key}] is no name", shortened(name, 40));
                let remedy = "names are made of letters a to z, digits, - and _";
                return Err(field.refuse(problem, remedy));
            }
            found.push((name.clone(), field));
        }
        Ok(found)
    }

    /// The value `node` of a key.
    pub(super) fn field(&self, key: &str, node: &'a Node) -> Field<'a> {
        Field {
            document: self.document,
            path: joined(&self.path, key),
            node,
        }
    }
}

fn joined(path: &str, key: &str) -> String {
    let quoted = if well_formed(key) {
        key.to_owned()
    } else {
        format!("\"{}\"", key.escape_debug())
    };
    if path.is_empty() {
        quoted
    } else {
        format!("{path}.{quoted}")
    }
}
