//! doc/pressing.md: the bar of `data/shapes/bar.stl` filled by the front of dem-pack, and by
//! filling a mould and pressing.

use dem_io::Body;
use dem_io::body::mass::volume_m3;
use dem_io::body::read_particles;
use dem_laboratory::Statistic;
use dem_pack::{
    BodySettings, BondSettings, Fabric, PackSettings, Spheres, bond_fabric, bond_spheres, make_body,
};
use dem_plots::{Line, Plot};
use dem_results::folder::{frame_in, frames_in};

use crate::bench::{Bench, Failed, ONE_THREAD};
use crate::cells::ends;
use crate::plots::draw;
use crate::shapes::{shape, sizes};
use crate::table::{Table, write};

/// The bar: 30 mm x 30 mm around the z axis, 60 mm high.
const HALF_WIDTH_M: f64 = 15e-3;
const HEIGHT_M: f64 = 60e-3;
const LAYERS: usize = 5;
const PARTICLE_DENSITY_KG_M3: f64 = 2050.0;
const SOLID_DENSITY_KG_M3: f64 = 1650.0;
/// Spheres as in data/scenes/press-mould.toml, and twice as large.
const COARSER: [f64; 2] = [2.0, 1.0];
/// Spheres that are fed if they are twice as large: those of the scene over 8.
const COARSE_COUNT: usize = 237;
/// Radii of the scene, mm, by the name of the body.
const RADII_MM: [(&str, f64); 5] = [
    ("a", 1.5),
    ("b", 1.625),
    ("c", 1.75),
    ("d", 1.875),
    ("e", 2.0),
];

/// A body, and what it took to make it.
struct Made {
    body: Body,
    /// Processor time, s.
    processor_s: f64,
    /// Height of the body, m.
    height_m: f64,
}

pub(crate) fn tables() -> [Table; 1] {
    let head = "way | spheres | processor time | slower | density, lowest to highest fifth | \
        stands out of the wall: mean, largest | \
        overlap of neighbours: mean, scatter, largest | bonds per particle | fabric inside";
    let ways = COARSER.iter().flat_map(|_| [FRONT, PRESSED]);
    [Table::new("doc/pressing.md", "pressing", head, ways)]
}

const FRONT: &str = "front";
const PRESSED: &str = "filled and pressed";

pub(crate) fn pressing(bench: &Bench) -> Result<(), Failed> {
    let [mut table] = tables();
    let mut lines = Vec::new();
    for coarser in COARSER {
        let pressed = pressed(bench, coarser)?;
        let front = front(coarser)?;
        for made in [&front, &pressed] {
            table.row(row(made, front.processor_s));
        }
        if coarser == 1.0 {
            lines.extend([
                Line::new(FRONT, profile(&front)),
                Line::new(PRESSED, profile(&pressed)),
            ]);
        }
    }
    let [title, x] = ["Solid density over the height", "height (mm)"];
    let plot = Plot::of(title, x, "solid density (kg/m3)", lines);
    draw("doc/pressing-density.svg", &plot)?;
    write(&[table])
}

/// The bar by the front of dem-pack, with the overlap that gives the density, on one thread.
fn front(coarser: f64) -> Result<Made, Failed> {
    let diameters = format!("{}mm..{}mm", 3.0 * coarser, 4.0 * coarser);
    let surface = shape("bar", 1.0)?;
    let settings = BodySettings {
        bonds: touching(),
        particle_density_kg_m3: Some(PARTICLE_DENSITY_KG_M3),
        solid_density_kg_m3: Some(SOLID_DENSITY_KG_M3),
        ..BodySettings::new(PackSettings::new(sizes(&diameters)?))
    };
    let began_s = processor_time_s();
    let made = dem_pack::cli::thread_pool(Some(1))?
        .install(|| make_body(&surface, &settings, &|_, _| Ok(())))?;
    Ok(Made {
        processor_s: processor_time_s() - began_s,
        height_m: HEIGHT_M,
        body: made.0,
    })
}

/// The bar by the scene that fills and presses, on one thread.
fn pressed(bench: &Bench, coarser: f64) -> Result<Made, Failed> {
    let mut options = vec![ONE_THREAD.to_owned()];
    if coarser != 1.0 {
        options.extend(RADII_MM.map(|(name, radius_mm)| {
            let radius_mm = coarser * radius_mm;
            format!("--set=bodies.{name}.particles=[[0,0,0,\"{radius_mm} mm\"]]")
        }));
        options.push(format!("--set=inlets.fill.count={COARSE_COUNT}"));
        options.push("--set=inlets.fill.rate=\"800 /s\"".to_owned());
    }
    let scene = "data/scenes/press-mould.toml";
    let run = bench.run(&coarser.to_string(), scene, &options)?;
    if run.summary.ended_by != "measure" {
        return Err("the density was not met".into());
    }
    let last = *frames_in(&run.folder)?.last().ok_or("no frame")?;
    let began_s = processor_time_s();
    let spheres = read_particles(&frame_in(&run.folder, last))?.loose_spheres()?;
    let (body, _) = bond_spheres(&spheres, &touching())?;
    Ok(Made {
        processor_s: run.processor_s() + processor_time_s() - began_s,
        height_m: 130e-3 + run.measured("plunger")?,
        body,
    })
}

