//! What a scene has and LAMMPS has no word for: all of it is said at once.

use std::collections::HashSet;

use dem_io::text::counted;
use dem_io::{Diagnostic, Result};
use dem_scene::{InitialOverlap, Integrator, Scene};

use dem_engine::state::bodies::PlacedBody;
use dem_plan::Plan;

/// Groups that LAMMPS allows, without `all` and those of the export itself.
const MOST_GROUPS: usize = 27;
/// Overlap of bonded particles, relative to the distance at which they touch, that rounding may
/// cause.
const ROUNDING: f64 = 1e-9;

/// A part of a scene that LAMMPS has no word for.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Refusal {
    /// A table, `[walls.plate]`, or a key, `bonds.grain.model`, perhaps with its value.
    part: String,
    why: String,
    remedy: String,
}

/// All that is to be changed in a scene before LAMMPS can run it.
#[derive(Debug, Clone, Default)]
pub struct Refusals(Vec<Refusal>);

impl Refusals {
    /// Adds one, unless it is there.
    pub(super) fn add(
        &mut self,
        part: impl Into<String>,
        why: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        let refusal = Refusal {
            part: part.into(),
            why: why.into(),
            remedy: remedy.into(),
        };
        if !self.0.contains(&refusal) {
            self.0.push(refusal);
        }
    }

    /// Puts the last ones, from this number on, before all others.
    fn put_first(&mut self, from: usize) {
        self.0.rotate_left(from);
    }

    /// One error with what is to be done about each of them, in the order of their places, and why.
    /// `place_of`: file and line of a key such as `walls.plate`, if it is written.
    pub fn check(&self, scene: &Scene, place_of: &dyn Fn(&str) -> Option<String>) -> Result<()> {
        let place = |one: &Refusal| match place_of(key_of(&one.part)) {
            Some(place) => format!("{place}: {}", one.part),
            None => format!("{}: {}", scene.source, one.part),
        };
        let said = |one: &Refusal| {
            let Refusal { why, remedy, .. } = one;
            format!("{remedy}, as LAMMPS has no word for it: {why}")
        };
        match &self.0[..] {
            [] => Ok(()),
            [one] => Err(Diagnostic::input(place(one), said(one), "")),
            all => {
                let numbered: Vec<String> = (1..)
                    .zip(all)
                    .map(|(number, one)| format!("{number}. {}: {}", place(one), said(one)))
                    .collect();
                let problem = format!(
                    "{} things to change before LAMMPS can run it: {}",
                    all.len(),
                    numbered.join("; ")
                );
                Err(Diagnostic::input(scene.source.clone(), problem, ""))
            }
        }
    }
}

/// The key of a part: `walls.plate` of `[walls.plate]`, without its value.
fn key_of(part: &str) -> &str {
    let part = part.split([' ', ',']).next().unwrap_or(part);
    part.trim_start_matches('[').trim_end_matches(']')
}

/// What is not exported of a planned scene, apart from bonds, contacts, walls, loads and supports.
pub(super) fn refuse(scene: &Scene, plan: &Plan, refusals: &mut Refusals) {
    let groups = scene.loads.len() + scene.supports.len() + scene.materials.len();
    if groups > MOST_GROUPS {
        let why = format!("it has 32 groups, and loads, supports and materials need {groups}");
        refusals.add("[loads], [supports], [materials]", why, "join some of them");
    }
    if plan.state.particles.is_empty() {
        let why =
            "a run that begins without particles, as all bodies of this scene come from inlets";
        let remedy = "place a body at the start, or run the scene with dem-run";
        refusals.add("[inlets]", why, remedy);
    }
    if plan.state.contacts.is_some() {
        // It is packed again before anything else is tried.
        let known = refusals.0.len();
        refuse_overlaps(plan, refusals);
        refusals.put_first(known);
    }
}

/// The tables and keys of a scene that are not exported, known before it is planned.
pub fn refuse_parts(scene: &Scene) -> Refusals {
    let first = |names: Option<&String>| names.cloned().unwrap_or_default();
    let bonded_within = scene
        .bodies
        .iter()
        .find(|(_, body)| body.bonded_within.is_some());
    let beside_bond = scene
        .bonds
        .iter()
        .find(|(_, bond)| bond.contact_beside_bond);
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
            bonded_within.is_some(),
            format!(
                "bodies.{}.bonded_within",
                first(bonded_within.map(|(name, _)| name))
            ),
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
            beside_bond.is_some(),
            format!(
                "bonds.{}.contact_beside_bond",
                first(beside_bond.map(|(name, _)| name))
            ),
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
    let mut refusals = Refusals::default();
    for (_, part, why, remedy) in parts.into_iter().filter(|(is_there, ..)| *is_there) {
        refusals.add(part, why, remedy);
    }
    refusals
}

/// Refuses breakable bodies whose particles overlap: without the origin of the contact law at that
/// overlap they would fly apart when a bond breaks, or push each other from the start if no bond
/// joins them.
fn refuse_overlaps(plan: &Plan, refusals: &mut Refusals) {
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
                "{} of its particles overlap where a bond joins them, and its contact laws, which begin at no overlap, would push them apart when it breaks",
                counted(count, "pair")
            );
            let remedy =
                "pack it without overlap (dem-pack --overlap 0), or with bonds that cannot break";
            refusals.add(part, why, remedy);
            continue;
        }
        let joined: HashSet<[u32; 2]> = ends.iter().copied().collect();
        if near_pairs(plan, body).any(|pair| overlap(plan, pair) && !joined.contains(&pair)) {
            refusals.add(
                part,
                "two of its particles overlap without a bond, and LAMMPS would push them apart although they belong to one piece",
                "bond them (dem-pack --bond-range 1), or pack it without overlap (dem-pack --overlap 0)",
            );
        }
    }
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
