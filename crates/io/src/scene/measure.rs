//! `[measures.NAME]`

use super::field::Field;
use super::names::ALL;
use super::table::Table;
use super::targets::{Subject, Targets};
use super::{At, Measure, Quantity};
use crate::Result;
use crate::units::{
    ANGLE, ANGULAR_VELOCITY, Dimension, ENERGY, FORCE, LENGTH, MASS, NUMBER, TORQUE, VELOCITY,
};

/// Every quantity and its name in a scene.
pub(super) const QUANTITIES: [(&str, Quantity); 35] = [
    ("position_x", Quantity::Position(0)),
    ("position_y", Quantity::Position(1)),
    ("position_z", Quantity::Position(2)),
    ("displacement_x", Quantity::Displacement(0)),
    ("displacement_y", Quantity::Displacement(1)),
    ("displacement_z", Quantity::Displacement(2)),
    ("velocity_x", Quantity::Velocity(0)),
    ("velocity_y", Quantity::Velocity(1)),
    ("velocity_z", Quantity::Velocity(2)),
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
    ("angle_of_repose", Quantity::AngleOfRepose),
    ("force_x", Quantity::Force(0)),
    ("force_y", Quantity::Force(1)),
    ("force_z", Quantity::Force(2)),
    ("torque_x", Quantity::Torque(0)),
    ("torque_y", Quantity::Torque(1)),
    ("torque_z", Quantity::Torque(2)),
    ("count", Quantity::Count),
    ("mass_fraction_of_largest", Quantity::MassFractionOfLargest),
    ("mass_of_largest", Quantity::MassOfLargest),
];

/// Every choice of a value from a history.
pub(super) const TIMES: [(&str, At); 4] = [
    ("end", At::End),
    ("largest", At::Largest),
    ("smallest", At::Smallest),
    ("mean", At::Mean),
];

impl Quantity {
    /// Its name in a scene, such as "displacement_x".
    pub fn name(self) -> &'static str {
        let found = QUANTITIES.iter().find(|(_, quantity)| *quantity == self);
        found.map_or("", |(name, _)| *name)
    }

    /// Its dimension, which knows its SI unit.
    pub fn dimension(self) -> &'static Dimension {
        match self {
            Self::Position(_) | Self::Displacement(_) => &LENGTH,
            Self::Velocity(_) => &VELOCITY,
            Self::Rotation(_) | Self::AngleOfRepose => &ANGLE,
            Self::AngularVelocity(_) => &ANGULAR_VELOCITY,
            Self::Reaction(_) | Self::Force(_) => &FORCE,
            Self::ReactionTorque(_) | Self::Torque(_) => &TORQUE,
            Self::KineticEnergy | Self::ElasticEnergy => &ENERGY,
            Self::MassOfLargest => &MASS,
            Self::BrokenBonds
            | Self::LargestUtilisation
            | Self::Count
            | Self::MassFractionOfLargest => &NUMBER,
        }
    }

    /// Whether it is a quantity of such things.
    fn is_of(self, subject: Subject) -> bool {
        match self {
            Self::Position(_) => subject != Subject::Fragments,
            Self::Force(_) | Self::Torque(_) => subject == Subject::Wall,
            Self::Count | Self::MassFractionOfLargest | Self::MassOfLargest => {
                subject == Subject::Fragments
            }
            _ => subject == Subject::Particles,
        }
    }
}

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Measure> {
    let table = field.table(&["of", "quantity", "at", "reference", "tolerance"])?;
    let (of, subject) = table
        .read("of", |field| targets.measured(&field))?
        .unwrap_or_else(|| (ALL.to_owned(), Subject::Particles));
    let quantity = quantity(&table, &of, subject)?;
    let reference = table.read("reference", |field| field.quantity(quantity.dimension()))?;
    let tolerance = table.read("tolerance", |field| field.positive(&NUMBER))?;
    if let Some(field) = table.get("tolerance") {
        let problem = match reference {
            None => "stands without reference, to which it is relative",
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
    Ok(Measure {
        of,
        quantity,
        at: table
            .read("at", |field| field.choice(&TIMES))?
            .unwrap_or(At::End),
        reference,
        tolerance,
    })
}

/// The quantity that is asked, if `of`, which is a `subject`, has it.
fn quantity(table: &Table<'_>, of: &str, subject: Subject) -> Result<Quantity> {
    let mut known = QUANTITIES.to_vec();
    known.retain(|(_, quantity)| quantity.is_of(subject));
    let example = match subject {
        Subject::Particles => "\"displacement_x\"",
        Subject::Wall => "\"force_x\"",
        Subject::Fragments => "\"count\"",
    };
    let field = table.need("quantity", example)?;
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
            "write of = \"NAME\", with the name of a set or a body",
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
