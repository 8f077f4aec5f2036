//! A group as one object: the same before and after a cluster replaces a clump, and equal to a
//! rigid motion.

use std::collections::BTreeMap;
use std::fmt::Write;

use nalgebra::{UnitQuaternion, Vector3};

use super::{Measured, assert_near};

const VECTORS: [&str; 5] = [
    "position",
    "displacement",
    "velocity",
    "rotation",
    "angular_velocity",
];

/// A lump of unequal spheres that flies and tumbles, rotated at the start, with all its measures.
fn lump(more: &str) -> String {
    let mut text = format!(
        "version = 1
run = {{ end_time = 1, gravity = [0, 1, -9.81] }}
materials.stuff = {{ density = 2500, young_modulus = 1e8 }}
bonds.stiff = {{ young_modulus = 1e9, poisson_ratio = 0.25 }}
[bodies.lump]
material = \"stuff\"
bonds = \"stiff\"
particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 0.9e-3], [0, 2e-3, 0, 0.5e-3], [0, 0, 2e-3, 0.8e-3], [2e-3, 2e-3, 0, 0.6e-3], [2e-3, 2e-3, 2e-3, 0.4e-3]]
bond_list = [[0, 1], [0, 2], [0, 3], [1, 4], [4, 5]]
position = [0.3, -0.2, 0.1]
rotation = {{ axis = [1, 2, 3], angle = \"70 deg\" }}
velocity = [1, -2, 3]
angular_velocity = [40, -50, 60]
{more}
"
    );
    for what in VECTORS {
        for axis in ["x", "y", "z"] {
            let quantity = format!("{what}_{axis}");
            writeln!(
                text,
                "[measures.{quantity}]\nof = \"lump\"\nquantity = \"{quantity}\""
            )
            .unwrap();
        }
    }
    for quantity in ["velocity", "displacement", "kinetic_energy"] {
        writeln!(
            text,
            "[measures.{quantity}]\nof = \"lump\"\nquantity = \"{quantity}\""
        )
        .unwrap();
    }
    text
}

fn vector(values: &BTreeMap<String, f64>, what: &str) -> Vector3<f64> {
    Vector3::from(["x", "y", "z"].map(|axis| values[&format!("{what}_{axis}")]))
}

/// Scale of the comparison: 1 m, 1 m/s, 1 rad, 100 rad/s.
fn assert_same(one: &BTreeMap<String, f64>, other: &BTreeMap<String, f64>, fraction: f64) {
    for (name, value) in one {
        let size = if name.starts_with("angular") {
            100.0
        } else {
            1.0
        };
        let off = (value - other[name]).abs();
        assert!(
            off <= fraction * size,
            "{name}: {value} and {}",
            other[name]
        );
    }
}

#[test]
fn a_clump_that_is_replaced_in_flight_shows_the_same_before_and_after() {
    let clump = "start_as = \"clump\"\n[replacement.lump]\nwhen = { time = 1e-4 }";
    let mut run = Measured::new(&lump(clump));
    run.interact();
    let start = run.read();
    let before = loop {
        let before = run.read();
        if run.replace() {
            break before;
        }
        run.advance();
        run.interact();
    };
    assert_eq!(run.state.particles.free, 6);
    let time_s = run.state.time_s;
    assert!(time_s >= 1e-4);
    let after = run.read();
    assert_same(&before, &after, 1e-13);

    let (velocity, gravity) = (Vector3::new(1.0, -2.0, 3.0), Vector3::new(0.0, 1.0, -9.81));
    let moved = velocity * time_s + gravity * (0.5 * time_s * time_s);
    for values in [&before, &after] {
        // Each of the steps rounds a position of 0.3 m.
        assert_near((vector(values, "displacement") - moved).norm(), 0.0, 2e-14);
        let place = vector(&start, "position") + moved;
        assert_near((vector(values, "position") - place).norm(), 0.0, 2e-14);
        let now = velocity + gravity * time_s;
        assert_near((vector(values, "velocity") - now).norm(), 0.0, 1e-12);
        assert_near(values["velocity"], now.norm(), 1e-12);
        assert_near(values["displacement"], moved.norm(), 2e-14);
        // The rotation since the start is that of the spin, which hardly changes in this time.
        let turned = Vector3::new(40.0, -50.0, 60.0) * time_s;
        assert_near(
            (vector(values, "rotation") - turned).norm(),
            0.0,
            0.02 * turned.norm(),
        );
    }
}

