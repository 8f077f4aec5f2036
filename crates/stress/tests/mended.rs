//! Regression tests for defects of the solver found by the suite.

use std::sync::atomic::AtomicBool;

use dem_results::Summary;
use dem_stress::impact::{Impact, Target};
use dem_stress::trial::{Outcome, Trial};

fn outcome(trial: &Trial) -> Outcome {
    trial.run(&AtomicBool::new(false)).unwrap()
}

fn ended(trial: &Trial) -> Box<Summary> {
    match outcome(trial) {
        Outcome::Ended(summary) => summary,
        other => panic!("{other:?}"),
    }
}

fn stopped(trial: &Trial) -> String {
    match outcome(trial) {
        Outcome::Stopped(said) => said,
        other => panic!("{other:?}"),
    }
}

/// A clump of two spheres that flies, past a floor or onto it.
fn clump(speed: &str) -> Trial {
    Trial::of(format!(
        "version = 1
run = {{ end_time = \"20 ms\" }}
materials.m = {{ density = 2000, young_modulus = \"1 GPa\", poisson_ratio = 0.3 }}
contacts.m-m = {{ restitution = 0.5, friction = 0.5 }}
bonds.m = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.3 }}
walls.floor = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"m\" }}
measures.moved = {{ of = \"stone\", quantity = \"displacement_x\" }}
measures.height = {{ quantity = \"position_z\" }}
measures.speed = {{ of = \"stone\", quantity = \"velocity_x\" }}
[bodies.stone]
particles = [[0, 0, 0.02, 0.01], [0.02, 0, 0.02, 0.01]]
bond_list = [[0, 1]]
material = \"m\"
bonds = \"m\"
start_as = \"clump\"
velocity = {speed}
"
    ))
}

#[test]
fn a_clump_that_stands_there_from_the_start_is_measured() {
    let summary = ended(&clump("[1, 0, 0]"));
    let value = |name: &str| {
        let found = summary.measures.iter().find(|m| m.name == name);
        found.unwrap().value
    };
    assert!((value("moved") - 0.02).abs() < 1e-12, "{}", value("moved"));
    assert!(
        (value("height") - 0.02).abs() < 1e-12,
        "{}",
        value("height")
    );
    assert!((value("speed") - 1.0).abs() < 1e-12, "{}", value("speed"));
}

/// Regression: rounding divided by rounding gave an error of 30 %.
#[test]
fn a_clump_that_falls_flat_has_no_error_of_angular_momentum() {
    let summary = ended(&clump("[0, 0, -3]"));
    assert!(summary.balance.contact_damping_j > 0.0);
    assert!(
        summary.angular_momentum_error < 1e-12,
        "{}",
        summary.angular_momentum_error
    );
}

#[test]
fn a_wall_is_called_by_its_name() {
    let impact = Impact {
        restitution: 0.9,
        ..Impact::usual()
    };
    let (_, plan, _) = impact.trial("\"auto\"").planned().unwrap();
    let trial = Trial {
        force_step: true,
        ..impact.trial(&format!("{:e}", 3.0 * plan.step.foreseen_s))
    };
    let said = stopped(&trial);
    assert!(
        said.contains("most of it in contacts with the wall 'floor'"),
        "{said}"
    );
}

/// Regression: two spheres whose centres met continued without notice, or ended as a step that was
/// too large.
#[test]
fn spheres_that_would_go_through_each_other_are_named() {
    for (radius_m, other_m) in [(1e-3, 1e-3), (1e-3, 5e-3), (5e-3, 1e-3)] {
        let impact = Impact {
            radius_m,
            target: Target::Sphere(other_m),
            young_modulus_pa: 1e6,
            speed_m_s: 100.0,
            ..Impact::usual()
        };
        let said = stopped(&impact.trial("\"auto\""));
        assert!(
            said.contains("particle 0 of the body 'ball' and particle 0 of the body 'other' are pressed into each other by more than the radius of the smaller, 1.000e-3 m;"),
            "{said}"
        );
    }
}

#[test]
fn a_place_is_refused_where_its_rounding_shows() {
    // 2^-52 of 1e6 m is 2.2e-10 m.
    for (radius_m, good) in [(2.3e-4, true), (2.2e-4, false)] {
        let impact = Impact {
            radius_m,
            at_m: 1e6,
            ..Impact::usual()
        };
        let planned = impact.trial("\"auto\"").planned();
        assert_eq!(planned.is_ok(), good, "{radius_m}");
        if let Err(said) = planned {
            assert_eq!(said.exit_code(), 2);
            let said = said.to_string();
            assert!(
                said.contains("[bodies.ball]: particle 0: 1.000e6 m from the origin its coordinates are rounded by 2.2e-10 m, more than 1e-6 of its radius of 2.200e-4 m"),
                "{said}"
            );
        }
    }
}
