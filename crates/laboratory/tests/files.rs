//! Files as test rigs write them, and damaged ones.

use std::fmt::Write;

use dem_laboratory::{ColumnChoice, Curve, Table, TestType, evaluate};

use dem_testing::made_test::{Made, USUAL};

use crate::synthetic::{curve, dimensions, specimen};

fn read(text: &str) -> dem_io::Result<Curve> {
    Curve::of(
        &Table::of(text)?,
        &ColumnChoice::default(),
        &ColumnChoice::default(),
    )
}

/// A file of the usual test: `row` writes each row from travel, mm, and force, N.
fn file(head: &str, row: impl Fn(f64, f64) -> String) -> String {
    let (travel_m, force_n) = USUAL.rows();
    let mut text = head.to_owned();
    for (travel_m, force_n) in travel_m.iter().zip(force_n) {
        let _ = writeln!(text, "{}", row(1e3 * travel_m, force_n));
    }
    text
}

fn comma(value: f64) -> String {
    format!("{value:.5}").replace('.', ",")
}

/// Equal curves come out of all of them.
#[test]
fn files_of_many_kinds_give_the_same_curve() {
    let wanted = curve(&USUAL);
    for text in [
        file("travel (mm),force (N)\n", |x, f| format!("{x:.5},{f:.5}")),
        file("\u{feff}Travel [mm];Force [N]\n", |x, f| {
            format!("{x:.5};{f:.5}")
        }),
        file(
            "Probe 7\nDatum;12.3.2024\n\nZeit;Standardweg;Standardkraft\ns;mm;N\n",
            |x, f| format!("{};{};{}", comma(x), comma(x), comma(f)),
        ),
        file(
            "\"Time\"\t\"Displacement in um\"\t\"Load in kN\"\n",
            |x, f| format!("\"{x:.2}\"\t\"{:.4}\"\t\"{:.9}\"", 1e3 * x, 1e-3 * f),
        ),
        file("# Travel [mm]  Force [N]\n", |x, f| {
            format!("  {x:.6e}   {f:.6e}")
        }),
        file("Travel [mm] Force [N]\n", |x, f| {
            format!("{} {}", comma(x), comma(f))
        }),
        file("Force / N | Stroke / mm | Note\n", |x, f| {
            format!("{f:.5} | {x:.5} | ok")
        }),
        file("travel_m,load_n\n", |x, f| {
            format!("{:.8},{f:.5}", 1e-3 * x)
        }) + "\nend of test\n",
        // Pressed: travel and force are negative.
        file("Weg (mm);Kraft (N)\r\n", |x, f| {
            format!("{:.5};{:.5}\r", -x, -f)
        }),
    ] {
        let found = read(&text).unwrap_or_else(|error| panic!("{error}\n{}", &text[..200]));
        assert_eq!(found.travel_m.len(), wanted.travel_m.len());
        for (a, b) in found.travel_m.iter().zip(&wanted.travel_m) {
            assert!((a - b).abs() < 6e-9, "{a} {b}");
        }
        for (a, b) in found.force_n.iter().zip(&wanted.force_n) {
            assert!((a - b).abs() < 6e-6, "{a} {b}");
        }
    }
}

#[test]
fn columns_and_units_can_be_named() {
    let text = file("", |x, f| format!("{x:.1};{f:.5};{x:.5}"));
    let named = |column: &str, unit: &str| ColumnChoice {
        column: Some(column.to_owned()),
        unit: Some(unit.to_owned()),
    };
    let table = Table::of(&text).unwrap();
    let found = Curve::of(&table, &named("3", "mm"), &named("2", "N")).unwrap();
    assert!((found.travel_m[700] - curve(&USUAL).travel_m[700]).abs() < 6e-9);
}

