//! The pictures of a film, and some of them side by side.

use super::image::{Image, MAX_SIDE_PX};

/// Largest number of pictures of a film strip.
pub(crate) const OF_STRIP: usize = 8;
/// Number of pictures in a row of it.
pub const COLUMNS: usize = 4;
/// Factor by which the pictures of the strip are reduced.
pub const SMALLER: u32 = 2;

/// Largest number of pictures of a film, without the last one.
pub(crate) const OF_FILM: usize = 200;
/// Duration of a film, if that is neither too fast nor too slow for a picture, ms.
const FILM_MS: usize = 8000;
const PICTURE_MS: [usize; 2] = [40, 400];

/// Lines between the frames of a film strip.
const RULE: [u8; 3] = [222, 225, 229];

/// At most `OF_STRIP` of this number of pictures: the first, the last and others evenly between
/// them.
pub fn chosen_for_strip(count: usize) -> Vec<usize> {
    match count {
        0..=OF_STRIP => (0..count).collect(),
        more => (0..OF_STRIP)
            .map(|k| k * (more - 1) / (OF_STRIP - 1))
            .collect(),
    }
}

/// Every one or every second, third, ... of this number of pictures, and the last one.
pub fn chosen_for_film(count: usize) -> Vec<usize> {
    let every = count.div_ceil(OF_FILM).max(1);
    let mut chosen: Vec<usize> = (0..count).step_by(every).collect();
    if let (Some(&shown), Some(last)) = (chosen.last(), count.checked_sub(1))
        && shown != last
    {
        chosen.push(last);
    }
    chosen
}

/// Time for which each of this number of pictures is shown, ms.
pub fn delay_ms(count: usize) -> u16 {
    let [least, most] = PICTURE_MS;
    (FILM_MS / count.max(1)).clamp(least, most) as u16
}

/// The pictures in rows of this number of columns, with thin lines between them. All have the size
/// of the first one: the others are cut off or padded in white.
///
/// A strip that would be larger than a picture may be is reduced by a whole factor. Without frames
/// it has no pixels.
pub fn film_strip(frames: &[Image], columns: usize) -> Image {
    let Some(first) = frames.first() else {
        return Image::new(0, 0, RULE);
    };
    let columns = columns.clamp(1, frames.len());
    let rows = frames.len().div_ceil(columns);
    let sides = |factor: u32| [first.width(), first.height()].map(|side| side / factor);
    let fits = |factor: &u32| {
        let [wide, high] = sides(*factor).map(|side| side as usize + 1);
        wide * columns <= MAX_SIDE_PX as usize && high * rows <= MAX_SIDE_PX as usize
    };
    let factor = (1..MAX_SIDE_PX).find(fits).unwrap_or(MAX_SIDE_PX);
    let [wide, high] = sides(factor);
    let side = |one: u32, count: usize| (one + 1).saturating_mul(count as u32) - 1;
    let mut strip = Image::new(side(wide, columns), side(high, rows), RULE);
    for at in 0..rows * columns {
        let mut cell = Image::new(wide, high, [255; 3]);
        if let Some(frame) = frames.get(at) {
            cell.paste(&frame.reduced(factor), 0, 0);
        }
        let [x, y] = [at % columns, at / columns].map(|k| k as u32);
        strip.paste(&cell, x * (wide + 1), y * (high + 1));
    }
    strip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chosen_are_the_first_the_last_and_some_between() {
        assert!(chosen_for_strip(0).is_empty() && chosen_for_film(0).is_empty());
        assert_eq!(chosen_for_strip(3), [0, 1, 2]);
        assert_eq!(chosen_for_strip(9), [0, 1, 2, 3, 4, 5, 6, 8]);
        assert_eq!(
            chosen_for_strip(701),
            [0, 100, 200, 300, 400, 500, 600, 700]
        );
        assert_eq!(chosen_for_film(1), [0]);
        assert_eq!(chosen_for_film(200).len(), 200);
        assert_eq!(chosen_for_film(201).len(), 101);
        assert_eq!(chosen_for_film(402)[132..], [396, 399, 401]);
        assert_eq!([0, 10, 100, 1000].map(delay_ms), [400, 400, 80, 40]);
    }
}
