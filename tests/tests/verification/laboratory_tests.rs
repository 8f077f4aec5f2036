//! Laboratory tests of regular specimens, run by the program: triaxial compression, direct shear, a
//! dog bone, and the stress in a disc.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::Value;

use super::page::{assert_shown, filled};
use super::table::{Case, compared};
use crate::dem_run;

/// Radius of every sphere, m.
const RADIUS_M: f64 = 1e-3;
const DIAMETER_M: f64 = 2.0 * RADIUS_M;
/// Modulus of bonds and contacts: so high that nothing turns before it breaks.
const YOUNG_PA: f64 = 1e12;
/// Friction angle of the bonds that break by Mohr-Coulomb, degrees, and their cohesion.
const FRICTION_DEG: f64 = 30.0;
const COHESION_PA: f64 = 0.5e6;
/// Friction of contacts.
const FRICTION: f64 = 0.3;

type Place = [f64; 3];

/// The bonds between spheres that touch.
fn touching(places: &[Place]) -> Vec<[usize; 2]> {
    let reach_m = 1.001 * DIAMETER_M;
    let mut bonds = Vec::new();
    for (j, b) in places.iter().enumerate() {
        let near = |a: &Place| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt() < reach_m;
        let before = places[..j].iter().enumerate();
        bonds.extend(before.filter(|(_, a)| near(a)).map(|(i, _)| [i, j]));
    }
    bonds
}

/// Contacts of this friction.
fn contact(friction: f64) -> String {
    format!("restitution = 0.5, friction = {friction}")
}

/// A scene with one body, its contacts, the failure of its bonds, and the rest.
fn scene(
    places: &[Place],
    bonds: &[[usize; 2]],
    contact: &str,
    failure: &str,
    rest: &str,
) -> String {
    let spheres = places
        .iter()
        .map(|[x, y, z]| format!("[{x:e}, {y:e}, {z:e}, {RADIUS_M}]"));
    let spheres: Vec<String> = spheres.collect();
    let bonds: Vec<String> = bonds.iter().map(|[i, j]| format!("[{i}, {j}]")).collect();
    format!(
        r#"
        version = 1
        run.safety_factor = 0.5
        contacts.rock-rock = {{ {contact} }}
        [materials.rock]
        density = 2600
        young_modulus = {YOUNG_PA:e}
        poisson_ratio = 0.25
        [bonds.rock]
        model = "shear-coefficient"
        young_modulus = {YOUNG_PA:e}
        poisson_ratio = 0.25
        damping.damping_ratio = 0.3
        {failure}
        [bodies.specimen]
        particles = [{}]
        bond_list = [{}]
        material = "rock"
        bonds = "rock"
        {rest}
        "#,
        spheres.join(", "),
        bonds.join(", "),
    )
}

/// Planes that touch the box around the spheres, with their normals along an axis.
fn planes(places: &[Place], named: &[(&str, usize, f64)]) -> String {
    let plane = |(name, axis, towards): &(&str, usize, f64)| {
        let ends = places.iter().map(|place| towards * place[*axis]);
        let mut point = [0.0; 3];
        point[*axis] = towards * (ends.fold(f64::INFINITY, f64::min) - RADIUS_M);
        let mut normal = [0.0; 3];
        normal[*axis] = *towards;
        format!(
            "[walls.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"rock\"\n"
        )
    };
    named.iter().map(plane).collect()
}

/// Plates above and below, walls on both sides along these axes, and the triaxial test with them,
/// with this pressure, area and [stroke, periods].
fn triaxial(
    places: &[Place],
    sides: &[usize],
    pressure: &str,
    area_m2: f64,
    [stroke, periods]: [&str; 2],
) -> String {
    const SIDES: [[&str; 2]; 2] = [["left", "right"], ["front", "back"]];
    let mut named = vec![("below", 2, 1.0), ("above", 2, -1.0)];
    for &axis in sides {
        named.extend([(SIDES[axis][0], axis, 1.0), (SIDES[axis][1], axis, -1.0)]);
    }
    let lateral: Vec<&str> = named[2..].iter().map(|(name, _, _)| *name).collect();
    format!(
        r#"
        {}
        [test]
        type = "triaxial-compression"
        crosshead = ["above"]
        direction = [0, 0, -1]
        lateral_walls = {lateral:?}
        confining_pressure = "{pressure}"
        area = {area_m2:e}
        stroke = "{stroke}"
        periods = {periods}
        rate_check = false
        "#,
        planes(places, &named)
    )
}

