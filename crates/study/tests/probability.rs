//! The probability of an outcome over a parameter.

use dem_laboratory::logistic::{Logistic, Trials, wilson};
use dem_results::summary::Verdict;
use dem_study::outcome::{Done, Outcome};
use dem_study::page::page;
use dem_study::probability::Probability;
use dem_study::probability_page::{probability_csv, probability_fit_csv, probability_plots};
use dem_study::sweep_table::SweepTable;

use super::made::{assert_near, done, study, table, table_of};

const STUDY: &str = r#"
[vary]
"run.seed" = [1, 2, 3, 4]
"bodies.bar.drop.height" = ["3 m", "1 m", "2 m"]
[probability]
of = "largest"
below = 0.9
over = "bodies.bar.drop.height"
[measures.largest]
reference = "none"
"#;
const CASES: &str = "\"bonds.bar.model\" = [\"parallel\", \"timoshenko\"]\n[probability]";

/// How many of the four seeds break at 3, 1 and 2 m.
fn breaks(counts: [usize; 3]) -> impl Fn(&dem_study::expand::Run) -> Done {
    move |run| {
        let is_broken = run.choice[0] < counts[run.choice[1]];
        done(1.0, &[if is_broken { 0.5 } else { 1.0 }])
    }
}

fn of(table: &SweepTable) -> &Probability {
    table.probability.as_ref().unwrap()
}

#[test]
fn fractions_and_curve() {
    let table = table(&study(STUDY), breaks([3, 1, 2]));
    let of = of(&table);
    assert_eq!((of.limit, of.is_below, of.is_log), (0.9, true, false));
    let [case] = &of.cases[..] else {
        panic!("{:?}", of.cases)
    };
    assert_eq!(case.settings, "");
    let points = case
        .points
        .iter()
        .map(|p| (p.value, p.runs, p.with_outcome));
    assert!(points.eq([(1.0, 4, 1), (2.0, 4, 2), (3.0, 4, 3)]));
    assert_eq!(case.points[0].fraction, 0.25);
    assert_eq!(case.points[0].between, wilson(4, 1));
    let trials = [(1.0, 1), (2.0, 2), (3.0, 3)].map(|(x, with_outcome)| Trials {
        x,
        runs: 4,
        with_outcome,
    });
    let wanted = Logistic::fit(&trials).unwrap();
    let fit = case.fit.as_ref().unwrap();
    assert_eq!([fit.a, fit.b], wanted.coefficients());
    assert_eq!(case.points[1].fitted.unwrap()[0], wanted.probability(2.0));
    assert_eq!(fit.values[0], wanted.value_at(0.5).unwrap());
    assert_eq!(fit.at_none, [0.1]);
    assert!(!fit.depends);
    assert!(table.notes.iter().any(|note| note.starts_with(
        "the runs do not show that the probability depends on bodies.bar.drop.height"
    )));

    let text = table.to_string();
    let line = text
        .lines()
        .find(|line| line.starts_with("probability"))
        .unwrap();
    assert!(
        line.starts_with("probability  largest below 0.9 over bodies.bar.drop.height: 10 % at no value above 0, 50 % at 2 m "),
        "{line}"
    );
    assert!(line.ends_with("; 6 of 12 runs"), "{line}");
    assert!(page(&table).contains("logistic curve"));
    let csv = probability_csv(&table, of);
    let mut lines = csv.lines();
    assert_eq!(
        lines.next().unwrap(),
        "bodies.bar.drop.height (m),runs,with_outcome,doubtful,fraction,fraction_from,fraction_to,fitted,fitted_from,fitted_to"
    );
    assert!(lines.next().unwrap().starts_with("1,4,1,0,0.25,"));
    assert_eq!(lines.count(), 2);
    let csv = probability_fit_csv(&table, of);
    assert!(
        csv.starts_with("runs,with_outcome,a,b,at_10 (m),at_10_from (m),at_10_to (m),at_50 (m),"),
        "{csv}"
    );
    assert_eq!(probability_plots(&table, of).len(), 1);
}

