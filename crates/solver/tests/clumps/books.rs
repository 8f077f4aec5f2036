//! The books of scenes in which bodies come, become others and go.

use dem_run::check::ledger::{Balance, balance};
use dem_run::plan::Plan;
use dem_run::stages::replacement::{Happened, replace};
use dem_run::state::State;
use dem_run::step::{act, move_on};

use crate::{HEAD, lump, planned};

/// Lumps that come through an inlet, fall, become clusters on the way, bounce on a plate, roll off it and go.
pub(crate) fn feed(restitution: f64, outlet: &str) -> String {
    let head = HEAD
        .replace("1e9,", "1e7, damping = { viscous = 0.1 },")
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

struct Books {
    worst: [f64; 3],
    last: Balance,
    state: State,
    happened: Vec<Happened>,
}

fn booked(text: &str, time_step_s: f64, end_s: f64) -> Books {
    let Plan { mut state, .. } = planned(text);
    assert!(
        time_step_s < 0.5 * state.time_step_s,
        "{:e}",
        state.time_step_s
    );
    state.time_step_s = time_step_s;
    let mut books = Books {
        worst: [0.0; 3],
        last: Balance::default(),
        happened: Vec::new(),
        state: state.clone(),
    };
    while state.time_s < end_s {
        act(&mut state);
        if state.steps % 20 == 0 {
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
        let happened = replace(&mut state);
        books
            .happened
            .extend(happened.into_iter().flat_map(|(_, all)| all));
        move_on(&mut state);
    }
    books.state = state;
    books
}

fn mass_inside_kg(state: &State) -> f64 {
    let motions = &state.particles.motions[..state.particles.free];
    let free: f64 = motions.iter().map(|m| 1.0 / m.inverse_mass).sum();
    free + state.clumps.mass_kg()
}

/// What came, was replaced and went, and whether mass agrees.
fn counted(books: &Books) -> [usize; 3] {
    let state = &books.state;
    let count = |is: fn(&Happened) -> bool| books.happened.iter().filter(|h| is(h)).count();
    let came = count(|h| matches!(h, Happened::Came { .. }));
    let replaced = count(|h| matches!(h, Happened::Replaced { .. }));
    let left = count(|h| matches!(h, Happened::Left { .. }));
    let (come, gone) = (state.rules.inlets[0].come, state.rules.outlets[0].gone);
    assert_eq!((come.bodies as usize, gone.0 as usize), (came, left));
    assert_eq!(state.rules.replaced as usize, replaced);
    let inside = mass_inside_kg(state);
    let wanted = come.bodies as f64 * state.clumps.templates[0].mass_kg;
    assert!((come.mass_kg / wanted - 1.0).abs() < 1e-13);
    assert!(((inside + gone.1) / come.mass_kg - 1.0).abs() < 1e-12);
    assert!((state.ledger.mass_kg() - inside).abs() < 1e-12 * come.mass_kg);
    [came, replaced, left]
}

#[test]
fn what_comes_and_goes_is_booked_and_errors_fall_with_the_square_of_the_step() {
    // They leave below the plate, in flight.
    let text = feed(0.5, "box = { min = [-1, -1, -1], max = [1, 1, -0.015] }");
    let all = [4e-6, 2e-6, 1e-6].map(|step_s| booked(&text, step_s, 0.13));
    for books in &all {
        let counts = counted(books);
        eprintln!("{:?}: {counts:?}, {:?}", books.worst, books.last);
        assert!(
            counts[0] == 8 && counts[1] > 4 && counts[2] > 1,
            "{counts:?}"
        );
        assert!(
            books.worst[1] < 1e-11 && books.worst[2] < 1e-11,
            "{:?}",
            books.worst
        );
        assert!(books.last.contact_damping_j > 0.0 && books.last.friction_j > 0.0);
    }
    let [a, b, c] = all.map(|books| books.worst[0]);
    eprintln!("energy errors {a:.2e} {b:.2e} {c:.2e}");
    assert!(a > 3.0 * b && b > 3.0 * c && c < 1e-5, "{a:e} {b:e} {c:e}");
}

/// Spheres that fall on a plate and go while they press on it.
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
    for step_s in [2e-6, 1e-6] {
        let books = booked(&text, step_s, 0.01);
        let counts = counted(&books);
        eprintln!("{:?}: {counts:?}, {:?}", books.worst, books.last);
        assert_eq!(counts, [3, 0, 3]);
        let rounds = books.state.steps as f64 * f64::EPSILON;
        assert!(books.worst[1] < 10.0 * rounds, "{:?}", books.worst);
        // Less than a thousandth of what they bring, most of which is in the contacts when they go.
        assert!(books.worst[0] < 1e-3, "{:e}", books.worst[0]);
    }
}
