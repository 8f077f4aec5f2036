//! Laboratory tests: closed forms, and what the force-displacement curves of a test rig say of a
//! material.
//!
//! Data flow: text of a file -> [`Table`] -> [`Curve`] -> [`Regions`] -> [`EvaluatedSpecimen`] ->
//! [`MeasuredMaterial`], which scenes take as their target.

mod curve;
mod evaluation;
mod fit;
mod list;
mod mean_curve;
mod numbers;
mod page;
mod regions;
mod specimen;
mod table;
mod target;
pub mod theory;

pub use curve::{ColumnChoice, Curve};
pub use evaluation::{
    EvaluatedSpecimen, FAILED, FORMAT_VERSION, LONGEST_SEATING, MeasuredMaterial, MeasuredSpecimen,
    Statistic, evaluate, material,
};
pub use list::{ListedSpecimen, read_list};
pub use mean_curve::CurvePoint;
pub use page::{page, regions_plot, statistics};
pub use regions::Regions;
pub use specimen::{Dimensions, Specimen, TestType};
pub use table::{Column, Table, read_text};
pub use target::{area_between, read_material, write_material};
