//! Strength that varies from bond to bond.

use std::collections::BTreeMap;

use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::loads::factor_at;
use dem_engine::state::particles::Particles;
use dem_engine::step::{advance, exchange, interact};
use dem_io::Body;
use dem_io::body::{read_body, write_body};
use dem_physics::bond::scatter::strength_factor;
use dem_plan::{Plan, plan};
use dem_scene::scene_from_text;

use super::bodies::{
    LENGTH_M, LOAD_STEP, NORMAL, RADIUS_M, SOFT_STEPS, STRENGTH_PA, YOUNG_PA, area_m2, bonded,
    hold, on_one_thread, push, rod,
};

const MODULUS: f64 = 6.0;

/// Ten bonds in a row carry the same load: the weakest breaks, alone, at its strength.
#[test]
fn the_weakest_bond_of_a_chain_breaks_first() {
    on_one_thread(|| {
        for seed in 0..6 {
            for incremental in [false, true] {
                let mut state = rod(10, NORMAL, incremental);
                hold(&mut state, std::iter::once(0), 0.0);
                let factors: Vec<f64> = (0..10)
                    .map(|i| strength_factor(seed, 0, [i, i + 1], MODULUS))
                    .collect();
                let weakest = (0..10).min_by(|&a, &b| factors[a].total_cmp(&factors[b]));
                let weakest = weakest.unwrap();
                let strength = factors[weakest];
                state.bonds.strength_factors = factors;
                let force = strength * STRENGTH_PA * area_m2();
                push(&mut state, 10, [force, 0.0, 0.0], [0.0; 3]);
                while state.broken_count == 0 {
                    interact(&mut state);
                    if state.broken_count == 0 {
                        advance(&mut state);
                    }
                    assert!(
                        state.steps < 2 * u64::from(SOFT_STEPS) + 10,
                        "does not break"
                    );
                }
                assert_eq!(state.scratch.events.broken.len(), 1);
                assert_eq!(state.scratch.events.broken[0].bond as usize, weakest);
                let load = factor_at(&state.loads[0].factor, state.time_s);
                let late = (load - 1.0) / LOAD_STEP;
                assert!((-0.1..1.1).contains(&late), "{late} steps late");
            }
        }
    });
}

/// Two thousand bonds under equal elongation break at Weibull-distributed strengths:
/// Kolmogorov-Smirnov test at one per cent.
#[test]
fn strengths_are_those_of_weibull() {
    const COUNT: usize = 2000;
    const STEPS: f64 = 1000.0;
    let mut particles = Particles::default();
    let mut pairs = Vec::new();
    for i in 0..COUNT {
        let y = 4.0 * RADIUS_M * i as f64;
        particles.push_sphere([0.0, y, 0.0], RADIUS_M, 2500.0);
        particles.push_sphere([LENGTH_M, y, 0.0], RADIUS_M, 2500.0);
        pairs.push([2 * i as u32, 2 * i as u32 + 1]);
    }
    let mut state = bonded(particles, &pairs, NORMAL, false);
    state.bonds.strength_factors = pairs
        .iter()
        .map(|pair| strength_factor(11, 0, pair.map(u64::from), MODULUS))
        .collect();
    let speed = 1e-3;
    let even = (0..COUNT as u32).map(|i| 2 * i);
    hold(&mut state, even, 0.0);
    let odd = (0..COUNT as u32).map(|i| 2 * i + 1);
    hold(&mut state, odd, speed);
    state.time_step_s = STRENGTH_PA / YOUNG_PA * LENGTH_M / speed / STEPS;
    let mut strengths = Vec::new();
    while strengths.len() < COUNT {
        interact(&mut state);
        for broken in &state.scratch.events.broken {
            let strength = state.steps as f64 / STEPS;
            let given = state.bonds.strength_factor(broken.bond as usize);
            let late = (strength - given) * STEPS;
            assert!((-0.05..1.05).contains(&late), "{given} broke at {strength}");
            strengths.push(given);
        }
        assert!(
            state
                .scratch
                .events
                .broken
                .windows(2)
                .all(|two| two[0].bond < two[1].bond)
        );
        advance(&mut state);
        assert!((state.steps as f64) < 3.0 * STEPS, "not all break");
    }
    assert_eq!(state.broken_count as usize, COUNT);
    let largest = strengths
        .iter()
        .enumerate()
        .fold(0.0, |largest: f64, (i, strength)| {
            let fraction = 1.0 - (-strength.powf(MODULUS)).exp();
            let (before, after) = (i as f64 / COUNT as f64, (i + 1) as f64 / COUNT as f64);
            largest
                .max((fraction - before).abs())
                .max((fraction - after).abs())
        });
    assert!(largest < 1.63 / (COUNT as f64).sqrt(), "off by {largest}");
}

/// Bonds of a lump, which connects neighbours in several directions.
const BONDS: [[u32; 2]; 9] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [0, 4],
    [1, 4],
    [1, 5],
    [2, 5],
    [3, 5],
    [4, 5],
];

