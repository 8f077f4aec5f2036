//! `[contacts]`: the contact between two materials.

mod liquid_bridge;
mod pair;

use std::collections::BTreeMap;
use std::ops::Bound::{Excluded, Included};

pub use self::liquid_bridge::LiquidBridge;

use self::liquid_bridge::LIQUID_BRIDGE;
use self::pair::named_pair;
use super::field::Field;
use super::listing::Listing;
use super::material::Material;
use super::schema::{Kind, table_schema, words_of};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ENERGY_PER_AREA, STIFFNESS};
use dem_physics::contact::law::Rolling;
use dem_physics::contact::rolling::{ConstantMoment, ElasticPlastic};

/// Smallest coefficient of restitution: dampers below it need arbitrarily small steps.
const LEAST_RESTITUTION: f64 = 1e-3;

#[derive(Clone, Copy)]
enum LawName {
    HertzMindlin,
    Dmt,
    Linear,
}

const LAWS: [(&str, LawName); 3] = [
    ("hertz-mindlin", LawName::HertzMindlin),
    ("dmt", LawName::Dmt),
    ("linear", LawName::Linear),
];

/// Rolling laws; true with a spring.
const ROLLINGS: [(&str, bool); 2] = [("constant-torque", false), ("spring-dashpot", true)];

table_schema! {
    /// Contact law of two materials. Their names may be in either order and may contain a hyphen.
    pub(super) static CONTACT = "[contacts.NAME-NAME]";

    /// Hertz-Mindlin, the same with the adhesion of Derjaguin, Muller and Toporov, or a linear
    /// spring and dashpot.
    new("law", Kind::Word(|| words_of(&LAWS))).or_word("hertz-mindlin");
    /// Work that separates two surfaces, of the law `dmt`, which requires it: the pull-off force is
    /// 2 pi times it and the effective radius. Twice the surface energy for a material with itself.
    quantity("work_of_adhesion", &ENERGY_PER_AREA).positive().sometimes_required("\"50 mJ/m2\"");
    /// Normal stiffness of the law `linear`, which requires it.
    quantity("normal_stiffness", &STIFFNESS).positive().sometimes_required("\"100 kN/m\"");
    /// Tangential over normal stiffness of the law `linear`; the default is 2/7.
    number("tangential_stiffness_ratio")
        .within(Excluded(0.0), Included(1.0))
        .remedy("leave it out for 2/7")
        .or(2.0 / 7.0);
    /// Coefficient of restitution: relative speed after a head-on collision over that before it.
    number("restitution")
        .within(Included(LEAST_RESTITUTION), Included(1.0))
        .remedy("1 loses nothing, a usual value is 0.5; the smaller it is, the smaller is the time step")
        .required("0.5");
    /// Coefficient of sliding friction: largest tangential force over the normal force.
    number("friction").not_negative().or(0.0);
    /// Model of rolling friction; `constant-torque` if only `rolling_friction` is given.
    new("rolling", Kind::Word(|| words_of(&ROLLINGS)));
    /// Coefficient of rolling friction; 0 is none. Above 0 it requires a `friction` above 0.
    number("rolling_friction").not_negative().remedy("0 is none").sometimes_required("0.05");
    /// Damping ratio of the model `spring-dashpot`, as a fraction of critical damping.
    number("rolling_damping_ratio")
        .within(Included(0.0), Included(1.0))
        .remedy("it is a fraction of critical damping: a usual value is 0.3")
        .or(0.3);
    /// Liquid between ends that have touched, which pulls them together beside the law; without it
    /// they are dry.
    table("liquid_bridge", &LIQUID_BRIDGE);
}

/// The contact between two materials.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Names of `[materials]`, sorted; the same name twice for a material with itself.
    pub materials: [String; 2],
    /// `law`
    pub law: ContactLaw,
    /// `restitution`: speed after a head-on collision over the speed before it, in (0, 1].
    pub restitution: f64,
    /// `friction`: largest tangential force over the normal one; 0 unless given.
    pub friction: f64,
    /// `rolling`: none if `friction` is 0.
    pub rolling: Rolling,
    /// `liquid_bridge = { ... }`. None: dry.
    pub liquid_bridge: Option<LiquidBridge>,
}

