//! What is tested: the type of test and the dimensions of a specimen, and what force and stiffness
//! say of its material.

use dem_io::units::{AREA, Dimension, LENGTH, STRESS};
use dem_io::{Diagnostic, Result};
use serde::{Deserialize, Serialize};

use crate::theory::{Beam, bar_stress_pa, disc_stress_pa};

/// Names of the pressures under which specimens are tested.
const CONFINING_PRESSURE: &str = "confining_pressure";
const NORMAL_STRESS: &str = "normal_stress";

/// Type of a laboratory test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TestType {
    /// Two pins push between two supports.
    FourPointBending,
    /// One pin pushes halfway between two supports.
    ThreePointBending,
    /// A disc is pressed across its diameter until it splits.
    BrazilianDisc,
    /// A body is pressed along its length.
    Compression,
    /// A body is gripped at its ends and pulled.
    Tension,
    /// A body with wide ends and a narrow neck is gripped at its ends and pulled.
    DogBone,
    /// A body is pressed along its length while walls around it keep a pressure on its sides.
    TriaxialCompression,
    /// One half of a body is slid along the other under a constant force that presses them
    /// together.
    DirectShear,
    /// A body is pressed between two long bars, into one of which a striker sends a pulse.
    HopkinsonPressure,
    /// A body is pulled by two long bars, into one of which a striker sends a pulse.
    HopkinsonTension,
    /// A disc is pressed across its diameter between the two bars.
    HopkinsonDisc,
    /// A weight falls on a body.
    DropWeight,
}

/// Dimensions of a specimen, and the pressure under which it is tested; those that its test does
/// not have stay empty.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Dimensions {
    /// Distance of the supports of a beam, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support_span_m: Option<f64>,
    /// Distance of the two loading pins, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loading_span_m: Option<f64>,
    /// Width of a beam, or thickness of a disc, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f64>,
    /// Height of a beam, or diameter of a disc, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Length of a body that is pressed or pulled, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    /// Area of its section, m2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub area_m2: Option<f64>,
    /// Pressure on the sides of a triaxial test, Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confining_pressure_pa: Option<f64>,
    /// Stress on the plane of a direct shear test, Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_stress_pa: Option<f64>,
}

/// A specimen in its test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Specimen {
    /// A beam on two supports.
    Beam(Beam),
    /// A disc pressed across its diameter.
    Disc {
        /// m.
        diameter_m: f64,
        /// m.
        thickness_m: f64,
    },
    /// A body pressed or pulled along its length.
    Bar {
        /// m.
        length_m: f64,
        /// m2.
        area_m2: f64,
    },
}

impl TestType {
    /// All types with their names.
    pub const NAMES: [(&'static str, Self); 12] = [
        ("four-point-bending", Self::FourPointBending),
        ("three-point-bending", Self::ThreePointBending),
        ("brazilian-disc", Self::BrazilianDisc),
        ("compression", Self::Compression),
        ("tension", Self::Tension),
        ("dog-bone", Self::DogBone),
        ("triaxial-compression", Self::TriaxialCompression),
        ("direct-shear", Self::DirectShear),
        ("hopkinson-pressure", Self::HopkinsonPressure),
        ("hopkinson-tension", Self::HopkinsonTension),
        ("hopkinson-disc", Self::HopkinsonDisc),
        ("drop-weight", Self::DropWeight),
    ];

    /// Its name in scenes and options.
    pub fn name(self) -> &'static str {
        let found = Self::NAMES.iter().find(|(_, other)| *other == self);
        found.map_or("", |(name, _)| *name)
    }

    /// Whether two long bars load the body.
    pub fn has_bars(self) -> bool {
        matches!(
            self,
            Self::HopkinsonPressure | Self::HopkinsonTension | Self::HopkinsonDisc
        )
    }

    /// Whether the inertia of the loading device is part of the test, which then has no rate.
    pub fn is_dynamic(self) -> bool {
        self.has_bars() || self == Self::DropWeight
    }

    /// Whether groups of particles are gripped and moved.
    pub fn grips(self) -> bool {
        matches!(
            self,
            Self::Tension | Self::DogBone | Self::HopkinsonTension | Self::DirectShear
        )
    }

    /// Whether the stress that is left after the peak is a result: the test goes on to the end of
    /// its stroke.
    pub fn has_residual(self) -> bool {
        matches!(self, Self::TriaxialCompression | Self::DirectShear)
    }

