//! Formulas that are evaluated for one bond or contact or for several at once are written for any
//! [`Number`]: an `f64`, or one `f64` for each of them.

use std::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::Vector3;

/// Operations that formulas need. Every operation rounds like that of `f64`, so several at once
/// give the same bits as one by one.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// 0.
    fn zero(self) -> Self;

    /// Times a constant.
    fn scale(self, factor: f64) -> Self;

    /// Plus a constant.
    fn plus(self, term: f64) -> Self;

    /// One over this.
    fn inverse(self) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;

    /// The larger of two numbers.
    fn maximum(self, other: Self) -> Self;

    /// The smaller of two numbers.
    fn minimum(self, other: Self) -> Self;

    /// 1 or -1, by the sign bit; -1 for -0.
    fn sign(self) -> Self;

    /// `value` where this is above 0, and 0 elsewhere.
    fn if_positive(self, value: Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn zero(self) -> Self {
        0.0
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn plus(self, term: f64) -> Self {
        self + term
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn sign(self) -> Self {
        1.0_f64.copysign(self)
    }

    #[inline(always)]
    fn if_positive(self, value: Self) -> Self {
        if self > 0.0 { value } else { 0.0 }
    }
}

/// A vector in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vec3<T>(pub T, pub T, pub T);

impl<T: Number> Vec3<T> {
    /// Inner product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.0 * other.0 + self.1 * other.1 + self.2 * other.2
    }

    /// Cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self(
            self.1 * other.2 - self.2 * other.1,
            self.2 * other.0 - self.0 * other.2,
            self.0 * other.1 - self.1 * other.0,
        )
    }

    /// Times a constant.
    #[inline(always)]
    pub fn scale(self, factor: f64) -> Self {
        Self(
            self.0.scale(factor),
            self.1.scale(factor),
            self.2.scale(factor),
        )
    }

    /// Square of the length.
    #[inline(always)]
    pub fn square(self) -> T {
        self.dot(self)
    }
}

impl From<Vector3<f64>> for Vec3<f64> {
    fn from(vector: Vector3<f64>) -> Self {
        Self(vector.x, vector.y, vector.z)
    }
}

impl From<Vec3<f64>> for Vector3<f64> {
    fn from(Vec3(x, y, z): Vec3<f64>) -> Self {
        Self::new(x, y, z)
    }
}

impl<T: Number> Add for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1, self.2 + other.2)
    }
}

impl<T: Number> Sub for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1, self.2 - other.2)
    }
}

impl<T: Number> Neg for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1, -self.2)
    }
}

impl<T: Number> Mul<T> for Vec3<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self(self.0 * factor, self.1 * factor, self.2 * factor)
    }
}

/// A rotation: the vector part and the scalar part of a unit quaternion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation<T>(pub Vec3<T>, pub T);

impl<T: Number> Rotation<T> {
    /// The rotated vector.
    #[inline(always)]
    pub fn of(self, vector: Vec3<T>) -> Vec3<T> {
        let Self(axis, w) = self;
        let half = axis.cross(vector);
        let t = half + half;
        t * w + axis.cross(t) + vector
    }

    /// The rotation, in space, from `before` to this one: this times the conjugate of `before`.
    #[inline(always)]
    pub fn relative_to(self, before: Self) -> Self {
        let (Self(b, wb), Self(a, wa)) = (self, before);
        Self(b * wa - a * wb - b.cross(a), wb * wa + b.dot(a))
    }
}
