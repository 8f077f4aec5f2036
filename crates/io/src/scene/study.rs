//! A study: a scene, what varies in it, what is measured and against what. Plain data, as read from
//! TOML.

mod check;
mod rewrite;
mod values;

use std::path::{Component, Path, PathBuf};

use super::field::Field;
use super::names::{suggestion, well_formed};
use super::read::{named_path, text_of};
use super::table::Table;
use super::tree::{Document, Value};
use crate::{Diagnostic, Result};

pub use check::{override_text, reference_values, scene_with};
pub use rewrite::rewritten;
use values::MOST_VALUES;

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
    /// `figure`: a figure of the scene's laboratory test.
    Figure(String),
    /// `masses`: how many pieces there are, and how far the distribution of their masses is from
    /// that of the finest run.
    Masses(Pieces),
    /// `curve = "force-displacement"`: the curve of the scene's laboratory test, and how far it is
    /// from that of the finest run.
    Curve,
    /// `ledger`: "energy", "momentum" or "angular-momentum": its largest relative error, which
    /// needs no reference.
    Ledger(&'static str),
}

/// Which pieces' masses are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pieces {
    /// "left": those that went through outlets.
    Left,
    /// "at-end": those that are there at the end of the run.
    AtEnd,
}

/// What a measure is compared with.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference {
    /// "closed-form", unless given: the reference of the scene's measure, or the theory of the
    /// test's figure.
    ClosedForm,
    /// `{ value = ... }`: as written, with or without a unit.
    Value(String),
    /// `{ finest = "AXIS" }`: the run of the smallest size along this axis.
    Finest(usize),
    /// `{ richardson = "AXIS" }`: what the runs along this axis come to at size 0.
    Richardson(usize),
}

const LEDGERS: [(&str, &str); 3] = [
    ("energy", "energy_error"),
    ("momentum", "momentum_error"),
    ("angular-momentum", "angular_momentum_error"),
];

const PIECES: [(&str, Pieces); 2] = [("left", Pieces::Left), ("at-end", Pieces::AtEnd)];

/// The curves of a laboratory test.
const CURVES: [(&str, ()); 1] = [("force-displacement", ())];

const TIMES: [(&str, RunTime); 2] = [("wall", RunTime::Wall), ("processor", RunTime::Processor)];

const COMBINATIONS: [(&str, Combine); 2] = [("grid", Combine::Grid), ("paired", Combine::Paired)];

/// Most axes of a study.
const MOST_AXES: usize = 100;

/// Most repeats, threads.
const MOST: u64 = 1024;

/// Reads a study from a TOML file.
///
/// # Errors
/// The file cannot be read, is no TOML, or no study. The place is file and line.
pub fn read_study(path: &Path) -> Result<Study> {
    study_from_text(&text_of(path, "a study")?, &path.display().to_string())
}

