//! Turns a scene and its bodies into a simulation ready to step: its state, the stages it needs,
//! and why the others are skipped.

pub mod alike;
pub mod bodies;
pub mod bond_kinds;
mod bonds;
pub mod bounces;
mod clumps;
pub(crate) mod contacts;
mod daughters;
mod falls;
mod file_units;
mod forecast;
pub mod groups;
pub(crate) mod held;
mod initial;
mod inputs;
pub mod masses;
pub mod measure;
mod outputs;
mod placement;
mod quality;
mod questions;
mod rules;
mod sieve_sizes;
mod size_correction;
mod stages;
pub mod time_step;
mod triggers;
mod unfinished;
mod walls;
mod zones;

use std::collections::BTreeMap;
use std::sync::Arc;

use dem_io::body::About;
use dem_io::body::mass::BodyMass;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::{Integrator, Scene, StartAs};

use dem_engine::check::limit::damping_bound_1_s;
use dem_engine::check::pass_through::passes_through;
use dem_engine::stages::bonds::damping::WEAK;
use dem_engine::stages::ledger::bookkeeping::opened;
use dem_engine::stages::population::change::apply_topology_change;
use dem_engine::state::State;
use dem_engine::state::clusters::Clusters;
use dem_engine::state::clusters::sizes::{Sphere, sieve_m};
use dem_engine::state::events::TopologyChange;
use dem_engine::state::loads::GroupLoad;
use dem_engine::state::model::NamedBody;
use dem_engine::state::population::{InletProgress, OutletTotals};
use dem_engine::state::sleep::{Sleep, SleepRule};
use dem_engine::state::supports::GroupSupport;
use dem_engine::state::supports::HeldParticle;
use dem_physics::chebyshev::{MOST, limit};

use self::alike::told_once;
use self::bodies::place_bodies;
use self::clumps::{
    ball_m, need_pairs, refuse_unbreakable, standing, templates, templates_of, unused_bonds,
};
use self::contacts::{Kinds, are_needed, choose_skin, place_contacts};
use self::daughters::fitted;
use self::forecast::forecast;
pub use self::forecast::{Forecast, InletForecast};
use self::groups::{held_degrees_of_freedom, particles_of, resolve_groups};
use self::held::refuse_loose;
use self::initial::start;
use self::inputs::inputs;
use self::measure::measurement::Measurement;
use self::measure::refused::refuse_valueless;
use self::outputs::refuse_endless_output;
use self::placement::placed;
use self::rules::{doubts, rules};
use self::sieve_sizes::scale_to_sieves;
use self::size_correction::corrected;
pub use self::stages::PlannedStage;
use self::stages::{leave_out, planned_stages};
use self::time_step::{StepChoice, arriving_as_clusters, choose_step, rayleigh_s};
pub use self::walls::stroke_m;
use self::zones::place_zones;
use dem_engine::state::bodies::PlacedBody;
use dem_results::summary::Inputs;

/// Number of particles, bonds and pairs that justify a thread of their own.
const WORTH_A_THREAD: usize = 2000;

/// A simulation that is ready to step, with names for its parts.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The state before the first step.
    pub state: State,
    /// Bodies in the order of their names.
    pub bodies: Vec<PlacedBody>,
    /// Particles (numbers in the state, ascending) of every set, every body and `all`.
    pub groups: BTreeMap<String, Vec<u32>>,
    /// The time step and the reason for it.
    pub step: StepChoice,
    /// Whether the step follows the limit up as well as down.
    pub is_adaptive: bool,
    /// The stages of a step.
    pub stages: Vec<PlannedStage>,
    /// Bodies that always stay rigid clumps, and the number of their bonds, which are unused.
    pub unused_bonds: Vec<(String, usize)>,
    /// Mass of each body, by name.
    pub masses: BTreeMap<String, BodyMass>,
    /// What is unusual but harmless in the scene, a sentence each.
    pub notes: Vec<String>,
    /// Reasons to doubt the result that are known before the run, a sentence each.
    pub warnings: Vec<String>,
    /// Why the result depends on the size of the spheres, a sentence each.
    pub coarse: Vec<String>,
    /// Whether all bodies that can break are granulates, whose bonds do not hold a sphere against
    /// its weight: sizes of their fragments are those of their grains.
    pub is_granular: bool,
    /// Forecast of the run, as far as possible.
    pub forecast: Forecast,
    /// Inputs of the plan, for the results.
    pub inputs: Inputs,
}

