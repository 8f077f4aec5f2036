//! Quartzite crushed in split Hopkinson bars (Rae et al. 2020), beside particles that break by the
//! law fitted to these tests: doc/breakage.md.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use dem_engine::state::events::{BrokenInto, PopulationEvent};
use dem_laboratory::drop_weight::{DropWeightTest, fit_ore, read_sheets};
use dem_physics::breakage::BreakageLaw;
use dem_testing::hold_table;

use super::planned;
use crate::helpers::step_and_balance;

const SHEET: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../data/measured/quartzite-drop-weight.csv"
);
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../doc/breakage.md");
const TABLE: [&str; 2] = ["<!-- quartzite -->\n", "<!-- end of quartzite -->"];
/// The n whose t_n are compared. The daughters go down to a 26th of the particle.
const COMPARED: [f64; 3] = [4.0, 10.0, 25.0];
const SMALLEST: f64 = 1.0 / 26.0;
/// Bands set before the first run: largest deviation of t10 of a test, and of the family at the
/// same t10, in the mean over all tests.
const T10_BAND: f64 = 0.10;
const FAMILY_BAND: f64 = 0.05;

/// t_n of a sphere that hits a rigid plate with the energy of a test. All 0: it does not break.
fn broken(test: &DropWeightTest, law: &BreakageLaw) -> [f64; 3] {
    let (radius_m, speed_m_s) = (0.5 * test.size_m, (2.0 * test.energy_j_kg).sqrt());
    let text = format!(
        "version = 1
run.end_time = 1
materials.anvil.rigid = true
contacts = {{ rock-rock = {{ restitution = 0.5 }}, rock-anvil = {{ restitution = 0.5 }} }}
replacement.ball.breakage = {{ smallest_size = {} }}
[materials.rock]
density = 2645
young_modulus = 38.1e9
poisson_ratio = 0.1
breakage = {{ largest_t10 = {}, b = {}, fracture_energy = {}, reference_size = {}, family_exponent = {} }}
[bodies.ball]
particles = [[0, 0, 0, {radius_m}]]
material = \"rock\"
start_as = \"clump\"
position = [0, 0, {}]
velocity = [0, 0, {}]
[walls.plate]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = \"anvil\"\n",
        SMALLEST * test.size_m,
        law.largest_t10,
        law.b_kg_j,
        law.fracture_energy_j_kg,
        law.reference_size_m,
        law.family_exponent,
        1.0001 * radius_m,
        -speed_m_s,
    );
    let mut state = planned(&text).state;
    let plate_touched = |state: &dem_engine::state::State| !state.walls[0].touching.is_empty();
    let mut touched = false;
    loop {
        step_and_balance(&mut state);
        let happened = state.scratch.events.population.first();
        if let Some(PopulationEvent::Broken { into, .. }) = happened {
            assert!(matches!(into, BrokenInto::Law { .. }));
            break;
        }
        touched |= plate_touched(&state);
        if touched && !plate_touched(&state) {
            return [0.0; 3];
        }
    }
    let fines_kg: f64 = state.population.fines_kg.iter().sum();
    let pieces: Vec<[f64; 2]> = (state.clumps.all.iter())
        .map(|clump| {
            let template = state.clumps.template(clump);
            [template.size_m(), template.mass_kg]
        })
        .collect();
    let whole_kg = fines_kg + pieces.iter().map(|[_, kg]| kg).sum::<f64>();
    COMPARED.map(|n| {
        let small = pieces
            .iter()
            .filter(|[size_m, _]| *size_m < test.size_m / n);
        (fines_kg + small.map(|[_, kg]| kg).sum::<f64>()) / whole_kg
    })
}

#[test]
fn quartzite_breaks_as_measured_and_the_page_says_how_nearly() {
    let sheets = read_sheets(&[PathBuf::from(SHEET)]).unwrap();
    let law = fit_ore(&sheets).unwrap().law;
    let mut table = "\n| energy, kWh/t | t4 measured | run | t10 measured | run | t25 measured | run |\n|---|---|---|---|---|---|---|\n".to_owned();
    let mut tests = sheets.tests.clone();
    tests.sort_by(|a, b| a.energy_j_kg.total_cmp(&b.energy_j_kg));
    let (mut squares, mut of_family) = ([0.0; 3], [0.0; 3]);
    for test in &tests {
        let of = |n: f64| test.family.iter().find(|[own, _]| *own == n).unwrap()[1];
        let measured = [of(4.0), test.t10.unwrap(), of(25.0)];
        let run = broken(test, &law);
        assert!(
            (run[1] - measured[1]).abs() < T10_BAND,
            "{}: {run:?}",
            test.place
        );
        write!(table, "| {:.3} |", test.energy_j_kg / 3600.0).unwrap();
        for n in 0..3 {
            write!(
                table,
                " {:.1} % | {:.1} % |",
                100.0 * measured[n],
                100.0 * run[n]
            )
            .unwrap();
            squares[n] += (run[n] - measured[n]).powi(2);
            of_family[n] += (law.passing(COMPARED[n], measured[1]) - measured[n]).powi(2);
        }
        table.push('\n');
    }
    let mean = |sum: f64| (sum / tests.len() as f64).sqrt();
    write!(table, "| root mean square deviation, points |").unwrap();
    for (square, family) in squares.iter().zip(of_family) {
        assert!(mean(family) < FAMILY_BAND, "{}", mean(family));
        write!(table, " | {:.1} |", 100.0 * mean(*square)).unwrap();
    }
    table.push('\n');
    hold_table(Path::new(PAGE), TABLE, &table);
}
