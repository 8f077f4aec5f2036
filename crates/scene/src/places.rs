//! Places of the keys of a scene, for messages about a scene that has been read already.

use std::path::Path;

use super::include::document_of;
use super::paths::text_of;
use super::tree::{Document, Node, Value};
use dem_io::diagnostic::Result;

/// The places of the keys of a scene.
#[derive(Debug)]
pub struct Places(Document);

impl Places {
    /// Those of the scene that [`super::read_scene`] reads with the same arguments.
    ///
    /// # Errors
    /// The file cannot be read, or is not TOML.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self> {
        let text = text_of(path, "a scene")?;
        let (document, _) = document_of(&text, &path.display().to_string(), overrides)?;
        Ok(Self(document))
    }

    /// File and line, or the option, of a key such as `walls.plate.stl`, or else of the table that
    /// would have it. None: neither is written, as it comes from defaults or from a file that the
    /// scene names. Pairs of materials are found in either order.
    pub fn of(&self, key: &str) -> Option<String> {
        let keys: Vec<&str> = key.split('.').collect();
        let mut node = &self.0.root;
        let mut found = 0;
        for key in &keys {
            let Some(next) = entry(node, key, keys[0] == "contacts") else {
                break;
            };
            (node, found) = (next, found + 1);
        }
        // The table of all walls is no place for one of them.
        (found >= keys.len().min(2)).then(|| self.0.place(node.origin))
    }
}

fn entry<'a>(table: &'a Node, key: &str, in_either_order: bool) -> Option<&'a Node> {
    let Value::Table(entries) = &table.value else {
        return None;
    };
    let is_pair = |name: &str| {
        let mut halves = name.match_indices('-');
        in_either_order
            && halves.any(|(at, _)| format!("{}-{}", &name[at + 1..], &name[..at]) == key)
    };
    let found = entries.iter().find(|(name, _)| name == key);
    let found = found.or_else(|| entries.iter().find(|(name, _)| is_pair(name)));
    found.map(|(_, node)| node)
}
