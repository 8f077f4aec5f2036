//! Error against run time as SVG: both axes logarithmic, series told apart by colour and shape, the
//! front filled and joined.

use std::fmt::Write;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use dem_io::text::for_page;

use super::rows::{Row, SweepTable};
use super::scale::{Scale, tick};

const WIDTH: f64 = 820.0;
const LEFT: f64 = 78.0;
const TOP: f64 = 44.0;
const RIGHT: f64 = 590.0;
const BOTTOM: f64 = 400.0;
const HEIGHT: f64 = 456.0;
/// Left end of the legend.
const LEGEND: f64 = RIGHT + 18.0;
/// Most letters of a name in the legend.
const LETTERS: usize = 28;
/// Most series in the legend.
const MOST_SERIES: usize = 16;

const INK: &str = "#222222";
/// Told apart with any colour vision (Okabe and Ito 2008).
const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555",
];
const SHAPES: usize = 5;

/// How the picture begins.
const BEGIN: &str = "<!-- dem-run sweep -->\n";

/// Whether a file is a plot of a sweep, of errors or of curves.
pub(super) fn is_plot(path: &Path) -> bool {
    [BEGIN, dem_io::results::plots::BEGIN].iter().any(|begin| {
        let mut found = vec![0; begin.len()];
        let read = File::open(path).and_then(|mut file| file.read_exact(&mut found));
        read.is_ok() && found == begin.as_bytes()
    })
}

/// A run in the plot.
struct Mark<'a> {
    row: &'a Row,
    time_s: f64,
    spread_s: f64,
    error: f64,
    is_on_front: bool,
    series: usize,
}

/// The plot of one measure. `alone`: as a file by itself, not as part of a page.
pub fn svg(table: &SweepTable, measure: usize, alone: bool) -> String {
    let mut out = String::new();
    // Writing to a text cannot fail.
    let _ = write_svg(&mut out, table, measure, alone);
    out
}

fn marks(table: &SweepTable, measure: usize) -> Vec<Mark<'_>> {
    let of_row = |row| {
        let row: &Row = row;
        let judged = row.results.get(measure)?;
        Some(Mark {
            time_s: row.time_s?,
            spread_s: row.spread_s?,
            error: judged.sure_error()?,
            is_on_front: judged.is_on_front,
            series: table.series.map_or(0, |axis| row.choice[axis]),
            row,
        })
    };
    table.runs.iter().filter_map(of_row).collect()
}

fn write_svg(
    out: &mut String,
    table: &SweepTable,
    measure: usize,
    alone: bool,
) -> std::fmt::Result {
    let column = &table.measures[measure];
    let marks = marks(table, measure);
    let times = marks.iter().map(|mark| mark.time_s);
    let x = Scale::new(times);
    let y = Scale::new(marks.iter().map(|mark| mark.error));
    let (begin, space) = if alone {
        (BEGIN, " xmlns=\"http://www.w3.org/2000/svg\"")
    } else {
        ("", "")
    };
    writeln!(
        out,
        "{begin}<svg{space} width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"12\" fill=\"{INK}\">"
    )?;
    let title = format!(
        "{}: error against {}",
        column.name.replace('_', " "),
        table.time
    );
    writeln!(out, "<title>{}</title>", for_page(&title))?;
    writeln!(
        out,
        "<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>"
    )?;
    writeln!(
        out,
        "<text x=\"{:.1}\" y=\"27\" text-anchor=\"middle\" font-size=\"15\" font-weight=\"bold\">{}</text>",
        f64::midpoint(LEFT, RIGHT),
        for_page(&shortened(&title, 60))
    )?;
    write_axes(out, &x, &y)?;
    let is_difference = marks.iter().any(|mark| {
        let judged = &mark.row.results[measure];
        judged.reference == Some(0.0) && !column.unit.is_empty()
    });
    let unit = if is_difference {
        format!(" ({})", column.unit)
    } else {
        " (share)".to_owned()
    };
    let repeats = match table.repeats {
        1 => String::new(),
        repeats => format!(", median of {repeats} or more"),
    };
    writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"13\">{} (s){repeats}</text>",
        f64::midpoint(LEFT, RIGHT),
        BOTTOM + 40.0,
        table.time
    )?;
    writeln!(
        out,
        "<text transform=\"translate(18 {:.1}) rotate(-90)\" text-anchor=\"middle\" font-size=\"13\">error{unit}</text>",
        f64::midpoint(TOP, BOTTOM)
    )?;
    write_chains(out, table, &marks, &x, &y)?;
    write_front(out, &marks, &x, &y)?;
    for mark in &marks {
        write_mark(out, table, mark, &x, &y)?;
    }
    if marks.is_empty() {
        writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"14\" fill=\"#888888\">no run has an error that is known</text>",
            f64::midpoint(LEFT, RIGHT),
            f64::midpoint(TOP, BOTTOM)
        )?;
    }
    write_legend(out, table, &marks)?;
    writeln!(out, "</svg>")
}

