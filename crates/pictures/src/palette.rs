//! A palette: the few colours by which those of a film are replaced, where nobody sees it.

use super::image::Image;

/// Most colours of a palette: 256 less the index of a transparent pixel.
const MOST: usize = 255;
/// Bits of each channel that tell cells of colours apart.
const BITS: u32 = 6;
/// Rounds in which colours of the palette move to the mean of the colours that they replace.
const ROUNDS: usize = 6;
/// A palette is not seen if the root mean square distance of colours from it is at most this, of
/// 255 in each channel.
const UNSEEN: f64 = 2.5;
/// The same for at most this fraction of the pixels that are further away than `FAR`.
const FAR: f64 = 16.0;
const FEW: f64 = 2e-3;

/// The number of pixels of each colour in some pictures, in cells of similar colours.
#[derive(Debug, Clone)]
pub(crate) struct Histogram {
    cells: Vec<Cell>,
}

/// Pixels of similar colours: their number and the sums of their channels.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    pixels: u64,
    sums: [u64; 3],
}

/// A mean colour of pixels, and their number.
#[derive(Debug, Clone, Copy)]
struct Shade {
    cell: usize,
    colour: [f64; 3],
    pixels: f64,
}

/// Colours, and the one that replaces each other colour.
#[derive(Debug, Clone)]
pub(crate) struct Palette {
    colours: Vec<[f64; 3]>,
    /// By cell.
    index: Vec<u8>,
}

impl Histogram {
    /// Without pixels.
    pub(crate) fn new() -> Self {
        Self {
            cells: vec![Cell::default(); 1 << (3 * BITS)],
        }
    }

    /// Adds all pixels of a picture.
    pub(crate) fn add(&mut self, image: &Image) {
        for pixel in image.rgb().chunks_exact(3) {
            let cell = &mut self.cells[cell_of(pixel)];
            cell.pixels += 1;
            for (sum, channel) in cell.sums.iter_mut().zip(pixel) {
                *sum += u64::from(*channel);
            }
        }
    }

    fn shades(&self) -> Vec<Shade> {
        let cells = self.cells.iter().enumerate();
        let shade = |(cell, of): (usize, &Cell)| Shade {
            cell,
            colour: of.sums.map(|sum| sum as f64 / of.pixels as f64),
            pixels: of.pixels as f64,
        };
        cells.filter(|(_, of)| of.pixels > 0).map(shade).collect()
    }
}

impl Palette {
    /// At most 255 colours for pixels of these. None: the difference would be seen.
    ///
    /// The pixels are divided along the channel in which they differ most, at their mean, always
    /// those that differ most (Wan, Wong and Prusinkiewicz 1988); the means of the groups then move
    /// by k-means.
    pub(crate) fn of(histogram: &Histogram) -> Option<Self> {
        let shades = histogram.shades();
        let mut colours = divided(&shades);
        for _ in 0..ROUNDS {
            colours = moved(&shades, &colours);
        }
        let mut index = vec![0; histogram.cells.len()];
        let (mut squares, mut far, mut all) = (0.0, 0.0, 0.0);
        for shade in &shades {
            let (nearest, square) = nearest(&colours, shade.colour);
            index[shade.cell] = nearest as u8;
            squares += square * shade.pixels;
            far += if square > FAR * FAR {
                shade.pixels
            } else {
                0.0
            };
            all += shade.pixels;
        }
        let is_unseen = squares <= 3.0 * UNSEEN * UNSEEN * all && far <= FEW * all;
        is_unseen.then_some(Self { colours, index })
    }

    /// The index of a transparent pixel.
    pub(crate) fn transparent(&self) -> u8 {
        self.colours.len() as u8
    }

    /// Its colours, three bytes each, and black for the transparent pixel.
    pub(crate) fn rgb(&self) -> Vec<u8> {
        let colours = self.colours.iter().chain(&[[0.0; 3]]);
        colours.flatten().map(|c| c.round() as u8).collect()
    }

    /// The index of each pixel of one of the pictures of the histogram. Length: width x height.
    pub(crate) fn indices(&self, image: &Image) -> Vec<u8> {
        let pixels = image.rgb().chunks_exact(3);
        pixels.map(|pixel| self.index[cell_of(pixel)]).collect()
    }
}

fn cell_of(pixel: &[u8]) -> usize {
    let part = |channel: &u8| usize::from(channel >> (8 - BITS));
    (pixel.iter()).fold(0, |cell, channel| cell << BITS | part(channel))
}

/// The means of at most [`MOST`] groups of shades.
fn divided(shades: &[Shade]) -> Vec<[f64; 3]> {
    let mut groups = vec![Group::of(shades.to_vec())];
    while groups.len() < MOST {
        let spread = |at: &usize| groups[*at].squares.iter().sum::<f64>();
        let widest = (0..groups.len()).max_by(|a, b| spread(a).total_cmp(&spread(b)));
        let Some(widest) = widest.filter(|at| groups[*at].shades.len() > 1) else {
            break;
        };
        let [left, right] = groups.swap_remove(widest).halves();
        groups.extend([left, right]);
    }
    groups.iter().map(|group| group.mean).collect()
}

