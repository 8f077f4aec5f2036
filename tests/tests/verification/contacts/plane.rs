//! A ball that slides and rolls on a plane.

use dem_run::{State, step};

use super::ball::{DENSITY_KG_M3, GRAVITY_M_S2, POISSON, RADIUS_M, YOUNG_PA, mass_kg};
use crate::verification::scene::{place, spin, started, velocity};
use crate::verification::table::{Case, compared};

/// A ball at rest on a plane, with the overlap due to its weight, under gravity rotated by `angle`.
fn on_plane(angle_rad: f64, friction: &str, velocity_m_s: f64, spin_rad_s: f64) -> State {
    let normal_n = mass_kg() * GRAVITY_M_S2 * angle_rad.cos();
    let young = YOUNG_PA / (1.0 - POISSON * POISSON);
    let overlap = (0.75 * normal_n / (young * RADIUS_M.sqrt())).powf(2.0 / 3.0);
    let [gx, gz] = [angle_rad.sin(), -angle_rad.cos()].map(|part| part * GRAVITY_M_S2);
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = "10 s", time_step = 1e-5, gravity = [{gx:e}, 0, {gz:e}], initial_overlap = "keep" }}
        materials.ball = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
        materials.rigid = {{ rigid = true }}
        contacts.ball-ball = {{ restitution = 0.3, {friction} }}
        contacts.ball-rigid = {{ restitution = 0.3, {friction} }}
        bodies.ball = {{ particles = [[0, 0, {:e}, {RADIUS_M:e}]], material = "ball", velocity = [{velocity_m_s:e}, 0, 0], angular_velocity = [0, {spin_rad_s:e}, 0] }}
        walls.ground = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = "rigid" }}
        "#,
        RADIUS_M - overlap
    ))
}

/// Ratio of overlap to radius of a ball on a plane: the relative reduction of its lever; for
/// friction and inertia twice that.
fn sunk() -> f64 {
    let young = YOUNG_PA / (1.0 - POISSON * POISSON);
    let force = mass_kg() * GRAVITY_M_S2;
    (0.75 * force / (young * RADIUS_M.sqrt())).powf(2.0 / 3.0) / RADIUS_M
}

fn until(state: &mut State, time_s: f64) {
    while state.time_s < time_s {
        step(state);
    }
}

/// Mean acceleration along x between two times, m/s2. Both velocities are those of half a step
/// before the state's time.
fn acceleration(state: &mut State, from_s: f64, to_s: f64) -> [f64; 2] {
    until(state, from_s);
    let (start_s, before) = (state.time_s, [velocity(state, 0).x, spin(state, 0).y]);
    until(state, to_s);
    let after = [velocity(state, 0).x, spin(state, 0).y];
    [0, 1].map(|k| (after[k] - before[k]) / (state.time_s - start_s))
}

/// From sliding to rolling.
pub(crate) fn sliding_to_rolling() -> String {
    let (friction, start) = (0.3, 1.0);
    let mut state = on_plane(0.0, "friction = 0.3", start, 0.0);
    let slip = |state: &State| velocity(state, 0).x - RADIUS_M * spin(state, 0).y;
    let (mut before, mut rolls) = (slip(&state), None);
    let rolls_s = 2.0 * start / (7.0 * friction * GRAVITY_M_S2);
    let mut x_m = 0.0;
    while state.time_s < 2.0 * rolls_s {
        step(&mut state);
        let now = slip(&state);
        if rolls.is_none() && now <= 0.0 {
            let part = now / (now - before);
            rolls = Some(state.time_s - state.time_step_s * (0.5 + part));
            x_m = place(&state, 0).x - velocity(&state, 0).x * state.time_step_s * (0.5 + part);
        }
        before = now;
    }
    let bound = sunk();
    let [speed, spin] = [velocity(&state, 0).x, spin(&state, 0).y];
    let energy = 0.5 * mass_kg() * (speed * speed + 0.4 * (RADIUS_M * spin).powi(2));
    let lost = 1.0 - energy / (0.5 * mass_kg() * start * start);
    compared(
        "from 1 m/s without spin, friction 0.3",
        "SI",
        &[
            Case::new("slides until, s", rolls.unwrap(), rolls_s, bound),
            Case::new(
                "distance, m",
                x_m,
                12.0 * start * start / (49.0 * friction * GRAVITY_M_S2),
                bound,
            ),
            Case::new("velocity then, m/s", speed, 5.0 / 7.0 * start, bound),
            Case::new(
                "spin then, rad/s",
                spin,
                5.0 / 7.0 * start / RADIUS_M,
                bound,
            ),
            Case::new("fraction of energy lost", lost, 2.0 / 7.0, bound),
        ],
    )
}

