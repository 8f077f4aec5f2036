//! Colours of particles by a quantity on a scale: fragment mass, or the rate and utilisation of
//! bonds.

use dem_io::units::significant;
use dem_pictures::Image;
use dem_pictures::colours::SINGLE;
use dem_pictures::label::colour_bar;
use dem_plots::viridis;
use dem_scene::ColourBy;

use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::fragments::fragment_masses_kg;
use dem_engine::state::events::REMOVED;
use dem_physics::bond::rate_strengthening::IncreaseCurve;
use dem_plan::measure::{DynamicUtilisation, dynamic_utilisations};

/// A scale of colours, the same in all pictures of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    quantity: Quantity,
    /// Values of the darkest and of the lightest colour, in `unit`.
    ends: [f64; 2],
}

/// The quantity of a scale.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    FragmentMass,
    StrainRate,
    IncreaseFactor,
    Utilisation,
}

impl Scale {
    /// From the state and the bodies at the start of a run. None: each fragment has its own colour.
    ///
    /// Masses go up to that of the heaviest body, strain rates to that above which strengths no
    /// longer rise, utilisations to 1.
    pub fn of(colour_by: ColourBy, state: &State, bodies: &[PlacedBody]) -> Option<Self> {
        let (quantity, ends) = match colour_by {
            ColourBy::Fragment => return None,
            ColourBy::FragmentMass => {
                let present = masses_kg(state, bodies).into_iter();
                let to_come = state.clumps.templates.iter().map(|t| t.mass_kg);
                let heaviest_kg = present.chain(to_come).fold(0.0, f64::max);
                (Quantity::FragmentMass, [0.0, heaviest_kg])
            }
            ColourBy::StrainRate => {
                let highest = largest_of_curves(state, IncreaseCurve::highest_rate_1_s);
                (Quantity::StrainRate, [0.0, highest])
            }
            ColourBy::DynamicIncreaseFactor => {
                let highest = largest_of_curves(state, |curve| curve.factor(f64::INFINITY));
                (Quantity::IncreaseFactor, [1.0, highest])
            }
            ColourBy::DynamicUtilisation => (Quantity::Utilisation, [0.0, 1.0]),
        };
        Some(Self { quantity, ends })
    }

    /// The value of each particle: the mass of its fragment, or the largest value of its intact
    /// bonds. None: it has none. Length: particles.
    pub fn values(&self, state: &State, bodies: &[PlacedBody]) -> Vec<Option<f64>> {
        let of_bond: fn(DynamicUtilisation) -> f64 = match self.quantity {
            Quantity::FragmentMass => {
                return masses_kg(state, bodies).into_iter().map(Some).collect();
            }
            Quantity::StrainRate => |bond| bond.strain_rate_1_s,
            Quantity::IncreaseFactor => |bond| bond.increase_factor,
            Quantity::Utilisation => |bond| bond.utilisation,
        };
        let mut values: Vec<Option<f64>> = vec![None; state.particles.len()];
        for (ends, bond) in state.bonds.ends.iter().zip(dynamic_utilisations(state)) {
            let Some(bond) = bond else {
                continue;
            };
            for end in ends.map(|end| end as usize) {
                let own = of_bond(bond);
                values[end] = Some(values[end].map_or(own, |largest| largest.max(own)));
            }
        }
        values
    }

    /// The colour of each particle; grey without a value. Length: particles.
    pub(super) fn colours(&self, state: &State, bodies: &[PlacedBody]) -> Vec<[u8; 3]> {
        let values = self.values(state, bodies).into_iter();
        values
            .map(|value| value.map_or(SINGLE, |value| self.colour(value)))
            .collect()
    }

    /// The colour of a value; beyond the ends that of the nearer end.
    pub fn colour(&self, value: f64) -> [u8; 3] {
        let [low, high] = self.ends;
        viridis((value - low) / (high - low))
    }

    /// Draws the bar of its colours, with name and ends, into the bottom left corner.
    pub(super) fn draw(&self, image: &mut Image) {
        let (name, unit) = match self.quantity {
            Quantity::FragmentMass => ("fragment mass", " kg"),
            Quantity::StrainRate => ("strain rate", " /s"),
            Quantity::IncreaseFactor => ("dynamic increase factor", ""),
            Quantity::Utilisation => ("dynamic utilisation", ""),
        };
        let [low, high] = self.ends.map(|end| significant(end, 3));
        colour_bar(image, name, [&low, &format!("{high}{unit}")], &viridis);
    }
}

/// The largest number of the curves by which strengths rise with the strain rate; that of eq. 20 if
/// there are none.
fn largest_of_curves(state: &State, number: impl Fn(&IncreaseCurve) -> f64) -> f64 {
    let rules = state.bonds.rules.iter();
    let curves = rules.filter_map(|rule| Some(&rule.strengthening.as_ref()?.curve));
    let largest = curves.map(&number).reduce(f64::max);
    largest.unwrap_or_else(|| number(&IncreaseCurve::Platzer { from_1_s: 0.0 }))
}

/// Mass of the fragment of each particle, kg; where nothing can break, of its body. Length:
/// particles.
fn masses_kg(state: &State, bodies: &[PlacedBody]) -> Vec<f64> {
    let p = &state.particles;
    if let Some(clusters) = &state.clusters {
        return fragment_masses_kg(clusters, p, &state.clumps);
    }
    let own_kg = |i: usize| 1.0 / p.motions[i].inverse_mass;
    let mut masses_kg: Vec<f64> = (0..p.len()).map(own_kg).collect();
    for body in bodies {
        let living = || body.particles.iter().filter(|i| **i != REMOVED);
        let whole_kg = living().map(|i| own_kg(*i as usize)).sum();
        for i in living() {
            masses_kg[*i as usize] = whole_kg;
        }
    }
    masses_kg
}
