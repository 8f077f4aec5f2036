//! What a body that is bonded in a region only cannot be combined with.

use std::collections::BTreeMap;

use super::body::{BodyEntry, BodySource};
use super::bond::{BondKind, Formulation};
use super::clump::StartAs;
use super::conflicts;
use super::field::Field;
use super::inlet::Inlet;
use super::table::Table;
use super::wall::Wall;
use super::zone;
use dem_io::diagnostic::Result;

/// What the zones of a scene refer to.
pub(super) struct Known<'a> {
    pub(super) bodies: &'a BTreeMap<String, BodyEntry>,
    pub(super) bonds: &'a BTreeMap<String, BondKind>,
    pub(super) inlets: &'a BTreeMap<String, Inlet>,
    pub(super) walls: &'a BTreeMap<String, Wall>,
}

/// Refuses zones of bodies that cannot have one, walls that are not there, and what has no meaning
/// beside a zone.
pub(super) fn check(root: &Table<'_>, known: &Known<'_>) -> Result<()> {
    for (name, body) in known.bodies {
        let Some(zone) = &body.bonded_within else {
            continue;
        };
        let Some(field) = root.find(&["bodies", name, "bonded_within"]) else {
            continue;
        };
        let table = Table::of(&field, &zone::ZONE)?;
        if let (Some(_), Some(field)) = (&zone.moves_with, table.get("moves_with")) {
            field.reference(known.walls.keys(), "walls")?;
        }
        check_body(&field, name, body, known)?;
        if let Some(body) = root.find(&["bodies", name]) {
            conflicts::ZONE.refuse(&Table::any(&body)?, root)?;
        }
    }
    Ok(())
}

fn check_body(field: &Field<'_>, name: &str, body: &BodyEntry, known: &Known<'_>) -> Result<()> {
    let path = &field.path;
    if body.start_as != StartAs::Bonded {
        let problem = "has no effect on a clump, which is rigid as a whole";
        return Err(field.fault(problem, "remove start_as = \"clump\", or remove it"));
    }
    let has_bonds = match &body.source {
        BodySource::Inline { bonds, .. } => !bonds.is_empty(),
        // The reader of the file finds whether it has bonds.
        BodySource::File(_) => true,
    };
    let kind = body
        .bond_kind
        .as_ref()
        .and_then(|kind| known.bonds.get(kind));
    let Some(kind) = kind.filter(|_| has_bonds) else {
        let problem = format!("{path}: body '{name}' has no bonds");
        return Err(field.refuse(problem, "give it bonds, or remove it"));
    };
    if kind.formulation == Formulation::Incremental {
        let problem = format!(
            "{path}: the bonds of body '{name}' are incremental, and forget how a rigid part turns"
        );
        return Err(field.refuse(problem, "write formulation = \"total\" in its [bonds]"));
    }
    if kind.plasticity.is_some() || kind.joint.is_some() {
        let problem = format!(
            "{path}: the bonds of body '{name}' keep a history, which a rigid part does not follow"
        );
        let remedy = "take a model other than flat-joint, without plasticity, in its [bonds]";
        return Err(field.refuse(problem, remedy));
    }
    let fed = known.inlets.iter().find(|(_, inlet)| inlet.feeds(name));
    if let Some((inlet, _)) = fed {
        let problem = format!("{path}: [inlets.{inlet}] feeds body '{name}'");
        return Err(field.refuse(problem, "place it in the scene, or remove it"));
    }
    Ok(())
}
