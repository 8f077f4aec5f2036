//! A study from its text.

use std::path::{Path, PathBuf};

use super::contents::{
    Axis, Combine, Design, Find, PACK, STUDY_VERSION, Setting, Study, StudyMeasure,
};
use super::design;
use super::find;
use super::keys::{DESIGN, FIND, MOST_REPEATS, PAGE, SEED, STUDY};
use super::measures::{axis_named, measure};
use super::pack;
use super::probability;
use super::values::{self, MOST_VALUES, tidy};
use crate::field::Field;
use crate::paths::{named_path, text_of};
use crate::table::Table;
use crate::tree::Document;
use dem_io::diagnostic::{Diagnostic, Result};

/// Largest number of axes of a study.
const MOST_AXES: usize = 100;
/// Largest number of cases of a search.
const MOST_CASES: u64 = 10_000;

/// Reads a study from a TOML file.
pub fn read_study(path: &Path) -> Result<Study> {
    study_from_text(&text_of(path, "a study")?, &path.display().to_string())
}

/// Reads a study from the text of a file named `source`.
pub fn study_from_text(text: &str, source: &str) -> Result<Study> {
    let document = Document::parse(source, text)?;
    let root = Table::root(&document, &STUDY)?;
    if root.read::<u64>("version")? > STUDY_VERSION {
        let version = root.need("version")?;
        return Err(version.wrong(&format!("at most {STUDY_VERSION}"), "use a newer program"));
    }
    root.refuse_unknown()?;
    let folder = Path::new(source).parent().unwrap_or(Path::new(""));
    let find = root.read_by("find", |field| Table::of(&field, &FIND))?;
    let (design, axes) = axes(&root, find.as_ref(), folder)?;
    refuse_set_twice(&axes)?;
    let fixed = fixed(&root, &axes, folder)?;
    let mut measures = measures(&root, &axes)?;
    let combine = root.read("combine")?;
    let average_over = average_over(&root, combine, &axes)?;
    if let Some(design) = &design {
        design::refuse_others(&axes, design.ranges.len(), average_over)?;
        design::without_references(&mut measures)?;
    }
    let find = match find {
        Some(find) => Some(search(&find, &measures, combine, average_over, &axes)?),
        None => None,
    };
    let probability = root.read_by("probability", |field| {
        if find.is_some() {
            let problem = "[probability] has no effect on a study with [find]";
            return Err(field.refuse(problem, "let the parameter vary in another study"));
        }
        probability::read(&field, combine, average_over, &axes, &measures)
    })?;
    let page = root.table("page", &PAGE)?;
    let series = page.read_by("series", |field| axis_named(&field, &axes))?;
    let study = Study {
        source: source.to_owned(),
        scene: tidy(named_path(&root.need("scene")?, folder)?),
        repeats: root.read_by("repeats", repeats)?,
        threads: root.read("threads")?,
        force_step: root.read("force_step")?,
        keep: root.read("keep")?,
        time: root.read("time")?,
        combine,
        average_over,
        statistic: find::statistic(&root)?,
        find,
        design,
        probability,
        series: series.or_else(|| axes.iter().position(|axis| axis.sizes().is_none())),
        packs: pack::packs(&root, folder)?,
        packings: PathBuf::new(),
        fixed,
        axes,
        measures,
    };
    pack::refuse_lost(&study)?;
    Ok(study)
}

/// The axes of `[find]` or `[design]`, `[vary]` and `[together]`, at least one, and the design.
fn axes(
    root: &Table<'_>,
    find: Option<&Table<'_>>,
    folder: &Path,
) -> Result<(Option<Design>, Vec<Axis>)> {
    let design = root.read_by("design", |field| {
        design::read(root, &Table::of(&field, &DESIGN)?)
    })?;
    let (design, mut axes) =
        design.map_or((None, Vec::new()), |(design, axes)| (Some(design), axes));
    if let Some(find) = find {
        axes.push(find::axis(find, folder)?);
    }
    if let Some(vary) = root.get("vary") {
        let table = Table::any(&vary)?;
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
        let remedy = "add [vary] with \"run.safety_factor\" = [0.9, 0.5], say";
        return Err(root.refuse("nothing varies", remedy));
    }
    Ok((design, axes))
}

