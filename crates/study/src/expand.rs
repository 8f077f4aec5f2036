//! From a study to its runs.

use dem_io::{Diagnostic, Result};
use dem_scene::study::{Axis, Combine, Design, Find, PACK, Setting, Study};

use super::design::{point_count, points, seeds};
use super::packings::{Packing, packings};

/// Largest number of processes started without confirmation.
pub const MOST_UNASKED: u64 = 10_000;
/// Largest number of processes.
pub const MOST: u64 = 1_000_000;
/// Largest number of runs times axes, which are kept in memory.
const MOST_CHOICES: u64 = 10_000_000;

/// One combination of values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// Number, from 1: that of its folder. Consecutive, except where searches of several cases end
    /// after different numbers of points.
    pub number: usize,
    /// Index of the value on each axis, from 0.
    pub choice: Vec<usize>,
}

impl Run {
    /// Its settings of the scene; its packings are files of bodies.
    pub fn settings(&self, study: &Study) -> Vec<Setting> {
        let all = self.written(study).into_iter();
        let of_scene = all.filter(|setting| !setting.path.starts_with(PACK));
        let packings = self.packings(study).into_iter().map(Packing::setting);
        of_scene.cloned().chain(packings).collect()
    }

    /// The bodies that are packed for it.
    pub fn packings(&self, study: &Study) -> Vec<Packing> {
        packings(study, &self.written(study))
    }

    /// Its settings as the study has them.
    fn written<'a>(&self, study: &'a Study) -> Vec<&'a Setting> {
        let chosen = study.axes.iter().zip(&self.choice);
        let chosen = chosen.flat_map(|(axis, &at)| &axis.values[at].settings);
        study.fixed.iter().chain(chosen).collect()
    }

    /// Human-readable value on each axis.
    pub fn labels(&self, study: &Study) -> Vec<String> {
        let chosen = study.axes.iter().zip(&self.choice);
        chosen
            .map(|(axis, &at)| axis.values[at].label.clone())
            .collect()
    }
}

/// All runs of a study; the last axis changes fastest.
///
/// # Errors
/// Paired axes of different lengths; more than [`MOST_UNASKED`] processes unless `yes`.
pub fn runs(study: &Study, yes: bool) -> Result<Vec<Run>> {
    let lengths: Vec<usize> = study.axes.iter().map(|axis| axis.values.len()).collect();
    let count = match (study.combine, &study.find) {
        _ if let Some(design) = &study.design => point_count(design) * seeds(study) as u64,
        (Combine::Grid, Some(find)) => {
            let averaged = study.average_over.map_or(1, |at| lengths[at]);
            let tried: usize = find.tried.iter().map(Vec::len).sum();
            tried as u64 * averaged as u64
        }
        (Combine::Grid, None) => lengths.iter().fold(1, |product: u64, &length| {
            product.saturating_mul(length as u64)
        }),
        (Combine::Paired, _) => paired(&study.axes)? as u64,
    };
    let processes = count.saturating_mul(u64::from(study.repeats()));
    if processes > MOST || (processes > MOST_UNASKED && !yes) {
        let (limit, remedy) = if processes > MOST {
            (MOST, "vary less")
        } else {
            (
                MOST_UNASKED,
                "vary less, or say --yes to have so many all the same",
            )
        };
        return Err(Diagnostic::input(
            &study.source,
            format!(
                "{count} runs, {} times each, are more than {limit}",
                study.repeats()
            ),
            remedy,
        ));
    }
    if count.saturating_mul(lengths.len() as u64) > MOST_CHOICES {
        return Err(Diagnostic::input(
            &study.source,
            format!(
                "{count} runs with {} axes each are more than {MOST_CHOICES} values",
                lengths.len()
            ),
            "vary less, or join axes in [together.NAME]",
        ));
    }
    if let Some(find) = &study.find {
        return Ok(runs_of_search(study, find, &lengths));
    }
    if let Some(design) = &study.design {
        return Ok(runs_of_design(study, design));
    }
    // Not above MOST.
    Ok((0..count as usize)
        .map(|index| Run {
            number: index + 1,
            choice: choice(study.combine, &lengths, index),
        })
        .collect())
}

/// The runs of a search so far: number k of the points of each case, before number k + 1 of any.
/// The number of a run depends neither on the other cases nor on the order in which they get on.
fn runs_of_search(study: &Study, find: &Find, lengths: &[usize]) -> Vec<Run> {
    let cases = study.cases();
    let others: usize = lengths[1..].iter().product();
    let mut runs = Vec::new();
    for other in 0..others {
        let mut choice = choice(Combine::Grid, lengths, other);
        let mut case = choice.clone();
        if let Some(averaged) = study.average_over {
            case[averaged] = 0;
        }
        let Some(case) = cases.iter().position(|one| *one == case) else {
            continue;
        };
        for (k, at) in find.tried[case].iter().enumerate() {
            choice[0] = *at;
            runs.push(Run {
                number: k * others + other + 1,
                choice: choice.clone(),
            });
        }
    }
    runs.sort_by_key(|run| run.number);
    runs
}

