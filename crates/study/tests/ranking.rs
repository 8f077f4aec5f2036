//! Rankings of made outcomes: trajectories and changes one at a time, with and without failures.

use dem_scene::study::{Study, study_from_text};
use dem_study::expand::{Run, runs};
use dem_study::outcome::Outcome;
use dem_study::ranking::{DesignTable, MorrisRanking, OneAtATimeRanking, Rankings};
use dem_study::ranking_text::effects_csv;
use dem_study::sweep_table::SweepTable;

use super::made::{assert_near, done, study, table, table_of};

const MORRIS: &str = r#"
[design]
kind = "morris"
trajectories = 6
[design.ranges]
"bonds.bar.young_modulus" = ["20 MPa", "60 MPa"]
"bonds.bar.radius" = { from = "1 mm", to = "10 mm", spacing = "log" }
"run.safety_factor" = [0.8, 0.2]
[vary]
"run.seed" = [1, 2, 3]
[measures.force]
[measures.size]
"#;

const ONE_AT_A_TIME: &str = r#"
[design]
kind = "one-at-a-time"
[design.ranges]
"bonds.bar.young_modulus" = { from = "20 MPa", to = "60 MPa", base = "30 MPa" }
"bonds.bar.radius" = { from = "1 mm", to = "4 mm", base = "2 mm" }
"run.safety_factor" = { from = 0, to = 0.8, base = 0 }
[vary]
"run.seed" = [1, 2, 3]
[measures.force]
"#;

/// The parameters of a run, as numbers in their units, and its seed from 0.
fn inputs(study: &Study, run: &Run) -> ([f64; 3], f64) {
    let number = |at: usize| study.axes[at].numbers().unwrap().0[run.choice[at]];
    ([0, 1, 2].map(number), run.choice[3] as f64)
}

fn design(table: &SweepTable) -> &DesignTable {
    table.design.as_ref().unwrap()
}

fn morris(table: &SweepTable) -> &[MorrisRanking] {
    match &design(table).rankings {
        Rankings::Morris(rankings) => rankings,
        Rankings::OneAtATime(_) => panic!("{:?}", design(table)),
    }
}

fn changes(table: &SweepTable) -> &OneAtATimeRanking {
    match &design(table).rankings {
        Rankings::OneAtATime(rankings) => &rankings[0],
        Rankings::Morris(_) => panic!("{:?}", design(table)),
    }
}

/// Force 2 E - 100 log10(radius) + seed, size E times safety: effects over the ranges are 80,
/// -100, 0, and for the size those of a product.
fn of_morris(study: &Study, run: &Run) -> Vec<f64> {
    let ([modulus, radius, safety], seed) = inputs(study, run);
    vec![
        2.0 * modulus - 100.0 * radius.log10() + seed,
        modulus * safety,
    ]
}

#[test]
fn a_design_has_its_runs_in_the_order_of_the_points() {
    let study = study(MORRIS);
    let runs = runs(&study, false).unwrap();
    assert_eq!(runs.len(), 6 * 4 * 3);
    for (run, number) in runs.iter().zip(1..) {
        assert_eq!((run.number, run.choice[3]), (number, (number - 1) % 3));
    }
    let points: Vec<&[usize]> = runs.iter().step_by(3).map(|run| &run.choice[..3]).collect();
    for trajectory in points.chunks(4) {
        for two in trajectory.windows(2) {
            let moved = two[0].iter().zip(two[1]).filter(|(a, b)| a != b).count();
            assert_eq!(moved, 1, "{trajectory:?}");
        }
    }
    let labels: Vec<&str> = study.axes[1]
        .values
        .iter()
        .map(|v| v.label.as_str())
        .collect();
    assert_eq!(labels, ["1 mm", "2.15443 mm", "4.64159 mm", "10 mm"]);
}

