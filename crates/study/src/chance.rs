//! What makes the scatter of a study mean less than it seems to.

use dem_scene::study::Study;

use super::response::Response;

/// Sentences on an averaged axis that changes nothing, and on values that an axis has twice.
pub(crate) fn notes(study: &Study, responses: &[Response]) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(axis) = study.average_over.and_then(|at| study.axes.get(at)) {
        let points = || responses.iter().flat_map(|response| &response.points);
        let several = points().filter(|point| point.values.len() > 1);
        let are_equal = |values: &[f64]| values.windows(2).all(|two| two[0] == two[1]);
        if several.clone().count() > 0 && several.clone().all(|point| are_equal(&point.values)) {
            notes.push(format!(
                "{} changes no value of any measure: nothing in these runs depends on it, and their scatter of 0 is no uncertainty",
                axis.name
            ));
        }
    }
    for axis in &study.axes {
        let labels = axis.values.iter().map(|value| value.label.as_str());
        let labels: Vec<&str> = labels.collect();
        let twice = (0..labels.len()).find(|at| labels[..*at].contains(&labels[*at]));
        if let Some(at) = twice {
            notes.push(format!(
                "{} has the value {} more than once: equal runs count as separate ones, and make the scatter too small",
                axis.name, labels[at]
            ));
        }
    }
    notes
}
