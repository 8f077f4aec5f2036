//! Things that a sweep must not do: execute text in names, remove files that it has not made, start
//! a run twice, use all memory.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::{SCENE, STEPS, bad, bench, good, partly, sweep};
use crate::program::Bench;

/// A study of a single run.
const ONE: &str = "version = 1\nscene = \"spring.toml\"\nrepeats = 1\n[vary]\n\"run.safety_factor\" = [0.1]\n[measures.energy]\nbalance = \"energy\"\n";

fn names_in(folder: &Path) -> Vec<String> {
    super::super::names_in(folder)
}

#[test]
fn a_name_that_would_split_a_listed_line_is_refused() {
    let evil = "a\ntouch pwned\n";
    let cases = [
        (
            ONE.replace("spring.toml", "a\\ntouch pwned\\n/spring.toml"),
            "out",
        ),
        (
            ONE.replace(
                "\"run.safety_factor\" = [0.1]",
                "\"body.bar\" = [\"a\\ntouch pwned\\n.csv\"]",
            ),
            "out",
        ),
        (ONE.to_owned(), evil),
    ];
    for (study, out) in cases {
        let bench = bench(&study);
        fs::create_dir(bench.path(evil)).unwrap();
        bench.write(&format!("{evil}/spring.toml"), SCENE);
        let said = bad(&bench, &["--list", "--output", out], 2);
        assert!(
            said.contains("\\u{a}touch pwned\\u{a}")
                && said.contains(
                    "' holds a control character; rename it: the command of each run is one line"
                ),
            "{said}"
        );
        assert!(!bench.path("out").exists());
    }
    // Text that sh would execute within a line is quoted.
    let bench = Bench::new();
    let folder = "a; touch pwned; $(touch pwned) `touch pwned` 'x' \"y\" \\ {} # &";
    fs::create_dir(bench.path(folder)).unwrap();
    bench.write(&format!("{folder}/-spring.toml"), SCENE);
    bench.write("-spring.toml", SCENE);
    bench.write("study.toml", ONE.replace("spring.toml", "-spring.toml"));
    for study in ["study.toml".to_owned(), format!("{folder}/study.toml")] {
        bench.write(&study, ONE.replace("spring.toml", "-spring.toml"));
        let mut command = bench.command(
            Path::new("sweep"),
            &["--list", "--output", &format!("{folder}/out")],
        );
        let listed = command.args(["--force"]).arg(&study).output().unwrap();
        let list = String::from_utf8(listed.stdout).unwrap();
        assert_eq!(list.lines().count(), 1, "{list}");
        let sh = Command::new("sh")
            .args(["-c", &list])
            .current_dir(bench.path(""))
            .status();
        assert!(sh.unwrap().success(), "{list}");
        assert!(
            bench
                .path(&format!("{folder}/out/runs/0001-1/summary.json"))
                .exists()
        );
        assert!(!bench.files().contains(&"pwned".to_owned()));
    }
}

#[test]
fn labels_are_shown_and_not_obeyed() {
    let names = "names = [\"\\u001b[31mred\\n\\u009b2J\\u202e<script>alert(1)</script>\", \"b\"]";
    let study = STEPS.replace(
        "[0.2, 0.1, 0.05, 0.025]",
        &format!("{{ values = [0.2, 0.1], {names} }}"),
    );
    let bench = bench(&study.replace(
        "{ richardson = \"run.safety_factor\" }",
        "{ finest = \"run.safety_factor\" }",
    ));
    let mut said = good(&bench, &[]);
    said += &good(&bench, &["--collect", "--json"]);
    let plain = |text: &str| {
        !text
            .chars()
            .any(|c| (c.is_control() && c != '\n') || c == '\u{202e}')
    };
    assert!(
        plain(&said) && said.contains("\\u{1b}[31mred\\u{a}\\u{9b}2J\\u{202e}<script>"),
        "{said}"
    );
    for file in ["sweep.html", "tip.svg", "energy.svg"] {
        let text = fs::read_to_string(bench.path(&format!("study-sweep/{file}"))).unwrap();
        assert!(plain(&text) && !text.contains("<script"), "{file}");
        assert!(text.contains("\\u{1b}[31mred"), "{file}");
    }
}

