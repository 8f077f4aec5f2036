//! Positions to scale, such as the broken bonds of a body seen from the side.

use dem_io::units::show_quantity;
use maud::{Markup, html};

use crate::colours::{GREY, INK, hex, viridis};
use crate::numbers::px;
use crate::svg::{Svg, WIDTH};

/// Margin around the content, px.
const SIDE: f64 = 24.0;
const ABOVE: f64 = 44.0;
const BELOW: f64 = 64.0;
/// Largest height of the content, px.
const HIGHEST: f64 = 420.0;
/// Radius of a dot, px.
const DOT: f64 = 2.2;

/// Coloured dots over faint circles, with a scale bar of a round length, 640 px wide.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Map {
    /// Title.
    pub title: String,
    /// The lower left and the upper right corner of the content, m.
    pub corners_m: [[f64; 2]; 2],
    /// Faint circles, the first below the others.
    pub circles: Vec<Circle>,
    /// Dots, from early and dark violet to late and yellow.
    pub dots: Vec<Dot>,
    /// Dashed lines from edge to edge.
    pub guides: Vec<Guide>,
    /// Position of a triangle that points upwards from below, m along x.
    pub pointer_m: Option<f64>,
}

/// A circle to scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// x to the right and y upwards, m.
    pub centre_m: [f64; 2],
    /// Radius, m.
    pub radius_m: f64,
}

/// A dot of fixed size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dot {
    /// x to the right and y upwards, m.
    pub at_m: [f64; 2],
    /// Time that determines its colour, s.
    pub time_s: f64,
}

/// A straight line across the entire map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guide {
    /// Vertical, at this x, m.
    Upright(f64),
    /// Horizontal, at this y, m.
    Level(f64),
}

/// The transformation from positions to pixels.
struct View {
    /// Middle along x.
    middle_m: f64,
    bottom_m: f64,
    px_per_m: f64,
    /// Height of the content, px.
    height: f64,
}

impl View {
    fn of([low, high]: [[f64; 2]; 2]) -> Self {
        let [wide_m, high_m] = [0, 1].map(|k| high[k] - low[k]);
        let px_per_m = ((WIDTH - 2.0 * SIDE) / wide_m).min(HIGHEST / high_m);
        Self {
            middle_m: low[0] + 0.5 * wide_m,
            bottom_m: low[1],
            px_per_m,
            height: px_per_m * high_m,
        }
    }

    fn x(&self, x_m: f64) -> f64 {
        0.5 * WIDTH + self.px_per_m * (x_m - self.middle_m)
    }

    fn y(&self, y_m: f64) -> f64 {
        ABOVE + self.height - self.px_per_m * (y_m - self.bottom_m)
    }
}

impl Map {
    /// The map as SVG.
    pub fn svg(&self) -> Svg {
        let view = View::of(self.corners_m);
        let below = ABOVE + view.height + 26.0;
        let times = self.times();
        let content = html! {
            g class="circles" fill="#eef1f4" stroke="#cfd6dd" stroke-width="0.5" {
                @for Circle { centre_m: [x, y], radius_m } in &self.circles {
                    (circle([view.x(*x), view.y(*y)], view.px_per_m * radius_m, None))
                }
            }
            (self.guides(&view))
            g class="dots" {
                @for Dot { at_m: [x, y], time_s } in &self.dots {
                    (circle([view.x(*x), view.y(*y)], DOT, Some(hex(viridis(fraction(*time_s, times))))))
                }
            }
            (scale_bar(&view, below))
            @if !self.dots.is_empty() { (colour_bar(times, below)) }
        };
        Svg::new(ABOVE + view.height + BELOW, &self.title, &content)
    }

    fn guides(&self, view: &View) -> Markup {
        let [top, bottom] = [ABOVE - 6.0, ABOVE + view.height + 6.0];
        let path = |guide: &Guide| match guide {
            Guide::Upright(x_m) => format!("M{:.1} {top:.1}V{bottom:.1}", view.x(*x_m)),
            Guide::Level(y_m) => format!("M{SIDE} {:.1}H{:.1}", view.y(*y_m), WIDTH - SIDE),
        };
        html! {
            @for guide in &self.guides {
                path class="guide" d=(path(guide)) stroke=(GREY) stroke-dasharray="5 4" fill="none" {}
            }
            @if let Some(x_m) = self.pointer_m {
                path class="pointer" d=(format!("M{:.1} {bottom:.1}l-5 9h10z", view.x(x_m)))
                    fill=(INK) {}
            }
        }
    }

    /// Times of the first and the last dot, s.
    fn times(&self) -> [f64; 2] {
        let times = || self.dots.iter().map(|dot| dot.time_s);
        let last = times().fold(f64::NEG_INFINITY, f64::max);
        [times().fold(f64::INFINITY, f64::min), last]
    }
}

/// Position of a time between the first and the last one, 0 to 1.
fn fraction(time_s: f64, [first_s, last_s]: [f64; 2]) -> f64 {
    if last_s > first_s {
        (time_s - first_s) / (last_s - first_s)
    } else {
        0.0
    }
}

/// The colour bar with its times.
fn colour_bar([first_s, last_s]: [f64; 2], y: f64) -> Markup {
    const CELLS: u32 = 24;
    let (left, width) = (WIDTH - SIDE - 200.0, 120.0);
    html! {
        text x=(px(left - 6.0)) y=(px(y + 4.0)) text-anchor="end" { (show_quantity(first_s, "s")) }
        @for cell in 0..CELLS {
            rect x=(px(left + width * f64::from(cell) / f64::from(CELLS))) y=(px(y - 5.0))
                width="5.2" height="9" fill=(hex(viridis(f64::from(cell) / f64::from(CELLS - 1)))) {}
        }
        text x=(px(left + width + 6.0)) y=(px(y + 4.0)) { (show_quantity(last_s, "s")) }
    }
}

fn circle([x, y]: [f64; 2], radius: f64, fill: Option<String>) -> Markup {
    html! { circle cx=(px(x)) cy=(px(y)) r=(px(radius)) fill=[fill] {} }
}

/// A bar of a round length of at most 100 px.
fn scale_bar(view: &View, y: f64) -> Markup {
    let about_m = 100.0 / view.px_per_m;
    let power = 10_f64.powf(about_m.log10().floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|f| f * power <= about_m);
    let length_m = factor.unwrap_or(1.0) * power;
    let end = SIDE + view.px_per_m * length_m;
    html! {
        path d=(format!("M{SIDE} {y:.1}v-4v8v-4H{end:.1}v-4v8")) stroke=(INK) fill="none" {}
        text x=(px(end + 8.0)) y=(px(y + 4.0)) { ((1e6 * length_m).round() / 1e3) " mm" }
    }
}
