//! Studies: valid contents, refusals, and scenes written with their values.

mod designs;
mod probabilities;
mod searches;

use std::path::Path;

use dem_scene::study::{
    Combine, DischargeFigure, MeasureOf, Reference, Study, reference_values, rewritten, scene_with,
    settle_references, study_from_text,
};

const HEAD: &str = "version = 1\nscene = \"bar.toml\"\n";
const TIP: &str = "[measures.tip]\n";

const SCENE: &str = r#"# A bar.
version = 1

[run]
end_time = "1 s"    # long
safety_factor = 0.9

[materials.steel]
density = 7850

[bonds.steel]
young_modulus = "200 GPa"
poisson_ratio = 0.3
damping = { damping_ratio = 0.1 }

[bodies.bar]
material = "steel"
bonds = "steel"
particles = [
    [0, 0, 0, 0.2],
    [0.4, 0, 0, 0.2],
]
bond_list = [[0, 1]]

[groups.tip]
particles = [1]

[measures.tip]
of = "tip"
quantity = "displacement_y"
"#;

fn study(rest: &str) -> Study {
    study_from_text(&format!("{HEAD}{rest}"), "study.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> String {
    let error = study_from_text(text, "study.toml").unwrap_err();
    assert_eq!(error.exit_code(), 2);
    error.to_string()
}

fn labels(study: &Study, axis: usize) -> Vec<&str> {
    let values = study.axes[axis].values.iter();
    values.map(|value| value.label.as_str()).collect()
}

#[test]
fn every_key_is_read() {
    let text = include_str!("studies/every-key.toml");
    let study = study_from_text(text, "every-key.toml").unwrap();
    assert_eq!((study.repeats(), study.threads), (2, 2));
    assert!(study.force_step);
    assert_eq!(study.combine, Combine::Paired);
    assert_eq!(study.axes[1].sizes(), Some(vec![1e-7, 1e-6, 1e-5]));
    assert_eq!(labels(&study, 2), ["T", "P", "E"]);
    assert_eq!(study.axes[2].sizes(), Some(vec![3.0, 2.0, 1.0]));
    let value = Reference::Value("2 mm".to_owned());
    assert_eq!(study.measures[0].reference, value);
    assert_eq!(study.series, Some(2));
}

#[test]
fn a_study_is_read() {
    let study = study(
        r#"
repeats = 5
combine = "paired"
[set]
"run.end_time" = "0.1 s"
[vary]
"run.safety_factor" = [0.9, 0.5, 0.25]
"run.time_step" = { from = "1e-7 s", to = "1e-5 s", count = 3, spacing = "log" }
"bonds.beam.model" = { values = ["timoshenko", "parallel", "elastic-solid"], names = ["T", "P", "E"] }
"body.bar" = { values = ["a/bar-5.csv", "a/bar-10.csv", "a/bar-20.csv"], size = ["0.8 m", "40 cm", 0.2] }
[together.load]
"loads.tip.force" = [[0, "1 N", 0], [0, 2, 0], [0, 3, 0]]
"loads.tip.ramp" = ["1 s", "2 s", "3 s"]
[measures.tip]
reference = { richardson = "body.bar" }
[measures.first]
measure = "tip"
reference = { value = "-8.5 mm" }
[measures.energy]
balance = "energy"
[measures.stiff]
test_result = "specimen stiffness"
[measures.fine]
reference = { finest = "run.time_step" }
[page]
series = "load"
"#,
    );
    assert_eq!((study.repeats(), study.threads), (5, 1));
    assert_eq!(study.combine, Combine::Paired);
    assert_eq!(study.fixed[0].value, "\"0.1 s\"");
    assert_eq!(study.fixed[0].place, "study.toml:7");
    assert_eq!(study.axes.len(), 5);
    assert_eq!(labels(&study, 0), ["0.9", "0.5", "0.25"]);
    assert_eq!(study.axes[0].sizes().unwrap(), [0.9, 0.5, 0.25]);
    assert_eq!(labels(&study, 1), ["1e-7 s", "1e-6 s", "1e-5 s"]);
    assert_eq!(study.axes[1].values[1].settings[0].value, "\"1e-6 s\"");
    assert_eq!(labels(&study, 2), ["T", "P", "E"]);
    assert_eq!(study.axes[2].sizes(), None);
    assert_eq!(labels(&study, 3), ["bar-5.csv", "bar-10.csv", "bar-20.csv"]);
    assert_eq!(study.axes[3].sizes().unwrap(), [0.8, 0.4, 0.2]);
    assert_eq!(study.axes[3].values[0].settings[0].value, "a/bar-5.csv");
    assert_eq!(study.axes[4].values[0].settings[0].value, "[0, \"1 N\", 0]");
    assert_eq!(study.axes[4].values[2].settings[1].value, "\"3 s\"");
    assert_eq!(study.series, Some(4));
    let measure = |name: &str| study.measures.iter().find(|m| m.name == name).unwrap();
    assert_eq!(measure("tip").reference, Reference::Richardson(3));
    assert_eq!(measure("first").of, MeasureOf::Measure("tip".to_owned()));
    assert_eq!(
        measure("first").reference,
        Reference::Value("-8.5 mm".to_owned())
    );
    assert_eq!(measure("energy").of, MeasureOf::Balance("energy_error"));
    assert_eq!(measure("fine").reference, Reference::Finest(1));
}

#[test]
fn ranges_begin_and_end_where_they_say() {
    let study = study(&format!(
        "[vary]\n\"run.safety_factor\" = {{ from = 0.1, to = 0.9, count = 5 }}\n\"run.gravity\" = {{ from = -1, to = 1, count = 2 }}\n{TIP}"
    ));
    assert_eq!(labels(&study, 0), ["0.1", "0.3", "0.5", "0.7", "0.9"]);
    assert_eq!(labels(&study, 1), ["-1", "1"]);
    assert_eq!(study.axes[1].sizes(), None, "a size is above 0");
}

/// Values are shown as written, vectors along one axis by their component there, tables by the key
/// in which they differ.
#[test]
fn values_have_labels_and_numbers() {
    let study = study(&format!(
        r#"[vary]
"bodies.bar.velocity" = [[0, 0, "-0.5 m/s"], [0, 0, 0], [0.0, "0 m/s", "-2 m/s"]]
"loads.tip.force" = [[0, "1 N", 0], ["1 N", 0, 0]]
"run.time_step" = ["1 us", "2e-3 ms"]
"run.gravity" = {{ from = "-1 m/s2", to = "1 m/s2", count = 3 }}
"run.seed" = [3, 4]
"bonds.steel.model" = ["timoshenko", "parallel"]
"bodies.bar.rotation" = [{{ axis = [1, 0, 0], angle = "24 deg" }}, {{ angle = "41 deg", axis = [1, 0, 0] }}]
"bodies.bar.drop" = [{{ height = 1, onto = "a" }}, {{ height = 2, onto = "b" }}]
{TIP}"#
    ));
    assert_eq!(labels(&study, 6), ["24 deg", "41 deg"]);
    let angles = study.axes[6].numbers();
    assert_eq!(angles, Some((vec![24.0, 41.0], "deg".to_owned())));
    let both = ["{ height = 1, onto = a }", "{ height = 2, onto = b }"];
    assert_eq!(labels(&study, 7), both);
    assert_eq!(study.axes[7].numbers(), None);
    assert_eq!(labels(&study, 0), ["-0.5 m/s", "0", "-2 m/s"]);
    let numbers = |axis: usize| study.axes[axis].numbers();
    assert_eq!(numbers(0), Some((vec![-0.5, 0.0, -2.0], "m/s".to_owned())));
    assert_eq!(study.axes[0].sizes(), None);
    assert_eq!(labels(&study, 1), ["[0, 1 N, 0]", "[1 N, 0, 0]"]);
    assert_eq!(numbers(1), None);
    assert_eq!(numbers(2), None, "two units");
    assert_eq!(numbers(3), Some((vec![-1.0, 0.0, 1.0], "m/s2".to_owned())));
    assert_eq!(numbers(4), Some((vec![3.0, 4.0], String::new())));
    assert_eq!(numbers(5), None);
    assert_eq!(study.average_over, Some(4));
}

/// Repeats are for run times, which are compared only where errors are.
#[test]
fn measures_without_a_reference_have_responses() {
    let of = |rest: &str, in_scene: &str| {
        let mut study = study(&format!("[vary]\n\"run.seed\" = [1]\n{rest}"));
        let scene = format!("{SCENE}{in_scene}");
        let scene = scene_with(&study, &scene, study.first_settings()).unwrap();
        settle_references(&mut study, &scene);
        (study.measures[0].reference.clone(), study.repeats())
    };
    let expected = "reference = \"1 mm\"\n";
    assert_eq!(of(TIP, ""), (Reference::None, 1));
    assert_eq!(of(TIP, expected), (Reference::ClosedForm, 3));
    let none = format!("{TIP}reference = \"none\"\n");
    assert_eq!(of(&none, expected), (Reference::None, 1));
    let both = format!("{TIP}[measures.energy]\nbalance = \"energy\"\n");
    assert_eq!(of(&both, ""), (Reference::None, 3));
    for of_test in [
        "test_result = \"stiffness\"",
        "curve = \"force-displacement\"",
        "fragment_masses = \"remaining\"",
    ] {
        let rest = format!("[measures.a]\n{of_test}\n");
        assert_eq!(of(&rest, ""), (Reference::None, 1));
    }
}

#[test]
fn figures_of_what_left_are_read() {
    let study = study(
        "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.a]\ndischarge = \"mass-of-largest\"\n\
         [measures.b]\ndischarge = \"passing\"\nsieve = \"20 mm\"\noutlet = \"product\"\n",
    );
    let of: Vec<&MeasureOf> = study.measures.iter().map(|one| &one.of).collect();
    let product = Some("product".to_owned());
    assert_eq!(
        of,
        [
            &MeasureOf::Discharge(DischargeFigure::MassOfLargest, None),
            &MeasureOf::Discharge(DischargeFigure::Passing(0.02), product),
        ]
    );
    assert_eq!(study.measures[1].reference, Reference::None);
}

#[test]
fn areas_have_sizes() {
    let study = study(
        "[vary]\n\"test.area\" = [\"9 cm2\", \"400 mm2\", \"1e-4 m2\"]\n[measures.tip]\nreference = \"richardson\"\n",
    );
    let sizes = study.axes[0].sizes().unwrap();
    for (size, wanted) in sizes.iter().zip([9e-4, 4e-4, 1e-4]) {
        assert!((size / wanted - 1.0).abs() < 1e-15, "{size}");
    }
}

#[test]
fn what_is_no_study() {
    for (rest, parts) in [
        (
            "[measures.tip]\n",
            "study.toml:1: nothing varies; add [vary]",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n",
            "nothing is measured",
        ),
        (
            "[vary]\nrun.safety = [0.5]\n[measures.tip]\n",
            "study.toml:4: vary.\"run\" is neither a list nor a range; write its path in quotes",
        ),
        (
            "[vary]\n\"run.safety_factor\" = 0.5\n[measures.tip]\n",
            "study.toml:4: vary.\"run.safety_factor\" is 0.5, but must be a list or a range",
        ),
        (
            "[vary]\n\"run.safety_factor\" = []\n[measures.tip]\n",
            "an empty list",
        ),
        (
            "[vary]\n\"safety\" = [1]\n[measures.tip]\n",
            "\"safety\" is no path of a scene; write TABLE.KEY",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { from = 1, to = \"2 s\", count = 3 }\n[measures.tip]\n",
            "is in 's', but vary.\"run.safety_factor\".from in no unit",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { from = 0, to = 2, count = 3, spacing = \"log\" }\n[measures.tip]\n",
            "no logarithm",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { from = 1, to = 2, count = 1 }\n[measures.tip]\n",
            "count is 1, but must be from 2 to 100000",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { values = [1, 2], size = [1] }\n[measures.tip]\n",
            "must be a list of 2, one for each value",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { values = [1, 2], size = [1, -1] }\n[measures.tip]\n",
            "a size of more than 0",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5, 0.6]\n[together.a]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\n",
            "study.toml:5: a is set by run.safety_factor already",
        ),
        (
            "[vary]\n\"body.bar\" = [\"-\"]\n[measures.tip]\n",
            "must be the name of a file",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5, 0.6]\n[measures.tip]\nreference = \"richardson\"\n",
            "study.toml:6: measures.tip.reference: run.safety_factor has 2 sizes, but Richardson extrapolation needs 3",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5, 0.6]\n[measures.tip]\nreference = { finest = \"run.safty_factor\" }\n",
            "which does not vary; did you mean 'run.safety_factor'?",
        ),
        (
            "[vary]\n\"bonds.a.model\" = [\"parallel\"]\n[measures.tip]\nreference = { finest = \"bonds.a.model\" }\n",
            "whose values have no size above 0; add size = [...]",
        ),
        (
            "[vary]\n\"bonds.a.model\" = [\"parallel\"]\n[measures.tip]\nreference = \"finest\"\n",
            "but 0 axes have sizes",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\nreference = 5\n",
            "must be a table",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\nreference = { value = 1, finest = \"run.safety_factor\" }\n",
            "names 2 references",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.e]\nbalance = \"energi\"\n",
            "did you mean 'energy'?",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.e]\nbalance = \"energy\"\nreference = \"finest\"\n",
            "it is an error by itself",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.e]\nbalance = \"energy\"\nmeasure = \"tip\"\n",
            "cannot be combined with",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.a]\ndischarge = \"passing\"\n",
            "measures.a.discharge is \"passing\", but there is no sieve beside it; add sieve = \"20 mm\"",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.a]\ndischarge = \"d50\"\nsieve = \"2 mm\"\n",
            "needs no sieve, which is beside it; remove sieve",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.a]\nrun_result = \"d50\"\noutlet = \"end\"\n",
            "measures.a.outlet is given without discharge, to which it belongs",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\n[page]\nseries = \"x\"\n",
            "which does not vary",
        ),
        (
            "repeats = 0\n[vary]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\n",
            "repeats is 0",
        ),
        (
            "threads = 5000\n[vary]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\n",
            "at most 1024",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { from = 1, to = 2, count = 1000000000000 }\n[measures.tip]\n",
            "vary.\"run.safety_factor\".count is 1000000000000, but must be from 2 to 100000",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { from = 1, to = 2, count = 1e300 }\n[measures.tip]\n",
            "vary.\"run.safety_factor\".count is 1e300",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { from = 1, to = 2, count = 60000 }\n\"run.rest_energy_ratio\" = { from = 1, to = 2, count = 60000 }\n[measures.tip]\n",
            "study.toml:5: with run.rest_energy_ratio the axes have 120000 values, more than 100000; vary less, or in several studies",
        ),
        (
            "[vary]\n\"run.safety_factor\" = { from = -1e308, to = 1e308, count = 99999999999999999999 }\n[measures.tip]\n",
            "vary.\"run.safety_factor\".count is 99999999999999999999",
        ),
        (
            "repeats = 18446744073709551615\n[vary]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\n",
            "repeats is 18446744073709551615, but must be a whole number from 1 to 1024",
        ),
        (
            "repeat = 3\n[vary]\n\"run.safety_factor\" = [0.5]\n[measures.tip]\n",
            "unknown key repeat; did you mean 'repeats'?",
        ),
    ] {
        let said = refused(&format!("{HEAD}{rest}"));
        assert!(said.contains(parts), "{rest}\n{said}\n{parts}");
    }
    let axes: String = (0..101)
        .map(|k| format!("\"run.safety_factor{k}\" = [1]\n"))
        .collect();
    let said = refused(&format!("{HEAD}[vary]\n{axes}[measures.tip]\n"));
    assert!(
        said.starts_with(
            "study.toml:104: with run.safety_factor100 there are more than 100 axes; join"
        ),
        "{said}"
    );
    assert!(refused("version = 2\n").contains("at most 1"));
    assert!(
        refused("version = 1\n[vary]\n\"run.safety_factor\" = [1]\n[measures.tip]\n")
            .contains("scene is missing")
    );
}

