//! `[measures.NAME]`

use std::collections::BTreeMap;

use super::field::Field;
use super::listing::Listing;
use super::names::ALL;
use super::numbers::quantity as shown;
use super::quantity::{Quantity, With, named};
use super::region::Region;
use super::schema::{Kind, Word, table_schema};
use super::table::Table;
use super::targets::{Subject, Targets};
use dem_io::diagnostic::Result;
use dem_io::units::LENGTH;

/// The statistic of a measure's history that is its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Statistic {
    /// "end"
    End,
    /// "largest"
    Largest,
    /// "smallest"
    Smallest,
    /// "mean" over time
    Mean,
}

/// A named quantity, with its expected value if that is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// `of`: a group, a body, a wall, `fragments` or `all` (the default), whose quantity is
    /// measured.
    pub of: String,
    /// `quantity`
    pub quantity: &'static Quantity,
    /// Of a vector, the component along x, y or z: 0, 1 or 2; 3 for its magnitude. Otherwise 0.
    pub part: usize,
    /// `with`: the body, group or wall that `of` touches, or the body or group that it mixes with.
    /// Required for contacts and mixing, and only allowed there.
    pub with: Option<String>,
    /// `within`: the region to which it is restricted. Only for masses, densities and mixing;
    /// required for mixing.
    pub within: Option<String>,
    /// `cell_size`, m: edge of the cells of a mixing index. Required there, and only allowed there.
    pub cell_size_m: Option<f64>,
    /// `limit`: dynamic utilisation below which bonds count. Required for
    /// `fraction_below_dynamic_utilisation`, and only allowed there.
    pub limit: Option<f64>,
    /// `statistic`, "end" unless given.
    pub statistic: Statistic,
    /// `reference`: expected result, in the quantity's unit. Not zero if there is a `tolerance`.
    pub reference: Option<f64>,
    /// `tolerance`: largest relative error for the run to pass. Only with `reference`.
    pub tolerance: Option<f64>,
    /// `absolute_tolerance`: largest difference from `reference`, which it needs, in the quantity's
    /// unit.
    pub absolute_tolerance: Option<f64>,
    /// `end_run_above`: value, in the quantity's unit, above which the run ends at the next row of
    /// the time series.
    pub end_run_above: Option<f64>,
}

impl Word for Statistic {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("end", Self::End),
        ("largest", Self::Largest),
        ("smallest", Self::Smallest),
        ("mean", Self::Mean),
    ];
}

impl Measure {
    /// The name of its quantity in the scene, such as "displacement_x".
    pub fn quantity_name(&self) -> &'static str {
        self.quantity.names.get(self.part).copied().unwrap_or("")
    }
}

table_schema! {
    /// A measured quantity, with its reference value if one is known.
    pub(super) static MEASURE = "[measures.NAME]";

    /// Object that is measured.
    text("of", "a group, a body, a wall, `all` or `fragments`").or_word(ALL);
    /// For a wall: `force`, `torque` about its pivot, `position` of its pivot, `work` on particles
    /// since the start, `power`, its mean over the time since then, and with `loads`
    /// `wear_volume`, `impact_energy`, `friction_energy`, since the start; for `fragments`:
    /// `count`, `mass_of_largest`, `mass_fraction_of_largest`; for groups: all others, and
    /// `position` and `force`.
    new("quantity", Kind::Word(|| named().map(|(name, _)| name).collect()))
        .required("\"displacement_x\"");
    /// Other side of the contact, or other part of the mixture; required for contact quantities and
    /// `mixing_index`.
    text("with", "a group, a body or a wall");
    /// Region to which `mass`, `bulk_density`, `bulking_factor` or `mixing_index` is restricted;
    /// spheres that its border cuts count in part. Required for `mixing_index`.
    text("within", "a name in [regions]");
    /// Edge of the cells in which `mixing_index` compares mass fractions; required there.
    quantity("cell_size", &LENGTH).positive();
    /// Dynamic utilisation below which intact bonds count; required for
    /// `fraction_below_dynamic_utilisation`.
    number("limit").positive();
    /// Statistic of the history that is reported; `mean` is over time.
    word::<Statistic>("statistic", "end");
    /// Reference value; the error of the result is reported.
    new("reference", Kind::Measured);
    /// Relative error above which the run warns. Requires a `reference` other than 0.
    number("tolerance").positive();
    /// Difference from `reference` above which the run warns. Requires a `reference`.
    new("absolute_tolerance", Kind::Measured).positive();
    /// The run ends, before its end time, at the first row of the time series with a larger value.
    new("end_run_above", Kind::Measured);
}

