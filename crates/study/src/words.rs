//! Names with their unit and numbers, on plots and in tables.

use dem_io::units::significant;

/// `name (unit)`.
pub(crate) fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} ({unit})")
    }
}

/// A number with these digits, or nothing.
pub(crate) fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or(String::new(), |value| significant(value, digits))
}

/// Tables of a scene that have no names in them.
const WITHOUT_NAMES: [&str; 4] = ["run", "test", "output", "sleep"];
/// Tables within others whose names add nothing to those of their keys.
const LEFT_OUT: [&str; 3] = ["failure", "damping", "when"];

/// A path of a scene as a reader says it: "drop height of tablet" for `bodies.tablet.drop.height`.
pub(crate) fn in_words(path: &str) -> String {
    let parts: Vec<&str> = path.split('.').map(|part| part.trim_matches('"')).collect();
    let (of, keys) = match parts.as_slice() {
        [table, keys @ ..] if WITHOUT_NAMES.contains(table) => (None, keys),
        [_, name, keys @ ..] if !keys.is_empty() => (Some(*name), keys),
        [_, name] => return (*name).to_owned(),
        all => (None, all),
    };
    let keys = keys.iter().filter(|key| !LEFT_OUT.contains(key));
    let keys: Vec<String> = keys.map(|key| key.replace('_', " ")).collect();
    let words = keys.join(" ");
    let words = words
        .replace("young m", "Young's m")
        .replace("poisson r", "Poisson's r")
        .replace("weibull m", "Weibull m");
    of.map_or(words.clone(), |name| format!("{words} of {name}"))
}

#[cfg(test)]
mod tests {
    use super::in_words;

    #[test]
    fn paths_are_said_in_words() {
        for (path, words) in [
            ("bodies.tablet.drop.height", "drop height of tablet"),
            (
                "bonds.cake.failure.tensile_strength",
                "tensile strength of cake",
            ),
            (
                "contacts.cake-steel.restitution",
                "restitution of cake-steel",
            ),
            ("run.safety_factor", "safety factor"),
            ("bonds.cake.young_modulus", "Young's modulus of cake"),
            ("largest_fragment", "largest fragment"),
            ("bodies.cake", "cake"),
        ] {
            assert_eq!(in_words(path), words);
        }
    }
}
