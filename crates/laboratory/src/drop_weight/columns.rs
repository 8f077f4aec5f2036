//! Which column of a sheet of drop-weight tests is what.

use dem_io::units::{ENERGY_PER_MASS, LENGTH};
use dem_io::{Diagnostic, Result};

use crate::head::Column;
use crate::units::{names_of, size_of};

/// Names of a column of sizes.
const SIZES: [&str; 20] = [
    "size",
    "particle size",
    "mean size",
    "mean particle size",
    "geometric mean",
    "geometric mean size",
    "geomean size",
    "size class",
    "size fraction",
    "sieve fraction",
    "size interval",
    "size range",
    "fraction",
    "sieve",
    "feed size",
    "initial size",
    "nominal size",
    "diameter",
    "x",
    "d",
];
/// Names of the two columns of the sieves above and below.
const SIEVES: [&str; 20] = [
    "from",
    "to",
    "size from",
    "size to",
    "upper",
    "lower",
    "upper size",
    "lower size",
    "size upper",
    "size lower",
    "top size",
    "bottom size",
    "upper sieve",
    "lower sieve",
    "passing",
    "retained",
    "passing sieve",
    "retaining sieve",
    "max size",
    "min size",
];
/// Names of a column of energies.
const ENERGIES: [&str; 16] = [
    "ecs",
    "eis",
    "e",
    "energy",
    "specific energy",
    "specific comminution energy",
    "specific input energy",
    "specific impact energy",
    "specific absorbed energy",
    "input energy",
    "impact energy",
    "absorbed energy",
    "mean ecs",
    "actual ecs",
    "ecs actual",
    "energy over mass",
];
/// Names of a column of numbers of specimens.
const SPECIMENS: [&str; 12] = [
    "specimens",
    "particles",
    "pieces",
    "rocks",
    "tested",
    "specimens tested",
    "particles tested",
    "number of specimens",
    "number of particles",
    "no of particles",
    "count",
    "n",
];
/// Names of a column of broken specimens, or of their share.
const BROKEN: [&str; 11] = [
    "broken",
    "broken specimens",
    "broken particles",
    "broken share",
    "broken fraction",
    "share broken",
    "number broken",
    "breakage probability",
    "probability of breakage",
    "probability",
    "broken count",
];
/// Names of a column of ores.
const ORES: [&str; 5] = ["ore", "ore type", "rock", "material", "lithology"];
/// Names of a column of samples: ores, or numbers of the rows.
const SAMPLES: [&str; 3] = ["sample", "sample name", "sample id"];
/// Units at the end of a name, without the signs between their words.
const ENDINGS: [(&str, &str); 14] = [
    ("kwh per t", "kWh/t"),
    ("kwh t", "kWh/t"),
    ("j per kg", "J/kg"),
    ("kj per kg", "kJ/kg"),
    ("kj kg", "kJ/kg"),
    ("j kg", "J/kg"),
    ("j per g", "J/g"),
    ("j g", "J/g"),
    ("mm", "mm"),
    ("cm", "cm"),
    ("um", "um"),
    ("percent", "%"),
    ("pct", "%"),
    ("fraction", "fraction"),
];

/// The unit of shares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShareUnit {
    Percent,
    Fraction,
    /// The head does not say.
    Unsaid,
}

/// A column of a part of the mass that passes the size over `n`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fineness {
    pub(super) column: usize,
    pub(super) n: f64,
    pub(super) unit: ShareUnit,
}

/// Columns that give the size of each row.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SizeColumns {
    One(usize),
    Sieves([usize; 2]),
}

/// The columns of a sheet.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SheetColumns {
    pub(super) size: SizeColumns,
    /// m. None: the head gives none.
    pub(super) size_unit_m: Option<f64>,
    pub(super) energy: usize,
    pub(super) energy_unit_j_kg: f64,
    /// t10 and the others, in the order of the sheet.
    pub(super) fineness: Vec<Fineness>,
    pub(super) specimens: Option<usize>,
    pub(super) broken: Option<(usize, ShareUnit)>,
    pub(super) ore: Option<usize>,
    /// Whether the column of ores may as well number the rows.
    pub(super) is_sample: bool,
    /// Names of columns that are not read.
    pub(super) others: Vec<String>,
}

impl SheetColumns {
    /// The columns by their heads.
    ///
    /// # Errors
    /// Size, energy or t10 is missing or there twice; a unit that is missing or none of its
    /// quantity.
    pub(super) fn of(columns: &[Column]) -> Result<Self> {
        let heads: Vec<Head> = columns.iter().map(Head::of).collect();
        let find = |names: &[&str], what: &str| one_of(&heads, names, what);
        let size = size_columns(&heads)?;
        let first = match size {
            SizeColumns::One(column) => column,
            SizeColumns::Sieves([column, _]) => column,
        };
        let energy = find(&ENERGIES, "energy over mass")?
            .ok_or_else(|| missing(&heads, "energy over mass", "Ecs (kWh/t)"))?;
        let fineness: Vec<Fineness> = (heads.iter().enumerate())
            .filter_map(|(column, head)| {
                let unit = head.share_unit();
                let n = head.n()?;
                Some(Fineness { column, n, unit })
            })
            .collect();
        refuse_same_n(&fineness)?;
        if !fineness.iter().any(|one| one.n == 10.0) {
            return Err(missing(&heads, "t10", "t10 (%)"));
        }
        let specimens = find(&SPECIMENS, "number of specimens")?;
        let broken = find(&BROKEN, "broken specimens")?;
        let ore = find(&ORES, "ore")?;
        let sample = find(&SAMPLES, "sample")?;
        let used = |column: usize| {
            let sizes = match size {
                SizeColumns::One(one) => [one, one],
                SizeColumns::Sieves(both) => both,
            };
            let read = [Some(energy), specimens, broken, ore.or(sample)];
            sizes.contains(&column)
                || read.contains(&Some(column))
                || fineness.iter().any(|one| one.column == column)
        };
        let others = (0..heads.len()).filter(|column| !used(*column));
        Ok(Self {
            size_unit_m: size_unit(&heads[first])?,
            energy,
            energy_unit_j_kg: energy_unit(&heads[energy])?,
            specimens,
            broken: broken.map(|column| (column, heads[column].broken_unit())),
            ore: ore.or(sample),
            is_sample: ore.is_none(),
            others: others.map(|column| heads[column].shown.clone()).collect(),
            size,
            fineness,
        })
    }
}

