//! Pictures and films of the frames of a finished run, from any side and in any colours.

mod colour_by;
mod gif_film;
mod subject;

pub use colour_by::ColourBy;

use std::cell::Cell;
use std::path::{Path, PathBuf};

use dem_io::units::show_quantity;
use dem_io::{Bounds, Diagnostic, Result, read_input};
use dem_pictures::label::{colour_bar, label, scale_bar, time_text};
use dem_pictures::png_file::{Compression, to_png};
use dem_pictures::{Camera, Image, Surface, render};
use dem_results::{Summary, from_json};

use crate::folder::Folder;
use crate::home::Home;
use crate::view::{ChosenFrame, home};
use gif_film::film;
use subject::{Colours, Seen};

/// Most frames of a film.
const MOST_FRAMES: usize = 240;
/// Upward direction in a picture.
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// A frame of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Which {
    /// The last one.
    Last,
    /// The one with this number, from 0.
    Number(usize),
    /// The one whose time is nearest to this one, s; of two, the earlier.
    Nearest(f64),
}

/// A picture or a film.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawn {
    /// The bytes of the file.
    pub bytes: Vec<u8>,
    /// True if no sphere of any frame shown is within the picture.
    pub is_empty: bool,
    /// Number of spheres, in the frame with the most, so far from the walls that the picture was
    /// not made to show them; 0 with a target or a zoom.
    pub far_away: usize,
}

/// What a picture shows, and from where.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOrder {
    /// The frame. Films show all.
    pub frame: Which,
    /// Direction of the viewer, of any length; None: that of the scene.
    pub from: Option<[f64; 3]>,
    /// The place in the middle, m; None: the middle of everything.
    pub target_m: Option<[f64; 3]>,
    /// Magnification over that which shows everything.
    pub zoom: f64,
    /// Width and height, px.
    pub size_px: [u32; 2],
    /// What colours tell.
    pub colour_by: ColourBy,
}

/// A picture as a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// One frame.
    Png,
    /// All frames, as a film.
    Gif,
}

/// The bytes of a picture or film of the run in this folder; refuses a folder without such frames.
pub fn picture(path: &Path, order: &PictureOrder, kind: PictureKind) -> Result<Drawn> {
    let folder = Folder::read(path)?;
    if folder.frames().is_empty() {
        return Err(Diagnostic::input(
            path.display().to_string(),
            "there are no frames of a run",
            "name the folder of results of a run whose scene has output.frames and which kept them (--keep all)",
        ));
    }
    // A run that has not finished has none, but the viewer may say from where to look.
    let summary = match (summary(path), order.from) {
        (Err(_), Some(_)) => Summary::default(),
        (summary, _) => summary?,
    };
    let from = order.from.or(summary.inputs.view_from);
    let frames = folder.frames();
    let chosen = chosen(frames, order, kind)?;
    let colours = Colours::of(order.colour_by, path, &chosen)?;
    let home = home(&ChosenFrame::from(&frames[0]))?;
    let (camera, far_away) = camera(order, from, &chosen, &home)?;
    let every_s = match frames {
        [(_, first), .., (_, last)] => (last - first) / (frames.len() - 1) as f64,
        _ => 0.0,
    };
    let is_empty = Cell::new(true);
    let one = |frame: &(PathBuf, f64)| {
        let seen = Seen::read(frame)?;
        if seen.is_within(&camera, order.size_px) {
            is_empty.set(false);
        }
        let walls = seen.walls(&summary.inputs.solid_walls);
        Ok(drawn(&seen, &walls, frame.1, &camera, &colours, every_s))
    };
    let bytes = match kind {
        PictureKind::Png => to_png(&one(&chosen[0])?, Compression::High),
        PictureKind::Gif => film(order.size_px, chosen.len(), &|number| one(&chosen[number])),
    }?;
    Ok(Drawn {
        bytes,
        is_empty: is_empty.get(),
        far_away,
    })
}

