//! `[supports.NAME]`

use super::field::Field;
use super::load::{end, factor, factor_from_zero, over_time};
use super::names::suggestion;
use super::targets::Targets;
use super::tree::Value;
use super::{Hold, Support};
use crate::Result;
use crate::units::{ANGLE, ANGULAR_VELOCITY, Dimension, LENGTH, VELOCITY};

const KEYS: [&str; 7] = [
    "of",
    "fixed",
    "velocity",
    "displacement",
    "ramp",
    "table",
    "end",
];

/// The degrees of freedom of a particle: along x, y, z, then about x, y, z.
pub(super) const FREEDOMS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Support> {
    let table = field.table(&KEYS)?;
    let of = targets.name(&table.need("of", "\"NAME\", a set, a body or \"all\"")?)?;
    let mut holds = [None; 6];
    if let Some(field) = table.get("fixed") {
        fix(&field, &mut holds)?;
    }
    if let Some(field) = table.get("velocity") {
        move_by(
            &field,
            [&VELOCITY, &ANGULAR_VELOCITY],
            Hold::Velocity,
            &mut holds,
        )?;
    }
    if let Some(field) = table.get("displacement") {
        move_by(&field, [&LENGTH, &ANGLE], Hold::Displacement, &mut holds)?;
    }
    if holds.iter().all(Option::is_none) {
        let problem = format!("{} holds nothing", table.path);
        let remedy =
            "add fixed = true, fixed = [\"x\"], velocity = { x = 1 } or displacement = { x = 1 }";
        return Err(table.refuse(problem, remedy));
    }
    let moves = holds.iter().flatten().any(|hold| *hold != Hold::Fixed);
    if let (Some(field), false) = (over_time(&table), moves) {
        let problem = format!(
            "{} stands without velocity or displacement, on which it acts",
            field.path
        );
        return Err(field.refuse(problem, "remove it"));
    }
    let factor = match table.get("displacement") {
        Some(field) => factor_from_zero(&table, &field)?,
        None => factor(&table)?,
    };
    let end_s = end(&table, &factor)?;
    Ok(Support {
        of,
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

/// `{ x = ..., rz = ... }`, in the dimensions of moves and of turns.
fn move_by(
    field: &Field<'_>,
    [along, about]: [&Dimension; 2],
    kind: impl Fn(f64) -> Hold,
    holds: &mut [Option<Hold>; 6],
) -> Result<()> {
    let table = field.any_table()?;
    if table.entries.is_empty() {
        let problem = format!("{} is an empty table", field.path);
        return Err(field.refuse(
            problem,
            "name a freedom, such as x = 1, or leave the key out",
        ));
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
    for (at, freedom) in FREEDOMS.iter().enumerate() {
        if let Some(field) = table.get(freedom) {
            let value = field.quantity(if at < 3 { along } else { about })?;
            hold(&field, freedom, &mut holds[at], kind(value))?;
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
        };
        let problem = format!("{}: {freedom} is already {how} by this support", field.path);
        return Err(field.refuse(problem, "a freedom is held in one way: remove one"));
    }
    *place = Some(new);
    Ok(())
}
