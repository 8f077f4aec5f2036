//! Inputs that hardly mean what they say: laws beyond their range, values of another unit, keys
//! without an effect.

use dem_io::units::{show_length, significant};
use dem_scene::{BondKind, Contact, ContactLaw, Integrator, Material, Scene, Statistic};
use nalgebra::Vector3;

use super::masses::sphere_density_kg_m3;
use super::measure::measurement::Measurement;
use super::unfinished::unfinished;
use super::walls::{crossings, shaking};
use dem_engine::state::State;
use dem_engine::state::bodies::{PlacedBody, called};
use dem_engine::state::contacts::ContactHistory;
use dem_physics::contact::law::Rolling;

/// Distance of atoms in Tabor's parameter, m.
const ATOMS_M: f64 = 0.3e-9;
/// Tabor's parameter from which the law of Johnson, Kendall and Roberts holds instead of DMT.
const LARGEST_TABOR: f64 = 5.0;
/// Volume of a liquid bridge over the cube of the radius: up to which its law fits, and above which
/// it is no bridge but a flood. The first is as written, with room for rounding.
const LARGEST_BRIDGES: [f64; 2] = [1.001e-3, 0.1];
/// Largest surface tension that is not questioned, N/m: molten tungsten has 2.5.
const LARGEST_TENSION_N_M: f64 = 3.0;
/// Largest overlap at the start, over the smaller radius, that is not questioned as an origin.
const LARGEST_ORIGIN: f64 = 0.3;
/// Largest coefficient of friction that is not questioned: rubber has about 1.2.
const LARGEST_FRICTION: f64 = 3.0;
/// Gravity above which its unit is questioned, m/s2.
const LARGEST_GRAVITY_M_S2: f64 = 900.0;
/// Number of rows of the time series below which a largest value or a mean of them is none.
const FEWEST_ROWS: f64 = 10.0;
/// Smallest sieve over the size of the largest body, from which sieves are questioned.
const LARGE_SIEVE: f64 = 10.0;

/// Reasons to doubt the results of a scene that is ready to step, a sentence each.
pub(super) fn doubts(scene: &Scene, state: &State, bodies: &[PlacedBody]) -> Vec<String> {
    let mut doubts = unfinished(scene);
    doubts.extend(bridges(scene, state, LARGEST_BRIDGES[1]));
    doubts.extend(sunk(state, bodies));
    doubts.extend(sunk_in_each_other(state, bodies));
    doubts.extend(too_strong(scene));
    doubts.extend(few_rows(scene));
    doubts.extend(crossings(&state.walls));
    doubts.extend(shaking(&state.walls));
    doubts.extend(scene.measures.iter().filter_map(|(name, measure)| {
        let doubt = (Measurement::of(measure).doubt)(scene)?;
        Some(format!("measures.{name}: {doubt}"))
    }));
    doubts
}

/// Inputs without an effect, and odd ones, a sentence each. `unused_bonds`: bodies that always
/// stay rigid, with the number of their bonds.
pub(super) fn notes(
    scene: &Scene,
    state: &State,
    bodies: &[PlacedBody],
    unused_bonds: &[(String, usize)],
) -> Vec<String> {
    let mut notes = adhesion(scene, state);
    let is_said = bridges(scene, state, LARGEST_BRIDGES[1]);
    if is_said.is_empty() {
        notes.extend(bridges(scene, state, LARGEST_BRIDGES[0]));
    }
    notes.extend(surface_tensions(scene));
    notes.extend(frictions(scene));
    notes.extend(gravity(scene));
    notes.extend(braked_impacts(scene));
    notes.extend(too_weak(scene, state, bodies));
    notes.extend(strengths(scene, unused_bonds));
    notes.extend(without_effect(scene, state));
    notes.extend(sieves(scene, state));
    notes
}

