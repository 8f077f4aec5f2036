//! Inputs of a run are never removed or overwritten by its output.
#![cfg(unix)]

use std::fs;
use std::path::Path;

use super::{Bench, dem_run, good, names_in, refused, row, vtp_bytes};

/// A scene in the folder of its own results, with a body and a wall in it under names of results.
fn scene(bench: &Bench, file: &str, wall: &str) {
    bench.write(
        "case.toml",
        format!(
            "version = 1\nrun.end_time = \"1 us\"\nmaterials.m = {{ density = 1000, young_modulus = \"1 MPa\" }}\n\
             bonds.m = {{ young_modulus = \"1 MPa\", poisson_ratio = 0.3 }}\n\
             contacts.m-m = {{ restitution = 0.5 }}\n\
             bodies.row = {{ file = \"{file}\", material = \"m\", bonds = \"m\", position = [0, 0, 3] }}\n\
             walls.floor = {{ {wall}, material = \"m\" }}\n"
        ),
    );
}

const PLANE: &str = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }";

#[test]
fn results_do_not_take_the_place_of_inputs() {
    let bench = Bench::new();
    let body = vtp_bytes(&row(3));
    fs::create_dir(bench.path("frames")).unwrap();
    fs::create_dir(bench.path("elsewhere")).unwrap();
    let frame = bench.write("frames/frame_000003.vtp", &body);
    std::os::unix::fs::symlink(&frame, bench.path("elsewhere/link.vtp")).unwrap();
    let kept = bench.write("elsewhere/body.vtp", &body);
    for file in [
        "frames/frame_000003.vtp",
        "./elsewhere/../frames/frame_000003.vtp",
        "elsewhere/link.vtp",
    ] {
        scene(&bench, file, PLANE);
        for option in ["--force", "--resume"] {
            let said = bench.bad(Path::new("case.toml"), &["--output", ".", option], 2);
            assert!(
                said.starts_with(&format!("error: {file}: this is an input of the run, and results in '.' would take its place; name another folder")),
                "{said}"
            );
        }
        assert_eq!(fs::read(&frame).unwrap(), body);
    }
    // A name of results that is a link to an input.
    scene(&bench, "elsewhere/body.vtp", PLANE);
    for name in ["series.csv", "summary.json"] {
        std::os::unix::fs::symlink(&kept, bench.path(name)).unwrap();
        let said = bench.bad(Path::new("case.toml"), &["--output", ".", "--force"], 2);
        assert!(
            said.contains("elsewhere/body.vtp: this is an input of the run"),
            "{said}"
        );
        fs::remove_file(bench.path(name)).unwrap();
    }
    std::os::unix::fs::symlink(bench.path("case.toml"), bench.path("events.csv")).unwrap();
    let said = bench.bad(Path::new("case.toml"), &["--output", ".", "--force"], 2);
    assert!(
        said.contains("case.toml: this is an input of the run"),
        "{said}"
    );
    fs::remove_file(bench.path("events.csv")).unwrap();
    // Inputs under other names are kept, also in the folder of results.
    fs::copy(&kept, bench.path("own.vtp")).unwrap();
    scene(&bench, "own.vtp", PLANE);
    let text = fs::read(bench.path("case.toml")).unwrap();
    bench.good(
        Path::new("case.toml"),
        &["--output", ".", "--force", "--quiet"],
    );
    assert_eq!(fs::read(bench.path("own.vtp")).unwrap(), body);
    assert_eq!(fs::read(bench.path("case.toml")).unwrap(), text);
    assert_eq!(fs::read(&kept).unwrap(), body);
}

#[test]
fn a_fragment_is_not_written_over_results_and_inputs() {
    let bench = Bench::new();
    bench.write("row.vtp", vtp_bytes(&row(5)));
    bench.write("other.vtp", vtp_bytes(&row(4)));
    scene(&bench, "row.vtp", PLANE);
    bench.good(Path::new("case.toml"), &["--output", "out", "--quiet"]);
    let frame = names_in(&bench.path("out/frames")).remove(0);
    let frame = format!("out/frames/{frame}");
    std::os::unix::fs::symlink(bench.path(&frame), bench.path("link.vtp")).unwrap();
    let fragment = |results: &str, output: &str| {
        let mut command = dem_run();
        command.current_dir(bench.path(""));
        let before =
            [&frame, "row.vtp", "other.vtp"].map(|name| fs::read(bench.path(name)).unwrap());
        let said = refused(
            &command
                .args(["fragment", results, "--largest", "-o", output])
                .output()
                .unwrap(),
        );
        let after =
            [&frame, "row.vtp", "other.vtp"].map(|name| fs::read(bench.path(name)).unwrap());
        assert!(before == after);
        assert_eq!(said.1, 2);
        said.0
    };
    for output in [&frame, "link.vtp"] {
        let said = fragment("out", output);
        assert_eq!(
            said,
            format!(
                "error: {output}: this is one of the results in 'out'; name another file with --output"
            )
        );
    }
    assert_eq!(
        fragment("out", "row.vtp"),
        "error: row.vtp: 'row.vtp' is read here and would be overwritten; name another file"
    );
    // The body named on the command line is known from the checkpoint.
    bench.good(
        Path::new("case.toml"),
        &["--output", "other", "--body", "other.vtp", "--quiet"],
    );
    assert!(fragment("other", "other.vtp").contains("'other.vtp' is read here"));
    // Other files may be written, also repeatedly.
    for _ in 0..2 {
        let mut command = dem_run();
        command.current_dir(bench.path(""));
        let output = command
            .args(["fragment", "out", "--largest", "-o", "piece.vtp"])
            .output()
            .unwrap();
        assert!(output.status.success());
    }
}

/// Output that would fill the disk is refused by its count, before anything is written; `check`
/// gives the same message.
#[test]
fn a_step_limits_how_often_is_written() {
    let bench = Bench::new();
    // As many frames as steps, which are few, however short the interval is.
    bench.good(
        &good("alone.toml"),
        &["--output", "out", "--set", "output.frames=1e-300 s"],
    );
    let frames = names_in(&bench.path("out/frames")).len();
    assert!((2..100_000).contains(&frames), "{frames}");
}
