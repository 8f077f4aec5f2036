//! The table of doc/inside/performance.md on many bodies: the time of a step over the number of
//! bodies that wait in an inlet, sleep, lie, ride, fly bonded or rigid, or are broken; alone, and
//! beside ten bonded bodies that fly. `cargo bench -p dem-tests --bench bodies`, then `--page FILE`
//! to write it, or the largest number of bodies to print it up to there. On one thread, some
//! minutes. With the word `waiting`, what a waiting body costs in time and memory.
#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark stops where it fails, and prints a table"
)]

mod page;

use std::fmt::Write as _;
use std::time::Instant;

use dem_run::plan::plan;
use dem_run::state::State;
use dem_run::step::{all_bytes, step};

use self::page::{Table, words};

/// Numbers of bodies.
const COUNTS: [usize; 4] = [10, 100, 1_000, 10_000];
/// Number of moving bonded bodies beside the others.
const FLYING: usize = 10;
/// Number of rounds, of which the median is taken, and the least time of a round, s.
const ROUNDS: usize = 5;
const ROUND_S: f64 = 0.1;
/// Radius of the spheres of a body, 3 x 3 x 3 of them that touch, m.
const RADIUS_M: f64 = 1e-3;
/// Edge of the square in which each body stands, m.
const SPACING_M: f64 = 8e-3;

/// What bodies do in a case.
#[derive(Clone, Copy, PartialEq)]
enum Doing {
    /// They are still to be fed.
    Waiting,
    /// They lie on the floor, asleep.
    Asleep,
    /// The same, and an inlet finds no room among them.
    AsleepInTheWay,
    /// They lie on the floor as rigid clumps.
    LyingAsClumps,
    /// They ride on a belt as rigid clumps.
    RidingAsClumps,
    /// The same, asleep.
    RidingAsleep,
    /// They fly as rigid clumps.
    FlyingAsClumps,
    /// They fly bonded.
    Bonded,
    /// They have broken into single spheres.
    Broken,
}

const CASES: [(Doing, &str); 9] = [
    (Doing::Waiting, "wait in an inlet"),
    (Doing::Asleep, "lie on a floor, asleep"),
    (
        Doing::AsleepInTheWay,
        "the same, and an inlet finds no room",
    ),
    (Doing::LyingAsClumps, "lie on a floor, as clumps"),
    (Doing::RidingAsClumps, "ride on a belt, as clumps"),
    (Doing::RidingAsleep, "ride on a belt, asleep"),
    (Doing::FlyingAsClumps, "fly as clumps"),
    (Doing::Bonded, "fly, bonded"),
    (Doing::Broken, "fly, broken into spheres"),
];

/// Whether the bodies sleep.
fn is_asleep(doing: Doing) -> bool {
    matches!(
        doing,
        Doing::Asleep | Doing::AsleepInTheWay | Doing::RidingAsleep
    )
}

