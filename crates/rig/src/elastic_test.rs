//! Stiffness of a test without time steps.

use dem_io::{Diagnostic, Result};
use dem_laboratory::Line;
use dem_laboratory::figure::Figure;
use dem_laboratory::test_result::TestResult;
use dem_scene::Scene;

use super::press::{NotPressed, press};
use crate::evaluate::elastic_figures;
use crate::record::{Loading, Row};
use crate::setup::Setup;
use dem_engine::state::State;
use dem_engine::statics::newton::{Cause, Equilibrium};

/// What a test says without steps: everything but its strength.
#[derive(Debug, Clone, PartialEq)]
pub struct ElasticTest {
    /// Equilibria at about 0.2, 0.4 and 0.6 of the largest load.
    pub rows: Vec<Row>,
    /// Dimensions of the specimen.
    pub dimensions: Vec<Figure>,
    /// Stiffness and moduli, by the names that they have in a test with steps.
    pub figures: Vec<Figure>,
    /// How the last equilibrium was found.
    pub equilibrium: Equilibrium,
}

impl ElasticTest {
    /// The value of a figure.
    pub fn figure(&self, name: &str) -> Option<f64> {
        let found = self.figures.iter().find(|figure| figure.name == name);
        found.map(|figure| figure.value)
    }

    /// As the result of a test of the scene: no bond broke, and there is no rate.
    pub fn result(&self, scene: &Scene) -> Option<TestResult> {
        let test = scene.test.as_ref()?;
        Some(TestResult {
            kind: test.kind,
            broken: false,
            broken_bonds: [0, 0],
            broken_at_peak: 0,
            target_strength_pa: None,
            lowest_frequency_hz: f64::NAN,
            rate_m_s: 0.0,
            dimensions: self.dimensions.clone(),
            figures: self.figures.clone(),
            calibration: Vec::new(),
            first_broken: None,
            crack: None,
            curve: (self.rows.iter())
                .map(|row| [row.travel_m, row.load_n()])
                .collect(),
            reasons: Vec::new(),
            half_the_rate_changes: Vec::new(),
        })
    }
}

/// Stiffness and moduli of the test of a scene, from equilibria at loads of 0.2, 0.4 and 0.6 of
/// that at which the body has the strength given in the scene, or of that at the end of the stroke.
/// `state`: of the scene with its test arranged, before the first step.
///
/// # Errors
/// The walls do not meet the body; no equilibrium is found (exit code 3); interrupted (130).
pub fn elastic_test(
    state: &mut State,
    scene: &Scene,
    setup: &Setup,
    goes_on: &dyn Fn(f64) -> bool,
) -> Result<ElasticTest> {
    let Some(test) = &scene.test else {
        let remedy = "add [test]";
        return Err(Diagnostic::input(
            &scene.source,
            "the scene has no test",
            remedy,
        ));
    };
    let loading = Loading::of_test(scene, test, setup, state);
    let strength_pa = test.strength_pa;
    let largest_n = strength_pa.map(|strength| strength / setup.specimen.stress_pa(1.0));
    let found = press(state, setup, &loading, test.stroke_m, largest_n, goes_on);
    let found = found.map_err(|problem| refused(problem, &scene.source))?;
    let slope = |way: fn(&Row) -> f64| {
        let ways: Vec<f64> = found.rows.iter().map(way).collect();
        let loads: Vec<f64> = found.rows.iter().map(Row::load_n).collect();
        let slope = Line::fitted(&ways, &loads).slope;
        slope.is_finite().then_some(slope)
    };
    let by_travel = slope(|row| row.travel_m);
    let of_body = slope(|row| row.deflection_m).filter(|_| !setup.moving.is_empty());
    let (dimensions, figures) = elastic_figures(test, setup, by_travel, of_body);
    Ok(ElasticTest {
        dimensions,
        figures,
        rows: found.rows,
        equilibrium: found.equilibrium,
    })
}

fn refused(problem: NotPressed, place: &str) -> Diagnostic {
    let remedy = "see what the test does with steps";
    match problem {
        NotPressed::NoContact => Diagnostic::input(
            place,
            "the walls of the test do not press the body within the stroke",
            "lengthen test.stroke, or place the walls nearer to the body",
        ),
        NotPressed::NoEquilibrium(Cause::Interrupted) => {
            Diagnostic::interrupted("interrupted", "start it again").within(place)
        }
        NotPressed::NoEquilibrium(Cause::Memory) => {
            Diagnostic::failed(place, "the stiffness does not fit into memory", remedy)
        }
        NotPressed::NoEquilibrium(Cause::Processor) => Diagnostic::failed(
            place,
            "the library of linear systems does not work on this processor",
            remedy,
        ),
        NotPressed::NoEquilibrium(Cause::Pivot | Cause::NoConvergence) => {
            Diagnostic::unstable(place, "no equilibrium was found without steps", remedy)
        }
    }
}
