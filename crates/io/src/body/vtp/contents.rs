//! The arrays of a .vtp file as the data of a body.

mod stored;

use super::decode::{DAMAGED, Number, Values};
use super::header::{Array, Counts, Role};
use super::names::{
    BOND_RANGE, FORMAT_VERSION, LENGTH_UNIT, METRE, OVERLAP, PARTICLE_DENSITY, PROGRAM, RADIUS,
    SEED, SHAPE_VOLUME, SOURCE, SOURCE_HASH, VERSION, WARNINGS,
};
use super::numbers::{
    check_count, float, floats, line_values, particle, particle_numbers, text, texts, tuples, whole,
};
use super::walls;
use crate::body::histories::HistoryArrays;
use crate::body::parts::{Body, Parts};
use crate::body::stored_frame as frame;
use crate::body::stored_walls::{StoredWalls, WALL_FORCES, WALL_NAMES};
use crate::diagnostic::{Diagnostic, Result};

/// The data of a body read so far.
#[derive(Default)]
pub(super) struct Contents {
    counts: Option<Counts>,
    /// Names of the point data, for the message that the radii are missing.
    point_data: Vec<String>,
    radii: Option<Vec<f64>>,
    lines_ended: u64,
    /// All data except the radii.
    parts: Parts,
    histories: HistoryArrays,
    of_frame: OfFrame,
    walls: StoredWalls,
}

/// Data of frames that bodies do not have.
#[derive(Default)]
struct OfFrame {
    time_s: Option<f64>,
    clusters: Option<Vec<u32>>,
    densities: Option<Vec<f64>>,
    broken: Option<Vec<f64>>,
    rigid: Option<Vec<u32>>,
    ids: Option<Vec<u32>>,
    bodies: Option<Vec<u32>>,
    velocities: Option<Vec<f64>>,
    body_names: Vec<String>,
}

impl Contents {
    /// Stores the number of points and cells.
    pub(super) fn set_counts(&mut self, counts: Counts) -> Result<()> {
        if self.counts.replace(counts).is_some() {
            return Err(Diagnostic::input(
                "",
                "the body is in several pieces",
                "save it as one piece",
            ));
        }
        Ok(())
    }

    /// Largest possible number of values of an array.
    pub(super) fn most_values(&self, role: Role) -> u64 {
        // A field holds at most a text; fields of other programs may be larger.
        const OF_FIELD: u64 = 1 << 14;
        /// Scenes may have many walls and bodies.
        const OF_WALLS: u64 = 1 << 20;
        const OF_OTHER: u64 = 1 << 16;
        const OF_OTHER_PER_CELL: u64 = 1 << 10;
        /// Elements of a flat joint, and vectors of them.
        const OF_HISTORY_PER_CELL: u64 = 30_000;
        let counts = self.counts.unwrap_or_default();
        let others = counts.cells_before.saturating_add(counts.cells_after);
        let cells = counts.lines.saturating_add(others);
        match role {
            Role::Positions | Role::Velocities | Role::Turns => counts.points.saturating_mul(3),
            Role::Radii
            | Role::Clusters
            | Role::Densities
            | Role::Ids
            | Role::Bodies
            | Role::Rigid => counts.points,
            Role::Connectivity => counts.lines.saturating_mul(2),
            Role::Offsets => counts.lines,
            Role::BondRadii | Role::BondLengths | Role::Damages | Role::Broken => cells,
            Role::History(_) => cells.saturating_mul(OF_HISTORY_PER_CELL),
            Role::Corners => counts.cells_after.saturating_mul(3),
            Role::CornerOffsets | Role::WallNumbers => counts.cells_after,
            Role::Field(WALL_NAMES | WALL_FORCES | frame::BODY_NAMES) => OF_WALLS,
            Role::Field(_) => OF_FIELD,
            Role::Other => {
                let all = counts.points.saturating_add(cells);
                all.saturating_mul(OF_OTHER_PER_CELL)
                    .saturating_add(OF_OTHER)
            }
        }
    }

    /// Records that there is point data of this name.
    pub(super) fn add_point_data(&mut self, name: &str) {
        self.point_data.push(name.to_owned());
    }

