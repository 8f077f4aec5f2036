//! The keys of a study.

use super::contents::{
    Average, BALANCES, CURVES, Combine, DischargeFigure, Keep, Pieces, RUN_RESULTS, RunTime,
};
use crate::schema::{Key, Kind, Word, table_schema, words_of};
use dem_io::units::LENGTH;

/// Largest number of threads.
const MOST: f64 = 1024.0;
/// Largest number of repeats.
pub(super) const MOST_REPEATS: u64 = 1024;

/// Any value of a scene.
const ANYTHING: Kind = Kind::Anything("a value");
/// The values of a path.
const SERIES: Kind = Kind::Either(&[
    Kind::List(&ANYTHING),
    Kind::Table(&VALUES),
    Kind::Table(&RANGE),
]);

table_schema! {
    /// A study: a scene, the settings that vary, the measures, and their references.
    pub(crate) static STUDY = "";

    /// Version of the format.
    whole("version", 1).remedy("write version = 1").required("1");
    /// File of the scene, relative to the folder of the study.
    text("scene", "a file").required("\"scene.toml\"");
    /// Number of repetitions of each run; its time is the median.
    whole("repeats", 1)
        .up_to(MOST_REPEATS as f64)
        .remedy("write repeats = 3")
        .otherwise("3 if a measure has a reference, else 1");
    /// Threads of each run.
    whole("threads", 1).up_to(MOST).remedy("write threads = 1").or(1.0);
    /// Allow steps above the largest stable one: `run.time_step`, or a `run.safety_factor` of 1 and
    /// more.
    flag("force_step", false);
    /// Files of each run that are kept: `tables` (summary, tables, page, scene) or `all` (frames,
    /// pictures, plots and checkpoint as well). Of a run that fails, all are kept.
    word::<Keep>("keep", "tables");
    /// Run time that is compared; `processor` depends less on other programs on the machine.
    word::<RunTime>("time", "wall");
    /// `grid`: every combination of values; `paired`: the first with the first, the second with the
    /// second.
    word::<Combine>("combine", "grid");
    /// Settings of all runs: paths of the scene as `--set` takes them, `body.NAME` for the file of a
    /// body, or `pack.NAME.OPTION` for an option of `dem-pack`.
    new("set", Kind::Named("\"TABLE.KEY\"", &ANYTHING));
    /// Settings that vary: paths as in `[set]`, each with its values.
    new("vary", Kind::Named("\"TABLE.KEY\"", &SERIES));
    /// Paths that change together along one axis, with lists of equal length.
    new("together", Kind::Named("NAME", &Kind::Open(&TOGETHER, &Kind::List(&ANYTHING))));
    named("pack", &Kind::Table(&PACKED));
    named("measures", &Kind::Table(&MEASURE)).required("{ NAME = {} }");
    /// Axis over which the responses of measures without a reference are averaged; their scatter is
    /// shown.
    text("average_over", "an axis").otherwise("`run.seed` or `pack.NAME.seed` if that varies");
    /// What the responses show of the values along the axis of `average_over`: their mean with the
    /// standard deviation, or their median with the range. `[find]` has its own.
    new("statistic", Kind::Word(|| words_of(&AVERAGES))).or_word("mean");
    documented("find", &FIND);
    documented("probability", &PROBABILITY);
    documented("design", &DESIGN);
    documented("page", &PAGE);
}

table_schema! {
    /// The body of this name is packed anew for each combination of its options, in the folder of
    /// the study; runs with the same options share a packing.
    pub(super) static PACKED = "[pack.NAME]";

    /// The shape, relative to the folder of the study.
    text("shape", "a file").required("\"lump.stl\"");
    /// Options of `dem-pack` that all packings have.
    text("options", "options of dem-pack, such as \"--overlap 0.25\"");
}

