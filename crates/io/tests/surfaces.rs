//! The results for every kind of STL file, good or bad.

#[path = "fuzz_bodies/read_stl.rs"]
mod body;
mod crossings;
mod files;
mod formats;
mod gaps;
mod properties;
mod shells;
mod solids;
mod three_mf;
mod written;

use body::assert_solid;
use dem_io::surface::{ReadSettings, read_surface};
use dem_io::{Diagnostic, Surface};
use proptest::sample::Index;

const METRES: ReadSettings = ReadSettings {
    unit_m: Some(1.0),
    scale: 1.0,
    fill_holes: false,
};
const FILL: ReadSettings = ReadSettings {
    fill_holes: true,
    ..METRES
};

fn shape_bytes(name: &str) -> Vec<u8> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/shapes");
    std::fs::read(folder.join(format!("{name}.stl"))).expect(name)
}

fn read(bytes: &[u8], settings: ReadSettings) -> Surface {
    let surface =
        read_surface(bytes, "part.stl", settings).unwrap_or_else(|error| panic!("{error}"));
    assert_solid(&surface);
    surface
}

/// Bytes with others at some places, cut off and with an end repeated.
fn damaged(
    mut bytes: Vec<u8>,
    damage: Vec<(Index, u8)>,
    keep: Option<Index>,
    repeat: Option<Index>,
) -> Vec<u8> {
    for (place, value) in damage {
        let place = place.index(bytes.len());
        bytes[place] = value;
    }
    if let Some(keep) = keep {
        bytes.truncate(keep.index(bytes.len()));
    }
    if let (Some(repeat), true) = (repeat, !bytes.is_empty()) {
        let from = repeat.index(bytes.len());
        bytes.extend_from_within(from..);
    }
    bytes
}

fn shape(name: &str) -> Surface {
    read(&shape_bytes(name), METRES)
}

fn refusal(bytes: &[u8], settings: ReadSettings) -> Diagnostic {
    let error = read_surface(bytes, "part.stl", settings).expect_err("a refusal");
    assert_eq!(error.exit_code(), 2);
    assert!(
        error.place.starts_with("part.stl") && !error.remedy.is_empty(),
        "{error}"
    );
    error
}

#[track_caller]
fn assert_volume(surface: &Surface, expected: f64) {
    let volume = surface.volume_m3();
    assert!(
        (volume / expected - 1.0).abs() < 1e-6,
        "{volume}, not {expected}"
    );
}

/// The same vertices, triangles and shells, to the last bit.
#[track_caller]
fn assert_same_solid(a: &Surface, b: &Surface) {
    let bits = |s: &Surface| {
        s.vertices
            .iter()
            .flatten()
            .map(|x| x.to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(a), bits(b));
    assert_eq!(a.triangles, b.triangles);
    assert_eq!(a.shells, b.shells);
    assert_eq!(a.unit_m, b.unit_m);
}
