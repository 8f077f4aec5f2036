//! A picture of the crack: the body seen from the side, as it stood at the start, and the bonds
//! that broke.

use std::fmt::Write;

use dem_io::results::plots::BEGIN;

use crate::laboratory::evaluate::Crack;
use crate::plan::test_setup::{Setup, Specimen};

/// Width of the picture, px.
const WIDTH: f64 = 640.0;
/// Room around the body, px.
const SIDE: f64 = 24.0;
const ABOVE: f64 = 44.0;
const BELOW: f64 = 64.0;
/// Largest height of the body in the picture, px.
const HIGHEST: f64 = 420.0;
/// Most particles drawn, those nearest to the viewer.
const MOST_PARTICLES: usize = 4000;
/// Radius of a broken bond, px.
const DOT: f64 = 2.2;

/// A particle of the body at the start: centre x, y, z and radius, m.
pub type Sphere = [f64; 4];

/// What the picture shows.
#[derive(Debug, Clone, Copy)]
pub struct CrackPicture<'a> {
    /// What stood where.
    pub setup: &'a Setup,
    /// Particles of the body at the start.
    pub spheres: &'a [Sphere],
    /// Place at the start, m, and time, s, of each broken bond, in the order of time.
    pub broken: &'a [([f64; 3], f64)],
    /// Where they are on average.
    pub crack: Option<&'a Crack>,
}

/// From places to pixels: across the picture, up the picture, towards the viewer.
struct View {
    axes: [[f64; 3]; 3],
    /// Lowest place along the first two, m.
    low: [f64; 2],
    /// px/m
    scale: f64,
    height: f64,
}

impl View {
    fn of(setup: &Setup, spheres: &[Sphere]) -> Self {
        let direction = setup.direction;
        let along = match setup.specimen {
            Specimen::Bar { .. } => square_to(direction),
            _ => setup.along,
        };
        // What loads comes from above; a bar that is pulled along x is drawn upright as well.
        let up = direction.map(|c| -c);
        let flip = if along.iter().sum::<f64>() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let along = along.map(|c| flip * c);
        let axes = [along, up, cross(along, up)];
        let ends = |axis: [f64; 3]| {
            spheres
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| {
                    let at = dot(axis, [s[0], s[1], s[2]]);
                    [low.min(at - s[3]), high.max(at + s[3])]
                })
        };
        let ([left, right], [bottom, top]) = (ends(axes[0]), ends(axes[1]));
        let scale = ((WIDTH - 2.0 * SIDE) / (right - left)).min(HIGHEST / (top - bottom));
        Self {
            axes,
            low: [left, bottom],
            scale,
            height: scale * (top - bottom),
        }
    }

    /// x and y in the picture, px.
    fn place(&self, point: [f64; 3]) -> [f64; 2] {
        let [across, up, _] = self.axes.map(|axis| dot(axis, point));
        [
            SIDE + self.scale * (across - self.low[0]),
            ABOVE + self.height - self.scale * (up - self.low[1]),
        ]
    }

    fn depth(&self, sphere: &Sphere) -> f64 {
        dot(self.axes[2], [sphere[0], sphere[1], sphere[2]]) + sphere[3]
    }
}

/// A unit vector along x, y or z that is square to one along another of them.
fn square_to(direction: [f64; 3]) -> [f64; 3] {
    if direction[0].abs() < 0.5 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The picture as an SVG file: early breaks dark violet, late ones yellow.
pub fn crack_svg(picture: &CrackPicture<'_>) -> String {
    let view = View::of(picture.setup, picture.spheres);
    let mut out = String::new();
    // Writing to a text cannot fail.
    let _ = write_svg(&mut out, picture, &view);
    out
}

fn write_svg(out: &mut String, picture: &CrackPicture<'_>, view: &View) -> std::fmt::Result {
    let height = ABOVE + view.height + BELOW;
    writeln!(out, "{BEGIN}")?;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" viewBox=\"0 0 {WIDTH} {height:.0}\" \
         font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"12\" fill=\"#222222\">"
    )?;
    writeln!(out, "<title>Crack</title>")?;
    writeln!(
        out,
        "<rect width=\"{WIDTH}\" height=\"{height:.0}\" fill=\"#ffffff\"/>"
    )?;
    let title = match picture.broken.len() {
        1 => "1 broken bond".to_owned(),
        count => format!("{count} broken bonds"),
    };
    writeln!(
        out,
        "<text x=\"{:.1}\" y=\"25\" text-anchor=\"middle\" font-size=\"15\" font-weight=\"bold\">{title}, from the side, in the body at the start</text>",
        0.5 * WIDTH
    )?;
    write_particles(out, picture, view)?;
    write_marks(out, picture, view)?;
    write_broken(out, picture, view)?;
    write_scale(out, view, ABOVE + view.height + 26.0)?;
    write_times(out, picture, ABOVE + view.height + 26.0)?;
    writeln!(out, "</svg>")
}

