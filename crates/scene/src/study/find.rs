//! `[find]`: the parameter that is searched, and the points at which it is tried.

use std::path::Path;

use super::contents::{Average, Axis, Combine, Find, Study, StudyMeasure};
use super::keys::AVERAGES;
use super::values::{point, rounded, setting};
use crate::field::Field;
use crate::names::suggestion;
use crate::table::Table;
use crate::toml_text::split;
use crate::tree::Value;
use dem_io::diagnostic::Result;
use dem_io::units::significant;

/// Smallest tolerance over the larger end: points are rounded to six digits.
const FINEST: f64 = 1e-4;

/// The axis of the parameter, with the two ends as its values.
pub(super) fn axis(table: &Table<'_>, folder: &Path) -> Result<Axis> {
    let parameter = table.need("parameter")?;
    let path = parameter.text()?;
    let [from, to] = [table.need("from")?, table.need("to")?];
    // Refuses what is no path.
    setting(path, &from, folder)?;
    let (ends, unit) = ends(&from, &to)?;
    let place = parameter.document.place(parameter.node.origin);
    let values = ends.map(|end| point(path, end, &unit, &place)).into();
    Ok(Axis {
        name: path.to_owned(),
        place,
        values,
        named: false,
    })
}

/// Both ends, ascending, and their unit.
fn ends(from: &Field<'_>, to: &Field<'_>) -> Result<([f64; 2], String)> {
    let [(first, unit), (last, _)] = [number(from, None)?, number(to, None)?];
    number(to, Some(&unit))?;
    if first == last {
        let problem = format!("{} and {} are equal", from.path, to.path);
        return Err(to.refuse(problem, "give two ends between which the value is searched"));
    }
    Ok(([first.min(last), first.max(last)], unit))
}

/// A number and its unit, which must be `unit` if that is given.
fn number(field: &Field<'_>, unit: Option<&str>) -> Result<(f64, String)> {
    let (value, own) = split(field.node)
        .ok_or_else(|| field.wrong("a number", "write it with its unit, such as \"0.1 m\""))?;
    match unit {
        Some(unit) if unit != own => {
            let problem = format!("is {}, in another unit than find.from", field.shown());
            Err(field.fault(problem, "write from, to and tolerance in the same unit"))
        }
        _ => Ok((value, own)),
    }
}

/// Refuses pairs of values, and a mean over the parameter.
pub(super) fn refuse_pairs_and_means(
    table: &Table<'_>,
    combine: Combine,
    average_over: Option<usize>,
) -> Result<()> {
    if combine == Combine::Paired {
        let problem = "[find] has no effect on pairs of values";
        return Err(table.refuse(problem, "remove combine"));
    }
    if average_over == Some(0) {
        let problem = "average_over names the parameter of [find]";
        let remedy = "name what the scatter comes from, such as run.seed";
        return Err(table.refuse(problem, remedy));
    }
    Ok(())
}

/// The search of a study with these measures.
///
/// `cases`: number of searches, one for each combination of the values of the other axes.
pub(super) fn search(table: &Table<'_>, measures: &[StudyMeasure], cases: usize) -> Result<Find> {
    let (ends, unit) = ends(&table.need("from")?, &table.need("to")?)?;
    let tolerated = table.need("tolerance")?;
    let (tolerance, _) = number(&tolerated, Some(&unit))?;
    let least = FINEST * ends[0].abs().max(ends[1].abs());
    if tolerance < least {
        let limit = format!("at least {} {unit}", significant(least, 3));
        let remedy = "points are rounded to six digits: write a larger one";
        return Err(tolerated.wrong(limit.trim_end(), remedy));
    }
    let measure = measure_named(&table.need("measure")?, measures)?;
    let value = table.need("value")?;
    Ok(Find {
        measure,
        value: match &value.node.value {
            Value::Number(written, number) if number.is_finite() => written.clone(),
            Value::Text(text) => text.clone(),
            _ => return Err(value.wrong("a number", "write it with its unit, such as \"2 mm\"")),
        },
        statistic: statistic(table)?,
        ends,
        tolerance,
        unit,
        tried: vec![vec![0, 1]; cases],
        place: table.document.place(table.origin),
    })
}

/// The measure of the study that `named` names.
pub(super) fn measure_named(named: &Field<'_>, measures: &[StudyMeasure]) -> Result<usize> {
    let name = named.text()?;
    let measure = measures.iter().position(|measure| measure.name == name);
    measure.ok_or_else(|| {
        let problem = format!("is {}, but the study has no such measure", named.shown());
        named.fault(
            problem,
            suggestion(name, measures.iter().map(|m| m.name.as_str())),
        )
    })
}

impl Study {
    /// The points at which the parameter of `[find]` is tried in any case, in its unit: its ends,
    /// then those that were added.
    pub fn points(&self) -> Vec<f64> {
        let numbers = self.axes.first().and_then(Axis::numbers);
        numbers.map_or(Vec::new(), |(numbers, _)| numbers)
    }

    /// Adds a point at which the parameter of `[find]` is tried in a case, by its number in
    /// [`Study::cases`].
    pub fn add_point(&mut self, case: usize, number: f64) {
        let known = self.points().iter().position(|point| *point == number);
        if let (Some(find), Some(axis)) = (&mut self.find, self.axes.first_mut()) {
            let at = known.unwrap_or(axis.values.len());
            if known.is_none() {
                let added = point(&axis.name, number, &find.unit, &axis.place);
                axis.values.push(added);
            }
            if let Some(tried) = find.tried.get_mut(case) {
                tried.push(at);
            }
        }
    }

    /// The cases of `[find]`: for each, the index of the value on each axis, 0 for the parameter
    /// and for the axis that is averaged over. The last axis changes fastest.
    pub fn cases(&self) -> Vec<Vec<usize>> {
        let lengths = self.axes.iter().enumerate().map(|(at, axis)| {
            let is_of_case = at > 0 && Some(at) != self.average_over;
            if is_of_case { axis.values.len() } else { 1 }
        });
        let mut cases = vec![Vec::new()];
        for length in lengths {
            let longer = |case: &Vec<usize>| {
                let case = case.clone();
                (0..length).map(move |at| [&case[..], &[at]].concat())
            };
            cases = cases.iter().flat_map(longer).collect();
        }
        cases
    }
}

impl Find {
    /// The middle between two points, rounded to six digits.
    pub fn middle(low: f64, high: f64) -> f64 {
        rounded(f64::midpoint(low, high))
    }
}

/// `statistic` of a study or of its `[find]`.
pub(super) fn statistic(table: &Table<'_>) -> Result<Average> {
    let given = table.read_by("statistic", |field| field.choice(&AVERAGES))?;
    Ok(given.unwrap_or(Average::Mean))
}
