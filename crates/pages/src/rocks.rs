//! tests/verification/rocks.md: bonds calibrated on the slow strength and modulus of seven rocks,
//! and what they give between split-Hopkinson bars.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use dem_calibration::read_record;
use dem_laboratory::Line;
use dem_plots::{Line as PlotLine, Marks, Plot, Point};

use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, root, sets};
use crate::cells::{change, ends, mean, range, scattered};
use crate::plots::draw;
use crate::table::{Table, write};

const PAGE: &str = "tests/verification/rocks.md";
const PREDICTIONS: &str = "tests/verification/predictions/rocks.csv";
const COMPUTED: &str = "tests/rocks/computed.csv";
const MEASURED: &str = "tests/rocks/measured.csv";

/// A rock of Rae et al. 2020 and 2021: the mean of its slow tests.
struct Rock {
    name: &'static str,
    young_modulus_gpa: f64,
    poisson_ratio: f64,
    density_kg_m3: f64,
    /// Slow strength, MPa: mean and standard deviation.
    strength_mpa: [f64; 2],
}

const fn rock(
    name: &'static str,
    [young_modulus_gpa, poisson_ratio, density_kg_m3]: [f64; 3],
    strength_mpa: [f64; 2],
) -> Rock {
    Rock {
        name,
        young_modulus_gpa,
        poisson_ratio,
        density_kg_m3,
        strength_mpa,
    }
}

const ROCKS: [Rock; 7] = [
    rock("Seeberger Sandstone", [13.8, 0.373, 2130.0], [52.0, 2.0]),
    rock("Taunus Quartzite", [38.1, 0.099, 2645.0], [255.3, 49.6]),
    rock("Savonnieres Limestone", [11.5, 0.197, 1881.0], [17.5, 2.5]),
    rock("Carrara Marble", [44.8, 0.245, 2711.0], [90.2, 3.1]),
    rock("Malsburg Granite", [36.1, 0.224, 2623.0], [149.3, 48.0]),
    rock(
        "Maggia Gneiss (Parallel)",
        [39.0, 0.209, 2745.0],
        [153.8, 21.0],
    ),
    rock(
        "Maggia Gneiss (Perpendicular)",
        [33.0, 0.286, 2745.0],
        [163.3, 26.9],
    ),
];
/// Packings, the seeds of calibration and of the fast tests.
const SEEDS: u32 = 3;
const PACKING: [&str; 3] = [
    "--diameter=3.4mm..4.6mm",
    "--overlap=0.25",
    "--bond-range=1.1",
];
/// Rates that the strikers are to reach about, 1/s.
const RATES_1_S: [f64; 6] = [0.0, 20.0, 50.0, 100.0, 160.0, 240.0];
/// Rates of the predictions, 1/s.
const PREDICTED_1_S: [f64; 4] = [50.0, 100.0, 150.0, 200.0];
/// The cylinder between the bars: diameter, and length between these, m.
const DIAMETER_M: f64 = 0.041;
const LENGTH_M: f64 = 0.0398;
/// Impedance of the bars over their section, Pa s/m, and their diameter, m.
const IMPEDANCE_PA_S_M: f64 = 22.07e6;
const BAR_M: f64 = 0.05;
/// Bonds with inertia alone, and with the strengthening of eq. 20 of Platzer 2022.
const WAYS: [(&str, bool); 2] = [("inertia alone", false), ("with eq. 20", true)];

/// A test between bars, computed or measured.
#[derive(Debug, Clone, Copy)]
struct Fast {
    rate_1_s: f64,
    strength_mpa: f64,
    /// J/kg. NaN: not measured.
    absorbed_j_kg: f64,
    /// Mass fraction of pieces coarser than 6.3 mm, of measured ones in percent. NaN: not measured.
    coarse: f64,
    has_failed: bool,
}

/// A test with the name of its rock and the word of its kind.
type Named = (String, String, Fast);

/// A rock with measured fast tests.
pub(crate) struct Beside {
    pub(crate) rock: &'static str,
    /// Number of tests.
    pub(crate) count: usize,
    /// Means of the strengths computed by inertia alone at the strain rates of the tests, and of
    /// those measured, MPa.
    pub(crate) strengths_mpa: [f64; 2],
}

