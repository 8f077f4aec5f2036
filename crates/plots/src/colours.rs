//! Colours that can be distinguished with any colour vision, and shapes.

use maud::{Markup, html};

use crate::numbers::{places, px};

pub(crate) const INK: &str = "#222222";
pub(crate) const GREY: &str = "#888888";

/// Number of lines of a plot that each have a colour of their own.
pub const MOST_LINES: usize = 7;

/// Colours of lines and kinds of marks, after Okabe and Ito 2008.
const COLOURS: [&str; MOST_LINES] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555",
];

/// The colour of the line or kind of marks with this number.
pub(crate) fn colour(number: usize) -> &'static str {
    COLOURS[number % COLOURS.len()]
}

/// The stroke of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stroke {
    pub(crate) colour: &'static str,
    /// Width, px.
    pub(crate) width: f64,
    pub(crate) dashes: Option<&'static str>,
}

/// For a reference value.
pub(crate) const REFERENCE: Stroke = Stroke {
    colour: GREY,
    width: 1.2,
    dashes: Some("2 3"),
};

impl Stroke {
    /// For the line with this number. When the colours are used up, they repeat with other dashes.
    pub(crate) fn of_line(number: usize, dashed: bool) -> Self {
        let dashes = match (dashed, number / COLOURS.len() % 3) {
            (false, 0) => None,
            (true, 0) => Some("6 4"),
            (_, 1) => Some("9 3 2 3"),
            _ => Some("3 2"),
        };
        Self {
            colour: colour(number),
            width: 1.6,
            dashes,
        }
    }
}

/// A mark of a kind at a position, px, in the colour of its kind.
pub(crate) fn shape(kind: usize, [x, y]: [f64; 2], fill: &str) -> Markup {
    let corners: &[[f64; 2]] = match kind % 5 {
        0 => &[],
        1 => &[[-3.8, -3.8], [3.8, -3.8], [3.8, 3.8], [-3.8, 3.8]],
        2 => &[[0.0, -5.0], [4.7, 3.6], [-4.7, 3.6]],
        3 => &[[0.0, -5.4], [5.4, 0.0], [0.0, 5.4], [-5.4, 0.0]],
        _ => &[[0.0, 5.0], [4.7, -3.6], [-4.7, -3.6]],
    };
    let placed = places(corners.iter().map(|[dx, dy]| [x + dx, y + dy]));
    html! {
        @if corners.is_empty() {
            circle cx=(px(x)) cy=(px(y)) r="4.2" fill=(fill) stroke-width="1.5" {}
        } @else {
            polygon points=(placed) fill=(fill) stroke-width="1.5" {}
        }
    }
}

/// Viridis, from dark violet (0) to yellow (1), in five steps with linear interpolation.
/// Red, green, blue.
pub fn viridis(fraction: f64) -> [u8; 3] {
    const STEPS: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 82.0, 139.0],
        [33.0, 145.0, 140.0],
        [94.0, 201.0, 98.0],
        [253.0, 231.0, 37.0],
    ];
    let at = 4.0 * fraction.clamp(0.0, 1.0);
    let below = (at as usize).min(3);
    let part = at - below as f64;
    [0, 1, 2].map(|k| ((1.0 - part) * STEPS[below][k] + part * STEPS[below + 1][k]).round() as u8)
}

/// A scale for values of both signs: blue (-1), nearly white (0), red (1). Red, green, blue.
pub fn blue_to_red(fraction: f64) -> [u8; 3] {
    const MIDDLE: [f64; 3] = [243.0, 241.0, 236.0];
    const BLUE: [f64; 3] = [33.0, 102.0, 172.0];
    const RED: [f64; 3] = [178.0, 24.0, 43.0];
    let end = if fraction < 0.0 { BLUE } else { RED };
    let part = fraction.abs().min(1.0);
    [0, 1, 2].map(|k| ((1.0 - part) * MIDDLE[k] + part * end[k]).round() as u8)
}

/// A colour in the notation of SVG.
pub(crate) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
