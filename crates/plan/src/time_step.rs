//! The time step of a run: the exact limit, the choice, and common estimates for comparison.

use dem_io::{Diagnostic, Result};
use dem_scene::{IMPACT_ACCURACY, InitialOverlap, SAFETY, Scene, WallMotion};
use serde::Serialize;
use std::sync::Arc;

use nalgebra::Vector3;

use super::walls::{largest_step_s, refuse_long_step};
use dem_engine::check::limit::{Limit, limit, safe_step};
use dem_engine::check::linearised_contacts::impact::{at_impact, at_landing};
use dem_engine::check::linearised_contacts::{
    StiffestContacts, largest_contact_rate_1_s2, stiffest_contact,
};
use dem_engine::stages::population::change::apply_topology_change;
use dem_engine::stages::walls::fastest_point_m_s;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bonds::Bonds;
use dem_engine::state::clumps::{Clump, Template};
use dem_engine::state::clusters::Clusters;
use dem_engine::state::contacts::{ContactModel, Contacts};
use dem_engine::state::events::TopologyChange;
use dem_engine::state::particles::Particles;
use dem_engine::state::walls::Wall;
use dem_physics::contact::ImpactLaw;
use dem_physics::geometry::{Bounds, Shape};

/// Largest fraction of the smallest radius that a particle may move in a step.
pub const FARTHEST: f64 = 0.5;

/// The chosen step and its basis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepChoice {
    /// The chosen step, s; the first one if the step is adaptive.
    pub step_s: f64,
    /// Whether it was given by the scene.
    pub given: bool,
    /// The exact limit of the initial state.
    pub limit: Limit,
    /// Largest step that is also stable in the first impacts, as far as they can be predicted, s.
    pub foreseen_s: f64,
    /// Speed of those impacts, m/s.
    pub impact_speed_m_s: f64,
    /// Largest ratio of stiffness to mass of a contact that the step allows for, 1/s2.
    pub contact_rate_1_s2: f64,
    /// Rayleigh's estimate (Platzer 2022, eq. 14), s; infinite if no modulus is known.
    pub rayleigh_s: f64,
    /// 0.17 sqrt(m/K) (Platzer 2022, eq. 15), s; infinite without bonds.
    pub platzer_eq_15_s: f64,
    /// What limits an automatic step most, and what would limit it next.
    pub limited_by: [StepLimit; 2],
    /// Requirements once clumps have become clusters: `step_s` is based on them, unless it is
    /// adaptive.
    pub replaced: StepBasis,
}

/// A limit of the automatic step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StepLimit {
    /// Largest step that it allows, s.
    pub step_s: f64,
    /// Its reason, in words.
    pub reason: &'static str,
}

/// Requirements that the time step must meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepBasis {
    /// The smallest limit of existing bodies and those that may be added.
    pub limit: Limit,
    /// Largest step that is also stable in the first impacts, as far as they can be predicted, s.
    pub foreseen_s: f64,
    /// Speed of those impacts, m/s.
    pub impact_speed_m_s: f64,
    /// Largest ratio of stiffness to mass of a contact that the step allows for, 1/s2.
    pub contact_rate_1_s2: f64,
    /// Largest automatic step, s.
    pub step_s: f64,
    /// What limits it most, and what would limit it next.
    pub limited_by: [StepLimit; 2],
}

impl StepBasis {
    /// Largest adaptive step, s, if a run without `adaptive` takes steps of `plain_s`: no smaller
    /// one, where it is stable.
    pub fn step_s_beside(&self, plain_s: f64, safety: f64) -> f64 {
        self.step_s.max(plain_s.min(safety * self.foreseen_s))
    }