    /// Name of the pressure under which it is done.
    pub fn pressure(self) -> Option<&'static str> {
        match self {
            Self::TriaxialCompression => Some(CONFINING_PRESSURE),
            Self::DirectShear => Some(NORMAL_STRESS),
            _ => None,
        }
    }

    /// Names of the dimensions that it has.
    pub fn dimensions(self) -> &'static [&'static str] {
        match self {
            Self::FourPointBending => &["support_span", "loading_span", "width", "height"],
            Self::ThreePointBending => &["support_span", "width", "height"],
            Self::BrazilianDisc | Self::HopkinsonDisc => &["width", "height"],
            Self::Compression
            | Self::Tension
            | Self::DogBone
            | Self::TriaxialCompression
            | Self::DirectShear
            | Self::HopkinsonPressure
            | Self::HopkinsonTension
            | Self::DropWeight => &["length", "area"],
        }
    }
}

impl Dimensions {
    /// Names of all sizes.
    pub const SIZES: [&'static str; 6] = [
        "support_span",
        "loading_span",
        "width",
        "height",
        "length",
        "area",
    ];

    /// Names of all dimensions.
    pub const NAMES: [&'static str; 8] = [
        "support_span",
        "loading_span",
        "width",
        "height",
        "length",
        "area",
        CONFINING_PRESSURE,
        NORMAL_STRESS,
    ];

    /// What a dimension is measured in, and its SI unit.
    pub fn unit_of(name: &str) -> (&'static Dimension, &'static str) {
        match name {
            "area" => (&AREA, "m2"),
            CONFINING_PRESSURE | NORMAL_STRESS => (&STRESS, "Pa"),
            _ => (&LENGTH, "m"),
        }
    }

    /// The pressure under which a specimen is tested, Pa.
    pub fn pressure_pa(&self) -> Option<f64> {
        self.confining_pressure_pa.or(self.normal_stress_pa)
    }

    /// The dimension with this name.
    pub fn get(&self, name: &str) -> Option<f64> {
        let all = [
            self.support_span_m,
            self.loading_span_m,
            self.width_m,
            self.height_m,
            self.length_m,
            self.area_m2,
            self.confining_pressure_pa,
            self.normal_stress_pa,
        ];
        let at = Self::NAMES.iter().position(|other| *other == name)?;
        all[at]
    }

    /// Sets the dimension with this name, in its SI unit.
    pub fn set(&mut self, name: &str, value: f64) {
        match name {
            "support_span" => self.support_span_m = Some(value),
            "loading_span" => self.loading_span_m = Some(value),
            "width" => self.width_m = Some(value),
            "height" => self.height_m = Some(value),
            "length" => self.length_m = Some(value),
            "area" => self.area_m2 = Some(value),
            CONFINING_PRESSURE => self.confining_pressure_pa = Some(value),
            NORMAL_STRESS => self.normal_stress_pa = Some(value),
            _ => {}
        }
    }

    /// These dimensions, and those of `other` where they are empty.
    pub fn or(&self, other: &Self) -> Self {
        Self {
            support_span_m: self.support_span_m.or(other.support_span_m),
            loading_span_m: self.loading_span_m.or(other.loading_span_m),
            width_m: self.width_m.or(other.width_m),
            height_m: self.height_m.or(other.height_m),
            length_m: self.length_m.or(other.length_m),
            area_m2: self.area_m2.or(other.area_m2),
            confining_pressure_pa: self.confining_pressure_pa.or(other.confining_pressure_pa),
            normal_stress_pa: self.normal_stress_pa.or(other.normal_stress_pa),
        }
    }
}

impl Specimen {
    /// A specimen of these dimensions.
    ///
    /// # Errors
    /// A dimension missing, of another test, or not positive; loading pins not within the supports.
    pub fn new(test: TestType, dimensions: &Dimensions) -> Result<Self> {
        refuse_dimensions(test, dimensions)?;
        let size = |name: &str| dimensions.get(name).unwrap_or(0.0);
        let beam = Beam {
            span_m: size("support_span"),
            loading_span_m: size("loading_span"),
            width_m: size("width"),
            height_m: size("height"),
        };
        match test {
            TestType::FourPointBending | TestType::ThreePointBending => {
                if beam.loading_span_m >= beam.span_m {
                    let problem = format!(
                        "the loading span of {} m is not below the support span of {} m",
                        beam.loading_span_m, beam.span_m
                    );
                    return Err(Diagnostic::input("", problem, "correct one of them"));
                }
                Ok(Self::Beam(beam))
            }
            TestType::BrazilianDisc | TestType::HopkinsonDisc => Ok(Self::Disc {
                diameter_m: size("height"),
                thickness_m: size("width"),
            }),
            TestType::Compression
            | TestType::Tension
            | TestType::DogBone
            | TestType::TriaxialCompression
            | TestType::DirectShear
            | TestType::HopkinsonPressure
            | TestType::HopkinsonTension
            | TestType::DropWeight => Ok(Self::Bar {
                length_m: size("length"),
                area_m2: size("area"),
            }),
        }
    }

