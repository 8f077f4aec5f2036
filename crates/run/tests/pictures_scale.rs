//! Colours of particles by a quantity on a scale.

use std::sync::Arc;

use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::Clusters;
use dem_physics::bond::stiffness::BondModel;
use dem_pictures::colours::SINGLE;
use dem_plots::viridis;
use dem_runner::pictures::View;
use dem_runner::pictures::scale::Scale;
use dem_scene::ColourBy;

use crate::bars::{ELASTIC, body, eq_20, spheres, steel};

const SPHERE_KG: f64 = 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.008;

/// Four spheres in a row, 0.4 m apart, with rates of 10/s, 1/s and -5/s; forces have not acted yet.
fn row() -> State {
    let (particles, pairs) = spheres(4);
    let mut state = body(
        particles,
        &pairs,
        &steel(BondModel::EulerBernoulli, ELASTIC),
        1e-9,
    );
    Arc::make_mut(&mut state.bonds.rules)[0].strengthening = eq_20(0.0);
    for (motion, velocity) in state.particles.motions.iter_mut().zip([0.0, 4.0, 4.4, 2.4]) {
        motion.velocity_m_s = [velocity, 0.0, 0.0];
    }
    state
}

fn values(by: ColourBy, state: &State) -> Vec<Option<f64>> {
    Scale::of(by, state, &[]).unwrap().values(state, &[])
}

fn assert_values(found: &[Option<f64>], wanted: &[Option<f64>]) {
    assert_eq!(found.len(), wanted.len());
    for (found, wanted) in found.iter().zip(wanted) {
        match (found, wanted) {
            (Some(found), Some(wanted)) => {
                assert!((found - wanted).abs() < 1e-6, "{found}, not {wanted}");
            }
            (found, wanted) => assert_eq!(found, wanted),
        }
    }
}

#[test]
fn a_particle_has_the_largest_value_of_its_intact_bonds() {
    let mut state = row();
    let rates = [Some(10.0), Some(10.0), Some(1.0), Some(-5.0)];
    assert_values(&values(ColourBy::StrainRate, &state), &rates);
    let factors = [Some(3.5675), Some(3.5675), Some(1.6), Some(1.0)];
    assert_values(&values(ColourBy::DynamicIncreaseFactor, &state), &factors);
    state.bonds.set_broken(0);
    let rates = [None, Some(1.0), Some(1.0), Some(-5.0)];
    assert_values(&values(ColourBy::StrainRate, &state), &rates);
}

#[test]
fn masses_are_those_of_fragments_or_of_bodies_that_cannot_break() {
    let mut state = row();
    let of = |state: &State, bodies: &[PlacedBody]| -> Vec<f64> {
        let scale = Scale::of(ColourBy::FragmentMass, state, bodies).unwrap();
        let values = scale.values(state, bodies).into_iter();
        values.map(|kg| (kg.unwrap() / SPHERE_KG).round()).collect()
    };
    let rod = PlacedBody {
        name: "rod".to_owned(),
        came_as: None,
        first_particle: 0,
        particles: vec![0, 1, 2],
        first_bond: 0,
        bonds: Vec::new(),
    };
    assert_eq!(of(&state, &[rod]), [3.0, 3.0, 3.0, 1.0]);
    state.bonds.set_broken(2);
    state.clusters = Some(Clusters::new(4, &state.bonds));
    assert_eq!(of(&state, &[]), [3.0, 3.0, 3.0, 1.0]);
    state.bonds.set_broken(0);
    state.clusters = Some(Clusters::new(4, &state.bonds));
    assert_eq!(of(&state, &[]), [1.0, 2.0, 2.0, 1.0]);
}

#[test]
fn scales_are_fixed_at_the_start() {
    let state = row();
    assert_eq!(Scale::of(ColourBy::Fragment, &state, &[]), None);
    for (by, low, high) in [
        (ColourBy::StrainRate, 0.0, 50.0),
        (ColourBy::DynamicIncreaseFactor, 1.0, 5.812_588_5),
        (ColourBy::DynamicUtilisation, 0.0, 1.0),
        (ColourBy::FragmentMass, 0.0, SPHERE_KG),
    ] {
        let scale = Scale::of(by, &state, &[]).unwrap();
        assert_eq!(scale.colour(low - 1.0), viridis(0.0), "{by:?}");
        assert_eq!(scale.colour(low), viridis(0.0));
        assert_eq!(scale.colour(0.5 * (low + high)), viridis(0.5));
        assert_eq!(scale.colour(high), viridis(1.0));
        assert_eq!(scale.colour(2.0 * high), viridis(1.0));
    }
    assert_ne!(viridis(0.5), SINGLE);
}

#[test]
fn pictures_show_the_scale_and_the_values() {
    let state = row();
    let picture = |by| {
        let view = View::of(&state, None, Scale::of(by, &state, &[]));
        view.picture(&state, &[], 0.01)
    };
    let all = [
        ColourBy::Fragment,
        ColourBy::FragmentMass,
        ColourBy::StrainRate,
        ColourBy::DynamicIncreaseFactor,
        ColourBy::DynamicUtilisation,
    ]
    .map(picture);
    for (k, one) in all.iter().enumerate() {
        for other in &all[k + 1..] {
            assert!(one.rgb() != other.rgb());
        }
    }
    // The bar in the bottom left corner, from its darkest to its lightest colour.
    let bar = |x: u32| all[2].pixel(x, 510).unwrap();
    assert_eq!(bar(17), viridis(0.5 / 211.0));
    assert_eq!(bar(227), viridis(210.5 / 211.0));
}
