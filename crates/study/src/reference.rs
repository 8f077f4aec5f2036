//! References for values without a known expectation: the finest run, or the extrapolation of the
//! runs to size 0.

/// The limit of values as their size goes to 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extrapolated {
    /// The value at size 0.
    pub value: f64,
    /// Its uncertainty.
    pub uncertainty: f64,
    /// Observed order. None if it cannot be determined.
    pub order: Option<f64>,
    /// Objection to the extrapolation. None if there is none.
    pub warning: Option<Warning>,
}

/// Objections to an extrapolation. The value is then that of the finest size, and the uncertainty
/// three times the range of the finest three.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Warning {
    /// The values are not monotone.
    NotMonotone,
    /// Their differences do not decrease.
    DoesNotConverge,
}

impl Warning {
    pub(crate) fn text(self) -> &'static str {
        match self {
            Self::NotMonotone => "its values go up and down with the size",
            Self::DoesNotConverge => {
                "its values do not come nearer to each other as the size falls"
            }
        }
    }
}

/// Range of orders that are searched.
const ORDERS: [f64; 2] = [0.05, 20.0];
/// Safety factors of the grid convergence index (Roache 1994): for three sizes, and if a fourth
/// does not confirm the order.
const SAFETY: f64 = 1.25;
const UNCONFIRMED: f64 = 3.0;
/// Relative differences up to this are rounding errors.
const ROUNDING: f64 = 1e-14;
/// Smallest uncertainty as a fraction of the extrapolated difference.
const LEAST: f64 = 0.02;

/// Richardson extrapolation f = f0 + C h^p through the three finest of `points` (size, value). With
/// four sizes the uncertainty follows from the difference between the extrapolations of the finest
/// and the next finest three, but is at most three times the extrapolated difference; with three it
/// is the grid convergence index. None for fewer than three sizes.
pub(crate) fn richardson(points: &[(f64, f64)]) -> Option<Extrapolated> {
    let mut points = points.to_vec();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0 == b.0);
    let [a, b, c, ..] = points.as_slice() else {
        return None;
    };
    let finest = through([*a, *b, *c]);
    let next = points.get(3).map(|d| through([*b, *c, *d]));
    Some(match next {
        Some(next) if finest.warning.is_none() && next.warning.is_none() => {
            let rounding = ROUNDING * a.1.abs();
            let way = (finest.value - a.1).abs();
            // Both have errors of a further power of their finest sizes, at least of first order.
            let falls = b.0 / a.0 - 1.0;
            let differ = SAFETY * (finest.value - next.value).abs() * falls.recip().max(1.0);
            let differ = differ.clamp(LEAST * way, UNCONFIRMED * way);
            Extrapolated {
                uncertainty: differ.max(rounding),
                ..finest
            }
        }
        _ => finest,
    })
}

