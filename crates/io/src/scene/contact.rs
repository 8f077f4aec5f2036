//! `[contacts]`: how two materials touch.

mod pair;

use std::collections::BTreeMap;

use self::pair::named_pair;
use super::Material;
use super::field::Field;
use super::table::Table;
use crate::Result;
use crate::units::{NUMBER, STIFFNESS};

/// Least coefficient of restitution: dampers that leave less need steps without end.
const LEAST_RESTITUTION: f64 = 1e-3;

const KEYS: [&str; 8] = [
    "law",
    "normal_stiffness",
    "tangential_ratio",
    "restitution",
    "friction",
    "rolling",
    "rolling_friction",
    "rolling_damping",
];

/// `tangential_ratio` unless given.
const TANGENTIAL_RATIO: f64 = 2.0 / 7.0;

/// `rolling_damping` unless given.
const ROLLING_DAMPING: f64 = 0.3;

/// How two materials touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Names of `[materials]`, sorted; twice the same for a material with itself.
    pub materials: [String; 2],
    /// `law`
    pub law: ContactLaw,
    /// `restitution`: speed after a head-on collision over that before it, in (0, 1].
    pub restitution: f64,
    /// `friction`: largest tangential force over the normal one; 0 unless given.
    pub friction: f64,
    /// `rolling`: none where `friction` is 0.
    pub rolling: Rolling,
}

/// How forces follow from overlap and sliding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactLaw {
    /// "hertz-mindlin", unless given: elastic spheres. Both materials have a `young_modulus`, or
    /// one of them is rigid.
    HertzMindlin,
    /// "linear": a spring and a dashpot.
    Linear {
        /// `normal_stiffness`, N/m.
        normal_n_m: f64,
        /// `tangential_ratio`: tangential over normal stiffness, 2/7 unless given; in (0, 1].
        tangential_ratio: f64,
    },
}

/// What resists rolling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rolling {
    /// Nothing, without `rolling_friction`.
    None,
    /// "constant-torque", unless given.
    ConstantTorque {
        /// `rolling_friction`, a coefficient of more than 0.
        friction: f64,
    },
    /// "spring-dashpot": elastic up to that torque, then plastic.
    SpringDashpot {
        /// `rolling_friction`, a coefficient of more than 0.
        friction: f64,
        /// `rolling_damping`: share of the critical damping, 0.3 unless given; in [0, 1].
        damping: f64,
    },
}

/// The contacts of a scene, sorted by their materials.
pub(super) fn read_all(
    root: &Table<'_>,
    materials: &BTreeMap<String, Material>,
) -> Result<Vec<Contact>> {
    let Some(field) = root.get("contacts") else {
        return Ok(Vec::new());
    };
    let table = field.any_table()?;
    let mut contacts = BTreeMap::new();
    let mut paths: BTreeMap<[String; 2], String> = BTreeMap::new();
    for (key, node) in table.entries {
        let field = table.field(key, node);
        let pair = named_pair(key, &field, materials)?;
        if let Some(first) = paths.insert(pair.clone(), field.path.clone()) {
            let problem = format!("{} is the same pair as {first}", field.path);
            return Err(field.refuse(problem, "remove one of them"));
        }
        contacts.insert(pair.clone(), read(&field, pair, materials)?);
    }
    Ok(contacts.into_values().collect())
}

fn read(
    field: &Field<'_>,
    pair: [String; 2],
    materials: &BTreeMap<String, Material>,
) -> Result<Contact> {
    let table = field.table(&KEYS)?;
    let is_rigid = |name: &String| materials.get(name).is_some_and(|material| material.rigid);
    if pair.iter().all(is_rigid) {
        let problem = format!("{} is a pair of rigid materials", field.path);
        return Err(field.refuse(
            problem,
            "remove it: only walls are rigid, and walls never meet each other",
        ));
    }
    let law = law(&table)?;
    if law == ContactLaw::HertzMindlin {
        need_moduli(&table, &pair, materials)?;
    }
    let restitution = table.need("restitution", "0.5")?.limited(
        &NUMBER,
        |e| (LEAST_RESTITUTION..=1.0).contains(&e),
        "at least 0.001 and at most 1",
        "1 loses nothing, a usual value is 0.5; the smaller it is, the smaller is the time step",
    )?;
    let friction = table
        .read("friction", |field| field.not_negative(&NUMBER))?
        .unwrap_or_default();
    Ok(Contact {
        materials: pair,
        law,
        restitution,
        friction,
        rolling: rolling(&table, friction)?,
    })
}

