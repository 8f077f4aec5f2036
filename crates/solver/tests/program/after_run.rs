//! What can be made of a run that has ended: its page, pictures, films; and of one before it
//! begins.

use std::fs;
use std::process::Output;

use super::{Bench, dem_run, good, names_in, refused};

fn ended() -> Bench {
    let bench = Bench::new();
    bench.good(&good("breaking.toml"), &["--output", "out"]);
    bench
}

fn go(bench: &Bench, words: &[&str]) -> Output {
    let mut command = dem_run();
    command.current_dir(bench.path("")).args(words);
    command.output().unwrap()
}

#[test]
fn the_page_can_be_written_again() {
    let bench = ended();
    let path = bench.path("out/report.html");
    let page = fs::read_to_string(&path).unwrap();
    for part in ["id=\"view-data\"", "Errors and run time", "breaking.toml"] {
        assert!(page.contains(part), "{part}");
    }
    fs::remove_file(&path).unwrap();
    let output = go(&bench, &["report", "out"]);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(output.stdout, b"out/report.html\n");
    assert_eq!(fs::read_to_string(&path).unwrap(), page);
}

#[test]
fn a_run_that_was_stopped_has_a_page_too() {
    let bench = Bench::new();
    let options = [
        "--output",
        "out",
        "--set",
        "run.time_step=1e-4",
        "--force-step",
    ];
    let output = bench.run(&good("breaking.toml"), &options);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
    assert!(page.contains("class=\"verdict doubtful\""));
    assert!(page.contains("instability"));
}

#[test]
fn pictures_and_films_have_the_size_and_number_asked_for() {
    let bench = ended();
    let words = [
        "picture", "out", "-o", "one.png", "--size", "320x200", "--frame", "4",
    ];
    let output = go(
        &bench,
        &[&words[..], &["--from=-1,-2,0.5", "--colour-by", "stress"]].concat(),
    );
    assert!(output.status.success(), "{output:?}");
    let image = dem_pictures::png_file::read_png(&bench.path("one.png")).unwrap();
    assert_eq!([image.width(), image.height()], [320, 200]);
    let film = [
        "picture", "out", "-o", "film.gif", "--size", "160x90", "--zoom", "2",
    ];
    assert!(go(&bench, &film).status.success());
    let bytes = fs::read(bench.path("film.gif")).unwrap();
    assert_eq!(&bytes[..6], b"GIF89a");
    assert_eq!(bytes[6..10], [160, 0, 90, 0]);
    // Of each of the nine frames: it stays until the next, and has no colour that is clear.
    let blocks = bytes.windows(4).filter(|four| four[..3] == [0x21, 0xf9, 4]);
    assert_eq!(blocks.count(), 9);
}

/// Frames are 0.25 ms apart or so: a time shows the nearest, in units as everywhere.
#[test]
fn a_time_shows_the_nearest_frame() {
    let bench = ended();
    let pvd = fs::read_to_string(bench.path("out/frames.pvd")).unwrap();
    let times_s: Vec<f64> = pvd
        .split("timestep=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap().parse().unwrap())
        .collect();
    let by = |words: &[&str]| {
        let output = go(
            &bench,
            &[
                &["picture", "out", "-o", "x.png", "--size", "160x90"],
                words,
            ]
            .concat(),
        );
        assert!(
            output.status.success() && output.stderr.is_empty(),
            "{output:?}"
        );
        fs::read(bench.path("x.png")).unwrap()
    };
    let third = by(&["--frame", "3"]);
    assert!(third != by(&["--frame", "2"]));
    let near_s = 0.7 * times_s[3] + 0.3 * times_s[4];
    assert!(third == by(&["--time", &format!("{} ms", 1e3 * near_s)]));
    assert!(third == by(&["--time", &near_s.to_string()]));
    // The frames end at 4 ms and are 0.5 ms apart.
    assert!(by(&[]) == by(&["--time", "4.4 ms"]));
    let late = go(&bench, &["picture", "out", "-o", "y.png", "--time", "9 h"]);
    assert_eq!(late.status.code(), Some(2));
    assert!(!bench.path("y.png").exists());
    assert_eq!(
        String::from_utf8(late.stderr).unwrap(),
        "error: --time: there are no frames near 32400 s; the run has frames from 0 s to 4 ms\n"
    );
    for (name, _) in dem_report::picture::ColourBy::WORDS {
        by(&["--colour-by", name]);
    }
}

#[test]
fn a_picture_without_particles_is_told() {
    let bench = ended();
    let words = [
        "picture", "out", "-o", "x.png", "--target", "5m,0,0", "--zoom", "9",
    ];
    let output = go(&bench, &words);
    assert!(output.status.success() && bench.path("x.png").exists());
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        "warning: x.png: no particle is within the picture; leave out --target and --zoom to see everything\n"
    );
}

