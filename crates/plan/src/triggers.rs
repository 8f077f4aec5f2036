//! When clumps become bonded clusters: what the scene's triggers are in the state, and triggers that
//! cannot work as intended.

use std::collections::BTreeMap;

use dem_io::body::About;
use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_scene::{Replacement, Scene};

use dem_engine::state::State;
use dem_engine::state::clumps::{Template, sphere_volume_m3};
use dem_engine::state::particles::Pose;
use dem_engine::state::rules::{Outlet, PrincipalStress, Touches, Trigger};
use dem_physics::geometry::Bounds;
use dem_physics::geometry::region::Region;
use dem_physics::shape::inertia::of_union;

/// What turns a clump into its cluster. None: nothing does. `number`: of a region.
pub(super) fn trigger(
    scene: &Scene,
    about: Option<&About>,
    template: &Template,
    number: impl Fn(&String) -> Option<usize>,
) -> Option<Trigger> {
    let rule = scene.replacement.get(&template.body)?;
    if rule.breaks_whole() {
        return None;
    }
    let when = &rule.when;
    Some(Trigger {
        enters: when.enters.as_ref().and_then(number),
        touches: touches(scene, &when.touches),
        force_n: when.force_n,
        contact_force_n: when.contact_force_n,
        principal_stress: when.principal_stress_pa.map(|limit_pa| {
            let of_shape = about.and_then(|about| about.shape_volume_m3);
            let volume_m3 = of_shape.unwrap_or_else(|| union_m3(template));
            PrincipalStress {
                limit_pa,
                volume_m3_kg: volume_m3 / template.mass_kg,
            }
        }),
        impact_energy_j: when.impact_energy_j,
        time_s: when.time_s,
        needs_all: rule.requires_all,
    })
}

/// The walls and bodies with these names, as in [`State::walls`] and the bodies of the model. None:
/// there are no names.
fn touches(scene: &Scene, names: &[String]) -> Option<Touches> {
    fn numbers<T>(names: &[String], known: &BTreeMap<String, T>) -> impl Iterator<Item = usize> {
        let number = |name| known.keys().position(|known| known == name);
        names.iter().filter_map(number)
    }
    (!names.is_empty()).then(|| Touches {
        walls: numbers(names, &scene.walls).collect(),
        bodies: numbers(names, &scene.bodies).map(|n| n as u32).collect(),
    })
}

/// Refuses a trigger by touch that names nothing which its body can touch.
pub(super) fn refuse_untouchable(scene: &Scene, template: &Template) -> Result<()> {
    let body = &template.body;
    let Some(rule) = scene.replacement.get(body) else {
        return Ok(());
    };
    let names = &rule.when.touches;
    let place = || format!("{}: replacement.{body}.when.touches", scene.source);
    if !names.is_empty() && scene.contacts.is_empty() {
        let problem = "nothing can touch anything: the scene has no [contacts]";
        return Err(Diagnostic::input(place(), problem, "add [contacts]"));
    }
    let inlets = scene.inlets.values().filter(|inlet| inlet.feeds(body));
    let counts = inlets.map(|inlet| inlet.count.unwrap_or(u32::MAX));
    let is_alone = counts.fold(0, u32::saturating_add) < 2 && !scene.walls.contains_key(body);
    if is_alone && !names.is_empty() && names.iter().all(|name| name == body) {
        let problem =
            format!("names '{body}' alone, of which there is one: it cannot touch itself");
        let remedy = "name a wall or another body";
        return Err(Diagnostic::input(place(), problem, remedy));
    }
    Ok(())
}

