//! Vectors of three numbers.

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + factor * b`.
pub(crate) fn plus(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The unit vector, where there is one.
pub(crate) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length.is_normal()).then(|| a.map(|x| x / length))
}

/// A unit vector across a unit vector: horizontal where that is possible.
pub(crate) fn across(a: [f64; 3]) -> [f64; 3] {
    unit(cross([0.0, 0.0, 1.0], a))
        .filter(|_| a[0].abs().max(a[1].abs()) > 1e-9)
        .unwrap_or([1.0, 0.0, 0.0])
}

pub(crate) fn are_finite(a: [f64; 3]) -> bool {
    a.into_iter().all(f64::is_finite)
}

/// Of directions of light.
pub(crate) fn dot_f32(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
