//! Observed orders: the power of the size with which errors decrease.

use std::collections::BTreeMap;

use dem_scene::study::{Reference, Study};

use super::expand::{Run, group};
use super::reference::{observed_order, richardson};
use super::row::Row;
use super::sweep_table::Order;

/// Smallest number of runs for an order.
const FEWEST: usize = 3;

/// For each measure, along each axis with sizes. Errors below the uncertainty of their reference
/// are not significant and are left out.
pub(crate) fn orders(study: &Study, runs: &[Run], rows: &[Row]) -> Vec<Order> {
    let mut found = Vec::new();
    for (measure, of) in study.measures.iter().enumerate() {
        for (along, axis) in study.axes.iter().enumerate() {
            if axis.sizes().is_none() {
                continue;
            }
            let mut groups: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
            for (at, run) in runs.iter().enumerate() {
                groups.entry(group(study, run, along)).or_default().push(at);
            }
            for members in groups.values() {
                let results = members.iter().filter_map(|&at| {
                    Some((rows[at].size(study, along)?, rows[at].results.get(measure)?))
                });
                let by_values = of.reference == Reference::Richardson(along);
                let points: Vec<(f64, f64)> = if by_values {
                    results.map(|(size, judged)| (size, judged.value)).collect()
                } else {
                    results
                        .filter_map(|(size, judged)| {
                            Some((size, judged.error?, judged.uncertainty))
                        })
                        .filter(|(_, error, uncertainty)| *error > uncertainty.unwrap_or(0.0))
                        .map(|(size, error, _)| (size, error))
                        .collect()
                };
                let order = if by_values {
                    richardson(&points).and_then(|found| found.order)
                } else {
                    observed_order(&points).filter(|_| points.len() >= FEWEST)
                };
                if let (Some(order), Some(&first)) = (order, members.first()) {
                    let mut others = runs[first].labels(study);
                    if group(study, &runs[first], along).is_empty() {
                        others.clear();
                    } else {
                        others.remove(along);
                    }
                    found.push(Order {
                        measure: of.name.clone(),
                        along: axis.name.clone(),
                        of: others,
                        order,
                        runs: points.len(),
                        by: if by_values { "values" } else { "errors" }.to_owned(),
                    });
                }
            }
        }
    }
    found
}
