//! A scene as it is run: the same scene, read from another folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf, absolute};

use dem_scene::{Scene, piped_bodies, read_scene, scene_as_run};
use tempfile::tempdir;

use super::corpus::files;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every value of a scene; paths as those of the files that they lead to.
fn values(scene: &Scene) -> BTreeMap<String, String> {
    let is_path = |key: &str| {
        [".file", ".stl", "test.measured"]
            .iter()
            .any(|end| key.ends_with(end))
    };
    // Some scenes name folders that do not exist.
    let real = |path: &str| {
        let mut real = PathBuf::new();
        for part in absolute(path).unwrap().components() {
            match part {
                Component::ParentDir => assert!(real.pop()),
                part => real.push(part),
            }
        }
        real.display().to_string()
    };
    let values = scene
        .values()
        .into_iter()
        .filter(|(key, _)| !["output.folder", "include"].contains(&key.as_str()));
    let value = |(key, value): (String, String)| {
        let value = if is_path(&key) && value != "-" {
            real(&value)
        } else {
            value
        };
        (key, value)
    };
    values.map(value).collect()
}

/// The scene as run in a folder, written there and read again; and its text.
fn again(path: &Path, scene: &Scene, overrides: &[String], folder: &Path) -> (Scene, String) {
    let text = fs::read_to_string(path).unwrap();
    let written = scene_as_run(&text, scene, overrides, folder).unwrap();
    let file = folder.join("scene.toml");
    fs::write(&file, &written).unwrap();
    let read = read_scene(&file, &[]).unwrap_or_else(|error| panic!("{error}\n{written}"));
    (read, written)
}

#[test]
fn every_scene_reads_back_from_another_folder() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/good");
    let folders = [
        own,
        root().join("tests/scenes/good"),
        root().join("data/scenes"),
    ];
    let mut count = 0;
    for path in folders.iter().flat_map(|folder| files(folder)) {
        let folder = tempdir().unwrap();
        let deeper = folder.path().join("a/b c");
        fs::create_dir_all(&deeper).unwrap();
        let scene = read_scene(&path, &[]).unwrap();
        let (read, text) = again(&path, &scene, &[], &deeper);
        assert_eq!(values(&read), values(&scene), "{}", path.display());
        // Written once more from there, it is the same text.
        let twice = scene_as_run(&text, &read, &[], &deeper).unwrap();
        assert_eq!(twice, text, "{}", path.display());
        count += 1;
    }
    assert!(count > 30, "{count} scenes");
}

#[test]
fn settings_included_files_and_bodies_are_in_it() {
    let folder = tempdir().unwrap();
    let scenes = folder.path().join("scenes");
    let out = folder.path().join("out");
    fs::create_dir_all(&scenes).unwrap();
    fs::create_dir_all(&out).unwrap();
    fs::write(
        scenes.join("stone.toml"),
        "[materials.stone]\ndensity = 2600\n",
    )
    .unwrap();
    let path = scenes.join("ball.toml");
    let text = "version = 1\ninclude = [\"stone.toml\"]\n[run]\nend_time = \"1 s\" # long\n\
        [bodies.ball]\nfile = \"ball.vtp\"\nmaterial = \"stone\"\n[output]\nfolder = \"old\"\nseries = \"1 ms\"\n";
    fs::write(&path, text).unwrap();
    let overrides = ["run.end_time=2 s", "run.gravity=[0, 0, -1.62]"].map(str::to_owned);
    let scene = read_scene(&path, &overrides).unwrap();
    let (read, text) = again(&path, &scene, &overrides, &out);
    assert_eq!(values(&read), values(&scene));
    assert_eq!(read.run.end_time_s, 2.0);
    assert_eq!(
        text,
        "version = 1\n\n[run]\nend_time = \"2 s\"\ngravity = [0, 0, -1.62]\n\n\
         [bodies.ball]\nfile = \"../scenes/ball.vtp\"\nmaterial = \"stone\"\n\n\
         [output]\nseries = \"1 ms\"\n\n[materials.stone]\ndensity = 2600\n"
    );
    assert!(piped_bodies(&read).is_empty());
}
