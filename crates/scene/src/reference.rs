//! Files generated from the schema of scenes and studies: the reference, and the JSON Schema for
//! editors.

mod json;
mod markdown;

use super::root::SCENE;
use super::schema::Kind;
use super::study::STUDY;

/// Names of files in `doc/`, and their texts.
pub fn files() -> [(&'static str, String); 4] {
    [
        (
            "scene-keys.md",
            markdown::page("a scene", &SCENE) + &markdown::conflicts(),
        ),
        ("study-keys.md", markdown::page("a study", &STUDY)),
        (
            "scene.schema.json",
            json::text("A scene of Crumble", &SCENE),
        ),
        (
            "study.schema.json",
            json::text("A study of Crumble", &STUDY),
        ),
    ]
}

/// The table of a scene, such as `output`, that has this key. None: there is no such key, or only
/// in tables that have names.
pub fn table_of(key: &str) -> Option<&'static str> {
    let tables = SCENE.keys.iter();
    let mut having = tables.filter(|table| match &table.kind {
        Kind::Table(schema) => schema.key(key).is_some(),
        _ => false,
    });
    having.next().map(|table| table.name)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{SCENE, STUDY, markdown};
    use crate::schema::{Kind, Schema, Unless};

    fn tables() -> Vec<&'static Schema> {
        [&SCENE, &STUDY].map(markdown::tables).concat()
    }

    #[test]
    fn defaults_are_of_the_kind_and_within_the_limits_of_their_keys() {
        for table in tables() {
            for key in table.keys {
                let fits = match (key.unless_given, &key.kind) {
                    (Unless::Number(usual), Kind::Quantity(_)) => key.allows(usual),
                    (Unless::Number(usual), Kind::Whole { least, .. }) => {
                        usual.fract() == 0.0 && usual >= *least as f64
                    }
                    (Unless::Number(usual), Kind::Vector(_) | Kind::Table(_)) => usual == 0.0,
                    (Unless::Word(usual), Kind::Word(words)) => words().contains(&usual),
                    (Unless::Word(usual), Kind::Auto(_)) => usual == "auto",
                    (Unless::Boolean(_), kind) => matches!(kind, Kind::Boolean),
                    (Unless::Number(_), _) => false,
                    _ => true,
                };
                assert!(fits, "{} {}", table.title, key.name);
            }
        }
    }

    #[test]
    fn names_are_unique_and_sentences_whole() {
        for table in tables() {
            let names: BTreeSet<&str> = table.names().collect();
            assert_eq!(names.len(), table.keys.len(), "{}", table.title);
            for key in table.keys {
                assert!(key.doc.ends_with('.'), "{} {}", table.title, key.name);
            }
        }
    }
}
