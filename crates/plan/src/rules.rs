//! Regions, replacement, inlets and outlets of a scene.

use std::collections::BTreeMap;
use std::sync::Arc;

use dem_io::body::About;
use dem_io::random::uniform;
use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_scene::{FeedRate, Region as SceneRegion, Scene, SharesBy, StartAs};
use nalgebra::{UnitQuaternion, Vector3};

use super::daughters::{compliances, daughter_rules};
use super::triggers::{
    is_in_outlet, refuse_restless, refuse_untouchable, replacement_doubts, trigger,
};
use super::walls::surface_of;
use dem_engine::state::State;
use dem_engine::state::clumps::Template;
use dem_engine::state::rules::{Feed, Inlet, Outlet, Restore, Rules, Start};
use dem_engine::state::walls::Wall;
use dem_physics::geometry::region::Region;
use dem_physics::geometry::{Bounds, Mesh};
use dem_physics::rotation::numbers;

/// The rules of the scene for adding, removing and replacing bodies. `about`: information on the
/// bodies. Refuses a region whose file is not a closed surface.
pub(super) fn rules(
    scene: &Scene,
    templates: &[Arc<Template>],
    about: &BTreeMap<String, About>,
) -> Result<Rules> {
    let mut regions = Vec::new();
    for (name, entry) in &scene.regions {
        let place = format!("{}: [regions.{name}]", scene.source);
        regions.push(region(entry).map_err(|error| error.within(&place))?);
    }
    let number = |name: &String| scene.regions.keys().position(|known| known == name);
    for template in templates {
        refuse_restless(scene, template)?;
        refuse_untouchable(scene, template)?;
    }
    let triggers = templates
        .iter()
        .map(|template| trigger(scene, about.get(&template.body), template, number));
    let restores = templates.iter().map(|template| {
        let back = scene.replacement.get(&template.body)?.restore.as_ref()?;
        Some(Restore {
            leaves: back.leaves.as_ref().and_then(number),
            unbroken_for_s: back.unbroken_for_s.unwrap_or(0.0),
            min_particles: back.min_particles,
            strain_energy_j_kg: back.strain_energy_j_kg,
            inner_speed_m_s: back.fluctuation_velocity_m_s,
        })
    });
    let starts = templates.iter().map(|template| {
        let entry = &scene.bodies[&template.body];
        let turned = UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad));
        let is_replaced = scene.replacement.contains_key(&template.body)
            || scene.parent_of(&template.body).is_some();
        Start {
            bonded: entry.start_as == StartAs::Bonded && !template.bonds.is_empty(),
            sphere: template.spheres.len() == 1 && template.scale == 1.0 && !is_replaced,
            turned: numbers(&turned),
        }
    });
    let inlets = scene.inlets.iter().map(|(name, inlet)| Inlet {
        name: name.clone(),
        templates: shares_by_number(inlet, templates),
        region: number(&inlet.region).unwrap_or(0),
        feed: match inlet.rate {
            FeedRate::Number(per_s) => Feed::Number(per_s),
            FeedRate::Mass(kg_s) => Feed::Mass(kg_s),
        },
        velocity_m_s: inlet.velocity_m_s,
        spin_rad_s: inlet.angular_velocity_rad_s,
        random_orientation: inlet.random_orientation,
        between_s: [inlet.start_s, inlet.end_s],
        count: inlet.count.unwrap_or(u32::MAX),
    });
    let outlets = scene.outlets.iter().map(|(name, outlet)| Outlet {
        name: name.clone(),
        region: number(&outlet.region).unwrap_or(0),
        removes_outside: outlet.removes_outside,
    });
    let [compliances, wall_compliances] = compliances(scene);
    Ok(Rules {
        daughters: daughter_rules(scene, templates),
        compliances,
        wall_compliances,
        triggers: triggers.collect(),
        restores: restores.collect(),
        starts: starts.collect(),
        inlets: inlets.collect(),
        outlets: outlets.collect(),
        zones: Vec::new(),
        seed: scene.run.seed,
        regions,
    })
}