    /// From the present state and, if bodies may be added, `to_come`: see `arriving`.
    pub fn of(scene: &Scene, state: &mut State, to_come: Option<&mut State>) -> Self {
        let run = &scene.run;
        let impact_speed_m_s = impact_speed(scene, state);
        let mut found = limit(state);
        let mut rates = at_impact(state, impact_speed_m_s);
        let mut flat = at_landing(state, impact_speed_m_s);
        if let Some(to_come) = to_come {
            let later = limit(to_come);
            let all_iterations = found.all_iterations + later.all_iterations;
            if later.step_s < found.step_s {
                found = later;
            }
            found.all_iterations = all_iterations;
            let later = at_impact(to_come, impact_speed_m_s);
            rates = [0, 1, 2].map(|n| rates[n].max(later[n]));
            let later = at_landing(to_come, impact_speed_m_s);
            flat = [0, 1, 2].map(|n| flat[n].max(later[n]));
        }
        let [k, c, rate] = rates;
        let foreseen_s = found.bound().with_more([k, c]);
        let across = if state.contacts.is_some() {
            FARTHEST * state.smallest_radius_m() / impact_speed_m_s
        } else {
            f64::INFINITY
        };
        // A contact under load now is part of an impact: an adaptive step must not rise before its
        // end. Contacts under load from the start are treated like an impact, too. Each of them on
        // its own: the limit holds for all together.
        let keeps = run.initial_overlap == InitialOverlap::Keep;
        let [pressed_k, pressed_c] = if run.adaptive || keeps {
            stiffest_contact(state)
        } else {
            [0.0; 2]
        };
        let [share, flat_share] = shares(state, run.safety_factor, run.impact_accuracy);
        let mut limits = [
            (run.safety_factor * foreseen_s, "stability"),
            (share * safe_step(k, c), "impacts foreseen"),
            (
                flat_share * safe_step(flat[0], flat[1]),
                "flat landings of clumps",
            ),
            (
                share * safe_step(pressed_k, pressed_c),
                "contacts under load",
            ),
            (run.end_time_s / 100.0, "the end time"),
            (across, "the way of a particle in a step"),
            (largest_step_s(scene), "the period of a wall's motion"),
        ]
        .map(|(step_s, reason)| StepLimit { step_s, reason });
        limits.sort_by(|a, b| a.step_s.total_cmp(&b.step_s));
        Self {
            limit: found,
            foreseen_s,
            impact_speed_m_s,
            contact_rate_1_s2: rate.max(largest_contact_rate_1_s2(state, StiffestContacts::ALL)),
            step_s: limits[0].step_s,
            limited_by: [limits[0], limits[1]],
        }
    }
}

impl StepChoice {
    /// For a static run, which goes to its end in one step.
    pub fn none(end_s: f64) -> Self {
        let limit = Limit {
            step_s: f64::INFINITY,
            undamped_step_s: f64::INFINITY,
            omega_rad_s: 0.0,
            damping_1_s: 0.0,
            iterations: 0,
            all_iterations: 0,
        };
        let end = StepLimit {
            step_s: end_s,
            reason: "the end time",
        };
        let nothing = StepBasis {
            limit,
            foreseen_s: f64::INFINITY,
            impact_speed_m_s: 0.0,
            contact_rate_1_s2: 0.0,
            step_s: end_s,
            limited_by: [end; 2],
        };
        Self {
            step_s: end_s,
            given: false,
            limit,
            foreseen_s: f64::INFINITY,
            impact_speed_m_s: 0.0,
            contact_rate_1_s2: 0.0,
            rayleigh_s: f64::INFINITY,
            platzer_eq_15_s: f64::INFINITY,
            limited_by: [end; 2],
            replaced: nothing,
        }
    }

    /// Ratio of the step to the smaller of both limits.
    pub fn fraction_of_limit(&self) -> f64 {
        self.step_s / self.foreseen_s.min(self.limit.step_s)
    }
}

