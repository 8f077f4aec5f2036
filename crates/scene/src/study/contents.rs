//! The contents of a study, as plain data.

use std::path::PathBuf;

use serde::Serialize;

use crate::schema::Word;

/// Version of the study format.
pub const STUDY_VERSION: u64 = 1;

/// Prefix of a path that stands for the file of a body, as in `--body NAME=FILE`.
pub const BODY: &str = "body.";
/// Prefix of a path that stands for an option of `dem-pack`: `pack.NAME.OPTION`.
pub const PACK: &str = "pack.";

/// A complete study.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// File from which it was read, as named by the user.
    pub source: String,
    /// `scene`, resolved against the folder of the study.
    pub scene: PathBuf,
    /// `repeats`: number of repetitions of each run; see [`Study::repeats`].
    pub repeats: Option<u32>,
    /// `threads` of each run; 1 unless given.
    pub threads: u32,
    /// `force_step`: allows steps above the largest stable one; false unless given.
    pub force_step: bool,
    /// `keep`, "tables" unless given.
    pub keep: Keep,
    /// `time`, "wall" unless given.
    pub time: RunTime,
    /// `combine`, "grid" unless given.
    pub combine: Combine,
    /// `[set]`: values common to all runs.
    pub fixed: Vec<Setting>,
    /// The parameter of `[find]` or those of `[design]` if there is one, `[vary]`, then
    /// `[together.NAME]`, in the order of the file. At least one.
    pub axes: Vec<Axis>,
    /// `[measures.NAME]`, in the order of the file. At least one.
    pub measures: Vec<StudyMeasure>,
    /// `average_over`: the axis over whose values responses are averaged; `run.seed` unless given,
    /// if that varies in a grid.
    pub average_over: Option<usize>,
    /// `statistic`: what responses show of the values along that axis; the mean unless given.
    pub statistic: Average,
    /// `[find]`
    pub find: Option<Find>,
    /// `[pack.NAME]`: bodies that are packed anew.
    pub packs: Vec<Pack>,
    /// The folder of their files.
    pub packings: PathBuf,
    /// `[design]`
    pub design: Option<Design>,
    /// `[probability]`, beside neither of these.
    pub probability: Option<Probability>,
    /// `series` of `[page]`: the axis whose values are distinguished by colour; the first without
    /// sizes unless given.
    pub series: Option<usize>,
}

impl Study {
    /// Number of repetitions of each run: as given, else 3 if a measure is compared with a
    /// reference, for which times are compared, else 1.
    pub fn repeats(&self) -> u32 {
        let is_compared = |measure: &StudyMeasure| measure.reference != Reference::None;
        let usual = if self.measures.iter().any(is_compared) {
            3
        } else {
            1
        };
        self.repeats.unwrap_or(usual)
    }

    /// True if a measure is compared with a reference, so that errors and run times are compared.
    pub fn has_errors(&self) -> bool {
        let mut measures = self.measures.iter();
        measures.any(|measure| measure.reference != Reference::None)
    }

    /// The settings of its first run.
    pub fn first_settings(&self) -> impl Iterator<Item = &Setting> {
        let firsts = self.axes.iter().filter_map(|axis| axis.values.first());
        self.fixed
            .iter()
            .chain(firsts.flat_map(|value| &value.settings))
    }
}

/// A body that is packed anew for each combination of its options.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pack {
    /// Name of the body in the scene.
    pub body: String,
    /// `shape`, resolved against the folder of the study.
    pub shape: PathBuf,
    /// `options` of `dem-pack`, word by word.
    pub options: Vec<String>,
    /// Hash of the shape and of the files among the options.
    pub content: u64,
    /// Its place in the study.
    pub place: String,
}

impl Pack {
    /// The arguments of `dem-pack` with the options among these settings.
    pub fn arguments(&self, settings: &[&Setting]) -> Vec<String> {
        let mut words = vec![self.shape.display().to_string()];
        words.extend(self.options.iter().cloned());
        let own = format!("{PACK}{}.", self.body);
        let options = settings.iter().filter_map(|setting| {
            let option = setting.path.strip_prefix(&own)?;
            // Of "8 mm", as a range of a study writes it, 8mm.
            let value = setting.value.replace(['"', ' '], "");
            Some(format!("--{option}={value}"))
        });
        words.extend(options);
        words
    }
}

/// A search for the value of one parameter at which the mean or median of a measure has a given
/// value, once for each case: each combination of the values of the other axes except the averaged
/// one.
#[derive(Debug, Clone, PartialEq)]
pub struct Find {
    /// `measure`: its index among the measures of the study.
    pub measure: usize,
    /// `value`, as written, with or without a unit.
    pub value: String,
    /// `statistic`: what of the values has it.
    pub statistic: Average,
    /// `from` and `to`: the ends between which the parameter is searched, in `unit`, ascending.
    pub ends: [f64; 2],
    /// `tolerance`: largest width of the interval found, in `unit`, above 0.
    pub tolerance: f64,
    /// Unit of the parameter, as written; empty for plain numbers.
    pub unit: String,
    /// For each case, the points tried: indices of values on the first axis, the two ends first and
    /// then in the order of trial. See [`Study::cases`].
    pub tried: Vec<Vec<usize>>,
    /// Its place in the study.
    pub place: String,
}

