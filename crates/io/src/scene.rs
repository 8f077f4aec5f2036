//! A scene: what stands where, of what, what is done to it and what is asked. Plain data in SI
//! units, as read from TOML.
//!
//! Every table of the file has one struct, beside its keys and its reader; names are unique within
//! their table. The reader of the file refuses what cannot be simulated.

mod bodies;
mod body;
mod bond;
mod clump;
mod clusters;
mod contact;
mod describe;
mod direction;
mod factor;
mod field;
mod initial;
mod inlet;
mod inputs;
mod listing;
mod load;
mod material;
mod measure;
mod names;
mod numbers;
mod outlet;
mod output;
mod overrides;
mod paths;
mod presence;
mod read;
pub mod reference;
mod region;
mod relaxation;
mod replacement;
mod root;
mod run;
mod schema;
mod search;
mod set;
mod shape;
mod sleep;
mod statics;
pub mod study;
mod support;
mod table;
mod targets;
mod test;
mod tree;
mod values;
mod wall;

pub use bodies::read_bodies;
pub use body::{BodyEntry, BodySource, WholeMass};
pub use bond::{BondDamping, BondFailure, BondKind, BondModel, Formulation, RateOf};
pub use clump::{ClumpMass, ClumpSettings, StartAs};
pub use clusters::Clusters;
pub use contact::{Contact, ContactLaw, Rolling};
pub use factor::Factor;
pub use initial::Initial;
pub use inlet::{FeedRate, Inlet};
pub use load::Load;
pub use material::Material;
pub use measure::{At, Measure, Quantity};
pub use outlet::Outlet;
pub use output::Output;
pub use paths::text_of;
pub use read::{read_scene, scene_from_text};
pub use region::Region;
pub use relaxation::Relaxation;
pub use replacement::{Back, Replacement};
pub use root::{SCENE_VERSION, Scene};
pub use run::{Integrator, Run, SAFETY, StartOverlap};
pub use search::Search;
pub use set::{ParticleSet, Pick};
pub use sleep::Sleep;
pub use support::{Hold, Support};
pub use test::{Test, TestKind};
pub use wall::{Wall, WallMotion, WallShape};