/// The frames that are shown, with their times, s.
fn chosen(
    frames: &[(PathBuf, f64)],
    order: &PictureOrder,
    kind: PictureKind,
) -> Result<Vec<(PathBuf, f64)>> {
    let last = frames.len() - 1;
    match kind {
        PictureKind::Gif => {
            let every = frames.len().div_ceil(MOST_FRAMES);
            let mut chosen: Vec<_> = frames.iter().step_by(every).cloned().collect();
            if !last.is_multiple_of(every) {
                chosen.push(frames[last].clone());
            }
            Ok(chosen)
        }
        PictureKind::Png => {
            if let Which::Nearest(time_s) = order.frame {
                refuse_beyond(time_s, frames)?;
            }
            let off_s = |number: &usize, time_s: f64| (frames[*number].1 - time_s).abs();
            let number = match order.frame {
                Which::Last => last,
                Which::Number(number) => number,
                Which::Nearest(time_s) => (0..frames.len())
                    .min_by(|a, b| off_s(a, time_s).total_cmp(&off_s(b, time_s)))
                    .unwrap_or(last),
            };
            let frame = frames.get(number).ok_or_else(|| {
                let problem = format!("there is no frame {number}");
                Diagnostic::input("--frame", problem, format!("the frames are 0 to {last}"))
            })?;
            Ok(vec![frame.clone()])
        }
    }
}

/// Refuses a time that is further from the frames than they are from each other.
fn refuse_beyond(time_s: f64, frames: &[(PathBuf, f64)]) -> Result<()> {
    let [(_, first_s), .., (_, last_s)] = frames else {
        return Ok(());
    };
    let every_s = (last_s - first_s) / (frames.len() - 1) as f64;
    if (first_s - every_s..=last_s + every_s).contains(&time_s) {
        return Ok(());
    }
    let [asked, first, last] = [time_s, *first_s, *last_s].map(|time| show_quantity(time, "s"));
    let problem = format!("there are no frames near {asked}");
    let remedy = format!("the run has frames from {first} to {last}");
    Err(Diagnostic::input("--time", problem, remedy))
}

/// The summary of the run.
fn summary(path: &Path) -> Result<Summary> {
    let summary = path.join("summary.json");
    let text = read_input(&summary, "the summary of a run")?;
    let read = serde_json::from_slice(&text).and_then(from_json);
    read.map_err(|error| {
        let problem = format!("this is not the summary of a run: {error}");
        Diagnostic::input(
            summary.display().to_string(),
            problem,
            "write the folder again",
        )
    })
}

/// The camera of all pictures: everything in the chosen frames that is not far from the walls, or a
/// part of it, and the largest number of spheres in a frame that are. Without a direction it looks
/// as in pictures that are made during a run.
fn camera(
    order: &PictureOrder,
    from: Option<[f64; 3]>,
    frames: &[(PathBuf, f64)],
    home: &Home,
) -> Result<(Camera, usize)> {
    let mut shown = Bounds::EMPTY;
    let mut far_away = 0;
    for frame in frames {
        let seen = Seen::read(frame)?;
        shown = shown.with(&Bounds::of(seen.points_m(home)));
        far_away = far_away.max(seen.far_away(home));
    }
    let Bounds { low, high } = shown;
    let middle_m = order
        .target_m
        .unwrap_or([0, 1, 2].map(|k| 0.5 * (low[k] + high[k])));
    let half = [0, 1, 2].map(|k| 0.5 * (high[k] - low[k]) / order.zoom);
    let corners: Vec<[f64; 3]> = (0..8)
        .map(|corner| {
            let sign = |k: usize| if corner >> k & 1 == 0 { -1.0 } else { 1.0 };
            [0, 1, 2].map(|k| middle_m[k] + sign(k) * half[k])
        })
        .collect();
    let direction = match from {
        Some(from) => from.map(|part| -part),
        None => Camera::three_quarter_direction(&home.start),
    };
    let camera = Camera::around(direction, UP, &corners, order.size_px);
    let is_chosen = order.target_m.is_some() || order.zoom != 1.0;
    Ok((camera, if is_chosen { 0 } else { far_away }))
}

fn drawn(
    seen: &Seen,
    walls: &[Surface],
    time_s: f64,
    camera: &Camera,
    colours: &Colours,
    every_s: f64,
) -> Image {
    let mut image = render(camera, &seen.balls(colours), walls);
    if let Some((name, [low, high])) = colours.scale() {
        colour_bar(&mut image, name, [&low, &high], &|at| colours.at(at));
    }
    label(&mut image, &time_text(time_s, every_s));
    scale_bar(&mut image, camera.px_per_m());
    image
}
