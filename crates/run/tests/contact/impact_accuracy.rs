//! The errors of an impact of one sphere at the step that is chosen for a wanted accuracy.

use std::fmt::Write;
use std::path::Path;

use dem_engine::state::State;
use dem_plan::time_step::impact_step_s;
use dem_testing::hold_table;

use crate::helpers::{started, step_and_balance};

/// The page with the table.
const PAGE: &str = "../../doc/running.md";
const TABLE: [&str; 2] = ["<!-- impacts -->\n", "<!-- end of impacts -->"];

const RADIUS_M: f64 = 5e-3;
const SPEED_M_S: f64 = 1.0;

const LAWS: [(&str, &str); 3] = [
    ("`hertz-mindlin`", "law = \"hertz-mindlin\""),
    ("`dmt`", "law = \"dmt\", work_of_adhesion = 0.1"),
    ("`linear`", "law = \"linear\", normal_stiffness = 1e5"),
];
const RESTITUTIONS: [f64; 6] = [1.0, 0.9, 0.7, 0.5, 0.3, 0.1];
/// Moments within a step at which the ends meet.
const MOMENTS: u32 = 20;

/// A sphere that hits a plate.
#[derive(Debug, Clone, Copy)]
struct Impact {
    law: &'static str,
    restitution: f64,
    /// Tangential over normal velocity.
    slope: f64,
}

/// Errors of an impact: of the energy, at any time of it, over the kinetic energy before, and of
/// restitution; and the number of steps in contact.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    energy: f64,
    restitution: f64,
    steps: f64,
}

impl Found {
    fn worse_of(self, other: Self) -> Self {
        Self {
            energy: self.energy.max(other.energy),
            restitution: self.restitution.max(other.restitution),
            steps: self.steps.max(other.steps),
        }
    }
}

impl Impact {
    fn state(&self, away_m: f64) -> State {
        let Self {
            law,
            restitution,
            slope,
        } = self;
        let across_m_s = slope * SPEED_M_S;
        started(&format!(
            "version = 1
run = {{ end_time = 1 }}
materials.ball = {{ density = 2500, young_modulus = \"50 MPa\", poisson_ratio = 0.25 }}
contacts.ball-ball = {{ {law}, restitution = {restitution}, friction = 0.3 }}
walls.ground = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"ball\" }}
[bodies.ball]
particles = [[0, 0, {:e}, {RADIUS_M}]]
material = \"ball\"
velocity = [{across_m_s}, 0, -{SPEED_M_S}]
",
            RADIUS_M + away_m
        ))
    }

    /// The ends meet this long after the beginning of the third step, in steps.
    fn found(&self, step_s: f64, moment: f64) -> Found {
        let mut state = self.state((2.0 + moment) * step_s * SPEED_M_S);
        state.time_step_s = step_s;
        let motion = |state: &State| state.particles.motions[0];
        let across_m_s = self.slope * SPEED_M_S;
        let mass_kg = 1.0 / motion(&state).inverse_mass;
        let kinetic_j = 0.5 * mass_kg * (SPEED_M_S.powi(2) + across_m_s.powi(2));
        let mut found = Found::default();
        let mut left = 3;
        while left > 0 {
            let error_j = step_and_balance(&mut state).energy_error_j;
            found.energy = found.energy.max(error_j.abs() / kinetic_j);
            let up_m_s = motion(&state).velocity_m_s[2];
            if state.particles.poses[0].position_m[2] < RADIUS_M {
                found.steps += 1.0;
            } else if up_m_s > 0.0 {
                left -= 1;
            }
            assert!(state.steps < 1_000_000, "{self:?} sticks");
        }
        let rebound = motion(&state).velocity_m_s[2] / SPEED_M_S;
        found.restitution = (rebound - self.restitution).abs();
        found
    }

    fn worst(&self, accuracy: f64) -> Found {
        let step_s = impact_step_s(&self.state(RADIUS_M), SPEED_M_S, 0.9, accuracy);
        let moments = (0..MOMENTS).map(|n| (f64::from(n) + 0.5) / f64::from(MOMENTS));
        moments.fold(Found::default(), |worst, moment| {
            worst.worse_of(self.found(step_s, moment))
        })
    }
}

/// The worst of all restitutions, normal and oblique.
fn worst(law: &'static str, accuracy: f64) -> Found {
    let mut worst = Found::default();
    for restitution in RESTITUTIONS {
        for slope in [0.0, 1.0] {
            let impact = Impact {
                law,
                restitution,
                slope,
            };
            let found = impact.worst(accuracy);
            println!("{accuracy} {impact:?}: {found:?}");
            worst = worst.worse_of(found);
        }
    }
    worst
}

/// The asked accuracy is met by each law, at any restitution, angle and moment; `doc/running.md` has
/// the table, which `RENEW_VERIFICATION=1` writes.
#[test]
fn the_asked_accuracy_is_met_and_the_page_says_what_it_costs() {
    let mut table = "\n| `impact_accuracy` | law | error of energy | of restitution | steps of the impact |\n|---|---|---|---|---|\n".to_owned();
    for accuracy in [0.04, 0.02, 0.01, 0.0025, 0.000625] {
        for (name, law) in LAWS {
            let found = worst(law, accuracy);
            assert!(found.energy <= accuracy, "{name}, {accuracy}: {found:?}");
            // An adhesive contact loses the energy of its attraction as well.
            if name != "`dmt`" {
                assert!(
                    found.restitution <= accuracy,
                    "{name}, {accuracy}: {found:?}"
                );
            }
            let restitution = match name {
                "`dmt`" => "-".to_owned(),
                _ => format!("{:.1e}", found.restitution),
            };
            writeln!(
                table,
                "| {accuracy} | {name} | {:.1e} | {restitution} | {} |",
                found.energy, found.steps
            )
            .unwrap();
        }
    }
    hold_table(Path::new(PAGE), TABLE, &table);
}

/// The error of the energy is of second order in the step.
#[test]
fn half_the_step_has_a_quarter_of_the_energy_error() {
    for (name, law) in LAWS {
        for restitution in [1.0, 0.5] {
            let impact = Impact {
                law,
                restitution,
                slope: 0.0,
            };
            let usual_s = impact_step_s(&impact.state(RADIUS_M), SPEED_M_S, 0.9, 0.01);
            let error = |step_s: f64| {
                let moments = (0..MOMENTS).map(|n| (f64::from(n) + 0.5) / f64::from(MOMENTS));
                let errors = moments.map(|moment| impact.found(step_s, moment).energy);
                errors.fold(0.0, f64::max)
            };
            let order = (error(usual_s) / error(0.25 * usual_s)).log(4.0);
            assert!((order - 2.0).abs() < 0.15, "{name}, {restitution}: {order}");
        }
    }
}
