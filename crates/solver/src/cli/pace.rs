//! The time that a run still takes, by its pace so far.

/// Part of a run after which its pace is noted again.
const NOTED: f64 = 1e-3;

/// What a run has done, and in what time.
#[derive(Debug, Default)]
pub(super) struct Pace {
    /// Fractions of the run and the times, s, at which they were done, both ascending.
    done: Vec<[f64; 2]>,
}

impl Pace {
    /// The time left, s, once this fraction of the run is done after `elapsed_s`: as if the rest went
    /// as the last half of what is done. So it is steady, and follows a run that gets slower. None:
    /// it is not known yet.
    pub(super) fn left_s(&mut self, fraction: f64, elapsed_s: f64) -> Option<f64> {
        let last = self
            .done
            .last()
            .map_or(f64::NEG_INFINITY, |[last, _]| *last);
        if fraction >= last + NOTED {
            self.done.push([fraction, elapsed_s]);
        }
        let [first, _] = *self.done.first()?;
        let half = 0.5 * (first + fraction);
        let at = self.done.partition_point(|[done, _]| *done <= half);
        let [from, since_s] = self.done[at.saturating_sub(1)];
        let left_s = (elapsed_s - since_s) * (1.0 - fraction) / (fraction - from);
        left_s.is_finite().then_some(left_s)
    }
}

/// A time left in words, in the unit that suits it.
pub(super) fn left_in_words(left_s: f64) -> String {
    match left_s {
        ..100.0 => format!("{left_s:.0} s left"),
        ..6000.0 => format!("{:.0} min left", left_s / 60.0),
        _ => format!("{:.1} h left", left_s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_of_one_pace_is_told_exactly_from_anywhere() {
        for begin in [0.0, 0.55] {
            let mut pace = Pace::default();
            for n in 0..=400 {
                let fraction = begin + (1.0 - begin) * f64::from(n) / 400.0;
                let elapsed_s = 50.0 * (fraction - begin);
                let left_s = pace.left_s(fraction, elapsed_s);
                let wanted_s = 50.0 * (1.0 - fraction);
                assert!(
                    n == 0 || left_s.is_some_and(|left_s| (left_s - wanted_s).abs() < 1e-9),
                    "{n}: {left_s:?}"
                );
            }
        }
        assert_eq!(Pace::default().left_s(0.0, 1.0), None);
    }

    #[test]
    fn short_phases_move_it_little_and_a_slower_run_is_followed() {
        // Every tenth of a second of a run of 10 s costs ten times as much as the others.
        let mut pace = Pace::default();
        let mut elapsed_s = 0.0;
        for n in 1..=1000 {
            elapsed_s += if n % 100 < 10 { 0.1 } else { 0.01 };
            let left_s = pace.left_s(f64::from(n) / 1000.0, elapsed_s);
            let wanted_s = 19.0 * (1.0 - f64::from(n) / 1000.0);
            if let Some(left_s) = left_s.filter(|_| n > 200) {
                assert!(
                    left_s < 1.6 * wanted_s + 0.1 && left_s > 0.6 * wanted_s - 0.1,
                    "{n}"
                );
            }
        }
        // Ten times as slow from the middle on.
        let mut slower = Pace::default();
        let told = |fraction: f64, pace: &mut Pace| {
            let elapsed_s = 10.0 * fraction + 90.0 * (fraction - 0.5).max(0.0);
            pace.left_s(fraction, elapsed_s)
        };
        let at: Vec<f64> = (0..=90)
            .filter_map(|n| told(f64::from(n) / 100.0, &mut slower))
            .collect();
        let is_near = |last_s: &f64| (last_s / 10.0 - 1.0).abs() < 0.15;
        assert!(at.last().is_some_and(is_near), "{at:?}");
    }

    #[test]
    fn words() {
        let words = [12.4, 150.0, 9000.0].map(left_in_words);
        assert_eq!(
            words,
            ["12 s left", "2 min left", "2.5 h left"].map(String::from)
        );
    }
}
