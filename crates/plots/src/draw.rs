//! From a plot to SVG.

use maud::{Markup, html};

use crate::colours::{GREY, INK, REFERENCE, Stroke, colour, shape};
use crate::legend::{Entry, Legend, Sample};
use crate::numbers::{places, px};
use crate::plot::{Marks, Plot, Point};
use crate::scale::{Scale, is_drawn};
use crate::svg::{Svg, WIDTH};
use crate::text::{shortened, shown, width};
use crate::thin;

/// Height without a legend below, px.
const HEIGHT: f64 = 400.0;

const GRID: &str = "#e4e4e4";
const FINE_GRID: &str = "#f2f2f2";

/// Room beside the first and the last mark, as a fraction of the distance between them.
const ROOM: f64 = 0.03;

/// The part of the picture in which lines are drawn, px, and the axes along it.
struct Area {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
    x: Scale,
    y: Scale,
}

impl Plot {
    /// The plot as SVG.
    pub fn svg(&self) -> Svg {
        svg(self)
    }
}

fn svg(plot: &Plot) -> Svg {
    let reference = (plot.reference.as_ref()).filter(|(value, _)| is_drawn(*value, plot.y.log));
    let area = area(plot, reference.map(|(value, _)| *value));
    let lines: Vec<_> = (plot.lines.iter())
        .map(|line| thin::segments(line.points.iter().map(|point| area.drawn(plot, *point))))
        .collect();
    let level = reference.map(|(value, _)| area.height_of(*value));
    let entries = entries(plot, reference.map(|(_, name)| name.as_str()));
    let legend = (entries.len() > 1).then(|| {
        let frame = [area.left, area.top, area.right, area.bottom];
        Legend::new(&entries, &area.covered(plot, &lines, level), frame, HEIGHT)
    });
    let is_empty =
        lines.iter().all(Vec::is_empty) && plot.marks.iter().flat_map(seen).next().is_none();
    let content = html! {
        (grid(&area))
        (labels(&area))
        @if let Some(y) = level {
            path class="reference" d={ "M" (px(area.left)) " " (px(y)) "H" (px(area.right)) }
                stroke=(REFERENCE.colour) stroke-width=(REFERENCE.width)
                stroke-dasharray=[REFERENCE.dashes] {}
        }
        @for (number, (line, pieces)) in plot.lines.iter().zip(&lines).enumerate() {
            (drawn_line(&line.name, Stroke::of_line(number, line.dashed), pieces))
        }
        (marks(plot, &area))
        rect class="area" x=(px(area.left)) y=(px(area.top)) width=(px(area.right - area.left))
            height=(px(area.bottom - area.top)) fill="none" stroke=(GREY) {}
        @if is_empty {
            text x=(px(f64::midpoint(area.left, area.right)))
                y=(px(f64::midpoint(area.top, area.bottom)))
                text-anchor="middle" font-size="14" fill=(GREY) {
                @if plot.if_empty.is_empty() { "no data" } @else { (shown(&plot.if_empty)) }
            }
        }
        @if let Some(legend) = &legend { (legend.markup(&entries)) }
    };
    let below = legend.as_ref().map_or(0.0, |legend| legend.height);
    Svg::new(HEIGHT + below, &plot.title, &content)
}

/// The area for all lines, marks and the reference.
fn area(plot: &Plot, reference: Option<f64>) -> Area {
    let of_lines = || {
        let points = plot.lines.iter().flat_map(|line| &line.points);
        let chains = plot.marks.iter().flat_map(|marks| &marks.chains);
        let points = points.chain(chains.flatten());
        points.filter(|[x, y]| is_drawn(*x, plot.x.log) && is_drawn(*y, plot.y.log))
    };
    let of_marks = || plot.marks.iter().flat_map(seen);
    let values = |k: usize| {
        // Bars along y lie within the axis, those along x end at its edge.
        let ends = move |point: &Point| {
            let half = [0.0, 0.5 * point.y_spread][k];
            [point.at[k] - half, point.at[k] + half]
        };
        let marks = of_marks().flat_map(ends);
        of_lines().map(move |point| point[k]).chain(marks)
    };
    let x = Scale::new(&plot.x, values(0).chain(room(plot)), false);
    let y = Scale::new(&plot.y, values(1).chain(reference), true);
    let numbers = y.ticks.iter().map(|tick| width(&tick.label, 12.0));
    Area {
        left: (numbers.fold(0.0, f64::max) + 46.0).ceil(),
        top: if plot.title.is_empty() { 16.0 } else { 40.0 },
        right: WIDTH - 24.0,
        bottom: HEIGHT - 52.0,
        x,
        y,
    }
}

