//! The contact history is carried over when a resting clump becomes a cluster.

use dem_engine::state::State;
use dem_plan::Plan;
use nalgebra::Vector3;

use super::{HEAD, block, go, planned};

/// Slope on which bodies stick: friction is 0.8, and the effect of a step is noticeable.
const SLOPE_RAD: f64 = 0.3;
const GRAVITY_M_S2: f64 = 9.81;
const SWAP_S: f64 = 0.1;

/// A slab of four spheres on another slab, `under`, that lies on a plane, sphere on sphere; or
/// directly on the plane.
fn resting(top: &str, under: Option<&str>) -> Plan {
    let slab = |name: &str, z_m: f64| {
        let more = format!("start_as = \"clump\"\nposition = [0, 0, {z_m:e}]");
        block(name, [2, 2, 1], 2e-3, |_| Some(1e-3), &more)
    };
    let (gravity_x, gravity_z) = (
        GRAVITY_M_S2 * SLOPE_RAD.sin(),
        GRAVITY_M_S2 * SLOPE_RAD.cos(),
    );
    let under = under.map(|name| slab(name, 1e-3));
    let z_m = if under.is_some() { 3e-3 } else { 1e-3 };
    planned(&format!(
        "{HEAD}run.gravity = [{gravity_x}, 0, -{gravity_z}]\n\
         contacts.stuff-stuff = {{ restitution = 0.05, friction = 0.8 }}\n{}{}\
         [walls.ground]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n\
         [replacement.{top}]\nwhen = {{ time = {SWAP_S} }}\n",
        slab(top, z_m),
        under.unwrap_or_default()
    ))
}

/// Force of walls and contacts on the four given spheres of the top slab.
fn force_on(state: &State, top: &[u32]) -> Vector3<f64> {
    let of_wrenches = top.iter().map(|i| {
        let [x, y, z, _] = state.particles.wrenches[*i as usize].force_n;
        Vector3::new(x, y, z)
    });
    of_wrenches.sum()
}

/// A slab rests, is replaced, and stays at rest.
fn after_swap(top: &str, under: Option<&str>) {
    let Plan {
        mut state,
        mut bodies,
        ..
    } = resting(top, under);
    let is_top =
        |state: &State, c: &dem_engine::state::clumps::Clump| state.clumps.template(c).body == top;
    let mut before = None;
    loop {
        let clumps = state.clumps.all.clone();
        if !go(&mut state, &mut bodies).population.is_empty() {
            break;
        }
        let clump = clumps
            .iter()
            .zip(&state.clumps.all)
            .find(|(_, c)| is_top(&state, c));
        before = clump.map(|(_, now)| *now);
    }
    // `go` has replaced it and moved on: the clump at the last summation of forces.
    let clump = before.unwrap();
    let template = state
        .clumps
        .templates
        .iter()
        .find(|t| t.body == top)
        .unwrap()
        .clone();
    let body = bodies.iter().find(|body| body.name == top).unwrap().clone();
    let weight_n = template.mass_kg * GRAVITY_M_S2;
    let wanted_n = -Vector3::from(state.model.gravity_m_s2) * template.mass_kg;
    // It was at rest and stuck: far below the limit of friction.
    assert!(
        (Vector3::from(clump.force_n) - wanted_n).norm() < 1e-6 * weight_n,
        "{:?}",
        clump.force_n
    );
    assert!(Vector3::from(clump.velocity_m_s).norm() < 1e-6);

    let start: Vec<Vector3<f64>> = (body.particles.iter())
        .map(|i| state.particles.poses[*i as usize].place())
        .collect();
    // The new bonds do not pull yet: the first forces are those of the contacts alone.
    dem_engine::step::interact(&mut state);
    let first_n = force_on(&state, &body.particles);
    let first = (first_n - Vector3::from(clump.force_n)).norm() / weight_n;
    let sliding = (first_n - Vector3::from(clump.force_n)).x.abs() / (wanted_n.x.abs());
    let touching = state
        .contacts
        .as_ref()
        .unwrap()
        .histories
        .iter()
        .map(|m| m.tangential);
    let touching = touching.chain(state.walls[0].touching.iter().map(|t| t.history.tangential));
    let touching: Vec<[f64; 4]> = touching.filter(|s| s[3] > 0.0).collect();
    let depth_m = touching.iter().map(|s| s[3]).sum::<f64>() / touching.len() as f64;
    let springs: Vec<f64> = touching.iter().map(|[x, y, ..]| x.hypot(*y)).collect();
    let spring_m = springs.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(springs.len(), if under.is_some() { 8 } else { 4 });
    dem_engine::step::advance(&mut state);
    // The new bonds carry nothing yet. The unequal part of the slope's effect on front and back, at
    // most its pull, acts on them suddenly. The cluster swings a little, by the compliance of the
    // bonds (softest in bending, at most four times the axial compliance), and the dashpots of the
    // four contacts respond.
    let spring_n_m = 1.5 * 0.25 * weight_n / depth_m;
    let bond_n_m = 0.25 * 1e9 * std::f64::consts::PI * 1e-6 / 2e-3;
    let answer = 4.0 * 2.0 * SLOPE_RAD.sin() * (spring_n_m / bond_n_m).sqrt();
    let (mut moved_m, mut worst, mut sum_n) = (0.0_f64, 0.0_f64, Vector3::zeros());
    let steps = (0.02 / state.time_step_s) as u32;
    for _ in 0..steps {
        dem_engine::step::interact(&mut state);
        let force_n = force_on(&state, &body.particles);
        sum_n += force_n;
        worst = worst.max((force_n - wanted_n).norm() / weight_n);
        dem_engine::step::advance(&mut state);
        for (i, start) in body.particles.iter().zip(&start) {
            moved_m = moved_m.max((state.particles.poses[*i as usize].place() - start).norm());
        }
    }
    let mean = (sum_n / f64::from(steps) - wanted_n).norm() / weight_n;
    eprintln!(
        "{top} on {under:?}: force {first:.1e} at once, along the slope {sliding:.1e}, later {worst:.1e} of {answer:.1e}, on average {mean:.1e}; moved {moved_m:.1e} m, springs {spring_m:.1e} m"
    );
    assert!(first < 1e-6 && sliding < 1e-6, "{first:e} {sliding:e}");
    // Nothing moves by more than a hundredth of the spring elongation: without the history it would
    // slide by all of it.
    assert!(moved_m < 0.01 * spring_m, "{moved_m:e}");
    assert!(
        worst < answer && mean < 1e-3,
        "{worst:e} {answer:e} {mean:e}"
    );
}

#[test]
fn on_a_slope() {
    after_swap("slab", None);
}

#[test]
fn on_a_clump_that_was_named_before_it_and_is_after_it_now() {
    after_swap("slab", Some("base"));
}

#[test]
fn on_a_clump_that_was_named_after_it_and_still_is() {
    after_swap("slab", Some("under"));
}
