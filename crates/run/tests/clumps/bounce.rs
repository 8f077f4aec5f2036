//! Clumps bounce as their material says, on any number of contacts.

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::state::clumps::Clump;
use dem_engine::step::{advance, interact};
use dem_physics::shape::landing::RigidSpheres;
use dem_plan::Plan;
use dem_plan::bounces::bonded_restitution;
use nalgebra::Vector3;

use super::planned;

const RADIUS_M: f64 = 1e-3;
const LINEAR: &str = "law = \"linear\", normal_stiffness = \"20 kN/m\", ";
const HERTZ: &str = "";

/// A scene with a floor, in which contacts have this law and restitution, and these bodies.
fn with_floor(law: &str, restitution: f64, bodies: &str) -> String {
    format!(
        "version = 1\nrun.end_time = 1\n\
         materials.m = {{ density = 2500, young_modulus = \"100 MPa\", poisson_ratio = 0.25 }}\n\
         materials.w.rigid = true\n\
         contacts.m-m = {{ {law}restitution = {restitution} }}\n\
         contacts.m-w = {{ {law}restitution = {restitution} }}\n\
         walls.w = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"w\" }}\n\
         {bodies}"
    )
}

/// A body of spheres of 2 mm at these places, m, that start as `start` and move down at 1 m/s.
fn body(name: &str, places_m: &[[f64; 3]], more: &str) -> String {
    let spheres = places_m.iter();
    let spheres = spheres.map(|[x, y, z]| format!("[{x:e}, {y:e}, {z:e}, {RADIUS_M}]"));
    let spheres: Vec<String> = spheres.collect();
    format!(
        "[bodies.{name}]\nmaterial = \"m\"\nparticles = [{}]\n{more}\n",
        spheres.join(", ")
    )
}

const FALLS: &str = "start_as = \"clump\"\nvelocity = [0, 0, -1]";

/// Touching spheres in a grid, the lowest just above the floor.
fn grid([nx, ny, nz]: [u32; 3]) -> Vec<[f64; 3]> {
    let all = (0..nx).flat_map(|i| (0..ny).flat_map(move |j| (0..nz).map(move |k| [i, j, k])));
    let place = |[i, j, k]: [u32; 3]| {
        let [x, y, z] = [i, j, k].map(|n| 2.0 * RADIUS_M * f64::from(n));
        [x, y, z + 1.01 * RADIUS_M]
    };
    all.map(place).collect()
}

fn touches(state: &State) -> bool {
    let of_walls = state.walls.iter().flat_map(|wall| &wall.touching);
    let of_pairs = state
        .contacts
        .iter()
        .flat_map(|contacts| &contacts.histories);
    let of_walls = of_walls.map(|touch| &touch.history);
    let mut all = of_walls.chain(of_pairs);
    all.any(|history| history.overlap_m() > 0.0)
}

/// Steps until nothing touches any more. Returns the error of the energy then.
fn bounce(state: &mut State, mut look: impl FnMut(&State)) -> f64 {
    let mut worst = 0.0_f64;
    let mut has_touched = false;
    for _ in 0..200_000 {
        interact(state);
        let error = balance(state).energy_error.abs();
        worst = worst.max(error);
        let now = touches(state);
        if has_touched && !now {
            // At the touch, a dashpot begins with its full force within a step.
            assert!(worst < 1e-2, "{worst:e}");
            return error;
        }
        has_touched |= now;
        look(state);
        advance(state);
    }
    panic!(
        "no end of the contact: {has_touched} at {:e} s",
        state.time_s
    );
}

/// Speeds upwards of all clumps after a bounce, m/s, and the error of the energy after it.
fn speeds(text: &str) -> (Vec<f64>, f64) {
    let Plan { mut state, .. } = planned(text);
    let worst = bounce(&mut state, |_| ());
    let up = state.clumps.all.iter().map(|clump| clump.velocity_m_s[2]);
    (up.collect(), worst)
}

/// How near a rebound comes to its restitution: single impacts scatter with the moment within a
/// step at which they begin, the more the more is lost.
fn tolerance(restitution: f64) -> f64 {
    if restitution < 0.5 { 0.1 } else { 0.05 }
}

