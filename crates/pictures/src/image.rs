//! A picture in memory.

/// Largest side of a picture, px.
pub(crate) const MAX_SIDE_PX: u32 = 16_384;

/// A picture: rows from the top, three bytes (red, green, blue) per pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl Image {
    /// A picture of one colour. Sides beyond `MAX_SIDE_PX` are cut off; without width or height
    /// it has no pixels.
    pub fn new(width: u32, height: u32, colour: [u8; 3]) -> Self {
        let [width, height] = [width, height].map(|side| side.min(MAX_SIDE_PX));
        Self {
            width,
            height,
            rgb: colour.repeat(width as usize * height as usize),
        }
    }

    /// A picture of these pixels, in the form of [`Image::rgb`]. None if their number is wrong, or
    /// a side is too long.
    pub(crate) fn of_rgb(width: u32, height: u32, rgb: Vec<u8>) -> Option<Self> {
        let fits =
            width.max(height) <= MAX_SIDE_PX && rgb.len() == 3 * width as usize * height as usize;
        fits.then_some(Self { width, height, rgb })
    }

    /// Width, px.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height, px.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels. Length 3 x width x height.
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    pub(crate) fn rgb_mut(&mut self) -> &mut [u8] {
        &mut self.rgb
    }

    /// The colour of a pixel, if it exists.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        let at = self.place(i64::from(x), i64::from(y))?;
        self.rgb.get(at..at + 3)?.try_into().ok()
    }

    /// Blends a colour over a pixel, from 0 (no change) to 1. Pixels outside are ignored.
    pub fn blend(&mut self, x: i64, y: i64, colour: [u8; 3], opacity: f64) {
        let Some(at) = self.place(x, y) else { return };
        let opacity = opacity.clamp(0.0, 1.0);
        for (below, over) in self.rgb[at..at + 3].iter_mut().zip(colour) {
            let mixed = f64::from(*below) * (1.0 - opacity) + f64::from(over) * opacity;
            *below = mixed.round() as u8;
        }
    }

    /// Copies a picture into this one, with its top left pixel at `x`, `y`. Parts outside are cut
    /// off.
    pub(crate) fn paste(&mut self, from: &Self, x: u32, y: u32) {
        if x >= self.width {
            return;
        }
        let bytes = 3 * from.width.min(self.width - x) as usize;
        let rows = from.rgb.chunks_exact((3 * from.width as usize).max(1));
        for (row, y) in rows.zip(y..self.height) {
            let at = 3 * (y as usize * self.width as usize + x as usize);
            self.rgb[at..at + bytes].copy_from_slice(&row[..bytes]);
        }
    }

    /// A rectangle of this picture, with its top left pixel at `x`, `y`. Parts outside are white.
    #[must_use]
    pub fn part(&self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> Self {
        let mut part = Self::new(width, height, [255; 3]);
        if x >= self.width {
            return part;
        }
        let bytes = 3 * part.width.min(self.width - x) as usize;
        let rows = part.rgb.chunks_exact_mut((3 * part.width as usize).max(1));
        for (row, y) in rows.zip(y..self.height) {
            let at = 3 * (y as usize * self.width as usize + x as usize);
            row[..bytes].copy_from_slice(&self.rgb[at..at + bytes]);
        }
        part
    }

    /// The picture with sides shorter by a whole factor: each pixel is the mean of a square.
    /// Remainders at the right and below are cut off.
    #[must_use]
    pub fn reduced(&self, factor: u32) -> Self {
        if factor <= 1 {
            return self.clone();
        }
        let mut small = Self::new(self.width / factor, self.height / factor, [0; 3]);
        let count = u64::from(factor) * u64::from(factor);
        let wide = self.width as usize;
        for (at, value) in small.rgb.iter_mut().enumerate() {
            let (pixel, channel) = (at / 3, at % 3);
            let x = pixel % small.width as usize * factor as usize;
            let y = pixel / small.width as usize * factor as usize;
            let sum: u64 = (y..y + factor as usize)
                .flat_map(|y| (x..x + factor as usize).map(move |x| 3 * (y * wide + x) + channel))
                .map(|at| u64::from(self.rgb[at]))
                .sum();
            *value = ((sum + count / 2) / count) as u8;
        }
        small
    }

    fn place(&self, x: i64, y: i64) -> Option<usize> {
        let is_inside =
            (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y);
        is_inside.then(|| 3 * (y as usize * self.width as usize + x as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reduced_is_the_mean() {
        let mut image = Image::new(5, 2, [10, 20, 30]);
        image.blend(0, 0, [50, 20, 30], 1.0);
        let small = image.reduced(2);
        assert_eq!((small.width(), small.height()), (2, 1));
        assert_eq!(small.rgb(), [20, 20, 30, 10, 20, 30]);
        assert!(image.reduced(9).rgb().is_empty());
    }

    #[test]
    fn part_is_a_rectangle() {
        let mut image = Image::new(4, 3, [1; 3]);
        image.blend(2, 1, [9; 3], 1.0);
        let part = image.part([2, 1], [1, 2]);
        assert_eq!(part.rgb(), [9, 9, 9, 1, 1, 1]);
        assert_eq!(image.part([3, 2], [2, 1]).pixel(1, 0), Some([255; 3]));
        assert_eq!(image.part([9, 0], [1, 1]).pixel(0, 0), Some([255; 3]));
        assert_eq!(image.part([0, 9], [1, 1]).pixel(0, 0), Some([255; 3]));
        assert_eq!(Image::of_rgb(4, 3, image.rgb().to_vec()), Some(image));
        assert_eq!(Image::of_rgb(4, 3, vec![0; 35]), None);
    }

    #[test]
    fn outside_is_harmless() {
        let mut image = Image::new(2, 2, [1; 3]);
        image.blend(-1, 5, [9; 3], 1.0);
        image.blend(0, 0, [9; 3], f64::NAN);
        image.paste(&Image::new(3, 3, [7; 3]), 1, 1);
        image.paste(&Image::new(0, 3, [7; 3]), 0, 0);
        image.paste(&Image::new(1, 1, [7; 3]), 9, 9);
        assert_eq!(image.pixel(1, 1), Some([7; 3]));
        assert_eq!(image.pixel(1, 0), Some([1; 3]));
        assert_eq!(image.pixel(2, 0), None);
    }
}
