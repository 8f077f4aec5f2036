//! `[bodies.NAME]`

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use super::bond::BondKind;
use super::clump;
use super::clump::{START_AS, StartAs};
use super::conflicts;
use super::direction::ROTATION;
use super::fall::{self, Fall};
use super::field::Field;
use super::listing::Listing;
use super::material::Material;
use super::names::meaning;
use super::paths::named_path;
use super::region::Region;
use super::schema::{Kind, Word, table_schema};
use super::table::Table;
use super::zone::{self, Zone};
use dem_io::diagnostic::Result;
use dem_io::units::{ANGULAR_VELOCITY, DENSITY, LENGTH, MASS, VELOCITY};

/// Source of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum BodySource {
    /// `file`, resolved against the folder of the scene; "-" is standard input.
    File(PathBuf),
    /// `particles` and `bond_list` in the scene. The radius of a bond is that of its smaller
    /// particle times `radius_factor`; its length is their distance.
    Inline {
        /// `particles = [[x, y, z, radius], ...]`, m.
        particles: Vec<[f64; 4]>,
        /// `bond_list = [[a, b], ...]`: indices of particles, from 0; the smaller comes first here,
        /// in any order in the file.
        bonds: Vec<[u32; 2]>,
    },
}

/// A body, its position and its motion at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyEntry {
    /// Source of its particles and bonds.
    pub source: BodySource,
    /// `material`: a name of `[materials]`.
    pub material: String,
    /// `bonds`: a name of `[bonds]`. None only for bodies without bonds.
    pub bond_kind: Option<String>,
    /// `position`: translation, m, after `rotation`; or the position of the centre of mass. Length
    /// 3.
    pub position_m: [f64; 3],
    /// `position_of`, "origin" unless given.
    pub position_of: PositionOf,
    /// `rotation = { axis, angle }`: rotation about the origin of the body's file, as a rotation
    /// vector, rad. Length 3.
    pub rotation_rad: [f64; 3],
    /// `velocity` of the centre of mass, m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// `drop`: it stands for `velocity` and the part of `position` along gravity.
    pub fall: Option<Fall>,
    /// `angular_velocity` about the centre of mass, as a rigid body, rad/s. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// `start_as`, "bonded" unless given, and `clump`.
    pub start_as: StartAs,
    /// `bonded_within`. None: all of it is bonded.
    pub bonded_within: Option<Zone>,
    /// `sieve_size`: smallest square opening that the body is scaled to pass, m. None: the size of
    /// its file.
    pub sieve_size_m: Option<f64>,
    /// The body of the scene that it is a size class of: see [`super::FeedSizes`]. None: it is in
    /// the scene itself.
    pub class_of: Option<String>,
    /// `body_density` or `mass`. None: its spheres have the density of the material.
    pub whole_mass: Option<WholeMass>,
}

/// The point of a body that its `position` is that of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PositionOf {
    /// "origin" of its file.
    Origin,
    /// "centre" of mass.
    Centre,
}

impl Word for PositionOf {
    const WORDS: &'static [(&'static str, Self)] =
        &[("origin", Self::Origin), ("centre", Self::Centre)];
}

/// The total mass of a body, which determines the density of its spheres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WholeMass {
    /// `body_density`: mass over the volume of its shape, kg/m3. Only for a body from a file.
    Density(f64),
    /// `mass`, kg.
    Mass(f64),
}

const PARTICLE: Kind = Kind::Row(&[
    Kind::Quantity(&LENGTH),
    Kind::Quantity(&LENGTH),
    Kind::Quantity(&LENGTH),
    Kind::Quantity(&LENGTH),
]);
const INDEX: Kind = Kind::Whole {
    least: 0,
    most: None,
    of: "",
};