/// Shades that get one colour.
struct Group {
    shades: Vec<Shade>,
    mean: [f64; 3],
    /// Sum of the squares of the distances from the mean along each channel.
    squares: [f64; 3],
}

impl Group {
    fn of(shades: Vec<Shade>) -> Self {
        let pixels: f64 = shades.iter().map(|shade| shade.pixels).sum();
        let over = |k: usize, of: &dyn Fn(f64) -> f64| -> f64 {
            shades.iter().map(|s| s.pixels * of(s.colour[k])).sum()
        };
        let mean = [0, 1, 2].map(|k| over(k, &|c| c) / pixels.max(1.0));
        let squares = [0, 1, 2].map(|k| over(k, &|c| (c - mean[k]).powi(2)));
        Self {
            shades,
            mean,
            squares,
        }
    }

    /// Both sides of the mean along the widest channel. Two different shades at least.
    fn halves(self) -> [Self; 2] {
        let Self {
            shades,
            mean,
            squares,
        } = self;
        let widest = (0..3).max_by(|a, b| squares[*a].total_cmp(&squares[*b]));
        let widest = widest.unwrap_or_default();
        let is_left = |shade: &Shade| shade.colour[widest] < mean[widest];
        let (left, right) = shades.into_iter().partition(is_left);
        [Self::of(left), Self::of(right)]
    }
}

/// Each colour at the mean of the shades that are nearest to it.
fn moved(shades: &[Shade], colours: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut sums = vec![([0.0; 3], 0.0); colours.len()];
    for shade in shades {
        let (sum, pixels) = &mut sums[nearest(colours, shade.colour).0];
        *sum = [0, 1, 2].map(|k| sum[k] + shade.pixels * shade.colour[k]);
        *pixels += shade.pixels;
    }
    let mean = |(colour, (sum, pixels)): (&[f64; 3], ([f64; 3], f64))| {
        if pixels > 0.0 {
            sum.map(|sum| sum / pixels)
        } else {
            *colour
        }
    };
    colours.iter().zip(sums).map(mean).collect()
}

/// The index of the nearest of these colours, and the square of its distance.
fn nearest(colours: &[[f64; 3]], colour: [f64; 3]) -> (usize, f64) {
    let square = |of: &[f64; 3]| -> f64 { (0..3).map(|k| (of[k] - colour[k]).powi(2)).sum() };
    let squares = colours.iter().map(square).enumerate();
    squares
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn picture(colour: impl Fn(u32, u32) -> [u8; 3]) -> Image {
        let mut image = Image::new(64, 64, [0; 3]);
        for at in 0..64 * 64 {
            let [x, y] = [at % 64, at / 64];
            image.blend(i64::from(x), i64::from(y), colour(x, y), 1.0);
        }
        image
    }

    fn palette(image: &Image) -> Option<Palette> {
        let mut histogram = Histogram::new();
        histogram.add(image);
        Palette::of(&histogram)
    }

    #[test]
    fn few_colours_stay_as_they_are() {
        let colours = [[255, 255, 255], [230, 159, 0], [0, 114, 178], [3, 2, 1]];
        let image = picture(|x, y| colours[((x + 7 * y) % 4) as usize]);
        let palette = palette(&image).unwrap();
        let [rgb, indices] = [palette.rgb(), palette.indices(&image)];
        assert_eq!(rgb.len(), 3 * 5);
        assert_eq!(palette.transparent(), 4);
        for (index, pixel) in indices.iter().zip(image.rgb().chunks_exact(3)) {
            assert_eq!(rgb[3 * usize::from(*index)..][..3], *pixel);
        }
    }

    #[test]
    fn a_slope_of_one_hue_is_hardly_changed() {
        let image = picture(|x, y| [(3 * x + y) as u8, (2 * x) as u8, 9]);
        let palette = palette(&image).unwrap();
        let rgb = palette.rgb();
        assert_eq!(rgb.len(), 3 * 256);
        let pixels = palette
            .indices(&image)
            .into_iter()
            .zip(image.rgb().chunks_exact(3));
        for (index, pixel) in pixels {
            for (a, b) in rgb[3 * usize::from(index)..][..3].iter().zip(pixel) {
                assert!(a.abs_diff(*b) <= 8, "{a} {b}");
            }
        }
    }

    #[test]
    fn all_colours_of_the_rainbow_need_more() {
        let image = picture(|x, y| [4 * x as u8, 4 * y as u8, (x * y / 16) as u8]);
        assert!(palette(&image).is_none());
    }
}
