//! Errors: what the values of a measure are compared with, and how far they are off.

use std::collections::BTreeMap;

use dem_io::scene::study::{MeasureOf, Reference, Study};
use dem_io::units::significant;

use super::curves;
use super::expand::{Run, group};
use super::masses::{by_chance, distance};
use super::outcome::Done;
use super::reference::{Extrapolated, richardson};
use super::rows::{Judged, Row};

/// Finds the references of one measure, and from them the errors.
pub fn judge(
    study: &Study,
    runs: &[Run],
    done: &[Option<&Done>],
    measure: usize,
    value: Option<f64>,
    rows: &mut [Row],
    notes: &mut Vec<String>,
) {
    let of = &study.measures[measure];
    let along = match of.reference {
        Reference::Finest(along) | Reference::Richardson(along) => along,
        Reference::ClosedForm | Reference::Value(_) => {
            for (row, done) in rows.iter_mut().zip(done) {
                let own = done.and_then(|done| done.readings[measure].closed_form);
                let reference = match of.reference {
                    Reference::Value(_) => value,
                    _ => own,
                };
                if let (Some(judged), Some(reference)) = (row.results.get_mut(measure), reference) {
                    set_error(judged, reference, None);
                }
            }
            return;
        }
    };
    let sizes = study.axes[along].sizes().unwrap_or_default();
    let size = |run: &Run| sizes[run.choice[along]];
    let mut groups: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (at, run) in runs.iter().enumerate() {
        groups.entry(group(study, run, along)).or_default().push(at);
    }
    for members in groups.values() {
        let named = |at: usize| runs[at].labels(study).join(", ");
        if let Reference::Finest(_) = of.reference {
            let finest = members
                .iter()
                .copied()
                .min_by(|&a, &b| size(&runs[a]).total_cmp(&size(&runs[b])));
            let Some(finest) = finest else { continue };
            let Some(reference) = rows[finest].results.get(measure).map(|j| j.value) else {
                notes.push(format!(
                    "{}: the finest run failed ({}), so others have nothing to be compared with",
                    of.name,
                    named(finest)
                ));
                continue;
            };
            for &at in members {
                if let Some(judged) = rows[at].results.get_mut(measure) {
                    judged.is_reference = at == finest;
                    if at == finest {
                        continue;
                    }
                    set_error(judged, reference, None);
                    let [Some(own), Some(other)] = [done[at], done[finest]] else {
                        continue;
                    };
                    let [own, other] = [own, other].map(|done| &done.readings[measure]);
                    match of.of {
                        MeasureOf::Masses(_) => {
                            let [own, other] = [own, other].map(|reading| &reading.masses_kg);
                            judged.error = Some(distance(own, other, |_| 1.0));
                            judged.uncertainty = Some(by_chance(own.len(), other.len()));
                        }
                        MeasureOf::Curve => {
                            judged.error = Some(curves::distance(&own.curve, &other.curve));
                        }
                        _ => {}
                    }
                }
                let [own_s, finest_s] = [rows[at].time_s, rows[finest].time_s];
                if let (Some(judged), [Some(own_s), Some(finest_s)]) =
                    (rows[at].results.get_mut(measure), [own_s, finest_s])
                {
                    judged.times_as_fast = Some(finest_s / own_s);
                }
            }
            continue;
        }
        let points: Vec<(f64, f64)> = members
            .iter()
            .filter_map(|&at| {
                Some((
                    rows[at].size(study, along)?,
                    rows[at].results.get(measure)?.value,
                ))
            })
            .collect();
        let Some(Extrapolated {
            value,
            uncertainty,
            doubt,
            ..
        }) = richardson(&points)
        else {
            if let Some(&first) = members.first() {
                notes.push(format!(
                    "{}: fewer than three runs along {} came to their end ({}): nothing to extrapolate from",
                    of.name,
                    study.axes[along].name,
                    named(first)
                ));
            }
            continue;
        };
        if let (Some(doubt), Some(&first)) = (doubt, members.first()) {
            notes.push(format!(
                "{}: no extrapolation along {} ({}): {}; compared with the finest run, good to {}",
                of.name,
                study.axes[along].name,
                named(first),
                doubt.text(),
                significant(uncertainty, 2)
            ));
        }
        for &at in members {
            if let Some(judged) = rows[at].results.get_mut(measure) {
                set_error(judged, value, Some(uncertainty));
            }
        }
    }
}

fn set_error(judged: &mut Judged, reference: f64, uncertainty: Option<f64>) {
    let scale = if reference == 0.0 {
        1.0
    } else {
        reference.abs()
    };
    judged.reference = Some(reference);
    judged.error = Some((judged.value - reference).abs() / scale);
    judged.uncertainty = uncertainty.map(|uncertainty| uncertainty / scale);
}

/// What a measure is compared with, in words.
pub fn in_words(study: &Study, measure: usize) -> String {
    let measure = &study.measures[measure];
    match (&measure.of, &measure.reference) {
        (MeasureOf::Ledger(_), _) => "an error by itself".to_owned(),
        (MeasureOf::Figure(_), Reference::ClosedForm) => "the theory of the test".to_owned(),
        (_, Reference::ClosedForm) => "the reference of the scene".to_owned(),
        (_, Reference::Value(text)) => text.clone(),
        (MeasureOf::Masses(_), Reference::Finest(at)) => format!(
            "the masses of the finest run along {} (distance of Kolmogorov and Smirnov, by number; below its uncertainty it is chance)",
            study.axes[*at].name
        ),
        (MeasureOf::Curve, Reference::Finest(at)) => format!(
            "the curve of the finest run along {} (area between the curves over the area under that one)",
            study.axes[*at].name
        ),
        (_, Reference::Finest(at)) => format!("the finest run along {}", study.axes[*at].name),
        (_, Reference::Richardson(at)) => {
            format!("Richardson extrapolation along {}", study.axes[*at].name)
        }
    }
}