/// A flat curve reaches far: heights of a fall end at 0, positions do not.
#[test]
fn a_height_is_never_negative() {
    let seeds: Vec<u32> = (1..=20).collect();
    let falls = STUDY.replace("[1, 2, 3, 4]", &format!("{seeds:?}"));
    let position = falls
        .replace("bodies.bar.drop.height", "walls.floor.plane.point")
        .replace(
            "[\"3 m\", \"1 m\", \"2 m\"]",
            "[[0, 0, \"3 m\"], [0, 0, \"1 m\"], [0, 0, \"2 m\"]]",
        );
    let [height, position] =
        [falls, position].map(|lines| table(&study(&lines), breaks([16, 10, 12])));
    let [of_height, of_position] = [&height, &position].map(of);
    let [height_fit, position_fit] =
        [of_height, of_position].map(|of| of.cases[0].fit.as_ref().unwrap());
    assert_eq!(height_fit.a, position_fit.a);
    let [ten, fifty, ninety] = &position_fit.values[..] else {
        panic!("{:?}", position_fit.values)
    };
    assert!(ten.value < 0.0 && fifty.value > 0.0);
    assert!(fifty.between[0].unwrap_or(f64::NEG_INFINITY) < 0.0 && fifty.between[1].is_some());
    assert_eq!(height_fit.at_none, [0.1]);
    assert_eq!(position_fit.at_none, [0.0; 0]);
    assert_eq!(height_fit.values[0].between, [None, fifty.between[1]]);
    assert_eq!(height_fit.values[1].value, ninety.value);
    let words = of_height.in_words(&of_height.cases[0], "largest");
    assert!(
        words.contains("height: 10 % at no value above 0, 50 % at "),
        "{words}"
    );
    assert!(!words.contains('-'), "{words}");
    let csv = probability_fit_csv(&height, of_height);
    let cells: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    // At 10 % with both ends, and the lower end at 50 %.
    assert_eq!([cells[4], cells[5], cells[6], cells[8]], [""; 4]);
    assert!(cells[7].parse::<f64>().unwrap() > 0.0);
}

#[test]
fn each_case_has_its_curve() {
    let study = study(&STUDY.replace("[probability]", CASES));
    let table = table(&study, |run| {
        let counts = [[4, 0, 2], [4, 0, 0]][run.choice[2]];
        breaks(counts)(run)
    });
    let of = of(&table);
    let settings = of.cases.iter().map(|case| case.settings.as_str());
    assert!(settings.eq(["bonds.bar.model parallel", "bonds.bar.model timoshenko"]));
    let [first, second] = [0, 1].map(|k| of.cases[k].fit.as_ref().unwrap().values[1].value);
    assert_near(first, 2.0);
    assert!(second > 2.0 && second < 3.0, "{second}");
    assert!(
        !of.cases[0].fit.as_ref().unwrap().is_separated
            || of.cases[1].fit.as_ref().unwrap().is_separated
    );
    let separated = "one value of bodies.bar.drop.height separates the runs with the outcome from those without for bonds.bar.model timoshenko";
    assert!(
        table.notes.iter().any(|note| note.starts_with(separated)),
        "{:?}",
        table.notes
    );
    assert!(
        probability_csv(&table, of).starts_with("bonds.bar.model,bodies.bar.drop.height (m),runs,")
    );
}

#[test]
fn the_logarithm_and_the_other_side() {
    let lines = STUDY.replace("below = 0.9", "above = 0.9\nspacing = \"log\"");
    let table = table(&study(&lines), breaks([3, 1, 2]));
    let case = &of(&table).cases[0];
    let trials = [(1.0_f64, 3), (2.0, 2), (3.0, 1)].map(|(x, with_outcome)| Trials {
        x: x.ln(),
        runs: 4,
        with_outcome,
    });
    let wanted = Logistic::fit(&trials).unwrap();
    let fit = case.fit.as_ref().unwrap();
    assert_eq!([fit.a, fit.b], wanted.coefficients());
    assert_near(
        fit.values[1].value,
        wanted.value_at(0.5).unwrap().value.exp(),
    );
    assert!(probability_plots(&table, of(&table))[0].x.log);
}

#[test]
fn equal_outcomes_have_a_bound_and_no_curve() {
    // 0.05^(1/12) = 0.7791.
    for (counts, words) in [
        (
            [0; 3],
            "largest below 0.9 in none of 12 runs: its mean probability in them is below 22.1 % with a confidence of 95 %; there is no curve over bodies.bar.drop.height",
        ),
        (
            [4; 3],
            "largest below 0.9 in all of 12 runs: its mean probability in them is above 77.9 % with a confidence of 95 %; there is no curve over bodies.bar.drop.height",
        ),
    ] {
        let table = table(&study(STUDY), breaks(counts));
        let of = of(&table);
        assert_eq!(of.cases[0].fit, None);
        assert_eq!(of.in_words(&of.cases[0], "largest"), words);
        assert!(page(&table).contains(words));
    }
}

#[test]
fn runs_without_values_do_not_count_and_doubtful_ones_are_named() {
    let table = table_of(&study(STUDY), |run| {
        let mut made = breaks([4, 1, 2])(run);
        vec![match run.choice.as_slice() {
            [3, 0] => Outcome::Failed("it burst".to_owned()),
            [3, 1] => Outcome::Done(done(1.0, &[f64::NAN])),
            [0, 2] => {
                made.verdict = Verdict::new(vec!["a doubt".to_owned()], Vec::new());
                Outcome::Done(made)
            }
            _ => Outcome::Done(made),
        }]
    });
    let points = &of(&table).cases[0].points;
    let counts = points.iter().map(|p| (p.runs, p.with_outcome, p.doubtful));
    assert!(counts.eq([(3, 1, 0), (4, 2, 1), (3, 3, 0)]));
}