/// Refuses to make pieces rigid in which waves could still break bonds: those of a velocity v, which
/// carry a stress v sqrt(E rho).
pub(super) fn refuse_restless(scene: &Scene, template: &Template) -> Result<()> {
    let body = &template.body;
    let rule = scene.replacement.get(body);
    let kind = scene.bodies[body].bond_kind.as_ref();
    let (Some(restore), Some(kind)) = (rule.and_then(|rule| rule.restore.as_ref()), kind) else {
        return Ok(());
    };
    let strength_pa = template.breaks_from_n_m / sphere_volume_m3(&template.spheres);
    let modulus_pa = scene.bonds[kind].young_modulus_pa;
    let limit_m_s = strength_pa / (modulus_pa * template.sphere_density_kg_m3()).sqrt();
    let given_m_s = restore.fluctuation_velocity_m_s;
    if given_m_s < limit_m_s {
        return Ok(());
    }
    let [given, limit] = [given_m_s, limit_m_s].map(|v| significant(v, 3));
    Err(Diagnostic::input(
        format!(
            "{}: replacement.{body}.restore.fluctuation_velocity",
            scene.source
        ),
        format!("waves of {given} m/s still break bonds: strength / sqrt(E rho) is {limit} m/s"),
        format!("write at most {} m/s", significant(0.5 * limit_m_s, 2)),
    ))
}

/// Volume of the union of the spheres of a body, m3.
fn union_m3(template: &Template) -> f64 {
    let spheres = template.spheres.iter();
    let (centres, radii): (Vec<[f64; 3]>, Vec<f64>) = spheres
        .map(|sphere| (sphere.place_m, sphere.radius_m))
        .unzip();
    of_union(&centres, &radii, 1.0).mass_kg
}

/// Clumps that may never be replaced.
pub(super) fn replacement_doubts(scene: &Scene, state: &State) -> Vec<String> {
    let mut doubts = Vec::new();
    for (template, trigger) in state
        .clumps
        .templates
        .iter()
        .zip(&state.model.rules.triggers)
    {
        let body = &template.body;
        let by_daughters = scene
            .replacement
            .get(body)
            .is_some_and(Replacement::breaks_whole);
        if by_daughters && state.contacts.is_none() {
            doubts.push(format!(
                "replacement of '{body}': nothing can touch it, so it takes in no energy"
            ));
        }
        let Some(trigger) = trigger else {
            continue;
        };
        if let Some(time_s) = trigger.time_s.filter(|t| *t > scene.run.end_time_s) {
            doubts.push(format!(
                "replacement of '{body}': its time {time_s} s comes after the end of the run, {} s",
                scene.run.end_time_s
            ));
        }
        let away = trigger
            .enters
            .filter(|&region| is_away(&state.model.rules.regions[region], state));
        if away.is_some() {
            doubts.push(format!(
                "replacement of '{body}': its region lies away from all bodies, inlets and walls"
            ));
        }
        let outlets = state.model.rules.outlets.iter();
        let outlet = trigger.enters.and_then(|region| {
            let mut taking = outlets.filter(|outlet| is_in_outlet(region, outlet, state));
            taking.next()
        });
        if let Some(outlet) = outlet {
            doubts.push(format!(
                "replacement of '{body}': the outlet '{}' removes everything in its region at once; choose another region for one of them",
                outlet.name
            ));
        }
        if trigger.needs_contact() && state.contacts.is_none() {
            doubts.push(format!(
                "replacement of '{body}': nothing can touch it, so it meets no condition of a contact"
            ));
        }
    }
    doubts
}

/// Whether an outlet removes everything in a region: its own region is the same or, of a shape
/// without hollows, contains the corners of the other.
pub(super) fn is_in_outlet(region: usize, outlet: &Outlet, state: &State) -> bool {
    let regions = &state.model.rules.regions;
    let taken = &regions[outlet.region];
    let is_convex = !matches!(taken, Region::Inside(..));
    let contains_all = || {
        let corners = regions[region].bounds().corners();
        corners.iter().all(|corner| taken.contains(*corner))
    };
    !outlet.removes_outside && (outlet.region == region || is_convex && contains_all())
}

/// Whether a region is disjoint from the box around all bodies, inlets and walls.
fn is_away(region: &Region, state: &State) -> bool {
    let places = state.particles.poses.iter().map(Pose::place);
    let inlets = state.model.rules.inlets.iter();
    let inlets = inlets.map(|inlet| state.model.rules.regions[inlet.region].bounds());
    let walls = state
        .walls
        .iter()
        .map(dem_engine::state::walls::Wall::bounds_in_space);
    let all = inlets
        .chain(walls)
        .fold(Bounds::of(places), |all, one| all.with(&one));
    !region.bounds().overlaps(&all)
}
