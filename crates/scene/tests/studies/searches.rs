//! Studies that search for a value.

use dem_scene::study::{Average, scene_with, value_to_find};

use super::{HEAD, SCENE, labels, refused, study};

const FIND: &str = r#"[find]
parameter = "run.end_time"
from = "3 s"
to = "1 s"
measure = "tip"
value = "2 mm"
tolerance = "10 ms"
[vary]
"run.seed" = [1, 2]
[measures.tip]
"#;

#[test]
fn a_search_is_read() {
    let search = FIND.replace("10 ms", "0.01 s");
    let mut study = study(&search);
    let find = study.find.clone().unwrap();
    assert_eq!(
        (find.measure, find.ends, find.tolerance),
        (0, [1.0, 3.0], 0.01)
    );
    assert_eq!((find.value.as_str(), find.unit.as_str()), ("2 mm", "s"));
    assert_eq!(find.statistic, Average::Mean);
    let median = search.replace("measure =", "statistic = \"median\"\nmeasure =");
    let of_median = super::study(&median).find.unwrap();
    assert_eq!(of_median.statistic, Average::Median);
    assert_eq!(study.average_over, Some(1));
    assert_eq!(labels(&study, 0), ["1 s", "3 s"]);
    study.add_point(0, 2.0);
    assert_eq!(study.points(), [1.0, 3.0, 2.0]);
    let added = &study.axes[0].values[2].settings[0];
    assert_eq!(
        (added.path.as_str(), added.value.as_str()),
        ("run.end_time", "\"2 s\"")
    );
    let scene = scene_with(&study, SCENE, study.first_settings()).unwrap();
    assert_eq!(value_to_find(&study, &scene).unwrap(), Some(2e-3));
}

/// A search for each value of the other axes; points are shared where they are the same.
#[test]
fn a_search_has_cases() {
    let search = FIND.replace("10 ms", "0.01 s").replace(
        "[measures",
        "\"bonds.steel.model\" = [\"timoshenko\", \"parallel\"]\n\"body.bar\" = [\"a.csv\", \"b.csv\"]\n[measures",
    );
    let mut study = study(&search);
    assert_eq!(study.average_over, Some(1));
    let cases = [[0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 1, 0], [0, 0, 1, 1]];
    assert_eq!(study.cases(), cases);
    study.add_point(2, 2.0);
    study.add_point(0, 1.5);
    study.add_point(3, 2.0);
    assert_eq!(study.points(), [1.0, 3.0, 2.0, 1.5]);
    let tried = study.find.unwrap().tried;
    assert_eq!(tried, [&[0, 1, 3][..], &[0, 1], &[0, 1, 2], &[0, 1, 2]]);
}

#[test]
fn what_is_no_search() {
    let good = FIND.replace("10 ms", "0.01 s");
    for (old, new, parts) in [
        (
            "\"0.01 s\"",
            "\"10 ms\"",
            "study.toml:9: find.tolerance is \"10 ms\", in another unit than find.from; write",
        ),
        (
            "\"0.01 s\"",
            "\"1e-9 s\"",
            "find.tolerance is \"1e-9 s\", but must be at least 0.0003 s; points are rounded",
        ),
        ("\"3 s\"", "\"1 s\"", "find.from and find.to are equal"),
        (
            "\"3 s\"",
            "[1]",
            "find.from is a list of 1, but must be a number",
        ),
        (
            "parameter = \"run.end_time\"",
            "",
            "find.parameter is missing",
        ),
        (
            "\"run.end_time\"",
            "\"end_time\"",
            "\"end_time\" is no path of a scene",
        ),
        (
            "measure = \"tip\"",
            "measure = \"top\"",
            "find.measure is \"top\", but the study has no such measure; did you mean 'tip'?",
        ),
        (
            "\"2 mm\"",
            "true",
            "find.value is true, but must be a number",
        ),
        (
            "\"run.seed\" = [1, 2]",
            "\"run.end_time\" = [\"1 s\"]",
            "run.end_time is set by run.end_time already",
        ),
        (
            "[find]",
            "combine = \"paired\"\n[find]",
            "[find] has no effect on pairs of values",
        ),
        (
            "[find]",
            "average_over = \"run.end_time\"\n[find]",
            "average_over names the parameter of [find]",
        ),
        (
            "[find]",
            "average_over = \"run.sed\"\n[find]",
            "average_over is \"run.sed\", which does not vary; did you mean 'run.seed'?",
        ),
    ] {
        let said = refused(&format!("{HEAD}{}", good.replace(old, new)));
        assert!(said.contains(parts), "{new}\n{said}\n{parts}");
    }
    let pairs = "combine = \"paired\"\naverage_over = \"run.seed\"\n[vary]\n\"run.seed\" = [1]\n[measures.tip]\n";
    assert!(refused(&format!("{HEAD}{pairs}")).contains("average_over has no effect on pairs"));
    let kilograms = study(&good.replace("2 mm", "2 kg"));
    let scene = scene_with(&kilograms, SCENE, kilograms.first_settings()).unwrap();
    let said = value_to_find(&kilograms, &scene).unwrap_err().to_string();
    assert!(
        said.contains("find.value: '2 kg' is not a length"),
        "{said}"
    );
}
