//! Tables for `rate_strengthening` from made tests.

use dem_results::summary::Verdict;
use dem_scene::scene_from_text;
use dem_study::outcome::Done;

use super::made::{done, study, table};

const LINES: &str = r#"
[vary]
"test.striker.velocity" = ["1 m/s", "2 m/s", "4 m/s", "8 m/s", "16 m/s"]
"bonds.rock.failure.rate_strengthening" = { values = [false, true], names = ["off", "eq. 20"] }
[measures.rate]
test_result = "strain rate"
[measures.factor]
test_result = "dynamic increase factor"
"#;

/// Without strengthening all factors are about 1; with it the second and the third fall, of which
/// the mean remains; the fourth test is doubtful, and in the fifth the body did not break.
fn made(velocity: usize, strengthened: bool) -> Done {
    let rate = [0.5, 1.0, 2.0, 4.0, 8.0][velocity];
    let factor = match strengthened {
        false => [0.95, 1.0, 1.0, 1.0, 1.0][velocity],
        true => [1.1, 1.5, 1.3, 2.0, f64::NAN][velocity],
    };
    let doubts = match velocity {
        3 => vec!["out of equilibrium".to_owned()],
        _ => Vec::new(),
    };
    Done {
        verdict: Verdict::new(doubts, Vec::new()),
        ..done(1.0, &[rate, factor])
    }
}

#[test]
fn a_study_of_dynamic_tests_gives_a_table_for_the_scene() {
    let table = table(&study(LINES), |run| made(run.choice[0], run.choice[1] == 1));
    let [off, on] = &table.increase_tables[..] else {
        panic!("{:?}", table.increase_tables);
    };
    assert_eq!(off.rows, [0.5, 1.0, 2.0, 8.0].map(|rate| [rate, 1.0]));
    assert_eq!(on.rows, [[0.5, 1.1], [1.0, 1.4], [2.0, 1.4]]);
    assert_eq!((on.tests, on.left_out), (3, 2));
    let line = r#"rate_strengthening = [["0.5 1/s", 1.1], ["1 1/s", 1.4], ["2 1/s", 1.4]]"#;
    assert_eq!(on.line(), line);
    let said = format!(
        "bonds.rock.failure.rate_strengthening = eq. 20: {line} from 3 valid tests (2 left out: doubtful, or unbroken)"
    );
    assert!(table.notes.contains(&said), "{:?}", table.notes);
    // Scenes take the line.
    let scene = format!(
        "version = 1\nrun.end_time = 1\n[materials.rock]\ndensity = 2000\n[bonds.rock]\nyoung_modulus = 1e9\npoisson_ratio = 0.2\nfailure.tensile_strength = 1e6\nfailure.{line}\n[bodies.block]\nfile = \"block.vtp\"\nmaterial = \"rock\"\nbonds = \"rock\"\n"
    );
    let scene = scene_from_text(&scene, "scene.toml", &[]).unwrap();
    assert!(scene.bonds["rock"].failure.rate_strengthening.is_some());
}

#[test]
fn other_studies_give_none() {
    for (from, to) in [
        ("dynamic increase factor", "strength"),
        ("test.striker.velocity", "test.striker.length"),
    ] {
        let table = table(
            &study(&LINES.replace(from, to).replace("m/s", "m")),
            |run| made(run.choice[0], run.choice[1] == 1),
        );
        assert_eq!((table.increase_tables.len(), table.failure_line), (0, None));
    }
}
