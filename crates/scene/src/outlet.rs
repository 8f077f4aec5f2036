//! `[outlets.NAME]`

use std::collections::BTreeMap;

use super::field::Field;
use super::inlet::Inlet;
use super::listing::Listing;
use super::region::Region;
use super::schema::table_schema;
use super::table::Table;
use dem_io::diagnostic::Result;

const SIDES: [&str; 2] = ["inside", "outside"];

table_schema! {
    /// Removes bodies and fragments whose centre is inside or outside a region, and counts their
    /// mass.
    pub(super) static OUTLET = "[outlets.NAME]";

    /// Remove bodies and fragments inside this region, which must not be the region of an inlet.
    text("inside", "a name in [regions]");
    /// Remove bodies and fragments outside this region.
    text("outside", "a name in [regions]");
}

/// Removes bodies and fragments by the position of their centre, and counts them.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlet {
    /// `inside` or `outside`: a name of `[regions]`.
    pub region: String,
    /// `outside`: removes objects outside the region.
    pub removes_outside: bool,
}

pub(super) fn read(
    field: &Field<'_>,
    regions: &BTreeMap<String, Region>,
    inlets: &BTreeMap<String, Inlet>,
) -> Result<Outlet> {
    let table = Table::of(field, &OUTLET)?;
    let one = "an outlet has one region: remove one, or make two outlets";
    let Some((key, field)) = table.at_most_one(&SIDES, one)? else {
        let remedy = "add inside = \"NAME\" or outside = \"NAME\", a name in [regions]";
        return Err(table.fault("has no region", remedy));
    };
    let region = field.reference(regions.keys(), "regions")?;
    let removes_outside = key == "outside";
    let into = inlets.iter().find(|(_, inlet)| inlet.region == region);
    if let (Some((inlet, _)), false) = (into, removes_outside) {
        let problem = format!("is \"{region}\", into which [inlets.{inlet}] puts bodies");
        let remedy = "they would be removed immediately: name another region";
        return Err(field.fault(problem, remedy));
    }
    Ok(Outlet {
        region,
        removes_outside,
    })
}

pub(super) fn list(outlet: &Outlet, listing: &mut Listing) {
    let side = SIDES[usize::from(outlet.removes_outside)];
    listing.text(side, &outlet.region);
}
