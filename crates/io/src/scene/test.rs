//! `[test]`: a quasi-static laboratory test.

use std::collections::BTreeMap;

use super::direction::direction;
use super::field::Field;
use super::names::suggestion;
use super::presence::Presence;
use super::table::Table;
use super::tree::Value;
use super::{ParticleSet, Support, Wall, WallMotion};
use crate::Result;
use crate::units::{AREA, LENGTH, NUMBER, STRESS, VELOCITY};

const KEYS: [&str; 17] = [
    "kind",
    "body",
    "moves",
    "direction",
    "stroke",
    "rate",
    "periods",
    "rate_check",
    "young_modulus",
    "poisson_ratio",
    "strength",
    "span",
    "load_distance",
    "width",
    "height",
    "length",
    "area",
];

/// Every kind of test and its name in a scene.
pub(super) const KINDS: [(&str, TestKind); 5] = [
    ("four-point-bending", TestKind::FourPointBending),
    ("three-point-bending", TestKind::ThreePointBending),
    ("brazilian-disc", TestKind::BrazilianDisc),
    ("compression", TestKind::Compression),
    ("tension", TestKind::Tension),
];

/// `periods` unless given.
const PERIODS: f64 = 20.0;
/// `poisson_ratio` unless given.
const POISSON_RATIO: f64 = 0.3;

/// Which laboratory test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TestKind {
    /// "four-point-bending": two pins push between two supports.
    FourPointBending,
    /// "three-point-bending": one pin pushes halfway between two supports.
    ThreePointBending,
    /// "brazilian-disc": a disc is pressed across its diameter until it splits.
    BrazilianDisc,
    /// "compression": a body is pressed along its length.
    Compression,
    /// "tension": a body is gripped at its ends and pulled.
    Tension,
}

impl TestKind {
    /// Its name in a scene.
    pub fn name(self) -> &'static str {
        let found = KINDS.iter().find(|(_, kind)| *kind == self);
        found.map_or("", |(name, _)| *name)
    }

    /// The keys of lengths and areas that mean something to it.
    pub(super) fn dimensions(self) -> &'static [&'static str] {
        match self {
            Self::FourPointBending => &["span", "load_distance", "width", "height"],
            Self::ThreePointBending => &["span", "width", "height"],
            Self::BrazilianDisc => &["width", "height"],
            Self::Compression | Self::Tension => &["length", "area"],
        }
    }
}

/// A quasi-static test: what moves, how far and how fast, and what it is compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Test {
    /// `kind`
    pub kind: TestKind,
    /// `body` that is tested; the only one unless given.
    pub body: String,
    /// `moves`: walls that load, which do not move otherwise; for tension sets that are pulled. At
    /// least one.
    pub moves: Vec<String>,
    /// `direction` in which they move, of length 1; for tension along x, y or z. Length 3.
    pub direction: [f64; 3],
    /// `stroke`: how far they move at most, m.
    pub stroke_m: f64,
    /// `rate`: their velocity, m/s. None, "auto": such that the stroke takes `periods`.
    pub rate_m_s: Option<f64>,
    /// `periods` of the body's lowest frequency, 20 unless given. At least 1.
    pub periods: f64,
    /// `rate_check`: the test is done at twice the rate as well. True unless given.
    pub rate_check: bool,
    /// `young_modulus` that the body as a whole should have, Pa. None: compared with nothing.
    pub young_modulus_pa: Option<f64>,
    /// `poisson_ratio` of the body as a whole, for its shear in bending; 0.3 unless given.
    pub poisson_ratio: f64,
    /// `strength` that the body as a whole should have, by the formula of the test, Pa. None:
    /// compared with nothing.
    pub strength_pa: Option<f64>,
    /// `span` between the supports of a beam, m. None: that of the walls.
    pub span_m: Option<f64>,
    /// `load_distance` between the two loading pins, m. None: that of the walls.
    pub load_distance_m: Option<f64>,
    /// `width` of a beam, or thickness of a disc, m. None: that of the body.
    pub width_m: Option<f64>,
    /// `height` of a beam, or diameter of a disc, m. None: that of the body.
    pub height_m: Option<f64>,
    /// `length` of a body that is pressed or pulled, m. None: that of the body.
    pub length_m: Option<f64>,
    /// `area` of its section, m2. None: volume of the body's shape over its length, or, where no
    /// file names a volume, the product of its other two sides.
    pub area_m2: Option<f64>,
}

/// What a test can name.
pub(super) struct Known<'a> {
    pub(super) presence: &'a Presence<'a>,
    pub(super) sets: &'a BTreeMap<String, ParticleSet>,
    pub(super) walls: &'a BTreeMap<String, Wall>,
    pub(super) supports: &'a BTreeMap<String, Support>,
}

