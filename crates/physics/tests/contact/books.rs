//! The energy balance is exact to second order in the time step, and momentum is conserved to
//! rounding.

use super::world::{Body, World, ZERO, material};
use dem_physics::contact::NormalLaw;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::pair_parameters::PairInput;
use dem_physics::contact::rolling::{ConstantMoment, ElasticPlastic, RollingFriction};
use dem_physics::number::Vec3;

/// An oblique impact of two unequal spinning spheres. Returns the missing energy and each loss,
/// over the initial energy.
fn missing<L: NormalLaw<f64>, R: RollingFriction<f64>>(
    law: L,
    rolling: R,
    dt: f64,
) -> (f64, [f64; 4]) {
    let mut a = Body::sphere(0.01, 2500.0, ZERO);
    // Slightly apart, so that the contact begins between steps.
    let direction = Vec3(2.0, 3.0, 6.0);
    let mut b = Body::sphere(0.02, 2500.0, direction * (0.03001 / 7.0));
    a.velocity = Vec3(0.3, -0.2, 0.5);
    a.spin = Vec3(20.0, -30.0, 10.0);
    b.velocity = Vec3(-0.2, -1.1, -0.9);
    b.spin = Vec3(-15.0, 40.0, 25.0);
    let mut world = World::new(law, rolling, [a, b], dt);
    let start = world.kinetic();
    let (momentum, angular) = (world.momentum(), world.angular_momentum());
    let mut met = false;
    loop {
        let overlap = world.touch().overlap_m;
        met |= overlap > 0.0;
        world.step();
        if met && overlap <= 0.0 {
            break;
        }
    }
    world.step();
    for (kept, scale) in [
        (world.momentum() - momentum, momentum),
        (world.angular_momentum() - angular, angular),
    ] {
        assert!(kept.square().sqrt() < 1e-11 * scale.square().sqrt());
    }
    let lost = world.lost.map(|lost| lost / start);
    ((world.kinetic() + world.all_lost()) / start - 1.0, lost)
}

fn check<L: NormalLaw<f64> + Copy, R: RollingFriction<f64> + Copy>(law: L, rolling: R, name: &str) {
    let steps = [16e-7, 8e-7, 4e-7, 2e-7, 1e-7];
    let errors = steps.map(|dt| missing(law, rolling, dt).0);
    let (_, lost) = missing(law, rolling, 1e-7);
    // Every loss contributes.
    for lost in lost {
        assert!(lost > 1e-7, "{name}");
    }
    let order = (errors[0].abs() / errors[4].abs()).log2() / 4.0;
    assert!(order > 1.8, "{name}: {order}");
}

#[test]
fn books_of_energy_are_exact_to_second_order() {
    let rock = material(1e8, 0.25);
    let hertz = |mu| HertzMindlin::new([rock, rock], &PairInput::new(0.6, mu));
    let linear = |mu| Linear::new(2e5, 0.8, &PairInput::new(0.6, mu));
    let spring = ElasticPlastic {
        friction: 0.05,
        damping_ratio: 0.3,
    };
    let moment = ConstantMoment { friction: 0.05 };
    for mu in [0.2, 0.6] {
        check(hertz(mu), spring, "hertz, spring");
        check(hertz(mu), moment, "hertz, moment");
        check(linear(mu), spring, "linear, spring");
        check(linear(mu), moment, "linear, moment");
    }
}
