//! Fills the tablet of `data/shapes` with bonded spheres and writes the body:
//!
//! ```text
//! cargo run --release -p dem-pack --example pack_a_shape -- tablet.vtp
//! ```

use dem_io::body::write_body;
use dem_io::surface::{ReadSettings, read_surface};
use dem_pack::{Basis, BodySettings, PackSettings, Sizes, make_body};
use std::io::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let output = std::env::args().nth(1).ok_or("name the body to write")?;

    // The shape: an STL file in millimetres.
    let shapes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/shapes");
    let stl = std::fs::read(shapes.join("tablet.stl"))?;
    let reading = ReadSettings {
        unit_m: Some(1e-3),
        scale: 1.0,
        fill_holes: false,
    };
    let surface = read_surface(&stl, "tablet.stl", reading)?;

    // The spheres and their bonds.
    let sizes = Sizes::parse("0.6mm..0.9mm", Basis::Number)?;
    let settings = BodySettings::new(PackSettings::new(sizes));
    let (body, report) = make_body(&surface, &settings, &|_stage, _done| Ok(()))?;

    std::io::stdout().write_all(report.quality.text().as_bytes())?;
    write_body(&body, Path::new(&output))?;
    Ok(())
}
