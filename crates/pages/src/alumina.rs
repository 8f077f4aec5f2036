//! The bars and discs of porous alumina of tests/verification/quasi-static-breakage.md.

#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use crate::bench::{Bench, Failed};
use crate::cells::{columns, mean, median, over, scattered, thousands, three_digits};
use crate::concrete::PAGE;
use crate::fracture::material::Material;
use crate::fracture::shapes::{Spheres, across, keep, row};
use crate::fracture::specimen::{CORNERS, Curve, Specimen, pulled_block, squeezed};
use crate::table::{Table, write};

const WORDS: &str = "alumina";
/// Diameter of the spheres, m: eight across a bar.
const DIAMETER_M: f64 = 0.605e-3;
const PACKINGS: u32 = 2;
/// Bonds over the alumina at first: modulus, strength of bars and of discs.
const GUESS: [f64; 3] = [0.55, 0.6, 1.0];

/// Side of the section of the bars, length of the part of them that is computed, span, m.
const SIDE_M: f64 = 4.84e-3;
const LENGTH_M: f64 = 24e-3;
const SPAN_M: f64 = 20e-3;
/// Alumina of the bars: modulus in bending, strength, Pa, density, kg/m3 (Farsi et al. 2017, and
/// Farsi et al. 2015).
const BAR: [f64; 3] = [72.22e9, 78e6, 2580.0];
/// Alumina of the discs of set 1, the same (Farsi et al. 2016).
const DISC: [f64; 3] = [40.05e9, 5.07e6, 2321.0];
/// Thickness of the slice of a disc that is computed, m.
const SLICE_M: f64 = 3e-3;
/// Diameter and thickness of the solid disc and of that with four holes, diameter of these, m.
const SOLID_M: [f64; 2] = [18.56e-3, 19.16e-3];
const HOLED_M: [f64; 2] = [18.39e-3, 12.54e-3];
const HOLE_M: f64 = 5.14e-3;
/// Half the width of the strip about the load line over the diameter of a disc.
const STRIP: f64 = 0.1;
/// Bonds whose middle place is that of the first break.
const FIRST: usize = 10;

/// A row of bars.
#[derive(Debug, Clone, Copy)]
struct Case {
    name: &'static str,
    packings: u32,
    diameter_m: f64,
    /// Times of the usual pace.
    slower: f64,
}

const fn case(name: &'static str, packings: u32) -> Case {
    Case {
        name,
        packings,
        diameter_m: DIAMETER_M,
        slower: 1.0,
    }
}

const BARS: Case = case("bonds found on them", PACKINGS);
const SLOW_BAR: Case = Case {
    slower: 2.0,
    ..case("the same at half the speed, packing 1", 1)
};
const COARSE_BAR: Case = Case {
    diameter_m: 2.0 * DIAMETER_M,
    ..case("the same, spheres twice as large", 1)
};

const SOLID: Case = case("solid, bonds found on it", PACKINGS);
const SCALED: Case = case(
    "solid, bonds of the bars times modulus and strength of both, packing 1",
    1,
);
const BAR_BONDS: Case = case("solid, bonds of the bars, packing 1", 1);
const STRONG: Case = case("four holes, load between them", PACKINGS);
const WEAK: Case = case("four holes, load through two", PACKINGS);

pub(crate) fn tables() -> [Table; 4] {
    let bonds = "bonds | of the alumina | of the bonds | bonds over alumina";
    let bond_rows = ["bars", "discs"].map(|of| {
        [
            format!("{of}: modulus, GPa"),
            format!("{of}: tensile strength, MPa"),
        ]
    });
    let bars = "bars | packings | spheres | force at failure, N | deflection at failure, um | \
        modulus in bending, GPa | modulus in tension, packing 1, GPa";
    let bar_rows = [BARS, SLOW_BAR, COARSE_BAR].map(|case| case.name);
    let discs = "discs of set 1 | packings | spheres | largest load, kN | \
        distance of the first breaks from the middle, of the radius | \
        broken bonds near the load line, % | largest piece, % of the mass";
    let disc_rows = [SOLID, SCALED, BAR_BONDS, STRONG, WEAK].map(|case| case.name);
    let ratio = "load between the holes over load through two | strong over weak";
    let from = |first: &'static str, rows: &[&'static str]| [&[first], rows].concat();
    [
        Table::new(PAGE, WORDS, bonds, bond_rows.concat()),
        Table::new(PAGE, WORDS, bars, from("measured", &bar_rows)),
        Table::new(PAGE, WORDS, discs, from("solid, measured", &disc_rows)),
        Table::new(
            PAGE,
            WORDS,
            ratio,
            ["here", "simulated by Farsi et al. 2016"],
        ),
    ]
}

