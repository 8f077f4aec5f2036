//! Flat joints: moments of their elements, forces as a gradient, partial failure, opening under
//! pressure, friction, and their balances.

use std::f64::consts::PI;

use super::vector;
use crate::bars::reopen;
use crate::leave_out::planned;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact};
use dem_physics::bond::failure::Cause;
use dem_physics::bond::flat_joint::{
    Element, ElementStrengths, FlatJoint, FlatJointLaw, JointStiffness, change, elements, forces,
    moment_ratio,
};
use dem_physics::bond::rod::Stiffness;
use dem_physics::bond::total::{self, End};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

const RADIUS_M: f64 = 0.5;
const LENGTH_M: f64 = 2.0;
const STIFFNESS: JointStiffness = JointStiffness {
    normal_pa_m: 1e3,
    shear_pa_m: 4e2,
};

fn law(radial_elements: u32, circumferential_elements: u32, friction: f64) -> FlatJointLaw {
    FlatJointLaw {
        radial_elements,
        circumferential_elements,
        friction,
    }
}

fn disc(law: &FlatJointLaw) -> Vec<Element> {
    elements(law, RADIUS_M, &Vector3::x())
}

fn ends(apart: Vector3<f64>, turns: [Vector3<f64>; 2]) -> [End; 2] {
    [
        (Vector3::zeros(), turns[0]),
        (Vector3::x() * LENGTH_M + apart, turns[1]),
    ]
    .map(|(position_m, turn)| End {
        position_m,
        turned: UnitQuaternion::from_scaled_axis(turn),
    })
}

/// Area, first and second moments of all elements, over those of the disc.
#[test]
fn the_elements_have_the_moments_of_their_centroids() {
    for (rings, sectors) in [(1, 3), (1, 4), (2, 5), (3, 12), (4, 7)] {
        let all = disc(&law(rings, sectors, 0.0));
        assert_eq!(all.len() as u32, rings * sectors);
        let area: f64 = all.iter().map(|element| element.area_m2).sum();
        assert!((area / (PI * RADIUS_M * RADIUS_M) - 1.0).abs() < 1e-14);
        let places = all.iter().map(|e| (e.area_m2, Vector3::from(e.place_m)));
        let first: Vector3<f64> = places.clone().map(|(area, r)| area * r).sum();
        assert!(first.norm() < 1e-15, "{first}");
        let [yy, zz, yz, xx] = places.fold([0.0; 4], |[yy, zz, yz, xx], (area, r)| {
            [
                yy + area * r.y * r.y,
                zz + area * r.z * r.z,
                yz + area * r.y * r.z,
                xx + r.x * r.x,
            ]
        });
        let of_disc = PI / 4.0 * RADIUS_M.powi(4);
        // Rings of the width 1/n: 2 (2 k + 1)/n^2 (2/3 (3 k^2 + 3 k + 1)/(2 k + 1)/n)^2.
        let n = f64::from(rings);
        let half = PI / f64::from(sectors);
        let sum: f64 = (0..rings)
            .map(|k| {
                let k = f64::from(k);
                let centroid = 2.0 / 3.0 * (3.0 * k * k + 3.0 * k + 1.0) / (2.0 * k + 1.0) / n;
                2.0 * (2.0 * k + 1.0) / (n * n) * centroid * centroid
            })
            .sum();
        let expected = sum * (half.sin() / half).powi(2);
        for (found, wanted) in [(yy, expected), (zz, expected), (yz, 0.0), (xx, 0.0)] {
            assert!((found / of_disc - wanted).abs() < 1e-14, "{found} {wanted}");
        }
        let ratio = moment_ratio(&law(rings, sectors, 0.0));
        assert!((ratio - expected).abs() < 1e-14, "{ratio} {expected}");
    }
    // One ring of three: 8/9 (sin(60 deg)/(60 deg))^2.
    let coarse = moment_ratio(&law(1, 3, 0.0));
    assert!((coarse - 8.0 / 9.0 * 0.75 / (PI / 3.0).powi(2)).abs() < 1e-14);
    let errors = [4, 8, 16, 32].map(|n| 1.0 - moment_ratio(&law(n, 4 * n, 0.0)));
    for order in crate::bars::orders(&errors) {
        assert!((1.95..2.05).contains(&order), "{order}: {errors:?}");
    }
}

