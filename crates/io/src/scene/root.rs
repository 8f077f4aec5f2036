//! The tables of a scene.

use super::schema::{Key, Kind, Schema};
use super::{
    body, bond, clusters, contact, initial, inlet, load, material, measure, outlet, output, region,
    relaxation, replacement, run, search, set, sleep, support, test, wall,
};

pub(super) static SCENE: Schema = Schema {
    title: "",
    doc: "A scene: what stands where, of what, what is done to it, and what is asked.",
    keys: &[
        Key::whole("version", 1, "Version of the format.").required("1"),
        Key::table("run", &run::RUN, run::RUN.doc).required("{ end_time = \"1 s\" }"),
        named(
            "materials",
            &Kind::Table(&material::MATERIAL),
            material::MATERIAL.doc,
        ),
        Key::new(
            "contacts",
            Kind::Named("NAME-NAME", &Kind::Table(&contact::CONTACT)),
            contact::CONTACT.doc,
        ),
        named("bonds", &Kind::Table(&bond::BOND), bond::BOND.doc),
        named("bodies", &Kind::Table(&body::BODY), body::BODY.doc)
            .required("{ NAME = { file = \"body.vtp\" } }"),
        named("walls", &Kind::Table(&wall::WALL), wall::WALL.doc),
        named("sets", &Kind::Table(&set::SET), set::SET.doc),
        named(
            "initial",
            &Kind::Table(&initial::INITIAL),
            initial::INITIAL.doc,
        ),
        named(
            "supports",
            &Kind::Table(&support::SUPPORT),
            support::SUPPORT.doc,
        ),
        named("loads", &Kind::Table(&load::LOAD), load::LOAD.doc),
        named("regions", &Kind::Table(&region::REGION), region::REGION.doc),
        named(
            "replacement",
            &Kind::Table(&replacement::REPLACEMENT),
            replacement::REPLACEMENT.doc,
        ),
        named("inlets", &Kind::Table(&inlet::INLET), inlet::INLET.doc),
        named("outlets", &Kind::Table(&outlet::OUTLET), outlet::OUTLET.doc),
        named(
            "measures",
            &Kind::Table(&measure::MEASURE),
            measure::MEASURE.doc,
        ),
        Key::table("clusters", &clusters::CLUSTERS, clusters::CLUSTERS.doc),
        Key::table(
            "relaxation",
            &relaxation::RELAXATION,
            relaxation::RELAXATION.doc,
        ),
        Key::table("search", &search::SEARCH, search::SEARCH.doc),
        Key::table("sleep", &sleep::SLEEP, sleep::SLEEP.doc),
        Key::table("output", &output::OUTPUT, output::OUTPUT.doc),
        Key::table("test", &test::TEST, test::TEST.doc),
    ],
};

/// Tables `[name.NAME]`.
const fn named(name: &'static str, kind: &'static Kind, doc: &'static str) -> Key {
    Key::new(name, Kind::Named("NAME", kind), doc)
}
