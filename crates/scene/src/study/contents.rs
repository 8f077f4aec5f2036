//! What a study holds, as plain data.

use std::path::PathBuf;

use crate::schema::Word;

/// Version of the study format.
pub const STUDY_VERSION: u64 = 1;

/// How a path begins that stands for the file of a body, as `--body NAME=FILE` gives it.
pub const BODY: &str = "body.";

/// A whole study.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// File that it was read from, as the user named it.
    pub source: String,
    /// `scene`, resolved against the folder of the study.
    pub scene: PathBuf,
    /// `repeats`: how often each run is done; 3 unless given.
    pub repeats: u32,
    /// `threads` of each run; 1 unless given.
    pub threads: u32,
    /// `force_step`: steps above the largest stable one are taken; not unless given.
    pub force_step: bool,
    /// `time`, "wall" unless given.
    pub time: RunTime,
    /// `combine`, "grid" unless given.
    pub combine: Combine,
    /// `[set]`: what all runs have.
    pub fixed: Vec<Setting>,
    /// `[vary]`, then `[together.NAME]`, in the order of the file. At least one.
    pub axes: Vec<Axis>,
    /// `[measures.NAME]`, in the order of the file. At least one.
    pub measures: Vec<StudyMeasure>,
    /// `series` of `[page]`: the axis whose values have colours; the first without sizes unless
    /// given.
    pub series: Option<usize>,
}

/// Which time of a run is compared. Both leave out start-up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunTime {
    /// "wall": from the first step to the last.
    Wall,
    /// "processor": what processors spent on it; other programs on the machine change it less.
    Processor,
}

/// How the values of several axes meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Combine {
    /// "grid": each with each.
    Grid,
    /// "paired": the first with the first, the second with the second.
    Paired,
}

/// A value of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Path in the scene, or [`BODY`] and a name.
    pub path: String,
    /// As TOML; the name of a file, resolved against the folder of the study, for a body.
    pub value: String,
    /// Where it stands in the study.
    pub place: String,
}

/// Something that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Its path, or the name of the paths that vary together.
    pub name: String,
    /// Where it stands in the study.
    pub place: String,
    /// At least one.
    pub values: Vec<AxisValue>,
}

impl Axis {
    /// The size of each value. None: not all of them have one.
    pub fn sizes(&self) -> Option<Vec<f64>> {
        self.values.iter().map(|value| value.size).collect()
    }
}

/// One of the values of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisValue {
    /// For a person.
    pub label: String,
    /// What it sets: one path, or all that vary together.
    pub settings: Vec<Setting>,
    /// How coarse it is, above 0: the value itself where it is a number, unless `size` says
    /// something else.
    pub size: Option<f64>,
}

/// What is looked at in each run.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyMeasure {
    /// Its name.
    pub name: String,
    /// What it is of.
    pub of: MeasureOf,
    /// What it is compared with.
    pub reference: Reference,
    /// Where it stands in the study.
    pub place: String,
}

/// What a measure of a study is of.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasureOf {
    /// `measure`: a measure of the scene; that of the same name unless given.
    Measure(String),
    /// `test_result`: a result of the scene's laboratory test.
    Figure(String),
    /// `fragment_masses`: how many pieces there are, and how far the distribution of their masses
    /// is from that of the finest run.
    Masses(Pieces),
    /// `curve = "force-displacement"`: the curve of the scene's laboratory test, and how far it is
    /// from that of the finest run.
    Curve,
    /// `balance`: "energy", "momentum" or "angular-momentum": its largest relative error, which
    /// needs no reference.
    Balance(&'static str),
}

/// Which pieces' masses are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pieces {
    /// "discharged": those that went through outlets.
    Left,
    /// "remaining": those that are there at the end of the run.
    AtEnd,
}

/// What a measure is compared with.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference {
    /// "closed-form", unless given: the reference of the scene's measure, or the theory of the
    /// test's result.
    ClosedForm,
    /// `{ value = ... }`: as written, with or without a unit.
    Value(String),
    /// `{ finest = "AXIS" }`: the run of the smallest size along this axis.
    Finest(usize),
    /// `{ richardson = "AXIS" }`: what the runs along this axis come to at size 0.
    Richardson(usize),
}

pub(super) const BALANCES: [(&str, &str); 3] = [
    ("energy", "energy_error"),
    ("momentum", "momentum_error"),
    ("angular-momentum", "angular_momentum_error"),
];

/// The curves of a laboratory test.
pub(super) const CURVES: [(&str, ()); 1] = [("force-displacement", ())];

impl Word for Pieces {
    const WORDS: &'static [(&'static str, Self)] =
        &[("discharged", Self::Left), ("remaining", Self::AtEnd)];
}

impl Word for RunTime {
    const WORDS: &'static [(&'static str, Self)] =
        &[("wall", Self::Wall), ("processor", Self::Processor)];
}

impl Word for Combine {
    const WORDS: &'static [(&'static str, Self)] =
        &[("grid", Self::Grid), ("paired", Self::Paired)];
}
