//! `[measures.NAME]`

use super::field::Field;
use super::read::Targets;
use super::{At, Measure, Quantity};
use crate::Result;
use crate::units::{
    ANGLE, ANGULAR_VELOCITY, Dimension, ENERGY, FORCE, LENGTH, NUMBER, TORQUE, VELOCITY,
};

/// Every quantity and its name in a scene.
pub(super) const QUANTITIES: [(&str, Quantity); 25] = [
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
            Self::Rotation(_) => &ANGLE,
            Self::AngularVelocity(_) => &ANGULAR_VELOCITY,
            Self::Reaction(_) => &FORCE,
            Self::ReactionTorque(_) => &TORQUE,
            Self::KineticEnergy | Self::ElasticEnergy => &ENERGY,
            Self::BrokenBonds | Self::LargestUtilisation => &NUMBER,
        }
    }
}

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Measure> {
    let table = field.table(&["of", "quantity", "at", "reference", "tolerance"])?;
    let of = table.read("of", |field| targets.name(&field))?;
    let quantity = table
        .need("quantity", "\"displacement_x\"")?
        .choice(&QUANTITIES)?;
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
        of: of.unwrap_or_else(|| "all".to_owned()),
        quantity,
        at: table
            .read("at", |field| field.choice(&TIMES))?
            .unwrap_or(At::End),
        reference,
        tolerance,
    })
}