#[test]
fn values_meet_the_scene() {
    let said = |rest: &str| {
        let study = study(&format!("{rest}\n{TIP}"));
        let first = &study.axes[0].values[0].settings;
        let read = scene_with(&study, SCENE, study.fixed.iter().chain(first));
        read.map_or_else(|error| error.to_string(), |_| String::new())
    };
    assert_eq!(said("[vary]\n\"run.safety_factor\" = [0.5]"), "");
    assert_eq!(
        said("[vary]\n\"bonds.steel.damping.damping_coefficient\" = [1]"),
        ""
    );
    for (rest, parts) in [
        (
            "[vary]\n\"run.safty_factor\" = [0.5]",
            "study.toml:4: --set run.safty_factor=0.5: unknown key run.safty_factor; did you mean 'safety_factor'?",
        ),
        (
            "[vary]\n\"run.safety_factor\" = [5]",
            "study.toml:4: --set run.safety_factor=5: run.safety_factor is 5, but must be",
        ),
        (
            "[set]\n\"run.seed\" = 5\n[vary]\n\"materials.stel.density\" = [1]",
            "study.toml:6: materials.stel.density: the scene bar.toml has no [materials.stel]; did you mean 'steel'?",
        ),
        (
            "[vary]\n\"body.rod\" = [\"a.vtp\"]",
            "study.toml:4: the scene bar.toml has no body 'rod'; known: bar",
        ),
        (
            "[vary]\n\"body.bar\" = [\"a.vtp\"]",
            "study.toml:4: there is no file a.vtp",
        ),
        ("[vary]\n\"body.bar\" = [\"a.xyz\"]", "study.toml:4: a.xyz"),
    ] {
        let found = said(rest);
        assert!(found.contains(parts), "{rest}\n{found}");
    }
}

