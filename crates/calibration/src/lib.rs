//! Calibration: numbers of a scene, above all modulus and strength of its bonds, are varied until
//! the mean result of a simulated test over several packings of the body is the wanted one
//! (Platzer 2022, 4.5.1.3).
//!
//! The tests themselves are done by the caller. [`calibrate`] says with which factors on the
//! numbers, and ends when all targets are met, or cannot be met.

mod case;
mod joint;
mod pace;
mod page;
mod record;
mod resolution;
mod response;
mod rounds;
mod search;
mod text;
mod unknown;

pub use case::{Case, End, Round, Start, Trial};
pub use dem_laboratory::half_width;
pub use joint::{
    Aim, Free, JOINT_VERSION, Joint, JointStart, JointTest, calibrate_joint, check_joint_rate,
    joint_origin, joint_page, joint_report, next_of_joint, read_joint, weighted_step, write_joint,
};
pub use pace::pace;
pub use page::{page, sizes};
pub use record::{FORMAT_VERSION, Record, read_record, write_record};
pub use resolution::{coarsest, curve_error};
pub use rounds::{SaveFunction, TestFunction, calibrate, check_rate};
pub use search::{Step, next};
pub use text::{origin, report};
pub use unknown::{Number, Unknown};
