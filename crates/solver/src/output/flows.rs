//! Masses of each body that inlets feed and outlets remove: their balance, and flows over time.

use std::collections::BTreeMap;

use dem_io::body::mass::BodyMass;
use dem_results::FlowRow;
use serde::Serialize;

use crate::state::State;
use crate::state::clusters::Cluster;
use crate::state::clusters::sizes::size_of;

/// Where the mass of a body is at the end of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct BodyFlow {
    /// Mass at the start, kg.
    pub start_kg: f64,
    /// Bodies fed by inlets.
    pub fed: u32,
    /// Their mass, kg.
    pub fed_kg: f64,
    /// Bodies and fragments discharged through each outlet, by its name, kg.
    pub discharged_kg: BTreeMap<String, f64>,
    /// Mass of the bodies and fragments inside, kg.
    pub inside_kg: f64,
    /// At the start and fed, less discharged and inside, kg: 0, to rounding. None: daughters of other
    /// bodies have replaced bodies, and their mass counts as that of their own body.
    pub missing_kg: Option<f64>,
}

/// Those of all bodies, by name. `masses`: of the bodies of the scene. None: nothing comes or goes.
pub(crate) fn body_flows(
    state: &State,
    masses: &BTreeMap<String, BodyMass>,
) -> Option<BTreeMap<String, BodyFlow>> {
    let rules = &state.model.rules;
    let clusters = state.clusters.as_ref()?;
    if rules.inlets.is_empty() && rules.outlets.is_empty() {
        return None;
    }
    let mut flows = vec![BodyFlow::default(); state.model.bodies.len()];
    for (number, flow) in (0..).zip(&mut flows) {
        let name = state.model.body_name(number);
        // Daughters have parents.
        let mut own = clusters
            .history
            .iter()
            .filter(|cluster| cluster.body == number);
        if !is_fed(state, name) && own.any(|cluster| cluster.parent.is_none()) {
            flow.start_kg = masses.get(name).map_or(0.0, |mass| mass.mass_kg);
        }
        for outlet in &rules.outlets {
            flow.discharged_kg.insert(outlet.name.clone(), 0.0);
        }
    }
    for (_, body, mass_kg) in fed(state) {
        let flow = &mut flows[body as usize];
        flow.fed += 1;
        flow.fed_kg += mass_kg;
    }
    for gone in &state.population.discharged {
        let outlet = &rules.outlets[gone.outlet as usize].name;
        if let Some(sum) = flows[gone.size.body as usize].discharged_kg.get_mut(outlet) {
            *sum += gone.size.mass_kg;
        }
    }
    for id in clusters.living() {
        let size = size_of(id, clusters, &state.particles, &state.clumps);
        flows[size.body as usize].inside_kg += size.mass_kg;
    }
    let history = &clusters.history;
    let is_of_other = |cluster: &Cluster| {
        let parent = cluster
            .parent
            .and_then(|parent| history.get(parent as usize));
        parent.is_some_and(|parent| parent.body != cluster.body)
    };
    let mixes = history.iter().any(is_of_other);
    for flow in &mut flows {
        let gone_kg: f64 = flow.discharged_kg.values().sum();
        let missing_kg = flow.start_kg + flow.fed_kg - gone_kg - flow.inside_kg;
        flow.missing_kg = (!mixes).then_some(missing_kg);
    }
    let names = state.model.bodies.iter().map(|body| body.name.clone());
    Some(names.zip(flows).collect())
}

/// Whether an inlet feeds bodies of this name: then none is there at the start.
fn is_fed(state: &State, body: &str) -> bool {
    let mut fed = state
        .model
        .rules
        .inlets
        .iter()
        .flat_map(|inlet| &inlet.templates);
    fed.any(|(template, _)| state.clumps.templates[*template as usize].body == body)
}

/// Time, s, body and mass, kg, of each body that an inlet has fed, in order.
fn fed(state: &State) -> Vec<(f64, u32, f64)> {
    let history = state.clusters.iter().flat_map(|clusters| &clusters.history);
    let come = history.filter(|cluster| cluster.parent.is_none());
    let templates = &state.clumps.templates;
    let of_body = |cluster: &Cluster| {
        let name = state.model.body_name(cluster.body);
        let template = templates.iter().find(|template| template.body == name)?;
        is_fed(state, name).then_some((cluster.created_s, cluster.body, template.mass_kg))
    };
    come.filter_map(of_body).collect()
}

/// Numbers of a body and of the outlet through which it has left. None: inlets have fed it.
type BodyAndOutlet = (u32, Option<u32>);

/// Masses fed and discharged in intervals of `interval_s` up to `end_s`, s: for each body what
/// inlets have fed, and for each outlet what has left through it.
pub(crate) fn flow_rows(state: &State, interval_s: f64, end_s: f64) -> Vec<FlowRow<'_>> {
    let outlets = &state.model.rules.outlets;
    let mut events: BTreeMap<BodyAndOutlet, Vec<(f64, f64)>> = BTreeMap::new();
    for (time_s, body, mass_kg) in fed(state) {
        events
            .entry((body, None))
            .or_default()
            .push((time_s, mass_kg));
    }
    for gone in &state.population.discharged {
        let of = events
            .entry((gone.size.body, Some(gone.outlet)))
            .or_default();
        of.push((gone.time_s, gone.size.mass_kg));
    }
    let count = (end_s / interval_s * (1.0 - 1e-9)).ceil().max(1.0) as u32;
    let mut rows = Vec::new();
    let mut totals = vec![(0, 0.0); events.len()];
    for number in 0..count {
        let from_s = f64::from(number) * interval_s;
        let is_last = number + 1 == count;
        let to_s = if is_last { end_s } else { from_s + interval_s };
        for ((&(body, outlet), events), total) in events.iter().zip(&mut totals) {
            let (mut pieces, mut mass_kg): (usize, f64) = *total;
            let due = events[pieces..].iter();
            for (_, kg) in due.take_while(|(time_s, _)| is_last || *time_s <= to_s) {
                pieces += 1;
                mass_kg += kg;
            }
            let outlet = outlet.and_then(|outlet| outlets.get(outlet as usize));
            rows.push(FlowRow {
                time_s: to_s,
                body: state.model.body_name(body),
                outlet: outlet.map_or("", |outlet| outlet.name.as_str()),
                pieces,
                mass_kg,
                flow_kg_s: (mass_kg - total.1) / (to_s - from_s),
            });
            *total = (pieces, mass_kg);
        }
    }
    rows
}
