//! Refusal of what does not go together with `run.steps_by_body`.

use super::field::Field;
use super::run::{Integrator, Run};
use super::table::Table;
use dem_io::diagnostic::Result;

/// Tables that hold, drive or freeze bodies.
const TABLES: [&str; 4] = ["loads", "sleep", "supports", "test"];

/// Refuses what does not go together with steps by body: everything that holds or drives
/// bodies, sleep, daughters, rigid parts, servos, damping of all particles, and steps that rise.
pub(super) fn refuse_others(root: &Table<'_>, run: &Run) -> Result<()> {
    let mut found: Vec<Field<'_>> = root.given(&TABLES).map(|(_, field)| field).collect();
    if let Some(table) = root.get("run") {
        let table = Table::any(&table)?;
        let chosen = [
            ("adaptive", run.adaptive),
            ("integrator", run.integrator == Integrator::Static),
            ("local_damping", run.local_damping > 0.0),
        ];
        let chosen = chosen.iter().filter(|(_, is_chosen)| *is_chosen);
        found.extend(chosen.filter_map(|(key, _)| table.get(key)));
    }
    for (_, wall) in root.named("walls")? {
        let wall = Table::any(&wall)?;
        found.extend(wall.get("servo"));
    }
    for (_, body) in root.named("bodies")? {
        let body = Table::any(&body)?;
        found.extend(body.get("bonded_within"));
    }
    for (_, replacement) in root.named("replacement")? {
        found.extend(Table::any(&replacement)?.get("daughters"));
    }
    for (_, contact) in root.named("contacts")? {
        found.extend(Table::any(&contact)?.get("liquid_bridge"));
    }
    let Some(field) = found.first() else {
        return Ok(());
    };
    let path = &field.path;
    let what = match TABLES.contains(&path.as_str()) {
        true => format!("[{path}]"),
        false => path.clone(),
    };
    let problem = format!("{what} does not go together with run.steps_by_body");
    Err(field.refuse(problem, "remove it, or run.steps_by_body"))
}
