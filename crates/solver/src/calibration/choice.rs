//! Which numbers are varied, and which result each is to give.

use dem_calibration::{Number, Unknown};
use dem_io::units::{Dimension, quantity};
use dem_io::{Diagnostic, Result};
use dem_laboratory::TestType;
use dem_scene::study::RUN_RESULTS;
use dem_scene::{Scene, Test, written_value};

use dem_laboratory::test_result::STIFFNESS;
use dem_rig::dynamic::results_of;
use dem_rig::evaluate::{BY_TRAVEL, EQ_18, MODULUS, STRENGTH};

/// Largest deviation of the mean modulus from its target.
const MODULUS_TOLERANCE: f64 = 0.01;
/// The same for the strength and other results.
pub(super) const STRENGTH_TOLERANCE: f64 = 0.02;
/// Strengths of bonds, as keys of a scene.
pub(super) const STRENGTHS: [&str; 5] = [
    "von_mises_strength",
    "tensile_strength",
    "shear_strength",
    "cohesion",
    "compressive_strength",
];

/// The modulus that is to be met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ModulusBy {
    /// From the crosshead travel, as test rigs measure it.
    Travel,
    /// From the deformation of the specimen itself.
    Specimen,
}

/// The text of a scene and its `--set` values.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SceneText<'a> {
    pub(crate) text: &'a str,
    pub(crate) source: &'a str,
    pub(crate) overrides: &'a [String],
}

/// What is varied: modulus and strengths of the bonds of the tested body, or what `free` names.
/// `stiffness_n_m`: stiffness of the measured curve for the simulated specimen. Refuses a scene
/// with nothing to calibrate.
pub(crate) fn unknowns(
    scene: &Scene,
    text: &SceneText<'_>,
    free: &[String],
    by: ModulusBy,
    stiffness_n_m: Option<f64>,
) -> Result<Vec<Unknown>> {
    let chooser = Chooser {
        scene,
        text,
        by,
        stiffness_n_m,
    };
    if !free.is_empty() {
        let found = free.iter().map(|one| chooser.named(one));
        let found: Vec<Unknown> = found.collect::<Result<_>>()?;
        refuse_twice(found.iter().flat_map(|unknown| &unknown.numbers))?;
        return Ok(found);
    }
    let both = [chooser.modulus()?, chooser.strength(&STRENGTHS)?];
    let found: Vec<Unknown> = both.into_iter().flatten().collect();
    if found.is_empty() {
        return Err(Diagnostic::input(
            &scene.source,
            "the scene has no target",
            "add young_modulus, strength or measured to [test], or name a result: --free PATH=MEASURE:VALUE",
        ));
    }
    Ok(found)
}

/// Whether an unknown varies all strengths that its bonds have in the scene.
pub(crate) fn has_all_strengths(scene: &SceneText<'_>, unknown: &Unknown) -> Result<bool> {
    let Some((table, _)) = unknown.numbers[0].path.rsplit_once('.') else {
        return Ok(false);
    };
    let mut all = 0;
    for key in STRENGTHS {
        let path = format!("{table}.{key}");
        let there = written_value(scene.text, scene.source, scene.overrides, &path)?;
        all += usize::from(there.is_some());
    }
    Ok(unknown.numbers.len() == all)
}

/// Refuses a number that two unknowns have, from the numbers of all.
pub(super) fn refuse_twice<'a>(numbers: impl Iterator<Item = &'a Number>) -> Result<()> {
    let mut paths: Vec<&str> = Vec::new();
    for number in numbers {
        if paths.contains(&number.path.as_str()) {
            let problem = format!("{} is named twice", number.path);
            return Err(Diagnostic::input(
                "--free",
                problem,
                "name each number once",
            ));
        }
        paths.push(&number.path);
    }
    Ok(())
}

