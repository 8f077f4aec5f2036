//! The curve and the crack as pictures.

use dem_laboratory::Specimen;
use dem_laboratory::TestType;
use dem_laboratory::theory::Beam;
use dem_rig::crack::{CrackPicture, crack_map};
use dem_rig::curve::rows_of;
use dem_rig::files::curve;

use super::evaluation::{PLACES, evaluated, record, setup, test};

const BEAM: Beam = Beam {
    span_m: 0.17,
    loading_span_m: 0.08,
    width_m: 0.03,
    height_m: 0.035,
};

#[test]
fn the_curve_has_the_lines_of_the_load_the_body_and_the_theory() {
    let record = record(2e4, 50.0);
    let test = test(TestType::FourPointBending);
    let result = evaluated(&test, &setup(Specimen::Beam(BEAM)), &record, true);
    let plot = curve(&rows_of(&record, result.lowest_frequency_hz), &result, &[]);
    let names: Vec<&str> = plot.lines.iter().map(|line| line.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "crosshead travel",
            "deflection of the specimen",
            "target: stiffness"
        ]
    );
    // The body's line passes through the origin and ends at the break.
    let of_body = &plot.lines[1].points;
    assert!(of_body[0].iter().all(|x| x.abs() < 1e-9));
    let end = of_body.last().unwrap();
    assert!((end[0] - 50.0 / 2e4).abs() < 1e-9 && (end[1] - 50.0).abs() < 1e-9);
    let theory = &plot.lines[2].points;
    let stiffness = BEAM.stiffness_n_m(12.05e6, 0.3, 5.0 / 6.0);
    assert!((theory[1][1] / theory[1][0] / stiffness - 1.0).abs() < 1e-9);
    let (wanted, _) = plot.reference.clone().unwrap();
    assert!((wanted / BEAM.force_n(0.21e6) - 1.0).abs() < 1e-12);
    assert!(plot.svg().file().contains("displacement (mm)"));
}

#[test]
fn the_crack_is_drawn_where_the_bonds_were() {
    let setup = setup(Specimen::Beam(BEAM));
    // Two particles at opposite corners: the picture extends from 0 to 180 mm and from 0 to 35 mm.
    let spheres = [[0.001, 0.015, 0.001, 0.001], [0.179, 0.015, 0.034, 0.001]];
    let broken = [(PLACES[0], 0.8), (PLACES[1], 1.0)];
    let picture = CrackPicture {
        setup: &setup,
        spheres: &spheres,
        broken: &broken,
        crack: None,
    };
    let text = crack_map(&picture).svg().file();
    assert!(text.starts_with("<svg "));
    assert!(text.trim_end().ends_with("</svg>"));
    let dots: Vec<[f64; 2]> = text
        .split_once("<g class=\"dots\">")
        .unwrap()
        .1
        .split_once("</g>")
        .unwrap()
        .0
        .lines()
        .filter_map(|line| {
            let number = |key: &str| -> Option<f64> {
                let (_, rest) = line.split_once(key)?;
                rest.split('"').next()?.parse().ok()
            };
            Some([number("cx=\"")?, number("cy=\"")?])
        })
        .collect();
    let scale = (640.0 - 48.0) / 0.18;
    for (dot, (place, _)) in dots.iter().zip(&broken) {
        assert!((dot[0] - (24.0 + scale * place[0])).abs() < 0.06, "{dot:?}");
        assert!(
            (dot[1] - (44.0 + scale * (0.035 - place[2]))).abs() < 0.06,
            "{dot:?}"
        );
    }
    assert_eq!(dots.len(), 2);
    // Early and late.
    assert!(text.contains("fill=\"#440154\"/>\n") && text.contains("fill=\"#fde725\"/>\n"));
    assert!(text.contains("2 broken bonds"));
}