/// Ends of a linear horizontal axis with room for the marks at both ends; none without marks.
fn room(plot: &Plot) -> Vec<f64> {
    let places = plot.marks.iter().flat_map(seen).map(|point| point.at[0]);
    let ends = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    });
    let room = ROOM * (ends[1] - ends[0]);
    if plot.x.log || !plot.x.names.is_empty() || !room.is_finite() {
        return Vec::new();
    }
    vec![ends[0] - room, ends[1] + room]
}

/// Marks with a valid position.
fn seen(marks: &Marks) -> impl Iterator<Item = &Point> {
    let points = marks.points.iter();
    points.filter(|point| point.at.into_iter().all(|value| is_drawn(value, false)))
}

impl Area {
    fn across(&self, fraction: f64) -> f64 {
        self.left + fraction * (self.right - self.left)
    }

    fn up(&self, fraction: f64) -> f64 {
        self.bottom - fraction * (self.bottom - self.top)
    }

    fn height_of(&self, value: f64) -> f64 {
        self.up(self.y.fraction(value))
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.across(self.x.fraction(x)), self.height_of(y)]
    }

    /// Position of the point of a line. None for a gap.
    fn drawn(&self, plot: &Plot, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let is_drawn = is_drawn(x, plot.x.log) && is_drawn(y, plot.y.log);
        is_drawn.then(|| self.place([x, y]))
    }

    /// The ends of a mark's error bar along x, limited to the axis.
    fn bar(&self, point: &Point) -> [[f64; 2]; 2] {
        let [x, y] = point.at;
        [-0.5, 0.5].map(|side| self.place([x + side * point.x_spread, y]))
    }

    /// The ends of its error bar along y.
    fn upright_bar(&self, point: &Point) -> [[f64; 2]; 2] {
        let [x, y] = point.at;
        [-0.5, 0.5].map(|side| self.place([x, y + side * point.y_spread]))
    }

    /// Corners of the stairs through a front, from the upper to the right edge.
    fn stairs(&self, front: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut corners = Vec::new();
        let mut height = self.top;
        for [x, y] in front.iter().map(|point| self.place(*point)) {
            corners.extend([[x, height], [x, y]]);
            height = y;
        }
        if !corners.is_empty() {
            corners.push([self.right, height]);
        }
        corners
    }

    /// The parts that the legend may not cover, as lines.
    fn covered(
        &self,
        plot: &Plot,
        lines: &[Vec<Vec<[f64; 2]>>],
        level: Option<f64>,
    ) -> Vec<Vec<[f64; 2]>> {
        let mut all: Vec<_> = lines.iter().flatten().cloned().collect();
        all.extend(level.map(|y| vec![[self.left, y], [self.right, y]]));
        all.push(self.stairs(&plot.front));
        for marks in &plot.marks {
            for point in seen(marks) {
                let [x, y] = self.place(point.at);
                all.push(vec![[x - 5.0, y - 5.0], [x + 5.0, y + 5.0]]);
                all.push(self.bar(point).into());
                all.push(self.upright_bar(point).into());
            }
            let chains = marks.chains.iter();
            all.extend(chains.map(|chain| chain.iter().map(|p| self.place(*p)).collect()));
        }
        all
    }
}

fn entries(plot: &Plot, reference: Option<&str>) -> Vec<Entry> {
    let entry = |name: &str, sample| Entry {
        name: name.to_owned(),
        sample,
    };
    let lines = plot.lines.iter().enumerate();
    let mut entries: Vec<Entry> = lines
        .map(|(number, line)| {
            let stroke = Stroke::of_line(number, line.dashed);
            entry(&line.name, Sample::Line(stroke))
        })
        .collect();
    entries.extend(reference.map(|name| entry(name, Sample::Line(REFERENCE))));
    if let Some([filled, hollow]) = &plot.filled {
        entries.push(entry(filled, Sample::Mark(0, INK, INK)));
        entries.push(entry(hollow, Sample::Mark(0, INK, "#ffffff")));
    }
    if !plot.kinds.is_empty() {
        entries.push(entry(&plot.kinds, Sample::Heading));
    }
    let kinds = (plot.marks.iter().enumerate()).filter(|(_, marks)| !marks.name.is_empty());
    entries.extend(kinds.map(|(kind, marks)| {
        let sample = Sample::Mark(kind, colour(kind), colour(kind));
        entry(&marks.name, sample)
    }));
    entries
}

