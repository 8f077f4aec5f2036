//! tests/verification/fracture.md: toughness, strength and modulus of bonded spheres over their
//! size.

mod formulas;
pub(crate) mod material;
mod pressed;
mod rock;
pub(crate) mod shapes;
pub(crate) mod specimen;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use dem_plots::{Axis, Line, Marks, Plot, Point};

use self::formulas::{SizeEffect, beam_shape, mouth_opening};
use self::material::{FLAT_JOINT, Material};
use self::rock::PAGE;
pub(crate) use self::rock::{ratios, recipe};
use self::shapes::{HEIGHT_M, Spheres};
use self::specimen::{
    Curve, DEPTH, SPAN, Specimen, beam, bent, double_cantilever, notched_disc, opened,
    opening_stiffness, pulled,
};
use crate::bench::{Bench, Failed};
use crate::cells::{change, columns, mean, over, scattered, thousands};
use crate::plots::draw;
use crate::table::{Table, write};

/// Spheres across the height of the beams, and number of packings of each.
const BEAMS: [(u32, u32); 3] = [(8, 4), (12, 3), (16, 2)];
/// The same of double cantilevers and discs with a notch.
const OTHERS: [(u32, u32); 2] = [(8, 2), (12, 1)];
/// Spheres across of the comparison of materials, and packings: the second are half as large.
const COARSE: (u32, u32) = (6, 4);
const FINE: (u32, u32) = (12, 1);
/// Heights of beams of the same spheres, m, and packings of each.
const HEIGHTS_M: [f64; 3] = [0.05, 0.1, 0.2];
const PACKINGS: u32 = 2;

fn usual() -> [Material; 2] {
    [Material::brittle(), Material::cohesive()]
}

/// Materials that are made of coarse and of fine spheres.
fn compared() -> [Material; 7] {
    let tension = "tensile_strength=5e6";
    [
        Material::of("brittle", "", tension),
        Material::of("parallel", "model=\"parallel\",", tension),
        Material::of("equivalent stress", "", "von_mises_strength=5e6"),
        Material::of(
            "Mohr-Coulomb",
            "",
            "tensile_strength=5e6,cohesion=10e6,friction_angle=0.6",
        ),
        Material::of(
            "Weibull modulus 4",
            "",
            "tensile_strength=5e6,weibull_modulus=4",
        ),
        Material::of("flat joint", FLAT_JOINT, tension),
        Material::cohesive(),
    ]
}

fn by_size(sizes: &[(u32, u32)]) -> Vec<String> {
    let rows = usual().map(|of| {
        let row = |(number, _): &(u32, u32)| format!("{}, {number}", of.name);
        sizes.iter().map(row).collect::<Vec<_>>()
    });
    rows.concat()
}

fn by_height() -> Vec<String> {
    let rows = usual().map(|of| HEIGHTS_M.map(|m| format!("{}, {:.0} mm", of.name, 1e3 * m)));
    rows.concat()
}

pub(crate) fn tables() -> Vec<Table> {
    let beams = "bonds, spheres across | packings | spheres | modulus, GPa | strength, MPa | \
        mouth opens more by, % | K_Ic, MPa sqrt(m) | over strength and sqrt(pi d) | K_Ic²/E, J/m2 | \
        work, J/m2 | damage, J/m2";
    let others = "bonds, spheres across | packings | double cantilever: stiffer by, % | \
        K_Ic, MPa sqrt(m) | K_Ic²/E, J/m2 | work, J/m2 | notched disc: K_Ic, MPa sqrt(m)";
    let sizes = "bonds, height of the beam | nominal strength, MPa | size effect | off | \
        K_Ic, MPa sqrt(m)";
    let laws = "bonds | B f_t, MPa | D_0, mm | K_Ic without end, MPa sqrt(m) | \
        its K_Ic²/E, J/m2";
    let materials = "bonds | modulus, GPa | with half the diameter | strength, MPa | \
        with half the diameter | K_Ic, MPa sqrt(m) | with half the diameter";
    let mut all = vec![
        Table::new(PAGE, "fracture beams", beams, by_size(&BEAMS)),
        Table::new(PAGE, "fracture growth", others, by_size(&OTHERS)),
        Table::new(PAGE, "fracture sizes", sizes, by_height()),
        Table::new(PAGE, "fracture sizes", laws, usual().map(|of| of.name)),
        Table::new(
            PAGE,
            "fracture materials",
            materials,
            compared().map(|of| of.name),
        ),
    ];
    all.extend(rock::tables());
    all
}

