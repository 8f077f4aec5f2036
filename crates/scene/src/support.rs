//! `[supports.NAME]`

use super::factor::{self, Factor, RAMP, TABLE, end, factor, factor_from_zero, over_time};
use super::field::Field;
use super::listing::Listing;
use super::names::suggestion;
use super::numbers::quantity;
use super::schema::{Key, Kind, Schema, table_schema};
use super::table::Table;
use super::targets::{GROUP_KEY, Targets};
use super::tree::Value;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGLE, ANGULAR_VELOCITY, LENGTH, VELOCITY};
use serde::{Deserialize, Serialize};

/// Constraint of one degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Hold {
    /// Fixed.
    Fixed,
    /// Moves at this velocity times the factor, m/s or rad/s.
    Velocity(f64),
    /// Is displaced by this times the factor, m or rad.
    Displacement(f64),
    /// All particles of the support move together, as the end of a long elastic bar that a `[test]`
    /// glues to them: it exerts Z (2 v_I - v) on them.
    Bar {
        /// Impedance Z, N s/m.
        impedance_n_s_m: f64,
        /// Velocity v_I of the incident pulse, times the factor, m/s.
        incident_m_s: f64,
    },
}

/// A support: holds degrees of freedom of a group of particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Support {
    /// `group`: a group, a body or `all`.
    pub group: String,
    /// Along x, y, z, then about x, y, z (`fixed`, `velocity`, `displacement`); None: free. At
    /// least one is not free. Length 6.
    pub holds: [Option<Hold>; 6],
    /// `ramp` or `table`, for velocities and displacements.
    pub factor: Factor,
    /// `end`: time from which the degrees of freedom are free, s. Not before the factor's last
    /// change. None: never.
    pub end_s: Option<f64>,
}

table_schema! {
    /// Boundary conditions: hold or move each particle of a group along x, y, z and about these
    /// axes (rx, ry, rz).
    pub(super) static SUPPORT = "[supports.NAME]";

    GROUP_KEY;
    /// Fixed degrees of freedom: `true` for all, or a list such as `["x", "rz"]`.
    new("fixed", Kind::Either(&[Kind::True, Kind::List(&Kind::Word(|| FREEDOMS.to_vec()))]));
    /// Prescribed velocities, multiplied by the factor of `ramp` or `table`.
    table("velocity", &VELOCITIES);
    /// Prescribed displacements, multiplied by the factor; requires a `ramp` or `table` that begins
    /// at 0.
    table("displacement", &DISPLACEMENTS);
    RAMP;
    TABLE;
    /// Time at which the degrees of freedom are released; not before the last change of `ramp` or
    /// `table`.
    until();
}

pub(super) static VELOCITIES: Schema = Schema {
    title: "Prescribed velocities",
    doc: "Velocities of degrees of freedom.",
    keys: &[
        Key::quantity("x", &VELOCITY, "Along x.").otherwise("free"),
        Key::quantity("y", &VELOCITY, "Along y.").otherwise("free"),
        Key::quantity("z", &VELOCITY, "Along z.").otherwise("free"),
        Key::quantity("rx", &ANGULAR_VELOCITY, "About x.").otherwise("free"),
        Key::quantity("ry", &ANGULAR_VELOCITY, "About y.").otherwise("free"),
        Key::quantity("rz", &ANGULAR_VELOCITY, "About z.").otherwise("free"),
    ],
};

pub(super) static DISPLACEMENTS: Schema = Schema {
    title: "Prescribed displacements",
    doc: "Displacements of degrees of freedom.",
    keys: &[
        Key::quantity("x", &LENGTH, "Along x.").otherwise("free"),
        Key::quantity("y", &LENGTH, "Along y.").otherwise("free"),
        Key::quantity("z", &LENGTH, "Along z.").otherwise("free"),
        Key::quantity("rx", &ANGLE, "About x.").otherwise("free"),
        Key::quantity("ry", &ANGLE, "About y.").otherwise("free"),
        Key::quantity("rz", &ANGLE, "About z.").otherwise("free"),
    ],
};

