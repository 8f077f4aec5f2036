//! Errors: the references of the values of a measure, and the deviations from them.

use std::collections::BTreeMap;

use dem_io::units::significant;
use dem_scene::study::{MeasureOf, Reference, Study};

use super::expand::{Run, group};
use super::masses::{by_chance, distance};
use super::outcome::Done;
use super::reference::{Extrapolated, richardson};
use super::row::{Judged, Row};
use dem_laboratory::area_between;

/// Determines the references of one measure, and from them the errors.
pub(crate) fn judge(
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
        Reference::None => return,
        Reference::IfAny | Reference::ClosedForm | Reference::Value(_) => {
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
        let group = Group {
            study,
            runs,
            done,
            measure,
            members,
        };
        match of.reference {
            Reference::Finest(_) => {
                let finest = members.iter().copied();
                let finest = finest.min_by(|&a, &b| size(&runs[a]).total_cmp(&size(&runs[b])));
                if let Some(finest) = finest {
                    group.compare_with(finest, rows, notes);
                }
            }
            _ => group.extrapolate(along, rows, notes),
        }
    }
}

/// Runs that differ along one axis only.
struct Group<'a> {
    study: &'a Study,
    runs: &'a [Run],
    done: &'a [Option<&'a Done>],
    measure: usize,
    /// Indices of its runs, from 0.
    members: &'a [usize],
}

impl Group<'_> {
    fn named(&self, at: usize) -> String {
        self.runs[at].labels(self.study).join(", ")
    }

    /// Compares all runs with the finest of them.
    fn compare_with(&self, finest: usize, rows: &mut [Row], notes: &mut Vec<String>) {
        let of = &self.study.measures[self.measure];
        let Some(reference) = rows[finest].results.get(self.measure).map(|j| j.value) else {
            notes.push(format!(
                "{}: the finest run failed ({}), so others have nothing to be compared with",
                of.name,
                self.named(finest)
            ));
            return;
        };
        for &at in self.members {
            if let Some(judged) = rows[at].results.get_mut(self.measure) {
                judged.is_reference = at == finest;
                if at == finest {
                    continue;
                }
                set_error(judged, reference, None);
                let [Some(own), Some(other)] = [self.done[at], self.done[finest]] else {
                    continue;
                };
                let [own, other] = [own, other].map(|done| &done.readings[self.measure]);
                match of.of {
                    MeasureOf::Masses(_) => {
                        let [own, other] = [own, other].map(|reading| &reading.masses_kg);
                        judged.error = Some(distance(own, other, |_| 1.0));
                        judged.uncertainty = Some(by_chance(own.len(), other.len()));
                    }
                    MeasureOf::Curve => {
                        judged.error = Some(area_between(&own.curve, &other.curve));
                    }
                    _ => {}
                }
            }
            let [own_s, finest_s] = [rows[at].time_s, rows[finest].time_s];
            if let (Some(judged), [Some(own_s), Some(finest_s)]) =
                (rows[at].results.get_mut(self.measure), [own_s, finest_s])
            {
                judged.times_as_fast = Some(finest_s / own_s);
            }
        }
    }

    /// Compares all runs with the value to which they converge (Richardson).
    fn extrapolate(&self, along: usize, rows: &mut [Row], notes: &mut Vec<String>) {
        let (study, measure, members) = (self.study, self.measure, self.members);
        let of = &study.measures[measure];
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
            warning,
            ..
        }) = richardson(&points)
        else {
            if let Some(&first) = members.first() {
                notes.push(format!(
                    "{}: fewer than three runs along {} came to their end ({}): nothing to extrapolate from",
                    of.name,
                    study.axes[along].name,
                    self.named(first)
                ));
            }
            return;
        };
        if let (Some(warning), Some(&first)) = (warning, members.first()) {
            notes.push(format!(
                "{}: no extrapolation along {} ({}): {}; compared with the finest run, good to {}",
                of.name,
                study.axes[along].name,
                self.named(first),
                warning.text(),
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

/// The reference of a measure, as text. None if it has none.
pub(crate) fn in_words(study: &Study, measure: usize) -> Option<String> {
    let measure = &study.measures[measure];
    Some(match (&measure.of, &measure.reference) {
        (_, Reference::None) => return None,
        (MeasureOf::Balance(_), _) => "an error by itself".to_owned(),
        (MeasureOf::Figure(_), Reference::ClosedForm) => "the target of the test".to_owned(),
        (_, Reference::IfAny | Reference::ClosedForm) => "the reference of the scene".to_owned(),
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
    })
}