/// The probability of an outcome over a parameter, once for each case: each combination of the
/// values of the other axes except the averaged one.
#[derive(Debug, Clone, PartialEq)]
pub struct Probability {
    /// `of`: the index of the measure among those of the study.
    pub measure: usize,
    /// `below` or `above`, as written, with or without a unit.
    pub limit: String,
    /// True for `below`: a run has the outcome if the measure is below the limit.
    pub is_below: bool,
    /// `over`: the index of the axis, whose values are numbers in one unit, two different ones at
    /// least.
    pub over: usize,
    /// `spacing`: true if the curve is one over the logarithm of the parameter, whose values are
    /// above 0.
    pub is_log: bool,
    /// True if a scene refuses values of the parameter below 0, such as heights of a fall.
    pub is_never_negative: bool,
    /// Its place in the study.
    pub place: String,
}

/// Runs in which parameters move within ranges, to rank them by what they change.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// `kind`, and what belongs to it.
    pub kind: DesignKind,
    /// `[design.ranges]`, in the order of the file: the first axes of the study. At least one.
    pub ranges: Vec<DesignRange>,
    /// Its place in the study.
    pub place: String,
}

/// How the parameters of a design move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DesignKind {
    /// "one-at-a-time": each from the base to both ends of its range, the others at the base.
    OneAtATime,
    /// "morris": along trajectories on which each changes once (Morris 1991).
    Morris {
        /// `trajectories`, at least 2.
        trajectories: usize,
        /// `levels` of each range, even.
        levels: usize,
        /// `seed` of the random trajectories.
        seed: u64,
    },
}

/// The range of a parameter of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignRange {
    /// Its ends in `unit`, ascending.
    pub ends: [f64; 2],
    /// Unit as written; empty for plain numbers.
    pub unit: String,
    /// `spacing`: true if levels have equal ratios.
    pub is_log: bool,
    /// `base` in `unit`: the value from which it changes, one at a time; that of the scene unless
    /// given, once [`Study::settle_design`] has read it. None for other designs.
    pub base: Option<f64>,
}

/// What is taken of the values along the averaged axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Average {
    /// "mean".
    Mean,
    /// "median": half of the values lie on either side.
    Median,
}

impl Average {
    /// Its name.
    pub fn word(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Median => "median",
        }
    }
}

/// The time of a run that is compared. Both exclude start-up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunTime {
    /// "wall": from the first step to the last.
    Wall,
    /// "processor": processor time; other programs on the machine affect it less.
    Processor,
}

/// The files of a run that are kept once it has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// "tables": summary, tables, page and scene.
    Tables,
    /// "all": frames, pictures, plots and checkpoint as well.
    All,
}

/// How the values of several axes are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Combine {
    /// "grid": each value with each other.
    Grid,
    /// "paired": the first with the first, the second with the second.
    Paired,
}

/// A value of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Path in the scene, [`BODY`] and a name, or [`PACK`], a name and an option.
    pub path: String,
    /// As TOML; for a body, the name of a file, resolved against the folder of the study.
    pub value: String,
    /// Its place in the study.
    pub place: String,
}

/// A parameter that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Its path, or the name of the paths that vary together.
    pub name: String,
    /// Its place in the study.
    pub place: String,
    /// Values, at least one.
    pub values: Vec<AxisValue>,
    /// True if the study names the values.
    pub named: bool,
}

impl Axis {
    /// The size of each value. None if not all of them have one.
    pub fn sizes(&self) -> Option<Vec<f64>> {
        self.values.iter().map(|value| value.size).collect()
    }

    /// The values as numbers in a common unit, the one in which they are written. None if they are
    /// no numbers or written in several units.
    pub fn numbers(&self) -> Option<(Vec<f64>, String)> {
        let numbers = self.values.iter().map(|value| value.number.as_ref());
        let numbers: Vec<&(f64, String)> = numbers.collect::<Option<_>>()?;
        let with_unit = numbers.iter().find(|(_, unit)| !unit.is_empty());
        let unit = with_unit.map_or("", |(_, unit)| unit);
        // 0 needs no unit.
        let fits =
            |(number, own): &&(f64, String)| own == unit || (*number == 0.0 && own.is_empty());
        numbers
            .iter()
            .all(fits)
            .then(|| (numbers.iter().map(|n| n.0).collect(), unit.to_owned()))
    }
}

