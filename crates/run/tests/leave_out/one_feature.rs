//! Scenes with one feature each: only that feature is active and stored, in addition to the
//! requirements of every such scene.

use super::{busy, go, planned, stored};
use dem_engine::state::State;
use dem_engine::step::{number_of, stages};

/// Moving spheres in a row, bonded to their neighbours unless `apart`; with further lines for the
/// body.
fn row(name: &str, y_m: f64, more: &str) -> String {
    format!(
        "[bodies.{name}]
particles = [[0, {y_m}, 0, 0.01], [0.02, {y_m}, 0, 0.01], [0.04, {y_m}, 0, 0.01]]
bond_list = [[0, 1], [1, 2]]
material = \"stuff\"
bonds = \"stiff\"
{more}\n"
    )
}

/// The scene of a row, with keys of the run, of the bonds, of the body, and tables.
fn scene(run: &str, bonds: &str, body: &str, tables: &str) -> String {
    format!(
        "version = 1
run = {{ end_time = 1{run} }}
materials.stuff = {{ density = 2500, young_modulus = 1e7 }}
bonds.stiff = {{ young_modulus = 1e7, poisson_ratio = 0.25{bonds} }}
{}{tables}",
        row("row", 0.0, &format!("angular_velocity = [0, 0, 1]\n{body}"))
    )
}

const MEETS: &str = "[contacts]\nstuff-stuff = { restitution = 0.5, friction = 0.3 }\n";
const ADHESION: &str = ", law = \"dmt\", work_of_adhesion = 0.05";
const FREE: [&str; 2] = ["bond forces", "motion"];
const RIGID: [&str; 2] = ["rigid clumps", "motion"];

/// As [`expect`], of bonded rows whose material has a contact with itself: it is known where their
/// spheres were.
fn expect_foldable(name: &str, text: &str, does: &[&str], stores: &[&str]) {
    expect(name, text, does, &with(stores, &["contacts within pieces"]));
}

/// Compares the active and the stored stages of a scene with the expected ones, in any order.
fn expect(name: &str, text: &str, does: &[&str], stores: &[&str]) {
    let (_, mut plan) = planned(text);
    go(&mut plan.state, 300);
    let sorted = |list: &[&str]| {
        let mut names: Vec<String> = list.iter().map(|name| (*name).to_owned()).collect();
        names.sort();
        names
    };
    assert_eq!(sorted(&busy(&plan.state)), sorted(does), "{name} does");
    assert_eq!(
        sorted(&stored(&plan.state)),
        sorted(stores),
        "{name} stores"
    );
    for stage in plan.stages.iter().filter(|stage| !stage.needed) {
        let left_out = stage.stage.name;
        assert!(
            !does.contains(&left_out),
            "{name}: {left_out} is said to be left out"
        );
    }
}

fn with<'a>(base: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [base, more].concat()
}

#[test]
fn of_bonds() {
    expect("a free row", &scene("", "", "", ""), &FREE, &FREE);
    expect(
        "histories",
        &scene("", ", formulation = \"incremental\"", "", ""),
        &["bond history", "motion"],
        &with(&FREE, &["bond history"]),
    );
    expect(
        "damping of bonds",
        &scene("", ", damping = { damping_ratio = 0.1 }", "", ""),
        &with(&FREE, &["bond damping"]),
        &with(&FREE, &["bond damping"]),
    );
    expect(
        "structural damping of bonds",
        &scene("", ", damping = { structural_damping = 0.1 }", "", ""),
        &with(&FREE, &["structural damping", "bond damping"]),
        &with(&FREE, &["structural damping", "bond damping"]),
    );
    expect(
        "failure",
        &scene("", ", failure = { tensile_strength = 1e12 }", "", ""),
        &with(&FREE, &["failure"]),
        &with(&FREE, &["cluster search"]),
    );
    expect(
        "fracture energy",
        &scene(
            "",
            ", failure = { tensile_strength = 1e6, fracture_energy = 1e9 }",
            "",
            "",
        ),
        &with(&FREE, &["failure"]),
        &with(&FREE, &["cluster search", "damage of bonds"]),
    );
    expect(
        "plasticity",
        &scene("", ", plasticity = { normal_yield_strength = 1e3 }", "", ""),
        &["elasto-plastic bonds", "motion"],
        &with(&FREE, &["elasto-plastic bonds"]),
    );
    expect(
        "flat joints",
        &scene("", ", model = \"flat-joint\"", "", ""),
        &["flat joints", "motion"],
        &with(&FREE, &["flat joints"]),
    );
    expect(
        "strength scatter",
        &scene(
            "",
            ", failure = { tensile_strength = 1e12, weibull_modulus = 5 }",
            "",
            "",
        ),
        &with(&FREE, &["failure", "strength scatter"]),
        &with(&FREE, &["cluster search", "strength scatter"]),
    );
    expect(
        "cohesion and friction angle",
        &scene(
            "",
            ", failure = { cohesion = 1e12, friction_angle = \"35 deg\" }",
            "",
            "",
        ),
        &with(&FREE, &["failure", "friction of bonds"]),
        &with(&FREE, &["cluster search"]),
    );
    let rate = ", failure = { tensile_strength = 1e12, rate_strengthening = true }";
    expect(
        "strength by rate, where no bond would break without it",
        &scene("", rate, "", ""),
        &with(&FREE, &["failure"]),
        &with(&FREE, &["cluster search"]),
    );
    expect(
        "strength by rate, where bonds would",
        &scene("", &rate.replace("1e12", "1"), "", ""),
        &with(&FREE, &["failure", "rate strengthening", "cluster search"]),
        &with(&FREE, &["cluster search"]),
    );
}

