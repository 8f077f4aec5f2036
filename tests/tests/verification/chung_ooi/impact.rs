//! Impacts of a ball on a rigid wall or another ball with Hertz-Mindlin: by the solver, by closed
//! forms, and by the equations of the law integrated without the solver.

use std::f64::consts::PI;

use dem_run::{State, step};

use crate::verification::contacts::impact::damping_ratio;
use crate::verification::scene::{place, spin, started, velocity};

/// Number of steps in an impact without damping.
pub(crate) const STEPS: f64 = 1000.0;

/// Duration of an elastic impact of Hertz's law over largest overlap and speed: the integral of
/// dx/sqrt(1 - x^(5/2)) from 0 to 1, twice.
const HERTZ_DURATION: f64 = 2.943_275_184_324_704;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Material {
    pub(crate) name: &'static str,
    pub(crate) density_kg_m3: f64,
    pub(crate) young_pa: f64,
    pub(crate) poisson: f64,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    pub(crate) material: Material,
    pub(crate) radius_m: f64,
}

impl Ball {
    fn mass_kg(&self) -> f64 {
        self.material.density_kg_m3 * 4.0 / 3.0 * PI * self.radius_m.powi(3)
    }

    /// 1/E, 1/G and 1/m of its end of a contact.
    fn softness(&self) -> [f64; 3] {
        let Material {
            young_pa, poisson, ..
        } = self.material;
        let shear = 2.0 * (1.0 + poisson) * (2.0 - poisson) / young_pa;
        let normal = (1.0 - poisson * poisson) / young_pa;
        [normal, shear, 1.0 / self.mass_kg()]
    }

    fn scene(&self, name: &str, height_m: f64, velocity_m_s: [f64; 2], spin_rad_s: f64) -> String {
        let Material {
            density_kg_m3,
            young_pa,
            poisson,
            ..
        } = self.material;
        let [across, along] = velocity_m_s;
        format!(
            "materials.{name} = {{ density = {density_kg_m3:e}, young_modulus = {young_pa:e}, poisson_ratio = {poisson:e} }}
            bodies.{name} = {{ particles = [[0, 0, {height_m:e}, {:e}]], material = \"{name}\", velocity = [{across:e}, 0, {along:e}], angular_velocity = [0, {spin_rad_s:e}, 0] }}\n",
            self.radius_m
        )
    }
}

/// A ball above a rigid wall (z = 0), or above another ball, which meet with their normal along z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Impact {
    pub(crate) ball: Ball,
    pub(crate) other: Option<Ball>,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    /// Speeds of the ball downwards and of the other upwards, m/s.
    pub(crate) speeds_m_s: [f64; 2],
    /// Velocity of the ball along x, m/s.
    pub(crate) across_m_s: f64,
    /// Spins about y of the ball and of the other, rad/s.
    pub(crate) spins_rad_s: [f64; 2],
}

/// Result of an impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rebound {
    /// Largest normal force, N, and overlap, m; duration, s.
    pub(crate) force_n: f64,
    pub(crate) overlap_m: f64,
    pub(crate) duration_s: f64,
    /// Speed with which the ends separate, m/s.
    pub(crate) apart_m_s: f64,
    /// Velocities along x of the ball and of the other, m/s.
    pub(crate) across_m_s: [f64; 2],
    /// Spins about y, rad/s.
    pub(crate) spins_rad_s: [f64; 2],
}

impl Impact {
    /// Sums of 1/E, 1/G and 1/m of both ends.
    fn softness(&self) -> [f64; 3] {
        let ends = [Some(self.ball), self.other];
        let all = ends.into_iter().flatten().map(|ball| ball.softness());
        all.fold([0.0; 3], |sum, of_end| {
            [0, 1, 2].map(|k| sum[k] + of_end[k])
        })
    }

    fn effective_radius_m(&self) -> f64 {
        let other = self.other.map_or(0.0, |other| 1.0 / other.radius_m);
        1.0 / (1.0 / self.ball.radius_m + other)
    }