table_schema! {
    /// Search for the value of a parameter at which the mean or the median of a measure has a given
    /// value, by bisection. What else varies, except the axis of `average_over`, makes cases, each
    /// with a search of its own.
    pub(super) static FIND = "[find]";

    /// The path, as in `[vary]`; its value is a number, with or without its unit.
    text("parameter", "a path of the scene").required("\"bodies.tablet.drop.height\"");
    /// One end of the range that is searched.
    new("from", ANYTHING).required("\"0.1 m\"");
    /// Its other end, in the same unit.
    new("to", ANYTHING).required("\"2 m\"");
    /// The measure, a name in `[measures]`.
    text("measure", "a measure of the study").required("\"largest\"");
    /// Its value that is looked for.
    new("value", ANYTHING).required("0.5");
    /// What of the values along the axis of `average_over` has that value: their mean, or their
    /// median, on either side of which lie half of the runs.
    new("statistic", Kind::Word(|| words_of(&AVERAGES))).or_word("mean");
    /// Largest width of the interval in which the parameter is found, in the same unit.
    new("tolerance", ANYTHING).required("\"2 cm\"");
}

table_schema! {
    /// Probability that a measure is below or above a limit, over a parameter: a logistic curve
    /// through runs with and without this outcome. The runs along the axis of `average_over` show
    /// chance; what else varies makes cases, each with a curve of its own.
    pub(super) static PROBABILITY = "[probability]";

    /// The measure, a name in `[measures]`.
    text("of", "a measure of the study").required("\"largest\"");
    /// A run has the outcome if the measure is below this value.
    new("below", ANYTHING);
    /// A run has the outcome if the measure is above this value.
    new("above", ANYTHING);
    /// The parameter, an axis whose values are numbers in one unit.
    text("over", "an axis").required("\"bodies.tablet.drop.height\"");
    /// Whether the curve is one over the parameter or over its logarithm.
    new("spacing", Kind::Word(|| words_of(&SPACINGS))).or_word("linear");
}

table_schema! {
    /// Runs that show which parameters matter: each moves within a range, and the measures are
    /// compared. Besides the ranges only the axis of `average_over` varies; its scatter is chance.
    pub(super) static DESIGN = "[design]";

    /// `one-at-a-time`: each parameter from the base to both ends of its range; `morris`: random
    /// trajectories on which each parameter changes once (Morris 1991).
    new("kind", Kind::Word(|| words_of(&DESIGN_KINDS))).required("\"morris\"");
    /// Number of trajectories; each has a run more than there are parameters.
    whole("trajectories", 2).up_to(1000.0).or(10.0);
    /// Number of levels of each range, even.
    whole("levels", 2).up_to(100.0).or(4.0);
    /// Seed of the random trajectories.
    whole("seed", 0).or(1.0);
    /// The parameters with their ranges: paths as in `[set]`, each with `[FROM, TO]` or a table.
    new("ranges", Kind::Named("\"TABLE.KEY\"", &DESIGN_ENDS)).required("{ \"run.safety_factor\" = [0.2, 0.8] }");
}

/// The range of a parameter.
const DESIGN_ENDS: Kind = Kind::Either(&[Kind::List(&ANYTHING), Kind::Table(&DESIGN_RANGE)]);

table_schema! {
    /// The range of a parameter of a design.
    pub(super) static DESIGN_RANGE = "Range of a design";

    /// One end, a number with or without its unit.
    new("from", ANYTHING).required("0.1");
    /// The other end, in the same unit.
    new("to", ANYTHING).required("0.9");
    /// Spacing of the levels of `morris`.
    new("spacing", Kind::Word(|| words_of(&SPACINGS))).or_word("linear");
    /// Value from which it changes in `one-at-a-time`, in the same unit.
    new("base", ANYTHING).otherwise("that of the scene");
}

/// Axis over which responses are averaged unless another one is given.
pub(super) const SEED: &str = "run.seed";

/// Designs; true for trajectories.
pub(super) const DESIGN_KINDS: [(&str, bool); 2] = [("one-at-a-time", false), ("morris", true)];

/// Sizes of the values, and their labels.
const SIZE: Key = Key::new(
    "size",
    Kind::List(&ANYTHING),
    "Size of each value, above 0: its coarseness; by default the value itself if it is a number. Required for `finest`, \
     `richardson` and orders.",
);
const NAMES: Key = Key::new(
    "names",
    Kind::List(&Kind::Text("a name")),
    "Label of each value on the page.",
);

