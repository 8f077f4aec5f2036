//! The number of a particle follows it, whatever becomes of its body.

use std::collections::HashMap;

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::state::State;

use super::again::busy;
use super::go;

/// Place and radius of each particle by its id, and number of its body. No id occurs twice.
fn by_id(state: &State) -> HashMap<u32, ([f64; 3], f64)> {
    let mut particles = state.particles.clone();
    place_all(&state.clumps, &mut particles);
    let all = (0..particles.len()).map(|i| {
        let pose = &particles.poses[i];
        (particles.id(i), (pose.place().into(), pose.radius_m()))
    });
    let found: HashMap<_, _> = all.collect();
    assert_eq!(found.len(), particles.len(), "an id occurs twice");
    found
}

#[test]
fn ids_follow_particles_while_bodies_come_break_stiffen_and_go() {
    let plan = busy(1);
    let (mut state, mut bodies) = (plan.state, plan.bodies);
    let mut before = by_id(&state);
    // The first id after all that have existed, and ids that have gone.
    let mut next = before.keys().max().map_or(0, |largest| largest + 1);
    let (mut seen, mut inner) = (0, 0);
    while state.time_s < 0.1 {
        let instances = state.population.instances;
        go(&mut state, &mut bodies);
        let now = by_id(&state);
        let speed_m_s = (state.particles.motions.iter())
            .map(|motion| {
                motion
                    .velocity_m_s
                    .iter()
                    .map(|v| v * v)
                    .sum::<f64>()
                    .sqrt()
            })
            .fold(0.0, f64::max);
        for (id, (place_m, _)) in &now {
            match before.get(id) {
                // It has moved no farther than the fastest of all.
                Some((place_before_m, _)) => {
                    let square = |k: usize| (place_m[k] - place_before_m[k]).powi(2);
                    let moved_m = (0..3).map(square).sum::<f64>().sqrt();
                    let most_m = 2.0 * (speed_m_s + 0.1) * state.time_step_s;
                    assert!(moved_m <= most_m, "{id} moved {moved_m} m in a step");
                    seen += 1;
                }
                // New ones come through inlets; inner spheres of clumps only appear with the
                // bonded cluster, under the numbers kept for them.
                None if *id >= next => assert!(state.population.instances > instances),
                None => inner += 1,
            }
        }
        next = next.max(now.keys().max().map_or(0, |largest| largest + 1));
        before = now;
    }
    let population = &state.population;
    assert!(population.replaced > 5 && population.restored > 0 && state.broken_count > 10);
    assert!(population.outlets[0].bodies > 5 && seen > 100_000);
    eprintln!("{seen} particles followed from step to step, {inner} appeared");
    // Every body has had its own range of numbers.
    let of_bodies: usize = (state.clumps.templates.first()).map_or(0, |t| t.spheres.len());
    assert!(of_bodies > 0 && next as usize <= of_bodies * (1 + population.instances as usize));
}
