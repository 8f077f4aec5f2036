//! What bonds have been through: for each law with a history one column with an entry per bond.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::law::{BondLaw, BondRule};
use dem_physics::bond::damage::Damage;
use dem_physics::bond::flat_joint::{FlatJoint, elements};
use dem_physics::bond::incremental::History;
use dem_physics::bond::plasticity::PlasticDeformation;
use dem_physics::bond::stiffness::Stiffness;

/// A bond that is added, without load.
pub(crate) struct NewBond<'a> {
    pub(super) law: BondLaw,
    /// Unit vector from the first to the second end.
    pub(super) direction: Vector3<f64>,
    pub(super) radius_m: f64,
    pub(super) stiffness: &'a Stiffness,
}

/// The history of a bond by one law. The default is that of a bond of another law.
pub(crate) trait BondHistory: Clone + Default {
    /// Whether bonds of this law have it.
    fn is_of(law: &BondLaw) -> bool;

    /// The history of a bond without load, which may follow another law.
    fn new(_bond: &NewBond<'_>) -> Self {
        Self::default()
    }

    /// The history of a copy of the bond whose strengths have this factor.
    fn copied(&self, _strength_factor: f64) -> Self {
        self.clone()
    }

    /// Turns what is in the axes of space.
    fn turn(&mut self, _by: &UnitQuaternion<f64>) {}

    /// Forgets what a broken bond has no more.
    fn end(&mut self) {}

    /// Bytes outside of the column.
    fn more_bytes(&self) -> usize {
        0
    }
}

impl BondHistory for History {
    fn is_of(law: &BondLaw) -> bool {
        *law == BondLaw::Incremental
    }

    fn turn(&mut self, by: &UnitQuaternion<f64>) {
        self.shear_force = by * self.shear_force;
        self.moment = by * self.moment;
    }

    fn end(&mut self) {
        *self = Self::default();
    }
}

impl BondHistory for Damage {
    fn is_of(law: &BondLaw) -> bool {
        law.fracture_energy_j_m2().is_some()
    }

    fn new(bond: &NewBond<'_>) -> Self {
        Self::none(bond.stiffness, 1.0)
    }

    /// The copy is damaged once its strengths are known.
    fn copied(&self, strength_factor: f64) -> Self {
        Self {
            damage: 0.0,
            strength_factor,
            ..*self
        }
    }
}

impl BondHistory for PlasticDeformation {
    fn is_of(law: &BondLaw) -> bool {
        law.plasticity().is_some()
    }
}

impl BondHistory for FlatJoint {
    fn is_of(law: &BondLaw) -> bool {
        law.flat_joint().is_some()
    }

    fn new(bond: &NewBond<'_>) -> Self {
        let law = bond.law.flat_joint();
        let elements = law.map(|law| elements(&law, bond.radius_m, &bond.direction));
        Self {
            elements: elements.unwrap_or_default(),
            last_failure: None,
        }
    }

    fn more_bytes(&self) -> usize {
        size_of_val(&self.elements[..])
    }
}

/// The columns, and what is done with each of them.
macro_rules! columns {
    ($($(#[$doc:meta])* $column:ident: $history:ty,)+) => {
        /// Histories of bonds. A column has an entry for each bond, or none at all if no rule has
        /// its law.
        #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
        pub struct Histories {
            $($(#[$doc])* pub $column: Vec<$history>,)+
        }

        impl Histories {
            /// Adds the history of a new bond, with this number, of bonds with these rules.
            pub(super) fn push(&mut self, at: usize, rules: &[BondRule], bond: &NewBond<'_>) {
                $(push(&mut self.$column, at, rules, bond);)+
            }

            /// Adds a copy of the history of bond `from` of other bonds for the bond with this
            /// number, whose strengths have this factor.
            pub(super) fn push_copy(&mut self, at: usize, other: &Self, from: usize, factor: f64) {
                $(push_copy(&mut self.$column, at, other.$column.get(from), factor);)+
            }

            /// Turns what bonds from `first` on remember in the axes of space.
            pub(super) fn turn(&mut self, first: usize, by: &UnitQuaternion<f64>) {
                $(self.$column.iter_mut().skip(first).for_each(|history| history.turn(by));)+
            }

            /// Forgets what bond `at`, which breaks, has no more.
            pub(super) fn end(&mut self, at: usize) {
                $(self.$column.iter_mut().skip(at).take(1).for_each(BondHistory::end);)+
            }

            /// Bytes of all columns.
            pub(crate) fn bytes(&self) -> usize {
                [$(column_bytes(&self.$column)),+].iter().sum()
            }
        }
    };
}

columns! {
    /// Loads that are summed step by step.
    sums: History,
    /// Damage beyond the strength.
    damages: Damage,
    /// Plastic deformation.
    plastics: PlasticDeformation,
    /// Elements of flat joints, none for bonds of other laws.
    joints: FlatJoint,
}

fn push<H: BondHistory>(column: &mut Vec<H>, at: usize, rules: &[BondRule], bond: &NewBond<'_>) {
    if !column.is_empty() || rules.iter().any(|rule| H::is_of(&rule.law)) {
        column.resize(at, H::default());
        column.push(H::new(bond));
    }
}

fn push_copy<H: BondHistory>(column: &mut Vec<H>, at: usize, from: Option<&H>, factor: f64) {
    if !column.is_empty() || from.is_some() {
        column.resize(at, H::default());
        column.push(from.map_or_else(H::default, |history| history.copied(factor)));
    }
}

pub(crate) fn column_bytes<H: BondHistory>(column: &[H]) -> usize {
    let more = column.iter().map(BondHistory::more_bytes);
    size_of_val(column) + more.sum::<usize>()
}
