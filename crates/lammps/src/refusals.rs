//! What a scene has and LAMMPS has no word for.

use std::collections::HashSet;

use dem_io::Result;
use dem_io::text::counted;
use dem_scene::{InitialOverlap, Integrator, Scene};

use super::words::refused;
use dem_engine::state::bodies::PlacedBody;
use dem_plan::Plan;

/// Groups that LAMMPS allows, without `all` and those of the export itself.
const MOST_GROUPS: usize = 27;
/// Overlap of bonded particles, relative to the distance at which they touch, that rounding may
/// cause.
const ROUNDING: f64 = 1e-9;

/// Refuses a planned scene with something that is not exported, apart from bonds, contacts, walls,
/// loads and supports.
pub(super) fn refuse(scene: &Scene, plan: &Plan) -> Result<()> {
    let groups = scene.loads.len() + scene.supports.len() + scene.materials.len();
    if groups > MOST_GROUPS {
        let why = format!("it has 32 groups, and loads, supports and materials need {groups}");
        return Err(refused(
            scene,
            "[loads], [supports], [materials]",
            why,
            "join some of them",
        ));
    }
    if plan.state.particles.is_empty() {
        let why =
            "a run that begins without particles, as all bodies of this scene come from inlets";
        let remedy = "place a body at the start, or run the scene with dem-run";
        return Err(refused(scene, "[inlets]", why, remedy));
    }
    if plan.state.contacts.is_some() {
        refuse_overlaps(scene, plan)?;
    }
    Ok(())
}

/// Refuses a scene with tables or keys that are not exported, before it is planned.
pub fn refuse_parts(scene: &Scene) -> Result<()> {
    let first = |names: Option<&String>| names.cloned().unwrap_or_default();
    let run_it = "leave it out, or run the scene with dem-run";
    let parts = [
        (
            scene.run.integrator == Integrator::Static,
            "run.integrator = \"static\"".to_owned(),
            "the exported run moves in time",
            "use \"leapfrog\", with local_damping and an end_time",
        ),
        (
            scene.test.is_some(),
            "[test]".to_owned(),
            "the rate, the end and the evaluation of a laboratory test",
            "write the walls and supports of the test as such, or run the scene with dem-run",
        ),
        (
            !scene.replacement.is_empty(),
            format!("[replacement.{}]", first(scene.replacement.keys().next())),
            "clumps that become bonded bodies, and particles that daughters replace",
            run_it,
        ),
        (
            scene
                .bodies
                .values()
                .any(|body| body.bonded_within.is_some()),
            "bonded_within".to_owned(),
            "bodies of which a part is rigid",
            run_it,
        ),
        (
            !scene.outlets.is_empty(),
            format!("[outlets.{}]", first(scene.outlets.keys().next())),
            "bodies that leave as a whole",
            run_it,
        ),
        (
            scene.bonds.values().any(|bond| bond.contact_beside_bond),
            "contact_beside_bond".to_owned(),
            "contact laws that begin at an overlap",
            run_it,
        ),
        (
            scene.sleep.is_some(),
            "[sleep]".to_owned(),
            "bodies that sleep",
            run_it,
        ),
        (
            scene.run.initial_overlap == InitialOverlap::Relax,
            "run.initial_overlap = \"relax\"".to_owned(),
            "contact laws that begin at an overlap",
            "move the bodies apart, or use \"keep\"",
        ),
    ];
    match parts.into_iter().find(|(is_there, ..)| *is_there) {
        Some((_, part, why, remedy)) => Err(refused(scene, part, why, remedy)),
        None => Ok(()),
    }
}

/// Refuses breakable bodies whose particles overlap: without the origin of the contact law at that
/// overlap they would fly apart when a bond breaks, or push each other from the start if no bond
/// joins them.
fn refuse_overlaps(scene: &Scene, plan: &Plan) -> Result<()> {
    let bonds = &plan.state.bonds;
    for body in plan.bodies.iter().filter(|body| !body.bonds.is_empty()) {
        if bonds.rules[bonds.rule_of(body.first_bond)]
            .criteria
            .is_none()
        {
            continue;
        }
        let ends = &bonds.ends[body.first_bond..body.first_bond + body.bonds.len()];
        let count = ends.iter().filter(|pair| overlap(plan, **pair)).count();
        let part = format!("[bodies.{}]", body.name);
        if count > 0 {
            let why = format!(
                "{} of its particles overlap where a bond joins them, and when it breaks they would fly apart: contact laws that begin at an overlap",
                counted(count, "pair")
            );
            return Err(refused(
                scene,
                part,
                why,
                "pack it without overlap (dem-pack --overlap 0), or with bonds that cannot break",
            ));
        }
        let joined: HashSet<[u32; 2]> = ends.iter().copied().collect();
        if near_pairs(plan, body).any(|pair| overlap(plan, pair) && !joined.contains(&pair)) {
            return Err(refused(
                scene,
                part,
                "two of its particles overlap without a bond, and LAMMPS would push them apart although they belong to one piece",
                "bond them (dem-pack --bond-range 1), or pack it without overlap",
            ));
        }
    }
    Ok(())
}

/// Whether two particles overlap at the start.
fn overlap(plan: &Plan, pair: [u32; 2]) -> bool {
    let [a, b] = pair.map(|i| &plan.state.particles.poses[i as usize]);
    let touching_m = a.radius_m() + b.radius_m();
    (b.place() - a.place()).norm() < touching_m * (1.0 - ROUNDING)
}

/// Pairs of particles of a body whose x differ by less than the largest diameter, the smaller
/// number first.
fn near_pairs(plan: &Plan, body: &PlacedBody) -> impl Iterator<Item = [u32; 2]> {
    let poses = &plan.state.particles.poses;
    let x = |i: u32| poses[i as usize].position_m[0];
    let radii = body.particles.iter().map(|i| poses[*i as usize].radius_m());
    let widest_m = 2.0 * radii.fold(0.0, f64::max);
    let mut sorted = body.particles.clone();
    sorted.sort_unstable_by(|a, b| x(*a).total_cmp(&x(*b)));
    (0..sorted.len()).flat_map(move |n| {
        let a = sorted[n];
        let after = sorted[n + 1..].iter().copied();
        let near = after.take_while(|b| x(*b) - x(a) < widest_m);
        let pairs: Vec<[u32; 2]> = near.map(|b| [a.min(b), a.max(b)]).collect();
        pairs
    })
}
