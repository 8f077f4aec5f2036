//! Positions and lengths in SVG.

/// A position or length, px.
pub(crate) fn px(length: f64) -> String {
    format!("{length:.2}")
}

/// Positions as `x,y x,y ...`, px.
pub(crate) fn places(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    let pairs = points.into_iter().map(|[x, y]| format!("{x:.2},{y:.2}"));
    pairs.collect::<Vec<_>>().join(" ")
}