/// Force at failure of a bar of this strength, N.
fn bar_n(strength_pa: f64) -> f64 {
    2.0 * strength_pa * SIDE_M.powi(3) / (3.0 * SPAN_M)
}

/// Load that splits a disc of this strength, diameter and thickness, N.
fn disc_n(strength_pa: f64, [diameter_m, thickness_m]: [f64; 2]) -> f64 {
    0.5 * PI * strength_pa * diameter_m * thickness_m
}

/// Brittle bonds of this modulus and strength, Pa, of an alumina.
fn material([bond_pa, strength_pa]: [f64; 2], [young_pa, _, density]: [f64; 3]) -> Material {
    Material::tensile([bond_pa, 0.0, strength_pa], young_pa, density)
}

fn spheres(case: &Case, seed: u32) -> Spheres {
    let diameter_m = case.diameter_m;
    Spheres { diameter_m, seed }
}

/// A bar that a row of spheres bends over two rows; its gauges have the deflection below the load.
fn bar(
    bench: Option<&Bench>,
    case: &Case,
    material: &Material,
    seed: u32,
) -> Result<Specimen, Failed> {
    let spheres = spheres(case, seed);
    let body = spheres.packed(bench, "bar", [LENGTH_M, SIDE_M, SIDE_M], 4)?;
    let pins = |x_m: f64, up: f64| {
        row(&body, spheres.diameter_m, SIDE_M, |[x, _, z]| {
            (x - x_m).abs() - up * z
        })
    };
    let held = [-0.5, 0.5].map(|part| pins(part * SPAN_M, -1.0)).concat();
    let [load, below] = [1.0, -1.0].map(|up| pins(0.0, up));
    let pace_s = SPAN_M.powi(2) / (SIDE_M * material.speed_m_s());
    let of_beam_m = bar_n(BAR[1]) * SPAN_M.powi(3) / (4.0 * BAR[0] * SIDE_M.powi(4));
    Ok(Specimen {
        name: format!("bar-{}-{}", spheres.name(), case.slower),
        most_broken: across(&body, 0) / 2,
        groups: [held.clone(), load.clone(), load, below, held],
        body,
        axis: 2,
        gauge_axis: 2,
        travel_m: -1.4 * of_beam_m * material.strength_pa / material.young_pa * BAR[0]
            / (GUESS[1] * BAR[1]),
        time_s: 10.0 * case.slower * pace_s,
        start: 1.0,
        strokes: 2.5,
        span_m: SPAN_M,
    })
}

/// What a bar measures: force, N, and deflection, um, at failure, and modulus in bending, GPa.
fn of_bar(curve: &Curve) -> [f64; 3] {
    let (at, force_n) = curve.peak();
    let young_pa = curve.stiffness() * SPAN_M.powi(3) / (4.0 * SIDE_M.powi(4));
    [force_n, 1e6 * curve.rows[at][2], 1e-9 * young_pa]
}

/// Runs a specimen.
type Running<'a> = dyn Fn(&Specimen, &Material) -> Result<Curve, Failed> + 'a;

/// The bars of a case, and how many spheres they have.
fn bent(
    bench: Option<&Bench>,
    run: &Running,
    case: &Case,
    material: &Material,
) -> Result<(Vec<[f64; 3]>, usize), Failed> {
    let (mut rows, mut count) = (Vec::new(), 0);
    for seed in 1..=case.packings {
        let bar = bar(bench, case, material, seed)?;
        count = bar.body.radii.len();
        rows.push(of_bar(&run(&bar, material)?));
    }
    Ok((rows, count))
}

/// The cells of bars up to the modulus in bending.
fn bar_cells((rows, count): &(Vec<[f64; 3]>, usize)) -> Vec<String> {
    let mut cells = vec![rows.len().to_string(), thousands(*count as f64)];
    cells.extend(over(rows, [1, 2, 2]));
    cells
}

