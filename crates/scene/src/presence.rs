//! The bodies that have particles of their own at the start of the run.

use std::collections::BTreeMap;

use super::body::BodyEntry;
use super::clump::StartAs;
use super::field::Field;
use super::inlet::Inlet;
use super::names::ALL;
use super::replacement::{Replacement, parent_of};
use super::table::Table;
use dem_io::diagnostic::Result;

/// Bodies, the inlets that feed some of them, and the replacements that make daughters of others.
/// Neither is in the scene at the start; the particles of a rigid clump cannot be held or moved
/// individually.
pub(super) struct Presence<'a> {
    pub(super) bodies: &'a BTreeMap<String, BodyEntry>,
    pub(super) inlets: &'a BTreeMap<String, Inlet>,
    pub(super) replacement: &'a BTreeMap<String, Replacement>,
}

/// The reason why a body has no particles of its own at the start.
struct Absence {
    /// "which ...", to be put after its name.
    why: String,
    /// The change that gives it particles.
    remedy: String,
}

impl Presence<'_> {
    /// Refuses the body `name`, given by `field`, if it has no particles of its own at the start.
    pub(super) fn refuse_body(&self, field: &Field<'_>, name: &str) -> Result<()> {
        match self.absence(name) {
            Some(Absence { why, remedy }) => {
                let problem = format!("is \"{name}\", {why}");
                Err(field.fault(problem, format!("name another, or {remedy}")))
            }
            None => Ok(()),
        }
    }

    /// Refuses `table`, which refers to the only body, `name`, if that has no particles of its own
    /// at the start.
    pub(super) fn refuse_only(&self, table: &Table<'_>, name: &str) -> Result<()> {
        match self.absence(name) {
            Some(Absence { why, remedy }) => {
                let problem = format!("is of the body \"{name}\", {why}");
                Err(table.fault(problem, format!("remove it, or {remedy}")))
            }
            None => Ok(()),
        }
    }

    /// Refuses the name `all`, given by `field`, if one of the bodies has no particles of its own
    /// at the start.
    pub(super) fn refuse_all(&self, field: &Field<'_>) -> Result<()> {
        for name in self.bodies.keys() {
            if let Some(Absence { why, .. }) = self.absence(name) {
                let problem = format!("is \"{ALL}\", with the body \"{name}\", {why}");
                return Err(field.fault(problem, "name a group or another body"));
            }
        }
        Ok(())
    }

    /// Refuses the group `field` of the body `body`, or of all bodies, if it could select particles
    /// of a clump, or if the body is fed.
    pub(super) fn refuse_group(&self, field: &Field<'_>, body: Option<&str>) -> Result<()> {
        if let Some(name) = body {
            let table = Table::any(field)?;
            return match table.get("body") {
                Some(field) => self.refuse_body(&field, name),
                None => self.refuse_only(&table, name),
            };
        }
        // Bodies that come later are not yet where a group could select their particles.
        for name in self.bodies.keys().filter(|name| self.later(name).is_none()) {
            if let Some(Absence { why, .. }) = self.clump(name) {
                let problem = format!("picks from all bodies, with \"{name}\", {why}");
                return Err(field.fault(problem, "add body = \"NAME\", another body"));
            }
        }
        Ok(())
    }

    /// Refuses the quantity given by `field`, which refers to the start, if `of` or a part of it
    /// comes later.
    pub(super) fn refuse_without_start(&self, field: &Field<'_>, of: &str) -> Result<()> {
        let mut meant = self.bodies.keys().filter(|name| of == ALL || *name == of);
        let Some((name, absence)) =
            meant.find_map(|name| self.later(name).map(|absence| (name, absence)))
        else {
            return Ok(());
        };
        let problem = format!(
            "is {} of \"{of}\", with the body \"{name}\", {}",
            field.shown(),
            absence.why
        );
        Err(field.fault(problem, "ask for a position or a velocity, or of another"))
    }

    fn absence(&self, name: &str) -> Option<Absence> {
        self.later(name).or_else(|| self.clump(name))
    }

    fn later(&self, name: &str) -> Option<Absence> {
        let feeds = |(_, inlet): &(&String, &Inlet)| inlet.feeds(name);
        if let Some(parent) = parent_of(name, self.replacement) {
            return Some(Absence {
                why: format!("daughters of '{parent}': it is not there at the start"),
                remedy: format!("take it out of replacement.{parent}.daughters"),
            });
        }
        let (inlet, _) = self.inlets.iter().find(feeds)?;
        Some(Absence {
            why: format!("which [inlets.{inlet}] feeds: it is not there at the start"),
            remedy: format!("take it out of inlets.{inlet}.bodies"),
        })
    }

    fn clump(&self, name: &str) -> Option<Absence> {
        match self.bodies.get(name)?.start_as {
            StartAs::Bonded => None,
            StartAs::Clump(_) => Some(Absence {
                why: "which starts as a clump: it has no particles of its own".to_owned(),
                remedy: format!("write start_as = \"bonded\" in [bodies.{name}]"),
            }),
        }
    }
}
