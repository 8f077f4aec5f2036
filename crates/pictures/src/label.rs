//! Labels: the time, a scale of lengths, a scale of colours.

mod font;

use super::image::Image;

/// Colour of labels.
const INK: [u8; 3] = [38, 42, 48];

/// Height of digits as a fraction of the height of the picture, and the smallest height, px.
const TEXT: f64 = 0.030;
const LEAST_TEXT_PX: f64 = 10.0;

/// Largest length of the scale bar, as a fraction of the width of the picture.
const BAR: f64 = 0.20;

/// Width of the bar of colours as a fraction of the width of the picture, unless the values at its
/// ends need more.
const COLOURS: f64 = 0.22;

/// Units of length with their size, m.
const LENGTHS: [(&str, f64); 4] = [("km", 1e3), ("m", 1.0), ("mm", 1e-3), ("µm", 1e-6)];

/// A time as a label: `t = 0.125 s`, or `t = 0.2 ms` where frames are less than a millisecond
/// apart, with as many decimals as needed for frames `step_s` apart. Both in s.
pub fn time_text(time_s: f64, step_s: f64) -> String {
    let (unit, size) = match step_s.abs() {
        step_s if step_s < 0.999e-6 => ("µs", 1e-6),
        step_s if step_s < 0.999e-3 => ("ms", 1e-3),
        _ => ("s", 1.0),
    };
    let (time, step) = (time_s / size, step_s / size);
    let mut decimals = 0;
    let mut rest = step.abs();
    // Up to the first step that is whole except for rounding, and three digits of it.
    while decimals < 9
        && rest.is_normal()
        && (rest < 1.0 || (rest - rest.round()).abs() > 1e-6 * rest)
    {
        if rest >= 100.0 {
            break;
        }
        rest *= 10.0;
        decimals += 1;
    }
    format!("t = {time:.decimals$} {unit}")
}

/// Writes a label into the top left corner. Characters without a glyph become blanks.
pub fn label(image: &mut Image, text: &str) {
    let size = text_px(image);
    font::write(image, text, [1.1 * size, 1.0 * size], size, INK);
}

/// Writes a name at a position, px from the left and from the top: its left end and its top. It is
/// moved into the picture.
pub fn name_at(image: &mut Image, name: &str, at: [f64; 2]) {
    let size = 0.8 * text_px(image);
    let most = [
        f64::from(image.width()) - font::width(name, size) - size,
        f64::from(image.height()) - 2.0 * size,
    ];
    let at = [0, 1].map(|k| at[k].min(most[k]).max(0.5 * size));
    font::write(image, name, at, size, INK);
}

/// Draws a bar of a round length with its label into the bottom right corner. `px_per_m`: the scale
/// of the picture.
///
/// Nothing is drawn if the scale is not a positive number.
pub fn scale_bar(image: &mut Image, px_per_m: f64) {
    let most_m = BAR * f64::from(image.width()) / px_per_m;
    let Some((length_m, text)) = round_length(most_m) else {
        return;
    };
    let size = text_px(image);
    let length = length_m * px_per_m;
    let right = f64::from(image.width()) - 1.4 * size;
    let bottom = f64::from(image.height()) - 1.3 * size;
    let left = right - length;
    let tick = 0.32 * size;
    let bar = [
        [[left, bottom], [right, bottom]],
        [[left, bottom - tick], [left, bottom + tick]],
        [[right, bottom - tick], [right, bottom + tick]],
    ];
    font::stroke(image, &bar, (0.12 * size).max(1.2), INK);
    let middle = 0.5 * (left + right - font::width(&text, size));
    font::write(image, &text, [middle, bottom - 1.75 * size], size, INK);
}

