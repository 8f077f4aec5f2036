//! Particles that daughters replace: what they take in, what is kept, and what the energy does.

use std::f64::consts::PI;

use dem_engine::Balance;
use dem_engine::state::State;
use dem_engine::state::clumps::Clump;
use dem_engine::state::events::{BrokenInto, PopulationEvent};
use dem_engine::step::exchange;
use dem_plan::Plan;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

use super::{planned, try_planned};
use dem_testing::Random;

use crate::helpers::step_and_balance;

const RADIUS_M: f64 = 5e-3;
const DENSITY_KG_M3: f64 = 2500.0;

/// Two packings of loose daughters, and a body with bonds.
const DAUGHTERS: [(&str, &str); 3] = [
    ("halves", "particles = [[0, 0, 0, 1], [2, 0.1, 0, 0.8]]"),
    (
        "pieces",
        "particles = [[0, 0, 0, 1], [2, 0.1, 0, 0.8], [0.9, 1.4, 0.2, 0.6], [1, 0.3, 1.5, 0.7], [0.8, -1.2, -0.4, 0.5]]",
    ),
    (
        "rod",
        "particles = [[0, 0, 0, 1], [1.5, 0.1, 0, 1], [0.8, 1.4, 0.2, 0.9]]\nbond_list = [[0, 1], [1, 2], [0, 2]]\nbonds = \"glue\"",
    ),
];

/// Materials, a sphere, and those daughters that the rest of the scene names.
fn bodies(restitution: f64, more: &str) -> String {
    let named = DAUGHTERS.iter().filter(|(name, _)| more.contains(name));
    let named = named.map(|(name, body)| format!("[bodies.{name}]\nmaterial = \"ore\"\n{body}\n"));
    let named: String = named.collect();
    format!(
        "version = 1
run.end_time = 0.1
materials.ore = {{ density = {DENSITY_KG_M3}, young_modulus = 1e8, poisson_ratio = 0.25 }}
materials.anvil.rigid = true
materials.steel = {{ young_modulus = 3e8, poisson_ratio = 0.3 }}
contacts.ore-ore = {{ restitution = {restitution}, friction = 0.4 }}
contacts.ore-anvil = {{ restitution = {restitution}, friction = 0.4 }}
contacts.ore-steel = {{ restitution = {restitution}, friction = 0.4 }}
bonds.glue = {{ young_modulus = 1e8, poisson_ratio = 0.25 }}
[bodies.ball]
particles = [[0, 0, 0, {RADIUS_M}]]
material = \"ore\"
start_as = \"clump\"
{named}{more}\n"
    )
}

fn daughters(classes: &str, more: &str) -> String {
    format!("[replacement.ball.daughters]\nclasses = [{classes}]\n{more}\n")
}

const PLATE: &str = "[walls.plate]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n";

fn ball_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

/// Mass, centre, momentum and angular momentum about the origin of all clumps.
fn whole(state: &State) -> (f64, Vector3<f64>, Vector3<f64>, Vector3<f64>) {
    let zero = Vector3::zeros();
    let (mut mass_kg, mut moment, mut momentum, mut angular) = (0.0, zero, zero, zero);
    for clump in &state.clumps.all {
        let m = state.clumps.template(clump).mass_kg;
        let (place, velocity) = (
            Vector3::from(clump.place_m),
            Vector3::from(clump.velocity_m_s),
        );
        mass_kg += m;
        moment += m * place;
        momentum += m * velocity;
        angular += m * place.cross(&velocity) + Vector3::from(clump.angular_momentum);
    }
    (mass_kg, moment / mass_kg, momentum, angular)
}

