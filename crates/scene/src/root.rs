//! A complete scene, and its tables.

use super::schema::{Kind, table_schema};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::body::{BodyEntry, BodySource};
use super::bond::BondKind;
use super::clusters::Clusters;
use super::contact::Contact;
use super::group::ParticleGroup;
use super::initial::Initial;
use super::inlet::Inlet;
use super::load::Load;
use super::material::Material;
use super::measure::Measure;
use super::outlet::Outlet;
use super::output::Output;
use super::region::Region;
use super::relaxation::Relaxation;
use super::replacement::Replacement;
use super::run::Run;
use super::search::Search;
use super::sleep::Sleep;
use super::support::Support;
use super::test::Test;
use super::wall::Wall;
use super::{
    body, bond, clusters, contact, group, initial, inlet, load, material, measure, outlet, output,
    region, relaxation, replacement, run, search, sleep, support, test, wall,
};

/// Version of the scene format.
pub const SCENE_VERSION: u64 = 1;

/// A complete scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// File from which it was read, as named by the user.
    pub source: String,
    /// `include`: files that its materials, contacts and bonds also come from.
    pub included: Vec<PathBuf>,
    /// What files of materials and of measured curves change that the scene has otherwise, a
    /// sentence each.
    pub notes: Vec<String>,
    /// `[run]`
    pub run: Run,
    /// `[materials.NAME]`
    pub materials: BTreeMap<String, Material>,
    /// `[contacts]`, by pairs of materials: sorted, each pair once. Pairs that bodies and walls
    /// need may be missing.
    pub contacts: Vec<Contact>,
    /// `[bonds.NAME]`
    pub bonds: BTreeMap<String, BondKind>,
    /// `[bodies.NAME]`. At least one.
    pub bodies: BTreeMap<String, BodyEntry>,
    /// `[walls.NAME]`. No body or group has the name of a wall.
    pub walls: BTreeMap<String, Wall>,
    /// `[groups.NAME]`. The name of a body also stands for all its particles, and `all` for all
    /// particles of the scene.
    pub groups: BTreeMap<String, ParticleGroup>,
    /// `[initial.NAME]`
    pub initial: BTreeMap<String, Initial>,
    /// `[supports.NAME]`
    pub supports: BTreeMap<String, Support>,
    /// `[loads.NAME]`
    pub loads: BTreeMap<String, Load>,
    /// `[regions.NAME]`, of any names.
    pub regions: BTreeMap<String, Region>,
    /// `[replacement.NAME]`, by the name of the body: a clump that has bonds or daughters.
    pub replacement: BTreeMap<String, Replacement>,
    /// `[inlets.NAME]`. The bodies that they name are not in the scene at the start.
    pub inlets: BTreeMap<String, Inlet>,
    /// `[outlets.NAME]`
    pub outlets: BTreeMap<String, Outlet>,
    /// `[measures.NAME]`
    pub measures: BTreeMap<String, Measure>,
    /// `[clusters]`
    pub clusters: Clusters,
    /// `[relaxation]`
    pub relaxation: Relaxation,
    /// `[search]`
    pub search: Search,
    /// `[sleep]`. None: nothing sleeps.
    pub sleep: Option<Sleep>,
    /// `[output]`. None: nothing is written to disk unless the command line names a folder.
    pub output: Option<Output>,
    /// `[test]`. None: no laboratory test.
    pub test: Option<Test>,
}

impl Scene {
    /// Names of the bodies that it declares: those that are fed in several sizes once.
    pub fn declared_bodies(&self) -> BTreeSet<&str> {
        let bodies = self.bodies.iter();
        bodies
            .map(|(own, entry)| entry.class_of.as_ref().unwrap_or(own).as_str())
            .collect()
    }

    /// Gives a body another file, in all its sizes.
    pub fn set_body_file(&mut self, name: &str, file: &Path) {
        for (own, entry) in &mut self.bodies {
            if entry.class_of.as_ref().unwrap_or(own) == name {
                entry.source = BodySource::File(file.to_owned());
            }
        }
    }

    /// The body whose daughters a body is: see [`Replacement::daughters`]. None: it is none.
    pub fn parent_of(&self, body: &str) -> Option<&String> {
        replacement::parent_of(body, &self.replacement)
    }
}

table_schema! {
    /// A scene: bodies, walls, materials, loads, measures and output.
    pub(super) static SCENE = "";

    /// Version of the format.
    whole("version", 1).required("1");
    /// Files with further `[materials]`, `[contacts]` and `[bonds]`, relative to the folder of the
    /// scene. `--material` adds a file, whose keys stand above those of tables of the same names.
    new("include", Kind::List(&Kind::Text("a file of materials, contacts and bonds")));
    documented("run", &run::RUN).required("{ end_time = \"1 s\" }");
    named("materials", &Kind::Table(&material::MATERIAL));
    named_by("NAME-NAME", "contacts", &Kind::Table(&contact::CONTACT));
    named("bonds", &Kind::Table(&bond::BOND));
    named("bodies", &Kind::Table(&body::BODY)).required("{ NAME = { file = \"body.vtp\" } }");
    named("walls", &Kind::Table(&wall::WALL));
    named("groups", &Kind::Table(&group::GROUP));
    named("initial", &Kind::Table(&initial::INITIAL));
    named("supports", &Kind::Table(&support::SUPPORT));
    named("loads", &Kind::Table(&load::LOAD));
    named("regions", &Kind::Table(&region::REGION));
    named("replacement", &Kind::Table(&replacement::REPLACEMENT));
    named("inlets", &Kind::Table(&inlet::INLET));
    named("outlets", &Kind::Table(&outlet::OUTLET));
    named("measures", &Kind::Table(&measure::MEASURE));
    documented("clusters", &clusters::CLUSTERS);
    documented("relaxation", &relaxation::RELAXATION);
    documented("search", &search::SEARCH);
    documented("sleep", &sleep::SLEEP);
    documented("output", &output::OUTPUT);
    documented("test", &test::TEST);
}