/// Draws a bar of colours with its name and the values at its ends into the bottom left corner.
/// `colour`: red, green, blue at a fraction of the bar, from 0 to 1.
pub fn colour_bar(image: &mut Image, name: &str, ends: [&str; 2], colour: &dyn Fn(f64) -> [u8; 3]) {
    let size = text_px(image);
    let bottom = f64::from(image.height()) - 1.3 * size;
    let left = 1.1 * size;
    let (width, height) = (colours_px(image, ends), 0.8 * size);
    let columns = width as i64;
    for column in 0..columns {
        let colour = colour((column as f64 + 0.5) / columns as f64);
        for y in (bottom - height) as i64..bottom as i64 {
            image.blend(left as i64 + column, y, colour, 1.0);
        }
    }
    let above = bottom - height - 1.4 * size;
    font::write(image, ends[0], [left, above], size, INK);
    let last = left + width - font::width(ends[1], size);
    font::write(image, ends[1], [last, above], size, INK);
    font::write(image, name, [left, above - 1.6 * size], size, INK);
}

/// Width of the bar of colours, px: wide enough for the values at its ends beside each other.
fn colours_px(image: &Image, ends: [&str; 2]) -> f64 {
    let size = text_px(image);
    let [low, high] = ends.map(|end| font::width(end, size));
    (COLOURS * f64::from(image.width())).max(low + high + size)
}

fn text_px(image: &Image) -> f64 {
    (TEXT * f64::from(image.height())).max(LEAST_TEXT_PX)
}

/// The longest of 1, 2 and 5 times a power of ten up to a length, m, and its text.
fn round_length(most_m: f64) -> Option<(f64, String)> {
    let decade = (-9..=9).rev().find(|k| 10f64.powi(*k) <= most_m)?;
    if most_m > 1e10 {
        return None;
    }
    let digit = [5.0, 2.0, 1.0]
        .into_iter()
        .find(|digit| digit * 10f64.powi(decade) <= most_m)?;
    let length_m = digit * 10f64.powi(decade);
    let (unit, size) = LENGTHS
        .into_iter()
        .find(|(_, size)| length_m > 0.999 * size)
        .unwrap_or(LENGTHS[3]);
    let value = (length_m / size * 1e6).round() / 1e6;
    Some((length_m, format!("{value} {unit}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_has_the_decimals_of_its_steps() {
        assert_eq!(time_text(0.125, 0.025), "t = 0.125 s");
        assert_eq!(time_text(3.0, 0.5), "t = 3.0 s");
        assert_eq!(time_text(20.0, 10.0), "t = 20 s");
        assert_eq!(time_text(0.1 + 0.2, 0.1), "t = 0.3 s");
        assert_eq!(time_text(1.0, 1.0 / 3.0), "t = 1.000 s");
        assert_eq!(time_text(0.002, 0.001), "t = 0.002 s");
        assert_eq!(time_text(2e-4, 1e-4), "t = 0.2 ms");
        assert_eq!(time_text(2e-3, 1e-4), "t = 2.0 ms");
        assert_eq!(time_text(1e-5, 1e-5), "t = 0.01 ms");
        assert_eq!(time_text(3e-7, 1e-7), "t = 0.3 µs");
        for odd in [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e300, 1e-300] {
            let _ = [time_text(odd, odd), time_text(1.0, odd)];
        }
    }

    #[test]
    fn lengths_are_round() {
        let text = |most_m| round_length(most_m).map(|(_, text)| text);
        assert_eq!(text(0.12).as_deref(), Some("100 mm"));
        assert_eq!(text(0.00099).as_deref(), Some("500 µm"));
        assert_eq!(text(2.1).as_deref(), Some("2 m"));
        assert_eq!(text(1.0).as_deref(), Some("1 m"));
        assert_eq!(text(7e3).as_deref(), Some("5 km"));
        for none in [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e300] {
            assert_eq!(text(none), None);
        }
    }

    #[test]
    fn values_at_the_ends_of_the_colours_stand_beside_each_other() {
        for (width, height) in [(1600, 1200), (800, 600), (300, 1200)] {
            let image = Image::new(width, height, [255; 3]);
            for ends in [["0", "1"], ["0", "0.0000123 kg"], ["-123.4", "123.4 /s"]] {
                let size = text_px(&image);
                let both = font::width(ends[0], size) + font::width(ends[1], size);
                let width = colours_px(&image, ends);
                assert!(width >= both + 0.9 * size, "{ends:?}: {width} {both}");
            }
        }
    }
}