/// Plans a scene whose bodies have been read (one for each of [`Scene::bodies`]). `allow_any_step`:
/// a given time step above the limit is taken.
///
/// # Errors
/// Inconsistencies of the scene: bonds without a rule, no density, a set without particles, a
/// degree of freedom held twice, a load on a held degree of freedom, materials that meet without a
/// contact law, bodies in each other or in walls, a wall's file that is not a surface, a time step
/// above the limit, a laboratory test that is not possible; if the scene asks for static
/// equilibrium, a piece that supports do not hold.
pub fn plan(
    scene: &Scene,
    mut read: BTreeMap<String, Body>,
    threads: usize,
    allow_any_step: bool,
) -> Result<Plan> {
    let inputs = inputs(scene, &read);
    let of_units = file_units::notes(scene, &read);
    scale_to_sieves(scene, &mut read);
    let scene = &corrected(fitted(placed(scene, &read)?, &mut read)?, &read)?;
    let about: BTreeMap<String, About> = (read.iter())
        .map(|(name, body)| (name.clone(), body.about.clone()))
        .collect();
    refuse_endless_fall(scene)?;
    let quality = quality::of_bodies(scene, &read);
    let mut warnings = quality.warnings;
    let ball_m = ball_m(scene, &read);
    let named = named_bodies(scene, &read);
    let unused_bonds = unused_bonds(scene, &read);
    let templates = templates(scene, &templates_of(scene), &mut read, ball_m)?;
    refuse_unbreakable(scene, &templates)?;
    let (particles, bonds, bodies) = place_bodies(scene, read)?;
    let masses = masses::masses(scene, &about, &templates, &bodies, &particles);
    let groups = resolve_groups(scene, &bodies, &particles)?;
    let mut state = State::new(particles, bonds, 1.0, threads);
    state.scratch.worth_a_thread = WORTH_A_THREAD;
    state.model.bodies = named;
    state.model.gravity_m_s2 = scene.run.gravity_m_s2;
    state.model.particle_damping = scene.run.local_damping;
    state.divide();
    state.supports = supports(scene, &groups)?;
    start(scene, &groups, &bodies, &mut state)?;
    state.loads = loads(scene, &groups, &state.supports)?;
    let of_masses = masses::notes(scene, &masses);
    let mut notes = [scene.notes.clone(), of_units, quality.notes, of_masses].concat();
    state.model.rules = rules(scene, &templates, &about)?;
    state.population.inlets = vec![InletProgress::default(); state.model.rules.inlets.len()];
    state.population.by_daughters = vec![0; templates.len()];
    state.population.fines_kg = vec![0.0; templates.len()];
    state.population.outlets = vec![OutletTotals::default(); state.model.rules.outlets.len()];
    state.model.templates.clone_from(&templates);
    state.clumps.templates = templates;
    state.model.ball_m = ball_m;
    refuse_damped_clumps(scene, &state)?;
    place_meetings(scene, &bodies, &mut state, &mut notes)?;
    place_zones(scene, &bodies, &mut state)?;
    refuse_valueless(scene, &groups, &state, &masses)?;
    warnings.extend(masses::odd_densities(scene, &state, &bodies));
    warnings.extend(doubts(scene, &state));
    warnings.extend(questions::doubts(scene, &state, &bodies));
    warnings.extend(without_contacts(scene, &state, &bodies));
    notes.extend(questions::notes(scene, &state, &bodies, &unused_bonds));
    notes.extend(bounces::notes(scene, &state));
    state.ledger = opened(&state);
    state.open_islands();
    let step = first_step(scene, &bodies, &mut state, allow_any_step)?;
    if scene.run.integrator == Integrator::Leapfrog {
        bound_damping(&mut state);
        refuse_endless_damping(scene, &state)?;
    }
    let forecast = forecast(scene, &state, &bodies, step.impact_speed_m_s);
    let stages = planned_stages(&state, scene);
    leave_out(&stages, &mut state);
    Ok(Plan {
        state,
        bodies,
        groups,
        step,
        is_adaptive: scene.run.adaptive && scene.run.integrator == Integrator::Leapfrog,
        stages,
        unused_bonds,
        masses,
        notes: told_once(notes, scene.bodies.keys()),
        warnings: told_once(warnings, scene.bodies.keys()),
        coarse: told_once(quality.coarse, scene.bodies.keys()),
        is_granular: quality.is_granular,
        forecast,
        inputs,
    })
}