/// One of the values of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisValue {
    /// Human-readable label.
    pub label: String,
    /// Its settings: one path, or all paths that vary together.
    pub settings: Vec<Setting>,
    /// Its coarseness, above 0: the value itself if it is a number, unless `size` is given.
    pub size: Option<f64>,
    /// The value as written, if it is a number or a vector along one axis: number and unit.
    pub number: Option<(f64, String)>,
}

/// A quantity evaluated in each run.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyMeasure {
    /// Its name.
    pub name: String,
    /// Its source.
    pub of: MeasureOf,
    /// Its reference.
    pub reference: Reference,
    /// Its place in the study.
    pub place: String,
}

/// The source of a measure of a study.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasureOf {
    /// `measure`: a measure of the scene; the one of the same name unless given.
    Measure(String),
    /// `test_result`: a result of the scene's laboratory test.
    Figure(String),
    /// `fragment_masses`: the number of pieces, and the distance between the distribution of their
    /// masses and that of the finest run.
    Masses(Pieces),
    /// `curve = "force-displacement"`: the curve of the scene's laboratory test, and its distance
    /// from that of the finest run.
    Curve,
    /// `balance`: "energy", "momentum" or "angular-momentum": its largest relative error, which
    /// needs no reference.
    Balance(&'static str),
    /// `run_time`: the time of the steps, s.
    RunTime(RunTime),
    /// `run_result`: one of [`RUN_RESULTS`].
    RunResult(String),
    /// `discharge`: a figure of what left through an outlet, or through all of them.
    Discharge(DischargeFigure, Option<String>),
}

/// A figure of the pieces that left through outlets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DischargeFigure {
    /// "mass": their mass, kg.
    Mass,
    /// "mass-flow": their mass over the time of the run, kg/s.
    MassFlow,
    /// "mass-of-largest": mass of the heaviest, kg.
    MassOfLargest,
    /// "d10", "d50", "d80": sieve size up to which this fraction of the mass is, m.
    Size(f64),
    /// "passing": fraction of the mass that passes a `sieve` with this opening, m.
    Passing(f64),
}

impl DischargeFigure {
    /// The words; "passing" stands for a sieve that is given beside it.
    pub(super) const WORDS: [(&'static str, Self); 7] = [
        ("mass", Self::Mass),
        ("mass-flow", Self::MassFlow),
        ("mass-of-largest", Self::MassOfLargest),
        ("d10", Self::Size(0.1)),
        ("d50", Self::Size(0.5)),
        ("d80", Self::Size(0.8)),
        ("passing", Self::Passing(f64::INFINITY)),
    ];

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Mass | Self::MassOfLargest => "kg",
            Self::MassFlow => "kg/s",
            Self::Size(_) => "m",
            Self::Passing(_) => "",
        }
    }
}

/// The pieces whose masses are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pieces {
    /// "discharged": pieces discharged through outlets.
    Left,
    /// "remaining": pieces present at the end of the run.
    AtEnd,
}

/// The reference of a measure.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference {
    /// Unless given, for a measure of the scene: its reference if it has one, else none. See
    /// [`settle_references`](super::settle_references).
    IfAny,
    /// "none", and unless given for all other measures except balances: the response of the measure
    /// is shown, and no error.
    None,
    /// "closed-form": the reference of the scene's measure, or the theory of the test's result.
    ClosedForm,
    /// `{ value = ... }`: as written, with or without a unit.
    Value(String),
    /// `{ finest = "AXIS" }`: the run of the smallest size along this axis.
    Finest(usize),
    /// `{ richardson = "AXIS" }`: the runs along this axis, extrapolated to size 0.
    Richardson(usize),
}

pub(super) const BALANCES: [(&str, &str); 3] = [
    ("energy", "energy_error"),
    ("momentum", "momentum_error"),
    ("angular-momentum", "angular_momentum_error"),
];

/// Results of every run with fragments, and their units: sieve sizes up to which a fraction of the
/// mass is and t10, of all fragments and of those that left through outlets, to which fines count,
/// and masses.
pub const RUN_RESULTS: [(&str, &str); 11] = [
    ("d10", "m"),
    ("d50", "m"),
    ("d80", "m"),
    ("t10", ""),
    ("discharged_d10", "m"),
    ("discharged_d50", "m"),
    ("discharged_d80", "m"),
    ("discharged_t10", ""),
    ("discharged_mass", "kg"),
    ("fines_mass", "kg"),
    ("mass_fraction_of_largest", ""),
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

impl Word for Keep {
    const WORDS: &'static [(&'static str, Self)] = &[("tables", Self::Tables), ("all", Self::All)];
}

impl Word for Combine {
    const WORDS: &'static [(&'static str, Self)] =
        &[("grid", Self::Grid), ("paired", Self::Paired)];
}
