//! Size distribution of fragments: those inside at the end, those discharged, and both, by body.
//!
//! Size is the opening of the smallest sieve that a fragment passes.

use std::collections::BTreeMap;

use dem_results::DistributionRow;
use dem_results::summary::{RESOLVED_DIAMETERS, SizeSummary, Sizes, Unresolved};
use rayon::prelude::*;

use dem_engine::state::State;
use dem_engine::state::clusters::Clusters;
use dem_engine::state::clusters::sizes::{FragmentSize, size_of};
use dem_engine::state::model::Model;

/// Sizes of the series R 20 of ISO 3 between 1 and 10.
const R20: [&str; 20] = [
    "1", "1.12", "1.25", "1.4", "1.6", "1.8", "2", "2.24", "2.5", "2.8", "3.15", "3.55", "4",
    "4.5", "5", "5.6", "6.3", "7.1", "8", "9",
];

/// The places of fragments in the table: names, and whether discharged and present ones are there.
const LOCATIONS: [(&str, bool, bool); 3] = [
    ("inside", false, true),
    ("discharged", true, false),
    ("both", true, true),
];

/// Masses and sizes of all present clusters. Clumps of one template have the same size, which is
/// found once.
fn sizes_of(state: &State, clusters: &Clusters) -> Vec<FragmentSize> {
    let clumps = &state.clumps;
    let template_of = |id: u32| {
        let carrier = clumps.carrier_of(*clusters.members(id).first()? as usize)?;
        Some(clumps.all[carrier].template)
    };
    let living: Vec<u32> = clusters.living().collect();
    let mut of_template: BTreeMap<u32, usize> = BTreeMap::new();
    let mut measured: Vec<u32> = Vec::new();
    let places = living.iter().map(|&id| {
        let mut new = || {
            measured.push(id);
            measured.len() - 1
        };
        match template_of(id) {
            Some(template) => *of_template.entry(template).or_insert_with(new),
            None => new(),
        }
    });
    let places: Vec<usize> = places.collect();
    let size = |id: u32| size_of(id, clusters, &state.particles, clumps);
    let sizes: Vec<FragmentSize> = measured.into_par_iter().map(size).collect();
    let whole = living.iter().zip(places).map(|(&id, place)| FragmentSize {
        body: clusters.history[id as usize].body,
        ..sizes[place]
    });
    whole.collect()
}

/// Name of all bodies together in the table.
const ALL: &str = "all";

/// Size of a fragment over that of its body above which it is the body itself.
const WHOLE: f64 = 0.999;
/// Size of fragments that were not made over the smallest size that is made.
const JUST_BELOW: f64 = 1.0 - 1e-9;

/// The fragments of a run, inside and discharged.
#[derive(Debug, Clone, Default)]
pub struct Fragments {
    inside: Vec<FragmentSize>,
    discharged: Vec<FragmentSize>,
    /// Bodies that break by a law, and the smallest size of their daughters, m.
    made_from_m: BTreeMap<u32, f64>,
}

impl Fragments {
    /// The fragments of a state. None: nothing can break or touch.
    pub fn of(state: &State) -> Option<Self> {
        let clusters = state.clusters.as_ref()?;
        let discharged = state.population.discharged.iter();
        let mut fragments = Self {
            inside: sizes_of(state, clusters),
            discharged: discharged.map(|one| one.size).collect(),
            made_from_m: BTreeMap::new(),
        };
        fragments.add_fines(state);
        Some(fragments)
    }

    /// Adds fragments that were too small to be made, as one of just below the smallest size of
    /// each body. They have left, if anything can leave.
    fn add_fines(&mut self, state: &State) {
        let rules = &state.model.rules;
        let templates = state.clumps.templates.iter();
        let of_rules = templates
            .zip(&rules.daughters)
            .zip(&state.population.fines_kg);
        for ((template, rule), mass_kg) in of_rules {
            let Some(rule) = rule.as_ref().filter(|rule| rule.by_law.is_some()) else {
                continue;
            };
            let body = state.model.body_number(&template.body);
            self.made_from_m.insert(body, rule.smallest_size_m);
            let fines = FragmentSize {
                body,
                mass_kg: *mass_kg,
                sieve_m: JUST_BELOW * rule.smallest_size_m,
                ..FragmentSize::default()
            };
            let place = if rules.outlets.is_empty() {
                &mut self.inside
            } else {
                &mut self.discharged
            };
            place.extend((*mass_kg > 0.0).then_some(fines));
        }
    }

    /// From these, for tests.
    pub fn from_parts(inside: Vec<FragmentSize>, discharged: Vec<FragmentSize>) -> Self {
        Self {
            inside,
            discharged,
            ..Self::default()
        }
    }

    /// The fragments of a body, or all, in these places, by ascending size.
    fn chosen(&self, body: Option<u32>, discharged: bool, inside: bool) -> Vec<FragmentSize> {
        let discharged = self.discharged.iter().filter(|_| discharged);
        let inside = self.inside.iter().filter(|_| inside);
        let all = discharged.chain(inside);
        let own = all.filter(|one| body.is_none_or(|body| body == one.body));
        let mut chosen: Vec<FragmentSize> = own.copied().collect();
        chosen.sort_by(|a, b| a.sieve_m.total_cmp(&b.sieve_m));
        chosen
    }

