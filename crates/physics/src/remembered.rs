//! Decay by damping alone in one stage, for damping that is too strong for it without a memory: the
//! velocities that damping acts on follow from those of the last steps.
//!
//! With the velocities w without damping of this step, and D = -G y, those that damping acts on are
//!
//!   Q(s) y = w + L(s) D/2,   Q(s) = 1 + a (1 - s)^2 (1 - m s),
//!
//! where s takes what was a step before. For slow motions Q and L are nearly 1, and y the
//! velocities in the middle of the decay, w + D/2. What changes fast is damped less by a factor of
//! about 1 + a. With S = G/0.9 for the largest eigenvalue G,
//!
//!   a = (S - 3/2)/2,   L(s) = 1 - 2/S (Q(s) - F(s)),   F(s) = (2 + 3 s + 2 s^2 + s^3)/8.
//!
//! L has no part of this step: D follows from y, and y from D of steps before. The factor
//!
//!   N(s) = Q(s) + g (L(s) - 1)/2 = (1 - g/S) Q(s) + g/S F(s)
//!
//! in N y = w + D/2 has a positive real part for |s| at most 1 and g up to G: that of F is Fejér's
//! kernel, and that of Q at least 0.09, which decides m. So no velocities are damped by a negative
//! amount: see `engine/stages/bonds/damping.rs`.
//!
//! Slow motions are damped by a factor of 1 + a (1 - m) (omega dt)^2 too much. Up to a largest
//! eigenvalue of 2.16 m is 1, and they are damped as they should be.

/// Largest eigenvalue that one stage with a memory covers. There the damping of slow motions is
/// too large by 0.5 (omega dt)^2; two stages more have a smaller error.
pub const MOST: f64 = 3.0;

/// Factors of what is remembered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remembered {
    /// Of the velocities w + L(s) D/2.
    pub present: f64,
    /// Of y one, two and three steps before.
    pub velocities: [f64; 3],
    /// Of D one, two and three steps before, in L(s).
    pub damping: [f64; 3],
}

impl Remembered {
    /// For eigenvalues up to `largest`, from 1.4 to [`MOST`].
    pub fn covering(largest: f64) -> Self {
        let most = largest / 0.9;
        let a = 0.5 * (most - 1.5);
        let m = (0.486 / a - 0.08).min(1.0);
        let earlier = [-a * (2.0 + m), a * (1.0 + 2.0 * m), -a * m];
        let of_kernel = [0.375, 0.25, 0.125];
        Self {
            present: 1.0 / (1.0 + a),
            velocities: earlier.map(|q| -q / (1.0 + a)),
            damping: std::array::from_fn(|k| 2.0 / most * (of_kernel[k] - earlier[k])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;
    use std::f64::consts::PI;

    /// Eigenvalues from that of one stage without this memory.
    fn eigenvalues() -> impl Iterator<Item = f64> {
        (0..=20).map(|n| 1.43 + (MOST - 1.43) * f64::from(n) / 20.0)
    }

    /// Q and L at s.
    fn factors(memory: &Remembered, s: Complex<f64>) -> [Complex<f64>; 2] {
        let powers = [s, s * s, s * s * s];
        let sum = |factors: [f64; 3]| -> Complex<f64> {
            powers.iter().zip(factors).map(|(s, f)| s * f).sum()
        };
        let one = Complex::new(1.0, 0.0);
        let q = (one - sum(memory.velocities)) / memory.present;
        [q, sum(memory.damping)]
    }

    #[test]
    fn nothing_is_damped_by_a_negative_amount() {
        for largest in eigenvalues() {
            let memory = Remembered::covering(largest);
            for n in 0..=1000 {
                let [q, l] = factors(&memory, Complex::from_polar(1.0, PI * f64::from(n) / 1e3));
                assert!(q.re > 0.08, "{largest}, {n}: {q}");
                for share in [0.0, 0.5, 1.0] {
                    let damped = q + 0.5 * share * largest * (l - 1.0);
                    assert!(damped.re > 0.007, "{largest}, {share}, {n}: {damped}");
                }
            }
        }
    }

    #[test]
    fn slow_motions_are_damped_as_they_should_be() {
        for largest in eigenvalues() {
            let memory = Remembered::covering(largest);
            let errors = [0.02, 0.01].map(|phase| {
                let [q, l] = factors(&memory, Complex::from_polar(1.0, -phase));
                assert!((l - 1.0).norm() < 3.0 * phase, "{largest}: {l}");
                (q - 1.0).norm() / (phase * phase)
            });
            assert!(errors[1] < 0.51, "{largest}: {errors:?}");
            assert!(largest > 2.15 || errors[1] < 0.51 * errors[0] + 1e-12);
        }
    }
}
