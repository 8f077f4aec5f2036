//! Contacts of a scene: materials, the contact law of each pair of materials, and the pairs of
//! particles in contact at the start.

use std::sync::Arc;

use dem_io::{Diagnostic, Result};
use dem_scene::{Contact, ContactLaw, InitialOverlap, Material, Scene};

use dem_engine::stages::contacts::forces::{list_contacts, overlap_m};
use dem_engine::state::State;
use dem_engine::state::bodies::{PlacedBody, called};
use dem_engine::state::bridges::Bridges;
use dem_engine::state::clusters::Clusters;
use dem_engine::state::contacts::{ContactHistory, ContactModel, Contacts, NO_KIND};
use dem_physics::contact::law::ContactKind;
use dem_physics::contact::law::Law;
use dem_physics::contact::law::dmt::DerjaguinMullerToporov;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::liquid_bridge::LiquidBridge;
use dem_physics::contact::pair_parameters::{Elastic, PairInput};

/// Verlet skin as a fraction of the largest radius, unless the scene sets it or objects are fast;
/// and the largest such fraction.
const SKIN: [f64; 2] = [0.1, 0.5];
/// Smallest and largest distance that a particle may move between two searches for its neighbours,
/// as fractions of its radius, unless the scene sets the skin.
const ALLOWANCES: [f64; 2] = [0.05, 0.5];
/// Number of steps for which a list of near pairs should last at the speed of the first impacts.
const STEPS_PER_LIST: f64 = 30.0;
/// Ends that overlap at the start by less than this fraction of the smaller radius are only
/// touching: files are rounded.
pub(super) const ROUNDING: f64 = 1e-6;
/// Number of materials that fit into a byte, besides one value for none.
const MOST_MATERIALS: usize = 255;

/// Types of contacts, and the type of each pair of materials.
pub(super) struct Kinds<'a> {
    /// Names of the materials, by number.
    names: Vec<&'a str>,
    /// In the order of [`Scene::contacts`].
    pub(super) kinds: Vec<ContactKind>,
    /// Row by row; [`NO_KIND`] if the scene does not define the pair. Length materials squared.
    of_pair: Vec<u8>,
}

impl<'a> Kinds<'a> {
    /// Refuses more materials or pairs than fit into a byte.
    pub(super) fn new(scene: &'a Scene) -> Result<Self> {
        let names: Vec<&str> = scene.materials.keys().map(String::as_str).collect();
        let count = names.len();
        let pairs = scene.contacts.len();
        if count > MOST_MATERIALS || pairs > MOST_MATERIALS {
            return Err(Diagnostic::input(
                &scene.source,
                format!("the scene has {count} materials and {pairs} pairs in [contacts]"),
                format!("use {MOST_MATERIALS} of each at most"),
            ));
        }
        let mut of_pair = vec![NO_KIND; count * count];
        for (kind, contact) in (0..).zip(&scene.contacts) {
            let [a, b] = [0, 1].map(|end| number(&names, &contact.materials[end]));
            of_pair[a * count + b] = kind;
            of_pair[b * count + a] = kind;
        }
        Ok(Self {
            kinds: scene.contacts.iter().map(|c| kind(scene, c)).collect(),
            names,
            of_pair,
        })
    }

    /// Number of a material.
    pub(super) fn material(&self, name: &str) -> usize {
        number(&self.names, name)
    }

    /// The types of contacts of a material with all materials.
    pub(super) fn row(&self, material: usize) -> &[u8] {
        let count = self.names.len();
        &self.of_pair[material * count..(material + 1) * count]
    }

    /// Refuses a pair of materials without a contact law. `who` describes what needs it, and is
    /// asked only then: there may be thousands of bodies.
    pub(super) fn need(
        &self,
        scene: &Scene,
        pair: [usize; 2],
        who: impl FnOnce() -> String,
    ) -> Result<()> {
        if self.row(pair[0])[pair[1]] != NO_KIND {
            return Ok(());
        }
        let [a, b] = pair.map(|material| self.names[material]);
        Err(Diagnostic::input(
            format!("{}: [contacts]", scene.source),
            format!(
                "no contact law for the material pair {a}-{b}, which {}",
                who()
            ),
            format!("add {a}-{b} = {{ restitution = 0.5, friction = 0.5 }} to [contacts]"),
        ))
    }
}