/// Name of a column in small letters and single spaces, its unit, and how it is shown.
struct Head {
    name: String,
    unit: String,
    shown: String,
}

impl Head {
    fn of(column: &Column) -> Self {
        let lower = column.name.to_lowercase();
        let words = lower.split(|c: char| !c.is_alphanumeric() && c != '.');
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let mut name = words.join(" ");
        let mut unit = column.unit.clone();
        if unit.is_empty() {
            let ending = ENDINGS.iter().find_map(|(ending, unit)| {
                let rest = name.strip_suffix(ending)?.strip_suffix(' ')?;
                Some((rest.to_owned(), (*unit).to_owned()))
            });
            if let Some(found) = ending {
                (name, unit) = found;
            }
        }
        Self {
            name,
            unit,
            shown: column.name.escape_debug().to_string(),
        }
    }

    /// The n of a column `t10`, `t_10`, `t10 passing`.
    fn n(&self) -> Option<f64> {
        let mut words = self.name.strip_prefix('t')?.split_whitespace();
        let n: f64 = words.next()?.parse().ok()?;
        (n > 1.0 && n.is_finite()).then_some(n)
    }

    fn share_unit(&self) -> ShareUnit {
        let unit = self.unit.to_lowercase();
        if unit.starts_with('%') || unit.contains("percent") || unit.contains("pct") {
            ShareUnit::Percent
        } else if unit.starts_with('-') || unit == "1" || unit.contains("fraction") {
            ShareUnit::Fraction
        } else {
            ShareUnit::Unsaid
        }
    }

    /// The unit of broken specimens: `-` is that of their number and of their share.
    fn broken_unit(&self) -> ShareUnit {
        match self.unit.as_str() {
            "-" | "1" => ShareUnit::Unsaid,
            _ => self.share_unit(),
        }
    }
}

/// The column with one of these names, if there is one; refuses two.
fn one_of(heads: &[Head], names: &[&str], what: &str) -> Result<Option<usize>> {
    let mut found = (0..heads.len()).filter(|at| names.contains(&heads[*at].name.as_str()));
    match (found.next(), found.next()) {
        (Some(one), Some(other)) => {
            let shown = |at: usize| format!("'{}'", heads[at].shown);
            let problem = format!(
                "{} and {} both are columns of the {what}",
                shown(one),
                shown(other)
            );
            Err(Diagnostic::input(
                "",
                problem,
                "remove one of them, or rename it",
            ))
        }
        (found, _) => Ok(found),
    }
}

fn size_columns(heads: &[Head]) -> Result<SizeColumns> {
    if let Some(column) = one_of(heads, &SIZES, "size")? {
        return Ok(SizeColumns::One(column));
    }
    let sieves: Vec<usize> = (0..heads.len())
        .filter(|at| SIEVES.contains(&heads[*at].name.as_str()))
        .collect();
    match sieves[..] {
        [one, other] => Ok(SizeColumns::Sieves([one, other])),
        _ => Err(missing(
            heads,
            "size",
            "size (mm), or size from (mm) and size to (mm)",
        )),
    }
}

fn missing(heads: &[Head], what: &str, example: &str) -> Diagnostic {
    let names: Vec<String> = heads
        .iter()
        .map(|head| format!("'{}'", head.shown))
        .collect();
    let problem = format!("no column of the {what} among {}", names.join(", "));
    let remedy = format!("write its name above the numbers: {example}");
    Diagnostic::input("", problem, remedy)
}

fn refuse_same_n(fineness: &[Fineness]) -> Result<()> {
    for (at, one) in fineness.iter().enumerate() {
        if fineness[..at].iter().any(|other| other.n == one.n) {
            let problem = format!("there are two columns of t{}", one.n);
            return Err(Diagnostic::input("", problem, "remove one of them"));
        }
    }
    Ok(())
}

/// The unit of a length. None: there is none.
fn size_unit(head: &Head) -> Result<Option<f64>> {
    if head.unit.is_empty() {
        return Ok(None);
    }
    let size = size_of(&head.unit, &LENGTH).ok_or_else(|| wrong_unit(head, &names_of(&LENGTH)))?;
    Ok(Some(size))
}

fn energy_unit(head: &Head) -> Result<f64> {
    let known = names_of(&ENERGY_PER_MASS);
    if head.unit.is_empty() {
        let problem = format!("the energy '{}' has no unit", head.shown);
        let remedy = format!(
            "write it behind the name, such as {} (kWh/t); units are {known}",
            head.shown
        );
        return Err(Diagnostic::input("", problem, remedy));
    }
    size_of(&head.unit, &ENERGY_PER_MASS).ok_or_else(|| wrong_unit(head, &known))
}

fn wrong_unit(head: &Head, known: &str) -> Diagnostic {
    let unit = head.unit.escape_debug();
    let problem = format!("'{unit}' is not a unit of '{}'", head.shown);
    Diagnostic::input("", problem, format!("use one of {known}"))
}