/// Largest acceleration that a run can be made with, m/s2: a thousand times that of an
/// ultracentrifuge.
const MOST_GRAVITY_M_S2: f64 = 1e10;

/// Refuses a gravity under which everything is so fast that a run would never end.
fn refuse_endless_fall(scene: &Scene) -> Result<()> {
    let most = scene
        .run
        .gravity_m_s2
        .iter()
        .fold(0.0_f64, |most, g| most.max(g.abs()));
    if most <= MOST_GRAVITY_M_S2 {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("{}: run.gravity", scene.source),
        format!(
            "{most:.3e} m/s2 is more than {MOST_GRAVITY_M_S2:.0e} m/s2: the time step would be so small that the run never ends"
        ),
        "write it in m/s2, such as [0, 0, -9.81]",
    ))
}

/// Bodies that meet, or are fed, in a scene in which nothing can touch.
fn without_contacts(scene: &Scene, state: &State, bodies: &[PlacedBody]) -> Option<String> {
    if state.contacts.is_some() || scene.run.integrator == Integrator::Static {
        return None;
    }
    if !scene.inlets.is_empty() {
        return Some(
            "nothing that the inlets feed can touch anything: [contacts] is empty; say there how the materials meet"
                .to_owned(),
        );
    }
    passes_through(state, bodies, scene.run.end_time_s)
}

fn refuse_damped_clumps(scene: &Scene, state: &State) -> Result<()> {
    if state.has_no_lasting_clump() || state.model.particle_damping <= 0.0 {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("{}: run.local_damping", scene.source),
        "it has no effect on clumps",
        "remove it, or start bodies as \"bonded\"",
    ))
}

/// Where damping is not weak by its bound, finds how fast it is.
fn bound_damping(state: &mut State) {
    let mut arriving = arriving_as_clusters(state);
    let of_arriving = arriving.iter().map(|state| state.damping_rate_1_s);
    let bound_1_s = of_arriving.fold(state.damping_rate_1_s, f64::max);
    if state.time_step_s * bound_1_s <= WEAK {
        return;
    }
    let of_arriving = arriving.iter_mut().map(damping_bound_1_s);
    let largest_1_s = of_arriving.fold(damping_bound_1_s(state), f64::max);
    state.most_damping_rate_1_s = largest_1_s;
    state.damping_rate_1_s = state.damping_rate_1_s.min(largest_1_s);
}

/// Refuses damping of bonds so strong that a step would take very many passes over them.
fn refuse_endless_damping(scene: &Scene, state: &State) -> Result<()> {
    let rate = state.time_step_s * state.damping_rate_1_s;
    let most = limit(MOST);
    if rate <= most {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("{}: damping of [bonds]", scene.source),
        format!(
            "it slows a particle down {rate:.1e} times in a step, and at most {most:.1e} can be computed"
        ),
        "write a smaller damping_ratio, damping_coefficient or structural_damping, or a smaller time step; above some 10, damping_ratio makes a bond stiff rather than damped",
    ))
}

