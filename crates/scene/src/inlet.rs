//! `[inlets.NAME]`

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::body::BodyEntry;
use super::field::Field;
use super::listing::Listing;
use super::numbers::number;
use super::paths::named_path;
use super::region::Region;
use super::replacement::{Replacement, parent_of};
use super::schema::{Kind, Word, table_schema, words_of};
use super::table::Table;
use super::tree::Value;
use dem_io::diagnostic::Result;
use dem_io::sieve_curve::{self, SieveCurve};
use dem_io::units::{ANGULAR_VELOCITY, MASS_RATE, NUMBER, RATE, TIME, VELOCITY, significant};

/// Orientation of new bodies; true for random.
const ORIENTATIONS: [(&str, bool); 2] = [("random", true), ("as-is", false)];
const NAMES_OR_SHARES: Kind = Kind::Either(&[
    Kind::List(&Kind::Text("a name in [bodies]")),
    Kind::Named("NAME", &Kind::Quantity(&NUMBER)),
]);

table_schema! {
    /// Feeds bodies during the run at a `rate` or a `mass_rate`. These bodies are not in the scene
    /// at the start.
    pub(super) static INLET = "[inlets.NAME]";

    /// `["NAME", ...]`, equal numbers of each, or `{ NAME = 0.7, OTHER = 0.3 }`, proportions with
    /// any sum, by number unless `shares_by` says otherwise.
    new("bodies", NAMES_OR_SHARES)
        .required("[\"NAME\"], names in [bodies]");
    /// What the proportions of `bodies` are of: the numbers of bodies fed, or their masses, as in a
    /// feed by sieve classes.
    word::<SharesBy>("shares_by", "number");
    /// Sieve curve of the feed, a CSV file as `dem-pack --diameter sieve:FILE.csv` reads it: each
    /// body is fed in the sizes of the curve, one for each class between two sieves, their
    /// geometric mean, by mass. Results name them `NAME-20-40mm`.
    text("sizes", "a file").otherwise("the sizes of the bodies");
    /// Region in which centres of new bodies are placed at random.
    text("region", "a name in [regions]").required("\"NAME\", a name in [regions]");
    /// Bodies per second.
    quantity("rate", &RATE).positive().remedy("write bodies per second, such as \"4 /s\"");
    /// Mass per second, instead of `rate`.
    quantity("mass_rate", &MASS_RATE).positive();
    /// Velocity of new bodies.
    vector("velocity", &VELOCITY);
    /// Angular velocity of new bodies.
    vector("angular_velocity", &ANGULAR_VELOCITY);
    /// Orientation of new bodies: random, or as given by their `rotation`.
    new("orientation", Kind::Word(|| words_of(&ORIENTATIONS))).or_word("as-is");
    /// Time at which feeding begins.
    quantity("start", &TIME).not_negative().or(0.0);
    /// Time at which feeding ends, later than `start`; by default the end of the run.
    quantity("end", &TIME).otherwise("never");
    /// Maximum number of bodies fed.
    new("count", Kind::COUNT).remedy("leave it out for no limit").otherwise("no limit");
}

/// Feeds bodies during the run. The bodies that it names are not in the scene at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Inlet {
    /// `bodies`: names of `[bodies]`, each once, with their proportions: more than 0, with any sum.
    /// All 1 unless given. At least one.
    pub bodies: Vec<(String, f64)>,
    /// `shares_by`: what these are proportions of.
    pub shares_by: SharesBy,
    /// `sizes`: `bodies` are those of its size classes. None: bodies as they are.
    pub sizes: Option<FeedSizes>,
    /// `region`: a name of `[regions]`, in which the centres of new bodies are placed at random.
    pub region: String,
    /// `rate` or `mass_rate`
    pub rate: FeedRate,
    /// `velocity` of new bodies, m/s; 0 unless given. Length 3.
    pub velocity_m_s: [f64; 3],
    /// `angular_velocity` of new bodies, rad/s; 0 unless given. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// `orientation`: "random", or "as-is" for the body's own `rotation`. False unless given.
    pub random_orientation: bool,
    /// `start`, s; 0 unless given. At least 0.
    pub start_s: f64,
    /// `end`, s: later than the start. Infinite unless given: feeds until the end of the run.
    pub end_s: f64,
    /// `count`: largest number of bodies. None: no limit. At least 1.
    pub count: Option<u32>,
}