fn law(table: &Table<'_>) -> Result<ContactLaw> {
    let laws = [("hertz-mindlin", false), ("linear", true)];
    let is_linear = table.read("law", |field| field.choice(&laws))?;
    if is_linear != Some(true) {
        let mut of_linear = table.given(&["normal_stiffness", "tangential_ratio"]);
        if let Some((_, field)) = of_linear.next() {
            let problem = format!(
                "{} means nothing to the law \"hertz-mindlin\", whose stiffness is that of the materials",
                field.path
            );
            return Err(field.refuse(problem, "remove it, or write law = \"linear\""));
        }
        return Ok(ContactLaw::HertzMindlin);
    }
    Ok(ContactLaw::Linear {
        normal_n_m: table
            .need("normal_stiffness", "\"100 kN/m\"")?
            .positive(&STIFFNESS)?,
        tangential_ratio: table
            .read("tangential_ratio", |field| {
                field.limited(
                    &NUMBER,
                    |ratio| ratio > 0.0 && ratio <= 1.0,
                    "more than 0 and at most 1",
                    "leave it out for 2/7",
                )
            })?
            .unwrap_or(TANGENTIAL_RATIO),
    })
}

/// Whether both materials say how stiff they are, as Hertz and Mindlin need it.
fn need_moduli(
    table: &Table<'_>,
    pair: &[String; 2],
    materials: &BTreeMap<String, Material>,
) -> Result<()> {
    let has_none = |name: &&String| {
        let material = materials.get(*name);
        material.is_none_or(|material| material.young_modulus_pa.is_none() && !material.rigid)
    };
    let Some(name) = pair.iter().find(has_none) else {
        return Ok(());
    };
    let problem = format!(
        "{} follows the law \"hertz-mindlin\", but [materials.{name}] has no young_modulus",
        table.path
    );
    let remedy = format!(
        "add young_modulus = \"15 MPa\" to [materials.{name}], or write law = \"linear\" here"
    );
    Err(table.refuse(problem, remedy))
}

fn rolling(table: &Table<'_>, sliding_friction: f64) -> Result<Rolling> {
    let laws = [("constant-torque", false), ("spring-dashpot", true)];
    let is_sprung = table.read("rolling", |field| field.choice(&laws))?;
    let damping = table.read("rolling_damping", |field| {
        field.limited(
            &NUMBER,
            |share| (0.0..=1.0).contains(&share),
            "at least 0 and at most 1",
            "it is a share of the critical damping: a usual value is 0.3",
        )
    })?;
    if let (Some(field), false) = (table.get("rolling_damping"), is_sprung == Some(true)) {
        let problem = format!(
            "{} stands without rolling = \"spring-dashpot\", on which it acts",
            field.path
        );
        return Err(field.refuse(problem, "remove it, or add rolling = \"spring-dashpot\""));
    }
    if is_sprung.is_none() && table.get("rolling_friction").is_none() {
        return Ok(Rolling::None);
    }
    let friction = table.need("rolling_friction", "0.05")?.limited(
        &NUMBER,
        |friction| friction > 0.0,
        "more than 0",
        "a law of rolling needs its friction: remove rolling and rolling_friction where nothing resists",
    )?;
    if let (Some(field), true) = (table.get("rolling_friction"), sliding_friction == 0.0) {
        let problem = format!(
            "{} is {}, but {}.friction is {}: what slides freely has no grip to roll with",
            field.path,
            field.shown(),
            table.path,
            if table.get("friction").is_some() {
                "0"
            } else {
                "not given, which means 0"
            }
        );
        return Err(field.refuse(
            problem,
            "give friction above 0, or remove rolling and rolling_friction",
        ));
    }
    Ok(if is_sprung == Some(true) {
        Rolling::SpringDashpot {
            friction,
            damping: damping.unwrap_or(ROLLING_DAMPING),
        }
    } else {
        Rolling::ConstantTorque { friction }
    })
}
