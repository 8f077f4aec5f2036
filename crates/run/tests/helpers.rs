//! Scenes from texts.

use dem_scene::Scene;
use dem_scene::scene_from_text;

/// The scene of a valid text.
pub(crate) fn scene(text: &str) -> Scene {
    scene_from_text(text, "test.toml", &[]).unwrap_or_else(|error| panic!("{error}: {text}"))
}
