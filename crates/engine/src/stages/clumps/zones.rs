//! Bodies of which only a part is bonded: a region, which may move with a wall. The spheres outside
//! it that bonds connect form rigid parts (Platzer 2022, section 5.3, suggests this for stalks at a
//! blade).
//!
//! Spheres that the region reaches are released with the velocity and spin that they have in their
//! part: momenta and kinetic energy stay. Spheres that it has left join a part one by one, once
//! they are quiet: momenta stay, and the kinetic energy that they lose is recorded. Bonds keep
//! their strain: within a part it is constant, and its energy counts. Spheres that are held or
//! loaded are always bonded.

use dem_io::disjoint::{find, join};

use crate::stages::ledger::totals::synchronous_motions;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::events::ZoneEvent;
use crate::state::particles::Particles;
use crate::state::rigid_parts::{FREE, RigidPart};
use crate::state::rules::{Rejoin, Zone};

/// Interval between looks at what the regions contain, in steps.
const EVERY: u64 = 50;

/// Bonded zones of bodies that are rigid elsewhere.
pub(crate) const ZONES: Stage = Stage::new("bonded zones", |state, _| {
    let zones = state.model.rules.zones.len();
    Need::of(
        zones > 0,
        || format!("of {zones} bodies, looked at every {EVERY} steps"),
        "no body is bonded in a region only",
    )
});

/// Forms the rigid parts of all bodies at the start.
pub fn form_rigid_parts(state: &mut State) {
    if state.model.rules.zones.is_empty() {
        return;
    }
    let is_fixed = held_or_loaded(state);
    let free = 0..state.particles.free as u32;
    let outside = free.filter(|&i| !is_fixed[i as usize] && is_outside(i, state) == Some(true));
    let parts = connected(&outside.collect::<Vec<u32>>(), state);
    set_parts(state, parts);
}

/// Releases the spheres that the regions have reached, and joins those that they have left to rigid
/// parts, between a kick and the drift after it. Returns the number of spheres looked at.
pub fn follow_zones(state: &mut State) -> usize {
    if state.model.rules.zones.is_empty() || !state.steps.is_multiple_of(EVERY) {
        return 0;
    }
    let mut part_of = state.rigid_parts.of_particle.clone();
    part_of.resize(state.particles.free, FREE);
    let mut changed = vec![Change::default(); state.model.rules.zones.len()];
    for &i in state.rigid_parts.all.iter().flat_map(|part| &part.members) {
        if let (Some(zone), Some(false)) = (number_of_zone(i, state), is_outside(i, state)) {
            part_of[i as usize] = FREE;
            changed[zone].released += 1;
        }
    }
    let joining = joining(state, &part_of);
    for &(i, part) in &joining {
        part_of[i as usize] = part;
        if let Some(zone) = number_of_zone(i, state) {
            changed[zone].rejoined += 1;
        }
    }
    if changed.iter().any(|change| *change != Change::default()) {
        regroup(state, &part_of, &mut changed);
        record(state, &changed);
    }
    state.particles.free
}

/// What a look at a zone changed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Change {
    /// Number of spheres released.
    released: usize,
    /// Number of spheres that joined a part again.
    rejoined: usize,
    /// Kinetic energy that those took from the body, J.
    lost_j: f64,
}

/// Counts the changes, and records them in the ledger and the events.
fn record(state: &mut State, changed: &[Change]) {
    let (step, time_s) = (state.steps, state.time_s);
    for (zone, change) in state.model.rules.zones.iter().zip(changed) {
        state.rigid_parts.released += change.released as u64;
        state.rigid_parts.rejoined += change.rejoined as u64;
        state.ledger.rejoined_j += change.lost_j;
        for (kind, particles, lost_j) in [
            ("released", change.released, 0.0),
            ("rejoined", change.rejoined, change.lost_j),
        ] {
            if particles > 0 {
                state.scratch.events.zones.push(ZoneEvent {
                    step,
                    time_s,
                    kind,
                    body: zone.body.clone(),
                    particles,
                    lost_j,
                });
            }
        }
    }
}

/// Number of the zone of the body of a particle. None: it has none.
fn number_of_zone(i: u32, state: &State) -> Option<usize> {
    let id = state.particles.id(i as usize);
    let mut zones = state.model.rules.zones.iter();
    zones.position(|zone| zone.ids.contains(&id))
}

/// The zone of the body of a particle.
fn zone_of(i: u32, state: &State) -> Option<&Zone> {
    number_of_zone(i, state).map(|number| &state.model.rules.zones[number])
}

/// Whether a particle is outside the bonded zone of its body. None: it is bonded everywhere.
fn is_outside(i: u32, state: &State) -> Option<bool> {
    let zone = zone_of(i, state)?;
    let place_m = state.particles.poses[i as usize].place().into();
    let rules = &state.model.rules;
    Some(!rules.zone_contains(zone, place_m, &state.walls))
}

/// For each free particle whether a support or a load acts on it.
fn held_or_loaded(state: &State) -> Vec<bool> {
    let mut is_fixed = vec![false; state.particles.len()];
    let held = state.supports.iter().flat_map(|support| &support.held);
    let loaded = state.loads.iter().flat_map(|load| &load.particles);
    for &i in held.map(|held| &held.particle).chain(loaded) {
        is_fixed[i as usize] = true;
    }
    is_fixed
}