fn all_restitutions() -> impl Iterator<Item = (&'static str, f64)> {
    let of_law = |law| [0.1, 0.5, 0.9, 1.0].map(|restitution| (law, restitution));
    [LINEAR, HERTZ].into_iter().flat_map(of_law)
}

/// From 4 contacts at once to 400.
#[test]
fn plates_that_land_flat_rebound_as_their_material_says() {
    for n in [2, 5, 10, 20] {
        for (law, restitution) in all_restitutions() {
            let falls = body("b", &grid([n, n, 1]), FALLS);
            let (up, worst) = speeds(&with_floor(law, restitution, &falls));
            let error = up[0] / restitution - 1.0;
            eprintln!("{n} x {n} {law} {restitution}: {error:.4}, energy {worst:.1e}");
            assert!(
                error.abs() < tolerance(restitution),
                "{n} {law} {restitution}: {}",
                up[0]
            );
            assert!(worst < 1e-3, "{n} {law} {restitution}: {worst:e}");
        }
    }
}

/// Their mass is above their contacts, so that they rock more slowly than they bounce.
#[test]
fn blocks_that_land_on_a_face_rebound_as_their_material_says() {
    for sides in [[2, 2, 2], [5, 5, 5], [4, 4, 8], [3, 8, 2]] {
        for (law, restitution) in all_restitutions() {
            let falls = body("b", &grid(sides), FALLS);
            let (up, worst) = speeds(&with_floor(law, restitution, &falls));
            let error = up[0] / restitution - 1.0;
            eprintln!("{sides:?} {law} {restitution}: {error:.4}, energy {worst:.1e}");
            assert!(
                error.abs() < tolerance(restitution),
                "{sides:?} {law} {restitution}: {}",
                up[0]
            );
            assert!(worst < 1e-3, "{sides:?} {law} {restitution}: {worst:e}");
        }
    }
}

#[test]
fn rods_that_land_flat_or_upright_rebound_as_their_material_says() {
    for n in [1, 2, 10, 100] {
        for (sides, (law, restitution)) in [[n, 1, 1], [1, 1, n]]
            .into_iter()
            .flat_map(|sides| all_restitutions().map(move |contact| (sides, contact)))
        {
            let falls = body("b", &grid(sides), FALLS);
            let (up, worst) = speeds(&with_floor(law, restitution, &falls));
            let error = up[0] / restitution - 1.0;
            assert!(
                error.abs() < tolerance(restitution),
                "{sides:?} {law} {restitution}: {}",
                up[0]
            );
            // One contact takes the step of a sphere.
            let most = if sides[0] > 1 { 1e-3 } else { 5e-3 };
            assert!(worst < most, "{sides:?} {law} {restitution}: {worst:e}");
        }
    }
}

/// Velocity of a point of a clump, m/s.
fn velocity_at(state: &State, clump: &Clump, point: &Vector3<f64>) -> Vector3<f64> {
    let spin = clump.spin_rad_s(state.clumps.template(clump));
    Vector3::from(clump.velocity_m_s) + spin.cross(&(point - Vector3::from(clump.place_m)))
}

/// Without friction the end that hits turns round at e times its speed: its mass there is
/// 1/(1/m + (r x n) I^-1 (r x n)).
#[test]
fn a_rod_that_lands_on_an_end_turns_round_there_as_its_material_says() {
    for (n, degrees) in [(2, 45.0), (5, 20.0), (5, 60.0), (20, 45.0)] {
        for (law, restitution) in all_restitutions() {
            let (sine, cosine) = f64::to_radians(degrees).sin_cos();
            let along = |i: u32| 2.0 * RADIUS_M * f64::from(i);
            let place = |i: u32| [along(i) * cosine, 0.0, along(i) * sine + 1.01 * RADIUS_M];
            let places: Vec<[f64; 3]> = (0..n).map(place).collect();
            let falls = body("b", &places, FALLS);
            let text = with_floor(law, restitution, &falls);
            let Plan { mut state, .. } =
                planned(&text.replace("restitution", "friction = 0, restitution"));
            let worst = bounce(&mut state, |_| ());
            let clump = state.clumps.all[0];
            let lowest = state
                .particles
                .poses
                .iter()
                .map(dem_engine::state::particles::Pose::place);
            let lowest = lowest.min_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
            let up = velocity_at(&state, &clump, &lowest).z;
            eprintln!("{n} at {degrees}: {law} {restitution}: {up:.4}, energy {worst:.1e}");
            // It turns by some degrees before the end leaves.
            assert!(
                (up - restitution).abs() < 0.03,
                "{n} at {degrees}: {law} {restitution}: {up}"
            );
            assert!(
                worst < 5e-3,
                "{n} at {degrees}: {law} {restitution}: {worst:e}"
            );
        }
    }
}

