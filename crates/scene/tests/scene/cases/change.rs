//! Changes of the text of a scene.

use std::ops::Range;

/// Changes a scene as a line of a case says. None if it lacks the place to change.
pub(super) fn change(scene: &mut Vec<String>, line: &str) -> Option<()> {
    if let Some(path) = line.strip_prefix("- ") {
        return remove(scene, path);
    }
    if let Some(text) = line.strip_prefix("+ ") {
        scene.push(text.to_owned());
    } else if line.starts_with('[') {
        add_table(scene, line);
    } else {
        let (path, value) = line.split_once(" = ")?;
        let (name, key) = split(path);
        let table = table(scene, name)?;
        let new = format!("{key} = {value}");
        match line_of(scene, table.clone(), key) {
            Some(at) => scene[at] = new,
            None => scene.insert(table.end, new),
        }
    }
    Some(())
}

fn add_table(scene: &mut Vec<String>, line: &str) {
    match line.split_once("] ") {
        Some((header, keys)) => {
            scene.push(format!("{header}]"));
            scene.extend(keys.split("; ").map(str::to_owned));
        }
        None => scene.push(line.to_owned()),
    }
}

/// Removes the line of a key, or a table with those below it.
fn remove(scene: &mut Vec<String>, path: &str) -> Option<()> {
    let (name, key) = split(path);
    if let Some(at) = table(scene, name).and_then(|table| line_of(scene, table, key)) {
        scene.remove(at);
        return Some(());
    }
    let count = scene.len();
    let mut is_within = false;
    scene.retain(|line| {
        if line.starts_with('[') {
            is_within = *line == format!("[{path}]") || line.starts_with(&format!("[{path}."));
        }
        !is_within
    });
    (scene.len() < count).then_some(())
}

/// The name of a table, empty for that of the scene, and a key in it.
fn split(path: &str) -> (&str, &str) {
    path.rsplit_once('.').unwrap_or(("", path))
}

/// The lines of a table below its header, up to the last that is not empty.
fn table(scene: &[String], name: &str) -> Option<Range<usize>> {
    let start = match name {
        "" => 0,
        _ => 1 + scene.iter().position(|line| *line == format!("[{name}]"))?,
    };
    let mut end = start;
    for (at, line) in scene.iter().enumerate().skip(start) {
        if line.starts_with('[') {
            break;
        }
        if !line.is_empty() {
            end = at + 1;
        }
    }
    Some(start..end)
}

fn line_of(scene: &[String], mut table: Range<usize>, key: &str) -> Option<usize> {
    table.find(|at| matches!(scene[*at].split_once(" = "), Some((other, _)) if other == key))
}
