//! `--set KEY=VALUE`: values given on the command line, which override those of the file.

use super::tree::{Document, Node, Origin, Value, parse_value};
use dem_io::diagnostic::{Diagnostic, Result};

impl Document {
    /// Applies a `--set` text to the file: `run.end_time="0.5 s"`. A value that is not TOML is
    /// taken as text, without quotes. Missing tables and keys are added; unknown ones are refused
    /// when they are read.
    ///
    /// # Errors
    /// No `=`, an empty key, a list or table that is not TOML, or a key inside a plain value.
    pub(super) fn set(&mut self, text: &str) -> Result<()> {
        let option = self.options.len();
        self.options.push(text.to_owned());
        let origin = Origin::Option(option);
        let place = self.place(origin);
        let form = "write KEY=VALUE, such as run.end_time=\"0.5 s\"";
        let Some((path, value)) = text.split_once('=') else {
            return Err(Diagnostic::input(place, "there is no =", form));
        };
        let keys: Vec<&str> = path.split('.').map(str::trim).collect();
        if keys.iter().any(|key| key.is_empty()) {
            return Err(Diagnostic::input(place, "a key is empty", form));
        }
        if keys.len() > DEEPEST {
            let problem = format!(
                "the key has {} parts; none has more than {DEEPEST}",
                keys.len()
            );
            return Err(Diagnostic::input(place, problem, form));
        }
        let value = value_of(value.trim(), option).map_err(|message| {
            let remedy = "correct the value, and keep the shell from changing it with '...' around";
            Diagnostic::input(
                place.clone(),
                format!("the value is not TOML: {message}"),
                remedy,
            )
        })?;
        insert(&mut self.root, &keys, value).map_err(|within| {
            Diagnostic::input(
                place,
                format!("{} is no table", keys[..within].join(".")),
                "set it as a whole",
            )
        })
    }
}

/// Largest number of parts of a key, as in `bodies.bar.rotation.angle`.
const DEEPEST: usize = 4;

fn value_of(text: &str, option: usize) -> std::result::Result<Node, String> {
    match parse_value(text, option) {
        Err(message) if text.starts_with(['[', '{', '"', '\'']) => Err(message),
        Err(_) => Ok(Node {
            origin: Origin::Option(option),
            value: Value::Text(text.to_owned()),
        }),
        Ok(node) => Ok(node),
    }
}

/// Puts `node` at the end of the path `keys`. The error is the number of keys up to a value that is
/// not a table.
fn insert(root: &mut Node, keys: &[&str], node: Node) -> std::result::Result<(), usize> {
    let origin = node.origin;
    let mut here = root;
    for (depth, key) in keys.iter().enumerate() {
        let Value::Table(entries) = &mut here.value else {
            return Err(depth);
        };
        let at = match entries.iter().position(|(name, _)| name == key) {
            Some(at) => at,
            None => {
                let value = Value::Table(Vec::new());
                entries.push(((*key).to_owned(), Node { origin, value }));
                entries.len() - 1
            }
        };
        here = &mut entries[at].1;
    }
    *here = node;
    Ok(())
}
