//! Colours in proportion to light: the square of the values stored in a picture.

/// Light of a stored colour.
pub(super) fn linear(colour: [u8; 3]) -> [f32; 3] {
    colour.map(|c| {
        let fraction = f32::from(c) / 255.0;
        fraction * fraction
    })
}

/// The stored colour of a light.
pub(super) fn stored(light: [f32; 3]) -> [u8; 3] {
    light.map(|c| (255.0 * c.clamp(0.0, 1.0).sqrt() + 0.5) as u8)
}

pub(super) fn mixed(a: [f32; 3], b: [f32; 3], fraction: f32) -> [f32; 3] {
    [0, 1, 2].map(|k| a[k] + fraction * (b[k] - a[k]))
}