/// Distance of the centres of the holes from the middle, m: all walls, between holes and outside of
/// them, are as thick.
fn hole_circle_m() -> f64 {
    (0.5 * HOLED_M[0] + 0.5 * HOLE_M) / (1.0 + 2_f64.sqrt())
}

/// A slice of a disc between pads; with holes, the first at this angle from the load, rad.
fn disc(
    bench: &Bench,
    case: &Case,
    material: &Material,
    seed: u32,
    first: Option<f64>,
) -> Result<Specimen, Failed> {
    let spheres = spheres(case, seed);
    let (name, [diameter_m, _]) = match first {
        Some(_) => ("holed", HOLED_M),
        None => ("solid", SOLID_M),
    };
    let size_m = [diameter_m, SLICE_M, diameter_m];
    let mut body = spheres.packed(Some(bench), name, size_m, CORNERS)?;
    let mut turned = 0.0;
    if let Some(first) = first {
        turned = first;
        let in_hole = |[x_m, _, z_m]: [f64; 3]| {
            (0..4).any(|hole| {
                let (sin, cos) = (first + 0.5 * PI * f64::from(hole)).sin_cos();
                let circle_m = hole_circle_m();
                (x_m - circle_m * sin).hypot(z_m - circle_m * cos) < 0.5 * HOLE_M
            })
        };
        keep(&mut body, |body, bond| {
            !bond
                .map(|end| body.positions[end as usize])
                .into_iter()
                .any(in_hole)
        });
    }
    let crossing = across(&body, 0);
    let squeezed = squeezed(body, material, spheres, size_m);
    Ok(Specimen {
        name: format!("{name}-{turned:.2}-{}-{}", spheres.name(), case.slower),
        most_broken: 5 * crossing / 2,
        time_s: case.slower * squeezed.time_s,
        start: 0.5,
        ..squeezed
    })
}

/// What a disc measures: its largest load, kN; the median distance of the first breaks from its
/// middle over the radius; the parts of broken bonds near the load line and of the mass in the
/// largest piece, %.
fn crushed(
    bench: &Bench,
    case: &Case,
    material: &Material,
    seed: u32,
    first: Option<f64>,
) -> Result<([f64; 4], usize), Failed> {
    let [diameter_m, thickness_m] = if first.is_some() { HOLED_M } else { SOLID_M };
    let specimen = disc(bench, case, material, seed, first)?;
    let run = specimen.results(bench, material)?;
    let load_n = specimen.curve(&run)?.peak_n() * thickness_m / SLICE_M;
    let events = run.words("events.csv", ["event", "x_m", "z_m"])?;
    let broken = events.iter().filter(|[event, ..]| event == "bond_broken");
    let place = |[_, x_m, z_m]: &[String; 3]| Ok([x_m.parse()?, z_m.parse()?]);
    let broken: Vec<[f64; 2]> = broken.map(place).collect::<Result<_, Failed>>()?;
    let distances = broken.iter().take(FIRST).map(|[x_m, z_m]| x_m.hypot(*z_m));
    let first_m = median(distances);
    let near = broken
        .iter()
        .filter(|[x_m, _]| x_m.abs() < STRIP * diameter_m);
    let near = near.count() as f64 / broken.len() as f64;
    Ok((
        [
            1e-3 * load_n,
            first_m / (0.5 * diameter_m),
            100.0 * near,
            100.0 * run.fragments().mass_fraction_of_largest,
        ],
        specimen.body.radii.len(),
    ))
}

/// The discs of a case.
fn all_crushed(
    bench: &Bench,
    case: &Case,
    material: &Material,
    first: Option<f64>,
) -> Result<(Vec<[f64; 4]>, usize), Failed> {
    let all = (1..=case.packings).map(|seed| crushed(bench, case, material, seed, first));
    let (rows, counts): (Vec<_>, Vec<_>) = all.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    Ok((rows, counts[0]))
}

fn disc_cells((rows, count): &(Vec<[f64; 4]>, usize)) -> Vec<String> {
    let mut cells = vec![rows.len().to_string(), thousands(*count as f64)];
    cells.extend(over(rows, [2, 2, 0, 0]));
    cells
}

