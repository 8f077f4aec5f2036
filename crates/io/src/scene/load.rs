//! `[loads.NAME]`, and the factor over time that loads, supports and walls share.

use super::field::Field;
use super::table::Table;
use super::targets::Targets;
use super::{Factor, Load};
use crate::Result;
use crate::units::{FORCE, NUMBER, TIME, TORQUE};

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Load> {
    let table = field.table(&["of", "force", "torque", "ramp", "table", "end"])?;
    let of = targets.name(&table.need("of", "\"NAME\", a set, a body or \"all\"")?)?;
    let factor = factor(&table)?;
    let load = Load {
        of,
        force_n: table
            .read("force", |field| field.vector(&FORCE))?
            .unwrap_or_default(),
        torque_n_m: table
            .read("torque", |field| field.vector(&TORQUE))?
            .unwrap_or_default(),
        end_s: end(&table, &factor)?,
        factor,
    };
    if load.force_n == [0.0; 3] && load.torque_n_m == [0.0; 3] {
        let problem = format!("{} is a load of zero", table.path);
        let remedy =
            "add force = [0, 0, \"100 N\"] or torque = [0, 0, \"1 N m\"], or remove the table";
        return Err(table.refuse(problem, remedy));
    }
    Ok(load)
}

/// The key that says how a factor changes with time, if there is one.
pub(super) fn over_time<'a>(table: &Table<'a>) -> Option<Field<'a>> {
    table.get("ramp").or_else(|| table.get("table"))
}

/// `ramp` or `table`; 1 without either.
pub(super) fn factor(table: &Table<'_>) -> Result<Factor> {
    match (table.get("ramp"), table.get("table")) {
        (None, None) => Ok(Factor::One),
        (Some(field), None) => Ok(Factor::Ramp {
            until_s: field.positive(&TIME)?,
        }),
        (None, Some(field)) => points(&field),
        (Some(_), Some(field)) => {
            let problem = format!("{} stands beside ramp", field.path);
            Err(field.refuse(problem, "the factor follows one of them: remove the other"))
        }
    }
}

/// `end`, s: not before the last change of the factor.
pub(super) fn end(table: &Table<'_>, factor: &Factor) -> Result<Option<f64>> {
    let Some(field) = table.get("end") else {
        return Ok(None);
    };
    let end_s = field.positive(&TIME)?;
    let (last_s, which) = match factor {
        Factor::One => return Ok(Some(end_s)),
        Factor::Ramp { until_s } => (*until_s, "the ramp"),
        Factor::Table(points) => (points.last().map_or(0.0, |row| row[0]), "the table"),
    };
    if end_s < last_s {
        let limit = format!("at least {last_s} s, the end of {which}");
        return Err(field.wrong(&limit, format!("write a later end, or shorten {which}")));
    }
    Ok(Some(end_s))
}

/// The factor of what `moved` says. Only the changes of a factor move a displacement, so it has to
/// begin at 0.
pub(super) fn factor_from_zero(table: &Table<'_>, moved: &Field<'_>) -> Result<Factor> {
    let factor = factor(table)?;
    let first = match &factor {
        Factor::Ramp { .. } => Some([0.0, 0.0]),
        Factor::Table(points) => points.first().copied(),
        Factor::One => None,
    };
    match (first, table.get("table")) {
        (None, _) => {
            let problem = format!(
                "{} stands without ramp and table, so at no time does anything move by it",
                moved.path
            );
            Err(moved.refuse(problem, "add ramp = \"0.1 s\", the time that it takes"))
        }
        (Some([time_s, first]), Some(field)) if first != 0.0 || time_s < 0.0 => {
            let problem = format!(
                "{} begins with a factor of {first} at {time_s} s, so {} would be followed in part only",
                field.path, moved.path
            );
            Err(field.refuse(problem, "begin it with a factor of 0, at 0 s or later"))
        }
        _ => Ok(factor),
    }
}

fn points(field: &Field<'_>) -> Result<Factor> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for item in field.items()? {
        let [time, factor] = item.row("[time, factor]")?;
        let time_s = time.quantity(&TIME)?;
        if let Some([before_s, _]) = points.last()
            && time_s <= *before_s
        {
            let limit = format!("more than the time before it, {before_s} s");
            return Err(time.wrong(&limit, "put the rows in the order of time"));
        }
        points.push([time_s, factor.quantity(&NUMBER)?]);
    }
    Ok(Factor::Table(points))
}
