//! Refusal of tables that have no meaning for a static equilibrium.

use super::field::Field;
use super::table::Table;
use dem_io::diagnostic::Result;

/// Tables of moving or fed objects, and initial conditions.
const TABLES: [&str; 5] = ["initial", "replacement", "inlets", "outlets", "sleep"];
/// Tables of contacts, which only a laboratory test needs.
const OF_CONTACTS: [&str; 2] = ["contacts", "walls"];
/// Motions of supports, of which a laboratory test has none but its own.
const MOTIONS: [&str; 2] = ["displacement", "velocity"];

/// Refuses everything except bonded bodies, loads, supports and laboratory tests in a scene solved
/// for its static equilibrium.
pub(super) fn refuse_what_moves(root: &Table<'_>) -> Result<()> {
    let has_test = root.get("test").is_some();
    let of_contacts = root.given(&OF_CONTACTS).filter(|_| !has_test);
    if let Some((_, field)) = root.given(&TABLES).chain(of_contacts).next() {
        let problem = format!(
            "[{}] is not available with run.integrator = \"static\", which handles bonded bodies, loads, supports and laboratory tests only",
            field.path
        );
        let remedy = "remove it, or write run.integrator = \"leapfrog\"";
        return Err(field.refuse(problem, remedy));
    }
    if has_test {
        refuse_beside_a_test(root)?;
    }
    for table in ["supports", "loads"] {
        for (_, one) in root.named(table)? {
            if let Some(field) = Table::any(&one)?.get("end") {
                let problem = format!(
                    "{} has no effect with run.integrator = \"static\"",
                    field.path
                );
                let remedy = format!(
                    "remove it, or the whole [{}] if it is over; or write run.integrator = \"leapfrog\"",
                    one.path
                );
                return Err(field.refuse(problem, remedy));
            }
        }
    }
    let incremental = written(root, "bonds", "formulation", "incremental")?;
    if let Some(field) = incremental {
        let problem = format!(
            "{} is \"incremental\": its forces follow from steps, of which run.integrator = \"static\" makes none",
            field.path
        );
        let remedy = "write formulation = \"total\", or run.integrator = \"leapfrog\"";
        return Err(field.refuse(problem, remedy));
    }
    for (tables, key, why) in [
        (
            "bodies",
            "bonded_within",
            "is not available with run.integrator = \"static\", which bonds all of a body",
        ),
        (
            "contacts",
            "liquid_bridge",
            "has no part in run.integrator = \"static\", in which contacts only press",
        ),
        (
            "bonds",
            "plasticity",
            "needs the way to a load, and run.integrator = \"static\" goes straight to its equilibrium",
        ),
    ] {
        for (_, table) in root.named(tables)? {
            if let Some(field) = Table::any(&table)?.get(key) {
                let problem = format!("{} {why}", field.path);
                let remedy = "remove it, or write run.integrator = \"leapfrog\"";
                return Err(field.refuse(problem, remedy));
            }
        }
    }
    if let Some(field) = written(root, "bonds", "model", "flat-joint")? {
        let problem = format!(
            "{} is \"flat-joint\": elements fail on the way to a load, and run.integrator = \"static\" goes straight to its equilibrium",
            field.path
        );
        let remedy = "take another model, or write run.integrator = \"leapfrog\"";
        return Err(field.refuse(problem, remedy));
    }
    if let Some(field) = written(root, "bodies", "start_as", "clump")? {
        let problem = format!(
            "{} is \"clump\", and run.integrator = \"static\" has nothing to do for a rigid body",
            field.path
        );
        let remedy = "write start_as = \"bonded\", or run.integrator = \"leapfrog\"";
        return Err(field.refuse(problem, remedy));
    }
    Ok(())
}

/// Refuses whatever else acts on the body of a laboratory test.
fn refuse_beside_a_test(root: &Table<'_>) -> Result<()> {
    let mut found: Vec<Field<'_>> = root.given(&["loads"]).map(|(_, field)| field).collect();
    if let Some(run) = root.get("run") {
        found.extend(Table::any(&run)?.get("gravity"));
    }
    for (_, one) in root.named("supports")? {
        let table = Table::any(&one)?;
        found.extend(MOTIONS.iter().filter_map(|key| table.get(key)));
    }
    match found.first() {
        Some(field) => {
            let problem = format!(
                "{} has no effect on a [test] with run.integrator = \"static\"",
                field.path
            );
            let remedy = "remove it, or write run.integrator = \"leapfrog\"";
            Err(field.refuse(problem, remedy))
        }
        None => Ok(()),
    }
}

/// The word, if a `[table.NAME]` has it for this key.
fn written<'a>(root: &Table<'a>, table: &str, key: &str, word: &str) -> Result<Option<Field<'a>>> {
    for (_, one) in root.named(table)? {
        let field = Table::any(&one)?.get(key);
        if let Some(field) = field.filter(|field| field.is(word)) {
            return Ok(Some(field));
        }
    }
    Ok(None)
}