table_schema! {
    /// A body with its initial position and velocity. Give either a `file` or `particles`.
    pub(super) static BODY = "[bodies.NAME]";

    /// File of the body, relative to the folder of the scene; `-` is standard input. `--body` is
    /// relative to the working directory.
    text("file", "a file");
    /// Particles, instead of a file: `[[x, y, z, radius], ...]`.
    new("particles", Kind::List(&PARTICLE));
    /// Bonds between `particles`, which are numbered from 0: `[[0, 1], ...]`.
    new("bond_list", Kind::List(&Kind::Row(&[INDEX, INDEX])));
    /// Its material.
    text("material", "a name in [materials]").required("\"NAME\", a name in [materials]");
    /// Scales the body, its spheres and bonds included, until it just passes a square opening of
    /// this side.
    quantity("sieve_size", &LENGTH).positive().otherwise("the size of its file");
    /// Mass of the body over the volume of its shape, which is stored in its file.
    quantity("body_density", &DENSITY).positive();
    /// Mass of the body. Without `mass` and `body_density`, its spheres have the density of the
    /// material, or else that of the file.
    quantity("mass", &MASS).positive().otherwise("that of its particles");
    /// Properties of its bonds; not required for a body without bonds.
    text("bonds", "a name in [bonds]").sometimes_required("\"NAME\", a name in [bonds]");
    /// Position of the body, after `rotation`.
    vector("position", &LENGTH);
    /// The point of the body that is put at `position`: the origin of its file, or its centre of
    /// mass.
    word::<PositionOf>("position_of", "origin");
    /// Initial rotation about the origin of its file.
    table("rotation", &ROTATION).or(0.0);
    /// Velocity of the centre of mass.
    vector("velocity", &VELOCITY);
    /// A fall onto a wall: the body starts just above it, with the speed that the fall has given
    /// it. Stands for `velocity` and the part of `position` along gravity.
    table("drop", &fall::DROP);
    /// Angular velocity of the rigid body about its centre of mass.
    vector("angular_velocity", &ANGULAR_VELOCITY);
    START_AS;
    /// Settings of the clump; only with `start_as = "clump"`.
    table("clump", &clump::CLUMP);
    /// Region in which the body is bonded; the rest of it is rigid.
    table("bonded_within", &zone::ZONE).otherwise("all of it is bonded");
}

pub(super) fn read_all(
    root: &Table<'_>,
    materials: &BTreeMap<String, Material>,
    bonds: &BTreeMap<String, BondKind>,
    regions: &BTreeMap<String, Region>,
    folder: &Path,
) -> Result<BTreeMap<String, BodyEntry>> {
    let tables = root.named("bodies")?;
    if tables.is_empty() {
        let remedy = "add [bodies.NAME] with file = \"body.vtp\"";
        return Err(root.refuse("there is no body", remedy));
    }
    let mut bodies = BTreeMap::new();
    let mut piped: Option<String> = None;
    for (name, field) in tables {
        if let Some(of) = meaning(&name) {
            return Err(field.fault(format!("is named like {of}"), "give it another name"));
        }
        let body = read(&field, materials, bonds, regions, folder)?;
        if matches!(&body.source, BodySource::File(file) if file.as_os_str() == "-")
            && let Some(first) = piped.replace(name.clone())
        {
            let problem = format!("reads standard input, as bodies.{first} does");
            let remedy = "it can be read once: give one of them another file";
            return Err(field.fault(problem, remedy));
        }
        bodies.insert(name, body);
    }
    Ok(bodies)
}

fn read(
    field: &Field<'_>,
    materials: &BTreeMap<String, Material>,
    bonds: &BTreeMap<String, BondKind>,
    regions: &BTreeMap<String, Region>,
    folder: &Path,
) -> Result<BodyEntry> {
    let table = Table::of(field, &BODY)?;
    let source = source(&table, folder)?;
    let material_field = table.need("material")?;
    let material = material_field.reference(materials.keys(), "materials")?;
    if materials.get(&material).is_some_and(|found| found.rigid) {
        let problem = format!("is \"{material}\", which is rigid, and only walls can be");
        let remedy = "name another material, or give this one a density and a young_modulus";
        return Err(material_field.fault(problem, remedy));
    }
    let bond_kind = table.read_by("bonds", |field| field.reference(bonds.keys(), "bonds"))?;
    let start_as = clump::read(&table)?;
    let whole_mass = whole_mass(&table, &source)?;
    if let BodySource::Inline { bonds, .. } = &source {
        // Also for a clump: the cluster that replaces it needs them.
        if !bonds.is_empty() && bond_kind.is_none() && start_as == StartAs::Bonded {
            table.need("bonds")?;
        }
        let density = materials
            .get(&material)
            .and_then(|found| found.density_kg_m3);
        if density.is_none() && whole_mass.is_none() {
            let problem = format!(
                "is \"{material}\", which has no density, and no file names one for {}",
                table.path
            );
            let remedy = format!("add density = \"2050 kg/m3\" to [materials.{material}]");
            return Err(material_field.fault(problem, remedy));
        }
    }
    Ok(BodyEntry {
        source,
        material,
        bond_kind,
        position_m: table.read("position")?,
        position_of: table.read("position_of")?,
        rotation_rad: table.read("rotation")?,
        velocity_m_s: table.read("velocity")?,
        fall: fall::read(&table)?,
        angular_velocity_rad_s: table.read("angular_velocity")?,
        start_as,
        bonded_within: table.read_by("bonded_within", |field| zone::read(&field, regions))?,
        sieve_size_m: table.read("sieve_size")?,
        class_of: None,
        whole_mass,
    })
}

