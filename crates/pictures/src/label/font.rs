//! A stroke font, smooth at every size.

use crate::image::Image;

/// Units between the base line and the top of a digit. A glyph is up to 4 units wide.
const HIGH: f64 = 8.0;
/// Gap between two glyphs, units.
const GAP: f64 = 1.9;
/// Ratio of the width of a unit to its height.
const WIDE: f64 = 1.15;
/// Width of a stroke as a fraction of the height of a digit.
const STROKE: f64 = 0.125;
/// Reach of the white border around a stroke, as a fraction of its width.
const HALO: f64 = 1.1;
const HALO_OPACITY: f64 = 0.85;
/// Number of times that corners are cut: three times is smooth.
const CUTS: usize = 3;

/// Width in units, and strokes: points of two digits each, from the left and from the top. Corners
/// are rounded, unless a point is repeated.
const GLYPHS: [(char, usize, &str); 71] = [
    ('0', 4, "20 40 42 46 48 28 08 06 02 00 20"),
    ('1', 2, "02 20 20 28"),
    ('2', 4, "02 00 20 40 42 44 08 08 48"),
    ('3', 4, "01 10 40 40 44 14,14 44 44 48 08 07"),
    ('4', 4, "38 30 30 05 05 45"),
    ('5', 4, "40 10 10 03 03 23 43 45 48 28 08 07"),
    ('6', 4, "30 00 05 08 28 48 43 23 03 05"),
    ('7', 4, "00 40 40 18"),
    ('8', 4, "20 40 44 24 04 00 20,24 44 48 28 08 04 24"),
    ('9', 4, "43 45 25 05 00 20 40 43 48 18"),
    ('.', 0, "08 08"),
    (',', 1, "18 09"),
    (':', 0, "04 04,08 08"),
    ('-', 3, "05 35"),
    ('+', 4, "05 45,23 27"),
    ('=', 4, "04 44,06 46"),
    ('/', 3, "30 09"),
    ('a', 4, "04 13 33 44 48,45 15 06 08 28 46"),
    ('c', 4, "44 33 13 04 07 18 38 47"),
    ('d', 4, "40 48,46 38 18 07 04 13 33 45"),
    ('e', 4, "06 46 46 43 23 03 06 08 28 48 47"),
    ('f', 3, "30 10 18,03 33"),
    ('g', 4, "43 48 39 19 09,46 38 18 07 04 13 33 45"),
    ('h', 4, "00 08,05 03 23 43 48"),
    ('i', 0, "03 08,01 01"),
    ('k', 3, "00 08,33 06,15 38"),
    ('l', 0, "00 08"),
    ('m', 6, "03 08,05 03 13 33 38,35 33 43 63 68"),
    ('n', 4, "03 08,05 03 23 43 48"),
    ('o', 4, "23 43 48 28 08 03 23"),
    ('r', 3, "03 08,05 03 13 33"),
    ('s', 3, "34 33 03 05 36 38 08 07"),
    ('t', 3, "11 18 38,03 33"),
    ('u', 4, "03 08 28 48 43,43 48"),
    ('x', 4, "03 48,43 08"),
    ('y', 4, "03 28,43 28 19 09"),
    ('b', 4, "00 08,06 18 38 47 44 33 13 05"),
    ('j', 1, "13 18 09,11 11"),
    ('p', 4, "03 09,06 18 38 47 44 33 13 05"),
    ('q', 4, "43 49,46 38 18 07 04 13 33 45"),
    ('v', 4, "03 28 28 43"),
    ('w', 6, "03 28 28 33 33 48 48 63"),
    ('z', 4, "03 43 43 08 08 48"),
    ('_', 4, "09 49"),
    ('A', 4, "08 20 20 48,15 35"),
    ('B', 4, "04 34 45 47 38 08 08 00 00 30 41 43 34 04"),
    ('C', 4, "41 30 10 02 06 18 38 47"),
    ('D', 4, "08 08 00 00 20 42 46 28 08 08"),
    ('E', 4, "40 00 00 08 08 48,04 34"),
    ('F', 4, "40 00 00 08,04 34"),
    ('H', 4, "00 08,40 48,04 44"),
    ('I', 0, "00 08"),
    ('K', 4, "00 08,40 04 04 48"),
    ('L', 4, "00 08 08 48"),
    ('O', 4, "20 00 02 06 08 28 48 46 42 40 20"),
    ('Q', 4, "20 00 02 06 08 28 48 46 42 40 20,26 49"),
    ('R', 4, "08 00 00 30 41 43 34 04,24 48"),
    ('S', 4, "41 30 10 01 03 14 34 45 47 38 18 07"),
    ('T', 4, "00 40,20 28"),
    ('U', 4, "00 06 18 38 46 40"),
    ('V', 4, "00 28 28 40"),
    ('X', 4, "00 48,40 08"),
    ('Y', 4, "00 24 24 40,24 28"),
    ('Z', 4, "00 40 40 08 08 48"),
    ('G', 4, "41 30 10 02 06 18 38 46 44 44 24"),
    ('J', 3, "30 36 18 06"),
    ('M', 5, "08 00 00 25 25 50 50 58"),
    ('N', 4, "08 00 00 48 48 40"),
    ('P', 4, "08 00 00 30 41 43 34 04"),
    ('W', 6, "00 18 18 32 32 58 58 60"),
    ('µ', 4, "03 09 09,06 08 18 38 36,43 48"),
];

type Stroke = [[f64; 2]; 2];

/// Width of a text with digits `size` px high, px.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let units: f64 = text.chars().map(advance).sum();
    (units - GAP).max(0.0) * WIDE * size / HIGH
}

