//! How an equilibrium was found, for the summary.

use dem_io::units::significant;
use serde::Serialize;

/// Residual over the largest bond force that is worth a word.
const LARGE_RESIDUAL: f64 = 1e-6;

/// How an equilibrium was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EquilibriumSummary {
    /// Unknown freedoms.
    pub unknowns: usize,
    /// Freedoms that supports hold.
    pub held: usize,
    /// Newton steps, of all load steps together.
    pub newton_steps: usize,
    /// Load steps; 1: the whole load at once.
    pub load_steps: usize,
    /// The residual over the largest bond force.
    pub residual: f64,
    /// The residual, N; torques over the radii of their particles.
    pub residual_n: f64,
    /// The largest that a bond carries, N; moments over its radius.
    pub largest_bond_force_n: f64,
    /// Bonds beyond their strength.
    pub bonds_beyond_strength: usize,
    /// Whether every small move from the equilibrium needs work.
    pub stable: bool,
}

impl EquilibriumSummary {
    /// What speaks against trusting the result. Empty: nothing.
    pub fn doubts(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        if self.bonds_beyond_strength > 0 {
            doubts.push(format!(
                "{} strength: the body would break; run it with run.integrator = \"leapfrog\"",
                match self.bonds_beyond_strength {
                    1 => "1 bond is beyond its".to_owned(),
                    many => format!("{many} bonds are beyond their"),
                }
            ));
        }
        if !self.stable {
            doubts.push(
                "the equilibrium may not be stable: some small moves from it give work".to_owned(),
            );
        }
        if self.residual > LARGE_RESIDUAL {
            doubts.push(format!(
                "the residual is {} of the largest bond force: the loads are hardly more than rounding",
                significant(self.residual, 2)
            ));
        }
        doubts
    }
}
