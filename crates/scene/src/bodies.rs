//! The bodies named in a scene.

use std::collections::BTreeMap;
use std::path::Path;

use dem_io::body::files::body_files;
use dem_io::body::read_body;
use dem_io::{Body, Result};

use super::body::BodySource;
use super::root::Scene;

/// The bodies of a scene by name, from their files or from the scene itself.
pub fn read_bodies(scene: &Scene) -> Result<BTreeMap<String, Body>> {
    let mut bodies = BTreeMap::new();
    for (name, entry) in &scene.bodies {
        let body = match &entry.source {
            BodySource::File(path) => read_body(path).map_err(|mut error| {
                if is_missing(path) {
                    error.remedy = "make it, or name another file with --body".to_owned();
                }
                error
            }),
            BodySource::Inline { particles, bonds } => Body::from_spheres(particles, bonds),
        };
        let within = format!("{}: [bodies.{name}]", scene.source);
        bodies.insert(name.clone(), body.map_err(|error| error.within(&within))?);
    }
    Ok(bodies)
}

fn is_missing(path: &Path) -> bool {
    body_files(path).is_ok_and(|files| files.iter().any(|file| !file.exists()))
}
