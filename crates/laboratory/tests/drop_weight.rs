//! Drop-weight tests made of a known law: the law comes back.

use std::fmt::Write;
use std::path::PathBuf;

use dem_io::random::uniform;
use dem_laboratory::drop_weight::{
    DropWeightSheets, DropWeightTest, Estimate, FittedOre, J_KG_OF_KWH_T, fit_ore, ore_text,
    read_sheets,
};
use dem_physics::breakage::BreakageLaw;
use tempfile::TempDir;

const LAW: BreakageLaw = BreakageLaw {
    largest_t10: 0.58,
    b_kg_j: 0.9 / J_KG_OF_KWH_T,
    fracture_energy_j_kg: 0.08 * J_KG_OF_KWH_T,
    energy_scatter: 0.0,
    reference_size_m: 0.0289,
    b_exponent: 0.6,
    energy_exponent: 0.6,
    family_exponent: 0.8,
};
const SCATTERED: BreakageLaw = BreakageLaw {
    energy_scatter: 0.45,
    energy_exponent: 0.75,
    ..LAW
};
const SIZELESS: BreakageLaw = BreakageLaw {
    b_exponent: 0.0,
    energy_exponent: 0.0,
    ..LAW
};
const SIZES_MM: [f64; 5] = [14.5, 20.6, 28.9, 41.1, 57.8];
const NS: [f64; 6] = [2.0, 4.0, 10.0, 25.0, 50.0, 75.0];

/// A sheet as a law gives it.
#[derive(Clone, Copy)]
struct Made<'a> {
    law: BreakageLaw,
    sizes_mm: &'a [f64],
    energies_kwh_t: &'a [f64],
    /// Standard deviation of all t_n.
    noise: f64,
    /// Specimens of a row; 0: none are counted.
    specimens: u32,
    seed: u64,
}

const USUAL: Made = Made {
    law: LAW,
    sizes_mm: &SIZES_MM,
    energies_kwh_t: &[0.15, 0.3, 0.6, 1.2, 2.4],
    noise: 0.0,
    specimens: 0,
    seed: 0,
};

impl Made<'_> {
    fn text(&self) -> String {
        let mut text = "size (mm);Ecs (kWh/t)".to_owned();
        for n in NS {
            let _ = write!(text, ";t{n} (%)");
        }
        text += if self.specimens > 0 {
            ";specimens;broken (%)\n"
        } else {
            "\n"
        };
        for (at, size_mm) in self.sizes_mm.iter().enumerate() {
            for (step, energy) in self.energies_kwh_t.iter().enumerate() {
                let row = 100 * at as u64 + step as u64;
                let (size_m, energy_j_kg) = (1e-3 * size_mm, J_KG_OF_KWH_T * energy);
                let t10 = self.law.mean_t10(size_m, energy_j_kg);
                let _ = write!(text, "{size_mm};{energy}");
                let shares = NS.map(|n| {
                    let noise = self.noise * normal(self.seed, &[row, n as u64]);
                    (self.law.passing(n, t10) + noise).clamp(0.0, 1.0)
                });
                for at in 0..NS.len() {
                    // A finer sieve does not pass more.
                    let least = shares[..=at]
                        .iter()
                        .fold(1.0, |least: f64, one| least.min(*one));
                    // Of the smallest energies only the broken specimens are counted.
                    match self.noise > 0.0 && self.specimens > 0 && *energy < 0.2 {
                        true => text.push(';'),
                        false => {
                            let _ = write!(text, ";{}", 100.0 * least);
                        }
                    }
                }
                if self.specimens > 0 {
                    let share = self.law.broken_share(size_m, energy_j_kg);
                    let broke =
                        |one: u32| uniform(self.seed, &[row, 1000 + u64::from(one)]) < share;
                    let drawn = (0..self.specimens).filter(|one| broke(*one)).count() as f64;
                    let shown = if self.noise == 0.0 {
                        share
                    } else {
                        drawn / f64::from(self.specimens)
                    };
                    let _ = write!(text, ";{};{}", self.specimens, 100.0 * shown);
                }
                text.push('\n');
            }
        }
        text
    }

    fn fitted(&self) -> FittedOre {
        fit_ore(&read(&[&self.text()]).unwrap()).unwrap()
    }
}

