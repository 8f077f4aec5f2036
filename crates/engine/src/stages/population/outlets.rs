//! Bodies and fragments that leave through outlets.

use nalgebra::Vector3;

use crate::stages::clumps::motion::synchronous;
use crate::stages::ledger::totals::synchronous_motions;
use crate::state::State;
use crate::state::clusters::fragments::mass_and_centre;
use crate::state::clusters::sizes::{Discharged, FragmentSize, size_of};
use crate::state::events::PopulationEvent;
use crate::state::population::OutletWatch;
use crate::state::rules::Outlet;

/// Clusters nearer to the border of an outlet than the fastest point may move in this many steps
/// are looked at in each step, the others again once something can have moved as far.
const STEPS_AHEAD: f64 = 50.0;
/// The same as a fraction of the size of the region, for bodies that hardly move.
const NEAR: f64 = 1e-3;

/// Clusters that have reached an outlet, or will have passed through it after the coming drift, in
/// ascending order; records their removal.
pub(super) fn leaving(state: &mut State) -> Vec<u32> {
    if state.model.rules.outlets.is_empty() || state.clusters.is_none() {
        return Vec::new();
    }
    let mut watch = std::mem::take(&mut state.scratch.outlets);
    follow(&mut watch, state);
    let mut leaving = Vec::new();
    for &id in &watch.near {
        let Some(piece) = piece(id, state) else {
            continue;
        };
        let outlets = state.model.rules.outlets.iter();
        let mut numbered = outlets.enumerate();
        let goes = numbered.find(|(_, outlet)| takes(outlet, &piece, state));
        if let Some((number, _)) = goes {
            leaving.push(id);
            note_leaving(id, number, &piece, state);
        }
    }
    state.scratch.outlets = watch;
    if !leaving.is_empty() {
        book_leaving(state, &leaving);
    }
    leaving
}

/// A cluster: its mass, kg, the centre of mass, m, and the way that it takes in the coming drift,
/// m.
struct Piece {
    mass_kg: f64,
    place_m: Vector3<f64>,
    way_m: Vector3<f64>,
}

/// None: the cluster has ended.
fn piece(id: u32, state: &State) -> Option<Piece> {
    let members = state.clusters.as_ref()?.members(id);
    let first = *members.first()?;
    let drift_s = state.time_step_s;
    if let Some(number) = state.clumps.carrier_of(first as usize) {
        let clump = &state.clumps.all[number];
        return Some(Piece {
            mass_kg: state.clumps.template(clump).mass_kg,
            place_m: clump.place_m.into(),
            way_m: Vector3::from(clump.velocity_m_s) * drift_s,
        });
    }
    let (mass_kg, place_m) = mass_and_centre(members, &state.particles);
    let momentum = members.iter().map(|&i| {
        let motion = &state.particles.motions[i as usize];
        Vector3::from(motion.velocity_m_s) / motion.inverse_mass
    });
    let way_m = momentum.sum::<Vector3<f64>>() * (drift_s / mass_kg);
    Some(Piece {
        mass_kg,
        place_m,
        way_m,
    })
}

/// Whether an outlet removes a piece now: it is there, or will have passed through the region.
fn takes(outlet: &Outlet, piece: &Piece, state: &State) -> bool {
    let region = &state.model.rules.regions[outlet.region];
    let inside = region.contains(piece.place_m.into());
    if outlet.removes_outside {
        return !inside;
    }
    inside || region.is_passed([piece.place_m, piece.place_m + piece.way_m])
}

/// Renews the list of clusters that are near an outlet.
fn follow(watch: &mut OutletWatch, state: &State) {
    let Some(clusters) = &state.clusters else {
        return;
    };
    // What moves in the coming drift moves about as fast as in the last one.
    let moved_m = state.fastest_m_s * state.previous_time_step_s;
    watch.left_m -= moved_m;
    if watch.left_m <= 2.0 * moved_m {
        let sizes = state.model.rules.outlets.iter().map(|outlet| {
            let region = &state.model.rules.regions[outlet.region];
            region.bounds().diagonal_m()
        });
        let smallest_m = sizes.fold(f64::INFINITY, f64::min);
        watch.left_m = (STEPS_AHEAD * moved_m).max(NEAR * smallest_m);
        watch.near.clear();
        watch.known = clusters.oldest();
    }
    let all = clusters.history.len() as u32;
    let is_near = |id: &u32| {
        let place_m = piece(*id, state).map(|piece| piece.place_m);
        place_m.is_some_and(|place_m| border_m(place_m, state) <= watch.left_m)
    };
    let new: Vec<u32> = (watch.known..all).filter(is_near).collect();
    watch.near.extend(new);
    watch.known = all;
}

/// Smallest distance from a place to where an outlet begins to act, m; 0 or less where one acts.
fn border_m(place_m: Vector3<f64>, state: &State) -> f64 {
    let rules = &state.model.rules;
    let distances = rules.outlets.iter().map(|outlet| {
        let region = &rules.regions[outlet.region];
        if region.contains(place_m.into()) == outlet.removes_outside {
            region.to_border_m(place_m)
        } else {
            0.0
        }
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// Records that an outlet removes a cluster.
fn note_leaving(id: u32, number: usize, piece: &Piece, state: &mut State) {
    let removed = &mut state.population.outlets[number];
    removed.bodies += 1;
    removed.mass_kg += piece.mass_kg;
    let Some(clusters) = &state.clusters else {
        return;
    };
    let size = size_of(id, clusters, &state.particles, &state.clumps);
    state.population.discharged.push(Discharged {
        time_s: state.scratch.events.time_s,
        fragment_id: id,
        outlet: number as u32,
        size: FragmentSize {
            mass_kg: piece.mass_kg,
            ..size
        },
    });
    state.scratch.events.population.push(PopulationEvent::Left {
        cluster: id,
        body: state.model.body_name(size.body).to_owned(),
        outlet: state.model.rules.outlets[number].name.clone(),
        mass_kg: piece.mass_kg,
        place_m: piece.place_m.into(),
    });
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
