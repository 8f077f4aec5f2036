//! Contacts within a piece: spheres that no bond joins touch.

use std::collections::HashSet;
use std::fmt::Write;

use dem_engine::stages::contacts::forces::overlap_m;
use dem_engine::state::State;
use dem_engine::step::step;
use dem_plan::Plan;
use nalgebra::Vector3;

use super::apart::planned;
use super::clouds::scattered;

const RADIUS_M: f64 = 1e-3;

/// A block of touching or overlapping spheres on a cubic lattice. `distance_m`: of neighbours;
/// `joins`: whether two neighbours are bonded.
struct Block {
    count: [usize; 3],
    distance_m: f64,
    joins: fn([usize; 3], [usize; 3]) -> bool,
}

impl Block {
    /// Its particles and bonds, as keys of a body.
    fn keys(&self) -> String {
        let [nx, ny, nz] = self.count;
        let number = |[x, y, z]: [usize; 3]| (z * ny + y) * nx + x;
        let (mut particles, mut bonds) = (String::new(), String::new());
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    let [px, py, pz] = [x, y, z].map(|n| n as f64 * self.distance_m);
                    let _ = write!(particles, "[{px:e}, {py:e}, {pz:e}, {RADIUS_M:e}],");
                    for next in [[x + 1, y, z], [x, y + 1, z], [x, y, z + 1]] {
                        let is_there = next.iter().zip(self.count).all(|(n, of)| *n < of);
                        if is_there && (self.joins)([x, y, z], next) {
                            let ends = [[x, y, z], next].map(number);
                            let _ = write!(bonds, "{ends:?},");
                        }
                    }
                }
            }
        }
        format!("particles = [{particles}], bond_list = [{bonds}]")
    }

    /// `bond`, `body`: further keys of its bonds and of itself.
    fn state(&self, bond: &str, body: &str, extra: &str) -> State {
        let text = format!(
            "version = 1\nrun.end_time = 1\n\
             materials.cake = {{ density = 2000, young_modulus = \"10 MPa\", poisson_ratio = 0.2 }}\n\
             materials.plate = {{ rigid = true }}\n\
             contacts.cake-cake = {{ restitution = 0.5, friction = 0.5 }}\n\
             contacts.cake-plate = {{ restitution = 0.5, friction = 0.5 }}\n\
             bonds.cake = {{ young_modulus = \"10 MPa\", poisson_ratio = 0.2, {bond} }}\n\
             bodies.block = {{ material = \"cake\", bonds = \"cake\", {}{body} }}\n{extra}",
            self.keys()
        );
        let Plan { state, .. } = planned(&text);
        state
    }
}

/// Listed pairs of one piece.
fn listed_within(state: &State) -> Vec<[u32; 2]> {
    let of = &state.clusters.as_ref().unwrap().of_particle;
    let pairs = state.contacts.as_ref().unwrap().pairs.iter();
    let within = pairs.filter(|[a, b]| of[*a as usize] == of[*b as usize]);
    within.copied().collect()
}

/// Largest force on the upper plate while a block, as tall as five spheres, is pressed by 0.3 mm.
fn pressed_n(joins: fn([usize; 3], [usize; 3]) -> bool) -> f64 {
    let block = Block {
        count: [3, 3, 6],
        distance_m: 2.0 * RADIUS_M,
        joins,
    };
    let mut state = block.state(
        "damping = { damping_ratio = 0.1 }",
        "",
        "run.local_damping = 0.2\n\
         walls.below = { plane = { point = [0, 0, -1e-3], normal = [0, 0, 1] }, material = \"plate\" }\n\
         walls.above = { plane = { point = [0, 0, 11e-3], normal = [0, 0, -1] }, material = \"plate\", velocity = [0, 0, -0.1] }",
    );
    let mut largest_n = 0.0_f64;
    while state.time_s < 3e-3 {
        step(&mut state);
        largest_n = largest_n.max(state.walls[0].total_load()[0][2].abs());
    }
    largest_n
}

/// A crack that is held open by nothing carries what the two parts of a block that is cut there
/// carry, which touch as bodies do.
#[test]
fn a_closed_crack_carries_load() {
    let cut = pressed_n(|a, b| [a[2], b[2]] != [2, 3]);
    let slit = pressed_n(|a, b| [a[2], b[2]] != [2, 3] || a[0] == 0);
    assert!(cut > 1.0 && slit > 0.95 * cut, "slit {slit} N, cut {cut} N");
}

