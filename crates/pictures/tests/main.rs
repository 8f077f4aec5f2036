//! Complete pictures.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]

use std::rc::Rc;

use dem_io::{Bounds, Diagnostic};
use dem_pictures::animation::animation;
use dem_pictures::film::film_strip;
use dem_pictures::label::{label, scale_bar};
use dem_pictures::png_file::{Compression, read_png, to_png};
use dem_pictures::surface::HalfSpace;
use dem_pictures::{Ball, Camera, Image, Surface, render};

const RED: [u8; 3] = [200, 30, 30];
const BLUE: [u8; 3] = [30, 30, 200];
const AROUND: Bounds = Bounds {
    low: [-1.0; 3],
    high: [1.0; 3],
};

fn ball(centre_m: [f64; 3], radius_m: f64, colour: [u8; 3]) -> Ball {
    Ball {
        centre_m,
        radius_m,
        colour,
    }
}

fn plane(point_m: [f64; 3], normal: [f64; 3]) -> Surface {
    Surface::plane(&HalfSpace { point_m, normal }, &AROUND, &[])
}

/// A view of all that is around, with z up.
fn looking(direction: [f64; 3]) -> Camera {
    Camera::around(direction, [0.0, 0.0, 1.0], &AROUND.corners(), [320, 200])
}

/// View along y, with x to the right and z up.
fn front() -> Camera {
    looking([0.0, 1.0, 0.0])
}

fn middle(camera: &Camera, point: [f64; 3]) -> [u32; 2] {
    let [x, y, _] = camera.project(point);
    [x, y].map(|at| at as u32)
}

fn some() -> (Vec<Ball>, Vec<Surface>) {
    let at = |k: i32, step: f64| (f64::from(k) * step).sin() * 0.8;
    let balls = (0..300)
        .map(|k| {
            ball(
                [at(k, 1.3), at(k, 2.1), at(k, 3.7)],
                0.07,
                [k as u8, 90, 200],
            )
        })
        .collect();
    let walls = vec![
        plane([0.0, 0.0, -0.9], [0.1, 0.0, 1.0]),
        Surface::cylinder([[0.3, -0.9, -1.0], [0.4, -0.9, 1.0]], 0.2),
        Surface::solid_box(&Bounds {
            low: [-0.9, -0.9, -0.5],
            high: [-0.3, 0.5, 0.1],
        }),
    ];
    (balls, walls)
}

#[test]
fn equal_input_gives_equal_bytes_in_any_thread() {
    let picture = || {
        let (balls, walls) = some();
        let camera = Camera::three_quarter(&AROUND.corners(), [320, 180]);
        let mut image = render(&camera, &balls, &walls);
        label(&mut image, "t = 0.125 s");
        scale_bar(&mut image, camera.px_per_m());
        to_png(&image, Compression::Fast).unwrap()
    };
    let first = picture();
    let others: Vec<_> = (0..3).map(|_| std::thread::spawn(picture)).collect();
    for other in others {
        assert!(first == other.join().unwrap());
    }
}

#[test]
fn silhouette_has_the_right_size() {
    let camera = front();
    for radius in [0.02, 0.3, 0.9] {
        let image = render(&camera, &[ball([0.1, 0.0, 0.05], radius, RED)], &[]);
        let inked: f64 = image
            .rgb()
            .chunks_exact(3)
            .map(|c| {
                if c[1] < 150 {
                    1.0
                } else if c[1] < 250 {
                    0.5
                } else {
                    0.0
                }
            })
            .sum();
        let px = radius * camera.px_per_m();
        let right = std::f64::consts::PI * px * px;
        assert!(
            (inked - right).abs() < 0.02 * right + 3.0 * px.sqrt() + 2.0,
            "{inked} {right}"
        );
    }
}

#[test]
fn nearer_balls_hide_farther_ones() {
    let camera = front();
    let [x, y] = middle(&camera, [0.0; 3]);
    let near = ball([0.0, -0.5, 0.0], 0.2, RED);
    let far = ball([0.0, 0.5, 0.0], 0.3, BLUE);
    for balls in [[near, far], [far, near]] {
        let image = render(&camera, &balls, &[]);
        let [red, _, blue] = image.pixel(x, y).unwrap();
        assert!(red > 2 * blue);
        let [x, y] = middle(&camera, [0.25, 0.0, 0.0]);
        let [red, _, blue] = image.pixel(x, y).unwrap();
        assert!(blue > red + 30);
    }
}

