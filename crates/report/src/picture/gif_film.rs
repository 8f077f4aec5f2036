//! A film as an animated GIF, which browsers, office programs and mail show.

use dem_io::{Diagnostic, Result};
use dem_pictures::Image;
use gif::{Encoder, Frame, Repeat};

/// Duration of a film, hundredths of a second, and the range of that of a picture.
const FILM: usize = 800;
const PICTURE: [usize; 2] = [4, 40];
/// Thoroughness of the choice of 256 colours, from 1 (best) to 30 (fastest).
const SPEED: i32 = 10;

/// The bytes of a film of `count` pictures of this size, at most 65535 px a side, made one after
/// the other.
pub(super) fn film(
    size_px: [u32; 2],
    count: usize,
    picture: &dyn Fn(usize) -> Result<Image>,
) -> Result<Vec<u8>> {
    let side = |px: u32| {
        u16::try_from(px).map_err(|_| {
            let problem = format!("{px} is beyond the 65535 of a GIF");
            Diagnostic::input("--size", problem, "make it smaller")
        })
    };
    let [width, height] = [side(size_px[0])?, side(size_px[1])?];
    let fault = |error: gif::EncodingError| Diagnostic::failed("film", error.to_string(), "");
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height, &[]).map_err(fault)?;
    encoder.set_repeat(Repeat::Infinite).map_err(fault)?;
    let [least, most] = PICTURE;
    let delay = (FILM / count.max(1)).clamp(least, most) as u16;
    for number in 0..count {
        let image = picture(number)?;
        let mut frame = Frame::from_rgb_speed(width, height, image.rgb(), SPEED);
        frame.delay = delay;
        encoder.write_frame(&frame).map_err(fault)?;
    }
    drop(encoder);
    Ok(bytes)
}
