//! Sieve curves as files.

use dem_pack::internals::parse_sieve_curve as parse;

#[test]
fn headers_units_and_separators() {
    let wanted = [1e-3, 2e-3, 4e-3];
    for text in [
        "opening_mm,passing_percent\n1,0\n2,35\n4,100\n",
        "\u{feff}Opening [mm];Passing [%]\r\n1,0;0\r\n2,0;35,0\r\n4,0;100\r\n",
        "# coarsest first\n4 mm, 100 %\n2mm, 35%\n1 mm, 0%\n",
        "size (\u{b5}m)\tfraction\n1000\t0\n2000\t0.35\n4000\t1\n",
        "sieve in cm, passing\n0.1, 0\n0.2, 0.35\n0.4, 1\n",
    ] {
        let curve = parse(text).unwrap();
        for (opening, wanted) in curve.openings_m.iter().zip(wanted) {
            assert!((opening / wanted - 1.0).abs() < 1e-15, "{text}");
        }
        for (passing, wanted) in curve.passing.iter().zip([0.0, 0.35, 1.0]) {
            assert!((passing - wanted).abs() < 1e-15, "{text}");
        }
        assert_eq!(curve.note, "");
    }
}

#[test]
fn flat_ends_are_cut_and_small_gaps_named() {
    let curve = parse("mm,%\n0.5,0\n1,0\n2,50\n4,100\n8,100\n").unwrap();
    assert_eq!(curve.openings_m, [1e-3, 2e-3, 4e-3]);
    let curve = parse("mm,%\n1,2\n2,50\n4,97\n").unwrap();
    assert_eq!((curve.passing[0], curve.passing[2]), (0.0, 1.0));
    assert!((curve.passing[1] - 48.0 / 95.0).abs() < 1e-15);
    assert!(
        curve.note.contains("2 % below") && curve.note.contains("3 % above"),
        "{}",
        curve.note
    );
}

#[test]
fn bad_curves_name_line_and_value() {
    for (text, line, value) in [
        ("mm,%\n1,0\n2,60\n3,40\n4,100\n", "line 4", "40 %"),
        ("mm,%\n1,0\n2,50\n2,60\n4,100\n", "line 4", "order"),
        ("mm,%\n1,0\n2,50\n1.5,60\n4,100\n", "line 4", "order"),
        ("mm,%\n1,20\n4,100\n", "line 2", "20 %"),
        ("mm,%\n1,0\n4,80\n", "line 3", "80 %"),
        ("mm,%\n1,0\n4,120\n", "line 3", "120 %"),
        ("mm,%\n1,-3\n4,100\n", "line 2", "-3 %"),
        ("mm,%\n0,0\n4,100\n", "line 2", "'0'"),
        ("mm,%\n-1,0\n4,100\n", "line 2", "'-1'"),
        ("opening,%\n1,0\n4,100\n", "line 2", "no unit"),
        ("1,0\n4,100\n", "line 1", "no unit"),
        ("mm,%\n1,0\nx,50\n4,100\n", "line 3", "'x'"),
        ("mm,%\n1,0\n2,y\n4,100\n", "line 3", "'y'"),
        ("mm,%\n1,0\n2,nan\n4,100\n", "line 3", "'nan'"),
        ("mm,%\n1,0\n2,30,9\n4,100\n", "line 3", "3 values"),
        ("mm,%\n1,0\n2 furlong,30\n4,100\n", "line 3", "furlong"),
        ("mm,%\n4,100\n", "", "1 sieve opening"),
        ("", "", "0 sieve openings"),
    ] {
        let error = parse(text).unwrap_err();
        assert_eq!(error.place, line, "{text}: {error}");
        assert!(error.problem.contains(value), "{text}: {error}");
    }
}
