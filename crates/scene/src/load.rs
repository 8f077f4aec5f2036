//! `[loads.NAME]`

use super::factor::{self, Factor, RAMP, TABLE, end, factor};
use super::field::Field;
use super::listing::Listing;
use super::schema::table_schema;
use super::table::Table;
use super::targets::{GROUP_KEY, Targets};
use dem_io::diagnostic::Result;
use dem_io::units::{FORCE, TORQUE};

/// A load on a group of particles, distributed equally among them.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// `group`: a group, a body or `all`.
    pub group: String,
    /// `force` on the entire group, N. Length 3. Not zero together with the torque.
    pub force_n: [f64; 3],
    /// `torque` on the entire group, N m. Length 3.
    pub torque_n_m: [f64; 3],
    /// `ramp` or `table`.
    pub factor: Factor,
    /// `end`: time from which the load is zero, s. Not before the factor's last change. None:
    /// never.
    pub end_s: Option<f64>,
}

table_schema! {
    /// A force or a torque on a group, shared equally among its particles.
    pub(super) static LOAD = "[loads.NAME]";

    GROUP_KEY;
    /// Total force on the group.
    vector("force", &FORCE);
    /// Total torque on the group.
    vector("torque", &TORQUE);
    RAMP;
    TABLE;
    /// Time from which the load is zero; not before the last change of `ramp` or `table`.
    until();
}

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Load> {
    let table = Table::of(field, &LOAD)?;
    let group = targets.name(&table.need("group")?)?;
    let factor = factor(&table)?;
    let load = Load {
        group,
        force_n: table.read("force")?,
        torque_n_m: table.read("torque")?,
        end_s: end(&table, &factor)?,
        factor,
    };
    if load.force_n == [0.0; 3] && load.torque_n_m == [0.0; 3] {
        let remedy =
            "add force = [0, 0, \"100 N\"] or torque = [0, 0, \"1 N m\"], or remove the table";
        return Err(table.fault("is a load of zero", remedy));
    }
    Ok(load)
}

pub(super) fn list(load: &Load, listing: &mut Listing) {
    listing.text("group", &load.group);
    listing.value("force", &load.force_n);
    listing.value("torque", &load.torque_n_m);
    factor::list(&load.factor, listing);
    listing.value("end", &load.end_s);
}
