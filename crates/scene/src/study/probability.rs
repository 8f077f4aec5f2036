//! `[probability]`: the outcome of runs, and the parameter over which it is shown.

use super::contents::{Axis, Combine, Probability, StudyMeasure};
use super::find::measure_named;
use super::keys::{PROBABILITY, SPACINGS};
use super::measures::axis_named;
use crate::field::Field;
use crate::root::SCENE;
use crate::schema::Key;
use crate::table::Table;
use crate::tree::Value;
use dem_io::diagnostic::Result;

/// Reads the table of a study with these axes and measures.
pub(super) fn read(
    field: &Field<'_>,
    combine: Combine,
    average_over: Option<usize>,
    axes: &[Axis],
    measures: &[StudyMeasure],
) -> Result<Probability> {
    let table = Table::of(field, &PROBABILITY)?;
    if combine == Combine::Paired {
        let problem = "[probability] has no effect on pairs of values";
        return Err(table.refuse(problem, "remove combine"));
    }
    let measure = measure_named(&table.need("of")?, measures)?;
    let one = "a run has one outcome: remove one of them";
    let Some((limit, value)) = table.at_most_one(&["below", "above"], one)? else {
        let remedy = "add below = 0.9, say, or above: of which values is the probability?";
        return Err(table.fault("has no limit", remedy));
    };
    let is_log = table.read_by("spacing", |field| field.choice(&SPACINGS))?;
    let is_log = is_log.unwrap_or(false);
    let named = table.need("over")?;
    let over = axis_named(&named, axes)?;
    if average_over == Some(over) {
        let problem = format!("is {}, which average_over names", named.shown());
        let remedy = "name a parameter here, and in average_over what chance comes from";
        return Err(named.fault(problem, remedy));
    }
    refuse_axis(&named, &axes[over], is_log)?;
    Ok(Probability {
        measure,
        limit: match &value.node.value {
            Value::Number(written, number) if number.is_finite() => written.clone(),
            Value::Text(text) => text.clone(),
            _ => return Err(value.wrong("a number", "write it with its unit, such as \"2 mm\"")),
        },
        is_below: limit == "below",
        over,
        is_log,
        is_never_negative: SCENE
            .key_at(&axes[over].name)
            .is_some_and(Key::is_never_negative),
        place: table.document.place(table.origin),
    })
}

/// Refuses an axis over which there is no curve.
fn refuse_axis(named: &Field<'_>, axis: &Axis, is_log: bool) -> Result<()> {
    let Some((numbers, _)) = axis.numbers() else {
        let problem = format!(
            "is {}, whose values are not numbers in one unit",
            named.shown()
        );
        return Err(named.fault(problem, "name a parameter with such values"));
    };
    if numbers.iter().all(|number| *number == numbers[0]) {
        let problem = format!("is {}, which has one value", named.shown());
        return Err(named.fault(problem, "let it vary, best with five values or more"));
    }
    if let Some(number) = numbers.iter().find(|number| is_log && **number <= 0.0) {
        let problem = format!("is {}, which is {number} in some runs", named.shown());
        return Err(named.fault(problem, "it has no logarithm: write spacing = \"linear\""));
    }
    Ok(())
}
