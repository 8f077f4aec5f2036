//! tests/calibrations/README.md: calibrations of four materials, and what packings give that they
//! were not made with.

use std::path::Path;

use dem_calibration::{Case, End, Record, Round, Unknown, pace, read_record};
use dem_io::body::read_body;
use dem_laboratory::{Statistic, half_width};

use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, root, sets};
use crate::table::{Table, write};

const WORDS: &str = "calibration cases";
const PAGE: &str = "tests/calibrations/README.md";
/// Seed of the first packing that no calibration was made with.
const FIRST_FRESH_SEED: u32 = 101;
/// Number of such packings, and of those with spheres of other diameters.
const FRESH: u32 = 6;
const OTHERS: u32 = 4;

/// A scene, its tested body and the shape of that body.
#[derive(Clone, Copy)]
struct Laboratory {
    scene: &'static str,
    body: &'static str,
    shape: &'static [&'static str],
}

/// A calibration.
struct Calibration {
    name: &'static str,
    laboratory: Laboratory,
    diameters: &'static str,
    /// More options of `dem-pack`.
    packing: [&'static str; 2],
    /// Options of `dem-run calibrate`.
    options: &'static [&'static str],
    first_seed: u32,
    /// Whether other packings are tested with its numbers.
    fresh: bool,
    /// Diameters of packings with other spheres across that are tested as well.
    others: Option<&'static str>,
}

const AGGLOMERATE: Laboratory = Laboratory {
    scene: "tests/calibrations/agglomerate.toml",
    body: "cylinder",
    shape: &["tests/calibrations/cylinder.stl"],
};
const ROCK: Laboratory = Laboratory {
    scene: "tests/calibrations/rock.toml",
    body: "disc",
    shape: &["data/shapes/disc.stl", "--scale=1.08"],
};
const CAKE: Laboratory = Laboratory {
    scene: "tests/calibrations/soft-cake.toml",
    body: "bar",
    shape: &["tests/calibrations/bar.stl", "--scale=1.6"],
};
const CERAMICS: Laboratory = Laboratory {
    scene: "tests/calibrations/ceramics.toml",
    body: "bar",
    shape: &["tests/calibrations/bar.stl"],
};
const FILTER_CAKE: Laboratory = Laboratory {
    scene: "data/scenes/four-point-bending.toml",
    body: "sample",
    shape: &["data/shapes/bending-sample.stl"],
};
const SPECIMEN: &str = "--modulus=specimen";
const TOO_STRONG: [&str; 2] = [
    "--set=bonds.agglomerate.failure.tensile_strength=\"100 MPa\"",
    "--set=bonds.agglomerate.failure.cohesion=\"200 MPa\"",
];
const TOO_WEAK: [&str; 2] = [
    "--set=bonds.agglomerate.failure.tensile_strength=\"10 kPa\"",
    "--set=bonds.agglomerate.failure.cohesion=\"20 kPa\"",
];

/// A calibration whose bonds reach a tenth beyond touching spheres.
const fn reaching(
    name: &'static str,
    laboratory: Laboratory,
    diameters: &'static str,
    options: &'static [&'static str],
) -> Calibration {
    Calibration {
        name,
        laboratory,
        diameters,
        packing: ["--overlap=0.25", "--bond-range=1.1"],
        options,
        first_seed: 1,
        fresh: true,
        others: None,
    }
}

/// A calibration of the agglomerate with coarse spheres.
const fn coarse(
    name: &'static str,
    first_seed: u32,
    options: &'static [&'static str],
) -> Calibration {
    Calibration {
        first_seed,
        ..reaching(name, AGGLOMERATE, "1.6mm..2mm", options)
    }
}

const AGGLOMERATE_FINE: Calibration =
    reaching("agglomerate, compression", AGGLOMERATE, "1mm..1.4mm", &[]);
const ROCK_DISC: Calibration = reaching("rock, Brazilian disc", ROCK, "3mm..4.5mm", &[SPECIMEN]);
const CAKE_BAR: Calibration = reaching("soft cake, bending", CAKE, "5mm..7mm", &[]);
const CERAMICS_BAR: Calibration = reaching("ceramics, bending", CERAMICS, "3mm..4mm", &[SPECIMEN]);

/// A calibration whose numbers are tested with spheres of these diameters as well: the same as the
/// same spheres in a body that is smaller by as much.
const fn in_another(calibration: Calibration, diameters: &'static str) -> Calibration {
    Calibration {
        others: Some(diameters),
        ..calibration
    }
}

