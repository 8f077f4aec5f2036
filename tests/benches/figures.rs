//! The first tables of doc/inside/performance.md: how fast a step is in scenes of bonded bodies, of
//! loose spheres and of rigid clumps, and how much of it is the neighbour search.
//! `cargo bench -p dem-tests --bench figures`, then the names of cases or nothing, and
//! `--page FILE` to write it. Some minutes.
#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark stops where it fails, and prints a table"
)]

mod filled;
mod page;
mod reading;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::Instant;

use dem_io::Body;
use dem_run::plan::plan;
use dem_run::state::State;
use dem_run::step::{stages, step};
use dem_run::threads::keep_awake;

use self::filled::{packed, shape};
use self::page::{Table, words};

/// Number of rounds, of which the median is taken.
const ROUNDS: usize = 7;

/// What was aimed at, on one thread and two: rates in millions, or as said.
const WANTED: [(&str, [&str; 2]); 6] = [
    ("free", ["65", "125"]),
    ("drop-damped", ["48", "92"]),
    ("drop", ["60", "115"]),
    ("bed", ["22", "40"]),
    ("bed-hit", ["0.9 of `bed`"; 2]),
    ("pour", ["", "search 15 %"]),
];

/// What is counted in a step.
#[derive(Clone, Copy)]
enum Counted {
    Bonds,
    Particles,
    Steps,
}

/// A scene whose steps are timed.
struct Case {
    name: &'static str,
    counted: Counted,
    scene: String,
    bodies: BTreeMap<String, Body>,
    /// Simulated time before the first round, s, and in each round.
    times_s: [f64; 2],
}

const HEAD: &str = "version = 1
[run]
end_time = \"10 s\"
gravity = [0, 0, -9.81]
initial_overlap = \"relax\"
[materials.stuff]
density = \"2050 kg/m3\"
shear_modulus = \"10 MPa\"
poisson_ratio = 0.3
[contacts]
stuff-stuff = { restitution = 0.3, friction = 0.5 }
";

/// A body of bonded spheres; with a bond table as given.
fn bonded(bonds: &str, more: &str) -> String {
    format!(
        "{HEAD}[bonds.stuff]\nyoung_modulus = \"12.05 MPa\"\npoisson_ratio = 0.3\n{bonds}\nfailure = {{ von_mises_strength = \"1 GPa\", equivalent_stress = \"axial-in-tension\" }}\n\
         [bodies.cake]\nfile = \"cake.vtp\"\nmaterial = \"stuff\"\nbonds = \"stuff\"\n{more}"
    )
}

/// Planes around a box with these sides, m, open above.
fn planes([x, y]: [f64; 2]) -> String {
    let mut text = String::new();
    let (x, y) = (0.5 * x, 0.5 * y);
    for (name, point, normal) in [
        ("bottom", [0.0, 0.0, 0.0], [0, 0, 1]),
        ("left", [-x, 0.0, 0.0], [1, 0, 0]),
        ("right", [x, 0.0, 0.0], [-1, 0, 0]),
        ("front", [0.0, -y, 0.0], [0, 1, 0]),
        ("back", [0.0, y, 0.0], [0, -1, 0]),
    ] {
        write!(
            text,
            "[walls.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"stuff\"\n"
        )
        .expect("text grows");
    }
    text
}

