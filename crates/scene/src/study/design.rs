//! `[design]`: the ranges in which parameters move to show which of them matter, and in which runs.

use super::contents::{
    Axis, AxisValue, BODY, Design, DesignKind, DesignRange, PACK, Reference, Study, StudyMeasure,
};
use super::keys::{DESIGN_KINDS, DESIGN_RANGE, SEED, SPACINGS};
use super::values::{in_si, named, point, rounded, setting};
use crate::field::Field;
use crate::include::document_of;
use crate::root::SCENE;
use crate::table::Table;
use crate::toml_text::split;
use crate::tree::{Value, shortened};
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::units::significant;

/// Keys of a study that mean nothing beside `[design]`.
const WITHOUT_EFFECT: [&str; 5] = ["find", "probability", "combine", "statistic", "page"];
/// Largest number of trajectories, and of levels.
const MOST_TRAJECTORIES: u64 = 1000;
const MOST_LEVELS: u64 = 100;

/// The design of a study, and an axis for each of its ranges. Until [`Study::settle_design`] the
/// axes of a one-at-a-time design lack the values of the scene.
pub(super) fn read(root: &Table<'_>, table: &Table<'_>) -> Result<(Design, Vec<Axis>)> {
    if let Some((key, field)) = root.given(&WITHOUT_EFFECT).next() {
        let problem = format!("{key} has no effect on a study with [design]");
        return Err(field.refuse(problem, format!("remove {key}")));
    }
    let kind = kind(table)?;
    let mut axes = Vec::new();
    let mut ranges = Vec::new();
    let given = table.need("ranges")?;
    for (path, node) in Table::any(&given)?.entries {
        let mut field = table.field(path, node);
        field.path = format!("design.ranges.\"{path}\"");
        let range = range(path, &field, kind)?;
        axes.push(axis(path, &field, &range, kind));
        ranges.push(range);
    }
    if axes.is_empty() {
        let remedy = "add [design.ranges] with \"run.safety_factor\" = [0.2, 0.8], say";
        return Err(table.refuse("the design has no ranges", remedy));
    }
    let design = Design {
        kind,
        ranges,
        place: table.document.place(table.origin),
    };
    Ok((design, axes))
}

fn kind(table: &Table<'_>) -> Result<DesignKind> {
    let given = table.need("kind")?;
    if !given.choice(&DESIGN_KINDS)? {
        if let Some((key, field)) = table.given(&["trajectories", "levels", "seed"]).next() {
            let problem = format!("design.{key} has no effect on changes one at a time");
            let remedy = format!("remove {key}, or write kind = \"morris\"");
            return Err(field.refuse(problem, remedy));
        }
        return Ok(DesignKind::OneAtATime);
    }
    let whole = |key: &str, least: u64, most: u64, usual: u64, remedy: &str| {
        let read = |field: Field<'_>| field.whole(least, Some(most), remedy);
        Ok(table.read_by(key, read)?.unwrap_or(usual))
    };
    let levels = whole(
        "levels",
        2,
        MOST_LEVELS,
        4,
        "4 are usual, 6 or 8 with more trajectories",
    )?;
    if let Some(field) = table.get("levels").filter(|_| levels % 2 == 1) {
        // With an odd number a step of about half the range would not reach all levels alike.
        return Err(field.wrong("an even number", "write levels = 4"));
    }
    Ok(DesignKind::Morris {
        trajectories: whole(
            "trajectories",
            2,
            MOST_TRAJECTORIES,
            10,
            "write trajectories = 10: their scatter shows how sure the ranking is",
        )? as usize,
        levels: levels as usize,
        seed: whole("seed", 0, u64::MAX, 1, "write seed = 1")?,
    })
}

