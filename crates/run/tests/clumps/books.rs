//! The balances of scenes in which bodies are fed, replaced and removed.

use dem_engine::Balance;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::state::events::PopulationEvent;
use dem_engine::step::{advance, interact};
use dem_plan::Plan;

use super::{HEAD, lump, planned};

/// Lumps that enter through an inlet, fall, become clusters on the way, bounce on a plate, roll off
/// it and leave.
pub(crate) fn feed(restitution: f64, outlet: &str) -> String {
    let head = HEAD
        .replace("1e9,", "1e7, damping = { damping_ratio = 0.1 },")
        .replace("1e8", "1e7");
    let fed = lump("lump", "start_as = \"clump\"");
    format!(
        "{head}run.gravity = [0, 0, -9.81]\nrun.seed = 3\n\
         contacts.stuff-stuff = {{ restitution = {restitution}, friction = 0.3 }}\n\
         {fed}\
         [walls.plate]\nbox = {{ min = [-0.015, -0.02, -0.01], max = [8e-3, 0.02, 0] }}\nmaterial = \"stuff\"\n\
         rotation = {{ axis = [0, 1, 0], angle = \"30 deg\" }}\n\
         [regions.gate]\nbox = {{ min = [-8e-3, -5e-3, 0.02], max = [-4e-3, 5e-3, 0.022] }}\n\
         [regions.low]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 0.014] }}\n\
         [regions.gone]\n{outlet}\n\
         [replacement.lump]\nwhen = {{ enters = \"low\" }}\n\
         [inlets.feed]\nbodies = [\"lump\"]\nregion = \"gate\"\nrate = 60\nvelocity = [0.1, 0, -0.3]\n\
         angular_velocity = [5, 10, 20]\norientation = \"random\"\n\
         [outlets.out]\ninside = \"gone\"\n"
    )
}

pub(crate) struct Books {
    pub(crate) worst: [f64; 3],
    pub(crate) last: Balance,
    pub(crate) state: State,
    pub(crate) happened: Vec<PopulationEvent>,
}

pub(crate) fn booked(text: &str, time_step_s: f64, end_s: f64) -> Books {
    let Plan { mut state, .. } = planned(text);
    assert!(time_step_s <= state.time_step_s, "{:e}", state.time_step_s);
    state.time_step_s = time_step_s;
    let mut books = Books {
        worst: [0.0; 3],
        last: Balance::default(),
        happened: Vec::new(),
        state: state.clone(),
    };
    while state.time_s < end_s {
        interact(&mut state);
        if state.steps.is_multiple_of(20) {
            let balance = balance(&mut state);
            let errors = [
                balance.energy_error,
                balance.momentum_error,
                balance.angular_momentum_error,
            ];
            for (worst, error) in books.worst.iter_mut().zip(errors) {
                *worst = worst.max(error.abs());
            }
            books.last = balance;
        }
        advance(&mut state);
        books
            .happened
            .extend(state.scratch.events.population.clone());
    }
    books.state = state;
    books
}

fn mass_inside_kg(state: &State) -> f64 {
    let motions = &state.particles.motions[..state.particles.free];
    let free: f64 = motions.iter().map(|m| 1.0 / m.inverse_mass).sum();
    free + state.clumps.mass_kg()
}

/// Numbers of bodies fed, replaced and removed; checks the balance of mass.
fn counted(books: &Books) -> [usize; 3] {
    let state = &books.state;
    let count = |is: fn(&PopulationEvent) -> bool| books.happened.iter().filter(|h| is(h)).count();
    let came = count(|h| matches!(h, PopulationEvent::Came { .. }));
    let replaced = count(|h| matches!(h, PopulationEvent::Replaced { .. }));
    let left = count(|h| matches!(h, PopulationEvent::Left { .. }));
    let (come, gone) = (state.population.inlets[0], state.population.outlets[0]);
    assert_eq!((come.bodies as usize, gone.bodies as usize), (came, left));
    assert_eq!(state.population.replaced as usize, replaced);
    let inside = mass_inside_kg(state);
    let wanted = f64::from(come.bodies) * state.clumps.templates[0].mass_kg;
    assert!((come.mass_kg / wanted - 1.0).abs() < 1e-13);
    assert!(((inside + gone.mass_kg) / come.mass_kg - 1.0).abs() < 1e-12);
    assert!((state.ledger.mass_kg() - inside).abs() < 1e-12 * come.mass_kg);
    [came, replaced, left]
}

#[test]
fn what_comes_and_goes_is_booked_and_errors_fall_with_the_square_of_the_step() {
    // They leave below the plate, in flight.
    let text = feed(0.5, "box = { min = [-1, -1, -1], max = [1, 1, -0.015] }");
    // Bodies bounce differently for each step, which scatters the error of one run: means over
    // three.
    let errors = [4e-6, 2e-6, 1e-6].map(|step_s| {
        let of_seed = |seed: u32| {
            let text = text.replace("run.seed = 3", &format!("run.seed = {seed}"));
            let books = booked(&text, step_s, 0.25);
            let counts = counted(&books);
            eprintln!("{:?}: {counts:?}, {:?}", books.worst, books.last);
            assert!(
                counts[0] == 15 && counts[1] > 10 && counts[2] > 2,
                "{counts:?}"
            );
            assert!(
                books.worst[1] < 1e-11 && books.worst[2] < 1e-11,
                "{:?}",
                books.worst
            );
            assert!(books.last.contact_damping_j > 0.0 && books.last.friction_j > 0.0);
            books.worst[0]
        };
        [3, 4, 5].map(of_seed).iter().sum::<f64>() / 3.0
    });
    let [a, b, c] = errors;
    eprintln!("energy errors {a:.2e} {b:.2e} {c:.2e}");
    assert!(a > 3.0 * b && b > 3.0 * c && c < 1e-5, "{a:e} {b:e} {c:e}");
}

