//! Regions, replacement, inlets and outlets of a scene.

use std::sync::Arc;

use dem_io::scene::{FeedRate, Region as SceneRegion, Scene, StartAs};
use dem_io::surface::read_open_surface;
use dem_io::{Diagnostic, Result};
use nalgebra::{UnitQuaternion, Vector3};

use crate::geometry::{Bounds, Mesh};
use crate::state::State;
use crate::state::clumps::{Template, numbers};
use crate::state::regions::Region;
use crate::state::rules::{Come, Feed, Inlet, Outlet, Rules, Start, Trigger};

/// What the scene says of when bodies come, go, and become others.
///
/// # Errors
/// A region's file that is no closed surface.
pub(super) fn rules(scene: &Scene, templates: &[Arc<Template>]) -> Result<Rules> {
    let mut regions = Vec::new();
    for (name, entry) in &scene.regions {
        let place = format!("{}: [regions.{name}]", scene.source);
        regions.push(region(entry).map_err(|error| error.within(&place))?);
    }
    let number = |name: &String| scene.regions.keys().position(|known| known == name);
    let template_of = |name: &str| templates.iter().position(|t| t.body == name);
    let triggers = templates.iter().map(|template| {
        let rule = scene.replacement.get(&template.body)?;
        Some(Trigger {
            enters: rule.enters.as_ref().and_then(number),
            force_n: rule.force_n,
            impact_energy_j: rule.impact_energy_j,
            time_s: rule.time_s,
            needs_all: rule.needs_all,
        })
    });
    let starts = templates.iter().map(|template| {
        let entry = &scene.bodies[&template.body];
        let turned = UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad));
        Start {
            bonded: entry.start_as == StartAs::Bonded && !template.bonds.is_empty(),
            turned: numbers(&turned),
        }
    });
    let inlets = scene.inlets.iter().map(|(name, inlet)| {
        let sum: f64 = inlet.bodies.iter().map(|(_, share)| share).sum();
        let templates = inlet.bodies.iter();
        let templates =
            templates.filter_map(|(name, share)| Some((template_of(name)? as u32, share / sum)));
        Inlet {
            name: name.clone(),
            templates: templates.collect(),
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
            come: Come::default(),
        }
    });
    let outlets = scene.outlets.iter().map(|(name, outlet)| Outlet {
        name: name.clone(),
        region: number(&outlet.region).unwrap_or(0),
        removes_outside: outlet.removes_outside,
        gone: (0, 0.0),
    });
    Ok(Rules {
        triggers: triggers.collect(),
        starts: starts.collect(),
        inlets: inlets.collect(),
        outlets: outlets.collect(),
        seed: scene.run.seed,
        regions,
        ..Rules::default()
    })
}

fn region(entry: &SceneRegion) -> Result<Region> {
    Ok(match entry {
        SceneRegion::Box { min_m, max_m } => Region::Box(Bounds {
            low: *min_m,
            high: *max_m,
        }),
        SceneRegion::Sphere { centre_m, radius_m } => Region::Sphere {
            centre_m: *centre_m,
            radius_m: *radius_m,
        },
        SceneRegion::Cylinder {
            from_m,
            to_m,
            radius_m,
        } => Region::Cylinder {
            from_m: *from_m,
            to_m: *to_m,
            radius_m: *radius_m,
        },
        SceneRegion::Stl { file, unit_m } => {
            let name = file.display().to_string();
            let bytes = std::fs::read(file).map_err(|error| {
                Diagnostic::input(
                    &name,
                    format!("cannot be read: {error}"),
                    "check its name: it counts from the scene's folder",
                )
            })?;
            let surface = read_open_surface(&bytes, &name, *unit_m)?;
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
                let share = [1, 2, 3].map(|of| crate::physics::random::uniform(n, &[of]));
                region.point(share).is_some()
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

/// What is odd about the rules but harmless, a sentence each: triggers that can never fire.
pub(super) fn doubts(scene: &Scene, state: &State) -> Vec<String> {
    let mut doubts = Vec::new();
    for (template, trigger) in state.clumps.templates.iter().zip(&state.rules.triggers) {
        let Some(trigger) = trigger else {
            continue;
        };
        let body = &template.body;
        if let Some(time_s) = trigger.time_s.filter(|t| *t > scene.run.end_time_s) {
            doubts.push(format!(
                "replacement of '{body}': its time {time_s} s comes after the end of the run, {} s",
                scene.run.end_time_s
            ));
        }
        let needs_contact = trigger.force_n.is_some() || trigger.impact_energy_j.is_some();
        if needs_contact && state.contacts.is_none() {
            doubts.push(format!(
                "replacement of '{body}': nothing can touch it, so force and impact energy stay 0"
            ));
        }
    }
    doubts
}