#[test]
fn walls_let_balls_behind_them_shine_through() {
    let camera = front();
    let [x, y] = middle(&camera, [0.0; 3]);
    let pixel = |balls: &[Ball], walls: &[Surface]| {
        let [red, green, _] = render(&camera, balls, walls).pixel(x, y).unwrap();
        i32::from(red) - i32::from(green)
    };
    let one = [ball([0.0; 3], 0.3, RED)];
    let wall = |y: f64| {
        [Surface::solid_box(&Bounds {
            low: [-0.5, y, -0.5],
            high: [0.5, y + 0.1, 0.5],
        })]
    };
    let bare = pixel(&one, &[]);
    let (before, behind) = (pixel(&one, &wall(-0.8)), pixel(&one, &wall(0.6)));
    assert!(bare > 80 && (behind - bare).abs() < 3, "{bare} {behind}");
    assert!(
        before > bare / 4 && before < 3 * bare / 4,
        "{before} {bare}"
    );
    assert!(pixel(&[], &wall(0.6)).abs() < 20);
}

#[test]
fn a_ball_throws_its_shadow_on_the_floor_and_not_through_it() {
    let camera = looking([0.0, 1.0, -1.0]);
    let floor = |z: f64| plane([0.0, 0.0, z], [0.0, 0.0, 1.0]);
    let grey = |balls: &[Ball], walls: &[Surface]| -> u64 {
        let image = render(&camera, balls, walls);
        image.rgb().iter().map(|c| u64::from(*c)).sum()
    };
    let one = [ball([0.0, 0.0, 0.2], 0.2, [255; 3])];
    let lost = |walls: &[Surface]| grey(&[], walls) as i64 - grey(&one, walls) as i64;
    assert!(lost(&[floor(0.0)]) > lost(&[]) + 10_000);
    let shelf = || {
        Surface::solid_box(&Bounds {
            low: [-0.6, -0.6, -0.1],
            high: [0.6, 0.6, 0.0],
        })
    };
    let (with, without) = (lost(&[shelf(), floor(-0.9)]), lost(&[shelf()]));
    assert!((with - without).abs() < without / 8, "{with} {without}");
}

#[test]
fn nonsense_is_left_out() {
    let (balls, walls) = some();
    let camera = Camera::three_quarter(&AROUND.corners(), [160, 90]);
    let right = render(&camera, &balls, &walls);
    let mut more = balls.clone();
    for odd in [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        1e15,
    ] {
        more.push(ball([odd, 0.0, 0.0], 0.1, RED));
        more.push(ball([0.0, 0.0, odd], 0.1, RED));
        more.push(ball([0.0; 3], odd, RED));
        more.push(ball([0.0; 3], -odd, RED));
    }
    more.push(ball([0.0; 3], 0.0, RED));
    let mut odd = walls.clone();
    odd.push(walls[0].moved(&|_| [f64::NAN; 3]));
    odd.push(walls[1].moved(&|p| p.map(|x| x * 1e300)));
    odd.push(walls[1].moved(&|_| [0.0; 3]));
    assert!(render(&camera, &more, &odd) == right);

    let large = [
        ball([0.0, 500.0, 0.0], 499.9, RED),
        ball([0.0; 3], 1e-9, BLUE),
    ];
    let _ = render(&camera, &large, &[walls[0].moved(&|p| p.map(|x| x * 1e4))]);
    let empty = Camera::around([f64::NAN; 3], [0.0; 3], &[], [64, 36]);
    assert_eq!(render(&empty, &[], &[]).pixel(3, 3), Some([255; 3]));
    let _ = render(&empty, &more, &odd);
    for size in [[0, 0], [0, 9], [9, 0], [1, 1], [3, 1]] {
        let camera = Camera::three_quarter(&AROUND.corners(), size);
        let mut image = render(&camera, &more, &odd);
        label(&mut image, "t = 1 s ?");
        for scale in [camera.px_per_m(), f64::NAN, 0.0, -1.0, 1e300, 1e-300] {
            scale_bar(&mut image, scale);
        }
        assert_eq!(
            to_png(&image, Compression::Fast).is_ok(),
            !size.contains(&0)
        );
    }
}

