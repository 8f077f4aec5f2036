//! Daughters that replace particles (PRM: Platzer 2022, section 2.1.1).
//!
//! Mass, centre of mass, momentum and angular momentum are those of the parent. The daughters move
//! as one rigid body: of all motions with these momenta, the one with the least energy. They
//! overlap each other and what the parent pressed on: these overlaps are the origins of their
//! contact laws (Platzer 2022, section 4.3, algorithm 4), so that they exert no force. The elastic
//! energy of the parent's contacts, and the difference of kinetic energy, are recorded as lost.

use nalgebra::{Matrix3, Vector3};

use super::absorbed_energy::fracture_energy_j_kg;
use super::change::apply_topology_change;
use crate::stages::clumps::motion::kick_one;
use crate::stages::contacts::forces::{pair_force_n, touch_point_m};
use crate::stages::walls::{relax_touches, surface_velocity_m_s, touch_force_n};
use crate::state::State;
use crate::state::clumps::{Clump, SubSphere, Template, sphere_volume_m3};
use crate::state::events::{BrokenInto, PopulationEvent, TopologyChange};
use crate::state::population::FragmentTemplate;
use crate::state::rules::{DaughterRule, SizeClass};
use dem_io::random::hash;
use dem_physics::bond::scatter::{body_key, strength_factor};
use dem_physics::breakage::SMALLEST_T10;
use dem_physics::breakage::daughters::{arranged_m, diameters_m};
use dem_physics::rotation::{numbers, rotation};
use dem_physics::shape::packing_fit::fit;
use std::sync::Arc;

/// Radius of the ball in which daughters by a law are packed, over that of the particle, at least:
/// in less room their centres would meet.
const LEAST_BALL: f64 = 0.6;

/// A particle that daughters replace in this step.
struct Due {
    /// Number of the clump.
    clump: usize,
    /// What its daughters follow from.
    into: Origin,
    /// Energy over mass that it has taken in, J/kg.
    specific_j_kg: f64,
}

/// What the daughters of a particle follow from.
#[derive(Clone, Copy)]
enum Origin {
    /// The size class with this number.
    Class(usize),
    /// The breakage law, with this t10.
    Law(f64),
}

/// The daughters of a particle, and the mass of the fragments that are too small to be made, kg.
struct Daughters {
    clumps: Vec<Clump>,
    fines_kg: f64,
}

/// Replaces the particles that have taken in enough energy, between a kick and the drift after it.
/// Returns the number of particles checked.
pub(crate) fn replace_by_daughters(state: &mut State) -> usize {
    if !state.model.rules.make_daughters() {
        return 0;
    }
    let checked = state.clumps.all.len();
    let due = due(state);
    if !due.is_empty() {
        replace(state, &due);
    }
    checked
}

/// The particles that have taken in the energy of a size class, and whose contacts press no harder
/// than before, or that have reached the last class: in ascending order.
fn due(state: &State) -> Vec<Due> {
    let rules = &state.model.rules;
    let mut left: Vec<u32> = (rules.daughters.iter().zip(&state.population.by_daughters))
        .map(|(rule, done)| {
            rule.as_ref()
                .map_or(0, |rule| rule.limit.saturating_sub(*done))
        })
        .collect();
    let mut due = Vec::new();
    for (n, clump) in state.clumps.all.iter().enumerate() {
        let base = state.base_of(clump.template) as usize;
        let Some(rule) = rules.daughters.get(base).and_then(Option::as_ref) else {
            continue;
        };
        if let (Some((into, specific_j_kg)), true) = (reached(clump, rule, state), left[base] > 0) {
            left[base] -= 1;
            due.push(Due {
                clump: n,
                into,
                specific_j_kg,
            });
        }
    }
    due
}

