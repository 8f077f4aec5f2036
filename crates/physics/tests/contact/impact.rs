//! Oblique impacts.

use super::reference;
use super::world::{Body, RIGID, World, material};
use dem_physics::contact::ImpactLaw;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::pair_parameters::{AttractiveDamping, PairInput, TangentialUnloading};
use dem_physics::contact::rolling::NoRolling;
use dem_physics::number::Vec3;

const RADIUS: f64 = 0.0025;
const SPEED: f64 = 3.9;

/// Normal and tangential restitution and spin after an impact at this angle to the normal.
fn impact(material_name: &str, angle: f64, pair_input: &PairInput, steps: f64) -> [f64; 3] {
    let (young, nu, density) = if material_name == "Al2O3" {
        (380e9, 0.23, 4000.0)
    } else {
        (70e9, 0.33, 2700.0)
    };
    let law = HertzMindlin::new([RIGID, material(young, nu)], pair_input);
    let mut b = Body::sphere(RADIUS, density, Vec3(0.0, 0.0, RADIUS));
    let (sine, cosine) = angle.to_radians().sin_cos();
    b.velocity = Vec3(SPEED * sine, 0.0, -SPEED * cosine);
    let mass = 1.0 / b.per_mass;
    let overlap = law.overlap_at_impact_m(RADIUS, mass, SPEED * cosine);
    let duration = 2.943_275_184_324_704_3 * overlap / (SPEED * cosine);
    let mut world = World::new(law, NoRolling, [Body::floor(), b], duration / steps);
    world.whole_lever = true;
    world.step();
    while world.touch().overlap_m > 0.0 {
        world.step();
    }
    let b = world.bodies[1];
    [
        b.velocity.2 / (SPEED * cosine),
        b.velocity.0 / (SPEED * sine),
        -b.spin.1,
    ]
}

fn row_behaviour(e: f64, mu: f64, kept: TangentialUnloading) -> PairInput {
    PairInput {
        tangential_damping: 0.0,
        pull: AttractiveDamping::AsDamped,
        kept,
        ..PairInput::new(e, mu)
    }
}

/// The reference's two variants keep the spring's force and its elongation. At 20 degrees and more
/// this law also keeps the elongation: the contact sticks only while the load decreases.
///
/// Errors decrease at least in proportion to the step: the load, which determines the tangential
/// stiffness, starts like a square root.
#[test]
fn impacts_at_all_angles_are_those_of_the_independent_implementation() {
    for row in reference().chung_ooi_4.rows {
        let mut cases = vec![
            (TangentialUnloading::Force, &row.variant1),
            (TangentialUnloading::Elongation, &row.variant2),
        ];
        if row.angle >= 20.0 {
            cases.push((TangentialUnloading::LesserForce, &row.variant2));
        }
        for (kept, wanted) in cases {
            let pair_input = row_behaviour(row.e, row.mu, kept);
            for steps in [2000.0, 20000.0] {
                let found = impact(&row.material, row.angle, &pair_input, steps);
                let errors = [
                    found[0] - wanted.e_n,
                    found[1] - wanted.e_t,
                    (found[2] - wanted.omega) * RADIUS / SPEED,
                ];
                assert!(
                    errors.iter().all(|error| error.abs() < 0.1 / steps),
                    "{} {} {} {kept:?} {steps}: {errors:?}",
                    row.material,
                    row.e,
                    row.angle
                );
            }
        }
    }
}

/// A sticking contact loses energy with this law, and would gain it if it kept the elongation.
#[test]
fn a_grazing_impact_wins_no_energy() {
    let energy = |kept| {
        let [_, e_t, spin] = impact("Al2O3", 2.0, &row_behaviour(1.0, 0.092, kept), 20000.0);
        let spin = spin * RADIUS / (SPEED * 2.0_f64.to_radians().sin());
        e_t * e_t + 0.4 * spin * spin
    };
    assert!(energy(TangentialUnloading::Elongation) > 1.007);
    assert!(energy(TangentialUnloading::LesserForce) < 0.95);
}
