//! Bridges of clumps that become bonded clusters, and of clusters that become clumps again.

use dem_engine::state::State;
use dem_engine::step::{advance, interact};
use dem_physics::contact::liquid_bridge::LiquidBridge;

use super::{RADIUS_M, WATER, assert_near, bridges, head, started, step_and_balance};

const SWAP_S: f64 = 1e-3;

/// A rod of two spheres, which leaves the rod below it at this speed, m/s, and to which a bridge of
/// this volume, m3, joins it. The upper one is replaced after a while; its clump spheres are larger
/// by this factor. The lower one stays a clump, and is numbered before it until then.
fn leaving(scale: f64, volume: f64, speed_m_s: f64, restore: &str) -> State {
    let rod = |name: &str, z_m: f64, more: &str| {
        format!(
            "[bodies.{name}]\nmaterial = \"glass\"\nbonds = \"glass\"\nstart_as = \"clump\"\n\
             particles = [[0, 0, 0, {RADIUS_M:e}], [0, 0, {:e}, {RADIUS_M:e}]]\nbond_list = [[0, 1]]\n\
             position = [0, 0, {z_m:e}]\n{more}\n",
            2.0 * RADIUS_M
        )
    };
    let apart_m = 4.0 * RADIUS_M + (scale - 1.0) * RADIUS_M - 1e-8;
    let settings = "initial_overlap = \"keep\", safety_factor = 0.3";
    started(&format!(
        "{}[bonds.glass]\nyoung_modulus = 1e8\npoisson_ratio = 0.25\n{}{}\
         [replacement.upper]\nwhen = {{ time = {SWAP_S} }}\n{restore}",
        head(1.0, 1.0, settings).replace("\"1e-3 mm3\"", &format!("{volume:e}")),
        rod("lower", 0.0, ""),
        rod(
            "upper",
            apart_m,
            &format!("clump.scale = {scale}\nvelocity = [0, 0, {speed_m_s}]")
        )
    ))
}

fn rupture_m(volume_m3: f64) -> f64 {
    LiquidBridge { volume_m3, ..WATER }.rupture_m()
}

/// Steps until the upper rod has been replaced. Returns the gap of its bridge at the last forces
/// before that, m.
fn until_swapped(state: &mut State) -> f64 {
    loop {
        interact(state);
        let gap_m = bridges(state).pairs[0].gap_m;
        assert_eq!(bridges(state).pairs[0].pair, [1, 2]);
        advance(state);
        if state.clumps.all.len() == 1 {
            return gap_m;
        }
        assert!(state.time_s < 2.0 * SWAP_S, "never replaced");
    }
}

/// The bridge goes on between the same two spheres, which have other numbers, with the gap of their
/// smaller surfaces, and ruptures where it would.
#[test]
fn a_bridge_outlasts_the_replacement_of_its_clump() {
    for scale in [1.0, 1.02] {
        let volume = 3e-10;
        let mut state = leaving(scale, volume, 0.2, "");
        let before_m = until_swapped(&mut state);
        assert!(before_m > 0.05 * rupture_m(volume), "{before_m:e}");
        assert_eq!((state.particles.free, state.clumps.all.len()), (2, 1));
        let [bridge] = bridges(&state).pairs[..] else {
            panic!("{:?}", bridges(&state).pairs);
        };
        // The lower sphere of the rod above, the upper sphere of the one below.
        assert_eq!(bridge.pair, [0, 3]);
        let grown_m = bridge.gap_m - before_m;
        let wanted_m = (scale - 1.0) * RADIUS_M;
        assert!((grown_m - wanted_m).abs() < 1e-12 * RADIUS_M, "{grown_m:e}");
        let mut largest_m = 0.0_f64;
        while bridges(&state).formed_and_ruptured[1] == 0 {
            let balance = step_and_balance(&mut state);
            assert!(balance.energy_error.abs() < 1e-3, "{scale}: {balance:?}");
            assert!(balance.momentum_error < 1e-12);
            if let [bridge] = bridges(&state).pairs[..] {
                largest_m = largest_m.max(bridge.gap_m);
            }
            assert!(state.time_s < 0.1);
        }
        assert_eq!(bridges(&state).formed_and_ruptured, [1, 1]);
        assert_near(largest_m, rupture_m(volume), 1e-2);
    }
}

/// The surfaces are farther apart than the bridge reaches once the larger spheres have gone.
#[test]
fn a_bridge_that_is_too_short_for_the_cluster_ruptures() {
    let volume = 1e-12;
    let scale = 1.1;
    let mut state = leaving(scale, volume, 0.05, "");
    let before_m = until_swapped(&mut state);
    assert!((0.0..0.9 * rupture_m(volume)).contains(&before_m));
    assert!(before_m + 0.1 * RADIUS_M > rupture_m(volume));
    let balance = step_and_balance(&mut state);
    assert!(bridges(&state).pairs.is_empty());
    assert_eq!(bridges(&state).formed_and_ruptured, [1, 1]);
    assert_eq!(balance.liquid_bridge_j, 0.0);
    assert!(balance.liquid_bridge_loss_j > 0.0);
    for _ in 0..100 {
        let balance = step_and_balance(&mut state);
        assert!(balance.energy_error.abs() < 1e-3, "{balance:?}");
        assert!(balance.momentum_error < 1e-12);
    }
}

/// Once the cluster is quiet it becomes a clump again, with its larger spheres.
#[test]
fn a_bridge_outlasts_restoration() {
    let restore = "restore = { leaves = \"far\", min_particles = 2, strain_energy = \"1e6 J/kg\", fluctuation_velocity = \"100 m/s\" }\n\
                   [regions.far]\nbox = { min = [1, 1, 1], max = [2, 2, 2] }\n";
    for scale in [1.0, 1.02] {
        let volume = 3e-10;
        let mut state = leaving(scale, volume, 0.2, restore);
        while bridges(&state).formed_and_ruptured[1] == 0 {
            let balance = step_and_balance(&mut state);
            assert!(balance.energy_error.abs() < 1e-3, "{scale}: {balance:?}");
            assert!(balance.momentum_error < 1e-11);
            assert!(state.time_s < 0.1);
        }
        assert_eq!(bridges(&state).formed_and_ruptured, [1, 1]);
        let swaps = [state.population.replaced, state.population.restored];
        assert_eq!(swaps, [1, 1]);
    }
}
