//! Bars between plates: `tests/fracture/pressed.toml`.

use dem_io::body::write_body;

use super::material::Material;
use super::shapes::{HEIGHT_M, LAYER, Spheres, WIDTH_M};
use crate::bench::{Bench, Failed, ONE_THREAD, body, sets};

/// Strength of a bar that is pressed along its height, Pa.
pub(crate) fn crushed_pa(
    bench: &Bench,
    material: &Material,
    spheres: Spheres,
) -> Result<f64, Failed> {
    let specimen = spheres.packed(Some(bench), "upright", [WIDTH_M, WIDTH_M, HEIGHT_M], 4)?;
    let name = format!("upright-{}", spheres.name());
    let file = bench.folder.join(format!("{name}.vtp"));
    write_body(&specimen, &file)?;
    // The plates stand off by a thousandth of a diameter.
    let plate_m = 0.5 * HEIGHT_M + (LAYER + 1e-3) * spheres.diameter_m;
    let mut options = sets(&[
        format!("bonds.rock={}", material.bonds),
        format!("walls.plate-below.plane.point=[0,0,-{plate_m}]"),
        format!("walls.plate-above.plane.point=[0,0,{plate_m}]"),
        format!("test.area={}", WIDTH_M * WIDTH_M),
    ]);
    options.extend([ONE_THREAD.to_owned(), body("specimen", &file)]);
    let name = format!("{name}-{}", material.file_name());
    let run = bench.run(&name, "tests/fracture/pressed.toml", &options)?;
    let figure = run.test()?.figure("failure force");
    Ok(figure.ok_or("the bar did not break")? / (WIDTH_M * WIDTH_M))
}
