//! What is written from the schema of scenes and studies: the reference, and the JSON Schema for editors.

mod json;
mod markdown;

use super::root::SCENE;
use super::study::STUDY;

/// Names of files in `doc/`, and their texts.
pub fn files() -> [(&'static str, String); 4] {
    [
        ("scene-keys.md", markdown::page("a scene", &SCENE)),
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
