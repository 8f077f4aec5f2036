//! The names in doc/notation.md are those of the code.

use std::collections::BTreeSet;
use std::path::Path;

/// Adds the words of all Rust files in a folder.
fn add_words(folder: &Path, words: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            add_words(&path, words);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let of_text = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
            words.extend(of_text.map(str::to_owned));
        }
    }
}

#[test]
fn names_of_the_notation_are_those_of_the_code() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut words = BTreeSet::new();
    for name in ["io", "laboratory", "packer", "physics", "scene", "solver"] {
        add_words(&root.join("crates").join(name).join("src"), &mut words);
    }
    let page = std::fs::read_to_string(root.join("doc/notation.md")).unwrap();
    let rows = page.lines().filter_map(|line| line.split('|').nth(2));
    // Between backquotes: every second part.
    let names = rows.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    let is_name = |c: char| c.is_alphanumeric() || "_:".contains(c);
    let mut seen = 0;
    for name in names.filter(|name| name.chars().all(is_name)) {
        for part in name.split("::") {
            assert!(words.contains(part), "{name} is not in the code");
        }
        seen += 1;
    }
    assert!(seen > 100, "{seen}");
}