#[test]
fn of_what_acts_on_particles() {
    expect(
        "gravity",
        &scene(", gravity = [0, 0, -9.81]", "", "", ""),
        &with(&FREE, &["gravity"]),
        &FREE,
    );
    expect(
        "local damping",
        &scene(", local_damping = 0.1", "", "", ""),
        &with(&FREE, &["local damping"]),
        &with(&FREE, &["local damping"]),
    );
    expect(
        "a load",
        &scene(
            "",
            "",
            "",
            "[loads.push]\ngroup = \"row\"\nforce = [0, 0, 1]\n",
        ),
        &with(&FREE, &["loads"]),
        &with(&FREE, &["loads"]),
    );
    expect(
        "a support",
        &scene(
            "",
            "",
            "",
            "[supports.hold]\ngroup = \"row\"\nfixed = [\"z\"]\n",
        ),
        &with(&FREE, &["supports"]),
        &with(&FREE, &["supports"]),
    );
}

#[test]
fn of_what_touches() {
    let wall = |z_m: f64| {
        format!(
            "{MEETS}[walls.floor]\nplane = {{ point = [0, 0, {z_m}], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n"
        )
    };
    let searches = with(&FREE, &["neighbour search"]);
    expect_foldable(
        "a wall far away: one body that cannot break meets no other particle",
        &scene("", "", "", &wall(-1.0)),
        &searches,
        &with(&searches, &["walls"]),
    );
    expect_foldable(
        "a wall that is touched",
        &scene("", "", "", &wall(-0.01)),
        &with(&searches, &["walls"]),
        &with(&searches, &["walls"]),
    );
    let other = |y_m: f64, rolling: &str| {
        let meets = MEETS.replace(" }", &format!("{rolling} }}"));
        format!("{meets}{}", row("other", y_m, ""))
    };
    expect_foldable(
        "another body far away",
        &scene("", "", "", &other(1.0, "")),
        &searches,
        &searches,
    );
    let touches = with(&searches, &["particle contacts"]);
    expect_foldable(
        "another that is touched",
        &scene("", "", "", &other(0.02, "")),
        &touches,
        &touches,
    );
    expect_foldable(
        "rolling friction",
        &scene("", "", "", &other(0.02, ", rolling_friction = 0.1")),
        &with(&touches, &["rolling friction"]),
        &touches,
    );
    expect_foldable(
        "adhesion, which is a law of contacts and no stage",
        &scene("", "", "", &other(0.02, ADHESION)),
        &touches,
        &touches,
    );
    expect_foldable(
        "adhesion that nothing touches",
        &scene("", "", "", &other(1.0, ADHESION)),
        &searches,
        &searches,
    );
    let beside = "[relaxation]\nmin_overlap = 0\n";
    expect_foldable(
        "contacts beside bonds that nothing presses",
        &scene(
            "",
            ", contact_beside_bond = true",
            "",
            &format!("{MEETS}{beside}"),
        ),
        &searches,
        &touches,
    );
    expect_foldable(
        "none beside bonds: one body that cannot break meets nothing",
        &scene("", "", "", &format!("{MEETS}{beside}")),
        &searches,
        &searches,
    );
    let wet = ", liquid_bridge = { surface_tension = \"73 mN/m\", volume = \"1 mm3\" }";
    expect_foldable(
        "liquid that nothing touches",
        &scene("", "", "", &other(1.0, wet)),
        &searches,
        &searches,
    );
    expect_foldable(
        "liquid bridges",
        &scene("", "", "", &other(0.02, wet)),
        &with(&touches, &["liquid bridges"]),
        &with(&touches, &["liquid bridges"]),
    );
    expect_foldable(
        "sleep",
        &scene("", "", "", &format!("{}[sleep]\n", other(1.0, ""))),
        &with(&searches, &["sleep"]),
        &with(&searches, &["sleep"]),
    );
    // Neighbours overlap and are pulled apart.
    let tears = scene(
        "",
        ", failure = { tensile_strength = 10 }",
        "",
        &format!("{MEETS}[groups.end]\nbody = \"row\"\nparticles = [2]\n[loads.pull]\ngroup = \"end\"\nforce = [0.1, 0, 0]\n"),
    )
    .replace("0.02, 0, 0, 0.01", "0.019, 0, 0, 0.01");
    let parts = ["failure", "cluster search", "relaxation", "loads"];
    let all = with(&touches, &parts);
    let stores: Vec<&str> = all
        .iter()
        .filter(|s| !["failure", "relaxation"].contains(*s))
        .copied()
        .collect();
    expect_foldable("pieces that part while they overlap", &tears, &all, &stores);
}

