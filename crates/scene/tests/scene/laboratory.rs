//! Laboratory tests of scenes: `[test]`.

use dem_laboratory::TestType;
use dem_scene::read_scene;

use super::good::{assert_near, folder, good};

/// A measured material gives the reference values that the test does not.
#[test]
fn a_test_with_a_measured_material() {
    let file = folder().join("measured-test.toml");
    let read = |options: &[&str]| {
        let options: Vec<String> = options.iter().map(|option| (*option).to_owned()).collect();
        read_scene(&file, &options)
    };
    let scene = read(&[]).unwrap();
    let test = scene.test.as_ref().unwrap();
    assert_eq!(test.young_modulus_pa, Some(12.05e6));
    assert_eq!(test.strength_pa, Some(0.21e6));
    assert_eq!(test.measured.as_ref().unwrap().material.curve.len(), 2);
    assert!(
        scene
            .input_files()
            .contains(&folder().join("measured.json"))
    );
    let scene = read(&["test.strength=0.3 MPa"]).unwrap();
    assert_eq!(scene.test.unwrap().strength_pa, Some(0.3e6));
    let error = read(&["test.type=brazilian-disc"]).expect_err("another test");
    assert!(
        error.to_string().contains(
            "test.measured is of the type \"three-point-bending\", not \"brazilian-disc\"; name a material measured in the same test"
        ),
        "{error}"
    );
}

/// A measured file that the command line names stands above the targets of the scene, and one of
/// the scene does not; both are named. The scene of the run has the same targets.
#[test]
fn two_targets_are_named_and_the_command_line_wins() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(self::folder().join("measured-test.toml")).unwrap();
    let own = "young_modulus = \"9 MPa\"\nstrength = \"0.1 MPa\"\n";
    let without = text.replace("measured = \"measured.json\"\n", own);
    let json = self::folder().join("measured.json");
    std::fs::copy(&json, folder.path().join("measured.json")).unwrap();
    let read = |text: &str, options: &[&str]| {
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).unwrap();
        let options: Vec<String> = options.iter().map(|option| (*option).to_owned()).collect();
        let scene = read_scene(&path, &options).unwrap();
        let as_run = dem_scene::scene_as_run(text, &scene, &options, folder.path()).unwrap();
        std::fs::write(&path, as_run).unwrap();
        let again = read_scene(&path, &[]).unwrap().test.unwrap();
        let test = scene.test.unwrap();
        let targets =
            |test: &dem_scene::Test| [test.young_modulus_pa, test.strength_pa].map(Option::unwrap);
        assert_eq!(targets(&again), targets(&test));
        (targets(&test), scene.notes.join("\n"))
    };
    let option = format!("test.measured={}", json.display());
    let (targets, said) = read(&without, &[&option]);
    assert_eq!(targets, [12.05e6, 0.21e6]);
    assert_eq!(
        said.matches("given on the command line), and not test.")
            .count(),
        2,
        "{said}"
    );
    assert!(
        said.contains("the target is 12.05 MPa, measured ("),
        "{said}"
    );
    // A number of the command line stands above the file of the command line.
    let (targets, _) = read(&without, &[&option, "test.strength=0.3 MPa"]);
    assert_eq!(targets, [12.05e6, 0.3e6]);
    // Both in the scene: its numbers are meant, which is said.
    let (targets, said) = read(&(text + own), &[]);
    assert_eq!(targets, [9e6, 0.1e6]);
    assert!(
        said.contains("the target is test.young_modulus = 9 MPa, and not 12.05 MPa"),
        "{said}"
    );
    // The same numbers are no conflict.
    let same = without
        .replace("9 MPa", "12.05 MPa")
        .replace("0.1 MPa", "0.21 MPa");
    assert_eq!(read(&same, &[&option]).1, "");
    // A modulus of the scene that was not measured is named as the target.
    let mut material: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&json).unwrap()).unwrap();
    material["young_modulus_pa"] = serde_json::Value::Null;
    let no_modulus = folder.path().join("no-modulus.json");
    std::fs::write(&no_modulus, material.to_string()).unwrap();
    let (targets, said) = read(
        &without,
        &[&format!("test.measured={}", no_modulus.display())],
    );
    assert_eq!(targets, [9e6, 0.21e6]);
    let wanted = format!(
        "the target is test.young_modulus = 9 MPa: {} has no modulus",
        no_modulus.display()
    );
    assert!(said.contains(&wanted), "{said}");
}

/// A test determines the end of the run, and all its defaults are shown as text.
#[test]
fn a_laboratory_test() {
    let scene = good("bending-test.toml");
    assert_eq!(scene.run.end_time_s, f64::INFINITY);
    let test = scene.test.as_ref().unwrap();
    assert_eq!(test.kind, TestType::ThreePointBending);
    assert_eq!(
        (test.body.as_str(), test.crosshead.join(" ")),
        ("beam", "pin".to_owned())
    );
    assert_eq!((test.direction, test.stroke_m), ([0.0, 0.0, -1.0], 0.004));
    let text = scene.describe();
    assert!(
        text.starts_with("run.end_time                    that of the test\n"),
        "{text}"
    );
    let (_, of_test) = text.split_once("test.type").unwrap();
    let wanted = "\
three-point-bending
test.body                       beam
test.crosshead                  pin
test.direction                  [0, 0, -1]
test.stroke                     0.004 m
test.rate                       auto
test.periods                    20
test.rate_check                 true
test.young_modulus              none
test.poisson_ratio              0.3
test.strength                   none
test.measured                   none
test.support_span               measured on walls and body
test.width                      measured on walls and body
test.height                     measured on walls and body
";
    assert_eq!(of_test.trim_start(), wanted);

    let file = folder().join("bending-test.toml");
    let options = [
        "test.rate=2 mm/s",
        "test.type=compression",
        "test.area=9 cm2",
        "test.young_modulus=12 MPa",
        "run.end_time=3 s",
    ];
    let scene = read_scene(&file, &options.map(str::to_owned)).unwrap();
    let test = scene.test.as_ref().unwrap();
    assert_near(test.rate_m_s.unwrap(), 0.002);
    assert_near(test.area_m2.unwrap(), 0.0009);
    assert_near(test.young_modulus_pa.unwrap(), 12e6);
    assert_eq!(scene.run.end_time_s, 3.0);
    let text = scene.describe();
    let words: Vec<&str> = text.split_whitespace().collect();
    let words = words.join(" ");
    for line in [
        "test.area 0.0009 m2",
        "test.rate 0.002 m/s",
        "test.length measured on",
    ] {
        assert!(words.contains(line), "{line}: {text}");
    }
    assert!(!text.contains("test.support_span"));
}

#[test]
fn what_a_laboratory_test_is_told() {
    let test = good("four-point-test.toml").test.unwrap();
    assert_eq!((test.rate_m_s, test.periods), (Some(0.002), 5.0));
    assert!(!test.rate_check);
    assert_eq!(
        (test.young_modulus_pa, test.poisson_ratio),
        (Some(12e6), 0.25)
    );
    assert_eq!(test.strength_pa, Some(2e5));
    assert_eq!(
        (test.support_span_m, test.loading_span_m),
        (Some(2.0), Some(1.0))
    );
    assert_eq!((test.width_m, test.height_m), (Some(2.0), Some(2.0)));
    let test = good("compression-test.toml").test.unwrap();
    assert_eq!((test.length_m, test.area_m2), (Some(2.0), Some(3.1)));
}