/// The scene: bodies of one kind, and `flying` bonded ones above them.
fn scene(doing: Doing, bodies: usize, flying: usize) -> String {
    let sleeps = is_asleep(doing);
    let rides = matches!(doing, Doing::RidingAsClumps | Doing::RidingAsleep);
    let lies = sleeps || rides || doing == Doing::LyingAsClumps;
    let gravity = if lies { "-9.81" } else { "0" };
    // Bodies above a floor fall less than a tenth of their size in the rounds.
    let mut text = format!(
        "version = 1\n\
         [run]\nend_time = \"10000 s\"\ngravity = [0, 0, {gravity}]\ninitial_overlap = \"keep\"\n\
         [materials.stuff]\ndensity = \"2000 kg/m3\"\nyoung_modulus = \"20 MPa\"\n\
         [contacts]\nstuff-stuff = {{ restitution = 0.1, friction = 0.5 }}\n\
         [bonds.firm]\nyoung_modulus = \"20 MPa\"\npoisson_ratio = 0.3\n\
         failure = {{ tensile_strength = \"1 GPa\" }}\n\
         [bonds.weak]\nyoung_modulus = \"20 MPa\"\npoisson_ratio = 0.3\n\
         failure = {{ tensile_strength = \"0.001 Pa\" }}\n\
         [walls.floor]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n"
    );
    if rides {
        text += "surface_velocity = [1, 0, 0]\n";
    }
    if sleeps {
        text += "[sleep]\nspeed = \"1 mm/s\"\nafter = \"0.5 ms\"\n";
    }
    let bonds = if doing == Doing::Broken {
        "weak"
    } else {
        "firm"
    };
    let motion = match doing {
        Doing::LyingAsClumps => "start_as = \"clump\"\n",
        Doing::RidingAsClumps | Doing::RidingAsleep => {
            "start_as = \"clump\"\nvelocity = [1, 0, 0]\n"
        }
        Doing::FlyingAsClumps => "start_as = \"clump\"\nangular_velocity = [1, 0, 0]\n",
        Doing::Broken => "angular_velocity = [20, 15, 10]\n",
        Doing::Waiting | Doing::Asleep | Doing::AsleepInTheWay => "",
        Doing::Bonded => "angular_velocity = [1, 0, 0]\n",
    };
    let height_m = if lies { 0.9999 * RADIUS_M } else { 0.1 };
    if doing == Doing::Waiting {
        body(&mut text, "waiting", bonds, "");
        write!(
            text,
            "[regions.gate]\nbox = {{ min = [0, 0, 3], max = [1, 1, 4] }}\n\
             [inlets.feed]\nbodies = [\"waiting\"]\nregion = \"gate\"\nrate = 1e-3\nstart = \"5000 s\"\ncount = {bodies}\n"
        )
        .expect("text grows");
    } else {
        for number in 0..bodies {
            let position = place(number, bodies, height_m);
            let at = format!("position = {position:?}\n{motion}");
            body(&mut text, &format!("a{number}"), bonds, &at);
        }
    }
    if doing == Doing::AsleepInTheWay {
        body(&mut text, "waiting", bonds, "");
        text += "[regions.gate]\nbox = { min = [0, 0, 0], max = [1e-4, 1e-4, 1e-4] }\n\
                 [inlets.feed]\nbodies = [\"waiting\"]\nregion = \"gate\"\nrate = 1e6\ncount = 1\n";
    }
    for number in 0..flying {
        let position = place(number, flying, 1.0);
        let at = format!(
            "position = {position:?}\nangular_velocity = [1, 0, 0]\nvelocity = [0, 0, 1]\n"
        );
        body(&mut text, &format!("b{number}"), "firm", &at);
    }
    text
}

/// The place of a body in a square of bodies.
fn place(number: usize, bodies: usize, height_m: f64) -> [f64; 3] {
    let side = (bodies as f64).sqrt().ceil() as usize;
    let [x, y] = [number % side, number / side].map(|n| n as f64 * SPACING_M);
    [x, y, height_m]
}

/// Adds a body, with what places and moves it.
fn body(text: &mut String, name: &str, bonds: &str, more: &str) {
    let at = |n: usize| [n % 3, n / 3 % 3, n / 9];
    let sphere = |n: usize| {
        let [x, y, z] = at(n).map(|k| 2.0 * RADIUS_M * k as f64);
        format!("[{x:?}, {y:?}, {z:?}, {RADIUS_M:?}]")
    };
    let spheres: Vec<String> = (0..27).map(sphere).collect();
    let mut pairs = Vec::new();
    for a in 0..27 {
        for (axis, stride) in [(0, 1), (1, 3), (2, 9)] {
            if at(a)[axis] < 2 {
                pairs.push(format!("[{a}, {}]", a + stride));
            }
        }
    }
    write!(
        text,
        "[bodies.{name}]\nmaterial = \"stuff\"\nbonds = \"{bonds}\"\nparticles = [{}]\nbond_list = [{}]\n{more}",
        spheres.join(", "),
        pairs.join(", ")
    )
    .expect("text grows");
}

/// The state before the first step.
fn planned(doing: Doing, bodies: usize, flying: usize) -> State {
    let text = scene(doing, bodies, flying);
    let scene = dem_scene::scene_from_text(&text, "bench.toml", &[]).expect("a scene");
    let written = dem_scene::read_bodies(&scene).expect("bodies");
    plan(&scene, written, 1, false).expect("plans").state
}

