//! Numbers with units, as written by users: "2 mm", "2.05 g/cm3". Inside the program all values are
//! in SI.

use std::f64::consts::PI;

use crate::diagnostic::{Diagnostic, Result};

/// A physical dimension and its usual units.
#[derive(Debug, Clone, Copy)]
pub struct Dimension {
    /// The name of a value of it.
    pub name: &'static str,
    /// The unit of its values, the SI unit except for [`ANGLE_DEG`]; empty for plain numbers.
    pub si: &'static str,
    /// Units and their size in the SI unit.
    pub units: &'static [(&'static str, f64)],
    /// An example value.
    pub example: &'static str,
}

impl Dimension {
    /// "a length", "an angle".
    pub fn named(&self) -> String {
        let vowel = self.name.starts_with(['a', 'e', 'i', 'o', 'u']);
        format!("{} {}", if vowel { "an" } else { "a" }, self.name)
    }
}

/// Makes a constant of each dimension, and the list of all.
macro_rules! dimensions {
    ($(
        $(#[$doc:meta])+
        $dimension:ident: $name:literal in $si:literal, as $example:literal [
            $($unit:literal: $size:expr,)+
        ]
    )+) => {
        $(
            $(#[$doc])+
            pub const $dimension: Dimension = Dimension {
                name: $name,
                si: $si,
                units: &[$(($unit, $size)),+],
                example: $example,
            };
        )+

        /// All dimensions.
        pub const DIMENSIONS: [Dimension; 26] = [$($dimension),+];
    };
}

dimensions! {
    /// A number without a unit.
    NUMBER: "number" in "", as "0.3" [
        "%": 1e-2,
    ]

    /// Length, m.
    LENGTH: "length" in "m", as "2mm" [
        "nm": 1e-9, "um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0, "km": 1e3, "in": 0.0254,
    ]

    /// Area, m2.
    AREA: "area" in "m2", as "9cm2" [
        "mm2": 1e-6, "cm2": 1e-4, "m2": 1.0,
    ]

    /// Volume, m3.
    VOLUME: "volume" in "m3", as "1 mm3" [
        "um3": 1e-18, "nl": 1e-12, "mm3": 1e-9, "ul": 1e-9, "ml": 1e-6, "cm3": 1e-6, "l": 1e-3,
        "m3": 1.0,
    ]

    /// Time, s.
    TIME: "time" in "s", as "5 ms" [
        "ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0,
    ]

    /// Mass, kg.
    MASS: "mass" in "kg", as "20 g" [
        "ug": 1e-9, "mg": 1e-6, "g": 1e-3, "kg": 1.0, "t": 1e3,
    ]

    /// Density, kg/m3.
    DENSITY: "density" in "kg/m3", as "2050kg/m3" [
        "kg/m3": 1.0, "g/cm3": 1e3, "g/cc": 1e3, "t/m3": 1e3,
    ]

    /// Angle, rad.
    ANGLE: "angle" in "rad", as "45 deg" [
        "rad": 1.0, "mrad": 1e-3, "deg": PI / 180.0, "°": PI / 180.0,
    ]

    /// Velocity, m/s.
    VELOCITY: "velocity" in "m/s", as "3 m/s" [
        "um/s": 1e-6, "mm/s": 1e-3, "cm/s": 1e-2, "m/s": 1.0, "km/h": 1.0 / 3.6,
    ]

    /// Angular velocity, rad/s.
    ANGULAR_VELOCITY: "angular velocity" in "rad/s", as "2 rpm" [
        "rad/s": 1.0, "deg/s": PI / 180.0, "rpm": PI / 30.0,
    ]

    /// Acceleration, m/s2.
    ACCELERATION: "acceleration" in "m/s2", as "9.81 m/s2" [
        "mm/s2": 1e-3, "cm/s2": 1e-2, "m/s2": 1.0,
    ]

    /// Stress and modulus, Pa.
    STRESS: "stress" in "Pa", as "12.05 MPa" [
        "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/m2": 1.0, "N/mm2": 1e6,
    ]

    /// Force, N.
    FORCE: "force" in "N", as "100 kN" [
        "uN": 1e-6, "mN": 1e-3, "N": 1.0, "kN": 1e3, "MN": 1e6,
    ]

    /// Torque, N m.
    TORQUE: "torque" in "N m", as "2 N m" [
        "uN m": 1e-6, "mN m": 1e-3, "N mm": 1e-3, "N m": 1.0, "kN m": 1e3,
    ]

    /// Stiffness, N/m.
    STIFFNESS: "stiffness" in "N/m", as "100 kN/m" [
        "mN/m": 1e-3, "N/m": 1.0, "N/mm": 1e3, "kN/m": 1e3, "kN/mm": 1e6, "MN/m": 1e6,
    ]

    /// Energy, J.
    ENERGY: "energy" in "J", as "3 mJ" [
        "nJ": 1e-9, "uJ": 1e-6, "mJ": 1e-3, "J": 1.0, "kJ": 1e3,
    ]

    /// Energy over mass, J/kg.
    ENERGY_PER_MASS: "energy per mass" in "J/kg", as "0.01 J/kg" [
        "mJ/kg": 1e-3, "J/kg": 1.0, "kJ/kg": 1e3, "kWh/t": 3600.0,
    ]

    /// Mass over energy, kg/J.
    MASS_PER_ENERGY: "mass per energy" in "kg/J", as "0.9 t/kWh" [
        "kg/J": 1.0, "kg/kJ": 1e-3, "t/kWh": 1.0 / 3600.0,
    ]

    /// Energy over area, J/m2.
    ENERGY_PER_AREA: "energy per area" in "J/m2", as "50 J/m2" [
        "mJ/m2": 1e-3, "J/m2": 1.0, "kJ/m2": 1e3, "N/m": 1.0,
    ]

    /// Surface tension, N/m.
    SURFACE_TENSION: "surface tension" in "N/m", as "73 mN/m" [
        "mN/m": 1e-3, "N/m": 1.0, "mJ/m2": 1e-3, "J/m2": 1.0,
    ]

    /// Mass over time, kg/s.
    MASS_RATE: "mass rate" in "kg/s", as "10 kg/s" [
        "g/s": 1e-3, "kg/s": 1.0, "kg/h": 1.0 / 3600.0, "t/h": 1.0 / 3.6,
    ]

    /// Rate, 1/s.
    RATE: "rate" in "1/s", as "1e-5 1/s" [
        "1/s": 1.0, "/s": 1.0, "%/s": 1e-2,
    ]

    /// Power, W.
    POWER: "power" in "W", as "10 W" [
        "mW": 1e-3, "W": 1.0, "kW": 1e3, "MW": 1e6,
    ]

    /// Frequency, Hz.
    FREQUENCY: "frequency" in "Hz", as "4 Hz" [
        "Hz": 1.0, "1/s": 1.0, "/s": 1.0, "1/min": 1.0 / 60.0, "rpm": 1.0 / 60.0,
    ]

    /// Force over velocity, N s/m.
    VISCOUS_DAMPING: "damping coefficient" in "N s/m", as "10 N s/m" [
        "mN s/m": 1e-3, "N s/m": 1.0, "N s/mm": 1e3, "kN s/m": 1e3,
    ]

    /// Volume worn off over normal force and sliding distance, 1/Pa.
    WEAR_CONSTANT: "wear constant" in "1/Pa", as "1e-13 1/Pa" [
        "1/Pa": 1.0, "1/MPa": 1e-6, "1/GPa": 1e-9, "m2/N": 1.0, "mm2/N": 1e-6, "mm3/(N m)": 1e-9,
    ]
}

/// An angle that is given and shown in degrees.
pub const ANGLE_DEG: Dimension = Dimension {
    name: "angle",
    si: "deg",
    units: &[
        ("deg", 1.0),
        ("°", 1.0),
        ("rad", 180.0 / PI),
        ("mrad", 0.18 / PI),
    ],
    example: "30 deg",
};

/// A length in metres from "2mm", "2 mm" or a plain number of metres.
pub fn length_m(text: &str) -> Result<f64> {
    quantity(text, &LENGTH)
}

/// A density in kg/m3 from "2.05 g/cm3" or a plain number of kg/m3.
pub fn density_kg_m3(text: &str) -> Result<f64> {
    quantity(text, &DENSITY)
}

/// Metres in one unit of length, from its name.
pub fn length_unit_m(name: &str) -> Result<f64> {
    unit_size(name.trim(), &LENGTH)
}

/// A value in SI from a number with a unit of `dimension`, or from a plain number in SI. Refuses
/// numbers that are not finite.
pub fn quantity(text: &str, dimension: &Dimension) -> Result<f64> {
    let text = text.trim();
    let number_end = number_length(text);
    let (number, unit) = text.split_at(number_end);
    let value: f64 = number.parse().map_err(|_| {
        Diagnostic::input(
            "",
            format!("'{}' is not {}", text.escape_debug(), dimension.named()),
            format!("write a number with a unit, such as {}", dimension.example),
        )
    })?;
    let unit = unit.trim();
    let size = if unit.is_empty() {
        1.0
    } else if is_decimal_comma(unit) {
        return Err(Diagnostic::input(
            "",
            format!("'{}' has a comma", text.escape_debug()),
            format!(
                "write a decimal point, and nothing between thousands: {}",
                text.replacen(',', ".", 1)
            ),
        ));
    } else {
        unit_size(unit, dimension).map_err(|error| Diagnostic {
            problem: format!(
                "'{}' is not {}: {}",
                text.escape_debug(),
                dimension.named(),
                error.problem
            ),
            ..error
        })?
    };
    let value = value * size;
    if !value.is_finite() {
        return Err(Diagnostic::input(
            "",
            format!("'{text}' is not a finite {}", dimension.name),
            "write a smaller number",
        ));
    }
    Ok(value)
}

/// True for `,5 MPa`, what follows the number of `1,5 MPa`.
fn is_decimal_comma(rest: &str) -> bool {
    let digits = rest.strip_prefix(',');
    digits.is_some_and(|digits| digits.starts_with(|c: char| c.is_ascii_digit()))
}

/// Length in bytes of the number at the beginning of `text`.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let c = bytes[end];
        let exponent = matches!(c, b'e' | b'E')
            && end > 0
            && bytes
                .get(end + 1)
                .is_some_and(|n| n.is_ascii_digit() || matches!(n, b'+' | b'-'));
        let sign = matches!(c, b'+' | b'-') && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        if !(c.is_ascii_digit() || c == b'.' || exponent || sign) {
            break;
        }
        end += 1;
    }
    end
}

