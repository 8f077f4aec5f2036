//! The parameters that vary, and their values: lists, ranges, several paths together.

use std::path::{Component, Path, PathBuf};

use super::contents::{Axis, AxisValue, BODY, Setting};
use super::keys::{RANGE, SPACINGS, TOGETHER, VALUES};
use crate::field::Field;
use crate::table::Table;
use crate::toml_text::{quoted, split, toml};
use crate::tree::{Node, Value, shortened};
use dem_io::diagnostic::Result;
use dem_io::units::{DIMENSIONS, quantity};

/// Largest number of values of a range, and of all axes of a study.
pub(super) const MOST_VALUES: u64 = 100_000;
/// Longest label, in characters.
const LONGEST_LABEL: usize = 40;

/// The axis of one path: a list, `{ values, size, names }`, or `{ from, to, count, spacing }`.
pub(super) fn axis(path: &str, field: &Field<'_>, folder: &Path) -> Result<Axis> {
    let place = field.document.place(field.node.origin);
    let (nodes, size, names) = match &field.node.value {
        Value::List(_) => (field.items()?, None, None),
        Value::Table(entries) if entries.iter().any(|(key, _)| key == "from") => {
            let values = range(path, field)?;
            return Ok(Axis {
                name: path.to_owned(),
                values: values
                    .into_iter()
                    .map(|(number, unit)| point(path, number, &unit, &place))
                    .collect(),
                place,
                named: false,
            });
        }
        Value::Table(entries) if entries.iter().any(|(key, _)| key == "values") => {
            let table = Table::of(field, &VALUES)?;
            let values = table.need("values")?.items()?;
            (values, table.get("size"), table.get("names"))
        }
        Value::Table(_) => {
            let remedy = "write its path in quotes, such as \"run.safety_factor\" = [0.9, 0.5]";
            return Err(field.fault("is neither a list nor a range", remedy));
        }
        _ => {
            let remedy = "write [0.9, 0.5] or { from = 0.1, to = 0.9, count = 5 }; what does not vary belongs into [set]";
            return Err(field.wrong("a list or a range", remedy));
        }
    };
    let mut values = Vec::new();
    let only = only_difference(&nodes);
    for item in &nodes {
        values.push(AxisValue {
            settings: vec![setting(path, item, folder)?],
            ..of_node(item.node, only.as_ref())
        });
    }
    tell_apart(&mut values, &nodes);
    with_sizes(&mut values, size.as_ref(), names.as_ref())?;
    Ok(Axis {
        name: path.to_owned(),
        place,
        values,
        named: names.is_some(),
    })
}

/// The axis of several paths that change together: lists of the same length, and perhaps `size` and
/// `names`.
pub(super) fn together(name: &str, field: &Field<'_>, folder: &Path) -> Result<Axis> {
    let table = Table::any(field)?;
    let mut values: Vec<AxisValue> = Vec::new();
    for (path, node) in table.entries {
        if TOGETHER.key(path).is_some() {
            continue;
        }
        let list = table.field(path, node);
        let items = list.items()?;
        if values.is_empty() {
            let only = only_difference(&items);
            let nodes = items.iter().map(|item| of_node(item.node, only.as_ref()));
            values = nodes.collect();
            tell_apart(&mut values, &items);
        } else if items.len() != values.len() {
            let limit = format!("a list of {}, as the one before it", values.len());
            return Err(list.wrong(&limit, "give each path as many values"));
        }
        for (value, item) in values.iter_mut().zip(&items) {
            value.settings.push(setting(path, item, folder)?);
        }
    }
    if values.is_empty() {
        let problem = "names no path";
        return Err(field.fault(problem, "add \"run.safety_factor\" = [0.9, 0.5], say"));
    }
    let [size, names] = ["size", "names"].map(|key| table.get(key));
    with_sizes(&mut values, size.as_ref(), names.as_ref())?;
    Ok(Axis {
        name: name.to_owned(),
        place: field.document.place(field.node.origin),
        values,
        named: names.is_some(),
    })
}

/// The settings of a table of paths.
pub(super) fn settings(field: &Field<'_>, folder: &Path) -> Result<Vec<Setting>> {
    let table = Table::any(field)?;
    let settings = table.entries.iter();
    settings
        .map(|(path, node)| {
            let field = table.field(path, node);
            if matches!(node.value, Value::Table(_)) && !path.contains('.') {
                let remedy = "write its path in quotes, such as \"run.safety_factor\" = 0.5";
                return Err(field.fault("is no path into a table of the scene", remedy));
            }
            setting(path, &field, folder)
        })
        .collect()
}

