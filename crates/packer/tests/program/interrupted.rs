//! Ctrl-C leaves no file behind, finished or not.
#![cfg(target_os = "linux")]

use super::{Bench, dem_pack};
use crate::helpers::facets::cuboid;
use std::fs;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

fn send(signal: &str, child: &Child) {
    assert!(
        Command::new("kill")
            .args([signal, &child.id().to_string()])
            .status()
            .unwrap()
            .success()
    );
}

/// Waits until the program handles the interrupt itself: bit 1 of the mask of caught signals.
fn wait_for_handler(child: &Child) {
    loop {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
        let caught = status
            .lines()
            .find_map(|line| line.strip_prefix("SigCgt:"))
            .unwrap()
            .trim();
        if u64::from_str_radix(caught, 16).unwrap() & 2 != 0 {
            return;
        }
        sleep(Duration::from_millis(5));
    }
}

/// Starts a packing of this diameter in the box of the folder.
fn start(bench: &Bench, diameter: &str, output: &str) -> Child {
    dem_pack()
        .current_dir(bench.folder.path())
        .args(["box.stl", "-d", diameter, "--densify", "0", "-o", output])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

#[test]
fn while_packing() {
    for signal in ["-INT", "-TERM"] {
        let bench = Bench::new();
        bench.stl("box.stl", &cuboid([200.0, 200.0, 200.0]));
        let child = start(&bench, "0.8mm..1.2mm", "body.vtp");
        wait_for_handler(&child);
        sleep(Duration::from_millis(300));
        send(signal, &child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(
            output.status.code(),
            Some(130),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(output.stdout.is_empty());
        assert_eq!(bench.files(), ["box.stl"]);
    }
}

#[test]
fn while_writing() {
    let bench = Bench::new();
    bench.stl("box.stl", &cuboid([40.0, 40.0, 40.0]));
    let mut child = start(&bench, "0.9mm..1.1mm", "body.csv");
    // The first other file in the folder is the unfinished one.
    while bench.files().len() == 1 && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(1));
    }
    send("-INT", &child);
    let output = child.wait_with_output().unwrap();
    let files = bench.files();
    match output.status.code() {
        Some(130) => assert!(
            !files
                .iter()
                .any(|f| f.starts_with('.') || f.contains("tmp")),
            "{files:?}"
        ),
        // It was faster than the signal.
        code => assert_eq!((code, files.len()), (Some(0), 3)),
    }
}