/// Reads a study from the text of a file named `source`.
///
/// # Errors
/// Those of [`read_study`], but for reading the file.
pub fn study_from_text(text: &str, source: &str) -> Result<Study> {
    let document = Document::parse(source, text)?;
    let root = Table::root(&document)?;
    let version = root.need("version", &STUDY_VERSION.to_string())?;
    if version.count(&format!("write version = {STUDY_VERSION}"))? > STUDY_VERSION {
        return Err(version.wrong(&format!("at most {STUDY_VERSION}"), "use a newer program"));
    }
    root.refuse_unknown(&[
        "version",
        "scene",
        "repeats",
        "threads",
        "force_step",
        "time",
        "combine",
        "set",
        "vary",
        "together",
        "measures",
        "page",
    ])?;
    let folder = Path::new(source).parent().unwrap_or(Path::new(""));
    let mut axes = Vec::new();
    if let Some(vary) = root.get("vary") {
        let table = vary.any_table()?;
        for (path, node) in table.entries {
            let mut field = table.field(path, node);
            field.path = format!("vary.\"{path}\"");
            axes.push(values::axis(path, &field, folder)?);
            refuse_many_values(&axes)?;
        }
    }
    for (name, field) in root.named("together")? {
        axes.push(values::together(&name, &field, folder)?);
        refuse_many_values(&axes)?;
    }
    if axes.is_empty() {
        let remedy = "add [vary] with \"run.safety\" = [0.9, 0.5], say";
        return Err(root.refuse("nothing varies", remedy));
    }
    for (at, axis) in axes.iter().enumerate() {
        if let Some(other) = axes[..at].iter().find(|other| sets_same(axis, other)) {
            return Err(Diagnostic::input(
                &axis.place,
                format!("{} is set by {} already", axis.name, other.name),
                "let each path vary once",
            ));
        }
    }
    let fixed = match root.get("set") {
        Some(field) => values::settings(&field, folder)?,
        None => Vec::new(),
    };
    let mut measures = Vec::new();
    for (name, field) in root.named("measures")? {
        measures.push(measure(&name, &field, &axes)?);
    }
    if measures.is_empty() {
        let remedy = "add [measures.NAME] with the name of a measure of the scene";
        return Err(root.refuse("nothing is measured", remedy));
    }
    let series = match root.get("page") {
        Some(page) => page
            .table(&["series"])?
            .read("series", |field| axis_named(&field, &axes))?,
        None => None,
    };
    let count = |key: &str, usual: u32| {
        let remedy = format!("write {key} = {usual}");
        root.read(key, |field| match field.count(&remedy)? {
            // Not above the limit, a u32.
            few @ 0..=MOST => Ok(few as u32),
            _ => Err(field.wrong(&format!("at most {MOST}"), remedy)),
        })
        .map(|given| given.unwrap_or(usual))
    };
    Ok(Study {
        source: source.to_owned(),
        scene: tidy(named_path(&root.need("scene", "\"scene.toml\"")?, folder)?),
        repeats: count("repeats", 3)?,
        threads: count("threads", 1)?,
        force_step: root
            .read("force_step", |field| field.boolean())?
            .unwrap_or_default(),
        time: root
            .read("time", |field| field.choice(&TIMES))?
            .unwrap_or(RunTime::Wall),
        combine: root
            .read("combine", |field| field.choice(&COMBINATIONS))?
            .unwrap_or(Combine::Grid),
        series: series.or_else(|| axes.iter().position(|axis| axis.sizes().is_none())),
        fixed,
        axes,
        measures,
    })
}

/// A path without `folder/..`, where that is the same.
fn tidy(path: PathBuf) -> PathBuf {
    let mut short = PathBuf::new();
    for part in path.components() {
        let leads_down = matches!(short.components().next_back(), Some(Component::Normal(_)));
        if part == Component::ParentDir && leads_down {
            short.pop();
        } else {
            short.push(part);
        }
    }
    match (short.canonicalize(), path.canonicalize()) {
        (Ok(one), Ok(other)) if one == other => short,
        _ => path,
    }
}

/// Refuses the last axis if all have more values than a study can have.
fn refuse_many_values(axes: &[Axis]) -> Result<()> {
    let count: usize = axes.iter().map(|axis| axis.values.len()).sum();
    match axes.last() {
        Some(last) if axes.len() > MOST_AXES => Err(Diagnostic::input(
            &last.place,
            format!("with {} there are more than {MOST_AXES} axes", last.name),
            "join what changes together in [together.NAME]",
        )),
        Some(last) if count as u64 > MOST_VALUES => Err(Diagnostic::input(
            &last.place,
            format!(
                "with {} the axes have {count} values, more than {MOST_VALUES}",
                last.name
            ),
            "vary less, or in several studies",
        )),
        _ => Ok(()),
    }
}

/// Whether two axes set the same path.
fn sets_same(one: &Axis, other: &Axis) -> bool {
    let paths = |axis: &Axis| -> Vec<String> {
        let first = axis.values.first().into_iter();
        first
            .flat_map(|value| value.settings.iter().map(|s| s.path.clone()))
            .collect()
    };
    paths(one).iter().any(|path| paths(other).contains(path))
}

fn axis_named(field: &Field<'_>, axes: &[Axis]) -> Result<usize> {
    let name = field.text()?;
    axes.iter()
        .position(|axis| axis.name == name)
        .ok_or_else(|| {
            let problem = format!("{} is {}, which does not vary", field.path, field.shown());
            field.refuse(
                problem,
                suggestion(name, axes.iter().map(|axis| axis.name.as_str())),
            )
        })
}

