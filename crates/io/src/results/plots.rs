//! Line plots as SVG, which browsers, editors and word processors show as they stand.
//!
//! 640 x 400 on white. Values that are not finite are gaps, and so are those of no logarithm on an axis that has one.

mod contents;
mod legend;
mod scale;
mod text;
mod thin;

use std::fmt::Write;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::text::for_page;
use contents::Area;
pub use contents::{Axis, HEIGHT, Line, Plot, WIDTH};
use legend::{Entry, Legend};
use scale::Scale;
use text::{shortened, width};

/// How every picture of a run begins: by this it is known as one that may be replaced.
pub const BEGIN: &str = "<!-- dem-run plot -->";

const INK: &str = "#222222";
const GRID: &str = "#e4e4e4";
const FINE_GRID: &str = "#f2f2f2";

/// Lines of a plot that each have a colour of their own.
pub const MOST_LINES: usize = 7;

/// Colours of the lines, told apart with any colour vision (Okabe and Ito 2008).
const COLOURS: [&str; MOST_LINES] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555",
];

/// The plot as an SVG file.
pub fn svg(plot: &Plot) -> String {
    let drawn = |point: &[f64; 2]| {
        scale::is_drawn(point[0], plot.x.log) && scale::is_drawn(point[1], plot.y.log)
    };
    let points = || {
        plot.lines
            .iter()
            .flat_map(|line| line.points.iter().filter(|point| drawn(point)))
    };
    let reference = plot
        .reference
        .as_ref()
        .filter(|(value, _)| scale::is_drawn(*value, plot.y.log));
    let x = Scale::new(&plot.x, points().map(|point| point[0]), false);
    let heights = points().map(|point| point[1]);
    let y = Scale::new(
        &plot.y,
        heights.chain(reference.map(|(value, _)| *value)),
        true,
    );

    let entries = entries(plot, reference.map(|(_, name)| name.as_str()));
    let widest = y
        .ticks
        .iter()
        .map(|tick| width(&tick.label, 12.0))
        .fold(0.0, f64::max);
    let mut area = Area {
        left: (widest + 46.0).ceil(),
        top: if plot.title.is_empty() { 16.0 } else { 40.0 },
        right: WIDTH - 24.0,
        bottom: HEIGHT - 52.0,
    };
    let mut segments = segments_of(plot, [&x, &y], area);
    let mut legend = None;
    if entries.len() > 1 {
        let level = reference.map(|(value, _)| area.place([0.0, y.share(*value)])[1]);
        legend = Legend::inside(&entries, &segments, level, area);
        if legend.is_none() {
            let below = Legend::below(&entries);
            area.bottom -= below.height;
            segments = segments_of(plot, [&x, &y], area);
            legend = Some(below);
        }
    }

    let mut out = String::new();
    // Writing to a text cannot fail.
    let _ = write_svg(
        &mut out,
        plot,
        &Layout {
            x,
            y,
            area,
            segments,
            reference: reference.map(|(value, _)| *value),
            entries,
            legend,
        },
    );
    out
}

/// Whether the file at `path` is a plot that we wrote.
pub(super) fn is_ours(path: &Path) -> bool {
    let mut begin = vec![0; BEGIN.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut begin));
    read.is_ok() && begin == BEGIN.as_bytes()
}

/// Everything that is decided before the first letter is written.
struct Layout {
    x: Scale,
    y: Scale,
    area: Area,
    /// Of each line its pieces between gaps, px.
    segments: Vec<Vec<Vec<[f64; 2]>>>,
    reference: Option<f64>,
    entries: Vec<Entry>,
    legend: Option<Legend>,
}

fn segments_of(plot: &Plot, [x, y]: [&Scale; 2], area: Area) -> Vec<Vec<Vec<[f64; 2]>>> {
    let place = |point: &[f64; 2]| {
        let drawn = scale::is_drawn(point[0], plot.x.log) && scale::is_drawn(point[1], plot.y.log);
        drawn.then(|| area.place([x.share(point[0]), y.share(point[1])]))
    };
    plot.lines
        .iter()
        .map(|line| thin::segments(line.points.iter().map(place)))
        .collect()
}

fn entries(plot: &Plot, reference: Option<&str>) -> Vec<Entry> {
    let mut entries: Vec<Entry> = plot
        .lines
        .iter()
        .enumerate()
        .map(|(index, line)| Entry {
            name: line.name.clone(),
            stroke: stroke(index, line.dashed),
        })
        .collect();
    if let Some(name) = reference {
        entries.push(Entry {
            name: name.to_owned(),
            stroke: REFERENCE_STROKE.to_owned(),
        });
    }
    entries
}

const REFERENCE_STROKE: &str = "stroke=\"#888888\" stroke-width=\"1.2\" stroke-dasharray=\"2 3\"";

/// How a line is drawn. When the colours are used up, they come again with other dashes.
fn stroke(index: usize, dashed: bool) -> String {
    let colour = COLOURS[index % COLOURS.len()];
    let dashes = match (dashed, index / COLOURS.len() % 3) {
        (false, 0) => "",
        (true, 0) => " stroke-dasharray=\"6 4\"",
        (_, 1) => " stroke-dasharray=\"9 3 2 3\"",
        _ => " stroke-dasharray=\"3 2\"",
    };
    format!("stroke=\"{colour}\" stroke-width=\"1.6\"{dashes}")
}