#[test]
fn what_is_read_is_not_written_over() {
    let bench = bench(&ONE.replace("[0.1]", "[0.1]\n\"body.bar\" = [\"bar.csv\"]"));
    bench.write(
        "bar.particles.csv",
        "x_m,y_m,z_m,radius_m\n0,0,0,0.2\n0.5,0,0,0.2\n",
    );
    bench.write("bar.bonds.csv", "particle_a,particle_b\n0,1\n");
    std::os::unix::fs::symlink("spring.toml", bench.path("link.toml")).unwrap();
    fs::hard_link(bench.path("study.toml"), bench.path("hard.toml")).unwrap();
    let before: Vec<_> = [
        "study.toml",
        "spring.toml",
        "bar.particles.csv",
        "bar.bonds.csv",
    ]
    .map(|name| fs::read(bench.path(name)).unwrap())
    .into();
    for target in [
        "study.toml",
        "./spring.toml",
        "link.toml",
        "hard.toml",
        "bar.particles.csv",
        "bar.bonds.csv",
    ] {
        let said = bad(&bench, &["--max-error", "all=1", "--write", target], 2);
        assert!(
            said.starts_with(&format!("error: --write {target}: '"))
                && said.ends_with("' is read here and would be overwritten; name another file"),
            "{said}"
        );
        assert!(!bench.path("study-sweep").exists());
    }
    // Nor removed: a body left by an earlier run of the same sweep.
    good(&bench, &["--quiet"]);
    let piece = "study-sweep/runs/0001-1/piece.vtp";
    bench.write(piece, super::super::vtp_bytes(&super::super::row(3)));
    bench.write(
        "study.toml",
        ONE.replace("[0.1]", &format!("[0.1]\n\"body.bar\" = [\"{piece}\"]")),
    );
    let said = bad(&bench, &["--force"], 2);
    assert!(
        said.contains("piece.vtp: this is an input of the study, and the sweep in 'study-sweep' would replace it; name another folder"),
        "{said}"
    );
    assert!(bench.path(piece).exists());
    bench.write("study.toml", &before[0]);
    let after: Vec<_> = [
        "study.toml",
        "spring.toml",
        "bar.particles.csv",
        "bar.bonds.csv",
    ]
    .map(|name| fs::read(bench.path(name)).unwrap())
    .into();
    assert!(before == after);
}

#[test]
fn force_removes_what_a_sweep_makes_and_nothing_else() {
    let bench = bench(STEPS);
    good(&bench, &["--quiet"]);
    let mine = [
        "study-sweep/notes.txt",
        "study-sweep/mine.svg",
        "study-sweep/runs/notes.txt",
        "study-sweep/runs/0001-1/notes.txt",
        "study-sweep/runs/0001-1/frames/mine.vtp",
        "study-sweep/runs/0009-9x/summary.json",
        "elsewhere/summary.json",
    ];
    for file in mine {
        fs::create_dir_all(bench.path(file).parent().unwrap()).unwrap();
        bench.write(file, "mine");
    }
    std::os::unix::fs::symlink(
        bench.path("elsewhere"),
        bench.path("study-sweep/runs/0099-1"),
    )
    .unwrap();
    bench.write("study.toml", ONE);
    good(&bench, &["--quiet", "--force"]);
    for file in mine {
        assert_eq!(fs::read(bench.path(file)).unwrap(), b"mine", "{file}");
    }
    // The plots and runs of the previous sweep are gone.
    assert!(!bench.path("study-sweep/tip.svg").exists());
    assert_eq!(
        names_in(&bench.path("study-sweep/runs")),
        ["0001-1", "0001-1.txt", "0009-9x", "0099-1", "notes.txt"]
    );
    assert_eq!(
        names_in(&bench.path("study-sweep")),
        [
            ".lock",
            "energy.svg",
            "mine.svg",
            "notes.txt",
            "runs",
            "study.json",
            "sweep.csv",
            "sweep.html",
            "sweep.json"
        ]
    );
    // An unrelated folder, even one with a file of that name.
    fs::create_dir_all(bench.path("other/runs/0001-1")).unwrap();
    for identity in ["{}", "[1]", "my study", "{ \"scene\": \"a.toml\" }"] {
        bench.write("other/study.json", identity);
        let said = bad(&bench, &["--force", "--output", "other"], 2);
        assert!(
            said.contains("other: this folder holds something else than a sweep"),
            "{said}"
        );
        assert_eq!(names_in(&bench.path("other")), ["runs", "study.json"]);
    }
}

fn children(parent: u32) -> Vec<u32> {
    let text =
        fs::read_to_string(format!("/proc/{parent}/task/{parent}/children")).unwrap_or_default();
    text.split_whitespace()
        .map(|id| id.parse().unwrap())
        .collect()
}

fn send(signal: &str, process: u32) {
    let sent = Command::new("kill")
        .args([signal, &process.to_string()])
        .status();
    assert!(sent.unwrap().success());
}

