//! The keys of a study.

use super::contents::{Average, BALANCES, CURVES, Combine, Keep, Pieces, RunTime};
use crate::schema::{Key, Kind, Schema, Word, words_of};

/// Largest number of threads.
const MOST: f64 = 1024.0;
/// Largest number of repeats.
pub(super) const MOST_REPEATS: u64 = 1024;

/// Any value of a scene.
const ANYTHING: Kind = Kind::Anything("a value");

pub(crate) static STUDY: Schema = Schema {
    title: "",
    doc: "A study: a scene, the settings that vary, the measures, and their references.",
    keys: &[
        Key::whole("version", 1, "Version of the format.")
            .remedy("write version = 1")
            .required("1"),
        Key::text(
            "scene",
            "a file",
            "File of the scene, relative to the folder of the study.",
        )
        .required("\"scene.toml\""),
        Key::whole(
            "repeats",
            1,
            "Number of repetitions of each run; its time is the median.",
        )
        .up_to(MOST_REPEATS as f64)
        .remedy("write repeats = 3")
        .otherwise("3 if a measure has a reference, else 1"),
        Key::whole("threads", 1, "Threads of each run.")
            .up_to(MOST)
            .remedy("write threads = 1")
            .or(1.0),
        Key::flag(
            "force_step",
            false,
            "Allow steps above the largest stable one: `run.time_step`, or a `run.safety_factor` of 1 and more.",
        ),
        Key::word::<Keep>(
            "keep",
            "tables",
            "Files of each run that are kept: `tables` (summary, tables, page, scene) or `all` (frames, pictures, plots and checkpoint as well). Of a run that fails, all are kept.",
        ),
        Key::word::<RunTime>(
            "time",
            "wall",
            "Run time that is compared; `processor` depends less on other programs on the machine.",
        ),
        Key::word::<Combine>(
            "combine",
            "grid",
            "`grid`: every combination of values; `paired`: the first with the first, the second with the second.",
        ),
        Key::new(
            "set",
            Kind::Named("\"TABLE.KEY\"", &ANYTHING),
            "Settings of all runs: paths of the scene as `--set` takes them, or `body.NAME` for the file of a body.",
        ),
        Key::new(
            "vary",
            Kind::Named(
                "\"TABLE.KEY\"",
                &Kind::Either(&[
                    Kind::List(&ANYTHING),
                    Kind::Table(&VALUES),
                    Kind::Table(&RANGE),
                ]),
            ),
            "Settings that vary: paths as in `[set]`, each with its values.",
        ),
        Key::new(
            "together",
            Kind::Named("NAME", &Kind::Open(&TOGETHER, &Kind::List(&ANYTHING))),
            "Paths that change together along one axis, with lists of equal length.",
        ),
        Key::new(
            "measures",
            Kind::Named("NAME", &Kind::Table(&MEASURE)),
            MEASURE.doc,
        )
        .required("{ NAME = {} }"),
        Key::text(
            "average_over",
            "an axis",
            "Axis over which the responses of measures without a reference are averaged; their scatter is shown.",
        )
        .otherwise("`run.seed` if that varies"),
        Key::new(
            "statistic",
            Kind::Word(|| words_of(&AVERAGES)),
            "What the responses show of the values along the axis of `average_over`: their mean with the standard deviation, or their median with the range. `[find]` has its own.",
        )
        .or_word("mean"),
        Key::table("find", &FIND, FIND.doc),
        Key::table("page", &PAGE, PAGE.doc),
    ],
};

pub(super) static FIND: Schema = Schema {
    title: "[find]",
    doc: "Search for the value of a parameter at which the mean or the median of a measure has a given value, by bisection. \
          What else varies, except the axis of `average_over`, makes cases, each with a search of its own.",
    keys: &[
        Key::text(
            "parameter",
            "a path of the scene",
            "The path, as in `[vary]`; its value is a number, with or without its unit.",
        )
        .required("\"bodies.tablet.drop.height\""),
        Key::new("from", ANYTHING, "One end of the range that is searched.").required("\"0.1 m\""),
        Key::new("to", ANYTHING, "Its other end, in the same unit.").required("\"2 m\""),
        Key::text(
            "measure",
            "a measure of the study",
            "The measure, a name in `[measures]`.",
        )
        .required("\"largest\""),
        Key::new("value", ANYTHING, "Its value that is looked for.").required("0.5"),
        Key::new(
            "statistic",
            Kind::Word(|| words_of(&AVERAGES)),
            "What of the values along the axis of `average_over` has that value: their mean, or their median, on either side \
             of which lie half of the runs.",
        )
        .or_word("mean"),
        Key::new(
            "tolerance",
            ANYTHING,
            "Largest width of the interval in which the parameter is found, in the same unit.",
        )
        .required("\"2 cm\""),
    ],
};

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

