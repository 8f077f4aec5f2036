//! `[groups.NAME]`

use std::collections::{BTreeMap, HashSet};

use super::body::{BodyEntry, BodySource};
use super::field::Field;
use super::listing::{LISTED, Listing};
use super::names::{FRAGMENTS, meaning};
use super::presence::Presence;
use super::schema::{Kind, table_schema};
use super::shape::{BOX, BoxShape, SPHERE, SphereShape, read_box, read_sphere};
use super::table::Table;
use dem_io::diagnostic::Result;

/// A group of particles.
#[derive(Debug, Clone, PartialEq)]
pub struct ParticleGroup {
    /// `body`: only particles of this body. None: of all bodies. Never None if `pick` lists
    /// particles.
    pub body: Option<String>,
    /// How they are selected, at the start of the run.
    pub pick: Pick,
}

/// How particles are selected.
#[derive(Debug, Clone, PartialEq)]
pub enum Pick {
    /// `all = true`
    All,
    /// `particles = [i, ...]`: indices in the body's file, from 0. Only with `body`, or if there is
    /// only one body.
    Particles(Vec<u32>),
    /// `box = { min, max }`: particles with their centres in it.
    Box(BoxShape),
    /// `sphere = { centre, radius }`: particles with their centres in it.
    Sphere(SphereShape),
}

/// The ways to select particles.
const PICKS: [&str; 4] = ["all", "particles", "box", "sphere"];

table_schema! {
    /// A group of particles, selected by one key at the start of the run. Each body name and `all`
    /// are groups as well.
    pub(super) static GROUP = "[groups.NAME]";

    /// Select only from this body.
    text("body", "a name in [bodies]").otherwise("all");
    /// All particles.
    new("all", Kind::True);
    /// Particles by their numbers in the body's file, from 0. Requires a `body`, or a scene with
    /// one body.
    new("particles", Kind::List(&Kind::Whole { least: 0, most: None, of: "" }));
    /// Particles whose centres are in this box.
    table("box", &BOX);
    /// Particles whose centres are in this sphere.
    table("sphere", &SPHERE);
}

pub(super) fn read_all(
    root: &Table<'_>,
    presence: &Presence<'_>,
) -> Result<BTreeMap<String, ParticleGroup>> {
    let bodies = presence.bodies;
    let mut groups = BTreeMap::new();
    for (name, field) in root.named("groups")? {
        let body = format!("the body [bodies.{name}]");
        let is_body = bodies.contains_key(&name);
        if let Some(of) = meaning(&name).or(is_body.then_some(&body)) {
            let remedy = if name == FRAGMENTS {
                "give it another name"
            } else {
                "give it another name, or remove it: the name stands for those particles without it"
            };
            return Err(field.fault(format!("is named like {of}"), remedy));
        }
        let group = read(&field, bodies)?;
        presence.refuse_group(&field, group.body.as_deref())?;
        groups.insert(name, group);
    }
    Ok(groups)
}

fn read(field: &Field<'_>, bodies: &BTreeMap<String, BodyEntry>) -> Result<ParticleGroup> {
    let table = Table::of(field, &GROUP)?;
    let body = table.read_by("body", |field| field.reference(bodies.keys(), "bodies"))?;
    let one = "a group selects in one way: remove one, or make two groups";
    let Some((key, first)) = table.at_most_one(&PICKS, one)? else {
        let remedy =
            "add all = true, particles = [0], box = { min, max } or sphere = { centre, radius }";
        return Err(table.fault("selects nothing", remedy));
    };
    match key {
        "particles" => {
            let only = bodies.keys().next().filter(|_| bodies.len() == 1);
            let Some(body) = body.or(only.cloned()) else {
                let problem = format!("needs a body, and there are {}", bodies.len());
                let names: Vec<&str> = bodies.keys().map(String::as_str).collect();
                let remedy = format!("add body = \"NAME\", one of {}", names.join(", "));
                return Err(first.fault(problem, remedy));
            };
            let pick = Pick::Particles(particles(&first, bodies.get(&body))?);
            Ok(ParticleGroup {
                body: Some(body),
                pick,
            })
        }
        "box" => Ok(ParticleGroup {
            body,
            pick: Pick::Box(read_box(&first, "at most", |low, high| low <= high)?),
        }),
        "sphere" => Ok(ParticleGroup {
            body,
            pick: Pick::Sphere(read_sphere(&first)?),
        }),
        _ => {
            if !first.boolean()? {
                return Err(first.wrong("true", "write all = true, or pick in another way"));
            }
            Ok(ParticleGroup {
                body,
                pick: Pick::All,
            })
        }
    }
}

fn particles(field: &Field<'_>, body: Option<&BodyEntry>) -> Result<Vec<u32>> {
    let count = match body.map(|body| &body.source) {
        Some(BodySource::Inline { particles, .. }) => particles.len(),
        // The indices are checked when the file is read.
        _ => usize::MAX,
    };
    let count = u32::try_from(count).unwrap_or(u32::MAX);
    let mut picked = Vec::new();
    let mut known = HashSet::new();
    for item in field.items()? {
        let index = item.particle(count)?;
        if !known.insert(index) {
            let problem = format!("is {index}, which is in the list already");
            return Err(item.fault(problem, "remove one of them"));
        }
        picked.push(index);
    }
    Ok(picked)
}

pub(super) fn list(group: &ParticleGroup, listing: &mut Listing) {
    listing.value("body", &group.body);
    match &group.pick {
        Pick::All => listing.text("all", "true"),
        Pick::Particles(picked) => {
            let shown: Vec<String> = picked.iter().take(LISTED).map(u32::to_string).collect();
            listing.some("particles", &shown, picked.len());
        }
        Pick::Box(of) => listing.table("box", &BOX, |listing| of.list(listing)),
        Pick::Sphere(of) => listing.table("sphere", &SPHERE, |listing| of.list(listing)),
    }
}
