//! Keeps the sizes true where spheres are chosen to fill voids: classes of sizes that have had more than their share are drawn less often.

/// How many spheres of each class of sizes have been placed, drawn or chosen. The classes are equal shares of the distribution by number.
#[derive(Debug, Clone)]
pub struct Ledger {
    placed: Vec<f64>,
    total: f64,
    /// The share of each class while there are draws: less than equal where voids will take more at the end.
    shares: Vec<f64>,
}

impl Ledger {
    /// For a packing of about so many spheres. More classes would tell sizes better apart, but have fewer spheres each, and draws hit them
    /// more seldom: with so many both errors stay a part of the noise of as many draws.
    pub fn new(spheres: f64) -> Self {
        let classes = (0.7 * spheres.sqrt()).clamp(1.0, 1e4) as usize;
        Self {
            placed: vec![0.0; classes],
            total: 0.0,
            shares: vec![1.0 / classes as f64; classes],
        }
    }

    /// For another attempt that keeps back what each class has had too many of in the end, and what is more than all of it from the next
    /// larger ones: the number of spheres up to most sizes is true then.
    pub fn corrected(&self) -> Self {
        let classes = self.placed.len();
        let mut owed = 0.0;
        let mut shares: Vec<f64> = self
            .shares
            .iter()
            .zip(&self.placed)
            .map(|(share, placed)| {
                let left = share - (placed / self.total.max(1.0) - 1.0 / classes as f64) - owed;
                owed = (-left).max(0.0);
                left.max(0.0)
            })
            .collect();
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        Self {
            placed: vec![0.0; classes],
            total: 0.0,
            shares,
        }
    }

    /// A sphere of quantile `u` (0 to 1) was placed.
    pub fn place(&mut self, u: f64) {
        let class = class_of(u, self.placed.len());
        self.placed[class] += 1.0;
        self.total += 1.0;
    }

    /// For each class the probability with which a draw is to be left out, if about so many are to be made before the next look:
    /// half of what would even out all, since the number is a guess.
    pub fn shares_left_out(&self, draws: usize) -> Vec<f64> {
        let draws_of_class = draws as f64 / self.placed.len() as f64;
        self.surplus(&self.shares)
            .map(|surplus| (0.5 * surplus / draws_of_class).max(0.0))
            .collect()
    }

    /// By how many spheres there are more up to some size than aimed at, at most.
    pub fn too_many(&self) -> f64 {
        largest_sum(self.surplus(&self.shares))
    }

    /// By how many spheres the number up to some size is off, at most.
    pub fn imbalance(&self) -> f64 {
        let equal = vec![1.0 / self.placed.len() as f64; self.placed.len()];
        largest_sum(self.surplus(&equal)).max(largest_sum(self.surplus(&equal).map(|s| -s)))
    }

    fn surplus(&self, shares: &[f64]) -> impl Iterator<Item = f64> {
        self.placed
            .iter()
            .zip(shares)
            .map(|(placed, share)| placed - self.total * share)
    }
}

/// The largest sum of a row from its beginning.
fn largest_sum(row: impl Iterator<Item = f64>) -> f64 {
    let mut sum = 0.0;
    row.fold(0.0, |most: f64, x| {
        sum += x;
        most.max(sum)
    })
}

/// The class of a quantile among so many.
pub fn class_of(u: f64, classes: usize) -> usize {
    ((u * classes as f64) as usize).min(classes - 1)
}
