//! What bonds have been through: for each history one column with an entry per bond, and the
//! columns of numbers as which files of bodies and frames hold it.

use dem_io::body::BondColumn;
use dem_io::body::histories::{
    ELEMENT_SLIP, FAILED_ELEMENTS, FIRST_EDGE, PLASTIC_BEND, PLASTIC_ELONGATION, PLASTIC_SLIP,
    PLASTIC_TURNS, PLASTIC_TWIST, PLASTIC_WORK, SUMMED_MOMENT, SUMMED_SHEAR,
};
use dem_io::{Diagnostic, Result};
use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::law::{BondLaw, BondRule};
use super::stored::{FileColumn, StoredBond, column, frame_between, number, vector};
use dem_physics::bond::damage::Damage;
use dem_physics::bond::flat_joint::{FlatJoint, elements, elements_from, first_edge};
use dem_physics::bond::incremental::History;
use dem_physics::bond::plasticity::PlasticDeformation;
use dem_physics::bond::rate_strengthening::LargestRate;
use dem_physics::bond::stiffness::Stiffness;
use dem_physics::rigid::rotation_vector;
use dem_physics::rotation::numbers;

/// A bond that is added, without load.
pub(crate) struct NewBond<'a> {
    pub(super) law: BondLaw,
    /// Unit vector from the first to the second end.
    pub(super) direction: Vector3<f64>,
    pub(super) radius_m: f64,
    pub(super) stiffness: &'a Stiffness,
}

/// The history of a bond by its rule. The default is that of a bond whose rule has no such history.
pub(crate) trait BondHistory: Clone + Default {
    /// Its columns in files, in their order; numbers that a file lacks are 0.
    const COLUMNS: &'static [FileColumn] = &[];

    /// Whether bonds of this rule have it.
    fn is_of(rule: &BondRule) -> bool;

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

    /// Number of elements of the bond, 1 for other laws.
    fn elements(&self) -> usize {
        1
    }

    /// Adds the numbers of a bond to the end of each column for files. 0 follows if one gets fewer
    /// than it has for each bond.
    fn store(&self, _bond: &StoredBond, _to: &mut [Vec<f64>]) {}

    /// Gives a bond of this law what a file says of it; of each column its numbers, none if it is
    /// missing.
    fn restore(&mut self, _from: &[&[f64]], _bond: &mut StoredBond) -> Result<()> {
        Ok(())
    }

    /// Whether such numbers are those of a bond that has been through nothing.
    fn is_none(from: &[&[f64]]) -> bool {
        from.iter().copied().flatten().all(|number| *number == 0.0)
    }

    /// The refusal of such numbers for a bond of another law: problem and remedy.
    fn foreign(_from: &[&[f64]]) -> [String; 2] {
        Default::default()
    }

    /// Takes over the direction that the bond, without load, has now got.
    fn set_direction(&mut self, _bond: &StoredBond) {}
}

impl BondHistory for History {
    const COLUMNS: &'static [FileColumn] = &[column(SUMMED_SHEAR, 3), column(SUMMED_MOMENT, 3)];

    fn is_of(rule: &BondRule) -> bool {
        rule.law == BondLaw::Incremental
    }

    fn store(&self, bond: &StoredBond, to: &mut [Vec<f64>]) {
        for (own, to) in [self.shear_force, self.moment].iter().zip(to) {
            to.extend(&(bond.sign() * own));
        }
    }

    fn restore(&mut self, from: &[&[f64]], bond: &mut StoredBond) -> Result<()> {
        let own = |stored: &[f64]| bond.sign() * (bond.rotation * vector(stored));
        *self = Self {
            shear_force: own(from[0]),
            moment: own(from[1]),
        };
        Ok(())
    }