/// While all elements hold, a joint is the linear bond with their moments, to first order.
#[test]
fn a_whole_joint_is_a_bond_with_its_moments() {
    let shape = law(2, 6, 0.0);
    let area = PI * RADIUS_M * RADIUS_M;
    let ratio = moment_ratio(&shape);
    let (normal, shear) = (area * STIFFNESS.normal_pa_m, area * STIFFNESS.shear_pa_m);
    let stiffness = Stiffness {
        normal,
        shear,
        torsion: ratio * shear * RADIUS_M * RADIUS_M / 2.0,
        bending: ratio * normal * RADIUS_M * RADIUS_M / 4.0,
        levers_m: [LENGTH_M / 2.0; 2],
    };
    let errors = [1e-3, 5e-4, 2.5e-4].map(|size| {
        let turns = [Vector3::new(0.3, -0.2, 0.5), Vector3::new(-0.4, 0.6, -0.1)];
        let at = ends(
            size * Vector3::new(0.4, -0.7, 0.2),
            turns.map(|turn| size * turn),
        );
        let joint = forces(&disc(&shape), &STIFFNESS, &Vector3::x(), LENGTH_M, &at);
        let bond = total::bond_forces(&stiffness, &Vector3::x(), &at);
        let off = (joint.force_on_b - bond.force_on_b).norm()
            + (joint.torques[0] - bond.torques[0]).norm()
            + (joint.torques[1] - bond.torques[1]).norm();
        off / bond.force_on_b.norm()
    });
    for order in crate::bars::orders(&errors) {
        assert!((0.9..1.1).contains(&order), "{errors:?}");
    }
    assert!(errors[2] < 1e-3, "{errors:?}");
}

fn turned(end: &End, by: Vector3<f64>) -> End {
    End {
        turned: UnitQuaternion::from_scaled_axis(by) * end.turned,
        ..*end
    }
}

proptest! {
    /// Whatever has failed and slid: force and torques are the gradient of the energy, no net force
    /// and no net moment acts, and a rotation of both ends rotates them.
    #[test]
    fn forces_are_the_gradient_of_the_energy(
        apart in vector(0.2), turn_a in vector(0.5), turn_b in vector(0.5), by in vector(3.0),
        failed in prop::collection::vec(any::<bool>(), 8), slips in prop::collection::vec(-0.1..0.1, 16)
    ) {
        let mut all = disc(&law(2, 4, 0.3));
        for (i, element) in all.iter_mut().enumerate() {
            element.is_bonded = !failed[i];
            element.slip_m = [0.0, slips[2 * i], slips[2 * i + 1]];
        }
        let at = ends(apart, [turn_a, turn_b]);
        let of = |at: &[End; 2]| forces(&all, &STIFFNESS, &Vector3::x(), LENGTH_M, at);
        let found = of(&at);
        let energy = |at: &[End; 2]| of(at).energy.total();
        let h = 1e-6;
        let here = energy(&at);
        // Where a failed element opens, the energy of its sliding ends, and there is no gradient.
        let is_smooth = |more: f64, less: f64| (more - 2.0 * here + less).abs() < 1e-2 * h;
        for axis in 0..3 {
            let mut step = Vector3::zeros();
            step[axis] = h;
            let moved = |sign: f64| [at[0], End { position_m: at[1].position_m + sign * step, ..at[1] }];
            let [more, less] = [1.0, -1.0].map(|sign| energy(&moved(sign)));
            prop_assume!(is_smooth(more, less));
            let force = -(more - less) / (2.0 * h);
            prop_assert!((force - found.force_on_b[axis]).abs() < 1e-3, "{force} {}", found.force_on_b[axis]);
            for end in 0..2 {
                let moved = |sign: f64| {
                    let mut moved = at;
                    moved[end] = turned(&at[end], sign * step);
                    moved
                };
                let [more, less] = [1.0, -1.0].map(|sign| energy(&moved(sign)));
                prop_assume!(is_smooth(more, less));
                let torque = -(more - less) / (2.0 * h);
                prop_assert!((torque - found.torques[end][axis]).abs() < 1e-3, "{torque} {}", found.torques[end][axis]);
            }
        }
        let arm = at[1].position_m - at[0].position_m;
        let moment = arm.cross(&found.force_on_b) + found.torques[0] + found.torques[1];
        prop_assert!(moment.norm() < 1e-10, "{moment}");
        let by = UnitQuaternion::from_scaled_axis(by);
        let there = of(&at.map(|end| End { position_m: by * end.position_m, turned: by * end.turned }));
        prop_assert!((by * found.force_on_b - there.force_on_b).norm() < 1e-9);
        prop_assert!((by * found.torques[0] - there.torques[0]).norm() < 1e-9);
    }
}

