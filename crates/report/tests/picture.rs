//! Pictures and films of a folder of frames.

use std::io::Write;

use dem_report::picture::{ColourBy, PictureKind, PictureOrder, Which, picture};
use tempfile::TempDir;

use super::made_run::{Moment, folder_with, out, summary};

const MOMENTS: [Moment; 3] = [
    Moment {
        time_s: 0.0,
        particles: 9,
    },
    Moment {
        time_s: 0.4,
        particles: 9,
    },
    Moment {
        time_s: 1.0,
        particles: 6,
    },
];

fn order() -> PictureOrder {
    PictureOrder {
        frame: Which::Last,
        from: Some([0.2, -1.0, 0.4]),
        target_m: None,
        zoom: 1.0,
        size_px: [160, 90],
        colour_by: ColourBy::Fragment,
    }
}

fn made() -> TempDir {
    let folder = folder_with(&MOMENTS);
    std::fs::write(out(&folder).join("summary.json"), summary().to_string()).unwrap();
    folder
}

/// Red, green and blue of the pixels of a PNG, read by another reader than the writer's.
fn pixels(bytes: &[u8]) -> Vec<u8> {
    let mut file = tempfile::NamedTempFile::with_suffix(".png").unwrap();
    file.write_all(bytes).unwrap();
    let image = dem_pictures::png_file::read_png(file.path()).unwrap();
    assert_eq!([image.width(), image.height()], [160, 90]);
    image.rgb().to_vec()
}

fn drawn(folder: &TempDir, order: &PictureOrder) -> Vec<u8> {
    pixels(
        &picture(&out(folder), order, PictureKind::Png)
            .unwrap()
            .bytes,
    )
}

#[test]
fn every_part_of_the_order_changes_the_picture() {
    let folder = made();
    let whole = drawn(&folder, &order());
    let others = [
        PictureOrder {
            frame: Which::Number(0),
            ..order()
        },
        PictureOrder {
            from: Some([1.0, 0.3, 0.2]),
            ..order()
        },
        PictureOrder {
            from: None,
            ..order()
        },
        PictureOrder {
            target_m: Some([0.02, 0.0, 0.5]),
            ..order()
        },
        PictureOrder {
            zoom: 3.0,
            ..order()
        },
    ];
    for other in &others {
        assert_ne!(drawn(&folder, other), whole, "{other:?}");
    }
    let last = PictureOrder {
        frame: Which::Number(2),
        ..order()
    };
    assert_eq!(
        drawn(&folder, &last),
        whole,
        "the last frame is the usual one"
    );
}

/// A plane is not seen from behind, a surface from a file is; from the front they are alike.
#[test]
fn walls_are_drawn_as_during_the_run() {
    let folder = made();
    let drawn_as = |solid_walls: &[&str], from: [f64; 3]| {
        let mut summary = summary();
        summary["inputs"]["solid_walls"] = serde_json::json!(solid_walls);
        std::fs::write(out(&folder).join("summary.json"), summary.to_string()).unwrap();
        let from = Some(from);
        drawn(&folder, &PictureOrder { from, ..order() })
    };
    let [above, below] = [[0.2, -1.0, 0.4], [0.2, -1.0, -0.4]];
    assert_eq!(drawn_as(&["floor"], above), drawn_as(&[], above));
    assert_ne!(drawn_as(&["floor"], below), drawn_as(&[], below));

    // Without a direction: that of pictures made during a run. The floor is 2 m long both ways.
    let usual = drawn(
        &folder,
        &PictureOrder {
            from: None,
            ..order()
        },
    );
    assert_eq!(usual, drawn_as(&["floor"], USUAL));
}

/// From the front, the right and above.
const USUAL: [f64; 3] = [0.42, -0.80, 0.43];

#[test]
fn colours_differ_by_what_they_tell() {
    let folder = made();
    let all = [
        ColourBy::Fragment,
        ColourBy::Body,
        ColourBy::Speed,
        ColourBy::FragmentMass,
        ColourBy::Utilisation,
        ColourBy::Stress,
    ];
    let zoom = 12.0;
    let target_m = Some([0.06, 0.0, 0.5]);
    let pictures: Vec<Vec<u8>> = all
        .into_iter()
        .map(|colour_by| {
            drawn(
                &folder,
                &PictureOrder {
                    colour_by,
                    zoom,
                    target_m,
                    ..order()
                },
            )
        })
        .collect();
    for (one, first) in pictures.iter().enumerate() {
        for (other, second) in pictures.iter().enumerate().skip(one + 1) {
            assert_ne!(first, second, "{:?} and {:?}", all[one], all[other]);
        }
    }
}

#[test]
fn a_film_has_all_frames() {
    let folder = made();
    let bytes = picture(&out(&folder), &order(), PictureKind::Gif)
        .unwrap()
        .bytes;
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut film = options.read_info(bytes.as_slice()).unwrap();
    assert_eq!([film.width(), film.height()], [160, 90]);
    let mut frames: Vec<Vec<u8>> = Vec::new();
    while let Some(frame) = film.read_next_frame().unwrap() {
        frames.push(frame.buffer.to_vec());
    }
    assert_eq!(frames.len(), MOMENTS.len());
    assert!(frames[0] != frames[1] && frames[1] != frames[2]);
}

#[test]
fn what_is_not_there_is_named() {
    let folder = made();
    let order = PictureOrder {
        frame: Which::Number(3),
        ..order()
    };
    let error = picture(&out(&folder), &order, PictureKind::Png).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("there is no frame 3"), "{error}");
    assert!(error.to_string().contains("0 to 2"), "{error}");
    for (time_s, is_near) in [(1.4, true), (1.6, false), (-0.6, false)] {
        let order = PictureOrder {
            frame: Which::Nearest(time_s),
            ..order
        };
        let drawn = picture(&out(&folder), &order, PictureKind::Png);
        assert_eq!(drawn.is_ok(), is_near, "{time_s} s");
        if let Err(error) = drawn {
            assert!(
                error.to_string().contains("frames from 0 s to 1 s"),
                "{error}"
            );
        }
    }
    let empty = tempfile::tempdir().unwrap();
    let error = picture(empty.path(), &order, PictureKind::Png).unwrap_err();
    assert!(
        error.to_string().contains("there are no frames of a run"),
        "{error}"
    );
}
