//! Help, man page, completions.

use super::dem_run;

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

#[test]
fn options_of_another_name_are_refused_with_the_new_one() {
    for (old, new) in dem_run::cli::RENAMED {
        for argument in [old.to_owned(), format!("{old}=1")] {
            let done = dem_run().args(["scene.toml", &argument]).output().unwrap();
            let said = String::from_utf8(done.stderr).unwrap();
            assert_eq!(done.status.code(), Some(2), "{said}");
            let expected = format!("error: {old}: is now called {new}; write {new}\n");
            assert_eq!(said, expected);
        }
    }
}