/// A ball with a random place, orientation and motion is replaced; what must be kept is kept.
fn kept(class: &str, seed: u64) {
    let text = bodies(0.5, &daughters(class, "energy = \"all-impacts\""));
    let mut state = planned(&text).state;
    let mut random = Random(seed);
    let parent = state.clumps.all[0];
    let template = state.clumps.template(&parent).clone();
    let clump = &mut state.clumps.all[0];
    clump.place_m = random.point(0.02);
    clump.turned = dem_physics::rotation::numbers(&random.rotation());
    clump.velocity_m_s = random.point(10.0);
    clump.angular_momentum = random.point(100.0 * template.moments_kg_m2[0]);
    clump.intake.before_j = 100.0 * template.mass_kg;
    let parent = *clump;
    let (mass_kg, centre, momentum, angular) = whole(&state);
    let kinetic_j = parent.kinetic_j(&template);
    exchange(&mut state);

    let speed = momentum.norm() / mass_kg + parent.spin_rad_s(&template).norm() * RADIUS_M;
    let arm_m = centre.norm() + RADIUS_M;
    let (now_kg, now_centre, now_momentum, now_angular) = if state.clumps.all.is_empty() {
        let whole = super::Whole::of(
            &state.particles,
            0..state.particles.len(),
            &Vector3::zeros(),
        );
        (
            whole.mass_kg,
            whole.centre,
            whole.momentum,
            whole.angular_momentum,
        )
    } else {
        whole(&state)
    };
    assert!((now_kg / mass_kg - 1.0).abs() < 1e-14, "{now_kg} {mass_kg}");
    assert!((now_centre - centre).norm() < 1e-12 * arm_m);
    assert!((now_momentum - momentum).norm() < 1e-12 * mass_kg * speed);
    assert!((now_angular - angular).norm() < 1e-12 * mass_kg * speed * arm_m);
    let [
        PopulationEvent::Broken {
            specific_j_kg,
            mass_kg: masses,
            kinetic_j: kinetics,
            ..
        },
        ..,
    ] = &state.scratch.events.population[..]
    else {
        panic!("{:?}", state.scratch.events.population);
    };
    assert!((specific_j_kg - 100.0).abs() < 1e-12);
    assert!((masses[0] / masses[1] - 1.0).abs() < 1e-14);
    assert!((kinetics[0] / kinetic_j - 1.0).abs() < 1e-12);
    if state.clumps.all.is_empty() {
        return;
    }
    // Of all motions with these momenta, that of one rigid body has the least energy.
    let now_j: f64 = (state.clumps.all.iter())
        .map(|clump| clump.kinetic_j(state.clumps.template(clump)))
        .sum();
    assert!((kinetics[1] / now_j - 1.0).abs() < 1e-12);
    let mut inertia = Matrix3::zeros();
    let mut cubes = 0.0;
    for clump in &state.clumps.all {
        let own = state.clumps.template(clump);
        let arm = Vector3::from(clump.place_m) - centre;
        let radius_m = own.spheres[0].radius_m;
        inertia += Matrix3::from_diagonal_element(own.moments_kg_m2[0])
            + own.mass_kg
                * (Matrix3::from_diagonal_element(arm.norm_squared()) - arm * arm.transpose());
        cubes += radius_m.powi(3);
        // All lie in the parent, and have its density.
        assert!(arm.norm() + radius_m < RADIUS_M * (1.0 + 1e-12));
        let density = own.mass_kg / (4.0 / 3.0 * PI * radius_m.powi(3));
        assert!((density / DENSITY_KG_M3 - 1.0).abs() < 1e-12);
    }
    assert!((cubes / RADIUS_M.powi(3) - 1.0).abs() < 1e-12);
    let own = now_angular - mass_kg * centre.cross(&(momentum / mass_kg));
    let turning_j = 0.5 * own.dot(&(inertia.try_inverse().unwrap() * own));
    let least_j = 0.5 * momentum.norm_squared() / mass_kg + turning_j;
    assert!((now_j / least_j - 1.0).abs() < 1e-9, "{now_j} {least_j}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]
    #[test]
    fn mass_centre_and_momenta_are_those_of_the_parent(seed in any::<u64>()) {
        kept("{ from = 10, body = \"halves\" }", seed);
        kept("{ from = 10, body = \"pieces\" }", seed);
        kept("{ from = 10, body = \"rod\" }", seed);
    }
}

/// What balls that start with these velocities along z, above the plate or apart from each other,
/// take in during their first impact, J, at this multiple of the planned step; and the step, s.
fn taken_in(scene: &str, step: f64) -> (Vec<f64>, f64) {
    let mut state = planned(scene).state;
    state.time_step_s *= step;
    let mut largest = vec![0.0_f64; state.clumps.all.len()];
    while state.time_s < 5e-3 {
        step_and_balance(&mut state);
        for (largest, clump) in largest.iter_mut().zip(&state.clumps.all) {
            *largest = largest.max(clump.intake.impact_j);
        }
    }
    (largest, state.time_step_s)
}

#[test]
fn a_normal_impact_gives_the_kinetic_energy_of_the_relative_motion() {
    let never = daughters("{ from = 1e9, body = \"halves\" }", "");
    let energy_j = 0.5 * ball_kg() * 3.0 * 3.0;
    let falls = format!("[bodies.ball]\nparticles = [[0, 0, 0, {RADIUS_M}]]");
    let start = format!(
        "{falls}\nposition = [0, 0, {}]\nvelocity = [0.5, 0, -3]",
        RADIUS_M + 1e-4
    );
    for restitution in [1.0, 0.5] {
        // (1 - 0.0625)/1e8 to (1 - 0.09)/3e8.
        for (wall, share) in [("anvil", 1.0), ("steel", 0.9375 / (0.9375 + 0.91 / 3.0))] {
            let wall = format!("{PLATE}material = \"{wall}\"\n");
            let text = bodies(restitution, &format!("{wall}{never}")).replace(&falls, &start);
            // The last step before the turn may end half a step away from it, with a speed of half
            // of a step at the largest force, which Hertz's contact gives.
            let modulus_pa = 1e8 / (0.9375 / share);
            let deep_m = (0.9375 * ball_kg() * 9.0 / (modulus_pa * RADIUS_M.sqrt())).powf(0.4);
            for step in [1.0, 0.5, 0.25] {
                let (found, step_s) = taken_in(&text, step);
                let error = found[0] / (share * energy_j) - 1.0;
                let most = (0.625 * step_s * 3.0 / deep_m).powi(2);
                eprintln!("restitution {restitution}, share {share}: {error} of {most}");
                assert!((-1.5 * most..1e-4).contains(&error), "{error} {most}");
            }
        }
        // Two balls, each of which moves at half of the speed, share alike: together they take in
        // m/2 v^2/2.
        let other = format!(
            "[bodies.other]\nparticles = [[0, 0, 0, {RADIUS_M}]]\nmaterial = \"ore\"\nstart_as = \"clump\"\nposition = [0, 0, {}]\nvelocity = [0, 0, 1.5]\n",
            -RADIUS_M - 1e-4
        );
        // What nothing replaces is no clump.
        let rule = never.replace("ball", "other").replace("halves", "pieces");
        let other = format!("{other}{rule}");
        let start = start.replace("-3]", "-1.5]").replace("0.5, 0", "0, 0");
        let text = bodies(restitution, &format!("{other}{never}")).replace(&falls, &start);
        let (both, _) = taken_in(&text, 0.5);
        for one in both {
            assert!((one / (0.25 * energy_j) - 1.0).abs() < 1e-3, "{one}");
        }
    }
}

/// A ball that hits a plate which moves at `plate_m_s` at this speed: the state, and the events.
fn hit(
    speed_m_s: f64,
    plate_m_s: f64,
    rule: &str,
    step: f64,
) -> (State, Vec<PopulationEvent>, Balance) {
    let falls = format!("[bodies.ball]\nparticles = [[0, 0, 0, {RADIUS_M}]]");
    let start = format!(
        "{falls}\nposition = [0, 0, {}]\nvelocity = [1, 0.3, {}]\nangular_velocity = [30, 0, -20]",
        RADIUS_M + 1e-5,
        plate_m_s - speed_m_s
    );
    let plate = format!("{PLATE}material = \"anvil\"\nvelocity = [0, 0, {plate_m_s}]\n");
    let text = bodies(0.7, &format!("{plate}{rule}")).replace(&falls, &start);
    let Plan { mut state, .. } = planned(&text);
    state.time_step_s *= step;
    let mut events = Vec::new();
    let mut last = Balance::default();
    while state.time_s < 3e-3 {
        last = step_and_balance(&mut state);
        events.extend(state.scratch.events.population.clone());
    }
    (state, events, last)
}

#[test]
fn the_energy_at_the_end_of_the_compression_chooses_the_size_class() {
    let rule = daughters(
        "{ from = 2, body = \"halves\" }, { from = 10, body = \"pieces\" }",
        "",
    );
    // v^2/2 is 1.9, 2.1, 9.5 and 12.5 J/kg.
    for (speed_m_s, wanted) in [
        (3.8_f64.sqrt(), None),
        (4.2_f64.sqrt(), Some((0, 2))),
        (19.0_f64.sqrt(), Some((0, 2))),
        (5.0, Some((1, 5))),
    ] {
        let (state, events, last) = hit(speed_m_s, 0.0, &rule, 0.5);
        let found = events.iter().map(|event| match event {
            PopulationEvent::Broken {
                into: BrokenInto::Class(class),
                daughters,
                specific_j_kg,
                ..
            } => {
                let reached = 0.5 * speed_m_s * speed_m_s;
                // The last class needs no more: it is taken at once.
                let wanted = if *class == 1 { 10.0 } else { reached };
                assert!(
                    (specific_j_kg / wanted - 1.0).abs() < 0.03,
                    "{specific_j_kg} {wanted}"
                );
                (*class, daughters.1)
            }
            _ => panic!("{event:?}"),
        });
        let found: Vec<_> = found.collect();
        assert_eq!(found, wanted.into_iter().collect::<Vec<_>>(), "{speed_m_s}");
        let count = wanted.map_or(1, |(_, count)| count);
        assert_eq!(state.clumps.all.len(), count);
        assert!(last.energy_error.abs() < 1e-3, "{last:?}");
    }
}

#[test]
fn what_particles_lose_is_booked_and_nothing_is_gained() {
    let rule = daughters(
        "{ from = 2, body = \"pieces\" }, { from = 30, body = \"halves\" }",
        "",
    );
    for plate_m_s in [0.0, 4.0, -4.0] {
        let errors = [1.0, 0.5, 0.25].map(|step| {
            let (state, events, last) = hit(4.0, plate_m_s, &rule, step);
            assert_eq!((events.len(), state.clumps.all.len()), (1, 5));
            // The kinetic energy across the plate is gone.
            let lost_j = 0.5 * ball_kg() * 16.0;
            let share = last.particle_breakage_j / lost_j;
            assert!((0.5..1.01).contains(&share), "{share}");
            assert!(
                last.momentum_error < 1e-12 && last.angular_momentum_error < 1e-9,
                "{last:?}"
            );
            last.energy_error.abs()
        });
        eprintln!("plate at {plate_m_s} m/s: {errors:?}");
        assert!(errors[0] < 1e-3 && errors[2] < 1e-4, "{errors:?}");
    }
}

#[test]
fn daughters_break_again_down_to_the_smallest_size_and_not_beyond_the_limit() {
    let classes = "{ from = 0.5, body = \"pieces\" }";
    let squeeze = |more: &str| {
        let rule = daughters(classes, more);
        let plates = format!(
            "{PLATE}material = \"anvil\"\n[walls.above]\nplane = {{ point = [0, 0, {}], normal = [0, 0, -1] }}\nmaterial = \"anvil\"\nvelocity = [0, 0, -0.5]\n",
            2.0 * RADIUS_M
        );
        let falls = format!("particles = [[0, 0, 0, {RADIUS_M}]]");
        let start = format!("{falls}\nposition = [0, 0, {RADIUS_M}]");
        let mut state =
            planned(&bodies(0.5, &format!("{plates}{rule}")).replace(&falls, &start)).state;
        let mut largest = 0.0_f64;
        while state.time_s < 8e-3 {
            largest = largest.max(step_and_balance(&mut state).energy_error.abs());
        }
        let masses = state
            .clumps
            .all
            .iter()
            .map(|clump| state.clumps.template(clump).mass_kg);
        let mass_kg: f64 = masses.sum();
        assert!((mass_kg / ball_kg() - 1.0).abs() < 1e-13);
        (state, largest)
    };
    let broken = |state: &State| state.population.by_daughters.iter().sum::<u32>();
    let (once, _) = squeeze("");
    assert_eq!((broken(&once), once.clumps.all.len()), (1, 5));
    let (state, error) = squeeze("smallest_size = 4e-3");
    eprintln!(
        "{} replaced, {} left, energy error {error}",
        broken(&state),
        state.clumps.all.len()
    );
    assert!(broken(&state) > 5 && state.clumps.all.len() == 1 + 4 * broken(&state) as usize);
    assert!(error < 1e-2, "{error}");
    // What is left has been made of a particle above the smallest size.
    let radius = |clump: &Clump| state.clumps.template(clump).spheres[0].radius_m;
    let smallest_m = state
        .clumps
        .all
        .iter()
        .map(radius)
        .fold(f64::INFINITY, f64::min);
    assert!(smallest_m < 2e-3);
    assert!(
        smallest_m
            >= state
                .model
                .rules
                .daughters
                .iter()
                .flatten()
                .next()
                .unwrap()
                .smallest_radius_m
    );
    let (limited, _) = squeeze("smallest_size = 4e-3\nlimit = 4");
    assert_eq!(broken(&limited), 4);
}

#[test]
fn strengths_scatter_by_weibull_and_only_the_seed_and_the_particle_decide() {
    // A ball in mid-air that has taken in 8 J/kg, fed often.
    let broken = |seed: u64| {
        let rule = daughters(
            "{ from = 10, body = \"halves\" }",
            "weibull_modulus = 3\nenergy = \"all-impacts\"",
        );
        let text =
            bodies(0.5, &rule).replace("run.end_time", &format!("run.seed = {seed}\nrun.end_time"));
        let state = planned(&text).state;
        (0..2000_u32)
            .filter(|first_id| {
                let mut state = state.clone();
                state.clumps.all[0].first_id = *first_id;
                state.clumps.all[0].intake.before_j = 8.0 * ball_kg();
                exchange(&mut state);
                state.population.by_daughters.iter().sum::<u32>() > 0
            })
            .collect::<Vec<u32>>()
    };
    let one = broken(1);
    assert_eq!(one, broken(1));
    assert_ne!(one, broken(2));
    // 1 - exp(-(8/10)^3), within four standard deviations.
    let wanted = 1.0 - (-0.512_f64).exp();
    let deviation = (wanted * (1.0 - wanted) / 2000.0).sqrt();
    let share = one.len() as f64 / 2000.0;
    assert!((share - wanted).abs() < 4.0 * deviation, "{share} {wanted}");
}

#[test]
fn what_cannot_be_is_refused() {
    let falls = "[bodies.halves]\nmaterial = \"ore\"\nparticles = [[0, 0, 0, 1], [2, 0.1, 0, 0.8]]";
    let one = "[bodies.halves]\nmaterial = \"ore\"\nparticles = [[0, 0, 0, 1]]";
    let rule = daughters("{ from = 10, body = \"halves\" }", "");
    let refused = try_planned(&bodies(0.5, &rule).replace(falls, one)).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("a particle would replace itself"),
        "{refused}"
    );
    let rule = daughters("{ from = 10, body = \"halves\" }", "smallest_size = 0.02");
    let refused = try_planned(&bodies(0.5, &rule)).unwrap_err();
    assert!(refused.to_string().contains("the body itself"), "{refused}");
}