fn number(names: &[&str], name: &str) -> usize {
    names.iter().position(|n| *n == name).unwrap_or_default()
}

fn kind(scene: &Scene, contact: &Contact) -> ContactKind {
    let pair_input = PairInput::new(contact.restitution, contact.friction);
    let elastic = |name: &String| {
        let material: Option<&Material> = scene.materials.get(name);
        Elastic {
            young_modulus_pa: material
                .and_then(|m| m.young_modulus_pa)
                .unwrap_or(f64::INFINITY),
            poisson_ratio: material.map_or(0.0, |m| m.poisson_ratio),
        }
    };
    let [a, b] = &contact.materials;
    ContactKind {
        law: match contact.law {
            ContactLaw::HertzMindlin => {
                Law::HertzMindlin(HertzMindlin::new([elastic(a), elastic(b)], &pair_input))
            }
            ContactLaw::Dmt {
                work_of_adhesion_j_m2,
            } => Law::DerjaguinMullerToporov(DerjaguinMullerToporov {
                hertz_mindlin: HertzMindlin::new([elastic(a), elastic(b)], &pair_input),
                work_of_adhesion_j_m2,
            }),
            ContactLaw::Linear {
                normal_n_m,
                tangential_stiffness_ratio: tangential_ratio,
            } => Law::Linear(Linear::new(normal_n_m, tangential_ratio, &pair_input)),
        },
        bridge: contact.liquid_bridge.map(|bridge| LiquidBridge {
            surface_tension_n_m: bridge.surface_tension_n_m,
            contact_angle_rad: bridge.contact_angle_rad,
            volume_m3: bridge.volume_m3,
        }),
        rolling: contact.rolling,
    }
}

/// Whether the particles of a scene can touch each other or walls, according to the scene.
pub(super) fn are_needed(scene: &Scene) -> bool {
    !scene.contacts.is_empty() || !scene.walls.is_empty()
}

/// Puts contacts into a state whose clusters are known.
///
/// # Errors
/// A pair of materials without a contact law that may meet; an overlap that is not allowed.
pub(super) fn place_contacts(
    scene: &Scene,
    kinds: &Kinds<'_>,
    bodies: &[PlacedBody],
    state: &mut State,
) -> Result<()> {
    let Some(clusters) = state.clusters.as_ref() else {
        return Ok(());
    };
    need_pairs(scene, kinds, bodies, clusters, state)?;
    let p = &state.particles;
    let mut materials = vec![0_u8; p.len()];
    for body in bodies {
        let material = kinds.material(&scene.bodies[&body.name].material);
        for &i in &body.particles {
            materials[i as usize] = material as u8;
        }
    }
    for clump in &state.clumps.all {
        materials[state.clumps.spheres_of(clump)].fill(state.clumps.template(clump).material);
    }
    let folds = scene.clusters.self_contact && can_fold(kinds, &materials, state, clusters);
    let model = ContactModel {
        kinds: kinds.kinds.clone(),
        kind_of: kinds.of_pair.clone(),
        alone: is_alone(state, clusters) && !folds,
        self_contact: folds,
        relaxes: scene.relaxation.enabled,
        least_overlap: scene.relaxation.min_overlap,
        allowances: scene.search.skin.is_none().then_some(ALLOWANCES),
    };
    let mut contacts = Contacts {
        // Present overlaps are not the result of a break: whether they relax depends only on
        // `initial_overlap`.
        model: Arc::new(ContactModel {
            relaxes: scene.run.initial_overlap != InitialOverlap::Keep,
            ..model.clone()
        }),
        materials,
        skin_m: scene.search.skin.unwrap_or(SKIN[0]) * state.largest_radius_m(),
        lost_j: vec![[0.0; 2]; p.len()],
        ..Contacts::default()
    };
    contacts.divide(p.len(), state.scratch.partitions.len().max(1));
    let skin_m = contacts.skin_m;
    list_contacts(&mut contacts, &clusters.of_particle, p, skin_m);
    refuse_same_place(scene, &contacts, bodies, state)?;
    match scene.run.initial_overlap {
        InitialOverlap::Refuse => refuse_overlaps(scene, &contacts, bodies, state)?,
        InitialOverlap::Relax => {}
        InitialOverlap::Keep => {
            refuse_swallowed(scene, &contacts, bodies, state)?;
            keep_overlaps(&mut contacts, state);
        }
    }
    contacts.model = Arc::new(model);
    state.model.contacts = Some(Arc::clone(&contacts.model));
    contacts.search_all();
    let is_wet = contacts
        .model
        .kinds
        .iter()
        .any(|kind| kind.bridge.is_some());
    state.bridges = is_wet.then(Bridges::default);
    state.contacts = Some(contacts);
    Ok(())
}

