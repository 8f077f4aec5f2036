//! Runs scenes of bonded bodies: TOML scene -> [`plan()`] -> [`State`] -> [`step()`], step, ... ->
//! results.
//!
//! ```
//! use dem_scene::{read_bodies, scene_from_text};
//! use dem_run::{plan, step};
//!
//! let text = r#"
//! version = 1
//! run = { end_time = "1 s", gravity = [0, 0, -9.81] }
//! materials.stone = { density = 2600 }
//! bodies.ball = { particles = [[0, 0, 0, 0.01]], material = "stone" }
//! "#;
//! let scene = scene_from_text(text, "fall.toml", &[])?;
//! let mut state = plan(&scene, read_bodies(&scene)?, 1, false)?.state;
//! while state.time_s < 0.5 {
//!     step(&mut state);
//! }
//! let fallen_m = -state.particles.poses[0].position_m[2];
//! assert!((fallen_m - 0.5 * 9.81 * state.time_s.powi(2)).abs() < 1e-9);
//! # Ok::<(), dem_io::Diagnostic>(())
//! ```
//!
//! [`run()`] does the same as the program: it steps a plan to its end, monitors it and writes
//! results.

pub(crate) mod calibration;
pub mod cli;
pub mod interrupt;

pub use dem_engine::{Balance, State, balance, check, stages, state, step, threads};
pub use dem_physics as physics;
pub use dem_plan::{self as plan, Plan, measure, plan};
pub use dem_rig as rig;
pub use dem_runner::{self as run, RunSettings, run};

/// The code on the page is compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../doc/inside/adding-a-model.md")]
struct AddingAModel;

#[cfg(doctest)]
#[doc = include_str!("../../../doc/inside/library.md")]
struct Library;