    /// Mass of the largest fragment of a body, by its number, kg.
    pub fn largest_kg(&self, body: u32) -> f64 {
        let of_body = self.chosen(Some(body), true, true);
        // Fines are no fragment.
        let of_body = of_body.iter().filter(|one| one.equivalent_diameter_m > 0.0);
        of_body.map(|one| one.mass_kg).fold(0.0, f64::max)
    }

    /// Bodies that have fragments, with their names, and all together.
    fn groups<'a>(&self, model: &'a Model) -> Vec<(Option<u32>, &'a str)> {
        let has = |number: u32| !self.chosen(Some(number), true, true).is_empty();
        let bodies = (0..).zip(&model.bodies);
        let bodies = bodies.map(|(number, body)| (number, body.name.as_str()));
        let bodies = bodies.filter(|(number, _)| has(*number));
        let bodies = bodies.map(|(number, name)| (Some(number), name));
        std::iter::once((None, ALL)).chain(bodies).collect()
    }

    /// Mean size, by mass, of the bodies that the fragments come from, m.
    fn mean_size_m(&self, body: Option<u32>, model: &Model) -> f64 {
        let all = self.chosen(body, true, true);
        let size = |one: &FragmentSize| {
            let body = model.bodies.get(one.body as usize);
            body.map_or(0.0, |body| body.sieve_m)
        };
        all.iter().map(|one| one.mass_kg * size(one)).sum::<f64>() / mass_kg(&all)
    }

    /// Diameter of the smallest sphere of the bodies that the fragments come from, m.
    fn smallest_m(&self, body: Option<u32>, model: &Model) -> f64 {
        let all = self.chosen(body, true, true);
        let own = all.iter().filter_map(|one| {
            let sphere_m = model.bodies.get(one.body as usize)?.smallest_diameter_m;
            Some(match self.made_from_m.get(&one.body) {
                Some(made_m) => made_m.min(sphere_m),
                None => sphere_m,
            })
        });
        own.fold(f64::INFINITY, f64::min)
    }

    /// Size from which fragments of a body, or of all, are resolved, m; 0 for single spheres.
    fn resolved_from_m(&self, body: Option<u32>, model: &Model) -> f64 {
        let all = self.chosen(body, true, true);
        let own = all.iter().filter_map(|one| {
            let of_spheres_m = model.bodies.get(one.body as usize)?.mean_diameter_m;
            let made_m = self.made_from_m.get(&one.body);
            Some(made_m.map_or(RESOLVED_DIAMETERS * of_spheres_m, |made_m| *made_m))
        });
        own.fold(0.0, f64::max)
    }

    /// The numbers of the summary.
    pub fn sizes(&self, model: &Model) -> Sizes {
        let mut sizes = Sizes::default();
        for (body, name) in self.groups(model) {
            let tenth_m = 0.1 * self.mean_size_m(body, model);
            let tenth_m = (tenth_m > self.smallest_m(body, model)).then_some(tenth_m);
            let of_group = LOCATIONS
                .iter()
                .filter_map(|(location, discharged, inside)| {
                    let chosen = self.chosen(body, *discharged, *inside);
                    let summary = marked(
                        summary(&chosen, tenth_m)?,
                        &chosen,
                        self.resolved_from_m(body, model),
                        tenth_m,
                        model,
                    );
                    Some(((*location).to_owned(), summary))
                });
            let of_group = of_group.collect();
            match body {
                None => sizes.all = of_group,
                Some(_) => drop(sizes.bodies.insert(name.to_owned(), of_group)),
            }
        }
        sizes
    }

    /// The rows of the table: for each body and all, for each place, for each sieve. `sieves_m`:
    /// openings, m; if empty, those of [`sieves_m`].
    pub fn rows<'a>(&self, model: &'a Model, sieves_m: &[f64]) -> Vec<DistributionRow<'a>> {
        let all = self.chosen(None, true, true);
        let (Some(first), Some(last)) = (all.first(), all.last()) else {
            return Vec::new();
        };
        let sieves_m = match sieves_m {
            [] => self::sieves_m(first.sieve_m, last.sieve_m),
            given => given.to_vec(),
        };
        let mut rows = Vec::new();
        for (body, name) in self.groups(model) {
            let resolved_from_m = self.resolved_from_m(body, model);
            for (location, discharged, inside) in LOCATIONS {
                let chosen = self.chosen(body, discharged, inside);
                let total_kg = mass_kg(&chosen);
                if total_kg == 0.0 {
                    continue;
                }
                for &sieve_m in &sieves_m {
                    let end = chosen.partition_point(|one| one.sieve_m <= sieve_m);
                    let passing_kg = mass_kg(&chosen[..end]);
                    rows.push(DistributionRow {
                        body: name,
                        location,
                        sieve_m,
                        passing_kg,
                        passing_fraction: passing_kg / total_kg,
                        resolved: sieve_m >= resolved_from_m,
                    });
                }
            }
        }
        rows
    }

    /// Cumulative curves of all fragments, inside and discharged: name of the body, points of size,
    /// m, and mass fraction with a step at each size, and d50, m.
    pub fn curves<'a>(&self, model: &'a Model) -> Vec<(&'a str, Vec<[f64; 2]>, f64)> {
        let curve = |(body, name): (Option<u32>, &'a str)| {
            let chosen = self.chosen(body, true, true);
            let d50_m = summary(&chosen, None).map_or(0.0, |summary| summary.d50_m);
            (name, steps(&chosen), d50_m)
        };
        self.groups(model).into_iter().map(curve).collect()
    }

    /// Size from which all of them are resolved, m: see [`SizeSummary::resolved_from_m`].
    pub fn all_resolved_from_m(&self, model: &Model) -> f64 {
        self.resolved_from_m(None, model)
    }

    /// Number of all fragments, inside and discharged.
    pub fn count(&self) -> usize {
        self.inside.len() + self.discharged.len()
    }
}

