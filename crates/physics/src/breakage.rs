//! Breakage of a particle by the energy that an impact brings: whether it breaks, and into what.
//!
//! A particle of size x breaks if the energy over its mass, E, exceeds its fracture energy
//!
//!   E_f = E_0 (x_0/x)^m f,
//!
//! where f is a factor of its own with median 1 and a log-normal distribution (Tavares and King
//! 1998). Of its fragments the part by mass
//!
//!   t_10 = A (1 - exp(-b (x/x_0)^k (E - E_f)))
//!
//! passes a sieve of a tenth of its size (Shi and Kojovic 2007; with E_f = 0 and k = 0 the law of
//! Napier-Munn et al. 1996), and the part t_n one of x/n:
//!
//!   t_n = 1 - (1 - t_10)^(((10 - 1)/(n - 1))^a)
//!
//! (King 2001, the truncated Rosin-Rammler distribution). It follows t_10 alone, reaches 1 at the
//! size of the particle, and holds for every n, not for tabulated ones only.
//!
//! Impacts below the fracture energy damage a particle: see [`damage`].

use dem_io::random::uniform;
use serde::{Deserialize, Serialize};

pub mod daughters;

/// t10 below which a particle does not break: what it would lose are chips, which break none.
pub const SMALLEST_T10: f64 = 0.01;
/// Exponent of the family of fragment sizes where none is measured: the mean of 41 tests on
/// granite, gneiss and quartzite (Rae et al. 2020).
pub const USUAL_FAMILY_EXPONENT: f64 = 0.87;
/// Once t10 is this part of its largest value, more energy hardly makes finer pieces.
const NEARLY_ALL: f64 = 0.9;
/// Standard deviations on each side over which scatter is averaged, and their parts.
const WIDEST: f64 = 5.0;
const PARTS: u32 = 200;

/// How the particles of a material break.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BreakageLaw {
    /// A: largest part of the mass below a tenth of the size, between 0 and 1.
    pub largest_t10: f64,
    /// b at the reference size, kg/J.
    pub b_kg_j: f64,
    /// E_0: median fracture energy over mass at the reference size, J/kg; 0: every impact breaks.
    pub fracture_energy_j_kg: f64,
    /// Standard deviation of the natural logarithm of fracture energies.
    pub energy_scatter: f64,
    /// x_0, m.
    pub reference_size_m: f64,
    /// k: b grows with the size to this power.
    pub b_exponent: f64,
    /// m: the fracture energy falls with the size to this power.
    pub energy_exponent: f64,
    /// a: of the family of t_n.
    pub family_exponent: f64,
}

impl BreakageLaw {
    /// Median fracture energy over mass of particles of this size, m, in J/kg.
    pub fn median_energy_j_kg(&self, size_m: f64) -> f64 {
        self.fracture_energy_j_kg * (self.reference_size_m / size_m).powf(self.energy_exponent)
    }

    /// Fracture energy over mass of the particle with this number and size, m, in J/kg.
    pub fn own_energy_j_kg(&self, seed: u64, particle: u64, size_m: f64) -> f64 {
        let median_j_kg = self.median_energy_j_kg(size_m);
        if self.energy_scatter == 0.0 {
            return median_j_kg;
        }
        // Box and Muller 1958.
        let [one, other] = [0, 1].map(|which| uniform(seed, &[particle, which]));
        let normal = (-2.0 * one.ln()).sqrt() * (std::f64::consts::TAU * other).cos();
        median_j_kg * (self.energy_scatter * normal).exp()
    }

    /// b of particles of this size, m, in kg/J.
    fn b_of_size_kg_j(&self, size_m: f64) -> f64 {
        self.b_kg_j * (size_m / self.reference_size_m).powf(self.b_exponent)
    }

    /// t10 of a particle of this size, m, with this fracture energy, that takes in this energy,
    /// both over its mass, J/kg: 0 if it does not break.
    pub fn t10(&self, size_m: f64, energy_j_kg: f64, fracture_energy_j_kg: f64) -> f64 {
        let beyond_j_kg = (energy_j_kg - fracture_energy_j_kg).max(0.0);
        -self.largest_t10 * (-self.b_of_size_kg_j(size_m) * beyond_j_kg).exp_m1()
    }

    /// Energy over mass from which half of the particles of this size, m, break, J/kg: that of the
    /// smallest t10 above the median fracture energy. Infinite: they never do.
    pub fn breaking_energy_j_kg(&self, size_m: f64) -> f64 {
        let beyond_j_kg =
            -(1.0 - SMALLEST_T10 / self.largest_t10).ln() / self.b_of_size_kg_j(size_m);
        self.median_energy_j_kg(size_m) + beyond_j_kg
    }

    /// t10 from which more energy hardly makes finer pieces.
    pub fn nearly_largest_t10(&self) -> f64 {
        NEARLY_ALL * self.largest_t10
    }

    /// Part of the particles of this size, m, that this energy over mass, J/kg, breaks.
    pub fn broken_share(&self, size_m: f64, energy_j_kg: f64) -> f64 {
        let median_j_kg = self.median_energy_j_kg(size_m);
        if self.energy_scatter == 0.0 {
            return f64::from(u8::from(energy_j_kg > median_j_kg));
        }
        let deviations = (energy_j_kg / median_j_kg).ln() / self.energy_scatter;
        0.5 * libm::erfc(-deviations / std::f64::consts::SQRT_2)
    }