fn write_axes(out: &mut String, x: &Scale, y: &Scale) -> std::fmt::Result {
    let across = |share: f64| LEFT + share * (RIGHT - LEFT);
    let up = |share: f64| BOTTOM - share * (BOTTOM - TOP);
    for (fine, colour) in [(true, "#f2f2f2"), (false, "#dddddd")] {
        let mut path = String::new();
        for value in x.lines(fine, 7) {
            write!(path, "M{:.2} {TOP}V{BOTTOM}", across(x.share(value)))?;
        }
        for value in y.lines(fine, 9) {
            write!(path, "M{LEFT} {:.2}H{RIGHT}", up(y.share(value)))?;
        }
        writeln!(
            out,
            "<path d=\"{path}\" stroke=\"{colour}\" fill=\"none\"/>"
        )?;
    }
    writeln!(out, "<g class=\"x\" text-anchor=\"middle\">")?;
    for value in x.lines(false, 7) {
        let (at, y) = (across(x.share(value)), BOTTOM + 18.0);
        writeln!(out, "<text x=\"{at:.2}\" y=\"{y}\">{}</text>", tick(value))?;
    }
    writeln!(out, "</g>\n<g class=\"y\" text-anchor=\"end\">")?;
    for value in y.lines(false, 9) {
        let at = up(y.share(value)) + 4.0;
        writeln!(
            out,
            "<text x=\"{}\" y=\"{at:.2}\">{}</text>",
            LEFT - 7.0,
            tick(value)
        )?;
    }
    writeln!(
        out,
        "</g>\n<rect class=\"area\" x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888888\"/>",
        RIGHT - LEFT,
        BOTTOM - TOP
    )
}

fn place(x: &Scale, y: &Scale, time_s: f64, error: f64) -> [f64; 2] {
    [
        LEFT + x.share(time_s) * (RIGHT - LEFT),
        BOTTOM - y.share(error) * (BOTTOM - TOP),
    ]
}

/// Thin lines through runs that differ along one axis with sizes only.
fn write_chains(
    out: &mut String,
    table: &SweepTable,
    marks: &[Mark<'_>],
    x: &Scale,
    y: &Scale,
) -> std::fmt::Result {
    let along = table
        .axes
        .iter()
        .rposition(|axis| axis.sizes.is_some())
        .filter(|along| Some(*along) != table.series);
    let Some((along, sizes)) = along.and_then(|at| Some((at, table.axes[at].sizes.as_ref()?)))
    else {
        return Ok(());
    };
    let others = |mark: &Mark<'_>| {
        let mut others = mark.row.choice.clone();
        others[along] = 0;
        others
    };
    let mut sorted: Vec<&Mark<'_>> = marks.iter().collect();
    sorted.sort_by(|a, b| {
        let size = |mark: &Mark<'_>| sizes[mark.row.choice[along]];
        others(a).cmp(&others(b)).then(size(a).total_cmp(&size(b)))
    });
    for chain in sorted.chunk_by(|a, b| others(a) == others(b)) {
        if chain.len() < 2 {
            continue;
        }
        let points: Vec<String> = chain
            .iter()
            .map(|mark| {
                let [px, py] = place(x, y, mark.time_s, mark.error);
                format!("{px:.2},{py:.2}")
            })
            .collect();
        writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1\" stroke-opacity=\"0.35\"/>",
            points.join(" "),
            COLOURS[chain[0].series % COLOURS.len()]
        )?;
    }
    Ok(())
}