/// Chooses the step of a scene: the given one, or `safety` times the limit, slightly reduced so
/// that the end time is met. Refuses a given step above the limit, unless any step is allowed.
pub(crate) fn choose_step(
    scene: &Scene,
    state: &mut State,
    allow_any_step: bool,
) -> Result<StepChoice> {
    let run = &scene.run;
    let replaced = StepBasis::of(scene, state, arriving_as_clusters(state).as_mut());
    let mut basis = replaced;
    if run.adaptive {
        basis = StepBasis::of(scene, state, arriving(state).as_mut());
        basis.step_s = basis.step_s_beside(replaced.step_s, run.safety_factor);
    }
    let StepBasis {
        limit, foreseen_s, ..
    } = basis;
    if limit.step_s.is_nan() || limit.step_s <= 0.0 {
        return Err(Diagnostic::input(
            scene.source.clone(),
            format!("the largest stable time step is {} s", limit.step_s),
            "check the units of places, radii, density, modulus and damping",
        ));
    }
    if run.time_step_s.is_none() && run.safety_factor >= 1.0 && !allow_any_step {
        return Err(Diagnostic::input(
            format!("{}: run.safety_factor", scene.source),
            format!(
                "{} of the largest stable step is not stable",
                run.safety_factor
            ),
            "write 0.9, or --force-step to see what happens",
        ));
    }
    let step_s = match run.time_step_s {
        Some(given) => {
            if given > foreseen_s && !allow_any_step {
                return Err(Diagnostic::input(
                    format!("{}: run.time_step", scene.source),
                    format!("{given:.4e} s is above the largest stable step of {foreseen_s:.4e} s"),
                    "write time_step = \"auto\", or --force-step to see what happens",
                ));
            }
            if !allow_any_step {
                refuse_long_step(scene, given)?;
            }
            given
        }
        None => run.end_time_s / (run.end_time_s / basis.step_s).ceil(),
    };
    if !(step_s.is_finite() && step_s > 0.0) {
        return Err(Diagnostic::input(
            scene.source.clone(),
            format!(
                "the time step would be {step_s} s: impacts at {:.3e} m/s, an end after {:.3e} s",
                basis.impact_speed_m_s, run.end_time_s
            ),
            "check the units of speeds, rates and times",
        ));
    }
    Ok(StepChoice {
        step_s,
        given: run.time_step_s.is_some(),
        limit,
        foreseen_s,
        impact_speed_m_s: basis.impact_speed_m_s,
        contact_rate_1_s2: basis.contact_rate_1_s2,
        rayleigh_s: f64::INFINITY,
        platzer_eq_15_s: platzer_eq_15_s(state),
        limited_by: basis.limited_by,
        replaced,
    })
}

/// One body of each template as it is added: a clump, or a bonded cluster if its inlet feeds bonded
/// bodies. Their positions are such that they do not touch. None: there are no templates.
pub fn arriving(state: &State) -> Option<State> {
    coming(state, false)
}

/// As [`arriving`], with all bodies bonded that can be.
pub(crate) fn arriving_as_clusters(state: &State) -> Option<State> {
    coming(state, true)
}

