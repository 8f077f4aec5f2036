//! Studies with a design.

use dem_scene::study::{DesignKind, MeasureOf, Reference, RunTime, study_from_text};

use super::{HEAD, labels, refused, study};

const MORRIS: &str = r#"[design]
kind = "morris"
[design.ranges]
"run.safety_factor" = [0.8, 0.2]
"bonds.steel.young_modulus" = { from = "1 GPa", to = "1000 GPa", spacing = "log" }
[vary]
"run.seed" = [1, 2]
[measures.tip]
[measures.cost]
run_time = "processor"
"#;

#[test]
fn a_design_is_read() {
    let usual = study(MORRIS);
    let design = usual.design.clone().unwrap();
    let kind = DesignKind::Morris {
        trajectories: 10,
        levels: 4,
        seed: 1,
    };
    assert_eq!((design.kind, design.place.as_str()), (kind, "study.toml:3"));
    assert_eq!(labels(&usual, 0), ["0.2", "0.4", "0.6", "0.8"]);
    assert_eq!(
        labels(&usual, 1),
        ["1 GPa", "10 GPa", "100 GPa", "1000 GPa"]
    );
    assert_eq!((usual.average_over, usual.repeats()), (Some(2), 1));
    assert_eq!(usual.measures[1].of, MeasureOf::RunTime(RunTime::Processor));
    let given = MORRIS.replace(
        "\"morris\"",
        "\"morris\"\ntrajectories = 3\nlevels = 2\nseed = 0",
    );
    let given = study(&given);
    assert_eq!(labels(&given, 0), ["0.2", "0.8"]);
    let kind = DesignKind::Morris {
        trajectories: 3,
        levels: 2,
        seed: 0,
    };
    assert_eq!(given.design.unwrap().kind, kind);
    let text = include_str!("one-at-a-time.toml");
    let study = study_from_text(text, "one-at-a-time.toml").unwrap();
    assert_eq!(study.design.as_ref().unwrap().kind, DesignKind::OneAtATime);
    assert_eq!(labels(&study, 0), ["20 MPa", "40 MPa", "60 MPa"]);
    let mut measures = study.measures.iter();
    assert!(measures.all(|measure| measure.reference == Reference::None));
}