fn write_svg(out: &mut String, plot: &Plot, layout: &Layout) -> std::fmt::Result {
    writeln!(out, "{BEGIN}")?;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"12\" fill=\"{INK}\">"
    )?;
    writeln!(out, "<title>{}</title>", for_page(&plot.title))?;
    writeln!(
        out,
        "<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>"
    )?;
    write_grid(out, layout)?;
    write_labels(out, plot, layout)?;
    if let Some(value) = layout.reference {
        let Area { left, right, .. } = layout.area;
        let [_, y] = layout.area.place([0.0, layout.y.share(value)]);
        writeln!(
            out,
            "<line id=\"reference\" x1=\"{left:.2}\" y1=\"{y:.2}\" x2=\"{right:.2}\" y2=\"{y:.2}\" {REFERENCE_STROKE}/>"
        )?;
    }
    for (index, (line, segments)) in plot.lines.iter().zip(&layout.segments).enumerate() {
        write_line(out, index, line, segments)?;
    }
    let Area {
        left,
        top,
        right,
        bottom,
    } = layout.area;
    writeln!(
        out,
        "<rect id=\"area\" x=\"{left:.2}\" y=\"{top:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"none\" stroke=\"#888888\"/>",
        right - left,
        bottom - top
    )?;
    if layout.segments.iter().all(Vec::is_empty) {
        let (x, y) = (f64::midpoint(left, right), f64::midpoint(top, bottom));
        writeln!(
            out,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"middle\" font-size=\"14\" fill=\"#888888\">no data</text>"
        )?;
    }
    if let Some(legend) = &layout.legend {
        legend.write(out, &layout.entries)?;
    }
    writeln!(out, "</svg>")
}

fn write_grid(out: &mut String, layout: &Layout) -> std::fmt::Result {
    let Area {
        left,
        top,
        right,
        bottom,
    } = layout.area;
    for fine in [true, false] {
        let mut path = String::new();
        let shares = |scale: &Scale| -> Vec<f64> {
            if fine {
                scale.fine.clone()
            } else {
                scale.ticks.iter().map(|tick| tick.share).collect()
            }
        };
        for share in shares(&layout.x) {
            let [x, _] = layout.area.place([share, 0.0]);
            write!(path, "M{x:.2} {top:.2}V{bottom:.2}")?;
        }
        for share in shares(&layout.y) {
            let [_, y] = layout.area.place([0.0, share]);
            write!(path, "M{left:.2} {y:.2}H{right:.2}")?;
        }
        if !path.is_empty() {
            let colour = if fine { FINE_GRID } else { GRID };
            writeln!(
                out,
                "<path d=\"{path}\" stroke=\"{colour}\" fill=\"none\"/>"
            )?;
        }
    }
    Ok(())
}

fn write_labels(out: &mut String, plot: &Plot, layout: &Layout) -> std::fmt::Result {
    let Area {
        left,
        top,
        right,
        bottom,
    } = layout.area;
    if !plot.title.is_empty() {
        // Bold letters are wider.
        let title = shortened(&plot.title, 17.0, WIDTH - 40.0);
        writeln!(
            out,
            "<text x=\"{:.2}\" y=\"25\" text-anchor=\"middle\" font-size=\"15\" font-weight=\"bold\">{}</text>",
            WIDTH / 2.0,
            for_page(&title)
        )?;
    }
    writeln!(out, "<g text-anchor=\"middle\">")?;
    for tick in &layout.x.ticks {
        let [x, _] = layout.area.place([tick.share, 0.0]);
        writeln!(
            out,
            "<text x=\"{x:.2}\" y=\"{:.2}\">{}</text>",
            bottom + 17.0,
            tick.label
        )?;
    }
    writeln!(out, "</g>\n<g text-anchor=\"end\">")?;
    for tick in &layout.y.ticks {
        let [_, y] = layout.area.place([0.0, tick.share]);
        writeln!(
            out,
            "<text x=\"{:.2}\" y=\"{:.2}\">{}</text>",
            left - 7.0,
            y + 4.0,
            tick.label
        )?;
    }
    writeln!(out, "</g>\n<g text-anchor=\"middle\" font-size=\"13\">")?;
    let (x, y) = (f64::midpoint(left, right), f64::midpoint(top, bottom));
    let label = shortened(&layout.x.label, 13.0, right - left);
    writeln!(
        out,
        "<text x=\"{x:.2}\" y=\"{:.2}\">{}</text>",
        bottom + 38.0,
        for_page(&label)
    )?;
    let label = shortened(&layout.y.label, 13.0, bottom - top);
    writeln!(
        out,
        "<text transform=\"translate(20 {y:.2}) rotate(-90)\">{}</text>\n</g>",
        for_page(&label)
    )
}

/// A line in its pieces; a piece of one point is a dot.
fn write_line(
    out: &mut String,
    index: usize,
    line: &Line,
    segments: &[Vec<[f64; 2]>],
) -> std::fmt::Result {
    let stroke = stroke(index, line.dashed);
    writeln!(
        out,
        "<g class=\"line\" fill=\"none\" stroke-linejoin=\"round\" {stroke}>"
    )?;
    writeln!(out, "<title>{}</title>", for_page(&line.name))?;
    for segment in segments {
        if let [[x, y]] = segment[..] {
            let colour = COLOURS[index % COLOURS.len()];
            writeln!(
                out,
                "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"2.5\" fill=\"{colour}\" stroke=\"none\"/>"
            )?;
            continue;
        }
        out.push_str("<polyline points=\"");
        for (number, [x, y]) in segment.iter().enumerate() {
            let blank = if number == 0 { "" } else { " " };
            write!(out, "{blank}{x:.2},{y:.2}")?;
        }
        writeln!(out, "\"/>")?;
    }
    writeln!(out, "</g>")
}
