//! One table of a scene: gives its values by key, according to its schema.

use std::fmt::Display;

use super::field::Field;
use super::names::{suggestion, well_formed};
use super::schema::{Key, Schema, Unless};
use super::tree::{Document, Node, Origin, Value, shortened};
use dem_io::diagnostic::{Diagnostic, Result};

/// A table of the scene, with its path for messages.
#[derive(Clone)]
pub(super) struct Table<'a> {
    pub(super) document: &'a Document,
    /// As in `bodies.bar`; empty for the entire file.
    pub(super) path: String,
    pub(super) origin: Origin,
    pub(super) entries: &'a [(String, Node)],
    schema: &'static Schema,
}

/// A type as which the value of a key can be read.
pub(super) trait Read: Sized {
    /// From the given value.
    fn given(field: &Field<'_>, key: &Key) -> Result<Self>;

    /// The value if the key is left out; None if it is required.
    fn unless_given(usual: Unless) -> Option<Self>;

    /// The value as shown in the listing of a scene, in SI.
    fn told(&self, key: &Key) -> String;
}

/// The schema of a table that may hold any keys.
static ANY: Schema = Schema {
    title: "",
    doc: "",
    keys: &[],
};

impl<'a> Table<'a> {
    /// The entire file, which may hold any keys until [`Table::refuse_unknown`].
    pub(super) fn root(document: &'a Document, schema: &'static Schema) -> Result<Self> {
        let root = Field {
            document,
            path: String::new(),
            node: &document.root,
        };
        let table = Self::any(&root)?;
        Ok(Self { schema, ..table })
    }

    /// The table in `field`, if it has no other keys than `schema`.
    pub(super) fn of(field: &Field<'a>, schema: &'static Schema) -> Result<Self> {
        let table = Self {
            schema,
            ..Self::any(field)?
        };
        table.refuse_unknown()?;
        Ok(table)
    }

    /// The table in `field`, with any keys.
    pub(super) fn any(field: &Field<'a>) -> Result<Self> {
        let Value::Table(entries) = &field.node.value else {
            let remedy = format!("write it as [{}], or in {{ }}", field.path);
            return Err(field.wrong("a table", remedy));
        };
        Ok(Self {
            document: field.document,
            path: field.path.clone(),
            origin: field.node.origin,
            entries,
            schema: &ANY,
        })
    }

    /// The table `name` within this one; an empty one if it is left out.
    pub(super) fn table(&self, name: &str, schema: &'static Schema) -> Result<Self> {
        match self.get(name) {
            Some(field) => Self::of(&field, schema),
            None => Ok(Self {
                document: self.document,
                path: joined(&self.path, name),
                origin: self.origin,
                entries: &[],
                schema,
            }),
        }
    }

    /// Refuses keys that the schema lacks.
    pub(super) fn refuse_unknown(&self) -> Result<()> {
        let unknown = |(key, _): &&(String, Node)| self.schema.key(key).is_none();
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
        Err(field.refuse(problem, suggestion(key, self.schema.names())))
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
            field = Self::any(&field).ok()?.get(key)?;
        }
        Some(field)
    }

    /// The value of a key, or its default.
    pub(super) fn read<T: Read>(&self, name: &str) -> Result<T> {
        let key = self.key(name)?;
        if let Some(field) = self.get(name) {
            return T::given(&field, key);
        }
        T::unless_given(key.unless_given).ok_or_else(|| self.missing(key))
    }

    /// The result of `read` for a key, if it is there.
    pub(super) fn read_by<T>(
        &self,
        name: &str,
        read: impl FnOnce(Field<'a>) -> Result<T>,
    ) -> Result<Option<T>> {
        self.get(name).map(read).transpose()
    }

    /// Those of `keys` that are given, in the order of the file, with their values.
    pub(super) fn given(
        &self,
        keys: &[&'static str],
    ) -> impl Iterator<Item = (&'static str, Field<'a>)> {
        self.entries.iter().filter_map(|(name, node)| {
            let key = keys.iter().find(|key| *key == name)?;
            Some((*key, self.field(name, node)))
        })
    }

    /// The one of `keys` that is given, with its value, if there is one.
    ///
    /// # Errors
    /// Several are given; `remedy`: the remedy for that.
    pub(super) fn at_most_one(
        &self,
        keys: &[&'static str],
        remedy: &str,
    ) -> Result<Option<(&'static str, Field<'a>)>> {
        let mut given = self.given(keys);
        match (given.next(), given.next()) {
            (Some((first, _)), Some((_, second))) => {
                Err(second.fault(format!("cannot be combined with {first}"), remedy))
            }
            (only, _) => Ok(only),
        }
    }

    /// The value of a required key.
    pub(super) fn need(&self, name: &str) -> Result<Field<'a>> {
        let key = self.key(name)?;
        self.get(name).ok_or_else(|| self.missing(key))
    }

    /// The value of a required key; `example` is a possible form.
    pub(super) fn need_such(&self, name: &str, example: &str) -> Result<Field<'a>> {
        self.get(name).ok_or_else(|| self.without(name, example))
    }

    fn missing(&self, key: &Key) -> Diagnostic {
        match key.unless_given {
            Unless::Required(example) | Unless::SometimesRequired(example) => {
                self.without(key.name, example)
            }
            _ => self.without(key.name, key.dimension().example),
        }
    }

    fn without(&self, name: &str, example: &str) -> Diagnostic {
        let problem = format!("{} is missing", joined(&self.path, name));
        self.refuse(problem, format!("add {name} = {example}"))
    }

    fn key(&self, name: &str) -> Result<&'static Key> {
        self.schema.key(name).ok_or_else(|| {
            let problem = format!("the schema of this table has no {name}");
            Diagnostic::failed(
                self.path.clone(),
                problem,
                "tell the authors of this program",
            )
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

    /// A message at the head of this table, which begins with its path: "loads.pull has no effect".
    pub(super) fn fault(&self, problem: impl Display, remedy: impl Into<String>) -> Diagnostic {
        self.refuse(format!("{} {problem}", self.path), remedy)
    }

    /// The named tables in the table `key`: `[key.NAME]`; none if it is not there. Names have only
    /// letters, digits, - and _.
    pub(super) fn named(&self, key: &str) -> Result<Vec<(String, Field<'a>)>> {
        let Some(field) = self.get(key) else {
            return Ok(Vec::new());
        };
        let Ok(table) = Self::any(&field) else {
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