/// Accelerations on an incline, of a rolling or sliding ball.
pub(crate) fn incline() -> [String; 2] {
    let mut tables = [Vec::new(), Vec::new()];
    for degrees in [5.0_f64, 15.0, 30.0, 45.0, 50.0, 60.0] {
        let angle = degrees.to_radians();
        let mut state = on_plane(angle, "friction = 0.3", 0.0, 0.0);
        let found = acceleration(&mut state, 0.1, 0.3);
        let (rolling, what) = (angle.tan() < 3.5 * 0.3, format!("{degrees}°"));
        let (what, wanted) = if rolling {
            let along = 5.0 / 7.0 * GRAVITY_M_S2 * angle.sin();
            (what + ", rolls", [along, along / RADIUS_M])
        } else {
            let pull = GRAVITY_M_S2 * (angle.sin() - 0.3 * angle.cos());
            let turn = 2.5 * 0.3 * GRAVITY_M_S2 * angle.cos() / RADIUS_M;
            (what + ", slides", [pull, turn])
        };
        for (table, (found, wanted)) in tables.iter_mut().zip(found.into_iter().zip(wanted)) {
            table.push(Case::new(what.clone(), found, wanted, sunk()));
        }
    }
    let [along, turn] = tables;
    [
        compared("incline", "m/s2", &along),
        compared("incline", "rad/s2", &turn),
    ]
}

/// Rolling friction: deceleration of a ball on the flat and on an incline.
pub(crate) fn rolling_friction() -> String {
    let mut cases = Vec::new();
    for kind in ["constant-torque", "spring-dashpot"] {
        for coefficient in [0.01_f64, 0.05] {
            for degrees in [0.0_f64, 10.0] {
                let angle = degrees.to_radians();
                let friction = format!(
                    "friction = 0.5, rolling = \"{kind}\", rolling_friction = {coefficient:e}"
                );
                let mut state = on_plane(angle, &friction, 1.0, 1.0 / RADIUS_M);
                let [found, _] = acceleration(&mut state, 0.1, 0.3);
                let wanted = 5.0 / 7.0 * GRAVITY_M_S2 * (angle.sin() - coefficient * angle.cos());
                let what = format!("{kind}, {coefficient}, {degrees}°");
                cases.push(Case::new(what, found, wanted, sunk()));
            }
        }
    }
    compared("rolling friction, incline", "m/s2", &cases)
}

/// A ball that starts at rest on an incline on which rolling friction can hold it: with a spring it
/// stays, with a constant moment it creeps, which is not shown.
pub(crate) fn held() -> String {
    let cases = [1.0_f64, 2.0, 4.0].map(|degrees| {
        let angle = degrees.to_radians();
        let rolling = "rolling = \"spring-dashpot\", rolling_friction = 0.1";
        let mut state = on_plane(angle, &format!("friction = 0.5, {rolling}"), 0.0, 0.0);
        until(&mut state, 1.0);
        let free = 5.0 / 7.0 * GRAVITY_M_S2 * angle.sin();
        Case::of_scale(
            format!("{degrees}°"),
            [velocity(&state, 0).x, 0.0],
            free,
            1e-9,
        )
    });
    compared("incline", "m/s", &cases)
}