fn run(folder: &Path, scene: &str) -> Value {
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    answer(folder, &["scene.toml", "--json", "--quiet"])
}

/// What a study of a scene answers that varies a pressure of its test.
fn sweep(folder: &Path, scene: &str, path: &str, pressures: &[&str], result: &str) -> Value {
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    let study = format!(
        "version = 1\nscene = \"scene.toml\"\n[vary]\n\"{path}\" = {pressures:?}\n[measures.peak]\ntest_result = \"{result}\"\n"
    );
    std::fs::write(folder.join("study.toml"), study).unwrap();
    answer(folder, &["sweep", "study.toml", "--json", "--quiet"])
}

fn answer(folder: &Path, options: &[&str]) -> Value {
    let output = dem_run()
        .current_dir(folder)
        .args(options)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn figure<'a>(summary: &'a Value, name: &str) -> &'a Value {
    let figures = summary["test"]["results"].as_array().unwrap();
    let found = figures.iter().find(|figure| figure["name"] == name);
    found.unwrap_or_else(|| panic!("{name} in {figures:?}"))
}

fn value(summary: &Value, name: &str) -> f64 {
    figure(summary, name)["value"].as_f64().unwrap()
}

/// Cases of one quantity in ever finer bodies, each with the number of spheres across it: from one
/// to the next the error must fall by at least half of the fraction by which the size of a sphere
/// over that of the body does. The coarsest has no bound.
fn converging(cases: Vec<(f64, Case)>) -> Vec<Case> {
    let mut bound = (f64::INFINITY, 1.0);
    let bounded = |(across, case): (f64, Case)| {
        let (before, across_before) = bound;
        bound = (case.error().abs(), across);
        case.within(before * 0.5 * (1.0 + across_before / across))
    };
    cases.into_iter().map(bounded).collect()
}

/// Widths of the bars of a face-centred lattice, in cells.
const CELLS: [usize; 3] = [3, 4, 6];

/// Elastic constants of bars of a face-centred lattice, ever wider.
fn elastic(folder: &Path) -> Vec<Case> {
    let of_bars = CELLS.map(|cells| cubic(cells, folder));
    let mut cases = Vec::new();
    for (at, name) in ["Young's modulus, GPa", "Poisson's ratio"]
        .into_iter()
        .enumerate()
    {
        let what =
            |cells: usize| format!("lattice of {cells} x {cells} x {} cells: {name}", 2 * cells);
        let with_size = CELLS.iter().zip(&of_bars).map(|(&cells, found)| {
            let [computed, reference] = found[at];
            let case = Case::new(what(cells), computed, reference, f64::INFINITY);
            (cells as f64, case)
        });
        cases.extend(converging(with_size.collect()));
    }
    let deviations = CELLS.iter().zip(&of_bars).map(|(cells, found)| {
        let what = format!(
            "lattice of {cells} x {cells} x {} cells: deviation of the lateral pressure",
            2 * cells
        );
        Case::of_scale(what, found[2], 1.0, 0.01)
    });
    cases.extend(deviations);
    cases
}

/// A bar of a face-centred lattice, `cells` wide and twice as high, its bonds without failure:
/// Young's modulus in GPa, Poisson's ratio and the deviation of the lateral pressure, computed and
/// expected.
fn cubic(cells: usize, folder: &Path) -> [[f64; 2]; 3] {
    let half_m = DIAMETER_M / 2.0_f64.sqrt();
    let mut places = Vec::new();
    for i in 0..=2 * cells {
        for j in 0..=2 * cells {
            let even = (0..=4 * cells).filter(|k| (i + j + k) % 2 == 0);
            places.extend(even.map(|k| [i, j, k].map(|n| half_m * n as f64)));
        }
    }
    let bonds = touching(&places);
    // Of the section through the bonds between two layers, a cell has eight.
    let middle_m = half_m * (cells as f64 + 0.5);
    let is_cut =
        |[i, j]: &&[usize; 2]| (places[*i][2] - middle_m) * (places[*j][2] - middle_m) < 0.0;
    let cut = bonds.iter().filter(is_cut).count() as f64;
    let area_m2 = cut / 8.0 * (2.0 * half_m).powi(2);
    let rest = triaxial(&places, &[0, 1], "1 MPa", area_m2, ["0.2 um", "40"]);
    // As stiff as the bonds, so that the plates press the ends evenly.
    let stiff =
        "law = \"linear\", normal_stiffness = \"1000 MN/m\", restitution = 0.5, friction = 0";
    let found = run(folder, &scene(&places, &bonds, stiff, "", &rest));
    // Stiffnesses of a bond, and the constants of the lattice.
    let normal = YOUNG_PA * PI * RADIUS_M.powi(2) / DIAMETER_M;
    let shear = 0.9 * normal / 2.5;
    let c11 = 2.0_f64.sqrt() / DIAMETER_M * (normal + shear);
    let c12 = 0.5_f64.sqrt() / DIAMETER_M * (normal - shear);
    let modulus_pa = c11 - 2.0 * c12 * c12 / (c11 + c12);
    [
        [1e-9 * value(&found, "specimen modulus"), 1e-9 * modulus_pa],
        [value(&found, "Poisson's ratio"), c12 / (c11 + c12)],
        [value(&found, "deviation of the lateral pressure"), 0.0],
    ]
}