/// The error of the energy depends on the moment within a step at which a contact begins. It is
/// largest where both sides move, without damping, under a force that begins with its full slope.
#[test]
fn the_energy_of_two_plates_is_kept_wherever_in_a_step_they_meet() {
    for n in 0..12 {
        let gap_m = 1e-5 + 1.37e-6 * f64::from(n);
        let at = |height_m: f64| {
            let up = |[x, y, z]: [f64; 3]| [1.1 * x, 1.1 * y, z + height_m];
            grid([2, 2, 1]).into_iter().map(up).collect::<Vec<_>>()
        };
        let above = body("a", &at(0.05 + 2.0 * RADIUS_M + gap_m), FALLS);
        let below = body("b", &at(0.05), "start_as = \"clump\"\nvelocity = [0, 0, 1]");
        let (_, error) = speeds(&with_floor(LINEAR, 1.0, &format!("{above}{below}")));
        assert!(error < 1e-3, "{gap_m}: {error:e}");
    }
}

/// Two plates meet face to face; and a plate meets loose spheres, one at each of its own.
#[test]
fn clumps_that_meet_on_many_contacts_part_as_their_material_says() {
    let at = |height_m: f64| {
        // No sphere touches the next.
        let up = |[x, y, z]: [f64; 3]| [1.1 * x, 1.1 * y, z + height_m];
        grid([5, 5, 1]).into_iter().map(up).collect::<Vec<_>>()
    };
    for (law, restitution) in all_restitutions() {
        let above = body("a", &at(0.05 + 2.01 * RADIUS_M), FALLS);
        let below = body("b", &at(0.05), "start_as = \"clump\"\nvelocity = [0, 0, 1]");
        let (up, worst) = speeds(&with_floor(law, restitution, &format!("{above}{below}")));
        let error = (up[0] - up[1]) / (2.0 * restitution) - 1.0;
        eprintln!("plates {law} {restitution}: {error:.4}, energy {worst:.1e}");
        assert!(
            error.abs() < tolerance(restitution) && (up[0] + up[1]).abs() < 1e-9,
            "{up:?}"
        );
        assert!(worst < 1e-3, "{law} {restitution}: {worst:e}");

        let loose = at(0.05).into_iter().enumerate();
        let loose = loose.map(|(n, place)| {
            body(
                &format!("s{n}"),
                &[place],
                "start_as = \"clump\"\nvelocity = [0, 0, 1]",
            )
        });
        let loose: String = loose.collect();
        let (up, _) = speeds(&with_floor(law, restitution, &format!("{above}{loose}")));
        let error = (up[0] - up[1]) / (2.0 * restitution) - 1.0;
        eprintln!("spheres {law} {restitution}: {error:.4}");
        assert!(error.abs() < tolerance(restitution), "{up:?}");
    }
}

/// A body of a file with its lowest point just above the floor, and what it is after its bounce:
/// its speed upwards, m/s, its largest number of contacts, and the error of the energy after it.
fn packed(file: &str, law: &str, restitution: f64) -> (f64, usize, f64) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/bodies");
    let entry = |height_m: f64| {
        format!(
            "[bodies.b]\nfile = \"{folder}/{file}\"\nmaterial = \"m\"\n\
             position = [0, 0, {height_m:e}]\n{FALLS}\n"
        )
    };
    let lowest = |state: &State| {
        let depths = state.particles.poses.iter();
        let depths = depths.map(|pose| pose.place().z - pose.radius_m());
        depths.fold(f64::INFINITY, f64::min)
    };
    let there = lowest(&planned(&with_floor(law, restitution, &entry(1.0))).state);
    let Plan { mut state, .. } = planned(&with_floor(law, restitution, &entry(1.0 - there + 1e-6)));
    let mut most = 0;
    let worst = bounce(&mut state, |state| {
        most = most.max(state.walls[0].touching.len());
    });
    (state.clumps.all[0].velocity_m_s[2], most, worst)
}