fn region(entry: &SceneRegion) -> Result<Region> {
    Ok(match entry {
        SceneRegion::Box(of) => Region::Box(Bounds {
            low: of.min_m,
            high: of.max_m,
        }),
        SceneRegion::Sphere(of) => Region::Sphere {
            centre_m: of.centre_m,
            radius_m: of.radius_m,
        },
        SceneRegion::Cylinder(of) => Region::Cylinder {
            from_m: of.from_m,
            to_m: of.to_m,
            radius_m: of.radius_m,
        },
        SceneRegion::Stl { file, unit_m } => {
            let name = file.display().to_string();
            let surface = surface_of(file, *unit_m, 1.0)?;
            let open_edges = Mesh::from_surface(&surface)?.content.open_edges;
            if open_edges > 0 {
                return Err(Diagnostic::input(
                    name,
                    format!("the surface is open: {open_edges} edges of one triangle only"),
                    "close it: a region is the inside of a closed surface",
                ));
            }
            let corners = |t: &[u32; 3]| t.map(|v| surface.vertices_m[v as usize]);
            let triangles: Vec<_> = surface.triangles.iter().map(corners).collect();
            let bounds = Bounds::of(surface.vertices_m.iter().copied());
            let region = Region::Inside(triangles, bounds);
            let centre = [0, 1, 2].map(|k| 0.5 * (bounds.low[k] + bounds.high[k]));
            let is_somewhere = (0..1000).any(|n| {
                let fraction = [1, 2, 3].map(|of| dem_io::random::uniform(n, &[of]));
                region.point(fraction).is_some()
            });
            if !is_somewhere && !region.contains(centre) {
                return Err(Diagnostic::input(
                    name,
                    "no point is inside this surface",
                    "give a closed surface",
                ));
            }
            region
        }
    })
}

/// Rules that cannot work as intended, a sentence each: triggers that never fire, inlets that feed
/// nothing, bodies that have to wait.
pub(super) fn doubts(scene: &Scene, state: &State) -> Vec<String> {
    let mut doubts = replacement_doubts(scene, state);
    doubts.extend(sleep_doubt(scene));
    for inlet in &state.model.rules.inlets {
        doubts.extend(inlet_doubts(scene, state, inlet));
    }
    doubts
}

/// Number of points of an inlet's region that are looked for in a closed surface.
const SAMPLES: u64 = 100;

/// Whether the region of an inlet lies inside a closed surface, as far as samples show.
fn is_inside(inlet: &Inlet, wall: &Wall, state: &State) -> bool {
    if wall.model.shape.mesh().is_none() {
        return false;
    }
    let region = &state.model.rules.regions[inlet.region];
    let samples = (0..SAMPLES).filter_map(|n| region.point([0, 1, 2].map(|k| uniform(n, &[k]))));
    let mut count = 0;
    let mut inside = samples.inspect(|_| count += 1);
    inside.all(|point| wall.model.shape.holds(wall.frame.to_wall(point))) && count > 0
}

/// Bodies that fall asleep in flight.
fn sleep_doubt(scene: &Scene) -> Option<String> {
    let sleep = scene.sleep.as_ref()?;
    let g = Vector3::from(scene.run.gravity_m_s2).norm();
    // Time on the way up and down again.
    let turning_s = 2.0 * sleep.speed_m_s / g;
    (sleep.after_s < turning_s).then(|| {
        format!(
            "sleep: a body that flies is slower than {} m/s for {} s where it turns, and falls asleep there: sleep.after should be longer",
            significant(sleep.speed_m_s, 4),
            significant(turning_s, 4)
        )
    })
}

