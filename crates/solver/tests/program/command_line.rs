//! Help, man page, completions.

use super::{Bench, dem_run, refused, scene_of_data};

fn said(arguments: &[&str]) -> String {
    let output = dem_run().args(arguments).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() && errors.is_empty(),
        "{arguments:?}: {errors}"
    );
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn help_man_page_and_completions_name_every_option() {
    for arguments in [
        &["--help"][..],
        &["man"],
        &["completions", "bash"],
        &["completions", "zsh"],
        &["completions", "fish"],
    ] {
        // A man page has its hyphens escaped; fish's completions name options without them.
        let text = said(arguments).replace("\\-", "-").replace("-l ", "--");
        for option in [
            "--body",
            "--set",
            "--force-step",
            "--output",
            "--resume",
            "--quiet",
            "--json",
        ] {
            assert!(text.contains(option), "{option} is not in {arguments:?}");
        }
        for command in ["check", "fragment", "sweep", "stress", "completions", "man"] {
            assert!(text.contains(command), "{command} is not in {arguments:?}");
        }
    }
    // A script also has the options of subcommands.
    assert!(said(&["completions", "bash"]).contains("--collect"));
    assert!(said(&["man"]).starts_with(".ie"));
}

#[test]
fn help_and_man_page_tell_the_exit_codes() {
    let codes = "0 done, 1 failed while running, 2 bad input, 3 unstable, 130 interrupted";
    for arguments in [&["--help"][..], &["man"]] {
        assert!(said(arguments).contains(codes), "{arguments:?}");
    }
}

#[test]
fn a_shell_that_is_none_is_refused() {
    let output = dem_run().args(["completions", "word"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
}

/// What `dem-run` says of bad arguments, and that the exit code is 2.
fn refusal(arguments: &[&str]) -> String {
    let (said, code) = refused(&dem_run().args(arguments).output().unwrap());
    assert_eq!(code, 2, "{said}");
    said
}

#[test]
fn arguments_are_refused_on_one_line() {
    for (arguments, parts) in [
        (
            &["pictures", "d4"][..],
            "dem-run pictures: there is no such command, and no such file; name a scene (.toml), or one of the commands check, new, keys, ",
        ),
        (
            &["tablet.stl"],
            "tablet.stl: this is a shape, not a body; fill it first: dem-pack tablet.stl --diameter 2mm..3mm -o tablet.vtp",
        ),
        (
            &["scene.toml", "--sett", "a=1"],
            "unexpected argument '--sett' found",
        ),
        (
            &["scene.toml", "--threads", "x"],
            "invalid value 'x' for '--threads <N>'",
        ),
        (
            &["new", "milling", "x"],
            "invalid value 'milling' for '<TYPE>'",
        ),
        (&["run", "gone.toml"], "gone.toml: there is no such file"),
        (&["fragment", "results"], "--largest"),
    ] {
        let said = refusal(arguments);
        assert!(said.contains(parts), "{arguments:?}: {said}");
    }
    let said = refusal(&["scene.toml", "--sett", "a=1"]);
    assert!(said.ends_with("; see dem-run --help"), "{said}");
    let said = refusal(&["new"]);
    assert!(said.ends_with("; see dem-run new --help"), "{said}");
    assert_eq!(
        refusal(&["scene.toml", "--pictures", "1ms"]),
        "error: unexpected argument '--pictures' found; it is a value of the scene: --set output.pictures=VALUE"
    );
    for (arguments, said) in [
        (
            &["scene.toml", "--threads", "-1"][..],
            "error: invalid value '-1' for '--threads <N>': it is not a whole number of 0 or more; see dem-run --help",
        ),
        (
            &["picture", "out", "-o", "x.png", "--zoom", "-2"],
            "error: --zoom: -2 is not above 0 and at most 10000; 2 shows half of the width",
        ),
    ] {
        assert_eq!(refusal(arguments), said);
    }
}

#[test]
fn the_word_run_may_stand_before_the_scene() {
    let scene = scene_of_data("spinning-bar.toml").display().to_string();
    let plain = said(&["check", &scene]);
    assert!(!plain.is_empty());
    let bench = Bench::new();
    let out = |first: &[&str]| {
        let folder = bench.path(&format!("out-{}", first.len()));
        let folder = folder.display().to_string();
        let short = [
            "--set",
            "run.end_time=1 ms",
            "--quiet",
            "--json",
            "--output",
            &folder,
        ];
        let arguments = [first, &[scene.as_str()], &short[..]].concat();
        let json: serde_json::Value = serde_json::from_str(&said(&arguments)).unwrap();
        json["steps"].clone()
    };
    assert_eq!(out(&["run"]), out(&[]));
}

/// Colours are for terminals, unless they are forced.
#[test]
fn colours_stay_out_of_pipes() {
    let bench = Bench::new();
    let scene = scene_of_data("spinning-bar.toml").display().to_string();
    let output = |forced: bool, arguments: &[&str]| {
        let mut command = dem_run();
        command.args(arguments).current_dir(bench.folder.path());
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
        if forced {
            command.env("CLICOLOR_FORCE", "1");
        }
        let output = command.output().unwrap();
        [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap())
    };
    let [plain, _] = output(false, &[&scene, "--set", "run.end_time=1 ms"]);
    let [coloured, _] = output(true, &[&scene, "--set", "run.end_time=1 ms", "--force"]);
    assert!(!plain.contains('\u{1b}') && plain.contains("\nverdict "));
    assert!(
        coloured.contains("\u{1b}[1m\u{1b}[32mverdict\u{1b}[0m "),
        "{coloured:?}"
    );
    let [_, plain] = output(false, &["gone.toml"]);
    let [_, coloured] = output(true, &["gone.toml"]);
    assert!(plain.starts_with("error: "));
    assert_eq!(
        coloured,
        plain.replace("error:", "\u{1b}[1m\u{1b}[31merror:\u{1b}[0m")
    );
}
