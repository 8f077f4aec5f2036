//! What has no meaning where a run goes to the equilibrium at once.

use super::field::Field;
use super::table::Table;
use dem_io::diagnostic::Result;

/// Tables of what touches, moves by itself, comes or goes, and of how it starts.
const TABLES: [&str; 8] = [
    "initial",
    "contacts",
    "walls",
    "replacement",
    "inlets",
    "outlets",
    "sleep",
    "test",
];

/// Refuses what is more than bonded bodies, loads and supports in a scene that goes to its
/// equilibrium at once.
pub(super) fn refuse_what_moves(root: &Table<'_>) -> Result<()> {
    if let Some((_, field)) = root.given(&TABLES).next() {
        let problem = format!(
            "[{}] is not available with run.integrator = \"static\", which handles bonded bodies, loads and supports only",
            field.path
        );
        let remedy = "remove it, or write run.integrator = \"leapfrog\"";
        return Err(field.refuse(problem, remedy));
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

/// The first `[table.NAME]` with this word for this key: the word.
fn written<'a>(root: &Table<'a>, table: &str, key: &str, word: &str) -> Result<Option<Field<'a>>> {
    for (_, one) in root.named(table)? {
        let field = Table::any(&one)?.get(key);
        if let Some(field) = field.filter(|field| field.is(word)) {
            return Ok(Some(field));
        }
    }
    Ok(None)
}