/// Two halves of nine spheres each, joined by one bond along the normal of a plane that is inclined
/// by 45° + phi/2: statics alone give its force. Axial stresses at failure, cohesion and angle.
fn plane_of_weakness(folder: &Path) -> (String, String) {
    let angle = (45.0 + 0.5 * FRICTION_DEG).to_radians();
    let (far_m, aside_m) = (8.0 * RADIUS_M, 1.5 * RADIUS_M);
    let mut upper = vec![[-RADIUS_M * angle.sin(), 0.0, RADIUS_M * angle.cos()]];
    for [a, b] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        upper.push([a * aside_m, b * aside_m, far_m]);
        upper.push([-far_m, a * aside_m, b * aside_m]);
    }
    let lower = upper.iter().map(|place| place.map(|x| -x));
    let places: Vec<Place> = upper.iter().copied().chain(lower).collect();
    let half = upper.len();
    let mut bonds = vec![[0, half]];
    bonds.extend((1..half).flat_map(|i| [[0, i], [half, half + i]]));
    // The pressure acts on the box around the spheres; the section is such that both stresses act
    // on one plane.
    let [high_m, deep_m] = [far_m, aside_m].map(|half| 2.0 * (half + RADIUS_M));
    let side_m2 = high_m * deep_m;
    let area_m2 = side_m2 / angle.tan();
    let rest = triaxial(&places, &[0], "20 kPa", area_m2, ["1.5 um", "100"]);
    let text = scene(&places, &bonds, &contact(0.0), &mohr_coulomb(), &rest);
    let pressures = [20e3, 50e3, 100e3];
    let named = ["20 kPa", "50 kPa", "100 kPa"];
    let found = sweep(
        folder,
        &text,
        "test.confining_pressure",
        &named,
        "axial stress at failure",
    );
    let cohesion_pa = COHESION_PA * PI * RADIUS_M.powi(2) * angle.sin() / side_m2;
    let of = |(at, pressure_pa): (usize, f64)| {
        let computed_pa = found["runs"][at]["results"][0]["value"].as_f64().unwrap();
        let friction = FRICTION_DEG.to_radians();
        let reference_pa = plane_of_weakness_pa(cohesion_pa, friction, angle, pressure_pa);
        let what = format!("confining pressure {}", named[at]);
        Case::new(what, 1e-3 * computed_pa, 1e-3 * reference_pa, 0.01)
    };
    let cases: Vec<Case> = pressures.into_iter().enumerate().map(of).collect();
    let line = line_of(&found, "joint in triaxial compression", cohesion_pa);
    (compared("axial stress at failure", "kPa", &cases), line)
}

/// Largest principal stress, Pa, at which a plane of weakness slides whose normal is inclined by
/// `angle_rad` to it: sigma_1 = sigma_3 + 2 (c + sigma_3 tan phi)/((1 - tan phi cot beta) sin 2
/// beta) (Jaeger, Cook and Zimmerman 2007, section 4.8).
fn plane_of_weakness_pa(
    cohesion_pa: f64,
    friction_angle_rad: f64,
    angle_rad: f64,
    confining_pa: f64,
) -> f64 {
    let friction = friction_angle_rad.tan();
    let resistance = 2.0 * (cohesion_pa + confining_pa * friction);
    confining_pa + resistance / ((1.0 - friction / angle_rad.tan()) * (2.0 * angle_rad).sin())
}

fn mohr_coulomb() -> String {
    format!("failure = {{ cohesion = {COHESION_PA:e}, friction_angle = \"{FRICTION_DEG} deg\" }}")
}

