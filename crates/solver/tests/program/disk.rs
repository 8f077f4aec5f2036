//! Full disks, and folders without write permission.
#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

use super::{Bench, dem_run, good, names_in, refused};

/// Runs a shell script as the superuser of a namespace of its own, with a small disk mounted on
/// ./disk; None if that is not permitted.
fn on_a_small_disk(bench: &Bench, size: &str, script: &str) -> Option<std::process::Output> {
    fs::create_dir(bench.path("disk")).unwrap();
    let mount = format!("mount -t tmpfs -o size={size} tmpfs disk");
    let try_it = |script: &str| {
        Command::new("unshare")
            .args(["--mount", "--user", "--map-root-user", "sh", "-c", script])
            .current_dir(bench.path(""))
            .env("DEM_RUN", dem_run().get_program())
            .output()
            .ok()
    };
    if !try_it(&mount)?.status.success() {
        return None;
    }
    try_it(&format!("{mount} && {script}"))
}

#[test]
fn a_full_disk_ends_the_run_and_keeps_the_last_checkpoint() {
    let bench = Bench::new();
    let scene = good("breaking.toml");
    let script = format!(
        "$DEM_RUN {} --output disk/out --set 'output.series=1e-9'; code=$?; cp -r disk/out kept; exit $code",
        scene.display()
    );
    let Some(output) = on_a_small_disk(&bench, "300k", &script) else {
        // Mounting is not permitted here: the tests of dem-io use /dev/full.
        return;
    };
    let (said, code) = refused(&output);
    assert_eq!(code, 1, "{said}");
    assert!(
        said.contains("disk/out/") && said.contains("no space left"),
        "{said}"
    );
    let files = names_in(&bench.path("kept"));
    assert!(files.contains(&"checkpoint.dem".to_owned()), "{files:?}");
    assert!(
        !files.iter().any(|name| name.starts_with(".unfinished")),
        "{files:?}"
    );
    // Rows are complete, and with free space the run continues where it stopped.
    let series = fs::read_to_string(bench.path("kept/series.csv")).unwrap();
    assert!(series.ends_with('\n'));
    bench.good(
        &scene,
        &[
            "--output",
            "kept",
            "--set",
            "output.series=1e-9",
            "--resume",
        ],
    );
    bench.good(
        &scene,
        &["--output", "whole", "--set", "output.series=1e-9"],
    );
    super::assert_same(&bench.path("kept"), &bench.path("whole"));
}

#[test]
fn a_disk_that_is_read_only() {
    for out in ["disk/empty", "disk/new"] {
        let bench = Bench::new();
        let script = format!(
            "mkdir disk/empty && mount -o remount,ro disk && $DEM_RUN {} --output {out}",
            good("alone.toml").display()
        );
        let Some(output) = on_a_small_disk(&bench, "300k", &script) else {
            return;
        };
        let (said, code) = refused(&output);
        assert_eq!(code, 1, "{said}");
        assert!(said.contains(out) && said.contains("read-only"), "{said}");
    }
}

#[test]
fn a_folder_that_may_not_be_written_to() {
    let bench = Bench::new();
    fs::create_dir(bench.path("locked")).unwrap();
    fs::set_permissions(bench.path("locked"), fs::Permissions::from_mode(0o555)).unwrap();
    let may_anyway = fs::write(bench.path("locked/try"), "").is_ok();
    if may_anyway {
        // The superuser may write anywhere; /proc accepts no files from anyone.
        let said = bench.bad(&good("alone.toml"), &["--output", "/proc/out"], 1);
        assert!(said.contains("/proc/out"), "{said}");
        return;
    }
    for out in ["locked", "locked/out"] {
        let said = bench.bad(&good("alone.toml"), &["--output", out], 1);
        assert!(said.contains(out) && said.contains("permission"), "{said}");
    }
}

#[test]
fn a_full_disk_behind_standard_output() {
    let bench = Bench::new();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = bench
        .command(&good("alone.toml"), &["--output", "out"])
        .stdout(full)
        .output()
        .unwrap();
    let (said, code) = refused(&output);
    assert_eq!(code, 1);
    assert!(
        said.starts_with("error: standard output: no space left"),
        "{said}"
    );
    // The results exist nevertheless.
    assert!(bench.path("out/summary.json").exists());
}

#[test]
fn a_standard_error_that_takes_nothing() {
    let codes = dem_testing::codes_without_standard_error(dem_run().arg("none.toml"));
    assert_eq!(codes, [Some(2); 2]);
    let bench = Bench::new();
    let mut command = bench.command(
        &good("alone.toml"),
        &["--quiet", "--output", "out", "--force"],
    );
    let codes = dem_testing::codes_without_standard_error(&mut command);
    assert_eq!(codes, [Some(0); 2]);
}

#[test]
fn folders_that_cannot_be_made() {
    let bench = Bench::new();
    let said = bench.bad(&good("alone.toml"), &["--output", "/proc/out"], 1);
    assert!(
        said.starts_with("error: /proc/out: cannot be written: ") && said.contains("os error"),
        "{said}"
    );
    // The folders that it is in are made.
    bench.good(&good("alone.toml"), &["--output", "new/and/out"]);
    assert!(bench.path("new/and/out/summary.json").is_file());
}

/// A file size limit of the shell is an error, not a signal that ends the program.
#[test]
fn a_file_beyond_the_limit_of_the_shell() {
    let bench = Bench::new();
    let script = format!(
        "ulimit -f 8; exec {} {} --output out --set output.series=1e-9",
        dem_run().get_program().display(),
        good("breaking.toml").display()
    );
    let output = Command::new("sh")
        .args(["-c", &script])
        .current_dir(bench.path(""))
        .output()
        .unwrap();
    let (said, code) = refused(&output);
    assert_eq!(code, 1, "{said}");
    assert!(
        said.starts_with("error: out/") && said.contains("a limit on the size of files is reached"),
        "{said}"
    );
    let files = names_in(&bench.path("out"));
    assert!(
        !files.iter().any(|name| name.starts_with(".unfinished")),
        "{files:?}"
    );
}

/// The remains of a checkpoint and of a fragment left by a killed run are removed by the next one
/// that writes there.
#[test]
fn remnants_of_a_killed_run_go_with_the_next() {
    let bench = Bench::new();
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/checkpoint.dem", "");
    bench.write("out/.unfinished-a1B2c3", "half");
    bench.write("here.vtp", "");
    bench.good(&good("breaking.toml"), &["--output", "out", "--force"]);
    let files = names_in(&bench.path("out"));
    assert!(
        !files.iter().any(|name| name.starts_with(".unfinished")),
        "{files:?}"
    );
    bench.write(".unfinished-a1B2c3", "half");
    let output = dem_run()
        .current_dir(bench.path(""))
        .args(["fragment", "out", "--largest", "-o", "piece.vtp"])
        .output()
        .unwrap();
    assert!(output.status.success());
    assert_eq!(bench.files(), ["here.vtp", "out", "piece.vtp"]);
}
