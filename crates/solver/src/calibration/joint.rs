//! Several tests of one material: their scenes, what they vary and what they are to give.

use std::path::Path;

use dem_calibration::{Aim, Free, Number};
use dem_io::units::quantity;
use dem_io::{Diagnostic, Result};
use dem_laboratory::TestType;
use dem_laboratory::test_result::STIFFNESS;
use dem_rig::confined::RESIDUAL;
use dem_rig::dynamic::results_of;
use dem_rig::evaluate::{BY_TRAVEL, EQ_18, MODULUS};
use dem_scene::{BondKind, Scene, Test, material_text, set_text, written_value};

use super::choice::{
    ModulusBy, STRENGTH_TOLERANCE, STRENGTHS, SceneText, dimension_of, refuse_twice, unknowns,
};
use super::slopes::slope;

/// Largest friction angle of bonds that a calibration tries, degrees.
const LARGEST_ANGLE_DEG: f64 = 80.0;

/// A scene of several, with its text.
pub(crate) struct TestScene {
    pub(crate) scene: Scene,
    pub(crate) text: String,
}

impl TestScene {
    /// Its text with these `--set` values.
    pub(crate) fn with<'a>(&'a self, overrides: &'a [String]) -> SceneText<'a> {
        SceneText {
            text: &self.text,
            source: &self.scene.source,
            overrides,
        }
    }

    /// Its test; refuses a scene without.
    pub(crate) fn test(&self) -> Result<&Test> {
        self.scene.test.as_ref().ok_or_else(|| {
            let problem = "the scene has no [test]";
            let remedy = "add one: of several scenes each is a laboratory test";
            Diagnostic::input(&self.scene.source, problem, remedy)
        })
    }

    /// Name and kind of the bonds of its tested body.
    fn bonds(&self) -> Result<(&str, &BondKind)> {
        let body = self.scene.bodies.get(&self.test()?.body);
        let name = body.and_then(|body| body.bond_kind.as_deref());
        let found = name.and_then(|name| Some((name, self.scene.bonds.get(name)?)));
        found.ok_or_else(|| {
            let problem = "the tested body has no bonds";
            Diagnostic::input(&self.scene.source, problem, "name them: bonds = \"NAME\"")
        })
    }

    /// Whether the command line means this scene: by its path or its file's name.
    pub(crate) fn is_named(&self, name: &str) -> bool {
        let file = Path::new(&self.scene.source).file_name();
        self.scene.source == name || file.is_some_and(|file| file == name)
    }

    /// The `--set` values with these factors on the numbers that this scene has.
    pub(crate) fn overrides(
        &self,
        overrides: &[String],
        unknowns: &[Free],
        factors: &[f64],
    ) -> Result<Vec<String>> {
        let mut all = overrides.to_vec();
        for (unknown, factor) in unknowns.iter().zip(factors) {
            for number in &unknown.numbers {
                let source = &self.scene.source;
                if written_value(&self.text, source, overrides, &number.path)?.is_some() {
                    all.push(set_text(&number.path, number.times(*factor), &number.unit));
                }
            }
        }
        Ok(all)
    }
}

/// The name of the bonds that all tests share; refuses scenes with other bonds.
pub(crate) fn shared_bonds<'a>(tests: &'a [TestScene], overrides: &[String]) -> Result<&'a str> {
    let first = &tests[0];
    let (name, kind) = first.bonds()?;
    for other in &tests[1..] {
        let (other_name, other_kind) = other.bonds()?;
        let problem = if other_name != name {
            format!(
                "its body has the bonds '{other_name}', and that of {} the bonds '{name}'",
                first.scene.source
            )
        } else if other_kind != kind {
            let differs = first_difference(first, other, overrides, name)?;
            format!(
                "its bonds '{name}' are others than in {}: {differs}",
                first.scene.source
            )
        } else {
            continue;
        };
        return Err(Diagnostic::input(
            &other.scene.source,
            problem,
            "several tests calibrate one material: include the same file of materials in all scenes",
        ));
    }
    Ok(name)
}

/// The first line of `[bonds.NAME]` that two scenes have differently.
fn first_difference(
    first: &TestScene,
    other: &TestScene,
    overrides: &[String],
    name: &str,
) -> Result<String> {
    let [first, other] = [first, other].map(|test| -> Result<Vec<String>> {
        let text = material_text(&test.text, &test.scene.source, overrides)?;
        let head = format!("[bonds.{name}]");
        let lines = text.lines().skip_while(|line| *line != head).skip(1);
        let own = lines.take_while(|line| !line.starts_with('['));
        Ok(own
            .map(str::to_owned)
            .filter(|line| !line.is_empty())
            .collect())
    });
    let (first, other) = (first?, other?);
    let lacks = |own: &[String], line: &&String| !own.contains(*line);
    let there = other.iter().find(|line| lacks(&first, line));
    let here = first.iter().find(|line| lacks(&other, line));
    let show = |line: Option<&String>| line.map_or("nothing".to_owned(), String::clone);
    Ok(format!("{} in place of {}", show(there), show(here)))
}

