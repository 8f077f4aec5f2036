//! Colours of particles by their fragment.
//!
//! Hues are distinguishable with any colour vision, and neighbouring numbers differ in hue as well
//! as in lightness. A number always has the same colour.

/// A single particle: light grey.
pub const SINGLE: [u8; 3] = [196, 198, 201];

/// After Okabe and Ito 2008, without the yellow, which is hardly visible on white, and with wine
/// red.
const VIVID: [[u8; 3]; 7] = [
    [0, 114, 178],
    [230, 140, 0],
    [0, 150, 110],
    [213, 80, 20],
    [86, 176, 230],
    [150, 40, 100],
    [205, 120, 170],
];

/// Steel and slate, from blue to green grey, dark and light in turn.
const CALM: [[u8; 3]; 7] = [
    [96, 125, 156],
    [157, 175, 190],
    [84, 112, 122],
    [136, 146, 178],
    [116, 152, 160],
    [92, 100, 130],
    [172, 182, 176],
];

/// Lightening (+) or darkening (-) of the colours, round after round.
const ROUNDS: [f64; 3] = [0.0, 0.38, -0.35];

/// The colour of a bonded cluster or a fragment: vivid. Red, green, blue.
pub fn of_cluster(id: u32) -> [u8; 3] {
    pick(&VIVID, id)
}

/// The colour of a rigid clump: steel. Red, green, blue.
pub fn of_clump(id: u32) -> [u8; 3] {
    pick(&CALM, id)
}

/// The colour of a fragment by its number and its fraction of the original body.
///
/// The complete body (1) is calm, and the smaller the piece, the more vivid. A fraction that is not
/// a number counts as 0. Red, green, blue.
pub fn of_fragment(id: u32, fraction: f64) -> [u8; 3] {
    let calm = if fraction > 0.0 {
        fraction.min(1.0)
    } else {
        0.0
    };
    mixed(of_cluster(id), of_clump(id), 0.75 * calm * calm)
}

/// A fragment in the history of a run, whose number is its place in the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Piece {
    /// The fragment from which it broke off, which has a smaller number.
    pub parent: Option<u32>,
    /// Number of its particles.
    pub particles: u32,
}

/// The colour of each fragment of a run. The largest part of a broken one keeps its colour, so that
/// a body that loses a crumb does not flicker. Red, green, blue.
pub fn of_pieces(pieces: &[Piece]) -> Vec<[u8; 3]> {
    let mut heirs: Vec<Option<usize>> = vec![None; pieces.len()];
    for (id, piece) in pieces.iter().enumerate() {
        let Some(heir) = (piece.parent).and_then(|parent| heirs.get_mut(parent as usize)) else {
            continue;
        };
        if heir.is_none_or(|heir| pieces[heir].particles < piece.particles) {
            *heir = Some(id);
        }
    }
    // Number of the colour, and number of particles of the original body. A parent precedes its
    // fragments.
    let mut known: Vec<(u32, u32)> = Vec::with_capacity(pieces.len());
    for (id, piece) in pieces.iter().enumerate() {
        let parent = piece.parent.map(|parent| parent as usize);
        let of_parent = parent.and_then(|parent| known.get(parent)).copied();
        let is_heir = parent.is_some_and(|parent| heirs.get(parent) == Some(&Some(id)));
        known.push(match of_parent {
            Some((number, whole)) if is_heir => (number, whole),
            Some((_, whole)) => (id as u32, whole),
            None => (id as u32, piece.particles),
        });
    }
    let all = pieces.iter().zip(known);
    all.map(|(piece, (number, whole))| of_piece(number, piece.particles, whole))
        .collect()
}

/// The colour of a fragment with this number of the particles of its body. Red, green, blue.
pub fn of_piece(number: u32, particles: u32, whole: u32) -> [u8; 3] {
    if particles == 1 {
        SINGLE
    } else {
        of_fragment(number, f64::from(particles) / f64::from(whole.max(1)))
    }
}

fn pick(palette: &[[u8; 3]; 7], id: u32) -> [u8; 3] {
    // Digit sums, so that equal steps do not always give the same colour.
    let colour = palette[digit_sum(id, 7) as usize % 7];
    match ROUNDS[digit_sum(id / 7, 3) as usize % ROUNDS.len()] {
        lighter if lighter > 0.0 => mixed(colour, [255; 3], lighter),
        darker => mixed(colour, [0; 3], -darker),
    }
}

fn digit_sum(mut rest: u32, base: u32) -> u32 {
    let mut sum = 0;
    while rest > 0 {
        sum += rest % base;
        rest /= base;
    }
    sum
}

fn mixed(a: [u8; 3], b: [u8; 3], fraction: f64) -> [u8; 3] {
    [0, 1, 2]
        .map(|k| (f64::from(a[k]) * (1.0 - fraction) + f64::from(b[k]) * fraction).round() as u8)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn neighbours_differ() {
        let far = |a: [u8; 3], b: [u8; 3]| {
            let difference = (0..3).map(|k| i32::from(a[k]).abs_diff(i32::from(b[k])));
            difference.sum::<u32>()
        };
        for id in 0..1000 {
            for other in [id + 1, id + 2] {
                assert!(far(of_cluster(id), of_cluster(other)) > 30, "{id}");
                assert!(far(of_clump(id), of_clump(other)) > 15, "{id}");
            }
        }
        for step in [7, 21, 49, 100, 300, 343, 1000] {
            let mut row: Vec<_> = (0..7).map(|k| of_cluster(k * step)).collect();
            row.sort_unstable();
            row.dedup();
            assert!(row.len() >= 4, "{step}");
        }
        let _ = [of_cluster(u32::MAX), of_fragment(u32::MAX, f64::NAN)];
    }

    #[test]
    fn fragments_are_more_vivid_than_bodies() {
        let vividness = |c: [u8; 3]| c.iter().max().unwrap() - c.iter().min().unwrap();
        for id in 0..50 {
            assert!(vividness(of_fragment(id, 0.01)) > vividness(of_fragment(id, 1.0)));
        }
    }
}
