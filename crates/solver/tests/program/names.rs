//! Names with characters that control a terminal or a browser: they are shown, never executed.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::Output;

use super::{Bench, good};

/// Red letters, a line of its own, reversed writing direction, and a script.
const NASTY: &str = "\u{1b}[31mred\n\u{9b}2J\u{202e}\u{2066}<script>alert(1)<";

fn is_obeyed(letter: char) -> bool {
    let turns =
        ('\u{202a}'..='\u{202e}').contains(&letter) || ('\u{2066}'..='\u{2069}').contains(&letter);
    turns || (letter.is_control() && letter != '\n')
}

fn assert_plain(what: &str, bytes: &[u8]) {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    let found = text.chars().find(|letter| is_obeyed(*letter));
    assert_eq!(found, None, "{what}: {text:?}");
    assert!(
        !text.lines().any(|line| line.starts_with("2J")),
        "{what}: a name made a line: {text:?}"
    );
}

/// Standard output and standard error, which must be plain.
fn plain(what: &str, output: &Output) -> String {
    assert_plain(what, &output.stdout);
    assert_plain(what, &output.stderr);
    let all = [output.stdout.clone(), output.stderr.clone()].concat();
    String::from_utf8(all).unwrap()
}

/// The pages and pictures of a folder and its subfolders, as text.
fn assert_pages_plain(folder: &Path) -> usize {
    let mut count = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            count += assert_pages_plain(&path);
        }
        if path
            .extension()
            .is_some_and(|ending| ending == "svg" || ending == "html")
        {
            let bytes = fs::read(&path).unwrap();
            assert_plain(&path.display().to_string(), &bytes);
            assert!(
                !String::from_utf8(bytes).unwrap().contains("<script>alert"),
                "{}",
                path.display()
            );
            count += 1;
        }
    }
    count
}

#[test]
fn of_files_are_shown_in_what_is_said_and_on_pages() {
    let bench = Bench::new();
    let scene = bench.write(
        &format!("{NASTY}.toml"),
        fs::read(good("breaking.toml")).unwrap(),
    );
    let scene = Path::new(scene.file_name().unwrap());
    let out = format!("out{NASTY}");
    let run = |options: &[&str]| bench.run(scene, options);
    let said = plain("run", &run(&["--output", &out]));
    assert!(
        said.contains("\\u{1b}[31mred\\u{a}\\u{9b}2J\\u{202e}\\u{2066}<script>alert(1)<.toml"),
        "{said}"
    );
    assert_pages_plain(&bench.path(&out));
    // All kinds of refusals name the scene or the folder.
    plain("not empty", &run(&["--output", &out]));
    plain("no such value", &run(&["--set", &format!("run.{NASTY}=1")]));
    plain(
        "no such body",
        &run(&["--body", &format!("bar={NASTY}.vtp")]),
    );
    plain("over", &run(&["--output", &out, "--resume"]));
    let json = run(&["--json", "--output", &out, "--force"]);
    plain("json", &json);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(json["scene"], format!("{NASTY}.toml"));
    for options in [&[][..], &["--json"]] {
        let mut check = super::dem_run();
        check
            .current_dir(bench.path(""))
            .arg("check")
            .arg(scene)
            .args(options);
        plain("check", &check.output().unwrap());
    }
    let mut fragment = super::dem_run();
    fragment
        .current_dir(bench.path(""))
        .arg("fragment")
        .arg(&out)
        .args(["--largest", "-o"]);
    let said = plain(
        "fragment",
        &fragment.arg(format!("{NASTY}.vtp")).output().unwrap(),
    );
    assert!(said.contains("fragment "), "{said}");
    let mut body = super::dem_run();
    body.current_dir(bench.path("")).arg(format!("{NASTY}.vtp"));
    let said = plain("body", &body.output().unwrap());
    assert!(said.contains("from out\\u{1b}[31mred\\u{a}"), "{said}");
}

#[test]
fn of_a_test_are_shown_on_its_page() {
    let bench = Bench::new();
    let scene = bench.write(&format!("{NASTY}.toml"), super::laboratory::bar());
    let output = bench.run(Path::new(scene.file_name().unwrap()), &["--output", "out"]);
    let said = plain("run", &output);
    assert!(output.status.success(), "{said}");
    assert!(assert_pages_plain(&bench.path("out")) > 2);
    let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
    assert!(
        page.contains("\\u{1b}[31mred\\u{a}\\u{9b}2J\\u{202e}\\u{2066}&lt;script&gt;"),
        "{page}"
    );
}

/// Bodies, groups, walls, measures, materials have names of letters and digits: others are refused,
/// and shown.
#[test]
fn in_a_scene_are_refused_and_shown() {
    let bench = Bench::new();
    let text = fs::read_to_string(good("breaking.toml")).unwrap();
    for (table, old) in [
        ("bodies", "[bodies.bar]"),
        ("groups", "[groups.left]"),
        ("measures", "[measures.pull]"),
        ("materials", "[materials.cake]"),
        ("supports", "[supports.left]"),
        ("bonds", "[bonds.cake]"),
        ("walls", "# A bar"),
    ] {
        let name = "\\u001b[31mred\\n\\u009b2J\\u202e\\u2066<script>alert(1)<";
        let new = format!("[{table}.\"{name}\"]\n#");
        let own = if old.starts_with('#') {
            format!("{text}\n{new}\n")
        } else {
            text.replacen(old, &new, 1)
        };
        assert_ne!(own, text);
        let scene = bench.write("scene.toml", own);
        for command in [&["check"][..], &[]] {
            let output = super::dem_run().args(command).arg(&scene).output().unwrap();
            let said = plain(table, &output);
            assert_eq!(output.status.code(), Some(2), "{table}: {said}");
            assert!(said.contains("\\u{1b}[31mred\\n"), "{table}: {said}");
        }
    }
}