/// The range of one path: `[from, to]`, or `{ from, to, spacing, base }`.
fn range(path: &str, field: &Field<'_>, kind: DesignKind) -> Result<DesignRange> {
    if path == SEED {
        let problem = format!("{SEED} has no range: it stands for chance");
        let remedy = format!(
            "list seeds in [vary], such as \"{SEED}\" = [1, 2, 3]: the effects of the others are means over them"
        );
        return Err(field.refuse(problem, remedy));
    }
    let (from, to, table) = match &field.node.value {
        Value::List(_) => match field.items()?.as_slice() {
            [from, to] => (from.clone(), to.clone(), None),
            others => {
                let problem = format!("has {} values, but a range has two ends", others.len());
                return Err(field.fault(problem, "write [0.2, 0.6], say"));
            }
        },
        Value::Table(_) => {
            let table = Table::of(field, &DESIGN_RANGE)?;
            (table.need("from")?, table.need("to")?, Some(table))
        }
        _ => return Err(field.wrong("a range", "write [0.2, 0.6], say")),
    };
    let (first, unit) = number(&from, None)?;
    let (last, _) = number(&to, Some(&unit))?;
    if first == last {
        return Err(field.fault(
            "has two equal ends",
            "give two different ones, or move it to [set]",
        ));
    }
    let ends = [first.min(last), first.max(last)];
    let get = |key: &str| table.as_ref().and_then(|table| table.get(key));
    let mut is_log = false;
    if let Some(spacing) = get("spacing") {
        if kind == DesignKind::OneAtATime {
            let problem = "has no effect on changes one at a time";
            return Err(spacing.fault(problem, "remove it, or write kind = \"morris\""));
        }
        is_log = spacing.choice(&SPACINGS)?;
    }
    if is_log && ends[0] <= 0.0 {
        let problem = "has no logarithm at 0 and below";
        return Err(field.fault(problem, "write spacing = \"linear\", or ends above 0"));
    }
    let base = match get("base") {
        Some(base) if kind != DesignKind::OneAtATime => {
            let problem = "has no effect on trajectories, which begin anywhere";
            return Err(base.fault(problem, "remove it, or write kind = \"one-at-a-time\""));
        }
        Some(base) => {
            let (number, _) = number(&base, Some(&unit))?;
            if !(ends[0]..=ends[1]).contains(&number) {
                let limit = format!("from {} to {} {unit}", ends[0], ends[1]);
                return Err(base.wrong(limit.trim_end(), "widen the range, or correct the base"));
            }
            Some(number)
        }
        None => None,
    };
    // Refuses what is no path.
    setting(path, &from, std::path::Path::new(""))?;
    Ok(DesignRange {
        ends,
        unit,
        is_log,
        base,
    })
}

/// A number and its unit, which must be `unit` if that is given.
fn number(field: &Field<'_>, unit: Option<&str>) -> Result<(f64, String)> {
    let Some((value, own)) = split(field.node) else {
        let remedy =
            "only numbers have a range: give words, true and false by [set], one study for each";
        return Err(field.wrong("a number", remedy));
    };
    match unit {
        Some(unit) if unit != own => {
            let problem = format!(
                "is in {}, but the range begins in {}",
                named(&own),
                named(unit)
            );
            Err(field.fault(problem, "write all its numbers in the same unit"))
        }
        _ => Ok((value, own)),
    }
}

/// The values of a range: its levels, or its ends and the base between them.
fn axis(path: &str, field: &Field<'_>, range: &DesignRange, kind: DesignKind) -> Axis {
    let place = field.document.place(field.node.origin);
    let numbers = match kind {
        DesignKind::Morris { levels, .. } => range.levels(levels),
        DesignKind::OneAtATime => range.around_base(),
    };
    Axis {
        name: path.to_owned(),
        values: values(path, &numbers, &range.unit, &place),
        place,
        named: false,
    }
}

fn values(path: &str, numbers: &[f64], unit: &str, place: &str) -> Vec<AxisValue> {
    let value = |number: &f64| point(path, *number, unit, place);
    numbers.iter().map(value).collect()
}

impl DesignRange {
    /// Values at equal steps from end to end, or at equal ratios, in its unit, rounded to six
    /// digits between the ends.
    pub fn levels(&self, count: usize) -> Vec<f64> {
        let [low, high] = self.ends;
        let last = count.saturating_sub(1);
        let level = |at: usize| {
            let fraction = at as f64 / last as f64;
            match at {
                0 => low,
                at if at == last => high,
                _ if self.is_log => rounded(low * (high / low).powf(fraction)),
                _ => rounded(low + (high - low) * fraction),
            }
        };
        (0..count).map(level).collect()
    }

    /// Its ends and the base, ascending; the base may be an end.
    pub fn around_base(&self) -> Vec<f64> {
        let [low, high] = self.ends;
        let between = self.base.filter(|base| low < *base && *base < high);
        [Some(low), between, Some(high)]
            .into_iter()
            .flatten()
            .collect()
    }

    /// Index of the base among [`around_base`](Self::around_base).
    pub fn base_index(&self) -> usize {
        let values = self.around_base();
        let is_base = |value: &f64| Some(*value) == self.base;
        values.iter().position(is_base).unwrap_or(0)
    }
}