    /// Stores the values of an array.
    pub(super) fn fill(&mut self, array: &Array, values: Values<'_>) -> Result<()> {
        let filled = match array.role {
            Role::Other => Ok(()),
            Role::Field(name) => self.fill_field(name, array, values),
            _ => match self.counts {
                Some(counts) => self.fill_counted(counts, array, values),
                None => Err(Diagnostic::input(
                    "",
                    "it stands outside of a piece",
                    DAMAGED,
                )),
            },
        };
        filled.map_err(|error| array.within(error))
    }

    fn fill_counted(&mut self, counts: Counts, array: &Array, values: Values<'_>) -> Result<()> {
        match array.role {
            Role::Positions => self.fill_positions(array, values, counts.points),
            Role::Connectivity => self.fill_bonds(array, values, counts.lines),
            Role::Offsets => self.check_line_ends(array, values, counts.lines),
            Role::Radii => {
                floats(array, values, [0, counts.points, 0]).map(|all| self.radii = Some(all))
            }
            Role::BondRadii => {
                line_values(array, values, counts).map(|all| self.parts.bond_radii = Some(all))
            }
            Role::BondLengths => {
                line_values(array, values, counts).map(|all| self.parts.bond_lengths = Some(all))
            }
            Role::Damages => {
                line_values(array, values, counts).map(|all| self.parts.bond_damages = all)
            }
            Role::Clusters => particle_numbers(array, values, counts)
                .map(|all| self.of_frame.clusters = Some(all)),
            Role::Ids => {
                particle_numbers(array, values, counts).map(|all| self.of_frame.ids = Some(all))
            }
            Role::Bodies => {
                particle_numbers(array, values, counts).map(|all| self.of_frame.bodies = Some(all))
            }
            Role::Velocities => floats(array, values, [0, counts.points.saturating_mul(3), 0])
                .map(|all| self.of_frame.velocities = Some(all)),
            Role::Turns => floats(array, values, [0, counts.points.saturating_mul(3), 0])
                .map(|all| self.parts.turns_rad = all.as_chunks().0.to_vec()),
            Role::Rigid => {
                particle_numbers(array, values, counts).map(|all| self.of_frame.rigid = Some(all))
            }
            Role::Densities => floats(array, values, [0, counts.points, 0])
                .map(|all| self.of_frame.densities = Some(all)),
            Role::Broken => {
                line_values(array, values, counts).map(|all| self.of_frame.broken = Some(all))
            }
            Role::History(number) => {
                tuples(array, values, counts).map(|all| self.histories.arrays[number] = all)
            }
            Role::Corners | Role::CornerOffsets | Role::WallNumbers => {
                walls::fill(&mut self.walls, counts, array, values)
            }
            Role::Field(_) | Role::Other => Ok(()),
        }
    }

    fn fill_positions(&mut self, array: &Array, values: Values<'_>, points: u64) -> Result<()> {
        let (mut point, mut axis) = ([0.0; 3], 0);
        let positions = &mut self.parts.positions;
        values.for_each(array.scalar()?, |number| {
            point[axis] = float(number);
            axis += 1;
            if axis == 3 {
                positions.push(point);
                axis = 0;
            }
            Ok(())
        })?;
        check_count(
            3 * positions.len() as u64 + axis as u64,
            3 * u128::from(points),
            "values",
        )
    }

    fn fill_bonds(&mut self, array: &Array, values: Values<'_>, lines: u64) -> Result<()> {
        let mut first = None;
        let bonds = &mut self.parts.bonds;
        values.for_each(array.scalar()?, |number| {
            let particle = particle(number)?;
            match first.take() {
                None => first = Some(particle),
                Some(other) => bonds.push([other, particle]),
            }
            Ok(())
        })?;
        check_count(
            2 * bonds.len() as u64 + u64::from(first.is_some()),
            2 * u128::from(lines),
            "line ends",
        )
    }