/// Few spheres touch first, others later.
#[test]
fn packed_bodies_bounce_as_their_material_says() {
    for (file, law, restitution) in [
        ("cake.vtp", LINEAR, 0.5),
        ("cake.vtp", HERTZ, 0.5),
        ("cake.vtp", HERTZ, 1.0),
        ("disc.vtp", HERTZ, 0.5),
    ] {
        let (up, contacts, worst) = packed(file, law, restitution);
        eprintln!("{file} {law} {restitution}: {up:.3} m/s on {contacts}, energy {worst:.1e}");
        assert!(contacts > 10, "{file}: {contacts}");
        assert!(
            (up / restitution - 1.0).abs() < 0.05,
            "{file} {law} {restitution}: {up}"
        );
        assert!(worst < 1e-3, "{file} {law} {restitution}: {worst:e}");
    }
}

/// A block of 3 x 3 x `layers` spheres, with bonds along the edges of the grid and across its
/// faces, a hundred times as stiff as its contacts: its speed after a bounce over that before.
fn bonded_rebound(law: &str, restitution: f64, layers: u32) -> f64 {
    let places = grid([3, 3, layers]);
    let near = |a: &[f64; 3], b: &[f64; 3]| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt() < 3.0 * RADIUS_M
    };
    let pairs = (0..places.len()).flat_map(|a| (0..a).map(move |b| [b, a]));
    let pairs: Vec<[usize; 2]> = pairs
        .filter(|[a, b]| near(&places[*a], &places[*b]))
        .collect();
    let more = format!("bonds = \"m\"\nbond_list = {pairs:?}\nvelocity = [0, 0, -0.1]");
    let stiff = "[bonds.m]\nyoung_modulus = \"10 GPa\"\npoisson_ratio = 0.25\n";
    let falls = stiff.to_owned() + &body("b", &places, &more);
    let Plan { mut state, .. } = planned(&with_floor(law, restitution, &falls));
    let worst = bounce(&mut state, |_| ());
    assert!(worst < 1e-3, "{law} {restitution} {layers}: {worst:e}");
    let motions = state.particles.motions.iter();
    let momentum = motions.clone().map(|m| m.velocity_m_s[2] / m.inverse_mass);
    let mass = motions.map(|m| 1.0 / m.inverse_mass);
    momentum.sum::<f64>() / mass.sum::<f64>() / 0.1
}

/// Each contact of the lowest layer stops all that stand on it; the page has the same values.
#[test]
fn bonded_blocks_rebound_the_faster_the_more_layers_they_have() {
    let page = include_str!("../../../../doc/inside/contacts.md");
    for restitution in [0.2, 0.5, 0.8] {
        let expected = [1, 2, 4, 8].map(|layers| bonded_restitution(restitution, layers.into()));
        let [a, b, c, d] = expected;
        let row = format!("| {restitution} | {a:.2} | {b:.2} | {c:.2} | {d:.2} |");
        assert!(page.contains(&row), "{row}");
        for (layers, law) in [(1, HERTZ), (2, LINEAR), (4, HERTZ), (8, LINEAR)] {
            let expected = bonded_restitution(restitution, layers.into());
            let found = bonded_rebound(law, restitution, layers);
            eprintln!("{layers} {law} {restitution}: {found:.4}, by the formula {expected:.4}");
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{layers} {law} {restitution}"
            );
        }
    }
}

/// The packed cake lands on a few of its spheres: a run that replaces it says that it then bounces
/// otherwise. A plate of one layer bounces as before.
#[test]
fn a_replaced_body_that_bounces_otherwise_is_noted() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/bodies/cake.vtp");
    let note = |body: &str| {
        let replaced = format!(
            "[bonds.m]\nyoung_modulus = \"50 MPa\"\npoisson_ratio = 0.25\n\
             failure = {{ tensile_strength = \"1 MPa\" }}\n\
             [bodies.b]\n{body}\nmaterial = \"m\"\nbonds = \"m\"\n{FALLS}\n\
             [replacement.b]\nwhen = {{ time = 0.5 }}\n"
        );
        let Plan { notes, .. } = planned(&with_floor(HERTZ, 0.5, &replaced));
        notes
            .into_iter()
            .find(|note| note.contains("rebounds from a flat landing"))
    };
    let cake = note(&format!("file = \"{file}\"\nposition = [0, 0, 1]"));
    assert!(cake.is_some_and(|note| note.contains("at 0.5 of its speed as a clump")));
    let plate = "particles = [[0, 0, 0.01, 0.001], [0.002, 0, 0.01, 0.001]]\nbond_list = [[0, 1]]";
    assert_eq!(note(plate), None);
}

