//! Signals: Ctrl-C, a request to end, a kill.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::{Bench, dem_run, good, root, scene_of_data};

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

pub(super) fn start(mut command: Command) -> Child {
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Number of lines of a file, 0 if it does not exist.
fn lines(path: &Path) -> usize {
    fs::read(path).map_or(0, |bytes| {
        bytes.iter().filter(|byte| **byte == b'\n').count()
    })
}

/// Waits until a condition holds, or the program has ended.
pub(super) fn wait_until(child: &mut Child, happened: impl Fn() -> bool) {
    let since = Instant::now();
    while !happened() && child.try_wait().unwrap().is_none() {
        assert!(since.elapsed() < Duration::from_mins(1), "nothing happens");
        sleep(Duration::from_millis(1));
    }
}

/// Sends a signal to a run when its time series has this number of rows. Returns its messages, or
/// None if it was faster than the signal.
pub(super) fn interrupt(
    command: Command,
    signal: &str,
    folder: &Path,
    rows: usize,
) -> Option<String> {
    let mut child = start(command);
    let series = folder.join("series.csv");
    let checkpoint = folder.join("checkpoint.dem");
    wait_until(&mut child, || lines(&series) > rows);
    let ended = child.try_wait().unwrap().is_some();
    if !ended {
        send(signal, &child);
    }
    let mut output = child.wait_with_output().unwrap();
    if output.status.success() {
        return None;
    }
    assert!(checkpoint.exists());
    // The summary of what has been simulated, unless it is quiet.
    let printed = String::from_utf8(std::mem::take(&mut output.stdout)).unwrap();
    assert!(
        printed.is_empty() || printed.contains("verdict "),
        "{printed}"
    );
    let (said, code) = super::refused(&output);
    assert_eq!(code, 130, "{said}");
    Some(said)
}

/// Kills a run some time after it has written its second checkpoint.
pub(super) fn kill_after_checkpoint(command: Command, folder: &Path) {
    let mut child = start(command);
    let checkpoint = folder.join("checkpoint.dem");
    wait_until(&mut child, || checkpoint.exists());
    let first = fs::read(&checkpoint).unwrap();
    wait_until(&mut child, || fs::read(&checkpoint).unwrap() != first);
    sleep(Duration::from_millis(5));
    send("-KILL", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), None, "it was faster than the kill");
    assert!(!folder.join("summary.json").exists());
}

#[test]
fn without_a_folder_it_is_said_how_the_state_would_have_been_kept() {
    let bench = Bench::new();
    let mut command = bench.command(
        &scene_of_data("cantilever.toml"),
        &[
            "--set",
            "run.rest_energy_ratio=1e-300",
            "--set",
            "run.end_time=1000 s",
            "--quiet",
        ],
    );
    let mut child = start({
        command.arg("--json");
        command
    });
    // Its activity is not visible from outside; it runs after a second at the latest, or it is
    // ended at once.
    sleep(Duration::from_millis(700));
    send("-INT", &child);
    child.try_wait().unwrap();
    let mut output = child.wait_with_output().unwrap();
    let printed = std::mem::take(&mut output.stdout);
    let printed: serde_json::Value = serde_json::from_slice(&printed).unwrap();
    assert_eq!(printed["ended_by"], "interruption");
    let (said, code) = super::refused(&output);
    assert_eq!(code, 130);
    assert!(said.starts_with("error: interrupted at "), "{said}");
    assert_eq!(
        format!("error: {}", printed["problem"].as_str().unwrap()),
        said
    );
    assert!(
        said.ends_with("with --output FOLDER its state would have been kept"),
        "{said}"
    );
    assert!(bench.files().is_empty());
}

#[test]
fn a_folder_is_written_to_by_one_run_at_a_time() {
    let bench = Bench::new();
    let scene = good("breaking.toml");
    let long = [
        "--set",
        "run.end_time=1000 s",
        "--set",
        "output.series=1e-3 s",
        "--set",
        "output.frames=1 s",
        "--set",
        "output.checkpoint=1 s",
        "--output",
        "out",
    ];
    let mut first = start(bench.command(&scene, &long));
    wait_until(&mut first, || lines(&bench.path("out/series.csv")) > 1);
    for option in [&[][..], &["--force"], &["--resume"]] {
        let said = bench.bad(&scene, &[&["--output", "out"], option].concat(), 2);
        assert!(
            said.starts_with("error: out: another run is writing into it; wait"),
            "{said}"
        );
    }
    assert!(lines(&bench.path("out/series.csv")) > 1);
    send("-KILL", &first);
    first.wait().unwrap();
    // The lock was released with the run.
    bench.good(&scene, &["--output", "out", "--force"]);
}

