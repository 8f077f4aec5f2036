//! First factors of a calibration, from equilibria without time steps: modulus and contacts are
//! springs in series; a body fails when its most loaded bonds do.

use std::sync::atomic::Ordering;
use std::time::Instant;

use dem_calibration::{Start, Unknown, pace};
use dem_io::Result;
use dem_io::diagnostic::Kind;
use dem_io::units::show_quantity;
use dem_laboratory::TestType;
use dem_laboratory::test_result::STIFFNESS;
use dem_plan::measure::bond_utilisation;
use dem_rig::elastic_test::elastic_test;
use dem_rig::evaluate::{BY_TRAVEL, EQ_18, MODULUS, STRENGTH};
use dem_scene::Test;

use super::bench::{Bench, wanted_n};
use super::choice::has_all_strengths;

/// First factors beyond this range are left to the tests with steps, which say why.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 1e-3..=1e3;
/// Least change of the logarithm of the modulus of bonds that shows the part of the contacts.
const LEAST_CHANGE: f64 = 0.2;
/// Solutions of the first packing at most.
const MOST_SOLUTIONS: usize = 4;
/// Least slope of ln(result) over ln(factor) by which a first modulus is corrected.
const LEAST_SLOPE: f64 = 0.25;
/// How much stiffer bonds may have to be before it is asked whether that helps.
const MUCH_STIFFER: f64 = 10.0;

/// What is known before the first round.
pub(crate) enum Beginning {
    /// Nothing: it begins with the numbers of the scene.
    Unknown,
    /// The first factors.
    Start(Start),
    /// The modulus cannot be met: problem and remedy.
    OutOfReach(String, String),
}

/// Part of the bonds whose stress in the whole body is above their strength when it fails, as found
/// in calibrations: a bar breaks where it is bent the most, a compressed body bears on when
/// many of its bonds have broken.
fn failed_bonds(kind: TestType) -> f64 {
    match kind {
        TestType::FourPointBending | TestType::ThreePointBending => 0.0005,
        TestType::Compression => 0.05,
        _ => 0.015,
    }
}

/// The [`pace`] of a test.
pub(crate) fn pace_of(test: &Test, travel_m: f64, mean_diameter_m: f64) -> Vec<String> {
    let periods = test.rate_m_s.is_none().then_some(test.periods);
    pace(test.stroke_m, periods, travel_m, mean_diameter_m)
}

/// What equilibria of all packings say in the mean.
struct Elastic {
    /// The result that stands for the stiffness.
    result: f64,
    /// Travel at the wanted load, with the way until all touches, m; the largest of the packings.
    /// None: there is no strength to meet.
    travel_m: Option<f64>,
    /// Stress over strength of the bonds at the wanted load: below it are all but a small part.
    utilisation: f64,
}

