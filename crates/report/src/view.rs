//! A view of the frames in three dimensions: spheres, bonds and walls, to be turned, cut and played
//! in any browser with WebGL 2, without a network.

mod choose;
mod encode;
mod pieces;
mod spheres;
mod tracks;
mod walls;

use std::path::{Path, PathBuf};

use dem_io::Result;
use dem_pictures::colours::of_fragment;
use dem_plots::viridis;
use maud::{Markup, PreEscaped, html};
use serde_json::json;

use choose::{Chosen, choose};
use encode::encoded;

use crate::home::Home;
use crate::load_cells::LoadCells;
use tracks::{Ranges, Tracks};

pub(crate) use choose::ChosenFrame;
pub(crate) use pieces::Pieces;
pub(crate) use spheres::Spheres;
pub(crate) use tracks::most_of;
pub(crate) use walls::read as read_walls;

/// The program of the view.
const PROGRAM: &str = include_str!("view/viewer.js");
/// Its style.
const STYLE: &str = include_str!("view/viewer.css");
/// Number of colours of a scale, from which those between are mixed.
const COLOURS: usize = 17;

/// Most triangles of walls with loads that a frame shows.
const MOST_LOADS: usize = 50_000;

/// What the view needs from the folder of a run besides its frames.
pub(crate) struct Subject<'a> {
    pub(crate) folder: &'a Path,
    /// Frames and their times, s.
    pub(crate) frames: &'a [(PathBuf, f64)],
    /// Direction of the viewer, of any length.
    pub(crate) from: [f64; 3],
}

/// The view, as a part of a page. None: there are no frames with particles.
pub(crate) fn view(subject: &Subject<'_>) -> Result<Option<Markup>> {
    let Some(chosen) = choose(subject.frames)? else {
        return Ok(None);
    };
    let mut ranges = Ranges::default();
    let home = home(&chosen.frames[0])?;
    for frame in &chosen.frames {
        let spheres = Spheres::read(frame, chosen.every, chosen.with_bonds)?;
        ranges.include(&spheres, &home);
        if let Some(walls) = walls::read(frame)? {
            ranges.include_walls(&walls.points_m);
        }
        ranges.include_loads(&loads_of(frame)?);
    }
    let Some(scales) = ranges.scales() else {
        return Ok(None);
    };
    let mut tracks = Tracks::new();
    let mut names = Names::default();
    let pieces = Pieces::of(subject.folder);
    for frame in &chosen.frames {
        let spheres = Spheres::read(frame, chosen.every, chosen.with_bonds)?;
        pieces.refuse_unknown(&spheres, &frame.path)?;
        tracks.push(&spheres, &scales);
        tracks.push_walls(walls::read(frame)?.as_ref(), &scales);
        tracks.push_loads(&loads_of(frame)?, &scales);
        if names.bodies.is_empty() {
            names.bodies.clone_from(&spheres.body_names);
        }
        names.can_break |= spheres.can_break;
        names.has_bonds |= !spheres.bonds.is_empty();
    }
    let pieces = pieces.colours(tracks.last_fragment());
    let head = head(subject, &chosen, &scales, (&tracks, pieces), &names);
    let data = encoded(tracks.all())
        .map_err(|error| dem_io::Diagnostic::failed("report.html", error.to_string(), ""))?;
    Ok(Some(markup(&head.to_string(), &data, &chosen)))
}

/// The loads of the walls of a frame, unless there are too many for a page.
fn loads_of(frame: &ChosenFrame) -> Result<LoadCells> {
    let loads = walls::read_loads(frame)?;
    let few = loads.filter(|loads| loads.triangles_m.len() <= MOST_LOADS);
    Ok(few.unwrap_or_default())
}

/// Where a run with this first frame takes place.
pub(crate) fn home(first: &ChosenFrame) -> Result<Home> {
    let walls = walls::read(first)?.unwrap_or_default();
    let spheres = Spheres::read(first, 1, false)?;
    Ok(Home::of(&walls.points_m, &spheres.centres_m))
}

/// What the frames contain.
#[derive(Default)]
struct Names {
    bodies: Vec<String>,
    can_break: bool,
    has_bonds: bool,
}