fn cases(is_asked_for: impl Fn(&str) -> bool) -> Vec<Case> {
    let cake = |body: Body| BTreeMap::from([("cake".to_owned(), body)]);
    let mut cases = Vec::new();
    let mut add = |name: &'static str, counted, make: &dyn Fn() -> (String, Body), times_s| {
        if is_asked_for(name) {
            let (scene, body) = make();
            cases.push(Case {
                name,
                counted,
                scene,
                bodies: cake(body),
                times_s,
            });
        }
    };
    let drop = |bonds: &'static str| {
        move || {
            let floor = "position = [\"-90 mm\", \"-15 mm\", \"1 mm\"]\nvelocity = [0, 0, -4]\n[walls.plate]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"stuff\"\n";
            let body = packed(&shape("filter-cake"), "2.85mm..3.48mm", 0.25, Some(4.9));
            (bonded(bonds, floor), body)
        }
    };
    let free = || {
        let body = packed(&shape("bending-sample"), "1.22mm..1.53mm", 0.0, Some(4.9));
        (bonded("", "angular_velocity = [1, 0, 0]\n"), body)
    };
    let bed = |ball: &'static str| {
        move || {
            let body = packed(&block(), "1.99mm..2.01mm", 0.0, None);
            let text = format!(
                "{HEAD}[bodies.cake]\nfile = \"cake.vtp\"\nmaterial = \"stuff\"\n{ball}{}",
                planes([0.054, 0.054])
            );
            (text, body)
        }
    };
    let pour = || {
        let body = packed(&shape("filter-cake"), "8mm..10mm", 0.25, None);
        let text = format!(
            "{HEAD}[bodies.cake]\nfile = \"cake.vtp\"\nmaterial = \"stuff\"\nstart_as = \"clump\"\n{}\
             [regions.gate]\nbox = {{ min = [-0.25, -0.25, 0.4], max = [0.25, 0.25, 1.2] }}\n\
             [inlets.feed]\nbodies = [\"cake\"]\nregion = \"gate\"\nrate = 250\ncount = 300\norientation = \"random\"\n",
            planes([0.6, 0.6])
        );
        (text, body)
    };
    let ball = "[bodies.ball]\nparticles = [[0, 0, 0.0705, 0.01]]\nmaterial = \"stuff\"\nvelocity = [0, 0, -2]\n";
    add("free", Counted::Bonds, &free, [1e-4, 3e-4]);
    let damped = drop("damping = { damping_ratio = 0.1 }");
    add("drop-damped", Counted::Bonds, &damped, [1e-3, 1e-3]);
    add("drop", Counted::Bonds, &drop(""), [1e-3, 1e-3]);
    add("bed", Counted::Particles, &bed(""), [5e-3, 2e-3]);
    add("bed-hit", Counted::Particles, &bed(ball), [5e-3, 2e-3]);
    add("pour", Counted::Steps, &pour, [0.8, 0.1]);
    cases
}

impl Case {
    fn state(&self, threads: usize) -> State {
        let scene = dem_scene::scene_from_text(&self.scene, "bench.toml", &[]).expect("a scene");
        let mut bodies = self.bodies.clone();
        if self.scene.contains("[bodies.ball]") {
            let written = dem_scene::read_bodies(&only_ball(&scene)).expect("a ball");
            bodies.extend(written);
        }
        plan(&scene, bodies, threads, false).expect("plans").state
    }

