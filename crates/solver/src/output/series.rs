//! Columns of the time series: energies, errors, broken bonds, every measure.

use crate::check::ledger::Balance;
use crate::measure::Gauge;

/// Names of the first columns after the time: energies and works, J.
pub(super) const ENERGIES: [&str; 8] = [
    "kinetic_energy_j",
    "elastic_energy_j",
    "gravity_energy_j",
    "load_work_j",
    "support_work_j",
    "bond_damping_j",
    "particle_damping_j",
    "released_j",
];
/// Names of the columns after those.
const OTHERS: [&str; 5] = [
    "energy_error",
    "momentum_error",
    "angular_momentum_error",
    "broken_bonds",
    "time_step_s",
];

/// Names of all columns after the time, with units, no two alike.
pub fn columns(gauges: &[Gauge]) -> Vec<String> {
    let mut columns: Vec<String> = ENERGIES
        .iter()
        .chain(&OTHERS)
        .map(|&name| name.to_owned())
        .collect();
    for gauge in gauges {
        let mut name = match gauge.unit() {
            "" => gauge.name.clone(),
            unit => format!(
                "{}_{}",
                gauge.name,
                unit.to_lowercase().replace(['/', ' '], "_")
            ),
        };
        while name == "time_s" || columns.contains(&name) {
            name.insert_str(0, "measured_");
        }
        columns.push(name);
    }
    columns
}

/// A row in the order of [`columns`].
pub fn row(balance: &Balance, broken: u64, time_step_s: f64, measured: &[f64]) -> Vec<f64> {
    let always = [
        balance.kinetic_j,
        balance.elastic_j(),
        balance.gravity_j,
        balance.load_work_j,
        balance.support_work_j,
        balance.bond_damping_j,
        balance.particle_damping_j,
        balance.released_j,
        balance.energy_error,
        balance.momentum_error,
        balance.angular_momentum_error,
        broken as f64,
        time_step_s,
    ];
    // Adding 0 takes the sign from a zero.
    let values = always.into_iter().chain(measured.iter().copied());
    values.map(|value| value + 0.0).collect()
}
