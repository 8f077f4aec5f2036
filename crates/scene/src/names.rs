//! Names: their allowed form, and suggestions for misspelt ones.

/// `did you mean 'end_time'?`, or the known names if none is similar.
pub(super) fn suggestion<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    if let Some(ours) = of_other_programs(name, &known) {
        return format!("did you mean '{ours}'?");
    }
    let nearest = known
        .iter()
        .map(|candidate| (edit_distance(name, candidate), *candidate))
        .min_by_key(|(distance, _)| *distance);
    match nearest {
        None => "there are none".to_owned(),
        Some((distance, candidate)) if near(distance, name, candidate) => {
            format!("did you mean '{candidate}'?")
        }
        Some(_) => {
            let more = if known.len() > MOST_NAMES {
                ", ..."
            } else {
                ""
            };
            let listed = &known[..known.len().min(MOST_NAMES)];
            format!("known: {}{more}", listed.join(", "))
        }
    }
}

/// Our name for what other programs and textbooks call `name`, if it is among the `known` ones.
fn of_other_programs<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let lower = name.to_lowercase();
    // E is a modulus, e a coefficient of restitution.
    let is_name = |other: &&str| *other == name || (other.len() > 1 && *other == lower);
    let of_line = |(_, others): &&(&str, &[&str])| others.iter().any(&is_name);
    let mut meant = OTHER_NAMES.iter().filter(of_line);
    meant.find_map(|(ours, _)| known.iter().find(|known| *known == ours).copied())
}

/// Our names, and those of other programs (LAMMPS, YADE, PFC, EDEM, MUSEN) and of textbooks.
const OTHER_NAMES: [(&str, &[&str]); 28] = [
    (
        "time_step",
        &["dt", "timestep", "time_step_size", "step", "step_size"],
    ),
    (
        "end_time",
        &[
            "duration",
            "t_end",
            "tend",
            "stop_time",
            "total_time",
            "simulation_time",
            "run_time",
        ],
    ),
    (
        "safety_factor",
        &["cfl", "time_step_factor", "timestep_safety"],
    ),
    ("gravity", &["g", "gravitational_acceleration"]),
    (
        "local_damping",
        &["damp", "numerical_damping", "global_damping"],
    ),
    (
        "young_modulus",
        &[
            "E",
            "young",
            "youngs_modulus",
            "elastic_modulus",
            "elasticity",
            "modulus",
            "e_modulus",
        ],
    ),
    ("shear_modulus", &["G", "shear_stiffness"]),
    ("poisson_ratio", &["nu", "poisson", "poissons_ratio"]),
    ("density", &["rho", "mass_density", "solid_density"]),
    (
        "friction",
        &[
            "mu",
            "friction_coefficient",
            "static_friction",
            "sliding_friction",
            "coefficient_of_friction",
        ],
    ),
    (
        "rolling_friction",
        &[
            "mu_r",
            "rolling_friction_coefficient",
            "rolling_resistance",
            "rolling_coefficient",
        ],
    ),
    (
        "restitution",
        &[
            "e",
            "cor",
            "coefficient_of_restitution",
            "restitution_coefficient",
        ],
    ),
    ("normal_stiffness", &["kn", "k_n"]),
    (
        "tensile_strength",
        &[
            "strength",
            "pb_ten",
            "sigma_t",
            "tension_strength",
            "critical_normal_stress",
            "normal_strength",
        ],
    ),
    (
        "shear_strength",
        &["pb_coh", "cohesion", "tau_c", "critical_shear_stress"],
    ),
    ("damping_ratio", &["critical_damping_ratio", "zeta"]),
    (
        "failure",
        &["strength", "tensile_strength", "shear_strength", "breakage"],
    ),
    (
        "radius_factor",
        &["bond_radius", "radius_multiplier", "pb_rmul"],
    ),
    (
        "position",
        &["centre", "center", "location", "translation", "origin"],
    ),
    (
        "angular_velocity",
        &["omega", "spin", "rotational_velocity"],
    ),
    ("drop", &["height", "drop_height", "fall_height"]),
    ("file", &["path", "filename", "geometry"]),
    ("bodies", &["particles", "agglomerates", "clusters"]),
    ("walls", &["geometries", "geometry", "boundaries"]),
    (
        "supports",
        &["constraints", "boundary_conditions", "fixities"],
    ),
    ("loads", &["forces"]),
    ("measures", &["sensors", "histories", "probes", "monitors"]),
    ("frames", &["dump", "save_interval", "output_interval"]),
];

/// All particles of the scene.
pub const ALL: &str = "all";

/// The fragments of bodies.
pub(super) const FRAGMENTS: &str = "fragments";

/// The meaning of a reserved name; None for a name that is free.
pub(super) fn meaning(name: &str) -> Option<&'static str> {
    match name {
        ALL => Some("all particles of the scene"),
        FRAGMENTS => Some("the fragments of the scene"),
        _ => None,
    }
}

/// Largest number of names listed in a message.
const MOST_NAMES: usize = 30;

/// True if one name may be a misspelling of the other: at most a third of the letters differ, and
/// not all of them.
fn near(distance: usize, name: &str, candidate: &str) -> bool {
    let length = candidate.chars().count();
    3 * distance <= length + 2 && distance < length.max(name.chars().count())
}

/// Smallest number of letters inserted, removed, replaced or swapped with their neighbour that
/// turns `a` into `b`.
fn edit_distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().take(LONGEST_COMPARED).collect();
    let b: Vec<char> = b.chars().take(LONGEST_COMPARED).collect();
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let replaced = last[j] + usize::from(a[i] != b[j]);
            let mut best = replaced.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                best = best.min(before[j - 1] + 1);
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

/// Number of leading letters up to which names are compared.
const LONGEST_COMPARED: usize = 64;

/// True if `name` consists of letters, digits, - and _.
pub(super) fn well_formed(name: &str) -> bool {
    !name.is_empty()
        && name
            .bytes()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, b'-' | b'_'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        for (a, b, distance) in [
            ("", "", 0),
            ("end_tim", "end_time", 1),
            ("end_tmie", "end_time", 1),
            ("steel", "stone", 3),
            ("", "abc", 3),
        ] {
            assert_eq!(edit_distance(a, b), distance, "{a} {b}");
            assert_eq!(edit_distance(b, a), distance, "{b} {a}");
        }
    }

    #[test]
    fn suggestions() {
        let known = || ["end_time", "rest", "seed"].into_iter();
        assert_eq!(suggestion("end_tim", known()), "did you mean 'end_time'?");
        assert_eq!(suggestion("colour", known()), "known: end_time, rest, seed");
        assert_eq!(suggestion("x", std::iter::empty()), "there are none");
        let moduli = || ["young_modulus", "restitution", "density"].into_iter();
        for (other, ours) in [
            ("E", "young_modulus"),
            ("youngs_modulus", "young_modulus"),
            ("Elastic_Modulus", "young_modulus"),
            ("e", "restitution"),
            ("rho", "density"),
        ] {
            assert_eq!(
                suggestion(other, moduli()),
                format!("did you mean '{ours}'?")
            );
        }
        // Only where it is known: a name of another table helps nobody.
        assert_eq!(
            suggestion("dt", moduli()),
            "known: young_modulus, restitution, density"
        );
        assert_eq!(
            suggestion("dt", ["time_step"].into_iter()),
            "did you mean 'time_step'?"
        );
        assert_eq!(suggestion("w", ["x", "y"].into_iter()), "known: x, y");
        let many = vec!["some"; 1000];
        assert!(suggestion("colour", many.into_iter()).ends_with("some, ..."));
    }
}