/// Refuses what varies besides the ranges of a design and the axis that is averaged over.
pub(super) fn refuse_others(
    axes: &[Axis],
    ranges: usize,
    average_over: Option<usize>,
) -> Result<()> {
    if let Some(averaged) = average_over.filter(|at| *at < ranges) {
        return Err(Diagnostic::input(
            &axes[averaged].place,
            format!(
                "average_over names {}, a range of [design]",
                axes[averaged].name
            ),
            "name what the scatter comes from, such as run.seed, with its values in [vary]",
        ));
    }
    let is_other = |at: &usize| Some(*at) != average_over;
    match (ranges..axes.len()).find(is_other) {
        None => Ok(()),
        Some(other) => Err(Diagnostic::input(
            &axes[other].place,
            format!("{} varies beside [design]", axes[other].name),
            "move it into [design.ranges] or [set], or name it in average_over if it stands for chance",
        )),
    }
}

/// Refuses references, and gives balances none: a design ranks values.
pub(super) fn without_references(measures: &mut [StudyMeasure]) -> Result<()> {
    for measure in measures {
        match measure.reference {
            Reference::IfAny | Reference::None | Reference::ClosedForm => {
                measure.reference = Reference::None;
            }
            Reference::Value(_) | Reference::Finest(_) | Reference::Richardson(_) => {
                return Err(Diagnostic::input(
                    &measure.place,
                    format!(
                        "measures.{} has a reference, but [design] ranks values, not errors",
                        measure.name
                    ),
                    "remove reference",
                ));
            }
        }
    }
    Ok(())
}

impl Study {
    /// Takes the base of each range of a one-at-a-time design that names none from the scene, whose
    /// file has the text `scene`, with `[set]` of the study.
    ///
    /// # Errors
    /// The scene has no number there, or one outside of the range.
    pub fn settle_design(&mut self, scene: &str) -> Result<()> {
        let is_settled = |design: &Design| {
            design.kind != DesignKind::OneAtATime || design.ranges.iter().all(|r| r.base.is_some())
        };
        if self.design.as_ref().is_none_or(is_settled) {
            return Ok(());
        }
        let is_of_scene =
            |s: &&super::contents::Setting| !s.path.starts_with(PACK) && !s.path.starts_with(BODY);
        let of_scene = self.fixed.iter().filter(is_of_scene);
        let set: Vec<String> = of_scene.map(super::check::override_text).collect();
        let name = self.scene.display().to_string();
        // What is wrong with it is said when the scenes of all runs are checked.
        let Ok((document, _)) = document_of(scene, &name, &set) else {
            return Ok(());
        };
        let root = Table::root(&document, &SCENE)?;
        let ranges = self.design.iter_mut().flat_map(|design| &mut design.ranges);
        for (range, axis) in ranges.zip(&mut self.axes) {
            if range.base.is_none() {
                range.base = Some(base_of_scene(&root, axis, range, &name)?);
                let numbers = range.around_base();
                axis.values = values(&axis.name, &numbers, &range.unit, &axis.place);
            }
        }
        Ok(())
    }
}

/// The value of the scene for a range, in its unit.
fn base_of_scene(root: &Table<'_>, axis: &Axis, range: &DesignRange, scene: &str) -> Result<f64> {
    let keys: Vec<&str> = axis.name.split('.').collect();
    let path = &axis.name;
    let remedy = format!(
        "add the value from which it changes: {{ from = ..., to = ..., base = ... }} for {path}"
    );
    let refuse = |problem: String| Err(Diagnostic::input(&axis.place, problem, remedy.clone()));
    let Some(field) = root.find(&keys) else {
        return refuse(format!("the scene {scene} does not give {path}"));
    };
    let Some((number, unit)) = split(field.node) else {
        return refuse(format!(
            "{path} of the scene {scene} is no number: {}",
            shortened(&field.shown(), 40)
        ));
    };
    let number = if unit == range.unit {
        number
    } else {
        let units = [format!("{number} {unit}"), format!("1 {}", range.unit)];
        match units.map(|text| in_si(text.trim_end())) {
            [Some(value_si), Some(unit_si)] => rounded(value_si / unit_si),
            _ => return refuse(format!("{path} of the scene {scene} is {}", field.shown())),
        }
    };
    let [low, high] = range.ends;
    if !(low..=high).contains(&number) {
        let shown = |value: f64| significant(value, 6);
        return refuse(format!(
            "{path} of the scene {scene} is {} {}, outside of the range from {} to {}",
            shown(number),
            range.unit,
            shown(low),
            shown(high)
        ));
    }
    Ok(number)
}
