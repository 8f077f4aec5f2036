//! The notched concrete beams of tests/verification/quasi-static-breakage.md.

mod measured;
#[cfg(test)]
mod tests;

use dem_plots::{Line, Plot};

use self::measured::{Load, MEASURED, Measured, OPENINGS_M, measured};
use crate::bench::{Bench, Failed, Run};
use crate::cells::{
    columns, least_to_most, mean, median, over, scattered, thousands, three_digits,
};
use crate::fracture::material::Material;
use crate::fracture::shapes::{Spheres, across, cut, row};
use crate::fracture::specimen::{Curve, Specimen};
use crate::plots::draw;
use crate::table::{Table, write};

pub(crate) const PAGE: &str = "tests/verification/quasi-static-breakage.md";
const WORDS: &str = "concrete";
/// Width of the measured beams, and of the slice of them that is computed, m.
const WIDTH_M: f64 = 0.05;
const SLICE_M: f64 = 0.025;
/// Diameter of the spheres, m: six across the ligament of the half-notched beam.
const DIAMETER_M: f64 = 0.025 / 6.0;
const PACKINGS: u32 = 3;
/// Rounds in which the bonds are found.
const ROUNDS: usize = 2;
/// Bonds over concrete at first: modulus, fracture energy, strength.
const GUESS: [f64; 3] = [0.6, 0.09, 0.27];
const DENSITY_KG_M3: f64 = 2346.0;
/// Distance of the points between which the opening is measured from the notch, m.
const GAUGE_M: f64 = 0.01;
/// Travel of the load in the time of a stroke, m; and that time over span^2/(height c) of the first
/// beam.
const STROKE_M: f64 = 20e-6;
const PERIODS: f64 = 20.0;

/// A beam with a notch from below, bent at three points.
#[derive(Debug)]
pub(crate) struct Beam {
    pub(crate) name: &'static str,
    /// Length, height, span and depth of the notch, m.
    length_m: f64,
    height_m: f64,
    span_m: f64,
    notch_m: f64,
    /// Distance of the load from the plane of the notch, m.
    offset_m: f64,
    /// Strokes up to the end.
    strokes: f64,
    /// The concrete: modulus, Pa, fracture energy, J/m2, strength, Pa.
    concrete: [f64; 3],
}

/// Of Gregoire et al. 2013, and of Garcia-Alvarez et al. 2012; their concretes as Hobbs 2021 used
/// them.
const BEAMS: [Beam; 2] = [
    Beam {
        name: MEASURED[0],
        length_m: 0.175,
        height_m: 0.05,
        span_m: 0.125,
        notch_m: 0.025,
        offset_m: 0.0,
        strokes: 4.4,
        concrete: [37e9, 143.2, 3.9e6],
    },
    Beam {
        name: MEASURED[1],
        length_m: 0.25,
        height_m: 0.08,
        span_m: 0.2,
        notch_m: 0.02,
        offset_m: 0.05,
        strokes: 3.5,
        concrete: [33.8e9, 125.2, 3.5e6],
    },
];

/// A row of computed loads.
#[derive(Debug, Clone, Copy)]
struct Case {
    beam: &'static Beam,
    name: &'static str,
    packings: u32,
    diameter_m: f64,
    /// Whether the bonds are scaled by the ratios of both concretes.
    is_scaled: bool,
    /// Times of the usual pace.
    slower: f64,
}

const fn case(beam: usize, name: &'static str, packings: u32) -> Case {
    Case {
        beam: &BEAMS[beam],
        name,
        packings,
        diameter_m: DIAMETER_M,
        is_scaled: false,
        slower: 1.0,
    }
}

const TUNED: Case = case(0, "half-notched, bonds found on it", PACKINGS);
const COARSE: Case = Case {
    diameter_m: 2.0 * DIAMETER_M,
    ..case(0, "half-notched, spheres twice as large", 1)
};
const CASES: [Case; 5] = [
    TUNED,
    Case {
        slower: 2.0,
        ..case(0, "half-notched, at half the speed, packing 1", 1)
    },
    COARSE,
    case(1, "mixed mode, predicted: bonds unchanged", 2),
    Case {
        is_scaled: true,
        ..case(1, "mixed mode, bonds scaled to its concrete, packing 1", 1)
    },
];