/// Numbers that are varied: what `--free` names, or else modulus and strengths of the bonds as far
/// as the tests have targets for them.
pub(crate) fn free_numbers(
    tests: &[TestScene],
    overrides: &[String],
    bonds: &str,
    named: &[String],
) -> Result<Vec<Free>> {
    let mut names: Vec<&str> = named.iter().map(String::as_str).collect();
    if names.is_empty() {
        let wants = |of: fn(&Test) -> bool| {
            let mut all = tests.iter().filter_map(|test| test.scene.test.as_ref());
            all.any(of)
        };
        let modulus = |test: &Test| {
            let is_disc = test.kind == TestType::BrazilianDisc && test.measured.is_some();
            (test.young_modulus_pa.is_some() || is_disc) && !test.kind.is_dynamic()
        };
        names.extend(wants(modulus).then_some("modulus"));
        names.extend(wants(|test| test.strength_pa.is_some()).then_some("strength"));
    }
    if names.is_empty() {
        let problem = "no scene has a target for modulus or strength";
        let remedy = "add young_modulus, strength or measured to [test], or name the numbers by --free and the results by --target";
        return Err(Diagnostic::input(&tests[0].scene.source, problem, remedy));
    }
    let found = names.iter().map(|name| free(tests, overrides, bonds, name));
    let found: Vec<Free> = found.collect::<Result<_>>()?;
    refuse_twice(found.iter().flat_map(|unknown| &unknown.numbers))?;
    Ok(found)
}

/// Numbers that `--free` names by one word or path.
fn free(tests: &[TestScene], overrides: &[String], bonds: &str, name: &str) -> Result<Free> {
    let place = format!("--free {name}");
    let failure = |key: &str| format!("bonds.{bonds}.failure.{key}");
    let paths: Vec<String> = match name {
        "modulus" => vec![format!("bonds.{bonds}.young_modulus")],
        "strength" => STRENGTHS.map(failure).to_vec(),
        "friction_angle" => vec![failure(name)],
        one if STRENGTHS.contains(&one) => vec![failure(one)],
        path if path.contains('.') && !path.contains('=') => vec![path.to_owned()],
        _ => {
            let remedy = format!(
                "write modulus, strength, {}, friction_angle or the path of a number; the results of several tests are named by --target",
                STRENGTHS.join(", ")
            );
            return Err(Diagnostic::input(place, "it is not known", remedy));
        }
    };
    let mut numbers = Vec::new();
    for path in paths {
        numbers.extend(shared_number(tests, overrides, &path)?);
    }
    if numbers.is_empty() {
        let problem = "no scene has this number".to_owned();
        let remedy = "write a first guess of it into the scenes, or correct its path";
        return Err(Diagnostic::input(place, problem, remedy));
    }
    let angle_deg = |number: &Number| match number.unit.as_str() {
        "rad" | "" => number.value.to_degrees(),
        _ => number.value,
    };
    let is_angle = numbers[0].path.ends_with(".friction_angle");
    let largest = match is_angle {
        true => LARGEST_ANGLE_DEG / angle_deg(&numbers[0]),
        false => f64::MAX,
    };
    Ok(Free { numbers, largest })
}

/// A number of the scenes. None: no scene has it.
///
/// # Errors
/// It is not above 0; two scenes have it differently.
fn shared_number(tests: &[TestScene], overrides: &[String], path: &str) -> Result<Option<Number>> {
    let mut found: Option<(Number, &str)> = None;
    for test in tests {
        let source = test.scene.source.as_str();
        let Some((value, unit)) = written_value(&test.text, source, overrides, path)? else {
            continue;
        };
        if !(value > 0.0 && value.is_finite()) {
            let problem = format!("{path} is {value}, and only numbers above 0 can be varied");
            let remedy = format!("write a first guess: --set {path}=...");
            return Err(Diagnostic::input(source, problem, remedy));
        }
        let number = Number {
            path: path.to_owned(),
            value,
            unit,
        };
        match &found {
            None => found = Some((number, source)),
            Some((first, other)) if *first != number => {
                let problem = format!(
                    "{path} is {}, and {} in {other}",
                    number.text(1.0),
                    first.text(1.0)
                );
                let remedy = "write the same first guess into all scenes";
                return Err(Diagnostic::input(source, problem, remedy));
            }
            Some(_) => {}
        }
    }
    Ok(found.map(|(number, _)| number))
}

