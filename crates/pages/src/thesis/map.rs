//! Side views of the sample, coloured by utilisation or by dynamic increase factor (Platzer 2022,
//! figs. 55 and 56).

use std::fmt::Write;

use serde_json::Value;

use crate::bench::number;

const PX_PER_M: f64 = 3200.0;
const MARGIN_PX: f64 = 20.0;

/// One view: the column of a cell that it shows, the value of its last colour, and its title.
pub(crate) struct View {
    pub(crate) column: usize,
    pub(crate) from_to: [f64; 2],
    pub(crate) title: String,
}

/// The views below each other, of the cells of one drop.
pub(crate) fn svg(utilisation: &Value, views: &[View]) -> String {
    let cell_m = number(&utilisation["cell_m"]);
    let cells: Vec<[f64; 4]> = utilisation["cells"]
        .as_array()
        .map_or(&[][..], Vec::as_slice)
        .iter()
        .map(|cell| [0, 1, 2, 3].map(|k| number(&cell[k])))
        .collect();
    let extent = |k: usize| {
        let least = cells
            .iter()
            .map(|cell| cell[k])
            .fold(f64::INFINITY, f64::min);
        let most = cells
            .iter()
            .map(|cell| cell[k])
            .fold(f64::NEG_INFINITY, f64::max);
        [least, most]
    };
    let ([left_m, right_m], [bottom_m, top_m]) = (extent(0), extent(1));
    let side = PX_PER_M * cell_m;
    let [width, height] = [right_m - left_m, top_m - bottom_m].map(|m| PX_PER_M * m + side);
    let view_height = height + 60.0;
    let whole = [
        width + 2.0 * MARGIN_PX,
        view_height * views.len() as f64 + MARGIN_PX,
    ];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0}\" height=\"{1:.0}\" viewBox=\"0 0 {0:.0} {1:.0}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\">\n<rect width=\"{0:.0}\" height=\"{1:.0}\" fill=\"#ffffff\"/>\n",
        whole[0], whole[1]
    );
    for (place, view) in views.iter().enumerate() {
        let above = view_height * place as f64 + MARGIN_PX;
        let _ = writeln!(
            svg,
            "<text x=\"{MARGIN_PX}\" y=\"{above:.0}\">{}</text>",
            view.title
        );
        for cell in &cells {
            let x = MARGIN_PX + PX_PER_M * (cell[0] - left_m);
            let y = above + 8.0 + PX_PER_M * (top_m - cell[1]);
            let _ = writeln!(
                svg,
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{side:.1}\" height=\"{side:.1}\" fill=\"{}\"/>",
                colour(view, cell[view.column])
            );
        }
        scale(&mut svg, view, above + height + 18.0);
    }
    svg + "</svg>\n"
}

/// Five fields of the colour scale with their values.
fn scale(svg: &mut String, view: &View, y: f64) {
    let [from, to] = view.from_to;
    for field in 0..5 {
        let value = from + (to - from) * f64::from(field) / 4.0;
        let x = MARGIN_PX + 90.0 * f64::from(field);
        let fill = colour(view, value);
        let _ = writeln!(
            svg,
            "<rect x=\"{x:.0}\" y=\"{y:.1}\" width=\"14\" height=\"12\" fill=\"{fill}\"/>\n<text x=\"{:.0}\" y=\"{:.1}\">{value:.2}</text>",
            x + 18.0,
            y + 10.0
        );
    }
}

/// From white over orange to dark red.
fn colour(view: &View, value: f64) -> String {
    const STOPS: [[f64; 3]; 3] = [
        [242.0, 244.0, 247.0],
        [244.0, 165.0, 72.0],
        [130.0, 10.0, 30.0],
    ];
    let [from, to] = view.from_to;
    let at = 2.0 * ((value - from) / (to - from)).clamp(0.0, 1.0);
    let below = (at as usize).min(1);
    let part = at - below as f64;
    let [r, g, b] = [0, 1, 2]
        .map(|k| ((1.0 - part) * STOPS[below][k] + part * STOPS[below + 1][k]).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
