//! Keeps the sizes true where spheres were chosen to fill voids: what was taken out of turn is left out of the draws that follow.

/// How many spheres of each class of sizes were placed out of turn and have not been left out of the draws yet.
/// The classes are equal shares of the distribution by number.
#[derive(Debug, Clone)]
pub struct Ledger {
    owed: Vec<f64>,
}

impl Ledger {
    /// For a packing of about so many spheres. More classes would tell sizes better apart, but each draw hits a class more seldom:
    /// with the root of the number both errors stay a small part of the noise of as many draws.
    pub fn new(spheres: f64) -> Self {
        Self {
            owed: vec![0.0; spheres.sqrt().clamp(1.0, 1e4) as usize],
        }
    }

    /// A sphere of quantile `u` (0 to 1) was placed out of turn.
    pub fn owe(&mut self, u: f64) {
        let class = self.class(u);
        self.owed[class] += 1.0;
    }

    /// A draw of quantile `u` was left out.
    pub fn pay(&mut self, u: f64) {
        let class = self.class(u);
        self.owed[class] -= 1.0;
    }

    /// For each class the probability with which a draw is to be left out, if about so many are to be made before the next look:
    /// half of what would pay all, since the number is a guess.
    pub fn shares_left_out(&self, draws: usize) -> Vec<f64> {
        let draws_of_class = draws as f64 / self.owed.len() as f64;
        self.owed
            .iter()
            .map(|owed| (0.5 * owed / draws_of_class).max(0.0))
            .collect()
    }

    /// By how many spheres the number up to some size, and its share of all, is off at most.
    pub fn imbalance(&self) -> f64 {
        let mean = self.owed.iter().sum::<f64>() / self.owed.len() as f64;
        let mut sum = 0.0;
        self.owed.iter().fold(0.0, |most: f64, owed| {
            sum += owed - mean;
            most.max(f64::abs(sum))
        })
    }

    /// What is owed, class by class.
    pub fn owed(&self) -> &[f64] {
        &self.owed
    }

    fn class(&self, u: f64) -> usize {
        class_of(u, self.owed.len())
    }
}

/// The class of a quantile among so many.
pub fn class_of(u: f64, classes: usize) -> usize {
    ((u * classes as f64) as usize).min(classes - 1)
}
