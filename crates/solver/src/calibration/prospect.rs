//! What is known of a test before it is run: its specimen, and whether the stroke is long enough.

use std::collections::BTreeMap;

use dem_calibration::Unknown;
use dem_io::units::{show_length, show_quantity};
use dem_io::{Body, Diagnostic, Result};
use dem_laboratory::Specimen;
use dem_scene::Scene;

use dem_laboratory::test_result::STIFFNESS;
use dem_rig::arrange::{arrange, tested_body};
use dem_rig::evaluate::{BY_TRAVEL, EQ_18, STRENGTH, measured_curve, stiffness_of_curve};
use dem_rig::plan_with_test;

/// Smallest ratio of the stroke to the travel at failure of a body that meets its targets: until
/// pins touch, and until the load has fallen.
const ROOM: f64 = 1.2;

/// What is known before the tests.
pub(crate) struct Prospect {
    /// The specimen of the first packing. None: the scene has no test.
    specimen: Option<Specimen>,
    /// Stiffness of the measured curve for this specimen, N/m.
    pub(crate) stiffness_n_m: Option<f64>,
    /// The measured curve for this specimen: displacement, m, and load, N. Empty: there is none.
    pub(crate) wanted_curve: Vec<[f64; 2]>,
}

/// Plans the test of a packing of `body`.
pub(crate) fn prospect(
    scene: &Scene,
    body: &str,
    packing: &Body,
    others: &BTreeMap<String, Body>,
    threads: usize,
) -> Result<Prospect> {
    let mut prospect = Prospect {
        specimen: None,
        stiffness_n_m: None,
        wanted_curve: Vec::new(),
    };
    let Some(test) = &scene.test else {
        return Ok(prospect);
    };
    let mut bodies = others.clone();
    bodies.insert(body.to_owned(), packing.clone());
    if let Some(body) = tested_body(scene, &bodies, threads)? {
        let scene = arrange(scene, &body, 1.0)?;
        let (_, setup) = plan_with_test(&scene, bodies, threads, true)?;
        prospect.specimen = setup.map(|setup| setup.specimen);
    }
    if let Some(specimen) = &prospect.specimen {
        prospect.stiffness_n_m = stiffness_of_curve(test, specimen);
        prospect.wanted_curve = measured_curve(test, specimen);
    }
    Ok(prospect)
}

impl Prospect {
    /// Refuses a stroke that is too short for a body that meets its targets: shorter than 1.2 times
    /// the travel at failure.
    pub(crate) fn check(&self, scene: &Scene, unknowns: &[Unknown]) -> Result<()> {
        let targets = unknowns.iter().map(|one| (one.result.as_str(), one.target));
        self.check_targets(scene, &targets.collect::<Vec<_>>())
    }

    /// The same for targets by their names.
    pub(crate) fn check_targets(&self, scene: &Scene, targets: &[(&str, f64)]) -> Result<()> {
        let (Some(specimen), Some(test)) = (&self.specimen, &scene.test) else {
            return Ok(());
        };
        let target = |names: &[&str]| {
            let found = targets.iter().find(|(name, _)| names.contains(name));
            found.map(|(_, target)| *target)
        };
        let stiffness_n_m = target(&[STIFFNESS]).or_else(|| {
            let modulus_pa = target(&[EQ_18, BY_TRAVEL])?;
            Some(modulus_pa / specimen.modulus_pa(1.0)?)
        });
        let (Some(stiffness_n_m), Some(strength_pa)) = (stiffness_n_m, target(&[STRENGTH])) else {
            return Ok(());
        };
        let force_n = strength_pa / specimen.stress_pa(1.0);
        let travel_m = force_n / stiffness_n_m;
        if test.stroke_m >= ROOM * travel_m {
            return Ok(());
        }
        Err(Diagnostic::input(
            format!("{}: [test]", scene.source),
            format!(
                "the stroke of {} is too short: a body with the wanted modulus and strength fails under {} at a travel of {}",
                show_length(test.stroke_m),
                show_quantity(force_n, "N"),
                show_length(travel_m)
            ),
            format!("write stroke = \"{:.3} mm\" or more", 1e3 * ROOM * travel_m),
        ))
    }
}
