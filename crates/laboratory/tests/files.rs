//! Files as test rigs write them, and damaged ones.

use std::fmt::Write;

use dem_laboratory::{ColumnChoice, Curve, Table, TestType};

use dem_testing::made_test::USUAL;

use crate::synthetic::{curve, dimensions};

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

/// A file with the last row first, of a specimen that keeps a tenth of its load: the same curve as
/// in the usual order. A rig that counts downwards keeps its order.
#[test]
fn rows_from_the_last_to_the_first() {
    let (travel_m, force_n) = USUAL.rows();
    let peak_n = force_n.iter().copied().fold(0.0, f64::max);
    let failed = force_n.iter().position(|force| *force == peak_n).unwrap();
    let force = |row: usize| {
        if row > failed {
            0.1 * peak_n
        } else {
            force_n[row]
        }
    };
    let rows: Vec<String> = (0..travel_m.len())
        .map(|row| format!("{:.6},{:.6}", 1e3 * travel_m[row], force(row)))
        .collect();
    let text = |rows: &[String]| format!("travel (mm),force (N)\n{}\n", rows.join("\n"));
    let wanted = read(&text(&rows)).unwrap();
    let backwards: Vec<String> = rows.iter().rev().cloned().collect();
    let found = read(&text(&backwards)).unwrap();
    assert_eq!(found.travel_m, wanted.travel_m);
    assert_eq!(found.force_n, wanted.force_n);
    assert!(
        found.notes[0].contains("from the last to the first"),
        "{:?}",
        found.notes
    );
    let downwards: Vec<String> = rows.iter().map(|row| format!("-{row}")).collect();
    let found = read(&text(&downwards)).unwrap();
    assert_eq!(found.travel_m, wanted.travel_m);
    assert!(
        found.notes[0].contains("its sign is reversed"),
        "{:?}",
        found.notes
    );
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
    ]
    .into_iter()
    .chain(of_other_countries())
    {
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

/// A number with signs between thousands and this decimal sign.
fn grouped(value: f64, decimals: usize, between: char, decimal: char) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
    let digits: Vec<char> = whole.chars().collect();
    let groups: Vec<String> = digits
        .rchunks(3)
        .rev()
        .map(|group| group.iter().collect())
        .collect();
    let sign = if value < 0.0 { "-" } else { "" };
    let whole = groups.join(&between.to_string());
    if fraction.is_empty() {
        format!("{sign}{whole}")
    } else {
        format!("{sign}{whole}{decimal}{fraction}")
    }
}

/// The same curve with the units, thousands, quotes and heads of other machines.
fn of_other_countries() -> Vec<String> {
    const POUND: f64 = 4.448_221_615_260_5;
    let mut made = vec![
        // An unknown unit in the row of units.
        file(
            "Time,Displacement,Force,Temperature\nSec,mm,N,quux\n",
            |x, f| format!("1.5,{x:.5},{f:.5},23.1"),
        ),
        file(
            "\"1_1\"\n\"Time\",\"Force\",\"Stroke\",\"Chamber\"\n\"sec\",\"N\",\"mm\",\"°C\"\n",
            |x, f| format!("1.5,{f:.5},{x:.5},23.1"),
        ),
        file("TIME (SEC),STROKE (MM),LOAD (KN)\n", |x, f| {
            format!("1.5,{x:.5},{:.8}", 1e-3 * f)
        }),
        file("Time (Sec),Crosshead (inch),Load (kip)\n", |x, f| {
            format!("1.5,{:.9},{:.12}", x / 25.4, 1e-3 * f / POUND)
        }),
        file("\"Crosshead (\"\")\"\t\"Load (lbf)\"\n", |x, f| {
            format!("\"{:.9}\"\t\"{:.9}\"", x / 25.4, f / POUND)
        }),
        file("Extension [mil];Load [kgf]\n", |x, f| {
            format!("{:.6};{:.9}", x / 0.0254, f / 9.806_65)
        }),
        // Commas between cells and in quoted numbers.
        file("Zeit,Verschiebung,Kraft\n(s),(mm),(N)\n", |x, f| {
            format!("\"1,5\",\"{}\",\"{}\"", comma(x), comma(f))
        }),
        // Both pages of a report: a table of results with a head of its own stands above.
        file(
            "Results\n,Maximum\n,(N)\n1,50\n2,51\n3,52\n4,53\n\nExtension,Load\n(mm),(N)\n",
            |x, f| format!("{x:.5},{f:.5}"),
        ),
        // The same travel twice, the second counted from elsewhere.
        file("Standardweg (mm);Kraft (N);Traverse (mm)\n", |x, f| {
            format!("{x:.5};{f:.5};{:.5}", 151.2 - x)
        }),
    ];
    for (between, decimal, separator) in [
        (',', '.', ','),
        ('.', ',', ';'),
        ('\'', '.', ';'),
        ('\u{202f}', ',', ';'),
        ('\u{a0}', ',', '\t'),
    ] {
        let head = format!("Extension (um){separator}Load (mN)\n");
        made.push(file(&head, |x, f| {
            let [x, f] = [(1e3 * x, 2), (1e3 * f, 2)]
                .map(|(value, decimals)| grouped(value, decimals, between, decimal));
            format!("\"{x}\"{separator}\"{f}\"")
        }));
    }
    // A head that stands again, as a rig writes it that records in blocks.
    let whole = file("", |x, f| format!("{x:.5}\t{f:.5}"));
    let lines: Vec<&str> = whole.lines().collect();
    let block = |(at, rows): (usize, &[&str])| {
        format!(
            "Timed\t{}\tSec\nTravel\tForce\nmm\tN\n{}\n",
            30 * at,
            rows.join("\n")
        )
    };
    made.push(lines.chunks(500).enumerate().map(block).collect());
    // UTF-16 without a mark is read as bytes below.
    made
}