/// Smallest and largest radius of the spheres of a material, m. None: it has none.
fn radii_m(scene: &Scene, state: &State, material: &str) -> Option<[f64; 2]> {
    let number = scene.materials.keys().position(|name| name == material)?;
    let is_own = |of: &u8| usize::from(*of) == number;
    let p = &state.particles;
    let materials = state.contacts.as_ref().map_or(&[][..], |c| &c.materials);
    let free = p.poses.iter().zip(materials).filter(|(_, of)| is_own(of));
    let free = free.map(|(pose, _)| pose.radius_m());
    let templates = state.clumps.templates.iter();
    let templates = templates.filter(|template| is_own(&template.material));
    let of_templates =
        templates.flat_map(|template| template.spheres.iter().map(|sphere| sphere.radius_m));
    let both = |[low, high]: [f64; 2], radius_m: f64| [low.min(radius_m), high.max(radius_m)];
    let found = free.chain(of_templates).fold([f64::INFINITY, 0.0], both);
    found[0].is_finite().then_some(found)
}

/// Smallest and largest effective radius of the contacts of a pair of materials, m: between two
/// spheres, and with walls. None: nothing can meet so.
fn effective_radii_m(scene: &Scene, state: &State, contact: &Contact) -> Option<[f64; 2]> {
    let [a, b] = &contact.materials;
    let [of_a, of_b] = [a, b].map(|name| radii_m(scene, state, name));
    let is_wall = |name: &String| scene.walls.values().any(|wall| wall.material == *name);
    let mut found = Vec::new();
    if let (Some(a), Some(b)) = (of_a, of_b) {
        found.push([0, 1].map(|k| a[k] * b[k] / (a[k] + b[k])));
    }
    found.extend(of_a.filter(|_| is_wall(b)));
    found.extend(of_b.filter(|_| is_wall(a)));
    let both = |one: [f64; 2], other: [f64; 2]| [one[0].min(other[0]), one[1].max(other[1])];
    found.into_iter().reduce(both)
}

/// Pairs of materials whose adhesive law is beyond its range.
fn adhesion(scene: &Scene, state: &State) -> Vec<String> {
    let compliance_1_pa = |name: &String| {
        let material: Option<&Material> = scene.materials.get(name);
        let modulus_pa = material.and_then(|material| material.young_modulus_pa);
        let ratio = material.map_or(0.0, |material| material.poisson_ratio);
        (1.0 - ratio * ratio) / modulus_pa.unwrap_or(f64::INFINITY)
    };
    let said = scene.contacts.iter().filter_map(|contact| {
        let ContactLaw::Dmt { work_of_adhesion_j_m2: w } = contact.law else {
            return None;
        };
        let [_, radius_m] = effective_radii_m(scene, state, contact)?;
        let [a, b] = &contact.materials;
        let modulus_pa = 1.0 / (compliance_1_pa(a) + compliance_1_pa(b));
        let tabor = (radius_m * w * w / (modulus_pa.powi(2) * ATOMS_M.powi(3))).cbrt();
        (tabor > LARGEST_TABOR).then(|| {
            format!(
                "contacts.{a}-{b}: the law \"dmt\" holds for Tabor's parameter (R* w^2/(E*^2 z^3))^(1/3) well below 1, and it is {} for R* = {}: from about {LARGEST_TABOR} the law of Johnson, Kendall and Roberts holds, whose pull-off force is 3/4 as large and whose ends stay together beyond the touch; a smaller work_of_adhesion or larger moduli make it fit",
                significant(tabor, 3),
                show_length(radius_m),
            )
        })
    });
    said.collect()
}

/// Pairs of materials whose liquid bridges have a volume above this, over the cube of the radius.
fn bridges(scene: &Scene, state: &State, largest: f64) -> Vec<String> {
    let said = scene.contacts.iter().filter_map(|contact| {
        let bridge = contact.liquid_bridge?;
        let [effective_m, _] = effective_radii_m(scene, state, contact)?;
        let radius_m = 2.0 * effective_m;
        let ratio = bridge.volume_m3 / radius_m.powi(3);
        let [a, b] = &contact.materials;
        (ratio > largest).then(|| {
            format!(
                "contacts.{a}-{b}: a liquid bridge of {} mm3 is {} times the cube of the radius R = {}: the law holds up to about 0.001 R^3; check volume and its unit, a number alone is in m3",
                significant(bridge.volume_m3 * 1e9, 3),
                significant(ratio, 3),
                show_length(radius_m),
            )
        })
    });
    said.collect()
}