/// Laws of other materials and keys of other bonds: with the same step, the same bits, items and
/// bytes.
#[test]
fn of_what_others_have() {
    let touching = format!("{MEETS}{}", row("other", 0.02, ""));
    let step = ", time_step = 1e-4";
    let plain = scene(step, "", "", &touching);
    let sticky = "materials.dust = { density = 2500, young_modulus = 1e7 }\n";
    let law = format!("dust-stuff = {{ restitution = 0.5{ADHESION} }}\n");
    let with_law = scene(
        step,
        "",
        "",
        &touching.replace(MEETS, &format!("{MEETS}{law}")),
    )
    .replace("bonds.stiff", &format!("{sticky}bonds.stiff"));
    same("adhesion of other materials", &plain, &with_law);
    let relaxed = format!("[relaxation]\nmin_overlap = 0\n{touching}");
    let plain = scene(step, "", "", &relaxed);
    let beside =
        "bonds.loose = { young_modulus = 1e7, poisson_ratio = 0.25, contact_beside_bond = true }\n";
    let with_key =
        scene(step, "", "", &relaxed).replace("[bodies.row]", &format!("{beside}[bodies.row]"));
    same("contacts beside other bonds", &plain, &with_key);
}

/// Compares the bits, the items of all stages and their bytes of two scenes.
fn same(name: &str, one: &str, other: &str) {
    let [one, other] = [one, other].map(|text| {
        let (_, mut plan) = planned(text);
        go(&mut plan.state, 300);
        plan.state
    });
    assert!(one.particles.poses == other.particles.poses, "{name}");
    assert!(one.particles.motions == other.particles.motions, "{name}");
    for stage in stages() {
        let done = |state: &State| state.scratch.clock.done(number_of(stage));
        assert_eq!(done(&one), done(&other), "{name}: {}", stage.name);
        let bytes = |state: &State| (stage.bytes)(state);
        assert_eq!(bytes(&one), bytes(&other), "{name}: {}", stage.name);
    }
}

#[test]
fn of_rigid_bodies() {
    let clump = |tables: &str| scene("", "", "start_as = \"clump\"", tables);
    expect("a clump", &clump(""), &["rigid clumps"], &RIGID);
    let when = "[replacement.row]\nwhen = { time = 0.9 }\n";
    expect(
        "a clump that waits to be replaced",
        &clump(when),
        &["rigid clumps", "replacement"],
        &RIGID,
    );
    let floor = format!(
        "{MEETS}[walls.floor]\nplane = {{ point = [0, 0, -0.00999], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n"
    );
    let lying = |when: &str| {
        let tables = format!("{floor}[replacement.row]\nwhen = {{ {when} }}\n");
        scene(
            ", initial_overlap = \"keep\"",
            "",
            "start_as = \"clump\"",
            &tables,
        )
    };
    let touches = ["neighbour search", "walls"];
    let waits = with(&["rigid clumps", "replacement"], &touches);
    expect(
        "a clump on a floor, whose trigger reads no contacts",
        &lying("time = 0.9"),
        &waits,
        &with(&RIGID, &touches),
    );
    expect(
        "a clump on a floor, whose trigger reads its contacts",
        &lying("principal_stress = 1e9"),
        &with(&waits, &["squeeze of clumps"]),
        &with(&RIGID, &touches),
    );
    let bits = "[bodies.bits]\nparticles = [[0, 0, 0, 1], [1, 0, 0, 1]]\nmaterial = \"stuff\"\n\
                [replacement.row.daughters]\nclasses = [{ from = 1e9, body = \"bits\" }]\n";
    expect(
        "a clump that daughters can replace",
        &clump(bits),
        &["rigid clumps", "daughters"],
        &RIGID,
    );
    let region = "[regions.part]\nbox = { min = [5, 5, 5], max = [6, 6, 6] }\n";
    expect(
        "a body that is bonded nowhere",
        &scene("", "", "bonded_within = { region = \"part\" }", region),
        &["motion", "rigid parts", "bonded zones"],
        &with(&FREE, &["rigid parts"]),
    );
    expect(
        "an outlet",
        &scene(
            "",
            "",
            "",
            &format!("{region}[outlets.out]\ninside = \"part\"\n"),
        ),
        &with(&FREE, &["inlets and outlets"]),
        &FREE,
    );
}
