//! Numbers that carry their derivatives: forward differentiation of any formula written for
//! [`Number`], exact to rounding.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::number::Number;

/// A value and its derivatives with respect to `N` variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// Its derivatives. Length N.
    pub slopes: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A number that depends on no variable.
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            slopes: [0.0; N],
        }
    }

    /// Variable `k` of the N, with this value.
    pub fn variable(value: f64, k: usize) -> Self {
        let mut variable = Self::constant(value);
        variable.slopes[k] = 1.0;
        variable
    }

    /// `value`, a function of this number with this slope.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            slopes: self.slopes.map(|own| slope * own),
        }
    }

    /// `value`, a function of this and another number with these slopes.
    #[inline(always)]
    fn chain_both(self, other: Self, value: f64, [by_this, by_other]: [f64; 2]) -> Self {
        let mut slopes = self.slopes;
        for (slope, other) in slopes.iter_mut().zip(other.slopes) {
            *slope = by_this * *slope + by_other * other;
        }
        Self { value, slopes }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.chain_both(other, self.value + other.value, [1.0, 1.0])
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.chain_both(other, self.value - other.value, [1.0, -1.0])
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let slopes = [other.value, self.value];
        self.chain_both(other, self.value * other.value, slopes)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        self.chain_both(other, value, [1.0 / other.value, -value / other.value])
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> Number for Dual<N> {
    #[inline(always)]
    fn zero(self) -> Self {
        Self::constant(0.0)
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }

    #[inline(always)]
    fn plus(self, term: f64) -> Self {
        self.chain(self.value + term, 1.0)
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        let inverse = 1.0 / self.value;
        self.chain(inverse, -inverse * inverse)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }

    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        if self.value > other.value {
            self
        } else {
            other
        }
    }

    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        if self.value < other.value {
            self
        } else {
            other
        }
    }

    #[inline(always)]
    fn sign(self) -> Self {
        Self::constant(self.value.sign())
    }

    #[inline(always)]
    fn if_positive(self, value: Self) -> Self {
        if self.value > 0.0 { value } else { self.zero() }
    }
}