impl Bench<'_> {
    /// First factors: on the modulus of the bonds, with which packings have the wanted stiffness in
    /// equilibria without time steps; on their strength, with which a small part of the bonds is at
    /// its strength under the wanted load.
    pub(crate) fn start(&self) -> Result<Beginning> {
        let unknowns = self.unknowns;
        let of_test = [STIFFNESS, EQ_18, BY_TRAVEL, MODULUS, STRENGTH];
        let is_of_test = |unknown: &Unknown| of_test.contains(&unknown.result.as_str());
        if !unknowns
            .iter()
            .all(|one| one.is_proportional && is_of_test(one))
        {
            return Ok(Beginning::Unknown);
        }
        let began = Instant::now();
        let mut factors = vec![1.0; unknowns.len()];
        let mut slopes = vec![1.0; unknowns.len()];
        let mut tests = self.packings.len();
        let stiffness = unknowns
            .iter()
            .position(|unknown| unknown.result != STRENGTH);
        if let Some(which) = stiffness {
            let (factor, slope, solutions) = match self.springs(which)? {
                Ok(found) => found,
                Err(ended) => return Ok(ended),
            };
            (factors[which], slopes[which]) = (factor, slope);
            tests += solutions;
        }
        let result = stiffness.map_or(STIFFNESS, |which| &unknowns[which].result);
        let Some(found) = self.equilibria(&factors, result)? else {
            return Ok(Beginning::Unknown);
        };
        if let Some(which) = stiffness {
            let slope = slopes[which].max(LEAST_SLOPE);
            factors[which] *= (unknowns[which].target / found.result).powf(1.0 / slope);
        }
        for (unknown, factor) in unknowns.iter().zip(&mut factors) {
            let is_strength =
                unknown.result == STRENGTH && has_all_strengths(&self.scene, unknown)?;
            if is_strength && PLAUSIBLE.contains(&found.utilisation) {
                *factor = found.utilisation;
            }
        }
        Ok(Beginning::Start(Start {
            factors,
            slopes,
            travel_m: found.travel_m,
            tests,
            wall_s: began.elapsed().as_secs_f64(),
        }))
    }

    /// From the stiffness of the first packing: the factor with which it meets the target, the
    /// slope there, and the number of solutions that it took.
    fn springs(&self, which: usize) -> Result<std::result::Result<(f64, f64, usize), Beginning>> {
        let unknown = &self.unknowns[which];
        let mut factors = vec![1.0; self.unknowns.len()];
        let mut points: Vec<[f64; 2]> = Vec::new();
        loop {
            let Some(found) = self.equilibrium(&factors, 0, &unknown.result)? else {
                return Ok(Err(Beginning::Unknown));
            };
            points.push([factors[which], found.result]);
            let springs = Springs::of(&points);
            let is_last = points.len() == MOST_SOLUTIONS;
            let most = MUCH_STIFFER * points.iter().map(|[factor, _]| *factor).fold(1.0, f64::max);
            let next = match springs.factor_for(unknown.target) {
                Some(factor) if points.len() > 1 && (factor < most || is_last) => {
                    return Ok(Ok((factor, springs.slope(factor), points.len())));
                }
                None if is_last => {
                    return Ok(Err(out_of_reach(unknown, factors[which], found.result)));
                }
                factor => factor.map_or(most, |factor| factor.min(most)),
            };
            let change = (next / factors[which]).ln();
            factors[which] *= (change.signum() * change.abs().max(LEAST_CHANGE)).exp();
            if !PLAUSIBLE.contains(&factors[which]) {
                return Ok(Err(Beginning::Unknown));
            }
        }
    }

    /// Equilibria of all packings, and the mean of what they say. None: one has none.
    fn equilibria(&self, factors: &[f64], result: &str) -> Result<Option<Elastic>> {
        let mut all = Vec::new();
        for at in 0..self.packings.len() {
            match self.equilibrium(factors, at, result)? {
                Some(one) => all.push(one),
                None => return Ok(None),
            }
        }
        let mean = |of: fn(&Elastic) -> f64| -> f64 {
            all.iter().map(|one| of(one) / all.len() as f64).sum()
        };
        Ok(Some(Elastic {
            result: mean(|one| one.result),
            travel_m: all.iter().filter_map(|one| one.travel_m).reduce(f64::max),
            utilisation: mean(|one| one.utilisation),
        }))
    }

    /// The equilibria of packing `at`. None: there are none.
    fn equilibrium(&self, factors: &[f64], at: usize, result: &str) -> Result<Option<Elastic>> {
        let (scene, mut plan, setup, _) = self.planned(factors, at, 1.0)?;
        let goes_on = |_: f64| !self.interrupted.load(Ordering::Relaxed);
        let (Some(setup), Some(test)) = (setup, &scene.test) else {
            return Ok(None);
        };
        let found = match elastic_test(&mut plan.state, &scene, &setup, &goes_on) {
            Ok(found) => found,
            Err(error) if error.kind == Kind::Interrupted => return Err(error),
            // The tests themselves say more.
            Err(_) => return Ok(None),
        };
        let figures = [result, STIFFNESS].map(|name| found.figure(name));
        let ([Some(result), Some(stiffness_n_m)], Some(last)) = (figures, found.rows.last()) else {
            return Ok(None);
        };
        let state = &plan.state;
        let mut utilisations: Vec<f64> = (0..state.bonds.len())
            .map(|at| bond_utilisation(state, at))
            .collect();
        utilisations.sort_by(|a, b| b.total_cmp(a));
        let above = (failed_bonds(test.kind) * utilisations.len() as f64) as usize;
        let wanted_n = wanted_n(test, &setup.specimen);
        let at_wanted = wanted_n.zip(utilisations.get(above));
        let further_m = |wanted_n: f64| (wanted_n - last.load_n()) / stiffness_n_m;
        Ok(Some(Elastic {
            result,
            travel_m: wanted_n.map(|wanted_n| last.travel_m + further_m(wanted_n)),
            utilisation: at_wanted.map_or(0.0, |(wanted_n, one)| one * wanted_n / last.load_n()),
        }))
    }
}

