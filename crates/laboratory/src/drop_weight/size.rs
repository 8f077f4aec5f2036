//! Groups of drop-weight tests of like size.

use super::sheet::DropWeightTest;

/// Sizes that differ by less than this factor are one in plots, residuals and checks.
const LIKE: f64 = 1.1;

/// Tests of like size.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeGroup {
    /// Geometric mean of their sizes, m.
    pub size_m: f64,
    /// Their places among the tests, in the order of the energies.
    pub tests: Vec<usize>,
}

/// Groups of tests of like size, the smallest first.
pub fn size_groups(tests: &[DropWeightTest]) -> Vec<SizeGroup> {
    let mut order: Vec<usize> = (0..tests.len()).collect();
    order.sort_by(|one, other| tests[*one].size_m.total_cmp(&tests[*other].size_m));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for at in order {
        match groups.last_mut() {
            Some(group) if tests[at].size_m < LIKE * tests[group[0]].size_m => group.push(at),
            _ => groups.push(vec![at]),
        }
    }
    let group = |mut places: Vec<usize>| {
        places.sort_by(|one, other| {
            let energy = |at: usize| tests[at].energy_j_kg;
            energy(*one).total_cmp(&energy(*other)).then(one.cmp(other))
        });
        SizeGroup {
            size_m: geometric_mean(places.iter().map(|at| tests[*at].size_m)),
            tests: places,
        }
    };
    groups.into_iter().map(group).collect()
}

/// Geometric mean of positive values; at least one.
pub(super) fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| {
        (sum + value.ln(), count + 1.0)
    });
    f64::exp(sum / count)
}