/// Bonds of bars and of discs: loads of brittle bodies are in proportion to the strength of their
/// bonds, moduli to that of these, so that one round finds them.
fn found(bench: &Bench, run: &Running) -> Result<[[f64; 2]; 2], Failed> {
    let first = [GUESS[0] * BAR[0], GUESS[1] * BAR[1]];
    let (rows, _) = bent(Some(bench), run, &BARS, &material(first, BAR))?;
    let [force_n, _, young_gpa] = columns(&rows, mean);
    let bar = [
        first[0] * 1e-9 * BAR[0] / young_gpa,
        first[1] * bar_n(BAR[1]) / force_n,
    ];
    let first = [bar[0] * DISC[0] / BAR[0], GUESS[2] * DISC[1]];
    let (rows, _) = all_crushed(bench, &SOLID, &material(first, DISC), None)?;
    let [load_kn, ..] = columns(&rows, mean);
    let disc = [
        first[0],
        first[1] * 1e-3 * disc_n(DISC[1], SOLID_M) / load_kn,
    ];
    Ok([bar, disc].map(|bonds| bonds.map(three_digits)))
}

fn bond_table(table: &mut Table, [bar, disc]: [[f64; 2]; 2]) {
    for (alumina, bonds) in [(BAR, bar), (DISC, disc)] {
        for (at, unit) in [1e-9, 1e-6].into_iter().enumerate() {
            table.row([
                format!("{:.2}", unit * alumina[at]),
                format!("{:.2}", unit * bonds[at]),
                format!("{:.3}", bonds[at] / alumina[at]),
            ]);
        }
    }
}

/// Bars and discs beside what was measured.
pub(crate) fn alumina(bench: &Bench) -> Result<(), Failed> {
    let [mut of_bonds, mut of_bars, mut of_discs, mut of_ratio] = tables();
    let run = |specimen: &Specimen, material: &Material| specimen.run(bench, material);
    let bonds = found(bench, &run)?;
    bond_table(&mut of_bonds, bonds);
    let [of_bar, of_disc] = bonds;
    let [bar, disc] = [material(of_bar, BAR), material(of_disc, DISC)];

    let none = String::new;
    let force = format!("{:.0}", bar_n(BAR[1]));
    let measured = [none(), none(), force];
    of_bars.row(
        measured
            .into_iter()
            .chain(["15 to 20", "72.22 +- 2.75", "65.45 +- 0.83, ultrasonic"].map(str::to_owned)),
    );
    for case in [BARS, SLOW_BAR, COARSE_BAR] {
        let mut cells = bar_cells(&bent(Some(bench), &run, &case, &bar)?);
        cells.push(if case.name == BARS.name {
            let size_m = [LENGTH_M, SIDE_M, SIDE_M];
            let spheres = spheres(&case, 1);
            let body = spheres.packed(Some(bench), "bar", size_m, 4)?;
            let [young_pa, _] = pulled_block(bench, &bar, spheres, body, size_m)?;
            format!("{:.2}", 1e-9 * young_pa)
        } else {
            none()
        });
        of_bars.row(cells);
    }

    let mut cells = vec![none(); 6];
    cells[2] = format!("{:.2}", 1e-3 * disc_n(DISC[1], SOLID_M));
    of_discs.row(cells);
    let scaled = [0, 1].map(|at| of_bar[at] * DISC[at] / BAR[at]);
    let scaled = material(scaled, DISC);
    for (case, bonds) in [(SOLID, &disc), (SCALED, &scaled), (BAR_BONDS, &bar)] {
        of_discs.row(disc_cells(&all_crushed(bench, &case, bonds, None)?));
    }
    let [strong, weak] = [(STRONG, 0.25 * PI), (WEAK, 0.0)]
        .map(|(case, first)| all_crushed(bench, &case, &disc, Some(first)));
    let (strong, weak) = (strong?, weak?);
    of_discs.row(disc_cells(&strong));
    of_discs.row(disc_cells(&weak));
    let both = strong.0.iter().zip(&weak.0);
    let ratios: Vec<f64> = both.map(|(strong, weak)| strong[0] / weak[0]).collect();
    of_ratio.row([scattered(&ratios, 2, "")]);
    of_ratio.row(["almost 5".to_owned()]);
    write(&[of_bonds, of_bars, of_discs, of_ratio])
}
