//! Invalid scenes, options and folders: one message with the place, exit code 2, no files left.

use super::{Bench, dem_run, good, refused, scene_of_data};

/// The message of dem-run for these arguments; nothing may be written.
fn said_of(bench: &Bench, arguments: &[&str]) -> String {
    let before = bench.files();
    let output = dem_run()
        .current_dir(bench.path(""))
        .args(arguments)
        .output()
        .unwrap();
    let (said, code) = refused(&output);
    assert_eq!(code, 2, "{said}");
    assert_eq!(bench.files(), before);
    said
}

fn assert_says(bench: &Bench, arguments: &[&str], parts: &[&str]) {
    let said = said_of(bench, arguments);
    for part in parts {
        assert!(
            said.contains(part),
            "{arguments:?}: '{part}' is not in: {said}"
        );
    }
}

#[test]
fn scenes_that_are_none() {
    let bench = Bench::new();
    bench.write("binary.toml", b"version = 1\n\xff\xfe");
    bench.write("prose.toml", "Once upon a time.\n");
    bench.write("empty.toml", "");
    bench.write("scene.yaml", "version: 1\n");
    std::fs::create_dir(bench.path("folder.toml")).unwrap();
    std::fs::create_dir(bench.path("folder")).unwrap();
    assert_says(
        &bench,
        &["none.toml"],
        &["none.toml: there is no such file"],
    );
    assert_says(&bench, &["folder.toml"], &["folder.toml: this is a folder"]);
    assert_says(&bench, &["folder"], &["folder: this is a folder"]);
    assert_says(
        &bench,
        &["binary.toml"],
        &["binary.toml:2: this is not text", "UTF-8"],
    );
    assert_says(&bench, &["prose.toml"], &["prose.toml:1"]);
    assert_says(&bench, &["empty.toml"], &["empty.toml", "version"]);
    assert_says(&bench, &["scene.yaml"], &["scene.yaml", ".yaml"]);
    for scene in ["none.toml", "folder.toml", "binary.toml"] {
        assert_says(&bench, &["check", scene], &[scene]);
    }
}

#[test]
fn options() {
    let bench = Bench::new();
    bench.write("row.vtp", super::vtp_bytes(&super::row(4)));
    let path = scene_of_data("cantilever.toml");
    let scene = path.to_str().unwrap();
    for (options, parts) in [
        (
            &["--set", "run.endtime=3"][..],
            &["--set run.endtime=3", "did you mean 'end_time'"][..],
        ),
        (&["--set", "run.end_time"], &["there is no ="]),
        (
            &["--set", "run.end_time=soon"],
            &["--set run.end_time=soon", "soon"],
        ),
        (&["--set", "run.end_time=1 parsec"], &["parsec"]),
        (&["--set", "loads.tip.group=top"], &["top"]),
        (&["--body", "bar="], &["--body bar=", "no file is named"]),
        (&["--body", ""], &["no file is named"]),
        (&["--body", "rod=row.vtp"], &["no body 'rod'", "bar"]),
        (
            &["--body", "none.vtp"],
            &["[bodies.bar]", "none.vtp", "no such file"],
        ),
        (&["--body", "bar=row"], &["[bodies.bar]", "no ending"]),
        (
            &["--body", "row.vtp", "--body", "row.data"],
            &["--body row.data: the body 'bar' has its file from --body row.vtp already"],
        ),
        (
            &["--body", "-", "--body", "-"],
            &["--body -: the body 'bar' has its file from --body - already"],
        ),
        (&["--threads", "0"], &["--threads", "1 and 1024"]),
        (&["--threads", "1025"], &["--threads", "1025"]),
    ] {
        assert_says(&bench, &[&[scene], options].concat(), parts);
    }
    let several = good("bodies.toml");
    let several = several.to_str().unwrap();
    assert_says(
        &bench,
        &[several, "--body", "row.vtp"],
        &["3 bodies", "--body NAME=row.vtp", "a, b, ball"],
    );
    assert_says(
        &bench,
        &[several, "--body", "a=-", "--body", "b=-"],
        &["[bodies.b]", "standard input"],
    );
    assert_says(
        &bench,
        &[several, "--body", "a=row.vtp", "--body", "a=none.vtp"],
        &["--body a=none.vtp: the body 'a' has its file from --body a=row.vtp already"],
    );
    for option in [
        &["--output", "x"][..],
        &["--set", "a=1"],
        &["--force"],
        &["--resume"],
        &["--force-step"],
    ] {
        assert_says(
            &bench,
            &[&["row.vtp"], option].concat(),
            &[option[0], "row.vtp"],
        );
    }
    for options in [
        &["other.vtp", "--body", "row.vtp"][..],
        &["--body", "row.vtp", "--body", "-"],
    ] {
        assert_says(
            &bench,
            options,
            &["--body: there is no scene for it to go into"],
        );
    }
}

#[test]
fn arguments_that_do_not_go_together_show_the_usage() {
    let bench = Bench::new();
    for arguments in [
        &["a.toml", "b.toml"][..],
        &["a.toml", "--force", "--resume"],
        &["check"],
        &["a.toml", "--threads", "x"],
    ] {
        let output = dem_run()
            .current_dir(bench.path(""))
            .args(arguments)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            said.starts_with("error: ") && said.contains("--help"),
            "{said}"
        );
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn json_and_quiet_do_not_hide_what_is_wrong() {
    let bench = Bench::new();
    assert_says(
        &bench,
        &["none.toml", "--json", "--quiet"],
        &["no such file"],
    );
}

#[test]
fn a_scene_whose_body_is_not_there_names_the_option() {
    let bench = Bench::new();
    let scene = scene_of_data("clamped.toml");
    assert_says(
        &bench,
        &[scene.to_str().unwrap()],
        &[
            "clamped.toml: [bodies.sample]: ",
            "bending-sample.vtp: there is no such file; make it, or name another file with --body",
        ],
    );
}
