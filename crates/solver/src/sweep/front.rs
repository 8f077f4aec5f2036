//! The Pareto front of error and run time: runs than which none is both faster and as exact.

/// A run by its error and run time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Median run time, s.
    pub time_s: f64,
    /// Differences of run times up to this mean nothing, s.
    pub spread_s: f64,
    /// At least 0; with the uncertainty of the reference, below which errors mean nothing.
    pub error: f64,
}

impl Point {
    /// Whether `other` is slower by more than the spread of both, and not more exact. Errors count with two digits.
    pub fn dominates(&self, other: &Self) -> bool {
        let clear = self.spread_s.max(other.spread_s);
        self.time_s + clear < other.time_s && two_digits(self.error) <= two_digits(other.error)
    }
}

/// Which points none dominates.
pub fn front(points: &[Point]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].time_s.total_cmp(&points[b].time_s));
    let mut is_on = vec![false; points.len()];
    let mut members: Vec<usize> = Vec::new();
    // Whoever dominates is faster, and who is dominated is so by a member: the relation is transitive.
    for at in order {
        let is_dominated = members.iter().any(|&m| points[m].dominates(&points[at]));
        if !is_dominated {
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
        let point = point.prop_map(|(time_s, share, log)| Point {
            time_s,
            spread_s: share * time_s,
            error: 10_f64.powf(log),
        });
        prop::collection::vec(point, 0..40)
    }

    proptest! {
        #[test]
        fn no_member_is_dominated_and_every_other_is_by_a_member(points in points()) {
            let is_on = front(&points);
            for (at, point) in points.iter().enumerate() {
                let mut members = points.iter().zip(&is_on).filter(|(_, on)| **on);
                let is_dominated = points.iter().any(|other| other.dominates(point));
                prop_assert_eq!(is_dominated, !is_on[at]);
                prop_assert_eq!(members.any(|(m, _)| m.dominates(point)), !is_on[at]);
            }
        }

        /// Run times that lie apart by more than twice the noise and their spread: the front stays.
        #[test]
        fn noise_within_the_spread_does_not_change_it(
            ranks in prop::collection::vec((0..30u32, -8.0..0.0f64), 1..30),
            noise in prop::collection::vec(-1.0..1.0f64, 30),
        ) {
            let at = |share: f64, rank: u32, log: f64| {
                let exact = 1.35_f64.powi(rank as i32);
                Point { time_s: exact * (1.0 + 0.04 * share), spread_s: 0.1 * exact, error: 10_f64.powf(log) }
            };
            let one: Vec<Point> = ranks.iter().map(|&(rank, log)| at(0.0, rank, log)).collect();
            let again: Vec<Point> =
                ranks.iter().zip(&noise).map(|(&(rank, log), &n)| at(n, rank, log)).collect();
            prop_assert_eq!(front(&one), front(&again));
        }
    }

    #[test]
    fn the_fastest_and_the_most_exact_are_on_it() {
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
            point(1.02, 0.2),
            point(9.0, 0.0),
        ];
        assert_eq!(front(&points), [true, true, false, false, true, true]);
        // The third digit of an error is none to wait for.
        assert_eq!(
            front(&[point(1.0, 0.1004), point(2.0, 0.1001)]),
            [true, false]
        );
        assert_eq!(front(&[]), [false; 0]);
    }
}