    fn foreign(_from: &[&[f64]]) -> [String; 2] {
        [
            "its load was summed step by step, and its kind of bonds computes loads from positions",
            "give it formulation = \"incremental\", or remove the arrays 'summed_...' from the file",
        ]
        .map(str::to_owned)
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
    fn is_of(rule: &BondRule) -> bool {
        rule.law.fracture_energy_j_m2().is_some()
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
    const COLUMNS: &'static [FileColumn] = &[
        column(PLASTIC_TURNS[0], 3),
        column(PLASTIC_TURNS[1], 3),
        column(PLASTIC_ELONGATION, 1),
        column(PLASTIC_SLIP, 3),
        column(PLASTIC_TWIST, 1),
        column(PLASTIC_BEND, 3),
        column(PLASTIC_WORK, 1),
    ];

    fn is_of(rule: &BondRule) -> bool {
        rule.law.plasticity().is_some()
    }

    fn store(&self, bond: &StoredBond, to: &mut [Vec<f64>]) {
        let [turn_a, turn_b] = bond.ends_in_order(self.turned.map(rotation_vector));
        to[0].extend(turn_a);
        to[1].extend(turn_b);
        to[2].push(self.elongation_m);
        to[3].extend(bond.stored(self.slip_m));
        to[4].push(self.twist_rad);
        to[5].extend(bond.stored(self.bend_rad));
        to[6].push(self.work_j);
    }

    fn restore(&mut self, from: &[&[f64]], bond: &mut StoredBond) -> Result<()> {
        let turns = bond.ends_in_order([from[0], from[1]]);
        let turns = turns.map(|turn| UnitQuaternion::from_scaled_axis(vector(turn)));
        self.turned = turns.map(|turn| numbers(&turn));
        let to_frame = frame_between(&self.ends(&bond.ends)).inverse() * bond.rotation;
        let own = |stored: &[f64]| (bond.sign() * (to_frame * vector(stored))).into();
        *self = Self {
            elongation_m: number(from[2]),
            slip_m: own(from[3]),
            twist_rad: number(from[4]),
            bend_rad: own(from[5]),
            work_j: number(from[6]),
            turned: self.turned,
        };
        let [a, b] = bond.levers_m;
        let longer = 1.0 + self.elongation_m / (a + b);
        bond.levers_m = [a, b].map(|lever| longer * lever);
        Ok(())
    }

    fn foreign(_from: &[&[f64]]) -> [String; 2] {
        [
            "it has yielded, and its kind of bonds has no plasticity",
            "add a table plasticity to it, or remove the arrays 'plastic_...' from the file",
        ]
        .map(str::to_owned)
    }
}

impl BondHistory for LargestRate {
    const COLUMNS: &'static [FileColumn] = &[FileColumn {
        is_optional: true,
        ..column("history_largest_strain_rate_1_s", 1)
    }];

    fn is_of(rule: &BondRule) -> bool {
        rule.keeps_largest_factor()
    }

    fn end(&mut self) {
        *self = Self::default();
    }

    fn store(&self, _bond: &StoredBond, to: &mut [Vec<f64>]) {
        to[0].push(self.0);
    }

    fn restore(&mut self, from: &[&[f64]], _bond: &mut StoredBond) -> Result<()> {
        self.0 = number(from[0]);
        Ok(())
    }

    fn foreign(_from: &[&[f64]]) -> [String; 2] {
        [
            "it keeps the largest factor of its strain rates, and its kind of bonds does not",
            "give it keeps_largest_factor = true, or remove the array 'history_largest_strain_rate_1_s' from the file",
        ]
        .map(str::to_owned)
    }
}

impl BondHistory for FlatJoint {
    const COLUMNS: &'static [FileColumn] = &[
        column(FIRST_EDGE, 3),
        FileColumn {
            is_of_elements: true,
            ..column(FAILED_ELEMENTS, 1)
        },
        FileColumn {
            is_of_elements: true,
            is_optional: true,
            ..column(ELEMENT_SLIP, 3)
        },
    ];

    fn is_of(rule: &BondRule) -> bool {
        rule.law.flat_joint().is_some()
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

    fn elements(&self) -> usize {
        self.elements.len()
    }

    fn store(&self, bond: &StoredBond, to: &mut [Vec<f64>]) {
        let Some(law) = bond.rule.law.flat_joint() else {
            return;
        };
        let own = &self.elements;
        let edge = bond.frame * first_edge(&law, own, &bond.direction);
        to[0].extend(&edge);
        let failed = own.iter().map(|e| bond.is_broken || !e.is_bonded);
        let failed = bond.elements_in_order(failed.collect(), &law);
        to[1].extend(
            failed
                .into_iter()
                .map(|failed: bool| f64::from(u8::from(failed))),
        );
        if own.iter().any(|element| element.slip_m != [0.0; 3]) {
            let slips = own.iter().map(|element| bond.stored(element.slip_m));
            to[2].extend(bond.elements_in_order(slips.collect(), &law).as_flattened());
        }
    }

    fn restore(&mut self, from: &[&[f64]], bond: &mut StoredBond) -> Result<()> {
        let &[edge, failed, slips] = from else {
            return Ok(());
        };
        let law = bond.rule.law.flat_joint();
        let count = law.map_or(0, |law| law.count());
        // Bonds with more elements in the same file lengthen the list of each.
        let (failed, surplus) = failed.split_at(count.min(failed.len()));
        let fits = failed.len() == count && surplus.iter().all(|failed| *failed == 0.0);
        let Some(law) = law.filter(|_| fits) else {
            let [problem, remedy] = other_elements(from[1].len(), count);
            return Err(Diagnostic::input("", problem, remedy));
        };
        let to_frame = bond.frame.inverse() * bond.rotation;
        let edge = to_frame * vector(edge);
        let across = edge - bond.direction * bond.direction.dot(&edge);
        let Some(edge) = across.try_normalize(1e-3) else {
            return Err(Diagnostic::input(
                "",
                "the edge of its first element lies along the bond",
                "remove the array 'failed_elements' from the file",
            ));
        };
        let mut elements = elements_from(&law, bond.radius_m, &bond.direction, &edge);
        let failed = bond.elements_in_order(failed.to_vec(), &law);
        for (element, failed) in elements.iter_mut().zip(failed) {
            element.is_bonded = failed == 0.0;
        }
        let (slips, _) = slips.as_chunks::<3>();
        let slips = slips[..count.min(slips.len())].to_vec();
        let slips = bond.elements_in_order(slips, &law);
        for (element, slip) in elements.iter_mut().zip(slips) {
            element.slip_m = (bond.sign() * (to_frame * Vector3::from(slip))).into();
        }
        self.elements = elements;
        Ok(())
    }

    fn is_none(from: &[&[f64]]) -> bool {
        from[1].iter().all(|failed| *failed == 0.0)
    }

    fn foreign(from: &[&[f64]]) -> [String; 2] {
        other_elements(from[1].len(), 0)
    }

    fn set_direction(&mut self, bond: &StoredBond) {
        if let Some(law) = bond.rule.law.flat_joint() {
            // Those of the line of centres lie across another direction.
            self.elements = elements(&law, bond.radius_m, &bond.direction);
        }
    }
}

