//! The names of regions beside the edges of their boxes.

use dem_pictures::label::name_at;
use dem_pictures::{Camera, Image};

use dem_physics::geometry::Bounds;

/// Room for a name, as fractions of the width and the height of a picture.
const ROOM: [f64; 2] = [0.14, 0.05];

/// Number of places along an edge that are tried.
const PLACES: i32 = 20;

/// Writes each name above the highest place of an edge of its box in the picture where there is
/// room. A name whose box has no edge in the picture is left out.
pub(super) fn write_names<'a>(
    image: &mut Image,
    camera: &Camera,
    boxes: impl Iterator<Item = (Bounds, &'a String)>,
) {
    let size_px = [image.width(), image.height()].map(f64::from);
    let room_px = [0, 1].map(|k| ROOM[k] * size_px[k]);
    // The time stands in the upper left corner.
    let mut taken = vec![[0.0, 0.0]];
    for (bounds, name) in boxes {
        let places = places(&bounds, camera).into_iter().filter(|place| {
            let is_inside = (0..2).all(|k| (0.0..size_px[k]).contains(&place[k]));
            let is_free =
                |other: &[f64; 2]| (0..2).any(|k| (place[k] - other[k]).abs() > room_px[k]);
            is_inside && taken.iter().all(is_free)
        });
        let highest = places.min_by(|a, b| a[1].total_cmp(&b[1]));
        if let Some(place) = highest {
            name_at(image, name, [place[0], place[1] - 0.7 * room_px[1]]);
            taken.push(place);
        }
    }
}

/// Places along the edges of a box, corners included, px from the left and from the top.
fn places(bounds: &Bounds, camera: &Camera) -> Vec<[f64; 2]> {
    let corners = bounds.corners();
    let mut places = Vec::new();
    for (number, a) in corners.iter().enumerate() {
        for b in &corners[number + 1..] {
            if (0..3).filter(|&k| a[k] != b[k]).count() != 1 {
                continue;
            }
            for number in 0..=PLACES {
                let part = f64::from(number) / f64::from(PLACES);
                let at_m = [0, 1, 2].map(|k| a[k] + part * (b[k] - a[k]));
                let [x, y, _] = camera.project(at_m);
                places.push([x, y]);
            }
        }
    }
    places
}
