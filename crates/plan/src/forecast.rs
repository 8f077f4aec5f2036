//! Forecast of a run: first contacts of bodies and their times, the feed of inlets, and resulting
//! doubts about the scene.

use dem_io::units::significant;
use dem_scene::{FeedRate, Scene};
use serde::Serialize;

use dem_engine::check::flight::{FreeBody, Meeting, can_meet, free_bodies, standing_bodies};
use dem_engine::check::validity::foreseen;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::step::all_bytes;

use super::alike::told_once;
use super::time_step::arriving_as_clusters;

/// Largest number of bodies whose first contacts are predicted.
const MOST_BODIES: usize = 8;
/// Part of a body that rounding of times may add.
const ROUNDING: f64 = 1e-9;
/// Number of times at which a flying body is tested for being in a region.
const MOMENTS: usize = 10_000;

/// Forecast of a run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Forecast {
    /// First contacts of bodies, a sentence each.
    pub first_contacts: Vec<String>,
    /// Expected feed of inlets.
    pub to_come: Vec<InletForecast>,
    /// Reasons against running the scene as it is, a sentence each. The run reports at its end
    /// whether they came true.
    pub warnings: Vec<String>,
}

/// Expected feed of an inlet until the end, if all bodies find room.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InletForecast {
    /// Name of the inlet.
    pub inlet: String,
    /// Number of bodies.
    pub bodies: f64,
    /// Number of their spheres, once bonded.
    pub spheres: f64,
    /// Number of their bonds.
    pub bonds: f64,
    /// Their memory once bonded, if none leaves, bytes.
    pub bytes: f64,
}

/// Forecast for a scene that is ready to step and whose impacts do not exceed this speed, m/s.
pub(super) fn forecast(
    scene: &Scene,
    state: &State,
    bodies: &[PlacedBody],
    impact_speed_m_s: f64,
) -> Forecast {
    let arriving = arriving_as_clusters(state);
    let meets = can_meet(state, scene);
    let mut forecast = Forecast {
        warnings: foreseen(state, bodies, meets.then_some(impact_speed_m_s)),
        to_come: to_come(scene, state, arriving.as_ref()),
        ..Forecast::default()
    };
    if scene.test.is_none() && meets {
        meetings(scene, state, bodies, &mut forecast);
    }
    forecast.warnings = told_once(forecast.warnings, scene.bodies.keys());
    forecast
}

fn meetings(scene: &Scene, state: &State, bodies: &[PlacedBody], forecast: &mut Forecast) {
    let flying = free_bodies(state, bodies, 0.0);
    let mut all = flying.clone();
    all.extend(standing_bodies(state, bodies));
    let end_s = scene.run.end_time_s;
    let end = significant(end_s, 4);
    let mut seen: Vec<&str> = Vec::new();
    for flyer in &flying {
        let name = flyer.name.as_str();
        if seen.contains(&name) || seen.len() == MOST_BODIES {
            continue;
        }
        seen.push(name);
        let meets_after_s = match flyer.first_meeting(&state.walls, &all) {
            Meeting::Unknown => continue,
            Meeting::Never => {
                let line = format!("'{name}' never meets anything in free flight");
                if scene.inlets.is_empty() {
                    forecast.warnings.push(format!(
                        "{line}: check its position and velocity, gravity and the walls"
                    ));
                }
                forecast.first_contacts.push(line);
                f64::INFINITY
            }
            Meeting::At {
                after_s,
                wall,
                speed_m_s,
            } => {
                let [at, speed] = [after_s, speed_m_s].map(|x| significant(x, 4));
                if after_s > end_s {
                    forecast.warnings.push(format!(
                        "'{name}' would meet the wall '{wall}' at {at} s, and the run ends at {end} s: nothing will have touched it; set run.end_time later"
                    ));
                }
                let line = format!("'{name}' meets the wall '{wall}' at {at} s, {speed} m/s fast");
                forecast.first_contacts.push(line);
                after_s
            }
        };
        regions(scene, state, flyer, meets_after_s, forecast);
    }
}

/// Time at which a body that is replaced in a region reaches it in free flight, if it does.
fn regions(scene: &Scene, state: &State, flyer: &FreeBody, until_s: f64, forecast: &mut Forecast) {
    let rule = scene.replacement.get(&flyer.name);
    let Some(name) = rule.and_then(|rule| rule.when.enters.as_ref()) else {
        return;
    };
    let Some(number) = scene.regions.keys().position(|region| region == name) else {
        return;
    };
    let region = &state.model.rules.regions[number];
    let end_s = until_s.min(scene.run.end_time_s);
    let mut moments = (0..=MOMENTS).map(|n| end_s * n as f64 / MOMENTS as f64);
    let body = &flyer.name;
    match moments.find(|&at_s| region.contains(flyer.centre_after(at_s).into())) {
        Some(at_s) => forecast.first_contacts.push(format!(
            "'{body}' enters the region '{name}' at {} s",
            significant(at_s, 4)
        )),
        None if until_s > scene.run.end_time_s => forecast.warnings.push(format!(
            "'{body}' does not enter the region '{name}' by the end of the run, {} s, and stays rigid: set run.end_time later, or check the region",
            significant(scene.run.end_time_s, 4)
        )),
        None => {}
    }
}

fn to_come(scene: &Scene, state: &State, arriving: Option<&State>) -> Vec<InletForecast> {
    let bytes_each = arriving.map_or(0.0, |arriving| {
        let items = arriving.particles.len() + arriving.bonds.len();
        all_bytes(arriving) as f64 / items.max(1) as f64
    });
    let inlets = state.model.rules.inlets.iter().zip(scene.inlets.values());
    inlets
        .map(|(inlet, asked)| {
            let mean = |of: &dyn Fn(&dem_engine::state::clumps::Template) -> f64| -> f64 {
                let each = inlet.templates.iter();
                each.map(|(t, fraction)| fraction * of(&state.clumps.templates[*t as usize]))
                    .sum()
            };
            let mass_kg = mean(&|template| template.mass_kg);
            let per_s = match asked.rate {
                FeedRate::Number(per_s) => per_s,
                FeedRate::Mass(kg_s) => kg_s / mass_kg,
            };
            let [start_s, end_s] = inlet.between_s;
            let for_s = end_s.min(scene.run.end_time_s) - start_s;
            // None comes at the very end.
            let bodies = (for_s * per_s - ROUNDING).ceil().max(0.0);
            let bodies = bodies.min(f64::from(inlet.count));
            let spheres = bodies * mean(&|template| template.spheres.len() as f64);
            let bonds = bodies * mean(&|template| template.bonds.len() as f64);
            InletForecast {
                inlet: inlet.name.clone(),
                bodies,
                spheres,
                bonds,
                bytes: bytes_each * (spheres + bonds),
            }
        })
        .collect()
}
