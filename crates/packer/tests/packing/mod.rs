//! The stages of a packing, and complete packings.

mod depth_map;
mod front;
mod halo;
mod inside;
mod near;
mod pack;
mod seed;
mod settle;
mod shrink;
mod union;
mod voids;