/// The sphere that a wall holds deepest at the start with its overlap as the origin of its law.
fn sunk(state: &State, bodies: &[PlacedBody]) -> Option<String> {
    let touches = state.walls.iter().flat_map(|wall| {
        let own = wall.touching.iter();
        own.map(move |touch| {
            let radius_m = state.particles.poses[touch.particle as usize].radius_m();
            (touch.history.origin_m() / radius_m, touch, wall)
        })
    });
    let (ratio, touch, wall) = touches.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (ratio > LARGEST_ORIGIN).then(|| {
        let [x, y, z, _] = state.particles.poses[touch.particle as usize].position_m;
        format!(
            "at the start {} stands {} of its radius deep in the wall '{}', at ({}, {}, {}) m, and run.initial_overlap = \"relax\" makes this the origin of their law: overlaps count from there, up to about {LARGEST_ORIGIN} of the radius is usual; move the body out of the wall",
            called(bodies, &state.clumps, touch.particle),
            significant(ratio, 3),
            wall.model.name,
            significant(x, 4),
            significant(y, 4),
            significant(z, 4),
        )
    })
}

/// The spheres of two bodies that are deepest in each other at the start with their overlap as the
/// origin of their law. Within a body it is the packing's.
fn sunk_in_each_other(state: &State, bodies: &[PlacedBody]) -> Option<String> {
    let contacts = state.contacts.as_ref()?;
    let radius_m = |i: u32| state.particles.poses[i as usize].radius_m();
    let body_of = |i: u32| bodies.iter().position(|body| body.number_of(i).is_some());
    let depth = |(pair, history): (&[u32; 2], &ContactHistory)| {
        let [a, b] = *pair;
        (history.origin_m() / radius_m(a).min(radius_m(b)), [a, b])
    };
    let deep = contacts.pairs.iter().zip(&contacts.histories).map(depth);
    let deep = deep.filter(|(ratio, _)| *ratio > LARGEST_ORIGIN);
    let mut deep: Vec<(f64, [u32; 2])> = deep.collect();
    deep.sort_by(|one, other| other.0.total_cmp(&one.0));
    let (ratio, [a, b]) = (deep.into_iter())
        .find(|(_, [a, b])| body_of(*a).is_none() || body_of(*a) != body_of(*b))?;
    Some(format!(
        "at the start {} and {} stand {} of a radius in each other, and run.initial_overlap = \"relax\" makes this the origin of their law: overlaps count from there, up to about {LARGEST_ORIGIN} of the radius is usual; move the bodies apart",
        called(bodies, &state.clumps, a),
        called(bodies, &state.clumps, b),
        significant(ratio, 3),
    ))
}

/// Surface tensions that no liquid at room temperature has.
fn surface_tensions(scene: &Scene) -> Vec<String> {
    let said = scene.contacts.iter().filter_map(|contact| {
        let tension_n_m = contact.liquid_bridge?.surface_tension_n_m;
        let [a, b] = &contact.materials;
        (tension_n_m > LARGEST_TENSION_N_M).then(|| {
            format!(
                "contacts.{a}-{b}: a surface tension of {} N/m is {} times that of water, 0.073 N/m: check its unit, a number alone is in N/m",
                significant(tension_n_m, 3),
                significant(tension_n_m / 0.073, 3),
            )
        })
    });
    said.collect()
}

fn frictions(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    for contact in &scene.contacts {
        let [a, b] = &contact.materials;
        let rolling = match contact.rolling {
            Rolling::Free => 0.0,
            Rolling::Constant(moment) => moment.friction,
            Rolling::Spring(spring) => spring.friction,
        };
        for (key, value) in [
            ("friction", contact.friction),
            ("rolling_friction", rolling),
        ] {
            if value > LARGEST_FRICTION {
                notes.push(format!(
                    "contacts.{a}-{b}: {key} is {}: hardly any solids have more than about 1.2; check the decimal point",
                    significant(value, 4)
                ));
            }
        }
    }
    for (name, bond) in &scene.bonds {
        let failure = &bond.failure;
        let both = failure
            .compressive_strength_pa
            .zip(failure.tensile_strength_pa);
        if let Some((compressive_pa, tensile_pa)) = both.filter(|(c, t)| c < t) {
            notes.push(format!(
                "bonds.{name}: compressive_strength, {} Pa, is below tensile_strength, {} Pa: brittle solids bear several times more in compression; check whether they are exchanged",
                significant(compressive_pa, 4),
                significant(tensile_pa, 4)
            ));
        }
    }
    notes
}