table_schema! {
    /// The values of a path.
    pub(super) static VALUES = "Values";

    /// The values.
    new("values", Kind::List(&ANYTHING)).required("[0.9, 0.5]");
    SIZE;
    NAMES;
}

table_schema! {
    /// A range of values of a path.
    pub(super) static RANGE = "Range";

    /// First value, a number with or without its unit.
    new("from", ANYTHING).required("0.1");
    /// Last value, in the same unit.
    new("to", ANYTHING).required("0.9");
    /// Number of values, both ends included.
    whole("count", 2).required("5");
    /// Spacing of the values.
    new("spacing", Kind::Word(|| words_of(&SPACINGS))).or_word("linear");
}

/// Averages of a search.
pub(super) const AVERAGES: [(&str, Average); 2] =
    [("mean", Average::Mean), ("median", Average::Median)];

/// Spacings of a range; true for logarithmic.
pub(super) const SPACINGS: [(&str, bool); 2] = [("linear", false), ("log", true)];

table_schema! {
    /// Paths that change together: `"TABLE.KEY" = [...]`, with equal numbers of values.
    pub(super) static TOGETHER = "[together.NAME]";

    SIZE;
    NAMES;
}

table_schema! {
    /// A result of each run: one of `measure`, `test_result`, `fragment_masses`, `curve`,
    /// `balance`, `run_result`, `discharge` and `run_time`.
    pub(crate) static MEASURE = "[measures.NAME]";

    /// A measure of the scene.
    text("measure", "a measure of the scene").otherwise("that of the same name");
    /// A result of the scene's laboratory test, such as `stiffness`.
    text("test_result", "a result of the scene's laboratory test");
    /// Masses of the fragments discharged through outlets, or remaining at the end.
    new("fragment_masses", Kind::Word(|| words_of(Pieces::WORDS)));
    /// The curve of the scene's laboratory test.
    new("curve", Kind::Word(|| words_of(&CURVES)));
    /// The largest relative error of this balance in the run.
    new("balance", Kind::Word(|| words_of(&BALANCES)));
    /// A result of the fragments: `d50` and so on are sieve sizes up to which a fraction of the
    /// mass is, of all fragments or of those that left through outlets, to which all fines count.
    new("run_result", Kind::Word(|| words_of(&RUN_RESULTS)));
    /// A figure of what left through outlets: mass, mean mass flow, mass of the heaviest piece,
    /// sieve sizes up to which a fraction of the mass is, or the fraction of the mass that passes a
    /// `sieve`. Fines count as the smallest, unless an outlet is named.
    new("discharge", Kind::Word(|| words_of(&DischargeFigure::WORDS)));
    /// The outlet of `discharge`.
    text("outlet", "an outlet of the scene").otherwise("all");
    /// Opening of the sieve of `discharge = "passing"`.
    quantity("sieve", &LENGTH).positive().otherwise("none");
    /// Time of the steps without start-up, s; the median of the repeats.
    new("run_time", Kind::Word(|| words_of(RunTime::WORDS)));
    /// Reference of the error: none, so that the response is shown; that of the scene's measure or
    /// the theory of the test's result; a value; the run of the smallest size along an axis; or the
    /// extrapolation of the runs to size 0.
    new(
        "reference",
        Kind::Either(&[
            Kind::Word(|| vec!["none", "closed-form", "finest", "richardson"]),
            Kind::Table(&REFERENCE),
        ])
    )
    .otherwise("that of the scene's measure if it has one, else `none`");
}

table_schema! {
    /// One of these.
    pub(super) static REFERENCE = "Reference";

    /// This value, a number with or without its unit.
    new("value", ANYTHING);
    /// Run of the smallest size along this axis, all else equal.
    text("finest", "an axis");
    /// Extrapolation of the values to size 0 from the three finest. Requires three sizes.
    text("richardson", "an axis");
}

table_schema! {
    /// Display of the runs on the page.
    pub(super) static PAGE = "[page]";

    /// Axis shown by colours.
    text("series", "an axis").otherwise("the first that is no number");
}
