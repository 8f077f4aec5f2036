//! `[replacement.NAME]`: NAME is a body.

use std::collections::BTreeMap;

use super::body::{BodyEntry, BodySource};
use super::breakage::{self, BREAKAGE, Breakage};
use super::clump::{ClumpMass, StartAs};
use super::daughters::{self, DAUGHTERS, Daughters};
use super::field::Field;
use super::listing::Listing;
use super::material::Material;
use super::plain_table::{keyed_struct, plain_table};
use super::region::Region;
use super::schema::{Kind, words_of};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ENERGY, ENERGY_PER_MASS, FORCE, STRESS, TIME, VELOCITY};

const NAME_OR_NAMES: Kind = Kind::Either(&[NAME, Kind::List(&NAME)]);
const NAME: Kind = Kind::Text("a name in [walls] or [bodies]");

/// Words for `require`; true if all conditions of `when` must hold.
const REQUIRE: [(&str, bool); 2] = [("any", false), ("all", true)];

keyed_struct! {
    REPLACEMENT = "[replacement.NAME]";
    /// Particle replacement: when the clump NAME, a body with bonds, becomes its bonded cluster,
    /// and when the cluster becomes rigid again; or the `daughters` that replace a clump or a
    /// single sphere, of given sizes or by a law of `breakage`.
    #[derive(Debug, Clone, Default, PartialEq)]
    pub struct Replacement {
        /// Conditions for replacement; at least one. Not with `daughters` or `breakage`.
        when: When = table("when", &WHEN)
            .sometimes_required("{ enters = \"NAME\" }, a name in [regions]");
        /// Pieces that replace the clump or sphere once it has taken in enough energy.
        daughters: Option<Daughters> = table("daughters", &DAUGHTERS)
            .otherwise("its own bonded cluster replaces it");
        /// Loose spheres that replace the clump or sphere by the breakage law of its material.
        breakage: Option<Breakage> = table("breakage", &BREAKAGE).otherwise("no law");
        /// `any` or `all` of the conditions in `when` must hold.
        requires_all: bool = new("require", Kind::Word(|| words_of(&REQUIRE))).or_word("any");
        /// Conditions for a fragment to become rigid again; all must hold.
        restore: Option<Restore> = table("restore", &RESTORE).otherwise("never");
    }
}

plain_table! {
    WHEN = "When";
    /// Conditions that turn a clump into its bonded cluster.
    #[derive(Debug, Clone, Default, PartialEq)]
    pub struct When {
        /// The centre of mass of the clump is in this region.
        enters: Option<String> = text("enters", "a name in [regions]").otherwise("not used");
        /// It touches one of these walls or bodies, by name: `"plate"` or `["plate", "anvil"]`. If
        /// it became rigid while it touched them, it has to part from them first.
        touches: Vec<String> = new("touches", NAME_OR_NAMES).otherwise("not used");
        /// The resultant contact force on the clump reaches this value.
        force_n: Option<f64> = quantity("force", &FORCE).positive().otherwise("not used");
        /// A single contact presses on the clump with this force. Unlike `force`, it sees a squeeze
        /// between two jaws, whose forces cancel.
        contact_force_n: Option<f64> = quantity("contact_force", &FORCE)
            .positive()
            .otherwise("not used");
        /// The mean stress that contacts exert on the clump (Love and Weber: the sum of the dyadic
        /// products of contact force and way from the centre, over the volume) has a principal
        /// value of this magnitude; or the stress of bending of a slender clump reaches it.
        principal_stress_pa: Option<f64> = quantity("principal_stress", &STRESS)
            .positive()
            .otherwise("not used");
        /// The kinetic energy that contacts have taken from the clump reaches this value.
        impact_energy_j: Option<f64> = quantity("impact_energy", &ENERGY)
            .positive()
            .otherwise("not used");
        /// The run reaches this time.
        time_s: Option<f64> = quantity("time", &TIME).not_negative().otherwise("not used");
    }
}