/// The refusal of a joint of so many elements in a file for a bond that has `count`.
fn other_elements(in_file: usize, count: usize) -> [String; 2] {
    [
        format!(
            "elements of its flat joint of {in_file} have failed, and its kind of bonds has {count}"
        ),
        "give it the radial_elements and circumferential_elements with which the file was written, or remove the array 'failed_elements' from the file".to_owned(),
    ]
}

/// The columns, and what is done with each of them.
macro_rules! columns {
    ($($(#[$doc:meta])* $column:ident: $history:ty,)+) => {
        /// Histories of bonds. A column has an entry for each bond, or none at all if no rule has
        /// such a history.
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

            /// Whether any history has a column of this name in files.
            pub(crate) fn is_known(name: &str) -> bool {
                let columns = [$(<$history as BondHistory>::COLUMNS),+];
                columns.into_iter().flatten().any(|column| column.name == name)
            }

            /// The columns for files of these bonds.
            pub(crate) fn stored(
                &self,
                bonds: &[u32],
                bond: &dyn Fn(usize) -> StoredBond,
            ) -> Vec<BondColumn> {
                let mut columns = Vec::new();
                $(columns.extend(stored(&self.$column, bonds, bond));)+
                columns
            }

            /// Gives bond `at` what a file says of its bond `number`.
            pub(crate) fn restore(
                &mut self,
                at: usize,
                file: &[BondColumn],
                number: usize,
                bond: &mut StoredBond,
            ) -> Result<()> {
                $(restore(self.$column.get_mut(at), file, number, bond)?;)+
                Ok(())
            }

            /// Takes over the direction that bond `at`, without load, has now got.
            pub(crate) fn set_direction(&mut self, at: usize, bond: &StoredBond) {
                $(self.$column.iter_mut().skip(at).take(1).for_each(|h| h.set_direction(bond));)+
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
    /// Largest strain rates.
    largest_rates: LargestRate,
}

fn push<H: BondHistory>(column: &mut Vec<H>, at: usize, rules: &[BondRule], bond: &NewBond<'_>) {
    if !column.is_empty() || rules.iter().any(H::is_of) {
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

/// The columns for files of these bonds, of one history; `bond` gives the n-th of them.
fn stored<H: BondHistory>(
    column: &[H],
    bonds: &[u32],
    bond: &dyn Fn(usize) -> StoredBond,
) -> Vec<BondColumn> {
    let of_each = || bonds.iter().filter_map(|at| column.get(*at as usize));
    let elements = of_each().map(H::elements).max().unwrap_or(0);
    if elements == 0 || H::COLUMNS.is_empty() {
        return Vec::new();
    }
    let components = |column: &FileColumn| match column.is_of_elements {
        true => column.numbers * elements,
        false => column.numbers,
    };
    let mut values = vec![Vec::new(); H::COLUMNS.len()];
    for (n, history) in of_each().enumerate() {
        history.store(&bond(n), &mut values);
        for (column, values) in H::COLUMNS.iter().zip(&mut values) {
            values.resize((n + 1) * components(column), 0.0);
        }
    }
    let says_something = |(column, values): &(&FileColumn, Vec<f64>)| {
        !column.is_optional || values.iter().any(|number| *number != 0.0)
    };
    (H::COLUMNS.iter().zip(values).filter(says_something))
        .map(|(column, values)| BondColumn::new(column.name, components(column), values))
        .collect()
}

fn restore<H: BondHistory>(
    history: Option<&mut H>,
    file: &[BondColumn],
    number: usize,
    bond: &mut StoredBond,
) -> Result<()> {
    let find = |name| file.iter().find(|column| column.name == name);
    let columns = H::COLUMNS.iter().map(|column| find(column.name));
    let from: Vec<&[f64]> = columns
        .map(|column| column.map_or(&[][..], |column| column.of(number)))
        .collect();
    if from.is_empty() || H::is_none(&from) {
        return Ok(());
    }
    match history.filter(|_| H::is_of(&bond.rule)) {
        Some(history) => history.restore(&from, bond),
        None => {
            let [problem, remedy] = H::foreign(&from);
            Err(Diagnostic::input("", problem, remedy))
        }
    }
}

pub(crate) fn column_bytes<H: BondHistory>(column: &[H]) -> usize {
    let more = column.iter().map(BondHistory::more_bytes);
    size_of_val(column) + more.sum::<usize>()
}
