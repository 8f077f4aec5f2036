//! `[materials.NAME.breakage]`: the law by which particles break.

use std::ops::Bound::{Excluded, Included};

use super::field::Field;
use super::listing::Listing;
use super::schema::table_schema;
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ENERGY_PER_MASS, LENGTH, MASS_PER_ENERGY};
use dem_physics::breakage::{BreakageLaw, SMALLEST_T10, USUAL_FAMILY_EXPONENT};

table_schema! {
    /// How particles of the material break by the energy that they take in, for
    /// `[replacement.NAME.breakage]`; `dem-run lab --type drop-weight` finds it from drop-weight
    /// tests.
    pub(super) static LAW = "Breakage law";

    /// A: the largest part of the fragments, by mass, that is smaller than a tenth of the particle.
    number("largest_t10").within(Excluded(SMALLEST_T10), Included(1.0)).required("0.5");
    /// b of t10 = A (1 - exp(-b (E - E_f))), for particles of the reference size.
    quantity("b", &MASS_PER_ENERGY).positive().required("\"0.9 t/kWh\"");
    /// Energy over mass, E_f, above which particles of the reference size break; with
    /// `energy_scatter` the median.
    quantity("fracture_energy", &ENERGY_PER_MASS).not_negative().or(0.0);
    /// Standard deviation of the natural logarithm of the fracture energies of equal particles.
    number("energy_scatter").not_negative().or(0.0);
    /// Size of the particles that `b` and `fracture_energy` are for.
    quantity("reference_size", &LENGTH).positive().required("\"30 mm\"");
    /// b grows with the size of the particle to this power.
    number("b_exponent").or(0.0);
    /// The fracture energy falls with the size of the particle to this power.
    number("energy_exponent").or(0.0);
    /// a of t_n = 1 - (1 - t10)^((9/(n - 1))^a), the part of the fragments smaller than the size of
    /// the particle over n.
    number("family_exponent").positive().or(USUAL_FAMILY_EXPONENT);
}

/// The law in the table in `field`.
pub(super) fn read(field: &Field<'_>) -> Result<BreakageLaw> {
    let table = Table::of(field, &LAW)?;
    Ok(BreakageLaw {
        largest_t10: table.read("largest_t10")?,
        b_kg_j: table.read("b")?,
        fracture_energy_j_kg: table.read("fracture_energy")?,
        energy_scatter: table.read("energy_scatter")?,
        reference_size_m: table.read("reference_size")?,
        b_exponent: table.read("b_exponent")?,
        energy_exponent: table.read("energy_exponent")?,
        family_exponent: table.read("family_exponent")?,
    })
}

pub(super) fn list(law: &BreakageLaw, listing: &mut Listing) {
    listing.value("largest_t10", &law.largest_t10);
    listing.value("b", &law.b_kg_j);
    listing.value("fracture_energy", &law.fracture_energy_j_kg);
    listing.value("energy_scatter", &law.energy_scatter);
    listing.value("reference_size", &law.reference_size_m);
    listing.value("b_exponent", &law.b_exponent);
    listing.value("energy_exponent", &law.energy_exponent);
    listing.value("family_exponent", &law.family_exponent);
}