pub(crate) fn tables() -> [Table; 3] {
    let of = |words, head| Table::new(PAGE, words, head, ROCKS.map(|rock| rock.name));
    [
        of(
            "rocks calibrate",
            "rock | modulus, wanted | slow strength, wanted | modulus of bonds | tensile strength of bonds | modulus off | strength off",
        ),
        of(
            "rocks page",
            "rock | fast tests | strain rate, 1/s | measured over computed strength, inertia alone | with eq. 20 | absorbed energy, measured over computed | coarser than 6.3 mm, measured | computed",
        ),
        of(
            "rocks page",
            "rock | 50/s | 100/s | 150/s | 200/s | with eq. 20: 50/s | 100/s | 150/s | 200/s",
        ),
    ]
}

/// The name of a rock in names of files.
fn material_name(rock: &Rock) -> String {
    let name = rock.name.to_lowercase().replace(['(', ')'], "");
    name.replace(' ', "-")
}

/// The file of the calibrated bonds of a rock, from the root of the repository.
fn material(rock: &Rock) -> String {
    format!("tests/rocks/{}.toml", material_name(rock))
}

/// Calibrates bonds for the slow tests of each rock, and writes the table of them.
pub(crate) fn calibrate(bench: &Bench) -> Result<(), Failed> {
    let [mut table, ..] = tables();
    for rock in &ROCKS {
        let file = bench.folder.join(material_name(rock) + ".toml");
        let record = file.with_extension("json");
        if !bench.has(&record) {
            let [strength_mpa, _] = rock.strength_mpa;
            let set = sets(&[
                format!(
                    "materials.rock.young_modulus=\"{} GPa\"",
                    rock.young_modulus_gpa
                ),
                format!("materials.rock.poisson_ratio={}", rock.poisson_ratio),
                format!("bodies.rock.body_density=\"{} kg/m3\"", rock.density_kg_m3),
                format!("test.young_modulus=\"{} GPa\"", rock.young_modulus_gpa),
                format!("test.strength=\"{strength_mpa} MPa\""),
                format!(
                    "bonds.rock.young_modulus=\"{} GPa\"",
                    rock.young_modulus_gpa
                ),
                format!(
                    "bonds.rock.failure.tensile_strength=\"{} MPa\"",
                    0.116 * strength_mpa
                ),
                format!(
                    "bonds.rock.failure.cohesion=\"{} MPa\"",
                    0.232 * strength_mpa
                ),
            ]);
            let output = file.display().to_string();
            let seeds = SEEDS.to_string();
            let words = ["calibrate", "tests/rocks/slow.toml", "--packings", &seeds];
            let mut words: Vec<String> = words.map(str::to_owned).to_vec();
            words.extend(set);
            words.extend(
                [ONE_THREAD, "-o", &output, "--", "tests/rocks/slow.stl"].map(str::to_owned),
            );
            words.extend(PACKING.map(str::to_owned));
            bench.command_or_miss(&words)?;
        }
        std::fs::copy(file, root().join(material(rock)))?;
        table.row(calibrated(rock, &record)?);
    }
    write(&[table])
}

/// The cells of a calibration, after the name of its rock.
fn calibrated(rock: &Rock, record: &Path) -> Result<Vec<String>, Failed> {
    let record = read_record(record)?;
    let case = record.cases.first().ok_or("a record without a case")?;
    let round = case.result().ok_or("a calibration without a round")?;
    let number = |at: usize| record.unknowns[at].numbers[0].value * round.factors[at];
    let off = |value: Option<f64>| value.map_or_else(String::new, |off| change(off, 1));
    let mut cells = vec![
        format!("{} GPa", rock.young_modulus_gpa),
        format!("{} MPa", rock.strength_mpa[0]),
        format!("{:.2} GPa", number(0)),
        format!("{:.2} MPa", number(1)),
    ];
    cells.extend(round.deviations(&record.unknowns).into_iter().map(off));
    Ok(cells)
}

/// Loads the calibrated rocks between bars, and stores what came out.
pub(crate) fn load(bench: &Bench) -> Result<(), Failed> {
    let mut text = "rock,eq_20,seed,striker_m_s,strain_rate_1_s,strength_mpa,absorbed_j_kg,coarser_than_6_3_mm,failed\n".to_owned();
    let bodies = (1..=SEEDS).map(|seed| fast_body(bench, seed));
    let bodies: Vec<PathBuf> = bodies.collect::<Result<_, Failed>>()?;
    for rock in &ROCKS {
        for (seed, body) in (1..).zip(&bodies) {
            for (_, strengthens) in WAYS {
                for rate_1_s in RATES_1_S {
                    text += &loaded(bench, rock, (seed, body), strengthens, rate_1_s)?;
                }
            }
        }
    }
    std::fs::write(root().join(COMPUTED), text)?;
    page(bench)
}