/// Processor time of this program, s.
#[cfg(unix)]
fn processor_time_s() -> f64 {
    let spent = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    spent.tv_sec as f64 + 1e-9 * spent.tv_nsec as f64
}

/// Not known.
#[cfg(not(unix))]
fn processor_time_s() -> f64 {
    f64::NAN
}

/// Bonds between spheres that overlap.
fn touching() -> BondSettings {
    BondSettings {
        range: 1.0,
        ..BondSettings::default()
    }
}

fn row(made: &Made, front_s: f64) -> [String; 8] {
    let densities = densities_kg_m3(made, LAYERS).map(|density| format!("{density:.0}"));
    let densities: Vec<String> = densities.collect();
    let (out, overlaps) = (outside(made), overlaps(&made.body));
    let [[_, most_out], [_, most_overlap]] = [&out, &overlaps].map(|values| ends(values));
    let [out, overlap] = [out, overlaps].map(|values| Statistic::of(&values));
    let per_particle = made.body.bonds.len() as f64 / made.body.radii.len() as f64;
    [
        made.body.radii.len().to_string(),
        format!("{:.1} s", made.processor_s),
        format!("{:.0}", made.processor_s / front_s),
        format!("{} kg/m3", densities.join(", ")),
        format!("{:.3}, {most_out:.3} of a radius", out.mean),
        format!(
            "{:.3}, {:.3}, {most_overlap:.3} of a radius",
            overlap.mean, overlap.standard_deviation
        ),
        format!("{per_particle:.2}"),
        fabric_text(made),
    ]
}

/// Density of each layer of the bar from below: mass of the parts of the spheres between its two
/// planes over its volume, kg/m3. What stands out of the walls counts; what stands out below or
/// above counts to the lowest or the highest layer.
fn densities_kg_m3(made: &Made, layers: usize) -> impl Iterator<Item = f64> + '_ {
    let layer_m = made.height_m / layers as f64;
    let layer_m3 = 4.0 * HALF_WIDTH_M * HALF_WIDTH_M * layer_m;
    (0..layers).map(move |layer| {
        let plane_m = |number: usize| match number {
            0 => f64::NEG_INFINITY,
            _ if number == layers => f64::INFINITY,
            _ => number as f64 * layer_m,
        };
        let [low_m, high_m] = [layer, layer + 1].map(plane_m);
        let spheres = made.body.positions.iter().zip(&made.body.radii);
        let volumes = spheres.map(|(place, radius)| {
            below_m3(*radius, high_m - place[2]) - below_m3(*radius, low_m - place[2])
        });
        PARTICLE_DENSITY_KG_M3 * volumes.sum::<f64>() / layer_m3
    })
}

/// Volume of the part of a sphere below a plane at this height above its centre, m3.
fn below_m3(radius_m: f64, height_m: f64) -> f64 {
    let rise_m = height_m.clamp(-radius_m, radius_m) + radius_m;
    let cap_m3 = std::f64::consts::PI * rise_m * rise_m * (radius_m - rise_m / 3.0);
    cap_m3.min(volume_m3(radius_m))
}

/// How far the spheres that reach a wall, floor or top stand out of it, in radii.
fn outside(made: &Made) -> Vec<f64> {
    let spheres = made.body.positions.iter().zip(&made.body.radii);
    let out = spheres.map(|([x, y, z], r)| (r - depth_m(made, [*x, *y, *z])) / r);
    // Spheres of a packing that touch the wall stay a little apart from it.
    out.filter(|out| *out > -0.02)
        .map(|out| out.max(0.0))
        .collect()
}

/// Distance of a point to the nearest face of the bar, m.
fn depth_m(made: &Made, [x, y, z]: [f64; 3]) -> f64 {
    let aside = HALF_WIDTH_M - x.abs().max(y.abs());
    aside.min(z).min(made.height_m - z)
}

/// Overlaps of bonded spheres, in radii of the smaller one.
fn overlaps(body: &Body) -> Vec<f64> {
    let bonds = body.bonds.iter().zip(&body.bond_lengths);
    bonds
        .map(|(&[a, b], length_m)| {
            let [a, b] = [a, b].map(|i| body.radii[i as usize]);
            (a + b - length_m) / a.min(b)
        })
        .collect()
}

/// The fabric of the bonds deeper than a largest diameter.
fn fabric_text(made: &Made) -> String {
    let body = &made.body;
    let spheres = Spheres {
        positions: body.positions.clone(),
        radii: body.radii.clone(),
    };
    let largest_m = body.radii.iter().copied().fold(0.0, f64::max);
    let is_inside = |i: u32| depth_m(made, body.positions[i as usize]) > 2.0 * largest_m;
    match bond_fabric(&spheres, &body.bonds, is_inside) {
        Some(Fabric {
            eigenvalues: [a, b, c],
            chance,
            ..
        }) => format!("{a:.3} {b:.3} {c:.3}, p = {chance:.2}"),
        None => "-".to_owned(),
    }
}

/// The density over the height, mm, in ten layers.
fn profile(made: &Made) -> Vec<[f64; 2]> {
    let layers = 2 * LAYERS;
    let middle_mm = |layer: usize| 1e3 * made.height_m * (layer as f64 + 0.5) / layers as f64;
    let densities = densities_kg_m3(made, layers).enumerate();
    densities
        .map(|(layer, density)| [middle_mm(layer), density])
        .collect()
}
