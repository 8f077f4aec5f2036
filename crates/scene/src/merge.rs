//! What a file of materials changes in tables that a scene has itself, or adds to them.

use super::toml_text::toml;
use super::tree::{Node, Origin, Value, shortened};

/// Keys that decide what the others of their table mean: another value, and the whole table is
/// that of the file.
const DECIDING: [&str; 2] = ["law", "model"];
/// Keys that stand for one another: where a file has one of them, those that it does not have go.
const ALTERNATIVES: [&[&str]; 2] = [
    &["young_modulus", "shear_modulus", "poisson_ratio"],
    &[
        "tensile_strength",
        "compressive_strength",
        "shear_strength",
        "cohesion",
        "friction_angle",
        "von_mises_strength",
        "equivalent_stress",
    ],
];
/// The table of which single keys are taken; others are taken whole.
const FAILURE: &str = "failure";
/// Longest value that is repeated in full, in characters.
const SHOWN: usize = 40;

/// What the keys of a file do to those of a table.
#[derive(Debug, Default)]
struct Changes {
    changed: Vec<String>,
    removed: Vec<String>,
    kept: Vec<String>,
}

/// Takes the keys of a table of a file, over those of a table of the scene. `path`: that of the
/// table. A sentence on what that changes, and on what stays that the file does not have. None:
/// nothing.
pub(super) fn take(own: &mut Node, added: Node, path: &str, file: &str) -> Option<String> {
    let mut changes = Changes::default();
    let decides = |node: &Node, key: &str| entry(node, key).map(toml);
    let differing = DECIDING
        .iter()
        .find(|key| decides(own, key) != decides(&added, key));
    if let Some(key) = differing {
        let before = std::mem::replace(own, added);
        if toml(&before) == toml(own) {
            return None;
        }
        return Some(format!(
            "{file} replaces {path} as a whole, as its {key} is another one: it was {}",
            shortened(&toml(&before), 4 * SHOWN)
        ));
    }
    merge(own, added, path, &mut changes);
    let said = |verb: &str, what: &[String]| {
        (!what.is_empty()).then(|| format!("{verb} {}", what.join(", ")))
    };
    let mut parts: Vec<String> = Vec::new();
    parts.extend(said("changes", &changes.changed));
    parts.extend(said("removes", &changes.removed));
    let kept = said("does not have", &changes.kept);
    parts.extend(kept.map(|kept| format!("{kept}, which the scene keeps")));
    (!parts.is_empty()).then(|| format!("{file} {}", parts.join("; it ")))
}

fn merge(own: &mut Node, added: Node, path: &str, changes: &mut Changes) {
    let (Value::Table(own), Value::Table(added)) = (&mut own.value, added.value) else {
        return;
    };
    let has = |key: &str| added.iter().any(|(name, _)| name == key);
    let replaced = |key: &str| {
        let of_group = ALTERNATIVES.iter().find(|group| group.contains(&key));
        !has(key) && of_group.is_some_and(|group| group.iter().any(|other| has(other)))
    };
    own.retain(|(name, node)| {
        let goes = replaced(name);
        if goes {
            changes.removed.push(shown(path, name, node));
        } else if !has(name) {
            changes.kept.push(shown(path, name, node));
        }
        !goes
    });
    for (name, node) in added {
        match own.iter_mut().find(|(other, _)| *other == name) {
            Some((_, old)) if name == FAILURE && is_table(old) && is_table(&node) => {
                merge(old, node, &format!("{path}.{FAILURE}"), changes);
            }
            Some((_, old)) => {
                if toml(old) != toml(&node) {
                    let to = shortened(&toml(&node), SHOWN);
                    changes
                        .changed
                        .push(format!("{} to {to}", shown(path, &name, old)));
                }
                *old = node;
            }
            None => own.push((name, node)),
        }
    }
}

/// Two values that a scene and its included file have for one key, or keys of which one stands for
/// the other.
#[derive(Debug)]
pub(super) struct Conflict {
    /// Where the scene has it.
    pub(super) own: Origin,
    /// Where the file has it.
    pub(super) added: Origin,
    /// What differs.
    pub(super) problem: String,
}

/// Adds the keys of a table of an included file to a table of the same name. `path`: that of the
/// table. Refuses keys with different values in the two, and keys that stand for one another.
pub(super) fn join(
    own: &mut Node,
    added: Node,
    path: &str,
) -> std::result::Result<(), Box<Conflict>> {
    let (own_at, added_at) = (own.origin, added.origin);
    let conflict = |own: Origin, added: Origin, problem: String| {
        let found = Conflict {
            own,
            added,
            problem,
        };
        Err(Box::new(found))
    };
    let decides = |node: &Node, key: &str| entry(node, key).map(toml);
    let differing = |key: &&&str| decides(own, key) != decides(&added, key);
    if let Some(key) = DECIDING.iter().find(differing) {
        let problem = format!("{path} has another {key}");
        return conflict(own_at, added_at, problem);
    }
    let (Value::Table(own), Value::Table(added)) = (&mut own.value, added.value) else {
        return conflict(own_at, added_at, format!("{path} is not a table in both"));
    };
    for group in ALTERNATIVES {
        let of = |table: &[(String, Node)]| -> Vec<String> {
            let keys = table.iter().map(|(key, _)| key);
            keys.filter(|key| group.contains(&key.as_str()))
                .cloned()
                .collect()
        };
        let (here, there) = (of(own), of(&added));
        let holds = |all: &[String], some: &[String]| some.iter().all(|key| all.contains(key));
        if !holds(&here, &there) && !holds(&there, &here) {
            let [here, there] = [here, there].map(|keys| keys.join(", "));
            let problem = format!("{path} has {here} here, and {there} there");
            return conflict(own_at, added_at, problem);
        }
    }
    for (name, node) in added {
        match own.iter_mut().find(|(other, _)| *other == name) {
            Some((_, old)) if name == FAILURE && is_table(old) && is_table(&node) => {
                join(old, node, &format!("{path}.{FAILURE}"))?;
            }
            Some((_, old)) if toml(old) == toml(&node) => {}
            Some((_, old)) => {
                let there = shortened(&toml(&node), SHOWN);
                let problem = format!("{} here, and {there} there", shown(path, &name, old));
                return conflict(old.origin, node.origin, problem);
            }
            None => own.push((name, node)),
        }
    }
    Ok(())
}

fn is_table(node: &Node) -> bool {
    matches!(node.value, Value::Table(_))
}

fn entry<'a>(node: &'a Node, key: &str) -> Option<&'a Node> {
    match &node.value {
        Value::Table(entries) => {
            let found = entries.iter().find(|(name, _)| name == key);
            found.map(|(_, node)| node)
        }
        _ => None,
    }
}

/// A key with its value: `bonds.cake.young_modulus = "1 GPa"`.
fn shown(path: &str, name: &str, node: &Node) -> String {
    format!("{path}.{name} = {}", shortened(&toml(node), SHOWN))
}
