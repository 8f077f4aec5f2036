//! Bodies and fragments that leave through outlets.

use crate::stages::clumps::synchronous;
use crate::stages::totals::synchronous_motions;
use crate::state::State;
use crate::state::clusters::fragments::mass_and_centre;
use crate::state::clusters::sizes::{Discharged, FragmentSize, size_of};
use crate::state::events::PopulationEvent;

/// Interval between checks of the outlets, in steps.
const OUTLET_EVERY: u64 = 50;

/// Clusters that have reached an outlet, in ascending order; records their removal.
pub(super) fn leaving(state: &mut State) -> Vec<u32> {
    let mut leaving = Vec::new();
    let every = OUTLET_EVERY.next_multiple_of(state.cycle());
    if state.model.rules.outlets.is_empty() || !state.steps.is_multiple_of(every) {
        return leaving;
    }
    let Some(clusters) = &state.clusters else {
        return leaving;
    };
    let outlets = &state.model.rules.outlets;
    for id in clusters.living() {
        let members = clusters.members(id);
        let carrier = members
            .first()
            .and_then(|&i| state.clumps.carrier_of(i as usize));
        let (mass_kg, place_m) = match carrier {
            Some(n) => {
                let clump = &state.clumps.all[n];
                (state.clumps.template(clump).mass_kg, clump.place_m)
            }
            None => {
                let (mass_kg, centre) = mass_and_centre(members, &state.particles);
                (mass_kg, centre.into())
            }
        };
        let goes = outlets.iter().position(|outlet| {
            let inside = state.model.rules.regions[outlet.region].contains(place_m);
            inside != outlet.removes_outside
        });
        let Some(n) = goes else {
            continue;
        };
        let removed = &mut state.population.outlets[n];
        removed.bodies += 1;
        removed.mass_kg += mass_kg;
        leaving.push(id);
        let size = size_of(id, clusters, &state.particles, &state.clumps);
        state.population.discharged.push(Discharged {
            time_s: state.scratch.events.time_s,
            fragment_id: id,
            outlet: n as u32,
            size: FragmentSize { mass_kg, ..size },
        });
        state.scratch.events.population.push(PopulationEvent::Left {
            cluster: id,
            body: state.model.body_name(size.body).to_owned(),
            outlet: outlets[n].name.clone(),
            mass_kg,
            place_m,
        });
    }
    if !leaving.is_empty() {
        book_leaving(state, &leaving);
    }
    leaving
}

/// Records mass, momenta and energy of the removed clusters: kinetic energy at the time of the
/// positions, and elastic energy of bonds.
fn book_leaving(state: &mut State, leaving: &[u32]) {
    let gravity = state.model.gravity_m_s2;
    let leaves = |id: u32| leaving.binary_search(&id).is_ok();
    let motions = synchronous_motions(state);
    let ids = state.clusters.as_ref().map(|c| c.of_particle.clone());
    let ids = ids.unwrap_or_default();
    for i in 0..state.particles.free {
        if !leaves(ids[i]) {
            continue;
        }
        let p = &state.particles;
        let motion = p.motions[i];
        let spin = motion.spin_rad_s.map(|w| w / motion.inverse_inertia);
        let kinetic_j = p.kinetic_j(i, &motions[i]);
        state.ledger.bring(
            -1.0,
            [1.0 / motion.inverse_mass, kinetic_j],
            [p.poses[i].place().into(), motion.velocity_m_s, spin],
            gravity,
        );
    }
    let bonds = &state.bonds;
    let poses = &state.particles.poses;
    let elastic_j: f64 = (0..bonds.len())
        .filter(|&at| !bonds.is_broken(at) && leaves(ids[bonds.ends[at][0] as usize]))
        .map(|at| bonds.forces(at, poses).energy.total())
        .sum();
    state.ledger.gain(-elastic_j);
    let now = synchronous(state);
    for (clump, now) in state.clumps.all.iter().zip(&now) {
        if leaves(clump.cluster) {
            let template = state.clumps.template(clump);
            state.ledger.bring(
                -1.0,
                [template.mass_kg, now.kinetic_j(template)],
                [clump.place_m, clump.velocity_m_s, clump.angular_momentum],
                gravity,
            );
        }
    }
}
