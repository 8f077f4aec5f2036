//! Which steps are stable for each body alone: the largest eigenvalues of all bodies at once, by
//! Lanczos' method on each.

use dem_io::random::uniform;

use super::limit::{
    Field, ITERATIONS, add_stiffness_times, clear_trial_wrenches, inverse_mass_roots, largest_ritz,
};
use crate::state::State;

/// The search for an eigenvalue ends at this ratio of residual to eigenvalue.
const RESIDUAL: f64 = 1e-4;
/// Beyond the least number of iterations, one in so many asks whether it was enough.
const EVERY: usize = 5;

/// For each body, alone in space, the largest eigenvalue of M^-1 K, 1/s2; 0 for single particles.
/// What counts is said at [`super::limit::limit`]. `body_of`: the number of the body of each
/// particle; bodies are not joined by bonds. Afterwards no wrench acts on any particle.
pub(crate) fn own_eigenvalues(state: &mut State, body_of: &[u32]) -> Vec<f64> {
    let found = largest_eigenvalues(state, body_of);
    clear_trial_wrenches(state);
    found
}

/// Lanczos' method on one body.
#[derive(Debug, Clone, Default)]
struct Search {
    particles: usize,
    /// Lanczos' tridiagonal matrix.
    diagonal: Vec<f64>,
    beside: Vec<f64>,
    beta: f64,
    is_done: bool,
    /// The eigenvalue, and how far it may be off.
    largest: (f64, f64),
}

impl Search {
    /// Takes the next row of the matrix, and ends the search if that is enough.
    fn take(&mut self, alpha: f64, beta: f64) {
        self.diagonal.push(alpha);
        self.beta = beta;
        let iteration = self.diagonal.len();
        let most = ITERATIONS[1].min(6 * self.particles);
        let is_last = iteration >= most || beta <= 1e-13 * alpha.abs();
        if is_last || (iteration >= ITERATIONS[0] && iteration.is_multiple_of(EVERY)) {
            self.largest = largest_ritz(&self.diagonal, &self.beside, beta);
            let (value, residual) = self.largest;
            self.is_done = is_last || residual <= RESIDUAL * value;
        }
        self.beside.push(beta);
    }
}

/// For each body the largest eigenvalue of stiffness over mass, without contacts; 0 for single
/// particles.
fn largest_eigenvalues(state: &mut State, body_of: &[u32]) -> Vec<f64> {
    let roots = inverse_mass_roots(state);
    let mut displaced = state.particles.poses.clone();
    let mut searches: Vec<Search> = Vec::new();
    for &body in body_of {
        let body = body as usize;
        searches.resize(searches.len().max(body + 1), Search::default());
        searches[body].particles += 1;
    }
    for search in &mut searches {
        search.is_done = search.particles < 2;
    }
    let mut present: Field = roots.clone();
    for (n, root) in (0..).zip(present.as_flattened_mut()) {
        *root = 2.0 * uniform(0, &[n]) - 1.0;
    }
    let lengths = dots(&present, &present, body_of, searches.len());
    let inverse = |(length, search): (&f64, &Search)| {
        if search.is_done {
            0.0
        } else {
            1.0 / length.sqrt()
        }
    };
    let factors: Vec<f64> = lengths.iter().zip(&searches).map(inverse).collect();
    scale(&mut present, &factors, body_of);
    let mut before: Field = vec![[0.0; 6]; roots.len()];
    while searches.iter().any(|search| !search.is_done) {
        let mut image = before;
        let factors: Vec<f64> = searches.iter().map(|search| -search.beta).collect();
        scale(&mut image, &factors, body_of);
        add_stiffness_times(
            state,
            1.0,
            &roots,
            &present,
            None,
            &mut displaced,
            &mut image,
        );
        let alphas = dots(&image, &present, body_of, searches.len());
        for ((image, present), &body) in image.iter_mut().zip(&present).zip(body_of) {
            for (image, present) in image.iter_mut().zip(present) {
                *image -= alphas[body as usize] * present;
            }
        }
        let betas = dots(&image, &image, body_of, searches.len());
        let searching = searches.iter_mut().zip(alphas.iter().zip(betas));
        let factors: Vec<f64> = searching
            .map(|(search, (&alpha, beta_squared))| {
                if !search.is_done {
                    search.take(alpha, beta_squared.sqrt());
                }
                if search.is_done {
                    0.0
                } else {
                    1.0 / search.beta
                }
            })
            .collect();
        scale(&mut image, &factors, body_of);
        before = std::mem::replace(&mut present, image);
    }
    let value = |search: Search| (search.largest.0 + search.largest.1).max(0.0);
    searches.into_iter().map(value).collect()
}

/// Multiplies the entries of each body by its factor.
fn scale(field: &mut Field, factors: &[f64], body_of: &[u32]) {
    for (of_particle, &body) in field.iter_mut().zip(body_of) {
        of_particle
            .iter_mut()
            .for_each(|x| *x *= factors[body as usize]);
    }
}

/// For each body the scalar product of two fields.
fn dots(a: &Field, b: &Field, body_of: &[u32], bodies: usize) -> Vec<f64> {
    let mut sums = vec![0.0; bodies];
    for ((a, b), &body) in a.iter().zip(b).zip(body_of) {
        sums[body as usize] += (0..6).map(|k| a[k] * b[k]).sum::<f64>();
    }
    sums
}
