//! Invalid input: exit code 2, one message with the value and the remedy, no files left.

use super::{Bench, dem_pack, refusal, shape};
use std::process::Output;

/// The message of dem-pack for the box of 20 x 12 x 10 mm with these options; the folder must stay
/// empty.
fn said_of_box(options: &[&str]) -> String {
    let bench = Bench::new();
    let output = bench.run(&shape("02"), &[options, &["-o", "body.vtp"]].concat());
    let said = refusal(&output, &options.join(" "));
    assert_eq!(bench.files(), Vec::<String>::new(), "{options:?}");
    said
}

fn assert_refused(options: &[&str], parts: &[&str]) {
    let said = said_of_box(options);
    assert_eq!(said.lines().count(), 1, "{said}");
    for part in parts {
        assert!(
            said.contains(part),
            "{options:?}: '{part}' is not in: {said}"
        );
    }
}

#[test]
fn diameters() {
    assert_refused(&["-d", "3mm..2mm"], &["3 mm", "2 mm", "smallest first"]);
    assert_refused(&["-d", "0mm"], &["0mm", "not positive"]);
    assert_refused(&["-d", "0mm..2mm"], &["0mm", "not positive"]);
    assert_refused(&["--diameter=-1mm"], &["-1mm", "not positive"]);
    assert_refused(&["-d", "nan"], &["nan"]);
    assert_refused(&["-d", "NaNmm..2mm"], &["NaN"]);
    assert_refused(&["-d", "inf"], &["inf"]);
    assert_refused(&["-d", "1e999mm"], &["1e999"]);
    assert_refused(&["-d", ""], &["--diameter"]);
    assert_refused(&["-d", "two"], &["two"]);
    assert_refused(&["-d", "2parsec"], &["unknown unit 'parsec'", "mm"]);
    assert_refused(&["-d", "2mm..3mm..4mm"], &["2mm..3mm..4mm"]);
    assert_refused(
        &["-d", "30mm"],
        &["no sphere fits", "10 mm", "30 mm", "smaller diameters"],
    );
    assert_refused(&["-d", "2mm..30mm"], &["largest", "10 mm", "30 mm"]);
    assert_refused(&["-d", "normal:2mm,0mm,1mm..3mm"], &["0mm"]);
    assert_refused(&["-d", "lognormal:2mm,0.1mm,8mm..9mm"], &["8 mm", "9 mm"]);
    assert_refused(&["-d", "sieve:no-such-file.csv"], &["no-such-file.csv"]);
    // Metres, by mistake.
    assert_refused(&["-d", "2"], &["no sphere fits", "2 m", "2mm..3mm"]);
    assert_refused(
        &["-d", "3..5"],
        &["'3..5'", "3 m", "20 mm", "without a unit is metres"],
    );
    assert_refused(
        &["-d", "normal:3,0.1"],
        &["normal:3", "without a unit is metres"],
    );
}

#[test]
fn numbers_out_of_range() {
    for value in ["1", "1.5", "-0.1", "nan", "inf"] {
        assert_refused(
            &["-d", "2mm", "--overlap", value],
            &["--overlap", "below 1"],
        );
    }
    for value in ["0.5", "0.081", "-0.1", "nan"] {
        assert_refused(
            &["-d", "2mm", "--densify", value],
            &["--densify", &value.replace("nan", "NaN"), "at most 0.08"],
        );
    }
    for value in ["0", "-1", "3", "nan"] {
        assert_refused(
            &["-d", "2mm", "--bond-range", value],
            &["--bond-range", "above 0"],
        );
    }
    for value in ["0", "1000", "nan"] {
        assert_refused(
            &["-d", "2mm", "--bonds-per-particle", value],
            &["--bonds-per-particle"],
        );
    }
    for value in ["0", "nan", "-1"] {
        assert_refused(&["-d", "2mm", "--bond-radius", value], &["--bond-radius"]);
    }
    for value in ["0", "nan", "-2 kg/m3", "2 stone"] {
        let option = format!("--particle-density={value}");
        assert_refused(&["-d", "2mm", &option], &["--particle-density"]);
    }
    for value in ["0", "nan", "inf", "-1"] {
        let option = format!("--scale={value}");
        assert_refused(&["-d", "2mm", &option], &["--scale"]);
    }
    assert_refused(&["-d", "2mm", "--threads", "0"], &["--threads"]);
    assert_refused(
        &["-d", "2mm", "--unit", "furlong"],
        &["--unit", "'furlong'", "mm"],
    );
}