/// A row that is bent until its ends meet.
#[test]
fn the_ends_of_a_body_that_folds_meet() {
    let (count, ring_m) = (14, 4.8e-3);
    let at = |n: usize| {
        let angle = (20.0 + 320.0 * n as f64 / (count - 1) as f64).to_radians();
        [ring_m * angle.cos(), ring_m * angle.sin()]
    };
    let mut particles = String::new();
    for [x, y] in (0..count).map(at) {
        let _ = write!(particles, "[{x:e}, {y:e}, 0, {RADIUS_M:e}],");
    }
    let bonds: Vec<[usize; 2]> = (1..count).map(|n| [n - 1, n]).collect();
    let load = |name: &str, at: usize, force_n: f64| {
        format!(
            "groups.{name} = {{ body = \"ring\", particles = [{at}] }}\n\
             loads.{name} = {{ group = \"{name}\", force = [0, {force_n}, 0], ramp = \"5 ms\" }}\n"
        )
    };
    let text = format!(
        "version = 1\nrun.end_time = 1\nrun.local_damping = 0.1\n\
         materials.fibre = {{ density = 2000, young_modulus = \"10 MPa\" }}\n\
         contacts.fibre-fibre = {{ restitution = 0.5, friction = 0.5 }}\n\
         bonds.fibre = {{ young_modulus = \"1 MPa\", poisson_ratio = 0.3, damping = {{ damping_ratio = 1 }} }}\n\
         bodies.ring = {{ material = \"fibre\", bonds = \"fibre\", particles = [{particles}], bond_list = {bonds:?} }}\n\
         {}{}",
        load("upper", 0, -0.02),
        load("lower", count - 1, 0.02),
    );
    let Plan {
        mut state, bodies, ..
    } = planned(&text);
    let ends = [0, count - 1].map(|n| bodies[0].particles[n]);
    let mut deepest_m = f64::NEG_INFINITY;
    while state.time_s < 25e-3 {
        step(&mut state);
        deepest_m = deepest_m.max(overlap_m(&state.particles.poses, ends));
    }
    // Hertz's overlap under 0.02 N is 17 um.
    assert!(deepest_m > 0.0 && deepest_m < 0.1 * RADIUS_M, "{deepest_m}");
    let [upper, lower] = ends.map(|i| state.particles.poses[i as usize].place());
    assert!(upper.y > lower.y);
}

/// Spheres that overlap without a bond, as second neighbours of a dense packing do, exert no force
/// until they are pressed further.
#[test]
fn an_overlap_of_the_packing_exerts_no_force() {
    let block = Block {
        count: [4, 4, 4],
        distance_m: 1.5 * RADIUS_M,
        joins: |a, b| a[2] != b[2] || a[2] == 0,
    };
    let mut state = block.state("", "", "");
    for _ in 0..500 {
        step(&mut state);
    }
    assert!(listed_within(&state).len() > 40);
    let fastest = state
        .particles
        .motions
        .iter()
        .map(|m| Vector3::from(m.velocity_m_s).norm());
    let fastest = fastest.fold(0.0, f64::max);
    // The speed that 1e-12 of the overlap would give it.
    assert!(fastest < 1e-12, "{fastest} m/s");
}

/// A whole body that flies and spins has no pair to look at, and is hardly ever looked at itself.
#[test]
fn a_body_in_which_nothing_can_touch_lists_nothing() {
    let block = Block {
        count: [6, 6, 6],
        distance_m: 1.9 * RADIUS_M,
        joins: |_, _| true,
    };
    let mut state = block.state(
        "failure = { tensile_strength = 1e12 }",
        ", velocity = [3, 0, 0], angular_velocity = [0, 50, 0]",
        "run.gravity = [0, 0, -9.81]",
    );
    let stage = dem_engine::step::stages()
        .iter()
        .position(|stage| stage.name == "contacts within pieces");
    for _ in 0..2000 {
        step(&mut state);
        assert!(listed_within(&state).is_empty());
    }
    let looked = state.scratch.clock.done(stage.unwrap());
    assert!(looked < 2000 * 216 / 10, "{looked} particles");
}

/// Spheres that overlap, of one piece, without a bond.
fn overlapping_within(state: &State) -> HashSet<[u32; 2]> {
    let of = &state.clusters.as_ref().unwrap().of_particle;
    let unbroken = (0..state.bonds.len()).filter(|&at| !state.bonds.is_broken(at));
    let bonded: HashSet<[u32; 2]> = unbroken.map(|at| state.bonds.ends[at]).collect();
    let poses = &state.particles.poses;
    let place = |i: u32| poses[i as usize].position_m[0];
    let mut along: Vec<u32> = (0..poses.len() as u32).collect();
    along.sort_by(|&a, &b| place(a).total_cmp(&place(b)));
    let near = along.iter().enumerate().flat_map(|(n, &a)| {
        let after = along[n + 1..].iter();
        let after = after.take_while(move |&&b| place(b) - place(a) < 2.0 * RADIUS_M);
        after.map(move |&b| [a.min(b), a.max(b)])
    });
    let overlap = |&[a, b]: &[u32; 2]| {
        of[a as usize] == of[b as usize]
            && !bonded.contains(&[a, b])
            && !bonded.contains(&[b, a])
            && overlap_m(poses, [a, b]) > 0.0
    };
    near.filter(overlap).collect()
}