/// Cohesion and friction angle that a study has found.
fn line_of(found: &Value, what: &str, cohesion_pa: f64) -> String {
    let line = &found["failure_line"];
    let number = |key: &str| line[key].as_f64().unwrap();
    let cases = [
        Case::new(
            format!("{what}: cohesion, kPa"),
            1e-3 * number("cohesion_pa"),
            1e-3 * cohesion_pa,
            0.02,
        ),
        Case::new(
            format!("{what}: friction angle, degrees"),
            number("friction_angle_deg"),
            FRICTION_DEG,
            0.02,
        ),
    ];
    compared("line through the strengths", "", &cases)
}

/// Two layers of nine spheres, one slid along the other: peaks, residual stresses, and the line.
fn sheared(folder: &Path) -> (String, String) {
    let layer = |z: f64| {
        let at = move |n: usize| [DIAMETER_M * (n / 3) as f64, DIAMETER_M * (n % 3) as f64, z];
        (0..9).map(at)
    };
    let places: Vec<Place> = layer(0.0).chain(layer(DIAMETER_M)).collect();
    let numbers = |from: usize| (from..from + 9).collect::<Vec<usize>>();
    let area_m2 = 9.0 * PI * RADIUS_M.powi(2);
    let rest = format!(
        r#"
        [groups]
        lower = {{ particles = {:?} }}
        upper = {{ particles = {:?} }}
        [supports]
        lower = {{ group = "lower", fixed = true }}
        [test]
        type = "direct-shear"
        crosshead = ["upper"]
        direction = [1, 0, 0]
        normal = [0, 0, -1]
        normal_stress = "0.2 MPa"
        area = {area_m2:e}
        stroke = "0.012 um"
        periods = 500
        rate_check = false
        "#,
        numbers(0),
        numbers(9)
    );
    let text = scene(
        &places,
        &touching(&places),
        &contact(FRICTION),
        &mohr_coulomb(),
        &rest,
    );
    let named = ["0.2 MPa", "0.5 MPa", "1 MPa"];
    let stresses = [0.2e6, 0.5e6, 1e6];
    let found = sweep(folder, &text, "test.normal_stress", &named, "strength");
    let mut cases = Vec::new();
    for (at, normal_pa) in stresses.into_iter().enumerate() {
        let peak_pa = found["runs"][at]["results"][0]["value"].as_f64().unwrap();
        let wanted_pa = COHESION_PA + normal_pa * FRICTION_DEG.to_radians().tan();
        let what = format!("normal stress {}: peak", named[at]);
        cases.push(Case::new(what, 1e-6 * peak_pa, 1e-6 * wanted_pa, 0.01));
        // Friction needs a longer way, on which the peak would be too short to see.
        let scene = text.replace(
            "normal_stress = \"0.2 MPa\"",
            &format!("normal_stress = {normal_pa:e}"),
        );
        let scene = scene
            .replace("0.012 um", "0.3 um")
            .replace("periods = 500", "periods = 2000");
        let residual_pa = value(&run(folder, &scene), "residual strength");
        let what = format!("normal stress {}: residual", named[at]);
        cases.push(Case::new(
            what,
            1e-6 * residual_pa,
            1e-6 * FRICTION * normal_pa,
            0.01,
        ));
    }
    let line = line_of(&found, "two layers in direct shear", COHESION_PA);
    (compared("shear stress", "MPa", &cases), line)
}

/// A neck of one row of spheres between two cubes of 27: its strength is that of its bonds.
fn dog_bone(folder: &Path) -> String {
    let mut places: Vec<Place> = Vec::new();
    for z in 0..13 {
        let is_end = !(3..10).contains(&z);
        let across = if is_end { 0..9 } else { 4..5 };
        places.extend(across.map(|n| {
            let [x, y] = [n / 3, n % 3].map(|i| DIAMETER_M * (f64::from(i) - 1.0));
            [x, y, DIAMETER_M * f64::from(z)]
        }));
    }
    let ends = |low: f64, high: f64| {
        let places = places.iter().enumerate();
        let inside = places.filter(|(_, place)| (low..high).contains(&(place[2] / DIAMETER_M)));
        inside.map(|(at, _)| at).collect::<Vec<usize>>()
    };
    let rest = |length_mm: f64| {
        format!(
            r#"
            [groups]
            low = {{ particles = {:?} }}
            high = {{ particles = {:?} }}
            [supports]
            low = {{ group = "low", fixed = ["z"] }}
            [test]
            type = "dog-bone"
            crosshead = ["high"]
            direction = [0, 0, 1]
            length = "{length_mm} mm"
            area = {:e}
            stroke = "1 um"
            periods = 400
            rate_check = false
            "#,
            ends(0.0, 0.5),
            ends(11.5, 13.0),
            PI * RADIUS_M.powi(2)
        )
    };
    let failure = "failure.tensile_strength = \"5 MPa\"";
    let text = |length_mm: f64| {
        scene(
            &places,
            &touching(&places),
            &contact(0.0),
            failure,
            &rest(length_mm),
        )
    };
    let found = run(folder, &text(16.0));
    let says = |found: &Value| {
        found["verdict"]["warnings"]
            .to_string()
            .contains("fails outside the neck")
    };
    assert!(!says(&found), "{}", found["verdict"]);
    // The same body with a neck that is said to be shorter breaks outside it.
    let outside = run(folder, &text(4.0));
    assert!(says(&outside), "{}", outside["verdict"]);
    let cases = [
        Case::new("strength, MPa", 1e-6 * value(&found, "strength"), 5.0, 0.02),
        Case::new(
            "modulus of the neck, GPa",
            1e-9 * value(&found, "specimen modulus"),
            1e-9 * YOUNG_PA,
            0.02,
        ),
    ];
    compared("dog bone", "", &cases)
}