/// What a particle breaks into, once that is certain, and its energy over mass, J/kg.
fn reached(clump: &Clump, rule: &DaughterRule, state: &State) -> Option<(Origin, f64)> {
    let intake = &clump.intake;
    let before_j = if rule.sums_impacts {
        intake.before_j
    } else {
        0.0
    };
    let energy_j = before_j + intake.impact_j;
    if energy_j <= 0.0 {
        return None;
    }
    let template = state.clumps.template(clump);
    let is_daughter = clump.template as usize >= state.model.templates.len();
    if is_daughter && template.size_m() < rule.smallest_size_m {
        return None;
    }
    let specific_j_kg = energy_j / template.mass_kg;
    if let Some(by_law) = &rule.by_law {
        let law = &by_law.law;
        let least_t10 = match intake.grows() {
            true => by_law.at_once_from_t10.max(SMALLEST_T10),
            false => SMALLEST_T10,
        };
        // Most particles take in too little for any fracture energy.
        if law.t10(template.size_m(), specific_j_kg, 0.0) < least_t10 {
            return None;
        }
        let fracture_j_kg = fracture_energy_j_kg(clump, template, law, state.model.rules.seed);
        let t10 = law.t10(template.size_m(), specific_j_kg, fracture_j_kg);
        return (t10 >= least_t10).then_some((Origin::Law(t10), specific_j_kg));
    }
    let factor = rule.weibull_modulus.map_or(1.0, |modulus| {
        let particle = [u64::from(clump.first_id); 2];
        strength_factor(
            state.model.rules.seed,
            body_key(&template.body, 0),
            particle,
            modulus,
        )
    });
    let classes = (0..)
        .zip(&rule.classes)
        .filter(|(_, class)| class.loose || !is_daughter);
    let is_reached = |class: &SizeClass| class.from_j_kg * factor <= specific_j_kg;
    let (class, _) = classes
        .clone()
        .filter(|(_, class)| is_reached(class))
        .last()?;
    let (last, _) = classes.last()?;
    (class == last || !intake.grows()).then_some((Origin::Class(class), specific_j_kg))
}

/// Replaces these particles, ascending, and records the events and the energy lost.
fn replace(state: &mut State, due: &[Due]) {
    let brought_j = state.ledger.brought_j;
    let kept_back_j = end_contacts(state, due);
    state.ledger.gain(kept_back_j);
    let mut change = TopologyChange::default();
    let mut counts = Vec::new();
    let mut fines = Vec::new();
    for one in due {
        let parent = state.clumps.all[one.clump];
        let Daughters {
            clumps: daughters,
            fines_kg,
        } = daughters_of(&parent, one.into, state);
        let (gravity, half_s) = (state.model.gravity_m_s2, 0.5 * state.time_step_s);
        let before = at_positions(&parent, state.clumps.template(&parent), gravity, half_s);
        let kinetic_j = |clump: &Clump, state: &State| {
            let template = state.clumps.template(clump);
            at_positions(clump, template, gravity, half_s).kinetic_j(template)
        };
        let template = state.clumps.template(&parent);
        let before_j = before.kinetic_j(template);
        let of_fines = fines_kg / template.mass_kg;
        let after_j: f64 = daughters
            .iter()
            .map(|daughter| kinetic_j(daughter, state))
            .sum();
        state.ledger.gain(after_j - (1.0 - of_fines) * before_j);
        if fines_kg > 0.0 {
            let own = left_to_fines(&parent, &daughters, state);
            let motion = [parent.place_m, parent.velocity_m_s, own];
            fines.push(([fines_kg, of_fines * before_j], motion));
        }
        record(state, one, (&daughters, fines_kg), [before_j, after_j]);
        counts.push(daughters.len());
        change.coming.extend(daughters);
        change.leaving.push(parent.cluster);
    }
    let parents = change.leaving.clone();
    // Clumps are not in the order of their clusters once some have come back.
    change.leaving.sort_unstable();
    let first = state
        .clusters
        .as_ref()
        .map_or(0, |clusters| clusters.history.len());
    let renumbered = apply_topology_change(state, change);
    state.scratch.events.renumberings.push(renumbered);
    if let Some(clusters) = &mut state.clusters {
        let parents = parents.into_iter().zip(counts);
        let parents = parents.flat_map(|(parent, count)| std::iter::repeat_n(parent, count));
        for (daughter, parent) in clusters.history[first..].iter_mut().zip(parents) {
            daughter.parent = Some(parent);
        }
    }
    relax_on_walls(state, first as u32);
    state.ledger.book_broken_particles(brought_j);
    // Fines leave the scene, with their motion.
    for (mass_and_energy, motion) in fines {
        (state.ledger).bring(-1.0, mass_and_energy, motion, state.model.gravity_m_s2);
    }
}

/// Angular momentum of a particle that its daughters do not take over, about its centre, kg m2/s.
fn left_to_fines(parent: &Clump, daughters: &[Clump], state: &State) -> [f64; 3] {
    let [place, velocity] = [parent.place_m, parent.velocity_m_s].map(Vector3::from);
    let taken = daughters.iter().map(|daughter| {
        let mass_kg = state.clumps.template(daughter).mass_kg;
        let arm = Vector3::from(daughter.place_m) - place;
        let around = mass_kg * arm.cross(&(Vector3::from(daughter.velocity_m_s) - velocity));
        around + Vector3::from(daughter.angular_momentum)
    });
    (Vector3::from(parent.angular_momentum) - taken.sum::<Vector3<f64>>()).into()
}