/// The stiffness 1/(a + b/f) of a body whose bonds are f times as stiff: contacts deform as well.
struct Springs {
    /// 1/result of the contacts alone.
    contacts: f64,
    /// 1/result of the bonds at a factor of 1.
    bonds: f64,
}

impl Springs {
    /// Through the last two of these factors and results, at least one; a single one knows no
    /// contacts.
    fn of(points: &[[f64; 2]]) -> Self {
        let last = points[points.len() - 1];
        let alone = Self {
            contacts: 0.0,
            bonds: last[0] / last[1],
        };
        let Some(before) = points.len().checked_sub(2).map(|at| points[at]) else {
            return alone;
        };
        let bonds = (1.0 / last[1] - 1.0 / before[1]) / (1.0 / last[0] - 1.0 / before[0]);
        match bonds > 0.0 {
            true => Self {
                contacts: (1.0 / last[1] - bonds / last[0]).max(0.0),
                bonds,
            },
            false => alone,
        }
    }

    /// The factor for a result. None: the contacts alone are softer.
    fn factor_for(&self, target: f64) -> Option<f64> {
        let left = 1.0 / target - self.contacts;
        (left > 0.0).then(|| self.bonds / left)
    }

    /// d ln(result)/d ln(factor).
    fn slope(&self, factor: f64) -> f64 {
        let bonds = self.bonds / factor;
        bonds / (self.contacts + bonds)
    }
}

fn out_of_reach(unknown: &Unknown, factor: f64, result: f64) -> Beginning {
    let show = |value: f64| show_quantity(value, &unknown.unit);
    let number = &unknown.numbers[0];
    let problem = format!(
        "the {} of {} is out of reach: with {} of {} it is {}, as the contacts at pins or plates deform",
        unknown.result,
        show(unknown.target),
        number.path,
        number.text(factor),
        show(result)
    );
    let remedy = match unknown.result.as_str() {
        MODULUS => "take smaller spheres, or correct the target",
        _ => {
            "calibrate the modulus of the specimen itself: --modulus specimen; or take smaller spheres, or correct the target"
        }
    };
    Beginning::OutOfReach(problem, remedy.to_owned())
}

#[cfg(test)]
mod tests {
    use super::Springs;

    #[test]
    fn bonds_and_contacts_are_springs_in_series() {
        let stiffness = |factor: f64| 1.0 / (0.1 + 0.05 / factor);
        let springs = Springs::of(&[1.0, 3.0].map(|factor| [factor, stiffness(factor)]));
        let factor = springs.factor_for(8.0).map_or(0.0, |factor| factor - 2.0);
        assert!(factor.abs() < 1e-9, "{factor}");
        assert!(springs.factor_for(10.01).is_none());
        let [low, high] = [1.99, 2.01].map(stiffness);
        let slope = (high / low).ln() / (2.01_f64 / 1.99).ln();
        assert!((springs.slope(2.0) / slope - 1.0).abs() < 1e-4);
    }
}
