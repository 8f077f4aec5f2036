//! `[measures.NAME]`

use std::collections::BTreeMap;

use super::field::Field;
use super::listing::Listing;
use super::names::ALL;
use super::numbers::quantity as shown;
use super::region::Region;
use super::schema::{Key, Kind, Schema, Word, words_of};
use super::table::Table;
use super::targets::{Subject, Targets};
use dem_io::diagnostic::Result;
use dem_io::units::{
    ANGLE, ANGLE_DEG, ANGULAR_VELOCITY, DENSITY, Dimension, ENERGY, FORCE, LENGTH, MASS, NUMBER,
    RATE, TIME, TORQUE, VELOCITY,
};
use serde::{Deserialize, Serialize};

/// The quantity that is measured. For a group, positions and velocities are those of its centre of
/// mass; energies, forces and counts are sums. Walls have positions, forces and torques; fragments
/// a count and masses; groups all except torques, count and masses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// "position_x", ... m; for a wall, that of its pivot. Axis 0, 1, 2.
    Position(u8),
    /// "displacement_x", ... of the centre of mass since the start, m.
    Displacement(u8),
    /// "displacement": its magnitude, m.
    DisplacementMagnitude,
    /// "velocity_x", ... of the centre of mass, m/s.
    Velocity(u8),
    /// "velocity": its magnitude, m/s.
    VelocityMagnitude,
    /// "rotation_x", ... since the start (rotation vector, mean by mass), rad.
    Rotation(u8),
    /// "angular_velocity_x", ... of the rigid body with the same inertia and angular momentum,
    /// rad/s.
    AngularVelocity(u8),
    /// "reaction_x", ... force of supports on the group, N.
    Reaction(u8),
    /// "reaction_torque_x", ... torque of supports on the group, each about its particle's centre,
    /// N m.
    ReactionTorque(u8),
    /// "kinetic_energy", J.
    KineticEnergy,
    /// "elastic_energy" of the bonds, half of each assigned to either end, J.
    ElasticEnergy,
    /// "broken_bonds" since the start.
    BrokenBonds,
    /// "largest_utilisation": stress over strength of the bond nearest to failure, without rate
    /// strengthening.
    LargestUtilisation,
    /// "largest_strain_rate" of the bonds by their `strain_rate_measure`, 1/s.
    LargestStrainRate,
    /// "largest_dynamic_increase_factor" of the strengths of the bonds, 1 without strengthening.
    LargestDynamicIncreaseFactor,
    /// "largest_dynamic_utilisation": stress over strength at the bond's strain rate.
    LargestDynamicUtilisation,
    /// "fraction_below_dynamic_utilisation": fraction of the intact bonds below `limit`.
    FractionBelowDynamicUtilisation,
    /// "angle_of_repose": slope of the heap that the particles form, degrees.
    AngleOfRepose,
    /// "mass" of the group, or of its part in the region `within`, kg.
    Mass,
    /// "bulk_density": mass of its part in the region `within` over the volume of the region;
    /// without a region mass over the volume under the surface of the group, kg/m3.
    BulkDensity,
    /// "bulking_factor": volume that the body takes as a bulk over that of its shape: its solid
    /// density (mass over volume of the shape) over its bulk density.
    BulkingFactor,
    /// "mixing_index" of Lacey, of the group and that of `with`, in cells of `cell_size` in the
    /// region `within`.
    MixingIndex,
    /// "force_x", ... total contact force: of particles on a wall, of other particles and walls on
    /// a group, N.
    Force(u8),
    /// "force": its magnitude, N.
    ForceMagnitude,
    /// "contact_force_x", ... contact force of the object named by `with` on the group, N.
    ContactForce(u8),
    /// "contact_force": its magnitude, N.
    ContactForceMagnitude,
    /// "contact_overlap": deepest overlap of these contacts; 0 if there is none, m.
    ContactOverlap,
    /// "contact_duration": total time of contact between the two since the start, s.
    ContactDuration,
    /// "torque_x", ... torque of particles on the wall about its pivot, N m.
    Torque(u8),
    /// "count" of fragments.
    Count,
    /// "mass_fraction_of_largest": mass of the heaviest fragment over that of all.
    MassFractionOfLargest,
    /// "mass_of_largest": mass of the heaviest fragment, kg.
    MassOfLargest,
}

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
    pub quantity: Quantity,
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