fn normal(seed: u64, words: &[u64]) -> f64 {
    let [one, other] = [1, 2].map(|which| uniform(seed, &[words, &[which]].concat()));
    (-2.0 * one.ln()).sqrt() * (std::f64::consts::TAU * other).cos()
}

/// Reads texts as files 1.csv, 2.csv, ...; messages are without their folder.
pub(crate) fn read(texts: &[&str]) -> dem_io::Result<DropWeightSheets> {
    let folder = TempDir::new().unwrap();
    let write = |(at, text): (usize, &&str)| {
        let file = folder.path().join(format!("{}.csv", at + 1));
        std::fs::write(&file, text).unwrap();
        file
    };
    let files: Vec<PathBuf> = texts.iter().enumerate().map(write).collect();
    let prefix = format!("{}/", folder.path().display());
    read_sheets(&files).map_err(|error| dem_io::Diagnostic {
        place: error.place.replace(&prefix, ""),
        problem: error.problem.replace(&prefix, ""),
        ..error
    })
}

/// The numbers of the law, at the reference size of the made one.
fn numbers(law: &BreakageLaw) -> [f64; 8] {
    let size = LAW.reference_size_m / law.reference_size_m;
    [
        law.largest_t10,
        law.b_kg_j * J_KG_OF_KWH_T * size.powf(law.b_exponent),
        law.median_energy_j_kg(LAW.reference_size_m) / J_KG_OF_KWH_T,
        law.energy_scatter,
        law.b_exponent,
        law.energy_exponent,
        law.family_exponent,
        1.0,
    ]
}

#[test]
fn exact_sheets_give_the_law_back() {
    let low = &[0.03, 0.06, 0.12, 0.25, 0.6, 1.2, 2.4];
    let no_threshold = BreakageLaw {
        fracture_energy_j_kg: 0.0,
        ..LAW
    };
    for made in [
        USUAL,
        Made {
            law: no_threshold,
            ..USUAL
        },
        Made {
            law: BreakageLaw {
                largest_t10: 1.0,
                ..LAW
            },
            ..USUAL
        },
        Made {
            law: SCATTERED,
            energies_kwh_t: low,
            specimens: 30,
            ..USUAL
        },
        Made {
            law: SIZELESS,
            sizes_mm: &[28.9],
            ..USUAL
        },
    ] {
        let found = made.fitted();
        for (found, wanted) in numbers(&found.law).iter().zip(numbers(&made.law)) {
            assert!(
                (found - wanted).abs() < 1e-6,
                "{found}, not {wanted}, of {:?}",
                made.law
            );
        }
        assert!(found.rms < 1e-7, "{}", found.rms);
        assert!(found.family.iter().all(|one| one.rms < 1e-7));
    }
}

/// Of 200 sheets with noise about 190 intervals of each number hold the true value: 3.1 is the
/// standard deviation of that. `fitted`: how many numbers have an interval.
fn assert_intervals_hold(made: &Made, fitted: usize) {
    let (mut held, mut known) = ([0; 8], [0; 8]);
    for seed in 1..=200 {
        let ore = Made { seed, ..*made }.fitted();
        let at = ore.law.reference_size_m;
        let b = made.law.b_kg_j * (at / made.law.reference_size_m).powf(made.law.b_exponent);
        let pairs: [(&Estimate, f64); 8] = [
            (&ore.largest_t10, made.law.largest_t10),
            (&ore.b_kg_j, b),
            (&ore.a_times_b_kg_j, made.law.largest_t10 * b),
            (&ore.fracture_energy_j_kg, made.law.median_energy_j_kg(at)),
            (&ore.energy_scatter, made.law.energy_scatter),
            (&ore.b_exponent, made.law.b_exponent),
            (&ore.energy_exponent, made.law.energy_exponent),
            (&ore.family_exponent, made.law.family_exponent),
        ];
        for (at, (estimate, wanted)) in pairs.into_iter().enumerate() {
            if let Some([least, most]) = estimate.interval {
                known[at] += 1;
                held[at] += i32::from((least..=most).contains(&wanted));
            }
        }
    }
    assert_eq!(known.iter().filter(|known| **known == 200).count(), fitted);
    assert_eq!(
        known.iter().filter(|known| **known == 0).count(),
        8 - fitted
    );
    let of_fitted = held.iter().zip(known).filter(|(_, known)| *known > 0);
    for (held, _) in of_fitted {
        assert!((181..=198).contains(held), "{held} of 200");
    }
}