#[test]
fn a_clump_shows_what_the_bonded_body_shows() {
    let [clump, bonded] = ["start_as = \"clump\"", ""].map(|more| {
        let mut run = Measured::new(&lump(more));
        run.interact();
        run.read()
    });
    assert_same(&clump, &bonded, 1e-13);
    let spin = Vector3::new(40.0, -50.0, 60.0);
    assert_near(
        (vector(&bonded, "angular_velocity") - spin).norm(),
        0.0,
        1e-11,
    );
    assert_near(
        (vector(&bonded, "velocity") - Vector3::new(1.0, -2.0, 3.0)).norm(),
        0.0,
        1e-14,
    );
    assert_eq!(vector(&bonded, "rotation"), Vector3::zeros());
    assert_near(vector(&bonded, "displacement").norm(), 0.0, 1e-16);
}

/// Two loose spheres that orbit each other without spin of their own: L = 2 m a v, I = 2 m a^2 + 2
/// 2/5 m r^2.
#[test]
fn spheres_that_circle_each_other_turn() {
    let text = "version = 1
run.end_time = 1
materials.stuff = { density = 1000 }
bodies.left = { particles = [[-3, 0, 0, 1]], material = \"stuff\", velocity = [5, -2, 0] }
bodies.right = { particles = [[3, 0, 0, 1]], material = \"stuff\", velocity = [5, 2, 0] }
measures.turn = { quantity = \"angular_velocity_z\" }
measures.own = { of = \"left\", quantity = \"angular_velocity_z\" }
measures.speed = { quantity = \"velocity\" }
";
    let mut run = Measured::new(text);
    run.interact();
    let values = run.read();
    assert_near(values["turn"], 3.0 * 2.0 / (9.0 + 0.4), 1e-15);
    assert_eq!(values["own"], 0.0);
    assert_near(values["speed"], 5.0, 1e-15);
}

#[test]
fn a_set_counts_its_particles_by_their_mass() {
    let text = "version = 1
run.end_time = 1
materials.stuff = { density = 1000 }
bodies.small = { particles = [[0, 0, 0, 1]], material = \"stuff\" }
bodies.large = { particles = [[9, 0, 0, 2]], material = \"stuff\", velocity = [9, 0, 0] }
measures.place = { quantity = \"position_x\" }
measures.speed = { quantity = \"velocity_x\" }
";
    let mut run = Measured::new(text);
    run.interact();
    let values = run.read();
    assert_near(values["place"], 8.0, 1e-14);
    assert_near(values["speed"], 8.0, 1e-14);
}

/// Around half a revolution, rotation vectors of almost the same rotation point in opposite
/// directions.
#[test]
fn rotations_on_both_sides_of_half_a_turn_have_a_mean() {
    let text = "version = 1
run.end_time = 1
materials.stuff = { density = 1000 }
bodies.left = { particles = [[-3, 0, 0, 1]], material = \"stuff\" }
bodies.right = { particles = [[3, 0, 0, 1]], material = \"stuff\" }
measures.turn = { quantity = \"rotation_z\" }
";
    let mut run = Measured::new(text);
    run.interact();
    for (pose, degrees) in run.state.particles.poses.iter_mut().zip([170.0_f64, 186.0]) {
        let turn = Vector3::z() * degrees.to_radians();
        let turned = UnitQuaternion::from_scaled_axis(turn);
        pose.turned = turned.coords.into();
    }
    assert_near(run.read()["turn"].to_degrees(), 178.0, 1e-12);
    run.state.particles.poses[0].turned = run.state.particles.poses[1].turned;
    assert_near(run.read()["turn"].to_degrees(), -174.0, 1e-12);
}

/// Particles removed by an outlet no longer count, also not for the initial values.
#[test]
fn displacement_is_that_of_the_particles_that_are_still_there() {
    let text = "version = 1
run = { end_time = 1, time_step = 1e-3 }
materials.stuff = { density = 1000 }
[bodies.pair]
particles = [[0, 0, 0, 1], [10, 0, 0, 1]]
material = \"stuff\"
velocity = [1, 0, 0]
[regions.end]
box = { min = [10.05, -5, -5], max = [30, 5, 5] }
[outlets.end]
inside = \"end\"
[measures.moved]
of = \"pair\"
quantity = \"displacement_x\"
[contacts]
stuff-stuff = { restitution = 1, friction = 0, law = \"linear\", normal_stiffness = 1 }
";
    let mut run = Measured::new(text);
    let moved = run.run(0.2)["moved"];
    assert_eq!(run.state.particles.len(), 1);
    assert_near(moved, run.state.time_s, 1e-12);
}
