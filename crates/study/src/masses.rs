//! Masses of the pieces after a run, and the distance between two such distributions.

use std::fs;
use std::path::Path;

use dem_scene::study::Pieces;

/// Limit of the distance that chance alone exceeds in one of twenty cases, divided by sqrt(1/n +
/// 1/m) (Kolmogorov and Smirnov).
const ONE_OF_TWENTY: f64 = 1.358;
/// Values with a smaller relative difference are the same: the masses of a clump and of its cluster
/// are sums in a different order.
const SAME: f64 = 1e-9;

/// The masses, kg, of the pieces of the run with its results in this folder.
///
/// # Errors
/// The reason why there are none, as text.
pub fn masses_kg(pieces: Pieces, results: &Path) -> Result<Vec<f64>, String> {
    let (file, column) = match pieces {
        Pieces::Left => ("events.csv", "detail"),
        Pieces::AtEnd => ("fragments.csv", "mass_kg"),
    };
    let text = fs::read_to_string(results.join(file)).map_err(|_| {
        let why = "no body of the scene can come, go or break";
        format!("it has left no {file}: {why}")
    })?;
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |wanted: &str| names.iter().position(|name| *name == wanted);
    let (Some(mass), Some(kind)) = (place(column), place("event").or(place("time_s"))) else {
        return Err(format!("its {file} has no column {column}"));
    };
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let last_s = rows.last().and_then(|row| row.get(kind).copied());
    let wanted = match pieces {
        Pieces::Left => Some("discharged"),
        Pieces::AtEnd => last_s,
    };
    let of_row = |row: &&Vec<&str>| row.get(kind).copied() == wanted;
    let number = |row: &Vec<&str>| {
        let text = row.get(mass).copied().unwrap_or_default();
        let text = text.rsplit(": ").next().unwrap_or_default();
        text.trim_end_matches(" kg").parse::<f64>().ok()
    };
    let found: Option<Vec<f64>> = rows.iter().filter(of_row).map(number).collect();
    match found {
        Some(found) if !found.is_empty() => Ok(found),
        Some(_) => Err(match pieces {
            Pieces::Left => "nothing was discharged through an outlet".to_owned(),
            Pieces::AtEnd => "there are no pieces at its end".to_owned(),
        }),
        None => Err(format!("a row of its {file} has no mass")),
    }
}

/// The largest difference between two cumulative distributions (Kolmogorov and Smirnov) of values
/// with weights from `weight`: 1 for a distribution by number, the value itself for one by mass.
pub fn distance(a: &[f64], b: &[f64], weight: impl Fn(f64) -> f64) -> f64 {
    let sums = [a, b].map(|all| all.iter().map(|x| weight(*x)).sum::<f64>());
    let mut all: Vec<(f64, f64)> = (a.iter().map(|x| (*x, weight(*x) / sums[0])))
        .chain(b.iter().map(|x| (*x, -weight(*x) / sums[1])))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut difference, mut largest) = (0.0_f64, 0.0_f64);
    for (at, (x, fraction)) in all.iter().enumerate() {
        difference += fraction;
        if all
            .get(at + 1)
            .is_none_or(|next| next.0 > x + SAME * x.abs())
        {
            largest = largest.max(difference.abs());
        }
    }
    largest
}

/// The distance by number that two samples of these sizes from one distribution exceed in one of
/// twenty cases.
pub fn by_chance(a: usize, b: usize) -> f64 {
    ONE_OF_TWENTY * (1.0 / a as f64 + 1.0 / b as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_small_samples() {
        let one = |_: f64| 1.0;
        assert_eq!(distance(&[1.0, 2.0, 3.0], &[3.0, 1.0, 2.0], one), 0.0);
        assert_eq!(distance(&[1.0, 2.0], &[3.0, 4.0, 5.0], one), 1.0);
        // At 2 the first has 2 of 4 at or below, the other none of 2.
        let apart = distance(&[1.0, 2.0, 5.0, 6.0], &[3.0, 6.0], one);
        assert!((apart - 0.5).abs() < 1e-15);
        let twice = [2.0, 2.0 * (1.0 + 1e-15), 2.0 * (1.0 - 1e-15)];
        assert!(distance(&twice, &[2.0, 2.0], one) < 1e-15);
        // By mass the two small ones count 2 of 12.
        let by_mass = distance(&[1.0, 1.0, 10.0], &[10.0, 10.0], |kg| kg);
        assert!((by_mass - 2.0 / 12.0).abs() < 1e-15);
    }

    #[test]
    fn chance_exceeds_its_limit_in_about_one_of_twenty_cases() {
        let mut state = 1_u64;
        let mut sample = |count: usize| -> Vec<f64> {
            let mut next = || {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                (state >> 11) as f64
            };
            (0..count).map(|_| next()).collect()
        };
        let (a, b) = (60, 90);
        let limit = by_chance(a, b);
        let beyond = (0..2000).filter(|_| distance(&sample(a), &sample(b), |_| 1.0) > limit);
        let fraction = beyond.count() as f64 / 2000.0;
        // The limit is that for large samples: these exceed it slightly less often.
        assert!((0.02..0.07).contains(&fraction), "{fraction}");
    }
}