pub(super) fn read(
    field: &Field<'_>,
    targets: &Targets<'_>,
    regions: &BTreeMap<String, Region>,
) -> Result<Measure> {
    let table = Table::of(field, &MEASURE)?;
    let (of, subject) = table
        .read_by("of", |field| targets.measured(&field))?
        .unwrap_or_else(|| (ALL.to_owned(), Subject::Particles));
    let (name, (quantity, part)) = quantity(&table, &of, subject)?;
    if let (true, Some(field)) = (quantity.since_start, table.get("quantity")) {
        targets.presence.refuse_without_start(&field, &of)?;
    }
    let with = counterpart(&table, &of, (name, quantity), targets)?;
    let within = within(&table, (name, quantity), regions)?;
    let cell_size_m = only_for(
        &table,
        "cell_size",
        (name, quantity.with == Some(With::Mixture)),
        "mixing_index",
        ["there is no cell_size", "\"10 mm\""],
    )?;
    let limit = only_for(
        &table,
        "limit",
        (name, quantity.limit),
        "fraction_below_dynamic_utilisation",
        ["nothing says below which utilisation", "0.5"],
    )?;
    let dimension = quantity.dimension;
    let reference = table.read_by("reference", |field| field.quantity(dimension))?;
    let tolerance = table.read("tolerance")?;
    let absolute_tolerance =
        table.read_by("absolute_tolerance", |field| field.positive(dimension))?;
    if let Some(field) = table.get("tolerance") {
        let problem = match reference {
            None => "needs a reference, to which it is relative",
            Some(0.0) => "is relative to reference, which is 0",
            Some(_) => "",
        };
        if !problem.is_empty() {
            let remedy = "give a reference other than 0, or remove tolerance";
            return Err(field.fault(problem, remedy));
        }
    }
    if let (Some(field), None) = (table.get("absolute_tolerance"), reference) {
        let problem = "has no effect without reference";
        return Err(field.fault(problem, "give a reference, or remove absolute_tolerance"));
    }
    Ok(Measure {
        of,
        quantity,
        part,
        with,
        within,
        cell_size_m,
        limit,
        statistic: table.read("statistic")?,
        reference,
        tolerance,
        absolute_tolerance,
        end_run_above: table.read_by("end_run_above", |field| field.quantity(dimension))?,
    })
}

/// The object that `of` touches: required if a contact is measured, refused otherwise.
fn counterpart(
    table: &Table<'_>,
    of: &str,
    (name, quantity): (&str, &Quantity),
    targets: &Targets<'_>,
) -> Result<Option<String>> {
    let mixes = quantity.with == Some(With::Mixture);
    if quantity.with.is_none() {
        return match table.get("with") {
            Some(field) => {
                let problem = format!(
                    "cannot be combined with the quantity \"{name}\", which is not of a contact"
                );
                Err(field.fault(problem, "remove it, or ask for \"contact_force\""))
            }
            None => Ok(None),
        };
    }
    let Some(field) = table.get("with") else {
        let (kind, others) = match mixes {
            true => ("a mixture", "a body or a group"),
            false => ("a contact", "a body, a group or a wall"),
        };
        let problem = format!(
            "{}.quantity is \"{name}\", of {kind}, but nothing says with what",
            table.path
        );
        return Err(table.refuse(problem, format!("add with = \"NAME\", of {others}")));
    };
    let (with, subject) = targets.measured(&field)?;
    if mixes && (subject != Subject::Particles || with == ALL || with == of) {
        let problem = format!("is \"{with}\", which is no other group");
        return Err(field.fault(problem, "name a body or a group that \"of\" mixes with"));
    }
    let problem = if with == of {
        format!("{} is \"{with}\", as of is", field.path)
    } else if with == ALL || subject == Subject::Fragments {
        format!(
            "{} is \"{with}\", which is no one of two that touch",
            field.path
        )
    } else {
        return Ok(Some(with));
    };
    let remedy =
        "name another body, group or wall; quantity = \"force\" is of contacts with all else";
    Err(field.refuse(problem, remedy))
}

