//! Keys of scenes and studies that had another name before version 0.1: the message for an old name
//! gives the new one.

#[cfg(test)]
mod tests;

/// Title of the table in the schema, old key, new key.
const RENAMED: [(&str, &str, &str); 35] = [
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
    ("[test]", "kind", "type"),
    ("[test]", "moves", "crosshead"),
    ("[test]", "span", "support_span"),
    ("[test]", "load_distance", "loading_span"),
    ("[measures.NAME]", "figure", "test_result"),
    ("[measures.NAME]", "masses", "fragment_masses"),
    ("[measures.NAME]", "ledger", "balance"),
];

/// Title of the table in the schema, key that is gone, why it can be left out.
const REMOVED: [(&str, &str, &str); 3] = [
    ("[clusters]", "interval", AT_ONCE),
    ("[clusters]", "min_broken_bonds", AT_ONCE),
    ("[clusters]", "force_every", AT_ONCE),
];

const AT_ONCE: &str =
    "leave it out: a body is searched for fragments in each step in which a bond of it breaks";

/// Why the key `old` of the table `title` can be left out, if there was such a key.
pub(super) fn why_removed(title: &str, old: &str) -> Option<&'static str> {
    let row = REMOVED.iter().find(|row| row.0 == title && row.1 == old)?;
    Some(row.2)
}

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
