//! A step takes no memory, whether it searches for neighbours or not: it keeps what it needs for
//! the next. Memory is taken where a bond breaks, a body comes or an inlet looks for room, by looks
//! now and then, and by lists that become longer than ever before.

use std::fmt::Write;

use allocation_counter::measure;
use dem_run::state::State;
use dem_run::step;

use super::root;
use super::verification::page::on_one_thread;
use super::verification::scene::started;

const HEAD: &str = "version = 1
run = { end_time = 1, initial_overlap = \"keep\", gravity = [0, 0, -9.81] }
materials.stone = { density = 2500, young_modulus = 1e8, poisson_ratio = 0.3 }
contacts.stone-stone = { restitution = 0.5, friction = 0.4 }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"stone\" }
";

/// Of a body that slides away.
const FLUNG: &str = ", velocity = [1, 0, 0]";

/// A block of 64 bonded spheres with its lowest layer at this height, in diameters.
fn block(height: f64, bonds: &str, more: &str) -> String {
    cube(4, height, bonds, more)
}

/// A cube of so many spheres along each edge.
fn cube(side: usize, height: f64, bonds: &str, more: &str) -> String {
    let (mut spheres, mut pairs) = (String::new(), String::new());
    for n in 0..side * side * side {
        let at = [n % side, n / side % side, n / (side * side)];
        let [x, y, z] = at.map(|k| 2e-3 * k as f64);
        write!(spheres, "[{x:e}, {y:e}, {:e}, 1e-3], ", z + 2e-3 * height).unwrap();
        for (axis, to) in [1, side, side * side].into_iter().enumerate() {
            if at[axis] + 1 < side {
                write!(pairs, "[{n}, {}], ", n + to).unwrap();
            }
        }
    }
    format!(
        "{HEAD}bonds.glue = {{ young_modulus = 1e8, poisson_ratio = 0.3{bonds} }}
bodies.block = {{ particles = [{spheres}], bond_list = [{pairs}], material = \"stone\", bonds = \"glue\"{more} }}
"
    )
}

/// Loose wet spheres that press on each other and on the floor.
fn wet() -> String {
    let mut spheres = String::new();
    for n in 0..27 {
        let [x, y, z] = [n % 3, n / 3 % 3, n / 9].map(|k| 1.9999e-3 * f64::from(k));
        write!(spheres, "[{x:e}, {y:e}, {:e}, 1e-3], ", z + 0.9999e-3).unwrap();
    }
    let bridge = "liquid_bridge = { surface_tension = 0.07, volume = 1e-12 }";
    HEAD.replace("friction = 0.4", &format!("friction = 0.4, {bridge}"))
        + &format!("bodies.heap = {{ particles = [{spheres}], material = \"stone\" }}\n")
}

/// Steps of a scene, after as many that are not counted: the allocations in each, and the state.
fn allocations(text: &str) -> (Vec<u64>, State) {
    const STEPS: usize = 200;
    on_one_thread(|| {
        let mut state = started(text);
        for _ in 0..STEPS {
            step(&mut state);
        }
        let count = |_| measure(|| _ = step(&mut state)).count_total;
        let found = (0..STEPS).map(count).collect();
        (found, state)
    })
}

#[test]
fn a_step_takes_no_memory() {
    let strengths = ", failure = { tensile_strength = 1e9 }";
    let on_floor = 0.5 + 1e-9;
    for (name, text) in [
        ("bonds", block(1.0, "", "")),
        ("failure", block(1.0, strengths, "")),
        ("many spheres", cube(11, 1.0, strengths, "")),
        (
            "weak damping",
            block(1.0, ", damping = { damping_ratio = 0.01 }", ""),
        ),
        (
            "strong damping",
            block(1.0, ", damping = { damping_ratio = 3 }", ""),
        ),
        (
            "structural damping",
            block(1.0, ", damping = { structural_damping = 0.3 }", ""),
        ),
        (
            "both dampings",
            block(
                1.0,
                ", damping = { damping_ratio = 0.1, structural_damping = 0.3 }",
                "",
            ),
        ),
        ("history", block(1.0, ", formulation = \"incremental\"", "")),
        (
            "yield",
            block(1.0, ", plasticity = { normal_yield_strength = 1e9 }", ""),
        ),
        ("at a wall", block(on_floor, strengths, "")),
        (
            "clump at a wall",
            block(on_floor, "", ", start_as = \"clump\""),
        ),
        (
            "part bonded",
            block(1.0, "", ", bonded_within = { region = \"zone\" }")
                + "regions.zone.box = { min = [-1, -1, -1], max = [1, 1, 4e-3] }\n",
        ),
        ("liquid bridges", wet()),
        (
            "squeeze",
            block(0.5 - 1e-6, strengths, ", start_as = \"clump\"")
                + "replacement.block.when = { contact_force = 1e9, principal_stress = 1e12 }\n",
        ),
    ] {
        let (found, state) = allocations(&text);
        let looks = match name {
            // Where the bonded zone of a body is now, is found once in fifty steps.
            "part bonded" => found.len() / 50,
            _ => 0,
        };
        let bridges = state.bridges.as_ref();
        let is_wet = bridges.is_some_and(|all| !all.pairs.is_empty() && !all.walls.is_empty());
        assert_eq!(is_wet, name == "liquid bridges");
        let taking = found.iter().filter(|&&count| count > 0).count();
        assert!(taking <= looks, "{name}: {found:?}");
    }
}

/// A cube of loose spheres, so many along each edge, that fall into a heap on the floor.
fn loose(side: usize) -> String {
    let mut spheres = String::new();
    for n in 0..side.pow(3) {
        let at = [n % side, n / side % side, n / (side * side)];
        let [x, y, z] = at.map(|k| 2.3e-3 * k as f64);
        let shift = 1e-4 * (n % 7) as f64;
        write!(
            spheres,
            "[{:e}, {:e}, {:e}, 1e-3], ",
            x + shift,
            y - shift,
            z + 2e-3
        )
        .unwrap();
    }
    format!(
        "{HEAD}bodies.heap = {{ particles = [{spheres}], material = \"stone\", velocity = [0.1, 0, -0.5] }}\n"
    )
}

/// A block that breaks on the floor.
fn breaking() -> String {
    let weak = ", failure = { tensile_strength = 2e4 }";
    block(1.0, weak, ", velocity = [0.3, 0, -2]")
}

/// Blocks that an inlet feeds as clumps, and that fall onto one on the floor.
fn fed() -> String {
    block(1.0, "", "")
        + "regions.mouth.box = { min = [0, 0, 0.02], max = [0.03, 0.03, 0.05] }
inlets.top = { bodies = [\"block\"], region = \"mouth\", rate = \"1000 /s\", count = 100, velocity = [0, 0, -1] }
"
}

/// Loose spheres within a wall of triangles.
fn in_a_tube() -> String {
    let tube = root().join("data/shapes/tube.stl");
    let placed = "velocity = [0.1, 0, -0.5], position = [-6e-3, -6e-3, 0]";
    loose(6).replace("velocity = [0.1, 0, -0.5]", placed)
        + &format!(
            "walls.tube = {{ stl = {tube:?}, unit = \"mm\", scale = 3, material = \"stone\" }}\n"
        )
}

/// Loose spheres on a plate that moves fast.
fn on_a_plate() -> String {
    let at_rest = "normal = [0, 0, 1] }";
    loose(6).replace(at_rest, &format!("{at_rest}, velocity = [0, 6, 0]"))
}

/// A block that lands on the floor, whose contacts act beside its bonds.
fn beside() -> String {
    block(
        1.0,
        ", contact_beside_bond = true",
        ", velocity = [0.3, 0, -1]",
    )
    .replace("run = {", "relaxation = { min_overlap = 0 }\nrun = {")
}

/// Loose spheres, of which a layer falls asleep before the others land beside it.
fn asleep() -> String {
    let mut lying = String::new();
    for n in 0..36 {
        let [x, y] = [n % 6, n / 6].map(|k| 2.1e-3 * f64::from(k));
        write!(lying, "[{:e}, {y:e}, 1e-3, 1e-3], ", x - 0.05).unwrap();
    }
    loose(6)
        + &format!("bodies.layer = {{ particles = [{lying}], material = \"stone\" }}\n")
        + "sleep = { speed = 0.01, after = 0.001 }\n"
}

/// What happened in a step, and how often it took memory.
struct Counted {
    searched: bool,
    /// What is near a moving wall was listed again.
    listed_at_wall: bool,
    /// Some bodies were asleep.
    any_asleep: bool,
    /// Bodies that may take longer steps or fall asleep were looked for.
    looked: bool,
    /// A bond broke or a body came, in this step or after the last search before it.
    is_changed: bool,
    broke: bool,
    came: bool,
    /// An inlet looked for room and found none.
    waited: bool,
    allocations: u64,
}

/// Steps of a scene, after the first hundred.
fn counted(text: &str) -> Vec<Counted> {
    const STEPS: usize = 9000;
    let stage = |name: &str| step::stages().iter().position(|stage| stage.name == name);
    let search = stage("neighbour search").unwrap();
    let sleep = stage("sleep").unwrap();
    on_one_thread(|| {
        let mut state = started(text);
        let mut is_changed = false;
        let one = |_| {
            let done = |state: &State| [search, sleep].map(|n| state.scratch.clock.done(n));
            let left_m = |state: &State| state.walls[0].skin_left_m;
            let (before, left_before_m) = (done(&state), left_m(&state));
            let next_try_of =
                |state: &State| state.population.inlets.first().map(|feed| feed.next_try);
            let next_try = next_try_of(&state);
            let allocations = measure(|| _ = step(&mut state)).count_total;
            let events = &state.scratch.events;
            let [broke, came] = [!events.broken.is_empty(), !events.population.is_empty()];
            let [searched, looked] = [0, 1].map(|n| done(&state)[n] > before[n]);
            is_changed |= broke || came;
            let counted = Counted {
                searched,
                listed_at_wall: left_m(&state) > left_before_m,
                any_asleep: (0..state.particles.len()).any(|i| state.particles.sleeps(i)),
                looked,
                is_changed,
                broke,
                came,
                waited: next_try_of(&state) != next_try,
                allocations,
            };
            is_changed &= !searched || broke || came;
            counted
        };
        (0..STEPS).map(one).skip(100).collect()
    })
}

#[test]
fn memory_is_taken_only_by_breaks_inlets_and_lists_that_grow() {
    for (name, text) in [
        ("heap", loose(6)),
        ("larger heap", loose(11)),
        ("in a tube", in_a_tube()),
        ("on a plate", on_a_plate()),
        ("beside", beside()),
        (
            "clump",
            block(1.0, "", &format!(", start_as = \"clump\"{FLUNG}")),
        ),
        ("breaking", breaking()),
        ("fed", fed()),
        ("asleep", asleep()),
    ] {
        let steps = counted(&text);
        let is_quiet = |step: &&Counted| !(step.is_changed || step.waited || step.looked);
        let quiet: Vec<&Counted> = steps.iter().filter(is_quiet).collect();
        let count = |is: &dyn Fn(&Counted) -> bool| quiet.iter().filter(|step| is(step)).count();
        let searches = count(&|step| step.searched);
        assert!(searches > 100, "{name}: {searches} searches");
        let taking = count(&|step| step.allocations > 0);
        assert!(taking <= steps.len() / 200, "{name}: {taking} steps");
        let [broke, came, at_wall, slept] =
            ["breaking", "fed", "on a plate", "asleep"].map(|of| name == of);
        assert_eq!(steps.iter().any(|step| step.broke), broke, "{name}");
        assert_eq!(steps.iter().any(|step| step.came), came, "{name}");
        assert_eq!(count(&|step| step.listed_at_wall) > 100, at_wall, "{name}");
        assert_eq!(
            count(&|step| step.any_asleep && step.searched) > 100,
            slept,
            "{name}"
        );
    }
}