/// Records the replacement of a particle by daughters and fines, kg: kinetic energies before and
/// after, J.
fn record(
    state: &mut State,
    one: &Due,
    (daughters, fines_kg): (&[Clump], f64),
    kinetic_j: [f64; 2],
) {
    let parent = state.clumps.all[one.clump];
    let template = Arc::clone(state.clumps.template(&parent));
    let base = state.base_of(parent.template) as usize;
    state.population.by_daughters[base] += 1;
    state.population.fines_kg[base] += fines_kg;
    let (into, body) = match (one.into, &state.model.rules.daughters[base]) {
        (Origin::Class(number), Some(rule)) => {
            let class = &state.clumps.templates[rule.classes[number].template as usize];
            (BrokenInto::Class(number), class.body.clone())
        }
        (Origin::Class(number), None) => (BrokenInto::Class(number), String::new()),
        (Origin::Law(t10), _) => (BrokenInto::Law { t10, fines_kg }, template.body.clone()),
    };
    let (mut mass_kg, mut momentum) = (0.0, Vector3::zeros());
    for daughter in daughters {
        let of_one_kg = state.clumps.template(daughter).mass_kg;
        mass_kg += of_one_kg;
        momentum += of_one_kg * Vector3::from(daughter.velocity_m_s);
    }
    let momentum_before = template.mass_kg * Vector3::from(parent.velocity_m_s);
    let event = PopulationEvent::Broken {
        cluster: parent.cluster,
        body: template.body.clone(),
        into,
        daughters: (body, daughters.len()),
        specific_j_kg: one.specific_j_kg,
        mass_kg: [template.mass_kg, mass_kg],
        momentum_n_s: [momentum_before.norm(), momentum.norm()],
        kinetic_j,
        place_m: parent.place_m,
    };
    state.scratch.events.population.push(event);
}

/// A clump with the velocity and the spin at the time of the positions.
fn at_positions(clump: &Clump, template: &Template, gravity: [f64; 3], half_s: f64) -> Clump {
    let mut now = *clump;
    kick_one(&mut now, template, gravity, -half_s);
    now
}

/// What a particle breaks into.
fn daughters_of(parent: &Clump, into: Origin, state: &mut State) -> Daughters {
    let base = state.base_of(parent.template);
    let template = Arc::clone(state.clumps.template(parent));
    let whole = |clumps| Daughters {
        clumps,
        fines_kg: 0.0,
    };
    let Some(rule) = &state.model.rules.daughters[base as usize] else {
        return whole(Vec::new());
    };
    let number = match (into, &rule.by_law) {
        (Origin::Class(number), _) => number,
        (Origin::Law(t10), Some(by_law)) => {
            let seed = hash(state.model.rules.seed, [u64::from(parent.first_id)]);
            let radius_m = 0.5 * template.size_m();
            let ball_m = (radius_m - deepest_m(state, parent)).max(LEAST_BALL * radius_m);
            let diameters_m = diameters_m(
                by_law.law.family_exponent,
                t10,
                template.size_m(),
                rule.smallest_size_m,
            );
            let spheres = packed(&template, &diameters_m, ball_m, seed);
            let mass_kg: f64 = spheres.iter().map(|sphere| sphere.mass_kg).sum();
            let spin = parent.spin_rad_s(&template);
            let clumps = as_clumps(parent, &spheres, parent.turned, spin, state);
            return Daughters {
                clumps,
                fines_kg: template.mass_kg - mass_kg,
            };
        }
        (Origin::Law(_), None) => return whole(Vec::new()),
    };
    let class = rule.classes[number];
    let packing = Arc::clone(&state.clumps.templates[class.template as usize]);
    let of_file = rotation(parent.turned) * rotation(template.axes).inverse();
    let turned = numbers(&(of_file * rotation(packing.axes)));
    if !class.loose {
        return whole(vec![Clump {
            template: class.template,
            turned,
            // Bodies from inlets count from the other end.
            instance: u32::MAX - parent.cluster,
            place_m: parent.place_m,
            velocity_m_s: parent.velocity_m_s,
            angular_momentum: parent.angular_momentum,
            ..Clump::default()
        }]);
    }
    let spheres = arranged(&packing, &template);
    let axes = rotation(turned);
    let own = axes.inverse() * Vector3::from(parent.angular_momentum);
    let spin = axes * spin_rad_s(&spheres, &own);
    whole(as_clumps(parent, &spheres, turned, spin, state))
}

