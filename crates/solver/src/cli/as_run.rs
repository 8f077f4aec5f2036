//! The scene as it is run, next to its results.

use std::path::Path;

use dem_io::Result;
use dem_results::ResultsFolder;
use dem_scene::{Scene, piped_bodies, scene_as_run, text_of};

use super::scene_arguments::SceneArguments;

/// Writes the scene of a run, with `--set`, `--material`, `include` and `--body` in it, to
/// `scene.toml` in its folder.
pub(super) fn write_scene(
    folder: &ResultsFolder,
    arguments: &SceneArguments,
    scene: &Scene,
) -> Result<()> {
    let file = arguments.file.as_deref().unwrap_or(Path::new(""));
    let text = text_of(file, "a scene")?;
    let text = scene_as_run(&text, scene, &arguments.all_overrides(), folder.path())?;
    let force = if arguments.force_step {
        " --force-step"
    } else {
        ""
    };
    let mut head = format!(
        "# Paths are relative to this file. To run it again: dem-run scene.toml{force} --output FOLDER\n"
    );
    for body in piped_bodies(scene) {
        head += &format!(
            "# The body '{body}' came from standard input: pipe it in again, or add --body {body}=FILE.\n"
        );
    }
    let program = concat!("dem-run ", env!("CARGO_PKG_VERSION"));
    folder.write_scene(program, &format!("{head}\n{text}"))
}
