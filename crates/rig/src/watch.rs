//! A test during a run: its initial data, and its result at the end.

use dem_io::Result;
use dem_results::ResultsFolder;
use dem_scene::{Scene, Test};

use super::confined::has_passed_its_peak;
use super::crack::{CrackPicture, Sphere};
use super::curve::rows_of;
use super::dynamic::evaluate_dynamic;
use super::evaluate::{TestInput, evaluate};
use super::files::{TestFiles, write_test};
use super::pieces::Pieces;
use super::record::{Loading, Record};
use crate::setup::Setup;
use dem_engine::state::State;
use dem_laboratory::test_result::TestResult;
use dem_plan::Plan;

/// Settings of a test in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct TestSettings {
    /// Lowest frequency of the body in the test, Hz.
    pub lowest_frequency_hz: f64,
    /// Result of the same test at twice the rate. None: it was not done.
    pub at_twice_the_rate: Option<TestResult>,
    /// Load of which the elastic part of the curve has 20 % to 60 %, N: that of a body with the
    /// wanted strength. None, or more than the body bears: its own largest load.
    pub wanted_n: Option<f64>,
}

/// A test that is monitored.
#[derive(Debug, Clone)]
pub struct Watch<'a> {
    scene: &'a Scene,
    test: &'a Test,
    settings: TestSettings,
    setup: Setup,
    loading: Loading,
    /// All particles in their initial positions, and whether they belong to the tested body.
    spheres: Vec<(Sphere, bool)>,
}

impl<'a> Watch<'a> {
    /// For a test arranged as in `setup`, in a plan that has not been stepped.
    pub fn new(
        scene: &'a Scene,
        test: &'a Test,
        setup: Setup,
        settings: TestSettings,
        plan: &Plan,
    ) -> Self {
        let state = &plan.state;
        let particles = plan.groups.get(&test.body).map_or(&[][..], Vec::as_slice);
        let loading = Loading::of_test(scene, test, &setup, state);
        let spheres = (0..).zip(&state.particles.poses);
        let spheres = spheres
            .map(|(i, pose)| (pose.position_m, particles.binary_search(&i).is_ok()))
            .collect();
        Self {
            scene,
            test,
            settings,
            setup,
            loading,
            spheres,
        }
    }

    /// How a test that is over, or at the end of its time, has ended.
    pub fn ended_by(&self, over: bool) -> &'static str {
        match (self.test.kind.is_dynamic(), over) {
            (true, _) => "end of the test",
            (false, true) => "breakage",
            (false, false) => "end of the stroke",
        }
    }

    /// Whether all answers of the test are those at its largest load.
    pub fn answers_at_its_peak(&self) -> bool {
        !self.test.kind.is_dynamic() && !self.test.kind.has_residual()
    }

    /// Records a step; returns whether the test is over.
    pub fn note(&self, record: &mut Record, state: &State) -> bool {
        record.note(&self.setup, &self.loading, state)
    }

    /// Whether bonds have broken and the stress has passed its peak, in a test that goes on then.
    fn has_passed_its_peak(&self, record: &Record) -> bool {
        let rows = rows_of(record, self.settings.lowest_frequency_hz);
        let goes_on = self.test.kind.has_residual() && !record.broken.is_empty();
        goes_on && has_passed_its_peak(&rows)
    }

    /// Its result, written to `folder` if there is one.
    pub fn finish(
        &self,
        record: &Record,
        state: &State,
        folder: Option<&ResultsFolder>,
    ) -> Result<TestResult> {
        let places: Vec<[f64; 3]> = record
            .broken
            .iter()
            .map(|broken| {
                let [a, b] = state.bonds.ends[broken.bond as usize];
                let [a, b] = [a, b].map(|end| self.spheres[end as usize].0);
                [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))
            })
            .collect();
        let kind = self.scene.bodies.get(&self.test.body);
        let kind = kind.and_then(|body| body.bond_kind.as_ref());
        let evidence = TestInput {
            test: self.test,
            setup: &self.setup,
            record,
            places_m: &places,
            bonds: kind.and_then(|name| self.scene.bonds.get(name)),
            lowest_frequency_hz: self.settings.lowest_frequency_hz,
            wanted_n: self.settings.wanted_n,
            broken: match self.test.kind.has_residual() {
                true => self.has_passed_its_peak(record),
                false => record.fell,
            },
            pieces: Pieces::of(state, &self.test.body),
            all_bonds: state.bonds.len(),
        };
        let mut result = if self.test.kind.is_dynamic() {
            evaluate_dynamic(&evidence)
        } else {
            evaluate(&evidence)
        };
        if let Some(fast) = &self.settings.at_twice_the_rate {
            result.compare(fast);
        }
        if let Some(folder) = folder {
            let times = record.broken.iter().map(|broken| broken.time_s);
            let broken: Vec<([f64; 3], f64)> = places.iter().copied().zip(times).collect();
            let of_body = self.spheres.iter().filter(|(_, is_of_body)| *is_of_body);
            let spheres: Vec<Sphere> = of_body.map(|(sphere, _)| *sphere).collect();
            write_test(
                folder,
                &TestFiles {
                    scene: &self.scene.source,
                    test: self.test,
                    record,
                    result: &result,
                    picture: CrackPicture {
                        setup: &self.setup,
                        spheres: &spheres,
                        broken: &broken,
                        crack: result.crack.as_ref(),
                    },
                },
            )?;
        }
        Ok(result)
    }
}