fn unit_size(name: &str, dimension: &Dimension) -> Result<f64> {
    let wanted = unit_letters(name);
    dimension
        .units
        .iter()
        .find(|(known, _)| unit_letters(known) == wanted)
        .map(|(_, size)| *size)
        .ok_or_else(|| {
            let known = dimension.units.iter().map(|(unit, _)| *unit);
            // Capitals matter: m is milli, M mega.
            let is_same = |unit: &&str| unit_letters(unit).eq_ignore_ascii_case(&wanted);
            let similar: Vec<&str> = known.clone().filter(is_same).collect();
            let remedy = if similar.is_empty() {
                format!("use one of {}", known.collect::<Vec<&str>>().join(", "))
            } else {
                format!("did you mean {}?", similar.join(" or "))
            };
            Diagnostic::input(
                "",
                format!("unknown unit '{}'", name.escape_debug()),
                remedy,
            )
        })
}

/// A unit in plain letters: "N·s/m", "N*s/m" and "N s/m" are the same.
fn unit_letters(name: &str) -> String {
    name.chars()
        .filter_map(|c| match c {
            'µ' | 'μ' => Some('u'),
            '²' => Some('2'),
            '³' => Some('3'),
            '^' | '*' | '·' => None,
            c if c.is_whitespace() => None,
            c => Some(c),
        })
        .collect()
}