/// A packing of the cylinder between the bars.
fn fast_body(bench: &Bench, seed: u32) -> Result<PathBuf, Failed> {
    let mut words = vec!["tests/rocks/fast.stl".to_owned(), format!("--seed={seed}")];
    words.extend(PACKING.map(str::to_owned));
    bench.packed(&format!("fast-{seed}"), &words)
}

/// Loads a rock, packed with this seed, at about this rate. Returns its row of the stored tests.
fn loaded(
    bench: &Bench,
    rock: &Rock,
    (seed, packed): (u32, &Path),
    strengthens: bool,
    rate_1_s: f64,
) -> Result<String, Failed> {
    let striker_m_s = striker_m_s(rock, rate_1_s);
    let mut options = sets(&[
        format!("test.striker.velocity=\"{striker_m_s} m/s\""),
        format!("bodies.rock.body_density=\"{} kg/m3\"", rock.density_kg_m3),
        format!("test.strength=\"{} MPa\"", rock.strength_mpa[0]),
        "bonds.rock.damping={damping_ratio=0.05}".to_owned(),
        format!("bonds.rock.failure.rate_strengthening={strengthens}"),
        "output.frames=\"10 s\"".to_owned(),
    ]);
    options.push(body("rock", packed));
    options.push(format!("--material={}", material(rock)));
    options.push(ONE_THREAD.to_owned());
    let name = format!("{}-{seed}-{strengthens}-{rate_1_s}", rock.name);
    let run = bench.run(&name.replace(' ', "-"), "tests/rocks/fast.toml", &options)?;
    let fast = fast(&run, rock)?;
    Ok(format!(
        "{},{strengthens},{seed},{striker_m_s},{:.2},{:.3},{:.1},{:.4},{}\n",
        rock.name,
        fast.rate_1_s,
        fast.strength_mpa,
        fast.absorbed_j_kg,
        fast.coarse,
        if fast.has_failed { "yes" } else { "no" }
    ))
}

/// Speed of the striker that loads a rock at about this rate, with 1.3 times its slow strength: the
/// ends of the bars approach each other with the speed of the striker less twice the force over the
/// impedance. In tenths of m/s.
fn striker_m_s(rock: &Rock, rate_1_s: f64) -> f64 {
    let of_sections = (DIAMETER_M / BAR_M).powi(2);
    let force_m_s = 2.0 * 1.3e6 * rock.strength_mpa[0] * of_sections / IMPEDANCE_PA_S_M;
    (10.0 * (rate_1_s * LENGTH_M + force_m_s)).round() / 10.0
}

/// What a run gives, by the definitions of Rae et al.: the strength is the largest stress, the
/// strain rate the mean while the stress exceeds half of it.
fn fast(run: &Run, rock: &Rock) -> Result<Fast, Failed> {
    let names = [
        "incident_force_n",
        "transmission_force_n",
        "incident_bar_velocity_m_s",
        "transmission_bar_velocity_m_s",
    ];
    let area_m2 = 0.25 * PI * DIAMETER_M.powi(2);
    let rows = run.columns("bar-signals.csv", names)?;
    let stress_pa = |[first, second, ..]: &[f64; 4]| 0.5 * (first + second) / area_m2;
    let largest_pa = rows.iter().map(stress_pa).fold(0.0, f64::max);
    let high = rows.iter().filter(|row| stress_pa(row) > 0.5 * largest_pa);
    let rates: Vec<f64> = high
        .map(|[.., first, second]| (first - second) / LENGTH_M)
        .collect();
    let sizes = run.words("distribution.csv", ["body", "sieve_m", "passing_fraction"])?;
    let passing = sizes
        .iter()
        .find(|[body, sieve_m, _]| body == "all" && sieve_m == "0.0063");
    let [.., passing] = passing.ok_or("a run without the sieve of 6.3 mm")?;
    let absorbed_j = run.test()?.figure("absorbed energy").unwrap_or(f64::NAN);
    let mass_kg = rock.density_kg_m3 * area_m2 * 0.04;
    Ok(Fast {
        rate_1_s: mean(&rates),
        strength_mpa: 1e-6 * largest_pa,
        absorbed_j_kg: absorbed_j / mass_kg,
        coarse: 1.0 - passing.parse::<f64>()?,
        has_failed: run.fragments().mass_fraction_of_largest < 0.5,
    })
}