/// The state once the bodies do what they are to do.
fn state(doing: Doing, bodies: usize, flying: usize) -> State {
    let mut state = planned(doing, bodies, flying);
    let is_ready = |state: &State| match doing {
        _ if is_asleep(doing) => {
            (state.sleep.as_ref()).is_some_and(|sleep| sleep.particles >= 27 * bodies)
        }
        Doing::Broken => state.broken_count as usize == 54 * bodies,
        _ => state.steps >= 200,
    };
    while !is_ready(&state) {
        assert!(state.time_s < 1.0, "bodies never do what they are to do");
        step(&mut state);
    }
    state
}

/// Processor time of this thread, s, which other programs do not disturb much. None: the system
/// does not tell it.
fn processor_s() -> Option<f64> {
    let spent = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let spent_ns: f64 = spent.split(' ').next()?.parse().ok()?;
    Some(1e-9 * spent_ns)
}

/// Time of a step, us: the median of rounds.
fn step_us(state: &mut State) -> f64 {
    let mut rounds: Vec<f64> = (0..ROUNDS)
        .map(|_| {
            let (clock, steps) = (Instant::now(), state.steps);
            let before_s = processor_s();
            while clock.elapsed().as_secs_f64() < ROUND_S {
                step(state);
            }
            let spent_s = processor_s()
                .zip(before_s)
                .map(|(after, before)| after - before);
            let spent_s = spent_s.unwrap_or_else(|| clock.elapsed().as_secs_f64());
            1e6 * spent_s / (state.steps - steps) as f64
        })
        .collect();
    rounds.sort_by(f64::total_cmp);
    rounds[ROUNDS / 2]
}

fn main() {
    let waits = words().first().is_some_and(|word| word == "waiting");
    let write = if waits { write_waiting } else { write_table };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a thread starts").install(write);
}

/// What bodies cost that wait: time of a step and memory, over their number. The largest number is
/// planned only.
fn write_waiting() {
    let mut table = Table::new();
    table.row("| bodies of 27 spheres and 54 bonds | | 10 | 100 | 1000 | 10000, not stepped |");
    table.row("|---|---|---|---|---|---|");
    let [few @ .., most] = COUNTS;
    let kb = |state: &State| format!(" {:.0} kB |", all_bytes(state) as f64 * 1e-3);
    for (doing, name) in [CASES[0], CASES[3], CASES[1]] {
        let (mut times, mut memory) = (String::new(), String::new());
        for count in few {
            let mut state = state(doing, count, 0);
            times += &format!(" {:.1} us |", step_us(&mut state));
            memory += &kb(&state);
        }
        memory += &kb(&planned(doing, most, 0));
        table.row(&format!("| {name} | time of a step |{times} |"));
        table.row(&format!("| | memory |{memory}"));
    }
}

fn write_table() {
    let most = words()
        .first()
        .map_or(COUNTS[3], |word| word.parse().expect("a number of bodies"));
    let mut table = Table::new();
    let counts: Vec<usize> = COUNTS.into_iter().filter(|count| *count <= most).collect();
    let head: Vec<String> = counts.iter().map(|count| format!(" {count} |")).collect();
    table.row(&format!("| bodies | beside them |{} |", head.concat()));
    table.row(&format!("|---|---|{}---|", "---|".repeat(counts.len())));
    for (doing, name) in CASES {
        for flying in [0, FLYING] {
            let times: Vec<f64> = counts
                .iter()
                .map(|&count| {
                    let mut state = state(doing, count, flying);
                    let us = step_us(&mut state);
                    let mut inlets = state.population.inlets.iter();
                    assert!(inlets.all(|feed| feed.bodies == 0), "a body has come");
                    us
                })
                .collect();
            let row: Vec<String> = times.iter().map(|us| format!(" {us:.1} |")).collect();
            let beside = if flying == 0 {
                "none"
            } else {
                "ten bonded ones"
            };
            table.row(&format!(
                "| {name} | {beside} |{} us per step |",
                row.concat()
            ));
        }
    }
    table.write("bodies");
}