/// Chooses the time step, and sets what follows from it in the state: the step itself, the largest
/// speed, the skin of the search for contacts.
fn first_step(
    scene: &Scene,
    bodies: &[PlacedBody],
    state: &mut State,
    allow_any_step: bool,
) -> Result<StepChoice> {
    let mut step = match scene.run.integrator {
        Integrator::Leapfrog => {
            let step = choose_step(scene, state, allow_any_step)?;
            refuse_endless_output(scene, step.step_s)?;
            step
        }
        Integrator::Static => {
            // Walls press the body of a test.
            if scene.test.is_none() {
                refuse_loose(state, bodies, &scene.source)?;
            }
            StepChoice::none(scene.run.end_time_s)
        }
    };
    state.time_step_s = step.step_s;
    choose_skin(scene, step.impact_speed_m_s, state);
    state.fastest_m_s = step.impact_speed_m_s;
    step.rayleigh_s = rayleigh_s(scene, state, bodies);
    Ok(step)
}

/// Names, materials and sizes of all bodies.
fn named_bodies(scene: &Scene, read: &BTreeMap<String, Body>) -> Vec<NamedBody> {
    let size_m = |name: &String| {
        let body = read.get(name);
        let spheres: Vec<Sphere> = body.map_or(Vec::new(), |body| {
            let both = body.positions.iter().zip(&body.radii);
            both.map(|(place, radius)| Sphere::of_unit_density(*place, *radius))
                .collect()
        });
        sieve_m(&spheres)
    };
    let radii_m = |name: &String| read.get(name).map_or(&[][..], |body| &body.radii);
    let smallest_diameter_m = |name: &String| {
        let radii_m = radii_m(name).iter().copied();
        2.0 * radii_m.fold(f64::INFINITY, f64::min)
    };
    let stays_rigid = |name: &String| {
        let is_clump = scene.bodies[name].start_as != StartAs::Bonded;
        is_clump && !scene.replacement.contains_key(name)
    };
    // Bodies of one sphere, and those that never break, are no fragments of a packing.
    let mean_diameter_m = |name: &String| match radii_m(name) {
        [] | [_] => 0.0,
        _ if stays_rigid(name) => 0.0,
        radii_m => {
            let cubes: f64 = radii_m.iter().map(|radius| radius.powi(3)).sum();
            2.0 * radii_m.iter().map(|radius| radius.powi(4)).sum::<f64>() / cubes
        }
    };
    let fine_fraction = |name: &String| {
        let volume = |largest_m: f64| -> f64 {
            let fine = radii_m(name)
                .iter()
                .filter(|radius| 2.0 * **radius < largest_m);
            fine.map(|radius| radius.powi(3)).sum()
        };
        volume(0.1 * size_m(name)) / volume(f64::INFINITY).max(f64::MIN_POSITIVE)
    };
    (scene.bodies.iter())
        .map(|(name, body)| NamedBody {
            name: name.clone(),
            material: body.material.clone(),
            sieve_m: size_m(name),
            smallest_diameter_m: smallest_diameter_m(name),
            mean_diameter_m: mean_diameter_m(name),
            fine_fraction: fine_fraction(name),
        })
        .collect()
}