#[test]
fn before_a_run_nothing_is_waited_for() {
    let mut command = dem_run();
    command
        .arg(scene_of_data("clamped.toml"))
        .args(["--body", "-"]);
    // Nothing is written to its standard input.
    let mut child = start({
        command.stdin(Stdio::piped());
        command
    });
    sleep(Duration::from_millis(500));
    assert!(child.try_wait().unwrap().is_none());
    send("-INT", &child);
    let kept = child.stdin.take();
    let since = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(since.elapsed() < Duration::from_secs(5));
    assert_eq!(
        super::refused(&output),
        ("error: interrupted".to_owned(), 130)
    );
    drop(kept);
}

#[test]
fn a_checkpoint_stays_when_the_next_run_is_interrupted_too() {
    let bench = Bench::new();
    let all = ["--set", "run.safety_factor=0.02", "--output", "out"];
    let scene = good("breaking.toml");
    let first = interrupt(bench.command(&scene, &all), "-INT", &bench.path("out"), 5);
    assert!(first.is_some());
    let said = bench.bad(&scene, &all, 2);
    assert!(
        said.contains("--force") && said.contains("--resume"),
        "{said}"
    );
    assert!(bench.path("out/checkpoint.dem").exists());
}

/// Waits until the program handles the interrupt itself: bit 1 of the mask of caught signals.
fn wait_for_handler(child: &mut Child) {
    let path = format!("/proc/{}/status", child.id());
    wait_until(child, || {
        let status = fs::read_to_string(&path).unwrap_or_default();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = u64::from_str_radix(caught.unwrap_or("0").trim(), 16);
        caught.is_ok_and(|caught| caught & 2 != 0)
    });
}

#[test]
fn a_stress_suite_ends_with_the_same_code() {
    let mut command = dem_run();
    command.args(["stress", "--threads", "1"]);
    let mut child = start(command);
    wait_for_handler(&mut child);
    send("-INT", &child);
    let output = child.wait_with_output().unwrap();
    let (said, code) = super::refused(&output);
    assert_eq!(code, 130, "{said}");
    assert!(said.starts_with("error: interrupted"), "{said}");
}

/// A calibration that packs one body after another ends during the next packing at the latest.
#[test]
fn a_calibration_ends_while_it_packs() {
    let bench = Bench::new();
    let mut command = dem_run();
    command
        .arg("calibrate")
        .arg(scene_of_data("tension.toml"))
        .arg("--output")
        .arg(bench.path("cake.toml"));
    let shape = root().join("data/shapes/bar.stl").display().to_string();
    command.args(["--packings", "1000", "--", &shape, "--diameter", "3mm"]);
    let mut child = start(command);
    let record = bench.path("cake.json");
    wait_until(&mut child, || record.exists());
    let since = Instant::now();
    send("-INT", &child);
    let output = child.wait_with_output().unwrap();
    assert!(since.elapsed() < Duration::from_secs(5));
    let (said, code) = super::refused(&output);
    assert_eq!(code, 130, "{said}");
    assert!(said.starts_with("error: interrupted"), "{said}");
    let kept: serde_json::Value = serde_json::from_slice(&fs::read(&record).unwrap()).unwrap();
    assert_eq!(kept["packings"].as_array().unwrap().len(), 1000);
    assert_eq!(bench.files(), ["cake.json"]);
}

/// All tables and plots of what has been simulated are there, and the summary is printed.
#[test]
fn an_interrupted_run_leaves_its_tables() {
    let bench = Bench::new();
    let options = [
        "--set",
        "run.end_time=1000 s",
        "--set",
        "output.series=1e-3 s",
        "--output",
        "out",
    ];
    let mut child = start(bench.command(&good("following.toml"), &options));
    let series = bench.path("out/series.csv");
    wait_until(&mut child, || lines(&series) > 30);
    send("-INT", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let printed = String::from_utf8(output.stdout).unwrap();
    for part in ["fragments ", "verdict "] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    // Once, as the error.
    assert!(!printed.contains("interrupted"), "{printed}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(said.matches("interrupted at ").count(), 1, "{said}");
    for name in [
        "flow.csv",
        "distribution.csv",
        "fragment-tree.csv",
        "report.html",
        "summary.json",
        "plots/energy.svg",
        "checkpoint.dem",
    ] {
        assert!(bench.path("out").join(name).is_file(), "{name}");
    }
    assert!(lines(&bench.path("out/flow.csv")) > 2);
}
