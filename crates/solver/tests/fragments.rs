//! Fragments taken from a run as bodies, and its frames as files for other programs.

mod all;
mod bodies;
#[path = "../../run/tests/fragments/burst.rs"]
mod burst;
mod strained;