/// The scene `tests/scenes/roll-mill.toml` for as long as a test may take: its whole run replaces
/// 100,000 particles (doc/replacement.md).
#[test]
fn thousands_of_replacements_create_no_energy_and_lose_no_mass() {
    let path =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenes/roll-mill.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let mut state = planned(&text).state;
    let broken = |state: &State| state.population.by_daughters.iter().sum::<u32>();
    // The energy may fall by what contacts lose that end while they press, and never rises.
    let (mut fallen, mut risen, mut steps) = (0.0_f64, 0.0_f64, 0);
    while broken(&state) < 2000 {
        if steps % 50 == 0 {
            let error = step_and_balance(&mut state).energy_error;
            (fallen, risen) = (fallen.max(-error), risen.max(error));
        } else {
            dem_engine::step::step(&mut state);
        }
        steps += 1;
    }
    let now = step_and_balance(&mut state);
    eprintln!(
        "{} replaced in {steps} steps, {} spheres left; energy error -{fallen:.2e} to {risen:.2e}, momentum {:.1e}",
        broken(&state),
        state.clumps.all.len(),
        now.momentum_error
    );
    assert!(fallen < 1e-3 && risen < 1e-9, "{fallen} {risen}");
    assert!(
        now.particle_breakage_j > 0.0 && now.momentum_error < 1e-10,
        "{now:?}"
    );
    let population = &state.population;
    let fed_kg: f64 = population.inlets.iter().map(|inlet| inlet.mass_kg).sum();
    let gone_kg: f64 = population.outlets.iter().map(|outlet| outlet.mass_kg).sum();
    assert!(((gone_kg + state.clumps.mass_kg()) / fed_kg - 1.0).abs() < 1e-12);
}
