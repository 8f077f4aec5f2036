//! Calibration by several tests at once: one material, whose numbers have to give the targets of
//! all tests.

mod page;
mod record;
mod response;
mod rounds;
mod search;
mod squares;
mod state;
mod text;

pub use page::joint_page;
pub use record::{JOINT_VERSION, read_joint, write_joint};
pub use rounds::{calibrate_joint, check_joint_rate};
pub use search::next_of_joint;
pub use squares::weighted_step;
pub use state::{Aim, Free, Joint, JointStart, JointTest};
pub use text::{joint_origin, joint_report};