/// A human-readable length: three to four digits in a suitable unit.
pub fn show_length(metres: f64) -> String {
    let size = metres.abs();
    let (name, unit) = match size {
        s if s == 0.0 || s >= 1.0 => ("m", 1.0),
        s if s >= 1e-4 => ("mm", 1e-3),
        s if s >= 1e-7 => ("um", 1e-6),
        _ => ("nm", 1e-9),
    };
    format!("{} {name}", significant(metres / unit, 4))
}

/// `value` with this number of significant digits, without trailing zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..=9).contains(&magnitude) {
        return format!("{value:.*e}", digits - 1);
    }
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A value in an SI unit for a person: four digits, in the unit that suits its size.
pub fn show_quantity(value: f64, unit: &str) -> String {
    let size = value.abs();
    let (factor, unit) = match unit {
        "m" if (1e-10..0.99995e-6).contains(&size) => (1e9, "nm"),
        "m" if size > 0.0 && size < 1e-10 => (1.0, "m"),
        "m" if size < 1.0 => (1e3, "mm"),
        "m2" if size < 1.0 => (1e6, "mm2"),
        "m/s" if size < 1.0 => (1e3, "mm/s"),
        "Pa" if size >= 1e9 => (1e-9, "GPa"),
        "Pa" if size >= 1e5 => (1e-6, "MPa"),
        "Pa" if size >= 1e3 => (1e-3, "kPa"),
        "N" if size >= 1e4 => (1e-3, "kN"),
        "N/m" if size >= 1e4 => (1e-3, "kN/m"),
        _ if size == 0.0 => (1.0, unit),
        "s" if size < 0.99995e-3 => (1e6, "us"),
        "s" if size < 0.99995 => (1e3, "ms"),
        "kg" if size < 1e-3 => (1e6, "mg"),
        "kg" if size < 1.0 => (1e3, "g"),
        unit => (1.0, unit),
    };
    format!("{} {unit}", significant(factor * value, 4))
        .trim_end()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_with_and_without_units() {
        assert_eq!(length_m("2mm").ok(), Some(2e-3));
        assert_eq!(length_m(" 2.5e-3 m").ok(), Some(2.5e-3));
        assert_eq!(length_m("0.002").ok(), Some(0.002));
        assert_eq!(length_m("3µm").ok(), Some(3.0 * 1e-6));
        assert_eq!(density_kg_m3("2.05 g/cm3").ok(), Some(2.05 * 1e3));
        for bad in ["", "mm", "2 parsec", "nan", "1e999", "2mm3", "--2"] {
            assert!(length_m(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn every_unit_reads_its_size() {
        for dimension in DIMENSIONS {
            for (unit, size) in dimension.units {
                let value = quantity(&format!("2 {unit}"), &dimension);
                assert_eq!(value.ok(), Some(2.0 * size), "{unit}");
            }
            assert!(quantity(dimension.example, &dimension).is_ok());
            assert!(quantity("2 parsec", &dimension).is_err());
        }
    }

    /// Every dimension declared above is also known to studies.
    #[test]
    fn all_dimensions_are_in_the_list() {
        let declared = include_str!("units.rs")
            .matches(": Dimension = Dimension {")
            .count();
        // The table, this test itself, and `ANGLE_DEG`, which has the units of `ANGLE`.
        assert_eq!(declared, 3);
        let names = |dimension: &Dimension| -> Vec<&str> {
            let mut names: Vec<&str> = dimension.units.iter().map(|(unit, _)| *unit).collect();
            names.sort_unstable();
            names
        };
        assert_eq!(names(&ANGLE_DEG), names(&ANGLE));
        let mut names: Vec<&str> = DIMENSIONS.iter().map(|d| d.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), DIMENSIONS.len());
    }

    #[test]
    fn units_in_several_spellings() {
        assert_eq!(quantity("5 N·s/m", &VISCOUS_DAMPING).ok(), Some(5.0));
        assert_eq!(quantity("5Ns/m", &VISCOUS_DAMPING).ok(), Some(5.0));
        assert_eq!(quantity("2 N*m", &TORQUE).ok(), Some(2.0));
        assert_eq!(quantity("9.81 m/s²", &ACCELERATION).ok(), Some(9.81));
        assert_eq!(quantity("9.81 m/s^2", &ACCELERATION).ok(), Some(9.81));
        assert_eq!(quantity("3 μs", &TIME).ok(), Some(3.0 * 1e-6));
        assert_eq!(quantity("1e-5 1/s", &RATE).ok(), Some(1e-5));
        assert_eq!(quantity("180 deg", &ANGLE).ok(), Some(PI));
        assert_eq!(quantity("30 rpm", &ANGULAR_VELOCITY).ok(), Some(PI));
    }

    #[test]
    fn a_wrong_unit_names_those_that_fit() {
        let message = quantity("5 mm", &TIME).map_err(|e| e.to_string());
        let wanted = "'5 mm' is not a time: unknown unit 'mm'; use one of ns, us, ms, s, min, h";
        assert_eq!(message, Err(wanted.to_owned()));
    }

    #[test]
    fn slips_of_the_pen_are_named() {
        let said = |text: &str, dimension: &Dimension| {
            quantity(text, dimension).map_err(|error| error.to_string())
        };
        let comma =
            "'1,5 MPa' has a comma; write a decimal point, and nothing between thousands: 1.5 MPa";
        assert_eq!(said("1,5 MPa", &STRESS), Err(comma.to_owned()));
        assert!(said("1,5", &NUMBER).is_err_and(|said| said.ends_with(": 1.5")));
        let capitals = "'1.5 Mpa' is not a stress: unknown unit 'Mpa'; did you mean MPa?";
        assert_eq!(said("1.5 Mpa", &STRESS), Err(capitals.to_owned()));
        assert!(said("2 KN", &FORCE).is_err_and(|said| said.ends_with("did you mean kN?")));
        assert_eq!(said("1.3 g/cc", &DENSITY), Ok(1300.0));
    }

    #[test]
    fn numbers_for_a_person() {
        assert_eq!(show_length(0.0025), "2.5 mm");
        assert_eq!(show_length(3.2e-6), "3.2 um");
        assert_eq!(significant(77487.0, 4), "77487");
        assert_eq!(significant(0.597_12, 3), "0.597");
    }
}