pub(super) fn read(field: &Field<'_>, known: &Known<'_>) -> Result<Test> {
    let table = field.table(&KEYS)?;
    let kind = table
        .need("kind", "\"four-point-bending\"")?
        .choice(&KINDS)?;
    refuse_dimensions(&table, kind)?;
    let pulls = kind == TestKind::Tension;
    let example = if pulls {
        "[\"NAME\"], sets that are pulled"
    } else {
        "[\"NAME\"], walls that load the body"
    };
    let moves = table.need("moves", example)?;
    let moves = all_moved(&moves, pulls, known)?;
    let along = table.need("direction", "[0, 0, -1], in which they move")?;
    let direction = direction(&along, "a direction")?;
    if pulls && direction.iter().filter(|c| **c != 0.0).count() != 1 {
        let remedy = "write [1, 0, 0], [0, 1, 0], [0, 0, 1] or the opposite";
        return Err(along.wrong("along x, y or z, as what a support moves", remedy));
    }
    let length = |key| table.read(key, |field: Field<'_>| field.positive(&LENGTH));
    let stress = |key| table.read(key, |field: Field<'_>| field.positive(&STRESS));
    Ok(Test {
        kind,
        body: body(&table, known)?,
        moves,
        direction,
        stroke_m: table.need("stroke", "\"4 mm\"")?.positive(&LENGTH)?,
        rate_m_s: match table.get("rate") {
            Some(field) => rate(&field)?,
            None => None,
        },
        periods: table
            .read("periods", |field| {
                let remedy = "a usual value is 20: more are slower, and nearer to rest";
                field.limited(&NUMBER, |periods| periods >= 1.0, "at least 1", remedy)
            })?
            .unwrap_or(PERIODS),
        rate_check: table
            .read("rate_check", |field| field.boolean())?
            .unwrap_or(true),
        young_modulus_pa: stress("young_modulus")?,
        poisson_ratio: table
            .read("poisson_ratio", |field| field.poisson_ratio())?
            .unwrap_or(POISSON_RATIO),
        strength_pa: stress("strength")?,
        span_m: length("span")?,
        load_distance_m: length("load_distance")?,
        width_m: length("width")?,
        height_m: length("height")?,
        length_m: length("length")?,
        area_m2: table.read("area", |field| field.positive(&AREA))?,
    })
}

/// Refuses dimensions that mean nothing to the kind of test.
fn refuse_dimensions(table: &Table<'_>, kind: TestKind) -> Result<()> {
    let all = ["span", "load_distance", "width", "height", "length", "area"];
    let known = kind.dimensions();
    match table.given(&all).find(|(key, _)| !known.contains(key)) {
        Some((_, field)) => {
            let problem = format!("{} means nothing to \"{}\"", field.path, kind.name());
            Err(field.refuse(
                problem,
                format!("remove it; known here: {}", known.join(", ")),
            ))
        }
        None => Ok(()),
    }
}

/// The body that is named, or the only one.
fn body(table: &Table<'_>, known: &Known<'_>) -> Result<String> {
    let bodies = known.presence.bodies;
    if let Some(field) = table.get("body") {
        let name = field.reference(bodies.keys(), "bodies")?;
        known.presence.refuse_body(&field, &name)?;
        return Ok(name);
    }
    let mut names = bodies.keys();
    match (names.next(), names.next()) {
        (Some(only), None) => {
            known.presence.refuse_only(table, only)?;
            Ok(only.clone())
        }
        _ => {
            let problem = format!("{}.body is missing, and there are several", table.path);
            let names: Vec<&str> = bodies.keys().map(String::as_str).collect();
            Err(table.refuse(problem, format!("name one of {}", names.join(", "))))
        }
    }
}

/// What `moves` names, each once.
fn all_moved(field: &Field<'_>, pulls: bool, known: &Known<'_>) -> Result<Vec<String>> {
    let mut moves: Vec<String> = Vec::new();
    for item in field.items()? {
        let name = moved(&item, pulls, known)?;
        if moves.contains(&name) {
            let problem = format!(
                "{} is \"{name}\", which stands in the list already",
                item.path
            );
            return Err(item.refuse(problem, "remove one of them"));
        }
        moves.push(name);
    }
    Ok(moves)
}

/// What an item of `moves` names: a wall that stands still, or a set that no support holds.
fn moved(item: &Field<'_>, pulls: bool, known: &Known<'_>) -> Result<String> {
    let name = item.text()?;
    if pulls {
        if !known.sets.contains_key(name) {
            let problem = format!("{} is \"{name}\", but no set has this name", item.path);
            let names = known.sets.keys().map(String::as_str);
            return Err(item.refuse(problem, suggestion(name, names)));
        }
        if let Some((support, _)) = known.supports.iter().find(|(_, s)| s.of == name) {
            let problem = format!(
                "{} is \"{name}\", which [supports.{support}] holds",
                item.path
            );
            return Err(item.refuse(problem, "remove that support: the test moves the set"));
        }
        return Ok(name.to_owned());
    }
    let Some(wall) = known.walls.get(name) else {
        let problem = format!("{} is \"{name}\", but no wall has this name", item.path);
        let names = known.walls.keys().map(String::as_str);
        return Err(item.refuse(problem, suggestion(name, names)));
    };
    if wall.motion != WallMotion::Fixed {
        let problem = format!("{} is \"{name}\", which moves by itself", item.path);
        let remedy = format!("take velocity, displacement or servo from [walls.{name}]");
        return Err(item.refuse(problem, remedy));
    }
    Ok(name.to_owned())
}

/// None for "auto".
fn rate(field: &Field<'_>) -> Result<Option<f64>> {
    let remedy = "write \"auto\" or a velocity such as \"0.2 mm/s\"";
    if matches!(&field.node.value, Value::Text(text) if text == "auto") {
        return Ok(None);
    }
    if field.is_word() {
        return Err(field.wrong("\"auto\" or a velocity", remedy));
    }
    let rate = field.limited(&VELOCITY, |rate| rate > 0.0, "more than 0 m/s", remedy)?;
    Ok(Some(rate))
}