/// Stresses of a disc of a triangular lattice, `spheres` across.
fn disc(spheres: usize, folder: &Path) -> [Case; 2] {
    let radius_m = RADIUS_M * spheres as f64;
    let row_m = 3.0_f64.sqrt() * RADIUS_M;
    let reach = spheres as i64;
    let mut places: Vec<Place> = Vec::new();
    for j in -reach..=reach {
        let shift_m = if j % 2 == 0 { 0.0 } else { RADIUS_M };
        let row =
            (-reach..=reach).map(|i| [DIAMETER_M * i as f64 + shift_m, 0.0, row_m * j as f64]);
        places.extend(row.filter(|[x, _, z]| x.hypot(*z) <= radius_m - RADIUS_M * 0.999));
    }
    // Narrow jaws press one sphere, or two, as a force in a point would.
    let half_m = 1.2 * RADIUS_M;
    let high_m = places.iter().map(|place| place[2]).fold(0.0, f64::max) + RADIUS_M;
    let jaw = |name: &str, low_m: f64| {
        let [min, max] = [
            [-half_m, -half_m, low_m],
            [half_m, half_m, low_m + RADIUS_M],
        ];
        format!("[walls.{name}]\nbox = {{ min = {min:?}, max = {max:?} }}\nmaterial = \"rock\"\n")
    };
    let walls = jaw("below", -high_m - RADIUS_M) + &jaw("above", high_m);
    let rest = format!(
        r#"
        {walls}
        [test]
        type = "brazilian-disc"
        crosshead = ["above"]
        direction = [0, 0, -1]
        stroke = "2 um"
        periods = 10
        rate_check = false
        "#
    );
    let found = run(
        folder,
        &scene(&places, &touching(&places), &contact(0.0), "", &rest),
    );
    DISC_STRESSES.map(|name| {
        let figure = figure(&found, name);
        let number = |key: &str| 1e-3 * figure[key].as_f64().unwrap();
        let what = format!("{spheres} spheres: {name}");
        Case::new(what, number("value"), number("theory"), f64::INFINITY)
    })
}

const DISC_STRESSES: [&str; 2] = [
    "stress across the loaded diameter",
    "stress along it in the centre",
];

/// Numbers of spheres across the discs.
const ACROSS: [usize; 3] = [15, 31, 47];

/// Stresses of ever finer discs.
fn discs(folder: &Path) -> Vec<Case> {
    let found = ACROSS.map(|across| disc(across, folder));
    let of_name = |at: usize| {
        let sizes = ACROSS.iter().zip(&found);
        let sizes = sizes.map(|(across, cases)| (*across as f64, cases[at].clone()));
        converging(sizes.collect())
    };
    [of_name(0), of_name(1)].concat()
}

#[test]
fn laboratory_tests_are_as_on_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (peaks, triaxial_line) = plane_of_weakness(folder);
    std::fs::remove_dir_all(folder.join("study-sweep")).unwrap();
    let (sheared, shear_line) = sheared(folder);
    let tables = [
        ("elastic", compared("body", "", &elastic(folder))),
        ("peaks", peaks),
        ("triaxial line", triaxial_line),
        ("sheared", sheared),
        ("shear line", shear_line),
        ("dog bone", dog_bone(folder)),
        ("disc", compared("disc", "kPa", &discs(folder))),
    ];
    let page = filled(include_str!("laboratory-tests.md"), &tables);
    assert_shown(&[("laboratory-tests.md".to_owned(), page)]);
}
