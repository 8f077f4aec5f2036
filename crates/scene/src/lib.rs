//! A scene: the objects and their places, their materials, loads and supports, and the requested
//! results. Plain data in SI units, as read from TOML.
//!
//! Every table of the file has one struct, next to its keys and its reader; names are unique within
//! their table. The reader of the file refuses scenes that cannot be simulated.

mod as_run;
mod blame;
mod bodies;
mod body;
mod bond;
mod clump;
mod clusters;
mod contact;
mod daughters;
mod describe;
mod direction;
mod factor;
mod fall;
mod fall_check;
mod field;
mod group;
mod include;
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
mod renamed;
mod replacement;
mod root;
mod run;
mod schema;
mod search;
mod shape;
mod sleep;
mod statics;
pub mod study;
mod support;
mod table;
mod targets;
mod test;
mod toml_text;
mod tree;
mod values;
mod wall;
mod zone;
mod zone_check;

pub use as_run::{piped_bodies, scene_as_run};
pub use bodies::read_bodies;
pub use body::{BodyEntry, BodySource, PositionOf, WholeMass};
pub use bond::{
    BondDamping, BondFailure, BondKind, BondModel, BondPlasticity, EquivalentStress, Formulation,
    JointElements, StrainRateMeasure,
};
pub use clump::{ClumpMass, ClumpSettings, StartAs};
pub use clusters::Clusters;
pub use contact::{Contact, ContactLaw, Rolling};
pub use daughters::{CountedEnergy, Daughters, SizeClass};
pub use factor::Factor;
pub use fall::Fall;
pub use group::{ParticleGroup, Pick};
pub use include::{include_text, material_text, set_text, written_value};
pub use initial::Initial;
pub use inlet::{FeedRate, Inlet};
pub use load::Load;
pub use material::Material;
pub use measure::{Measure, Quantity, Statistic};
pub use outlet::Outlet;
pub use output::{ColourBy, Output};
pub use paths::text_of;
pub use read::{read_scene, scene_from_text};
pub use region::Region;
pub use relaxation::Relaxation;
pub use replacement::{Replacement, Restore};
pub use root::{SCENE_VERSION, Scene};
pub use run::{InitialOverlap, Integrator, Run, SAFETY};
pub use search::Search;
pub use sleep::Sleep;
pub use support::{Hold, Support};
pub use test::{MeasuredReference, Test};
pub use wall::{Wall, WallMotion, WallShape};
pub use zone::{Rejoin, Zone};
