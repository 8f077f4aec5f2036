//! Studies of the probability of an outcome.

use dem_scene::study::{Probability, scene_with, study_from_text, value_to_find};

use super::{HEAD, SCENE, refused, study};

const GOOD: &str = r#"[probability]
of = "tip"
above = "2 mm"
over = "run.end_time"
[vary]
"run.end_time" = ["1 s", "2 s"]
"run.seed" = [1, 2]
[measures.tip]
"#;

#[test]
fn a_probability_is_read() {
    let found = study(GOOD);
    let wanted = Probability {
        measure: 0,
        limit: "2 mm".to_owned(),
        is_below: false,
        over: 0,
        is_log: false,
        is_never_negative: true,
        place: "study.toml:3".to_owned(),
    };
    assert_eq!(found.probability, Some(wanted));
    let scene = scene_with(&found, SCENE, found.first_settings()).unwrap();
    assert_eq!(value_to_find(&found, &scene).unwrap(), Some(2e-3));
    let text = include_str!("probability.toml");
    let found = study_from_text(text, "probability.toml").unwrap();
    let probability = found.probability.unwrap();
    assert!(probability.is_log && !probability.is_below && probability.over == 1);
}

#[test]
fn what_is_no_probability() {
    for (old, new, parts) in [
        (
            "of = \"tip\"",
            "of = \"top\"",
            "study.toml:4: probability.of is \"top\", but the study has no such measure; did you mean 'tip'?",
        ),
        ("of = \"tip\"", "", "probability.of is missing"),
        (
            "above = \"2 mm\"",
            "",
            "study.toml:3: probability has no limit; add below = 0.9, say, or above",
        ),
        (
            "above = \"2 mm\"",
            "above = 1\nbelow = 2",
            "study.toml:6: probability.below cannot be combined with above; a run has one outcome",
        ),
        (
            "\"2 mm\"",
            "true",
            "probability.above is true, but must be a number",
        ),
        ("over = \"run.end_time\"", "", "probability.over is missing"),
        (
            "over = \"run.end_time\"",
            "over = \"run.end\"",
            "probability.over is \"run.end\", which does not vary",
        ),
        (
            "over = \"run.end_time\"",
            "over = \"run.seed\"",
            "probability.over is \"run.seed\", which average_over names; name a parameter here",
        ),
        (
            "[\"1 s\", \"2 s\"]",
            "[\"1 s\"]",
            "probability.over is \"run.end_time\", which has one value; let it vary",
        ),
        (
            "[\"1 s\", \"2 s\"]",
            "[\"1 s\", \"2 ms\"]",
            "probability.over is \"run.end_time\", whose values are not numbers in one unit",
        ),
        ("over = ", "spacing = \"log\"\nover = ", ""),
        (
            "over = ",
            "spacing = \"even\"\nover = ",
            "probability.spacing is \"even\"",
        ),
        (
            "over = ",
            "unit = 1\nover = ",
            "unknown key probability.unit",
        ),
        (
            "[probability]",
            "combine = \"paired\"\n[probability]",
            "[probability] has no effect on pairs of values; remove combine",
        ),
        (
            "[probability]",
            "[find]\nparameter = \"run.safety_factor\"\nfrom = 0.1\nto = 0.9\nmeasure = \"tip\"\nvalue = 1\ntolerance = 0.01\n[probability]",
            "[probability] has no effect on a study with [find]",
        ),
        (
            "[vary]\n\"run.end_time\" = [\"1 s\", \"2 s\"]",
            "[design]\nkind = \"morris\"\n[design.ranges]\n\"run.end_time\" = [\"1 s\", \"2 s\"]\n[vary]",
            "probability has no effect on a study with [design]",
        ),
    ] {
        let text = format!("{HEAD}{}", GOOD.replace(old, new));
        if parts.is_empty() {
            study_from_text(&text, "study.toml").unwrap();
            continue;
        }
        let said = refused(&text);
        assert!(said.contains(parts), "{new}\n{said}\n{parts}");
    }
    let zero = GOOD
        .replace("over = ", "spacing = \"log\"\nover = ")
        .replace("\"2 s\"", "0");
    assert!(
        refused(&format!("{HEAD}{zero}")).contains("which is 0 in some runs; it has no logarithm")
    );
    let kilograms = study(&GOOD.replace("2 mm", "2 kg"));
    let scene = scene_with(&kilograms, SCENE, kilograms.first_settings()).unwrap();
    let said = value_to_find(&kilograms, &scene).unwrap_err().to_string();
    assert!(
        said.contains("study.toml:3: probability.above: '2 kg' is not a length"),
        "{said}"
    );
}
