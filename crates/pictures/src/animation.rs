//! Pictures one after the other, as an animated PNG.

use std::rc::Rc;

use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, EncodingError, Filter};

use super::image::Image;
use super::palette::{Histogram, Palette};
use super::png_file::fault;

/// Pictures as the bytes of an animated PNG file, which browsers play repeatedly. `delay_ms`: time
/// for which each is shown.
///
/// `frame` gives each of the `count` pictures, at least one, twice in turn. All have the size of
/// the first one: the others are cut off or padded in white. For each, only the rectangle that
/// differs from the previous one is stored. The colours are those of a palette of 256, in which
/// unchanged pixels are transparent; where the palette would be seen, the colours are stored as
/// they are.
pub fn animation(
    count: u32,
    delay_ms: u16,
    mut frame: impl FnMut(u32) -> dem_io::Result<Rc<Image>>,
) -> dem_io::Result<Vec<u8>> {
    let first = if count == 0 {
        Rc::new(Image::new(0, 0, [255; 3]))
    } else {
        frame(0)?
    };
    let mut sized = |number: u32| {
        let given = frame(number)?;
        if [given.width(), given.height()] == [first.width(), first.height()] {
            return Ok(given);
        }
        let mut image = Image::new(first.width(), first.height(), [255; 3]);
        image.paste(&given, 0, 0);
        Ok(Rc::new(image))
    };
    let mut histogram = Histogram::new();
    histogram.add(&first);
    for number in 1..count {
        let image = sized(number)?;
        histogram.add(&image);
    }
    let colours = match Palette::of(&histogram) {
        Some(palette) => Colours::Palette(palette),
        None => Colours::Rgb,
    };
    let mut bytes = Vec::new();
    let mut film = colours
        .encoder(&mut bytes, &first, count, delay_ms)
        .and_then(Encoder::write_header)
        .map_err(|error| fault(&error))?;
    let mut shown = colours.pixels(&first);
    film.write_image_data(&shown)
        .map_err(|error| fault(&error))?;
    for number in 1..count {
        let image = sized(number)?;
        let next = colours.pixels(&image);
        let [x, y, width, height] = difference(&shown, &next, first.width(), colours.bytes());
        let part = colours.part(&shown, &next, first.width(), [x, y, width, height]);
        film.reset_frame_position()
            .and_then(|()| film.set_frame_dimension(width, height))
            .and_then(|()| film.set_frame_position(x, y))
            .and_then(|()| film.set_blend_op(colours.blend()))
            .and_then(|()| film.write_image_data(&part))
            .map_err(|error| fault(&error))?;
        shown = next;
    }
    film.finish().map_err(|error| fault(&error))?;
    Ok(bytes)
}

/// The form in which the pixels of a film are stored.
enum Colours {
    /// An index each.
    Palette(Palette),
    /// Three bytes each.
    Rgb,
}

impl Colours {
    /// Of a film whose first picture has this size.
    fn encoder<'a>(
        &self,
        bytes: &'a mut Vec<u8>,
        first: &Image,
        count: u32,
        delay_ms: u16,
    ) -> Result<Encoder<'a, &'a mut Vec<u8>>, EncodingError> {
        let mut encoder = Encoder::new(bytes, first.width(), first.height());
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::High);
        match self {
            Self::Palette(palette) => {
                encoder.set_color(ColorType::Indexed);
                let mut opacity = vec![255; usize::from(palette.transparent())];
                opacity.push(0);
                encoder.set_palette(palette.rgb());
                encoder.set_trns(opacity);
                // Neighbouring indices are not similar colours.
                encoder.set_filter(Filter::NoFilter);
            }
            Self::Rgb => {
                encoder.set_color(ColorType::Rgb);
                encoder.set_filter(Filter::Adaptive);
            }
        }
        // Without frames as well, so that the header is refused.
        encoder.set_animated(count.max(1), 0)?;
        encoder.set_frame_delay(delay_ms, 1000)?;
        encoder.set_blend_op(BlendOp::Source)?;
        encoder.set_dispose_op(DisposeOp::None)?;
        Ok(encoder)
    }

    /// Bytes of a pixel.
    fn bytes(&self) -> usize {
        match self {
            Self::Palette(_) => 1,
            Self::Rgb => 3,
        }
    }

    /// How a picture is laid over the previous one.
    fn blend(&self) -> BlendOp {
        match self {
            Self::Palette(_) => BlendOp::Over,
            Self::Rgb => BlendOp::Source,
        }
    }

    /// The pixels of a picture. Length: [`bytes`](Self::bytes) x pixels.
    fn pixels(&self, image: &Image) -> Vec<u8> {
        match self {
            Self::Palette(palette) => palette.indices(image),
            Self::Rgb => image.rgb().to_vec(),
        }
    }

    /// The pixels of a rectangle (left, top, width, height) of the next picture, laid over the one
    /// that is shown. `wide`: width of the pictures, px.
    fn part(
        &self,
        shown: &[u8],
        next: &[u8],
        wide: u32,
        [x, y, width, height]: [u32; 4],
    ) -> Vec<u8> {
        let [wide, x, width] = [wide, x, width].map(|px| px as usize * self.bytes());
        let mut part = Vec::with_capacity(width * height as usize);
        for row in y..y + height {
            let start = row as usize * wide + x;
            let [shown, next] = [shown, next].map(|pixels| &pixels[start..start + width]);
            match self {
                Self::Palette(palette) => {
                    let transparent = palette.transparent();
                    let pixel =
                        |(old, new): (&u8, &u8)| if old == new { transparent } else { *new };
                    part.extend(shown.iter().zip(next).map(pixel));
                }
                Self::Rgb => part.extend(next),
            }
        }
        part
    }
}

/// The smallest rectangle that contains all pixels that differ, or one pixel: left, top, width,
/// height. `wide`: width of both pictures, px; `bytes` of each pixel.
fn difference(a: &[u8], b: &[u8], wide: u32, bytes: usize) -> [u32; 4] {
    let row = (wide as usize * bytes).max(1);
    let mut low = [u32::MAX; 2];
    let mut high = [0; 2];
    for (y, (a, b)) in (0u32..).zip(a.chunks_exact(row).zip(b.chunks_exact(row))) {
        if a == b {
            continue;
        }
        let differs = |at: &usize| a[*at] != b[*at];
        let ends = [(0..row).find(differs), (0..row).rfind(differs)];
        for x in ends.into_iter().flatten().map(|at| (at / bytes) as u32) {
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
        }
    }
    if low[0] > high[0] {
        return [0, 0, 1, 1];
    }
    [low[0], low[1], high[0] - low[0] + 1, high[1] - low[1] + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn difference_is_the_smallest_rectangle() {
        let a = Image::new(9, 9, [0; 3]);
        let mut b = a.clone();
        let of = |b: &Image| difference(a.rgb(), b.rgb(), 9, 3);
        assert_eq!(of(&b), [0, 0, 1, 1]);
        b.blend(2, 3, [9; 3], 1.0);
        b.blend(5, 4, [9; 3], 1.0);
        assert_eq!(of(&b), [2, 3, 4, 2]);
    }
}
