//! Names of files that have no meaning, do not exist, or cannot be written.

use std::path::Path;

use dem_io::body::{read_body, write_body};

use super::bodies::{triangle, with_derived_bonds};

#[test]
fn an_unknown_ending_lists_the_known_ones() {
    for name in ["cake.xyz", "cake", "cake.", ".vtp", "folder.vtp/cake"] {
        for error in [
            read_body(Path::new(name)).unwrap_err(),
            write_body(&triangle(), Path::new(name)).unwrap_err(),
        ] {
            assert_eq!((error.exit_code(), error.place.as_str()), (2, name));
            for known in [".vtp", ".data", ".lmp", ".lammps", ".csv", ".txt", " - "] {
                assert!(error.remedy.contains(known), "{error}");
            }
        }
    }
}

#[test]
fn a_shape_is_no_body_yet() {
    let said = read_body(Path::new("a b/cake.STL"))
        .unwrap_err()
        .to_string();
    let fill = "fill it first: dem-pack a b/cake.STL --diameter 2mm..3mm -o a b/cake.vtp";
    assert_eq!(
        said,
        format!("a b/cake.STL: this is a shape, not a body; {fill}")
    );
    let said = read_body(Path::new("part.STEP")).unwrap_err().to_string();
    assert_eq!(
        said,
        "part.STEP: a file of the format STEP, which has no triangles; export it as STL or 3MF from the program that made it, or from FreeCAD"
    );
    let said = write_body(&triangle(), Path::new("cake.stl")).unwrap_err();
    assert!(
        said.problem.contains("'.stl' is not the ending of a body"),
        "{said}"
    );
}

#[test]
fn missing_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for (name, file) in [
        ("a.vtp", "a.vtp"),
        ("b.csv", "b.particles.csv"),
        ("c.bonds.txt", "c.particles.txt"),
    ] {
        let error = read_body(&path(name)).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert_eq!(error.place, path(file).display().to_string());
        assert_eq!(error.problem, "there is no such file");
    }
    std::fs::create_dir(path("folder.vtp")).unwrap();
    assert_eq!(
        read_body(&path("folder.vtp")).unwrap_err().problem,
        "this is a folder"
    );
}

#[test]
fn of_two_files_none_appears_if_one_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("cake.bonds.csv")).unwrap();
    let error = write_body(&triangle(), &folder.path().join("cake.csv")).unwrap_err();
    assert_eq!(
        (error.exit_code(), error.problem.as_str()),
        (1, "this is a folder")
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_body_that_breaks_the_rules_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut body = triangle();
    body.radii[1] = 0.0;
    let error = write_body(&body, &folder.path().join("cake.vtp")).unwrap_err();
    assert!(
        error.to_string().contains("particle 1: its radius is 0 m"),
        "{error}"
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["full.vtp", "full.data"] {
        let link = folder.path().join(name);
        std::os::unix::fs::symlink("/dev/full", &link).unwrap();
        let error = write_body(&with_derived_bonds(triangle()), &link).unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(error.problem.starts_with("no space left"), "{error}");
    }
}