/// The least strength of a kind of bonds against pull and shear, Pa. None: it has none.
fn least_strength_pa(kind: &BondKind) -> Option<f64> {
    let failure = &kind.failure;
    let strengths = [
        failure.tensile_strength_pa,
        failure.shear_strength_pa,
        failure.cohesion_pa,
        failure.von_mises_strength_pa,
    ];
    strengths.into_iter().flatten().reduce(f64::min)
}

/// Bonds stronger than stiff: they would have to double their length first.
fn too_strong(scene: &Scene) -> Vec<String> {
    let said = scene.bonds.iter().filter_map(|(name, kind)| {
        let strength_pa = least_strength_pa(kind)?;
        let modulus_pa = kind.young_modulus_pa;
        (strength_pa > modulus_pa).then(|| {
            format!(
                "bonds.{name}: the least strength, {} Pa, is above the Young's modulus, {} Pa: bonds would break at a strain of {}, and are linear elastic up to about 0.1; check both and their units",
                significant(strength_pa, 3),
                significant(modulus_pa, 3),
                significant(strength_pa / modulus_pa, 3),
            )
        })
    });
    said.collect()
}

/// Bodies whose bonds would break under their own weight.
fn too_weak(scene: &Scene, state: &State, bodies: &[PlacedBody]) -> Vec<String> {
    let gravity_m_s2 = Vector3::from(scene.run.gravity_m_s2).norm();
    let own = scene.bodies.iter().zip(&state.model.bodies);
    let said = own.filter_map(|((name, entry), sizes)| {
        let kind = entry.bond_kind.as_ref()?;
        let strength_pa = least_strength_pa(scene.bonds.get(kind)?)?;
        let density_kg_m3 = sphere_density_kg_m3(name, state, bodies)?;
        let weight_pa = density_kg_m3 * gravity_m_s2 * sizes.sieve_m;
        (strength_pa < weight_pa).then(|| {
            format!(
                "bonds.{kind}: the least strength, {} Pa, is below the {} Pa of the weight of '{name}', {} kg/m3 over its width of {}: it breaks by itself; check the strength and its unit, a number alone is in Pa",
                significant(strength_pa, 3),
                significant(weight_pa, 3),
                significant(density_kg_m3, 4),
                show_length(sizes.sieve_m),
            )
        })
    });
    said.collect()
}

/// Measures whose statistic is taken over a few rows of the time series.
fn few_rows(scene: &Scene) -> Vec<String> {
    let series_s = scene.output.as_ref().and_then(|output| output.series_s);
    let rows = series_s.map_or(f64::INFINITY, |series_s| scene.run.end_time_s / series_s);
    if rows >= FEWEST_ROWS {
        return Vec::new();
    }
    let of_rows = scene.measures.iter().filter(|(_, measure)| {
        measure.statistic != Statistic::End && Measurement::of(measure).recorded.is_none()
    });
    let said = of_rows.map(|(name, _)| {
        format!(
            "measures.{name}: its statistic is taken over the rows of the time series, of which there are about {}, fewer than {FEWEST_ROWS}; write a shorter output.series",
            significant(1.0 + rows.floor(), 2)
        )
    });
    said.collect()
}

/// Local damping of bodies that hit something.
fn braked_impacts(scene: &Scene) -> Option<String> {
    let damping = scene.run.local_damping;
    let moves_freely = scene.test.is_none() && scene.supports.is_empty();
    let is_run = scene.run.integrator != Integrator::Static;
    let hits = moves_freely && is_run && !scene.contacts.is_empty();
    let instead = match scene.bonds.is_empty() {
        true => "remove it",
        false => "damp the bonds instead",
    };
    (hits && damping > 0.0).then(|| {
        format!(
            "run.local_damping = {damping} also brakes bodies while they touch a wall: they rebound less than the restitution of [contacts] says, and slide less far; for impacts, {instead}"
        )
    })
}