/// The data that stand before the numbers, for `viewer.js`.
fn head(
    subject: &Subject<'_>,
    chosen: &Chosen,
    scales: &tracks::Scales,
    (tracks, pieces): (&Tracks, Vec<[u8; 3]>),
    names: &Names,
) -> serde_json::Value {
    let mut modes = vec![if names.can_break { "piece" } else { "body" }];
    if names.can_break && tracks.last_body() > 0 {
        modes.push("body");
    }
    modes.push("speed");
    if names.has_bonds {
        modes.extend(["utilisation", "stress"]);
    }
    if names.can_break {
        modes.push("mass");
    }
    let scale = (0..COLOURS).map(|k| hex(viridis(k as f64 / (COLOURS - 1) as f64)));
    let times_s: Vec<f64> = chosen.frames.iter().map(|frame| frame.time_s).collect();
    let bodies = (0..=tracks.last_body()).map(|body| hex(of_fragment(body, 1.0)));
    json!({
        "time_texts": times_s.iter().map(|time_s| time_text(*time_s)).collect::<Vec<_>>(),
        "times_s": times_s,
        "opening": 0.6,
        "from": subject.from,
        "origin_m": scales.low_m,
        "low_m": scales.low_m,
        "high_m": scales.high_m,
        "resolution_m": scales.resolution_m,
        "radius_unit_m": scales.radius_unit_m,
        "focus_m": scales.focus_m,
        "reach_m": scales.reach_m,
        "modes": modes,
        "scale": scale.collect::<Vec<_>>(),
        "piece_colours": pieces.into_iter().map(hex).collect::<Vec<_>>(),
        "body_colours": bodies.collect::<Vec<_>>(),
        "body_names": names.bodies,
        "highest": scales.highest_texts(),
        "loads": scales.loads(),
        "tracks": tracks.all().collect::<Vec<_>>(),
    })
}

/// A time with a fitting unit: `1.25 ms`.
fn time_text(time_s: f64) -> String {
    dem_io::units::show_quantity(time_s, "s")
}

fn hex([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The elements of the view. Texts within scripts must contain neither `</` nor `<!--`; JSON may
/// write `<` as `\u003c`, and base64 has none.
fn markup(head: &str, data: &str, chosen: &Chosen) -> Markup {
    let head = head.replace('<', "\\u003c");
    html! {
        style { (PreEscaped(STYLE)) }
        div id="view" data-state="loading" {
            canvas class="canvas" tabindex="0" aria-label="The run in three dimensions" {}
            p class="say" { "Loading the view." }
            div class="controls" hidden[true] {
                div class="times" {
                    button class="play" type="button" { "Play" }
                    input class="slider" type="range" min="0" value="0" aria-label="Time";
                    output class="time" {}
                    button class="full" type="button" { "Full screen" }
                }
                div class="choices" {
                    label { "Colour " select class="mode" {} }
                    span class="mode-legend legend" hidden[true] {
                        span class="low" {} span class="ramp" {} span class="high" {}
                    }
                    span class="bodies" hidden[true] {}
                    span class="pieces" hidden[true] { "each fragment has its own colour" }
                    @for name in ["spheres", "bonds", "walls"] {
                        label { input class=(name) type="checkbox"; " " (name) }
                    }
                    label class="loads-choice" hidden[true] { "Loads of walls " select class="loads" {} }
                    span class="loads-legend legend" hidden[true] {
                        span class="low" { "0" } span class="ramp" {} span class="high" {}
                    }
                    label { "Cut " select class="axis" {
                        option value="" { "none" }
                        @for axis in ["x", "y", "z"] { option value=(axis) { (axis) } }
                    } }
                    input class="cut" type="range" min="0" max="1" step="0.005" value="0.5" disabled[true] aria-label="Place of the cut";
                    button class="reset" type="button" { "Reset" }
                }
            }
        }
        p class="small" {
            "Drag to turn, drag with two fingers or the right button to move, pinch, or click and use the wheel, to zoom. Arrow keys step through the frames."
            @for note in chosen.notes() { " " (note) }
        }
        script id="view-head" type="application/json" { (PreEscaped(head)) }
        script id="view-data" type="application/octet-stream" { (PreEscaped(data)) }
        script { (PreEscaped(PROGRAM)) }
    }
}