pub(super) static VALUES: Schema = Schema {
    title: "Values",
    doc: "The values of a path.",
    keys: &[
        Key::new("values", Kind::List(&ANYTHING), "The values.").required("[0.9, 0.5]"),
        SIZE,
        NAMES,
    ],
};

pub(super) static RANGE: Schema = Schema {
    title: "Range",
    doc: "A range of values of a path.",
    keys: &[
        Key::new(
            "from",
            ANYTHING,
            "First value, a number with or without its unit.",
        )
        .required("0.1"),
        Key::new("to", ANYTHING, "Last value, in the same unit.").required("0.9"),
        Key::whole("count", 2, "Number of values, both ends included.").required("5"),
        Key::new(
            "spacing",
            Kind::Word(|| words_of(&SPACINGS)),
            "Spacing of the values.",
        )
        .or_word("linear"),
    ],
};

/// Averages of a search.
pub(super) const AVERAGES: [(&str, Average); 2] =
    [("mean", Average::Mean), ("median", Average::Median)];

/// Spacings of a range; true for logarithmic.
pub(super) const SPACINGS: [(&str, bool); 2] = [("linear", false), ("log", true)];

pub(super) static TOGETHER: Schema = Schema {
    title: "[together.NAME]",
    doc: "Paths that change together: `\"TABLE.KEY\" = [...]`, with equal numbers of values.",
    keys: &[SIZE, NAMES],
};

pub(crate) static MEASURE: Schema = Schema {
    title: "[measures.NAME]",
    doc: "A result of each run: one of `measure`, `test_result`, `fragment_masses`, `curve` and `balance`.",
    keys: &[
        Key::text("measure", "a measure of the scene", "A measure of the scene.")
            .otherwise("that of the same name"),
        Key::text(
            "test_result",
            "a result of the scene's laboratory test",
            "A result of the scene's laboratory test, such as `stiffness`.",
        ),
        Key::new(
            "fragment_masses",
            Kind::Word(|| words_of(Pieces::WORDS)),
            "Masses of the fragments discharged through outlets, or remaining at the end.",
        ),
        Key::new(
            "curve",
            Kind::Word(|| words_of(&CURVES)),
            "The curve of the scene's laboratory test.",
        ),
        Key::new(
            "balance",
            Kind::Word(|| words_of(&BALANCES)),
            "The largest relative error of this balance in the run.",
        ),
        Key::new(
            "reference",
            Kind::Either(&[
                Kind::Word(|| vec!["none", "closed-form", "finest", "richardson"]),
                Kind::Table(&REFERENCE),
            ]),
            "Reference of the error: none, so that the response is shown; that of the scene's measure or the theory of the \
             test's result; a value; the run of the smallest size along an axis; or the extrapolation of the runs to size 0.",
        )
        .otherwise("that of the scene's measure if it has one, else `none`"),
    ],
};

pub(super) static REFERENCE: Schema = Schema {
    title: "Reference",
    doc: "One of these.",
    keys: &[
        Key::new(
            "value",
            ANYTHING,
            "This value, a number with or without its unit.",
        ),
        Key::text(
            "finest",
            "an axis",
            "Run of the smallest size along this axis, all else equal.",
        ),
        Key::text(
            "richardson",
            "an axis",
            "Extrapolation of the values to size 0 from the three finest. Requires three sizes.",
        ),
    ],
};

pub(super) static PAGE: Schema = Schema {
    title: "[page]",
    doc: "Display of the runs on the page.",
    keys: &[Key::text("series", "an axis", "Axis shown by colours.")
        .otherwise("the first that is no number")],
};