#[test]
fn trajectories_rank_what_changes_a_measure() {
    let study = study(MORRIS);
    let table = table(&study, |run| done(1.0, &of_morris(&study, run)));
    let words = "Morris: 6 trajectories of 3 parameters on 4 levels (seed 1), 24 points, each with 3 values of run.seed: 72 runs";
    assert_eq!(design(&table).words, words);
    let [force, size] = morris(&table) else {
        panic!("{:?}", morris(&table));
    };
    let order: Vec<usize> = force.parameters.iter().map(|of| of.parameter).collect();
    assert_eq!(order, [1, 0, 2]);
    // Levels are rounded to six digits.
    for (of, effect) in force.parameters.iter().zip([-100.0, 80.0, 0.0]) {
        let statistics = of.statistics.as_ref().unwrap();
        assert!((statistics.mu - effect).abs() < 1e-3, "{of:?}");
        assert!((statistics.mu_star - effect.abs()).abs() < 1e-3, "{of:?}");
        assert!(statistics.sigma.unwrap() < 1e-3, "{of:?}");
        // The seed adds the same everywhere: nothing of the effects is chance.
        assert!(statistics.chance.unwrap() < 1e-9, "{of:?}");
        assert_eq!(of.is_above_chance, Some(effect != 0.0));
    }
    // d(E s)/ds over the range from 0.2 to 0.8 is 0.6 E, from 12 to 36.
    let of = |ranking: &MorrisRanking, parameter: usize| {
        let mut all = ranking.parameters.iter();
        all.find(|of| of.parameter == parameter)
            .unwrap()
            .statistics
            .clone()
            .unwrap()
    };
    let safety = of(size, 2);
    assert!(
        safety.mu > 12.0 && safety.mu < 36.0 && safety.sigma.unwrap() > 1.0,
        "{safety:?}"
    );
    assert!(table.notes.is_empty(), "{:?}", table.notes);
}

/// Without the values of a run its steps are left out, and the rest stands; a note names it.
#[test]
fn failed_runs_are_never_counted() {
    let study = study(&MORRIS.replace("[1, 2, 3]", "[1]"));
    let table = table_of(&study, |run| {
        vec![match run.number {
            // The second point of the second trajectory: two of its steps.
            6 => Outcome::Failed("it burst".to_owned()),
            _ => Outcome::Done(done(1.0, &of_morris(&study, run))),
        }]
    });
    let force = &morris(&table)[0];
    let counts = force
        .parameters
        .iter()
        .map(|of| of.statistics.as_ref().unwrap().effects);
    assert_eq!(counts.sum::<usize>(), 6 * 3 - 2);
    for (of, effect) in force.parameters.iter().zip([100.0, 80.0, 0.0]) {
        let statistics = of.statistics.as_ref().unwrap();
        assert!((statistics.mu_star - effect).abs() < 1e-3, "{of:?}");
        assert_eq!((statistics.chance, of.is_above_chance), (None, None));
    }
    let said = "1 run without values (6): the steps that they end are left out; parameters keep 5 to 6 effects";
    assert!(
        table.notes.iter().any(|note| note == said),
        "{:?}",
        table.notes
    );
    assert!(
        table
            .notes
            .iter()
            .any(|note| note.contains("with one seed")),
        "{:?}",
        table.notes
    );
    let none = table_of(&study, |_| vec![Outcome::Missing]);
    assert!(
        morris(&none)[0]
            .parameters
            .iter()
            .all(|of| of.statistics.is_none())
    );
    assert_eq!(morris(&none)[0].mean, None);
    for text in [none.to_string(), effects_csv(&none, design(&none))] {
        assert!(
            text.contains("no values") && !text.contains("NaN"),
            "{text}"
        );
    }
}

