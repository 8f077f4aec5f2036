//! The stress suite: stiff and extreme scenes, each with a prediction made before its run.
//!
//! [`cases`] -> members, each a [`trial`] (a scene) with a [`prediction`] from a closed form -> the
//! scene is read, planned and run like any other -> [`verdict`]. No scene may go wrong silently: it
//! ends with the right result, is refused before it starts, or is stopped with the cause.

pub(crate) mod adhesion;
pub(crate) mod bars;
mod beside;
pub(crate) mod bonded;
pub(crate) mod breakage;
pub(crate) mod bridges;
pub mod cases;
pub(crate) mod daughters;
pub(crate) mod families;
mod friction;
pub mod impact;
pub(crate) mod joints;
pub mod limit_map;
pub(crate) mod long;
pub(crate) mod oscillator;
pub mod prediction;
pub(crate) mod softening;
pub(crate) mod swap;
pub mod text;
pub mod trial;
pub mod verdict;
pub(crate) mod yielding;
pub(crate) mod zones;