/// One body of each shape; if clumps are `replaced`, as a cluster if it can become one. None: there
/// are no templates.
fn coming(state: &State, replaced: bool) -> Option<State> {
    let becomes_one = |n: usize| {
        let starts = state
            .model
            .rules
            .starts
            .get(n)
            .is_some_and(|start| start.bonded);
        let triggers = state
            .model
            .rules
            .triggers
            .get(n)
            .is_some_and(Option::is_some);
        starts || (replaced && triggers)
    };
    let templates = &with_smallest_daughters(state);
    // There may be many bodies from one file.
    let same = |a: usize, b: usize| {
        let [one, other] = [a, b].map(|n| &templates[n]);
        becomes_one(a) == becomes_one(b)
            && one.material == other.material
            && one.scale == other.scale
            && one.spheres == other.spheres
            && one.bonds == other.bonds
    };
    let mut shapes: Vec<usize> = Vec::new();
    for n in 0..templates.len() {
        if !shapes.iter().any(|&other| same(other, n)) {
            shapes.push(n);
        }
    }
    let all: Vec<Clump> = (shapes.iter())
        .map(|&n| Clump {
            template: n as u32,
            turned: [0.0, 0.0, 0.0, 1.0],
            ..Clump::default()
        })
        .collect();
    if all.is_empty() {
        return None;
    }
    let bonds = Bonds {
        rules: state.bonds.rules.clone(),
        ..Bonds::default()
    };
    let mut bonded = State::new(Particles::default(), bonds, 1.0, state.scratch.threads);
    bonded.clumps.templates.clone_from(templates);
    bonded.model.templates.clone_from(templates);
    bonded.clusters = Some(Clusters::new(0, &bonded.bonds));
    bonded.walls.clone_from(&state.walls);
    for wall in &mut bonded.walls {
        wall.touching.clear();
    }
    bonded.contacts = state.contacts.as_ref().map(|contacts| Contacts {
        model: Arc::new(ContactModel {
            kinds: contacts.model.kinds.clone(),
            kind_of: contacts.model.kind_of.clone(),
            ..ContactModel::default()
        }),
        ..Contacts::default()
    });
    let to_clusters = (0..all.len())
        .filter(|&at| becomes_one(shapes[at]))
        .collect();
    let come = TopologyChange {
        coming: all,
        ..TopologyChange::default()
    };
    let swap = TopologyChange {
        to_clusters,
        ..TopologyChange::default()
    };
    apply_topology_change(&mut bonded, come);
    apply_topology_change(&mut bonded, swap);
    Some(bonded)
}

/// The shapes, and for each that daughters can replace the smallest sphere that can come of it.
fn with_smallest_daughters(state: &State) -> Vec<Arc<Template>> {
    let mut templates = state.clumps.templates.clone();
    for (parent, rule) in state
        .clumps
        .templates
        .iter()
        .zip(&state.model.rules.daughters)
    {
        let radius_m = rule
            .as_ref()
            .map_or(f64::INFINITY, |rule| rule.smallest_radius_m);
        if radius_m.is_finite() {
            let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3);
            let mass_kg = parent.sphere_density_kg_m3() * volume_m3;
            templates.push(Arc::new(Template::sphere(parent, mass_kg, radius_m)));
        }
    }
    templates
}

/// pi R sqrt(rho/G) / (0.1631 nu + 0.8766), the smallest value of all particles that exist or may
/// be fed, each with its own material, s (Platzer 2022, eq. 14). Infinite: no particle has a
/// modulus.
pub fn rayleigh_s(scene: &Scene, state: &State, bodies: &[PlacedBody]) -> f64 {
    let of_material = |body: &str| {
        let material = scene.materials.get(&scene.bodies.get(body)?.material)?;
        let nu = material.poisson_ratio;
        let shear_pa = material.young_modulus_pa? / (2.0 * (1.0 + nu));
        Some(std::f64::consts::PI / (shear_pa.sqrt() * (0.1631 * nu + 0.8766)))
    };
    let p = &state.particles;
    let of_bodies = bodies.iter().flat_map(|body| {
        let factor = of_material(&body.name).unwrap_or(f64::INFINITY);
        body.particles.iter().map(move |&i| {
            let i = i as usize;
            factor * p.poses[i].radius_m() * p.density_kg_m3(i).sqrt()
        })
    });
    let of_templates = state.clumps.templates.iter().flat_map(|template| {
        let factor = of_material(&template.body).unwrap_or(f64::INFINITY);
        template.spheres.iter().map(move |sphere| {
            let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * sphere.radius_m.powi(3);
            factor * sphere.radius_m * (sphere.mass_kg / volume_m3).sqrt()
        })
    });
    of_bodies.chain(of_templates).fold(f64::INFINITY, f64::min)
}