    /// A row: rates, and the fraction of the search.
    fn row(&self, threads: usize) -> String {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads start").install(|| {
            let mut state = self.state(threads);
            go(&mut state, self.times_s[0]);
            let rates = || (0..ROUNDS).map(|_| self.rate(&mut state)).collect();
            let mut rates: Vec<f64> = keep_awake(rates);
            rates.sort_by(f64::total_cmp);
            let search = stages().iter().position(|s| s.name == "neighbour search");
            let fraction = state.scratch.clock.fraction(search.expect("a stage"));
            let unit = match self.counted {
                Counted::Bonds => "million bond-steps/s",
                Counted::Particles => "million particle-steps/s",
                Counted::Steps => "steps/s",
            };
            let rate = rates[ROUNDS / 2];
            let reading = match self.counted {
                Counted::Bonds => Some(reading::million_bonds_per_s(&state)),
                Counted::Particles => Some(reading::million_particles_per_s(&state)),
                Counted::Steps => None,
            };
            let reading = reading.map_or(String::from("|"), |reading| {
                format!("{reading:.0} | {:.0} %", 1e2 * rate / reading)
            });
            let wanted = WANTED.iter().find(|(case, _)| *case == self.name);
            let wanted = wanted.map_or("", |(_, wanted)| wanted[threads - 1]);
            format!(
                "| {} | {} | {} | {threads} | {rate:.1} | {wanted} | {unit} | {reading} | {:.0} % |",
                self.name,
                state.particles.len(),
                state.bonds.len(),
                1e2 * fraction
            )
        })
    }

    /// A row on the searches of a scene: how many steps apart they are, how long each takes, and
    /// what the memory allows.
    fn search_row(&self, threads: usize) -> String {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads start").install(|| {
            let mut state = self.state(threads);
            go(&mut state, self.times_s[0]);
            let stage = stages().iter().position(|s| s.name == "neighbour search");
            let stage = stage.expect("a stage");
            let end_s = state.time_s + ROUNDS as f64 * self.times_s[1];
            let (mut with, mut without, mut sought) = (Vec::new(), Vec::new(), 0);
            keep_awake(|| {
                while state.time_s < end_s {
                    let (clock, before) = (Instant::now(), state.scratch.clock.done(stage));
                    step(&mut state);
                    let took_s = clock.elapsed().as_secs_f64();
                    let done = state.scratch.clock.done(stage) - before;
                    sought += done;
                    if done > 0 { &mut with } else { &mut without }.push(took_s);
                }
            });
            let [search_s, other_s] = [with.as_slice(), &without].map(mean);
            let searches = with.len() as f64;
            let apart = (with.len() + without.len()) as f64 / searches;
            format!(
                "| {} | {threads} | {apart:.0} | {:.0} of {} | {} | {:.2} ms | {:.2} ms |",
                self.name,
                sought as f64 / searches,
                state.particles.len(),
                state.contacts.as_ref().map_or(0, |c| c.pairs.len()),
                1e3 * (search_s - other_s),
                1e3 * reading::search_s(&state)
            )
        })
    }

    /// Work per second in a round.
    fn rate(&self, state: &mut State) -> f64 {
        let (clock, before) = (Instant::now(), state.steps);
        go(state, self.times_s[1]);
        let items = match self.counted {
            Counted::Bonds => 1e-6 * state.bonds.len() as f64,
            Counted::Particles => 1e-6 * state.particles.len() as f64,
            Counted::Steps => 1.0,
        };
        items * (state.steps - before) as f64 / clock.elapsed().as_secs_f64()
    }
}

/// The scene with the body alone that is written in it.
fn only_ball(scene: &dem_scene::Scene) -> dem_scene::Scene {
    let mut scene = scene.clone();
    scene.bodies.retain(|name, _| name == "ball");
    scene
}

fn mean(times_s: &[f64]) -> f64 {
    times_s.iter().sum::<f64>() / times_s.len() as f64
}

fn go(state: &mut State, time_s: f64) {
    let end_s = state.time_s + time_s;
    while state.time_s < end_s {
        step(state);
    }
}

/// A block of 54 mm x 54 mm x 60 mm as STL, in mm.
fn block() -> Vec<u8> {
    let corner = |n: usize| [(n & 4) * 54 / 4, (n & 2) * 27, (n & 1) * 60].map(|x| x as i64);
    let sides = [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ];
    let mut text = "solid block\n".to_owned();
    for [a, b, c, d] in sides {
        for facet in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in facet.map(corner) {
                writeln!(text, "vertex {} {} {z}", x - 27, y - 27).expect("text grows");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text += "endsolid block\n";
    text.into_bytes()
}

fn main() {
    let words = words();
    let wanted = |name: &str| words.is_empty() || words.iter().any(|word| word == name);
    let mut table = Table::new();
    table.row("| case | particles | bonds | threads | rate | wanted | | reading alone | reached | neighbour search |");
    table.row("|---|---|---|---|---|---|---|---|---|---|");
    for case in cases(wanted) {
        for threads in [1, 2] {
            table.row(&case.row(threads));
        }
    }
    table.write("figures");
    let mut table = Table::new();
    table.row("| case | threads | steps between searches | spheres searched for | listed pairs | a search | reading alone |");
    table.row("|---|---|---|---|---|---|---|");
    for case in cases(|name| wanted(name) && name == "pour") {
        for threads in [1, 2] {
            table.row(&case.search_row(threads));
        }
    }
    table.write("figures search");
}