/// The settings of `[set]`, none of which varies.
fn fixed(root: &Table<'_>, axes: &[Axis], folder: &Path) -> Result<Vec<Setting>> {
    let Some(field) = root.get("set") else {
        return Ok(Vec::new());
    };
    let fixed = values::settings(&field, folder)?;
    let varies = |one: &&Setting| {
        let values = axes.iter().flat_map(|axis| &axis.values);
        let mut varied = values.flat_map(|value| &value.settings);
        varied.any(|setting| setting.path == one.path)
    };
    if let Some(both) = fixed.iter().find(varies) {
        let problem = format!("[set] gives {}, which varies", both.path);
        return Err(field.refuse(problem, "remove it from [set]: it would have no effect"));
    }
    Ok(fixed)
}

/// The measures, at least one.
fn measures(root: &Table<'_>, axes: &[Axis]) -> Result<Vec<StudyMeasure>> {
    let named = root.named("measures")?.into_iter();
    let measures = named.map(|(name, field)| measure(&name, &field, axes));
    let measures: Vec<StudyMeasure> = measures.collect::<Result<_>>()?;
    if measures.is_empty() {
        let remedy = "add [measures.NAME] with the name of a measure of the scene";
        return Err(root.refuse("nothing is measured", remedy));
    }
    Ok(measures)
}

/// The search of `[find]`, for each combination of the values of the other axes.
fn search(
    table: &Table<'_>,
    measures: &[StudyMeasure],
    combine: Combine,
    average_over: Option<usize>,
    axes: &[Axis],
) -> Result<Find> {
    find::refuse_pairs_and_means(table, combine, average_over)?;
    let others = (1..axes.len()).filter(|at| Some(*at) != average_over);
    let lengths = others.map(|at| axes[at].values.len() as u64);
    let cases = lengths.fold(1, u64::saturating_mul);
    if cases > MOST_CASES {
        let problem = format!("{cases} cases are more than {MOST_CASES}");
        return Err(table.refuse(problem, "vary less, or in several studies"));
    }
    find::search(table, measures, cases as usize)
}

fn repeats(field: Field<'_>) -> Result<u32> {
    let number = field.whole(1, Some(MOST_REPEATS), "write repeats = 3")?;
    // Not above the limit.
    Ok(number as u32)
}

/// The axis over which responses are averaged.
fn average_over(root: &Table<'_>, combine: Combine, axes: &[Axis]) -> Result<Option<usize>> {
    let Some(field) = root.get("average_over") else {
        let is_packing = |name: &str| name.starts_with(PACK) && name.ends_with(".seed");
        let of_packings = || axes.iter().position(|axis| is_packing(&axis.name));
        let seeds = axes.iter().position(|axis| axis.name == SEED);
        let seeds = seeds.or_else(of_packings);
        return Ok(seeds.filter(|_| combine == Combine::Grid));
    };
    if combine == Combine::Paired {
        let problem = format!("{} has no effect on pairs of values", field.path);
        return Err(field.refuse(problem, "write combine = \"grid\", or remove it"));
    }
    axis_named(&field, axes).map(Some)
}

/// Refuses the last axis if the number of values of all exceeds the limit of a study.
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

/// Refuses an axis that sets a path of another one before it.
fn refuse_set_twice(axes: &[Axis]) -> Result<()> {
    for (at, axis) in axes.iter().enumerate() {
        if let Some(other) = axes[..at].iter().find(|other| sets_same(axis, other)) {
            return Err(Diagnostic::input(
                &axis.place,
                format!("{} is set by {} already", axis.name, other.name),
                "let each path vary once",
            ));
        }
    }
    Ok(())
}

/// True if two axes set the same path.
fn sets_same(one: &Axis, other: &Axis) -> bool {
    let paths = |axis: &Axis| -> Vec<String> {
        let first = axis.values.first().into_iter();
        first
            .flat_map(|value| value.settings.iter().map(|s| s.path.clone()))
            .collect()
    };
    paths(one).iter().any(|path| paths(other).contains(path))
}
