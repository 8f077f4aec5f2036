//! Tests of the packer's internals: each stage separately, and all together on shapes of many
//! kinds.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bonds;
mod density_search;
mod helpers;
mod packing;
mod program;
mod quality;
mod sizes;