/// Every quantity and its name in a scene.
pub(super) const QUANTITIES: [(&str, Quantity); 52] = [
    ("position_x", Quantity::Position(0)),
    ("position_y", Quantity::Position(1)),
    ("position_z", Quantity::Position(2)),
    ("displacement_x", Quantity::Displacement(0)),
    ("displacement_y", Quantity::Displacement(1)),
    ("displacement_z", Quantity::Displacement(2)),
    ("displacement", Quantity::DisplacementMagnitude),
    ("velocity_x", Quantity::Velocity(0)),
    ("velocity_y", Quantity::Velocity(1)),
    ("velocity_z", Quantity::Velocity(2)),
    ("velocity", Quantity::VelocityMagnitude),
    ("rotation_x", Quantity::Rotation(0)),
    ("rotation_y", Quantity::Rotation(1)),
    ("rotation_z", Quantity::Rotation(2)),
    ("angular_velocity_x", Quantity::AngularVelocity(0)),
    ("angular_velocity_y", Quantity::AngularVelocity(1)),
    ("angular_velocity_z", Quantity::AngularVelocity(2)),
    ("reaction_x", Quantity::Reaction(0)),
    ("reaction_y", Quantity::Reaction(1)),
    ("reaction_z", Quantity::Reaction(2)),
    ("reaction_torque_x", Quantity::ReactionTorque(0)),
    ("reaction_torque_y", Quantity::ReactionTorque(1)),
    ("reaction_torque_z", Quantity::ReactionTorque(2)),
    ("kinetic_energy", Quantity::KineticEnergy),
    ("elastic_energy", Quantity::ElasticEnergy),
    ("broken_bonds", Quantity::BrokenBonds),
    ("largest_utilisation", Quantity::LargestUtilisation),
    ("largest_strain_rate", Quantity::LargestStrainRate),
    (
        "largest_dynamic_increase_factor",
        Quantity::LargestDynamicIncreaseFactor,
    ),
    (
        "largest_dynamic_utilisation",
        Quantity::LargestDynamicUtilisation,
    ),
    (
        "fraction_below_dynamic_utilisation",
        Quantity::FractionBelowDynamicUtilisation,
    ),
    ("angle_of_repose", Quantity::AngleOfRepose),
    ("mass", Quantity::Mass),
    ("bulk_density", Quantity::BulkDensity),
    ("bulking_factor", Quantity::BulkingFactor),
    ("mixing_index", Quantity::MixingIndex),
    ("force_x", Quantity::Force(0)),
    ("force_y", Quantity::Force(1)),
    ("force_z", Quantity::Force(2)),
    ("force", Quantity::ForceMagnitude),
    ("contact_force_x", Quantity::ContactForce(0)),
    ("contact_force_y", Quantity::ContactForce(1)),
    ("contact_force_z", Quantity::ContactForce(2)),
    ("contact_force", Quantity::ContactForceMagnitude),
    ("contact_overlap", Quantity::ContactOverlap),
    ("contact_duration", Quantity::ContactDuration),
    ("torque_x", Quantity::Torque(0)),
    ("torque_y", Quantity::Torque(1)),
    ("torque_z", Quantity::Torque(2)),
    ("count", Quantity::Count),
    ("mass_fraction_of_largest", Quantity::MassFractionOfLargest),
    ("mass_of_largest", Quantity::MassOfLargest),
];

impl Word for Statistic {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("end", Self::End),
        ("largest", Self::Largest),
        ("smallest", Self::Smallest),
        ("mean", Self::Mean),
    ];
}

impl Quantity {
    /// Its name in a scene, such as "displacement_x".
    pub fn name(self) -> &'static str {
        let found = QUANTITIES.iter().find(|(_, quantity)| *quantity == self);
        found.map_or("", |(name, _)| *name)
    }

    /// Its dimension, which gives the unit of its values.
    pub fn dimension(self) -> &'static Dimension {
        match self {
            Self::Position(_)
            | Self::Displacement(_)
            | Self::DisplacementMagnitude
            | Self::ContactOverlap => &LENGTH,
            Self::Velocity(_) | Self::VelocityMagnitude => &VELOCITY,
            Self::Rotation(_) => &ANGLE,
            Self::AngleOfRepose => &ANGLE_DEG,
            Self::AngularVelocity(_) => &ANGULAR_VELOCITY,
            Self::Reaction(_)
            | Self::Force(_)
            | Self::ForceMagnitude
            | Self::ContactForce(_)
            | Self::ContactForceMagnitude => &FORCE,
            Self::ReactionTorque(_) | Self::Torque(_) => &TORQUE,
            Self::ContactDuration => &TIME,
            Self::KineticEnergy | Self::ElasticEnergy => &ENERGY,
            Self::MassOfLargest | Self::Mass => &MASS,
            Self::BulkDensity => &DENSITY,
            Self::LargestStrainRate => &RATE,
            Self::BrokenBonds
            | Self::LargestUtilisation
            | Self::LargestDynamicIncreaseFactor
            | Self::LargestDynamicUtilisation
            | Self::FractionBelowDynamicUtilisation
            | Self::Count
            | Self::BulkingFactor
            | Self::MixingIndex
            | Self::MassFractionOfLargest => &NUMBER,
        }
    }

    /// True if it belongs to the contacts between two objects: `of` and `with`.
    pub fn is_of_contact(self) -> bool {
        matches!(
            self,
            Self::ContactForce(_)
                | Self::ContactForceMagnitude
                | Self::ContactOverlap
                | Self::ContactDuration
        )
    }

    /// True if such objects have it.
    fn is_of(self, subject: Subject) -> bool {
        match self {
            Self::Position(_) | Self::Force(_) | Self::ForceMagnitude => {
                subject != Subject::Fragments
            }
            Self::Torque(_) => subject == Subject::Wall,
            Self::Count | Self::MassFractionOfLargest | Self::MassOfLargest => {
                subject == Subject::Fragments
            }
            _ => subject == Subject::Particles,
        }
    }
}

