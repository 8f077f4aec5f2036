//! The example shapes, in mm. Plain arithmetic and fixed seeds: the same bytes on every run.

mod cake;
mod jaw;
mod mesh;
mod noise;
mod rock;
mod round;

use mesh::Mesh;
use std::path::Path;

/// Every shape with the stem of its file name.
pub(crate) fn all() -> Vec<(&'static str, Mesh)> {
    vec![
        ("ball", rock::ball([0.0, 0.0, 0.0], 10.0, 3)),
        ("bar", Mesh::cuboid([-15.0, -15.0, 0.0], [15.0, 15.0, 60.0])),
        (
            "bending-sample",
            Mesh::cuboid([0.0, 0.0, 0.0], [180.0, 30.0, 35.0]),
        ),
        ("c-shape", round::c_shape()),
        ("disc", round::disc()),
        ("dog-bone", round::dog_bone()),
        ("filter-cake", cake::filter_cake()),
        ("funnel", round::funnel()),
        ("hollow-pair", hollow_pair()),
        ("infinity-knot", round::infinity_knot()),
        ("jaw", jaw::jaw()),
        (
            "long-bending-sample",
            Mesh::cuboid([0.0, 0.0, 0.0], [200.0, 30.0, 35.0]),
        ),
        ("orifice", round::orifice()),
        ("rock", rock::rock()),
        ("stalk", round::stalk()),
        ("tablet", round::tablet()),
        ("torus", round::torus()),
        ("tube", round::tube()),
    ]
}

/// Writes every shape to `folder` as a binary STL file.
///
/// # Errors
/// The folder cannot be written to.
pub(crate) fn write_all(folder: &Path) -> std::io::Result<()> {
    for (name, mesh) in all() {
        std::fs::write(folder.join(format!("{name}.stl")), mesh.stl_bytes(name))?;
    }
    Ok(())
}

/// A ball of radius 12 mm with a spherical cavity of radius 5 mm off its centre, and a block next
/// to it.
fn hollow_pair() -> Mesh {
    let mut pair = rock::ball([0.0, 0.0, 0.0], 12.0, 4);
    let mut cavity = rock::ball([2.0, 1.0, -1.0], 5.0, 3);
    cavity.turn_inside_out();
    pair.append(&cavity);
    pair.append(&Mesh::cuboid([16.0, -9.0, -8.0], [34.0, 9.0, 8.0]));
    pair
}