/// The tests of a table, by rock and by the words of a second column.
fn read(file: &str, columns: [&str; 7]) -> Result<Vec<Named>, Failed> {
    let text = std::fs::read_to_string(root().join(file))?;
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap_or_default();
    let places = columns.map(|name| head.iter().position(|other| *other == name));
    let row = |cells: Vec<&str>| {
        let cell = |at: usize| {
            places[at]
                .and_then(|place| cells.get(place))
                .copied()
                .unwrap_or("")
        };
        let number = |at: usize| cell(at).parse().unwrap_or(f64::NAN);
        let fast = Fast {
            rate_1_s: number(2),
            strength_mpa: number(3),
            absorbed_j_kg: number(4),
            coarse: number(5),
            has_failed: cell(6) == "yes",
        };
        (cell(0).to_owned(), cell(1).to_owned(), fast)
    };
    Ok(lines.map(row).collect())
}

/// The tests of a rock that broke it.
fn broken(all: &[Named], rock: &str, kind: &str) -> Vec<Fast> {
    let own = all.iter().filter(|(name, word, fast)| {
        name == rock && word == kind && fast.has_failed && fast.strength_mpa.is_finite()
    });
    let mut own: Vec<Fast> = own.map(|(.., fast)| *fast).collect();
    own.sort_by(|a, b| a.rate_1_s.total_cmp(&b.rate_1_s));
    own
}

/// A line fitted to a quantity over the strain rate, and the rates that it covers.
#[derive(Clone, Copy)]
struct Trend {
    line: Line,
    rates_1_s: [f64; 2],
}

impl Trend {
    fn of(tests: &[Fast], value: fn(&Fast) -> f64) -> Option<Self> {
        let rates: Vec<f64> = tests.iter().map(|test| test.rate_1_s).collect();
        let values: Vec<f64> = tests.iter().map(value).collect();
        (tests.len() >= 3).then(|| Self {
            line: Line::fitted(&rates, &values),
            rates_1_s: ends(&rates),
        })
    }

    fn covers(&self, rate_1_s: f64) -> bool {
        let [least_1_s, most_1_s] = self.rates_1_s;
        (0.8 * least_1_s..=1.25 * most_1_s).contains(&rate_1_s)
    }
}

/// The stored tests, computed and measured.
fn stored() -> Result<[Vec<Named>; 2], Failed> {
    let computed = [
        "rock",
        "eq_20",
        "strain_rate_1_s",
        "strength_mpa",
        "absorbed_j_kg",
        "coarser_than_6_3_mm",
        "failed",
    ];
    let mut measured = computed;
    (measured[1], measured[5]) = ("test", "coarser_than_6_3_mm_percent");
    Ok([read(COMPUTED, computed)?, read(MEASURED, measured)?])
}

/// The rocks with measured fast tests.
pub(crate) fn beside() -> Result<Vec<Beside>, Failed> {
    let [computed, measured] = stored()?;
    let of = |rock: &Rock| {
        let trend = Trend::of(&broken(&computed, rock.name, "false"), |test| {
            test.strength_mpa
        })?;
        let tests = broken(&measured, rock.name, "SHPB").into_iter();
        let tests: Vec<Fast> = tests.filter(|test| trend.covers(test.rate_1_s)).collect();
        let ours: Vec<f64> = tests
            .iter()
            .map(|test| trend.line.at(test.rate_1_s))
            .collect();
        let theirs: Vec<f64> = tests.iter().map(|test| test.strength_mpa).collect();
        (!tests.is_empty()).then(|| Beside {
            rock: rock.name,
            count: tests.len(),
            strengths_mpa: [mean(&ours), mean(&theirs)],
        })
    };
    Ok(ROCKS.iter().filter_map(of).collect())
}

