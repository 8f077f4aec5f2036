//! The listing of a scene: keys and values in order.

use super::schema::{Key, Schema};
use super::table::Read;

/// Largest number of items of a list that are written out.
pub(super) const LISTED: usize = 8;

/// The lines of one table.
pub(super) struct Listing {
    /// As in `bodies.bar`.
    path: String,
    schema: &'static Schema,
    pub(super) lines: Vec<(String, String)>,
    /// True if all values so far are the defaults.
    pub(super) is_usual: bool,
}

impl Listing {
    pub(super) fn new(path: impl Into<String>, schema: &'static Schema) -> Self {
        Self {
            path: path.into(),
            schema,
            lines: Vec::new(),
            is_usual: true,
        }
    }

    /// A line for the key `name`, in its unit.
    pub(super) fn value(&mut self, name: &str, value: &impl Read) {
        if let Some(key) = self.schema.key(name) {
            let text = value.told(key);
            self.is_usual &= text == key.usual();
            self.text(name, text);
        }
    }

    /// The default of the key `name` as text.
    pub(super) fn usual(&self, name: &str) -> String {
        self.schema.key(name).map_or_else(String::new, Key::usual)
    }

    /// A line of text.
    pub(super) fn text(&mut self, name: &str, text: impl Into<String>) {
        self.lines
            .push((format!("{}.{name}", self.path), text.into()));
    }

    /// A line of the first few of this number of items.
    pub(super) fn some(&mut self, name: &str, shown: &[String], count: usize) {
        let mut text = shown.join(", ");
        if count > shown.len() {
            text.push_str(&format!(", ... ({count} in all)"));
        }
        self.text(name, text);
    }

    /// The lines of a table within this one.
    pub(super) fn table(
        &mut self,
        name: &str,
        schema: &'static Schema,
        list: impl FnOnce(&mut Self),
    ) {
        let mut inner = Self::new(format!("{}.{name}", self.path), schema);
        list(&mut inner);
        self.lines.append(&mut inner.lines);
    }
}
