//! Spheres packed into blocks and discs, bonds cut, and spheres chosen for supports.
//!
//! Bonds join centres, so that a layer of 0.35 diameters at each face bears nothing
//! (doc/sphere-size.md): shapes are larger by that, and all dimensions are those of what bears.

use std::f64::consts::TAU;
use std::fmt::Write;

use dem_io::Body;
use dem_io::body::{read_body, write_body};
use dem_pack::cli::thread_pool;
use dem_pack::{BodySettings, BondSettings, PackSettings, make_body};

use crate::bench::{Bench, Failed};
use crate::shapes::{sizes, surface_of};

/// Layer at each face that bears nothing, over the diameter.
pub(crate) const LAYER: f64 = 0.35;
/// Height of beams, of double cantilevers and of discs, and width of all specimens, m.
pub(crate) const HEIGHT_M: f64 = 0.1;
pub(crate) const WIDTH_M: f64 = 0.05;

/// The spheres of a specimen: their mean diameter, m, and the seed of their packing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spheres {
    pub(crate) diameter_m: f64,
    pub(crate) seed: u32,
}

impl Spheres {
    /// As many across the height of the usual specimens.
    pub(crate) fn across(number: u32, seed: u32) -> Self {
        let diameter_m = HEIGHT_M / f64::from(number);
        Self { diameter_m, seed }
    }

    pub(crate) fn name(self) -> String {
        format!("{:.2}mm-{}", 1e3 * self.diameter_m, self.seed)
    }

    /// Packs a shape of these sizes that bear, m, whose outline in the x-z plane has so many
    /// corners: 4 for a block, more for a disc. Kept in the folder of a bench.
    pub(crate) fn packed(
        self,
        bench: Option<&Bench>,
        name: &str,
        size_m: [f64; 3],
        corners: u32,
    ) -> Result<Body, Failed> {
        let name = format!("{name}-{}", self.name());
        let file = bench.map(|bench| bench.folder.join(format!("{name}.vtp")));
        if let (Some(bench), Some(file)) = (bench, &file)
            && bench.has(file)
        {
            return Ok(read_body(file)?);
        }
        let size_m = size_m.map(|size_m| size_m + 2.0 * LAYER * self.diameter_m);
        let outline = prism(size_m, corners);
        let surface = surface_of(outline.as_bytes(), &format!("{name}.obj"), 1.0)?;
        let [least, most] = [0.8, 1.2].map(|part| 1e3 * part * self.diameter_m);
        let packing = PackSettings {
            overlap: 0.296,
            seed: self.seed.into(),
            ..PackSettings::new(sizes(&format!("{least}mm..{most}mm"))?)
        };
        let settings = BodySettings {
            bonds: BondSettings {
                range: 1.0,
                ..BondSettings::default()
            },
            ..BodySettings::new(packing)
        };
        let made = thread_pool(Some(1))?.install(|| make_body(&surface, &settings, &|_, _| Ok(())));
        let body = made?.0;
        if let Some(file) = file {
            write_body(&body, &file)?;
        }
        Ok(body)
    }
}

/// An OBJ file, in mm, of a block or of a disc whose axis is y, about the origin.
fn prism([x_m, y_m, z_m]: [f64; 3], corners: u32) -> String {
    let mut text = String::new();
    let turn = TAU / f64::from(corners);
    // The corners of a block are those of a square about the circle.
    let reach = if corners == 4 { 0.5_f64.sqrt() } else { 0.5 };
    for y_m in [-0.5 * y_m, 0.5 * y_m] {
        for k in 0..corners {
            let angle = turn * (f64::from(k) + 0.5);
            let [x, z] = [x_m * reach * angle.cos(), z_m * reach * angle.sin()];
            let _ = writeln!(text, "v {} {} {}", 1e3 * x, 1e3 * y_m, 1e3 * z);
        }
    }
    for k in 1..=corners {
        let next = k % corners + 1;
        let _ = writeln!(text, "f {k} {} {next}", k + corners);
        let _ = writeln!(text, "f {next} {} {}", k + corners, next + corners);
        if (2..corners).contains(&k) {
            let _ = writeln!(text, "f 1 {k} {next}");
            let [first, a, b] = [1, k, next].map(|corner| corner + corners);
            let _ = writeln!(text, "f {first} {b} {a}");
        }
    }
    text
}

/// Takes away the bonds that cross the plane through the origin across this axis at a point in the
/// notch.
pub(crate) fn cut(body: &mut Body, axis: usize, notch: impl Fn([f64; 3]) -> bool) {
    keep(body, |body, bond| {
        crossing(body, axis, bond).is_none_or(|at_m| !notch(at_m))
    });
}

/// Keeps the bonds of a body that meet a condition.
pub(crate) fn keep(body: &mut Body, meets: impl Fn(&Body, [u32; 2]) -> bool) {
    let keep: Vec<bool> = body.bonds.iter().map(|bond| meets(body, *bond)).collect();
    let mut kept = keep.iter();
    body.bonds.retain(|_| kept.next() == Some(&true));
    for of_bonds in [&mut body.bond_radii, &mut body.bond_lengths] {
        let mut kept = keep.iter();
        of_bonds.retain(|_| kept.next() == Some(&true));
    }
}

/// Where a bond crosses that plane, m.
fn crossing(body: &Body, axis: usize, bond: [u32; 2]) -> Option<[f64; 3]> {
    let [a, b] = bond.map(|end| body.positions[end as usize]);
    let part = a[axis] / (a[axis] - b[axis]);
    (a[axis] * b[axis] < 0.0).then(|| std::array::from_fn(|k| a[k] + part * (b[k] - a[k])))
}

/// Number of bonds that cross the plane.
pub(crate) fn across(body: &Body, axis: usize) -> usize {
    let bonds = body.bonds.iter();
    bonds
        .filter(|bond| crossing(body, axis, **bond).is_some())
        .count()
}

/// In each of as many strips across the width, m, as spheres fit, the sphere with the least
/// distance.
pub(crate) fn row(
    body: &Body,
    diameter_m: f64,
    width_m: f64,
    distance: impl Fn([f64; 3]) -> f64,
) -> Vec<usize> {
    let strips = (width_m / diameter_m).round().max(2.0);
    let mut nearest = vec![(f64::INFINITY, 0); strips as usize];
    for (number, place) in body.positions.iter().enumerate() {
        let strip = (place[1] / width_m + 0.5) * strips;
        let strip = strip.clamp(0.0, strips - 1.0) as usize;
        let candidate = (distance(*place), number);
        if candidate.0 < nearest[strip].0 {
            nearest[strip] = candidate;
        }
    }
    nearest.into_iter().map(|(_, number)| number).collect()
}

/// Spheres of a body in order that meet a condition.
pub(crate) fn those(body: &Body, meets: impl Fn([f64; 3]) -> bool) -> Vec<usize> {
    let all = body.positions.iter().enumerate();
    all.filter(|(_, place)| meets(**place))
        .map(|(number, _)| number)
        .collect()
}

pub(crate) fn mean_x_m(body: &Body, group: &[usize]) -> f64 {
    let sum: f64 = group.iter().map(|&number| body.positions[number][0]).sum();
    sum / group.len() as f64
}
