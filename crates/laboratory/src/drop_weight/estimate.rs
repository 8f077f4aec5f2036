//! Numbers with confidence intervals.

use serde::Serialize;

/// A number of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// Its value.
    pub value: f64,
    /// 95 % confidence interval. None: it is assumed, or the tests do not tell.
    pub interval: Option<[f64; 2]>,
    /// Whether it was fitted; otherwise it is assumed, or at its bound.
    pub is_fitted: bool,
}

impl Estimate {
    pub(super) fn fitted(value: f64) -> Self {
        Self {
            value,
            interval: None,
            is_fitted: true,
        }
    }

    pub(super) fn assumed(value: f64) -> Self {
        Self {
            value,
            interval: None,
            is_fitted: false,
        }
    }

    /// With a symmetric interval of this half width.
    pub(super) fn within(value: f64, half: Option<f64>) -> Self {
        let interval = half.map(|half| [value - half, value + half]);
        Self {
            interval,
            ..Self::fitted(value)
        }
    }

    /// Of a positive number, from the half width of the interval of its logarithm.
    pub(super) fn within_factor(value: f64, half: Option<f64>) -> Self {
        let interval = half.map(|half| [value * (-half).exp(), value * half.exp()]);
        Self {
            interval,
            ..Self::fitted(value)
        }
    }
}
