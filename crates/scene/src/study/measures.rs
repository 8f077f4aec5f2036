//! The measures of each run, and their references.

use super::contents::{
    Axis, BALANCES, CURVES, DischargeFigure, MeasureOf, Pieces, RUN_RESULTS, Reference, RunTime,
    StudyMeasure,
};
use super::keys::{MEASURE, REFERENCE};
use crate::field::Field;
use crate::names::suggestion;
use crate::schema::Word;
use crate::table::Table;
use crate::tree::Value;
use dem_io::diagnostic::Result;

pub(super) fn axis_named(field: &Field<'_>, axes: &[Axis]) -> Result<usize> {
    let name = field.text()?;
    axes.iter()
        .position(|axis| axis.name == name)
        .ok_or_else(|| {
            let problem = format!("is {}, which does not vary", field.shown());
            field.fault(
                problem,
                suggestion(name, axes.iter().map(|axis| axis.name.as_str())),
            )
        })
}

pub(super) fn measure(name: &str, field: &Field<'_>, axes: &[Axis]) -> Result<StudyMeasure> {
    let table = Table::of(field, &MEASURE)?;
    let kinds = [
        "measure",
        "test_result",
        "fragment_masses",
        "curve",
        "balance",
        "run_result",
        "discharge",
        "run_time",
    ];
    let one = "a measure is of one of them: remove the other";
    let of = match table.at_most_one(&kinds, one)? {
        None => MeasureOf::Measure(name.to_owned()),
        Some(("measure", field)) => MeasureOf::Measure(field.text()?.to_owned()),
        Some(("test_result", field)) => MeasureOf::Figure(field.text()?.to_owned()),
        Some(("fragment_masses", field)) => MeasureOf::Masses(field.choice(Pieces::WORDS)?),
        Some(("curve", field)) => {
            field.choice(&CURVES)?;
            MeasureOf::Curve
        }
        Some(("balance", field)) => MeasureOf::Balance(field.choice(&BALANCES)?),
        Some(("run_result", field)) => {
            field.choice(&RUN_RESULTS)?;
            MeasureOf::RunResult(field.text()?.to_owned())
        }
        Some(("discharge", field)) => discharge(&table, &field)?,
        Some((_, field)) => MeasureOf::RunTime(field.choice(RunTime::WORDS)?),
    };
    if !matches!(of, MeasureOf::Discharge(..)) {
        for key in ["outlet", "sieve"] {
            if let Some(field) = table.get(key) {
                let problem = "is given without discharge, to which it belongs";
                return Err(field.fault(problem, "add discharge = \"mass\" or another figure"));
            }
        }
    }
    let reference = match table.get("reference") {
        Some(field) if matches!(of, MeasureOf::Balance(_)) => {
            let problem = "is given for a balance, whose error is compared with 0";
            return Err(field.fault(problem, "it is an error by itself: remove reference"));
        }
        Some(field) if matches!(of, MeasureOf::RunTime(_)) => {
            let problem = "is given for a run time, which has none";
            return Err(field.fault(problem, "remove reference"));
        }
        Some(field) => reference(&field, axes)?,
        None => match of {
            MeasureOf::Balance(_) => Reference::ClosedForm,
            MeasureOf::Measure(_) => Reference::IfAny,
            MeasureOf::Figure(_)
            | MeasureOf::Masses(_)
            | MeasureOf::Curve
            | MeasureOf::RunResult(_)
            | MeasureOf::Discharge(..)
            | MeasureOf::RunTime(_) => Reference::None,
        },
    };
    if let (MeasureOf::Masses(_) | MeasureOf::Curve, false) = (
        &of,
        matches!(reference, Reference::Finest(_) | Reference::None),
    ) {
        let remedy = "write reference = { finest = \"AXIS\" }, or \"none\"";
        return Err(field.fault("has no run to be compared with", remedy));
    }
    Ok(StudyMeasure {
        name: name.to_owned(),
        of,
        reference,
        place: field.document.place(field.node.origin),
    })
}

/// The figure of what left that the key `discharge` asks for.
fn discharge(table: &Table<'_>, field: &Field<'_>) -> Result<MeasureOf> {
    let figure = field.choice(&DischargeFigure::WORDS)?;
    let sieve_m: Option<f64> = table.read("sieve")?;
    let figure = match (figure, sieve_m) {
        (DischargeFigure::Passing(_), Some(opening_m)) => DischargeFigure::Passing(opening_m),
        (DischargeFigure::Passing(_), None) => {
            let problem = "is \"passing\", but there is no sieve beside it";
            return Err(field.fault(problem, "add sieve = \"20 mm\", its opening"));
        }
        (_, Some(_)) => {
            let problem = "needs no sieve, which is beside it";
            return Err(field.fault(problem, "remove sieve, or write discharge = \"passing\""));
        }
        (other, None) => other,
    };
    let outlet = table.get("outlet");
    let outlet = outlet.map(|field| field.text().map(str::to_owned));
    Ok(MeasureOf::Discharge(figure, outlet.transpose()?))
}

fn reference(field: &Field<'_>, axes: &[Axis]) -> Result<Reference> {
    if let Value::Text(word) = &field.node.value {
        let with_size: Vec<usize> = (0..axes.len())
            .filter(|at| axes[*at].sizes().is_some())
            .collect();
        return match (word.as_str(), with_size.as_slice()) {
            ("none", _) => Ok(Reference::None),
            ("closed-form", _) => Ok(Reference::ClosedForm),
            ("finest", [only]) => Ok(Reference::Finest(*only)),
            ("richardson", [only]) => richardson(field, *only, axes),
            ("finest" | "richardson", _) => {
                let problem = format!("is \"{word}\", but {} axes have sizes", with_size.len());
                let remedy = format!("say along which: {{ {word} = \"AXIS\" }}");
                Err(field.fault(problem, remedy))
            }
            _ => Err(field.wrong(
                "\"none\", \"closed-form\", \"finest\", \"richardson\" or a table",
                "write a number as { value = \"2 mm\" }",
            )),
        };
    }
    let table = Table::of(field, &REFERENCE)?;
    let given: Vec<_> = table.given(&["value", "finest", "richardson"]).collect();
    let [(kind, named)] = given.as_slice() else {
        let problem = format!("names {} references", given.len());
        return Err(field.fault(problem, "name one: value, finest or richardson"));
    };
    if *kind == "value" {
        return match &named.node.value {
            Value::Number(written, value) if value.is_finite() => {
                Ok(Reference::Value(written.clone()))
            }
            Value::Text(text) => Ok(Reference::Value(text.clone())),
            _ => Err(named.wrong("a number", "write it with its unit, such as \"2 mm\"")),
        };
    }
    let at = axis_named(named, axes)?;
    if axes[at].sizes().is_none() {
        let problem = format!("is {}, whose values have no size above 0", named.shown());
        let remedy = "add size = [...], how coarse each of its values is";
        return Err(named.fault(problem, remedy));
    }
    if *kind == "finest" {
        Ok(Reference::Finest(at))
    } else {
        richardson(named, at, axes)
    }
}

/// Checks that there are three different sizes, which are needed to see an order.
fn richardson(field: &Field<'_>, at: usize, axes: &[Axis]) -> Result<Reference> {
    let mut sizes = axes[at].sizes().unwrap_or_default();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    if sizes.len() < 3 {
        let problem = format!(
            "{}: {} has {} sizes, but Richardson extrapolation needs 3",
            field.path,
            axes[at].name,
            sizes.len()
        );
        return Err(field.refuse(problem, "let it vary further, or write \"finest\""));
    }
    Ok(Reference::Richardson(at))
}