#[test]
fn a_scene_is_written_with_its_values() {
    let written = |rest: &str| {
        let study = study(&format!("{rest}\n{TIP}"));
        let last = study
            .axes
            .iter()
            .flat_map(|axis| &axis.values.last().unwrap().settings);
        let settings: Vec<_> = study.fixed.iter().chain(last).collect();
        // Equality with the requested scene is checked inside.
        rewritten(&study, SCENE, &settings, Path::new("new.toml"))
            .unwrap_or_else(|e| panic!("{rest}: {e}"))
    };
    let plain = written("[vary]\n\"run.safety_factor\" = [0.9, 0.25]");
    assert_eq!(
        plain,
        SCENE.replace("safety_factor = 0.9", "safety_factor = 0.25")
    );
    let added = written(
        "[vary]\n\"run.seed\" = [1]\n\"bonds.steel.damping.damping_coefficient\" = [\"2 N s/m\"]\n\"bonds.steel.model\" = [\"parallel\"]",
    );
    assert!(added.contains("[run]\nseed = 1\n"), "{added}");
    assert!(
        added.contains("{ damping_ratio = 0.1, damping_coefficient = \"2 N s/m\" }"),
        "{added}"
    );
    assert!(
        added.contains("# A bar.") && added.contains("# long"),
        "{added}"
    );
    let table = written(
        "[vary]\n\"groups.tip\" = [{ box = { min = [0.3, -1, -1], max = [1, 1, 1] } }]\n\"output.frames\" = [\"1 s\"]\n\"run.gravity\" = [[0, 0, -9.81]]",
    );
    assert!(table.contains("[groups.tip]\nbox = { min"), "{table}");
    assert!(table.contains("[output]\nframes = \"1 s\"\n"), "{table}");
    written(
        "[vary]\n\"bodies.bar.particles\" = [[[0, 0, 0, 0.1], [0.2, 0, 0, 0.1]]]\n\"bonds.steel.failure.tensile_strength\" = [\"1 MPa\"]",
    );

    let folder = tempfile::tempdir().unwrap();
    for (part, text) in [
        (
            "particles",
            "x_m,y_m,z_m,radius_m\n0,0,0,0.1\n0.2,0,0,0.1\n",
        ),
        ("bonds", "particle_a,particle_b\n0,1\n"),
    ] {
        std::fs::write(folder.path().join(format!("b.{part}.csv")), text).unwrap();
    }
    let file = folder.path().join("b.csv");
    let text = written(&format!(
        "[vary]\n\"body.bar\" = [{:?}]",
        file.display().to_string()
    ));
    assert!(
        text.contains("file = ") && !text.contains("bond_list"),
        "{text}"
    );
}

/// An angle of repose is in degrees, also in a study; contacts have their own types of references.
#[test]
fn references_are_in_the_unit_of_the_measure() {
    let scene = format!(
        "{SCENE}
[measures.slope]
quantity = \"angle_of_repose\"
reference = \"0.5 rad\"

[walls.floor]
plane = {{ point = [0, 0, -1], normal = [0, 0, 1] }}
material = \"steel\"

[measures.hit]
of = \"bar\"
with = \"floor\"
quantity = \"contact_duration\"
"
    );
    let study = study(
        "[vary]\n\"run.safety_factor\" = [0.9]\n[measures.slope]\n[measures.hit]\nreference = { value = \"2 ms\" }\n[measures.turn]\nmeasure = \"slope\"\nreference = { value = \"30 deg\" }\n",
    );
    let scene = scene_with(&study, &scene, std::iter::empty()).unwrap();
    let values = reference_values(&study, &scene).unwrap();
    let wanted = [0.5_f64.to_degrees(), 2e-3, 30.0];
    for (value, wanted) in values.into_iter().zip(wanted) {
        assert!((value.unwrap() / wanted - 1.0).abs() < 1e-14);
    }
}
