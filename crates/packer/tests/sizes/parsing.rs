//! Valid sizes as typed by a user, and the messages for mistakes.

use super::TextFile;
use dem_pack::{Basis, Sizes};
use proptest::prelude::*;
use std::f64::consts::PI;

#[test]
fn one_size_and_descriptions() {
    let sizes = Sizes::parse(" 2.5 mm ", Basis::Mass).unwrap();
    assert_eq!(
        (sizes.min_m(), sizes.max_m(), sizes.mean_m()),
        (2.5e-3, 2.5e-3, 2.5e-3)
    );
    assert!(sizes.is_one_size());
    assert_eq!(sizes.quantile_by_number(0.3), 2.5e-3);
    assert_eq!(
        (sizes.cdf_by_number(2.4e-3), sizes.cdf_by_mass(2.5e-3)),
        (0.0, 1.0)
    );
    assert!((sizes.mean_volume_m3() / (PI / 6.0 * 2.5e-3_f64.powi(3)) - 1.0).abs() < 1e-15);
    assert_eq!(sizes.describe(), "all 2.5 mm");
    let sizes = Sizes::parse("2mm..2mm", Basis::Number).unwrap();
    assert!(sizes.is_one_size());
    let sizes = Sizes::parse("0.002..0.003", Basis::Number).unwrap();
    assert_eq!(
        sizes.describe(),
        "uniform by number, 2 mm to 3 mm, mean 2.5 mm by number and 2.597 mm by mass"
    );
    let sizes = Sizes::parse("Normal: 3mm, 0.5mm, 2mm..4mm", Basis::Number).unwrap();
    assert!(
        sizes
            .describe()
            .contains("95.45 % of it between the limits"),
        "{}",
        sizes.describe()
    );
}