/// Size, m, and mass fraction of all fragments of that size and smaller ones, with a step at every
/// size. `sorted`: by ascending size.
pub fn steps(sorted: &[FragmentSize]) -> Vec<[f64; 2]> {
    let total_kg = mass_kg(sorted);
    let (mut sum_kg, mut points) = (0.0, Vec::new());
    for same in sorted.chunk_by(|a, b| a.sieve_m == b.sieve_m) {
        points.push([same[0].sieve_m, sum_kg / total_kg]);
        sum_kg += mass_kg(same);
        points.push([same[0].sieve_m, sum_kg / total_kg]);
    }
    points
}

/// Mass of some fragments, kg. Not the sum of an iterator: that of none is minus zero.
fn mass_kg(fragments: &[FragmentSize]) -> f64 {
    fragments.iter().fold(0.0, |sum, one| sum + one.mass_kg)
}

/// Of fragments by ascending size; `tenth_m`: the size for t10, if it is resolved. None: there are
/// none.
fn summary(sorted: &[FragmentSize], tenth_m: Option<f64>) -> Option<SizeSummary> {
    let last = sorted.last()?;
    let mass_kg = mass_kg(sorted);
    let at = |fraction: f64| {
        let mut sum_kg = 0.0;
        let reached = sorted.iter().find(|one| {
            sum_kg += one.mass_kg;
            sum_kg >= fraction * mass_kg
        });
        reached.unwrap_or(last).sieve_m
    };
    let fines_kg = |tenth_m: f64| {
        let fines = sorted.partition_point(|one| one.sieve_m < tenth_m);
        self::mass_kg(&sorted[..fines])
    };
    Some(SizeSummary {
        mass_kg,
        d10_m: at(0.1),
        d50_m: at(0.5),
        d80_m: at(0.8),
        t10: tenth_m.map(|tenth_m| fines_kg(tenth_m) / mass_kg),
        resolved_from_m: 0.0,
        unresolved: Unresolved::default(),
    })
}

/// A summary with marks at the figures of these fragments that are below the size that the spheres
/// resolve, m. A body that has not broken is no matter of its spheres.
fn marked(
    summary: SizeSummary,
    sorted: &[FragmentSize],
    resolved_from_m: f64,
    tenth_m: Option<f64>,
    model: &Model,
) -> SizeSummary {
    let is_fragment = |size_m: f64| {
        let mut own = sorted.iter().filter(|one| one.sieve_m == size_m);
        own.any(|one| {
            let body = model.bodies.get(one.body as usize);
            body.is_some_and(|body| size_m < WHOLE * body.sieve_m)
        })
    };
    let is_small = |size_m: f64| size_m < resolved_from_m && is_fragment(size_m);
    SizeSummary {
        resolved_from_m,
        unresolved: Unresolved {
            d10: is_small(summary.d10_m),
            d50: is_small(summary.d50_m),
            d80: is_small(summary.d80_m),
            t10: tenth_m.is_some_and(|tenth_m| tenth_m < resolved_from_m),
        },
        ..summary
    }
}

/// Openings of test sieves, m: the principal sizes R 20/3 of ISO 565 (1 mm, 1.4 mm, 2 mm, 2.8 mm,
/// ...), from the last below the smallest fragment to the first that all pass.
pub fn sieves_m(smallest_m: f64, largest_m: f64) -> Vec<f64> {
    if !(smallest_m > 0.0 && largest_m.is_finite()) {
        return Vec::new();
    }
    // Every third size of the series, counted from 1 mm; 20 sizes make a decade.
    let opening_m = |number: i64| -> f64 {
        let digits = R20[(3 * number).rem_euclid(20) as usize];
        let decade = (3 * number).div_euclid(20) - 3;
        format!("{digits}e{decade}").parse().unwrap_or(f64::NAN)
    };
    let mut number = (20.0 / 3.0 * (smallest_m * 1e3).log10()).floor() as i64 + 2;
    while opening_m(number) >= smallest_m {
        number -= 1;
    }
    let mut sieves_m = vec![opening_m(number)];
    while opening_m(number) < largest_m {
        number += 1;
        sieves_m.push(opening_m(number));
    }
    sieves_m
}
