//! Daughters that replace particles: their bodies, fitted into the parent, and the rules of
//! replacement.

use std::collections::BTreeMap;
use std::sync::Arc;

use dem_io::body::About;
use dem_io::units::show_length;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::{Breakage, CountedEnergy, Daughters, Material, Replacement, Scene, WholeMass};
use nalgebra::Vector3;

use super::clumps::template;
use super::sieve_sizes::grow;
use dem_engine::state::clumps::{Template, sphere_volume_m3};
use dem_engine::state::rules::{ByLaw, DaughterRule, SizeClass};
use dem_physics::breakage::BreakageLaw;
use dem_physics::breakage::daughters::diameters_m;
use dem_physics::shape::packing_fit::fit;

/// Largest number of daughters of a break by a law, and ratio of sizes up to which they are
/// counted.
const MOST_DAUGHTERS: usize = 10_000;
const LARGEST_RATIO: f64 = 200.0;

/// The scene with the mass of each parent for its daughters, whose bodies in `read` become as large
/// as the parent: see [`fit`]; bodies with bonds keep their proportions. Refuses loose daughters of
/// one sphere, and a parent smaller than the smallest that is replaced.
pub(super) fn fitted(mut scene: Scene, read: &mut BTreeMap<String, Body>) -> Result<Scene> {
    let rules = scene.replacement.clone();
    for (parent, rule) in &rules {
        let Some(body) = read.get(parent).filter(|_| rule.breaks_whole()) else {
            continue;
        };
        let parent = template(&scene, parent, body)?;
        refuse_too_small(&scene, &parent, rule)?;
        if let Some(breakage) = &rule.breakage {
            refuse_unlawful(&scene, &parent, breakage)?;
        }
        let Some(daughters) = &rule.daughters else {
            continue;
        };
        for class in &daughters.classes {
            let Some(body) = read.get_mut(&class.body) else {
                continue;
            };
            if body.bonds.is_empty() && body.radii.len() < 2 {
                return Err(Diagnostic::input(
                    format!("{}: [replacement.{}.daughters]", scene.source, parent.body),
                    format!(
                        "the daughters '{}' are a single sphere: a particle would replace itself",
                        class.body
                    ),
                    "name a body of two or more spheres, made with dem-pack",
                ));
            }
            scale(body, &parent);
            refuse_same_place(&scene, &parent, &class.body, body)?;
            if let Some(entry) = scene.bodies.get_mut(&class.body) {
                entry.whole_mass = Some(WholeMass::Mass(parent.mass_kg));
            }
        }
    }
    Ok(scene)
}

/// Refuses loose daughters with the same centre, which no contact can part.
fn refuse_same_place(scene: &Scene, parent: &Template, name: &str, body: &Body) -> Result<()> {
    let near_m = 1e-6 * parent.reach_m;
    let apart_m = |a: &[f64; 3], b: &[f64; 3]| (Vector3::from(*a) - Vector3::from(*b)).norm();
    let places = || body.positions.iter().enumerate();
    let same = places().find(|(n, a)| places().skip(n + 1).any(|(_, b)| apart_m(a, b) < near_m));
    match same {
        Some((n, _)) if body.bonds.is_empty() => Err(Diagnostic::input(
            format!("{}: [replacement.{}.daughters]", scene.source, parent.body),
            format!(
                "sphere {n} of the daughters '{name}' has another one at its centre within the parent"
            ),
            "move the spheres apart, or name daughters that fill the parent more evenly",
        )),
        _ => Ok(()),
    }
}

/// Refuses particles of several spheres, whose size and room the law does not tell, and so many
/// daughters that packing them takes longer than the run.
fn refuse_unlawful(scene: &Scene, parent: &Template, breakage: &Breakage) -> Result<()> {
    let place = format!("{}: [replacement.{}.breakage]", scene.source, parent.body);
    if parent.spheres.len() > 1 {
        let problem = format!(
            "the body has {} spheres: the law is that of round particles",
            parent.spheres.len()
        );
        let remedy = "write particles = [[0, 0, 0, \"20 mm\"]], one sphere, or take [replacement.NAME.daughters]";
        return Err(Diagnostic::input(place, problem, remedy));
    }
    let Some(law) = law_of(scene, &parent.body) else {
        return Ok(());
    };
    let [size_m, smallest_m] = [parent.size_m(), breakage.smallest_size_m];
    let ratio = size_m / smallest_m;
    let count = match ratio > LARGEST_RATIO {
        true => usize::MAX,
        false => diameters_m(
            law.family_exponent,
            law.nearly_largest_t10(),
            size_m,
            smallest_m,
        )
        .len(),
    };
    if count > MOST_DAUGHTERS {
        let problem = format!(
            "smallest_size is {}, 1/{ratio:.0} of the body: a break would make more than {MOST_DAUGHTERS} fragments",
            show_length(smallest_m)
        );
        return Err(Diagnostic::input(
            place,
            problem,
            "write a larger smallest_size, a tenth of the body or so",
        ));
    }
    Ok(())
}

fn refuse_too_small(scene: &Scene, parent: &Template, rule: &Replacement) -> Result<()> {
    let (key, smallest_m) = match (&rule.daughters, &rule.breakage) {
        (Some(daughters), _) => ("daughters", daughters.smallest_size_m),
        (None, breakage) => (
            "breakage",
            breakage.map(|breakage| breakage.smallest_size_m),
        ),
    };
    match smallest_m {
        Some(smallest_m) if parent.size_m() < smallest_m => Err(Diagnostic::input(
            format!("{}: [replacement.{}.{key}]", scene.source, parent.body),
            format!(
                "smallest_size is {}, and the body itself, {}, is smaller",
                show_length(smallest_m),
                show_length(parent.size_m())
            ),
            "write the size of the smallest daughter that breaks in turn",
        )),
        _ => Ok(()),
    }
}