/// Spheres that fall on a plate and are removed while they press on it.
fn pressing(outlet: &str) -> String {
    format!(
        "{}contacts.stuff-stuff = {{ restitution = 0.9 }}\n\
         [bodies.ball]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0, 1e-3]]\n{outlet}",
        HEAD.replace("1e8", "1e7")
    )
}

#[test]
fn what_goes_while_it_touches_a_wall_takes_its_elastic_energy_along() {
    let text = pressing(
        "[walls.plate]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"stuff\"\n\
         [regions.gate]\nbox = { min = [-8e-3, -5e-3, 0.002], max = [-4e-3, 5e-3, 0.0022] }\n\
         [regions.gone]\nbox = { min = [-1, -1, -1], max = [1, 1, 0.98e-3] }\n\
         [inlets.feed]\nbodies = [\"ball\"]\nregion = \"gate\"\nrate = 300\nvelocity = [0, 0, -1]\n\
         [outlets.out]\ninside = \"gone\"\n",
    );
    let errors = [2e-6, 1e-6].map(|step_s| {
        let books = booked(&text, step_s, 0.01);
        assert_eq!(counted(&books), [3, 0, 3]);
        let rounds = books.state.steps as f64 * f64::EPSILON;
        assert!(books.worst[1] < rounds, "{:?}", books.worst);
        books.worst[0]
    });
    eprintln!("energy errors {errors:?}");
    assert!(
        errors[1] < 1e-4 && errors[0] > 3.0 * errors[1],
        "{errors:?}"
    );
}

/// A lump whose contact spheres are larger than its own is replaced when it hits a plate, and
/// another one on another lump: contacts end, and their energy with them.
#[test]
fn what_shrinks_while_it_touches_books_what_contacts_lose() {
    let fed = feed(0.5, "box = { min = [-1, -1, -1], max = [1, 1, -0.5] }");
    let text = fed
        .replace(
            "start_as = \"clump\"",
            "start_as = \"clump\"\nclump = { scale = 1.05 }",
        )
        .replace("enters = \"low\"", "force = 0.05")
        .replace("rate = 60", "rate = 400");
    for step_s in [2e-6, 1e-6] {
        let books = booked(&text, step_s, 0.05);
        let [_, replaced, _] = counted(&books);
        assert!(replaced > 2, "{replaced}");
        let scale_j = books.last.energy_scale_j;
        // The half kick after the current positions is still that of the larger spheres: 0.05 N,
        // and a little more as the force increases step by step, at no more than 1 m/s. The rest,
        // as for bodies that keep their size, is the error of the step.
        let bound_j = replaced as f64 * 0.5 * 0.06 * step_s + 2e-5 * scale_j;
        let error_j = books.worst[0] * scale_j;
        // Contacts store about 0.4 F d each, with a depth of at least 30 um.
        let held_j = replaced as f64 * 0.4 * 0.05 * 3e-5;
        eprintln!("{replaced}: error {error_j:.1e} J of {bound_j:.1e} J, held {held_j:.1e} J");
        assert!(
            error_j < bound_j && bound_j < 0.2 * held_j,
            "{error_j:e} {bound_j:e} {held_j:e}"
        );
    }
}

/// Bodies that break and leave in pieces, several times as many bonds as exist at a time: the count
/// of broken bonds continues.
#[test]
fn broken_bonds_of_bodies_that_have_gone_stay_counted() {
    let fed = feed(0.5, "box = { min = [-1, -1, -1], max = [1, 1, -0.015] }");
    let text = fed.replace(
        "1e7, damping",
        "1e7, failure = { tensile_strength = 1e3, shear_strength = 1e3 }, damping",
    );
    let Plan {
        mut state,
        mut bodies,
        ..
    } = planned(&text);
    let mut broken = 0;
    while state.time_s < 0.25 {
        super::go(&mut state, &mut bodies);
        broken += state.scratch.events.broken.len() as u64;
    }
    assert_eq!(state.broken_count, broken);
    let left = state.bonds.len() as u64;
    eprintln!(
        "{broken} bonds broken, {left} there, {:?}",
        state.population.outlets[0]
    );
    assert!(broken > left, "{broken} {left}");
    let inside = mass_inside_kg(&state);
    let (come, gone) = (state.population.inlets[0], state.population.outlets[0]);
    assert!(((inside + gone.mass_kg) / come.mass_kg - 1.0).abs() < 1e-12);
    let there = (0..state.bonds.len()).filter(|at| state.bonds.is_broken(*at));
    assert_eq!(
        state.broken_count - state.broken_removed,
        there.count() as u64
    );
}
