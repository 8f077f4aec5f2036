//! Writes the reference of keys and the JSON Schemas of scenes and studies into `doc/`:
//! `cargo run -p dem-scene --example scene_reference`, from the root of the repository.

use std::path::Path;

fn main() -> std::io::Result<()> {
    for (name, text) in dem_scene::reference::files() {
        std::fs::write(Path::new("doc").join(name), text)?;
    }
    Ok(())
}