/// Turns overlaps into contacts that press as if they had been loaded before.
fn keep_overlaps(contacts: &mut Contacts, state: &State) {
    let poses = &state.particles.poses;
    for (&pair, history) in contacts.pairs.iter().zip(&mut contacts.histories) {
        *history = ContactHistory::pressed_by(overlap_m(poses, pair));
    }
    contacts.divide(state.particles.len(), contacts.scratch.wanted_partitions);
}

/// Whether a body is bonded, or may be later, whose material has a contact with itself.
fn can_fold(kinds: &Kinds<'_>, materials: &[u8], state: &State, clusters: &Clusters) -> bool {
    let touches = |material: u8| kinds.row(usize::from(material))[usize::from(material)] != NO_KIND;
    let is_bonded = |id: u32| {
        let first = clusters.members(id)[0] as usize;
        clusters.members(id).len() > 2 && first < state.particles.free && touches(materials[first])
    };
    let mut templates = state.clumps.templates.iter();
    templates.any(|template| !template.bonds.is_empty() && touches(template.material))
        || clusters.living().any(is_bonded)
}

/// Whether there is one piece that cannot break, and no other can be added.
fn is_alone(state: &State, clusters: &Clusters) -> bool {
    let of_clumps = state.clumps.templates.iter().any(|t| !t.bonds.is_empty());
    let has_bonds = of_clumps || !state.bonds.is_empty();
    let breaks = has_bonds && state.bonds.rules.iter().any(|rule| rule.criteria.is_some());
    let rules = &state.model.rules;
    let others_come = rules.make_daughters() || !rules.inlets.is_empty();
    let beside = state.bonds.rules.iter().any(|rule| rule.contact_beside);
    clusters.living().count() <= 1 && !breaks && !others_come && !beside
}

/// Chooses the skin of the pair list for impacts at this speed, m/s: the distance that both
/// particles may move in some steps.
pub(super) fn choose_skin(scene: &Scene, speed_m_s: f64, state: &mut State) {
    let (step_s, largest_m) = (state.time_step_s, state.largest_radius_m());
    if let (Some(contacts), None) = (&mut state.contacts, scene.search.skin) {
        let moved_m = 2.0 * STEPS_PER_LIST * speed_m_s * step_s;
        contacts.skin_m = moved_m.clamp(SKIN[0] * largest_m, SKIN[1] * largest_m);
    }
}

/// Checks that the scene defines a contact law for all pairs that can meet.
fn need_pairs(
    scene: &Scene,
    kinds: &Kinds<'_>,
    bodies: &[PlacedBody],
    clusters: &Clusters,
    state: &State,
) -> Result<()> {
    let material = |body: &PlacedBody| kinds.material(&scene.bodies[&body.name].material);
    let materials: Vec<usize> = bodies.iter().map(material).collect();
    for (n, body) in bodies.iter().enumerate() {
        let first = body.first_particle;
        let cluster_of = |i: &u32| clusters.of_particle[*i as usize];
        let is_in_pieces = body
            .particles
            .iter()
            .any(|i| cluster_of(i) != clusters.of_particle[first]);
        let breaks = body.bonds.first().is_some_and(|_| {
            let rule = state.bonds.rule_of(body.first_bond);
            state.bonds.rules[rule].criteria.is_some()
        });
        let beside = body.bonds.first().is_some_and(|_| {
            let rule = state.bonds.rule_of(body.first_bond);
            state.bonds.rules[rule].contact_beside
        });
        if beside {
            let who = || format!("contacts beside the bonds of the body '{}' need", body.name);
            kinds.need(scene, [materials[n]; 2], who)?;
        }
        if breaks || is_in_pieces {
            let why = if breaks {
                "can break into"
            } else {
                "consists of"
            };
            let who = || format!("pieces that the body '{}' {why} need", body.name);
            kinds.need(scene, [materials[n]; 2], who)?;
        }
        for (other, &of_other) in bodies.iter().zip(&materials).skip(n + 1) {
            let who = || format!("the bodies '{}' and '{}' need", body.name, other.name);
            kinds.need(scene, [materials[n], of_other], who)?;
        }
    }
    Ok(())
}

