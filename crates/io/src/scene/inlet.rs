//! `[inlets.NAME]`

use std::collections::BTreeMap;

use super::field::Field;
use super::table::Table;
use super::tree::Value;
use super::{BodyEntry, Region};
use crate::Result;
use crate::units::{ANGULAR_VELOCITY, MASS_RATE, NUMBER, RATE, TIME, VELOCITY};

const KEYS: [&str; 10] = [
    "bodies",
    "region",
    "rate",
    "mass_rate",
    "velocity",
    "angular_velocity",
    "orientation",
    "start",
    "end",
    "count",
];

/// How new bodies may be turned: whether at random.
pub(super) const ORIENTATIONS: [(&str, bool); 2] = [("random", true), ("as-is", false)];

/// Feeds bodies during the run. Those that it names do not stand in the scene at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Inlet {
    /// `bodies`: names of `[bodies]`, each once, with their shares by number: more than 0, of any
    /// sum. All 1 unless given. At least one.
    pub bodies: Vec<(String, f64)>,
    /// `region`: a name of `[regions]`, in which the centres of new bodies are put at random.
    pub region: String,
    /// `rate` or `mass_rate`
    pub rate: FeedRate,
    /// `velocity` of new bodies, m/s; 0 unless given. Length 3.
    pub velocity_m_s: [f64; 3],
    /// `angular_velocity` of new bodies, rad/s; 0 unless given. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// `orientation`: "random", or "as-is", as the body's own `rotation` says. False unless given.
    pub random_orientation: bool,
    /// `start`, s; 0 unless given. At least 0.
    pub start_s: f64,
    /// `end`, s: later than the start. Infinite, unless given: feeds as long as the run lasts.
    pub end_s: f64,
    /// `count`: at most so many bodies. None: no limit. At least 1.
    pub count: Option<u32>,
}

/// How much an inlet feeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FeedRate {
    /// `rate`: bodies per second, 1/s; more than 0.
    Number(f64),
    /// `mass_rate`: kg/s; more than 0.
    Mass(f64),
}

pub(super) fn read_all(
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
    regions: &BTreeMap<String, Region>,
) -> Result<BTreeMap<String, Inlet>> {
    let mut inlets = BTreeMap::new();
    for (name, field) in root.named("inlets")? {
        let inlet = read(&field, bodies, regions)?;
        for (body, _) in &inlet.bodies {
            refuse_own_start(root, &name, body, bodies)?;
        }
        inlets.insert(name, inlet);
    }
    Ok(inlets)
}

fn read(
    field: &Field<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
    regions: &BTreeMap<String, Region>,
) -> Result<Inlet> {
    let table = field.table(&KEYS)?;
    let named = table.need("bodies", "[\"NAME\"], names in [bodies]")?;
    let start_s = table
        .read("start", |field| field.not_negative(&TIME))?
        .unwrap_or_default();
    Ok(Inlet {
        bodies: shares(&named, bodies)?,
        region: table
            .need("region", "\"NAME\", a name in [regions]")?
            .reference(regions.keys(), "regions")?,
        rate: rate(&table)?,
        velocity_m_s: table
            .read("velocity", |field| field.vector(&VELOCITY))?
            .unwrap_or_default(),
        angular_velocity_rad_s: table
            .read("angular_velocity", |field| field.vector(&ANGULAR_VELOCITY))?
            .unwrap_or_default(),
        random_orientation: table
            .read("orientation", |field| field.choice(&ORIENTATIONS))?
            .unwrap_or(false),
        start_s,
        end_s: table
            .read("end", |field| {
                let limit = format!("more than start, {start_s} s");
                let remedy = "write a later time, or leave it out to feed until the run ends";
                field.limited(&TIME, |end_s| end_s > start_s, &limit, remedy)
            })?
            .unwrap_or(f64::INFINITY),
        count: table.read("count", |field| {
            field.small_count("leave it out for no limit")
        })?,
    })
}

/// `["a", "b"]`, or `{ a = 0.7, b = 0.3 }`.
fn shares(field: &Field<'_>, bodies: &BTreeMap<String, BodyEntry>) -> Result<Vec<(String, f64)>> {
    let is_empty = match &field.node.value {
        Value::List(items) => items.is_empty(),
        Value::Table(entries) => entries.is_empty(),
        _ => {
            let remedy = "write [\"NAME\"], or { NAME = 0.7, OTHER = 0.3 }";
            return Err(field.wrong("a list of bodies or a table of their shares", remedy));
        }
    };
    if is_empty {
        let names: Vec<&str> = bodies.keys().map(String::as_str).collect();
        let problem = format!("{} names no body", field.path);
        let remedy = format!("name at least one of {}", names.join(", "));
        return Err(field.refuse(problem, remedy));
    }
    let mut shares: Vec<(String, f64)> = Vec::new();
    if let Value::Table(_) = field.node.value {
        let table = field.any_table()?;
        for (name, node) in table.entries {
            let field = table.field(name, node);
            field.key_reference(name, bodies.keys(), "bodies")?;
            shares.push((name.clone(), field.positive(&NUMBER)?));
        }
        return Ok(shares);
    }
    for item in field.items()? {
        let name = item.reference(bodies.keys(), "bodies")?;
        if shares.iter().any(|(other, _)| *other == name) {
            let problem = format!(
                "{} is \"{name}\", which stands in the list already",
                item.path
            );
            let remedy = "remove one of them, or give shares, such as { NAME = 2, OTHER = 1 }";
            return Err(item.refuse(problem, remedy));
        }
        shares.push((name, 1.0));
    }
    Ok(shares)
}

fn rate(table: &Table<'_>) -> Result<FeedRate> {
    match (table.get("rate"), table.get("mass_rate")) {
        (None, None) => {
            let problem = format!("{} has no rate", table.path);
            let remedy = "add rate = \"4 /s\", bodies per second, or mass_rate = \"10 kg/s\"";
            Err(table.refuse(problem, remedy))
        }
        (Some(field), None) => {
            let remedy = "write bodies per second, such as \"4 /s\"";
            let rate = field.limited(&RATE, |rate| rate > 0.0, "more than 0 1/s", remedy)?;
            Ok(FeedRate::Number(rate))
        }
        (None, Some(field)) => Ok(FeedRate::Mass(field.positive(&MASS_RATE)?)),
        (Some(_), Some(field)) => {
            let problem = format!("{} stands beside rate", field.path);
            Err(field.refuse(problem, "an inlet has one rate: remove one"))
        }
    }
}

/// Refuses where a body that is fed says itself where it stands or how it moves at the start.
fn refuse_own_start(
    root: &Table<'_>,
    inlet: &str,
    name: &str,
    bodies: &BTreeMap<String, BodyEntry>,
) -> Result<()> {
    let Some(body) = bodies.get(name) else {
        return Ok(());
    };
    for (key, given, instead) in [
        ("position", body.position_m, "region"),
        ("velocity", body.velocity_m_s, "velocity"),
        (
            "angular_velocity",
            body.angular_velocity_rad_s,
            "angular_velocity",
        ),
    ] {
        let field = root.find(&["bodies", name, key]);
        if let (Some(field), true) = (field, given != [0.0; 3]) {
            let problem = format!(
                "{} is of the start, but [inlets.{inlet}] feeds the body: it is not there then",
                field.path
            );
            let remedy = format!("remove it: inlets.{inlet}.{instead} stands for it");
            return Err(field.refuse(problem, remedy));
        }
    }
    Ok(())
}
