//! Which clumps become bonded clusters in this step (BPRM: Platzer 2022, 4.5.4), which bodies come through inlets, and which leave through outlets.

use nalgebra::{UnitQuaternion, Vector3};

use super::population::{Renumbering, TopologyChange, apply_topology_change};
use super::restoring::restore;
use crate::check::totals::synchronous_motions;
use crate::clock::Stage;
use crate::clusters::fragments::mass_and_centre;
use crate::physics::random::uniform;
use crate::stages::clumps::synchronous;
use crate::state::State;
use crate::state::clumps::{Clump, Template, numbers, rotation};
use crate::state::rules::{Feed, Inlet, Trigger};
use crate::state::walls::Wall;

/// Places looked at for a body in one step.
const TRIES: u32 = 10;
/// Steps after which a place is looked for again.
const WAIT: u64 = 50;
/// Outlets look for what has come to them once in so many steps.
const OUTLET_EVERY: u64 = 50;

/// What has happened to bodies in a step.
#[derive(Debug, Clone, PartialEq)]
pub enum PopulationEvent {
    /// A clump has become a bonded cluster.
    Replaced {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// Which condition was met: `enters`, `force`, `impact_energy`, `time`, `start`.
        cause: &'static str,
        /// Mass before and after, kg.
        mass_kg: [f64; 2],
        /// Magnitude of the momentum before and after, N s.
        momentum_n_s: [f64; 2],
        /// Kinetic energy before and after, J.
        kinetic_j: [f64; 2],
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
    /// A cluster has become a clump again.
    Restored {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// Number of its particles.
        particles: u32,
        /// Strain and inner motion that it had, J.
        lost_j: f64,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
    /// A body has come.
    Came {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// Name of the inlet.
        inlet: String,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
    /// A body or a fragment has gone.
    Left {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of the outlet.
        outlet: String,
        /// Its mass, kg.
        mass_kg: f64,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
}

/// Cause of the change of a body that comes through an inlet and starts as bonded.
pub const STARTS_BONDED: &str = "start";

/// Does to the bodies what the scene asks for, between a kick and the drift after it. None: nothing.
pub fn replace(state: &mut State) -> Option<(Vec<Renumbering>, Vec<PopulationEvent>)> {
    if state.rules.are_none() {
        return None;
    }
    let waiting = state.clumps.all.iter();
    let waiting = waiting.map(|clump| state.clumps.template(clump).bonds.len() as u64);
    state.rules.bond_steps[1] += waiting.sum::<u64>();
    state.rules.bond_steps[0] += state.bonds.len() as u64;
    let mut happened = Vec::new();
    let mut renumbered = Vec::new();
    let ways = state.rules.inlets.len() + state.rules.outlets.len();
    state.clock.did(Stage::Population, ways);
    if state.rules.triggers.iter().any(Option::is_some) {
        state.clock.did(Stage::Replacement, state.clumps.all.len());
    }

    let leaving = leaving(state, &mut happened);
    let coming = coming(state, &mut happened);
    if !(leaving.is_empty() && coming.is_empty()) {
        let changes = TopologyChange {
            coming,
            leaving,
            ..TopologyChange::default()
        };
        renumbered.push(apply_topology_change(state, changes));
    }
    if let Some((by, restored)) = restore(state) {
        state.rules.restored += restored.len() as u32;
        renumbered.push(by);
        happened.extend(restored);
    }
    let (to_clusters, causes): (Vec<usize>, Vec<&'static str>) = triggered(state).unzip();
    if !to_clusters.is_empty() {
        renumbered.push(swap(state, to_clusters, &causes, &mut happened));
    }
    (!happened.is_empty()).then_some((renumbered, happened))
}

/// Clumps that become clusters: their numbers, and why.
fn triggered(state: &State) -> impl Iterator<Item = (usize, &'static str)> {
    let rules = &state.rules;
    (state.clumps.all.iter().enumerate()).filter_map(move |(n, clump)| {
        let template = clump.template as usize;
        if rules.starts.get(template)?.bonded {
            return Some((n, STARTS_BONDED));
        }
        let trigger = rules.triggers.get(template)?.as_ref()?;
        Some((n, met(trigger, clump, state)?))
    })
}

/// Which condition of a trigger a clump meets, or the first where it needs all and meets all.
fn met(trigger: &Trigger, clump: &Clump, state: &State) -> Option<&'static str> {
    let enters = trigger
        .enters
        .map(|region| state.rules.regions[region].contains(clump.place_m));
    let force = trigger
        .force_n
        .map(|limit| Vector3::from(clump.force_n).norm() > limit);
    let energy = trigger
        .impact_energy_j
        .map(|limit| clump.impact_energy_j > limit);
    // The time has come for good: what has become rigid again waits for something else.
    let is_again = state.rules.base_of_cluster.contains_key(&clump.cluster);
    let time = trigger.time_s.filter(|_| !is_again);
    let time = time.map(|from| state.time_s >= from);
    let all = [
        ("enters", enters),
        ("force", force),
        ("impact_energy", energy),
        ("time", time),
    ];
    let mut asked = all
        .iter()
        .filter_map(|(name, met)| met.map(|met| (*name, met)));
    if trigger.needs_all {
        let first = asked.clone().next()?.0;
        asked.all(|(_, met)| met).then_some(first)
    } else {
        asked.find(|(_, met)| *met).map(|(name, _)| name)
    }
}

/// Clumps become clusters; notes mass, momentum and energy before and after.
fn swap(
    state: &mut State,
    to_clusters: Vec<usize>,
    causes: &[&'static str],
    happened: &mut Vec<PopulationEvent>,
) -> Renumbering {
    // A body that an inlet feeds as bonded starts so.
    let fired = causes.iter().filter(|cause| **cause != STARTS_BONDED);
    state.rules.replaced += fired.count() as u32;
    let changes = TopologyChange {
        to_clusters,
        ..TopologyChange::default()
    };
    let renumbered = apply_topology_change(state, changes);
    for born in &renumbered.born {
        let base = state.rules.base(born.clump.template);
        let of_scene = (base, born.clump.instance);
        state
            .rules
            .base_of_cluster
            .insert(born.clump.cluster, of_scene);
    }
    for (born, cause) in renumbered.born.iter().zip(causes) {
        let (clump, template) = (&born.clump, &born.template);
        let p = &state.particles;
        let (mut mass, mut momentum, mut kinetic) = (0.0, Vector3::zeros(), 0.0);
        for i in born.first_particle..born.first_particle + template.spheres.len() {
            let motion = &p.motions[i];
            mass += 1.0 / motion.inverse_mass;
            momentum += Vector3::from(motion.velocity_m_s) / motion.inverse_mass;
            kinetic += p.kinetic_j(i, motion);
        }
        happened.push(PopulationEvent::Replaced {
            cluster: clump.cluster,
            body: template.body.clone(),
            cause,
            mass_kg: [template.mass_kg, mass],
            momentum_n_s: [
                template.mass_kg * Vector3::from(clump.velocity_m_s).norm(),
                momentum.norm(),
            ],
            kinetic_j: [clump.kinetic_j(template), kinetic],
            place_m: clump.place_m,
        });
    }
    renumbered
}

/// Bodies that come through inlets in this step.
fn coming(state: &mut State, happened: &mut Vec<PopulationEvent>) -> Vec<Clump> {
    let mut coming: Vec<Clump> = Vec::new();
    let asks =
        |inlet: &Inlet| state.steps >= inlet.progress.next_try && is_due(inlet, state.time_s);
    if !state.rules.inlets.iter().any(asks) {
        return coming;
    }
    let mut inlets = std::mem::take(&mut state.rules.inlets);
    let mut next_cluster = state
        .clusters
        .as_ref()
        .map_or(0, |c| c.history.len() as u32);
    for (n, inlet) in inlets.iter_mut().enumerate() {
        while is_due(inlet, state.time_s) && state.steps >= inlet.progress.next_try {
            let Some(clump) = next_body(n, inlet, state, &coming) else {
                if inlet.progress.tries <= TRIES {
                    inlet.progress.delayed += 1;
                }
                inlet.progress.next_try = state.steps + WAIT;
                break;
            };
            let template = state.clumps.template(&clump);
            let now = Clump {
                velocity_m_s: inlet.velocity_m_s,
                ..clump
            };
            state.ledger.bring(
                1.0,
                [template.mass_kg, now.kinetic_j(template)],
                [clump.place_m, clump.velocity_m_s, clump.angular_momentum],
                state.gravity_m_s2,
            );
            inlet.progress.bodies += 1;
            inlet.progress.mass_kg += template.mass_kg;
            inlet.progress.tries = 0;
            state.rules.instances += 1;
            happened.push(PopulationEvent::Came {
                cluster: next_cluster,
                body: template.body.clone(),
                inlet: inlet.name.clone(),
                place_m: clump.place_m,
            });
            next_cluster += 1;
            coming.push(clump);
        }
    }
    state.rules.inlets = inlets;
    coming
}

/// What gravity adds to a velocity from the moment of the places to the half step after it, m/s.
fn half_kick(state: &State) -> Vector3<f64> {
    Vector3::from(state.gravity_m_s2) * (0.5 * state.time_step_s)
}

/// Whether an inlet owes a body.
fn is_due(inlet: &Inlet, time_s: f64) -> bool {
    let [start_s, end_s] = inlet.between_s;
    if inlet.progress.bodies >= inlet.count || time_s < start_s || time_s >= end_s {
        return false;
    }
    let since_s = time_s - start_s;
    match inlet.feed {
        Feed::Number(per_s) => since_s * per_s >= f64::from(inlet.progress.bodies),
        Feed::Mass(kg_s) => since_s * kg_s >= inlet.progress.mass_kg,
    }
}

/// The next body of an inlet, where there is place for it: a random place of the region at which the sphere around it touches no sphere of another body, and
/// none of its spheres a wall.
fn next_body(n: usize, inlet: &mut Inlet, state: &State, coming: &[Clump]) -> Option<Clump> {
    let seed = state.rules.seed;
    let number = u64::from(inlet.progress.bodies);
    let random = |of: u64, attempt: u32| uniform(seed, &[n as u64, number, of, u64::from(attempt)]);
    let which = {
        let share = random(0, 0);
        let mut sum = 0.0;
        let chosen = inlet.templates.iter().find(|(_, part)| {
            sum += part;
            share < sum
        });
        chosen.or(inlet.templates.last())?.0
    };
    let template = &state.clumps.templates[which as usize];
    let region = &state.rules.regions[inlet.region];
    let reach_m = template.reach_m * template.scale.max(1.0);
    for _ in 0..TRIES {
        inlet.progress.tries += 1;
        let attempt = inlet.progress.tries;
        let Some(place_m) = region.point([1, 2, 3].map(|of| random(of, attempt))) else {
            continue;
        };
        if is_taken(place_m, reach_m, state, coming) {
            continue;
        }
        let as_file = if inlet.random_orientation {
            any_rotation([4, 5, 6].map(|of| random(of, attempt)))
        } else {
            rotation(state.rules.starts[which as usize].turned)
        };
        let turned = numbers(&(as_file * rotation(template.axes)));
        let velocity = Vector3::from(inlet.velocity_m_s) + half_kick(state);
        let clump = Clump {
            template: which,
            instance: state.rules.instances + 1,
            place_m,
            turned,
            velocity_m_s: velocity.into(),
            angular_momentum: angular_momentum(template, turned, inlet.spin_rad_s),
            ..Clump::default()
        };
        if !state
            .walls
            .iter()
            .any(|wall| is_in_wall(&clump, template, wall))
        {
            return Some(clump);
        }
    }
    None
}

/// Whether a sphere of a clump touches a wall.
fn is_in_wall(clump: &Clump, template: &Template, wall: &Wall) -> bool {
    let reach_m = template.reach_m * template.scale.max(1.0);
    if !wall.bounds_in_space().is_near(&clump.place_m, reach_m) {
        return false;
    }
    let mut touches = Vec::new();
    template.outer.iter().any(|&sphere| {
        let pose = template.pose(sphere as usize, clump);
        let centre = wall.frame.to_wall(pose.place().into());
        let radius_m = template.scale * pose.radius_m();
        wall.shape.touches(centre, radius_m, &mut touches);
        touches.iter().any(|touch| touch.distance_m < radius_m)
    })
}

/// Angular momentum of a clump that is turned so and spins so, kg m2/s.
pub fn angular_momentum(template: &Template, turned: [f64; 4], spin_rad_s: [f64; 3]) -> [f64; 3] {
    let turned = rotation(turned);
    let spin = turned.inverse() * Vector3::from(spin_rad_s);
    let own = spin.component_mul(&Vector3::from(template.moments_kg_m2));
    (turned * own).into()
}

/// A rotation, uniform over all, from three numbers in (0, 1) (Shoemake 1992).
fn any_rotation([u, v, w]: [f64; 3]) -> UnitQuaternion<f64> {
    let turn = std::f64::consts::TAU;
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    let ((sv, cv), (sw, cw)) = ((turn * v).sin_cos(), (turn * w).sin_cos());
    rotation([a * sv, a * cv, b * sw, b * cw])
}

fn is_taken(place_m: [f64; 3], reach_m: f64, state: &State, coming: &[Clump]) -> bool {
    let place = Vector3::from(place_m);
    let near = |other: Vector3<f64>, reach: f64| {
        (other - place).norm_squared() < (reach_m + reach).powi(2)
    };
    let around = |clump: &Clump| {
        let template = state.clumps.template(clump);
        let reach = template.reach_m * template.scale.max(1.0);
        near(clump.place_m.into(), reach)
    };
    // Those in the middle of a clump are not in the scene.
    let in_clump = |clump: &Clump| {
        let template = state.clumps.template(clump);
        let touches = |sphere: usize| {
            let pose = template.pose(sphere, clump);
            near(pose.place(), template.scale * pose.radius_m())
        };
        around(clump) && (0..template.spheres.len()).any(touches)
    };
    let mut free = state.particles.poses[..state.particles.free].iter();
    free.any(|pose| near(pose.place(), pose.radius_m()))
        || state.clumps.all.iter().any(in_clump)
        || coming.iter().any(around)
}

/// Clusters that have come to an outlet, and books that they go. Their numbers, rising.
fn leaving(state: &mut State, happened: &mut Vec<PopulationEvent>) -> Vec<u32> {
    let mut leaving = Vec::new();
    if state.rules.outlets.is_empty() || !state.steps.is_multiple_of(OUTLET_EVERY) {
        return leaving;
    }
    let Some(clusters) = &state.clusters else {
        return leaving;
    };
    let mut outlets = std::mem::take(&mut state.rules.outlets);
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
        let goes = outlets.iter_mut().find(|outlet| {
            let inside = state.rules.regions[outlet.region].contains(place_m);
            inside != outlet.removes_outside
        });
        let Some(outlet) = goes else {
            continue;
        };
        outlet.removed.bodies += 1;
        outlet.removed.mass_kg += mass_kg;
        leaving.push(id);
        happened.push(PopulationEvent::Left {
            cluster: id,
            outlet: outlet.name.clone(),
            mass_kg,
            place_m,
        });
    }
    state.rules.outlets = outlets;
    if !leaving.is_empty() {
        book_leaving(state, &leaving);
    }
    leaving
}

/// Books mass, momenta and energy of what leaves: kinetic energy at the moment of the places, and elastic energy of bonds.
fn book_leaving(state: &mut State, leaving: &[u32]) {
    let gravity = state.gravity_m_s2;
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
    let now = synchronous(&state.clumps, gravity, state.time_step_s);
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