/// Refuses two particles at the same position: a force between them has no direction.
fn refuse_same_place(
    scene: &Scene,
    contacts: &Contacts,
    bodies: &[PlacedBody],
    state: &State,
) -> Result<()> {
    let poses = &state.particles.poses;
    let is_same = |pair: &&[u32; 2]| {
        let [a, b] = pair.map(|i| &poses[i as usize]);
        (b.place() - a.place()).norm() <= ROUNDING * a.radius_m().min(b.radius_m())
    };
    let Some(pair) = contacts.pairs.iter().find(is_same) else {
        return Ok(());
    };
    let [a, b] = pair.map(|i| called(bodies, &state.clumps, i));
    Err(Diagnostic::input(
        &scene.source,
        format!("{a} and {b} are at the same place"),
        "move one of the bodies",
    ))
}

/// Refuses particles that overlap by more than the radius of the smaller one.
fn refuse_swallowed(
    scene: &Scene,
    contacts: &Contacts,
    bodies: &[PlacedBody],
    state: &State,
) -> Result<()> {
    let poses = &state.particles.poses;
    let smaller_m = |pair: [u32; 2]| {
        let [a, b] = pair.map(|i| poses[i as usize].radius_m());
        a.min(b)
    };
    let is_swallowed = |pair: &&[u32; 2]| overlap_m(poses, **pair) > smaller_m(**pair);
    let Some(&pair) = contacts.pairs.iter().find(is_swallowed) else {
        return Ok(());
    };
    let [a, b] = pair.map(|i| called(bodies, &state.clumps, i));
    Err(Diagnostic::input(
        &scene.source,
        format!(
            "{a} and {b} overlap by {} at the start, more than the radius of the smaller, {}",
            dem_io::units::show_length(overlap_m(poses, pair)),
            dem_io::units::show_length(smaller_m(pair))
        ),
        "move the bodies apart: run.initial_overlap = \"keep\" is for bodies that rest on each other",
    ))
}

/// Refuses particles of different clusters that overlap: names the deepest pair.
fn refuse_overlaps(
    scene: &Scene,
    contacts: &Contacts,
    bodies: &[PlacedBody],
    state: &State,
) -> Result<()> {
    let poses = &state.particles.poses;
    let overlapping: Vec<(f64, [u32; 2])> = contacts
        .pairs
        .iter()
        .map(|&pair| (overlap_m(poses, pair), pair))
        .filter(|&(overlap, pair)| {
            let radii = pair.map(|i| poses[i as usize].radius_m());
            overlap > ROUNDING * radii[0].min(radii[1])
        })
        .collect();
    let Some((overlap, pair)) = overlapping.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Ok(());
    };
    let [a, b] = pair.map(|i| called(bodies, &state.clumps, i));
    let more = match overlapping.len() {
        1 => String::new(),
        count => format!(", the deepest of {count} such pairs"),
    };
    Err(Diagnostic::input(
        &scene.source,
        format!(
            "{a} and {b} overlap by {} at the start although no bond joins them{more}",
            dem_io::units::show_length(*overlap)
        ),
        "move the bodies apart; or run.initial_overlap = \"relax\" takes the overlap as the origin of the contact law, and \"keep\" applies the full contact force",
    ))
}
