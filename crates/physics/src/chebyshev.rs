//! Decay by damping alone, in stages: the method of Runge, Kutta and Chebyshev of second order
//! (Sommeijer, Shampine and Verwer 1998), for y' = -G y with a symmetric G.
//!
//! With s stages, y is multiplied by a polynomial R(G) of degree s, exp(-G) to second order, which
//! stays between 0 and 1 up to eigenvalues of about 2/3 (s^2 - 1): the stages that strong damping
//! needs grow with its square root only. All b_j below 2 are that of 2.

/// How much R stays below 1.
const EPSILON: f64 = 2.0 / 13.0;

/// Fewest stages of second order.
const FEWEST: usize = 2;

/// Factors of the stages over a unit of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Chebyshev {
    /// Of the first rate in the first stage.
    pub first: f64,
    /// Of the other stages.
    pub others: Vec<Stage>,
}

/// Factors with which the change of y after a stage is summed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// Of the change after the last stage (mu_j).
    pub last: f64,
    /// Of the change after the stage before (nu_j); 0 where there is none.
    pub before: f64,
    /// Of the rate after the last stage.
    pub force: f64,
    /// Of the first rate.
    pub first_force: f64,
}

/// Chebyshev polynomials of degree j at a point, and their first two derivatives.
#[derive(Debug, Clone, Copy)]
struct Polynomial([f64; 3]);

impl Polynomial {
    /// Those of degree 0 to `count` at `at`.
    fn up_to(count: usize, at: f64) -> Vec<Self> {
        let mut all = vec![Self([1.0, 0.0, 0.0]), Self([at, 1.0, 0.0])];
        for j in 2..=count {
            let (Self([t, d, dd]), Self([t2, d2, dd2])) = (all[j - 1], all[j - 2]);
            all.push(Self([
                2.0 * at * t - t2,
                2.0 * t + 2.0 * at * d - d2,
                4.0 * d + 2.0 * at * dd - dd2,
            ]));
        }
        all
    }

    /// b_j
    fn weight(&self) -> f64 {
        let Self([_, d, dd]) = *self;
        dd / (d * d)
    }
}

impl Chebyshev {
    /// The fewest stages for eigenvalues up to `largest`, with their limit if that is larger.
    pub fn covering(largest: f64) -> Self {
        let mut count = FEWEST.max((0.5 * largest).max(0.0).sqrt() as usize);
        while limit(count) < largest {
            count += 1;
        }
        Self::of(count)
    }

    /// So many stages, at least two.
    fn of(count: usize) -> Self {
        let at = shift(count);
        let all = Polynomial::up_to(count, at);
        let Polynomial([_, d, dd]) = all[count];
        let scale = d / dd;
        let b = |j: usize| all[j.max(2)].weight();
        let a = |j: usize| 1.0 - b(j) * all[j].0[0];
        let stage = |j: usize| {
            let force = 2.0 * b(j) * scale / b(j - 1);
            Stage {
                last: 2.0 * b(j) * at / b(j - 1),
                before: if j > 2 { -b(j) / b(j - 2) } else { 0.0 },
                force,
                first_force: -a(j - 1) * force,
            }
        };
        Self {
            first: b(1) * scale,
            others: (2..=count).map(stage).collect(),
        }
    }
}

/// Most stages of a run: more would hardly come to an end.
pub const MOST: usize = 1000;

/// Largest eigenvalue for which so many stages are stable.
pub fn limit(count: usize) -> f64 {
    let at = shift(count);
    let Polynomial([_, d, dd]) = Polynomial::up_to(count, at)[count];
    (at + 1.0) * dd / d
}

fn shift(count: usize) -> f64 {
    1.0 + EPSILON / (count * count) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R at an eigenvalue, by the stages.
    fn decay(stages: &Chebyshev, g: f64) -> f64 {
        let rate = |change: f64| -g * (1.0 + change);
        let (mut before, mut now) = (0.0, stages.first * rate(0.0));
        for stage in &stages.others {
            let next = stage.last * now
                + stage.before * before
                + stage.force * rate(now)
                + stage.first_force * rate(0.0);
            (before, now) = (now, next);
        }
        1.0 + now
    }

    #[test]
    fn decay_is_of_second_order_and_stays_between_0_and_1() {
        for count in [2, 3, 4, 7, 20, 50] {
            let stages = Chebyshev::of(count);
            let errors = [0.02, 0.01].map(|g: f64| (decay(&stages, g) - (-g).exp()).abs());
            let order = (errors[0] / errors[1]).log2();
            assert!((order - 3.0).abs() < 0.1, "{count}: {errors:?}");
            let most = limit(count);
            let squares = (count * count) as f64 - 1.0;
            assert!((most / squares - 0.66).abs() < 0.03, "{count}: {most}");
            for n in 1..=1000 {
                let value = decay(&stages, most * f64::from(n) / 1000.0);
                assert!((0.0..1.0).contains(&value), "{count}, {n}: {value}");
            }
        }
    }

    #[test]
    fn there_are_as_many_stages_as_needed() {
        for largest in [0.0, 0.5, 1.9, 2.1, 30.0, 1e4] {
            let count = Chebyshev::covering(largest).others.len() + 1;
            assert!(limit(count) >= largest);
            assert!(
                count == 2 || limit(count - 1) < largest,
                "{largest}: {count}"
            );
        }
    }
}