    fn check_line_ends(&mut self, array: &Array, values: Values<'_>, lines: u64) -> Result<()> {
        let ended = &mut self.lines_ended;
        values.for_each(array.scalar()?, |number| {
            let line = *ended;
            *ended += 1;
            if number == Number::Integer(2 * i128::from(*ended)) {
                return Ok(());
            }
            let problem = format!("line {line} does not have two points");
            Err(Diagnostic::input(
                "",
                problem,
                "a bond joins two: save each bond as a line of its own",
            ))
        })?;
        check_count(*ended, lines.into(), "lines")
    }

    fn fill_field(&mut self, name: &'static str, array: &Array, values: Values<'_>) -> Result<()> {
        let mut numbers = Vec::new();
        values.for_each(array.scalar()?, |number| {
            numbers.push(number);
            Ok(())
        })?;
        let first = numbers.first().copied();
        let about = &mut self.parts.about;
        match name {
            VERSION => check_version(first)?,
            LENGTH_UNIT => check_unit(&text(&numbers)?)?,
            PROGRAM => about.program = Some(text(&numbers)?),
            SOURCE => about.source = Some(text(&numbers)?),
            SOURCE_HASH => about.source_hash = first.map(whole).transpose()?,
            SEED => about.seed = first.map(whole).transpose()?,
            SHAPE_VOLUME => about.shape_volume_m3 = first.map(float),
            PARTICLE_DENSITY => about.particle_density_kg_m3 = first.map(float),
            OVERLAP => about.overlap = first.map(float),
            BOND_RANGE => about.bond_range = first.map(float),
            WARNINGS => about.warnings = texts(&numbers)?,
            frame::TIME => self.of_frame.time_s = first.map(float),
            frame::BODY_NAMES => self.of_frame.body_names = texts(&numbers)?,
            _ => walls::fill_field(&mut self.walls, name, &numbers)?,
        }
        Ok(())
    }

    /// The body, if everything that it needs was present.
    pub(super) fn into_body(self) -> Result<Body> {
        self.check_counts()?;
        if self.of_frame.broken.is_some() {
            return Err(Diagnostic::input(
                "",
                "this is a frame of a run, whose bonds may be broken",
                "write one of its fragments as a body: dem-run fragment RESULTS --largest -o piece.vtp",
            ));
        }
        let Some(radii) = self.radii else {
            let known = self.known_point_data();
            return Err(Diagnostic::input(
                "",
                format!("the radii of the particles are missing: {known}"),
                format!("name the point data that hold them '{RADIUS}'"),
            ));
        };
        let bonds = self.parts.bonds.len();
        Body::from_parts(Parts {
            radii,
            bond_directions: self.histories.directions(bonds),
            bond_sums: self.histories.sums(bonds),
            bond_plastics: self.histories.plastics(bonds),
            bond_joints: self.histories.joints(bonds),
            ..self.parts
        })
    }

    /// The names of the point data, human-readable.
    fn known_point_data(&self) -> String {
        match self.point_data.as_slice() {
            [] => "there are no point data".to_owned(),
            names => format!("the point data are '{}'", names.join("', '")),
        }
    }

    fn check_counts(&self) -> Result<()> {
        let counts = self.counts.unwrap_or_default();
        check_count(
            self.parts.positions.len() as u64,
            counts.points.into(),
            "points",
        )?;
        check_count(self.parts.bonds.len() as u64, counts.lines.into(), "lines")?;
        check_count(self.lines_ended, counts.lines.into(), "offsets of lines")
    }
}

fn check_version(number: Option<Number>) -> Result<()> {
    match number {
        Some(Number::Integer(version)) if version == i128::from(FORMAT_VERSION) => Ok(()),
        Some(Number::Integer(version)) if version > i128::from(FORMAT_VERSION) => {
            Err(Diagnostic::input(
                "",
                format!(
                    "the body has format version {version}; this program knows {FORMAT_VERSION}"
                ),
                "use a newer program, or write the body with an older one",
            ))
        }
        _ => Err(Diagnostic::input(
            "",
            "the format version makes no sense",
            DAMAGED,
        )),
    }
}

fn check_unit(unit: &str) -> Result<()> {
    if unit == METRE {
        return Ok(());
    }
    Err(Diagnostic::input(
        "",
        format!("the length unit is '{unit}', not '{METRE}'"),
        "convert the lengths to metres",
    ))
}