/// Parts of the ligament, from the notch to the face.
const PARTS: [&str; 5] = [
    "0 to 0.2",
    "0.2 to 0.4",
    "0.4 to 0.6",
    "0.6 to 0.8",
    "0.8 to 1",
];

pub(crate) fn tables() -> [Table; 3] {
    let bonds = "bonds | concrete of the half-notched beam | bonds, found on this beam | \
        bonds over concrete | concrete of the mixed-mode beam | bonds scaled to it";
    let names = [
        "modulus, GPa",
        "fracture energy, J/m2",
        "tensile strength, MPa",
    ];
    let loads = "beam | packings | spheres | largest load, N | at an opening of, um | \
        load at 20 um, N | at 50 um | at 100 um | work up to 100 um, mJ | \
        inside of the band";
    let mut rows = Vec::new();
    for beam in &BEAMS {
        rows.push(format!("{}, measured", beam.name));
        let own = CASES.iter().filter(|case| case.beam.name == beam.name);
        rows.extend(own.map(|case| case.name.to_owned()));
    }
    let path = "height above the notch, of the ligament | half-notched: crack beside the plane of \
        the notch, mm | mixed mode: towards the load, mm | the straight line to the load, mm";
    [
        Table::new(PAGE, WORDS, bonds, names),
        Table::new(PAGE, WORDS, loads, rows),
        Table::new(PAGE, WORDS, path, PARTS),
    ]
}

/// The bonds of a case, if these are those of the half-notched beam.
fn material(case: &Case, bonds: [f64; 3]) -> Material {
    let [first, own] = [BEAMS[0].concrete, case.beam.concrete];
    let ratio = |at: usize| {
        if case.is_scaled {
            own[at] / first[at]
        } else {
            1.0
        }
    };
    let bonds = std::array::from_fn(|at| bonds[at] * ratio(at));
    Material::tensile(bonds, case.beam.concrete[0], DENSITY_KG_M3)
}

/// A beam between rows of spheres; its notch lies in the plane x = 0.
fn specimen(
    bench: Option<&Bench>,
    case: &Case,
    material: &Material,
    seed: u32,
) -> Result<Specimen, Failed> {
    let beam = case.beam;
    let spheres = Spheres {
        diameter_m: case.diameter_m,
        seed,
    };
    let size_m = [beam.length_m, SLICE_M, beam.height_m];
    let name = beam.name.replace(' ', "-");
    let mut body = spheres.packed(bench, &name, size_m, 4)?;
    for place in &mut body.positions {
        place[0] += beam.offset_m;
    }
    let tip_m = beam.notch_m - 0.5 * beam.height_m;
    cut(&mut body, 0, |[_, _, z_m]| z_m < tip_m);
    let pins = |x_m: f64, up: f64| {
        row(&body, spheres.diameter_m, SLICE_M, |[x, _, z]| {
            (x - x_m).abs() - up * z
        })
    };
    let half_m = 0.5 * beam.span_m;
    let held = [-half_m, half_m].map(|x_m| pins(beam.offset_m + x_m, -1.0));
    let load = pins(beam.offset_m, 1.0);
    let [gauge_a, gauge_b] = [-GAUGE_M, GAUGE_M].map(|x_m| pins(x_m, -1.0));
    let (first, periods) = (&BEAMS[0], case.slower * PERIODS);
    Ok(Specimen {
        name: format!("{name}-{}-{}", spheres.name(), case.slower),
        most_broken: 2 * across(&body, 0),
        groups: [held.concat(), load.clone(), load, gauge_a, gauge_b],
        body,
        axis: 2,
        gauge_axis: 0,
        travel_m: -STROKE_M,
        time_s: periods * first.span_m.powi(2) / (first.height_m * material.speed_m_s()),
        start: 1.0,
        strokes: beam.strokes,
        span_m: beam.span_m,
    })
}

/// Load of the whole width over opening, and the bonds that broke: x and height above the notch, m.
struct Bent {
    points: Vec<[f64; 2]>,
    broken: Vec<[f64; 2]>,
    spheres: usize,
}

