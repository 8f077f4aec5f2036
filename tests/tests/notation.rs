//! The names in doc/inside/notation.md are those of the code: a member belongs to its type, and a
//! name alone is there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::root;

/// The words of the code, and those within the definition and the methods of each type.
#[derive(Default)]
struct Names {
    all: BTreeSet<String>,
    of_type: BTreeMap<String, BTreeSet<String>>,
}

fn words(text: &str) -> impl Iterator<Item = String> {
    let is_of_word = |c: char| c.is_alphanumeric() || c == '_';
    text.split(move |c| !is_of_word(c)).map(str::to_owned)
}

impl Names {
    /// Adds all Rust files in a folder.
    fn add(&mut self, folder: &Path) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                self.add(&path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                self.all.extend(words(&text));
                self.add_types(&text);
            }
        }
    }

    /// A formatted text: an item, which a macro may indent, ends with the first brace below its
    /// first letter.
    fn add_types(&mut self, text: &str) {
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            let item = line.trim_start();
            if let Some(name) = type_of(item) {
                let end = format!("{}}}", &line[..line.len() - item.len()]);
                let body = lines.by_ref().take_while(|line| *line != end);
                let members = body.flat_map(|line| words(line.split("//").next().unwrap()));
                self.of_type.entry(name).or_default().extend(members);
            }
        }
    }

    fn has(&self, name: &str) -> bool {
        match name.split_once("::") {
            Some((owner, member)) => self
                .of_type
                .get(owner)
                .is_some_and(|members| members.contains(member)),
            None => self.all.contains(name),
        }
    }
}

/// The type whose definition or methods begin with this line.
fn type_of(line: &str) -> Option<String> {
    let line = line.strip_suffix('{')?;
    let line = line.strip_prefix("pub(crate) ").unwrap_or(line);
    let line = line.strip_prefix("pub ").unwrap_or(line);
    let (kind, rest) = line.split_at(line.find([' ', '<'])?);
    let named = match kind {
        "struct" | "enum" | "trait" => rest,
        "impl" => match rest.split_once(" for ") {
            Some((_, of_trait)) => of_trait,
            None if rest.starts_with('<') => rest.split_once("> ")?.1,
            None => rest,
        },
        _ => return None,
    };
    words(named.trim()).next()
}

#[test]
fn names_of_the_notation_are_those_of_the_code() {
    let mut names = Names::default();
    for of_crate in fs::read_dir(root().join("crates")).unwrap() {
        names.add(&of_crate.unwrap().path().join("src"));
    }
    assert!(names.has("State::time_s") && !names.has("State::gravity_m_s2"));
    let page = fs::read_to_string(root().join("doc/inside/notation.md")).unwrap();
    let rows = page.lines().filter_map(|line| line.split('|').nth(2));
    // Between backquotes: every second part.
    let listed = rows.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    let is_name = |c: char| c.is_alphanumeric() || "_:".contains(c);
    let listed: Vec<&str> = listed.filter(|name| name.chars().all(is_name)).collect();
    assert!(listed.len() > 100, "{}", listed.len());
    let unknown: Vec<&&str> = listed.iter().filter(|name| !names.has(name)).collect();
    assert!(unknown.is_empty(), "not in the code: {unknown:?}");
}
