//! Objects of supports, loads and measures.

use std::collections::BTreeMap;

use super::field::Field;
use super::group::ParticleGroup;
use super::names::{ALL, FRAGMENTS, suggestion};
use super::presence::Presence;
use super::schema::Key;
use super::wall::Wall;
use dem_io::diagnostic::{Diagnostic, Result};

/// The key `group` of supports and loads.
pub(super) const GROUP_KEY: Key = Key::group("group", "The particles that it acts on.");

/// Objects that supports, loads and measures can name: groups, bodies and `all`; walls and
/// `fragments` only for measures.
pub(super) struct Targets<'a> {
    pub(super) groups: &'a BTreeMap<String, ParticleGroup>,
    pub(super) presence: &'a Presence<'a>,
    pub(super) walls: &'a BTreeMap<String, Wall>,
}

/// Objects whose quantities can be measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Subject {
    /// A group, a body or `all`.
    Particles,
    /// A wall.
    Wall,
    /// `fragments`
    Fragments,
}

impl Targets<'_> {
    /// The name given by `field`, if it is that of a group, of a body or `all`, and has particles
    /// of its own at the start.
    pub(super) fn name(&self, field: &Field<'_>) -> Result<String> {
        let name = field.text()?;
        match self.subject(name) {
            Some(Subject::Particles) => {
                if name == ALL {
                    self.presence.refuse_all(field)?;
                } else {
                    self.presence.refuse_body(field, name)?;
                }
                Ok(name.to_owned())
            }
            Some(Subject::Wall) => {
                let remedy = format!(
                    "name a group or a body: the motion of a wall is set in [walls.{name}]"
                );
                Err(field.fault(format!("is \"{name}\", which is a wall"), remedy))
            }
            Some(Subject::Fragments) | None => {
                Err(unknown(field, name, "group or body", self.of_particles()))
            }
        }
    }

    /// The name given by `field`, if it can be measured, and its type.
    pub(super) fn measured(&self, field: &Field<'_>) -> Result<(String, Subject)> {
        let name = field.text()?;
        let subject = self.subject(name).ok_or_else(|| {
            let others = self.walls.keys().map(String::as_str).chain([FRAGMENTS]);
            let known = self.of_particles().chain(others);
            unknown(field, name, "group, body or wall", known)
        })?;
        Ok((name.to_owned(), subject))
    }

    fn subject(&self, name: &str) -> Option<Subject> {
        if name == ALL || self.groups.contains_key(name) || self.presence.bodies.contains_key(name)
        {
            Some(Subject::Particles)
        } else if self.walls.contains_key(name) {
            Some(Subject::Wall)
        } else {
            (name == FRAGMENTS).then_some(Subject::Fragments)
        }
    }

    fn of_particles(&self) -> impl Iterator<Item = &str> {
        let names = self.groups.keys().chain(self.presence.bodies.keys());
        names.map(String::as_str).chain([ALL])
    }
}

/// The error for the name given by `field`, which none of the `kinds` has; `known` are the valid
/// names.
fn unknown<'n>(
    field: &Field<'_>,
    name: &str,
    kinds: &str,
    known: impl Iterator<Item = &'n str>,
) -> Diagnostic {
    let problem = format!("is {}, but no {kinds} has this name", field.shown());
    field.fault(problem, suggestion(name, known))
}
