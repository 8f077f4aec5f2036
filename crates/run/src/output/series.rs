//! Columns of the time series: energies, errors, numbers of bonds and particles, every measure.

use dem_engine::state::State;
use dem_engine::state::bonds::Bonds;
use dem_plan::measure::Probe;
use dem_results::Balance;

/// Names of the first columns after the time: energies and works, J.
pub(super) const ENERGIES: [&str; 20] = [
    "kinetic_energy_j",
    "elastic_energy_j",
    "gravity_energy_j",
    "load_work_j",
    "support_work_j",
    "wall_work_j",
    "bond_damping_j",
    "structural_damping_j",
    "local_damping_j",
    "adhesion_j",
    "contact_damping_j",
    "friction_j",
    "bond_breakage_j",
    "bond_damage_j",
    "particle_breakage_j",
    "bond_plastic_j",
    "liquid_bridge_j",
    "liquid_bridge_loss_j",
    "rejoining_loss_j",
    "flow_energy_j",
];
/// Names of the columns after those.
const OTHERS: [&str; 8] = [
    "energy_error",
    "momentum_error",
    "angular_momentum_error",
    "broken_bonds",
    "intact_bonds",
    "particles",
    "clumps",
    "time_step_s",
];

/// Names of all columns after the time, with units, all different: energies and errors, force on
/// and work of each wall, measures.
pub(crate) fn columns<'a>(
    walls: impl Iterator<Item = &'a String>,
    probes: &[Probe],
) -> Vec<String> {
    let mut columns: Vec<String> = ENERGIES
        .iter()
        .chain(&OTHERS)
        .map(|&name| name.to_owned())
        .collect();
    for wall in walls {
        let of_wall = ["force_x_n", "force_y_n", "force_z_n", "work_j"];
        columns.extend(of_wall.map(|what| format!("wall_{wall}_{what}")));
    }
    for probe in probes {
        let mut name = match probe.unit() {
            "" => probe.name.clone(),
            unit => format!(
                "{}_{}",
                probe.name,
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
pub(crate) fn row(state: &State, balance: &Balance, measured: &[f64]) -> Vec<f64> {
    let always = [
        balance.kinetic_j,
        balance.elastic_j(),
        balance.gravity_j,
        balance.load_work_j,
        balance.support_work_j,
        balance.wall_work_j,
        balance.bond_damping_j,
        balance.structural_damping_j,
        balance.local_damping_j,
        balance.adhesion_j,
        balance.contact_damping_j,
        balance.friction_j,
        balance.bond_breakage_j,
        balance.bond_damage_j,
        balance.particle_breakage_j,
        balance.bond_plastic_j,
        balance.liquid_bridge_j,
        balance.liquid_bridge_loss_j,
        balance.rejoining_loss_j,
        balance.flow_energy_j,
        balance.energy_error,
        balance.momentum_error,
        balance.angular_momentum_error,
        state.broken_count as f64,
        intact_bonds(&state.bonds) as f64,
        state.particles.len() as f64,
        state.clumps.of_several_spheres() as f64,
        state.time_step_s,
    ];
    let of_walls = state.walls.iter().flat_map(|wall| {
        let [x, y, z] = wall.total_load()[0].map(|f| -f);
        [x, y, z, wall.work_j]
    });
    // Adding 0 removes the sign of a zero.
    let values = always
        .into_iter()
        .chain(of_walls)
        .chain(measured.iter().copied());
    values.map(|value| value + 0.0).collect()
}

fn intact_bonds(bonds: &Bonds) -> usize {
    let all = 0..bonds.len();
    all.filter(|at| !bonds.is_broken(*at)).count()
}