const CALIBRATIONS: [Calibration; 13] = [
    in_another(AGGLOMERATE_FINE, "1.6mm..2mm"),
    in_another(ROCK_DISC, "4.3mm..6.5mm"),
    in_another(CAKE_BAR, "8mm..11.2mm"),
    Calibration {
        fresh: false,
        ..reaching(
            "soft cake, stroke of 6 mm",
            CAKE,
            "5mm..7mm",
            &["--set=test.stroke=\"6 mm\""],
        )
    },
    in_another(CERAMICS_BAR, "4.3mm..5.7mm"),
    Calibration {
        name: "filter cake, bending",
        laboratory: FILTER_CAKE,
        diameters: "6mm..8mm",
        packing: ["--overlap=0.296", "--bond-range=1.0"],
        options: &[],
        first_seed: 21,
        fresh: true,
        others: None,
    },
    coarse("coarse agglomerate", 1, &[]),
    coarse("the same, seeds from 5", 5, &[]),
    coarse("the same, seeds from 9", 9, &[]),
    coarse("eight packings", 1, &["--packings=8"]),
    coarse("one packing", 1, &["--packings=1"]),
    coarse("first guess 100 times too strong", 1, &TOO_STRONG),
    coarse("first guess 100 times too weak", 1, &TOO_WEAK),
];

pub(crate) fn tables() -> [Table; 2] {
    let head = "calibration | spheres across | packings | rounds | end | modulus off | strength off | \
        six other packings: modulus | strength | promised for them";
    let sizes = "calibration | calibrated with, across | tested with, across | modulus off | \
        strength off | with size_correction: modulus off | strength off";
    let name = |one: Calibration| one.others.map(|_| one.name);
    [
        Table::new(PAGE, WORDS, head, CALIBRATIONS.map(|one| one.name)),
        Table::new(
            PAGE,
            WORDS,
            sizes,
            CALIBRATIONS.into_iter().filter_map(name),
        ),
    ]
}

pub(crate) fn cases(bench: &Bench) -> Result<(), Failed> {
    let [mut table, mut sizes] = tables();
    for (at, calibration) in CALIBRATIONS.iter().enumerate() {
        let file = bench.folder.join(format!("case-{at}.toml"));
        calibration.calibrate(bench, &file)?;
        let record = read_record(&file.with_extension("json"))?;
        let case = record.cases.first().ok_or("a record without a case")?;
        let round = case.result().ok_or("a calibration without a round")?;
        let tested = Tested {
            bench,
            at,
            calibration,
            material: &file,
            record: &record,
        };
        let fresh = match calibration.fresh && case.is_met() {
            true => tested.results("fresh", calibration.diameters, FRESH, &[])?,
            false => Vec::new(),
        };
        table.row(row(&record, case, round, &fresh));
        if let Some(diameters) = calibration.others {
            sizes.row(tested.size_row(case, diameters)?);
        }
    }
    write(&[table, sizes])
}

/// The cells of a calibration, after its name. `fresh`: the results of other packings, one set for
/// each unknown; none if they were not tested.
fn row(record: &Record, case: &Case, round: &Round, fresh: &[Vec<f64>]) -> Vec<String> {
    let end = match &case.end {
        Some((_, End::Met)) => "met",
        Some((_, End::WithinScatter)) => "within scatter",
        _ => "not met",
    };
    let mut cells = vec![
        format!("{:.1}", case.spheres_across),
        round.trials.len().to_string(),
        case.rounds.len().to_string(),
        end.to_owned(),
    ];
    let off = |value: Option<f64>| value.map_or_else(String::new, |off| percent(100.0 * off));
    cells.extend(round.deviations(&record.unknowns).into_iter().map(off));
    let unknowns = record.unknowns.iter().enumerate();
    cells.extend(unknowns.clone().map(|(at, unknown)| {
        let values = fresh.get(at).map(|values| mean_off(values, unknown.target));
        values.unwrap_or_default()
    }));
    let promised = unknowns.filter_map(|(at, _)| {
        let statistic = round.statistic(at).filter(|_| !fresh.is_empty())?;
        let half = half_width(&statistic)? / statistic.mean;
        // half_width has a factor of 1/sqrt(count): the prediction interval of another mean.
        let wider = (1.0 + statistic.count as f64 / f64::from(FRESH)).sqrt();
        Some(format!("± {:.1} %", 100.0 * half * wider))
    });
    cells.push(promised.collect::<Vec<_>>().join(", "));
    cells
}

/// The mean of some results, as its deviation from their target, with its 95 % confidence interval.
fn mean_off(values: &[f64], target: f64) -> String {
    let values: Vec<f64> = values.iter().map(|value| value / target).collect();
    let statistic = Statistic::of(&values);
    let half = half_width(&statistic).unwrap_or(f64::NAN);
    let off = percent(100.0 * (statistic.mean - 1.0));
    format!("{off} ± {:.1} %", 100.0 * half)
}

fn percent(value: f64) -> String {
    format!("{value:+.1} %")
}

