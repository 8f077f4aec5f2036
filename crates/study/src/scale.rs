//! Logarithmic axes: where values stand, and which have a number.

/// A logarithmic axis.
pub(super) struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    /// An axis with room around these values; values that are not above 0 stand on its lower end.
    pub(super) fn new(values: impl Iterator<Item = f64>) -> Self {
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for value in values.filter(|value| *value > 0.0) {
            low = low.min(value.log10());
            high = if high == 0.0 { value } else { high.max(value) };
        }
        if high == 0.0 {
            return Self {
                low: -1.0,
                high: 0.0,
            };
        }
        let high = high.log10();
        // A factor of two at least, and a little room.
        let room = (0.5 * (0.3 - (high - low)))
            .max(0.06 * (high - low))
            .max(0.04);
        Self {
            low: low - room,
            high: high + room,
        }
    }

    /// The share of the axis at which a value stands, 0 to 1.
    pub(super) fn share(&self, value: f64) -> f64 {
        let log = if value > 0.0 { value.log10() } else { self.low };
        ((log - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }

    /// Values with a line of the grid: those with a number, at most about `most`, or the finer
    /// ones.
    pub(super) fn lines(&self, fine: bool, most: usize) -> Vec<f64> {
        let digits = |digits: &[u32], every: i32| -> Vec<f64> {
            let decades = self.low.floor() as i32..=self.high.floor() as i32;
            let decades = decades.filter(|decade| decade.rem_euclid(every) == 0);
            decades
                .flat_map(|decade| {
                    digits
                        .iter()
                        .map(move |d| f64::from(*d) * 10_f64.powi(decade))
                })
                .filter(|value| (self.low..=self.high).contains(&value.log10()))
                .collect()
        };
        let all = &[1, 2, 3, 4, 5, 6, 7, 8, 9];
        if fine {
            let few = self.high - self.low <= 4.0;
            return digits(if few { all } else { &[1] }, 1);
        }
        let choices = [
            digits(all, 1),
            digits(&[1, 2, 3, 5], 1),
            digits(&[1, 2, 5], 1),
            digits(&[1, 3], 1),
            digits(&[1], 1),
            digits(&[1], 2),
            digits(&[1], 3),
        ];
        let fits = choices.into_iter().find(|lines| lines.len() <= most);
        fits.unwrap_or_else(|| digits(&[1], 5))
    }
}

/// A number at an axis: 0.02, or 2×10⁻⁵.
pub(super) fn tick(value: f64) -> String {
    let exponent = (value.log10() + 1e-9).floor() as i32;
    if (-3..4).contains(&exponent) {
        let decimals = (-exponent).max(0) as usize;
        return format!("{value:.decimals$}");
    }
    let raised: String = exponent
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
        })
        .collect();
    match (value / 10_f64.powi(exponent)).round() as u32 {
        1 => format!("10{raised}"),
        digit => format!("{digit}×10{raised}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a plot, px.
    const WIDTH: f64 = 512.0;

    #[test]
    fn axes_have_numbers_that_fit() {
        for (low, high) in [
            (0.01, 0.013),
            (0.01, 0.5),
            (1e-3, 20.0),
            (1e-12, 1e-1),
            (3.0, 3.0),
        ] {
            let scale = Scale::new([low, high].into_iter());
            let lines = scale.lines(false, 7);
            assert!((2..=9).contains(&lines.len()), "{low} {high} {lines:?}");
            let places: Vec<f64> = lines.iter().map(|line| scale.share(*line)).collect();
            let room = places
                .windows(2)
                .map(|two| two[1] - two[0])
                .fold(1.0, f64::min);
            assert!(room * WIDTH > 36.0, "{low} {high} {lines:?} {room}");
            assert!(scale.share(low) > 0.0 && scale.share(high) < 1.0);
        }
        assert_eq!(tick(0.02), "0.02");
        assert_eq!(tick(30.0), "30");
        assert_eq!(tick(1e-5), "10⁻⁵");
        assert_eq!(tick(2e-12), "2×10⁻¹²");
    }
}
