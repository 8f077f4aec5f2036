//! Tests for a calibration: what a scene's numbers are to give, and a run with other numbers and
//! another packing.

mod bench;
mod choice;
mod joint;
mod joint_bench;
mod prospect;
mod slopes;
mod start;

pub(crate) use bench::{Bench, overrides};
pub(crate) use choice::{ModulusBy, SceneText, unknowns};
pub(crate) use joint::{TestScene, aims, free_numbers, shared_bonds};
pub(crate) use joint_bench::{JointBeginning, JointBench, TestBodies};
pub(crate) use prospect::{Prospect, prospect};
pub(crate) use start::{Beginning, pace_of};
