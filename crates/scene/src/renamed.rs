//! Keys of scenes and studies that had another name before version 0.1: the message for an old name
//! gives the new one.

/// Title of the table in the schema, old key, new key.
const RENAMED: [(&str, &str, &str); 36] = [
    ("", "sets", "groups"),
    ("[run]", "particle_damping", "local_damping"),
    ("[run]", "rest", "rest_energy_ratio"),
    ("[run]", "safety", "safety_factor"),
    ("[run]", "start_overlap", "initial_overlap"),
    (
        "[contacts.NAME-NAME]",
        "tangential_ratio",
        "tangential_stiffness_ratio",
    ),
    (
        "[contacts.NAME-NAME]",
        "rolling_damping",
        "rolling_damping_ratio",
    ),
    ("[bonds.NAME]", "kappa", "stiffness_ratio"),
    ("Damping", "viscous", "damping_ratio"),
    ("Damping", "each_mode", "per_mode"),
    ("Damping", "force", "damping_coefficient"),
    ("Damping", "torque", "torque_factor"),
    ("Failure", "tension", "tensile_strength"),
    ("Failure", "compression", "compressive_strength"),
    ("Failure", "shear", "shear_strength"),
    ("Failure", "von_mises", "von_mises_strength"),
    ("Failure", "rate_of", "strain_rate_measure"),
    ("[walls.NAME]", "tilt", "rotation"),
    ("[walls.NAME]", "turn", "angular_displacement"),
    ("Servo", "velocity", "max_velocity"),
    ("[initial.NAME]", "of", "group"),
    ("[supports.NAME]", "of", "group"),
    ("[loads.NAME]", "of", "group"),
    ("[replacement.NAME]", "need", "require"),
    ("[replacement.NAME]", "back", "restore"),
    ("Restore", "inner_speed", "fluctuation_velocity"),
    ("[measures.NAME]", "at", "statistic"),
    (
        "[measures.NAME]",
        "tolerance_absolute",
        "absolute_tolerance",
    ),
    ("[clusters]", "min_broken", "min_broken_bonds"),
    ("[test]", "kind", "type"),
    ("[test]", "moves", "crosshead"),
    ("[test]", "span", "support_span"),
    ("[test]", "load_distance", "loading_span"),
    ("[measures.NAME]", "figure", "test_result"),
    ("[measures.NAME]", "masses", "fragment_masses"),
    ("[measures.NAME]", "ledger", "balance"),
];

/// The new name of the key `old` of the table `title` and its form, if it was renamed.
pub(super) fn new_name(title: &str, old: &str) -> Option<(&'static str, String)> {
    let is = |row: &&(&str, &str, &str)| row.0 == title && row.1 == old;
    let (_, _, new) = RENAMED.iter().find(is)?;
    let form = match old {
        "sets" => "[groups.NAME]".to_owned(),
        "tilt" => "rotation = { axis = [0, 1, 0], angle = ... }".to_owned(),
        _ => format!("{new} = ..."),
    };
    Some((new, format!("write {form}")))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]

    use super::*;
    use crate::schema::Schema;
    use crate::study::keys::MEASURE as STUDY_MEASURE;
    use crate::table::Table;
    use crate::tree::Document;
    use crate::wall::motion::SERVO;
    use crate::{
        bond, clusters, contact, initial, load, measure, replacement, root, run, support, test,
        wall,
    };

    static SCHEMAS: [&Schema; 17] = [
        &root::SCENE,
        &run::RUN,
        &contact::CONTACT,
        &bond::BOND,
        &bond::DAMPING,
        &bond::FAILURE,
        &wall::WALL,
        &SERVO,
        &initial::INITIAL,
        &support::SUPPORT,
        &load::LOAD,
        &replacement::REPLACEMENT,
        &replacement::RESTORE,
        &clusters::CLUSTERS,
        &test::TEST,
        &measure::MEASURE,
        &STUDY_MEASURE,
    ];

    #[test]
    fn every_old_key_is_refused_with_the_new_one() {
        for (title, old, new) in RENAMED {
            let has_new = |schema: &&Schema| schema.title == title && schema.key(new).is_some();
            let schema = SCHEMAS.into_iter().find(has_new);
            let schema = schema.unwrap_or_else(|| panic!("{title} has no {new}"));
            assert!(schema.key(old).is_none(), "{old} is a key again");
            let text = format!("# Of {title}\n{old} = 1\n");
            let document = Document::parse("scene.toml", &text).unwrap();
            let table = Table::root(&document, schema).unwrap();
            let error = table.refuse_unknown().unwrap_err().to_string();
            let expected = format!("scene.toml:2: {old} is now called {new}; write ");
            assert!(error.starts_with(&expected), "{error}");
            assert!(error[expected.len()..].contains(new), "{error}");
        }
    }
}