/// While a body is crumpled and falls apart, every unbonded pair of one piece that overlaps is
/// listed before it does, so that only those that overlapped when their bond broke have an origin.
fn no_pair_is_missed(count: [usize; 3], end_s: f64, extra: &str) {
    let block = Block {
        count,
        distance_m: 2.05 * RADIUS_M,
        joins: |a, b| a[2] == b[2] || (a[0] + 2 * a[1]) % 3 == 0,
    };
    let floor = "walls.floor = { plane = { point = [0, 0, -2e-3], normal = [0.1, 0, 1] }, material = \"plate\" }";
    let mut state = block.state(
        "failure = { tensile_strength = \"0.5 MPa\" }",
        ", velocity = [20, 0, -8], angular_velocity = [0, 0, 100]",
        &format!("{floor}\n{extra}"),
    );
    let mut any = scattered();
    for motion in &mut state.particles.motions {
        let push = Vector3::new(any(), any(), any()) * 6.0;
        for k in 0..3 {
            motion.velocity_m_s[k] += push[k];
        }
    }
    let (mut touched, mut touched_whole) = (0, 0);
    while state.time_s < end_s {
        step(&mut state);
        let contacts = state.contacts.as_ref().unwrap();
        // Forces are those of the positions before the last drift.
        let listed: HashSet<[u32; 2]> = contacts.pairs.iter().copied().collect();
        let overlapping = overlapping_within(&state);
        let just_broken = state.scratch.events.broken.iter();
        let just_broken: HashSet<[u32; 2]> = just_broken
            .map(|broken| state.bonds.ends[broken.bond as usize])
            .collect();
        for &[a, b] in &overlapping {
            let is_just_broken = just_broken.contains(&[a, b]) || just_broken.contains(&[b, a]);
            assert!(
                listed.contains(&[a, b]) || is_just_broken,
                "{a} and {b} at step {}",
                state.steps
            );
        }
        let joined: HashSet<[u32; 2]> = state.bonds.ends.iter().copied().collect();
        for (pair, history) in contacts.pairs.iter().zip(&contacts.histories) {
            let [a, b] = *pair;
            let was_joined = joined.contains(pair) || joined.contains(&[b, a]);
            assert!(history.origin_m() == 0.0 || was_joined, "{pair:?}");
        }
        touched = touched.max(overlapping.len());
        if state.broken_count == 0 {
            touched_whole = touched;
        }
    }
    assert!(
        touched > 3 && touched_whole > 0,
        "{touched}, {touched_whole} before a bond broke"
    );
    assert!(state.broken_count > 20, "{}", state.broken_count);
}

#[test]
fn no_pair_of_a_crumpled_body_is_missed() {
    no_pair_is_missed([5, 5, 3], 3e-3, "");
}

/// The same in a body of more particles than one task handles, beside dust that hits it and dust
/// that leaves, so that particles are renumbered.
#[test]
fn no_pair_of_a_large_body_among_dust_is_missed() {
    let mut any = scattered();
    let mut dust = String::new();
    for (name, down) in [("hits", -30.0), ("leaves", 30.0)] {
        let _ = write!(
            dust,
            "bodies.{name} = {{ material = \"cake\", velocity = [0, 0, {down}], particles = ["
        );
        for n in 0..20 {
            let [x, y] = [14e-3 + 14e-3 * any(), 14e-3 + 14e-3 * any()];
            let z = 14e-3 + 4e-4 * f64::from(n) + if down > 0.0 { 8e-3 } else { 0.0 };
            let _ = write!(dust, "[{x:e}, {y:e}, {z:e}, 2e-4],");
        }
        dust += "] }\n";
    }
    let outlet = "regions.above = { box = { min = [-1, -1, 0.035], max = [1, 1, 1] } }\n\
                  outlets.out.inside = \"above\"\n";
    no_pair_is_missed([14, 14, 6], 1e-3, &(dust + outlet));
}

/// As in the thesis, if the scene asks for it.
#[test]
fn without_self_contact_no_pair_of_a_piece_is_listed() {
    let block = Block {
        count: [3, 3, 4],
        distance_m: 1.9 * RADIUS_M,
        joins: |a, b| [a[2], b[2]] != [1, 2] || a[0] == 0,
    };
    let mut state = block.state("", "", "clusters.self_contact = false");
    step(&mut state);
    assert!(listed_within(&state).is_empty());
    let mut state = block.state("", "", "");
    step(&mut state);
    assert_eq!(listed_within(&state).len(), 6);
}
