//! The file that a program is asked to write: its folder exists, and it is none of those that are
//! read.

use std::fs;
use std::path::{Path, PathBuf};

use crate::diagnostic::{Diagnostic, Result};

/// True if two names refer to the same file, also through links of both types. False for a device
/// or a missing file.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let (Ok(a), Ok(b)) = (fs::metadata(one), fs::metadata(other)) else {
        return false;
    };
    if !(a.is_file() && b.is_file()) {
        return false;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        (a.dev(), a.ino()) == (b.dev(), b.ino())
    }
    #[cfg(not(unix))]
    {
        let whole = [one, other].map(fs::canonicalize);
        matches!(whole, [Ok(a), Ok(b)] if a == b)
    }
}

/// Refuses to write `target`, called `place` in messages (an option or a file), if it is one of the
/// files that are read, also through a link.
pub fn refuse_input(place: &str, target: &Path, inputs: &[PathBuf]) -> Result<()> {
    match inputs.iter().find(|input| is_same_file(target, input)) {
        None => Ok(()),
        Some(input) => Err(Diagnostic::input(
            place,
            format!(
                "'{}' is read here and would be overwritten",
                input.display()
            ),
            "name another file",
        )),
    }
}

/// Checks before the work that the folder for a file exists; else bad input (exit code 2).
pub fn need_folder_of(target: &Path) -> Result<()> {
    if folder_of(target).is_dir() {
        return Ok(());
    }
    let (problem, remedy) = no_folder_of(target);
    Err(Diagnostic::input(
        target.display().to_string(),
        problem,
        remedy,
    ))
}

/// Refuses to overwrite files that are read, under whatever name.
pub fn refuse_to_replace(written: &[PathBuf], read: &[PathBuf]) -> Result<()> {
    for target in written {
        if let Some(input) = read.iter().find(|input| is_same_file(target, input)) {
            let problem = if target == input {
                "it would replace the file that it is made from".to_owned()
            } else {
                format!(
                    "it would replace '{}', which it is made from",
                    input.display()
                )
            };
            return Err(Diagnostic::input(
                target.display().to_string(),
                problem,
                "write to another name",
            ));
        }
    }
    Ok(())
}

/// Problem and remedy of a file whose folder is missing.
pub(crate) fn no_folder_of(target: &Path) -> (String, &'static str) {
    let folder = folder_of(target).display();
    (
        format!("there is no folder '{folder}'"),
        "make it first, or write elsewhere",
    )
}

pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_file_is_not_written_over_itself() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("cake.vtp"), "").unwrap();
        fs::hard_link(path("cake.vtp"), path("hard.vtp")).unwrap();
        fs::write(path("other.vtp"), "").unwrap();
        let refused = |name: &str| refuse_to_replace(&[path(name)], &[path("cake.vtp")]);
        assert!(refused("new.vtp").is_ok() && refused("other.vtp").is_ok());
        let said = refused("cake.vtp").unwrap_err();
        assert_eq!(said.exit_code(), 2);
        assert!(
            said.problem.contains("the file that it is made from"),
            "{said}"
        );
        assert!(
            refused("hard.vtp")
                .unwrap_err()
                .problem
                .contains("cake.vtp")
        );
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("cake.vtp", path("soft.vtp")).unwrap();
            assert!(refused("soft.vtp").is_err());
        }
    }

    #[cfg(unix)]
    #[test]
    fn the_same_file_is_known_by_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("a"), "x").unwrap();
        fs::write(path("b"), "x").unwrap();
        std::os::unix::fs::symlink(path("a"), path("link")).unwrap();
        fs::hard_link(path("a"), path("hard")).unwrap();
        for other in ["a", "link", "hard", "../a"] {
            let other = match other.strip_prefix("../") {
                Some(name) => path(&format!(
                    "../{}/{name}",
                    folder.path().file_name().unwrap().display()
                )),
                None => path(other),
            };
            assert!(is_same_file(&path("a"), &other), "{}", other.display());
            let said = refuse_input("here", &other, &[path("b"), path("a")]).unwrap_err();
            assert_eq!(said.exit_code(), 2);
            assert!(
                said.problem
                    .ends_with("a' is read here and would be overwritten"),
                "{said}"
            );
        }
        assert!(!is_same_file(&path("a"), &path("b")) && !is_same_file(&path("no"), &path("no")));
        assert_eq!(refuse_input("here", &path("new"), &[path("a")]), Ok(()));
    }
}