impl Bent {
    fn of(beam: &Beam, curve: &Curve, run: &Run, spheres: usize) -> Result<Self, Failed> {
        let of_slice = WIDTH_M / SLICE_M;
        let load = |at: usize| [curve.rows[at][2], of_slice * curve.load_n(at)];
        let events = run.words("events.csv", ["event", "x_m", "z_m"])?;
        let broken = events.iter().filter(|[event, ..]| event == "bond_broken");
        let tip_m = beam.notch_m - 0.5 * beam.height_m;
        let place =
            |[_, x_m, z_m]: &[String; 3]| Ok([x_m.parse::<f64>()?, z_m.parse::<f64>()? - tip_m]);
        Ok(Self {
            points: (0..curve.rows.len()).map(load).collect(),
            broken: broken.map(place).collect::<Result<_, Failed>>()?,
            spheres,
        })
    }

    /// The median of x of the bonds that broke in each part of the ligament, m.
    fn path_m(&self, beam: &Beam) -> [f64; 5] {
        let ligament_m = beam.height_m - beam.notch_m;
        std::array::from_fn(|at| {
            let part = |[_, z_m]: &&[f64; 2]| (5.0 * z_m / ligament_m).floor() == at as f64;
            let own: Vec<f64> = self
                .broken
                .iter()
                .filter(part)
                .map(|[x_m, _]| *x_m)
                .collect();
            if own.is_empty() {
                f64::NAN
            } else {
                median(own)
            }
        })
    }
}

/// Runs a beam.
type Running<'a> = dyn Fn(&Specimen, &Material, &Beam) -> Result<Bent, Failed> + 'a;

/// The packings of a case, all bent.
fn bent(
    bench: Option<&Bench>,
    run: &Running,
    case: &Case,
    bonds: [f64; 3],
) -> Result<Vec<Bent>, Failed> {
    let material = material(case, bonds);
    let of_seed = |seed| {
        let specimen = specimen(bench, case, &material, seed)?;
        run(&specimen, &material, case.beam)
    };
    (1..=case.packings).map(of_seed).collect()
}

/// Finds the bonds: the modulus follows the load at a small opening, the strength the largest
/// load, the fracture energy the work.
fn found(bench: &Bench, run: &Running, measured: &Measured) -> Result<[f64; 3], Failed> {
    let wanted = measured.loads().map(|[low, high]| 0.5 * (low + high));
    let start = BEAMS[0].concrete;
    let mut bonds = std::array::from_fn(|at| three_digits(GUESS[at] * start[at]));
    for _ in 0..ROUNDS {
        let loads: Vec<_> = bent(Some(bench), run, &TUNED, bonds)?
            .iter()
            .map(|bent| Load::of(&bent.points).numbers())
            .collect();
        let loads = columns(&loads, mean);
        let over = |at: usize| wanted[at] / loads[at];
        let factors = [over(Load::EARLY), over(Load::WORK), over(Load::LARGEST)];
        let powers = [1.0, 1.0, 1.5];
        bonds = std::array::from_fn(|at| three_digits(bonds[at] * factors[at].powf(powers[at])));
    }
    Ok(bonds)
}

/// The cells of computed loads.
fn load_cells(bent: &[Bent], band: &[[f64; 2]; 7]) -> Vec<String> {
    let rows: Vec<_> = bent
        .iter()
        .map(|bent| Load::of(&bent.points).numbers())
        .collect();
    let means = columns(&rows, mean);
    let shown = over(&rows, [0, 1, 0, 0, 0, 1, 0]);
    let compared = [
        Load::LARGEST,
        Load::AT[0],
        Load::AT[1],
        Load::AT[2],
        Load::WORK,
    ];
    let inside = compared
        .iter()
        .filter(|at| (band[**at][0]..=band[**at][1]).contains(&means[**at]));
    let spheres: Vec<f64> = bent.iter().map(|bent| bent.spheres as f64).collect();
    let mut cells = vec![bent.len().to_string(), thousands(mean(&spheres))];
    cells.extend_from_slice(&shown[..Load::EARLY]);
    cells.push(format!("{} of {}", inside.count(), compared.len()));
    cells
}

