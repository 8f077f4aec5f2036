//! Scenes with a mistake: the files `bad/*.cases`, each a scene, and changes of it with the message
//! that each leads to.
//!
//! The scene ends at the line `====`. A case is a change in one or more lines, and a message:
//!
//! - `TABLE.KEY = VALUE`: the line of this key is replaced, or added at the end of its table.
//! - `- TABLE.KEY`, `- TABLE`: this line, or this table with those below it, is left out.
//! - `[TABLE] KEY = VALUE; KEY = VALUE`: a table is added at the end, each key in a line.
//! - `+ TEXT`: a line is added at the end, as it is.
//! - `> LINE: MESSAGE`: what the reader says, after the name of the file. A new case has `>` alone;
//!   `RENEW_MESSAGES=1` writes the rest.
//!
//! Lines that begin with `#` are remarks.

mod change;

use std::path::{Path, PathBuf};

use dem_scene::scene_from_text;

use change::change;

/// Fewest cases: an empty folder would pass.
const FEWEST: usize = 600;

/// Name of the scene in messages.
const NAME: &str = "scene.toml";

/// A scene with a mistake.
pub(super) struct Case {
    pub(super) scene: String,
    /// The expected message, from the number of the line on.
    pub(super) message: String,
    /// Line of the message in the file of cases, from 0.
    line: usize,
}

/// The files of cases, sorted.
pub(super) fn paths() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/bad");
    let files = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    paths.sort();
    paths
}

/// The scene without a mistake of a file of cases, and the cases.
pub(super) fn read(path: &Path) -> (String, Vec<Case>) {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().enumerate();
    let scene: Vec<String> = lines
        .by_ref()
        .map(|(_, line)| line.to_owned())
        .take_while(|line| !line.starts_with("===="))
        .collect();
    let mut changed = scene.clone();
    let mut cases = Vec::new();
    for (at, line) in lines {
        let place = format!("{}:{}", path.display(), at + 1);
        if let Some(message) = line.strip_prefix('>') {
            assert!(changed != scene, "{place}: a message without a change");
            cases.push(Case {
                scene: text_of(&changed),
                message: message.trim().to_owned(),
                line: at,
            });
            changed.clone_from(&scene);
        } else if !line.is_empty() && !line.starts_with('#') {
            let done = change(&mut changed, line);
            assert!(done.is_some(), "{place}: the scene has no place for this");
        }
    }
    assert!(
        changed == scene,
        "{}: no message at the end",
        path.display()
    );
    (text_of(&scene), cases)
}

fn text_of(lines: &[String]) -> String {
    lines.join("\n") + "\n"
}

/// What the reader says of a case, which stands at `place`.
fn refusal(case: &Case, place: &str) -> String {
    let Err(error) = scene_from_text(&case.scene, NAME, &[]) else {
        panic!("{place}: this scene is read without an error");
    };
    assert_eq!(error.exit_code(), 2, "{place}: {error}");
    let text = error.to_string();
    text.strip_prefix(NAME).unwrap()[1..].to_owned()
}

#[test]
fn every_bad_scene_is_refused_with_its_message() {
    let renews = std::env::var_os("RENEW_MESSAGES").is_some();
    let mut count = 0;
    let mut wrong = String::new();
    for path in paths() {
        let (scene, cases) = read(&path);
        if let Err(error) = scene_from_text(&scene, NAME, &[]) {
            panic!("the scene of {}: {error}", path.display());
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for case in &cases {
            let place = format!("{}:{}", path.display(), case.line + 1);
            let found = refusal(case, &place);
            if found != case.message && !renews {
                wrong += &format!("{place}\nexpected {}\ngot      {found}\n", case.message);
            }
            lines[case.line] = format!("> {found}");
        }
        if renews {
            std::fs::write(&path, text_of(&lines)).unwrap();
        }
        count += cases.len();
    }
    assert!(count >= FEWEST, "{count} cases");
    assert!(
        wrong.is_empty(),
        "after a look at them, RENEW_MESSAGES=1 writes them anew:\n{wrong}"
    );
}