/// The dimension of one of the results of a test. None: it is none of them, or a plain number.
pub(super) fn dimension_of(
    results: &[(&str, &'static Dimension)],
    name: &str,
) -> Option<&'static Dimension> {
    let found = results.iter().find(|(known, _)| *known == name);
    found
        .map(|(_, dimension)| *dimension)
        .filter(|dimension| !dimension.si.is_empty())
}

struct Chooser<'a> {
    scene: &'a Scene,
    text: &'a SceneText<'a>,
    by: ModulusBy,
    stiffness_n_m: Option<f64>,
}

impl Chooser<'_> {
    /// One that `--free` names: `modulus`, `strength`, a strength of the bonds, or
    /// `PATH=RESULT:VALUE`.
    fn named(&self, text: &str) -> Result<Unknown> {
        let place = || format!("--free {text}");
        let no_target = |key: &str| {
            let remedy = format!("add {key} or measured to [test]");
            Diagnostic::input(place(), "the scene has no target for it", remedy)
        };
        if let Some((path, result)) = text.split_once('=') {
            let (result, value) = result.rsplit_once(':').unwrap_or((result, ""));
            let target = self
                .target(result, value)
                .map_err(|error| error.within(&place()))?;
            let Some(target) = target.filter(|target| *target > 0.0 && target.is_finite()) else {
                let problem = format!("'{value}' is not a positive number");
                let remedy = "write PATH=MEASURE:VALUE with the value in SI units, or with a unit";
                return Err(Diagnostic::input(place(), problem, remedy));
            };
            let measures = self.scene.measures.keys().map(String::as_str);
            let of_test = self.of_test().iter().map(|(name, _)| *name);
            let known: Vec<&str> = (measures.chain(of_test))
                .chain(RUN_RESULTS.map(|(name, _)| name))
                .collect();
            if !known.contains(&result) {
                let problem = format!("the scene has no measure or test result '{result}'");
                let remedy = format!("use one of {}", known.join(", "));
                return Err(Diagnostic::input(place(), problem, remedy));
            }
            return Ok(Unknown {
                numbers: vec![self.number(path)?.ok_or_else(|| {
                    let remedy = "write its path as for --set, such as contacts.cake-cake.friction";
                    Diagnostic::input(place(), format!("the scene has no {path}"), remedy)
                })?],
                result: result.to_owned(),
                unit: self
                    .dimension(result)
                    .map_or("", |dimension| dimension.si)
                    .to_owned(),
                target,
                tolerance: STRENGTH_TOLERANCE,
                is_proportional: false,
            });
        }
        match text {
            "modulus" => self.modulus()?.ok_or_else(|| no_target("young_modulus")),
            "strength" => self
                .strength(&STRENGTHS)?
                .ok_or_else(|| no_target("strength")),
            one if STRENGTHS.contains(&one) => {
                self.strength(&[one])?.ok_or_else(|| no_target("strength"))
            }
            _ => {
                let remedy = format!(
                    "write modulus, strength, {}, or PATH=MEASURE:VALUE",
                    STRENGTHS.join(", ")
                );
                Err(Diagnostic::input(place(), "it is not known", remedy))
            }
        }
    }

    /// The wanted value of a result, as its measure gives it: a number in SI, or with a unit. None:
    /// it is no number. An angle of repose is given in degrees, and needs its unit.
    fn target(&self, result: &str, value: &str) -> Result<Option<f64>> {
        let plain: Option<f64> = value.parse().ok();
        let Some(dimension) = self.dimension(result) else {
            return Ok(plain);
        };
        match plain {
            Some(number) if dimension.si == "deg" => {
                let problem = format!("the unit of {result}:{value} is missing");
                let remedy = format!(
                    "write \"{number} deg\" or \"{number} rad\": its results are in degrees"
                );
                Err(Diagnostic::input("", problem, remedy))
            }
            None if value.starts_with(|c: char| c.is_ascii_digit()) => {
                quantity(value, dimension).map(Some)
            }
            _ => Ok(plain),
        }
    }

    /// The dimension of a measure, or of a figure of the test. None: a plain number.
    fn dimension(&self, result: &str) -> Option<&'static Dimension> {
        match self.scene.measures.get(result) {
            Some(measure) => Some(measure.quantity.dimension),
            None => dimension_of(self.of_test(), result),
        }
    }

    /// The results that the test can have; none without a test.
    fn of_test(&self) -> &'static [(&'static str, &'static Dimension)] {
        let test = self.scene.test.as_ref();
        test.map_or(&[], |test| results_of(test.kind))
    }

    /// The modulus of the bonds, if the scene has a target for it.
    fn modulus(&self) -> Result<Option<Unknown>> {
        let Some(test) = &self.scene.test else {
            return Ok(None);
        };
        let Some((result, unit, target)) = self.stiffness(test) else {
            return Ok(None);
        };
        let path = format!("bonds.{}.young_modulus", self.bonds(test)?);
        Ok(self.number(&path)?.map(|number| Unknown {
            numbers: vec![number],
            result: result.to_owned(),
            unit: unit.to_owned(),
            target,
            tolerance: MODULUS_TOLERANCE,
            is_proportional: true,
        }))
    }

    /// Name, unit and target of the result that stands for the stiffness of the body.
    fn stiffness(&self, test: &Test) -> Option<(&'static str, &'static str, f64)> {
        let modulus = test.young_modulus_pa;
        match (test.kind, self.by) {
            (kind, _) if kind.is_dynamic() => None,
            (TestType::BrazilianDisc, ModulusBy::Travel) if self.stiffness_n_m.is_some() => {
                Some((STIFFNESS, "N/m", self.stiffness_n_m?))
            }
            (TestType::BrazilianDisc, _) | (_, ModulusBy::Specimen) => {
                Some((MODULUS, "Pa", modulus?))
            }
            (TestType::FourPointBending | TestType::ThreePointBending, _) => {
                Some((EQ_18, "Pa", modulus?))
            }
            (
                TestType::Compression | TestType::Tension | TestType::TriaxialCompression,
                ModulusBy::Travel,
            ) => Some((BY_TRAVEL, "Pa", modulus?)),
            _ => None,
        }
    }

    /// The strengths among these that the bonds have, if the scene has a target.
    fn strength(&self, keys: &[&str]) -> Result<Option<Unknown>> {
        let Some((test, target)) = self
            .scene
            .test
            .as_ref()
            .and_then(|test| Some((test, test.strength_pa?)))
        else {
            return Ok(None);
        };
        let bonds = self.bonds(test)?;
        let mut numbers = Vec::new();
        for key in keys {
            let path = format!("bonds.{bonds}.failure.{key}");
            numbers.extend(self.number(&path)?);
        }
        if numbers.is_empty() {
            return Err(Diagnostic::input(
                &self.scene.source,
                format!("[bonds.{bonds}] has no strength to vary, and [test] has a target"),
                "add failure = { tensile_strength = \"1 MPa\" }, a first guess",
            ));
        }
        Ok(Some(Unknown {
            numbers,
            result: STRENGTH.to_owned(),
            unit: "Pa".to_owned(),
            target,
            tolerance: STRENGTH_TOLERANCE,
            is_proportional: true,
        }))
    }

    /// Name of the bonds of the tested body.
    fn bonds(&self, test: &Test) -> Result<&str> {
        let body = self.scene.bodies.get(&test.body);
        let bonds = body.and_then(|body| body.bond_kind.as_deref());
        bonds.ok_or_else(|| {
            let problem = format!("the body '{}' has no bonds", test.body);
            Diagnostic::input(&self.scene.source, problem, "name them: bonds = \"NAME\"")
        })
    }

    fn number(&self, path: &str) -> Result<Option<Number>> {
        let SceneText {
            text,
            source,
            overrides,
        } = self.text;
        let found = written_value(text, source, overrides, path)?;
        if let Some((value, _)) = &found
            && !(*value > 0.0 && value.is_finite())
        {
            let problem = format!("{path} is {value}, and only numbers above 0 can be varied");
            let remedy = format!("write a first guess: --set {path}=...");
            return Err(Diagnostic::input(*source, problem, remedy));
        }
        let number = |(value, unit)| Number {
            path: path.to_owned(),
            value,
            unit,
        };
        Ok(found.map(number))
    }
}
