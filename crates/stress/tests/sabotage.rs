//! A suite that cannot fail proves nothing: wrong predictions and corrupted scenes are detected.

use std::sync::atomic::AtomicBool;

use dem_stress::prediction::{Member, Prediction, Quantity, Shown};
use dem_stress::trial::Trial;
use dem_stress::verdict::{CaseResult, Judged, judge};

use super::member;

fn judged(member: &Member) -> Judged {
    judge(member, &AtomicBool::new(false)).unwrap()
}

/// The reported problem of a corrupted member, which behaved as predicted before.
fn wrong(good: &Member, spoil: impl FnOnce(&mut Member)) -> String {
    assert_eq!(judged(good).wrong, None, "{}", good.what);
    let mut spoiled = good.clone();
    spoil(&mut spoiled);
    let judged = judged(&spoiled);
    let result = CaseResult {
        name: "spoiled",
        extreme: "",
        members: vec![judged.clone()],
        wall_s: 0.0,
    };
    assert_eq!(result.wrong().count(), 1);
    let row = dem_stress::text::row(&result);
    assert!(row.contains("| WRONG: "), "{row}");
    judged.wrong.unwrap()
}

fn replace(trial: &mut Trial, what: &str, with: &str) {
    assert!(trial.scene.contains(what), "{what} in {}", trial.scene);
    trial.scene = trial.scene.replace(what, with);
}

fn values(member: &mut Member) -> &mut Vec<Shown> {
    match &mut member.prediction {
        Prediction::Ends(values) => values,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_value_that_is_off_by_little_is_found() {
    let row = member("size", "bonded, 1e3 m");
    let said = wrong(&row, |row| values(row)[1].value *= 1.0 + 1e-9);
    assert_eq!(said, "second_moved is off");
    let impact = member("impact", "on a wall, restitution 1");
    let said = wrong(&impact, |impact| values(impact)[1].value *= 0.99);
    assert_eq!(said, "lowest_place is off");
    let blow = member("overlap", "overlap 0.9");
    let said = wrong(&blow, |blow| values(blow)[2].value -= 1.0);
    assert_eq!(said, "broken bonds is off");
    let said = wrong(&blow, |blow| {
        values(blow)[3].quantity = Quantity::Measure("unknown");
    });
    assert_eq!(said, "unknown is off");
}

#[test]
fn a_limit_without_its_damping_is_found() {
    let damped = "timoshenko, damping_ratio = 0, local_damping = 0.5";
    let map = member("damping", damped);
    let (_, plan, _) = map.trial.planned().unwrap();
    let undamped_s = plan.step.limit.undamped_step_s;
    assert!(undamped_s > 1.2 * plan.step.limit.step_s);
    let said = wrong(&map, |map| values(map)[0].value = undamped_s);
    assert_eq!(said, "largest stable step is off");
}

#[test]
fn a_limit_that_is_off_by_two_hundredths_is_found() {
    for (what, factor) in [
        ("timoshenko, damping_ratio = 0", 1.02),
        ("elastic-solid, damping_ratio = 1", 0.98),
    ] {
        let map = member("damping", what);
        let said = wrong(&map, |map| {
            let value = &mut values(map)[0];
            value.value *= factor;
        });
        assert_eq!(said, "largest stable step is off");
    }
}

#[test]
fn a_step_above_the_limit_is_found() {
    let good = member("step", "0.98, damping 0.3");
    let above = member("step", "1.02 by force, damping 0.3");
    let said = wrong(&good, |good| good.trial = above.trial.clone());
    assert!(said.starts_with("was stopped: unstable at step "), "{said}");
    let said = wrong(&good, |good| {
        good.trial.scene.clone_from(&above.trial.scene);
    });
    assert!(
        said.starts_with("was refused: ") && said.contains("run.time_step"),
        "{said}"
    );
}

#[test]
fn an_explosion_for_want_of_relaxation_is_found() {
    for what in ["overlap 0.25", "overlap 0.9"] {
        let good = member("overlap", what);
        let said = wrong(&good, |good| {
            good.trial.scene += "relaxation.enabled = false\n";
        });
        assert!(
            said.starts_with("was stopped: ") && said.contains("set relaxation.enabled = true"),
            "{said}"
        );
    }
}

#[test]
fn an_end_in_silence_is_found() {
    let stopped = member("impact", "on a sphere, 10 MPa");
    let said = wrong(&stopped, |soft| {
        replace(
            &mut soft.trial,
            "young_modulus = 1e7",
            "young_modulus = 7e10",
        );
    });
    assert_eq!(said, "ended in silence");
    let refused = member("coordinates", "1 um at 1e6 m");
    let said = wrong(&refused, |far| {
        *far = Member {
            prediction: far.prediction.clone(),
            ..member("coordinates", "colliding at 1e6 m")
        };
    });
    assert_eq!(said, "ended in silence");
}

#[test]
fn the_wrong_cause_is_found() {
    let stopped = member("impact", "on a wall, 10 MPa");
    let said = wrong(&stopped, |soft| {
        soft.prediction = Prediction::Stopped(vec!["of energy were created".to_owned()]);
    });
    assert!(
        said.starts_with("'of energy were created' is not in: at "),
        "{said}"
    );
    let said = wrong(&stopped, |soft| {
        soft.prediction = Prediction::Refused(vec!["gone through".to_owned()]);
    });
    assert!(said.starts_with("was stopped: at "), "{said}");
}

#[test]
fn spins_that_lose_and_bodies_that_creep_are_found() {
    let spin = member("spin", "undamped");
    let said = wrong(&spin, |spin| {
        replace(&mut spin.trial, "damping_ratio = 0", "damping_ratio = 0.01");
    });
    assert_eq!(said, "elastic_energy is off");
    let rest = member("rest", "a tetrahedron on a slope of 15 degrees, clump");
    // Carried along by 1e-6 m in a day.
    let belt = "normal = [0, 0, 1] }, surface_velocity = [1e-11, 0, 0]";
    let said = wrong(&rest, |rest| {
        replace(&mut rest.trial, "normal = [0, 0, 1] }", belt);
    });
    assert_eq!(said, "way is off");
}

#[test]
fn no_number_is_no_good_value() {
    let shown = Shown::at_most(Quantity::EnergyError, 1.0);
    for (value, good) in [
        (0.5, true),
        (-1.0, true),
        (1.5, false),
        (f64::NAN, false),
        (f64::INFINITY, false),
    ] {
        assert_eq!(shown.deviation(value) <= 1.0, good, "{value}");
    }
    let count = Shown::count(Quantity::Fragments, 3);
    assert!(
        count.deviation(3.0) <= 1.0
            && count.deviation(4.0) > 1.0
            && count.deviation(f64::NAN) > 1.0
    );
}
