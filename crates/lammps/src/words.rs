//! Numbers and regions in the words of LAMMPS.

/// Cosine from which a direction counts as that of an axis.
pub(super) const ALONG: f64 = 1.0 - 1e-12;

/// Numbers with spaces between them.
pub(super) fn numbers(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(|x| format!("{x:e}")).collect();
    words.join(" ")
}

/// Style and arguments of the region of a box along the axes.
pub(super) fn block([low, high]: [[f64; 3]; 2]) -> String {
    let pairs: Vec<f64> = (0..3).flat_map(|k| [low[k], high[k]]).collect();
    format!("block {}", numbers(&pairs))
}

/// Style and arguments of the region of a cylinder between the middles of its ends, m. None: it is
/// not along an axis.
pub(super) fn cylinder([from, to]: [[f64; 3]; 2], radius_m: f64) -> Option<String> {
    let along = [0, 1, 2].map(|k| to[k] - from[k]);
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    let axis = (0..3).find(|&k| along[k].abs() >= ALONG * length)?;
    let across: Vec<f64> = (0..3).filter(|k| *k != axis).map(|k| from[k]).collect();
    let ends = [from[axis].min(to[axis]), from[axis].max(to[axis])];
    Some(format!(
        "cylinder {} {} {radius_m:e} {}",
        ["x", "y", "z"][axis],
        numbers(&across),
        numbers(&ends)
    ))
}
