//! Invariants of every contact law.

use super::world::{Body, Vector, World, ZERO, material};
use dem_physics::contact::kinematics::{
    ContactKinematics, ContactSphere, contact_kinematics, torques,
};
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::pair_parameters::PairInput;
use dem_physics::contact::rolling::{ConstantMoment, ElasticPlastic, NoRolling, RollingFriction};
use dem_physics::contact::{ContactSprings, NormalLaw, Response, response};
use dem_physics::number::Vec3;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

pub(crate) const SPRING: ElasticPlastic = ElasticPlastic {
    friction: 0.1,
    damping_ratio: 0.3,
};
pub(crate) const MOMENT: ConstantMoment = ConstantMoment { friction: 0.1 };
pub(crate) const DT: f64 = 1e-6;

pub(crate) fn hertz() -> HertzMindlin {
    HertzMindlin::new(
        [material(1e9, 0.25), material(3e9, 0.2)],
        &PairInput::new(0.5, 0.3),
    )
}

pub(crate) fn linear() -> Linear {
    Linear::new(1e6, 0.8, &PairInput::new(0.5, 0.3))
}

/// Two touching balls and their contact history.
#[derive(Debug, Clone, Copy)]
struct Scene {
    apart: Vector,
    balls: [ContactSphere; 2],
    history: ContactSprings,
}

pub(crate) fn triple(v: Vector3<f64>) -> Vector {
    Vec3(v.x, v.y, v.z)
}

/// The unit vector along another.
fn direction(v: Vector) -> Vector {
    v * (1.0 / v.square().sqrt())
}

fn scenes() -> impl Strategy<Value = Scene> {
    let unit = prop::array::uniform3(-1.0..1.0_f64)
        .prop_filter("a direction", |v| Vector3::from(*v).norm() > 0.1)
        .prop_map(|v| triple(Vector3::from(v).normalize()));
    let vector = |size: f64| {
        prop::array::uniform3(-size..size).prop_map(|v: [f64; 3]| Vec3(v[0], v[1], v[2]))
    };
    (
        unit,
        prop::array::uniform2(0.005..0.02_f64),
        -2e-6..1e-5_f64,
        prop::array::uniform2(vector(1.0)),
        prop::array::uniform2(vector(50.0)),
        [vector(3e-6), vector(3e-4)],
        0.0..1e-5_f64,
    )
        .prop_map(
            |(normal, radii, overlap, velocities, spins, springs, before)| {
                let [a, b] = [0, 1].map(|end| ContactSphere {
                    velocity_m_s: velocities[end],
                    spin_rad_s: spins[end],
                    ..Body::sphere(radii[end], 2500.0, ZERO).ball()
                });
                let moving = velocities[1] - velocities[0];
                let apart = normal * (radii[0] + radii[1] - overlap);
                let was = direction(apart - moving * DT);
                let across = |v: Vector| v - was * was.dot(v);
                Scene {
                    apart,
                    balls: [a, b],
                    history: ContactSprings {
                        tangential_m: across(springs[0]),
                        rolling_rad: across(springs[1]),
                        overlap_m: before,
                    },
                }
            },
        )
}

fn answer(
    law: &impl NormalLaw<f64>,
    rolling: &impl RollingFriction<f64>,
    scene: &Scene,
) -> Response {
    let touch = contact_kinematics(scene.apart, scene.balls, DT);
    response(law, rolling, &touch, &scene.history, DT)
}

pub(crate) fn vectors(r: &Response) -> [Vector; 4] {
    [
        r.force_on_b,
        r.moment_on_b,
        r.springs.tangential_m,
        r.springs.rolling_rad,
    ]
}

fn scalars(r: &Response) -> [f64; 6] {
    [
        r.springs.overlap_m,
        r.energy.normal,
        r.energy.tangential,
        r.energy.rolling,
        r.lost.sliding,
        r.lost.rolling,
    ]
}

fn turned(scene: &Scene, by: &Rotation3<f64>) -> Scene {
    let turn = |v: Vector| triple(by * Vector3::new(v.0, v.1, v.2));
    Scene {
        apart: turn(scene.apart),
        balls: scene.balls.map(|ball| ContactSphere {
            velocity_m_s: turn(ball.velocity_m_s),
            spin_rad_s: turn(ball.spin_rad_s),
            ..ball
        }),
        history: ContactSprings {
            tangential_m: turn(scene.history.tangential_m),
            rolling_rad: turn(scene.history.rolling_rad),
            ..scene.history
        },
    }
}