impl Inlet {
    /// Whether it feeds the body of this name.
    pub fn feeds(&self, body: &str) -> bool {
        self.bodies.iter().any(|(name, _)| name == body)
    }
}

/// The sieve curve of a feed.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedSizes {
    /// Its file, resolved against the folder of the scene.
    pub file: PathBuf,
    /// Its openings and what passes them.
    pub curve: SieveCurve,
}

/// What the proportions of an inlet's bodies are of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SharesBy {
    /// "number"
    Number,
    /// "mass"
    Mass,
}

impl Word for SharesBy {
    const WORDS: &'static [(&'static str, Self)] =
        &[("number", Self::Number), ("mass", Self::Mass)];
}

/// Feed rate of an inlet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FeedRate {
    /// `rate`: bodies per second, 1/s; more than 0.
    Number(f64),
    /// `mass_rate`: kg/s; more than 0.
    Mass(f64),
}

pub(super) fn read_all(
    root: &Table<'_>,
    folder: &Path,
    bodies: &BTreeMap<String, BodyEntry>,
    regions: &BTreeMap<String, Region>,
    replacement: &BTreeMap<String, Replacement>,
) -> Result<BTreeMap<String, Inlet>> {
    let mut inlets = BTreeMap::new();
    for (name, field) in root.named("inlets")? {
        let inlet = read(&field, folder, bodies, regions)?;
        for (body, _) in &inlet.bodies {
            if let Some(parent) = parent_of(body, replacement) {
                let problem = format!(
                    "{}.bodies names '{body}', daughters of '{parent}'",
                    field.path
                );
                let remedy = "name another body: daughters come when their parent is replaced";
                return Err(field.refuse(problem, remedy));
            }
            refuse_own_start(root, &name, body, bodies)?;
        }
        inlets.insert(name, inlet);
    }
    Ok(inlets)
}

fn read(
    field: &Field<'_>,
    folder: &Path,
    bodies: &BTreeMap<String, BodyEntry>,
    regions: &BTreeMap<String, Region>,
) -> Result<Inlet> {
    let table = Table::of(field, &INLET)?;
    let named = table.need("bodies")?;
    let (start_s, end_s) = (table.read("start")?, table.read("end")?);
    if let (Some(field), true) = (table.get("end"), end_s <= start_s) {
        let limit = format!("more than start, {start_s} s");
        let remedy = "write a later time, or leave it out to feed until the run ends";
        return Err(field.wrong(&limit, remedy));
    }
    Ok(Inlet {
        bodies: fractions(&named, bodies)?,
        shares_by: table.read("shares_by")?,
        sizes: table.read_by("sizes", |field| sizes(&field, &table, folder))?,
        region: table.need("region")?.reference(regions.keys(), "regions")?,
        rate: rate(&table)?,
        velocity_m_s: table.read("velocity")?,
        angular_velocity_rad_s: table.read("angular_velocity")?,
        random_orientation: table
            .read_by("orientation", |field| field.choice(&ORIENTATIONS))?
            .unwrap_or(false),
        start_s,
        end_s,
        count: table.read("count")?,
    })
}

/// The sieve curve in a file.
fn sizes(field: &Field<'_>, inlet: &Table<'_>, folder: &Path) -> Result<FeedSizes> {
    let by = inlet.get("shares_by");
    if let (Some(by), SharesBy::Number) = (by, inlet.read("shares_by")?) {
        let problem = "is \"number\", but a sieve curve is by mass";
        return Err(by.fault(problem, "remove it, or write shares_by = \"mass\""));
    }
    let file = named_path(field, folder)?;
    let curve = sieve_curve::read(&file.display().to_string())?;
    if curve.left_out != [0.0; 2] {
        let problem = format!(
            "names a curve that passes {} % at its smallest opening and {} % at its largest",
            significant(100.0 * curve.left_out[0], 4),
            significant(100.0 * (1.0 - curve.left_out[1]), 4)
        );
        let remedy =
            "add the opening that nothing passes and the one that all passes: a feed has all sizes";
        return Err(field.fault(problem, remedy));
    }
    Ok(FeedSizes { file, curve })
}