/// The first impacts of a rod need no smaller step than those of its spheres; a flat landing takes
/// 0.27 of it with the linear law, 0.4 with Hertz's.
#[test]
fn slender_clumps_take_about_the_step_of_a_sphere() {
    for (law, flat) in [(LINEAR, 0.27), (HERTZ, 0.4)] {
        let steps = [1, 10, 100].map(|n| {
            let falls = body("b", &grid([n, 1, 1]), FALLS);
            planned(&with_floor(law, 0.5, &falls)).step.step_s
        });
        eprintln!("{law}: {steps:?}");
        for step in &steps[1..] {
            assert!(
                (0.98 * flat..1.5).contains(&(step / steps[0])),
                "{law} {steps:?}"
            );
        }
    }
}

/// Contacts see the inverse mass and moment of a sphere as they are, bit by bit.
#[test]
fn single_spheres_keep_their_mass_in_contacts() {
    let pair = body("pair", &grid([2, 1, 1]), FALLS);
    let single = body("one", &[[0.02, 0.0, 1.01 * RADIUS_M]], FALLS);
    let Plan { mut state, .. } = planned(&with_floor(HERTZ, 0.5, &format!("{pair}{single}")));
    let inertia = |state: &State, name: &str| {
        let is_meant = |clump: &&Clump| state.clumps.template(clump).body == name;
        let clump = state.clumps.all.iter().find(is_meant).unwrap();
        let motion = state.particles.motions[clump.first as usize];
        [motion.inverse_mass, motion.inverse_inertia]
    };
    let before = ["one", "pair"].map(|name| inertia(&state, name));
    let (mut of_one, mut of_pair) = (0, 0);
    bounce(&mut state, |state| {
        of_one += u32::from(inertia(state, "one") != before[0]);
        let [mass, moment] = inertia(state, "pair");
        // Two contacts: each has half of the mass, and half of the moment.
        let halved = (mass / before[1][0] - 2.0).abs() < 1e-9 && moment == 2.0 * before[1][1];
        of_pair += u32::from(halved);
    });
    assert!(of_one == 0 && of_pair > 3, "{of_one} {of_pair}");
}

/// A plane touches a whole face at once, however the body is turned; a contact moves the end of a
/// long rod as it would move a mass of a quarter of the rod's.
#[test]
fn landings_are_those_of_whole_faces_and_of_ends() {
    for (sides, face) in [
        ([1, 1, 1], 1),
        ([100, 1, 1], 100),
        ([20, 20, 1], 400),
        ([3, 4, 5], 20),
    ] {
        let turned = "rotation = { axis = [1, 2, 3], angle = 1 }";
        let falls = body(
            "b",
            &grid(sides),
            &format!("{FALLS}\n{turned}\nposition = [0, 0, 1]"),
        );
        let state = planned(&with_floor(HERTZ, 0.5, &falls)).state;
        let template = &state.clumps.templates[0];
        let spheres = template.spheres.iter();
        let spheres = spheres.map(|sphere| (Vector3::from(sphere.place_m), sphere.radius_m));
        let found = RigidSpheres {
            mass_kg: template.mass_kg,
            moments_kg_m2: template.moments_kg_m2.into(),
            spheres: spheres.collect(),
        }
        .landing();
        let shares = template.mass_kg * found.together_per_kg;
        let alone = template.mass_kg * found.alone_per_kg;
        eprintln!(
            "{sides:?}: {} together, {shares:.3} of the mass, alone {alone:.3}",
            found.together
        );
        assert_eq!(found.together, face, "{sides:?}");
        assert!(
            (shares / f64::from(face) - 1.0).abs() < 1e-3,
            "{sides:?}: {shares}"
        );
        if sides == [100, 1, 1] {
            assert!((alone / 4.0 - 1.0).abs() < 0.02, "{alone}");
        }
    }
}