/// Force E^2/radius + seed, whose scatter is the same everywhere; safety adds scatter only.
#[test]
fn changes_one_at_a_time_are_closed_forms() {
    let study = study(ONE_AT_A_TIME);
    let all = runs(&study, false).unwrap();
    assert_eq!(all.len(), (1 + 2 + 2 + 1) * 3);
    let scatter = [1.0, -2.0, 0.5];
    let table = table(&study, |run| {
        let ([modulus, radius, safety], seed) = inputs(&study, run);
        let chance = if safety > 0.0 {
            scatter[seed as usize]
        } else {
            0.0
        };
        done(1.0, &[modulus * modulus / radius + seed + chance])
    });
    let ranking = changes(&table);
    // 900/2 + 1.
    assert_near(ranking.base.unwrap(), 451.0);
    assert_near(ranking.base_deviation.unwrap(), 1.0);
    let order: Vec<usize> = ranking.parameters.iter().map(|of| of.parameter).collect();
    assert_eq!(order, [0, 1, 2]);
    let [modulus, radius, safety] = ranking.parameters.as_slice() else {
        panic!("{ranking:?}");
    };
    assert_near(modulus.low.as_ref().unwrap().change, 200.0 - 450.0);
    assert_near(modulus.high.as_ref().unwrap().change, 1800.0 - 450.0);
    assert_near(
        modulus.elasticity.unwrap(),
        (1801.0_f64 / 201.0).ln() / 3.0_f64.ln(),
    );
    assert_near(radius.low.as_ref().unwrap().change, 450.0);
    assert_near(radius.high.as_ref().unwrap().change, -225.0);
    assert_eq!(modulus.is_above_chance, Some(true));
    // The base is the lower end. 1, -2, 0.5: mean -1/6, squares 49/36 + 121/36 + 16/36 over 2.
    assert_eq!((&safety.low, safety.elasticity), (&None, None));
    let high = safety.high.as_ref().unwrap();
    assert_near(high.change, -1.0 / 6.0);
    let deviation = (186.0_f64 / 36.0 / 2.0).sqrt();
    assert_near(
        high.half_width.unwrap(),
        4.3027 * deviation / 3.0_f64.sqrt(),
    );
    assert_eq!((high.seeds, safety.is_above_chance), (3, Some(false)));
    let text = table.to_string();
    assert!(
        text.contains("run.safety_factor  (within chance)"),
        "{text}"
    );
    let csv = effects_csv(&table, design(&table));
    assert!(
        csv.lines()
            .nth(1)
            .unwrap()
            .starts_with("force,m,1,bonds.bar.young_modulus,MPa,20,60,30,-250,"),
        "{csv}"
    );
    assert!(
        csv.lines().nth(3).unwrap().ends_with(",within chance"),
        "{csv}"
    );
}

/// The base is that of the scene, in the unit of the range.
#[test]
fn the_base_is_that_of_the_scene() {
    let settled = |lines: &str, scene: &str| {
        let text = format!(
            "version = 1\nscene = \"bar.toml\"\n[design]\nkind = \"one-at-a-time\"\n[design.ranges]\n{lines}\n[measures.tip]\n"
        );
        let mut study = study_from_text(&text, "study.toml").unwrap();
        let settled = study.settle_design(scene);
        settled.map(|()| study).map_err(|error| error.to_string())
    };
    let scene = "version = 1\n[bonds.bar]\nyoung_modulus = \"0.03 GPa\"\ndamping = { damping_ratio = 0.1 }\nmodel = \"timoshenko\"\n";
    let study = settled(
        "\"bonds.bar.young_modulus\" = [\"20 MPa\", \"60 MPa\"]\n\"bonds.bar.damping.damping_ratio\" = [0.1, 0.3]",
        scene,
    )
    .unwrap();
    let labels = |at: usize| -> Vec<&str> {
        study.axes[at]
            .values
            .iter()
            .map(|v| v.label.as_str())
            .collect()
    };
    assert_eq!(labels(0), ["20 MPa", "30 MPa", "60 MPa"]);
    assert_eq!(labels(1), ["0.1", "0.3"]);
    let points: Vec<Vec<usize>> = runs(&study, false)
        .unwrap()
        .into_iter()
        .map(|r| r.choice)
        .collect();
    assert_eq!(points, [[1, 0], [0, 0], [2, 0], [1, 1]]);
    for (lines, said) in [
        (
            "\"bonds.bar.poisson_ratio\" = [0.1, 0.3]",
            "study.toml:6: the scene bar.toml does not give bonds.bar.poisson_ratio; add the value from which it changes",
        ),
        (
            "\"bonds.bar.model\" = [0.1, 0.3]",
            "bonds.bar.model of the scene bar.toml is no number: \"timoshenko\"",
        ),
        (
            "\"bonds.bar.young_modulus\" = [\"40 MPa\", \"60 MPa\"]",
            "bonds.bar.young_modulus of the scene bar.toml is 30 MPa, outside of the range from 40 to 60",
        ),
    ] {
        let found = settled(lines, scene).unwrap_err();
        assert!(found.contains(said), "{found}");
    }
}