fn grid(area: &Area) -> Markup {
    let path = |x: &[f64], y: &[f64]| {
        let upright = x.iter().map(|fraction| {
            let x = px(area.across(*fraction));
            format!("M{x} {:.2}V{:.2}", area.top, area.bottom)
        });
        let level = y.iter().map(|fraction| {
            let y = px(area.up(*fraction));
            format!("M{:.2} {y}H{:.2}", area.left, area.right)
        });
        upright.chain(level).collect::<String>()
    };
    let fractions =
        |scale: &Scale| -> Vec<f64> { scale.ticks.iter().map(|t| t.fraction).collect() };
    let fine = path(&area.x.fine, &area.y.fine);
    html! {
        @if !fine.is_empty() { path d=(fine) stroke=(FINE_GRID) fill="none" {} }
        path d=(path(&fractions(&area.x), &fractions(&area.y))) stroke=(GRID) fill="none" {}
    }
}

fn labels(area: &Area) -> Markup {
    let &Area {
        left,
        top,
        right,
        bottom,
        ..
    } = area;
    let (x, y) = (f64::midpoint(left, right), f64::midpoint(top, bottom));
    html! {
        g class="x" text-anchor="middle" {
            @for tick in &area.x.ticks {
                text x=(px(area.across(tick.fraction))) y=(px(bottom + 17.0)) { (tick.label) }
            }
        }
        g class="y" text-anchor="end" {
            @for tick in &area.y.ticks {
                text x=(px(left - 7.0)) y=(px(area.up(tick.fraction) + 4.0)) { (tick.label) }
            }
        }
        g class="axes" text-anchor="middle" font-size="13" {
            text x=(px(x)) y=(px(bottom + 38.0)) {
                (shortened(&area.x.label, 13.0, right - left))
            }
            text transform={ "translate(20 " (px(y)) ") rotate(-90)" } {
                (shortened(&area.y.label, 13.0, bottom - top))
            }
        }
    }
}

/// A line in its pieces; a piece of one point is a dot.
fn drawn_line(name: &str, stroke: Stroke, pieces: &[Vec<[f64; 2]>]) -> Markup {
    let Stroke {
        colour,
        width,
        dashes,
    } = stroke;
    html! {
        g class="line" fill="none" stroke-linejoin="round" stroke=(colour) stroke-width=(width)
            stroke-dasharray=[dashes] {
            title { (shown(name)) }
            @for piece in pieces {
                @if let [[x, y]] = piece[..] {
                    circle cx=(px(x)) cy=(px(y)) r="2.5" fill=(colour) stroke="none" {}
                } @else {
                    polyline points=(places(piece.iter().copied())) {}
                }
            }
        }
    }
}

/// Chains below the front, marks above it.
fn marks(plot: &Plot, area: &Area) -> Markup {
    let stairs = area.stairs(&plot.front);
    html! {
        @for (kind, marks) in plot.marks.iter().enumerate() {
            @for chain in &marks.chains {
                polyline class="chain" points=(places(chain.iter().map(|p| area.place(*p))))
                    fill="none" stroke=(colour(kind)) stroke-opacity="0.35" {}
            }
        }
        @if !stairs.is_empty() {
            polyline class="front" points=(places(stairs)) fill="none" stroke=(INK)
                stroke-width="1.2" stroke-dasharray="5 3" {}
        }
        @for (kind, marks) in plot.marks.iter().enumerate() {
            @for point in seen(marks) { (mark(area, kind, point)) }
        }
    }
}

fn mark(area: &Area, kind: usize, point: &Point) -> Markup {
    let [[from, y], [to, _]] = area.bar(point);
    let [[x, low], [_, high]] = area.upright_bar(point);
    let fill = if point.filled {
        colour(kind)
    } else {
        "#ffffff"
    };
    html! {
        g class="mark" stroke=(colour(kind)) {
            title { (shown(&point.title)) }
            @if point.x_spread > 0.0 { path d={ "M" (px(from)) " " (px(y)) "H" (px(to)) } {} }
            @if point.y_spread > 0.0 { path d={ "M" (px(x)) " " (px(low)) "V" (px(high)) } {} }
            (shape(kind, area.place(point.at), fill))
        }
    }
}