fn wait_until(happened: impl Fn() -> bool) {
    let since = Instant::now();
    while !happened() {
        assert!(since.elapsed() < Duration::from_mins(1), "nothing happens");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The sweep is killed, its process continues.
#[test]
fn a_run_that_is_still_alive_is_named() {
    let bench = bench(&ONE.replace("[vary]", "[set]\n\"run.end_time\" = \"1e6 s\"\n[vary]"));
    let mut parent = sweep(&bench, &[])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_until(|| !children(parent.id()).is_empty());
    let child = children(parent.id())[0];
    // At once: the process may not have reached its folder of results.
    send("-KILL", parent.id());
    parent.wait().unwrap();
    let lives = || Path::new(&format!("/proc/{child}")).exists();
    let named = "error: study-sweep/runs/0001-1: run 1 of this sweep is still going on; wait until it has ended, or end its process; then say the same again";
    assert!(lives());
    assert_eq!(bad(&bench, &["--resume"], 2), named);
    wait_until(|| bench.path("study-sweep/runs/0001-1/series.csv").exists());
    for options in [&["--resume"][..], &["--force"], &["--resume", "--list"]] {
        assert_eq!(bad(&bench, options, 2), named);
    }
    assert!(lives());
    // It is neither finished nor failed.
    let said = bad(&bench, &["--collect"], 1);
    assert!(
        said.contains("no run came to its end") && said.contains("it has not been run to its end"),
        "{said}"
    );
    send("-KILL", child);
    wait_until(|| !lives());
    bench.write("study.toml", ONE);
    good(&bench, &["--force"]);
}

/// The demands of a study are bounded before they are computed: within a second and little memory.
#[test]
fn studies_of_extreme_numbers_are_refused_at_once() {
    let range = |count: &str| {
        format!("{{ from = 1e-300, to = 1e300, count = {count}, spacing = \"log\" }}")
    };
    let axes = |count: usize, values: &str| -> String {
        (0..count)
            .map(|k| format!("\"materials.m{k}.density\" = {values}\n"))
            .collect()
    };
    let ten = format!(
        "{}{}",
        axes(90, "[1]"),
        (0..9)
            .map(|k| format!("\"bodies.b{k}.position\" = [1, 2, 3, 4]\n"))
            .collect::<String>()
    );
    for (vary, options, parts) in [
        (
            format!("\"run.rest_energy_ratio\" = {}\n", range("1000000000000")),
            "",
            "must be from 2 to 100000",
        ),
        (
            format!("\"run.rest_energy_ratio\" = {}\n", range("99999")),
            "",
            "99999 runs, 1 times each, are more than 10000; vary less, or say --yes",
        ),
        (
            axes(30, &range("99999")),
            "--yes",
            "axes have 199998 values, more than 100000",
        ),
        (
            axes(100, &range("1000")),
            "--yes",
            "18446744073709551615 runs, 1 times each, are more than 1000000; vary less",
        ),
        (
            axes(20_000, "[1]"),
            "--yes",
            "there are more than 100 axes; join",
        ),
        (
            ten,
            "--yes",
            "262144 runs with 99 axes each are more than 10000000 values; vary less",
        ),
    ] {
        let bench = bench(&ONE.replace("\"run.safety_factor\" = [0.1]\n", &vary));
        let mut command = sweep(&bench, &[]);
        if !options.is_empty() {
            command.arg(options);
        }
        // 1 GB of address space, including threads and program.
        let line: Vec<String> = std::iter::once(command.get_program())
            .chain(command.get_args())
            .map(|word| format!("'{}'", word.to_str().unwrap()))
            .collect();
        let output = Command::new("sh")
            .args([
                "-c",
                &format!("ulimit -v 1000000; ulimit -t 20; exec {}", line.join(" ")),
            ])
            .current_dir(bench.path(""))
            .output()
            .unwrap();
        let (said, code) = crate::program::refused(&output);
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(parts), "{said}\n{parts}");
        assert!(!bench.path("study-sweep").exists());
    }
}

#[test]
fn an_endless_scene_or_study_is_refused() {
    let bench = bench(&ONE.replace("spring.toml", "endless.toml"));
    std::os::unix::fs::symlink("/dev/zero", bench.path("endless.toml")).unwrap();
    let said = bad(&bench, &[], 2);
    assert!(
        said.contains("study.toml: scene: endless.toml: this is larger than 256 MB; name a scene"),
        "{said}"
    );
    let said = bench.bad(Path::new("endless.toml"), &[], 2);
    assert!(
        said.contains("endless.toml: this is larger than 256 MB"),
        "{said}"
    );
    bench.write("spring.toml", SCENE);
    let failing = ONE.replace("[0.1]", "[0.1, 1.5]");
    bench.write("study.toml", failing);
    // Run 2 fails; the first exists.
    let (table, said) = partly(&bench, &["--quiet"]);
    assert!(
        table.is_empty()
            && said.contains(
                "1 of 2 runs did not come to their end; the first: run 2, run.safety_factor 1.5: "
            ),
        "{said}"
    );
}
