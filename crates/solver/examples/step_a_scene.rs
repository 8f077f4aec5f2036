//! Plans a scene, steps it, and measures: a ball that falls onto a plate.
//!
//! ```sh
//! cargo run --release -p dem-run --example step_a_scene
//! ```
#![allow(clippy::print_stdout, reason = "it prints what it measures")]

use dem_run::{balance, plan, step};
use dem_scene::{read_bodies, scene_from_text};

const SCENE: &str = r#"
version = 1
run = { end_time = "0.2 s", gravity = [0, 0, -9.81] }
materials.steel = { density = 7850, young_modulus = "10 MPa", poisson_ratio = 0.3 }
contacts.steel-steel = { restitution = 0.8, friction = 0.3 }
bodies.ball = { particles = [[0, 0, 0.05, 0.01]], material = "steel" }
walls.plate = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = "steel" }
"#;

fn main() -> dem_io::Result<()> {
    let scene = scene_from_text(SCENE, "ball.toml", &[])?;
    let threads = 1;
    let mut state = plan(&scene, read_bodies(&scene)?, threads, false)?.state;
    let mut highest_m = 0.0_f64;
    let mut has_met = false;
    while state.time_s < scene.run.end_time_s {
        step(&mut state);
        let [_, _, z, radius_m] = state.particles.poses[0].position_m;
        has_met |= z < radius_m;
        if has_met {
            highest_m = highest_m.max(z - radius_m);
        }
    }
    let energy = balance(&mut state);
    println!("{} steps of {:.2e} s", state.steps, state.time_step_s);
    println!("it rises again by {:.1} mm", 1e3 * highest_m);
    println!("energy error {:.1e}", energy.energy_error);
    Ok(())
}