    /// Mean t10 of many particles of this size, m, at this energy over mass, J/kg, those included
    /// that do not break.
    pub fn mean_t10(&self, size_m: f64, energy_j_kg: f64) -> f64 {
        let median_j_kg = self.median_energy_j_kg(size_m);
        if self.energy_scatter == 0.0 {
            return self.t10(size_m, energy_j_kg, median_j_kg);
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for part in 0..=PARTS {
            let deviations = WIDEST * (2.0 * f64::from(part) / f64::from(PARTS) - 1.0);
            let weight = (-0.5 * deviations * deviations).exp();
            let fracture_j_kg = median_j_kg * (self.energy_scatter * deviations).exp();
            sum += weight * self.t10(size_m, energy_j_kg, fracture_j_kg);
            weights += weight;
        }
        sum / weights
    }

    /// Part of the mass of the fragments that passes a sieve of the size of the particle over `n`,
    /// at least 1, given t10.
    pub fn passing(&self, n: f64, t10: f64) -> f64 {
        passing(self.family_exponent, n, t10)
    }
}

/// t_n of the family with this exponent: see [`BreakageLaw::passing`].
pub fn passing(family_exponent: f64, n: f64, t10: f64) -> f64 {
    // 1 for n = 1, where the exponent is infinite.
    let exponent = (9.0 / (n - 1.0).max(0.0)).powf(family_exponent);
    -(exponent * (-t10).ln_1p()).exp_m1()
}

/// Damage by an impact that does not break a particle (Tavares 2009): the fracture energy falls by
/// this part of it. `ratio`: the energy of the impact over the fracture energy, between 0 and 1.
/// `exponent`: gamma, above 2.5; the larger, the less small impacts count.
///
///   D = (2 gamma (1 - D)/(2 gamma - 5 D + 5) ratio)^(2 gamma/5)
pub fn damage(ratio: f64, exponent: f64) -> f64 {
    let right = |damage: f64| {
        let factor = 2.0 * exponent * (1.0 - damage) / (2.0 * exponent - 5.0 * damage + 5.0);
        (factor * ratio).powf(0.4 * exponent)
    };
    // The left side rises with the damage, the right side falls.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle < right(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::{BreakageLaw, damage, passing};

    const LAW: BreakageLaw = BreakageLaw {
        largest_t10: 0.5,
        b_kg_j: 1e-3,
        fracture_energy_j_kg: 100.0,
        energy_scatter: 0.4,
        reference_size_m: 0.03,
        b_exponent: 0.8,
        energy_exponent: 0.6,
        family_exponent: 0.87,
    };

    #[test]
    fn damage_solves_its_equation() {
        for exponent in [3.0, 5.0, 8.0] {
            for ratio in [1e-3, 0.1, 0.5, 0.9, 1.0] {
                let found = damage(ratio, exponent);
                // The equation solved for the ratio.
                let factor = 2.0 * exponent * (1.0 - found) / (2.0 * exponent - 5.0 * found + 5.0);
                let back = found.powf(2.5 / exponent) / factor;
                assert!((back - ratio).abs() < 1e-9, "{exponent} {ratio} {back}");
            }
        }
        assert_eq!(damage(0.0, 5.0), 0.0);
    }

    #[test]
    fn the_family_passes_through_t10_and_ends_at_the_size() {
        for t10 in [0.01, 0.2, 0.6] {
            assert!((passing(0.87, 10.0, t10) - t10).abs() < 1e-15);
            assert_eq!(passing(0.87, 1.0, t10), 1.0);
            let falling = [1.0, 1.2, 2.0, 4.0, 25.0, 50.0, 75.0].map(|n| passing(0.87, n, t10));
            assert!(falling.is_sorted_by(|a, b| a > b), "{falling:?}");
        }
        // Granite, gneiss and quartzite crushed in split Hopkinson bars (Rae et al. 2020): mean
        // t4, t25, t50, t75 of eleven tests with t10 = 37.8 %.
        for (n, measured) in [(4.0, 0.711), (25.0, 0.178), (50.0, 0.108), (75.0, 0.079)] {
            assert!((passing(0.87, n, 0.378) - measured).abs() < 0.01, "t{n}");
        }
    }

    #[test]
    fn energies_of_many_particles_have_the_distribution_that_is_stated() {
        let size_m = 0.012;
        let median_j_kg = LAW.median_energy_j_kg(size_m);
        assert!((median_j_kg - 100.0 * 2.5_f64.powf(0.6)).abs() < 1e-9);
        let count = 40_000;
        let energies: Vec<f64> = (0..count)
            .map(|particle| LAW.own_energy_j_kg(1, particle, size_m))
            .collect();
        for energy_j_kg in [0.5, 0.8, 1.0, 1.5, 2.5].map(|factor| factor * median_j_kg) {
            let broken = energies.iter().filter(|own| **own < energy_j_kg).count();
            let share = broken as f64 / count as f64;
            let stated = LAW.broken_share(size_m, energy_j_kg);
            // Four standard errors.
            assert!((share - stated).abs() < 0.01, "{share} {stated}");
            let t10s = energies
                .iter()
                .map(|own| LAW.t10(size_m, energy_j_kg, *own));
            let mean = t10s.sum::<f64>() / count as f64;
            assert!((mean - LAW.mean_t10(size_m, energy_j_kg)).abs() < 2e-3);
        }
        let sharp = BreakageLaw {
            energy_scatter: 0.0,
            ..LAW
        };
        assert_eq!(sharp.broken_share(0.03, 99.0), 0.0);
        assert_eq!(sharp.broken_share(0.03, 101.0), 1.0);
        let expected = 0.5 * (1.0 - (-0.9_f64).exp());
        assert!((sharp.mean_t10(0.03, 1000.0) - expected).abs() < 1e-15);
    }
}
