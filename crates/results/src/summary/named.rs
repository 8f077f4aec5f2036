//! Results of the fragments of a run by name, for studies and calibrations.

use super::Summary;

impl Summary {
    /// The result with this name in the studies' list of run results, in SI. None: the run has no
    /// such result.
    pub fn run_result(&self, name: &str) -> Option<f64> {
        let (place, figure) = match name.strip_prefix("discharged_") {
            Some(figure) => ("discharged", figure),
            None => ("both", name),
        };
        let has_left = self.population.as_ref().is_some_and(|p| p.discharged > 0);
        if place == "discharged" && !has_left {
            return (figure == "mass").then_some(0.0);
        }
        let sizes = || self.sizes.as_ref()?.all.get(place);
        match (place, figure) {
            (_, "d10") => Some(sizes()?.d10_m),
            (_, "d50") => Some(sizes()?.d50_m),
            (_, "d80") => Some(sizes()?.d80_m),
            (_, "t10") => sizes()?.t10,
            ("discharged", "mass") => Some(self.population.as_ref()?.discharged_kg),
            ("both", "fines_mass") => Some(self.population.as_ref()?.fines_kg),
            ("both", "mass_fraction_of_largest") => {
                Some(self.fragments.as_ref()?.mass_fraction_of_largest)
            }
            _ => None,
        }
    }
}
