//! Contacts linearised at an impact of a speed.

use super::{LEAST_OVERLAP, translation};
use crate::stages::walls::wall_contact;
use crate::state::State;
use crate::state::clumps::Clump;
use dem_physics::contact::kinematics::{contact_kinematics, indentation};
use dem_physics::contact::law::ContactKind;
use dem_physics::number::Vec3;
use nalgebra::Vector3;

/// Contribution of the first impact at a speed, m/s, to the largest eigenvalues of stiffness and
/// damping over mass, 1/s2 and 1/s, if a single particle meets a wall or another of its size, or a
/// clump does with one sphere or with [all that a plane touches](dem_physics::shape::landing); and
/// its [rate](super::largest_contact_rate_1_s2), 1/s2. A particle pushed by a body behind it may
/// overlap more. With contacts beside bonds something presses at any speed, as loads and supports
/// do: the stiffness of a linear law counts in full, and that of Hertz's law from no overlap on.
pub fn at_impact(state: &State, speed_m_s: f64) -> [f64; 3] {
    at_impacts(state, speed_m_s, first_to_hit(state).into_iter())
}

/// The same for flat landings of clumps alone, on all spheres that a plane touches at once. 0 if
/// there are none.
pub fn at_landing(state: &State, speed_m_s: f64) -> [f64; 3] {
    let first = first_to_hit(state).into_iter();
    at_impacts(state, speed_m_s, first.filter(|hit| hit.is_flat))
}

/// As [`at_impact`], for these hits.
fn at_impacts(state: &State, speed_m_s: f64, first: impl Iterator<Item = Hit>) -> [f64; 3] {
    let Some(contacts) = &state.contacts else {
        return [0.0; 3];
    };
    let p = &state.particles;
    let materials = contacts.model.kind_of.len().isqrt();
    let is_beside = state.bonds.rules.iter().any(|rule| rule.contact_beside);
    let least = if is_beside { LEAST_OVERLAP } else { 0.0 };
    let mut largest = [0.0_f64; 3];
    let mut take = |kind: &ContactKind, hit: &Hit, at_wall: bool| {
        let n = Vector3::x();
        let i = hit.particle;
        let radius_m = p.poses[i].radius_m();
        let overlap_m = overlap_at_impact_m(kind, radius_m, hit.per_share_kg, speed_m_s, at_wall);
        let overlap_m = overlap_m.max(least * radius_m);
        let mut touch = if at_wall {
            wall_contact(p, i, &n, overlap_m)
        } else {
            let apart = Vec3(2.0 * p.poses[i].radius_m() - overlap_m, 0.0, 0.0);
            contact_kinematics(apart, [p.contact_sphere_at_rest(i); 2], 0.0)
        };
        let ends = if at_wall { 1.0 } else { 2.0 };
        let per_mass = ends * hit.inverse_kg;
        if hit.is_shared {
            touch.effective_mass_kg = 1.0 / per_mass;
        }
        let mut answer = kind.linearised(&touch);
        if let Some(bridge) = &kind.bridge {
            answer.normal_n_m += bridge.steepest_n_m(touch.effective_radius_m);
        }
        let [stiffness, damping] = translation(&answer);
        largest[0] = largest[0].max(per_mass * stiffness);
        largest[1] = largest[1].max(per_mass * damping);
        largest[2] = largest[2].max(per_mass * answer.normal_n_m);
    };
    for hit in first {
        let material = usize::from(contacts.materials[hit.particle]);
        let row = &contacts.model.kind_of[material * materials..(material + 1) * materials];
        for &kind in row {
            if let Some(kind) = contacts.model.kinds.get(usize::from(kind)) {
                take(kind, &hit, false);
            }
        }
        for wall in &state.walls {
            if let Some(kind) = wall
                .model
                .kinds
                .get(usize::from(wall.model.kind_of[material]))
            {
                take(kind, &hit, true);
            }
        }
    }
    largest
}