/// 0.17 sqrt(m/K) with the lighter end and the normal stiffness of each bond, the smallest value of
/// all bonds (Platzer 2022, eq. 15).
fn platzer_eq_15_s(state: &State) -> f64 {
    let motions = &state.particles.motions;
    let bonds = &state.bonds;
    (0..bonds.len())
        .map(|at| {
            let [a, b] = bonds.ends[at].map(|end| motions[end as usize].inverse_mass);
            0.17 / (bonds.normal(at) * a.max(b)).sqrt()
        })
        .fold(f64::INFINITY, f64::min)
}

/// Upper bound of impact speeds until bonds or loads accelerate something, m/s: the relative speed
/// of particles and walls at the start, plus a fall through the entire scene. 0 if nothing can
/// touch.
fn impact_speed(scene: &Scene, state: &State) -> f64 {
    if state.contacts.is_none() {
        return 0.0;
    }
    let of_particles = state.particles.motions.iter().map(|m| m.velocity_m_s);
    let of_inlets = state
        .model
        .rules
        .inlets
        .iter()
        .map(|inlet| inlet.velocity_m_s);
    let of_particles = of_particles.chain(of_inlets);
    let of_walls = state.walls.iter().map(|wall| wall_speed(wall, state));
    let start_m_s =
        Bounds::of(of_particles.chain([[0.0; 3]])).diagonal_m() + of_walls.fold(0.0, f64::max);
    let gravity = Vector3::from(scene.run.gravity_m_s2);
    let g = gravity.norm();
    if g == 0.0 {
        return start_m_s;
    }
    let by_time = g * scene.run.end_time_s;
    let down = gravity / g;
    let fall_m = fall_m(state, &down).max(fall_from_inlets_m(state, &down));
    let by_height = (2.0 * g * fall_m).sqrt();
    start_m_s.hypot(by_time.min(by_height))
}

/// Largest speed of a wall near particles, m/s.
fn wall_speed(wall: &Wall, state: &State) -> f64 {
    let speed = |along: &[f64; 3], about: &[f64; 3]| {
        let norms = [along, about].map(|of| Vector3::from(*of).norm());
        fastest_point_m_s(wall, &state.particles, norms)
    };
    match &wall.model.motion {
        WallMotion::Fixed => 0.0,
        WallMotion::Velocity {
            velocity_m_s,
            spin_rad_s,
            factor,
        } => factor.largest() * speed(velocity_m_s, spin_rad_s),
        WallMotion::Displacement {
            displacement_m,
            angular_displacement_rad: turn_rad,
            factor,
        } => factor.steepest_1_s() * speed(displacement_m, turn_rad),
        WallMotion::Orbit(orbit) => orbit.speed_m_s(),
        WallMotion::Gyration(gyration) => {
            let spin = gyration.angular_velocity_rad_s(0.0);
            // Particles may come later.
            let corners = wall.model.shape.bounds().corners();
            let reach_m = corners.map(|corner| Vector3::from(corner).norm());
            let reach_m = reach_m.into_iter().fold(0.0, f64::max);
            let finite_m = if reach_m.is_finite() { reach_m } else { 0.0 };
            speed(&[0.0; 3], &spin).max(finite_m * Vector3::from(spin).norm())
        }
        WallMotion::Servo {
            max_velocity_m_s: largest_velocity_m_s,
            ..
        } => *largest_velocity_m_s,
        WallMotion::Bar { incident_m_s, .. } => 2.0 * incident_m_s,
        WallMotion::Weight { velocity_m_s, .. } => *velocity_m_s,
    }
}

/// Largest step that resolves an impact at this speed, m/s, as well as these require, s; infinite
/// if nothing can touch.
pub fn impact_step_s(state: &State, speed_m_s: f64, safety: f64, accuracy: f64) -> f64 {
    let [k, c, _] = at_impact(state, speed_m_s);
    let [flat_k, flat_c, _] = at_landing(state, speed_m_s);
    let [share, flat_share] = shares(state, safety, accuracy);
    (share * safe_step(k, c)).min(flat_share * safe_step(flat_k, flat_c))
}