#[test]
fn options_that_do_not_go_together() {
    for options in [
        &["-d", "2mm", "--solid-density", "1650"][..],
        &[
            "-d",
            "2mm",
            "--solid-density",
            "1650",
            "--particle-density",
            "2050",
            "--overlap",
            "0.2",
        ],
        &[
            "-d",
            "2mm",
            "--bonds-per-particle",
            "5",
            "--bond-range",
            "1.1",
        ],
        &["-d", "2mm", "--basis", "volume"],
        &["-d", "2mm", "--no-such-option"],
        &[],
    ] {
        said_of_box(options);
    }
    let bench = Bench::new();
    let said = refusal(
        &bench.run(&shape("02"), &["-d", "2mm", "--json"]),
        &"--json without -o",
    );
    assert!(said.contains("--output"), "{said}");
}

#[test]
fn a_seed_point_outside_is_told_where_inside_is() {
    for (name, outside) in [
        ("02", "100mm,0mm,0mm"),
        ("22", "0,0,0"),
        ("09", "0mm,0mm,0mm"),
        ("02", "10mm,6mm,-1um"),
    ] {
        let bench = Bench::new();
        let output = bench.run(
            &shape(name),
            &["-d", "2mm..3mm", "--seed-point", outside, "-o", "body.vtp"],
        );
        let said = refusal(&output, &outside);
        assert!(said.starts_with("error: --seed-point: ("), "{said}");
        assert!(bench.files().is_empty());
        // The point named in the message, copied literally, works.
        let named = said
            .rsplit_once("inside is (")
            .unwrap()
            .1
            .trim_end_matches(')')
            .replace(' ', "");
        let made = bench.pack(&shape(name), &["-d", "2mm..3mm", "--seed-point", &named]);
        assert!(made.body.radii.len() > 50, "{named}");
    }
    assert_refused(
        &["-d", "2mm", "--seed-point", "1mm,2mm"],
        &["--seed-point", "'1mm,2mm'"],
    );
    assert_refused(
        &["-d", "2mm", "--seed-point", "1mm,2mm,x"],
        &["--seed-point", "'x'"],
    );
    assert_refused(
        &["-d", "2mm", "--seed-point", "nan,0,0"],
        &["--seed-point", "nan"],
    );
}

fn run_here(bench: &Bench, arguments: &[&str]) -> Output {
    dem_pack()
        .current_dir(bench.folder.path())
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn outputs_that_cannot_be() {
    let bench = Bench::new();
    let file = shape("02");
    for (output, part) in [
        ("none/body.vtp", "there is no folder 'none'"),
        ("body.foo", "'.foo'"),
        ("body", "no ending"),
        ("body.stl", "'.stl'"),
    ] {
        let said = refusal(&bench.run(&file, &["-d", "2mm", "-o", output]), &output);
        assert!(said.contains(output) && said.contains(part), "{said}");
    }
    assert!(bench.files().is_empty());
}

#[test]
fn files_that_are_not_there() {
    let bench = Bench::new();
    for arguments in [
        &["none.stl", "-d", "2mm", "-o", "body.vtp"][..],
        &["info", "none.stl"],
        &["info", "none.vtp"],
        &["convert", "none.vtp", "body.csv"],
    ] {
        let said = refusal(&run_here(&bench, arguments), &arguments.join(" "));
        assert!(
            said.contains("none.") && said.contains("there is no such file"),
            "{said}"
        );
    }
    let folder = refusal(
        &run_here(&bench, &[".", "-d", "2mm", "-o", "body.vtp"]),
        &".",
    );
    assert!(folder.contains("this is a folder"), "{folder}");
    assert!(bench.files().is_empty());
}

#[test]
fn damaged_standard_input() {
    for input in [&b""[..], b"solid", b"no STL at all", &[0; 84], &[255; 500]] {
        let mut program = dem_pack();
        program.args(["-", "-d", "2mm", "-q"]);
        let said = refusal(&dem_testing::piped(&mut program, input), &"standard input");
        assert!(said.starts_with("error: standard input: "), "{said}");
    }
}

#[test]
fn arguments_that_are_not_understood_are_named_on_one_line() {
    assert_refused(
        &["-d", "2mm", "--overlap=x"],
        &["'x'", "--overlap", "--help"],
    );
    assert_refused(&[], &["--diameter", "--help"]);
    assert_refused(
        &["-d", "2mm", "--overlp", "0.1"],
        &["--overlp", "'--overlap'"],
    );
    for seed in ["-1", "1.5", "x", "18446744073709551616"] {
        assert_refused(
            &["-d", "2mm", "--seed", seed],
            &[seed, "a whole number from 0 to 18446744073709551615"],
        );
    }
}