/// The value of `path` that is this number in this unit, rounded to six digits.
pub(super) fn point(path: &str, number: f64, unit: &str, place: &str) -> AxisValue {
    let written = shown(number);
    let (value, label) = if unit.is_empty() {
        (written.clone(), written)
    } else {
        let label = format!("{written} {unit}");
        (quoted(&label), label)
    };
    AxisValue {
        size: size_of_text(&label),
        label,
        settings: vec![Setting {
            path: path.to_owned(),
            value,
            place: place.to_owned(),
        }],
        number: Some((number, unit.to_owned())),
    }
}

/// The part in which the values of an axis differ.
enum Part {
    /// A component of vectors.
    Component(usize),
    /// A key of inline tables.
    Key(String),
}

/// A value without its settings, shown by its part `only`.
fn of_node(node: &Node, only: Option<&Part>) -> AxisValue {
    let shown = only.and_then(|only| part(node, only)).unwrap_or(node);
    AxisValue {
        label: label(shown),
        settings: Vec::new(),
        size: size_of(node),
        number: split(shown),
    }
}

/// Gives files of the same name their whole paths as labels.
fn tell_apart(values: &mut [AxisValue], items: &[Field<'_>]) {
    let labels: Vec<String> = values.iter().map(|value| value.label.clone()).collect();
    for (value, item) in values.iter_mut().zip(items) {
        let alike = labels.iter().filter(|label| **label == value.label);
        if let (Value::Text(text), true) = (&item.node.value, alike.count() > 1) {
            value.label.clone_from(text);
        }
    }
}

/// The one part in which values differ, if all else is equal in all of them: the angle of rotations
/// about one axis, or the component of vectors whose others are 0.
fn only_difference(values: &[Field<'_>]) -> Option<Part> {
    let component = only_component(values).map(Part::Component);
    component.or_else(|| only_key(values).map(Part::Key))
}

/// 2 for `[0, 0, "1 m/s"]`.
fn only_component(values: &[Field<'_>]) -> Option<usize> {
    let is_zero = |node: &Node| split(node).is_some_and(|(number, _)| number == 0.0);
    let fits = |at: usize| {
        values.iter().all(|value| match &value.node.value {
            Value::List(items) if items.len() == 3 => {
                let mut others = items.iter().enumerate().filter(|(other, _)| *other != at);
                others.all(|(_, node)| is_zero(node)) && split(&items[at]).is_some()
            }
            _ => false,
        })
    };
    (0..3).find(|at| fits(*at))
}

/// `angle` for `{ axis = [1, 0, 0], angle = "24 deg" }`.
fn only_key(values: &[Field<'_>]) -> Option<String> {
    let tables = values.iter().map(|value| match &value.node.value {
        Value::Table(entries) => Some(entries),
        _ => None,
    });
    let tables: Vec<_> = tables.collect::<Option<_>>()?;
    let (first, others) = tables.split_first()?;
    let is_equal = |key: &str, node: &Node| {
        let same = |(other, value): &(String, Node)| other == key && toml(value) == toml(node);
        others.iter().all(|table| table.iter().any(same))
    };
    let mut differ = first.iter().filter(|(key, node)| !is_equal(key, node));
    let (key, _) = differ.next()?;
    let all_have = others
        .iter()
        .all(|table| table.len() == first.len() && table.iter().any(|(other, _)| other == key));
    (all_have && differ.next().is_none()).then(|| key.clone())
}

/// A part of a value.
fn part<'a>(node: &'a Node, part: &Part) -> Option<&'a Node> {
    match (&node.value, part) {
        (Value::List(items), Part::Component(at)) => items.get(*at),
        (Value::Table(entries), Part::Key(key)) => {
            let entry = entries.iter().find(|(other, _)| other == key);
            entry.map(|(_, node)| node)
        }
        _ => None,
    }
}

pub(super) fn setting(path: &str, field: &Field<'_>, folder: &Path) -> Result<Setting> {
    let is_path = path.split('.').all(|key| !key.is_empty());
    if !is_path || !path.contains('.') || path.contains('=') {
        let problem = format!("\"{}\" is no path of a scene", shortened(path, 40));
        let remedy = "write TABLE.KEY, such as run.safety_factor or body.NAME";
        return Err(field.refuse(problem, remedy));
    }
    let value = if path.starts_with(BODY) {
        let name = field.text()?;
        if name.trim().is_empty() || name == "-" {
            return Err(field.wrong("the name of a file", "write a name such as \"cake.vtp\""));
        }
        tidy_body(folder.join(name)).display().to_string()
    } else {
        toml(field.node)
    };
    Ok(Setting {
        path: path.to_owned(),
        value,
        place: field.document.place(field.node.origin),
    })
}

/// The same for a body, which may consist of two files with other names: its folder is normalised.
fn tidy_body(path: PathBuf) -> PathBuf {
    match (path.parent(), path.file_name()) {
        (Some(folder), Some(name)) => tidy(folder.to_owned()).join(name),
        _ => path,
    }
}

/// Gives the values the sizes and names of two lists of the same length.
fn with_sizes(
    values: &mut [AxisValue],
    size: Option<&Field<'_>>,
    names: Option<&Field<'_>>,
) -> Result<()> {
    let items = |list: &Field<'_>, count: usize| {
        let items = list.items().map(|items| items.len());
        match items {
            Ok(found) if found != count => Err(list.wrong(
                &format!("a list of {count}, one for each value"),
                "give as many",
            )),
            _ => list.items().map(drop),
        }
    };
    if let Some(list) = size {
        items(list, values.len())?;
        for (value, item) in values.iter_mut().zip(list.items()?) {
            value.size = Some(size_of(item.node).ok_or_else(|| {
                item.wrong("a size of more than 0", "write how coarse the value is")
            })?);
        }
    }
    if let Some(list) = names {
        items(list, values.len())?;
        for (value, item) in values.iter_mut().zip(list.items()?) {
            item.text()?.clone_into(&mut value.label);
        }
    }
    Ok(())
}

/// The values of `{ from, to, count, spacing }` and their unit.
fn range(path: &str, field: &Field<'_>) -> Result<Vec<(f64, String)>> {
    let table = Table::of(field, &RANGE)?;
    let [from, to] = [table.need("from")?, table.need("to")?];
    let ends = [&from, &to].map(|end| {
        split(end.node).ok_or_else(|| {
            let remedy = format!("write it as {path} wants it, such as \"1 us\" or 0.5");
            end.wrong("a number", remedy)
        })
    });
    let [(first, unit), (last, unit_of_last)] = match ends {
        [Ok(first), Ok(last)] => [first, last],
        [Err(error), _] | [_, Err(error)] => return Err(error),
    };
    if unit != unit_of_last {
        let problem = format!(
            "is in {}, but {} in {}",
            named(&unit_of_last),
            from.path,
            named(&unit)
        );
        return Err(to.fault(problem, "write both in the same unit"));
    }
    let counted = table.need("count")?;
    let remedy = "write how many values there are, both ends among them";
    let count = counted.whole(1, None, remedy)?;
    if !(2..=MOST_VALUES).contains(&count) {
        let limit = format!("from 2 to {MOST_VALUES}");
        return Err(counted.wrong(&limit, "write how many values there are"));
    }
    let log = table
        .read_by("spacing", |field| field.choice(&SPACINGS))?
        .unwrap_or(false);
    if log && (first <= 0.0 || last <= 0.0) {
        let problem = "has no logarithm at 0 and below";
        return Err(field.fault(problem, "write spacing = \"linear\", or ends above 0"));
    }
    let value = |at: u64| {
        let fraction = at as f64 / (count - 1) as f64;
        if at == 0 {
            first
        } else if at == count - 1 {
            last
        } else if log {
            rounded(first * (last / first).powf(fraction))
        } else {
            rounded(first + (last - first) * fraction)
        }
    };
    Ok((0..count).map(|at| (value(at), unit.clone())).collect())
}

/// Rounded to six digits: values between the ends need not be exact, but short.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

fn shown(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A unit in messages.
pub(super) fn named(unit: &str) -> String {
    if unit.is_empty() {
        "no unit".to_owned()
    } else {
        format!("'{unit}'")
    }
}

/// The size of a value, if it is a number above 0.
fn size_of(node: &Node) -> Option<f64> {
    match &node.value {
        Value::Number(_, value) => (value.is_finite() && *value > 0.0).then_some(*value),
        Value::Text(text) => size_of_text(text),
        _ => None,
    }
}

fn size_of_text(text: &str) -> Option<f64> {
    in_si(text).filter(|value| *value > 0.0)
}

/// A number with any unit, in SI.
pub(super) fn in_si(text: &str) -> Option<f64> {
    DIMENSIONS.iter().find_map(|d| quantity(text, d).ok())
}

/// A human-readable label of a value.
fn label(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => {
            let name = Path::new(text);
            let is_file = name.extension().is_some() && text.contains('/');
            let short = name.file_name().and_then(|name| name.to_str());
            match short {
                Some(short) if is_file => short.to_owned(),
                _ => text.clone(),
            }
        }
        _ => shortened(&toml(node).replace('"', ""), LONGEST_LABEL),
    }
}

/// A path without `folder/..`, if that is the same.
pub(super) fn tidy(path: PathBuf) -> PathBuf {
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
