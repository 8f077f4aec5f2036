//! A fragment of a frame as a body that says where it comes from.

use std::path::Path;

use dem_io::body::StoredFrame;
use dem_io::{Body, Result};

/// The fragment `id` of a frame, whose file is `path`.
pub(super) fn fragment_body(frame: &StoredFrame, path: &Path, id: u32) -> Result<Body> {
    let mut body = frame.body(id)?;
    name_fragment(&mut body, path, id);
    Ok(body)
}

/// Says in a body that it is the fragment `id` of the frame in this file.
pub(super) fn name_fragment(body: &mut Body, path: &Path, id: u32) {
    name_origin(body, path, &format!("fragment {id}"));
}

/// Says in a body that this program took it from the frame in this file, and which part of it.
pub(super) fn name_origin(body: &mut Body, path: &Path, part: &str) {
    body.about.program = Some(concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned());
    body.about.source = Some(format!("{}: {part}", path.display()));
}
