//! A body instead of a scene: its contents.

use std::io::{Read, Write};
use std::path::Path;
use std::process::Stdio;

use dem_io::body::write_body;

use super::{dem_run, piped, refused, row, vtp_bytes};

const TEXT: &str = "particles  10, diameter 2 mm
bonds      8, 0.8 per particle
pieces     2, the largest of 5 particles; 0 particles without a bond
box        from -1 mm, -1 mm, -1 mm to 19 mm, 1 mm, 1 mm
mass       8.587e-5 kg, particles of 2050 kg/m3
centre     9 mm, 0 m, 0 m; principal moments 3.435e-11, 2.868e-9, 2.868e-9 kg m2
made       seed 7
";

#[test]
fn says_what_a_body_holds_from_a_file_of_each_kind() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["row.vtp", "row.data", "row.csv", "row.txt"] {
        let path = folder.path().join(name);
        write_body(&row(10), &path).unwrap();
        for arguments in [
            vec![path.as_os_str()],
            vec!["--body".as_ref(), path.as_os_str()],
        ] {
            let output = dem_run().args(arguments).output().unwrap();
            assert!(output.status.success() && output.stderr.is_empty());
            let said = String::from_utf8(output.stdout).unwrap();
            // Information on the origin is only in a .vtp, the density also in LAMMPS data.
            let wanted: Vec<&str> = TEXT
                .lines()
                .take(if name == "row.vtp" { 7 } else { 4 })
                .collect();
            assert!(said.starts_with(&wanted.join("\n")), "{said}");
        }
    }
}

#[test]
fn says_the_same_from_a_pipe() {
    let bytes = vtp_bytes(&row(10));
    for arguments in [&["-"][..], &["--body", "-"]] {
        let output = piped(arguments, &bytes);
        assert_eq!(String::from_utf8(output.stdout).unwrap(), TEXT);
        assert!(output.status.success() && output.stderr.is_empty());
    }
}

#[test]
fn json_holds_the_numbers() {
    let output = piped(&["--body", "-", "--json"], &vtp_bytes(&row(10)));
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(said["particles"], 10);
    assert_eq!(said["bonds"], 8);
    assert_eq!(said["pieces"], 2);
    assert_eq!(said["radius_max_m"], 1e-3);
    assert_eq!(said["box_min_m"], serde_json::json!([-1e-3, -1e-3, -1e-3]));
    assert_eq!(said["about"]["seed"], 7);
    assert_eq!(said["about"]["overlap"], serde_json::Value::Null);
    let mass = 2050.0 * 10.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    assert!((said["mass_kg"].as_f64().unwrap() / mass - 1.0).abs() < 1e-14);
}

#[test]
fn bad_input_is_one_line_and_exit_code_2() {
    let bytes = vtp_bytes(&row(10));
    let (said, code) = refused(&piped(&["-"], &bytes[..bytes.len() / 2]));
    assert!(
        said.starts_with("error: standard input: ") && said.ends_with("write or copy it again"),
        "{said}"
    );
    assert_eq!(code, 2);
    let (said, code) = refused(&piped(&["-"], b"solid cake\n"));
    assert!(
        said.starts_with("error: standard input: this is not a VTK XML file"),
        "{said}"
    );
    assert_eq!(code, 2);
    let mut body = row(3);
    body.bonds = vec![[0, 1], [0, 1]];
    body.bond_radii = vec![1e-3; 2];
    body.bond_lengths = vec![1e-3; 2];
    let (said, code) = refused(&piped(&["-"], &vtp_bytes(&body)));
    assert_eq!(
        said,
        "error: standard input: bond 1: it joins particles 0 and 1, as bond 0 does already; \
         one pair takes one bond: remove one of the two"
    );
    assert_eq!(code, 2);
    let (said, code) = refused(&piped(&["missing.vtp"], b""));
    assert_eq!(
        said,
        "error: missing.vtp: there is no such file; check its name and folder"
    );
    assert_eq!(code, 2);
}

#[test]
fn without_a_body_the_usage_is_shown() {
    for (arguments, shown) in [
        (&[][..], "Usage: dem-run"),
        (&["--wrong"][..], "see dem-run --help"),
    ] {
        let output = piped(arguments, b"");
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8(output.stderr).unwrap().contains(shown));
    }
    let help = piped(&["--help"], b"");
    assert!(
        help.status.success()
            && String::from_utf8(help.stdout)
                .unwrap()
                .contains("Exit codes")
    );
}

#[test]
fn a_reader_that_closes_the_pipe_ends_it_quietly() {
    let mut child = dem_run()
        .arg("-")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    child
        .stdin
        .take()
        .unwrap()
        .write_all(&vtp_bytes(&row(10)))
        .unwrap();
    let mut said = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut said)
        .unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(said, "");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_exit_code_1() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("row.vtp");
    write_body(&row(10), &path).unwrap();
    let full = std::fs::File::options()
        .write(true)
        .open(Path::new("/dev/full"))
        .unwrap();
    let output = dem_run().arg(&path).stdout(full).output().unwrap();
    let (said, code) = refused(&output);
    assert!(
        said.starts_with("error: standard output: no space left"),
        "{said}"
    );
    assert_eq!(code, 1);
}

/// An endless pipe is rejected at the first bytes that are not a body.
#[cfg(target_os = "linux")]
#[test]
fn an_endless_pipe_is_refused_at_once() {
    for arguments in [&["-"][..], &["--body", "-"]] {
        let zeros = std::fs::File::open("/dev/zero").unwrap();
        let output = dem_run().args(arguments).stdin(zeros).output().unwrap();
        let (said, code) = refused(&output);
        assert!(
            said.starts_with("error: standard input: this is not a VTK XML file"),
            "{said}"
        );
        assert_eq!(code, 2);
    }
}
