//! Plots with arbitrary content: well-formed, nothing outside, nothing hidden by the legend.

use dem_plots::{Axis, Line, Marks, Plot, Point};
use proptest::prelude::*;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// The content of a drawing.
#[derive(Debug, Default)]
struct Picture {
    height: f64,
    /// Left, top, width and height.
    area: [f64; 4],
    legend: Option<[f64; 4]>,
    /// The pieces of each line; a dot is a piece of one point.
    lines: Vec<Vec<Vec<[f64; 2]>>>,
    marks: usize,
    reference: Option<f64>,
    /// Every text with its position; rotated ones are at [0, 0].
    texts: Vec<([f64; 2], String)>,
    titles: Vec<String>,
}

fn attribute(element: &BytesStart<'_>, name: &str) -> String {
    let found = element.try_get_attribute(name).unwrap();
    found
        .map(|found| {
            found
                .normalized_value(quick_xml::XmlVersion::Implicit1_0)
                .unwrap()
                .into_owned()
        })
        .unwrap_or_default()
}

fn number(element: &BytesStart<'_>, name: &str) -> f64 {
    attribute(element, name).parse().unwrap_or(0.0)
}

fn rectangle(element: &BytesStart<'_>) -> [f64; 4] {
    ["x", "y", "width", "height"].map(|name| number(element, name))
}

fn is_in(open: &[(String, String)], class: &str) -> bool {
    open.last().is_some_and(|(_, last)| last == class)
}

/// The text of a plot's file.
fn svg(plot: &Plot) -> String {
    plot.svg().file()
}

