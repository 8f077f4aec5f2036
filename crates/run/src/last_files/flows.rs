//! Masses of each body that inlets feed and outlets remove: their balance, and flows over time.

use std::collections::BTreeMap;

use dem_io::body::mass::BodyMass;
use dem_results::FlowRow;
use dem_results::summary::BodyFlow;

use dem_engine::state::State;
use dem_engine::state::clusters::sizes::mass_kg_of;
use dem_engine::state::clusters::{Cluster, Clusters};

/// Masses of all bodies, by name. `masses`: of the bodies of the scene. None: nothing comes or
/// goes.
pub(crate) fn body_flows(
    state: &State,
    masses: &BTreeMap<String, BodyMass>,
) -> Option<BTreeMap<String, BodyFlow>> {
    let rules = &state.model.rules;
    let clusters = state.clusters.as_ref()?;
    if !rules.have_flows() {
        return None;
    }
    let fed_kg = fed_kg(state);
    let mut flows = vec![BodyFlow::default(); state.model.bodies.len()];
    for (number, flow) in (0..).zip(&mut flows) {
        let name = state.model.body_name(number);
        // Daughters have parents.
        let mut own = clusters
            .history
            .iter()
            .filter(|cluster| cluster.body == number);
        if fed_kg[number as usize].is_none() && own.any(|cluster| cluster.parent.is_none()) {
            flow.start_kg = masses.get(name).map_or(0.0, |mass| mass.mass_kg);
        }
        for outlet in &rules.outlets {
            flow.discharged_kg.insert(outlet.name.clone(), 0.0);
        }
    }
    for (_, body, mass_kg) in fed(clusters, &fed_kg) {
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
        let mass_kg = mass_kg_of(id, clusters, &state.particles, &state.clumps);
        flows[clusters.history[id as usize].body as usize].inside_kg += mass_kg;
    }
    let templates = state.clumps.templates.iter();
    for (template, fines_kg) in templates.zip(&state.population.fines_kg) {
        flows[state.model.body_number(&template.body) as usize].fines_kg += fines_kg;
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
        let missing_kg = flow.start_kg + flow.fed_kg - gone_kg - flow.inside_kg - flow.fines_kg;
        flow.missing_kg = (!mixes).then_some(missing_kg);
    }
    let names = state.model.bodies.iter().map(|body| body.name.clone());
    Some(names.zip(flows).collect())
}

/// For each body its mass if inlets feed it, kg: then none is there at the start.
fn fed_kg(state: &State) -> Vec<Option<f64>> {
    let mut found = vec![None; state.model.bodies.len()];
    let inlets = state.model.rules.inlets.iter();
    for (template, _) in inlets.flat_map(|inlet| &inlet.templates) {
        let template = &state.clumps.templates[*template as usize];
        let body = state.model.body_number(&template.body) as usize;
        found[body] = Some(template.mass_kg);
    }
    found
}

/// Time, s, body and mass, kg, of each body that an inlet has fed, in order.
fn fed<'a>(
    clusters: &'a Clusters,
    fed_kg: &'a [Option<f64>],
) -> impl Iterator<Item = (f64, u32, f64)> + 'a {
    let come = clusters.history.iter();
    let come = come.filter(|cluster| cluster.parent.is_none());
    come.filter_map(|cluster| {
        let mass_kg = fed_kg[cluster.body as usize]?;
        Some((cluster.created_s, cluster.body, mass_kg))
    })
}

/// Numbers of a body and of the outlet through which it has left. None: inlets have fed it.
type BodyAndOutlet = (u32, Option<u32>);

/// Masses fed and discharged in intervals of `interval_s` up to `end_s`, s: for each body what
/// inlets have fed, and for each outlet what has left through it.
pub(crate) fn flow_rows(state: &State, interval_s: f64, end_s: f64) -> Vec<FlowRow<'_>> {
    let outlets = &state.model.rules.outlets;
    let mut events: BTreeMap<BodyAndOutlet, Vec<(f64, f64)>> = BTreeMap::new();
    let clusters = state.clusters.iter();
    let fed_kg = fed_kg(state);
    for (time_s, body, mass_kg) in clusters.flat_map(|clusters| fed(clusters, &fed_kg)) {
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
