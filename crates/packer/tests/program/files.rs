//! Bodies to files and through pipes: every format, full disks, closed pipes.

use super::{Bench, bits, dem_pack, shape};
use crate::helpers::facets::cuboid;
use dem_io::body::read_body;
use dem_testing::piped;
use std::fs;
use std::io::Read;
use std::process::Stdio;

const OPTIONS: [&str; 4] = ["-d", "1.5mm..2mm", "--particle-density", "2050"];

#[test]
fn straight_into_info() {
    let bench = Bench::new();
    let body = bench.run(&shape("02"), &[&OPTIONS[..], &["-q"]].concat());
    assert!(body.status.success() && body.stderr.is_empty());
    let made = bench.pack(&shape("02"), &OPTIONS);
    let [particles, bonds] = [made.body.radii.len(), made.body.bonds.len()];
    let output = piped(dem_pack().args(["info", "-"]), &body.stdout);
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
    let output = piped(&mut program, &fs::read(shape("02")).unwrap());
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
    let output = piped(&mut convert, &bytes);
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
    // The third body was complete before its report could not be written.
    assert_eq!(bench.files(), ["body.vtp", "box.stl", "full.vtp"]);
    read_body(&bench.path("body.vtp")).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_standard_error_that_takes_nothing() {
    let mut command = dem_pack();
    command.args(["none.stl", "--diameter", "2mm"]);
    assert_eq!(
        dem_testing::codes_without_standard_error(&mut command),
        [Some(2); 2]
    );
}

/// An endless pipe is rejected at the first bytes that are not a body.
#[cfg(target_os = "linux")]
#[test]
fn an_endless_pipe_is_refused_at_once() {
    let bench = Bench::new();
    bench.pack(&shape("02"), &OPTIONS);
    let body = fs::read(bench.path("body.vtp")).unwrap();
    let header = body
        .windows(13)
        .position(|some| some == b"<AppendedData")
        .unwrap();
    let zeros = dem_pack()
        .args(["info", "-"])
        .stdin(fs::File::open("/dev/zero").unwrap())
        .output()
        .unwrap();
    let endless = |beginning: &[u8], arguments: &[&str]| {
        fs::write(bench.path("beginning"), beginning).unwrap();
        let script = format!(
            "(cat beginning; yes) | {} {}",
            dem_pack().get_program().display(),
            arguments.join(" ")
        );
        std::process::Command::new("sh")
            .args(["-c", &script])
            .current_dir(bench.folder.path())
            .output()
            .unwrap()
    };
    let in_values = &body[..header + 300];
    for (output, wanted) in [
        (zeros, "this is not a VTK XML file"),
        (endless(b"", &["info", "-"]), "this is not a VTK XML file"),
        (
            endless(b"", &["convert", "-", "other.vtp"]),
            "this is not a VTK XML file",
        ),
        (
            endless(&body[..header], &["info", "-"]),
            "its XML is longer than",
        ),
        (endless(in_values, &["info", "-"]), "the header says"),
    ] {
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.starts_with("error: standard input: ") && said.contains(wanted),
            "{said}"
        );
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

/// A shape or a sieve curve without end is refused before memory ends, and help that cannot be
/// written is a failure.
#[cfg(target_os = "linux")]
#[test]
fn endless_shapes_and_full_disks_end_in_an_error() {
    for (arguments, code) in [
        (&["info", "zero.stl"][..], 2),
        (&["zero.stl", "-d", "1mm", "-o", "b.vtp"], 2),
        (&["--help"], 1),
        (&["--version"], 1),
    ] {
        let bench = Bench::new();
        std::os::unix::fs::symlink("/dev/zero", bench.path("zero.stl")).unwrap();
        let output = dem_pack()
            .args(arguments)
            .current_dir(bench.folder.path())
            .stdout(fs::File::options().write(true).open("/dev/full").unwrap())
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    assert!(dem_pack().arg("--help").output().unwrap().status.success());
}

/// Neither the shape nor the sieve curve nor the converted body is overwritten, under whatever
/// name.
#[cfg(unix)]
#[test]
fn an_output_that_is_an_input_is_refused() {
    let bench = Bench::new();
    let stl = fs::read(shape("02")).unwrap();
    let sieve = "opening_mm,passing_percent\n1.5,0\n2,100\n";
    fs::write(bench.path("shape.vtp"), &stl).unwrap();
    fs::write(bench.path("sieve.particles.csv"), sieve).unwrap();
    fs::hard_link(bench.path("shape.vtp"), bench.path("hard.vtp")).unwrap();
    std::os::unix::fs::symlink("sieve.particles.csv", bench.path("soft.bonds.txt")).unwrap();
    let refused = |arguments: &[&str]| {
        let output = dem_pack()
            .current_dir(bench.folder.path())
            .args(arguments)
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.ends_with("; write to another name\n"), "{said}");
        said
    };
    let own = "it would replace the file that it is made from";
    let said = refused(&["shape.vtp", "-d", "2mm", "-o", "shape.vtp"]);
    assert_eq!(
        said,
        format!("error: shape.vtp: {own}; write to another name\n")
    );
    let said = refused(&["shape.vtp", "-d", "2mm", "-o", "hard.vtp"]);
    assert!(
        said.starts_with("error: hard.vtp: it would replace 'shape.vtp'"),
        "{said}"
    );
    for sizes in ["sieve:sieve.particles.csv", "sieve.particles.csv"] {
        let said = refused(&["shape.vtp", "-d", sizes, "-o", "sieve.csv"]);
        assert!(
            said.starts_with(&format!("error: sieve.particles.csv: {own}")),
            "{said}"
        );
        let said = refused(&["shape.vtp", "-d", sizes, "-o", "soft.txt"]);
        assert!(said.starts_with("error: soft.bonds.txt: "), "{said}");
    }
    assert_eq!(fs::read(bench.path("shape.vtp")).unwrap(), stl);
    assert_eq!(
        fs::read_to_string(bench.path("sieve.particles.csv")).unwrap(),
        sieve
    );
    // Any other file is replaced as usual.
    let made = bench.run(
        &bench.path("shape.vtp"),
        &["-d", "2mm", "-q", "-o", "body.vtp"],
    );
    assert!(made.status.success());
    refused(&["convert", "body.vtp", "body.vtp"]);
    refused(&["convert", "./body.vtp", "body.vtp"]);
    let body = read_body(&bench.path("body.vtp")).unwrap();
    dem_io::body::write_body(&body, &bench.path("pair.csv")).unwrap();
    refused(&["convert", "pair.csv", "pair.particles.csv"]);
}

/// A file size limit of the shell is an error, not a signal that ends the program.
#[cfg(target_os = "linux")]
#[test]
fn a_file_beyond_the_limit_of_the_shell_leaves_nothing() {
    for name in ["body.vtp", "body.csv"] {
        let bench = Bench::new();
        let script = format!(
            "ulimit -f 4; exec {} {} -d 1mm -q -o {name}",
            dem_pack().get_program().display(),
            shape("02").display()
        );
        let output = std::process::Command::new("sh")
            .args(["-c", &script])
            .current_dir(bench.folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(
            said.starts_with("error: body.")
                && said.contains("a limit on the size of files is reached")
                && said.lines().count() == 1,
            "{said}"
        );
        assert!(bench.files().is_empty(), "{:?}", bench.files());
    }
}

/// Leftovers of a killed run are removed by the next; files of others stay.
#[test]
fn remnants_of_a_killed_run_go_with_the_next() {
    let bench = Bench::new();
    for name in [".unfinished-a1B2c3", ".unfinished-zzzzzz"] {
        fs::write(bench.path(name), "half a body").unwrap();
    }
    let other = fs::File::open(bench.path(".unfinished-zzzzzz")).unwrap();
    other.lock().unwrap();
    let made = bench.run(&shape("02"), &["-d", "2mm", "-q", "-o", "body.vtp"]);
    assert!(made.status.success());
    assert_eq!(bench.files(), [".unfinished-zzzzzz", "body.vtp"]);
}

/// Warnings of the report are kept in the .vtp, and printed by info.
#[test]
fn warnings_are_kept_with_the_body() {
    let bench = Bench::new();
    let few_bonds = ["-d", "3mm", "--overlap", "0", "--bond-range", "1.01"];
    let made = bench.pack(&shape("02"), &few_bonds);
    let warned = made.report["quality"]["warnings"].as_array().unwrap();
    assert!(!warned.is_empty());
    let kept: Vec<&str> = warned.iter().map(|text| text.as_str().unwrap()).collect();
    assert_eq!(made.body.about.warnings, kept);
    let info = dem_pack()
        .current_dir(bench.folder.path())
        .args(["info", "body.vtp"])
        .output()
        .unwrap();
    let info = String::from_utf8(info.stdout).unwrap();
    let coarse = made.body.about.coarse().unwrap();
    assert!(info.contains(&format!("coarse     {coarse}\n")), "{info}");
    for text in kept {
        assert!(
            info.contains(&format!("warning    when it was made: {text}\n")),
            "{info}"
        );
    }
    // Also through a pipe and a conversion.
    let again = dem_pack()
        .current_dir(bench.folder.path())
        .args(["convert", "body.vtp", "again.vtp"])
        .output()
        .unwrap();
    assert!(again.status.success());
    let again = read_body(&bench.path("again.vtp")).unwrap();
    assert_eq!(again.about, made.body.about);
    // Nothing is written for a body without warnings.
    let sound = bench.pack(&shape("02"), &["-d", "1mm"]);
    assert_eq!(
        sound.report["quality"]["warnings"]
            .as_array()
            .unwrap()
            .len(),
        0
    );
    let bytes = fs::read(bench.path("body.vtp")).unwrap();
    assert!(!bytes.windows(8).any(|some| some == b"warnings"));
}
