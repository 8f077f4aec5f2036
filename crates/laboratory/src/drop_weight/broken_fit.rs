//! Fracture energies from the numbers of specimens that break, by maximum likelihood.

use nalgebra::{Matrix3, Vector3};

use super::sheet::DropWeightTest;

/// Most steps.
const MOST_STEPS: usize = 100;
/// A smaller scatter cannot be told from none.
const LEAST_SCATTER: f64 = 0.01;
/// Probabilities of 0 and 1 are those of numbers within this.
const LEAST_PROBABILITY: f64 = 1e-12;

/// The distribution of fracture energies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BrokenFit {
    /// Median at the reference size, J/kg.
    pub(super) energy_j_kg: f64,
    /// Power of the size with which it falls.
    pub(super) exponent: f64,
    /// Standard deviation of the natural logarithm.
    pub(super) scatter: f64,
    /// Covariance of the logarithm of the median, the exponent and the logarithm of the scatter.
    pub(super) covariance: Matrix3<f64>,
    /// Sum of (broken - expected)²/variance over the degrees of freedom. None: there are none.
    pub(super) dispersion: Option<f64>,
}

/// Rows as they are fitted: 1, ln(E/E_r), ln(x/x_0) or 0, number of specimens, broken ones.
struct Row {
    at: Vector3<f64>,
    count: f64,
    broken: f64,
}

/// The fit of P = Phi(beta . (1, ln(E/E_r), ln(x/x_0))), a probit regression, by Fisher scoring:
/// its likelihood has a single maximum. `fits_size`: whether energies depend on the size.
///
/// # Errors
/// A sentence that says why there is no maximum.
pub(super) fn fit_broken(
    tests: &[DropWeightTest],
    reference_size_m: f64,
    fits_size: bool,
) -> Result<BrokenFit, String> {
    let measured: Vec<(&DropWeightTest, [f64; 2])> = (tests.iter())
        .filter_map(|test| Some((test, test.broken?)))
        .collect();
    let shares = || measured.iter().map(|(_, [count, broken])| broken / count);
    if shares().all(|share| share == 1.0) || shares().all(|share| share == 0.0) {
        return Err("all specimens broke, or none".to_owned());
    }
    let logarithms = measured.iter().map(|(test, _)| test.energy_j_kg.ln());
    let centre = logarithms.sum::<f64>() / measured.len() as f64;
    let row = |(test, [count, broken]): &(&DropWeightTest, [f64; 2])| {
        let size = if fits_size {
            (test.size_m / reference_size_m).ln()
        } else {
            0.0
        };
        let at = Vector3::new(1.0, test.energy_j_kg.ln() - centre, size);
        Row {
            at,
            count: *count,
            broken: *broken,
        }
    };
    let rows: Vec<Row> = measured.iter().map(row).collect();
    let (beta, covariance) = maximum(&rows, fits_size)
        .ok_or("no energies break some specimens and leave others whole, in enough rows")?;
    let [shift, slope, size] = [beta[0], beta[1], beta[2]];
    if slope <= 0.0 {
        return Err("the share of broken specimens does not rise with the energy".to_owned());
    }
    // Of (-shift/slope, size/slope, -ln(slope)) by (shift, slope, size).
    let slopes = Matrix3::new(
        -1.0,
        shift / slope,
        0.0,
        0.0,
        -size / slope,
        1.0,
        0.0,
        -1.0,
        0.0,
    ) / slope;
    let free = rows.len().saturating_sub(2 + usize::from(fits_size));
    let dispersion = (free > 0).then(|| pearson(&rows, &beta) / free as f64);
    Ok(BrokenFit {
        energy_j_kg: (centre - shift / slope).exp(),
        exponent: size / slope,
        scatter: 1.0 / slope,
        covariance: slopes * covariance * slopes.transpose(),
        dispersion,
    })
}

/// The coefficients of largest likelihood, and their covariance. None: there is no maximum.
fn maximum(rows: &[Row], fits_size: bool) -> Option<(Vector3<f64>, Matrix3<f64>)> {
    let mut beta = Vector3::new(0.0, 1.0, 0.0);
    for _ in 0..MOST_STEPS {
        let (score, information) = score(rows, &beta, fits_size);
        let covariance = information.try_inverse()?;
        let mut step = covariance * score;
        let before = likelihood(rows, &beta);
        while likelihood(rows, &(beta + step)) < before - 1e-12 * before.abs() {
            step *= 0.5;
            if step.norm() < 1e-12 {
                break;
            }
        }
        beta += step;
        if beta[1] > 1.0 / LEAST_SCATTER {
            return None;
        }
        if step.norm() < 1e-12 * beta.norm() {
            let mut covariance = covariance;
            if !fits_size {
                covariance[(2, 2)] = 0.0;
            }
            return Some((beta, covariance));
        }
    }
    None
}

/// Probability of breaking, and its derivative by z = beta . at.
fn probability(row: &Row, beta: &Vector3<f64>) -> (f64, f64) {
    let z = row.at.dot(beta);
    let probability = 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
    let density = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    (
        probability.clamp(LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY),
        density,
    )
}

/// Gradient of the logarithm of the likelihood, and Fisher's information.
fn score(rows: &[Row], beta: &Vector3<f64>, fits_size: bool) -> (Vector3<f64>, Matrix3<f64>) {
    let (mut score, mut information) = (Vector3::zeros(), Matrix3::zeros());
    for row in rows {
        let (share, density) = probability(row, beta);
        let weight = density / (share * (1.0 - share));
        score += weight * (row.broken - row.count * share) * row.at;
        information += weight * density * row.count * row.at * row.at.transpose();
    }
    if !fits_size {
        information[(2, 2)] = 1.0;
    }
    (score, information)
}

fn likelihood(rows: &[Row], beta: &Vector3<f64>) -> f64 {
    let one = |row: &Row| {
        let (share, _) = probability(row, beta);
        row.broken * share.ln() + (row.count - row.broken) * (-share).ln_1p()
    };
    rows.iter().map(one).sum()
}

fn pearson(rows: &[Row], beta: &Vector3<f64>) -> f64 {
    let one = |row: &Row| {
        let (share, _) = probability(row, beta);
        (row.broken - row.count * share).powi(2) / (row.count * share * (1.0 - share))
    };
    rows.iter().map(one).sum()
}
