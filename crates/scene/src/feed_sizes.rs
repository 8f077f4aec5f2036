//! Feeds by a sieve curve: `sizes` of an inlet stands for bodies of several sizes.

use std::collections::BTreeMap;

use super::body::BodyEntry;
use super::inlet::{Inlet, SharesBy};
use super::replacement::Replacement;
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::sieve_curve::SieveCurve;
use dem_io::units::significant;

/// A class of a sieve curve.
struct SizeClass {
    /// "20-40mm"
    name: String,
    /// Geometric mean of its openings, m.
    size_m: f64,
    /// Fraction of the mass.
    share: f64,
}

/// Puts in the place of each body that an inlet feeds by a sieve curve one of each size class, and
/// with it its replacement. Refuses such bodies where another inlet feeds them as they are, and
/// daughters of given sizes.
pub(super) fn expand(
    root: &Table<'_>,
    inlets: &mut BTreeMap<String, Inlet>,
    bodies: &mut BTreeMap<String, BodyEntry>,
    replacement: &mut BTreeMap<String, Replacement>,
) -> Result<()> {
    refuse_others(root, inlets, replacement)?;
    let mut stood_for: Vec<String> = Vec::new();
    for inlet in inlets.values_mut() {
        let Some(sizes) = &inlet.sizes else {
            continue;
        };
        inlet.shares_by = SharesBy::Mass;
        let classes = classes(&sizes.curve);
        for (body, share) in std::mem::take(&mut inlet.bodies) {
            for class in &classes {
                let name = format!("{body}-{}", class.name);
                if let Some(entry) = bodies.get(&body) {
                    let own = BodyEntry {
                        sieve_size_m: Some(class.size_m),
                        class_of: Some(body.clone()),
                        ..entry.clone()
                    };
                    bodies.insert(name.clone(), own);
                }
                if let Some(rule) = replacement.get(&body) {
                    replacement.insert(name.clone(), rule.clone());
                }
                inlet.bodies.push((name, share * class.share));
            }
            stood_for.push(body);
        }
    }
    for body in stood_for {
        bodies.remove(&body);
        replacement.remove(&body);
        let classes = bodies.iter();
        let classes = classes.filter(|(_, entry)| entry.class_of.as_ref() == Some(&body));
        let classes: Vec<String> = classes.map(|(name, _)| name.clone()).collect();
        for rule in replacement.values_mut() {
            if let Some(at) = rule.when.touches.iter().position(|name| *name == body) {
                rule.when.touches.splice(at..=at, classes.iter().cloned());
            }
        }
    }
    Ok(())
}

/// The classes between the openings of a curve that have mass.
fn classes(curve: &SieveCurve) -> Vec<SizeClass> {
    let openings = curve.openings_m.windows(2).zip(curve.passing.windows(2));
    let class = |(openings_m, passing): (&[f64], &[f64])| SizeClass {
        name: format!("{}-{}mm", shown_mm(openings_m[0]), shown_mm(openings_m[1])),
        size_m: (openings_m[0] * openings_m[1]).sqrt(),
        share: passing[1] - passing[0],
    };
    let all = openings.map(class);
    all.filter(|class| class.share > 0.0).collect()
}

/// An opening in mm, as a part of a name: "22_4".
fn shown_mm(opening_m: f64) -> String {
    significant(1e3 * opening_m, 4).replace('.', "_")
}

fn refuse_others(
    root: &Table<'_>,
    inlets: &BTreeMap<String, Inlet>,
    replacement: &BTreeMap<String, Replacement>,
) -> Result<()> {
    for (name, inlet) in inlets.iter().filter(|(_, inlet)| inlet.sizes.is_some()) {
        let Some(field) = root.find(&["inlets", name, "sizes"]) else {
            continue;
        };
        for (body, _) in &inlet.bodies {
            let mut others = inlets.iter().filter(|(_, other)| other.sizes.is_none());
            if let Some((other, _)) = others.find(|(_, other)| other.feeds(body)) {
                let problem =
                    format!("scales the body '{body}', which [inlets.{other}] feeds as it is");
                let remedy =
                    format!("copy [bodies.{body}] under another name for [inlets.{other}]");
                return Err(field.fault(problem, remedy));
            }
            if let Some(field) = root.find(&["bodies", body, "mass"]) {
                let problem =
                    format!("is that of one size, but [inlets.{name}] feeds the body in many");
                let remedy =
                    "remove it: the density of the material, or body_density, gives the mass";
                return Err(field.fault(problem, remedy));
            }
            let rule = replacement.get(body);
            if rule.is_some_and(|rule| rule.daughters.is_some()) {
                let problem =
                    format!("scales the body '{body}', whose daughters are those of one size");
                let remedy = format!(
                    "write [replacement.{body}.breakage], a law for all sizes, or feed one size"
                );
                return Err(field.fault(problem, remedy));
            }
        }
    }
    Ok(())
}