/// Spheres within a particle, about its centre of mass in axes turned like this, as clumps that
/// move as one with this spin, rad/s, in the axes of space.
fn as_clumps(
    parent: &Clump,
    spheres: &[SubSphere],
    turned: [f64; 4],
    spin: Vector3<f64>,
    state: &mut State,
) -> Vec<Clump> {
    let base = state.base_of(parent.template);
    let turned = rotation(turned);
    let [place, velocity] = [parent.place_m, parent.velocity_m_s].map(Vector3::from);
    (spheres.iter())
        .map(|sphere| {
            let arm = turned * Vector3::from(sphere.place_m);
            Clump {
                template: sphere_template(base, sphere, state),
                place_m: (place + arm).into(),
                turned: parent.turned,
                velocity_m_s: (velocity + spin.cross(&arm)).into(),
                angular_momentum: (sphere.inertia_kg_m2 * spin).into(),
                ..Clump::default()
            }
        })
        .collect()
}

/// Largest distance that something reaches into a particle, m: walls by the whole overlap, others
/// by half of it.
fn deepest_m(state: &State, clump: &Clump) -> f64 {
    let own = state.clumps.spheres_of(clump);
    let is_own = |i: u32| own.contains(&(i as usize));
    let touches = state.walls.iter().flat_map(|wall| &wall.touching);
    let touches = touches.filter(|touch| is_own(touch.particle));
    let of_walls = touches.map(|touch| touch.history.overlap_m() + touch.history.origin_m());
    let contacts = state.contacts.iter();
    let pairs = contacts.flat_map(|contacts| contacts.pairs.iter().zip(&contacts.histories));
    let pairs = pairs.filter(|([a, b], _)| is_own(*a) || is_own(*b));
    let of_pairs = pairs.map(|(_, history)| 0.5 * (history.overlap_m() + history.origin_m()));
    of_walls.chain(of_pairs).fold(0.0, f64::max)
}

/// Spheres of these diameters, m, of the density of a particle, within a ball of this radius, m,
/// about its centre of mass.
fn packed(parent: &Template, diameters_m: &[f64], ball_m: f64, seed: u64) -> Vec<SubSphere> {
    let radii_m: Vec<f64> = diameters_m.iter().map(|diameter| 0.5 * diameter).collect();
    let places_m = arranged_m(&radii_m, ball_m, seed);
    let spheres = radii_m.iter().zip(places_m);
    let sphere = |(&radius_m, place_m): (&f64, Vector3<f64>)| {
        let mass_kg = parent.mass_kg * (2.0 * radius_m / parent.size_m()).powi(3);
        SubSphere {
            place_m: place_m.into(),
            turned: [0.0, 0.0, 0.0, 1.0],
            radius_m,
            mass_kg,
            inertia_kg_m2: 0.4 * mass_kg * radius_m * radius_m,
        }
    };
    spheres.map(sphere).collect()
}

/// The spheres of a packing, in its principal axes, as daughters of a particle: see [`fit`].
fn arranged(packing: &Template, parent: &Template) -> Vec<SubSphere> {
    let arms_m: Vec<[f64; 3]> = packing
        .spheres
        .iter()
        .map(|sphere| sphere.place_m)
        .collect();
    let radii_m: Vec<f64> = packing
        .spheres
        .iter()
        .map(|sphere| sphere.radius_m)
        .collect();
    let volume_m3 = sphere_volume_m3(&parent.spheres);
    let [of_centres, of_radii] = fit(&arms_m, &radii_m, volume_m3, parent.reach_m);
    let cubes: f64 = radii_m.iter().map(|radius| radius.powi(3)).sum();
    let daughter = |sphere: &SubSphere| {
        let radius_m = of_radii * sphere.radius_m;
        let mass_kg = parent.mass_kg * (sphere.radius_m.powi(3) / cubes);
        SubSphere {
            place_m: sphere.place_m.map(|x| of_centres * x),
            radius_m,
            mass_kg,
            inertia_kg_m2: 0.4 * mass_kg * radius_m * radius_m,
            ..*sphere
        }
    };
    packing.spheres.iter().map(daughter).collect()
}

/// The spin at which spheres that rotate as one have this angular momentum, rad/s.
fn spin_rad_s(spheres: &[SubSphere], angular_momentum: &Vector3<f64>) -> Vector3<f64> {
    let mut inertia = Matrix3::zeros();
    for sphere in spheres {
        let arm = Vector3::from(sphere.place_m);
        let own = sphere.inertia_kg_m2 + sphere.mass_kg * arm.norm_squared();
        inertia += Matrix3::from_diagonal_element(own) - sphere.mass_kg * arm * arm.transpose();
    }
    // Positive definite: every sphere has an inertia of its own.
    let solved = inertia
        .cholesky()
        .map(|factor| factor.solve(angular_momentum));
    solved.unwrap_or_default()
}