/// Checks every condition for one scene.
fn check(
    law: &impl NormalLaw<f64>,
    rolling: &impl RollingFriction<f64>,
    scene: &Scene,
    by: &Rotation3<f64>,
) -> Result<(), TestCaseError> {
    let found = answer(law, rolling, scene);
    let met = contact_kinematics(scene.apart, scene.balls, DT);
    let n = met.normal;

    // Never attractive; friction never above its limit.
    let normal = found.force_on_b.dot(n);
    let across = found.force_on_b - n * normal;
    let room = 1e-9 * normal.abs();
    prop_assert!(normal >= -1e-12 * across.square().sqrt());
    prop_assert!(across.square().sqrt() <= 0.3 * normal + room);
    prop_assert!(found.moment_on_b.square().sqrt() <= 0.1 * met.effective_radius_m * normal + room);
    prop_assert!(found.moment_on_b.dot(n).abs() <= 1e-12 * normal.abs());
    if met.overlap_m <= 0.0 {
        prop_assert!(vectors(&found).iter().all(|v| *v == ZERO));
        prop_assert_eq!(scalars(&found)[..4].to_vec(), vec![0.0; 4]);
        prop_assert_eq!(
            found
                .damping
                .power_w(met.velocity_m_s, met.spin_rad_s)
                .normal,
            0.0
        );
    }
    let power = found.damping.power_w(met.velocity_m_s, met.spin_rad_s);
    let loss = 1e-9 * normal.abs() * met.velocity_m_s.square().sqrt();
    prop_assert!(
        power.tangential >= -loss && power.rolling >= -1e-12,
        "{power:?}"
    );

    // Torques balance.
    let [on_a, on_b] = torques(&met, found.force_on_b, found.moment_on_b);
    let left = on_a + on_b + scene.apart.cross(found.force_on_b);
    prop_assert!(left.square().sqrt() <= 1e-13 * normal.abs());

    // Rotated as a whole, the result is the same but rotated. The overlap has the rounding error of
    // the distance, and where sliding begins the contribution of the damper is the square root of a
    // difference that may be rounding: half the digits.
    let normal_response = law.evaluate(&met, scene.history.overlap_m, DT);
    let speed = met.velocity_m_s.square().sqrt();
    let size = normal_response.elastic_n + normal_response.normal_damping_n_s_m * speed;
    let force_off = size * (1e-8 + 1e-16 / met.overlap_m.abs());
    let moment_off = force_off * met.effective_radius_m;
    let rolling_n_m_rad =
        2.25 * normal_response.normal_n_m[1] * (0.1 * met.effective_radius_m).powi(2);
    let offs = [
        force_off,
        moment_off,
        force_off / normal_response.tangential_n_m[1]
            + 1e-8 * scene.history.tangential_m.square().sqrt(),
        moment_off / rolling_n_m_rad + 1e-8 * scene.history.rolling_rad.square().sqrt(),
    ];
    let other = answer(law, rolling, &turned(scene, by));
    let pairs = vectors(&found).into_iter().zip(vectors(&other));
    for ((before, after), most) in pairs.zip(offs) {
        let wanted = by * Vector3::new(before.0, before.1, before.2);
        let off = (triple(wanted) - after).square().sqrt();
        prop_assert!(
            met.overlap_m <= 0.0 || off <= most,
            "{off:e} {most:e} {after:?}"
        );
    }

    // With the ends exchanged, the opposite to the last bit.
    let [a, b] = scene.balls;
    let other = Scene {
        apart: -scene.apart,
        balls: [b, a],
        history: ContactSprings {
            tangential_m: -scene.history.tangential_m,
            rolling_rad: -scene.history.rolling_rad,
            ..scene.history
        },
    };
    let other = answer(law, rolling, &other);
    for (one, other) in vectors(&found).into_iter().zip(vectors(&other)) {
        prop_assert_eq!(one, -other);
    }
    prop_assert_eq!(scalars(&found), scalars(&other));
    Ok(())
}

proptest! {
    #[test]
    fn every_law_keeps_what_it_must(
        scene in scenes(),
        axis in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        let by = Rotation3::new(Vector3::from(axis));
        check(&hertz(), &SPRING, &scene, &by)?;
        check(&hertz(), &MOMENT, &scene, &by)?;
        check(&linear(), &SPRING, &scene, &by)?;
        check(&linear(), &MOMENT, &scene, &by)?;
    }
}

