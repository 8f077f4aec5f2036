//! The packer from the inside: each stage by itself, and all together on shapes of many kinds.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod depth_map;
mod exact;
mod facets;
mod front;
mod halo;
mod inside;
mod pack;
mod room;
mod seed;
mod settle;
mod solids;
mod union;
mod voids;
