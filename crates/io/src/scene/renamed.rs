//! Keys that had another name before version 0.1: whoever uses one is told the new one.

use super::initial::INITIAL;
use super::load::LOAD;
use super::measure::MEASURE;
use super::replacement::{REPLACEMENT, RESTORE};
use super::root::SCENE;
use super::run::RUN;
use super::schema::Schema;
use super::study::keys::MEASURE as STUDY_MEASURE;
use super::support::SUPPORT;
use super::test::TEST;
use super::wall::WALL;
use super::wall::motion::SERVO;
use super::{bond, clusters, contact};

/// A key that has another name now.
pub(super) struct Renamed {
    /// The table that it is in.
    pub(super) schema: &'static Schema,
    pub(super) old: &'static str,
    pub(super) new: &'static str,
    /// How it is written, where not as `NEW = ...`.
    pub(super) form: &'static str,
}

const fn renamed(schema: &'static Schema, old: &'static str, new: &'static str) -> Renamed {
    let form = "";
    Renamed {
        schema,
        old,
        new,
        form,
    }
}

impl Renamed {
    /// "write tensile_strength = ..."
    pub(super) fn remedy(&self) -> String {
        match self.form {
            "" => format!("write {} = ...", self.new),
            form => format!("write {form}"),
        }
    }
}

/// All of them.
pub(super) static RENAMED: [Renamed; 36] = [
    Renamed {
        schema: &SCENE,
        old: "sets",
        new: "groups",
        form: "[groups.NAME]",
    },
    renamed(&RUN, "particle_damping", "local_damping"),
    renamed(&RUN, "rest", "rest_energy_ratio"),
    renamed(&RUN, "safety", "safety_factor"),
    renamed(&RUN, "start_overlap", "initial_overlap"),
    renamed(
        &contact::CONTACT,
        "tangential_ratio",
        "tangential_stiffness_ratio",
    ),
    renamed(
        &contact::CONTACT,
        "rolling_damping",
        "rolling_damping_ratio",
    ),
    renamed(&bond::BOND, "kappa", "stiffness_ratio"),
    renamed(&bond::DAMPING, "viscous", "damping_ratio"),
    renamed(&bond::DAMPING, "each_mode", "per_mode"),
    renamed(&bond::DAMPING, "force", "damping_coefficient"),
    renamed(&bond::DAMPING, "torque", "torque_factor"),
    renamed(&bond::FAILURE, "tension", "tensile_strength"),
    renamed(&bond::FAILURE, "compression", "compressive_strength"),
    renamed(&bond::FAILURE, "shear", "shear_strength"),
    renamed(&bond::FAILURE, "von_mises", "von_mises_strength"),
    renamed(&bond::FAILURE, "rate_of", "strain_rate_measure"),
    Renamed {
        schema: &WALL,
        old: "tilt",
        new: "rotation",
        form: "rotation = { axis = [0, 1, 0], angle = ... }",
    },
    renamed(&WALL, "turn", "angular_displacement"),
    renamed(&SERVO, "velocity", "max_velocity"),
    renamed(&INITIAL, "of", "group"),
    renamed(&SUPPORT, "of", "group"),
    renamed(&LOAD, "of", "group"),
    renamed(&REPLACEMENT, "need", "require"),
    renamed(&REPLACEMENT, "back", "restore"),
    renamed(&RESTORE, "inner_speed", "fluctuation_velocity"),
    renamed(&MEASURE, "at", "statistic"),
    renamed(&MEASURE, "tolerance_absolute", "absolute_tolerance"),
    renamed(&clusters::CLUSTERS, "min_broken", "min_broken_bonds"),
    renamed(&TEST, "kind", "type"),
    renamed(&TEST, "moves", "crosshead"),
    renamed(&TEST, "span", "support_span"),
    renamed(&TEST, "load_distance", "loading_span"),
    renamed(&STUDY_MEASURE, "figure", "test_result"),
    renamed(&STUDY_MEASURE, "masses", "fragment_masses"),
    renamed(&STUDY_MEASURE, "ledger", "balance"),
];

/// The new name of the key `old` of this table and how it is written, if it had another one.
pub(super) fn new_name(schema: &'static Schema, old: &str) -> Option<&'static Renamed> {
    let is = |renamed: &&Renamed| std::ptr::eq(renamed.schema, schema) && renamed.old == old;
    RENAMED.iter().find(is)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::table::Table;
    use crate::scene::tree::Document;

    #[test]
    fn every_old_key_is_refused_with_the_new_one() {
        for renamed in &RENAMED {
            let (schema, old, new) = (renamed.schema, renamed.old, renamed.new);
            assert!(schema.key(old).is_none(), "{old} is a key again");
            assert!(schema.key(new).is_some(), "there is no {new}");
            let text = format!("# Of {}\n{old} = 1\n", schema.title);
            let document = Document::parse("scene.toml", &text).unwrap();
            let table = Table::root(&document, schema).unwrap();
            let error = table.refuse_unknown().unwrap_err().to_string();
            let expected = format!("scene.toml:2: {old} is now called {new}; write ");
            assert!(error.starts_with(&expected), "{error}");
            assert!(error[expected.len()..].contains(new), "{error}");
        }
    }
}