/// The templates of an inlet's bodies and their shares by number, whose sum is 1.
fn shares_by_number(inlet: &dem_scene::Inlet, templates: &[Arc<Template>]) -> Vec<(u32, f64)> {
    let share = |(name, share): &(String, f64)| {
        let template = templates.iter().position(|t| t.body == *name)?;
        let by_number = match inlet.shares_by {
            SharesBy::Number => *share,
            SharesBy::Mass => share / templates[template].mass_kg,
        };
        Some((template as u32, by_number))
    };
    let mut shares: Vec<(u32, f64)> = inlet.bodies.iter().filter_map(share).collect();
    let sum: f64 = shares.iter().map(|(_, share)| share).sum();
    for (_, share) in &mut shares {
        *share /= sum;
    }
    shares
}

/// An inlet that starts too late, whose bodies are removed immediately, or have to wait.
fn inlet_doubts(scene: &Scene, state: &State, inlet: &Inlet) -> Vec<String> {
    let mut doubts = Vec::new();
    if inlet.between_s[0] >= scene.run.end_time_s {
        doubts.push(format!(
            "inlet '{}': it starts at {} s, and the run ends at {} s",
            inlet.name,
            significant(inlet.between_s[0], 6),
            significant(scene.run.end_time_s, 6)
        ));
    }
    for outlet in &state.model.rules.outlets {
        if is_in_outlet(inlet.region, outlet, state) {
            doubts.push(format!(
                "outlet '{}': the region of inlet '{}' lies inside its own, so what is fed is removed immediately",
                outlet.name, inlet.name
            ));
        }
    }
    let gate = state.model.rules.regions[inlet.region].bounds();
    for outlet in state
        .model
        .rules
        .outlets
        .iter()
        .filter(|outlet| outlet.removes_outside)
    {
        if !gate.overlaps(&state.model.rules.regions[outlet.region].bounds()) {
            doubts.push(format!(
                "outlet '{}': the region of inlet '{}' lies outside its own, so what is fed is removed immediately",
                outlet.name, inlet.name
            ));
        }
    }
    let buried = state
        .walls
        .iter()
        .find(|wall| is_inside(inlet, wall, state));
    if let Some(wall) = buried {
        doubts.push(format!(
            "inlet '{}': its region lies inside the closed surface of the wall '{}', whose normals look outwards: a solid, in which no body finds room; if it is a container, export it with its normals inwards",
            inlet.name, wall.model.name
        ));
    }
    if let Some((places, most_per_s)) = places(inlet, state)
        && f64::from(inlet.count) > places
    {
        let wanted = match inlet.feed {
            Feed::Number(per_s) => per_s,
            Feed::Mass(kg_s) => {
                let mean = inlet.templates.iter();
                let mean = mean
                    .map(|(t, fraction)| fraction * state.clumps.templates[*t as usize].mass_kg);
                kg_s / mean.sum::<f64>()
            }
        };
        if wanted > most_per_s {
            doubts.push(format!(
                "inlet '{}': {} bodies per second are wanted, and at its velocity places for about {} become free: some will wait",
                inlet.name,
                significant(wanted, 4),
                significant(most_per_s, 2)
            ));
        }
    }
    doubts
}

/// Approximate number of bodies that find room in the region of an inlet, and how many can leave it
/// per second. None: they do not move by themselves.
fn places(inlet: &Inlet, state: &State) -> Option<(f64, f64)> {
    let speed = Vector3::from(inlet.velocity_m_s).norm();
    let reaches = inlet.templates.iter();
    let reaches = reaches.map(|(t, _)| 2.0 * state.clumps.templates[*t as usize].reach_m);
    let wide_m = reaches.fold(0.0, f64::max);
    if speed == 0.0 || wide_m == 0.0 {
        return None;
    }
    let Bounds { low, high } = state.model.rules.regions[inlet.region].bounds();
    let places: f64 = (0..3)
        .map(|k| ((high[k] - low[k]) / wide_m).floor() + 1.0)
        .product();
    Some((places, places * speed / wide_m))
}
