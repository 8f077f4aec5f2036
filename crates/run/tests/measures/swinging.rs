//! Walls that swing, and their work.

use std::f64::consts::TAU;

use super::{Measured, assert_near};

/// A plate that swings below a ball without gravity: 20 Hz, 1 mm.
fn text(phase: &str, gap_m: f64) -> String {
    let mut text = format!(
        "version = 1
run = {{ end_time = 1 }}
materials.m = {{ density = 2000, young_modulus = 1e7 }}
materials.anvil.rigid = true
contacts = {{ m-m = {{ restitution = 1 }}, m-anvil = {{ restitution = 1, friction = 0 }} }}
bodies.ball = {{ particles = [[0, 0, {}, 5e-3]], material = \"m\" }}
walls.plate = {{ box = {{ min = [-1, -1, -1], max = [1, 1, 0] }}, material = \"anvil\", displacement = [0, 0, 1e-3], frequency = \"20 Hz\", phase = \"{phase}\" }}
",
        5e-3 + gap_m
    );
    for quantity in ["position_z", "work", "power"] {
        text += &format!("measures.{quantity} = {{ of = \"plate\", quantity = \"{quantity}\" }}\n");
    }
    text += "measures.kinetic = { of = \"ball\", quantity = \"kinetic_energy\" }\n";
    text
}

#[test]
fn a_wall_swings_by_its_frequency_and_phase() {
    for (phase, phase_rad) in [
        ("0 deg", 0.0),
        ("-90 deg", -0.25 * TAU),
        ("30 deg", TAU / 12.0),
    ] {
        for end_s in [3e-3, 12.5e-3, 31e-3] {
            let mut measured = Measured::new(&text(phase, 1.0));
            let values = measured.run(end_s);
            let turned_rad = TAU * 20.0 * measured.state.time_s + phase_rad;
            let swing: f64 = turned_rad.sin() - phase_rad.sin();
            assert_near(values["position_z"], 1e-3 * swing, 1e-12);
            assert_eq!((values["work"], values["power"]), (0.0, 0.0));
        }
    }
}

#[test]
fn the_work_of_a_wall_is_the_energy_that_it_gives() {
    // From the middle of its way the plate hits the ball at nearly its largest speed, 0.126 m/s,
    // which leaves at nearly twice that.
    let mut measured = Measured::new(&text("0 deg", 1e-5));
    let values = measured.run(20e-3);
    let mass_kg = 2000.0 * 4.0 / 3.0 * std::f64::consts::PI * 5e-3_f64.powi(3);
    let energy_j = 0.5 * mass_kg * (2.0 * TAU * 20.0 * 1e-3_f64).powi(2);
    assert_near(values["work"], energy_j, 0.05 * energy_j);
    assert_near(values["work"], values["kinetic"], 1e-3 * energy_j);
    let mean_w = values["work"] / measured.state.time_s;
    assert_near(values["power"], mean_w, 1e-12 * mean_w);
}