/// Largest [indentation] in an impact at a speed, m/s, of a single sphere with a wall or another of
/// its size: a particle pushed by a body behind it is pressed in further. One sphere of each
/// material represents all, as the ratio does not depend on the radius with Hertz's law.
pub(crate) fn indentation_at_impact(state: &State, speed_m_s: f64) -> f64 {
    let Some(contacts) = &state.contacts else {
        return 0.0;
    };
    let materials = contacts.model.kind_of.len().isqrt();
    let mut seen = vec![false; materials];
    let mut largest = 0.0_f64;
    for (i, &material) in contacts.materials.iter().enumerate() {
        let material = usize::from(material);
        if std::mem::replace(&mut seen[material], true) {
            continue;
        }
        let radius_m = state.particles.poses[i].radius_m();
        let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3);
        let inverse_kg = 1.0 / (state.density_kg_m3(i) * volume_m3);
        let row = &contacts.model.kind_of[material * materials..(material + 1) * materials];
        let pairs = (row.iter()).filter_map(|&kind| contacts.model.kinds.get(usize::from(kind)));
        let walls = state.walls.iter().filter_map(|wall| {
            let kind = wall.model.kind_of.get(material)?;
            wall.model.kinds.get(usize::from(*kind))
        });
        let all = (pairs.map(|kind| (kind, false))).chain(walls.map(|kind| (kind, true)));
        for (kind, at_wall) in all {
            let overlap_m = overlap_at_impact_m(kind, radius_m, inverse_kg, speed_m_s, at_wall);
            let other_m = if at_wall { f64::INFINITY } else { radius_m };
            largest = largest.max(indentation(overlap_m, radius_m, other_m));
        }
    }
    largest
}

/// A first impact.
#[derive(Debug, Clone, Copy)]
struct Hit {
    particle: usize,
    /// Largest eigenvalue over the stiffness of a contact, 1/kg.
    inverse_kg: f64,
    /// One over the mass whose energy a contact takes, 1/kg.
    per_share_kg: f64,
    /// Whether the particle is one of several of a clump.
    is_shared: bool,
    /// Whether others of them hit with it.
    is_flat: bool,
}

/// The fastest impacts: of free particles those of the smallest of each material, of the clumps of
/// each template those of a largest sphere.
fn first_to_hit(state: &State) -> Vec<Hit> {
    let Some(contacts) = &state.contacts else {
        return Vec::new();
    };
    let p = &state.particles;
    let radius = |i: &usize| p.poses[*i].radius_m();
    let mut found: Vec<Option<usize>> = Vec::new();
    for i in 0..p.free {
        let material = usize::from(contacts.materials[i]);
        if found.len() <= material {
            found.resize(material + 1, None);
        }
        if found[material].is_none_or(|other| radius(&i) < radius(&other)) {
            found[material] = Some(i);
        }
    }
    let of_particle = |i: usize| Hit {
        particle: i,
        inverse_kg: p.motions[i].inverse_mass,
        per_share_kg: p.motions[i].inverse_mass,
        is_shared: false,
        is_flat: false,
    };
    let mut found: Vec<Hit> = found.into_iter().flatten().map(of_particle).collect();
    let mut seen = vec![false; state.clumps.templates.len()];
    for clump in &state.clumps.all {
        if !std::mem::replace(&mut seen[clump.template as usize], true) {
            found.extend(hits_first(state, clump));
        }
    }
    found
}

/// The hits of a clump with one sphere, and with as many as a plane can touch, which share its
/// energy.
fn hits_first(state: &State, clump: &Clump) -> Vec<Hit> {
    let radius = |i: &usize| state.particles.poses[*i].radius_m();
    let template = state.clumps.template(clump);
    let spheres = state.clumps.spheres_of(clump);
    let Some(particle) = spheres.max_by(|a, b| radius(a).total_cmp(&radius(b))) else {
        return Vec::new();
    };
    let landing = template.landing();
    let alone = Hit {
        particle,
        inverse_kg: landing.alone_per_kg,
        per_share_kg: landing.alone_per_kg,
        is_shared: template.spheres.len() > 1,
        is_flat: false,
    };
    let together = Hit {
        inverse_kg: landing.together_per_kg,
        per_share_kg: f64::from(landing.together) / template.mass_kg,
        is_flat: true,
        ..alone
    };
    if landing.together > 1 {
        vec![alone, together]
    } else {
        vec![alone]
    }
}

fn overlap_at_impact_m(
    kind: &ContactKind,
    radius_m: f64,
    inverse_kg: f64,
    speed_m_s: f64,
    at_wall: bool,
) -> f64 {
    let half = if at_wall { 1.0 } else { 0.5 };
    let mass_kg = half / inverse_kg;
    kind.overlap_at_impact_m(half * radius_m, mass_kg, speed_m_s)
}
