//! Observed orders of convergence.

use dem_study::outcome::{Done, Reading};
use dem_study::sweep_table::SweepTable;

use super::made::{assert_near, done, reading, study, table};

const SIZES_MM: [f64; 4] = [8.0, 1.0, 4.0, 2.0];

fn radii(combine: &str) -> String {
    format!(
        r#"
combine = "{combine}"
[vary]
"bonds.bar.model" = ["first", "second", "exact", "two"]
"bodies.bar.radius" = ["8 mm", "1 mm", "4 mm", "2 mm"]
[measures.tip]
reference = {{ value = 1 }}
"#
    )
}

/// The orders: along what, of what, from how many runs.
fn told(table: &SweepTable) -> Vec<String> {
    let orders = table.orders.iter();
    orders
        .map(|one| format!("{} {} {:?} {}", one.by, one.along, one.of, one.runs))
        .collect()
}

/// Errors of first and second order; none; and only two that are not 0, which show no order.
#[test]
fn the_order_is_the_slope_of_the_errors() {
    let table = table(&study(&radii("grid")), |run| {
        let size = SIZES_MM[run.choice[1]];
        let error = match run.choice[0] {
            0 => 0.3 * size,
            1 => 0.01 * size.powi(2),
            3 if size > 2.0 => size,
            _ => 0.0,
        };
        done(1.0, &[1.0 - error])
    });
    assert_eq!(
        told(&table),
        [
            "errors bodies.bar.radius [\"first\"] 4",
            "errors bodies.bar.radius [\"second\"] 4",
        ]
    );
    assert_near(table.orders[0].order, 1.0);
    assert_near(table.orders[1].order, 2.0);
}

#[test]
fn pairs_have_one_order() {
    let table = table(&study(&radii("paired")), |run| {
        done(1.0, &[1.0 + 0.01 * SIZES_MM[run.choice[1]].powi(3)])
    });
    assert_eq!(told(&table), ["errors bodies.bar.radius [] 4"]);
    assert_near(table.orders[0].order, 3.0);
}

/// A run has a smallest number of steps, so that its step is not proportional to the factor.
#[test]
fn the_size_of_a_relative_step_is_the_step() {
    let steps_s = [3e-6, 2e-6, 1e-6_f64];
    let study = study(
        r#"
[vary]
"run.safety_factor" = [0.9, 0.8, 0.1]
[measures.tip]
reference = { value = 1 }
"#,
    );
    let table = table(&study, |run| {
        let step_s = steps_s[run.choice[0]];
        Done {
            time_step_s: step_s,
            ..done(1.0, &[1.0 + (1e5 * step_s).powi(2)])
        }
    });
    assert_eq!(told(&table), ["errors run.safety_factor [] 3"]);
    assert_near(table.orders[0].order, 2.0);
}

#[test]
fn richardson_gives_the_order_of_the_values() {
    let study = study(
        r#"
[vary]
"bodies.bar.radius" = ["4 mm", "1 mm", "2 mm"]
[measures.tip]
reference = "richardson"
"#,
    );
    let table = table(&study, |run| {
        let size_mm = [4.0, 1.0, 2.0_f64][run.choice[0]];
        done(1.0, &[7.0 - 0.1 * size_mm.powf(1.5)])
    });
    assert_eq!(told(&table), ["values bodies.bar.radius [] 3"]);
    assert_near(table.orders[0].order, 1.5);
}

/// A thousand masses, shifted by the size: the distance is the shifted fraction. One of 0.05 is
/// within the chance of 0.06.
#[test]
fn errors_within_chance_show_no_order() {
    let study = study(
        r#"
[vary]
"bodies.bar.radius" = [400, 200, 100, 50, 1]
[measures.pieces]
fragment_masses = "remaining"
reference = "finest"
"#,
    );
    let table = table(&study, |run| {
        let shift = [400, 200, 100, 50, 0][run.choice[0]];
        let masses_kg = (1..=1000).map(|kg| f64::from(kg + shift)).collect();
        Done {
            readings: vec![Reading {
                masses_kg,
                ..reading(1000.0)
            }],
            ..done(1.0, &[])
        }
    });
    assert_near(table.runs[3].results[0].error.unwrap(), 0.05);
    assert_eq!(told(&table), ["errors bodies.bar.radius [] 3"]);
    assert_near(table.orders[0].order, 1.0);
}