/// Axial force and moment of a rigid disc of radius R on a foundation that only presses, turned by
/// an angle about an axis in its plane, where it touches beyond R cos(a): over k angle R^3, and
/// over k angle R^4.
fn rigid_disc(a: f64) -> [f64; 2] {
    let (sine, cosine) = a.sin_cos();
    let area = a - sine * cosine;
    let first = 2.0 / 3.0 * sine.powi(3);
    let second = 0.25 * (area + 2.0 * sine.powi(3) * cosine);
    [first - cosine * area, second - cosine * first]
}

/// A joint of elements with hardly any tensile strength that is rotated under a constant pressure
/// follows the curve of a rigid disc on a foundation that only presses.
#[test]
fn a_joint_opens_under_pressure_like_a_disc_on_a_foundation() {
    let pressure_n = 0.02;
    let strengths = ElementStrengths {
        tensile_pa: 1e-9,
        cohesion_pa: f64::INFINITY,
        friction_tangent: 0.0,
    };
    let errors = [8, 16, 32].map(|n| {
        let mut all = disc(&law(n, 4 * n, 0.0));
        let mut largest = 0.0_f64;
        // From just before it opens to a tenth of the section.
        for degrees in [180, 150, 120, 90, 60, 45] {
            let [axial, moment] = rigid_disc(f64::from(degrees).to_radians());
            let angle = pressure_n / (axial * STIFFNESS.normal_pa_m * RADIUS_M.powi(3));
            // The elongation at which the pressure is that.
            let (mut low, mut high) = (-0.1, 0.1);
            let at = |elongation: f64| {
                let half = 0.5 * angle * Vector3::z();
                // Distance along the direction of the frame.
                ends(elongation * Vector3::x(), [-half, half])
            };
            let strained = |all: &[Element], elongation: f64| {
                let now = change(
                    all,
                    (&STIFFNESS, 0.0),
                    Some(&strengths),
                    &Vector3::x(),
                    LENGTH_M,
                    &at(elongation),
                );
                now.map_or(all.to_vec(), |change| change.elements)
            };
            let load = |all: &[Element], elongation: f64| {
                forces(all, &STIFFNESS, &Vector3::x(), LENGTH_M, &at(elongation)).load
            };
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let now = strained(&all, middle);
                if load(&now, middle).normal_n < -pressure_n {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            all = strained(&all, low);
            let found = load(&all, low).bending_n_m;
            let expected = moment * angle * STIFFNESS.normal_pa_m * RADIUS_M.powi(4);
            largest = largest.max((found / expected - 1.0).abs());
        }
        largest
    });
    assert!(errors[2] < 2e-3, "{errors:?}");
    assert!(errors[0] > 4.0 * errors[2], "{errors:?}");
}

const SPHERE_M: f64 = 1e-3;
const YOUNG_PA: f64 = 1e9;

const LEFT_FIXED: &str = "supports.left = { group = \"left\", fixed = true }\n";

/// A pair of spheres at 2 mm with a flat joint of radius 1 mm, with keys of the bond, and further
/// tables.
fn pair(step_s: f64, bond: &str, more: &str) -> State {
    let text = format!(
        "version = 1
run = {{ end_time = 1, time_step = {step_s:e} }}
materials.rock = {{ density = 2500 }}
bonds.rock = {{ model = \"flat-joint\", young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.25, {bond} }}
bodies.pair = {{ particles = [[0, 0, 0, {SPHERE_M}], [2e-3, 0, 0, {SPHERE_M}]], bond_list = [[0, 1]], material = \"rock\", bonds = \"rock\" }}
groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
{more}"
    );
    planned(&text).1.state
}

/// Pulled apart, all elements fail at the tensile strength, and the bond releases what it stored.
#[test]
fn a_joint_in_tension_breaks_as_a_whole() {
    let (strength_pa, speed_m_s) = (1e5, 1e-3);
    let mut state = pair(
        1e-6,
        &format!("failure = {{ tensile_strength = {strength_pa:e} }}"),
        &format!(
            "{LEFT_FIXED}supports.right = {{ group = \"right\", fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], velocity = {{ x = {speed_m_s} }} }}"
        ),
    );
    while state.broken_count == 0 {
        assert!(state.time_s < 1e-3, "it does not break");
        interact(&mut state);
        if state.broken_count > 0 {
            break;
        }
        advance(&mut state);
    }
    let expected_s = strength_pa / YOUNG_PA * 2e-3 / speed_m_s;
    assert!(
        (state.time_s - expected_s).abs() < 1.5e-6,
        "{}",
        state.time_s
    );
    assert_eq!(state.broken_by_cause.of(Cause::Tension), 1);
    let area = PI * SPHERE_M * SPHERE_M;
    let stored_j = 0.5 * strength_pa * strength_pa / YOUNG_PA * area * 2e-3;
    let now = balance(&mut state);
    let off = now.bond_breakage_j / stored_j - 1.0;
    // Two steps of the displacement.
    assert!(off.abs() < 2.0 * 1e-6 / expected_s, "{off}");
    assert!(now.energy_error.abs() < 1e-6, "{now:?}");
}

/// Twisted under pressure, the outer ring fails first and slides, while the inner one holds.
#[test]
fn a_ring_that_has_failed_rubs_under_pressure() {
    let (cohesion_pa, friction, pressure_pa) = (1e5, 0.4, 5e4);
    let (angle, ramp_s) = (1.2e-3, 4e-3);
    let squeezed_m = pressure_pa / YOUNG_PA * 2e-3;
    let mut state = pair(
        1e-6,
        &format!(
            "radial_elements = 2, circumferential_elements = 8, joint_friction = {friction}, failure = {{ cohesion = {cohesion_pa:e}, friction_angle = 0 }}"
        ),
        &format!(
            "{LEFT_FIXED}supports.right = {{ group = \"right\", fixed = [\"y\", \"z\", \"ry\", \"rz\"], displacement = {{ x = {:e}, rx = {angle:e} }}, table = [[0, 0], [{ramp_s}, 1]] }}",
            -squeezed_m
        ),
    );
    let stiffness = state.bonds.stiffness(0);
    let area = PI * SPHERE_M * SPHERE_M;
    let shear_pa_m = stiffness.shear / area;
    let half = PI / 8.0;
    let centroid = |inner: f64, outer: f64| {
        2.0 / 3.0 * (outer.powi(3) - inner.powi(3)) / (outer.powi(2) - inner.powi(2)) * half.sin()
            / half
            * SPHERE_M
    };
    let (inside, outside) = (centroid(0.0, 0.5), centroid(0.5, 1.0));
    let fails_at = cohesion_pa / (shear_pa_m * outside);
    assert!(fails_at < 0.9 * angle && angle < 0.9 * cohesion_pa / (shear_pa_m * inside));
    while state.time_s < ramp_s - 0.5e-6 {
        interact(&mut state);
        let part = state.time_s / ramp_s;
        let twist = part * angle;
        let torque = |factor: f64, r: f64, tau: f64| factor * area * r * tau;
        let outer_pa = if twist < fails_at {
            shear_pa_m * twist * outside
        } else {
            friction * part * pressure_pa
        };
        let expected =
            torque(0.25, inside, shear_pa_m * twist * inside) + torque(0.75, outside, outer_pa);
        let load = state.bonds.forces(0, &state.particles.poses).load;
        let scale = torque(1.0, outside, cohesion_pa);
        let is_at_failure = (twist - fails_at).abs() < 1e-6 / ramp_s * angle;
        assert!(
            is_at_failure || (load.torsion_n_m - expected).abs() < 1e-6 * scale,
            "{twist}: {} {expected}",
            load.torsion_n_m
        );
        advance(&mut state);
    }
    interact(&mut state);
    assert_eq!(state.broken_count, 0);
    let failed = state.bonds.histories.joints[0].failed_fraction();
    assert!((failed - 0.75).abs() < 1e-12, "{failed}");
    let now = balance(&mut state);
    // The friction rises with the pressure, which rises with the twist.
    let full = friction * pressure_pa * 0.75 * area * outside;
    let last_pa = friction * pressure_pa;
    let first_pa = last_pa * fails_at / angle;
    let stored = 0.75 * area / (2.0 * shear_pa_m) * (last_pa.powi(2) - first_pa.powi(2));
    // At once: the stress falls from the cohesion to the friction, and the faces slide by it.
    let falls_pa = cohesion_pa - first_pa;
    let at_once = 0.75 * area / shear_pa_m * first_pa * falls_pa;
    let work = 0.5 * full / angle * (angle * angle - fails_at * fails_at) - stored + at_once;
    assert!(
        (now.friction_j / work - 1.0).abs() < 5e-3,
        "{} {work}",
        now.friction_j
    );
    let released = 0.75 * area / (2.0 * shear_pa_m) * falls_pa.powi(2);
    assert!(
        (now.bond_breakage_j / released - 1.0).abs() < 5e-3,
        "{} {released}",
        now.bond_breakage_j
    );
    assert!(now.energy_error.abs() < 1e-4, "{now:?}");
}

/// Bent, the edge fails first: at the moment that strains its elements to the strength.
#[test]
fn a_bent_joint_fails_from_its_edge() {
    let (strength_pa, angle, ramp_s) = (1e5, 6e-4, 4e-3);
    let bend = |side: &str, angle: f64| {
        format!(
            "supports.{side} = {{ group = \"{side}\", fixed = [\"x\", \"y\", \"z\", \"rx\", \"ry\"], displacement = {{ rz = {angle:e} }}, table = [[0, 0], [{ramp_s}, 1]] }}\n"
        )
    };
    let mut state = pair(
        1e-6,
        &format!(
            "radial_elements = 4, circumferential_elements = 16, failure = {{ tensile_strength = {strength_pa:e} }}"
        ),
        &(bend("left", -0.5 * angle) + &bend("right", 0.5 * angle)),
    );
    let farthest = state.bonds.histories.joints[0]
        .elements
        .iter()
        .map(|element| element.place_m[1].abs())
        .fold(0.0, f64::max);
    let fails_at = strength_pa / (YOUNG_PA / 2e-3) / farthest;
    let (mut failed_at, mut fractions) = (None, vec![]);
    while state.time_s < ramp_s && state.broken_count == 0 {
        interact(&mut state);
        let fraction = state.bonds.histories.joints[0].failed_fraction();
        if fraction > 0.0 && failed_at.is_none() {
            failed_at = Some(state.time_s / ramp_s * angle);
        }
        fractions.push(fraction);
        advance(&mut state);
    }
    let found = failed_at.unwrap();
    assert!(
        (found - fails_at).abs() < 2e-6 / ramp_s * angle,
        "{found} {fails_at}"
    );
    assert!(fractions.is_sorted(), "{fractions:?}");
    // One half is pressed: it holds.
    let last = *fractions.last().unwrap();
    assert!(
        (0.3..=0.5).contains(&last) && state.broken_count == 0,
        "{last}"
    );
}

/// A row of flat joints that is squeezed and twisted: elements fail and slide.
fn thrown(part: f64) -> State {
    let spheres: Vec<String> = (0..7)
        .map(|i| format!("[{}, 0, 0, {SPHERE_M}]", 2e-3 * f64::from(i)))
        .collect();
    let text = format!(
        "version = 1
run = {{ end_time = 1, safety_factor = {part} }}
materials.rock = {{ density = 2500 }}
bonds.rock = {{ model = \"flat-joint\", joint_friction = 0.1, young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3, failure = {{ cohesion = 1e4, friction_angle = 0 }} }}
bodies.row = {{ particles = [{}], bond_list = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6]], material = \"rock\", bonds = \"rock\" }}
",
        spheres.join(", ")
    );
    let mut state = planned(&text).1.state;
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        let phase = PI * i as f64 / 6.0;
        motion.velocity_m_s = [0.05 * phase.cos(), 0.004 * (2.0 * phase).sin(), 0.0];
        motion.spin_rad_s = [60.0 * phase.cos(), 0.0, 6.0 * (2.0 * phase).cos()];
    }
    reopen(&mut state);
    state
}

#[test]
fn books_stay_closed_while_elements_fail_and_slide() {
    let until_s = 150.0 * thrown(0.25).time_step_s;
    let errors = [0.25, 0.125, 0.0625].map(|part| {
        let mut state = thrown(part);
        let (mut error, mut partly) = (0.0_f64, 0);
        while state.time_s < until_s {
            interact(&mut state);
            let now = balance(&mut state);
            error = error.max(now.energy_error.abs());
            assert!(now.momentum_error < 1e-12, "{now:?}");
            assert!(now.angular_momentum_error < 1e-12, "{now:?}");
            let failed = state
                .bonds
                .histories
                .joints
                .iter()
                .map(FlatJoint::failed_fraction);
            partly = partly.max(failed.filter(|part| (0.01..0.99).contains(part)).count());
            advance(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        assert!(now.bond_breakage_j > 0.1 * now.energy_scale_j, "{now:?}");
        assert!(now.friction_j > 0.05 * now.energy_scale_j, "{now:?}");
        assert!(partly >= 2, "{partly}");
        error
    });
    assert!(
        errors[0] > 8.0 * errors[2] && errors[2] < 5e-4,
        "{errors:?}"
    );
}