/// How forces are computed from overlap and sliding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactLaw {
    /// "hertz-mindlin", unless given: elastic spheres. Both materials have a `young_modulus`, or
    /// one of them is rigid.
    HertzMindlin,
    /// "dmt": the same with adhesion.
    Dmt {
        /// `work_of_adhesion`, J/m2; more than 0.
        work_of_adhesion_j_m2: f64,
    },
    /// "linear": a spring and a dashpot.
    Linear {
        /// `normal_stiffness`, N/m.
        normal_n_m: f64,
        /// `tangential_stiffness_ratio`: tangential over normal stiffness, 2/7 unless given; in (0,
        /// 1].
        tangential_stiffness_ratio: f64,
    },
}

impl ContactLaw {
    /// Whether its stiffness is that of the materials.
    fn needs_moduli(&self) -> bool {
        match self {
            Self::HertzMindlin | Self::Dmt { .. } => true,
            Self::Linear { .. } => false,
        }
    }
}

/// The contacts of a scene, sorted by their materials.
pub(super) fn read_all(
    root: &Table<'_>,
    materials: &BTreeMap<String, Material>,
) -> Result<Vec<Contact>> {
    let Some(field) = root.get("contacts") else {
        return Ok(Vec::new());
    };
    let table = Table::any(&field)?;
    let mut contacts = BTreeMap::new();
    let mut paths: BTreeMap<[String; 2], String> = BTreeMap::new();
    for (key, node) in table.entries {
        let field = table.field(key, node);
        let pair = named_pair(key, &field, materials)?;
        if let Some(first) = paths.insert(pair.clone(), field.path.clone()) {
            return Err(field.fault(format!("is the same pair as {first}"), "remove one of them"));
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
    let table = Table::of(field, &CONTACT)?;
    let is_rigid = |name: &String| materials.get(name).is_some_and(|material| material.rigid);
    if pair.iter().all(is_rigid) {
        let problem = "is a pair of rigid materials";
        let remedy = "remove it: only walls are rigid, and walls never meet each other";
        return Err(field.fault(problem, remedy));
    }
    let law = law(&table)?;
    if law.needs_moduli() {
        need_moduli(&table, &pair, materials)?;
    }
    let restitution = table.read("restitution")?;
    let friction = table.read("friction")?;
    Ok(Contact {
        materials: pair,
        law,
        restitution,
        friction,
        rolling: rolling(&table, friction)?,
        liquid_bridge: table.read_by("liquid_bridge", |field| {
            LiquidBridge::read(&Table::of(&field, &LIQUID_BRIDGE)?)
        })?,
    })
}

/// Keys that only one law has, with the name of the law.
type Own = (&'static str, &'static [&'static str]);
const OF_LINEAR: Own = (
    "linear",
    &["normal_stiffness", "tangential_stiffness_ratio"],
);
const OF_DMT: Own = ("dmt", &["work_of_adhesion"]);

/// Why laws of Hertz have no keys of stiffness.
const STIFF_BY_MATERIALS: &str = "whose stiffness is that of the materials";

/// Refuses keys that belong to another law than `law`.
fn refuse_of(table: &Table<'_>, (other, keys): &Own, law: &str, why: &str) -> Result<()> {
    match keys.iter().find_map(|key| table.get(key)) {
        Some(field) => {
            let remedy = format!("remove it, or write law = \"{other}\"");
            let problem = format!("does not apply to the law \"{law}\", {why}");
            Err(field.fault(problem, remedy))
        }
        None => Ok(()),
    }
}

fn law(table: &Table<'_>) -> Result<ContactLaw> {
    let name = table.read_by("law", |field| field.choice(&LAWS))?;
    match name.unwrap_or(LawName::HertzMindlin) {
        LawName::Dmt => {
            refuse_of(table, &OF_LINEAR, "dmt", STIFF_BY_MATERIALS)?;
            Ok(ContactLaw::Dmt {
                work_of_adhesion_j_m2: table.read("work_of_adhesion")?,
            })
        }
        LawName::HertzMindlin => {
            refuse_of(table, &OF_DMT, "hertz-mindlin", "which has no adhesion")?;
            refuse_of(table, &OF_LINEAR, "hertz-mindlin", STIFF_BY_MATERIALS)?;
            Ok(ContactLaw::HertzMindlin)
        }
        LawName::Linear => {
            refuse_of(table, &OF_DMT, "linear", "which has no adhesion")?;
            Ok(ContactLaw::Linear {
                normal_n_m: table.read("normal_stiffness")?,
                tangential_stiffness_ratio: table.read("tangential_stiffness_ratio")?,
            })
        }
    }
}

/// Refuses a pair if one material has no Young's modulus, which Hertz-Mindlin needs, and is not
/// rigid.
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
    let problem = format!("follows Hertz's law, but [materials.{name}] has no young_modulus");
    let remedy = format!(
        "add young_modulus = \"15 MPa\" to [materials.{name}], or write law = \"linear\" here"
    );
    Err(table.fault(problem, remedy))
}

fn rolling(table: &Table<'_>, sliding_friction: f64) -> Result<Rolling> {
    let is_sprung = table.read_by("rolling", |field| field.choice(&ROLLINGS))?;
    let damping_ratio = table.read("rolling_damping_ratio")?;
    if let (Some(field), false) = (table.get("rolling_damping_ratio"), is_sprung == Some(true)) {
        let problem = "has no effect without rolling = \"spring-dashpot\"";
        return Err(field.fault(problem, "remove it, or add rolling = \"spring-dashpot\""));
    }
    if is_sprung.is_none() && table.get("rolling_friction").is_none() {
        return Ok(Rolling::Free);
    }
    let friction = table.read("rolling_friction")?;
    if friction == 0.0 {
        return Ok(Rolling::Free);
    }
    if let (Some(field), true) = (table.get("rolling_friction"), sliding_friction == 0.0) {
        let problem = format!(
            "is {}, but {}.friction is {}: what slides freely has no grip to roll with",
            field.shown(),
            table.path,
            if table.get("friction").is_some() {
                "0"
            } else {
                "not given, which means 0"
            }
        );
        return Err(field.fault(problem, "give friction above 0, or rolling_friction = 0"));
    }
    Ok(if is_sprung == Some(true) {
        Rolling::Spring(ElasticPlastic {
            friction,
            damping_ratio,
        })
    } else {
        Rolling::Constant(ConstantMoment { friction })
    })
}

pub(super) fn list(contact: &Contact, listing: &mut Listing) {
    match contact.law {
        ContactLaw::HertzMindlin => listing.text("law", "hertz-mindlin"),
        ContactLaw::Dmt {
            work_of_adhesion_j_m2,
        } => {
            listing.text("law", "dmt");
            listing.value("work_of_adhesion", &work_of_adhesion_j_m2);
        }
        ContactLaw::Linear {
            normal_n_m,
            tangential_stiffness_ratio,
        } => {
            listing.text("law", "linear");
            listing.value("normal_stiffness", &normal_n_m);
            listing.value("tangential_stiffness_ratio", &tangential_stiffness_ratio);
        }
    }
    listing.value("restitution", &contact.restitution);
    listing.value("friction", &contact.friction);
    match contact.rolling {
        Rolling::Free => listing.text("rolling", "none"),
        Rolling::Constant(moment) => {
            listing.text("rolling", "constant-torque");
            listing.value("rolling_friction", &moment.friction);
        }
        Rolling::Spring(spring) => {
            listing.text("rolling", "spring-dashpot");
            listing.value("rolling_friction", &spring.friction);
            listing.value("rolling_damping_ratio", &spring.damping_ratio);
        }
    }
    if let Some(bridge) = &contact.liquid_bridge {
        listing.table("liquid_bridge", &LIQUID_BRIDGE, |listing| {
            bridge.list(listing);
        });
    }
}