/// The table of these words, or the second of them.
fn table(words: &str, at: usize) -> Result<Table, Failed> {
    let mut own = tables().into_iter().filter(|table| table.words == words);
    Ok(own.nth(at).ok_or("no such table")?)
}

/// Beams with a notch, and bars of the same blocks.
pub(crate) fn beams(bench: &Bench) -> Result<(), Failed> {
    let mut table = table("fracture beams", 0)?;
    for material in usual() {
        for (number, packings) in BEAMS {
            let (mut rows, mut count) = (Vec::new(), 0);
            for seed in 1..=packings {
                let spheres = Spheres::across(number, seed);
                let [young_pa, strength_pa] = pulled(bench, &material, spheres)?;
                let specimen = beam(Some(bench), &material, spheres, HEIGHT_M)?;
                let curve = specimen.run(bench, &material)?;
                count = specimen.body.radii.len();
                let bent = bent(&specimen, &curve, HEIGHT_M);
                let stress_pa_n = bent.stress_pa / curve.peak_n();
                let opening_m_n = stress_pa_n * HEIGHT_M * mouth_opening(DEPTH, SPAN) / young_pa;
                rows.push([
                    1e-9 * young_pa,
                    1e-6 * strength_pa,
                    100.0 / (curve.stiffness() * opening_m_n) - 100.0,
                    1e-6 * bent.toughness,
                    bent.toughness / strength_pa / (PI * spheres.diameter_m).sqrt(),
                    bent.toughness.powi(2) / young_pa,
                    bent.work_j_m2,
                    bent.damage_j_m2,
                ]);
            }
            let first = [packings.to_string(), thousands(count as f64)];
            table.row(
                first
                    .into_iter()
                    .chain(over(&rows, [2, 2, 1, 3, 3, 1, 1, 1])),
            );
        }
    }
    write(&[table])
}

/// Cracks that grow from a notch through double cantilevers, and discs with a notch.
pub(crate) fn growth(bench: &Bench) -> Result<(), Failed> {
    let mut table = table("fracture growth", 0)?;
    for material in usual() {
        for (number, packings) in OTHERS {
            let mut rows = Vec::new();
            for seed in 1..=packings {
                let spheres = Spheres::across(number, seed);
                let [young_pa, _] = pulled(bench, &material, spheres)?;
                let specimen = double_cantilever(bench, &material, spheres)?;
                let curve = specimen.run(bench, &material)?;
                let opened = opened(&specimen, &curve).ok_or("the crack has not grown")?;
                rows.push([
                    100.0 * opened.stiffness / opening_stiffness(young_pa) - 100.0,
                    1e-6 * opened.toughness,
                    opened.toughness.powi(2) / young_pa,
                    opened.work_j_m2,
                    1e-6 * notched_disc(bench, &material, spheres)?,
                ]);
            }
            let first = [packings.to_string()];
            table.row(first.into_iter().chain(over(&rows, [1, 3, 1, 1, 3])));
        }
    }
    write(&[table])
}

/// Nominal strengths of beams of one height, Pa.
fn nominal_pa(
    bench: Option<&Bench>,
    run: &dyn Fn(&Specimen, &Material) -> Result<Curve, Failed>,
    material: &Material,
    height_m: f64,
) -> Result<Vec<f64>, Failed> {
    let of_seed = |seed| {
        let specimen = beam(bench, material, Spheres::across(8, seed), height_m)?;
        let curve = run(&specimen, material)?;
        Ok(bent(&specimen, &curve, height_m).stress_pa)
    };
    (1..=PACKINGS).map(of_seed).collect()
}

/// The cell of nominal strengths.
fn nominal(stresses_pa: &[f64]) -> String {
    let stresses_mpa: Vec<f64> = stresses_pa.iter().map(|pa| 1e-6 * pa).collect();
    scattered(&stresses_mpa, 4, "")
}

