//! Results of a run by name, for studies and calibrations.

use super::Summary;
use super::sizes::SizeSummary;

/// Results of every run with fragments: sizes of all, and of what has left.
pub const RUN_RESULTS: [&str; 10] = [
    "d10",
    "d50",
    "d80",
    "t10",
    "discharged_d10",
    "discharged_d50",
    "discharged_d80",
    "discharged_mass",
    "fines_mass",
    "mass_fraction_of_largest",
];

impl Summary {
    /// One of [`RUN_RESULTS`], with its unit. None: the run has no such result.
    pub fn run_result(&self, name: &str) -> Option<(f64, &'static str)> {
        let (place, figure) = match name.strip_prefix("discharged_") {
            Some(figure) => ("discharged", figure),
            None => ("both", name),
        };
        let sizes = || -> Option<&SizeSummary> { self.sizes.as_ref()?.all.get(place) };
        let population = self.population.as_ref();
        match (place, figure) {
            (_, "d10") => Some((sizes()?.d10_m, "m")),
            (_, "d50") => Some((sizes()?.d50_m, "m")),
            (_, "d80") => Some((sizes()?.d80_m, "m")),
            ("both", "t10") => Some((sizes()?.t10?, "")),
            ("discharged", "mass") => Some((population?.discharged_kg, "kg")),
            ("both", "fines_mass") => Some((population?.fines_kg, "kg")),
            ("both", "mass_fraction_of_largest") => {
                let fragments = self.fragments.as_ref()?;
                Some((fragments.mass_fraction_of_largest, ""))
            }
            _ => None,
        }
    }
}
