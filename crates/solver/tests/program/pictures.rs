//! Pictures of a run and its film. The tests of threads and interruptions check that they are the
//! same bits for any number of threads and after an interruption: their scenes have pictures.

use std::fs;
use std::io::BufReader;
use std::path::Path;

use super::{Bench, good, names_in, results};

/// Width, height and pixels of a PNG file, and the number of its frames.
fn decoded(path: &Path) -> ([u32; 2], Vec<u8>, u32) {
    let file = BufReader::new(fs::File::open(path).unwrap());
    let mut decoder = png::Decoder::new(file);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let frames = reader
        .info()
        .animation_control()
        .map_or(1, |c| c.num_frames);
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    if info.color_type == png::ColorType::Rgba {
        // The first picture of a film with a palette: no pixel is transparent.
        pixels = pixels
            .chunks_exact(4)
            .flat_map(|pixel| pixel[..3].to_vec())
            .collect();
    }
    for _ in 1..frames {
        let mut part = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut part).unwrap();
    }
    ([info.width, info.height], pixels, frames)
}

/// Fraction of the pixels that are not white.
fn inked(pixels: &[u8]) -> f64 {
    let all = pixels.chunks_exact(3);
    let count = all.len() as f64;
    all.filter(|colour| **colour != [255; 3]).count() as f64 / count
}

#[test]
fn are_taken_at_their_times_and_at_the_end() {
    let bench = Bench::new();
    let options = ["--set", "output.pictures=5 ms", "--output", "out"];
    bench.good(&good("meeting.toml"), &options);
    // At 0, 5, 10 and 12 ms.
    let names: Vec<String> = (0..4).map(|k| format!("picture-0000{k}.png")).collect();
    assert_eq!(names_in(&bench.path("out/pictures")), names);
    let mut seen = Vec::new();
    for name in &names {
        let (size, pixels, frames) = decoded(&bench.path("out/pictures").join(name));
        assert_eq!((size, frames), ([960, 540], 1));
        assert!((0.05..0.95).contains(&inked(&pixels)), "{}", inked(&pixels));
        assert!(!seen.contains(&pixels));
        seen.push(pixels);
    }
    let (size, pixels, frames) = decoded(&bench.path("out/film-strip.png"));
    assert_eq!((size, frames), ([4 * 480 + 3, 270], 1));
    assert!((0.05..0.95).contains(&inked(&pixels)));
    let (size, pixels, frames) = decoded(&bench.path("out/film.png"));
    assert_eq!((size, frames), ([960, 540], 4));
    // Its colours are those of a palette.
    let both = || pixels.iter().zip(&seen[0]);
    let off: u64 = both().map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    assert!((off as f64) < 0.5 * pixels.len() as f64, "{off}");
    assert!(both().all(|(a, b)| a.abs_diff(*b) <= 32));
}

#[test]
fn there_are_none_unless_asked_for() {
    let bench = Bench::new();
    bench.good(&good("breaking.toml"), &["--output", "out"]);
    let names = results(&bench.path("out"));
    assert!(!names.keys().any(|name| name.ends_with(".png")));
    assert!(!bench.path("out/pictures").exists());
}

#[test]
fn the_view_can_be_chosen() {
    let bench = Bench::new();
    let picture = |out: &str, view: &[&str]| {
        let options = ["--set", "run.end_time=1 us", "--output", out];
        bench.good(&good("meeting.toml"), &[&options[..], view].concat());
        decoded(&bench.path(out).join("pictures/picture-00000.png")).1
    };
    let usual = picture("usual", &[]);
    let front = picture("front", &["--set", "output.view.from=[0, -1, 0]"]);
    assert!(front != usual && inked(&front) > 0.02);
}

#[test]
fn the_earlier_ones_are_replaced_or_gone_on_from() {
    let bench = Bench::new();
    let scene = good("meeting.toml");
    let run = |end: &str, more: &[&str]| {
        let end = format!("run.end_time={end}");
        let options = [
            "--set",
            &end,
            "--set",
            "output.pictures=1 ms",
            "--output",
            "out",
        ];
        bench.run(&scene, &[&options[..], more].concat())
    };
    let count = || names_in(&bench.path("out/pictures")).len();
    assert!(run("4 ms", &[]).status.success());
    assert_eq!(count(), 5);
    assert!(run("2 ms", &["--force"]).status.success());
    assert_eq!(count(), 3);
    let before = fs::read(bench.path("out/pictures/picture-00002.png")).unwrap();
    assert!(run("4 ms", &["--resume"]).status.success());
    assert_eq!(count(), 5);
    assert!(before == fs::read(bench.path("out/pictures/picture-00002.png")).unwrap());
    assert_eq!(decoded(&bench.path("out/film.png")).2, 5);

    fs::remove_file(bench.path("out/pictures/picture-00001.png")).unwrap();
    let (said, code) = super::refused(&run("5 ms", &["--resume"]));
    assert_eq!(code, 2);
    assert!(
        said.contains("picture-00001.png: this picture is missing"),
        "{said}"
    );
}
