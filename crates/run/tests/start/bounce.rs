//! The energy error of a bounce, as documented in doc/inside/contacts.md.

use super::{assert_near, run_of};

const PAGE: &str = include_str!("../../../../doc/inside/contacts.md");

/// The page's scene gives the page's numbers, which decrease with the square of the step.
#[test]
fn the_energy_error_of_a_bounce_is_that_of_the_page() {
    let (_, rest) = PAGE.split_once("```toml\n").unwrap();
    let (scene, rest) = rest.split_once("```").unwrap();
    let rows: Vec<Vec<f64>> = (rest.lines())
        .filter(|line| line.starts_with("| 0."))
        .map(|line| {
            line.split('|')
                .filter_map(|cell| cell.trim().parse().ok())
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), 3);
    let mut largest = Vec::new();
    for row in &rows {
        let [safety, step_s, pressed, left] = row[..] else {
            panic!("{row:?}");
        };
        let text = scene.replace("run = {", &format!("run = {{ safety_factor = {safety},"));
        let summary = run_of(&text, None, None, 2.0).unwrap();
        assert_near(summary.time_step_s, step_s, 1e-3);
        assert_near(summary.energy_error, pressed, 5e-3);
        assert_near(summary.balance.energy_error, left, 5e-3);
        largest.push(summary.energy_error);
    }
    // A quarter of the step: a sixteenth of the error, except for the timing of rows of the series.
    let order = (largest[0] / largest[2]).log(4.0);
    assert!((order - 2.0).abs() < 0.2, "{order}");
}