pub(super) static MEASURE: Schema = Schema {
    title: "[measures.NAME]",
    doc: "A measured quantity, with its reference value if one is known.",
    keys: &[
        Key::text("of", "a group, a body, a wall, `all` or `fragments`", "Object that is measured.")
            .or_word(ALL),
        Key::new(
            "quantity",
            Kind::Word(|| words_of(&QUANTITIES)),
            "For a wall: `force`, `torque` about its pivot, `position` of its pivot; for `fragments`: `count`, \
             `mass_of_largest`, `mass_fraction_of_largest`; for groups: all others, and `position` and `force`.",
        )
        .required("\"displacement_x\""),
        Key::text(
            "with",
            "a group, a body or a wall",
            "Other side of the contact, or other part of the mixture; required for contact quantities and `mixing_index`.",
        ),
        Key::text(
            "within",
            "a name in [regions]",
            "Region to which `mass`, `bulk_density`, `bulking_factor` or `mixing_index` is restricted; spheres that its border cuts count in part. Required for `mixing_index`.",
        ),
        Key::quantity(
            "cell_size",
            &LENGTH,
            "Edge of the cells in which `mixing_index` compares mass fractions; required there.",
        )
        .positive(),
        Key::number(
            "limit",
            "Dynamic utilisation below which intact bonds count; required for `fraction_below_dynamic_utilisation`.",
        )
        .positive(),
        Key::word::<Statistic>(
            "statistic",
            "end",
            "Statistic of the history that is reported; `mean` is over time.",
        ),
        Key::new("reference", Kind::Measured, "Reference value; the error of the result is reported."),
        Key::number(
            "tolerance",
            "Relative error above which the run warns. Requires a `reference` other than 0.",
        )
        .positive(),
        Key::new(
            "absolute_tolerance",
            Kind::Measured,
            "Difference from `reference` above which the run warns. Requires a `reference`.",
        )
        .positive(),
        Key::new(
            "end_run_above",
            Kind::Measured,
            "The run ends, before its end time, at the first row of the time series with a larger value.",
        ),
    ],
};

