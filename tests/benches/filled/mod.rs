//! Bodies of benchmarks: shapes filled with spheres.

use std::path::Path;

use dem_io::Body;
use dem_io::surface::{ReadSettings, read_surface};
use dem_pack::{Basis, BodySettings, BondSettings, PackSettings, Sizes, make_body};

/// A shape of the repository as STL, in mm.
pub(crate) fn shape(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/shapes");
    std::fs::read(folder.join(name).with_extension("stl")).expect("the shape is in the repository")
}

/// A shape filled with spheres of these diameters. `bonds`: bonds per particle; none: bonds of
/// spheres that overlap.
pub(crate) fn packed(stl: &[u8], diameters: &str, overlap: f64, bonds: Option<f64>) -> Body {
    let reading = ReadSettings {
        unit_m: Some(1e-3),
        scale: 1.0,
        fill_holes: false,
    };
    let surface = read_surface(stl, "", reading).expect("the shape is sound");
    let sizes = Sizes::parse(diameters, Basis::Number).expect("good diameters");
    let settings = BodySettings {
        packing: PackSettings {
            overlap,
            ..PackSettings::new(sizes)
        },
        bonds: BondSettings {
            range: if bonds.is_some() || overlap > 0.0 {
                1.1
            } else {
                1.0
            },
            per_particle: bonds,
            ..BondSettings::default()
        },
        particle_density_kg_m3: None,
        solid_density_kg_m3: None,
    };
    make_body(&surface, &settings, &|_, _| Ok(()))
        .expect("packs")
        .0
}