#[test]
fn intervals_of_five_sizes_hold_the_law() {
    let made = Made {
        noise: 0.012,
        ..USUAL
    };
    assert_intervals_hold(&made, 7);
}

#[test]
fn intervals_of_one_size_hold_the_law() {
    let made = Made {
        law: SIZELESS,
        sizes_mm: &[28.9],
        energies_kwh_t: &[0.1, 0.13, 0.17, 0.25, 0.4, 0.6, 0.9, 1.3, 1.8, 2.4, 3.2],
        noise: 0.008,
        ..USUAL
    };
    assert_intervals_hold(&made, 5);
}

#[test]
fn intervals_with_broken_specimens_hold_the_law() {
    let made = Made {
        law: SCATTERED,
        sizes_mm: &[14.5, 28.9, 57.8],
        energies_kwh_t: &[0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 1.7, 2.5],
        noise: 0.012,
        specimens: 30,
        ..USUAL
    };
    assert_intervals_hold(&made, 8);
}

/// A = 1, b = 1.20 t/kWh and 4.4 points are what a fit of both without limits on the rest gives.
#[test]
fn published_tests_on_quartzite() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/measured/quartzite-drop-weight.csv"
    );
    let sheets = read_sheets(&[PathBuf::from(file)]).unwrap();
    assert_eq!(sheets.tests.len(), 13);
    let ore = fit_ore(&sheets).unwrap();
    assert_eq!(
        (ore.law.largest_t10, ore.law.fracture_energy_j_kg),
        (1.0, 0.0)
    );
    assert!(!ore.largest_t10.is_fitted);
    let b_t_kwh = ore.law.b_kg_j * J_KG_OF_KWH_T;
    assert!((b_t_kwh - 1.20).abs() < 0.005, "{b_t_kwh}");
    assert!((ore.rms - 0.044).abs() < 5e-4, "{}", ore.rms);
    // The family of 41 tests on such rocks lies in the interval.
    let [least, most] = ore.family_exponent.interval.unwrap();
    assert!((least..most).contains(&0.87), "{least} to {most}");
    let has = |part: &str| ore.doubts.iter().any(|doubt| doubt.contains(part));
    for part in [
        "A is at its bound",
        "one size only",
        "not significantly different from 0",
    ] {
        assert!(has(part), "{part} not in {:?}", ore.doubts);
    }
}

/// The least sum of squares over all A and b of a grid is not below that of the fit.
#[test]
fn no_other_law_is_nearer_to_the_tests() {
    let made = Made {
        noise: 0.03,
        seed: 7,
        sizes_mm: &[20.6, 41.1],
        ..USUAL
    };
    let sheets = read(&[&made.text()]).unwrap();
    let ore = fit_ore(&sheets).unwrap();
    let squares = |law: &BreakageLaw| -> f64 {
        let off =
            |test: &DropWeightTest| law.mean_t10(test.size_m, test.energy_j_kg) - test.t10.unwrap();
        sheets.tests.iter().map(|test| off(test).powi(2)).sum()
    };
    let best = squares(&ore.law);
    assert!((best - 10.0 * ore.rms * ore.rms).abs() < 1e-12);
    for word in 0..20_000 {
        let within =
            |which: u64, least: f64, most: f64| least + (most - least) * uniform(3, &[word, which]);
        let exponent = within(2, -0.5, 1.5);
        let law = BreakageLaw {
            largest_t10: within(0, 0.3, 1.0),
            b_kg_j: ore.law.b_kg_j * within(1, 0.3, 3.0),
            fracture_energy_j_kg: ore.law.fracture_energy_j_kg * within(3, 0.0, 3.0),
            b_exponent: exponent,
            energy_exponent: exponent,
            ..ore.law
        };
        assert!(squares(&law) >= best - 1e-12, "{law:?}");
    }
}

