//! Strengths in compression and in tension of a rock by its bonds, and the bonds of a rock that is
//! given by its modulus, toughness and strengths.

use super::material::{DENSITY_KG_M3, FLAT_JOINT, Material};
use super::pressed::crushed_pa;
use super::shapes::{HEIGHT_M, Spheres};
use super::specimen::{beam, bent, pulled, split_pa};
use crate::bench::{Bench, Failed};
use crate::cells::{change, columns, mean, over};
use crate::table::{Table, write};

pub(super) const PAGE: &str = "tests/verification/fracture.md";
/// Spheres across, and packings.
const ACROSS: (u32, u32) = (8, 2);
/// The rock of the recipe: modulus, Pa, toughness, Pa sqrt(m), and strength in tension, Pa.
const ROCK: [f64; 3] = [20e9, 1.4e6, 7e6];
/// First guess: bonds over rock for the modulus, the fracture energy and the strength.
const GUESS: [f64; 3] = [0.53, 0.49, 0.45];
/// Spheres across for which its bonds are found, and with which they are tried; packings.
const FOUND_WITH: (u32, u32) = (8, 3);
const TRIED_WITH: [(u32, u32); 3] = [(6, 4), (8, 3), (12, 1)];
/// Rounds in which they are found.
const ROUNDS: usize = 2;

/// Bonds in compression and tension.
fn strengths() -> [Material; 6] {
    let tension = "tensile_strength=5e6";
    let shear = &format!("{tension},cohesion=20e6,friction_angle=0.6");
    let softening = |energy: f64| Material {
        fracture_energy_j_m2: energy,
        ..Material::of(
            &format!("tension, {energy} J/m2"),
            "",
            &format!("{tension},fracture_energy={energy}"),
        )
    };
    [
        Material::of("tension", "", tension),
        Material::of("tension and cohesion", "", shear),
        Material::of("parallel, the same", "model=\"parallel\",", shear),
        Material::of("flat joint, the same", FLAT_JOINT, shear),
        softening(40.0),
        softening(160.0),
    ]
}

pub(super) fn tables() -> [Table; 3] {
    let ratios = "bonds | packings | strength in compression, MPa | \
        of discs in tension, MPa | ratio of both";
    let bonds = "of the rock | wanted | of the bonds | found | over that of the rock";
    let names = [
        "modulus, GPa",
        "K_Ic, MPa sqrt(m)",
        "strength in tension, MPa",
    ];
    let tried = "spheres across | packings | modulus off | K_Ic off | strength in tension off | \
        strength of discs, MPa | strength in compression, MPa";
    let sizes = TRIED_WITH.map(|(number, _)| number.to_string());
    [
        Table::new(
            PAGE,
            "fracture ratios",
            ratios,
            strengths().map(|of| of.name),
        ),
        Table::new(PAGE, "fracture recipe", bonds, names),
        Table::new(PAGE, "fracture recipe", tried, sizes),
    ]
}

/// Strengths by the models of bonds.
pub(crate) fn ratios(bench: &Bench) -> Result<(), Failed> {
    let [mut table, _, _] = tables();
    let (number, packings) = ACROSS;
    for material in strengths() {
        let of_seed = |seed| {
            let spheres = Spheres::across(number, seed);
            let crushed_pa = crushed_pa(bench, &material, spheres)?;
            let split_pa = split_pa(bench, &material, spheres)?;
            Ok([1e-6 * crushed_pa, 1e-6 * split_pa, crushed_pa / split_pa])
        };
        let rows = (1..=packings)
            .map(of_seed)
            .collect::<Result<Vec<_>, Failed>>()?;
        let first = [packings.to_string()];
        table.row(first.into_iter().chain(over(&rows, [1, 2, 2])));
    }
    write(&[table])
}

/// The bonds of the rock.
fn rock(bonds: [f64; 3]) -> Material {
    Material::tensile(bonds, ROCK[0], DENSITY_KG_M3)
}

/// Means over packings of what `ROCK` has.
fn measured(bench: &Bench, material: &Material, of: (u32, u32)) -> Result<[f64; 3], Failed> {
    let of_seed = |seed| {
        let spheres = Spheres::across(of.0, seed);
        let [young_pa, tensile_pa] = pulled(bench, material, spheres)?;
        let specimen = beam(Some(bench), material, spheres, HEIGHT_M)?;
        let bent = bent(&specimen, &specimen.run(bench, material)?, HEIGHT_M);
        Ok([young_pa, bent.toughness, tensile_pa])
    };
    let rows = (1..=of.1)
        .map(of_seed)
        .collect::<Result<Vec<_>, Failed>>()?;
    Ok(columns(&rows, mean))
}

/// The bonds of a rock: modulus follows modulus, the fracture energy `K_Ic^2/E`, and the strength
/// the square of strength over toughness, as both strength and toughness of a body follow both
/// numbers of its bonds. Then the same bonds with other spheres.
pub(crate) fn recipe(bench: &Bench) -> Result<(), Failed> {
    let of_rock = [ROCK[0], ROCK[1].powi(2) / ROCK[0], ROCK[2]];
    let mut bonds: [f64; 3] = std::array::from_fn(|at| GUESS[at] * of_rock[at]);
    for _ in 0..ROUNDS {
        let found = measured(bench, &rock(bonds), FOUND_WITH)?;
        let [modulus, toughness, strength]: [f64; 3] =
            std::array::from_fn(|at| ROCK[at] / found[at]);
        bonds[0] *= modulus;
        bonds[1] *= toughness.powi(2) / modulus;
        bonds[2] *= (strength / toughness).powi(2);
    }
    let [_, mut derived, mut tried] = tables();
    let names = [
        "modulus, GPa",
        "fracture energy, J/m2",
        "tensile strength, MPa",
    ];
    for at in 0..3 {
        let [of_rock_unit, of_bonds_unit] = [[1e-9, 1e-9], [1e-6, 1.0], [1e-6, 1e-6]][at];
        derived.row([
            format!("{}", of_rock_unit * ROCK[at]),
            names[at].to_owned(),
            format!("{:.2}", of_bonds_unit * bonds[at]),
            format!("{:.3}", bonds[at] / of_rock[at]),
        ]);
    }
    let material = rock(bonds);
    for of in TRIED_WITH {
        let found = measured(bench, &material, of)?;
        let strengths = |seed| {
            let spheres = Spheres::across(of.0, seed);
            let crushed_pa = crushed_pa(bench, &material, spheres)?;
            Ok([
                1e-6 * split_pa(bench, &material, spheres)?,
                1e-6 * crushed_pa,
            ])
        };
        let strengths = (1..=of.1)
            .map(strengths)
            .collect::<Result<Vec<_>, Failed>>()?;
        let mut cells = vec![of.1.to_string()];
        cells.extend((0..3).map(|at| change(found[at] / ROCK[at] - 1.0, 1)));
        cells.extend(over(&strengths, [1, 1]));
        tried.row(cells);
    }
    write(&[derived, tried])
}
