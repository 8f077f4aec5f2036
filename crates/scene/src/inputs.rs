//! The files read for a scene.

use std::path::PathBuf;

use super::body::BodySource;
use super::region::Region;
use super::root::Scene;
use super::wall::WallShape;
use dem_io::body::files::body_files;

impl Scene {
    /// The scene's own file, those that it includes, and those of its bodies, walls and regions,
    /// except standard input.
    pub fn input_files(&self) -> Vec<PathBuf> {
        let mut files = vec![PathBuf::from(&self.source)];
        files.extend(self.included.iter().cloned());
        for body in self.bodies.values() {
            if let BodySource::File(path) = &body.source {
                // A name that is not that of a body has been refused, or will be when it is read.
                files.extend(body_files(path).unwrap_or_default());
            }
        }
        for wall in self.walls.values() {
            if let WallShape::Stl { path, .. } = &wall.shape {
                files.push(path.clone());
            }
        }
        for region in self.regions.values() {
            if let Region::Stl { file, .. } = region {
                files.push(file.clone());
            }
        }
        let measured = self.test.as_ref().and_then(|test| test.measured.as_ref());
        files.extend(measured.map(|measured| measured.file.clone()));
        files
    }
}
