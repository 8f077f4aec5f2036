//! Names: their allowed form, and suggestions for misspelt ones.

/// `did you mean 'end_time'?`, or the known names if none is similar.
pub(super) fn suggestion<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    let nearest = known
        .iter()
        .map(|candidate| (edit_distance(name, candidate), *candidate))
        .min_by_key(|(distance, _)| *distance);
    match nearest {
        None => "there are none".to_owned(),
        Some((distance, candidate)) if near(distance, name, candidate) => {
            format!("did you mean '{candidate}'?")
        }
        Some(_) => {
            let more = if known.len() > MOST_NAMES {
                ", ..."
            } else {
                ""
            };
            let listed = &known[..known.len().min(MOST_NAMES)];
            format!("known: {}{more}", listed.join(", "))
        }
    }
}

/// All particles of the scene.
pub(super) const ALL: &str = "all";

/// The fragments of bodies.
pub(super) const FRAGMENTS: &str = "fragments";

/// The meaning of a reserved name; None for a name that is free.
pub(super) fn meaning(name: &str) -> Option<&'static str> {
    match name {
        ALL => Some("all particles of the scene"),
        FRAGMENTS => Some("the fragments of the scene"),
        _ => None,
    }
}

/// Largest number of names listed in a message.
const MOST_NAMES: usize = 30;

/// True if one name may be a misspelling of the other: at most a third of the letters differ, and
/// not all of them.
fn near(distance: usize, name: &str, candidate: &str) -> bool {
    let length = candidate.chars().count();
    3 * distance <= length + 2 && distance < length.max(name.chars().count())
}

/// Smallest number of letters inserted, removed, replaced or swapped with their neighbour that
/// turns `a` into `b`.
fn edit_distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().take(LONGEST_COMPARED).collect();
    let b: Vec<char> = b.chars().take(LONGEST_COMPARED).collect();
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let replaced = last[j] + usize::from(a[i] != b[j]);
            let mut best = replaced.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                best = best.min(before[j - 1] + 1);
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

/// Number of leading letters up to which names are compared.
const LONGEST_COMPARED: usize = 64;

/// True if `name` consists of letters, digits, - and _.
pub(super) fn well_formed(name: &str) -> bool {
    !name.is_empty()
        && name
            .bytes()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, b'-' | b'_'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        for (a, b, distance) in [
            ("", "", 0),
            ("end_tim", "end_time", 1),
            ("end_tmie", "end_time", 1),
            ("steel", "stone", 3),
            ("", "abc", 3),
        ] {
            assert_eq!(edit_distance(a, b), distance, "{a} {b}");
            assert_eq!(edit_distance(b, a), distance, "{b} {a}");
        }
    }

    #[test]
    fn suggestions() {
        let known = || ["end_time", "rest", "seed"].into_iter();
        assert_eq!(suggestion("end_tim", known()), "did you mean 'end_time'?");
        assert_eq!(suggestion("colour", known()), "known: end_time, rest, seed");
        assert_eq!(suggestion("x", std::iter::empty()), "there are none");
        assert_eq!(suggestion("w", ["x", "y"].into_iter()), "known: x, y");
        let many = vec!["some"; 1000];
        assert!(suggestion("colour", many.into_iter()).ends_with("some, ..."));
    }
}