/// Clusters, contacts and walls, if the scene needs them.
fn place_meetings(
    scene: &Scene,
    bodies: &[PlacedBody],
    state: &mut State,
    notes: &mut Vec<String>,
) -> Result<()> {
    let breaks = state.bonds.rules.iter().any(|rule| rule.criteria.is_some());
    let needs_clusters = |measure| Measurement::of(measure).needs_clusters;
    let counts_pieces = scene.measures.values().any(needs_clusters);
    let has_clumps = !state.clumps.templates.is_empty();
    if !(breaks || counts_pieces || has_clumps || are_needed(scene)) {
        return Ok(());
    }
    let mut clusters = Clusters::new(state.particles.len(), &state.bonds);
    for body in bodies {
        clusters.set_body(&body.particles, state.model.body_number(&body.name));
    }
    state.clusters = Some(clusters);
    let coming = standing(scene, &state.clumps.templates);
    if !coming.is_empty() {
        let changes = TopologyChange {
            coming,
            ..TopologyChange::default()
        };
        apply_topology_change(state, changes);
    }
    if are_needed(scene) {
        let kinds = Kinds::new(scene)?;
        if !scene.contacts.is_empty() {
            need_pairs(scene, &kinds, &state.clumps.templates)?;
        }
        place_contacts(scene, &kinds, bodies, state)?;
        state.walls = walls::place_walls(scene, &kinds, bodies, state, notes)?;
        let asked = scene.sleep.as_ref();
        state.sleep = asked.map(|_| Sleep::default());
        state.model.sleep = asked.map(|asked| SleepRule {
            speed_m_s: asked.speed_m_s,
            after_s: asked.after_s,
        });
        let models = state.walls.iter().map(|wall| Arc::clone(&wall.model));
        state.model.walls = models.collect();
    }
    Ok(())
}

fn supports(scene: &Scene, groups: &BTreeMap<String, Vec<u32>>) -> Result<Vec<GroupSupport>> {
    let mut held_by: BTreeMap<(u32, usize), &str> = BTreeMap::new();
    let mut supports = Vec::new();
    for (name, support) in &scene.supports {
        let particles = particles_of(groups, &support.group);
        for &particle in particles {
            for (k, _) in support
                .holds
                .iter()
                .enumerate()
                .filter(|(_, h)| h.is_some())
            {
                if let Some(other) = held_by.insert((particle, k), name) {
                    return Err(Diagnostic::input(
                        format!("{}: [supports.{name}]", scene.source),
                        format!(
                            "{} of a particle of '{}' is already held by [supports.{other}]",
                            DEGREES_OF_FREEDOM[k], support.group
                        ),
                        "hold each freedom of a particle once",
                    ));
                }
            }
        }
        supports.push(GroupSupport {
            holds: support.holds,
            factor: support.factor.clone(),
            end_s: support.end_s.unwrap_or(f64::INFINITY),
            held: particles
                .iter()
                .map(|&particle| HeldParticle {
                    particle,
                    ..HeldParticle::default()
                })
                .collect(),
        });
    }
    Ok(supports)
}

const DEGREES_OF_FREEDOM: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

fn loads(
    scene: &Scene,
    groups: &BTreeMap<String, Vec<u32>>,
    supports: &[GroupSupport],
) -> Result<Vec<GroupLoad>> {
    let mut loads = Vec::new();
    for (name, load) in &scene.loads {
        // Degrees of freedom released before the load ends can move with it.
        let end_s = load.end_s.unwrap_or(f64::INFINITY);
        let held =
            held_degrees_of_freedom(supports.iter().filter(|support| support.end_s >= end_s));
        let particles = particles_of(groups, &load.group);
        let fraction = 1.0 / particles.len() as f64;
        let six: Vec<f64> = load.force_n.into_iter().chain(load.torque_n_m).collect();
        for particle in particles {
            let Some(held) = held.get(particle) else {
                continue;
            };
            if let Some(k) = (0..6).find(|&k| held[k] && six[k] != 0.0) {
                return Err(Diagnostic::input(
                    format!("{}: [loads.{name}]", scene.source),
                    format!(
                        "{} {} {} acts on a particle of '{}' that a support holds there",
                        if k < 3 { "a force of" } else { "a torque of" },
                        six[k],
                        [
                            "N along x",
                            "N along y",
                            "N along z",
                            "N m about x",
                            "N m about y",
                            "N m about z"
                        ][k],
                        load.group
                    ),
                    "load particles that can move, or free them",
                ));
            }
        }
        loads.push(GroupLoad {
            particles: particles.to_vec(),
            force_n: load.force_n.map(|f| f * fraction),
            torque_n_m: load.torque_n_m.map(|t| t * fraction),
            factor: load.factor.clone(),
            end_s,
        });
    }
    Ok(loads)
}
