//! The packer from the inside: each stage by itself, and all together on shapes of many kinds.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bonds;
mod helpers;
mod packing;
mod program;
mod quality;
mod sizes;