impl Calibration {
    /// The arguments of `dem-pack` with spheres of these diameters.
    fn pack(&self, diameters: &str, seed: u32) -> Vec<String> {
        let mut words: Vec<String> = (self.laboratory.shape.iter())
            .map(|&word| word.into())
            .collect();
        words.push(format!("--diameter={diameters}"));
        words.extend(self.packing.map(str::to_owned));
        words.push(format!("--seed={seed}"));
        words
    }

    /// `dem-run calibrate`, or its complete record.
    fn calibrate(&self, bench: &Bench, file: &Path) -> Result<(), Failed> {
        let record = file.with_extension("json");
        let mut words: Vec<String> = vec!["calibrate".to_owned(), self.laboratory.scene.to_owned()];
        words.extend(self.options.iter().map(|&option| option.to_owned()));
        words.push(format!("--output={}", file.display()));
        words.extend([ONE_THREAD, "--quiet"].map(str::to_owned));
        let keeps = if bench.has(&record) {
            "--resume"
        } else {
            "--force"
        };
        words.push(keeps.to_owned());
        words.push("--".to_owned());
        words.extend(self.pack(self.diameters, self.first_seed));
        bench.command_or_miss(&words)
    }
}

/// A calibration whose numbers are tested in packings that it was not made with.
struct Tested<'a> {
    bench: &'a Bench,
    /// Its number.
    at: usize,
    calibration: &'a Calibration,
    material: &'a Path,
    record: &'a Record,
}

impl Tested<'_> {
    /// The results of this many other packings, one set for each unknown, with more `--set` values.
    fn results(
        &self,
        name: &str,
        diameters: &str,
        count: u32,
        more: &[String],
    ) -> Result<Vec<Vec<f64>>, Failed> {
        let seeds = FIRST_FRESH_SEED..FIRST_FRESH_SEED + count;
        let runs = seeds.map(|seed| self.test(name, diameters, seed, more));
        let runs: Vec<Run> = runs.collect::<Result<_, Failed>>()?;
        let of = |unknown: &Unknown| {
            let values = runs.iter().map(|run| {
                let found = run.test()?.figure(&unknown.result);
                found.ok_or_else(|| Failed::from(format!("a test has no {}", unknown.result)))
            });
            values.collect()
        };
        self.record.unknowns.iter().map(of).collect()
    }

    /// The test of one other packing, as the calibration itself does it.
    fn test(&self, name: &str, diameters: &str, seed: u32, more: &[String]) -> Result<Run, Failed> {
        let Laboratory {
            scene: file,
            body: tested,
            ..
        } = self.calibration.laboratory;
        let packing = format!("case-{}-{diameters}-{seed}", self.at);
        let packed = self
            .bench
            .packed(&packing, &self.calibration.pack(diameters, seed))?;
        let scene = dem_scene::read_scene(&root().join(file), &[])?;
        let test = scene.test.ok_or("the scene has no test")?;
        let case = &self.record.cases[0];
        let mut values = more.to_vec();
        values.extend(["test.rate_check=false", "output.frames=\"10 s\""].map(str::to_owned));
        if let Some(travel_m) = case.start.as_ref().and_then(|start| start.travel_m) {
            let periods = test.rate_m_s.is_none().then_some(test.periods);
            let diameter_m = case.mean_diameter_m;
            values.extend(pace(test.stroke_m, periods, travel_m, diameter_m));
        }
        let mut options = sets(&values);
        options.push(body(tested, &packed));
        options.push(format!("--material={}", self.material.display()));
        options.push(ONE_THREAD.to_owned());
        self.bench
            .run(&format!("case-{}-{name}-{seed}", self.at), file, &options)
    }

    /// The row of what its numbers give with spheres of other diameters, after its name.
    fn size_row(&self, case: &Case, diameters: &str) -> Result<Vec<String>, Failed> {
        let kind = &self.record.unknowns[0].numbers[0].path;
        let kind = kind.split('.').nth(1).unwrap_or_default();
        let correct = [format!("bonds.{kind}.size_correction=true")];
        let plain = self.results("plain", diameters, OTHERS, &[])?;
        let corrected = self.results("corrected", diameters, OTHERS, &correct)?;
        let packing = format!("case-{}-{diameters}-{FIRST_FRESH_SEED}.vtp", self.at);
        let packed = read_body(&self.bench.folder.join(packing))?;
        let across = packed.about.particles_across.unwrap_or(f64::NAN);
        let mut cells = vec![
            format!("{:.1}", case.spheres_across),
            format!("{across:.1}"),
        ];
        for results in [plain, corrected] {
            let unknowns = results.iter().zip(&self.record.unknowns);
            cells.extend(unknowns.map(|(values, unknown)| mean_off(values, unknown.target)));
        }
        Ok(cells)
    }
}
