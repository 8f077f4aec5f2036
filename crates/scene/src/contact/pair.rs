//! The two materials named by a key of `[contacts]`: "cake-steel", where names may themselves
//! contain a "-".

use std::collections::BTreeMap;

use crate::field::Field;
use crate::material::Material;
use crate::names::suggestion;
use crate::tree::shortened;
use dem_io::diagnostic::{Diagnostic, Result};

/// The materials of `key`, sorted: it is split at the "-" that has a name of `materials` on both
/// sides. Refuses a key without such a "-", or with several that give different pairs.
pub(super) fn named_pair(
    key: &str,
    field: &Field<'_>,
    materials: &BTreeMap<String, Material>,
) -> Result<[String; 2]> {
    let is_known = |name: &str| materials.contains_key(name);
    let mut pairs: Vec<[&str; 2]> = splits(key)
        .filter(|sides| sides.iter().all(|name| is_known(name)))
        .collect();
    pairs.iter_mut().for_each(|pair| pair.sort_unstable());
    pairs.sort_unstable();
    pairs.dedup();
    match pairs.as_slice() {
        [pair] => Ok(pair.map(str::to_owned)),
        [] => Err(unknown(key, field, materials)),
        [[a, b], [c, d], ..] => {
            let problem = format!("means \"{a}\" with \"{b}\" as well as \"{c}\" with \"{d}\"");
            Err(field.fault(problem, "rename one of these materials"))
        }
    }
}

/// The two sides of every "-" in `key`, if neither is empty.
fn splits(key: &str) -> impl Iterator<Item = [&str; 2]> {
    key.match_indices('-')
        .map(|(at, dash)| [&key[..at], &key[at + dash.len()..]])
        .filter(|sides| sides.iter().all(|name| !name.is_empty()))
}

/// The error for a `key` that is not a pair: it is one material, or one of its sides is not a
/// material.
fn unknown(key: &str, field: &Field<'_>, materials: &BTreeMap<String, Material>) -> Diagnostic {
    let is_known = |name: &str| materials.contains_key(name);
    let half_known = |sides: &[&str; 2]| sides.iter().any(|name| is_known(name));
    let split = splits(key).find(half_known).or_else(|| splits(key).next());
    let stranger = split.and_then(|sides| sides.into_iter().find(|name| !is_known(name)));
    match stranger {
        Some(name) if !is_known(key) => {
            let problem = format!(
                "is of \"{}\", but nothing in [materials] has this name",
                shortened(name, 40)
            );
            let known = materials.keys().map(String::as_str);
            field.fault(problem, suggestion(name, known))
        }
        _ => {
            let first = materials.keys().next().map_or("NAME", String::as_str);
            let last = materials.keys().last().map_or("NAME", String::as_str);
            let [a, b] = if is_known(key) {
                [key, key]
            } else {
                [first, last]
            };
            let remedy =
                format!("write two names of [materials] with - between them, such as {a}-{b}");
            field.fault("is no pair of materials", remedy)
        }
    }
}
