//! The list of quantities that measures can ask for.

use super::targets::Subject;
use dem_io::units::{
    ANGLE, ANGLE_DEG, ANGULAR_VELOCITY, DENSITY, Dimension, ENERGY, FORCE, LENGTH, MASS, NUMBER,
    POWER, RATE, TIME, TORQUE, VELOCITY, VOLUME,
};

/// A quantity that can be measured. For a group, positions and velocities are those of its centre
/// of mass; energies, forces and counts are sums.
#[derive(Debug)]
pub struct Quantity {
    /// Its name in a scene; of a vector, those of its components along x, y and z, and that of its
    /// magnitude if that can be measured.
    pub names: &'static [&'static str],
    /// Its dimension, which gives the unit of its values.
    pub dimension: &'static Dimension,
    /// The objects that have it.
    pub(super) of: &'static [Subject],
    /// Whether it belongs to two objects: `of` and `with`.
    pub(super) with: Option<With>,
    /// Whether it can be restricted to the region `within`.
    pub(super) within: bool,
    /// Whether it needs a `limit`.
    pub(super) limit: bool,
    /// Whether it is refused for what is not there at the start.
    pub(super) since_start: bool,
}

/// What a quantity says of two objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum With {
    /// How they touch.
    Contact,
    /// How they are mixed in the cells of a region.
    Mixture,
}

impl PartialEq for Quantity {
    fn eq(&self, other: &Self) -> bool {
        self.names == other.names
    }
}

const fn of(
    of: &'static [Subject],
    names: &'static [&'static str],
    dimension: &'static Dimension,
) -> Quantity {
    Quantity {
        names,
        dimension,
        of,
        with: None,
        within: false,
        limit: false,
        since_start: false,
    }
}

const fn of_group(names: &'static [&'static str], dimension: &'static Dimension) -> Quantity {
    of(&[Subject::Particles], names, dimension)
}

const fn of_fragments(names: &'static [&'static str], dimension: &'static Dimension) -> Quantity {
    of(&[Subject::Fragments], names, dimension)
}

const fn of_contact(names: &'static [&'static str], dimension: &'static Dimension) -> Quantity {
    Quantity {
        with: Some(With::Contact),
        ..of_group(names, dimension)
    }
}

const fn in_region(names: &'static [&'static str], dimension: &'static Dimension) -> Quantity {
    Quantity {
        within: true,
        ..of_group(names, dimension)
    }
}

/// Every quantity. How it is computed is in the crate `dem-plan`, in `measure/`.
pub static QUANTITIES: &[Quantity] = &[
    // For a wall, that of its pivot.
    of(
        &[Subject::Particles, Subject::Wall],
        &["position_x", "position_y", "position_z"],
        &LENGTH,
    ),
    // Of the centre of mass since the start.
    Quantity {
        since_start: true,
        ..of_group(
            &[
                "displacement_x",
                "displacement_y",
                "displacement_z",
                "displacement",
            ],
            &LENGTH,
        )
    },
    of_group(
        &["velocity_x", "velocity_y", "velocity_z", "velocity"],
        &VELOCITY,
    ),
    // Rotation vector since the start, mean by mass.
    of_group(&["rotation_x", "rotation_y", "rotation_z"], &ANGLE),
    // Of the rigid body with the same inertia and angular momentum.
    of_group(
        &[
            "angular_velocity_x",
            "angular_velocity_y",
            "angular_velocity_z",
        ],
        &ANGULAR_VELOCITY,
    ),
    // Force of supports on the group.
    of_group(&["reaction_x", "reaction_y", "reaction_z"], &FORCE),
    // Torque of supports on the group, each about its particle's centre.
    of_group(
        &[
            "reaction_torque_x",
            "reaction_torque_y",
            "reaction_torque_z",
        ],
        &TORQUE,
    ),
    of_group(&["kinetic_energy"], &ENERGY),
    // Of the bonds, half of each assigned to either end.
    of_group(&["elastic_energy"], &ENERGY),
    // Since the start.
    of_group(&["broken_bonds"], &NUMBER),
    // Stress over strength of the bond nearest to failure, without rate strengthening.
    of_group(&["largest_utilisation"], &NUMBER),
    // Of the bonds by their `strain_rate_measure`.
    of_group(&["largest_strain_rate"], &RATE),
    // Of the strengths of the bonds, 1 without strengthening.
    of_group(&["largest_dynamic_increase_factor"], &NUMBER),
    // Stress over strength at the bond's strain rate.
    of_group(&["largest_dynamic_utilisation"], &NUMBER),
    // Fraction of the intact bonds below `limit`.
    Quantity {
        limit: true,
        ..of_group(&["fraction_below_dynamic_utilisation"], &NUMBER)
    },
    // Slope of the heap that the particles form.
    of_group(&["angle_of_repose"], &ANGLE_DEG),
    // Of the group, or of its part in the region.
    in_region(&["mass"], &MASS),
    // Mass in the region over its volume; without a region, over the volume under the surface of
    // the group.
    in_region(&["bulk_density"], &DENSITY),
    // Solid density of the body (mass over volume of its shape) over its bulk density.
    in_region(&["bulking_factor"], &NUMBER),
    // Index of Lacey, in cells of `cell_size`.
    Quantity {
        with: Some(With::Mixture),
        ..in_region(&["mixing_index"], &NUMBER)
    },
    // Total contact force: of particles on a wall, of other particles and walls on a group.
    of(
        &[Subject::Particles, Subject::Wall],
        &["force_x", "force_y", "force_z", "force"],
        &FORCE,
    ),
    // Contact force of the object named by `with` on the group.
    of_contact(
        &[
            "contact_force_x",
            "contact_force_y",
            "contact_force_z",
            "contact_force",
        ],
        &FORCE,
    ),
    // The deepest; 0 if there is no contact.
    of_contact(&["contact_overlap"], &LENGTH),
    // Total time of contact since the start.
    of_contact(&["contact_duration"], &TIME),
    // Of particles on the wall about its pivot.
    of(
        &[Subject::Wall],
        &["torque_x", "torque_y", "torque_z"],
        &TORQUE,
    ),
    // Of the wall on particles since the start, and its mean over the time.
    of(&[Subject::Wall], &["work"], &ENERGY),
    of(&[Subject::Wall], &["power"], &POWER),
    // Sums over the patches of a wall with loads, since the start.
    of(&[Subject::Wall], &["wear_volume"], &VOLUME),
    of(&[Subject::Wall], &["impact_energy"], &ENERGY),
    of(&[Subject::Wall], &["friction_energy"], &ENERGY),
    of_fragments(&["count"], &NUMBER),
    // Mass of the heaviest fragment over that of all.
    of_fragments(&["mass_fraction_of_largest"], &NUMBER),
    of_fragments(&["mass_of_largest"], &MASS),
];

/// All names, each with its quantity and its place among the names of that.
pub(super) fn named() -> impl Iterator<Item = (&'static str, (&'static Quantity, usize))> {
    QUANTITIES.iter().flat_map(|quantity| {
        let names = quantity.names.iter().enumerate();
        names.map(move |(part, name)| (*name, (quantity, part)))
    })
}