plain_table! {
    RESTORE = "Restore";
    /// Conditions that make a fragment, or an intact body, rigid again. At least one of `leaves` and
    /// `unbroken_for`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Restore {
        /// The centre of the fragment is outside this region.
        leaves: Option<String> = text("leaves", "a name in [regions]").otherwise("not used");
        /// No bond of it has broken for this time, and it has been bonded for as long.
        unbroken_for_s: Option<f64> = quantity("unbroken_for", &TIME)
            .positive()
            .otherwise("not used");
        /// It has at least this many particles.
        min_particles: u32 = new("min_particles", Kind::COUNT)
            .remedy("a usual value is 10")
            .or(10.0);
        /// Elastic energy of its bonds over its mass is at most this.
        strain_energy_j_kg: f64 = quantity("strain_energy", &ENERGY_PER_MASS).positive().or(0.01);
        /// Root mean square velocity of its particles relative to its rigid-body motion is at most
        /// this.
        fluctuation_velocity_m_s: f64 = quantity("fluctuation_velocity", &VELOCITY)
            .positive()
            .or(5e-3);
    }
}

pub(super) fn read_all(
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
    materials: &BTreeMap<String, Material>,
    regions: &BTreeMap<String, Region>,
) -> Result<BTreeMap<String, Replacement>> {
    let mut replacements = BTreeMap::new();
    for (name, field) in root.named("replacement")? {
        let table = Table::of(&field, &REPLACEMENT)?;
        let replacement = match (table.get("daughters"), table.get("breakage")) {
            (Some(_), Some(given)) => {
                let remedy = "remove one of them: the law makes daughters of its own";
                return Err(given.fault("cannot be combined with daughters", remedy));
            }
            (Some(given), None) => {
                refuse_unrelaxed(root, &given)?;
                refuse_conditions(&table, "daughters")?;
                let daughters = daughters::read(&given, &name, root, bodies)?;
                refuse_others_daughters(&given, &daughters, &replacements)?;
                Replacement {
                    daughters: Some(daughters),
                    ..Replacement::default()
                }
            }
            (None, Some(given)) => {
                refuse_unrelaxed(root, &given)?;
                refuse_conditions(&table, "breakage")?;
                Replacement {
                    breakage: Some(breakage::read(&given, &name, bodies, materials)?),
                    ..Replacement::default()
                }
            }
            (None, None) => read(&table, root, bodies, regions)?,
        };
        check_body(root, &name, &field, bodies, &replacement)?;
        replacements.insert(name, replacement);
    }
    Ok(replacements)
}

/// The body whose daughters a body is. None: it is none.
pub(super) fn parent_of<'a>(
    body: &str,
    replacement: &'a BTreeMap<String, Replacement>,
) -> Option<&'a String> {
    let has = |(_, rule): &(&String, &Replacement)| {
        let mut classes = rule
            .daughters
            .iter()
            .flat_map(|daughters| &daughters.classes);
        classes.any(|class| class.body == body)
    };
    replacement.iter().find(has).map(|(parent, _)| parent)
}

/// Refuses a body that is not a clump, cannot break, or would change its mass.
fn check_body(
    root: &Table<'_>,
    name: &str,
    field: &Field<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
    replacement: &Replacement,
) -> Result<()> {
    let Some(body) = bodies.get(name) else {
        return field.key_reference(name, bodies.keys(), "bodies");
    };
    let StartAs::Clump(clump) = body.start_as else {
        let problem = format!("replaces a clump, but the body '{name}' starts bonded");
        let remedy =
            format!("add start_as = \"clump\" to [bodies.{name}], or remove [replacement.{name}]");
        return Err(field.fault(problem, remedy));
    };
    let has_bonds = match &body.source {
        BodySource::Inline { bonds, .. } if bonds.is_empty() => false,
        // The reader of the file finds whether it has bonds.
        _ => body.bond_kind.is_some(),
    };
    if !has_bonds && !replacement.breaks_whole() {
        let problem = format!(
            "{}: body '{name}' has no bonds: it cannot break",
            field.path
        );
        let missing = match body.source {
            BodySource::Inline { ref bonds, .. } if bonds.is_empty() => "bond_list = [[0, 1]]",
            _ => "bonds = \"NAME\"",
        };
        let remedy = format!("add {missing} to [bodies.{name}], or remove [replacement.{name}]");
        return Err(field.refuse(problem, remedy));
    }
    if clump.mass == ClumpMass::Union {
        let mass = root.find(&["bodies", name, "clump", "mass"]);
        let place = mass.unwrap_or_else(|| field.clone());
        let problem = format!(
            "is \"union\", but [replacement.{name}] replaces it: clump and cluster would differ in mass"
        );
        return Err(place.fault(problem, "write mass = \"spheres\""));
    }
    Ok(())
}

