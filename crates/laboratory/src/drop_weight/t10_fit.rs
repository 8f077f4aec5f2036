//! A, b, the size exponent of b and the smallest energy, from t10 over energy.

use dem_physics::breakage::BreakageLaw;
use nalgebra::{DMatrix, DVector};

use super::broken_fit::BrokenFit;
use super::estimate::Estimate;
use super::least_squares::{Fitted, Unknown, jacobian, least_squares};
use super::sheet::DropWeightTest;
use crate::fit::median;
use crate::student::student_95;
use crate::units::J_KG_OF_KWH_T;
use dem_physics::breakage::USUAL_FAMILY_EXPONENT;

/// The fitted values: ln(A b), b in t/kWh, which is the slope of t10 at small energies; 1/A, with
/// which the law stays regular where t10 has not bent yet; the size exponent; E_0 in kWh/t.
const SLOPE: usize = 0;
const INVERSE: usize = 1;
const EXPONENT: usize = 2;
const ENERGY: usize = 3;

/// First guesses: A over the largest t10, the exponent, and E_0 over the least energy that gives
/// fragments. The best of them are fitted.
const LARGEST_OVER_T10: [f64; 3] = [1.05, 1.4, 3.0];
const EXPONENTS: [f64; 4] = [-0.5, 0.0, 0.5, 1.0];
const ENERGIES: [f64; 6] = [0.0, 0.3, 0.6, 0.9, 1.5, 3.0];
const BEST: usize = 3;
/// A sum of squares below this part of that of all t10 is rounding.
const ROUNDING: f64 = 1e-18;

/// Where the fracture energy comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EnergyFrom {
    /// From numbers of broken specimens.
    Broken,
    /// From t10: the energy at which it begins to rise.
    T10,
    /// It is 0: what t10 says of it is not significant.
    Insignificant,
    /// It is 0: there are no rows to spare for it.
    TooFewTests,
}

/// The fit of t10.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct T10Fit {
    pub(super) law: BreakageLaw,
    pub(super) largest_t10: Estimate,
    pub(super) b_kg_j: Estimate,
    pub(super) a_times_b_kg_j: Estimate,
    pub(super) b_exponent: Estimate,
    pub(super) fracture_energy_j_kg: Estimate,
    pub(super) energy_from: EnergyFrom,
}

/// What is fitted: tests with t10, and what is known of them.
#[derive(Clone, Copy)]
pub(super) struct T10Data<'a> {
    pub(super) tests: &'a [&'a DropWeightTest],
    pub(super) reference_size_m: f64,
    pub(super) fits_size: bool,
    pub(super) broken: Option<&'a BrokenFit>,
}