/// The region to which a measure is restricted.
fn within(
    table: &Table<'_>,
    (name, quantity): (&str, &Quantity),
    regions: &BTreeMap<String, Region>,
) -> Result<Option<String>> {
    match table.get("within") {
        None if quantity.with == Some(With::Mixture) => {
            let problem = format!(
                "{}.quantity is \"{name}\", but nothing says where",
                table.path
            );
            Err(table.refuse(problem, "add within = \"NAME\", a name in [regions]"))
        }
        Some(field) if !quantity.within => {
            let remedy = "remove it, or ask for \"mass\", \"bulk_density\" or \"mixing_index\"";
            let problem = format!("cannot be combined with the quantity \"{name}\"");
            Err(field.fault(problem, remedy))
        }
        Some(field) => Ok(Some(field.reference(regions.keys(), "regions")?)),
        None => Ok(None),
    }
}

/// A number that some quantities require, such as `example_quantity`, and that is refused for
/// others. `name`: the quantity; `missing`: what is not known without it; `example`: a value of it.
fn only_for(
    table: &Table<'_>,
    key: &str,
    (name, is_needed): (&str, bool),
    example_quantity: &str,
    [missing, example]: [&str; 2],
) -> Result<Option<f64>> {
    match (is_needed, table.get(key)) {
        (true, None) => {
            let problem = format!("{}.quantity is \"{name}\", but {missing}", table.path);
            Err(table.refuse(problem, format!("add {key} = {example}")))
        }
        (false, Some(field)) => {
            let remedy = format!("remove it, or ask for \"{example_quantity}\"");
            let problem = format!("cannot be combined with the quantity \"{name}\"");
            Err(field.fault(problem, remedy))
        }
        _ => table.read(key),
    }
}

/// The requested quantity, if `of`, which is a `subject`, has it.
fn quantity(
    table: &Table<'_>,
    of: &str,
    subject: Subject,
) -> Result<(&'static str, (&'static Quantity, usize))> {
    let (known, others): (Vec<_>, Vec<_>) =
        named().partition(|(_, (quantity, _))| quantity.of.contains(&subject));
    let example = match subject {
        Subject::Particles => "\"displacement_x\"",
        Subject::Wall => "\"force_x\"",
        Subject::Fragments => "\"count\"",
    };
    let field = table.need_such("quantity", example)?;
    let name = field.text()?;
    let Some((_, (elsewhere, _))) = others.iter().find(|(other, _)| *other == name) else {
        let known: Vec<_> = known.into_iter().map(|found| (found.0, found)).collect();
        return field.choice(&known);
    };
    let (owner, remedy) = match elsewhere.of {
        [Subject::Particles, ..] => (
            "particles",
            "write of = \"NAME\", with the name of a group or a body",
        ),
        [Subject::Wall, ..] => ("walls", "write of = \"NAME\", with the name of a wall"),
        _ => ("fragments", "write of = \"fragments\""),
    };
    let is = match subject {
        Subject::Particles => "names particles",
        Subject::Wall => "is a wall",
        Subject::Fragments => "are none",
    };
    let remedy = if subject == Subject::Particles {
        remedy.to_owned()
    } else {
        let has: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        format!("{remedy}, or ask for {}", has.join(", "))
    };
    let problem = format!("is \"{name}\", a quantity of {owner}, but \"{of}\" {is}");
    Err(field.fault(problem, remedy))
}

pub(super) fn list(measure: &Measure, listing: &mut Listing) {
    let in_unit = |value: Option<f64>| {
        let unit = measure.quantity.dimension.si;
        value.map_or_else(|| "none".to_owned(), |value| shown(value, unit))
    };
    listing.text("of", &measure.of);
    listing.text("quantity", measure.quantity_name());
    if let Some(with) = &measure.with {
        listing.text("with", with);
    }
    if let Some(within) = &measure.within {
        listing.text("within", within);
    }
    if let Some(cell_size) = &measure.cell_size_m {
        listing.value("cell_size", cell_size);
    }
    if let Some(limit) = &measure.limit {
        listing.value("limit", limit);
    }
    listing.value("statistic", &measure.statistic);
    listing.text("reference", in_unit(measure.reference));
    listing.value("tolerance", &measure.tolerance);
    listing.text("absolute_tolerance", in_unit(measure.absolute_tolerance));
    if measure.end_run_above.is_some() {
        listing.text("end_run_above", in_unit(measure.end_run_above));
    }
}
