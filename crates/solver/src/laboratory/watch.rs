//! A test during a run: what is known of its start, and what comes of it at its end.

use dem_io::Result;
use dem_io::results::ResultsFolder;
use dem_io::scene::{Scene, Test};

use super::arrange::support_of;
use super::crack::{CrackPicture, Sphere};
use super::evaluate::{Evidence, TestResult, evaluate};
use super::page::{TestFiles, write_test};
use super::record::{Holders, Loading, Record};
use super::setup::{Setup, setup};
use crate::plan::Plan;
use crate::state::State;

/// What a run is told of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct TestSettings {
    /// Lowest frequency of the body in the test, Hz.
    pub lowest_frequency_hz: f64,
    /// Volume of the body's shape, m3. None: no file names one.
    pub volume_m3: Option<f64>,
    /// What came of the same test at twice the rate. None: it was not done.
    pub at_twice_the_rate: Option<TestResult>,
}

/// A test that is watched.
#[derive(Debug, Clone)]
pub struct Watch<'a> {
    scene: &'a Scene,
    test: &'a Test,
    settings: TestSettings,
    setup: Setup,
    loading: Loading,
    /// All particles at the start, and whether they are of the tested body.
    spheres: Vec<(Sphere, bool)>,
}

impl<'a> Watch<'a> {
    /// Of a plan that has not been stepped.
    ///
    /// # Errors
    /// Those of [`setup`].
    pub fn new(
        scene: &'a Scene,
        test: &'a Test,
        settings: TestSettings,
        plan: &Plan,
    ) -> Result<Self> {
        let state = &plan.state;
        let particles = plan.sets.get(&test.body).map_or(&[][..], Vec::as_slice);
        let setup = setup(scene, test, state, particles, settings.volume_m3)?;
        let grips: Vec<String> = test.moves.iter().map(|name| support_of(name)).collect();
        let walls = scene.walls.keys().enumerate();
        let supports = scene.supports.keys().enumerate();
        let (mut moving, mut resting) = (Holders::default(), Holders::default());
        for (at, name) in walls {
            let holders = if test.moves.contains(name) {
                &mut moving
            } else {
                &mut resting
            };
            holders.walls.push(at);
        }
        for (at, name) in supports {
            let holders = if grips.contains(name) {
                &mut moving
            } else {
                &mut resting
            };
            holders.supports.push(at);
        }
        let loading = Loading::of(moving, resting, &setup, state, scene.run.end_time_s);
        let spheres = (0..).zip(&state.particles.poses);
        let spheres = spheres
            .map(|(i, pose)| (pose.position_m, particles.binary_search(&i).is_ok()))
            .collect();
        Ok(Self {
            scene,
            test,
            settings,
            setup,
            loading,
            spheres,
        })
    }

    /// Notes a step; whether the body is broken.
    pub fn note(&self, record: &mut Record, state: &State) -> bool {
        record.note(&self.setup, &self.loading, state)
    }

    /// What came of it; written to `folder` if there is one.
    ///
    /// # Errors
    /// Those of the files.
    pub fn finish(
        &self,
        record: &Record,
        state: &State,
        broken: bool,
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
        let mut result = evaluate(&Evidence {
            test: self.test,
            setup: &self.setup,
            record,
            places_m: &places,
            bonds: kind.and_then(|name| self.scene.bonds.get(name)),
            lowest_frequency_hz: self.settings.lowest_frequency_hz,
            broken,
        });
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
