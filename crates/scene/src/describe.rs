//! A human-readable list of every value of a scene in SI, defaults included.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::listing::Listing;
use super::root::Scene;
use super::schema::Schema;
use super::{
    body, bond, clusters, contact, group, initial, inlet, load, material, measure, outlet, output,
    region, relaxation, replacement, run, search, sleep, support, test, wall,
};
use dem_io::text::visible;

impl Scene {
    /// All values in SI with their units, defaults included: one line each, `key   value`, aligned.
    pub fn describe(&self) -> String {
        let lines = self.values();
        let width = lines.iter().map(|(key, _)| key.len()).max();
        let width = width.unwrap_or_default();
        let mut text = String::new();
        for (key, value) in &lines {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{key:width$}   {}", visible(value));
        }
        text
    }

    /// The parts of [`Self::describe`] as keys and values, in the same order.
    pub fn values(&self) -> Vec<(String, String)> {
        let mut lines = Lines(Vec::new());
        if !self.included.is_empty() {
            let files = self.included.iter().map(|file| file.display().to_string());
            let files: Vec<String> = files.collect();
            lines.0.push(("include".to_owned(), files.join(", ")));
        }
        lines.table("run", &run::RUN, &self.run, run::Run::list);
        lines.each(
            "materials",
            &material::MATERIAL,
            &self.materials,
            material::list,
        );
        for contact in &self.contacts {
            let path = format!("contacts.{}", contact.materials.join("-"));
            lines.table(&path, &contact::CONTACT, contact, contact::list);
        }
        lines.each("bonds", &bond::BOND, &self.bonds, bond::list_kind);
        lines.each("bodies", &body::BODY, &self.bodies, body::list);
        lines.each("walls", &wall::WALL, &self.walls, wall::list);
        lines.each("groups", &group::GROUP, &self.groups, group::list);
        lines.each(
            "initial",
            &initial::INITIAL,
            &self.initial,
            initial::Initial::list,
        );
        lines.each("supports", &support::SUPPORT, &self.supports, support::list);
        lines.each("loads", &load::LOAD, &self.loads, load::list);
        lines.each("regions", &region::REGION, &self.regions, region::list);
        lines.each(
            "replacement",
            &replacement::REPLACEMENT,
            &self.replacement,
            replacement::list,
        );
        lines.each("inlets", &inlet::INLET, &self.inlets, inlet::list);
        lines.each("outlets", &outlet::OUTLET, &self.outlets, outlet::list);
        lines.each("measures", &measure::MEASURE, &self.measures, measure::list);
        // If nothing can touch, only values that differ from the defaults.
        let touches = !self.contacts.is_empty() || !self.walls.is_empty();
        lines.unusual(
            touches,
            "clusters",
            &clusters::CLUSTERS,
            &self.clusters,
            clusters::Clusters::list,
        );
        lines.unusual(
            touches,
            "relaxation",
            &relaxation::RELAXATION,
            &self.relaxation,
            relaxation::Relaxation::list,
        );
        lines.unusual(
            touches,
            "search",
            &search::SEARCH,
            &self.search,
            search::Search::list,
        );
        if let Some(sleep) = &self.sleep {
            lines.table("sleep", &sleep::SLEEP, sleep, sleep::Sleep::list);
        }
        match &self.output {
            Some(output) => lines.table("output", &output::OUTPUT, output, output::list),
            None => lines.0.push(("output".to_owned(), "none".to_owned())),
        }
        if let Some(test) = &self.test {
            lines.table("test", &test::TEST, test, test::list);
        }
        lines.0
    }
}

/// Keys and values, in order.
struct Lines(Vec<(String, String)>);

impl Lines {
    fn table<T>(
        &mut self,
        path: &str,
        schema: &'static Schema,
        table: &T,
        list: fn(&T, &mut Listing),
    ) {
        self.unusual(true, path, schema, table, list);
    }

    /// Every `[kind.NAME]`.
    fn each<T>(
        &mut self,
        kind: &str,
        schema: &'static Schema,
        tables: &BTreeMap<String, T>,
        list: fn(&T, &mut Listing),
    ) {
        for (name, table) in tables {
            self.table(&format!("{kind}.{name}"), schema, table, list);
        }
    }

    /// A table that is always listed, or only if a value differs from its default.
    fn unusual<T>(
        &mut self,
        always: bool,
        path: &str,
        schema: &'static Schema,
        table: &T,
        list: fn(&T, &mut Listing),
    ) {
        let mut listing = Listing::new(path, schema);
        list(table, &mut listing);
        if always || !listing.is_usual {
            self.0.append(&mut listing.lines);
        }
    }
}
