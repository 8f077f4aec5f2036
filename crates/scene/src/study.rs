//! A study: a scene, the values that vary in it, the measures and their references. Plain data, as
//! read from TOML.

mod check;
mod contents;
mod design;
mod find;
pub(super) mod keys;
mod measures;
mod pack;
mod probability;
mod read;
mod rewrite;
mod values;

pub use check::{override_text, reference_values, scene_with, settle_references, value_to_find};
pub use contents::{
    Average, Axis, AxisValue, BODY, Combine, Design, DesignKind, DesignRange, DischargeFigure,
    Find, Keep, MeasureOf, PACK, Pack, Pieces, Probability, RUN_RESULTS, Reference, RunTime,
    STUDY_VERSION, Setting, Study, StudyMeasure,
};
pub(crate) use keys::STUDY;
pub use read::{read_study, study_from_text};
pub use rewrite::rewritten;