/// Beams of the same spheres and different height.
pub(crate) fn sizes(bench: &Bench) -> Result<(), Failed> {
    let mut table = [table("fracture sizes", 0)?, table("fracture sizes", 1)?];
    let shape = beam_shape(DEPTH, SPAN);
    let (mut marks, mut lines) = (Vec::new(), Vec::new());
    for material in usual() {
        let run = |specimen: &Specimen, material: &Material| specimen.run(bench, material);
        let of_height = |height_m| nominal_pa(Some(bench), &run, &material, height_m);
        let all = HEIGHTS_M.iter().map(|&height_m| of_height(height_m));
        let all: Vec<Vec<f64>> = all.collect::<Result<_, _>>()?;
        let points = HEIGHTS_M.iter().zip(&all);
        let points: Vec<[f64; 2]> = points.map(|(m, pa)| [*m, mean(pa)]).collect();
        let law = SizeEffect::of(&points).ok_or("strengths do not fall with the size")?;
        for ([height_m, stress_pa], all_pa) in points.iter().zip(&all) {
            let fitted_pa = law.strength_pa(*height_m);
            table[0].row([
                nominal(all_pa),
                format!("{:.4}", 1e-6 * fitted_pa),
                change(stress_pa / fitted_pa - 1.0, 1),
                format!("{:.3}", 1e-6 * stress_pa * height_m.sqrt() * shape),
            ]);
        }
        let [young_pa, _] = pulled(bench, &material, Spheres::across(8, 1))?;
        let toughness = law.toughness(shape);
        table[1].row([
            format!("{:.2}", 1e-6 * law.small_pa),
            format!("{:.0}", 1e3 * law.transition_m),
            format!("{:.3}", 1e-6 * toughness),
            format!("{:.1}", toughness.powi(2) / young_pa),
        ]);
        let shown = |[m, pa]: [f64; 2]| [1e3 * m, 1e-6 * pa];
        let points = points.iter().map(|point| Point {
            at: shown(*point),
            filled: true,
            ..Point::default()
        });
        marks.push(Marks {
            name: material.name.clone(),
            points: points.collect(),
            ..Marks::default()
        });
        let heights_m = (0..=40).map(|i| 0.025 * 16_f64.powf(f64::from(i) / 40.0));
        let curve = heights_m.map(|m| shown([m, law.strength_pa(m)]));
        lines.push(Line::dashed(
            format!("size effect, {}", material.name),
            curve.collect(),
        ));
    }
    let plot = Plot {
        x: Axis::log("height of the beam (mm)"),
        y: Axis::log("nominal strength (MPa)"),
        marks,
        ..Plot::of("notched beams of the same spheres", "", "", lines)
    };
    draw("tests/verification/fracture-sizes.svg", &plot)?;
    write(&table)
}

/// Materials of coarse and of fine spheres.
pub(crate) fn materials(bench: &Bench) -> Result<(), Failed> {
    let mut table = table("fracture materials", 0)?;
    for material in compared() {
        let [coarse, fine] = [COARSE, FINE].map(|(number, packings)| {
            let of_seed = |seed| {
                let spheres = Spheres::across(number, seed);
                let [young_pa, strength_pa] = pulled(bench, &material, spheres)?;
                let specimen = beam(Some(bench), &material, spheres, HEIGHT_M)?;
                let bent = bent(&specimen, &specimen.run(bench, &material)?, HEIGHT_M);
                Ok([1e-9 * young_pa, 1e-6 * strength_pa, 1e-6 * bent.toughness])
            };
            (1..=packings)
                .map(of_seed)
                .collect::<Result<Vec<_>, Failed>>()
        });
        let (coarse, fine) = (coarse?, fine?);
        let [of_coarse, of_fine] = [&coarse, &fine].map(|rows| columns(rows, mean));
        let shown = over(&coarse, [1, 2, 2]).into_iter().enumerate();
        let cells =
            shown.flat_map(|(at, cell)| [cell, change(of_fine[at] / of_coarse[at] - 1.0, 0)]);
        table.row(cells);
    }
    write(&[table])
}
