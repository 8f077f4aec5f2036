//! The runs of a design: its points in the ranges of the parameters, each with every value of the
//! averaged axis.

use dem_io::text::counted;
use dem_scene::study::{Design, DesignKind, DesignRange, Study};

use super::morris::Trajectory;
use super::one_at_a_time;

/// The trajectories of Morris' method; none for another design.
pub fn trajectories(design: &Design) -> Vec<Trajectory> {
    match design.kind {
        DesignKind::Morris {
            trajectories,
            levels,
            seed,
        } => (0..trajectories)
            .map(|number| Trajectory::new(design.ranges.len(), levels, seed, number))
            .collect(),
        DesignKind::OneAtATime => Vec::new(),
    }
}

/// The points of a design: for each, the index of the value on the axis of each parameter.
pub(crate) fn points(design: &Design) -> Vec<Vec<usize>> {
    match design.kind {
        DesignKind::Morris { .. } => {
            let trajectories = trajectories(design).into_iter();
            trajectories.flat_map(|one| one.points).collect()
        }
        DesignKind::OneAtATime => {
            let ranges = || design.ranges.iter();
            let bases: Vec<usize> = ranges().map(DesignRange::base_index).collect();
            let values: Vec<usize> = ranges().map(|range| range.around_base().len()).collect();
            one_at_a_time::points(&bases, &values)
        }
    }
}

/// Number of points.
pub(crate) fn point_count(design: &Design) -> u64 {
    let parameters = design.ranges.len();
    let count = match design.kind {
        DesignKind::Morris { trajectories, .. } => trajectories * (parameters + 1),
        DesignKind::OneAtATime => {
            let others = design
                .ranges
                .iter()
                .map(|range| range.around_base().len() - 1);
            1 + others.sum::<usize>()
        }
    };
    count as u64
}

/// Number of values of the averaged axis with which each point of a study runs.
pub(crate) fn seeds(study: &Study) -> usize {
    study
        .average_over
        .map_or(1, |at| study.axes[at].values.len())
}

/// A design and what it costs: `Morris: 6 trajectories of 8 parameters on 4 levels (seed 1), 54
/// points, each with 2 values of run.seed: 108 runs`.
pub fn in_words(study: &Study, design: &Design) -> String {
    let parameters = counted(design.ranges.len(), "parameter");
    let points = point_count(design);
    let of = match design.kind {
        DesignKind::Morris {
            trajectories,
            levels,
            seed,
        } => format!(
            "Morris: {trajectories} trajectories of {parameters} on {levels} levels (seed {seed})"
        ),
        DesignKind::OneAtATime => {
            format!("one at a time: {parameters} to the ends of their ranges")
        }
    };
    let with_seeds = match study.average_over {
        Some(at) => format!(
            ", each with {} of {}",
            counted(study.axes[at].values.len(), "value"),
            study.axes[at].name
        ),
        None => String::new(),
    };
    let repeats = match study.repeats() {
        1 => String::new(),
        repeats => format!(", {repeats} times each"),
    };
    let runs = points * seeds(study) as u64;
    format!("{of}, {points} points{with_seeds}: {runs} runs{repeats}")
}