/// The message of each damaged file.
#[test]
fn damaged_files_have_one_clear_message() {
    let head = "travel (mm),force (N)\n";
    let good = file(head, |x, f| format!("{x:.5},{f:.5}"));
    let lines: Vec<&str> = good.lines().collect();
    let changed = |line: usize, text: &str| {
        let mut lines = lines.clone();
        lines[line - 1] = text;
        lines.join("\n")
    };
    let without = |from: usize, to: usize| [&lines[..from - 1], &lines[to..]].concat().join("\n");
    let all_files = [
        (
            String::new(),
            "has no rows with two numbers or more; export travel and force as columns, a row for each moment",
        ),
        (
            "travel and force\nwere lost\n".to_owned(),
            "has no rows with two numbers or more; export travel and force as columns, a row for each moment",
        ),
        (
            lines[..12].join("\n"),
            "has 11 rows of numbers; a curve takes at least 20: export the entire test",
        ),
        (
            changed(400, "1.2,overflow"),
            "line 400: the force is 'overflow', not a number; correct or remove this line",
        ),
        (
            changed(400, "1.2,"),
            "line 400: the force is missing; correct or remove this line",
        ),
        (
            changed(400, "1.2"),
            "line 400: the force is missing; correct or remove this line",
        ),
        (
            changed(400, "1.2,1.5e400"),
            "line 400: the force is '1.5e400', not a number; correct or remove this line",
        ),
        (
            changed(400, "1.2,nan"),
            "line 400: the force is 'nan', not a number; correct or remove this line",
        ),
        (
            changed(400, "1,234.5,17"),
            "line 400: has 3 cells, where 2 are usual; correct or remove this line",
        ),
        (
            without(500, 700),
            "line 500: the travel jumps from 2.0398 to 2.8688 mm",
        ),
        (
            good.clone() + &lines[2..].join("\n"),
            "line 1202: the travel goes back from",
        ),
        (
            good.replace(" (N)", ""),
            "the unit of the force is not in the head of its column; add --force-unit N",
        ),
        (
            good.replace(" (N)", " (kg)"),
            "the unit of the force is 'kg', which is unknown; add --force-unit with one of",
        ),
        (
            good.replace("travel (mm)", "travel (inch)"),
            "the unit of the travel is 'inch', which is unknown; add --travel-unit with one of",
        ),
        (
            good.replace(head, ""),
            "the unit of the travel is not in the head of its column; add --travel-unit mm",
        ),
        (
            good.replace("travel", "strain").replace("(mm)", "(%)"),
            "no column is known as the travel: 1 'strain [%]', 2 'force [N]'; name one by --travel-column NAME or its number",
        ),
        (
            file("travel (mm),force (N),load (kN)\n", |x, f| {
                format!("{x:.5},{f:.5},{f:.5}")
            }),
            "several columns may be the force: 2 'force [N]', 3 'load [kN]'; name one by --force-column NAME or its number",
        ),
    ];
    for (text, wanted) in &all_files {
        let error = read(text).expect_err(wanted);
        assert_eq!(error.exit_code(), 2);
        let said = error.to_string();
        assert!(said.starts_with(wanted), "{said}\nnot\n{wanted}");
    }
}

/// Curves that can be read and mean nothing are left out, and it is said why.
#[test]
fn doubtful_specimens_are_named() {
    let doubts = |made: &Made| evaluate(vec![specimen("a", made)])[0].doubts.clone();
    assert_eq!(doubts(&USUAL), Vec::<String>::new());
    let first = |made: &Made| doubts(made).into_iter().next().unwrap_or_default();
    let seating = first(&Made {
        seating_m: 3.2e-3,
        ..USUAL
    });
    assert!(seating.starts_with("its seating takes 1."), "{seating}");
    let whole = first(&Made {
        tail: 0.95,
        ..USUAL
    });
    assert_eq!(
        whole,
        "it did not fail: the force is still 95 % of its largest at the end"
    );
    let begun = first(&Made {
        before_m: 0.0,
        seating_m: 0.0,
        ..USUAL
    });
    assert_eq!(
        begun,
        "it begins in contact: the offset of the load cell is taken to be 0"
    );
    let bent = first(&Made {
        bend: 0.05,
        seating_m: 0.0,
        noise_n: 0.005,
        ..USUAL
    });
    assert!(bent.starts_with("it has no linear part"), "{bent}");
}

#[test]
fn two_peaks_cracks_outside_and_other_units_are_named() {
    let mut slipped = specimen("slipped", &USUAL);
    for (at, force) in slipped.curve.force_n.iter_mut().enumerate() {
        if (600..660).contains(&at) {
            *force *= 0.5;
        }
    }
    let mut outside = specimen("outside", &USUAL);
    outside.crack_m = Some(-0.05);
    let mut kilo = specimen("kilo", &USUAL);
    kilo.curve
        .force_n
        .iter_mut()
        .for_each(|force| *force *= 1e-3);
    let good = ["a", "b", "c"].map(|name| specimen(name, &USUAL));
    let all = good.into_iter().chain([slipped, outside, kilo]).collect();
    let found = evaluate(all);
    let doubts: Vec<&str> = found
        .iter()
        .flat_map(|one| &one.doubts)
        .map(String::as_str)
        .collect();
    assert!(
        doubts[0].starts_with("it has two peaks: the force falls from"),
        "{doubts:?}"
    );
    assert_eq!(
        doubts[1],
        "it cracked 50.0 mm from the middle, outside the loading pins at 40.0 mm"
    );
    assert!(
        doubts[2].contains("one of them is in another unit"),
        "{doubts:?}"
    );
    assert_eq!(doubts.len(), 3, "{doubts:?}");
}

#[test]
fn dimensions_that_do_not_fit_are_refused() {
    let refused = |test, dimensions| {
        dem_laboratory::Specimen::new(test, &dimensions)
            .expect_err("refused")
            .to_string()
    };
    let all = dimensions();
    let with = |change: &dyn Fn(&mut dem_laboratory::Dimensions)| {
        let mut changed = all;
        change(&mut changed);
        changed
    };
    for (test, dimensions, wanted) in [
        (
            TestType::FourPointBending,
            with(&|d| d.width_m = None),
            "four-point-bending needs the width; add --width 30mm",
        ),
        (
            TestType::FourPointBending,
            with(&|d| d.height_m = Some(0.0)),
            "the height is 0, not above 0; correct --height",
        ),
        (
            TestType::ThreePointBending,
            all,
            "the loading span does not apply to three-point-bending; leave out --loading-span",
        ),
        (
            TestType::FourPointBending,
            with(&|d| d.loading_span_m = Some(0.2)),
            "the loading span of 0.2 m is not below the support span of 0.18 m; correct one of them",
        ),
    ] {
        assert_eq!(refused(test, dimensions), wanted);
    }
}