/// The cells of the measured band.
fn band_cells(band: &[[f64; 2]; 7]) -> Vec<String> {
    let mut cells = vec![String::new(); 2];
    cells.extend((0..Load::EARLY).map(|at| {
        let digits = usize::from([Load::WORK, Load::OPENING].contains(&at));
        least_to_most(&band[at], |value| format!("{value:.digits$}"))
    }));
    cells.push(String::new());
    cells
}

fn bond_table(table: &mut Table, bonds: [f64; 3]) {
    let [first, second] = [BEAMS[0].concrete, BEAMS[1].concrete];
    for (at, unit) in [1e-9, 1.0, 1e-6].into_iter().enumerate() {
        table.row([
            format!("{:.1}", unit * first[at]),
            format!("{:.2}", unit * bonds[at]),
            format!("{:.3}", bonds[at] / first[at]),
            format!("{:.1}", unit * second[at]),
            format!("{:.2}", unit * bonds[at] * second[at] / first[at]),
        ]);
    }
}

fn path_table(table: &mut Table, both: [&[Bent]; 2]) {
    let paths = [0, 1].map(|beam| {
        let paths = both[beam].iter().map(|bent| bent.path_m(&BEAMS[beam]));
        paths.collect::<Vec<_>>()
    });
    for at in 0..PARTS.len() {
        let shift = |beam: usize| {
            let all: Vec<f64> = paths[beam].iter().map(|path| 1e3 * path[at]).collect();
            scattered(&all, 1, "")
        };
        let straight_mm = 1e3 * BEAMS[1].offset_m * (at as f64 + 0.5) / 5.0;
        table.row([shift(0), shift(1), format!("{straight_mm:.0}")]);
    }
}

/// Both beams beside their measured bands.
pub(crate) fn concrete(bench: &Bench) -> Result<(), Failed> {
    let [mut of_bonds, mut of_loads, mut of_path] = tables();
    let run = |specimen: &Specimen, material: &Material, beam: &Beam| {
        let run = specimen.results(bench, material)?;
        let curve = specimen.curve(&run)?;
        Bent::of(beam, &curve, &run, specimen.body.radii.len())
    };
    let bands = [0, 1].map(|beam| measured(BEAMS[beam].name));
    let [first, second] = bands;
    let bands = [first?, second?];
    let bonds = found(bench, &run, &bands[0])?;
    bond_table(&mut of_bonds, bonds);
    let mut all = Vec::new();
    for (beam, band) in BEAMS.iter().zip(&bands) {
        let numbers = band.loads();
        of_loads.row(band_cells(&numbers));
        for case in CASES.iter().filter(|case| case.beam.name == beam.name) {
            let bent = bent(Some(bench), &run, case, bonds)?;
            of_loads.row(load_cells(&bent, &numbers));
            all.push(bent);
        }
    }
    path_table(&mut of_path, [&all[0], &all[3]]);
    plot(&bands[0], &[(&all[0], "bonds found on this beam")])?;
    plot(
        &bands[1],
        &[
            (&all[3], "predicted, bonds unchanged"),
            (&all[4], "bonds scaled"),
        ],
    )?;
    write(&[of_bonds, of_loads, of_path])
}

/// Load over opening, measured and of all packings.
fn plot(measured: &Measured, computed: &[(&Vec<Bent>, &str)]) -> Result<(), Failed> {
    let most_m = 1.2 * OPENINGS_M[2];
    let side = |at: usize, name: &str| {
        let rows = measured.rows.iter().filter(|row| row[0] <= most_m);
        Line::dashed(name, rows.map(|row| [row[0], row[at]]).collect())
    };
    let mut lines = vec![
        side(1, "measured, lower end"),
        side(2, "measured, upper end"),
    ];
    for (all, name) in computed {
        for (seed, bent) in (1..).zip(*all) {
            let points = bent.points.iter().filter(|point| point[0] <= most_m);
            lines.push(Line::new(
                format!("{name}, packing {seed}"),
                points.copied().collect(),
            ));
        }
    }
    let title = format!("{} beam", measured.beam);
    let plot = Plot::of(title, "opening (m)", "load (N)", lines);
    let name = measured.beam.replace(' ', "-");
    draw(&format!("tests/verification/concrete-{name}.svg"), &plot)
}