/// The particles nearest to the viewer, faint.
fn write_particles(out: &mut String, picture: &CrackPicture<'_>, view: &View) -> std::fmt::Result {
    let front = picture.spheres.iter().map(|s| view.depth(s));
    let front = front.fold(f64::NEG_INFINITY, f64::max);
    let mut shown: Vec<&Sphere> = picture
        .spheres
        .iter()
        .filter(|s| front - view.depth(s) < 2.0 * s[3])
        .collect();
    // Those of a curved front that lie further back are missing less where too few are at the very
    // front.
    if shown.len() < picture.spheres.len().min(200) {
        shown = picture.spheres.iter().collect();
    }
    shown.sort_by(|a, b| view.depth(b).total_cmp(&view.depth(a)));
    shown.truncate(MOST_PARTICLES);
    writeln!(
        out,
        "<g id=\"particles\" fill=\"#eef1f4\" stroke=\"#cfd6dd\" stroke-width=\"0.5\">"
    )?;
    for sphere in shown.iter().rev() {
        let [x, y] = view.place([sphere[0], sphere[1], sphere[2]]);
        let radius = view.scale * sphere[3];
        writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\"/>"
        )?;
    }
    writeln!(out, "</g>")
}

/// Where the crack may be: dashed lines at both sides; and the mean place of the broken bonds: a
/// triangle below.
fn write_marks(out: &mut String, picture: &CrackPicture<'_>, view: &View) -> std::fmt::Result {
    let setup = picture.setup;
    let at = |offset: f64| {
        let place = [0, 1, 2].map(|k| setup.middle_m[k] + offset * setup.along[k]);
        view.place(place)
    };
    let upright = matches!(setup.specimen, Specimen::Bar { .. });
    let (top, bottom) = (ABOVE - 6.0, ABOVE + view.height + 6.0);
    let dashed = "stroke=\"#888888\" stroke-dasharray=\"5 4\" fill=\"none\"";
    for side in [-1.0, 1.0] {
        let [x, y] = at(side * setup.crack_within_m);
        if upright {
            writeln!(
                out,
                "<path d=\"M{SIDE} {y:.1}H{:.1}\" {dashed}/>",
                WIDTH - SIDE
            )?;
        } else {
            writeln!(out, "<path d=\"M{x:.1} {top:.1}V{bottom:.1}\" {dashed}/>")?;
        }
    }
    if let (Some(crack), false) = (picture.crack, upright) {
        let [x, _] = at(crack.offset_m);
        writeln!(
            out,
            "<path id=\"mean\" d=\"M{x:.1} {bottom:.1}l-5 9h10z\" fill=\"#222222\"/>"
        )?;
    }
    Ok(())
}

fn write_broken(out: &mut String, picture: &CrackPicture<'_>, view: &View) -> std::fmt::Result {
    writeln!(out, "<g id=\"broken\">")?;
    for &(place, time_s) in picture.broken {
        let [x, y] = view.place(place);
        let colour = colour(share_of_time(picture, time_s));
        writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{DOT}\" fill=\"{colour}\"/>"
        )?;
    }
    writeln!(out, "</g>")
}

fn share_of_time(picture: &CrackPicture<'_>, time_s: f64) -> f64 {
    let [first, last] = times(picture);
    if last > first {
        (time_s - first) / (last - first)
    } else {
        0.0
    }
}

fn times(picture: &CrackPicture<'_>) -> [f64; 2] {
    let time = |broken: Option<&([f64; 3], f64)>| broken.map_or(0.0, |(_, time_s)| *time_s);
    [time(picture.broken.first()), time(picture.broken.last())]
}

/// Viridis, in five steps with straight lines between them.
fn colour(share: f64) -> String {
    const STEPS: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 82.0, 139.0],
        [33.0, 145.0, 140.0],
        [94.0, 201.0, 98.0],
        [253.0, 231.0, 37.0],
    ];
    let at = 4.0 * share.clamp(0.0, 1.0);
    let below = (at as usize).min(3);
    let part = at - below as f64;
    let [r, g, b] = [0, 1, 2]
        .map(|k| ((1.0 - part) * STEPS[below][k] + part * STEPS[below + 1][k]).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A bar of a round length.
fn write_scale(out: &mut String, view: &View, y: f64) -> std::fmt::Result {
    let about_m = 100.0 / view.scale;
    let power = 10_f64.powf(about_m.log10().floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|f| f * power <= about_m);
    let length_m = factor.unwrap_or(1.0) * power;
    let end = SIDE + view.scale * length_m;
    writeln!(
        out,
        "<path d=\"M{SIDE} {y:.1}v-4v8v-4H{end:.1}v-4v8\" stroke=\"#222222\" fill=\"none\"/>"
    )?;
    writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\">{} mm</text>",
        end + 8.0,
        y + 4.0,
        (1e6 * length_m).round() / 1e3
    )
}

/// What the colours mean.
fn write_times(out: &mut String, picture: &CrackPicture<'_>, y: f64) -> std::fmt::Result {
    if picture.broken.is_empty() {
        return Ok(());
    }
    let [first, last] = times(picture);
    let (left, width, cells) = (WIDTH - SIDE - 200.0, 120.0, 24);
    let text = |x: f64, anchor: &str, time_s: f64| {
        format!(
            "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{:.3} s</text>",
            y + 4.0,
            time_s
        )
    };
    writeln!(out, "{}", text(left - 6.0, "end", first))?;
    for cell in 0..cells {
        let part = f64::from(cell) / f64::from(cells);
        let colour = colour(f64::from(cell) / f64::from(cells - 1));
        writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"5.2\" height=\"9\" fill=\"{colour}\"/>",
            left + width * part,
            y - 5.0
        )?;
    }
    writeln!(out, "{}", text(left + width + 6.0, "start", last))
}