/// Fractions of their own limits at which impacts of one sphere and flat landings of clumps are
/// resolved: those of landings follow those of impacts.
fn shares(state: &State, safety: f64, accuracy: f64) -> [f64; 2] {
    let of_impacts = |accuracy: f64| smallest_fraction(state, |law| law.impact_fraction(accuracy));
    let of_landings = smallest_fraction(state, |law| law.landing_fraction());
    let coarser = of_impacts(accuracy) / of_impacts(IMPACT_ACCURACY);
    // The factor is exactly 1 at the default safety.
    [of_impacts(accuracy), coarser * of_landings].map(|fraction| safety / SAFETY * fraction)
}

/// The smallest fraction of all contact laws of a scene, 1 at most.
fn smallest_fraction(state: &State, fraction: impl Fn(&dyn ImpactLaw) -> f64) -> f64 {
    let of_particles = state
        .contacts
        .iter()
        .flat_map(|contacts| &contacts.model.kinds);
    let kinds = of_particles.chain(state.walls.iter().flat_map(|wall| &wall.model.kinds));
    let fractions = kinds.map(|kind| fraction(kind.law.at_impact()));
    fractions.fold(1.0, f64::min)
}

/// Coordinate of the deepest corner of a box along `down`, m.
fn deepest(bounds: &Bounds, down: &Vector3<f64>) -> f64 {
    let depths = bounds
        .corners()
        .map(|corner| Vector3::from(corner).dot(down));
    depths.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// Largest height of fall along `down` from the highest point of an inlet to the lowest of a wall,
/// m.
fn fall_from_inlets_m(state: &State, down: &Vector3<f64>) -> f64 {
    let regions = (state.model.rules.inlets.iter())
        .map(|inlet| state.model.rules.regions[inlet.region].bounds());
    let tops = regions.flat_map(|bounds| bounds.corners());
    let tops = tops.map(|corner| Vector3::from(corner).dot(down));
    let top = tops.fold(f64::INFINITY, f64::min);
    let bottom = state.walls.iter().map(|wall| match &wall.model.shape {
        Shape::Plane(_) => Vector3::from(wall.frame.position_m).dot(down),
        _ => deepest(&wall.bounds_in_space(), down),
    });
    let bottom = bottom.fold(f64::NEG_INFINITY, f64::max);
    (bottom - top).max(0.0)
}

/// Largest height of fall along `down` before meeting a wall or another particle, m.
fn fall_m(state: &State, down: &Vector3<f64>) -> f64 {
    let heights = state.particles.poses.iter().map(|p| p.place().dot(down));
    let (mut high, mut low) = (f64::INFINITY, f64::NEG_INFINITY);
    for height in heights {
        high = high.min(height);
        low = low.max(height);
    }
    let mut farthest = low - high;
    for wall in &state.walls {
        let to_wall = match &wall.model.shape {
            Shape::Plane(_) => {
                let far = |pose: &dem_engine::state::particles::Pose| {
                    let mut found = Vec::new();
                    let centre = wall.frame.to_wall(pose.place().into());
                    wall.model.shape.touches(centre, f64::INFINITY, &mut found);
                    found.first().map_or(0.0, |touch| {
                        let normal = Vector3::from(wall.frame.direction_to_space(touch.normal));
                        let slope = normal.dot(down);
                        if slope > 0.05 {
                            touch.distance_m / slope
                        } else {
                            0.0
                        }
                    })
                };
                state.particles.poses.iter().map(far).fold(0.0, f64::max)
            }
            other => {
                let corners = other.bounds().corners();
                let depths =
                    corners.map(|corner| Vector3::from(wall.frame.to_space(corner)).dot(down));
                depths.into_iter().fold(f64::NEG_INFINITY, f64::max) - high
            }
        };
        farthest = farthest.max(to_wall);
    }
    farthest.max(0.0)
}
