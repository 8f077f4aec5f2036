//! Keeps the size distribution correct where spheres are chosen to fill voids: classes of sizes
//! that have exceeded their quota are drawn less often.

/// Numbers of spheres of each class of sizes that have been placed, drawn or chosen. The classes
/// are equal fractions of the distribution by number.
#[derive(Debug, Clone)]
pub(crate) struct SizeQuota {
    placed: Vec<f64>,
    total: f64,
    /// The quota of each class during the draws, as a fraction of all spheres: less than equal for
    /// classes from which voids will take more at the end.
    quotas: Vec<f64>,
}

impl SizeQuota {
    /// For a packing of about this number of spheres. More classes would distinguish sizes better,
    /// but have fewer spheres each and are drawn less often. With the number chosen, both errors
    /// stay a fraction of the statistical noise of a random sample.
    pub(crate) fn new(spheres: f64) -> Self {
        let classes = (0.7 * spheres.sqrt()).clamp(1.0, 1e4) as usize;
        Self {
            placed: vec![0.0; classes],
            total: 0.0,
            quotas: vec![1.0 / classes as f64; classes],
        }
    }

    /// For another attempt that holds back the final surplus of each class. A surplus that exceeds
    /// the quota of its class is held back from the next larger ones, so that the number of spheres
    /// up to most sizes is then correct.
    pub(crate) fn corrected(&self) -> Self {
        let classes = self.placed.len();
        let mut owed = 0.0;
        let mut quotas: Vec<f64> = self
            .quotas
            .iter()
            .zip(&self.placed)
            .map(|(quota, placed)| {
                let left = quota - (placed / self.total.max(1.0) - 1.0 / classes as f64) - owed;
                owed = (-left).max(0.0);
                left.max(0.0)
            })
            .collect();
        let sum: f64 = quotas.iter().sum();
        quotas.iter_mut().for_each(|quota| *quota /= sum);
        Self {
            placed: vec![0.0; classes],
            total: 0.0,
            quotas,
        }
    }

    /// A sphere of quantile `u` (0 to 1) was placed.
    pub(crate) fn place(&mut self, u: f64) {
        let class = class_of(u, self.placed.len());
        self.placed[class] += 1.0;
        self.total += 1.0;
    }

    /// For each class, the probability that a draw is left out, if about this number of draws are
    /// made before the next check. It removes half of the surplus, since the number is a guess.
    pub(crate) fn fractions_left_out(&self, draws: usize) -> Vec<f64> {
        let draws_of_class = draws as f64 / self.placed.len() as f64;
        self.surplus(&self.quotas)
            .map(|surplus| (0.5 * surplus / draws_of_class).max(0.0))
            .collect()
    }

    /// Largest surplus of spheres up to any size over the target number.
    pub(crate) fn too_many(&self) -> f64 {
        largest_sum(self.surplus(&self.quotas))
    }

    /// Largest error of the number of spheres up to any size.
    pub(crate) fn imbalance(&self) -> f64 {
        let equal = vec![1.0 / self.placed.len() as f64; self.placed.len()];
        largest_sum(self.surplus(&equal)).max(largest_sum(self.surplus(&equal).map(|s| -s)))
    }

    fn surplus(&self, quotas: &[f64]) -> impl Iterator<Item = f64> {
        self.placed
            .iter()
            .zip(quotas)
            .map(|(placed, quota)| placed - self.total * quota)
    }
}

/// The largest partial sum of a sequence.
fn largest_sum(row: impl Iterator<Item = f64>) -> f64 {
    let mut sum = 0.0;
    row.fold(0.0, |most: f64, x| {
        sum += x;
        most.max(sum)
    })
}

/// The class of a quantile among this number of classes.
pub(super) fn class_of(u: f64, classes: usize) -> usize {
    ((u * classes as f64) as usize).min(classes - 1)
}