/// Particles that are to join a rigid part, ascending, and its number: bonded to a sphere of it,
/// with all their bonds intact, quiet, and outside the zone. `part_of`: the part of each particle.
fn joining(state: &State, part_of: &[u32]) -> Vec<(u32, u32)> {
    let zones = &state.model.rules.zones;
    if zones.iter().all(|zone| zone.rejoin.is_none()) {
        return Vec::new();
    }
    let mut is_kept = held_or_loaded(state);
    let mut found = vec![FREE; part_of.len()];
    let bonds = &state.bonds;
    for (at, ends) in bonds.ends.iter().enumerate() {
        let [a, b] = ends.map(|end| end as usize);
        if bonds.damage(at) > 0.0 {
            [is_kept[a], is_kept[b]] = [true; 2];
        }
        for [one, other] in [[a, b], [b, a]] {
            if part_of[one] == FREE {
                found[one] = found[one].min(part_of[other]);
            }
        }
    }
    let mut strain_j = vec![0.0; part_of.len()];
    for (at, ends) in bonds.ends.iter().enumerate() {
        let [a, b] = ends.map(|end| end as usize);
        if (found[a] != FREE || found[b] != FREE) && !bonds.is_broken(at) {
            let energy_j = bonds.forces(at, &state.particles.poses).energy.total();
            strain_j[a] += energy_j;
            strain_j[b] += energy_j;
        }
    }
    (0..part_of.len())
        .filter(|&i| found[i] != FREE && !is_kept[i])
        .filter(|&i| is_outside(i as u32, state) == Some(true))
        .filter(|&i| {
            let rejoin = zone_of(i as u32, state).and_then(|zone| zone.rejoin);
            let part = &state.rigid_parts.all[found[i] as usize];
            rejoin.is_some_and(|rule| is_quiet(i, strain_j[i], part, &rule, &state.particles))
        })
        .map(|i| (i as u32, found[i]))
        .collect()
}

/// Whether a particle whose bonds have this energy, J, may join a part.
fn is_quiet(
    i: usize,
    strain_j: f64,
    part: &RigidPart,
    rule: &Rejoin,
    particles: &Particles,
) -> bool {
    let (pose, motion) = (&particles.poses[i], &particles.motions[i]);
    let [velocity, spin] = [motion.velocity_m_s, motion.spin_rad_s].map(nalgebra::Vector3::from);
    let passing_m_s = (velocity - part.velocity_at(&pose.place())).norm();
    let turning_m_s = pose.radius_m() * (spin - part.spin_rad_s()).norm();
    strain_j * motion.inverse_mass <= rule.strain_energy_j_kg
        && passing_m_s.max(turning_m_s) <= rule.speed_m_s
}

/// Forms the rigid parts again whose spheres have changed, and adds to `changed` what each zone
/// loses where spheres have joined parts.
fn regroup(state: &mut State, part_of: &[u32], changed: &mut [Change]) {
    let joins = changed.iter().any(|change| change.rejoined > 0);
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); state.rigid_parts.all.len()];
    for (i, &part) in (0..).zip(part_of) {
        if let Some(members) = members.get_mut(part as usize) {
            members.push(i);
        }
    }
    // Energies are those at the time of the positions.
    let motions = if joins {
        synchronous_motions(state)
    } else {
        Vec::new()
    };
    let mut parts = Vec::new();
    for (n, members) in members.into_iter().enumerate() {
        if members == state.rigid_parts.all[n].members {
            parts.push(std::mem::take(&mut state.rigid_parts.all[n]));
            continue;
        }
        for part in connected(&members, state) {
            let p = &state.particles;
            if let (true, Some(zone)) = (joins, number_of_zone(part.members[0], state)) {
                let now = RigidPart::of(part.members.clone(), &p.poses, &motions);
                let own = part.members.iter().map(|&i| i as usize);
                let before: f64 = own.map(|i| p.kinetic_j(i, &motions[i])).sum();
                changed[zone].lost_j += before - now.kinetic_j();
            }
            parts.push(part);
        }
    }
    parts.sort_by_key(|part| part.members[0]);
    set_parts(state, parts);
}

/// The rigid parts of two or more spheres that unbroken bonds connect among these, ascending.
fn connected(members: &[u32], state: &State) -> Vec<RigidPart> {
    let bonds = &state.bonds;
    let mut names: Vec<u32> = (0..members.len() as u32).collect();
    for (n, &i) in (0..).zip(members) {
        let from = bonds.ends.partition_point(|[a, _]| *a < i);
        for (at, &[a, b]) in bonds.ends.iter().enumerate().skip(from) {
            if a != i {
                break;
            }
            if let (Ok(other), false) = (members.binary_search(&b), bonds.is_broken(at)) {
                join(&mut names, n, other as u32);
            }
        }
    }
    let mut pieces: Vec<Vec<u32>> = vec![Vec::new(); members.len()];
    for (n, &i) in (0..).zip(members) {
        pieces[find(&mut names, n) as usize].push(i);
    }
    let p = &state.particles;
    let several = pieces.into_iter().filter(|piece| piece.len() > 1);
    several
        .map(|piece| RigidPart::of(piece, &p.poses, &p.motions))
        .collect()
}

/// Makes these the rigid parts, in the order of their first spheres, and gives their spheres their
/// motion.
fn set_parts(state: &mut State, parts: Vec<RigidPart>) {
    for part in &parts {
        let Particles { poses, motions, .. } = &mut state.particles;
        part.set_motions(poses, motions);
    }
    state.rigid_parts.all = parts;
    let free = state.particles.free;
    state.rigid_parts.number(free, &state.bonds);
    state.divide_bonds();
}