#[test]
fn bad_sizes_name_value_limit_and_remedy() {
    for (text, problem, remedy) in [
        ("", "'' is not a length", "write one of"),
        ("abc", "'abc' is not a length", "write one of"),
        (
            "3mm..2mm",
            "3 mm is above the largest 2 mm",
            "smallest first",
        ),
        ("0mm", "'0mm' is not positive", "above zero"),
        ("-2mm..3mm", "'-2mm' is not positive", "above zero"),
        ("nan", "'nan' is not a length", "write one of"),
        ("inf..3mm", "'inf' is not a length", "write one of"),
        ("1e400mm", "not a finite", ""),
        ("1e300mm", "outside", "check the unit"),
        ("2 furlong", "unknown unit 'furlong'", "use one of"),
        ("2..3mm", "mix numbers", "unit at each"),
        ("2mm..3", "mix numbers", "unit at each"),
        (
            "gauss:2mm,1mm",
            "'gauss' is not a distribution",
            "lognormal",
        ),
        ("normal:2mm", "here are 1", "normal:MEAN,STD,MIN..MAX"),
        ("normal:2,5mm,0,3mm,1mm..4mm", "here are 5", "decimal point"),
        ("normal:2mm,0mm,1mm..3mm", "is 0 m", "one size"),
        ("normal:2mm,-1mm,1mm..3mm", "is -1 mm", "one size"),
        (
            "normal:2mm,1mm,3mm..1mm",
            "above the largest",
            "smallest first",
        ),
        (
            "normal:2mm,1mm,3mm..3mm",
            "both limits are 3 mm",
            "one size",
        ),
        ("normal:2mm,1mm,3mm", "'3mm' is not a range", "two dots"),
        (
            "normal:2mm,0.1mm,10mm..20mm",
            "only 0 % of the normal",
            "move MIN..MAX",
        ),
        (
            "lognormal:2mm,0.1mm,2.3mm..20mm",
            "of the lognormal",
            "move MIN..MAX",
        ),
        (
            "lognormal:-2mm,0.1mm,1mm..3mm",
            "'-2mm' is not positive",
            "above zero",
        ),
        ("weibull:2mm,0,1mm..3mm", "0 is outside", "narrower"),
        ("weibull:2mm,nan,1mm..3mm", "NaN is outside", "narrower"),
        (
            "weibull:2mm,3mm,1mm..3mm",
            "'3mm' is not a plain number",
            "without a unit",
        ),
        ("weibull:2mm,3,8mm..9mm", "of the Weibull", "move MIN..MAX"),
        ("weibull:2mm,0.1", "limit is 1000", "closer together"),
        (
            "1um..2mm",
            "a factor of 2000, the limit is 1000",
            "closer together",
        ),
        (
            "sieve:no-such-file.csv",
            "cannot read the sieve curve",
            "path of a text file",
        ),
        (
            "no-such-file.CSV",
            "cannot read the sieve curve",
            "path of a text file",
        ),
    ] {
        let error = Sizes::parse(text, Basis::Mass).expect_err(text);
        assert!(
            error.place.starts_with(&format!("--diameter '{text}'")),
            "{text}: {error}"
        );
        assert!(error.problem.contains(problem), "{text}: {error}");
        assert!(error.remedy.contains(remedy), "{text}: {error}");
        assert_eq!(error.exit_code(), 2);
    }
    let file = TextFile::new("opening_mm,%\n1,0\n2,60\n3,50\n4,100\n");
    let error = Sizes::parse(&format!("sieve:{}", file.0.display()), Basis::Mass).unwrap_err();
    assert!(error.place.ends_with(".csv: line 4"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_answered(text in "\\PC{0,40}") {
        let _ = Sizes::parse(&text, Basis::Mass);
    }

    #[test]
    fn any_nearly_good_text_is_answered(text in "(normal|lognormal|weibull|uniform|sieve|):?[-+0-9.e]{0,6}(mm|um|m|),?[-+0-9.e]{0,6}(mm|),?[0-9.]{0,4}(mm|)(\\.\\.)?[0-9.]{0,4}(mm|)") {
        if let Ok(sizes) = Sizes::parse(&text, Basis::Number) {
            prop_assert!(sizes.min_m() > 0.0 && sizes.max_m() >= sizes.min_m() && sizes.max_m().is_finite());
            prop_assert!(sizes.mean_m() >= sizes.min_m() * (1.0 - 1e-9) && sizes.mean_m() <= sizes.max_m() * (1.0 + 1e-9));
        }
    }

    #[test]
    fn quantile_and_cdf_are_inverse(
        law in 0..4usize, mean in 1.0..5.0f64, spread in 0.02..0.8f64, low in 0.1..0.9f64, high in 1.1..4.0f64,
        mass in any::<bool>(), us in proptest::collection::vec(0.0..1.0f64, 20),
    ) {
        let (min, max) = (low * mean, high * mean);
        let text = match law {
            0 => format!("{min}mm..{max}mm"),
            1 => format!("normal:{mean}mm,{}mm,{min}mm..{max}mm", spread * mean),
            2 => format!("lognormal:{mean}mm,{}mm,{min}mm..{max}mm", spread * mean),
            _ => format!("weibull:{mean}mm,{},{min}mm..{max}mm", 1.0 / spread),
        };
        let sizes = Sizes::parse(&text, if mass { Basis::Mass } else { Basis::Number }).unwrap();
        let mut previous = sizes.min_m();
        let mut us = us;
        us.sort_by(f64::total_cmp);
        for u in us {
            let d = sizes.quantile_by_number(u);
            prop_assert!(d >= sizes.min_m() && d <= sizes.max_m() && d >= previous);
            prop_assert!((sizes.cdf_by_number(d) - u).abs() < 1e-9, "{} {} {}", text, u, sizes.cdf_by_number(d));
            prop_assert!(sizes.cdf_by_mass(d) <= sizes.cdf_by_number(d) + 1e-8);
            previous = d;
        }
        let first = sizes.quantile_by_number(0.0);
        prop_assert!(first >= sizes.min_m() && sizes.cdf_by_number(first) < 1e-9);
        let last = sizes.quantile_by_number(1.0);
        prop_assert!(last <= sizes.max_m() * (1.0 + 1e-15) && sizes.cdf_by_number(last) > 1.0 - 1e-9);
    }
}