    /// Speed with which the ends meet, m/s.
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.speeds_m_s[0] + self.speeds_m_s[1]
    }

    /// Largest overlap without damping, m.
    pub(crate) fn overlap_m(&self) -> f64 {
        let [softness, _, per_mass] = self.softness();
        let square = self.speed_m_s().powi(2) / per_mass;
        (15.0 * square * softness / (16.0 * self.effective_radius_m().sqrt())).powf(0.4)
    }

    /// Largest force without damping, N.
    pub(crate) fn force_n(&self) -> f64 {
        let stiffness = 4.0 / 3.0 / self.softness()[0] * self.effective_radius_m().sqrt();
        stiffness * self.overlap_m().powf(1.5)
    }

    /// Duration without damping, s.
    pub(crate) fn duration_s(&self) -> f64 {
        HERTZ_DURATION * self.overlap_m() / self.speed_m_s()
    }

    /// Velocity with which the surface of the ball slides on the other, m/s, from velocities along
    /// x and spins.
    pub(crate) fn slip_m_s(&self, across_m_s: [f64; 2], spins_rad_s: [f64; 2]) -> f64 {
        let other_m = self.other.map_or(0.0, |other| other.radius_m);
        let turned = self.ball.radius_m * spins_rad_s[0] + other_m * spins_rad_s[1];
        across_m_s[0] - across_m_s[1] - turned
    }

    /// Slip at the first touch, m/s.
    pub(crate) fn slip_before_m_s(&self) -> f64 {
        self.slip_m_s([self.across_m_s, 0.0], self.spins_rad_s)
    }

    /// Slip that friction takes from ends that slide throughout, m/s: each tangential impulse also
    /// turns spheres, so that it counts 7/2 times.
    pub(crate) fn stopped_m_s(&self) -> f64 {
        3.5 * self.friction * (1.0 + self.restitution) * self.speed_m_s()
    }

    pub(crate) fn slides(&self) -> bool {
        self.slip_before_m_s().abs() > self.stopped_m_s()
    }

    /// Velocities along x and spins after an impact that slides throughout.
    pub(crate) fn after_sliding(&self) -> [[f64; 2]; 2] {
        let per_mass = self.softness()[2];
        let normal = (1.0 + self.restitution) * self.speed_m_s() / per_mass;
        self.after(
            self.friction * normal * self.slip_before_m_s().signum(),
            0.0,
        )
    }

    /// The same after a tangential impulse, N s, against the motion of the ball along x, whose
    /// lever is shorter than each radius by `sunk_m` in the mean.
    fn after(&self, impulse: f64, sunk_m: f64) -> [[f64; 2]; 2] {
        let turned = |ball: &Ball| {
            let inertia = 0.4 * ball.mass_kg() * ball.radius_m * ball.radius_m;
            impulse * (ball.radius_m - sunk_m) / inertia
        };
        let [spin, other_spin] = self.spins_rad_s;
        let pushed = self.other.map_or([0.0; 2], |other| {
            [impulse / other.mass_kg(), other_spin + turned(&other)]
        });
        let own = self.across_m_s - impulse / self.ball.mass_kg();
        [[own, pushed[0]], [spin + turned(&self.ball), pushed[1]]]
    }

    /// The ball at the distance that the ends cover in `away_s` seconds.
    fn scene(&self, step_s: f64, away_s: f64) -> String {
        let (restitution, friction) = (self.restitution, self.friction);
        let law = format!("{{ restitution = {restitution:e}, friction = {friction:e} }}");
        let [down, up] = self.speeds_m_s;
        let [spin, other_spin] = self.spins_rad_s;
        let height = self.ball.radius_m + (down + up) * away_s;
        let ball = self
            .ball
            .scene("ball", height, [self.across_m_s, -down], spin);
        let other = match self.other {
            Some(other) => {
                let other = other.scene("other", -other.radius_m, [0.0, up], other_spin);
                format!("{other} contacts.ball-other = {law}\n contacts.other-other = {law}")
            }
            None => format!(
                "materials.rigid = {{ rigid = true }}
                walls.ground = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"rigid\" }}
                contacts.ball-rigid = {law}"
            ),
        };
        format!(
            "version = 1
            run = {{ end_time = \"1 s\", time_step = {step_s:e} }}
            contacts.ball-ball = {law}
            {ball} {other}"
        )
    }

    /// Runs until the ends separate. They meet in the middle of a step; the time of separation
    /// within its step is found by linear interpolation.
    pub(crate) fn run(&self) -> Rebound {
        let step_s = self.duration_s() / STEPS;
        let mut state = started(&self.scene(step_s, 2.5 * step_s));
        let overlap = |state: &State| match self.other {
            Some(other) => {
                let apart = (place(state, 0) - place(state, 1)).norm();
                self.ball.radius_m + other.radius_m - apart
            }
            None => self.ball.radius_m - place(state, 0).z,
        };
        let met_s = -overlap(&state) / self.speed_m_s();
        let (mut before, mut largest_m, mut force_n) = (overlap(&state), 0.0_f64, 0.0_f64);
        let mut rises_m_s = velocity(&state, 0).z;
        loop {
            step(&mut state);
            let (now, rises) = (overlap(&state), velocity(&state, 0).z);
            largest_m = largest_m.max(now);
            force_n = force_n.max(self.ball.mass_kg() * (rises - rises_m_s) / state.time_step_s);
            if before > 0.0 && now <= 0.0 {
                let parted_s = state.time_s - state.time_step_s * now / (now - before);
                // Another step, so that velocities are those after the last force.
                step(&mut state);
                let of = |end: usize| match (end, self.other) {
                    (1, None) => [0.0; 3],
                    _ => {
                        let moves = velocity(&state, end);
                        [moves.x, moves.z, spin(&state, end).y]
                    }
                };
                let [own, other] = [of(0), of(1)];
                return Rebound {
                    force_n,
                    overlap_m: largest_m,
                    duration_s: parted_s - met_s,
                    apart_m_s: own[1] - other[1],
                    across_m_s: [own[0], other[0]],
                    spins_rad_s: [own[2], other[2]],
                };
            }
            (before, rises_m_s) = (now, rises);
        }
    }

    /// Velocities along x and spins after the impact by the equations of the law
    /// (doc/inside/contacts.md), integrated with 100 times the steps.
    pub(crate) fn integrated(&self) -> [[f64; 2]; 2] {
        let step_s = self.duration_s() / (100.0 * STEPS);
        let [softness, shear_softness, per_mass] = self.softness();
        let damping = 2.0 * (5.0_f64 / 6.0).sqrt() * damping_ratio(self.restitution);
        let other_m = self.other.map(|other| other.radius_m);
        let (mut overlap, mut closing) = (0.0_f64, self.speed_m_s());
        // The tangential impulse, and that times half the overlap.
        let (mut impulse, mut sunk) = (0.0_f64, 0.0);
        let (mut spring, mut stiffness_before) = (0.0_f64, 0.0);
        loop {
            overlap += closing * step_s;
            let mean_m = if impulse == 0.0 { 0.0 } else { sunk / impulse };
            let [across, spins] = self.after(impulse, mean_m);
            if overlap <= 0.0 {
                return [across, spins];
            }
            let root = (self.effective_radius_m() * overlap).sqrt();
            let (normal_stiffness, stiffness) =
                (2.0 / softness * root, 8.0 / shear_softness * root);
            let dashpot = damping * (normal_stiffness / per_mass).sqrt();
            let normal = (2.0 / 3.0 * normal_stiffness * overlap + dashpot * closing).max(0.0);
            let lever = |radius_m: f64| radius_m - 0.5 * overlap;
            let turned = lever(self.ball.radius_m) * spins[0]
                + other_m.map_or(0.0, |radius_m| lever(radius_m) * spins[1]);
            let slip = across[0] - across[1] - turned;
            // While the load increases the spring keeps its force, while it decreases its
            // elongation.
            if stiffness > stiffness_before {
                spring *= stiffness_before / stiffness;
            }
            stiffness_before = stiffness;
            spring += slip * step_s;
            let limit = self.friction * normal;
            spring = spring.clamp(-limit / stiffness, limit / stiffness);
            let damped = damping * (stiffness / per_mass).sqrt() * slip;
            let push = (stiffness * spring + damped).clamp(-limit, limit) * step_s;
            impulse += push;
            sunk += 0.5 * overlap * push;
            closing -= normal * per_mass * step_s;
        }
    }

    /// Bound of errors relative to velocities: the error of restitution of Hertz's law is of first
    /// order in the step over the faster of the two times of a damped oscillation, and friction
    /// follows the normal force.
    pub(crate) fn bound(&self) -> f64 {
        let zeta = damping_ratio(self.restitution);
        (zeta + zeta.hypot(1.0)) / STEPS
    }

    /// Relative error of the lever, for which closed forms use the radius.
    pub(crate) fn lever_error(&self) -> f64 {
        0.5 * self.overlap_m() / self.effective_radius_m()
    }
}