/// Writes a text. `at`: its left end and the top of its digits, px.
pub(super) fn write(image: &mut Image, text: &str, at: [f64; 2], size: f64, colour: [u8; 3]) {
    let unit = size / HIGH;
    let mut left = at[0];
    let mut strokes = Vec::new();
    for sign in text.chars() {
        if let Some((_, _, points)) = GLYPHS.iter().find(|glyph| glyph.0 == sign) {
            for points in points.split(',') {
                let line = smooth(points);
                let placed = |p: [f64; 2]| [left + p[0] * WIDE * unit, at[1] + p[1] * unit];
                strokes.extend(
                    line.windows(2)
                        .map(|ends| [placed(ends[0]), placed(ends[1])]),
                );
            }
        }
        left += advance(sign) * WIDE * unit;
    }
    stroke(image, &strokes, (STROKE * size).max(1.2), colour);
}

/// Draws straight strokes with round ends over a white border. Ends, px; shape n x 2 x 2.
pub(super) fn stroke(image: &mut Image, strokes: &[Stroke], width: f64, colour: [u8; 3]) {
    let halo = (HALO * width).max(1.5);
    let reach = 0.5 * width + halo + 1.0;
    let longest = strokes.iter().map(|[a, b]| (a[0] - b[0]).abs());
    let far = reach + longest.fold(0.0, f64::max);
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for point in strokes.iter().flatten() {
        low = [0, 1].map(|k| low[k].min(point[k] - reach));
        high = [0, 1].map(|k| high[k].max(point[k] + reach));
    }
    let sides = [image.width(), image.height()].map(f64::from);
    let [columns, rows] =
        [0, 1].map(|k| low[k].clamp(0.0, sides[k]) as i64..high[k].clamp(0.0, sides[k]) as i64);
    for y in rows {
        let row: Vec<&Stroke> = strokes
            .iter()
            .filter(|ends| {
                ends.iter()
                    .any(|end| (end[1] - y as f64).abs() < reach + 1.0)
                    || crosses(ends, y as f64)
            })
            .collect();
        for x in columns.clone() {
            let here = [x as f64 + 0.5, y as f64 + 0.5];
            let square = row
                .iter()
                .filter(|ends| ends.iter().any(|end| (end[0] - here[0]).abs() < far))
                .map(|ends| distance_squared(here, ends))
                .fold(f64::INFINITY, f64::min);
            if square > reach * reach {
                continue;
            }
            let off = square.sqrt() - 0.5 * width;
            let border = ((halo - off) / halo + 0.5).clamp(0.0, 1.0);
            image.blend(x, y, [255; 3], HALO_OPACITY * border);
            image.blend(x, y, colour, 0.5 - off);
        }
    }
}

fn crosses(ends: &Stroke, y: f64) -> bool {
    (ends[0][1] < y) != (ends[1][1] < y)
}

fn distance_squared(point: [f64; 2], ends: &Stroke) -> f64 {
    let along = [0, 1].map(|k| ends[1][k] - ends[0][k]);
    let from = [0, 1].map(|k| point[k] - ends[0][k]);
    let square = along[0] * along[0] + along[1] * along[1];
    let t = if square > 0.0 {
        ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = [0, 1].map(|k| from[k] - t * along[k]);
    off[0] * off[0] + off[1] * off[1]
}

/// Distance from the left end of a glyph to that of the next one, units.
fn advance(sign: char) -> f64 {
    let glyph = GLYPHS.iter().find(|glyph| glyph.0 == sign);
    glyph.map_or(1.5, |(_, wide, _)| *wide as f64) + GAP
}

/// The points of a stroke, with its corners cut off repeatedly.
fn smooth(points: &str) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = points
        .split(' ')
        .map(|point| {
            let mut digits = point
                .chars()
                .map(|digit| f64::from(digit.to_digit(10).unwrap_or(0)));
            [digits.next().unwrap_or(0.0), digits.next().unwrap_or(0.0)]
        })
        .collect();
    let between =
        |a: [f64; 2], b: [f64; 2], fraction: f64| [0, 1].map(|k| a[k] + fraction * (b[k] - a[k]));
    for _ in 0..CUTS {
        let (Some(first), Some(last)) = (line.first(), line.last()) else {
            break;
        };
        let mut next = vec![*first];
        let inner = line.windows(2);
        next.extend(
            inner.flat_map(|ends| [0.25, 0.75].map(|fraction| between(ends[0], ends[1], fraction))),
        );
        next.push(*last);
        line = next;
    }
    line
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn all_signs_of_labels_have_a_glyph() {
        for sign in "t = -0123456789.e s km mm µm inf fragment mass kg strain rate dynamic increase factor utilisation /s MPa GN kJ W abcdefghijklmnopqrstuvwxyz".chars() {
            assert!(
                sign == ' ' || GLYPHS.iter().any(|glyph| glyph.0 == sign),
                "{sign}"
            );
        }
    }

    #[test]
    fn text_is_as_wide_as_said() {
        let mut image = Image::new(200, 40, [255; 3]);
        write(&mut image, "0.4", [10.0, 10.0], 20.0, [0; 3]);
        let dark = |x: &u32| (0..40).any(|y| image.pixel(*x, y).unwrap()[0] < 128);
        let (first, last) = (
            (0..200).find(dark).unwrap(),
            (0..200).rev().find(dark).unwrap(),
        );
        assert!((9..=11).contains(&first));
        assert!((f64::from(last) - 10.0 - width("0.4", 20.0)).abs() < 2.5);
    }
}