/// Reads a plot back. Checks that everything is closed and every number finite.
fn read(text: &str) -> Picture {
    for word in ["NaN", "inf", "\u{0}"] {
        let drawn: String = text
            .lines()
            .filter(|line| !line.contains("text") && !line.contains("title"))
            .collect();
        assert!(!drawn.contains(word), "{text}");
    }
    let mut picture = Picture::default();
    let mut xml = Reader::from_str(text);
    let mut open: Vec<(String, String)> = Vec::new();
    let mut at = [0.0; 2];
    loop {
        match xml.read_event().unwrap() {
            event @ (Event::Start(_) | Event::Empty(_)) => {
                let is_open = matches!(event, Event::Start(_));
                let (Event::Start(element) | Event::Empty(element)) = event else {
                    unreachable!()
                };
                let name = element.name().as_ref().to_owned();
                match name.as_str() {
                    "svg" => picture.height = number(&element, "height"),
                    "rect" if attribute(&element, "class") == "area" => {
                        picture.area = rectangle(&element);
                    }
                    "rect" if open.last().is_some_and(|(_, class)| class == "legend") => {
                        picture.legend = Some(rectangle(&element));
                    }
                    "g" if attribute(&element, "class") == "line" => picture.lines.push(Vec::new()),
                    "circle" if is_in(&open, "line") => {
                        let point = ["cx", "cy"].map(|name| number(&element, name));
                        picture.lines.last_mut().unwrap().push(vec![point]);
                    }
                    "polyline" if is_in(&open, "line") => {
                        let points = attribute(&element, "points");
                        let points = points.split(' ').map(|pair| {
                            let (x, y) = pair.split_once(',').unwrap();
                            [x.parse().unwrap(), y.parse().unwrap()]
                        });
                        picture.lines.last_mut().unwrap().push(points.collect());
                    }
                    "circle" | "polygon" if is_in(&open, "mark") => picture.marks += 1,
                    "path" if attribute(&element, "class") == "reference" => {
                        let path = attribute(&element, "d");
                        let y = path.split([' ', 'H']).nth(1).unwrap();
                        picture.reference = Some(y.parse().unwrap());
                    }
                    "text" => {
                        at = ["x", "y"].map(|name| number(&element, name));
                        picture.texts.push((at, String::new()));
                    }
                    "title" => picture.titles.push(String::new()),
                    _ => {}
                }
                if is_open {
                    open.push((name, attribute(&element, "class")));
                }
            }
            Event::End(_) => {
                open.pop().unwrap();
            }
            Event::Text(text) => match open.last().map(|(name, _)| name.as_str()) {
                Some("text") => picture.texts.last_mut().unwrap().1.push_str(&text),
                Some("title") => picture.titles.last_mut().unwrap().push_str(&text),
                _ => assert_eq!(text.trim(), ""),
            },
            Event::GeneralRef(name) => {
                let letter = match &*name {
                    "amp" => '&',
                    "lt" => '<',
                    "gt" => '>',
                    "quot" => '"',
                    other => panic!("{other}"),
                };
                match open.last().map(|(name, _)| name.as_str()) {
                    Some("text") => picture.texts.last_mut().unwrap().1.push(letter),
                    _ => picture.titles.last_mut().unwrap().push(letter),
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    assert!(open.is_empty(), "{open:?}");
    let _ = at;
    assert_inside(&picture);
    picture
}

fn assert_inside(picture: &Picture) {
    let [left, top, wide, high] = picture.area;
    assert!(
        left > 0.0 && top > 0.0 && wide > 200.0 && high > 150.0,
        "{:?}",
        picture.area
    );
    assert!(left + wide < 640.0 && top + high < 400.0);
    let near = 0.02;
    let level = picture.reference.map(|y| [left, y]);
    for [x, y] in picture
        .lines
        .iter()
        .flatten()
        .flatten()
        .copied()
        .chain(level)
    {
        assert!(
            x >= left - near && x <= left + wide + near,
            "{x} of {:?}",
            picture.area
        );
        assert!(
            y >= top - near && y <= top + high + near,
            "{y} of {:?}",
            picture.area
        );
        if let Some([x0, y0, w, h]) = picture.legend {
            let hidden = x > x0 && x < x0 + w && y > y0 && y < y0 + h;
            assert!(!hidden, "{x} {y} behind {:?}", picture.legend);
        }
    }
    for ([x, y], text) in &picture.texts {
        assert!(
            (0.0..640.0).contains(x) && (0.0..picture.height).contains(y),
            "{text} at {x} {y}"
        );
    }
    if let Some([x, y, w, h]) = picture.legend {
        assert!(x >= left && y >= top && x + w <= left + wide && y + h <= top + high);
    }
}

fn axis(label: &str, log: bool) -> Axis {
    Axis {
        label: label.to_owned(),
        log,
        ..Axis::default()
    }
}

fn plot(x: &str, y: &str, log: [bool; 2], lines: Vec<Vec<[f64; 2]>>) -> Plot {
    let lines = lines.into_iter().enumerate();
    Plot {
        title: "A title".to_owned(),
        x: axis(x, log[0]),
        y: axis(y, log[1]),
        lines: lines
            .map(|(index, points)| Line {
                name: format!("line {index}"),
                points,
                dashed: false,
            })
            .collect(),
        ..Plot::default()
    }
}

fn has(picture: &Picture, text: &str) -> bool {
    picture.texts.iter().any(|(_, found)| found == text)
}

#[track_caller]
fn assert_texts(plot: &Plot, texts: &[&str]) {
    let picture = read(&svg(plot));
    for text in texts {
        assert!(has(&picture, text), "no {text} in {:?}", picture.texts);
    }
}

#[test]
fn units_take_a_prefix_that_suits_the_values() {
    let points = vec![vec![[0.0, 0.0], [0.05, 2.5e6]]];
    let one = plot("time (s)", "stress (Pa)", [false; 2], points.clone());
    assert_texts(
        &one,
        &["time (ms)", "0", "10", "50", "stress (MPa)", "0.5", "2.5"],
    );
    let one = plot("time (h)", "area (m2)", [false; 2], points.clone());
    assert_texts(
        &one,
        &["time (h)", "0.00", "0.05", "area (m2, ×10⁶)", "2.5"],
    );
    let one = plot("ratio", "", [false; 2], points);
    assert_texts(&one, &["ratio", "×10⁶"]);
    let plain = vec![vec![[-3.0, 0.0], [9000.0, -0.4]]];
    let one = plot("speed (m/s)", "share", [false; 2], plain);
    assert_texts(&one, &["speed (m/s)", "8000", "share", "−0.1", "0.0"]);
    let small = vec![vec![[0.0, 0.0], [2e-3, 4e-15]]];
    let one = plot("sag (m)", "error", [false; 2], small);
    assert_texts(&one, &["sag (mm)", "1.0", "error (×10⁻¹⁵)", "4"]);
}

#[test]
fn decades_on_an_axis_with_logarithms() {
    let points = vec![vec![
        [1.0, 2e-9],
        [1e3, 3e-4],
        [0.0, 1.0],
        [-1.0, 1.0],
        [10.0, 0.0],
    ]];
    let log = plot("step (s)", "error", [true; 2], points);
    assert_texts(&log, &["step (s)", "1", "100", "10⁻⁸", "10⁻⁴"]);
    let picture = read(&svg(&log));
    assert_eq!(
        picture.lines[0].len(),
        1,
        "what has no logarithm is left out"
    );
    assert_eq!(picture.lines[0][0].len(), 2);
    let far = plot(
        "a",
        "b",
        [true; 2],
        vec![vec![[1e-300, 1e-290], [1e290, 1e300]]],
    );
    let picture = read(&svg(&far));
    assert!(picture.texts.len() < 40);
}

#[test]
fn few_decades_have_numbers_in_between() {
    let two = vec![vec![[2e-3, 0.1], [9e-2, 0.2]]];
    let two = plot("size (m)", "share", [true, false], two);
    assert_texts(&two, &["0.002", "0.005", "0.01", "0.02", "0.05"]);
    let three = vec![vec![[2e-3, 0.1], [0.9, 0.2]]];
    let three = plot("size (m)", "share", [true, false], three);
    assert!(!has(&read(&svg(&three)), "0.02"));
    assert_texts(&three, &["0.01", "0.1"]);
    let tiny = vec![vec![[2e-9, 0.1], [9e-9, 0.2]]];
    let tiny = plot("size (m)", "share", [true, false], tiny);
    assert_texts(&tiny, &["2×10⁻⁹", "5×10⁻⁹"]);
}

#[test]
fn counts_have_whole_numbers_only() {
    let points = vec![vec![[0.0, 1.0], [0.05, 3.0]]];
    let mut counted = plot("time (s)", "fragments", [false; 2], points);
    assert_texts(&counted, &["1.0", "1.5", "2.0", "2.5", "3.0"]);
    counted.y.whole = true;
    assert_texts(&counted, &["1", "2", "3"]);
    assert!(!has(&read(&svg(&counted)), "1.5"));
}

#[test]
fn few_points_or_none() {
    let none = read(&svg(&plot("x", "y", [false; 2], vec![])));
    assert!(has(&none, "no data"));
    let gaps = vec![vec![[0.0, f64::NAN], [f64::INFINITY, 1.0]]];
    assert!(has(
        &read(&svg(&plot("x", "y", [false; 2], gaps))),
        "no data"
    ));
    let one = read(&svg(&plot("x", "y", [false; 2], vec![vec![[3.0, 4.0]]])));
    assert_eq!(one.lines[0].len(), 1);
    assert_eq!(one.lines[0][0].len(), 1);
    let constant: Vec<[f64; 2]> = (0..9).map(|x| [f64::from(x), 2050.0]).collect();
    let constant = read(&svg(&plot("x", "y", [false; 2], vec![constant])));
    let [_, top, _, high] = constant.area;
    for point in &constant.lines[0][0] {
        assert!(
            (point[1] - (top + high / 2.0)).abs() < 0.2 * high,
            "near the middle"
        );
    }
}

#[test]
fn gaps_part_a_line() {
    let y = [1.0, 2.0, f64::NAN, 3.0, f64::INFINITY, 4.0, 5.0, 6.0];
    let points = y.iter().enumerate().map(|(x, y)| [x as f64, *y]).collect();
    let picture = read(&svg(&plot("x", "y", [false; 2], vec![points])));
    let lengths: Vec<usize> = picture.lines[0].iter().map(Vec::len).collect();
    assert_eq!(lengths, [2, 1, 3]);
}

#[test]
fn a_long_series_keeps_its_peaks() {
    let mut points: Vec<[f64; 2]> = (0..200_000)
        .map(|k| [f64::from(k), (f64::from(k) * 1e-4).sin()])
        .collect();
    points[77_777][1] = 40.0;
    points[123_456][1] = -20.0;
    for point in &mut points[150_000..160_000] {
        point[1] = f64::NAN;
    }
    let picture = read(&svg(&plot("x", "y", [false; 2], vec![points])));
    let pieces = &picture.lines[0];
    assert_eq!(pieces.len(), 2, "one gap");
    let drawn = pieces.iter().flatten().count();
    assert!((400..=1000).contains(&drawn), "{drawn}");
    // 40 and -20 are ticks, at which the axis begins and ends.
    let [left, top, wide, high] = picture.area;
    let peak = |fraction: f64, y: f64| {
        let near = |point: &&[f64; 2]| {
            (point[0] - left - fraction * wide).abs() < 0.01 && (point[1] - y).abs() < 0.01
        };
        assert_eq!(pieces.iter().flatten().filter(near).count(), 1);
    };
    peak(77_777.0 / 199_999.0, top);
    peak(123_456.0 / 199_999.0, top + high);
}

#[test]
fn names_of_any_length_and_letters() {
    let mut names = plot("x", "y", [false; 2], vec![vec![[0.0, 0.0], [1.0, 1.0]]; 3]);
    names.title = "<a> & \"b\" 'c'\u{0}\u{ffff}\n".to_owned() + &"very long ".repeat(50);
    names.lines[1].name = "x".repeat(5000);
    names.lines[2].name = "</svg>&amp;".to_owned();
    names.x.label = "long ".repeat(100);
    names.y.label = "長い".repeat(100);
    names.reference = Some((0.5, "<limit>".to_owned()));
    let picture = read(&svg(&names));
    assert!(has(&picture, "</svg>&amp;") && has(&picture, "<limit>"));
    assert!(picture.titles[0].starts_with("<a> & \"b\" 'c'\\u{0}\\u{a}very long"));
    assert_eq!(
        picture.titles[2].len(),
        5000,
        "the whole name is told to the pointer"
    );
    assert!(
        picture
            .texts
            .iter()
            .all(|(_, text)| text.chars().count() < 120)
    );
}

#[test]
fn one_line_needs_no_legend_but_a_reference_does() {
    let mut one = plot("x", "y", [false; 2], vec![vec![[0.0, 0.0], [1.0, 1.0]]]);
    let text = svg(&one);
    assert!(!text.contains("legend"));
    one.reference = Some((3.0, "limit".to_owned()));
    let picture = read(&svg(&one));
    assert!(picture.legend.is_some() && has(&picture, "limit") && has(&picture, "line 0"));
    one.reference = Some((f64::NAN, "limit".to_owned()));
    assert_eq!(svg(&one), text);
    let many = plot("x", "y", [false; 2], vec![vec![[0.0, 0.0], [1.0, 1.0]]; 90]);
    let picture = read(&svg(&many));
    assert!(picture.legend.is_none(), "it stands below");
    assert!(
        picture
            .texts
            .iter()
            .any(|(_, text)| text.ends_with(" more")),
        "{:?}",
        picture.texts
    );
}

fn marks(name: &str, points: &[[f64; 2]]) -> Marks {
    let point = |at: &[f64; 2]| Point {
        at: *at,
        x_spread: 0.1 * at[0],
        filled: at[1] < 0.02,
        title: format!("<run> {}", at[0]),
        ..Point::default()
    };
    Marks {
        name: name.to_owned(),
        points: points.iter().map(point).collect(),
        chains: vec![points.to_vec()],
    }
}

#[test]
fn marks_have_kinds_error_bars_and_a_front() {
    let mut plot = plot("time (s)", "error", [true; 2], vec![]);
    plot.marks = vec![
        marks("total", &[[1.0, 0.1], [2.0, 0.01], [4.0, 0.0]]),
        marks("incremental", &[[1.5, 0.2], [3.0, 0.05]]),
    ];
    plot.kinds = "formulation".to_owned();
    plot.filled = Some(["on the front".to_owned(), "another is better".to_owned()]);
    plot.front = vec![[1.0, 0.1], [2.0, 0.01]];
    let text = svg(&plot);
    let picture = read(&text);
    assert_eq!(
        picture.marks, 5,
        "what has no logarithm stands at the lower end"
    );
    for name in [
        "formulation",
        "total",
        "incremental",
        "on the front",
        "another is better",
    ] {
        assert!(has(&picture, name), "{name}");
    }
    assert!(picture.titles.contains(&"<run> 1.5".to_owned()));
    assert_eq!(text.matches("class=\"chain\"").count(), 2);
    assert_eq!(text.matches("class=\"front\"").count(), 1);
    // Two are filled, and so is their sample; the legend covers none of them.
    let [left, top, wide, high] = picture.area;
    assert!(!text.contains("no data") && left + wide < 640.0 && top + high < 400.0);
    plot.marks[1].name.clear();
    assert!(!has(&read(&svg(&plot)), "incremental"));
    plot.marks = (0..90)
        .map(|kind| marks(&format!("kind {kind}"), &[[1.0, 1.0]]))
        .collect();
    let many = read(&svg(&plot));
    assert!(many.texts.iter().any(|(_, text)| text.ends_with(" more")));
    assert!(has(&many, "on the front") && has(&many, "kind 9"));
}

fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -1e3..1e3_f64,
        Just(0.0),
        Just(f64::NAN),
        Just(7.0)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_numbers_give_a_sound_picture(
        lines in prop::collection::vec(prop::collection::vec([any_value(), any_value()], 0..30), 0..12),
        names in prop::collection::vec(any::<String>(), 12),
        title in any::<String>(),
        log in any::<[bool; 2]>(),
        reference in prop::option::of((any_value(), any::<String>())),
    ) {
        let mut any = plot("time (s)", &title, log, lines);
        for (line, name) in any.lines.iter_mut().zip(names) {
            line.name = name;
        }
        any.title = title;
        any.reference = reference;
        read(&svg(&any));
        let of_line = |line: Line| Marks {
            chains: Vec::new(),
            ..marks(&line.name, &line.points)
        };
        any.marks = any.lines.drain(..).map(of_line).collect();
        read(&svg(&any));
    }

    #[test]
    fn long_lines_are_thinned(
        seed in prop::collection::vec([any_value(), any_value()], 1..50),
        repeat in 20..200_usize,
        in_order in any::<bool>(),
    ) {
        let mut points = seed.repeat(repeat);
        if in_order {
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        }
        let count = points.len();
        let picture = read(&svg(&plot("x", "y", [false; 2], vec![points])));
        let drawn = picture.lines[0].iter().flatten().count();
        prop_assert!(drawn <= count.min(1000), "{drawn}");
    }

    #[test]
    fn ticks_stand_where_their_numbers_are(low in -1e3..1e3_f64, span in 1e-6..1e3_f64) {
        let picture = read(&svg(&plot("x", "y", [false; 2], vec![vec![[low, 0.0], [low + span, 1.0]]])));
        let [left, top, wide, high] = picture.area;
        let ticks: Vec<(f64, f64)> = picture.texts.iter()
            .filter(|([x, y], _)| *y > top + high + 10.0 && *y < top + high + 25.0 && *x > 0.0)
            .map(|([x, _], text)| (*x, text.replace('−', "-").parse().unwrap()))
            .collect();
        prop_assert!((2..=13).contains(&ticks.len()), "{ticks:?}");
        let largest = low.abs().max((low + span).abs());
        let factor = if largest < 1e-2 { 10_f64.powf((largest.log10() / 3.0).floor() * 3.0) } else { 1.0 };
        for (x, value) in ticks {
            let place = left + (value * factor - low) / span * wide;
            prop_assert!((x - place).abs() < 0.02 + 1e-9 * wide * largest / span, "{x} {place}");
        }
    }
}

#[test]
fn marks_have_upright_bars_within_the_axis() {
    let mut plot = plot("speed (m/s)", "share", [false; 2], vec![]);
    let point = |x: f64, y: f64, spread: f64| Point {
        at: [x, y],
        y_spread: spread,
        filled: true,
        ..Point::default()
    };
    plot.marks = vec![Marks {
        points: vec![point(1.0, 0.5, 0.9), point(2.0, 0.6, 0.0)],
        ..Marks::default()
    }];
    let svg = plot.svg().file();
    let picture = read(&svg);
    assert_eq!(picture.marks, 2);
    // One bar, from 0.05 to 0.95 on an axis that holds it.
    let mark = svg.split("class=\"mark\"").nth(1).unwrap();
    let (_, bar) = mark.split_once("d=\"M").unwrap();
    let (bar, _) = bar.split_once('"').unwrap();
    let numbers: Vec<f64> = bar
        .split(|c: char| !(c.is_ascii_digit() || c == '.'))
        .filter_map(|text| text.parse().ok())
        .collect();
    let [_, top, _, high] = picture.area;
    let [_, low, up] = numbers[..] else {
        panic!("{bar}")
    };
    assert!(up < low && up > top && low < top + high, "{bar}");
}

#[test]
fn values_without_numbers_have_names() {
    let mut plot = plot("", "", [false; 2], vec![]);
    let names = [
        "parallel",
        "timoshenko",
        "a name that is far too long for the room that it has at the axis",
    ];
    plot.x = Axis::named("model", names.map(str::to_owned).to_vec());
    plot.marks = vec![marks("", &[[0.0, 1.0], [1.0, 2.0], [2.0, 3.0]])];
    let svg = plot.svg().file();
    let picture = read(&svg);
    let texts: Vec<&str> = picture
        .texts
        .iter()
        .map(|(_, text)| text.as_str())
        .collect();
    assert!(
        texts.contains(&"parallel") && texts.contains(&"timoshenko"),
        "{texts:?}"
    );
    assert!(
        texts
            .iter()
            .any(|text| text.starts_with("a name") && text.ends_with('…')),
        "{texts:?}"
    );
}