impl T10Data<'_> {
    /// Number of values to fit, without E_0.
    pub(super) fn fewest_values(&self) -> usize {
        2 + usize::from(self.fits_size)
    }

    /// Fits t10; needs more tests than values, one of them with a t10 above 0.
    pub(super) fn fit(&self) -> T10Fit {
        let without = self.best(false);
        if self.broken.is_some() {
            return self.evaluated(&without, EnergyFrom::Broken);
        }
        let free = self.tests.len().saturating_sub(self.fewest_values() + 1);
        if free == 0 {
            return self.evaluated(&without, EnergyFrom::TooFewTests);
        }
        let with = self.best(true);
        let sum: f64 = self
            .tests
            .iter()
            .filter_map(|test| test.t10)
            .map(|t10| t10 * t10)
            .sum();
        let gain = without.squares - with.squares;
        let needed = student_95(free).powi(2) * with.squares / free as f64;
        if gain > needed.max(ROUNDING * sum) {
            self.evaluated(&with, EnergyFrom::T10)
        } else {
            self.evaluated(&without, EnergyFrom::Insignificant)
        }
    }

    /// ln(E_0), m and ln(scatter) as the broken specimens give them.
    fn fracture(&self) -> Option<[f64; 3]> {
        let broken = self.broken?;
        Some([
            broken.energy_j_kg.ln(),
            broken.exponent,
            broken.scatter.ln(),
        ])
    }

    /// The law with these values.
    fn law(&self, values: &[f64], fracture: Option<[f64; 3]>) -> BreakageLaw {
        let [energy_j_kg, energy_exponent, scatter] = match fracture {
            Some([energy, exponent, scatter]) => [energy.exp(), exponent, scatter.exp()],
            None => [J_KG_OF_KWH_T * values[ENERGY], values[EXPONENT], 0.0],
        };
        BreakageLaw {
            largest_t10: 1.0 / values[INVERSE],
            b_kg_j: values[SLOPE].exp() * values[INVERSE] / J_KG_OF_KWH_T,
            fracture_energy_j_kg: energy_j_kg,
            energy_scatter: scatter,
            reference_size_m: self.reference_size_m,
            b_exponent: values[EXPONENT],
            energy_exponent,
            family_exponent: USUAL_FAMILY_EXPONENT,
        }
    }

    /// Fitted minus measured t10.
    fn residuals(&self, law: &BreakageLaw) -> DVector<f64> {
        let one = |test: &&DropWeightTest| {
            law.mean_t10(test.size_m, test.energy_j_kg) - test.t10.unwrap_or_default()
        };
        DVector::from_iterator(self.tests.len(), self.tests.iter().map(one))
    }

    /// The best fit from all first guesses; `fits_energy`: with E_0, which is 0 otherwise.
    fn best(&self, fits_energy: bool) -> Fitted {
        let fracture = self.fracture();
        let residuals = |values: &[f64]| self.residuals(&self.law(values, fracture));
        let mut guesses: Vec<(f64, Vec<f64>)> = (self.guesses(fits_energy).into_iter())
            .map(|values| (residuals(&values).norm_squared(), values))
            .collect();
        guesses.sort_by(|one, other| one.0.total_cmp(&other.0));
        let fits = guesses
            .iter()
            .take(BEST)
            .map(|(_, values)| least_squares(&self.unknowns(values, fits_energy), &residuals));
        let best = fits.min_by(|one, other| one.squares.total_cmp(&other.squares));
        best.unwrap_or_else(|| {
            least_squares(&self.unknowns(&[0.0, 2.0, 0.0, 0.0], false), &residuals)
        })
    }

    fn unknowns(&self, start: &[f64], fits_energy: bool) -> [Unknown; 4] {
        let unknown = |at: usize, least: f64, is_free: bool| Unknown {
            start: start[at],
            least,
            is_free,
        };
        [
            unknown(SLOPE, f64::NEG_INFINITY, true),
            unknown(INVERSE, 1.0, true),
            unknown(EXPONENT, f64::NEG_INFINITY, self.fits_size),
            unknown(ENERGY, 0.0, fits_energy),
        ]
    }

    /// Values on a grid; the slope of each is the median of those that make it meet a test.
    fn guesses(&self, fits_energy: bool) -> Vec<Vec<f64>> {
        let measured = || {
            self.tests
                .iter()
                .filter_map(|test| Some((*test, test.t10?)))
        };
        let largest = measured().map(|(_, t10)| t10).fold(0.0, f64::max);
        let exponents = if self.fits_size {
            &EXPONENTS[..]
        } else {
            &[0.0]
        };
        let parts = if fits_energy { &ENERGIES[..] } else { &[0.0] };
        let mut guesses = Vec::new();
        for over in LARGEST_OVER_T10 {
            let inverse = (1.0 / (over * largest)).max(1.0);
            for exponent in exponents {
                // Energies as at the reference size, kWh/t.
                let scaled = |test: &DropWeightTest| {
                    let size = (test.size_m / self.reference_size_m).powf(*exponent);
                    size * test.energy_j_kg / J_KG_OF_KWH_T
                };
                let broke = measured().filter(|(_, t10)| *t10 > 0.0);
                let least = broke
                    .map(|(test, _)| scaled(test))
                    .fold(f64::INFINITY, f64::min);
                for part in parts {
                    let energy = part * least;
                    let slopes: Vec<f64> = measured()
                        .map(|(test, t10)| (scaled(test) - energy, t10))
                        .filter(|(beyond, t10)| *beyond > 0.0 && *t10 > 0.0)
                        .map(|(beyond, t10)| {
                            -(-(inverse * t10).min(0.95)).ln_1p() / (inverse * beyond)
                        })
                        .collect();
                    if !slopes.is_empty() {
                        guesses.push(vec![median(&slopes).ln(), inverse, *exponent, energy]);
                    }
                }
            }
        }
        guesses
    }

    /// The numbers of a fit with their intervals.
    fn evaluated(&self, fitted: &Fitted, energy_from: EnergyFrom) -> T10Fit {
        let values = &fitted.values;
        let law = self.law(values, self.fracture());
        let free = self.tests.len().saturating_sub(fitted.inner.len());
        let covariance = self.covariance(fitted, free);
        let student = student_95(free);
        // Half width of the interval of a sum of values with these factors.
        let half = |factors: &[(usize, f64)]| {
            let covariance = covariance.as_ref()?;
            let mut variance = 0.0;
            for (one, factor) in factors {
                for (other, other_factor) in factors {
                    variance += factor * other_factor * covariance[(*one, *other)];
                }
            }
            Some(student * variance.max(0.0).sqrt())
        };
        let inverse = values[INVERSE];
        let largest_t10 = if fitted.inner.contains(&INVERSE) {
            let most = |half: f64| 1.0 / (inverse - half).max(1.0);
            let interval = half(&[(INVERSE, 1.0)]).map(|half| [1.0 / (inverse + half), most(half)]);
            Estimate {
                interval,
                ..Estimate::fitted(law.largest_t10)
            }
        } else {
            let interval = self.least_largest(fitted, free).map(|least| [least, 1.0]);
            Estimate {
                interval,
                ..Estimate::assumed(law.largest_t10)
            }
        };
        let exponent = match self.fits_size {
            true => Estimate::within(values[EXPONENT], half(&[(EXPONENT, 1.0)])),
            false => Estimate::assumed(0.0),
        };
        let energy = match energy_from {
            EnergyFrom::T10 => {
                let half = half(&[(ENERGY, J_KG_OF_KWH_T)]);
                let interval = half.map(|half| {
                    let value = law.fracture_energy_j_kg;
                    [(value - half).max(0.0), value + half]
                });
                Estimate {
                    interval,
                    ..Estimate::fitted(law.fracture_energy_j_kg)
                }
            }
            _ => Estimate::assumed(law.fracture_energy_j_kg),
        };
        T10Fit {
            largest_t10,
            b_kg_j: Estimate::within_factor(
                law.b_kg_j,
                half(&[(SLOPE, 1.0), (INVERSE, 1.0 / inverse)]),
            ),
            a_times_b_kg_j: Estimate::within_factor(
                law.largest_t10 * law.b_kg_j,
                half(&[(SLOPE, 1.0)]),
            ),
            b_exponent: exponent,
            fracture_energy_j_kg: energy,
            energy_from,
            law,
        }
    }

    /// Covariance of the values, 0 for those that are not fitted. What the broken specimens leave
    /// open of the fracture energies is part of it.
    fn covariance(&self, fitted: &Fitted, free: usize) -> Option<DMatrix<f64>> {
        let fracture = self.fracture();
        let residuals = |values: &[f64]| self.residuals(&self.law(values, fracture));
        let slopes = jacobian(&fitted.values, &fitted.inner, &residuals);
        let inverse = (slopes.tr_mul(&slopes)).try_inverse()?;
        let mut inner = &inverse * (fitted.squares / free.max(1) as f64);
        if let (Some(broken), Some(fracture)) = (self.broken, fracture) {
            let residuals = |fracture: &[f64]| {
                let [energy, exponent, scatter] = [0, 1, 2].map(|at| fracture[at]);
                self.residuals(&self.law(&fitted.values, Some([energy, exponent, scatter])))
            };
            let by_fracture = jacobian(&fracture, &[0, 1, 2], &residuals);
            let moved = &inverse * slopes.tr_mul(&by_fracture);
            let known = DMatrix::from_iterator(3, 3, broken.covariance.iter().copied());
            inner += &moved * known * moved.transpose();
        }
        let mut all = DMatrix::zeros(fitted.values.len(), fitted.values.len());
        for (row, at) in fitted.inner.iter().enumerate() {
            for (column, other) in fitted.inner.iter().enumerate() {
                all[(*at, *other)] = inner[(row, column)];
            }
        }
        Some(all)
    }

    /// Lower end of the interval of A where the best A is at its bound of 1: the sum of squares of
    /// the best fit with a smaller A is larger by as much as chance allows. None: there is none.
    fn least_largest(&self, fitted: &Fitted, free: usize) -> Option<f64> {
        let fracture = self.fracture();
        let residuals = |values: &[f64]| self.residuals(&self.law(values, fracture));
        let most = fitted.squares * (1.0 + student_95(free).powi(2) / free.max(1) as f64);
        let is_likely = |inverse: f64| {
            let mut start = fitted.values.clone();
            start[INVERSE] = inverse;
            let mut unknowns = self.unknowns(&start, fitted.inner.contains(&ENERGY));
            unknowns[INVERSE].is_free = false;
            least_squares(&unknowns, &residuals).squares <= most
        };
        let mut high = (1..50)
            .map(|step| 1.1_f64.powi(step))
            .find(|high| !is_likely(*high))?;
        let mut low = high / 1.1;
        for _ in 0..20 {
            let middle = f64::midpoint(low, high);
            if is_likely(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(1.0 / low)
    }
}