#[test]
fn png_holds_the_same_pixels() {
    let (balls, walls) = some();
    let image = render(
        &Camera::three_quarter(&AROUND.corners(), [161, 90]),
        &balls,
        &walls,
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    std::fs::write(&path, to_png(&image, Compression::Fast).unwrap()).unwrap();
    assert!(read_png(&path).unwrap() == image);
    std::fs::write(&path, "a picture of a cat").unwrap();
    let error = read_png(&path).unwrap_err();
    assert!(error.place.ends_with("picture.png") && error.exit_code() == 1);
}

/// The pictures that a browser shows of a film, and whether it has a palette.
fn shown(film: &[u8]) -> (Vec<Image>, bool) {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(film));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!(control.num_plays, 0);
    let has_palette = reader.info().palette.is_some();
    let mut canvas = Image::new(reader.info().width, reader.info().height, [0; 3]);
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let mut frames = Vec::new();
    for _ in 0..control.num_frames {
        let info = reader.next_frame(&mut pixels).unwrap();
        let part = *reader.info().frame_control().unwrap();
        assert_eq!((part.delay_num, part.delay_den), (40, 1000));
        let is_over = part.blend_op == png::BlendOp::Over;
        assert_eq!(is_over, has_palette && !frames.is_empty());
        let bytes = info.color_type.samples();
        for (k, colour) in (0..).zip(pixels[..info.buffer_size()].chunks_exact(bytes)) {
            let place = [
                k % part.width + part.x_offset,
                k / part.width + part.y_offset,
            ];
            if colour.get(3) != Some(&0) {
                let [x, y] = place.map(i64::from);
                canvas.blend(x, y, [colour[0], colour[1], colour[2]], 1.0);
            }
        }
        frames.push(canvas.clone());
    }
    (frames, has_palette)
}

#[test]
fn animation_holds_all_frames_and_plays_for_ever() {
    let camera = front();
    let at = |k: i32| [0.1 * f64::from(k / 2), 0.0, 0.0];
    let frames: Vec<Image> = (0..6)
        .map(|k| render(&camera, &[ball(at(k), 0.2, RED)], &[]))
        .collect();
    let film = animation(6, 40, |k| Ok(Rc::new(frames[k as usize].clone()))).unwrap();
    let (shown, has_palette) = shown(&film);
    assert!(has_palette && shown.len() == 6);
    for (shown, frame) in shown.iter().zip(&frames) {
        let pixels = shown.rgb().iter().zip(frame.rgb());
        let largest = pixels.map(|(a, b)| a.abs_diff(*b)).max();
        assert!(largest <= Some(4), "{largest:?}");
    }
    // What does not change takes no room.
    let once = animation(1, 40, |k| Ok(Rc::new(frames[k as usize].clone()))).unwrap();
    let twice = animation(2, 40, |k| Ok(Rc::new(frames[k as usize].clone()))).unwrap();
    assert!(frames[0] == frames[1] && twice.len() < once.len() + 100);
}

#[test]
fn animation_of_too_many_colours_keeps_them() {
    let frame = |k: u32| {
        let mut image = Image::new(160, 160, [0; 3]);
        for at in 0..160 * 160 {
            let [x, y] = [at % 160, at / 160];
            let colour = [x, y, (x * y + 40 * k) % 251].map(|part| part as u8);
            image.blend(i64::from(x), i64::from(y), colour, 1.0);
        }
        image
    };
    let film = animation(3, 40, |k| Ok(Rc::new(frame(k)))).unwrap();
    assert!(shown(&film) == ([0, 1, 2].map(frame).into(), false));
}

#[test]
fn animation_refuses_what_has_no_pixels() {
    assert!(animation(0, 40, |_| Ok(Rc::new(Image::new(5, 5, RED)))).is_err());
    assert!(animation(1, 40, |_| Ok(Rc::new(Image::new(0, 5, RED)))).is_err());
    assert!(animation(2, 0, |k| Ok(Rc::new(Image::new(5 * (1 - k), 9, RED)))).is_ok());
    let lost = || Diagnostic::failed("", "lost", "find it");
    let second = |k| {
        if k == 0 {
            Ok(Rc::new(Image::new(5, 5, RED)))
        } else {
            Err(lost())
        }
    };
    assert_eq!(animation(2, 40, second).unwrap_err().problem, "lost");
}

#[test]
fn film_strip_has_a_place_for_each_frame() {
    let frames: Vec<Image> = (0..5).map(|k| Image::new(10, 6, [k; 3])).collect();
    let strip = film_strip(&frames, 3);
    assert_eq!((strip.width(), strip.height()), (32, 13));
    assert_eq!(strip.pixel(12, 8), Some([4; 3]));
    assert_eq!(strip.pixel(23, 8), Some([255; 3]));
    assert_eq!(film_strip(&frames, 0).width(), 10);
    assert_eq!(film_strip(&[], 3).width(), 0);
    let long: Vec<Image> = (0..40).map(|_| Image::new(900, 2, [0; 3])).collect();
    assert!(film_strip(&long, 40).width() <= 16_384);
}