/// What the tests are to give: the modulus and the strength of each, as far as its scene or its
/// measured file has them, and what `targets` name. `stiffnesses`: stiffness of the measured curve
/// of each test for its simulated specimen, N/m.
pub(crate) fn aims(
    tests: &[TestScene],
    overrides: &[String],
    by: ModulusBy,
    stiffnesses: &[Option<f64>],
    unknowns: &[Free],
    targets: &[String],
) -> Result<Vec<Aim>> {
    let named = targets.iter().map(|text| named_aim(tests, text));
    let named: Vec<Aim> = named.collect::<Result<_>>()?;
    let mut aims = Vec::new();
    for (at, (test, stiffness_n_m)) in tests.iter().zip(stiffnesses).enumerate() {
        let own = of_scene(test, overrides, by, *stiffness_n_m);
        let is_named = named.iter().any(|aim| aim.test == at);
        let own = match own {
            Err(_) if is_named => Vec::new(),
            own => own?,
        };
        let is_new = |aim: &Aim| {
            let mut named = named.iter().filter(|other| other.test == at);
            named.all(|other| other.result != aim.result)
        };
        aims.extend(
            own.into_iter()
                .map(|aim| Aim { test: at, ..aim })
                .filter(is_new),
        );
        aims.extend(named.iter().filter(|aim| aim.test == at).cloned());
    }
    for aim in &mut aims {
        let of = |unknown: &Free| slope(&aim.result, unknown, unknowns);
        aim.slopes = unknowns.iter().map(of).collect();
        refuse_unmoved(&tests[aim.test], aim)?;
    }
    if aims.len() < unknowns.len() {
        let problem = format!(
            "{} numbers are free, and the scenes have {} targets",
            unknowns.len(),
            aims.len()
        );
        let remedy = "add a test or a --target, or free fewer numbers";
        return Err(Diagnostic::input("--free", problem, remedy));
    }
    Ok(aims)
}

/// Modulus and strength that a scene asks for.
fn of_scene(
    test: &TestScene,
    overrides: &[String],
    by: ModulusBy,
    stiffness_n_m: Option<f64>,
) -> Result<Vec<Aim>> {
    let text = test.with(overrides);
    let found = unknowns(&test.scene, &text, &[], by, stiffness_n_m)?;
    let aim = |unknown: dem_calibration::Unknown| Aim {
        test: 0,
        result: unknown.result,
        unit: unknown.unit,
        target: unknown.target,
        tolerance: unknown.tolerance,
        slopes: Vec::new(),
    };
    Ok(found.into_iter().map(aim).collect())
}

/// Refuses a target that no free number moves.
fn refuse_unmoved(test: &TestScene, aim: &Aim) -> Result<()> {
    if !aim.slopes.iter().all(|slope| *slope == Some(0.0)) {
        return Ok(());
    }
    let remedy = match [STIFFNESS, EQ_18, BY_TRAVEL, MODULUS].contains(&aim.result.as_str()) {
        true => "add --free modulus, or leave out young_modulus",
        false => "add --free strength, or leave out this target",
    };
    let problem = format!("no free number moves its target, the {}", aim.result);
    Err(Diagnostic::input(&test.scene.source, problem, remedy))
}

/// A target that `--target` names: `SCENE=RESULT:VALUE`, or `SCENE=residual strength` of the
/// measured file.
fn named_aim(tests: &[TestScene], text: &str) -> Result<Aim> {
    let place = format!("--target {text}");
    let refuse = |problem: String, remedy: String| Diagnostic::input(&place, problem, remedy);
    let known: Vec<&str> = tests
        .iter()
        .map(|test| test.scene.source.as_str())
        .collect();
    let (scene, result) = text.split_once('=').unwrap_or((text, ""));
    let Some(at) = tests.iter().position(|test| test.is_named(scene)) else {
        let remedy = format!("write SCENE=RESULT:VALUE with one of {}", known.join(", "));
        return Err(refuse(format!("no scene is called '{scene}'"), remedy));
    };
    let test = tests[at].test()?;
    let (result, value) = match result.rsplit_once(':') {
        Some((result, value)) => (result, Some(value)),
        None => (result, None),
    };
    let measures = tests[at].scene.measures.keys().map(String::as_str);
    let of_test = results_of(test.kind);
    let names = of_test.iter().map(|(name, _)| *name);
    let results: Vec<&str> = measures.chain(names).collect();
    if !results.contains(&result) {
        let problem = format!("the scene has no measure or test result '{result}'");
        return Err(refuse(
            problem,
            format!("use one of {}", results.join(", ")),
        ));
    }
    let measured = test.measured.as_ref().map(|measured| &measured.material);
    let residual_pa = measured.and_then(|material| material.residual_pa);
    let dimension = dimension_of(of_test, result);
    let target = match value {
        None => residual_pa
            .filter(|_| result == RESIDUAL)
            .map(|one| one.mean),
        Some(value) => match (value.parse(), dimension) {
            (Ok(number), _) => Some(number),
            (Err(_), Some(dimension)) => {
                Some(quantity(value, dimension).map_err(|e| e.within(&place))?)
            }
            (Err(_), None) => None,
        },
    };
    let target = target.filter(|target: &f64| *target > 0.0 && target.is_finite());
    let target = target.ok_or_else(|| {
        let problem = "its value is not a positive number".to_owned();
        let remedy = "write SCENE=RESULT:VALUE with the value in SI units; only a residual strength may come from a measured file";
        refuse(problem, remedy.to_owned())
    })?;
    Ok(Aim {
        test: at,
        result: result.to_owned(),
        unit: dimension.map_or("", |dimension| dimension.si).to_owned(),
        target,
        tolerance: STRENGTH_TOLERANCE,
        slopes: Vec::new(),
    })
}
