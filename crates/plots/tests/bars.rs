//! Bars: lengths to scale from a common zero line, in the order of the rows.

use dem_plots::{Bar, BarRow, Bars};
use proptest::prelude::*;
use quick_xml::Reader;
use quick_xml::events::Event;

/// Left ends and widths of the bars, the zero line, and all texts.
fn read(text: &str) -> (Vec<[f64; 2]>, f64, Vec<String>) {
    let mut reader = Reader::from_str(text);
    let (mut bars, mut zero, mut texts) = (Vec::new(), f64::NAN, Vec::new());
    let mut is_bar = false;
    loop {
        match reader.read_event().unwrap() {
            Event::Eof => return (bars, zero, texts),
            Event::Text(text) => texts.push(text.trim().to_owned()),
            Event::Start(element) | Event::Empty(element) => {
                let attribute = |name: &str| {
                    let found = element.try_get_attribute(name).unwrap();
                    found.map_or(String::new(), |found| found.value.into_owned())
                };
                let number = |name: &str| attribute(name).parse::<f64>().unwrap();
                match (element.name().as_ref(), attribute("class").as_str()) {
                    ("g", class) => is_bar = class == "bar",
                    ("rect", _) if is_bar => bars.push([number("x"), number("width")]),
                    ("path", "zero") => {
                        let path = attribute("d");
                        zero = path[1..].split(' ').next().unwrap().parse().unwrap();
                    }
                    _ => {}
                }
            }
            _ => {}
        }
    }
}

fn row(number: usize, ends: &[Option<f64>], is_hollow: bool) -> BarRow {
    let bar = |end: f64| Bar {
        end,
        interval: Some([end - 0.5, end + 0.5]),
        is_hollow,
        title: String::new(),
    };
    BarRow {
        name: format!("row {number}"),
        bars: ends.iter().map(|end| end.map(bar)).collect(),
    }
}

proptest! {
    #[test]
    fn bars_are_to_scale(
        ends in prop::collection::vec((-1e3..1e3_f64, prop::option::of(-1e3..1e3_f64)), 1..20),
    ) {
        let rows = ends.iter().enumerate();
        let bars = Bars {
            title: "a title".to_owned(),
            label: "change (N)".to_owned(),
            kinds: vec!["low".to_owned(), "high".to_owned()],
            hollow: "nothing".to_owned(),
            rows: rows.map(|(at, (low, high))| row(at, &[Some(*low), *high], at % 2 == 1)).collect(),
        };
        let (drawn, zero, texts) = read(&bars.svg().file());
        let known: Vec<f64> = ends.iter().flat_map(|(low, high)| [Some(*low), *high]).flatten().collect();
        prop_assert_eq!(drawn.len(), known.len());
        let longest = known.iter().map(|end| end.abs()).fold(0.0, f64::max);
        let scale = drawn.iter().map(|[_, width]| *width).fold(0.0, f64::max) / longest;
        for ([x, width], end) in drawn.iter().zip(&known) {
            prop_assert!((width - scale * end.abs()).abs() < 0.05, "{} {} {}", width, end, scale);
            let from_zero = if *end < 0.0 { x + width } else { *x };
            prop_assert!((from_zero - zero).abs() < 0.03);
            prop_assert!(*x > 0.0 && x + width < 640.0);
        }
        let names: Vec<&String> = texts.iter().filter(|text| text.starts_with("row ")).collect();
        let wanted: Vec<String> = (0..ends.len()).map(|at| format!("row {at}")).collect();
        prop_assert_eq!(names, wanted.iter().collect::<Vec<_>>());
        prop_assert!(texts.iter().any(|text| text == "high"));
        prop_assert_eq!(texts.iter().any(|text| text == "nothing"), ends.len() > 1);
    }
}

#[test]
fn no_bars_are_no_data() {
    let (drawn, _, texts) = read(&Bars::default().svg().file());
    assert!(
        drawn.is_empty() && texts.iter().any(|text| text == "no data"),
        "{texts:?}"
    );
}