#[test]
fn a_quantity_that_frames_do_not_have_is_refused() {
    let bench = Bench::new();
    let off = "bonds.cake.failure.rate_strengthening=false";
    bench.good(&good("breaking.toml"), &["--set", off, "--output", "out"]);
    let words = [
        "picture",
        "out",
        "-o",
        "x.png",
        "--colour-by",
        "dynamic_utilisation",
    ];
    let (error, code) = refused(&go(&bench, &words));
    assert!(
        error.contains("has none: the scene has no bonds with rate_strengthening") && code == 2,
        "{error}"
    );
}

/// Only what cannot be read as a table, page or scene is removed, and only of a run that has ended.
#[test]
fn a_run_may_keep_its_tables_only() {
    let bench = Bench::new();
    let options = [
        "--set",
        "output.pictures=5 ms",
        "--output",
        "out",
        "--keep",
        "tables",
    ];
    bench.good(&good("breaking.toml"), &options);
    let names = names_in(&bench.path("out"));
    for gone in [
        "frames",
        "frames.pvd",
        "pictures",
        "film.png",
        "film-strip.png",
        "plots",
        "checkpoint.dem",
    ] {
        assert!(!names.contains(&gone.to_owned()), "{gone}");
    }
    for kept in [
        "summary.json",
        "series.csv",
        "report.html",
        "scene.toml",
        "fragments.csv",
        "events.csv",
    ] {
        assert!(names.contains(&kept.to_owned()), "{kept}");
    }
    // It runs again as any other.
    bench.good(&good("breaking.toml"), &["--output", "out", "--force"]);
    assert!(bench.path("out/frames.pvd").exists() && bench.path("out/checkpoint.dem").exists());
    let unstable = ["--set", "run.time_step=1e-4", "--force-step", "--force"];
    let output = bench.run(&good("breaking.toml"), &[&options[2..], &unstable].concat());
    assert_eq!(output.status.code(), Some(3));
    assert!(bench.path("out/frames.pvd").exists());
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let bench = ended();
    for (words, said) in [
        (
            &["-o", "x.jpg"][..],
            "x.jpg: this is not the name of a picture",
        ),
        (
            &["-o", "x.gif", "--frame", "1"],
            "--frame: a film shows all frames",
        ),
        (
            &["-o", "x.png", "--frame", "99"],
            "--frame: there is no frame 99",
        ),
        (
            &["-o", "x.png", "--size", "9x9"],
            "--size: '9x9' is not a width and a height",
        ),
        (&["-o", "x.png", "--zoom", "0"], "--zoom: 0 is not above 0"),
        (
            &["-o", "x.png", "--from", "0,0,0"],
            "--from: this is no direction",
        ),
        (
            &["-o", "x.png", "--target", "1,2"],
            "--target: '1,2' is not three numbers",
        ),
        (
            &["-o", "x.png", "--from", "1mm,0,0"],
            "--from: '1mm' is not a number: unknown unit 'mm'",
        ),
        (
            &["-o", "x.png", "--target", "1,2,3 s"],
            "--target: '3 s' is not a length: unknown unit 's'",
        ),
        (
            &["-o", "x.png", "--time", "3 mm"],
            "--time: '3 mm' is not a time: unknown unit 'mm'",
        ),
        (
            &["-o", "x.gif", "--time", "3 ms"],
            "--time: a film shows all frames",
        ),
        (
            &["-o", "x.png", "--colour-by", "mass"],
            "--colour-by: 'mass' has another name; write fragment_mass",
        ),
        (
            &["-o", "x.png", "--colour-by", "heat"],
            "--colour-by: 'heat' is no quantity of a picture; write one of fragment, ",
        ),
        (&["-o", "x.png", "--colour", "speed"], "--colour-by"),
        (&["-o", "nowhere/x.png"], "nowhere"),
    ] {
        let output = go(&bench, &[&["picture", "out"], words].concat());
        let (error, code) = refused(&output);
        assert!(error.contains(said), "{words:?}: {error}");
        assert!(code == 2 || said == "nowhere", "{words:?}: {code}");
        assert!(!bench.path("x.png").exists() && !bench.path("x.gif").exists());
    }
    let output = go(&bench, &["picture", ".", "-o", "x.png"]);
    assert!(
        refused(&output).0.contains("no frames of a run"),
        "{output:?}"
    );
    assert!(
        refused(&go(&bench, &["report", "."]))
            .0
            .contains("summary.json")
    );
}

#[test]
fn check_draws_the_start() {
    let bench = Bench::new();
    let scene = good("breaking.toml");
    let scene = scene.to_str().unwrap();
    let output = go(&bench, &["check", scene, "--picture", "start.png"]);
    assert!(output.status.success(), "{output:?}");
    assert!(dem_pictures::png_file::read_png(&bench.path("start.png")).is_ok());
    let output = go(&bench, &["check", scene, "--picture", "start.svg"]);
    assert!(refused(&output).0.contains("end it with .png"));
}