/// What is possible lies above and to the right of this line.
fn write_front(out: &mut String, marks: &[Mark<'_>], x: &Scale, y: &Scale) -> std::fmt::Result {
    let mut front: Vec<&Mark<'_>> = marks.iter().filter(|mark| mark.is_on_front).collect();
    front.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let mut path = String::new();
    let mut least = f64::INFINITY;
    for mark in front {
        if mark.error >= least {
            continue;
        }
        least = mark.error;
        let [px, py] = place(x, y, mark.time_s, mark.error);
        if path.is_empty() {
            write!(path, "M{px:.2} {TOP}V{py:.2}")?;
        } else {
            write!(path, "H{px:.2}V{py:.2}")?;
        }
    }
    if !path.is_empty() {
        writeln!(
            out,
            "<path class=\"front\" d=\"{path}H{RIGHT}\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"1.2\" stroke-dasharray=\"5 3\"/>"
        )?;
    }
    Ok(())
}

fn write_mark(
    out: &mut String,
    table: &SweepTable,
    mark: &Mark<'_>,
    x: &Scale,
    y: &Scale,
) -> std::fmt::Result {
    let [px, py] = place(x, y, mark.time_s, mark.error);
    let colour = COLOURS[mark.series % COLOURS.len()];
    let [from, to] = [-0.5, 0.5].map(|side| {
        let time = (mark.time_s + side * mark.spread_s).max(1e-3 * mark.time_s);
        place(x, y, time, mark.error)[0]
    });
    writeln!(out, "<g class=\"run\" stroke=\"{colour}\">")?;
    writeln!(
        out,
        "<title>run {}: {}; {} s, error {}</title>",
        mark.row.number,
        for_page(&table.named(mark.row)),
        short(mark.time_s),
        short(mark.error)
    )?;
    writeln!(
        out,
        "<path d=\"M{from:.2} {py:.2}H{to:.2}\" stroke-width=\"1\"/>"
    )?;
    let fill = if mark.is_on_front { colour } else { "#ffffff" };
    writeln!(out, "{}\n</g>", shape(mark.series, px, py, fill))
}

/// The shape of a series around a point.
fn shape(series: usize, x: f64, y: f64, fill: &str) -> String {
    let style = format!("fill=\"{fill}\" stroke-width=\"1.5\"");
    let path = |corners: &[[f64; 2]]| {
        let corners: Vec<String> = corners
            .iter()
            .map(|[dx, dy]| format!("{:.2},{:.2}", x + dx, y + dy))
            .collect();
        format!("<polygon points=\"{}\" {style}/>", corners.join(" "))
    };
    match series % SHAPES {
        0 => format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4.2\" {style}/>"),
        1 => path(&[[-3.8, -3.8], [3.8, -3.8], [3.8, 3.8], [-3.8, 3.8]]),
        2 => path(&[[0.0, -5.0], [4.7, 3.6], [-4.7, 3.6]]),
        3 => path(&[[0.0, -5.4], [5.4, 0.0], [0.0, 5.4], [-5.4, 0.0]]),
        _ => path(&[[0.0, 5.0], [4.7, -3.6], [-4.7, -3.6]]),
    }
}

fn write_legend(out: &mut String, table: &SweepTable, marks: &[Mark<'_>]) -> std::fmt::Result {
    let mut y = TOP + 8.0;
    writeln!(out, "<g class=\"legend\">")?;
    let text = |x: f64, y: f64, text: &str| {
        let text = for_page(&shortened(text, LETTERS));
        format!("<text x=\"{x}\" y=\"{:.1}\">{text}</text>", y + 4.0)
    };
    if let Some(axis) = table.series.map(|at| &table.axes[at]) {
        writeln!(
            out,
            "<g font-weight=\"bold\">{}</g>",
            text(LEGEND, y, &axis.name)
        )?;
        for (at, name) in axis.values.iter().take(MOST_SERIES).enumerate() {
            y += 19.0;
            let colour = COLOURS[at % COLOURS.len()];
            let mark = shape(at, LEGEND + 7.0, y, colour);
            writeln!(
                out,
                "<g stroke=\"{colour}\">{mark}</g>{}",
                text(LEGEND + 20.0, y, name)
            )?;
        }
        if axis.values.len() > MOST_SERIES {
            y += 19.0;
            let more = format!("and {} more", axis.values.len() - MOST_SERIES);
            writeln!(out, "{}", text(LEGEND + 20.0, y, &more))?;
        }
        y += 27.0;
    }
    if !marks.is_empty() {
        let mark = shape(0, LEGEND + 7.0, y, INK);
        writeln!(
            out,
            "<g stroke=\"{INK}\">{mark}</g>{}",
            text(LEGEND + 20.0, y, "on the Pareto front")
        )?;
        y += 19.0;
        let mark = shape(0, LEGEND + 7.0, y, "#ffffff");
        writeln!(
            out,
            "<g stroke=\"{INK}\">{mark}</g>{}",
            text(LEGEND + 20.0, y, "another is as fast and")
        )?;
        y += 15.0;
        writeln!(out, "{}", text(LEGEND + 20.0, y, "as exact"))?;
    }
    writeln!(out, "</g>")
}

fn short(value: f64) -> String {
    dem_io::units::significant(value, 3)
}

fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(letters - 1).collect();
    short.push('…');
    short
}
