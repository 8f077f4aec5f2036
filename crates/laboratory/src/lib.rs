//! Laboratory tests: closed forms, and what the force-displacement curves of a test rig say of a
//! material.
//!
//! Data flow: text of a file -> [`Table`] -> [`Curve`] -> [`Regions`] -> [`EvaluatedSpecimen`] ->
//! [`MeasuredMaterial`], which scenes take as their target.

mod area;
mod curve;
mod evaluation;
mod fit;
mod list;
mod material;
mod mean_curve;
mod numbers;
mod page;
mod regions;
mod specimen;
mod statistic;
mod table;
mod target;
pub mod theory;

pub use area::area_between;
pub use curve::{ColumnChoice, Curve};
pub use evaluation::{EvaluatedSpecimen, FAILED, LONGEST_SEATING, MeasuredSpecimen, evaluate};
pub use fit::Line;
pub use list::{ListedSpecimen, read_list};
pub use material::{FORMAT_VERSION, MeasuredMaterial, material};
pub use mean_curve::CurvePoint;
pub use page::{page, regions_plot, statistics};
pub use regions::Regions;
pub use specimen::{Dimensions, Specimen, TestType};
pub use statistic::Statistic;
pub use table::{Column, Table, read_text};
pub use target::{read_material, write_material};