/// A lump of six spheres with these bonds.
fn lump(bonds: &[[u32; 2]]) -> Body {
    let places = [
        [0.0, 0.0, 0.0],
        [9.0, 1.0, 0.0],
        [18.0, 0.0, 1.0],
        [27.0, 1.0, 2.0],
        [4.0, 9.0, 0.5],
        [14.0, 8.0, -1.0],
    ];
    let spheres = places.map(|[x, y, z]: [f64; 3]| [1e-3 * x, 1e-3 * y, 1e-3 * z, 5e-3]);
    Body::from_spheres(&spheres, bonds).unwrap()
}

/// A scene of lumps with these names; `more` is added to the table of the one called lump.
fn scene_of(names: &[&str], more: &str) -> String {
    let mut text = "version = 1\nrun = { end_time = 1, seed = 12 }\n\
        materials.stuff = { density = 2500, young_modulus = 1e8, poisson_ratio = 0.25 }\n\
        contacts.stuff-stuff = { restitution = 0.5, friction = 0.5 }\n\
        bonds.stiff = { young_modulus = 1e9, poisson_ratio = 0.25, \
        failure = { tensile_strength = 1e6, weibull_modulus = 5 } }\n"
        .to_owned();
    for (x, name) in names.iter().enumerate() {
        let own = if *name == "lump" { more } else { "" };
        text += &format!(
            "[bodies.{name}]\nfile = \"{name}.vtp\"\nmaterial = \"stuff\"\nbonds = \"stiff\"\n\
             position = [{x}, 0, 0]\n{own}\n"
        );
    }
    text
}

/// Strengths of the bonds of a placed body, by the numbers of their particles in its file.
fn strengths(state: &State, body: &PlacedBody) -> BTreeMap<[u32; 2], f64> {
    (0..body.bonds.len())
        .map(|n| {
            let at = body.first_bond + n;
            let mut pair = state.bonds.ends[at].map(|end| body.number_of(end).unwrap());
            pair.sort_unstable();
            (pair, state.bonds.strength_factor(at))
        })
        .collect()
}

/// Strengths of the body called lump in a scene of these lumps, which equal `body`.
fn planned_strengths(text: &str, body: &Body) -> BTreeMap<[u32; 2], f64> {
    let scene = scene_from_text(text, "lumps.toml", &[]).unwrap();
    let bodies = (scene.bodies.keys())
        .map(|name| (name.clone(), body.clone()))
        .collect();
    let Plan {
        mut state, bodies, ..
    } = plan(&scene, bodies, 1, true).unwrap();
    if let Some(body) = bodies.iter().find(|body| body.name == "lump") {
        return strengths(&state, body);
    }
    interact(&mut state);
    exchange(&mut state);
    let body = PlacedBody::created(&state.scratch.events.renumberings[0].created[0]);
    strengths(&state, &body)
}

#[test]
fn strengths_do_not_depend_on_the_order_of_bonds_or_on_other_bodies() {
    let alone = scene_of(&["lump"], "");
    let wanted = planned_strengths(&alone, &lump(&BONDS));
    assert_eq!(wanted.len(), BONDS.len());
    let mut turned = BONDS;
    turned.rotate_left(4);
    turned.reverse();
    let reversed = turned.map(|[a, b]| [b, a]);
    assert_eq!(planned_strengths(&alone, &lump(&turned)), wanted);
    assert_eq!(planned_strengths(&alone, &lump(&reversed)), wanted);

    // Written and read in every format that stores both particles and bonds.
    let folder = tempfile::tempdir().unwrap();
    for name in ["lump.vtp", "lump.csv", "lump.txt", "lump.data"] {
        let path = folder.path().join(name);
        write_body(&lump(&reversed), &path).unwrap();
        let body = read_body(&path).unwrap();
        assert_eq!(planned_strengths(&alone, &body), wanted, "{name}");
    }

    // Placed elsewhere, among others, and replaced as a clump.
    let placed = "rotation = { axis = [1, 2, 3], angle = 2 }\nvelocity = [1, 0, 0]";
    let clump = "start_as = \"clump\"\n[replacement.lump]\nwhen = { time = 0 }";
    for (names, more) in [
        (&["lump"][..], placed),
        (&["lump"], clump),
        (&["a", "lump"], ""),
        (&["another-name", "b", "lump", "z"], ""),
        (&["another-name", "b", "lump", "z"], clump),
    ] {
        let text = scene_of(names, more);
        assert_eq!(planned_strengths(&text, &lump(&turned)), wanted, "{text}");
    }
}

/// Two bodies of one file do not have the same strengths.
#[test]
fn bodies_of_one_file_have_strengths_of_their_own() {
    let wanted = planned_strengths(&scene_of(&["lump"], ""), &lump(&BONDS));
    let text = scene_of(&["lump", "twin"], "");
    let scene = scene_from_text(&text, "lumps.toml", &[]).unwrap();
    let bodies = (scene.bodies.keys())
        .map(|name| (name.clone(), lump(&BONDS)))
        .collect();
    let Plan { state, bodies, .. } = plan(&scene, bodies, 1, true).unwrap();
    let twin = strengths(&state, &bodies[1]);
    assert!(
        twin.iter()
            .all(|(pair, strength)| wanted[pair] != *strength)
    );
}