proptest! {
    /// Normals and effective values by their definitions, in steps in which the normal rotates far,
    /// also with held ends.
    #[test]
    fn kinematics_are_those_of_unit_vectors(
        scene in scenes(),
        held in prop::array::uniform2(any::<bool>()),
    ) {
        const LONG: f64 = 2e-3;
        let mut balls = scene.balls;
        for (ball, held) in balls.iter_mut().zip(held) {
            if held {
                ball.inverse_mass_per_kg = 0.0;
            }
        }
        let [a, b] = balls;
        let met = contact_kinematics(scene.apart, balls, LONG);
        let normal = direction(scene.apart);
        let before = direction(scene.apart - (b.velocity_m_s - a.velocity_m_s) * LONG);
        let off = |one: Vector, other: Vector| (one - other).square().sqrt();
        prop_assert!(off(met.normal, normal) < 2e-15);
        prop_assert!(off(met.middle, direction(normal + before)) < 2e-15);
        let radius_m = 1.0 / (1.0 / a.radius_m + 1.0 / b.radius_m);
        prop_assert!((met.effective_radius_m / radius_m - 1.0).abs() < 1e-15);
        let inverse_mass = a.inverse_mass_per_kg + b.inverse_mass_per_kg;
        if inverse_mass == 0.0 {
            prop_assert_eq!(met.effective_mass_kg, 0.0);
        } else {
            prop_assert!((met.effective_mass_kg * inverse_mass - 1.0).abs() < 1e-15);
        }
    }

    /// The dashpot across the normal is whole, or as large as the limit of friction allows it.
    #[test]
    fn friction_limits_the_dashpot_no_more_than_it_must(
        scene in scenes(),
        slowness in 0.0..4.0_f64,
    ) {
        let slowed = |v: Vector| v * 10.0_f64.powf(-slowness);
        let balls = scene.balls.map(|ball| ContactSphere {
            velocity_m_s: slowed(ball.velocity_m_s),
            spin_rad_s: slowed(ball.spin_rad_s),
            ..ball
        });
        let touch = contact_kinematics(scene.apart, balls, 0.0);
        prop_assume!(touch.overlap_m > 1e-7);
        let across = |v: Vector| v - touch.normal * touch.normal.dot(v);
        let history = ContactSprings {
            tangential_m: across(scene.history.tangential_m),
            ..scene.history
        };
        for (found, damping_n_s_m) in [
            of_law(&hertz(), &touch, &history),
            of_law(&linear(), &touch, &history),
        ] {
            let normal = found.force_on_b.dot(touch.normal);
            let limit = 0.3 * normal;
            let friction = across(found.force_on_b).square().sqrt();
            let whole = across(touch.velocity_m_s) * damping_n_s_m;
            let missing = (found.damping.tangential_n + whole).square().sqrt();
            prop_assert!(friction <= limit * (1.0 + 1e-9), "{friction:e} {limit:e}");
            let is_whole = missing < 1e-9 * limit;
            let at_limit = (friction - limit).abs() <= 1e-7 * limit;
            prop_assert!(is_whole || at_limit, "{missing:e} {friction:e} {limit:e}");
        }
    }
}

/// Response in a step of 0 s, in which axes do not rotate, and the coefficient of the tangential
/// dashpot, N s/m.
fn of_law(
    law: &impl NormalLaw<f64>,
    touch: &ContactKinematics,
    history: &ContactSprings,
) -> (Response, f64) {
    let found = response(law, &NoRolling, touch, history, 0.0);
    let normal = law.evaluate(touch, history.overlap_m, 0.0);
    (found, normal.tangential_damping_n_s_m)
}

/// Steady sliding: friction is mu N against the motion, and dissipates its power.
#[test]
fn sliding_loses_friction_times_way() {
    let mut world = World::new(
        linear(),
        MOMENT,
        [
            Body::floor(),
            Body::sphere(0.01, 2500.0, Vec3(0.0, 0.0, 0.00999)),
        ],
        DT,
    );
    world.bodies[1].velocity = Vec3(3.0, 4.0, 0.0);
    world.bodies[1].per_mass = 0.0;
    world.bodies[1].per_inertia = 0.0;
    for _ in 0..1000 {
        world.step();
    }
    let before = world.all_lost();
    let found = world.step();
    let normal = 1e6 * 1e-5;
    for (found, wanted) in [
        (found.force_on_b.0, -0.6 * 0.3 * normal),
        (found.force_on_b.1, -0.8 * 0.3 * normal),
        (found.force_on_b.2, normal),
        (world.all_lost() - before, 0.3 * normal * 5.0 * DT),
    ] {
        super::assert_near(found, wanted, 1e-9);
    }
}

/// A contact can continue from its history alone.
#[test]
fn a_contact_goes_on_from_its_history() {
    let ball = Body {
        velocity: Vec3(0.3, 0.1, -0.5),
        ..Body::sphere(0.01, 2500.0, Vec3(0.0, 0.0, 0.01))
    };
    let mut one = World::new(hertz(), SPRING, [Body::floor(), ball], DT);
    for _ in 0..20 {
        one.step();
    }
    let mut other = World::new(hertz(), SPRING, one.bodies, DT);
    other.history = one.history;
    other.before = one.before;
    for _ in 0..50 {
        assert_eq!(one.step(), other.step());
    }
    assert_eq!(one.bodies[1].place, other.bodies[1].place);
}