/// Writes the tables of the fast tests, the predictions and the plots, from the stored results.
pub(crate) fn page(_: &Bench) -> Result<(), Failed> {
    let [_, mut compared, mut predicted] = tables();
    let [computed, measured] = stored()?;
    let mut text = "rock,bonds,strain_rate_1_s,strength_mpa,lowest_mpa,highest_mpa\n".to_owned();
    for rock in &ROCKS {
        let own =
            WAYS.map(|(_, strengthens)| broken(&computed, rock.name, &strengthens.to_string()));
        let strengths = own
            .each_ref()
            .map(|tests| Trend::of(tests, |test| test.strength_mpa));
        let tests = broken(&measured, rock.name, "SHPB");
        compared.row(comparison(&tests, &own[0], strengths));
        let mut cells = Vec::new();
        for ((way, _), trend) in WAYS.iter().zip(strengths) {
            for rate_1_s in PREDICTED_1_S {
                let Some(trend) = trend.filter(|trend| trend.covers(rate_1_s)) else {
                    cells.push(String::new());
                    continue;
                };
                let strength_mpa = trend.line.at(rate_1_s);
                // Two standard deviations, of the packings and of the slow tests.
                let [slow_mpa, slow_scatter_mpa] = rock.strength_mpa;
                let band_mpa = 2.0
                    * trend
                        .line
                        .residual
                        .hypot(strength_mpa * slow_scatter_mpa / slow_mpa);
                cells.push(format!("{strength_mpa:.0} ± {band_mpa:.0} MPa"));
                let [low, high] = [strength_mpa - band_mpa, strength_mpa + band_mpa];
                writeln!(
                    text,
                    "{},{way},{rate_1_s},{strength_mpa:.1},{low:.1},{high:.1}",
                    rock.name
                )?;
            }
        }
        predicted.row(cells);
        plot(rock, &own, &tests)?;
    }
    std::fs::write(root().join(PREDICTIONS), text)?;
    write(&[compared, predicted])
}

/// The cells that compare measured tests with computed ones, by the trends of these.
fn comparison(tests: &[Fast], inertia: &[Fast], strengths: [Option<Trend>; 2]) -> Vec<String> {
    if tests.is_empty() {
        let cells = ["to be compared", "", "", "", "", "", ""];
        return cells.map(str::to_owned).to_vec();
    }
    let over = |trend: Option<Trend>, value: fn(&Fast) -> f64| {
        let Some(trend) = trend else {
            return String::new();
        };
        let there = tests.iter().filter(|test| trend.covers(test.rate_1_s));
        let ratios: Vec<f64> = there
            .map(|test| value(test) / trend.line.at(test.rate_1_s))
            .collect();
        let ratios: Vec<f64> = ratios
            .into_iter()
            .filter(|ratio| ratio.is_finite())
            .collect();
        scattered(&ratios, 2, "")
    };
    let rates: Vec<f64> = tests.iter().map(|test| test.rate_1_s).collect();
    let coarse = |some: &[Fast], factor: f64| {
        let there = some.iter().map(|test| factor * test.coarse);
        let there: Vec<f64> = there.filter(|share| share.is_finite()).collect();
        if there.is_empty() {
            String::new()
        } else {
            range(&there, 0) + " %"
        }
    };
    let absorbed = Trend::of(inertia, |test| test.absorbed_j_kg);
    vec![
        tests.len().to_string(),
        range(&rates, 0),
        over(strengths[0], |test| test.strength_mpa),
        over(strengths[1], |test| test.strength_mpa),
        over(absorbed, |test| test.absorbed_j_kg),
        coarse(tests, 1.0),
        coarse(inertia, 100.0),
    ]
}

/// Draws strength over strain rate.
fn plot(rock: &Rock, computed: &[Vec<Fast>; 2], measured: &[Fast]) -> Result<(), Failed> {
    let points = |tests: &[Fast], filled: bool| {
        let at = tests.iter().map(|test| Point {
            at: [test.rate_1_s, 1e6 * test.strength_mpa],
            filled,
            ..Point::default()
        });
        at.collect::<Vec<_>>()
    };
    let kinds = [
        ("measured", points(measured, true)),
        ("inertia alone", points(&computed[0], false)),
        ("with eq. 20", points(&computed[1], false)),
    ];
    let kinds = kinds.into_iter().filter(|(_, points)| !points.is_empty());
    let marks = kinds.map(|(name, points)| Marks {
        name: name.to_owned(),
        points,
        ..Marks::default()
    });
    let rates = computed
        .iter()
        .flatten()
        .chain(measured)
        .map(|test| test.rate_1_s);
    let [_, most_1_s] = ends(&rates.collect::<Vec<_>>());
    let slow_pa = 1e6 * rock.strength_mpa[0];
    let slow = PlotLine::dashed(
        "slow strength, calibrated",
        vec![[0.0, slow_pa], [most_1_s, slow_pa]],
    );
    let plot = Plot {
        marks: marks.collect(),
        ..Plot::of(rock.name, "strain rate (1/s)", "strength (Pa)", vec![slow])
    };
    let name = material_name(rock);
    draw(&format!("tests/verification/rocks-{name}.svg"), &plot)
}