/// `["a", "b"]`, or `{ a = 0.7, b = 0.3 }`.
fn fractions(
    field: &Field<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
) -> Result<Vec<(String, f64)>> {
    let is_empty = match &field.node.value {
        Value::List(items) => items.is_empty(),
        Value::Table(entries) => entries.is_empty(),
        _ => {
            let remedy = "write [\"NAME\"], or { NAME = 0.7, OTHER = 0.3 }";
            return Err(field.wrong("a list of bodies or a table of their proportions", remedy));
        }
    };
    if is_empty {
        let names: Vec<&str> = bodies.keys().map(String::as_str).collect();
        let remedy = format!("name at least one of {}", names.join(", "));
        return Err(field.fault("names no body", remedy));
    }
    let mut fractions: Vec<(String, f64)> = Vec::new();
    if let Value::Table(_) = field.node.value {
        let table = Table::any(field)?;
        for (name, node) in table.entries {
            let field = table.field(name, node);
            field.key_reference(name, bodies.keys(), "bodies")?;
            fractions.push((name.clone(), field.positive(&NUMBER)?));
        }
        return Ok(fractions);
    }
    for item in field.items()? {
        let name = item.reference(bodies.keys(), "bodies")?;
        if fractions.iter().any(|(other, _)| *other == name) {
            let remedy = "remove one of them, or give proportions, such as { NAME = 2, OTHER = 1 }";
            let problem = format!("is \"{name}\", which is in the list already");
            return Err(item.fault(problem, remedy));
        }
        fractions.push((name, 1.0));
    }
    Ok(fractions)
}

fn rate(table: &Table<'_>) -> Result<FeedRate> {
    match (table.get("rate"), table.get("mass_rate")) {
        (None, None) => {
            let remedy = "add rate = \"4 /s\", bodies per second, or mass_rate = \"10 kg/s\"";
            Err(table.fault("has no rate", remedy))
        }
        (Some(_), None) => Ok(FeedRate::Number(table.read("rate")?)),
        (None, Some(_)) => Ok(FeedRate::Mass(table.read("mass_rate")?)),
        (Some(_), Some(field)) => Err(field.fault(
            "cannot be combined with rate",
            "an inlet has one rate: remove one",
        )),
    }
}

/// Refuses a body that is fed but has its own position or motion at the start.
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
                "is of the start, but [inlets.{inlet}] feeds the body: it is not there then"
            );
            let remedy = format!("remove it: inlets.{inlet}.{instead} stands for it");
            return Err(field.fault(problem, remedy));
        }
    }
    Ok(())
}

pub(super) fn list(inlet: &Inlet, listing: &mut Listing) {
    let fraction = |(body, fraction): &(String, f64)| format!("{body}: {}", number(*fraction));
    let fractions: Vec<String> = inlet.bodies.iter().map(fraction).collect();
    listing.text("bodies", fractions.join(", "));
    listing.value("shares_by", &inlet.shares_by);
    listing.text("region", &inlet.region);
    match inlet.rate {
        FeedRate::Number(rate) => listing.value("rate", &rate),
        FeedRate::Mass(rate) => listing.value("mass_rate", &rate),
    }
    listing.value("velocity", &inlet.velocity_m_s);
    listing.value("angular_velocity", &inlet.angular_velocity_rad_s);
    let orientation = ORIENTATIONS
        .iter()
        .find(|(_, random)| *random == inlet.random_orientation);
    listing.text("orientation", orientation.map_or("", |(word, _)| *word));
    listing.value("start", &inlet.start_s);
    listing.value("end", &inlet.end_s);
    listing.value("count", &inlet.count);
}