/// Scales a body of daughters to a parent, about its centre of mass. What is known of a packing is
/// about a shape that loose daughters do not fill.
fn scale(body: &mut Body, parent: &Template) {
    let cubes: Vec<f64> = body.radii.iter().map(|radius| radius.powi(3)).collect();
    let sum: f64 = cubes.iter().sum();
    let weighted = body.positions.iter().zip(&cubes);
    let moment: Vector3<f64> = weighted.map(|(p, cube)| *cube * Vector3::from(*p)).sum();
    let centre = moment / sum;
    let arms = body.positions.iter().map(|p| Vector3::from(*p) - centre);
    let arms_m: Vec<[f64; 3]> = arms.map(Into::into).collect();
    let [of_centres, of_radii] = if body.bonds.is_empty() {
        let volume_m3 = sphere_volume_m3(&parent.spheres);
        fit(&arms_m, &body.radii, volume_m3, parent.reach_m)
    } else {
        let reaches = arms_m.iter().zip(&body.radii);
        let reaches = reaches.map(|(arm, radius)| Vector3::from(*arm).norm() + radius);
        [parent.reach_m / reaches.fold(0.0, f64::max); 2]
    };
    if body.bonds.is_empty() {
        body.about = About::default();
    }
    for (place, arm) in body.positions.iter_mut().zip(&arms_m) {
        *place = arm.map(|x| of_centres * x);
    }
    grow(body, of_radii);
}

/// The rule of each template. None: no daughters replace its particles.
pub(super) fn daughter_rules(
    scene: &Scene,
    templates: &[Arc<Template>],
) -> Vec<Option<DaughterRule>> {
    let rule = |parent: &Arc<Template>| {
        let rule = scene.replacement.get(&parent.body)?;
        if let Some(breakage) = &rule.breakage {
            return Some(rule_of_law(law_of(scene, &parent.body)?, breakage, parent));
        }
        let daughters = rule.daughters.as_ref()?;
        let class = |class: &dem_scene::SizeClass| {
            let template = templates.iter().position(|t| t.body == class.body)?;
            Some(SizeClass {
                from_j_kg: class.from_j_kg,
                template: template as u32,
                loose: templates[template].bonds.is_empty(),
            })
        };
        let classes: Vec<SizeClass> = daughters.classes.iter().filter_map(class).collect();
        let smallest_radius_m = smallest_radius_m(daughters, &classes, templates);
        Some(DaughterRule {
            by_law: None,
            needed_j_kg: classes.first()?.from_j_kg,
            sums_impacts: daughters.energy == CountedEnergy::AllImpacts,
            weibull_modulus: daughters.weibull_modulus,
            smallest_size_m: daughters.smallest_size_m.unwrap_or(f64::INFINITY),
            limit: daughters.limit,
            smallest_radius_m,
            classes,
        })
    };
    templates.iter().map(rule).collect()
}

/// The breakage law of the material of a body.
fn law_of(scene: &Scene, body: &str) -> Option<BreakageLaw> {
    scene
        .materials
        .get(&scene.bodies.get(body)?.material)?
        .breakage
}

/// The rule of particles that break by the law of their material.
fn rule_of_law(law: BreakageLaw, breakage: &Breakage, parent: &Template) -> DaughterRule {
    DaughterRule {
        classes: Vec::new(),
        by_law: Some(ByLaw {
            law,
            damage_exponent: breakage.damage_exponent,
            at_once_from_t10: (breakage.at_once_from_t10)
                .unwrap_or_else(|| law.nearly_largest_t10()),
        }),
        needed_j_kg: law.breaking_energy_j_kg(parent.size_m()),
        sums_impacts: false,
        weibull_modulus: None,
        smallest_size_m: breakage.smallest_size_m,
        limit: breakage.limit,
        smallest_radius_m: 0.5 * breakage.smallest_size_m,
    }
}

/// Radius of the smallest sphere that can come: of the body's own loose daughters, or of those of
/// the smallest daughter that is replaced.
fn smallest_radius_m(
    daughters: &Daughters,
    classes: &[SizeClass],
    templates: &[Arc<Template>],
) -> f64 {
    let mut smallest_m = f64::INFINITY;
    for class in classes.iter().filter(|class| class.loose) {
        let template = &templates[class.template as usize];
        let radii = template.spheres.iter().map(|sphere| sphere.radius_m);
        let first_m = radii.fold(f64::INFINITY, f64::min);
        smallest_m = smallest_m.min(first_m);
        if let Some(size_m) = daughters.smallest_size_m {
            // The volumes of the daughters add up to that of their parent.
            smallest_m = smallest_m.min(first_m * size_m / template.size_m());
        }
    }
    smallest_m
}

/// Compliances (1 - nu^2)/E of the materials and of the walls, 1/Pa: see
/// [`dem_engine::state::rules::Rules::compliances`].
pub(super) fn compliances(scene: &Scene) -> [Vec<f64>; 2] {
    let of = |material: &Material, unknown: f64| match material.young_modulus_pa {
        Some(modulus_pa) => (1.0 - material.poisson_ratio.powi(2)) / modulus_pa,
        None if material.rigid => 0.0,
        None => unknown,
    };
    let materials = scene
        .materials
        .values()
        .map(|material| of(material, f64::INFINITY));
    let walls = scene.walls.values().map(|wall| {
        let material = scene.materials.get(&wall.material);
        material.map_or(0.0, |material| of(material, 0.0))
    });
    [materials.collect(), walls.collect()]
}
