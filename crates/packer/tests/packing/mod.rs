//! The stages of a packing, and whole packings.

mod depth_map;
mod front;
mod halo;
mod inside;
mod pack;
mod room;
mod seed;
mod settle;
mod union;
mod voids;