/// Extrapolation through three points, the finest first.
fn through([(h1, f1), (h2, f2), (h3, f3)]: [(f64, f64); 3]) -> Extrapolated {
    let (fine, coarse) = (f2 - f1, f3 - f2);
    let rounding = ROUNDING * f1.abs().max(f2.abs()).max(f3.abs());
    let range = f1.max(f2).max(f3) - f1.min(f2).min(f3);
    let found = |warning, uncertainty: f64| Extrapolated {
        value: f1,
        uncertainty: uncertainty.max(rounding),
        order: None,
        warning,
    };
    if fine.abs() <= rounding {
        return found(None, rounding);
    }
    if fine * coarse <= 0.0 {
        return found(Some(Warning::NotMonotone), 3.0 * range);
    }
    let ratio = |p: f64| (h3.powf(p) - h2.powf(p)) / (h2.powf(p) - h1.powf(p));
    let wanted = coarse / fine;
    if wanted <= ratio(ORDERS[0]) {
        return found(Some(Warning::DoesNotConverge), 3.0 * range);
    }
    // The ratio increases with the order.
    let [mut low, mut high] = ORDERS;
    for _ in 0..200 {
        let middle = f64::midpoint(low, high);
        if ratio(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    let order = f64::midpoint(low, high);
    let value = f1 - fine * h1.powf(order) / (h2.powf(order) - h1.powf(order));
    Extrapolated {
        value,
        uncertainty: (SAFETY * (value - f1).abs()).max(rounding),
        order: Some(order),
        warning: None,
    }
}

/// Slope of log(error) over log(size): the order with which the error decreases with the size. None
/// for fewer than two different sizes with an error.
pub(crate) fn observed_order(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<[f64; 2]> = points
        .iter()
        .filter(|(size, error)| *size > 0.0 && *error > 0.0)
        .map(|(size, error)| [size.ln(), error.ln()])
        .collect();
    let count = logs.len() as f64;
    let mean = |k: usize| logs.iter().map(|point| point[k]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let over: f64 = logs.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    let under: f64 = logs.iter().map(|p| (p[0] - x).powi(2)).sum();
    (under > 1e-12).then(|| over / under)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const TRUTH: f64 = -8.5;

    fn sequence(order: i32, sizes: &[f64], next_order: f64) -> Vec<(f64, f64)> {
        let value = |h: f64| TRUTH + 3.0 * h.powi(order) + next_order * h.powi(order + 1);
        sizes.iter().map(|&h| (h, value(h))).collect()
    }

    #[test]
    fn a_pure_power_is_found_exactly() {
        for order in [1, 2, 4] {
            for sizes in [&[0.4, 0.2, 0.1][..], &[0.5, 0.3, 0.25, 0.1]] {
                let found = richardson(&sequence(order, sizes, 0.0)).unwrap();
                assert!((found.value - TRUTH).abs() < 1e-10, "{order} {found:?}");
                assert!((found.order.unwrap() - f64::from(order)).abs() < 1e-6);
                assert_eq!(found.warning, None);
                assert!(found.uncertainty >= (found.value - TRUTH).abs());
            }
        }
    }

    #[test]
    fn the_uncertainty_covers_the_truth() {
        for order in [1, 2, 4] {
            for next_order in [-2.0, -0.5, 0.5, 2.0, 8.0] {
                for sizes in [
                    &[0.4, 0.2, 0.1][..],
                    &[0.4, 0.2, 0.1, 0.05],
                    &[0.3, 0.24, 0.2, 0.15],
                ] {
                    let found = richardson(&sequence(order, sizes, next_order)).unwrap();
                    let off = (found.value - TRUTH).abs();
                    assert!(
                        off <= found.uncertainty,
                        "{order} {next_order} {sizes:?} {off} {found:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn values_that_go_up_and_down_are_flagged() {
        let found = richardson(&[(0.1, 1.0), (0.2, 1.1), (0.4, 0.9)]).unwrap();
        assert_eq!(found.warning, Some(Warning::NotMonotone));
        assert_eq!((found.value, found.order), (1.0, None));
        assert!((found.uncertainty - 0.6).abs() < 1e-12);
        let found = richardson(&[(0.1, 1.0), (0.2, 1.2), (0.4, 1.3)]).unwrap();
        assert_eq!(found.warning, Some(Warning::DoesNotConverge));
        let found = richardson(&[(0.1, 1.0), (0.2, 1.0), (0.4, 1.0)]).unwrap();
        assert_eq!((found.warning, found.value), (None, 1.0));
        assert!(richardson(&[(0.1, 1.0), (0.2, 1.0), (0.2, 1.0)]).is_none());
    }

    #[test]
    fn orders_from_errors() {
        let of = |order: i32| -> Vec<(f64, f64)> {
            [0.1, 0.2, 0.35]
                .iter()
                .map(|&h: &f64| (h, 7.0 * h.powi(order)))
                .collect()
        };
        for order in [1, 2, 4] {
            assert!((observed_order(&of(order)).unwrap() - f64::from(order)).abs() < 1e-9);
        }
        assert_eq!(observed_order(&[(0.1, 1.0)]), None);
        assert_eq!(observed_order(&[(0.1, 1.0), (0.2, 0.0)]), None);
    }
}
