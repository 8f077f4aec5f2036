//! Refusal of what does not go together with `contact_beside_bond`.

use super::field::Field;
use super::run::{Integrator, Run};
use super::table::Table;
use dem_io::diagnostic::Result;

/// Tables that add, remove or replace bodies, or let them sleep.
const TABLES: [&str; 4] = ["inlets", "outlets", "replacement", "sleep"];

/// Refuses what does not go together with contacts beside bonds: bodies that come, go, sleep or are
/// rigid, liquid bridges, adhesion, static equilibria, and overlaps that are not kept as they were
/// when the bonds were made.
pub(super) fn refuse_others(root: &Table<'_>, run: &Run) -> Result<()> {
    let mut beside = None;
    for (_, bond) in root.named("bonds")? {
        let key = Table::any(&bond)?.get("contact_beside_bond");
        if let Some(field) = key
            && field.boolean()?
        {
            beside = Some(field);
        }
    }
    let Some(beside) = beside else {
        return Ok(());
    };
    if run.integrator == Integrator::Static {
        let problem = format!(
            "{} has no part in run.integrator = \"static\", in which bonds alone act between bonded ends",
            beside.path
        );
        let remedy = "remove it, or write run.integrator = \"leapfrog\"";
        return Err(beside.refuse(problem, remedy));
    }
    if root.get("contacts").is_none() {
        let problem = format!("{} needs a contact law", beside.path);
        return Err(beside.refuse(problem, "add the pair of its material to [contacts]"));
    }
    let mut found: Vec<Field<'_>> = root.given(&TABLES).map(|(_, field)| field).collect();
    for (_, body) in root.named("bodies")? {
        let body = Table::any(&body)?;
        found.extend(body.get("start_as").filter(|field| field.is("clump")));
        found.extend(body.get("bonded_within"));
    }
    for (_, contact) in root.named("contacts")? {
        let contact = Table::any(&contact)?;
        let others = ["liquid_bridge", "work_of_adhesion"];
        found.extend(others.iter().filter_map(|key| contact.get(key)));
    }
    if let Some(field) = found.first() {
        let problem = format!("{} does not go together with {}", field.path, beside.path);
        return Err(field.refuse(problem, "remove one of them"));
    }
    let relaxation = super::relaxation::read(root)?;
    if !relaxation.enabled || relaxation.min_overlap > 0.0 {
        let problem = format!(
            "{} needs the overlaps of bonded ends as origins of their contacts, whatever they are",
            beside.path
        );
        return Err(beside.refuse(
            problem,
            "write relaxation = { min_overlap = 0 }, without enabled = false",
        ));
    }
    Ok(())
}