/// Bytes of UTF-16, with and without its mark, give the text.
#[test]
fn wide_characters_are_read_without_their_mark() {
    let folder = tempfile::tempdir().unwrap();
    let text = file("Time;Weg;Kraft\nsec;mm;N\n", |x, f| {
        format!("1,5;{};{}", comma(x), comma(f))
    });
    for mark in ["", "\u{feff}"] {
        for order in [u16::to_le_bytes, u16::to_be_bytes] {
            let marked = format!("{mark}{text}");
            let bytes: Vec<u8> = marked.encode_utf16().flat_map(order).collect();
            let path = folder.path().join("curve.txt");
            std::fs::write(&path, bytes).unwrap();
            let found = dem_laboratory::read_text(&path).unwrap();
            assert!(found.trim_start_matches('\u{feff}') == text);
        }
    }
}

/// The crosshead that drives back behind the failure is cut off; a second loading is not.
#[test]
fn a_crosshead_that_drives_back_is_cut_off() {
    let head = "travel (mm),force (N)\n";
    let good = file(head, |x, f| format!("{x:.5},{f:.5}"));
    let last_mm = 1e3 * curve(&USUAL).travel_m[1199];
    for beyond in [0.9, 3.0] {
        let back = |row: usize| {
            format!(
                "{:.5},2.1\n",
                last_mm * (1.0 - beyond * f64::from(row as u32) / 50.0)
            )
        };
        let back: String = (1..=50).map(back).collect();
        let found = read(&(good.clone() + &back)).unwrap();
        assert_eq!(found.travel_m, read(&good).unwrap().travel_m);
        assert_eq!(
            found.notes,
            ["behind the failure the crosshead drives back from line 1202 on: 50 rows are cut off"]
        );
    }
    // Not where it drives back under load, or where a test follows that is half as strong.
    let rows: Vec<&str> = good.lines().skip(1).collect();
    let unloaded: String = rows[..700]
        .iter()
        .chain(rows[..700].iter().rev())
        .map(|row| format!("{row}\n"))
        .collect();
    let weak = file("", |x, f| format!("{x:.5},{:.5}", 0.4 * f));
    for other in [head.to_owned() + &unloaded, good + &weak] {
        let refused = read(&other).expect_err("refused").to_string();
        assert!(refused.contains("the travel goes back from"), "{refused}");
    }
}

/// A column of a table of a run is named as its head has it, with the unit, or without.
#[test]
fn a_column_may_be_named_with_its_unit() {
    let text = file("time_s,travel_m,displacement_m,load_n\n", |x, f| {
        format!("{x:.5},{:.8},7,{f:.5}", 1e-3 * x)
    });
    let table = Table::of(&text).unwrap();
    let named = |column: &str| ColumnChoice {
        column: Some(column.to_owned()),
        ..ColumnChoice::default()
    };
    let of = |travel: &str| Curve::of(&table, &named(travel), &ColumnChoice::default());
    assert_eq!(of("travel_m").unwrap(), of("travel").unwrap());
    assert!(of("travel_mm").is_err());
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
            "has no 3 rows with two numbers or more, one below the other; export travel and force as columns, a row for each moment",
        ),
        (
            "travel and force\nwere lost\n".to_owned(),
            "has no 3 rows with two numbers or more, one below the other; export travel and force as columns, a row for each moment",
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
            "the unit of the force is 'kg', which is unknown; add --force-unit kgf if the weight of kilograms is meant",
        ),
        (
            good.replace("travel (mm)", "travel (cubit)"),
            "the unit of the travel is 'cubit', which is unknown; add --travel-unit with one of",
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
            file("Extension (um),Load (N)\n", |x, f| {
                let whole = |value: f64| grouped(value.max(0.0).round(), 0, ',', '.');
                format!("\"{}\",\"{}\"", whole(1e3 * x), whole(f))
            }),
            "line 246: the travel is '1,001', which may be 1.001 or 1001: the file does not show which sign is the decimal one; export it without a sign between thousands",
        ),
        (
            file("Weg (mm),Kraft (N)\n", |x, f| {
                format!("{},{}", comma(x), comma(f))
            }),
            "line 2: has 4 cells below a head of 2: commas stand in numbers and between them; export it with semicolons or tabs, or with a decimal point",
        ),
        (
            good.clone() + "\n" + &good,
            "line 1204: another test begins: its travel starts again at 0.0000 mm",
        ),
        (
            good.replace("travel (mm)", "strain (%)")
                .replace("force (N)", "stress (MPa)"),
            "no column is known as the travel: 1 'strain [%]', 2 'stress [MPa]'; export travel and force instead of strain and stress",
        ),
        (
            changed(400, "1.2,1e300"),
            "line 400: the force is 1e300 N, more than any test rig has (1e9); check the number and its unit",
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
