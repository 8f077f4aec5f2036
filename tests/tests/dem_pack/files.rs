//! Bodies to files and through pipes: every format, full disks, closed pipes, and on into dem-run.

use super::facets::cuboid;
use super::{Bench, bits, dem_pack, piped, shape};
use dem_io::body::read_body;
use std::fs;
use std::io::Read;
use std::process::Stdio;

const OPTIONS: [&str; 4] = ["-d", "1.5mm..2mm", "--particle-density", "2050"];

#[test]
fn straight_into_dem_run_and_info() {
    let bench = Bench::new();
    let body = bench.run(&shape("02"), &[&OPTIONS[..], &["-q"]].concat());
    assert!(body.status.success() && body.stderr.is_empty());
    let made = bench.pack(&shape("02"), &OPTIONS);
    let [particles, bonds] = [made.body.radii.len(), made.body.bonds.len()];
    let mut run = dem_tests::program("dem-run");
    run.args(["--body", "-"]);
    let mut info = dem_pack();
    info.args(["info", "-"]);
    for program in [run, info] {
        let output = piped(program, &body.stdout);
        assert!(output.status.success() && output.stderr.is_empty());
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(
            said.contains(&format!("particles  {particles},"))
                && said.contains(&format!("bonds      {bonds},")),
            "{said}"
        );
        assert!(
            said.contains("2050 kg/m3") && said.contains("seed 1"),
            "{said}"
        );
    }
}

#[test]
fn the_stl_may_come_through_a_pipe() {
    let bench = Bench::new();
    let by_name = bench.pack(&shape("02"), &OPTIONS);
    let mut program = dem_pack();
    program
        .current_dir(bench.folder.path())
        .arg("-")
        .args(OPTIONS)
        .args(["-q", "-o", "piped.vtp"]);
    let output = piped(program, &fs::read(shape("02")).unwrap());
    assert!(output.status.success() && output.stderr.is_empty());
    let body = read_body(&bench.path("piped.vtp")).unwrap();
    assert!(bits(&body) == bits(&by_name.body));
    assert_eq!(body.about.source.as_deref(), Some("standard input"));
    assert_eq!(body.about.source_hash, by_name.body.about.source_hash);
}

#[test]
fn every_format_is_written_and_converted_back() {
    let bench = Bench::new();
    let wanted = bench.pack(&shape("02"), &OPTIONS).body;
    for name in ["body.data", "body.lmp", "body.csv", "body.txt"] {
        let written = bench.run(&shape("02"), &[&OPTIONS[..], &["-q", "-o", name]].concat());
        assert!(written.status.success() && written.stdout.is_empty() && written.stderr.is_empty());
        let direct = read_body(&bench.path(name)).unwrap();
        let convert = |from: &str, to: &str| {
            let output = dem_pack()
                .current_dir(bench.folder.path())
                .args(["convert", from, to])
                .output()
                .unwrap();
            assert!(
                output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(),
                "{from} {to}"
            );
        };
        convert("body.vtp", &format!("converted-{name}"));
        convert(&format!("converted-{name}"), "back.vtp");
        for body in [direct, read_body(&bench.path("back.vtp")).unwrap()] {
            assert!(
                bits(&body) == bits(&wanted),
                "{name}: positions or radii changed"
            );
            assert_eq!(body.bonds, wanted.bonds, "{name}");
        }
    }
    assert!(
        bench.files().contains(&"body.particles.csv".to_owned())
            && bench.files().contains(&"body.bonds.txt".to_owned())
    );
}

#[test]
fn convert_through_pipes_keeps_every_byte() {
    let bench = Bench::new();
    bench.pack(&shape("02"), &OPTIONS);
    let bytes = fs::read(bench.path("body.vtp")).unwrap();
    let mut convert = dem_pack();
    convert.args(["convert", "-", "-"]);
    let output = piped(convert, &bytes);
    assert!(output.status.success() && output.stderr.is_empty());
    assert!(output.stdout == bytes);
}

#[test]
fn what_was_there_is_replaced_or_kept_whole() {
    let bench = Bench::new();
    fs::write(bench.path("body.vtp"), "old").unwrap();
    let refused = bench.run(&shape("24"), &["-d", "2mm", "-o", "body.vtp"]);
    assert_eq!(refused.status.code(), Some(2));
    assert_eq!(fs::read(bench.path("body.vtp")).unwrap(), b"old");
    bench.pack(&shape("02"), &OPTIONS);
    assert_eq!(bench.files(), ["body.vtp"]);
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_ends_it_quietly() {
    // More than a pipe holds.
    let bench = Bench::new();
    let mut child = dem_pack()
        .arg(shape("02"))
        .args(["-d", "0.8mm..1.2mm", "-q"])
        .current_dir(bench.folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdout = child.stdout.take().unwrap();
    let mut first = [0; 100];
    stdout.read_exact(&mut first).unwrap();
    drop(stdout);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    assert!(first.starts_with(b"<?xml"));

    for arguments in [
        &["man"][..],
        &["completions", "bash"],
        &["info", shape("02").to_str().unwrap()],
    ] {
        let mut child = dem_pack()
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(
            (output.status.code(), output.stderr),
            (Some(0), Vec::new()),
            "{arguments:?}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_exit_code_1_and_leaves_nothing() {
    let full = || fs::File::options().write(true).open("/dev/full").unwrap();
    let bench = Bench::new();
    std::os::unix::fs::symlink("/dev/full", bench.path("full.vtp")).unwrap();
    let stl = bench.stl("box.stl", &cuboid([20.0, 12.0, 10.0]));
    let failures = [
        bench.run(&stl, &["-d", "2mm", "-q", "-o", "full.vtp"]),
        dem_pack()
            .current_dir(bench.folder.path())
            .arg(&stl)
            .args(["-d", "2mm", "-q"])
            .stdout(full())
            .output()
            .unwrap(),
        dem_pack()
            .current_dir(bench.folder.path())
            .arg(&stl)
            .args(["-d", "2mm", "-q", "-o", "body.vtp", "--json"])
            .stdout(full())
            .output()
            .unwrap(),
        dem_pack().arg("man").stdout(full()).output().unwrap(),
        dem_pack()
            .args(["completions", "zsh"])
            .stdout(full())
            .output()
            .unwrap(),
    ];
    for output in failures {
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(
            said.starts_with("error: ")
                && said.contains("no space left")
                && said.lines().count() == 1,
            "{said}"
        );
        assert!(output.stdout.is_empty());
    }
    // The body of the third was complete before its report found no place.
    assert_eq!(bench.files(), ["body.vtp", "box.stl", "full.vtp"]);
    read_body(&bench.path("body.vtp")).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_standard_error_that_takes_nothing() {
    let mut command = dem_pack();
    command.args(["none.stl", "--diameter", "2mm"]);
    assert_eq!(
        dem_tests::codes_without_standard_error(&mut command),
        [Some(2); 2]
    );
}