pub(super) fn read(
    field: &Field<'_>,
    targets: &Targets<'_>,
    regions: &BTreeMap<String, Region>,
) -> Result<Measure> {
    let table = Table::of(field, &MEASURE)?;
    let (of, subject) = table
        .read_by("of", |field| targets.measured(&field))?
        .unwrap_or_else(|| (ALL.to_owned(), Subject::Particles));
    let quantity = quantity(&table, &of, subject)?;
    if let (Quantity::Displacement(_) | Quantity::DisplacementMagnitude, Some(field)) =
        (quantity, table.get("quantity"))
    {
        targets.presence.refuse_without_start(&field, &of)?;
    }
    let with = counterpart(&table, &of, quantity, targets)?;
    let within = within(&table, quantity, regions)?;
    let cell_size_m = only_for(
        &table,
        "cell_size",
        [quantity, Quantity::MixingIndex],
        ["there is no cell_size", "\"10 mm\""],
    )?;
    let limit = only_for(
        &table,
        "limit",
        [quantity, Quantity::FractionBelowDynamicUtilisation],
        ["nothing says below which utilisation", "0.5"],
    )?;
    let dimension = quantity.dimension();
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
            let problem = format!("{} {problem}", field.path);
            return Err(field.refuse(
                problem,
                "give a reference other than 0, or remove tolerance",
            ));
        }
    }
    if let (Some(field), None) = (table.get("absolute_tolerance"), reference) {
        let problem = format!("{} has no effect without reference", field.path);
        return Err(field.refuse(problem, "give a reference, or remove absolute_tolerance"));
    }
    Ok(Measure {
        of,
        quantity,
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
    quantity: Quantity,
    targets: &Targets<'_>,
) -> Result<Option<String>> {
    let name = quantity.name();
    let mixes = quantity == Quantity::MixingIndex;
    if !quantity.is_of_contact() && !mixes {
        return match table.get("with") {
            Some(field) => {
                let problem = format!(
                    "{} cannot be combined with the quantity \"{name}\", which is not of a contact",
                    field.path
                );
                Err(field.refuse(problem, "remove it, or ask for \"contact_force\""))
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
        let problem = format!("{} is \"{with}\", which is no other group", field.path);
        return Err(field.refuse(problem, "name a body or a group that \"of\" mixes with"));
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
    Err(field.refuse(
        problem,
        "name another body, group or wall; quantity = \"force\" is of contacts with all else",
    ))
}

/// The region to which a measure is restricted.
fn within(
    table: &Table<'_>,
    quantity: Quantity,
    regions: &BTreeMap<String, Region>,
) -> Result<Option<String>> {
    let bulk = [
        Quantity::Mass,
        Quantity::BulkDensity,
        Quantity::BulkingFactor,
        Quantity::MixingIndex,
    ];
    let name = quantity.name();
    match table.get("within") {
        None if quantity == Quantity::MixingIndex => {
            let problem = format!(
                "{}.quantity is \"{name}\", but nothing says where",
                table.path
            );
            Err(table.refuse(problem, "add within = \"NAME\", a name in [regions]"))
        }
        Some(field) if !bulk.contains(&quantity) => {
            let problem = format!(
                "{} cannot be combined with the quantity \"{name}\"",
                field.path
            );
            let remedy = "remove it, or ask for \"mass\", \"bulk_density\" or \"mixing_index\"";
            Err(field.refuse(problem, remedy))
        }
        Some(field) => Ok(Some(field.reference(regions.keys(), "regions")?)),
        None => Ok(None),
    }
}

/// A number that one quantity requires, and that is refused otherwise. `missing`: what is not known
/// without it; `example`: a value of it.
fn only_for(
    table: &Table<'_>,
    key: &str,
    [quantity, one]: [Quantity; 2],
    [missing, example]: [&str; 2],
) -> Result<Option<f64>> {
    match (quantity == one, table.get(key)) {
        (true, None) => {
            let problem = format!(
                "{}.quantity is \"{}\", but {missing}",
                table.path,
                one.name()
            );
            Err(table.refuse(problem, format!("add {key} = {example}")))
        }
        (false, Some(field)) => {
            let problem = format!(
                "{} cannot be combined with the quantity \"{}\"",
                field.path,
                quantity.name()
            );
            let remedy = format!("remove it, or ask for \"{}\"", one.name());
            Err(field.refuse(problem, remedy))
        }
        _ => table.read(key),
    }
}

/// The requested quantity, if `of`, which is a `subject`, has it.
fn quantity(table: &Table<'_>, of: &str, subject: Subject) -> Result<Quantity> {
    let mut known = QUANTITIES.to_vec();
    known.retain(|(_, quantity)| quantity.is_of(subject));
    let example = match subject {
        Subject::Particles => "\"displacement_x\"",
        Subject::Wall => "\"force_x\"",
        Subject::Fragments => "\"count\"",
    };
    let field = table.need_such("quantity", example)?;
    let name = field.text()?;
    let Some((_, elsewhere)) = QUANTITIES
        .iter()
        .find(|(other, quantity)| *other == name && !quantity.is_of(subject))
    else {
        return field.choice(&known);
    };
    let (owner, remedy) = if elsewhere.is_of(Subject::Particles) {
        (
            "particles",
            "write of = \"NAME\", with the name of a group or a body",
        )
    } else if elsewhere.is_of(Subject::Wall) {
        ("walls", "write of = \"NAME\", with the name of a wall")
    } else {
        ("fragments", "write of = \"fragments\"")
    };
    let is = match subject {
        Subject::Particles => "names particles",
        Subject::Wall => "is a wall",
        Subject::Fragments => "are none",
    };
    let problem = format!(
        "{} is \"{name}\", a quantity of {owner}, but \"{of}\" {is}",
        field.path
    );
    let remedy = if subject == Subject::Particles {
        remedy.to_owned()
    } else {
        let has: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        format!("{remedy}, or ask for {}", has.join(", "))
    };
    Err(field.refuse(problem, remedy))
}

pub(super) fn list(measure: &Measure, listing: &mut Listing) {
    let in_unit = |value: Option<f64>| {
        let unit = measure.quantity.dimension().si;
        value.map_or_else(|| "none".to_owned(), |value| shown(value, unit))
    };
    listing.text("of", &measure.of);
    listing.text("quantity", measure.quantity.name());
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