/// Refuses daughters that another body has as well: their size is that of one parent.
fn refuse_others_daughters(
    field: &Field<'_>,
    daughters: &Daughters,
    known: &BTreeMap<String, Replacement>,
) -> Result<()> {
    for class in &daughters.classes {
        if let Some(parent) = parent_of(&class.body, known) {
            let body = &class.body;
            let problem = format!("names '{body}', daughters of '{parent}' already");
            let remedy =
                format!("copy [bodies.{body}] under another name: daughters have one parent");
            return Err(field.fault(problem, remedy));
        }
    }
    Ok(())
}

/// Refuses the keys of the bonded cluster, which do not concern what breaks as a whole.
fn refuse_conditions(table: &Table<'_>, with: &str) -> Result<()> {
    for key in ["when", "require", "restore"] {
        if let Some(field) = table.get(key) {
            let problem = format!("cannot be combined with {with}");
            let remedy =
                "remove one of them: daughters come by the energy taken in, and stay as they are";
            return Err(field.fault(problem, remedy));
        }
    }
    Ok(())
}

/// Refuses daughters that no relaxation holds back.
fn refuse_unrelaxed(root: &Table<'_>, field: &Field<'_>) -> Result<()> {
    if let Some(relaxation) = root.find(&["relaxation", "enabled"])
        && !relaxation.boolean()?
    {
        let problem = format!(
            "is false, but {} makes daughters that overlap: without relaxation they fly apart",
            field.path
        );
        return Err(relaxation.fault(problem, "remove it"));
    }
    Ok(())
}

fn read(
    table: &Table<'_>,
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
    regions: &BTreeMap<String, Region>,
) -> Result<Replacement> {
    let when = Table::of(&table.need("when")?, &WHEN)?;
    if when.entries.is_empty() {
        let remedy = "add enters = \"NAME\", touches = \"NAME\", force = \"100 N\", contact_force = \"100 N\", principal_stress = \"0.1 MPa\", impact_energy = \"0.5 J\" or time = \"0.1 s\"";
        return Err(when.fault("is an empty table", remedy));
    }
    when.read_by("enters", |field| field.reference(regions.keys(), "regions"))?;
    when.read_by("touches", |field| {
        refuse_unknown_names(&field, root, bodies)
    })?;
    Ok(Replacement {
        when: When::read(&when)?,
        requires_all: table
            .read_by("require", |field| field.choice(&REQUIRE))?
            .unwrap_or(false),
        restore: table.read_by("restore", |field| restore(&field, regions))?,
        daughters: None,
        breakage: None,
    })
}

fn restore(field: &Field<'_>, regions: &BTreeMap<String, Region>) -> Result<Restore> {
    let table = Table::of(field, &RESTORE)?;
    table.read_by("leaves", |field| field.reference(regions.keys(), "regions"))?;
    if table.get("leaves").is_none() && table.get("unbroken_for").is_none() {
        let remedy = "add unbroken_for = \"5 ms\", leaves = \"NAME\", a name in [regions], or both";
        return Err(table.fault("has neither leaves nor unbroken_for", remedy));
    }
    Restore::read(&table)
}

/// Refuses names of a trigger by touch that are neither walls nor bodies.
fn refuse_unknown_names(
    field: &Field<'_>,
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
) -> Result<()> {
    let walls: Vec<String> = root
        .named("walls")?
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    let known = || walls.iter().chain(bodies.keys());
    for item in field.one_or_more()? {
        item.reference(known(), "walls] or [bodies")?;
    }
    Ok(())
}

impl Replacement {
    /// Whether its particles break as a whole: into daughters of given sizes, or by a law.
    pub fn breaks_whole(&self) -> bool {
        self.daughters.is_some() || self.breakage.is_some()
    }
}

pub(super) fn list(replacement: &Replacement, listing: &mut Listing) {
    if let Some(breakage) = &replacement.breakage {
        return listing.table("breakage", &BREAKAGE, |listing| breakage.list(listing));
    }
    if let Some(daughters) = &replacement.daughters {
        return listing.table("daughters", &DAUGHTERS, |listing| {
            daughters::list(daughters, listing);
        });
    }
    listing.table("when", &WHEN, |listing| replacement.when.list(listing));
    listing.text(
        "require",
        if replacement.requires_all {
            "all"
        } else {
            "any"
        },
    );
    let Some(restore) = &replacement.restore else {
        return listing.text("restore", "never");
    };
    listing.table("restore", &RESTORE, |listing| restore.list(listing));
}
