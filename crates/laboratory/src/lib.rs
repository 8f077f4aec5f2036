//! Laboratory tests: closed forms, what the force-displacement curves of a test rig say of a
//! material, and what [drop-weight tests](drop_weight) say of an ore.
//!
//! Data flow: text of a file -> [`Table`] -> [`Curve`] -> [`Regions`] -> [`EvaluatedSpecimen`] ->
//! [`MeasuredMaterial`], which scenes take as their target.

mod area;
mod clipped;
mod confidence;
mod curve;
pub mod drop_weight;
mod elastic;
mod evaluation;
mod failure_line;
pub mod figure;
mod fit;
mod head;
mod largest;
mod list;
pub mod logistic;
mod material;
mod mean_curve;
mod numbers;
mod outlier;
mod page;
mod regions;
mod residual;
mod specimen;
mod statistic;
mod student;
mod table;
mod target;
pub mod test_result;
pub mod theory;
mod units;

pub use area::area_between;
pub use confidence::half_width;
pub use curve::{ColumnChoice, Curve, FAILED};
pub use elastic::{ELASTIC, elastic_line, elastic_rows};
pub use evaluation::{EvaluatedSpecimen, LONGEST_SEATING, MeasuredSpecimen, evaluate};
pub use failure_line::FailureLine;
pub use fit::Line;
pub use head::Column;
pub use largest::{LargestForce, largest_force};
pub use list::{ListedSpecimen, read_list};
pub use material::{FORMAT_VERSION, MeasuredMaterial, material};
pub use mean_curve::CurvePoint;
pub use page::{Series, page, page_of_series, regions_plot, statistics};
pub use regions::{FALL, Regions};
pub use residual::{has_passed_its_peak, residual_n};
pub use specimen::{Dimensions, Specimen, TestType};
pub use statistic::Statistic;
pub use student::student_95;
pub use table::{Table, read_text};
pub use target::{read_material, write_material};
