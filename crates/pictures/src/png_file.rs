//! Pictures as PNG files.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use dem_io::{Diagnostic, Result};
pub use png::Compression;
use png::{BitDepth, ColorType, Decoder, Encoder, EncodingError, Filter};

use super::image::Image;

/// A picture, which must have pixels, as the bytes of a PNG file, RGB.
pub fn to_png(image: &Image, compression: Compression) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let written = encoder(&mut bytes, image, compression)
        .write_header()
        .and_then(|mut writer| {
            writer.write_image_data(image.rgb())?;
            writer.finish()
        });
    written.map_err(|error| fault(&error))?;
    Ok(bytes)
}

/// The picture in a file whose bytes were made by [`to_png`]; refuses others (exit code 1).
pub fn read_png(path: &Path) -> Result<Image> {
    let refuse = |problem: String| {
        Diagnostic::failed(
            path.display().to_string(),
            format!("this picture of the run cannot be read: {problem}"),
            "start the run again, without --resume",
        )
    };
    let file = File::open(path).map_err(|error| refuse(error.to_string()))?;
    let mut reader = Decoder::new(BufReader::new(file))
        .read_info()
        .map_err(|error| refuse(error.to_string()))?;
    let size = reader.output_buffer_size().unwrap_or_default();
    let mut pixels = vec![0; size];
    let info = reader
        .next_frame(&mut pixels)
        .map_err(|error| refuse(error.to_string()))?;
    let is_ours = info.color_type == ColorType::Rgb && info.bit_depth == BitDepth::Eight;
    is_ours
        .then(|| Image::of_rgb(info.width, info.height, pixels))
        .flatten()
        .ok_or_else(|| refuse("it is not of this program".to_owned()))
}

/// Encoder for pictures of this size, RGB.
fn encoder<'a>(
    bytes: &'a mut Vec<u8>,
    image: &Image,
    compression: Compression,
) -> Encoder<'a, &'a mut Vec<u8>> {
    let mut encoder = Encoder::new(bytes, image.width(), image.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_filter(Filter::Adaptive);
    encoder
}

/// The error for a failed conversion of a picture to bytes.
pub(super) fn fault(error: &EncodingError) -> Diagnostic {
    Diagnostic::failed(
        "picture",
        error.to_string(),
        "this is a fault of the program",
    )
}
