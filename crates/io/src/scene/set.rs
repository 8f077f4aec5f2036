//! `[sets.NAME]`

use std::collections::{BTreeMap, HashSet};

use super::field::Field;
use super::names::{FRAGMENTS, meaning};
use super::table::Table;
use super::{BodyEntry, BodySource, ParticleSet, Pick};
use crate::Result;
use crate::units::LENGTH;

/// The ways to pick.
const PICKS: [&str; 4] = ["all", "particles", "box", "sphere"];

pub(super) fn read_all(
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
) -> Result<BTreeMap<String, ParticleSet>> {
    let mut sets = BTreeMap::new();
    for (name, field) in root.named("sets")? {
        let body = format!("the body [bodies.{name}]");
        let is_body = bodies.contains_key(&name);
        if let Some(of) = meaning(&name).or(is_body.then_some(&body)) {
            let problem = format!("{} is named like {of}", field.path);
            let remedy = if name == FRAGMENTS {
                "give it another name"
            } else {
                "give it another name, or remove it: the name stands for those particles without it"
            };
            return Err(field.refuse(problem, remedy));
        }
        sets.insert(name, read(&field, bodies)?);
    }
    Ok(sets)
}

fn read(field: &Field<'_>, bodies: &BTreeMap<String, BodyEntry>) -> Result<ParticleSet> {
    let table = field.table(&["body", "all", "particles", "box", "sphere"])?;
    let body = table.read("body", |field| field.reference(bodies.keys(), "bodies"))?;
    let mut given = table.given(&PICKS);
    let Some((key, first)) = given.next() else {
        let problem = format!("{} picks nothing", table.path);
        let remedy =
            "add all = true, particles = [0], box = { min, max } or sphere = { centre, radius }";
        return Err(table.refuse(problem, remedy));
    };
    if let Some((_, second)) = given.next() {
        let problem = format!("{} stands beside {key}", second.path);
        return Err(second.refuse(
            problem,
            "a set picks in one way: remove one, or make two sets",
        ));
    }
    match key {
        "particles" => {
            let only = bodies.keys().next().filter(|_| bodies.len() == 1);
            let Some(body) = body.or(only.cloned()) else {
                let problem = format!(
                    "{} says nothing of the body, and there are {}",
                    first.path,
                    bodies.len()
                );
                let names: Vec<&str> = bodies.keys().map(String::as_str).collect();
                let remedy = format!("add body = \"NAME\", one of {}", names.join(", "));
                return Err(first.refuse(problem, remedy));
            };
            let pick = Pick::Particles(particles(&first, bodies.get(&body))?);
            Ok(ParticleSet {
                body: Some(body),
                pick,
            })
        }
        "box" => Ok(ParticleSet {
            body,
            pick: region(&first)?,
        }),
        "sphere" => {
            let sphere = first.table(&["centre", "radius"])?;
            let pick = Pick::Sphere {
                centre: sphere.need("centre", "[0, 0, 0]")?.vector(&LENGTH)?,
                radius: sphere.need("radius", "\"5 mm\"")?.positive(&LENGTH)?,
            };
            Ok(ParticleSet { body, pick })
        }
        _ => {
            if !first.boolean()? {
                return Err(first.wrong("true", "write all = true, or pick in another way"));
            }
            Ok(ParticleSet {
                body,
                pick: Pick::All,
            })
        }
    }
}

fn particles(field: &Field<'_>, body: Option<&BodyEntry>) -> Result<Vec<u32>> {
    let count = match body.map(|body| &body.source) {
        Some(BodySource::Inline { particles, .. }) => particles.len(),
        // Whoever reads the file checks the indices.
        _ => usize::MAX,
    };
    let count = u32::try_from(count).unwrap_or(u32::MAX);
    let mut picked = Vec::new();
    let mut known = HashSet::new();
    for item in field.items()? {
        let index = item.particle(count)?;
        if !known.insert(index) {
            let problem = format!("{} is {index}, which is in the list already", item.path);
            return Err(item.refuse(problem, "remove one of them"));
        }
        picked.push(index);
    }
    Ok(picked)
}

fn region(field: &Field<'_>) -> Result<Pick> {
    let [min, max] = corners(field, "at most", |low, high| low <= high)?;
    Ok(Pick::Box { min, max })
}

/// The smallest and the largest corner of a box `{ min, max }`, m. `holds` for both along each axis; `limit` says in words what min must be to max.
pub(super) fn corners(
    field: &Field<'_>,
    limit: &str,
    holds: impl Fn(f64, f64) -> bool,
) -> Result<[[f64; 3]; 2]> {
    let table = field.table(&["min", "max"])?;
    let min = table.need("min", "[0, 0, 0]")?.vector(&LENGTH)?;
    let upper = table.need("max", "[1, 1, 1]")?;
    let max = upper.vector(&LENGTH)?;
    for (axis, (low, high)) in ["x", "y", "z"].iter().zip(min.into_iter().zip(max)) {
        if !holds(low, high) {
            let problem = format!(
                "{} is {high} m along {axis}, but min is {low} m",
                upper.path
            );
            let remedy = if low > high {
                format!("min must be {limit} max: swap them")
            } else {
                format!("min must be {limit} max: move one of them")
            };
            return Err(upper.refuse(problem, remedy));
        }
    }
    Ok([min, max])
}
