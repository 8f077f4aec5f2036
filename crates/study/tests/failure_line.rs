//! Cohesion and friction angle from made strengths of a body of Mohr and Coulomb.

use dem_study::sweep_table::SweepTable;

use super::made::{assert_near, done, study, table};

const COHESION_PA: f64 = 2e6;
const ANGLE_DEG: f64 = 30.0;

fn strengths(key: &str, result: &str, strength_pa: impl Fn(f64) -> f64) -> SweepTable {
    let study = study(&format!(
        "[vary]\n\"test.{key}\" = [\"1 MPa\", \"2 MPa\", \"5 MPa\"]\n[measures.peak]\ntest_result = \"{result}\""
    ));
    table(&study, |run| {
        done(1.0, &[strength_pa([1e6, 2e6, 5e6][run.choice[0]])])
    })
}

fn assert_line(table: &SweepTable) {
    let line = table.failure_line.as_ref().unwrap();
    assert_near(line.cohesion_pa, COHESION_PA);
    assert_near(line.friction_angle_deg, ANGLE_DEG);
    assert!(line.residual_pa < 1.0);
    assert_eq!(line.peaks, 3);
    let said = "cohesion 2 MPa and friction angle 30 degrees, from the line through 3 strengths";
    assert!(table.notes[0].starts_with(said), "{:?}", table.notes);
}

/// (sigma_1 - sigma_3)/2 = c cos phi + (sigma_1 + sigma_3)/2 sin phi.
#[test]
fn triaxial_strengths_give_the_line() {
    let (sin, cos) = ANGLE_DEG.to_radians().sin_cos();
    let of_pressure =
        |confining_pa: f64| (2.0 * COHESION_PA * cos + confining_pa * (1.0 + sin)) / (1.0 - sin);
    assert_line(&strengths(
        "confining_pressure",
        "axial stress at failure",
        of_pressure,
    ));
}

/// tau = c + sigma tan phi.
#[test]
fn shear_strengths_give_the_line() {
    let slope = ANGLE_DEG.to_radians().tan();
    let of_stress = |normal_pa: f64| COHESION_PA + normal_pa * slope;
    assert_line(&strengths("normal_stress", "strength", of_stress));
}

#[test]
fn strengths_that_do_not_rise_give_none() {
    let table = strengths("normal_stress", "strength", |normal_pa| 9e6 - normal_pa);
    assert_eq!((table.failure_line, table.notes.len()), (None, 0));
    let table = strengths("normal_stress", "another result", |normal_pa| {
        normal_pa + 1e6
    });
    assert_eq!(table.failure_line, None);
}