/// The runs of a design: point by point, each with every value of the averaged axis, which is the
/// last. More trajectories leave the numbers of the others.
fn runs_of_design(study: &Study, design: &Design) -> Vec<Run> {
    let of_point = points(design).into_iter().flat_map(|point| {
        let seeds = 0..seeds(study);
        let is_averaged = study.average_over.is_some();
        seeds.map(move |seed| {
            let seed = is_averaged.then_some(seed);
            point.iter().copied().chain(seed).collect()
        })
    });
    let run = |(number, choice): (usize, Vec<usize>)| Run { number, choice };
    (1..).zip(of_point).map(run).collect()
}

fn paired(axes: &[Axis]) -> Result<usize> {
    let count = axes.first().map_or(0, |axis| axis.values.len());
    match axes.iter().find(|axis| axis.values.len() != count) {
        None => Ok(count),
        Some(other) => Err(Diagnostic::input(
            &other.place,
            format!(
                "{} has {} values, but {} has {count}",
                other.name,
                other.values.len(),
                axes.first().map_or("", |axis| axis.name.as_str())
            ),
            "paired axes have equally many; give as many, or write combine = \"grid\"",
        )),
    }
}

fn choice(combine: Combine, lengths: &[usize], index: usize) -> Vec<usize> {
    if combine == Combine::Paired {
        return vec![index; lengths.len()];
    }
    let mut rest = index;
    let mut choice: Vec<usize> = lengths
        .iter()
        .rev()
        .map(|length| {
            let at = rest % length;
            rest /= length;
            at
        })
        .collect();
    choice.reverse();
    choice
}

/// The common choices of runs that differ along one axis only. Runs of a paired study differ along
/// every axis.
pub fn group(study: &Study, run: &Run, along: usize) -> Vec<usize> {
    match study.combine {
        Combine::Paired => Vec::new(),
        Combine::Grid => {
            let mut others = run.choice.clone();
            others[along] = 0;
            others
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use dem_scene::study::study_from_text;

    fn study(rest: &str) -> Study {
        let text = format!("version = 1\nscene = \"a.toml\"\n{rest}\n[measures.tip]\n");
        study_from_text(&text, "study.toml").unwrap()
    }

    fn labels(study: &Study) -> Vec<String> {
        let runs = runs(study, false).unwrap();
        runs.iter().map(|run| run.labels(study).join(" ")).collect()
    }

    #[test]
    fn a_grid_has_each_with_each() {
        let grid = study(
            "[set]\n\"run.seed\" = 3\n[vary]\n\"run.safety_factor\" = [0.9, 0.5]\n\"run.rest_energy_ratio\" = { from = 1, to = 3, count = 3 }",
        );
        assert_eq!(
            labels(&grid),
            ["0.9 1", "0.9 2", "0.9 3", "0.5 1", "0.5 2", "0.5 3"]
        );
        let runs = runs(&grid, false).unwrap();
        assert!(
            runs.iter()
                .zip(1..)
                .all(|(run, number)| run.number == number)
        );
        let settings = runs[5].settings(&grid);
        let settings: Vec<&str> = settings.iter().map(|s| s.value.as_str()).collect();
        assert_eq!(settings, ["3", "0.5", "3"]);
        assert_eq!(group(&grid, &runs[1], 1), group(&grid, &runs[2], 1));
        assert_ne!(group(&grid, &runs[1], 1), group(&grid, &runs[4], 1));
    }

    #[test]
    fn pairs_go_side_by_side() {
        let paired = study(
            "combine = \"paired\"\n[vary]\n\"run.safety_factor\" = [0.9, 0.5]\n\"run.rest_energy_ratio\" = [1, 2]",
        );
        assert_eq!(labels(&paired), ["0.9 1", "0.5 2"]);
        let runs_of = runs(&paired, false).unwrap();
        assert_eq!(
            group(&paired, &runs_of[0], 0),
            group(&paired, &runs_of[1], 0)
        );
        let uneven = study(
            "combine = \"paired\"\n[vary]\n\"run.safety_factor\" = [0.9, 0.5]\n\"run.rest_energy_ratio\" = [1]",
        );
        let said = runs(&uneven, true).unwrap_err();
        assert_eq!(said.exit_code(), 2);
        assert!(
            said.problem
                .contains("run.rest_energy_ratio has 1 values, but run.safety_factor has 2")
        );
    }

    #[test]
    fn a_million_runs_are_refused_unless_asked_for() {
        let many = "[vary]\n\"run.safety_factor\" = { from = 0, to = 1, count = 1000 }\n\"run.rest_energy_ratio\" = { from = 0, to = 1, count = COUNT }";
        let million = study(&format!("repeats = 1\n{}", many.replace("COUNT", "1000")));
        let said = runs(&million, false).unwrap_err().to_string();
        assert!(
            said.contains("1000000 runs, 1 times each, are more than 10000")
                && said.contains("--yes"),
            "{said}"
        );
        assert_eq!(runs(&million, true).unwrap().len(), 1_000_000);
        let more = study(&many.replace("COUNT", "99000"));
        assert!(runs(&more, true).is_err());
    }
}
