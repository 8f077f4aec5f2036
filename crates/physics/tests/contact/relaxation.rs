//! Overlaps of pairs that separate by breakage.

use super::world::{Body, RIGID, World, frictionless, material};
use dem_physics::contact::kinematics::ContactKinematics;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::relaxation::{Relaxed, relaxed};
use dem_physics::contact::rolling::NoRolling;
use dem_physics::contact::{ContactSprings, response};
use dem_physics::number::Vec3;
use proptest::prelude::*;

fn origins(path: &[f64], origin: f64, least: f64) -> Vec<Relaxed> {
    let mut origin = origin;
    path.iter()
        .map(|overlap| {
            let found = relaxed(*overlap, origin, least);
            origin = found.origin_m;
            found
        })
        .collect()
}

#[test]
fn a_pair_presses_from_where_it_parted() {
    let found = origins(&[3.0, 5.0, 3.0, 2.0, 2.5, 1.0, 0.4, 0.6], 3.0, 0.5);
    let forces: Vec<f64> = found.iter().map(|r| r.overlap_m).collect();
    let origins: Vec<f64> = found.iter().map(|r| r.origin_m).collect();
    assert_eq!(forces, [0.0, 2.0, 0.0, 0.0, 0.5, 0.0, 0.4, 0.6]);
    assert_eq!(origins, [3.0, 3.0, 3.0, 2.0, 2.0, 1.0, 0.0, 0.0]);
    // Ordinary pairs are unchanged, apart or not.
    for overlap in [-1.0, 0.0, 2.0] {
        let found = relaxed(overlap, 0.0, 0.5);
        assert_eq!((found.overlap_m, found.origin_m), (overlap, 0.0));
    }
}

/// Two overlapping spheres separate after bond breakage, meet with some speed and part: never
/// faster than they met.
#[test]
fn faces_that_part_never_fly_apart() {
    let law = HertzMindlin::new([RIGID, material(26e6, 0.3)], &frictionless());
    for speed in [0.0, 0.1, 1.0] {
        let mut ball = Body::sphere(0.5e-3, 2050.0, Vec3(0.0, 0.0, 0.48e-3));
        ball.velocity = Vec3(0.0, 0.0, -speed);
        let mut world = World::new(law, NoRolling, [Body::floor(), ball], 2e-8);
        let (mut origin, start) = (20e-6, world.kinetic());
        let mut history = ContactSprings::default();
        for _ in 0..50_000 {
            let touch = world.touch();
            let found = relaxed(touch.overlap_m, origin, 0.0);
            assert!(found.origin_m <= origin && found.origin_m >= 0.0);
            origin = found.origin_m;
            let touch = ContactKinematics {
                overlap_m: found.overlap_m,
                ..touch
            };
            let found = response(&law, &NoRolling, &touch, &history, world.dt);
            history = found.springs;
            let ball = &mut world.bodies[1];
            ball.velocity = ball.velocity + found.force_on_b * (world.dt * ball.per_mass);
            ball.place = ball.place + ball.velocity * world.dt;
            world.before = world.dt;
        }
        // The first kick is one step late: first order in the step, 2e-8 s of about 1e-4 s.
        assert!(world.kinetic() <= start * (1.0 + 1e-3), "{speed}");
        assert!(world.touch().overlap_m <= 20e-6);
        if speed > 0.0 {
            assert!(world.touch().overlap_m <= 0.0);
        }
    }
}

proptest! {
    /// Whatever the path, no more work is returned than was done: the origin never increases, and
    /// no energy of the pair is created with it.
    #[test]
    fn origins_only_fall(path in prop::collection::vec(-1.0..3.0_f64, 1..50), least in 0.0..0.5_f64) {
        let mut before = 2.0;
        for (overlap, found) in path.iter().zip(origins(&path, 2.0, least)) {
            prop_assert!(found.origin_m <= before);
            prop_assert!(found.origin_m == 0.0 || found.origin_m >= least);
            prop_assert!(found.overlap_m == overlap - found.origin_m);
            before = found.origin_m;
        }
    }
}