    /// Young's modulus from the force over the crosshead travel, Pa: Platzer 2022, eq. 18, in
    /// bending, without shear. None for a disc.
    pub fn modulus_pa(&self, stiffness_n_m: f64) -> Option<f64> {
        match self {
            Self::Beam(beam) => Some(stiffness_n_m / beam.bending_shape_m()),
            Self::Disc { .. } => None,
            Self::Bar { length_m, area_m2 } => Some(stiffness_n_m * length_m / area_m2),
        }
    }

    /// Stress at a force, Pa: Platzer 2022, eq. 19, in bending; 2 F/(pi D t) for a disc; F/A.
    pub fn stress_pa(&self, force_n: f64) -> f64 {
        match self {
            Self::Beam(beam) => beam.stress_pa(force_n),
            Self::Disc {
                diameter_m,
                thickness_m,
            } => disc_stress_pa(force_n, *diameter_m, *thickness_m),
            Self::Bar { area_m2, .. } => bar_stress_pa(force_n, *area_m2),
        }
    }

    /// Factor by which the force on this specimen becomes that on another at the same travel: the
    /// ratio of the second moments of area in bending (Platzer 2022, 4.4.1.2), of the thicknesses
    /// of discs, of the stiffnesses of bars, of the areas of shear planes (bars without a length).
    pub(crate) fn force_factor(&self, other: &Self) -> f64 {
        let has_no_length =
            |one: &Self| matches!(one, Self::Bar { length_m, .. } if *length_m == 0.0);
        let sheared = has_no_length(self) || has_no_length(other);
        let stiffness = |specimen: &Self| match specimen {
            Self::Beam(beam) => beam.bending_shape_m(),
            Self::Disc { thickness_m, .. } => *thickness_m,
            Self::Bar { area_m2, .. } if sheared => *area_m2,
            Self::Bar { length_m, area_m2 } => area_m2 / length_m,
        };
        stiffness(other) / stiffness(self)
    }

    /// Half the length, from the middle of the specimen, within which a crack counts, m: between
    /// the loading pins of a four-point test. None: anywhere.
    pub fn crack_within_m(&self) -> Option<f64> {
        match self {
            Self::Beam(beam) if beam.loading_span_m > 0.0 => Some(0.5 * beam.loading_span_m),
            _ => None,
        }
    }
}

/// Refuses dimensions that a test does not have, that it lacks, or that are not above 0.
fn refuse_dimensions(test: TestType, dimensions: &Dimensions) -> Result<()> {
    let names: Vec<&str> = test
        .dimensions()
        .iter()
        .copied()
        .chain(test.pressure())
        .collect();
    // The force on a shear plane does not depend on the length of the body.
    let is_needed =
        |name: &str| names.contains(&name) && !(test == TestType::DirectShear && name == "length");
    for name in Dimensions::NAMES {
        let option = name.replace('_', "-");
        match dimensions.get(name) {
            Some(_) if !names.contains(&name) => {
                let problem = format!(
                    "the {} does not apply to {}",
                    name.replace('_', " "),
                    test.name()
                );
                return Err(Diagnostic::input(
                    "",
                    problem,
                    format!("leave out --{option}"),
                ));
            }
            Some(value) if !(value > 0.0 && value.is_finite()) => {
                let problem = format!("the {} is {value}, not above 0", name.replace('_', " "));
                return Err(Diagnostic::input(
                    "",
                    problem,
                    format!("correct --{option}"),
                ));
            }
            None if is_needed(name) => {
                let problem = format!("{} needs the {}", test.name(), name.replace('_', " "));
                let example = match Dimensions::unit_of(name).1 {
                    "m2" => "9cm2",
                    "Pa" => "100kPa",
                    _ => "30mm",
                };
                return Err(Diagnostic::input(
                    "",
                    problem,
                    format!("add --{option} {example}"),
                ));
            }
            _ => {}
        }
    }
    Ok(())
}