fn whole_mass(table: &Table<'_>, source: &BodySource) -> Result<Option<WholeMass>> {
    let Some(field) = table.get("body_density") else {
        let mass: Option<f64> = table.read("mass")?;
        return Ok(mass.map(WholeMass::Mass));
    };
    conflicts::BODY.refuse_key("body_density", table)?;
    if matches!(source, BodySource::Inline { .. }) {
        let problem = "is that of a shape, and particles in the scene have none";
        return Err(field.fault(problem, "give the body a mass, such as mass = \"0.4 kg\""));
    }
    Ok(Some(WholeMass::Density(table.read("body_density")?)))
}

fn source(table: &Table<'_>, folder: &Path) -> Result<BodySource> {
    conflicts::BODY.refuse_key("particles", table)?;
    if let Some(file) = table.get("file") {
        return Ok(BodySource::File(named_path(&file, folder)?));
    }
    let Some(particles) = table.get("particles") else {
        let remedy = "add file = \"body.vtp\", or particles = [[x, y, z, radius]]";
        return Err(table.fault("has no particles", remedy));
    };
    let particles = read_particles(&particles)?;
    let bonds = match table.get("bond_list") {
        Some(field) => read_bonds(&field, &particles)?,
        None => Vec::new(),
    };
    Ok(BodySource::Inline { particles, bonds })
}

fn read_particles(field: &Field<'_>) -> Result<Vec<[f64; 4]>> {
    let mut particles = Vec::new();
    for item in field.items()? {
        let [x, y, z, radius] = item.row("[x, y, z, radius]")?;
        particles.push([
            x.quantity(&LENGTH)?,
            y.quantity(&LENGTH)?,
            z.quantity(&LENGTH)?,
            radius.positive(&LENGTH)?,
        ]);
    }
    Ok(particles)
}

/// Bonds with the smaller index first.
fn read_bonds(field: &Field<'_>, particles: &[[f64; 4]]) -> Result<Vec<[u32; 2]>> {
    let mut bonds = Vec::new();
    let mut known: HashMap<[u32; 2], usize> = HashMap::new();
    let count = u32::try_from(particles.len()).unwrap_or(u32::MAX);
    for (number, item) in field.items()?.into_iter().enumerate() {
        let [a, b] = item.row("the numbers of two particles, such as [0, 1]")?;
        let (a, b) = (a.particle(count)?, b.particle(count)?);
        if a == b {
            let problem = format!("joins particle {a} to itself");
            return Err(item.fault(problem, "correct or remove this bond"));
        }
        let pair = [a.min(b), a.max(b)];
        if let Some(first) = known.insert(pair, number) {
            let problem = format!(
                "joins particles {} and {}, which {}[{first}] joins already",
                pair[0], pair[1], field.path
            );
            return Err(item.fault(problem, "remove one of them"));
        }
        let [from, to] = pair.map(|end| &particles[end as usize]);
        if from[..3] == to[..3] {
            let problem = format!(
                "joins particles {} and {}, which are at the same place",
                pair[0], pair[1]
            );
            return Err(item.fault(problem, "a bond needs a length: move one of them"));
        }
        bonds.push(pair);
    }
    Ok(bonds)
}

pub(super) fn list(body: &BodyEntry, listing: &mut Listing) {
    match &body.source {
        BodySource::File(file) => listing.text("file", file.display().to_string()),
        BodySource::Inline { particles, bonds } => {
            listing.text("particles", format!("{} in the scene", particles.len()));
            listing.text("bond_list", format!("{} in the scene", bonds.len()));
        }
    }
    listing.text("material", &body.material);
    listing.value("sieve_size", &body.sieve_size_m);
    match body.whole_mass {
        Some(WholeMass::Density(density)) => listing.value("body_density", &density),
        Some(WholeMass::Mass(mass)) => listing.value("mass", &mass),
        None => listing.value("mass", &None::<f64>),
    }
    listing.value("bonds", &body.bond_kind);
    listing.value("position", &body.position_m);
    listing.value("position_of", &body.position_of);
    listing.value("rotation", &body.rotation_rad);
    match &body.fall {
        Some(fall) => listing.table("drop", &fall::DROP, |listing| fall.list(listing)),
        None => listing.value("velocity", &body.velocity_m_s),
    }
    listing.value("angular_velocity", &body.angular_velocity_rad_s);
    clump::list_start(body.start_as, listing);
    if let Some(zone) = &body.bonded_within {
        listing.table("bonded_within", &zone::ZONE, |listing| {
            zone::list(zone, listing);
        });
    }
}
