//! Units as test rigs write them.

use dem_io::units::{Dimension, ENERGY_PER_MASS, FORCE, LENGTH, quantity};

/// J/kg of a kWh/t.
pub const J_KG_OF_KWH_T: f64 = 3600.0;

/// Spellings of units of length beside those of scenes, in small letters, m.
const LENGTHS: [(&str, f64); 17] = [
    ("inch", 0.0254),
    ("inches", 0.0254),
    ("in.", 0.0254),
    ("\"", 0.0254),
    ("\"\"", 0.0254),
    ("\u{2033}", 0.0254),
    ("mil", 25.4e-6),
    ("mils", 25.4e-6),
    ("thou", 25.4e-6),
    ("ft", 0.3048),
    ("feet", 0.3048),
    ("micron", 1e-6),
    ("microns", 1e-6),
    ("micrometer", 1e-6),
    ("millimeter", 1e-3),
    ("millimeters", 1e-3),
    ("millimetre", 1e-3),
];
/// Newtons of a pound-force.
const POUND: f64 = 4.448_221_615_260_5;
/// Newtons of a kilogram-force.
const KILOPOND: f64 = 9.806_65;
/// Spellings of units of force beside those of scenes, in small letters, N.
const FORCES: [(&str, f64); 20] = [
    ("lbf", POUND),
    ("lbsf", POUND),
    ("lb", POUND),
    ("lbs", POUND),
    ("pound", POUND),
    ("pounds", POUND),
    ("kip", 1e3 * POUND),
    ("kips", 1e3 * POUND),
    ("klbf", 1e3 * POUND),
    ("ozf", POUND / 16.0),
    ("kgf", KILOPOND),
    ("kp", KILOPOND),
    ("gf", 1e-3 * KILOPOND),
    ("tf", 1e3 * KILOPOND),
    ("dan", 10.0),
    ("cn", 1e-2),
    ("newton", 1.0),
    ("newtons", 1.0),
    ("kilonewton", 1e3),
    ("kilonewtons", 1e3),
];
/// Spellings of units of energy over mass beside those of scenes, in small letters, J/kg.
const ENERGIES: [(&str, f64); 7] = [
    ("j/g", 1e3),
    ("mj/t", 1e3),
    ("kwh/tonne", 3600.0),
    ("kwh per t", 3600.0),
    ("kwh per tonne", 3600.0),
    ("j per kg", 1.0),
    ("j per g", 1e3),
];
/// Units of pounds that are masses as well.
const POUNDS: [&str; 4] = ["lb", "lbs", "pound", "pounds"];
/// Units of anything else that a test rig records, in small letters.
const OTHERS: [&str; 46] = [
    "s",
    "sec",
    "secs",
    "sec.",
    "second",
    "seconds",
    "sek",
    "sek.",
    "sn",
    "ms",
    "msec",
    "min",
    "min.",
    "h",
    "hr",
    "%",
    "-",
    "mm/mm",
    "in/in",
    "m/m",
    "\u{b5}e",
    "mpa",
    "kpa",
    "pa",
    "gpa",
    "n/mm2",
    "n/mm\u{b2}",
    "n/mm^2",
    "kn/m2",
    "kn/m\u{b2}",
    "psi",
    "ksi",
    "kgf/cm2",
    "kgf/mm2",
    "\u{b0}c",
    "degc",
    "deg c",
    "\u{b0}f",
    "degf",
    "k",
    "v",
    "mv",
    "mv/v",
    "mm/min",
    "mm/s",
    "segments",
];

/// Size of a unit of a dimension in its SI unit. None: it is not a unit of it. Capitals matter only
/// where they tell units apart: mN and MN.
pub(crate) fn size_of(unit: &str, dimension: &Dimension) -> Option<f64> {
    let unit = unit.trim();
    let is_word = unit.starts_with(|c: char| c.is_alphabetic());
    let exact = is_word.then(|| quantity(&format!("1 {unit}"), dimension).ok());
    if let Some(size) = exact.flatten() {
        return Some(size);
    }
    let small = unit.to_lowercase();
    let aliases: &[(&str, f64)] = match dimension.name {
        name if name == LENGTH.name => &LENGTHS,
        name if name == FORCE.name => &FORCES,
        name if name == ENERGY_PER_MASS.name => &ENERGIES,
        _ => &[],
    };
    if let Some((_, size)) = aliases.iter().find(|(alias, _)| *alias == small) {
        return Some(*size);
    }
    let known = dimension.units.iter();
    let mut alike = known.filter(|(known, _)| known.to_lowercase() == small);
    match (alike.next(), alike.next()) {
        (Some((_, size)), None) => Some(*size),
        _ => None,
    }
}

/// Names of the units of a dimension, for messages.
pub(crate) fn names_of(dimension: &Dimension) -> String {
    let mut names: Vec<&str> = dimension.units.iter().map(|(unit, _)| *unit).collect();
    if dimension.name == FORCE.name {
        names.extend(["lbf", "kip", "kgf"]);
    } else if dimension.name == LENGTH.name {
        names.extend(["mil"]);
    } else if dimension.name == ENERGY_PER_MASS.name {
        names.extend(["J/g"]);
    }
    names.join(", ")
}

/// Whether a unit of force is a mass as well: the force is its weight.
pub(crate) fn is_weight(unit: &str) -> bool {
    POUNDS.contains(&unit.trim().to_lowercase().as_str())
}

/// Whether a text is a unit of travel or of force.
pub(crate) fn is_travel_or_force(text: &str) -> bool {
    size_of(text, &LENGTH).is_some() || size_of(text, &FORCE).is_some()
}

/// Whether a text is a unit of anything that a test rig records.
pub(crate) fn is_unit(text: &str) -> bool {
    is_travel_or_force(text)
        || size_of(text, &ENERGY_PER_MASS).is_some()
        || OTHERS.contains(&text.trim().to_lowercase().as_str())
}
