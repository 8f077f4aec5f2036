//! What bonds have been through goes from run to run: plastic deformation and hardening, and the
//! failed elements of flat joints.

use dem_engine::State;
use dem_io::Body;
use dem_io::body::{BondColumn, read_body, write_body};
use dem_plan::plan;
use dem_scene::{read_bodies, scene_from_text};
use nalgebra::Vector3;
use serde_json::Value;

use super::Bench;

const RADIUS_M: f64 = 1e-3;
const LENGTH_M: f64 = 2e-3;
const YOUNG_MODULUS_PA: f64 = 1e8;
const AREA_M2: f64 = std::f64::consts::PI * RADIUS_M * RADIUS_M;
/// Of every mode.
const YIELD_PA: f64 = 1e5;
const HARDENING: f64 = 0.2;

const ELASTIC_PLASTIC: &str = "plasticity = { normal_yield_strength = 1e5, shear_yield_strength = 1e5, torsion_yield_strength = 1e5, bending_yield_strength = 1e5, hardening_ratio = 0.2 }, failure = { tensile_strength = 1e9 }";

/// A pair of which the left end is held, and the right end follows `moved`, keys of its support.
fn pair(body: &str, bonds: &str, moved: &str) -> String {
    format!(
        "version = 1
run = {{ end_time = \"20 ms\" }}
materials.rock = {{ density = 2500 }}
bonds.rock = {{ young_modulus = {YOUNG_MODULUS_PA:e}, poisson_ratio = 0.25, damping = {{ damping_ratio = 0.3 }}, {bonds} }}
bodies.pair = {{ {body}, material = \"rock\", bonds = \"rock\" }}
groups = {{ left = {{ body = \"pair\", particles = [0] }}, right = {{ body = \"pair\", particles = [1] }} }}
supports.left = {{ group = \"left\", fixed = true }}
supports.right = {{ group = \"right\", {moved} }}
measures.pull = {{ of = \"right\", quantity = \"reaction_x\" }}
measures.turn = {{ of = \"right\", quantity = \"reaction_torque_z\" }}
measures.hardest = {{ of = \"right\", quantity = \"reaction_x\", statistic = \"largest\" }}
"
    )
}

const INLINE: &str = "particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3]], bond_list = [[0, 1]]";

/// Runs a scene, and writes what it leaves as a body if a file is named.
fn ran(bench: &Bench, text: &str, left: Option<&str>) -> Value {
    let file = bench.write("pair.toml", text);
    let options = ["--json", "--quiet", "--output", "out", "--force"];
    let results = serde_json::from_str(&bench.good(&file, &options)).unwrap();
    if let Some(name) = left {
        let done = super::dem_run()
            .current_dir(bench.path(""))
            .args(["fragment", "out", "--largest", "-o", name, "--quiet"])
            .status();
        assert!(done.unwrap().success());
    }
    results
}

fn measure(results: &Value, name: &str) -> f64 {
    results["measures"][name]["value"].as_f64().unwrap()
}

/// The state of a scene of the bench at its start.
fn state(bench: &Bench, text: &str) -> State {
    let path = bench.path("left.vtp");
    let text = text.replace("left.vtp", &path.display().to_string());
    let scene = scene_from_text(&text, "test.toml", &[]).unwrap();
    let planned = plan(&scene, read_bodies(&scene).unwrap(), 1, false);
    planned.unwrap_or_else(|error| panic!("{error}")).state
}

/// A bond is pulled beyond its strength and relieved. Pulled or pushed again in a run of its own,
/// it yields where it would have in the first one.
#[test]
fn a_bond_stays_as_hard_as_it_has_become() {
    let bench = Bench::new();
    let yields_m = YIELD_PA / YOUNG_MODULUS_PA * LENGTH_M;
    let moved = |table: &str| {
        format!(
            "fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], displacement = {{ x = {yields_m:e} }}, table = [{table}]"
        )
    };
    // In elongations at yield: to 4 and back to 3, which leaves 0.6 of the strength.
    let first = pair(
        INLINE,
        ELASTIC_PLASTIC,
        &moved("[0, 0], [5e-3, 4], [1e-2, 3]"),
    );
    let before = ran(&bench, &first, Some("left.vtp"));
    let kept_n = 0.6 * YIELD_PA * AREA_M2;
    let found_n = measure(&before, "pull");
    assert!((found_n / kept_n - 1.0).abs() < 1e-3, "{found_n} {kept_n}");
    let body = read_body(&bench.path("left.vtp")).unwrap();
    let plastic_m = body.history_of("plastic_elongation_m", 0)[0];
    // (1 - h) of what exceeds the elastic limit, h of the slope.
    let wanted_m = (1.0 - HARDENING) * 3.0 * yields_m;
    assert!((plastic_m / wanted_m - 1.0).abs() < 2e-3, "{plastic_m}");
    let stress_free_m = LENGTH_M + wanted_m;
    assert!((body.bond_lengths[0] / stress_free_m - 1.0).abs() < 1e-5);
    let mut forgetful = body.clone();
    forgetful.bond_histories.clear();
    let again = "file = \"left.vtp\"";
    for further in [2.0, -3.0] {
        let path = format!("[0, 0], [5e-3, 4], [1e-2, 3], [1.8e-2, {}]", 3.0 + further);
        let one = ran(&bench, &pair(INLINE, ELASTIC_PLASTIC, &moved(&path)), None);
        let second = pair(
            again,
            ELASTIC_PLASTIC,
            &moved(&format!("[0, 0], [1e-2, {further}]")),
        );
        write_body(&body, &bench.path("left.vtp")).unwrap();
        let two = ran(&bench, &second, None);
        let [wanted_n, found_n] = [&one, &two].map(|results| measure(results, "pull"));
        assert!(
            (found_n / wanted_n - 1.0).abs() < 1e-3,
            "{further}: {found_n} {wanted_n}"
        );
        let work = |results: &Value| results["balance"]["bond_plastic_j"].as_f64().unwrap();
        let found_j = work(&before) + work(&two);
        assert!(
            (found_j / work(&one) - 1.0).abs() < 1e-2,
            "{further}: {found_j}"
        );
        assert_eq!(two["yielded_bonds"], 1);
        // Without its history it yields at its first strength.
        write_body(&forgetful, &bench.path("left.vtp")).unwrap();
        let other_n = measure(&ran(&bench, &second, None), "pull");
        assert!(
            (other_n / wanted_n - 1.0).abs() > 0.2,
            "{further}: {other_n} {wanted_n}"
        );
    }
}

/// The body of a scene with this rotation about its file.
fn turned(axis: &str, degrees: f64) -> String {
    format!("file = \"left.vtp\", rotation = {{ axis = {axis}, angle = \"{degrees} deg\" }}")
}

const TURNS: [(&str, f64); 4] = [
    ("[1, 0, 0]", 0.0),
    ("[1, 0, 0]", 90.0),
    ("[0, 0, 1]", 180.0),
    ("[1, 2, 3]", 70.0),
];

/// The rotation of the frame of the first bond: halfway between those of its ends.
fn frame(state: &State) -> nalgebra::UnitQuaternion<f64> {
    let plastic = state.bonds.histories.plastics.first();
    let ends = [0, 1].map(|k| {
        let of_particle = state.particles.poses[state.bonds.ends[0][k] as usize].rotation();
        let turned = plastic.map_or([0.0, 0.0, 0.0, 1.0], |plastic| plastic.turned[k]);
        (of_particle * dem_physics::rotation::rotation(turned)).into_inner()
    });
    nalgebra::UnitQuaternion::new_normalize(ends[0] + ends[1])
}

/// The plastic part of bending and sliding turns with the body.
#[test]
fn plastic_bending_turns_with_the_body() {
    let bench = Bench::new();
    let moved = "fixed = [\"x\", \"y\", \"z\", \"rx\", \"ry\"], displacement = { rz = 0.03 }, ramp = \"10 ms\"";
    ran(
        &bench,
        &pair(INLINE, ELASTIC_PLASTIC, moved),
        Some("left.vtp"),
    );
    let body = read_body(&bench.path("left.vtp")).unwrap();
    let stored = |name: &str| body.history_of(name, 0);
    let [bend_rad, slip_m] = ["plastic_bend_rad", "plastic_slip_m"].map(stored);
    let work_j = stored("plastic_work_j")[0];
    assert!(bend_rad[2] > 1e-2 && work_j > 0.0, "{bend_rad:?} {work_j}");
    assert!(slip_m[1].abs() > 1e-7, "{slip_m:?}");
    let fixed = "fixed = true";
    for (axis, degrees) in TURNS {
        let state = state(
            &bench,
            &pair(&turned(axis, degrees), ELASTIC_PLASTIC, fixed),
        );
        let plastic = state.bonds.histories.plastics[0];
        let rotation = rotation(axis, degrees);
        // The particle that is first in the file may be the second of the bond.
        let along = Vector3::from(state.bonds.blocks[0].direction.map(|column| column[0]));
        let frame = frame(&state);
        let sign = (rotation * Vector3::x()).dot(&(frame * along)).signum();
        for (found, stored) in [(plastic.bend_rad, bend_rad), (plastic.slip_m, slip_m)] {
            let wanted = sign * (rotation * Vector3::from_column_slice(stored));
            let off = (frame * Vector3::from(found) - wanted).norm() / wanted.norm();
            assert!(
                off < 1e-12,
                "{degrees} degrees about {axis}: {found:?} {wanted:?}"
            );
        }
        assert_eq!(plastic.work_j, work_j);
    }
    // Bent on, it is harder than bent back: the difference is twice the back stress, as far as the
    // bond yields both ways.
    let bent = |angle: f64| {
        let moved = format!(
            "fixed = [\"x\", \"y\", \"z\", \"rx\", \"ry\"], displacement = {{ rz = {angle} }}, ramp = \"10 ms\""
        );
        measure(
            &ran(
                &bench,
                &pair("file = \"left.vtp\"", ELASTIC_PLASTIC, &moved),
                None,
            ),
            "turn",
        )
        .abs()
    };
    let [on, back] = [0.02, -0.02].map(bent);
    assert!(on > 1.2 * back, "{on} {back}");
}

/// The rotation of a body [`turned`] like this.
fn rotation(axis: &str, degrees: f64) -> nalgebra::UnitQuaternion<f64> {
    let entries: Vec<f64> = axis
        .trim_matches(['[', ']'])
        .split(", ")
        .map(|x| x.parse().unwrap())
        .collect();
    let about = nalgebra::Unit::new_normalize(Vector3::from_row_slice(&entries));
    nalgebra::UnitQuaternion::from_axis_angle(&about, degrees.to_radians())
}

const JOINT: &str = "model = \"flat-joint\", radial_elements = 2, circumferential_elements = 9, failure = { tensile_strength = 1e5, cohesion = 1e6, friction_angle = 0 }";

/// Bends a flat joint until some of its elements have failed, and returns the body.
fn cracked(bench: &Bench) -> Body {
    let moved = "fixed = [\"x\", \"y\", \"z\", \"rx\", \"ry\"], displacement = { rz = 0.004 }, ramp = \"10 ms\"";
    ran(bench, &pair(INLINE, JOINT, moved), Some("left.vtp"));
    read_body(&bench.path("left.vtp")).unwrap()
}

/// The elements that have failed are at the same places, however the body is turned.
#[test]
fn failed_elements_turn_with_the_body() {
    let bench = Bench::new();
    let body = cracked(&bench);
    let failed = body.history_of("failed_elements", 0);
    let count = failed.iter().filter(|failed| **failed == 1.0).count();
    assert!(failed.len() == 18 && (2..16).contains(&count), "{failed:?}");
    let mut first: Option<(Vector3<f64>, f64)> = None;
    for (axis, degrees) in TURNS {
        let state = state(&bench, &pair(&turned(axis, degrees), JOINT, "fixed = true"));
        let joint = &state.bonds.histories.joints[0];
        let rotation = rotation(axis, degrees);
        let gone = joint.elements.iter().filter(|element| !element.is_bonded);
        let middle: Vector3<f64> = gone.map(|element| Vector3::from(element.place_m)).sum();
        let middle = rotation.inverse() * (frame(&state) * middle);
        let fraction = joint.failed_fraction();
        let (wanted, part) = *first.get_or_insert((middle, fraction));
        // The face that opens as the right end turns about z.
        assert!(middle.y < -0.5 * RADIUS_M, "{middle}");
        assert!(
            (middle - wanted).norm() < 1e-9 * wanted.norm(),
            "{middle} {wanted}"
        );
        assert!((fraction - part).abs() < 1e-12);
    }
}

/// A joint that is cracked in part is softer and weaker in the next run, and its frames say so from
/// the start.
#[test]
fn a_joint_stays_as_cracked_as_it_is() {
    let bench = Bench::new();
    // Its bending is taken from it: only what has failed is left.
    let body = Body {
        turns_rad: Vec::new(),
        bond_directions: Vec::new(),
        ..cracked(&bench)
    };
    let elements = |name: &str| {
        let frames = super::names_in(&bench.path("out/frames"));
        let frame = if name == "last" {
            frames.last()
        } else {
            frames.first()
        };
        let frame = bench.path(&format!("out/frames/{}", frame.unwrap()));
        let arrays = dem_results::read_all_arrays(&frame).unwrap();
        arrays.get("CellData/failed_fraction").unwrap()[0]
    };
    let failed = elements("last");
    assert!((0.1..0.9).contains(&failed), "{failed}");
    let moved = "fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], displacement = { x = 4e-6 }, ramp = \"10 ms\"";
    let pulled = |body: &Body| {
        write_body(body, &bench.path("left.vtp")).unwrap();
        ran(&bench, &pair("file = \"left.vtp\"", JOINT, moved), None)
    };
    let cracked = pulled(&body);
    assert!((elements("first") - failed).abs() < 1e-12);
    let mut mended = body.clone();
    mended.bond_histories.clear();
    let whole = pulled(&mended);
    for results in [&cracked, &whole] {
        assert_eq!(results["broken_bonds"], 1);
    }
    let [left_n, all_n] = [&cracked, &whole].map(|results| measure(results, "hardest"));
    let wanted_n = 1e5 * AREA_M2;
    assert!((all_n / wanted_n - 1.0).abs() < 0.02, "{all_n} {wanted_n}");
    assert!(
        (left_n / all_n - (1.0 - failed)).abs() < 0.02,
        "{left_n} {all_n} {failed}"
    );
}

#[test]
fn bonds_with_a_history_need_a_kind_that_has_one() {
    let bench = Bench::new();
    cracked(&bench);
    let refused = |bonds: &str| {
        let text = pair("file = \"left.vtp\"", bonds, "fixed = true");
        bench.bad(&bench.write("bad.toml", text), &[], 2)
    };
    let said = refused("model = \"flat-joint\", failure = { tensile_strength = 1e5 }");
    assert!(
        said.contains("bond 0: elements of its flat joint of 18 have failed, and its kind of bonds has 36; give it the radial_elements"),
        "{said}"
    );
    let said = refused("failure = { tensile_strength = 1e5 }");
    assert!(
        said.contains("of 18 have failed, and its kind of bonds has 0"),
        "{said}"
    );
    let moved = "fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], displacement = { x = 8e-6 }, ramp = \"10 ms\"";
    ran(
        &bench,
        &pair(INLINE, ELASTIC_PLASTIC, moved),
        Some("left.vtp"),
    );
    let said = refused("failure = { tensile_strength = 1e5 }");
    assert!(
        said.contains("bond 0: it has yielded, and its kind of bonds has no plasticity; add a table plasticity to it"),
        "{said}"
    );
    let mut body = read_body(&bench.path("left.vtp")).unwrap();
    body.bond_histories = vec![BondColumn::new("history_other", 1, vec![1.0])];
    write_body(&body, &bench.path("left.vtp")).unwrap();
    let said = refused(ELASTIC_PLASTIC);
    assert!(
        said.contains("no kind of bonds has the history 'history_other'"),
        "{said}"
    );
    // Another format would lose it.
    let done = super::dem_run()
        .current_dir(bench.path(""))
        .args(["fragment", "out", "--largest", "-o", "left.csv"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("write a .vtp"), "{said}");
}

/// A bond is pulled at 10/s up to twice its static strength and at 1/s from there on. It keeps the
/// factor of 10/s, 3.5675 by eq. 20: through the end of a run that is taken further, and in a body
/// that a second run pulls at 1/s alone.
#[test]
fn a_bond_keeps_its_largest_factor_in_checkpoints_and_files() {
    const KEEPS: &str = "failure = { tensile_strength = 1e5, rate_strengthening = true, keeps_largest_factor = true }";
    let bench = Bench::new();
    let moved = "fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], velocity = { x = 0.02 }, table = [[0, 1], [2e-4, 1], [2.01e-4, 0.1]]";
    let run = "2 ms\", time_step = \"0.2 us";
    let scene = pair(INLINE, KEEPS, moved).replace("20 ms", run);
    let broke = || {
        let (_, rows) = super::table(&bench.path("out/events.csv"));
        let row = rows.iter().find(|row| row[2] == "bond_broken");
        row.map(|row| [1, 12, 13].map(|at| row[at].parse::<f64>().unwrap()))
    };
    let assert_broke = |wanted_s: f64| {
        let [time_s, rate_1_s, factor] = broke().unwrap();
        assert!((time_s - wanted_s).abs() < 2e-6, "{time_s} {wanted_s}");
        assert!((rate_1_s / 10.0 - 1.0).abs() < 1e-6, "{rate_1_s}");
        assert!((factor / 3.5675 - 1.0).abs() < 1e-6, "{factor}");
    };
    ran(&bench, &scene, None);
    // 2e-3 at 10/s, 5.5e-6 in the change of speed, the rest of 3.5675e-3 at 1/s.
    assert_broke(2.01e-4 + 1.5675e-3 - 5.5e-6);
    let whole = std::fs::read(bench.path("out/events.csv")).unwrap();
    let plot = std::fs::read_to_string(bench.path("out/plots/rate_strengthening.svg")).unwrap();
    assert!(plot.contains("1 broken") && plot.contains("10 1/s: 3.57"));

    ran(&bench, &scene.replace("2 ms", "1 ms"), Some("left.vtp"));
    assert_eq!(broke(), None);
    let left = read_body(&bench.path("left.vtp")).unwrap();
    let kept_1_s = left.history_of("history_largest_strain_rate_1_s", 0)[0];
    assert!((kept_1_s / 10.0 - 1.0).abs() < 1e-6, "{kept_1_s}");
    let further = [
        "--output",
        "out",
        "--resume",
        "--quiet",
        "--set",
        "run.end_time=2 ms",
    ];
    bench.good(&bench.path("pair.toml"), &further);
    assert_eq!(std::fs::read(bench.path("out/events.csv")).unwrap(), whole);

    // It was left at a strain of 2.8045e-3.
    let slow = "fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], velocity = { x = 0.002 }";
    let again = pair("file = \"left.vtp\"", KEEPS, slow).replace("20 ms", run);
    ran(&bench, &again, None);
    assert_broke(3.5675e-3 - 2.8045e-3);
    let forgets = again.replace(", keeps_largest_factor = true", "");
    let said = bench.bad(
        &bench.write("pair.toml", &forgets),
        &["--output", "out", "--force"],
        2,
    );
    assert!(
        said.contains("bond 0: it keeps the largest factor of its strain rates")
            && said.contains("give it keeps_largest_factor = true"),
        "{said}"
    );
}