/// Gravity that is missing or of another unit.
fn gravity(scene: &Scene) -> Option<String> {
    let gravity_m_s2 = Vector3::from(scene.run.gravity_m_s2).norm();
    if gravity_m_s2 > LARGEST_GRAVITY_M_S2 {
        return Some(format!(
            "run.gravity is {} m/s2, {} times that of the earth: check its unit, 9810 mm/s2 and 981 cm/s2 are 9.81 m/s2",
            significant(gravity_m_s2, 4),
            significant(gravity_m_s2 / 9.81, 3)
        ));
    }
    (gravity_m_s2 == 0.0 && !scene.inlets.is_empty()).then(|| {
        "run.gravity is not given, so it is 0: what inlets feed does not fall; set run.gravity, such as [0, 0, -9.81]"
            .to_owned()
    })
}

/// Strengths of bodies that cannot break.
fn strengths(scene: &Scene, unused_bonds: &[(String, usize)]) -> Vec<String> {
    let has_strength = |name: &String| {
        let kind = scene.bodies.get(name)?.bond_kind.as_ref()?;
        let failure = &scene.bonds.get(kind)?.failure;
        let strengths = [
            failure.tensile_strength_pa,
            failure.compressive_strength_pa,
            failure.shear_strength_pa,
            failure.cohesion_pa,
            failure.von_mises_strength_pa,
        ];
        strengths.iter().any(Option::is_some).then_some(kind)
    };
    let own = unused_bonds
        .iter()
        .filter(|(name, _)| !scene.replacement.contains_key(name));
    let said = own.filter_map(|(name, _)| {
        let kind = has_strength(name)?;
        Some(format!(
            "body '{name}' always stays a rigid clump, so the strengths in bonds.{kind}.failure have no effect on it: for breakage add [replacement.{name}], or start_as = \"bonded\""
        ))
    });
    said.collect()
}

/// Keys that change nothing in this scene.
fn without_effect(scene: &Scene, state: &State) -> Vec<String> {
    let mut notes = Vec::new();
    let run = &scene.run;
    if run.time_step_s.is_some() && run.safety_factor != dem_scene::SAFETY {
        notes.push(
            "run.safety_factor has no effect beside run.time_step: it is that of the automatic step"
                .to_owned(),
        );
    }
    for (name, wall) in &scene.walls {
        let is_measured = scene.measures.values().any(|measure| measure.of == *name);
        let is_used = wall.motion.turns() || wall.rotation_rad != [0.0; 3] || is_measured;
        if wall.pivot_m != [0.0; 3] && !is_used {
            notes.push(format!(
                "walls.{name}.pivot has no effect: the wall neither has a rotation nor turns"
            ));
        }
    }
    if let Some(output) = &scene.output {
        if output.flow_s.is_some() && !state.model.rules.have_flows() {
            notes.push("output.flow has no effect: there are no inlets and no outlets".to_owned());
        }
        if output.view_from.is_some() && output.pictures_s.is_none() {
            notes.push(
                "output.view has no effect on a run: output.pictures asks for none".to_owned(),
            );
        }
    }
    for (name, rule) in &scene.replacement {
        let template = state.clumps.templates.iter().find(|t| t.body == *name);
        let both = rule.restore.as_ref().zip(template);
        if let Some((restore, template)) = both
            && restore.min_particles as usize > template.spheres.len()
        {
            notes.push(format!(
                "replacement.{name}.restore has no effect: its min_particles, {}, is more than the {} of the body",
                restore.min_particles,
                template.spheres.len()
            ));
        }
    }
    notes
}

/// Sieves that everything passes.
fn sieves(scene: &Scene, state: &State) -> Option<String> {
    let smallest_m = *scene.output.as_ref()?.sieves_m.first()?;
    let sizes = state.model.bodies.iter().map(|body| body.sieve_m);
    let largest_m = sizes.fold(0.0, f64::max);
    (largest_m > 0.0 && smallest_m > LARGE_SIEVE * largest_m).then(|| {
        format!(
            "output.sieves begin at {}, and the largest body passes one of {}: everything passes all of them; check their unit",
            show_length(smallest_m),
            show_length(largest_m)
        )
    })
}
