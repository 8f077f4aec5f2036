//! Data on an equilibrium.

use dem_io::units::significant;
use serde::{Deserialize, Serialize};

/// Smallest ratio of residual to the largest bond force that is reported; and for a laboratory
/// test, whose walls can open and whose equilibria are found for its stiffness.
const LARGE_RESIDUALS: [f64; 2] = [1e-6, 1e-3];

/// Data on an equilibrium.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct EquilibriumSummary {
    /// Number of unknown degrees of freedom.
    pub unknowns: usize,
    /// Number of degrees of freedom held by supports.
    pub held: usize,
    /// Total number of Newton steps of all load steps.
    pub newton_steps: usize,
    /// Load steps; 1: the full load at once.
    pub load_steps: usize,
    /// Ratio of the residual to the largest bond force.
    pub residual: f64,
    /// The residual, N; torques over the radii of their particles.
    pub residual_n: f64,
    /// The largest bond force, N; moments over the bond radius.
    pub largest_bond_force_n: f64,
    /// Bonds beyond their strength.
    pub bonds_beyond_strength: usize,
    /// Whether every small displacement from the equilibrium requires work.
    pub stable: bool,
}

impl EquilibriumSummary {
    /// Reasons to doubt the result. Empty: none. `is_test`: of a laboratory test.
    pub(super) fn doubts(&self, is_test: bool) -> Vec<String> {
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
        if self.residual > LARGE_RESIDUALS[usize::from(is_test)] {
            doubts.push(format!(
                "the residual is {} of the largest bond force: the loads are hardly more than rounding",
                significant(self.residual, 2)
            ));
        }
        doubts
    }
}