/// The degrees of freedom of a particle: along x, y, z, then about x, y, z.
pub(super) const FREEDOMS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Support> {
    let table = Table::of(field, &SUPPORT)?;
    let group = targets.name(&table.need("group")?)?;
    let mut holds = [None; 6];
    if let Some(field) = table.get("fixed") {
        fix(&field, &mut holds)?;
    }
    if let Some(field) = table.get("velocity") {
        move_by(&field, &VELOCITIES, Hold::Velocity, &mut holds)?;
    }
    if let Some(field) = table.get("displacement") {
        move_by(&field, &DISPLACEMENTS, Hold::Displacement, &mut holds)?;
    }
    if holds.iter().all(Option::is_none) {
        let remedy =
            "add fixed = true, fixed = [\"x\"], velocity = { x = 1 } or displacement = { x = 1 }";
        return Err(table.fault("holds nothing", remedy));
    }
    let moves = holds.iter().flatten().any(|hold| *hold != Hold::Fixed);
    if let (Some(field), false) = (over_time(&table), moves) {
        let problem = "has no effect without velocity or displacement";
        return Err(field.fault(problem, "remove it"));
    }
    let factor = match table.get("displacement") {
        Some(field) => factor_from_zero(&table, &field)?,
        None => factor(&table)?,
    };
    let end_s = end(&table, &factor)?;
    Ok(Support {
        group,
        holds,
        factor,
        end_s,
    })
}

/// `true`, or a list of degrees of freedom.
fn fix(field: &Field<'_>, holds: &mut [Option<Hold>; 6]) -> Result<()> {
    match field.node.value {
        Value::Boolean(true) => *holds = [Some(Hold::Fixed); 6],
        Value::List(_) => {
            for item in field.items()? {
                let at = item.choice(&[0, 1, 2, 3, 4, 5].map(|at| (FREEDOMS[at], at)))?;
                hold(&item, FREEDOMS[at], &mut holds[at], Hold::Fixed)?;
            }
        }
        _ => {
            let remedy = "write fixed = true, or fixed = [\"x\", \"ry\"]";
            return Err(field.wrong("true or a list of x, y, z, rx, ry, rz", remedy));
        }
    }
    Ok(())
}

/// `{ x = ..., rz = ... }`
fn move_by(
    field: &Field<'_>,
    freedoms: &'static Schema,
    kind: impl Fn(f64) -> Hold,
    holds: &mut [Option<Hold>; 6],
) -> Result<()> {
    let table = Table::any(field)?;
    if table.entries.is_empty() {
        let problem = "is an empty table";
        let remedy = "name a freedom, such as x = 1, or leave the key out";
        return Err(field.fault(problem, remedy));
    }
    if let Some((key, _)) = table
        .entries
        .iter()
        .find(|(key, _)| !FREEDOMS.contains(&key.as_str()))
    {
        let problem = format!("{} has no freedom '{}'", field.path, key.escape_debug());
        let place = table.get(key).unwrap_or(field.clone());
        return Err(place.refuse(problem, suggestion(key, FREEDOMS.into_iter())));
    }
    let table = Table::of(field, freedoms)?;
    for (at, freedom) in FREEDOMS.iter().enumerate() {
        if let Some(field) = table.get(freedom) {
            hold(&field, freedom, &mut holds[at], kind(table.read(freedom)?))?;
        }
    }
    Ok(())
}

fn hold(field: &Field<'_>, freedom: &str, place: &mut Option<Hold>, new: Hold) -> Result<()> {
    if let Some(before) = place {
        let how = match before {
            Hold::Fixed => "fixed",
            Hold::Velocity(_) => "given a velocity",
            Hold::Displacement(_) => "given a displacement",
            Hold::Bar { .. } => "moved by a bar",
        };
        let problem = format!("{}: {freedom} is already {how} by this support", field.path);
        return Err(field.refuse(problem, "a freedom is held in one way: remove one"));
    }
    *place = Some(new);
    Ok(())
}

pub(super) fn list(support: &Support, listing: &mut Listing) {
    listing.text("group", &support.group);
    for (at, (freedom, hold)) in FREEDOMS.iter().zip(&support.holds).enumerate() {
        let unit = |units: [&'static str; 2]| if at < 3 { units[0] } else { units[1] };
        let text = match hold {
            None => "free".to_owned(),
            Some(Hold::Fixed) => "fixed".to_owned(),
            Some(Hold::Velocity(velocity)) => {
                format!("velocity {}", quantity(*velocity, unit(["m/s", "rad/s"])))
            }
            Some(Hold::Bar { .. }) => "end of a bar".to_owned(),
            Some(Hold::Displacement(displacement)) => {
                format!(
                    "displacement {}",
                    quantity(*displacement, unit(["m", "rad"]))
                )
            }
        };
        listing.text(freedom, text);
    }
    factor::list(&support.factor, listing);
    listing.value("end", &support.end_s);
}