#[test]
fn what_is_no_design() {
    let range = "\"run.safety_factor\" = [0.8, 0.2]";
    for (old, new, parts) in [
        (
            "\"morris\"",
            "\"morriss\"",
            "study.toml:4: design.kind is \"morriss\", which is unknown; did you mean 'morris'?",
        ),
        (
            "\"morris\"",
            "\"morris\"\nlevels = 5",
            "study.toml:5: design.levels is 5, but must be an even number; write levels = 4",
        ),
        (
            "\"morris\"",
            "\"morris\"\ntrajectories = 1",
            "design.trajectories is 1, but must be a whole number from 2 to 1000; write trajectories = 10",
        ),
        (
            "\"morris\"",
            "\"morris\"\ntrajectory = 4",
            "unknown key design.trajectory; did you mean 'trajectories'?",
        ),
        (
            "\"morris\"",
            "\"one-at-a-time\"\nlevels = 4",
            "study.toml:5: design.levels has no effect on changes one at a time; remove levels, or write kind = \"morris\"",
        ),
        (
            "\"morris\"",
            "\"one-at-a-time\"",
            "study.toml:7: design.ranges.\"bonds.steel.young_modulus\".spacing has no effect on changes one at a time; remove it",
        ),
        (
            "spacing = \"log\"",
            "base = \"2 GPa\"",
            "base has no effect on trajectories, which begin anywhere; remove it, or write kind = \"one-at-a-time\"",
        ),
        (
            range,
            "\"run.safety_factor\" = [0.2]",
            "study.toml:6: design.ranges.\"run.safety_factor\" has 1 values, but a range has two ends; write [0.2, 0.6], say",
        ),
        (
            range,
            "\"run.safety_factor\" = 0.5",
            "design.ranges.\"run.safety_factor\" is 0.5, but must be a range",
        ),
        (
            range,
            "\"run.safety_factor\" = [0.5, 0.5]",
            "has two equal ends; give two different ones, or move it to [set]",
        ),
        (
            range,
            "\"run.seed\" = [1, 100]",
            "run.seed has no range: it stands for chance; list seeds in [vary], such as \"run.seed\" = [1, 2, 3]",
        ),
        (
            range,
            "\"run.adaptive\" = [false, true]",
            "is false, but must be a number; only numbers have a range: give words, true and false by [set], one study for each",
        ),
        (
            range,
            "\"bonds.steel.model\" = [\"timoshenko\", \"parallel\"]",
            "is \"timoshenko\", but must be a number; only numbers have a range",
        ),
        (
            range,
            "\"run.safety_factor\" = [\"1 mm\", \"2 m\"]",
            "is in 'm', but the range begins in 'mm'; write all its numbers in the same unit",
        ),
        (
            "from = \"1 GPa\"",
            "from = \"0 GPa\"",
            "has no logarithm at 0 and below; write spacing = \"linear\", or ends above 0",
        ),
        (
            range,
            "\"safety\" = [1, 2]",
            "\"safety\" is no path of a scene",
        ),
        (
            range,
            "\"bonds.steel.young_modulus2\" = [1, 2]\n\"bonds.steel.young_modulus\" = [1, 2]",
            "study.toml:8: the key \"bonds.steel.young_modulus\" is given twice in its table; remove one",
        ),
        (
            "[vary]",
            "[vary]\n\"bonds.steel.model\" = [\"parallel\"]",
            "study.toml:9: bonds.steel.model varies beside [design]; move it into [design.ranges] or [set], or name it in average_over",
        ),
        (
            "[vary]",
            "[vary]\n\"run.safety_factor\" = [0.1]",
            "run.safety_factor is set by run.safety_factor already",
        ),
        (
            "[measures.tip]",
            "[set]\n\"run.safety_factor\" = 0.1\n[measures.tip]",
            "[set] gives run.safety_factor, which varies",
        ),
        (
            "[design]",
            "average_over = \"run.safety_factor\"\n[design]",
            "average_over names run.safety_factor, a range of [design]; name what the scatter comes from, such as run.seed",
        ),
        (
            "[design]",
            "combine = \"grid\"\n[design]",
            "study.toml:3: combine has no effect on a study with [design]; remove combine",
        ),
        (
            "[design]",
            "statistic = \"median\"\n[design]",
            "statistic has no effect on a study with [design]",
        ),
        (
            "[measures.tip]",
            "[measures.tip]\nreference = { value = 1 }",
            "measures.tip has a reference, but [design] ranks values, not errors; remove reference",
        ),
        (
            "run_time = \"processor\"",
            "run_time = \"processor\"\nreference = \"none\"",
            "measures.cost.reference is given for a run time, which has none; remove reference",
        ),
        (
            "run_time = \"processor\"",
            "run_time = \"cpu\"",
            "measures.cost.run_time is \"cpu\", which is unknown; known: wall, processor",
        ),
    ] {
        assert!(MORRIS.contains(old), "{old}");
        let said = refused(&format!("{HEAD}{}", MORRIS.replacen(old, new, 1)));
        assert!(said.contains(parts), "{new}\n{said}\n{parts}");
    }
    let base = "[design]\nkind = \"one-at-a-time\"\n[design.ranges]\n\"run.safety_factor\" = { from = 0.2, to = 0.8, base = 1 }\n[measures.tip]\n";
    let said = refused(&format!("{HEAD}{base}"));
    let parts = "study.toml:6: design.ranges.\"run.safety_factor\".base is 1, but must be from 0.2 to 0.8; widen the range, or correct the base";
    assert!(said.contains(parts), "{said}");
    let empty = "[design]\nkind = \"morris\"\n[design.ranges]\n[measures.tip]\n";
    let said = refused(&format!("{HEAD}{empty}"));
    assert!(
        said.contains("the design has no ranges; add [design.ranges] with"),
        "{said}"
    );
    let said = refused(&format!(
        "{HEAD}[design]\nkind = \"morris\"\n[measures.tip]\n"
    ));
    assert!(
        said.contains("study.toml:3: design.ranges is missing"),
        "{said}"
    );
}