fn measure(name: &str, field: &Field<'_>, axes: &[Axis]) -> Result<StudyMeasure> {
    let table = field.table(&[
        "measure",
        "figure",
        "masses",
        "curve",
        "ledger",
        "reference",
    ])?;
    let kinds = ["measure", "figure", "masses", "curve", "ledger"];
    let given: Vec<_> = table.given(&kinds).collect();
    if let [(one, _), (_, other), ..] = given.as_slice() {
        let problem = format!("{} stands beside {one}", other.path);
        return Err(other.refuse(problem, "a measure is of one of them: remove the other"));
    }
    let of = match given.first() {
        None => MeasureOf::Measure(name.to_owned()),
        Some(("measure", field)) => MeasureOf::Measure(field.text()?.to_owned()),
        Some(("figure", field)) => MeasureOf::Figure(field.text()?.to_owned()),
        Some(("masses", field)) => MeasureOf::Masses(field.choice(&PIECES)?),
        Some(("curve", field)) => {
            field.choice(&CURVES)?;
            MeasureOf::Curve
        }
        Some((_, field)) => MeasureOf::Ledger(field.choice(&LEDGERS)?),
    };
    let reference = match table.get("reference") {
        Some(field) if matches!(of, MeasureOf::Ledger(_)) => {
            let problem = format!("{} stands at an error of the ledger", field.path);
            return Err(field.refuse(problem, "it is an error by itself: remove reference"));
        }
        Some(field) => reference(&field, axes)?,
        None => Reference::ClosedForm,
    };
    if let (MeasureOf::Masses(_) | MeasureOf::Curve, false) =
        (&of, matches!(reference, Reference::Finest(_)))
    {
        let problem = format!("{} has no run to be compared with", field.path);
        return Err(field.refuse(problem, "add reference = { finest = \"AXIS\" }"));
    }
    Ok(StudyMeasure {
        name: name.to_owned(),
        of,
        reference,
        place: field.document.place(field.node.origin),
    })
}

fn reference(field: &Field<'_>, axes: &[Axis]) -> Result<Reference> {
    if let Value::Text(word) = &field.node.value {
        let with_size: Vec<usize> = (0..axes.len())
            .filter(|at| axes[*at].sizes().is_some())
            .collect();
        return match (word.as_str(), with_size.as_slice()) {
            ("closed-form", _) => Ok(Reference::ClosedForm),
            ("finest", [only]) => Ok(Reference::Finest(*only)),
            ("richardson", [only]) => richardson(field, *only, axes),
            ("finest" | "richardson", _) => {
                let problem = format!(
                    "{} is \"{word}\", but {} axes have sizes",
                    field.path,
                    with_size.len()
                );
                let remedy = format!("say along which: {{ {word} = \"AXIS\" }}");
                Err(field.refuse(problem, remedy))
            }
            _ => Err(field.wrong(
                "\"closed-form\", \"finest\", \"richardson\" or a table",
                "write a number as { value = \"2 mm\" }",
            )),
        };
    }
    let table = field.table(&["value", "finest", "richardson"])?;
    let given: Vec<_> = table.given(&["value", "finest", "richardson"]).collect();
    let [(kind, named)] = given.as_slice() else {
        let problem = format!("{} names {} references", field.path, given.len());
        return Err(field.refuse(problem, "name one: value, finest or richardson"));
    };
    if *kind == "value" {
        return match &named.node.value {
            Value::Number(written, value) if value.is_finite() => {
                Ok(Reference::Value(written.clone()))
            }
            Value::Text(text) => Ok(Reference::Value(text.clone())),
            _ => Err(named.wrong("a number", "write it with its unit, such as \"2 mm\"")),
        };
    }
    let at = axis_named(named, axes)?;
    if axes[at].sizes().is_none() {
        let problem = format!(
            "{} is {}, whose values have no size above 0",
            named.path,
            named.shown()
        );
        let remedy = "add size = [...], how coarse each of its values is";
        return Err(named.refuse(problem, remedy));
    }
    if *kind == "finest" {
        Ok(Reference::Finest(at))
    } else {
        richardson(named, at, axes)
    }
}

/// Three different sizes are needed to see an order.
fn richardson(field: &Field<'_>, at: usize, axes: &[Axis]) -> Result<Reference> {
    let mut sizes = axes[at].sizes().unwrap_or_default();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    if sizes.len() < 3 {
        let problem = format!(
            "{}: {} has {} sizes, but Richardson extrapolation needs 3",
            field.path,
            axes[at].name,
            sizes.len()
        );
        return Err(field.refuse(problem, "let it vary further, or write \"finest\""));
    }
    Ok(Reference::Richardson(at))
}

/// A key as TOML wants it.
fn key(name: &str) -> String {
    if well_formed(name) {
        name.to_owned()
    } else {
        format!("{name:?}")
    }
}