/// The template of a single sphere of a body, a new one if there is none of this radius.
fn sphere_template(base: u32, sphere: &SubSphere, state: &mut State) -> u32 {
    let next = state.clumps.templates.len() as u32;
    let key = (base, sphere.radius_m.to_bits());
    let number = *state.population.daughter_spheres.entry(key).or_insert(next);
    if number == next {
        let like = &state.clumps.templates[base as usize];
        let template = Arc::new(Template::sphere(like, sphere.mass_kg, sphere.radius_m));
        state.clumps.templates.push(Arc::clone(&template));
        state
            .population
            .fragments
            .push(FragmentTemplate { base, template });
    }
    number
}

/// Ends the contacts of these particles at the time of the positions: without the half of the kick
/// that they have given in advance to what they touch. Returns the gain of kinetic energy by that,
/// J; takes the work of the walls back.
fn end_contacts(state: &mut State, due: &[Due]) -> f64 {
    let Some(contacts) = &state.contacts else {
        return 0.0;
    };
    let half_s = 0.5 * state.time_step_s;
    let p = &state.particles;
    let clumps = &state.clumps;
    let goes = |i: u32| {
        let carrier = clumps.carrier_of(i as usize)?;
        due.binary_search_by_key(&carrier, |one| one.clump).ok()
    };
    let mut gained_j = 0.0;
    let pairs = contacts.pairs.iter().zip(&contacts.histories);
    for (&[a, b], history) in pairs.filter(|(_, history)| history.overlap_m() > 0.0) {
        let kept = match (goes(a).is_some(), goes(b).is_some()) {
            (true, false) => (b, 1.0),
            (false, true) => (a, -1.0),
            _ => continue,
        };
        let (kept, sign) = kept;
        let force_n = sign * pair_force_n(contacts, p, [a, b], history);
        let [one, other] = [a, b].map(|i| &p.poses[i as usize]);
        let point = touch_point_m(one, other);
        gained_j += kept_back_j(state, kept, &force_n, &point, half_s);
    }
    for wall in &mut state.walls {
        let touching = wall.touching.iter();
        let ending = touching.filter(|touch| goes(touch.particle).is_some());
        let power_w: f64 = ending
            .map(|touch| {
                let force_n = touch_force_n(wall, contacts, p, touch);
                force_n.dot(&surface_velocity_m_s(wall, p, touch, 1))
            })
            .sum();
        wall.pending_j -= half_s * power_w;
    }
    gained_j
}

/// Gain of kinetic energy of a particle if a force, N, at a point, m, does not act for half a step
/// that it has been reckoned with, J.
fn kept_back_j(
    state: &State,
    i: u32,
    force_n: &Vector3<f64>,
    point: &Vector3<f64>,
    half_s: f64,
) -> f64 {
    let p = &state.particles;
    let gravity = state.model.gravity_m_s2;
    let (velocity, inverse_kg) = match state.clumps.carrier_of(i as usize) {
        Some(n) => {
            let clump = &state.clumps.all[n];
            let template = state.clumps.template(clump);
            let now = at_positions(clump, template, gravity, half_s);
            let motion = now.motion(template)(point);
            (Vector3::from(motion.velocity_m_s), motion.inverse_mass)
        }
        None => {
            let motion = &p.motions[i as usize];
            let [x, y, z, _] = p.wrenches[i as usize].force_n;
            let push = motion.inverse_mass * Vector3::new(x, y, z) + Vector3::from(gravity);
            let arm = point - p.poses[i as usize].place();
            let turning = Vector3::from(motion.spin_rad_s).cross(&arm);
            let velocity = Vector3::from(motion.velocity_m_s) - half_s * push;
            (velocity + turning, motion.inverse_mass)
        }
    };
    let impulse = half_s * force_n;
    impulse.dot(&velocity) + 0.5 * inverse_kg * impulse.norm_squared()
}

/// Makes the overlaps of new clusters, from this number on, with walls the origins of their laws.
fn relax_on_walls(state: &mut State, first: u32) {
    let Some(clusters) = &state.clusters else {
        return;
    };
    let is_new = |i: &u32| clusters.of_particle[*i as usize] >= first;
    let new: Vec<u32> = (0..state.particles.len() as u32).filter(is_new).collect();
    for wall in &mut state.walls {
        relax_touches(wall, &state.particles, &new);
    }
}
