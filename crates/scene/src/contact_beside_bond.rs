//! Refusal of what does not go together with `contact_beside_bond`.

use super::conflicts::{BESIDE_CONTACT_BESIDE_BOND, CONTACT_BESIDE_BOND};
use super::table::Table;
use dem_io::diagnostic::Result;

/// Refuses what does not go together with contacts beside bonds, and overlaps that are not kept as
/// they were when the bonds were made.
pub(super) fn refuse_others(root: &Table<'_>) -> Result<()> {
    let mut beside = None;
    for (_, bond) in root.named("bonds")? {
        let bond = Table::any(&bond)?;
        if let Some(field) = bond.get("contact_beside_bond")
            && field.boolean()?
        {
            beside = Some((bond, field));
        }
    }
    let Some((bond, beside)) = beside else {
        return Ok(());
    };
    CONTACT_BESIDE_BOND.refuse(&bond, root)?;
    BESIDE_CONTACT_BESIDE_BOND.refuse(root, &bond)?;
    let relaxation = super::relaxation::read(root)?;
    if !relaxation.enabled || relaxation.min_overlap > 0.0 {
        let problem =
            "needs the overlaps of bonded ends as origins of their contacts, whatever they are";
        let remedy = "write relaxation = { min_overlap = 0 }, without enabled = false";
        return Err(beside.fault(problem, remedy));
    }
    Ok(())
}
