//! The Pareto front of error and run time: the cost of each further step in accuracy.

/// A run by its error and run time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Median run time, s.
    pub time_s: f64,
    /// Uncertainty of the run time, s: smaller differences are not significant.
    pub spread_s: f64,
    /// Error, at least 0, including the uncertainty of the reference, below which errors are not
    /// significant.
    pub error: f64,
}

impl Point {
    /// True if it is faster by more than the spread of both.
    pub(crate) fn is_clearly_faster(&self, other: &Self) -> bool {
        self.time_s + self.spread_s.max(other.spread_s) < other.time_s
    }
}

/// For each point, true if it is on the front. From the smallest error upwards, a point is on it if
/// it is clearly faster than all points already on it. Errors count with two digits; of points with
/// the same error that are as fast as the fastest of them, within their spread, the first is taken.
///
/// So chance does not decide between hardly different run times: of two equally fast runs the more
/// accurate one is taken, of two equal ones the first.
pub(crate) fn front(points: &[Point]) -> Vec<bool> {
    let errors: Vec<f64> = points.iter().map(|point| two_digits(point.error)).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| errors[a].total_cmp(&errors[b]));
    let mut is_on = vec![false; points.len()];
    let mut members: Vec<usize> = Vec::new();
    for equals in order.chunk_by(|&a, &b| errors[a] == errors[b]) {
        // Equal points keep their order: sorting is stable.
        let is_first = |at: &&usize| {
            let mut others = equals.iter();
            !others.any(|&other| points[other].is_clearly_faster(&points[**at]))
        };
        if let Some(&at) = equals.iter().find(is_first)
            && members
                .iter()
                .all(|&m| points[at].is_clearly_faster(&points[m]))
        {
            members.push(at);
            is_on[at] = true;
        }
    }
    is_on
}

fn two_digits(error: f64) -> f64 {
    format!("{error:.1e}").parse().unwrap_or(error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<Point>> {
        let point = (0.01..10.0f64, 0.0..0.3f64, -8.0..0.0f64);
        let point = point.prop_map(|(time_s, fraction, log)| Point {
            time_s,
            spread_s: fraction * time_s,
            error: 10_f64.powf(log),
        });
        prop::collection::vec(point, 0..40)
    }

    proptest! {
        /// Of two members the less accurate is clearly faster; the smallest error has a member; for
        /// every other point there is a member, or an equally fast equal of one, that is as
        /// accurate and not clearly slower.
        #[test]
        fn each_step_towards_exactness_costs_time(points in points()) {
            let is_on = front(&points);
            let errors: Vec<f64> = points.iter().map(|p| two_digits(p.error)).collect();
            let members: Vec<usize> = (0..points.len()).filter(|&at| is_on[at]).collect();
            for &a in &members {
                for &b in members.iter().filter(|&&b| b != a) {
                    let [exact, fast] = if errors[a] < errors[b] { [a, b] } else { [b, a] };
                    prop_assert!(errors[exact] < errors[fast]);
                    prop_assert!(points[fast].is_clearly_faster(&points[exact]));
                }
            }
            let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
            prop_assert!(points.is_empty() || members.iter().any(|&m| errors[m] == least));
            for at in (0..points.len()).filter(|&at| !is_on[at]) {
                let mut others = 0..points.len();
                let is_superfluous = others.any(|other| other != at && errors[other] <= errors[at]
                    && !points[at].is_clearly_faster(&points[other]));
                prop_assert!(is_superfluous);
            }
        }

        /// Run times are equal or differ by more than twice the noise and their spread: the front
        /// stays the same.
        #[test]
        fn noise_within_the_spread_does_not_change_it(
            ranks in prop::collection::vec((0..8u32, 0..8i32), 1..30),
            noise in prop::collection::vec(-1.0..1.0f64, 30),
        ) {
            let at = |fraction: f64, rank: u32, log: i32| {
                let exact = 1.35_f64.powi(rank as i32);
                Point { time_s: exact * (1.0 + 0.04 * fraction), spread_s: 0.1 * exact, error: 10_f64.powi(log) }
            };
            let one: Vec<Point> = ranks.iter().map(|&(rank, log)| at(0.0, rank, log)).collect();
            let again: Vec<Point> =
                ranks.iter().zip(&noise).map(|(&(rank, log), &n)| at(n, rank, log)).collect();
            prop_assert_eq!(front(&one), front(&again));
        }
    }

    #[test]
    fn the_most_exact_and_those_that_are_clearly_faster_are_on_it() {
        let point = |time_s: f64, error: f64| Point {
            time_s,
            spread_s: 0.05,
            error,
        };
        let points = [
            point(1.0, 0.1),
            point(2.0, 0.01),
            point(2.0, 0.1),
            point(4.0, 0.01),
            point(0.98, 0.2),
            point(9.0, 0.0),
        ];
        assert_eq!(front(&points), [true, true, false, false, false, true]);
        // The third digit of an error does not matter, and of equal points the first is taken.
        assert_eq!(
            front(&[point(1.02, 0.1004), point(1.0, 0.1001), point(2.0, 0.1001)]),
            [true, false, false]
        );
        assert_eq!(front(&[]), [false; 0]);
    }
}