#[test]
fn what_could_not_be_fitted_is_said() {
    let says = |made: &Made, part: &str| {
        let ore = made.fitted();
        assert!(
            ore.doubts.iter().any(|doubt| doubt.contains(part)),
            "{part} not in {:?}",
            ore.doubts
        );
        ore
    };
    says(&USUAL, "the scatter of fracture energies is unknown");
    // In the straight part A is not known.
    let straight = Made {
        energies_kwh_t: &[0.1, 0.12, 0.14, 0.16, 0.18, 0.2, 0.22],
        sizes_mm: &[28.9],
        noise: 0.004,
        seed: 5,
        ..USUAL
    };
    let ore = straight.fitted();
    let [least, most] = ore.largest_t10.interval.unwrap();
    assert!(least < 0.2 && most == 1.0, "{least} to {most}");
    assert!(
        ore.doubts.iter().any(|doubt| doubt.starts_with("A ")),
        "{:?}",
        ore.doubts
    );
    // All break, at every energy.
    let all = Made {
        law: SCATTERED,
        energies_kwh_t: &[0.8, 1.2, 1.8, 2.5],
        specimens: 20,
        noise: 1e-4,
        seed: 1,
        ..USUAL
    };
    says(&all, "all specimens broke, or none");
    // One size does not follow the power of the others.
    let text = USUAL.text();
    let other = Made {
        law: BreakageLaw {
            b_kg_j: 2.0 * LAW.b_kg_j,
            ..LAW
        },
        sizes_mm: &[57.8],
        ..USUAL
    };
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with("57.8"))
        .collect();
    let lines = lines.join("\n");
    let ore = fit_ore(&read(&[&lines, &other.text()]).unwrap()).unwrap();
    let doubt = ore
        .doubts
        .iter()
        .find(|doubt| doubt.starts_with("at "))
        .unwrap();
    assert!(
        doubt.contains("the size exponent does not hold for it"),
        "{doubt}"
    );
    // A family that ends otherwise.
    let mut text = "size (mm),Ecs (kWh/t),t10 (%),t75 (%)\n".to_owned();
    for (energy, t10) in [(0.3, 12.0), (0.6, 20.0), (1.2, 35.0), (2.4, 50.0)] {
        let _ = writeln!(text, "30,{energy},{t10},{}", 0.8 * t10);
    }
    let text = text + "30,2.4,50,2\n";
    let ore = fit_ore(&read(&[&text]).unwrap()).unwrap();
    assert!(
        ore.doubts.iter().any(|doubt| doubt.starts_with("t75 is ")),
        "{:?}",
        ore.doubts
    );
}

/// Without a family its exponent is the usual one; the file is what scenes include.
#[test]
fn the_file_has_the_numbers_and_where_they_come_from() {
    let text = "size (mm),Ecs (kWh/t),t10 (%),ore\n28.9,0.25,11,\"Old, pit\"\n28.9,1,32,\n28.9,2.5,49,Old pit\n";
    let sheets = read(&[text]).unwrap();
    let ore = fit_ore(&sheets).unwrap();
    let written = ore_text(&ore, &sheets, ["2026-01-02", "dem-run 0"], "ore");
    let (comments, keys) = written.split_once("\n\n").unwrap();
    assert!(
        comments.lines().all(|line| line.starts_with("# ")),
        "{comments}"
    );
    for part in [
        "# Fitted on 2026-01-02 by dem-run 0 to drop-weight tests.",
        "# Ore: Old, pit.",
        "1.csv",
        "# 3 rows with a t10",
        "# A x b, A in %: ",
        "# doubt: no family is given",
    ] {
        assert!(comments.contains(part), "{part} not in {comments}");
    }
    let names: Vec<&str> = keys
        .lines()
        .map(|line| line.split(" = ").next().unwrap())
        .collect();
    assert_eq!(
        names,
        [
            "[materials.ore.breakage]",
            "largest_t10",
            "b",
            "fracture_energy",
            "energy_scatter",
            "reference_size",
            "b_exponent",
            "energy_exponent",
            "family_exponent"
        ]
    );
    for line in [
        "fracture_energy = \"0 kWh/t\"",
        "energy_scatter = 0.0",
        "reference_size = \"28.9 mm\"",
        "b_exponent = 0.0",
        "family_exponent = 0.87",
    ] {
        assert!(keys.lines().any(|one| one == line), "{line} not in {keys}");
    }
    let b = keys
        .lines()
        .find_map(|line| line.strip_prefix("b = "))
        .unwrap();
    let b_kg_j =
        dem_io::units::quantity(b.trim_matches('"'), &dem_io::units::MASS_PER_ENERGY).unwrap();
    assert!((b_kg_j / ore.law.b_kg_j - 1.0).abs() < 1e-5);
}
