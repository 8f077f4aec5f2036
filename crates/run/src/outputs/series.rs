//! The time series, `series.csv`: energies, errors, numbers of bonds and particles, every measure.

use dem_io::Result;
use dem_results::SeriesFile;
use dem_results::folder::names;

use super::{Moment, Opening, Output, Saved, TableEnd};
use dem_engine::state::State;
use dem_engine::state::bonds::Bonds;
use dem_plan::measure::Probe;
use dem_results::summary::{Balance, ENERGIES};

struct Series(SeriesFile);

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let path = opening.folder.file(names::SERIES);
    let columns = columns(opening.scene.walls.keys(), opening.probes);
    let file = match opening.position::<TableEnd>()? {
        None => SeriesFile::create(&path, &columns)?,
        Some(end) => SeriesFile::continue_at(&path, &columns, end.bytes)?,
    };
    Ok(Some(Box::new(Series(file))))
}

impl Output for Series {
    fn write(&mut self, now: &Moment<'_>) -> Result<()> {
        let Some((balance, values)) = now.row else {
            return Ok(());
        };
        let row = row(now.state, balance, values);
        self.0.append(now.state.time_s, &row)
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.0.table, &())
    }
}

/// A column: its name, and how it is read.
type Column = (&'static str, fn(&State, &Balance) -> f64);

/// The columns after those of [`ENERGIES`].
const OTHERS: [Column; 8] = [
    ("energy_error", |_, balance| balance.energy_error),
    ("momentum_error", |_, balance| balance.momentum_error),
    ("angular_momentum_error", |_, balance| {
        balance.angular_momentum_error
    }),
    ("broken_bonds", |state, _| state.broken_count as f64),
    ("intact_bonds", |state, _| intact_bonds(&state.bonds) as f64),
    ("particles", |state, _| state.particles.len() as f64),
    ("clumps", |state, _| {
        state.clumps.of_several_spheres() as f64
    }),
    ("time_step_s", |state, _| state.time_step_s),
];

/// Names of all columns after the time, with units, all different: energies and errors, force on
/// and work of each wall, measures.
pub(crate) fn columns<'a>(
    walls: impl Iterator<Item = &'a String>,
    probes: &[Probe],
) -> Vec<String> {
    let energies = ENERGIES.iter().map(|energy| energy.name);
    let mut columns: Vec<String> = energies
        .chain(OTHERS.map(|(name, _)| name))
        .map(str::to_owned)
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
    let energies = ENERGIES.iter().map(|energy| (energy.of)(balance));
    let others = OTHERS.iter().map(|(_, of)| of(state, balance));
    let of_walls = state.walls.iter().flat_map(|wall| {
        let [x, y, z] = wall.total_load()[0].map(|f| -f);
        [x, y, z, wall.work_j]
    });
    // Adding 0 removes the sign of a zero.
    let values = energies
        .chain(others)
        .chain(of_walls)
        .chain(measured.iter().copied());
    values.map(|value| value + 0.0).collect()
}

fn intact_bonds(bonds: &Bonds) -> usize {
    let all = 0..bonds.len();
    all.filter(|at| !bonds.is_broken(*at)).count()
}
